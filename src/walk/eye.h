// The eye pass: where the pixels' rays meet surfaces that scatter light other than as a mirror or
// clear glass does, past those that do, or collide in a medium before.
#ifndef WALK_EYE_H
#define WALK_EYE_H

#include "walk/walk.h"

// What one pixel sees. Where a surface has delta lobes beside others, which of the two is seen is
// random, so that a path has one point.
struct eye_point {
  bool hit;        // the path ended here; false: it left the scene or was absorbed
  bool volume;     // in a medium: bsdf is its phase function, weight holds sigma_s
  uint32_t medium; // that the path arrived through; MEDIUM_NONE: a vacuum
  int vertex;      // scatterings between the camera and here
  struct vec p;
  uint32_t primitive;       // p is on it; PRIMITIVE_NONE: in a medium
  struct bsdf bsdf;         // type NULL: scatters nothing
  struct vec wo;            // towards the eye, unit length
  double weight[3];         // of radiance leaving towards wo, in the pixel
  double emitted[3];        // radiance met on the way, weights included: L S* E, and the background
  double across, footprint; // the pixel's width here, straight and on the surface, scene units
                            // (walk/differential.h); 0 if nobody asked
};

// The rays of n <= WALK_BATCH pixels; pixel centres, or with `footprint` positions distributed as
// the scene's filter, random in (iteration, path). path[j] identifies pixel j's random numbers.
void eye_rays(struct walk *, const struct pixel *, int n, bool footprint);

// The eye points of n pixels (any number). walk->key and walk->iteration are set by the caller.
// depth: pbrt's maxdepth, the most scatterings, the one at the point included.
void eye_trace(struct walk *, const struct pixel *, int n, bool footprint, int depth,
               struct eye_point *);

// Radiance the surface emits towards w; zero where it is no light.
void eye_emitted(const struct scene *, const struct surface *, struct vec w, double rgb[3]);

// The geometric normal on the side of wo.
static inline struct vec eye_normal(const struct eye_point *point) {
  struct vec ng = point->bsdf.ng;
  return vec_dot(ng, point->wo) < 0 ? vec_scale(ng, -1) : ng;
}

// The identity of a pixel's eye path.
static inline uint64_t eye_path(const struct camera *camera, struct pixel pixel) {
  return (uint64_t)pixel.y * (uint64_t)camera->width + (uint64_t)pixel.x;
}

#endif
