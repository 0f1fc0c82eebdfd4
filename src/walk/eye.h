// The eye pass: where the pixels' rays meet the scene.
#ifndef WALK_EYE_H
#define WALK_EYE_H

#include "walk/walk.h"

// What one pixel sees. Surfaces that do not scatter light end here too, with their emission.
struct eye_point {
  bool hit;
  struct surface surface;
  struct vec wo;     // towards the eye, unit length
  struct vec n;      // geometric normal on the side of wo
  double weight[3];  // of radiance leaving towards wo, in the pixel
  double emitted[3]; // radiance emitted towards wo, weight included
};

// The rays of n <= WALK_BATCH pixels; pixel centres, or with `footprint` a uniform position in each
// pixel, random in (iteration, path). path[j] identifies pixel j's random numbers.
void eye_rays(struct walk *, const struct camera *, const struct pixel *, int n, bool footprint);

// The eye points of n pixels (any number). walk->key and walk->iteration are set by the caller.
void eye_trace(struct walk *, const struct camera *, const struct pixel *, int n, bool footprint,
               struct eye_point *);

// Radiance the surface emits towards w; zero where it is no light.
void eye_emitted(const struct scene *, const struct surface *, struct vec w, double rgb[3]);

// The identity of a pixel's eye path.
static inline uint64_t eye_path(const struct camera *camera, struct pixel pixel) {
  return (uint64_t)pixel.y * (uint64_t)camera->width + (uint64_t)pixel.x;
}

#endif
