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
static double resident(const struct bench_scene *scene, const char *integrator, int n) {
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
  struct steps *steps = steps_new(integrator, measure, &arena);
  struct run_options options = {.threads = 1, .quiet = true};
  _exit(!render_image(steps->integrator, &steps->measure, ITERATIONS, options, &arena, &image));
}

static void rows(struct bench *bench) {
  const struct bench_scene *scene = bench_scene(bench, "box");
  for (size_t k = 0; k < sizeof integrators / sizeof integrators[0]; k++) {
    if (!bench_wants(bench, "memory", integrators[k])) continue;
    double more = resident(scene, integrators[k], LARGE) - resident(scene, integrators[k], SMALL);
    bench_add(bench, "memory",
              (struct row){.name = integrators[k],
                           .kind = COUNT,
                           .unit = "B/pixel",
                           .work = more / (LARGE * LARGE - SMALL * SMALL)});
  }
}

const struct part_type part_memory = {
    "memory",
    "most resident in a picture of 1024 x 1024 minus 256 x 256 pixels, over the pixels added", 1,
    rows};
