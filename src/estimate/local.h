// Local statistics (Hachisuka, Ogaki, Jensen 2008): each point of each estimator has a radius and a
// count of its own, which only the photons found there change. The flux rule tau (r'^2 / r^2) makes
// the estimate the average of what each pass alone estimates (theory 2.4), so a pass gives just that.
#ifndef ESTIMATE_LOCAL_H
#define ESTIMATE_LOCAL_H

#include "estimate/photon_map.h"

struct local {
  double *r2, *n; // [point * n_estimators + estimator]
  double *r;      // scratch, [n_estimators]
  int64_t *found; // scratch, [n_estimators]
};

struct local local_new(const struct measurement *, struct arena *);
void local_begin(struct local *, const struct measurement *);

// Photon pass i around the map's points, its estimates into the frame, then the law. A law without
// local statistics follows i alone.
void local_pass(struct local *, struct photon_map *, uint64_t i, double *frame);

#endif
