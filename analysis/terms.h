// How variance and bias go with the radius where theory knows no more than that (theory 1.3, 1.4).
#ifndef ANALYSIS_TERMS_H
#define ANALYSIS_TERMS_H

#include "experiment/experiment.h"
#include "log/results.h"
#include "scene/scene.h"

// In a medium (d = 3, 1):
// - `ends`: where the medium ends on the ray, at a wall or an interface, balls lack the photons
//   behind. Within r of a wall that the ray meets at the cosine c an eye point at the height h
//   lacks the share M(h / r), and the mean over the ray
//     T sigma_s S r / c int_0^1 M(a) da = T sigma_s S r / c E|u_1| / 2     (3/16 for the box)
//   with T what the ray has left there and S the radiance scattered at the wall over sigma_s. So
//   the bias leads with r, and r^2 is the second term. Beams, too, lack what is of order r near
//   the ray's end, unless wall and ray are at right angles. The surface behind has a bias as rho,
//   third after points, and first along with what beams lack.
// - `pairs`: two photons of one path in a ball (analysis/pairs.h), over the leading term of the
//   first iteration; NAN: some, of unknown size.
// - How far a ray gets is random, which adds a variance that knows no radius: with points it
//   outweighs the terms of r^-1 and r^0 that photons have.
struct terms {
  int d;
  bool ends;
  double pairs;
};

struct terms terms_of(const struct scene *, const struct cell *, const struct probe *);

#endif
