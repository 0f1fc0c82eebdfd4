// An experiment: a YAML file that holds only what it varies (design, "An experiment file").
// Every key is a value or a list; lists cross. `parts:` is a list of mappings, each an experiment of
// its own that inherits the keys above it. `paper:` (at the top or in a part) is a mapping of the
// keys that quality "paper" replaces. Defaults live in one table (experiment.c), printed by
// `photonlab list experiment`.
#ifndef EXPERIMENT_EXPERIMENT_H
#define EXPERIMENT_EXPERIMENT_H

#include "base/arena.h"
#include "base/problem.h"
#include "density/kernel.h"
#include "density/law.h"
#include "estimate/reference_radius.h"
#include "integrator/integrator.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum direct { DIRECT_PHOTONS, DIRECT_NEE };
enum quantity { QUANTITY_VARIANCE = 1, QUANTITY_BIAS = 2 }; // bits

struct cell {
  int number;              // from 0, in the order of the file
  int part;                // from 0
  const char *scene_path;
  const char *scene;       // base name without extension
  const struct integrator_type *integrator;
  const struct kernel *kernel;
  const struct law *law;   // NULL while being read: the integrator's default
  double alpha;            // in [0, 1]
  double radius;           // support at i = 1, in reference radii, > 0; 0: it has none
  double radius_volume;    // the same of points in media, scene units; 0: radius
  const struct reference_radius *reference_radius;
  int k;                   // nearest photons, of knn or of photonmap; 0: none
  uint64_t photons;        // emitted per iteration, >= 1
  uint64_t iterations, runs; // N >= 1, K >= 1
  double until_se;         // of every rate that is asked for: then no more runs; 0: all runs
  uint64_t seed;
  struct pixel *probe;     // NULL: default, a fixed 3x3 grid of pixels
  int n_probes;            // 0: default
  uint64_t hit_points;     // ppm: of one eye pass in each pixel, >= 1
  bool footprint;          // pixel: footprint (true) or centre
  enum direct direct;
  unsigned left_out;       // bits of enum light_path that are not seen; 0: all are
  int depth;
  unsigned quantities;     // what is fitted: bits of enum quantity
  uint64_t *image;         // running averages after these iterations are kept as moment images
  int n_images;
  uint64_t *single;        // the images of these iterations alone are kept
  int n_singles;
  bool keeps_runs;         // each run's running averages are kept, not only moments over runs
  uint64_t *discs;         // the points of run 1 and their radii after these passes are kept
  int n_discs;
  const char *reference_integrator; // "path", "analytic", "richardson" or "none"
  double reference_se;     // absolute target standard error of the reference, radiance; 0: none needed
  double reference_share;  // or relative, of the smallest bias to be fitted; 0: reference_se
};

// The law where none is said.
const struct law *cell_default_law(const struct cell *);

// Sets what follows from other keys: a radius of 1 reference radius, k of knn. NULL, or what is wrong
// with the keys together.
const char *cell_settle(struct cell *);

// Whether the radius is the same at all points, in scene units.
static inline bool cell_radius_is_known(const struct cell *cell) {
  return cell->reference_radius->global && cell->radius > 0;
}

// Whether the cell's photons are also gathered at half the radius: reference richardson.
static inline bool cell_has_companion(const struct cell *cell) {
  return strcmp(cell->reference_integrator, "richardson") == 0;
}

// Half the radius means half the radius at every point and iteration.
static inline bool cell_can_have_companion(const struct cell *cell) {
  return cell->integrator->photons && cell->radius > 0 && !cell->law->count;
}

struct experiment {
  const char *path, *name, *title, *quality; // name: base name without extension
  struct text_copy {
    const char *data;
    ptrdiff_t length;
  } text;                  // the file's bytes
  struct cell *cell;
  int n_cells, n_parts;
};

// quality: "default" or "paper". Problems carry file:line:column; duplicate keys, unknown keys,
// values out of range, NaN are problems.
bool experiment_read(const char *path, const char *quality, struct arena *, struct experiment *,
                     struct problem *);

// Cells whose photon and eye paths are the same (scene, photons, depth, direct, view, seed, runs,
// iterations, probes, footprint, images, integrator): they share one photon pass. Formed from the
// experiment alone, in the order of the first cell of each.
struct group {
  int *cell;
  int n_cells;
};
struct group *experiment_groups(const struct experiment *, struct arena *, int *n_groups);

// The table of keys (name, default, meaning), for `photonlab list experiment`. A default in
// parentheses is a description, any other is a value as a file would give it. Where lists cross, the
// first key of the table varies slowest.
struct reading;
struct node;
struct experiment_key {
  const char *name, *fallback, *meaning;
  bool crosses; // may be a list: one cell for each item
  bool (*read)(struct reading *, const struct node *, struct cell *); // NULL: title, parts, paper
};
extern const struct experiment_key experiment_keys[];
extern const int n_experiment_keys;

#endif
