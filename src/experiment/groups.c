// Which cells share one photon pass.
#include "experiment/experiment.h"
#include "scene/scene.h"

#include <string.h>

static bool same_probes(const struct cell *a, const struct cell *b) {
  if (a->n_probes != b->n_probes) return false;
  for (int j = 0; j < a->n_probes; j++)
    if (a->probe[j].x != b->probe[j].x || a->probe[j].y != b->probe[j].y) return false;
  return true;
}

static bool same_list(const uint64_t *a, int n_a, const uint64_t *b, int n_b) {
  return n_a == n_b && (n_a == 0 || memcmp(a, b, (size_t)n_a * sizeof *a) == 0);
}

static bool same_images(const struct cell *a, const struct cell *b) {
  return same_list(a->image, a->n_images, b->image, b->n_images) &&
         same_list(a->single, a->n_singles, b->single, b->n_singles) &&
         same_list(a->discs, a->n_discs, b->discs, b->n_discs);
}

// Everything but kernel, law, alpha, radii, their reference and k, and what the analysis alone looks
// at.
static bool same_paths(const struct cell *a, const struct cell *b) {
  return a->photons == b->photons && a->depth == b->depth && a->direct == b->direct &&
         a->left_out == b->left_out && a->seed == b->seed && a->runs == b->runs &&
         a->until_se == b->until_se && a->keeps_runs == b->keeps_runs &&
         a->iterations == b->iterations && a->footprint == b->footprint &&
         a->hit_points == b->hit_points && a->integrator == b->integrator &&
         strcmp(a->scene_path, b->scene_path) == 0 && same_probes(a, b) && same_images(a, b);
}

// The group of each cell, numbered in the order of their first cells; returns how many there are.
static int assign(const struct experiment *experiment, int *group_of, int *first) {
  int n = 0;
  for (int c = 0; c < experiment->n_cells; c++) {
    int g = 0;
    while (g < n && !same_paths(&experiment->cell[first[g]], &experiment->cell[c])) g++;
    if (g == n) first[n++] = c;
    group_of[c] = g;
  }
  return n;
}

struct group *experiment_groups(const struct experiment *experiment, struct arena *arena,
                                int *n_groups) {
  int n_cells = experiment->n_cells;
  int *group_of = arena_new(arena, int, n_cells), *first = arena_new(arena, int, n_cells);
  *n_groups = assign(experiment, group_of, first);
  struct group *group = arena_new(arena, struct group, *n_groups);
  for (int c = 0; c < n_cells; c++) group[group_of[c]].n_cells++;
  for (int g = 0; g < *n_groups; g++) {
    group[g].cell = arena_new(arena, int, group[g].n_cells);
    group[g].n_cells = 0;
  }
  for (int c = 0; c < n_cells; c++) {
    struct group *mine = &group[group_of[c]];
    mine->cell[mine->n_cells++] = c;
  }
  return group;
}
