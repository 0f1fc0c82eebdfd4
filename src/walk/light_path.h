// Light paths by what lies between the light and the first surface the eye sees that scatters other
// than as a mirror or clear glass does. In Heckbert's words: L a light, S a scattering by a delta
// lobe, D any other (a glossy one too), E the eye.
#ifndef WALK_LIGHT_PATH_H
#define WALK_LIGHT_PATH_H

#include <stdbool.h>

enum light_path { // bits
  LIGHT_PATH_EMITTED = 1,
  LIGHT_PATH_DIRECT = 2,
  LIGHT_PATH_CAUSTICS = 4,
  LIGHT_PATH_INDIRECT = 8,
  LIGHT_PATH_ALL = 15,
};

enum { LIGHT_PATHS = 4 };
struct light_path_row {
  const char *name, *about;
  enum light_path bit;
};
extern const struct light_path_row light_paths[LIGHT_PATHS];

// One more scattering, seen from either end. From the eye: what an emitter met next completes,
// EMITTED at the camera. From the light: what an eye that looks here completes, DIRECT at the
// light.
static inline enum light_path light_path_after(enum light_path before, bool delta) {
  if (before == LIGHT_PATH_EMITTED) return delta ? LIGHT_PATH_EMITTED : LIGHT_PATH_DIRECT;
  if (before == LIGHT_PATH_INDIRECT || !delta) return LIGHT_PATH_INDIRECT;
  return LIGHT_PATH_CAUSTICS;
}

// Whether all that may follow is left out too: indirect light stays indirect.
static inline bool light_path_ends(enum light_path kind, unsigned left_out) {
  return kind == LIGHT_PATH_INDIRECT && (left_out & LIGHT_PATH_INDIRECT);
}

#endif
