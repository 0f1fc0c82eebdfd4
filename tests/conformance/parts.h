// The parts of the conformance test.
#ifndef TESTS_CONFORMANCE_PARTS_H
#define TESTS_CONFORMANCE_PARTS_H

#include "tests/conformance/report.h"
#include "tests/conformance/runs.h"

// Where the reference itself is known to be too bright: the truth is between (1 - excess) of it and
// all of it.
struct doubt {
  struct region where;
  double excess;
};

struct conformance_scene {
  const char *name, *about;
  bool fog;                  // around everything: integrators are compared in full only
  const struct doubt *doubt; // of the blocks it touches, or NULL
};
extern const struct conformance_scene conformance_scenes[]; // ends with a NULL name

struct options {
  const char *conformance, *scenes, *output; // folders; NULL output: pictures are not wanted
  const char *only;                          // scenes whose name contains this; NULL: all
  bool full;                                 // as precise as the references, else a glance
  bool always_pictures;
};

// Path tracing against pbrt-v4's images.
void paths_check(const struct options *, struct report *);

// All integrators against each other; pbrt-v4's scenes if they are there, and our own.
void agree_check(const struct options *, struct report *, bool conformance);

// Scenes by others: image means only, or the integrator against itself.
void others_check(const struct options *, struct report *);

// Prints the line of a scene that cannot be read.
void refused(struct report *, const char *name, const struct problem *);

bool selected(const struct options *, const char *name);

// NAME.png (ours, the reference, z of every block from blue to red) and NAME.exr.
void picture_write(const struct options *, const char *name, const struct image *ours,
                   const struct image *reference, const double *z, int side, struct arena scratch);

#endif
