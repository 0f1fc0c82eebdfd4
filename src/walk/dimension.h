// Every random dimension has a name. Numbers come in pairs (numeric/rng.h); a path's pairs are
// numbered from its start: the first few once a path, then PAIRS_PER_VERTEX a vertex.
#ifndef WALK_DIMENSION_H
#define WALK_DIMENSION_H

#include <stdint.h>

enum {
  PAIR_LIGHT = 0,    // u0: which light; u1: free
  PAIR_POSITION = 1, // where a photon starts
  PAIR_DIRECTION = 2,
  PAIR_PIXEL = 0, // eye paths: where in the pixel's footprint
  PAIR_LENS = 1,
  PAIR_VERTEX = 4,
  PAIRS_PER_VERTEX = 4,
};

enum vertex_pair {
  VERTEX_DIRECTION, // of scattering
  VERTEX_CHOICE,    // u0: component of the material; u1: roulette
  VERTEX_LIGHT,     // u0: which light, of next-event estimation; u1: the material's own (bsdf.u)
  VERTEX_EMITTER,   // where on that light; light tracing: on the lens
};

// Vertex 0 is the first surface a path meets, or its first collision in a medium.
static inline uint32_t pair_of_vertex(int vertex, enum vertex_pair pair) {
  return PAIR_VERTEX + PAIRS_PER_VERTEX * (uint32_t)vertex + (uint32_t)pair;
}

// Above all others: number `k` since `vertex` of what happens between vertices. A path of 2^14
// vertices, or of 2^16 such events, would meet its own numbers again.
enum pair_between {
  BETWEEN_FLIGHT = 1,   // where in a medium a path may collide, and whether it does
  BETWEEN_CROSSING = 2, // whether a surface that it may see through stops it
  BETWEEN_SHADOW = 3,   // where in a medium its shadow ray may be attenuated
};
static inline uint32_t pair_between(enum pair_between what, int vertex, uint32_t k) {
  return (uint32_t)what << 30 | ((uint32_t)vertex & 0x3fffu) << 16 | (k & 0xffffu);
}

#endif
