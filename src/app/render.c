// photonlab render: a picture of a scene by one integrator.
#include "run/render.h"
#include "app/cli.h"
#include "base/file.h"
#include "log/cell_json.h"
#include "run/interrupt.h"
#include "walk/media_check.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

// What the scene file says of one key, in the words of an experiment; NULL: nothing. The command
// line comes before it.
static void say(struct cli *file, const struct cli *line, const char *key, const char *text) {
  if (text && !cli_setting_of(line, key) && file->n_settings < CLI_MAX_SETTINGS)
    file->setting[file->n_settings++] = (struct cli_setting){key, key, text};
}

static char *number(struct arena *arena, double value) {
  return isnan(value) ? NULL : arena_format(arena, "%.17g", value);
}

static const char * or (const char *said, const char *fallback) { return said ? said : fallback; }

// The scene file's settings and the command line's, through the same readers.
static bool cell_read(const struct cli *cli, const struct scene *scene, struct cell *cell,
                      struct problem *problem) {
  const struct scene_settings *file = &scene->settings;
  struct arena *arena = cli->arena;
  struct cli said = {.source = scene->path, .arena = arena};
  int64_t photons = file->photons ? file->photons : 65536, seed = file->seed < 0 ? 0 : file->seed;
  int64_t iterations = file->iterations ? file->iterations : file->spp;
  say(&said, cli, "integrator", or (file->integrator, "path"));
  say(&said, cli, "law", file->law);
  say(&said, cli, "kernel", or (file->kernel, "box"));
  say(&said, cli, "alpha", or (number(arena, file->alpha), "2/3"));
  say(&said, cli, "photons", arena_format(arena, "%" PRId64, photons));
  say(&said, cli, "iterations", arena_format(arena, "%" PRId64, iterations));
  say(&said, cli, "seed", arena_format(arena, "%" PRId64, seed));
  say(&said, cli, "direct", or (file->direct, "photons"));
  say(&said, cli, "view", "all");
  say(&said, cli, "depth", arena_format(arena, "%d", file->max_depth));
  say(&said, cli, "hit-points", "1");
  say(&said, cli, "pixel", file->centre ? "centre" : "footprint");
  *cell = (struct cell){.runs = 1,
                        .scene = file_base_name(scene->path, arena),
                        .reference_radius = &reference_radii[0]};
  // The scene's radius is one of scene units, and stands in the way of k.
  bool other_radius = cli_setting_of(cli, "reference-radius") || cli_setting_of(cli, "k");
  if (!other_radius) say(&said, cli, "radius", number(arena, file->radius));
  if (!cli_apply(&said, cell, problem) || !cli_apply(cli, cell, problem)) return false;
  if (!cell->law) cell->law = cell_default_law(cell);
  const char *wrong = cell_settle(cell);
  return !wrong ||
         problem_set(problem, "%s: integrator %s: %s", scene->path, cell->integrator->name, wrong);
}

static bool measure_film(const struct cell *cell, const struct scene *scene, const struct cli *cli,
                         struct measurement *measure, struct problem *problem) {
  if (scene->n_lights == 0)
    return problem_set(problem, "%s: the scene has no light, every pixel would be black",
                       scene->path);
  struct estimator *estimator = arena_new(cli->arena, struct estimator, 1);
  struct bvh *bvh = bvh_build(scene, plan_tree(&cli->options), cli->arena);
  if (!media_check(scene, bvh, *cli->arena, problem)) return false;
  *measure = plan_measurement(cell, scene, bvh, cli->options.skip_off);
  measure->pixel = plan_film(scene, &measure->n_points, cli->arena, problem);
  measure->estimator = estimator;
  measure->n_estimators = 1;
  return measure->pixel && plan_estimator(cell, scene, estimator, problem);
}

// Found out before the picture is computed, not after.
static bool output_can_be_written(const char *path, struct problem *problem) {
  struct file_out out;
  if (!image_can_write(path, problem) || !file_begin(&out, path, problem)) return false;
  file_abandon(&out);
  return true;
}

static int render(struct cli *cli, struct problem *problem) {
  struct scene scene;
  struct cell cell;
  struct scene_options options = {.lenient = cli->options.lenient, .notes = stderr};
  if (!scene_read_with(cli->argument, options, cli->arena, &scene, problem)) return 1;
  const char *output = cli->output ? cli->output : scene.settings.filename;
  if (!output) return problem_set(problem, "say where the picture goes: -o FILE.exr"), 1;
  struct measurement measure;
  if (!cell_read(cli, &scene, &cell, problem) ||
      !measure_film(&cell, &scene, cli, &measure, problem) ||
      !output_can_be_written(output, problem))
    return 1;
  struct image image;
  if (!render_image(cell.integrator, &measure, cell.iterations, cli->options, cli->arena, &image)) {
    fprintf(stderr, "photonlab: interrupted, no picture was written\n");
    return 128 + interrupt_signal();
  }
  char *hash = arena_format(cli->arena, "%016" PRIx64, scene.hash);
  image.manifest = cell_json_line(&cell, "scene_hash", hash, cli->arena);
  if (!image_write(output, &image, problem)) return 1;
  printf("%s\n", output);
  return 0;
}

const struct command command_render = {
    "render", "SCENE", "renders a scene to -o FILE.{exr,pfm,png} (default: the Film's filename)",
    "output integrator spp iterations photons radius radius-volume reference-radius k alpha kernel law direct view "
    "maxdepth pixel hit-points seed "
    "threads quiet no-skip lenient",
    render};
