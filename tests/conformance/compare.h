// Two estimates of the same mean, each with an error that was itself estimated: do they disagree?
#ifndef TESTS_CONFORMANCE_COMPARE_H
#define TESTS_CONFORMANCE_COMPARE_H

#include "image/image.h"

struct estimate {
  double mean;
  double se2, dof; // variance of the mean, known with so many degrees of freedom
  double rounding; // a systematic error of at most this, unit of the mean
};

// The mean of n independent values.
struct estimate estimate_of(const double *value, int n);

// The mean of `n` values and of `more` further ones, where the number of these was chosen by the
// variance of the first n: that variance, and no other, makes the difference Student's t (Stein
// 1945), since it is independent of both means.
struct estimate estimate_extended(struct estimate first, int n, double mean_of_more, int more);

// The mean of n independent estimates with weights that know nothing of them (Satterthwaite's
// degrees of freedom, as below). Estimates of weight 0 may be unset.
struct estimate estimate_weighted(const struct estimate *, const double *weight, int n);

// The mean of n independent measurements, each with a standard error of `dof` degrees of freedom.
// The sum of their squares is worth (sum se^2)^2 / sum (se^4 / dof) of them (Satterthwaite 1946).
struct estimate estimate_pooled(const double *mean, const double *se, int n, double dof);

// The difference over its standard error is Student's t with Welch's degrees of freedom, to the
// extent that the means are normal. Returned is the normal deviate with the same two-sided tail, so
// that one threshold serves all degrees of freedom; the sign is a's minus b's. Only what exceeds
// the rounding bounds counts. Without any variance: 0 or infinite.
double compare_z(struct estimate a, struct estimate b);

// The same estimate when the truth is known to be between (1 - excess) of it and all of it.
struct estimate estimate_with_excess(struct estimate, double excess);

// |z| that a family of so many independent tests exceeds somewhere with probability `level`
// (Sidak).
double compare_threshold(double level, long tests);

// Probability that |compare_z| exceeds the threshold when a is off by `shift`.
double compare_power(struct estimate a, struct estimate b, double shift, double threshold);

// The shift that exceeds it with this probability, in (1/2, 1).
double compare_smallest(struct estimate a, struct estimate b, double threshold, double power);

// ---- regions of images ----

struct region {
  int x, y, width, height;
};

// Squares of `side` pixels from the top left, smaller at the right and bottom edges.
int region_count(const struct image *, int side);
struct region region_block(const struct image *, int side, int number);
struct region region_quadrant(const struct image *, int number); // 0..3: top left, right, bottom

bool region_overlap(struct region, struct region);

// The mean of the first three channels (of the only one, if there is one) over the region.
double region_mean(const struct image *, struct region);

// The same from pbrt-v4's stored mean and standard error, over 8 seeds written as half floats.
struct estimate region_reference(const struct image *mean, const struct image *se, struct region,
                                 struct arena scratch);

#endif
