// Batches of paths that advance together: trace the batch, then at every hit store or connect,
// scatter, and close the gaps. Photon and eye paths share this body; what happens at a hit is
// theirs.
#ifndef WALK_WALK_H
#define WALK_WALK_H

#include "bvh/bvh.h"
#include "numeric/rng.h"
#include "scene/scene.h"

enum { WALK_BATCH = 4096 };

struct walk {
  const struct scene *scene;
  const struct bvh *bvh;
  int n_channels;
  struct rng_key key;
  uint64_t iteration;

  int n;           // paths alive, packed at the front of the arrays below
  int vertex;      // how many surfaces they have met: 0 before the first trace
  uint64_t *path;  // [n] number of the path, its identity for random numbers
  struct ray *ray; // d of unit length
  struct hit *hit;
  double *throughput[3]; // photons: flux [W]; eye paths: weight of what is met next
  double *pdf;           // solid angle pdf of ray.d by the last scattering; 0: not sampled by one
  int *owner;            // eye paths: the point this path belongs to

  double *u[4][2]; // scratch: pairs of random numbers
  struct shadow {  // scratch of connect_lights, [WALK_BATCH] each
    struct ray *ray;
    struct hit *hit;
    double *distance, *value[3];
    uint32_t *emitter;
    int *owner;
    uint64_t *path;
  } shadow;
};

struct walk *walk_new(const struct scene *, const struct bvh *, int n_channels, struct arena *);

// The pairs of random numbers of all paths alive: u[slot][0..1][j].
void walk_random(struct walk *, int slot, uint32_t pair);

// Closest hits of all rays; paths that hit nothing end.
void walk_trace(struct walk *);

// Moves path `from` to place `to` (closing gaps keeps the order).
void walk_move(struct walk *, int to, int from);

// Samples the material at a surface with u[0] (direction) and u[1] (choice, roulette) of path j.
// Roulette survives with the largest channel of the weight, so gray paths keep their throughput.
// False: absorbed. True: ray, throughput and pdf are those of the next segment.
bool walk_scatter(struct walk *, int j, const struct surface *);

#endif
