// What radii that follow the photons found do on average (theory 2.4), by recursion and without
// random numbers. The photons of a pass in a disc are binomial, so (N, r^2) is a Markov chain, and
//   W_0 = 1,   W_k+1(N, s) = sum over m of P(m | s) ratio(N, m)^p W_k(N', s ratio(N, m)),
// with (N', ratio) the law's, gives s^p W_k(N, s) = E[r^2p of k passes later | N, r^2 = s].
#ifndef ANALYSIS_LOCAL_RADIUS_H
#define ANALYSIS_LOCAL_RADIUS_H

#include "base/arena.h"
#include "density/law.h"

#include <stdint.h>

// One point; s is r^2 in units of r_1^2.
struct local_radius {
  const struct law *law; // with local statistics
  double alpha;          // in (0, 1]
  double emitted;        // photons in a pass, all alike, each once in a disc at most
  double (*fraction)(const void *of, double s); // of them that fall into the disc, s in (0, 1]
  const void *of;
};

// moment[i - 1] = E[(r_i / r_1)^(2 power)] for i = 1..n, power 1 or 2.
void local_radius_moment(const struct local_radius *, int power, uint64_t n, double *moment,
                         struct arena scratch);

#endif
