#include "app/race.h"

#include "analysis/image_error.h"
#include "experiment/cell_keys.h"
#include "log/csv.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

// ---- cells: by scene, then by method ----

static bool is_key(const struct cell_key *key, const char *names) {
  const char *at = strstr(names, key->name);
  size_t length = strlen(key->name);
  return at && (at[length] == ' ' || !at[length]) && (at == names || at[-1] == ' ');
}

static bool same_key(const struct cell_key *key, const struct cell *a, const struct cell *b) {
  char x[CELL_KEY_SIZE], y[CELL_KEY_SIZE];
  return strcmp(key->text(a, 17, x), key->text(b, 17, y)) == 0;
}

static bool same_method(const struct cell *a, const struct cell *b) {
  for (int k = 0; k < CELL_KEYS; k++)
    if (!is_key(&cell_keys[k], "cell seed runs") && !same_key(&cell_keys[k], a, b)) return false;
  return true;
}

static bool same_scene(const struct cell *a, const struct cell *b) {
  return strcmp(a->scene_path, b->scene_path) == 0;
}

static bool is_truth(const struct cell *cell) { return cell->runs > 1; }

// The first method of the field that this cell is a run of, or a new one.
static struct method *method_of(struct field *field, const struct cell *cell) {
  int m = 0;
  while (m < field->n_methods && !same_method(field->method[m].cell[0], cell)) m++;
  if (m == field->n_methods) field->n_methods++;
  return &field->method[m];
}

static void add_cells(const struct experiment *experiment, const struct cell *first,
                      struct field *field, struct arena *arena) {
  int n_cells = experiment->n_cells;
  field->method = arena_new(arena, struct method, n_cells);
  for (int c = 0; c < n_cells; c++) {
    const struct cell *cell = &experiment->cell[c];
    if (!same_scene(first, cell) || is_truth(cell)) continue;
    struct method *method = method_of(field, cell);
    if (!method->cell) method->cell = arena_new(arena, const struct cell *, n_cells);
    method->cell[method->n_runs++] = cell;
  }
}

// Keys that differ among the methods of one integrator, with as many digits as a table needs.
static const char *name_of(const struct field *field, const struct cell *cell,
                           struct arena *arena) {
  char *name = arena_format(arena, "%s", cell->integrator->name), text[CELL_KEY_SIZE];
  for (int k = 0; k < CELL_KEYS; k++) {
    bool differs = false;
    for (int m = 0; m < field->n_methods; m++) {
      const struct cell *other = field->method[m].cell[0];
      differs |= other->integrator == cell->integrator && !same_key(&cell_keys[k], other, cell);
    }
    if (differs && !is_key(&cell_keys[k], "cell seed runs iterations"))
      name = arena_format(arena, "%s %s", name, cell_keys[k].text(cell, 3, text));
  }
  return name;
}

// ---- images ----

static char *image_path(const struct results *results, const struct cell *cell, uint64_t n,
                        struct arena *arena) {
  return arena_format(arena, "%s/images/%s-cell%03d-%" PRIu64 ".exr", results->directory,
                      cell->scene, cell->number, n);
}

static bool check_truth(const struct cell *const *cell, int n, const char *scene,
                        struct problem *problem) {
  if (n == 1 && !cell[0]->integrator->photons) return true;
  bool fixed = n == 3;
  for (int k = 0; k < n && fixed; k++)
    fixed = cell[k]->integrator->photons && !strcmp(cell[k]->law->name, "fixed") &&
            cell[k]->radius == cell[0]->radius * (1 << k) &&
            cell[k]->radius_volume == cell[0]->radius_volume * (1 << k) &&
            cell[k]->seed != cell[(k + 1) % 3]->seed; // or their photons were the same
  return fixed || problem_set(problem,
                              "%s: a reference is one cell of several runs without bias, or three "
                              "by photons at fixed radii r, 2 r and 4 r with a seed for each",
                              scene);
}

static bool read_truth(const struct results *results, const struct cell *first, struct field *field,
                       struct arena *arena, struct problem *problem) {
  const struct cell *cell[3] = {NULL};
  struct image image[3];
  struct moment_image at[3];
  int n = 0;
  struct arena scratch = arena_reserve();
  for (int c = 0; c < results->experiment.n_cells; c++) {
    const struct cell *other = &results->experiment.cell[c];
    if (same_scene(first, other) && is_truth(other) && n++ < 3) cell[n - 1] = other;
  }
  bool ok = check_truth(cell, n, first->scene, problem);
  for (int k = 0; ok && k < n; k++) {
    at[k] = (struct moment_image){&image[k], (double)cell[k]->runs,
                                  image_path(results, cell[k], cell[k]->iterations, &scratch)};
    ok = image_read(at[k].name, &scratch, &image[k], problem);
  }
  field->truth = cell[0];
  ok = ok && (n == 1 ? reference_image_unbiased(at, arena, &field->reference, problem)
                     : reference_image_extrapolated(at, arena, &field->reference, problem));
  arena_release(scratch);
  return ok;
}

// Over pixels and colours.
static double image_mean(const struct image *image) {
  long size = (long)image->width * image->height;
  double sum = 0;
  for (int c = 0; c < image->n_channels; c++)
    for (long j = 0; j < size && strlen(image->name[c]) == 1; j++)
      sum += (double)image->plane[c][j];
  return sum / (3.0 * (double)size);
}

static bool read_errors(const struct results *results, const struct field *field,
                        struct method *method, struct arena scratch, struct problem *problem) {
  for (int k = 0; k < method->n_runs; k++)
    for (int j = 0; j < method->n_points; j++) {
      struct arena own = scratch;
      struct image image;
      double value[IMAGE_METRICS];
      const struct cell *cell = method->cell[k];
      char *path = image_path(results, cell, cell->image[j], &own);
      if (!image_read(path, &own, &image, problem) ||
          !image_error(&image, path, &field->reference.image, "the reference", value, problem))
        return false;
      method->error[k * method->n_points + j] = value[IMAGE_RELMSE];
      method->mean[k] = image_mean(&image);
      if (!(value[IMAGE_RELMSE] > 0)) return problem_set(problem, "%s: has no error at all", path);
    }
  return true;
}

// ---- times ----

// The row of this group and N: as a group of one cell and one run has one block.
static bool find_time(const struct csv *csv, int group, uint64_t n, double *time_s) {
  int row_group;
  uint64_t row_n;
  for (const char *at = csv->at; *at; at += strcspn(at, "\n") + 1) {
    if (sscanf(at, "%d,%*[^,],%*[^,],%*[^,],%*[^,],%" SCNu64 ",%*[^,],%*[^,],%*[^,],%lf",
               &row_group, &row_n, time_s) == 3 &&
        row_group == group && row_n == n)
      return true;
  }
  return false;
}

static int group_of(const struct group *group, int n_groups, const struct cell *cell) {
  for (int g = 0; g < n_groups; g++)
    for (int c = 0; c < group[g].n_cells; c++)
      if (group[g].cell[c] == cell->number) return g;
  return -1;
}

static bool read_times(const struct csv *csv, const struct group *group, int n_groups,
                       struct method *method, struct problem *problem) {
  for (int k = 0; k < method->n_runs; k++) {
    const struct cell *cell = method->cell[k];
    int g = group_of(group, n_groups, cell);
    if (group[g].n_cells != 1)
      return problem_set(problem,
                         "cell %d shares its photons with others, so that its time is not its own: "
                         "a seed of its own parts it from them",
                         cell->number);
    for (int j = 0; j < method->n_points; j++)
      if (!find_time(csv, g, cell->image[j], &method->time_s[k * method->n_points + j]))
        return problem_set(problem, "%s: has no time of cell %d after %" PRIu64 " iterations",
                           csv->path, cell->number, cell->image[j]);
    for (int j = 1; j < method->n_points; j++)
      if (!(method->time_s[k * method->n_points + j] >
            method->time_s[k * method->n_points + j - 1]))
        return problem_set(problem,
                           "%s: cell %d took no longer for %" PRIu64 " iterations than for %" PRIu64
                           ": set `images` further apart",
                           csv->path, cell->number, cell->image[j], cell->image[j - 1]);
  }
  return true;
}

// ---- methods ----

// Of x[runs], `step` apart.
static struct pace_error over_runs(const double *x, int runs, int step) {
  struct pace_error at = {0, 0};
  for (int k = 0; k < runs; k++) at.mean += x[k * step] / runs;
  for (int k = 0; k < runs; k++) at.se += (x[k * step] - at.mean) * (x[k * step] - at.mean);
  at.se = sqrt(at.se / (runs - 1) / runs);
  return at;
}

struct pace_error method_point(const struct method *method, int j) {
  return over_runs(method->error + j, method->n_runs, method->n_points);
}

struct pace_error method_mean(const struct field *field, const struct method *method) {
  double mean = image_mean(&field->reference.image);
  struct pace_error at = over_runs(method->mean, method->n_runs, 1);
  return (struct pace_error){at.mean / mean - 1, at.se / mean};
}

double method_time(const struct method *method, int j) {
  double sum = 0;
  for (int k = 0; k < method->n_runs; k++) sum += method->time_s[k * method->n_points + j];
  return sum / method->n_runs;
}

// Points in which the reference's own error has a share, and those after them, do not count.
static void count_points(const struct field *field, struct method *method, struct arena *arena) {
  double least = REFERENCE_MARGIN * (field->reference.noise + field->reference.bias);
  int n = 0, runs = method->n_runs;
  while (n < method->n_points && method_point(method, n).mean >= least) n++;
  double *time_s = arena_new(arena, double, (ptrdiff_t)runs *n),
         *error = arena_new(arena, double, (ptrdiff_t)runs *n);
  for (int k = 0; k < runs; k++)
    for (int j = 0; j < n; j++) {
      time_s[k * n + j] = method->time_s[k * method->n_points + j];
      error[k * n + j] = method->error[k * method->n_points + j];
    }
  method->n_counted = n;
  method->pace = (struct pace){runs, n, time_s, error};
}

static bool read_method(const struct results *results, const struct field *field,
                        const struct csv *csv, const struct group *group, int n_groups,
                        struct method *method, struct arena *arena, struct problem *problem) {
  const struct cell *first = method->cell[0];
  method->name = name_of(field, first, arena);
  method->n_points = first->n_images;
  if (method->n_runs < 2 || method->n_points < 1)
    return problem_set(problem, "%s, %s: at least two seeds and an image are needed", first->scene,
                       method->name);
  for (int k = 1; k < method->n_runs; k++)
    if (method->cell[k]->n_images != first->n_images ||
        memcmp(method->cell[k]->image, first->image, (size_t)first->n_images * sizeof(uint64_t)))
      return problem_set(problem, "%s, %s: runs have different images", first->scene, method->name);
  ptrdiff_t size = (ptrdiff_t)method->n_runs * method->n_points;
  method->time_s = arena_new(arena, double, size);
  method->error = arena_new(arena, double, size);
  method->mean = arena_new(arena, double, method->n_runs);
  if (!read_times(csv, group, n_groups, method, problem) ||
      !read_errors(results, field, method, *arena, problem))
    return false;
  count_points(field, method, arena);
  return true;
}

static double last_common(const struct field *field) {
  struct pace_span span, all = {0, INFINITY};
  for (int m = 0; m < field->n_methods; m++) {
    if (!pace_span(&field->method[m].pace, &span)) return NAN;
    all.from_s = fmax(all.from_s, span.from_s);
    all.to_s = fmin(all.to_s, span.to_s);
  }
  return all.from_s <= all.to_s && isfinite(all.to_s) ? all.to_s : NAN;
}

static bool read_field(const struct results *results, const struct cell *first,
                       const struct csv *csv, const struct group *group, int n_groups,
                       struct field *field, struct arena *arena, struct problem *problem) {
  field->scene = first->scene;
  if (!read_truth(results, first, field, arena, problem)) return false;
  add_cells(&results->experiment, first, field, arena);
  for (int m = 0; m < field->n_methods; m++)
    if (!read_method(results, field, csv, group, n_groups, &field->method[m], arena, problem))
      return false;
  field->last_s = last_common(field);
  return true;
}

bool race_read(const struct results *results, struct arena *arena, struct race *race,
               struct problem *problem) {
  static const char header[] =
      "group,block,scene,integrator,photons,iterations,runs,photon_bytes,wall_s,cpu_s";
  const struct experiment *experiment = &results->experiment;
  int n_groups;
  const struct group *group = experiment_groups(experiment, arena, &n_groups);
  struct csv csv;
  if (!csv_open(&csv, arena_format(arena, "%s/timing.csv", results->directory), header, arena,
                problem))
    return false;
  *race = (struct race){results, 0, arena_new(arena, struct field, experiment->n_cells)};
  for (int c = 0; c < experiment->n_cells; c++) {
    bool known = false;
    for (int k = 0; k < c; k++) known |= same_scene(&experiment->cell[k], &experiment->cell[c]);
    if (!known && !read_field(results, &experiment->cell[c], &csv, group, n_groups,
                              &race->field[race->n_fields++], arena, problem))
      return false;
  }
  return true;
}
