// Embree 3 on the triangles of a scene, one thread, its default quality: the peer of the ray rows.
#ifndef TESTS_BENCH_EMBREE_H
#define TESTS_BENCH_EMBREE_H

#include "tests/bench/rays.h"

struct embree; // NULL where the program was built without it

// The scene holds triangles alone, else NULL. robust: by its flag of that name.
struct embree *embree_new(const struct scene *, bool robust, struct arena *);
void embree_release(struct embree *);

// Its ways to trace rays. `any`: blocked or not, else the closest hit.
struct embree_mode {
  const char *name;
  bool any;
  void (*trace)(void *rays, int repetition); // struct embree_rays
};
extern const struct embree_mode embree_modes[]; // name NULL: the end

// Rays laid out as the modes want them, and room for their answers. coherent: Embree is told so.
struct embree_rays;
struct embree_rays *embree_rays_new(const struct embree *, const struct rays *, bool coherent,
                                    struct arena *);

// After a trace: of how many rays the answer is another than ours, beyond what float can tell.
int embree_differs(const struct embree_rays *, const struct embree_mode *, const struct rays *);

// The primitive that ray j hit, or PRIMITIVE_NONE.
uint32_t embree_primitive(const struct embree_rays *, int j);

#endif
