#include "run/output.h"

#include "base/file.h"
#include "base/version.h"
#include "log/cell_json.h"
#include "log/log.h"
#include "log/runs.h"
#include "run/block.h"
#include "run/discs.h"
#include "run/picture.h"
#include "run/runs.h"
#include "run/series.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <string.h>
#include <xxhash.h>

static char *path_of(const char *directory, const char *name, struct arena *arena) {
  return arena_format(arena, "%s/%s", directory, name);
}

// The fingerprint in the directory's manifest, or an empty string.
static const char *manifest_fingerprint(const char *directory, struct arena *arena) {
  json_error_t error;
  json_t *root = json_load_file(path_of(directory, "manifest.json", arena), 0, &error);
  const char *text = json_string_value(json_object_get(root, "fingerprint"));
  char *copy = arena_string(arena, text ? text : "", text ? (ptrdiff_t)strlen(text) : 0);
  json_decref(root);
  return copy;
}

static char *fingerprint_text(const struct plan *plan, struct arena *arena) {
  return arena_format(arena, "%016" PRIx64, plan->fingerprint);
}

// Fields of a CSV file are not quoted, and JSON is UTF-8.
static bool check_name(const char *name, struct problem *problem) {
  json_t *text = json_string(name);
  bool plain = text && !strpbrk(name, ",\"\\\n\r");
  json_decref(text);
  return plain ||
         problem_set(problem,
                     "\"%s\" cannot be the name of an experiment or a scene: outputs have no "
                     "place for commas, quotes, backslashes and what is not UTF-8",
                     name);
}

bool output_check_names(const struct plan *plan, struct problem *problem) {
  for (int c = 0; c < plan->experiment->n_cells; c++)
    if (!check_name(plan->experiment->cell[c].scene, problem)) return false;
  return check_name(plan->experiment->name, problem);
}

bool output_is_complete(const struct plan *plan, const char *directory, struct arena scratch) {
  return strcmp(manifest_fingerprint(directory, &scratch), fingerprint_text(plan, &scratch)) == 0 &&
         file_exists(path_of(directory, "log.csv", &scratch)) &&
         file_exists(path_of(directory, "probes.csv", &scratch)) &&
         (!runs_are_kept(plan->experiment) ||
          file_exists(path_of(directory, "runs.csv", &scratch)));
}

bool output_set_aside(const struct plan *plan, const char *directory, struct arena scratch,
                      struct problem *problem) {
  if (!file_exists(path_of(directory, "manifest.json", &scratch))) return true;
  int k = 1;
  while (file_exists(arena_format(&scratch, "%s.%d", directory, k))) k++;
  char *aside = arena_format(&scratch, "%s.%d", directory, k);
  if (rename(directory, aside) != 0)
    return problem_set(problem, "%s: holds other results and cannot be renamed to %s: %s",
                       directory, aside, strerror(errno));
  if (!plan->options.quiet)
    fprintf(stderr, "photonlab: %s held other results; they are now in %s\n", directory, aside);
  if (!file_make_directory(directory, problem)) return false;
  rename(path_of(aside, "blocks", &scratch), path_of(directory, "blocks", &scratch));
  return true;
}

// ---- log.csv and images ----

static void write_group_log(FILE *out, const struct outputs *outputs,
                            const struct group_plan *group, struct moments *moments) {
  for (int e = 0; e < group->group->n_cells; e++)
    for (int p = 0; p < group->n_probes; p++) {
      struct series series = series_of(group, e, p, moments);
      log_write_series(out, &outputs->plan->experiment->cell[series.cell],
                       &outputs->probe[series.cell][p], &series);
    }
}

// images/SCENE-cellCCC-N.exr: mean over runs of the running average after N iterations, and its
// variance over runs; SCENE-cellCCC-single-I.exr: the same of iteration I alone.
static bool write_images(const struct outputs *outputs, const struct group_plan *group,
                         const struct moments *moments, struct arena scratch,
                         struct problem *problem) {
  if (!group->n_images) return true;
  char *folder = path_of(outputs->directory, "images", &scratch);
  if (!file_make_directory(folder, problem)) return false;
  for (int e = 0; e < group->group->n_cells; e++)
    for (int m = 0; m < group->n_images; m++) {
      struct arena own = scratch;
      const struct cell *cell = &outputs->plan->experiment->cell[group->group->cell[e]];
      bool single = m >= cell->n_images;
      uint64_t i = single ? cell->single[m - cell->n_images] : cell->image[m];
      struct image image = picture_of(&group->measure, moments + plan_image(group, e, m), &own);
      char *n = arena_format(&own, "%" PRIu64, i);
      image.manifest = cell_json_line(cell, single ? "iteration" : "average_of", n, &own);
      char *path = arena_format(&own, "%s/%s-cell%03d-%s%s.exr", folder, cell->scene, cell->number,
                                single ? "single-" : "", n);
      if (!image_write(path, &image, problem)) return false;
    }
  return true;
}

// Rows go by group (in the order of their first cells), within it by cell.
static bool write_logs(const struct outputs *outputs, struct arena scratch,
                       struct problem *problem) {
  const struct plan *plan = outputs->plan;
  struct file_out log;
  if (!file_begin(&log, path_of(outputs->directory, "log.csv", &scratch), problem)) return false;
  log_write_header(log.stream);
  for (int g = 0; g < plan->n_groups; g++) {
    const struct group_plan *group = &plan->group[g];
    struct arena own = scratch;
    struct moments *moments = arena_new(&own, struct moments, group->width);
    block_merge(group, block_folder(plan, outputs->directory, &own), moments, own);
    write_group_log(log.stream, outputs, group, moments);
    if (!write_images(outputs, group, moments, own, problem) ||
        !discs_write(group, plan->experiment, outputs->directory, own, problem)) {
      file_abandon(&log);
      return false;
    }
  }
  return file_commit(&log, problem);
}

static bool write_probes(const struct outputs *outputs, struct arena scratch,
                         struct problem *problem) {
  struct file_out out;
  if (!file_begin(&out, path_of(outputs->directory, "probes.csv", &scratch), problem)) return false;
  fprintf(out.stream, "%s\n", probes_header);
  for (int g = 0; g < outputs->plan->n_groups; g++) {
    const struct group_plan *group = &outputs->plan->group[g];
    for (int e = 0; e < group->group->n_cells; e++) {
      int c = group->group->cell[e];
      probes_write(out.stream, &outputs->plan->experiment->cell[c], outputs->probe[c],
                   group->n_probes);
    }
  }
  return file_commit(&out, problem);
}

// A row for each iteration whose average is kept as an image, and the last: what all runs of the
// block took until then.
static void write_times(FILE *out, const struct group_plan *group, uint64_t block,
                        const struct block_time *time) {
  const struct cell *cell = group->cell;
  for (int t = 0; time && t < group->n_times; t++)
    fprintf(out, "%d,%" PRIu64 ",%s,%s,%" PRIu64 ",%" PRIu64 ",%d,%" PRId64 ",%.6f,%.6f\n",
            group->number, block, cell->scene, cell->integrator->name, cell->photons,
            plan_time_at(group, t), block_runs(group, block), time[t].photon_bytes, time[t].wall_s,
            time[t].cpu_s);
}

static bool write_timing(const struct outputs *outputs, struct arena scratch,
                         struct problem *problem) {
  struct file_out out;
  if (!file_begin(&out, path_of(outputs->directory, "timing.csv", &scratch), problem)) return false;
  fputs("group,block,scene,integrator,photons,iterations,runs,photon_bytes,wall_s,cpu_s\n",
        out.stream);
  const char *folder = block_folder(outputs->plan, outputs->directory, &scratch);
  for (int g = 0; g < outputs->plan->n_groups; g++) {
    const struct group_plan *group = &outputs->plan->group[g];
    for (uint64_t b = 0; b < group->n_blocks; b++) {
      struct arena own = scratch;
      write_times(out.stream, group, b, block_times(group, b, folder, &own));
    }
  }
  return file_commit(&out, problem);
}

static bool write_experiment(const struct outputs *outputs, struct arena scratch,
                             struct problem *problem) {
  const struct experiment *experiment = outputs->plan->experiment;
  struct file_out out;
  char *name = arena_format(&scratch, "%s/%s.yaml", outputs->directory, experiment->name);
  if (!file_begin(&out, name, problem)) return false;
  fwrite(experiment->text.data, 1, (size_t)experiment->text.length, out.stream);
  return file_commit(&out, problem);
}

// ---- manifest.json ----

static char *cpu_name(struct arena *arena) {
  struct text text;
  struct problem ignored = {0};
  if (!file_read("/proc/cpuinfo", arena, &text, &ignored)) return "unknown";
  char *at = strstr(text.data, "model name");
  at = at ? strchr(at, ':') : NULL;
  if (!at) return "unknown";
  at += 1 + strspn(at + 1, " \t");
  return arena_string(arena, at, (ptrdiff_t)strcspn(at, "\n"));
}

static json_t *hex(uint64_t value) {
  char text[17];
  snprintf(text, sizeof text, "%016" PRIx64, value);
  return json_string(text);
}

static int looks_at(const struct plan *plan, int cell) {
  for (int g = 0; g < plan->n_groups; g++)
    for (int c = 0; c < plan->group[g].group->n_cells; c++)
      if (plan->group[g].group->cell[c] == cell) return plan->group[g].looks;
  return 1;
}

static json_t *manifest_cell(const struct plan *plan, const struct cell *cell) {
  uint64_t hash = 0;
  for (int s = 0; s < plan->n_scenes; s++)
    if (strcmp(plan->scene[s].path, cell->scene_path) == 0) hash = plan->scene[s].scene.hash;
  json_t *out = json_object();
  cell_json_set(out, cell);
  json_object_set_new(out, "scene_path", json_string(cell->scene_path));
  json_object_set_new(out, "scene_hash", hex(hash));
  json_object_set_new(out, "reference", json_string(cell->reference_integrator));
  json_object_set_new(out, "looks", json_integer(looks_at(plan, cell->number)));
  return out;
}

// Of a file that was just written: what is read back must be it.
static bool set_hash(json_t *root, const char *key, const char *directory, const char *file,
                     struct arena scratch, struct problem *problem) {
  struct text text;
  if (!file_read(path_of(directory, file, &scratch), &scratch, &text, problem)) return false;
  json_object_set_new(root, key, hex(XXH64(text.data, (size_t)text.length, 0)));
  return true;
}

static bool write_manifest(const struct outputs *outputs, struct arena scratch,
                           struct problem *problem) {
  const struct plan *plan = outputs->plan;
  json_t *root = json_object(), *cells = json_array();
  json_object_set_new(root, "experiment", json_string(plan->experiment->name));
  json_object_set_new(root, "title", json_string(plan->experiment->title));
  json_object_set_new(root, "quality", json_string(plan->experiment->quality));
  json_object_set_new(root, "fingerprint", json_string(fingerprint_text(plan, &scratch)));
  json_object_set_new(root, "commit", json_string(photonlab_version));
  json_object_set_new(root, "compiler", json_string(photonlab_compiler));
  json_object_set_new(root, "flags", json_string(photonlab_flags));
  json_object_set_new(root, "cpu", json_string(cpu_name(&scratch)));
  if (!set_hash(root, "experiment_hash", outputs->directory,
                arena_format(&scratch, "%s.yaml", plan->experiment->name), scratch, problem) ||
      !set_hash(root, "log_hash", outputs->directory, "log.csv", scratch, problem) ||
      !set_hash(root, "probes_hash", outputs->directory, "probes.csv", scratch, problem) ||
      (runs_are_kept(plan->experiment) &&
       !set_hash(root, "runs_hash", outputs->directory, "runs.csv", scratch, problem))) {
    json_decref(root);
    json_decref(cells);
    return false;
  }
  for (int c = 0; c < plan->experiment->n_cells; c++)
    json_array_append_new(cells, manifest_cell(plan, &plan->experiment->cell[c]));
  json_object_set_new(root, "cells", cells);
  struct file_out out;
  bool ok = file_begin(&out, path_of(outputs->directory, "manifest.json", &scratch), problem);
  if (ok) {
    json_dumpf(root, out.stream, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    fputc('\n', out.stream);
    ok = file_commit(&out, problem);
  }
  json_decref(root);
  return ok;
}

bool output_write(const struct outputs *outputs, struct arena scratch, struct problem *problem) {
  if (!write_experiment(outputs, scratch, problem) || !write_probes(outputs, scratch, problem) ||
      !write_logs(outputs, scratch, problem) ||
      !runs_collect(outputs->plan, outputs->directory, scratch, problem) ||
      !write_timing(outputs, scratch, problem) || !write_manifest(outputs, scratch, problem))
    return false;
  if (!block_remove_all(outputs->plan, outputs->directory, scratch) &&
      !outputs->plan->options.quiet)
    fprintf(stderr, "photonlab: %s/blocks keeps what another experiment or version began\n",
            outputs->directory);
  return true;
}
