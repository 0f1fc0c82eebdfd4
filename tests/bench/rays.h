// Rays of a scene as the renderer shoots them, in its order, rounded to float so that a peer gets
// the very same ones.
#ifndef TESTS_BENCH_RAYS_H
#define TESTS_BENCH_RAYS_H

#include "tests/bench/bench.h"

struct rays {
  struct ray *ray;
  struct hit *hit; // of each, by the tree, checked against brute force
  int n;
};

// From the camera: one a pixel.
struct rays rays_of_camera(const struct bench_scene *, struct arena *);
// Photon paths from their light on, batch by batch, vertex by vertex.
struct rays rays_of_photons(const struct bench_scene *, int n, struct arena *);
// From where these hit to a point of a light on the same side, t_max just before it.
struct rays rays_to_lights(const struct bench_scene *, const struct rays *, struct arena *);

// From about the middle of the largest shape, which is closed, to points of its edges and vertices.
// Each must hit it.
struct rays rays_at_edges(const struct bench_scene *, int n, struct arena *);
bool rays_hit_largest(const struct bench_scene *, uint32_t primitive);

// Dies unless the tree's hits are those of brute force, of as many rays as time permits.
void rays_check(const struct bench_scene *, const struct rays *, const char *name);

#endif
