// An experiment made ready: scenes loaded, cells grouped by what determines their paths, and the
// layout of what one run of a group yields.
#ifndef RUN_PLAN_H
#define RUN_PLAN_H

#include "experiment/experiment.h"
#include "log/results.h"

enum { RUNS_PER_BLOCK = 16 }; // a power of two: the unit of work, checkpoint and merge

struct run_options {
  int threads; // 0: all cores
  bool quiet;
  unsigned skip_off; // bits of enum skip
  bool lenient;      // of scene_options
  // The largest standard error of the rates asked for; infinite: some is not known. A problem: it
  // cannot be said. NULL where no cell has `until`.
  double (*largest_rate_se)(const struct results *, struct arena scratch, struct problem *);
};

int plan_threads(const struct run_options *);
struct bvh_options plan_tree(const struct run_options *);

struct loaded_scene {
  const char *path;
  struct scene scene;
  struct bvh *bvh;
};

// One run of a group yields a vector of `width` numbers: for each cell, for each probe a series of
// `iterations` luminances, the running averages at the checkpoints and, where there are any,
// `iterations` squared radii of local statistics and `iterations` biases by Richardson; then for
// each cell, for each kept image, n_points * n_channels values: running averages, then those of
// iterations alone. Where runs are kept, kept_width of its numbers are: for each cell, for each probe
// the running averages at the checkpoints, then, where there are biases by Richardson, theirs. The
// measurement's estimators are the cells, then their companions.
struct group_plan {
  int number;
  const struct group *group;
  const struct cell *cell; // the first: what all cells of the group share
  const struct loaded_scene *loaded;
  struct measurement measure;
  int n_probes;
  struct pixel *probe_pixel;
  int *probe_point; // where each probe is among the measured points
  int n_checkpoints;
  uint64_t *checkpoint;
  int n_images;       // kept: averages, then single iterations; if any, the whole film is measured
  int *companion;     // [n_cells] the estimator of half the radius; 0: none
  long average_at;    // parts of a series: running averages,
  long radius_at;     // squared radii; 0: none
  long richardson_at; // biases; 0: none
  int n_times;        // at how many iterations the time is taken: of images, and the last
  long series_width, width;
  long kept_width; // numbers kept of each run; 0: none
  uint64_t runs; // that are made: all of the cell, or so many until now (look.h)
  int looks;     // at what they say, the last included
  bool enough;   // the last look said so
  uint64_t n_blocks;
  uint64_t fingerprint; // of all that determines the numbers
};

struct plan {
  const struct experiment *experiment;
  struct run_options options;
  struct loaded_scene *scene;
  int n_scenes;
  struct group_plan *group;
  int n_groups;
  uint64_t fingerprint; // of all groups
};

bool plan_make(const struct experiment *, struct run_options, struct arena *, struct plan *,
               struct problem *);

// The parts of a measurement that a cell and its scene determine; its points and estimators are
// left to the caller.
struct measurement plan_measurement(const struct cell *, const struct scene *, const struct bvh *,
                                    unsigned skip_off);
// All pixels of the film, row by row; NULL and a problem if they are too many.
struct pixel *plan_film(const struct scene *, int *n_points, struct arena *, struct problem *);
// False and a problem where the scene's coordinates do not resolve the last radius.
bool plan_estimator(const struct cell *, const struct scene *, struct estimator *,
                    struct problem *);

// Offsets into the vector.
long plan_series(const struct group_plan *, int cell, int probe); // cell: in the group
long plan_image(const struct group_plan *, int cell, int image);
long plan_kept(const struct group_plan *, int cell, int probe); // into what is kept of a run

// The iteration after which time t of n_times is taken.
uint64_t plan_time_at(const struct group_plan *, int t);

// What the probes of a group see (reference NAN).
void plan_probes(const struct group_plan *, struct probe *, struct arena scratch);

// N at which running averages are logged: 10 a decade (1 2 3 4 5 6 8 10 13 ...), and the last.
uint64_t *plan_checkpoints(uint64_t iterations, int *count, struct arena *);

#endif
