// What theory says of one cell at one probe, iteration by iteration (theory 1.3, 1.4, 3.2).
#ifndef ANALYSIS_PREDICTION_H
#define ANALYSIS_PREDICTION_H

#include "analysis/family.h"
#include "analysis/profile.h"
#include "analysis/terms.h"
#include "base/arena.h"
#include "experiment/experiment.h"
#include "log/results.h"

#include <stdbool.h>
#include <stdint.h>

// How the bias of an iteration depends on its radius.
enum bias_kind {
  BIAS_SMOOTH, // as r^2, and higher powers of it
  BIAS_FOURTH, // as r^4, and higher powers: the light's Laplacian is zero
  BIAS_SIDE,   // as r: the side of the probe's pixel is an edge of the light, the bias the error
               // integrated over one side of it (theory 5 iv); or the medium ends on the ray
  BIAS_EDGE,   // not at all: the probe is at an edge (theory 1.5)
  BIAS_ENDS,   // it is none from iteration bias_end + 1 on: the discs are clear of an edge
  BIAS_STAYS,  // the last disc still reaches across an edge, and no power describes it
};

// Where there is a closed form, at theory's radii and per iteration,
//   variance = divergent + rest, bias = bias,
// exactly. Elsewhere only their shape is known: variance = a divergent + c rest and
// bias = b1 bias + b2 bias2, with a, c, b1, b2 to be fitted (not b1 if `known_bias`). Where
// theory's bias is zero, `bias` is the shape that is looked for.
struct prediction {
  int d;          // dimension of the kernel that leads
  double pairs;   // of struct terms
  double radius;  // the first of that kernel, in reference radii
  uint64_t n;     // iterations
  uint64_t first; // those before are not fitted: theory says nothing of their larger discs
  struct family family;
  const char *why_not; // why nothing is fitted although theory knows all; or NULL
  bool closed_form;
  bool known_bias;  // as in closed form, while of the variance only the shape is known
  bool independent; // of each other; else radii follow the photons found, are those expected in
                    // closed form, else the law's, and exponents are predicted but constants are
                    // not (theory 2.4)
  bool unbiased;    // theory's bias is zero for every radius
  enum bias_kind bias_kind;
  uint64_t bias_end;           // of BIAS_ENDS: iterations that have a bias
  double truth, truth_se;      // radiance; NAN if there is nothing to measure bias against
  double variance_coefficient; // A: the leading term of the first iteration's variance; or NAN
  double bias_coefficient;     // b_1: the first iteration's bias; or NAN
  double bias_terms[2];        // what of it goes as r^2 and r^4; NAN where that is not known
  const double *divergent, *rest, *bias, *bias2; // [n]; rest, bias2 NULL where there is one term
  const double *kurtosis;                        // [n], excess, of one value; NULL if unknown
  const double *richardson; // [n], in closed form: 4/3 of what half the radius takes off `bias`
};

// The law of a cell's radii; NULL, constant, where no photons are stored. Radii that follow the
// photons found do so as their law's closed form, but for a constant that tends to one with the
// photons in the first disc (theory 2.4).
const struct law *prediction_law(const struct cell *);
struct family *prediction_family(const struct cell *, struct arena *);

// `scene` is only asked for a closed form. The family must outlive the prediction.
struct prediction prediction_new(const struct scene *scene, const struct cell *cell,
                                 const struct probe *probe, const struct family *family,
                                 struct arena *arena);

// The same from a profile of the irradiance that is already known; tests use it.
struct prediction prediction_from_profile(const struct profile *, double radius, double photons,
                                          double emitted, const struct family *, struct arena *);
// What Richardson's estimate of the bias shows, where that is known; its variance is not.
struct prediction prediction_of_richardson(const struct prediction *);
// ... and where nothing but the exponents is known.
struct prediction prediction_from_reference(double reference, double reference_se, struct terms,
                                            const struct family *, struct arena *);

#endif
