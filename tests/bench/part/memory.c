#define _DEFAULT_SOURCE // fork
#include "tests/bench/measure.h"

#include "base/problem.h"
#include "run/render.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const char *const integrators[] = {"path", "probabilistic", "sppm"};
enum { SMALL = 256, LARGE = 1024, ITERATIONS = 8 };

static struct pixel *film(struct scene *scene, int n, struct arena *arena) {
  struct pixel *pixel = arena_new(arena, struct pixel, (long)n * n);
  struct camera *camera = &scene->camera;
  camera->width = camera->height = camera->full_width = camera->full_height = n;
  for (int j = 0; j < n * n; j++) pixel[j] = (struct pixel){j % n, j / n};
  return pixel;
}

// `photonlab render` of n x n pixels, in a process of its own: the most it had resident, bytes.
static double resident(const struct bench_scene *scene, const char *integrator, int channels,
                       int n) {
  struct rusage usage;
  pid_t child = fork();
  if (child < 0) die("bench: cannot start a process");
  if (child > 0) {
    int status = 0;
    if (wait4(child, &status, 0, &usage) != child || status) die("bench: a render failed");
    return 1024.0 * (double)usage.ru_maxrss;
  }
  struct arena arena = arena_reserve();
  struct scene own = scene->scene;
  struct measurement measure = measure_of(scene, true);
  struct image image;
  measure.scene = &own;
  measure.pixel = film(&own, n, &arena);
  measure.n_points = n * n;
  measure.features.n_channels = channels;
  const struct integrator_type *type = integrator_find(integrator);
  measure_set_law(&measure, type, &arena);
  struct run_options options = {.threads = 1, .quiet = true};
  _exit(!render_image(type, &measure, ITERATIONS, options, &arena, &image));
}

// The scene is gray; of three channels as a coloured one is.
static void add(struct bench *bench, const char *integrator, int channels) {
  const char *name =
      arena_format(bench->arena, "%s/%s", integrator, channels == 1 ? "gray" : "coloured");
  if (!bench_wants(bench, "memory", name)) return;
  const struct bench_scene *scene = bench_scene(bench, "box");
  double more =
      resident(scene, integrator, channels, LARGE) - resident(scene, integrator, channels, SMALL);
  bench_add(bench, "memory",
            (struct row){.name = name,
                         .kind = COUNT,
                         .unit = "B/pixel",
                         .work = more / (LARGE * LARGE - SMALL * SMALL)});
}

static void rows(struct bench *bench) {
  for (size_t k = 0; k < sizeof integrators / sizeof integrators[0]; k++)
    for (int channels = 1; channels <= 3; channels += 2) add(bench, integrators[k], channels);
}

const struct part_type part_memory = {
    "memory",
    "most resident in a picture of 1024 x 1024 minus 256 x 256 pixels, over the pixels added", 1,
    rows};
