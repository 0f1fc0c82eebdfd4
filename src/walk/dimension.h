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
  PAIR_VERTEX = 4,
  PAIRS_PER_VERTEX = 4,
};

enum vertex_pair {
  VERTEX_DIRECTION, // of scattering
  VERTEX_CHOICE,    // u0: component of the material; u1: roulette
  VERTEX_LIGHT,     // next-event estimation: u0: which light; u1: free
  VERTEX_EMITTER,   // where on that light
};

// Vertex 0 is the first surface a path meets.
static inline uint32_t pair_of_vertex(int vertex, enum vertex_pair pair) {
  return PAIR_VERTEX + PAIRS_PER_VERTEX * (uint32_t)vertex + (uint32_t)pair;
}

#endif
