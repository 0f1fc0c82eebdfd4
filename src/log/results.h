// A results directory read back: what was run and what was measured. Written by src/run, read by
// the analysis. Formats: log.csv (columns in log_columns), probes.csv, manifest.json, a copy of the
// experiment.
#ifndef LOG_RESULTS_H
#define LOG_RESULTS_H

#include "base/arena.h"
#include "base/problem.h"
#include "base/vec.h"
#include "experiment/experiment.h"
#include "moments/moments.h"

// A probe of one part's scene: where its unjittered ray meets the scene, and what is true there.
struct probe {
  int x, y;
  bool hit;        // a surface; false: the ray leaves the scene
  bool volume;     // it flies through a medium on the way,
  bool ends;       // ... which ends on it, at a surface or elsewhere
  struct vec p, n; // world; n on the side of the eye
  double scale;    // radiance in the pixel per irradiance there, luminance: f_r (1/sr) of a diffuse
                   // surface, times what mirrors on the way to the eye leave
  double scale_rgb[3];
  double emitted;                 // radiance emitted towards the eye, luminance
  double reference, reference_se; // radiance, luminance; NAN where there is none
};

// Statistics over runs of one cell at one probe. Values are luminance of radiance [W sr^-1 m^-2].
struct series {
  int cell, probe; // numbers
  uint64_t n_iterations;
  struct moments *iteration; // [n_iterations]: iteration i at i - 1
  int n_checkpoints;
  uint64_t *checkpoint;       // N
  struct moments *average;    // of the running average after N iterations
  struct moments *radius2;    // [n_iterations], scene units^2: of a local law's radius; NULL: none
  struct moments *richardson; // [n_iterations]: bias of iteration i by Richardson; NULL: none
  // Of each run: [n_checkpoints][runs], the running averages of its values and, where there are
  // any, of its biases by Richardson; NULL: only moments are kept.
  double *run_average, *run_richardson;
};

// Of what leads there as radii shrink: of the kernel in the medium, on a surface 2.
static inline int probe_dimension(const struct cell *cell, const struct probe *probe) {
  int volume = cell->integrator->volume_dimension;
  return probe->volume && volume ? volume : 2;
}

// The first support of the same, in reference radii.
static inline double probe_radius(const struct cell *cell, const struct probe *probe) {
  bool own = probe_dimension(cell, probe) != 2 && cell->radius_volume > 0;
  return own ? cell->radius_volume : cell->radius;
}

struct results {
  const char *directory;
  struct experiment experiment;
  uint64_t *scene_hash;  // by cell
  int *looks;            // by cell: at how many numbers of runs it was decided to make more
  struct probe **probe;  // by cell: [n_probes of the cell]
  int *n_probes;         // by cell
  struct series *series; // by cell, then probe
  int n_series;
};

bool results_read(const char *directory, struct arena *, struct results *, struct problem *);

// Only the experiment's name, from the manifest.
bool results_name(const char *directory, struct arena *, const char **name, struct problem *);

struct log_column {
  const char *name, *unit, *meaning;
};
extern const struct log_column log_columns[];
extern const int n_log_columns;
extern const char probes_header[]; // first line of probes.csv

// Rec.709 luminance, exact for equal channels.
static inline double luminance(const double *value, int n_channels) {
  if (n_channels == 1) return value[0];
  return value[1] + (0.2126 * (value[0] - value[1]) + 0.0722 * (value[2] - value[1]));
}

#endif
