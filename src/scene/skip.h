// What a scene does not need is skipped, and no bit of the result changes (design 6). Each skip has
// a name, so that `--no-skip=NAME` can switch it off and a test can compare the bytes.
#ifndef SCENE_SKIP_H
#define SCENE_SKIP_H

#include "base/problem.h"

enum skip {
  SKIP_GRAY = 1,         // carrying three channels where all spectra are gray
  SKIP_STATIC_EYE = 2,   // tracing the eye pass again where nothing at the camera is random
  SKIP_UNSEEN = 4,       // storing photons in grid cells that no point can see
  SKIP_PROBES = 8,       // computing pixels nobody asked for
  SKIP_MEDIA = 16,       // asking for media, and for photons in them, where there are none
  SKIP_MOTION = 32,      // bringing a scene to its time in every iteration where nothing moves
  SKIP_TREE = 64,        // a tree over at most SKIP_FEW_PRIMITIVES, or SKIP_FEW_TRIANGLES
  SKIP_LAST = 128,       // a direction after the last vertex of a photon path
  SKIP_RUNS = 256,       // runs after those that `until` needed
  SKIP_REFERENCES = 512, // references that are on disk
};

// All in one leaf, or one of triangles and one of others. Of 3 or 4 a tree is as fast, of 9 (three
// spheres) and 12 triangles 1.1 times faster.
enum { SKIP_FEW_PRIMITIVES = 4, SKIP_FEW_TRIANGLES = 48 };

struct skip_row {
  const char *name;
  enum skip bit;
  const char *about;
};
extern const struct skip_row skip_rows[];
extern const int n_skip_rows;

// "all" or names separated by commas; sets the bits of what is not to be skipped.
bool skip_read(const char *names, unsigned *off, struct problem *);

#endif
