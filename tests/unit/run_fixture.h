// Experiments run into a temporary folder and read back, for the tests of the runner.
#ifndef TESTS_RUN_FIXTURE_H
#define TESTS_RUN_FIXTURE_H

#include "base/file.h"
#include "run/run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-run-XXXXXX"; // of all files of these tests

static inline const char *path_in(const char *name) {
  return arena_format(&arena, "%s/%s", folder, name);
}

static inline void write_text(const char *path, const char *text) {
  struct file_out out;
  struct problem problem = {0};
  if (!file_begin(&out, path, &problem)) fail_msg("%s", problem.text);
  fputs(text, out.stream);
  if (!file_commit(&out, &problem)) fail_msg("%s", problem.text);
}

static inline char *read_text(const char *path) {
  struct text text;
  struct problem problem = {0};
  if (!file_read(path, &arena, &text, &problem)) fail_msg("%s", problem.text);
  return text.data;
}

static inline int remove_entry(const char *path, const struct stat *info, int type,
                               struct FTW *at) {
  (void)info, (void)type, (void)at;
  return remove(path);
}

static inline void remove_references(void) {
  const char *path = path_in("references");
  if (file_exists(path)) nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

// An experiment file NAME.yaml with this text, read.
static inline struct experiment experiment_of(const char *name, const char *yaml) {
  const char *path = path_in(arena_format(&arena, "%s.yaml", name));
  struct experiment experiment;
  struct problem problem = {0};
  write_text(path, yaml);
  if (!experiment_read(path, "default", &arena, &experiment, &problem))
    fail_msg("%s", problem.text);
  return experiment;
}

static const struct run_options quiet = {.threads = 1, .quiet = true};

static inline void run_into(const struct experiment *experiment, const char *directory) {
  struct problem problem = {0};
  enum run_outcome outcome = run_experiment(experiment, directory, quiet, &arena, &problem);
  if (outcome != RUN_DONE) fail_msg("%s", problem.text);
}

static inline struct results results_of(const char *directory) {
  struct results results;
  struct problem problem = {0};
  if (!results_read(directory, &arena, &results, &problem)) fail_msg("%s", problem.text);
  return results;
}

// Runs the experiment into a directory of its name and reads the results back.
static inline struct results run(const char *name, const char *yaml) {
  struct experiment experiment = experiment_of(name, yaml);
  run_into(&experiment, path_in(name));
  return results_of(path_in(name));
}

#define BEAM                                                                                       \
  "scene: scenes/plane-quadratic-beam.pbrt\nradius: 0.5\nphotons: 250\ndepth: 1\n"                 \
  "probes: [[32, 32]]\niterations: 4\nruns: 3\n"
#define BOX "scene: scenes/cornell-box.pbrt\nradius: 0.3\nphotons: 300\niterations: 2\nruns: 2\n"
#define TRACED BEAM "reference: {integrator: path, se: 0.05}\n"

// A disk seen from above and the field of view around it, in degrees.
static inline void write_disk(const char *name, int width, int height, int fov, int radius) {
  write_text(path_in(name),
             arena_format(&arena,
                          "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d\n"
                          "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" %d\n"
                          "WorldBegin\nLightSource \"point\" \"point3 from\" [0 0 2]\n"
                          "Material \"diffuse\"\nShape \"disk\" \"float radius\" %d\n",
                          width, height, fov, radius));
}

// Replaces the first `old` in a file.
static inline void replace_in(const char *path, const char *old, const char *new) {
  char *text = read_text(path), *at = strstr(text, old);
  if (!at) fail_msg("there is no '%s' in %s", old, path);
  *at = 0;
  write_text(path, arena_format(&arena, "%s%s%s", text, new, at + strlen(old)));
}

static inline struct plan plan_of(const struct experiment *experiment) {
  struct plan plan;
  struct problem problem = {0};
  if (!plan_make(experiment, quiet, &arena, &plan, &problem)) fail_msg("%s", problem.text);
  return plan;
}

static inline int make_folder(void **state) {
  (void)state;
  arena = arena_reserve();
  return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state) {
  (void)state;
  arena_release(arena);
  return nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

#endif
