#include "run/plan.h"

#include "base/file.h"
#include "base/threads.h"
#include "base/version.h"
#include "density/grid.h"
#include "numeric/elementary.h"
#include "run/look.h"
#include "run/resolved.h"
#include "walk/eye.h"
#include "walk/media_check.h"

#include <inttypes.h>
#include <limits.h>
#include <string.h>
#include <xxhash.h>

int plan_threads(const struct run_options *options) {
  return options->threads ? options->threads : threads_available();
}

struct bvh_options plan_tree(const struct run_options *options) {
  return (struct bvh_options){.tree = options->skip_off & SKIP_TREE,
                              .threads = plan_threads(options)};
}

uint64_t *plan_checkpoints(uint64_t iterations, int *count, struct arena *arena) {
  struct {
    uint64_t *item;
    ptrdiff_t count, capacity;
  } list = {0};
  uint64_t last = 0;
  for (int j = 0; last < iterations; j++) {
    uint64_t n = (uint64_t)floor(num_pow(10, j / 10.0) + 0.5);
    n = n < iterations ? n : iterations;
    if (n == last) continue;
    *arena_push(arena, &list) = last = n;
  }
  *count = (int)list.count;
  return list.item;
}

static const struct loaded_scene *load(struct plan *plan, const char *path, struct arena *arena,
                                       struct problem *problem) {
  for (int s = 0; s < plan->n_scenes; s++)
    if (strcmp(plan->scene[s].path, path) == 0) return &plan->scene[s];
  struct loaded_scene *loaded = &plan->scene[plan->n_scenes];
  loaded->path = path;
  struct scene_options options = {.lenient = plan->options.lenient, .notes = stderr};
  if (!scene_read_with(path, options, arena, &loaded->scene, problem)) return NULL;
  loaded->bvh = bvh_build(&loaded->scene, plan_tree(&plan->options), arena);
  if (!media_check(&loaded->scene, loaded->bvh, *arena, problem)) return NULL;
  plan->n_scenes++;
  return loaded;
}

struct measurement plan_measurement(const struct cell *cell, const struct scene *scene,
                                    const struct bvh *bvh, unsigned skip_off) {
  struct measurement measure = {.scene = scene,
                                .bvh = bvh,
                                .features = scene_features(scene),
                                .n_replicas = 1,
                                .hit_points = (int)cell->hit_points,
                                .footprint = cell->footprint,
                                .nee = cell->direct == DIRECT_NEE,
                                .left_out = cell->left_out,
                                .depth = cell->depth,
                                .n_emitted = cell->photons,
                                .seed = cell->seed,
                                .skip_off = skip_off};
  if (skip_off & SKIP_GRAY) measure.features.n_channels = 3;
  if (skip_off & SKIP_MEDIA) measure.features.media = true;
  if (skip_off & SKIP_MOTION) measure.features.motion = true;
  return measure;
}

struct pixel *plan_film(const struct scene *scene, int *n_points, struct arena *arena,
                        struct problem *problem) {
  int width = scene->camera.width, height = scene->camera.height;
  if (height > INT_MAX / width) {
    problem_set(problem, "%s: a film of %d x %d pixels is too large to be computed as a whole",
                scene->path, width, height);
    return NULL;
  }
  *n_points = width * height;
  struct pixel *pixel = arena_new(arena, struct pixel, *n_points);
  for (int j = 0; j < *n_points; j++) pixel[j] = (struct pixel){j % width, j / width};
  return pixel;
}

// Emitted in one iteration; each stores several, of about a hundred bytes with their place in the
// grid.
enum { MOST_PHOTONS = 1 << 26 };

// What a law and an integrator ask of each other and of the scene.
static bool check_law(const struct cell *cell, struct problem *problem) {
  const struct law *law = cell->law;
  if (law->count && cell->integrator->independent)
    return problem_set(problem,
                       "law %s follows the photons found by the iterations before, but those of "
                       "integrator %s are independent: take ppm or sppm, or law knaus-zwicker",
                       law->name, cell->integrator->name);
  if (law->rho(cell->alpha, 2) == 0)
    return problem_set(problem, "law %s at alpha = %g: the second radius is zero", law->name,
                       cell->alpha);
  return true;
}

static bool check_points(const struct cell *cell, const struct scene *scene,
                         struct problem *problem) {
  if (!cell->integrator->one_eye_pass) return true;
  uint64_t pixels = (uint64_t)scene->camera.width * (uint64_t)scene->camera.height;
  if (cell->hit_points > INT_MAX / pixels)
    return problem_set(problem, "hit-points: %" PRIu64 " in each of %d x %d pixels are too many",
                       cell->hit_points, scene->camera.width, scene->camera.height);
  if (!scene_features(scene).motion) return true;
  return problem_set(problem,
                     "%s: something moves, but integrator %s draws its points once, and photons of "
                     "other times do not belong to them: take sppm or probabilistic",
                     scene->path, cell->integrator->name);
}

static const struct medium *glowing_medium(const struct scene *scene) {
  for (uint32_t k = 0; k < scene->n_media; k++) {
    struct medium_point most;
    if (!scene_uses_medium(scene, k)) continue;
    scene->medium[k].type->peak(&scene->medium[k], &most);
    if (most.emission[0] > 0 || most.emission[1] > 0 || most.emission[2] > 0)
      return &scene->medium[k];
  }
  return NULL;
}

// Photons start at lights, so nothing would scatter what a medium emits. In a volume a point's own
// radius would be that of a ball, which nothing here finds.
static bool check_media(const struct cell *cell, const struct scene *scene,
                        struct problem *problem) {
  bool media = scene_features(scene).media;
  const struct medium *glowing = cell->depth > 0 ? glowing_medium(scene) : NULL;
  if (glowing)
    return problem_set(problem,
                       "%s: medium \"%s\" emits light, but photons start at lights only: take "
                       "integrator path (or depth 0: what is emitted, not scattered)",
                       scene->path, glowing->name);
  if (cell->radius_volume > 0 && !media)
    return problem_set(problem, "%s: radius-volume: the scene has no participating media",
                       scene->path);
  if ((cell->reference_radius->global && !cell->k) || !media) return true;
  return problem_set(problem,
                     "%s: the scene has participating media, and %s finds radii on surfaces only: "
                     "say `radius`",
                     scene->path,
                     cell->k ? "`k` (the nearest photons)" : cell->reference_radius->name);
}

static bool check_radius(const struct cell *cell, const struct scene *scene, double r1, int d,
                         struct problem *problem) {
  if ((d == 3 ? r1 * r1 * r1 : r1 * r1) == INFINITY)
    return problem_set(problem, "radius %g is too large: its %s is not a number any more", r1,
                       d == 3 ? "cube" : "square");
  double last = law_radius(cell->law, cell->alpha, r1, d, cell->iterations);
  return grid_radius_is_resolved(scene->bounds, last, problem);
}

bool plan_estimator(const struct cell *cell, const struct scene *scene, struct estimator *estimator,
                    struct problem *problem) {
  *estimator = (struct estimator){.kernel = cell->kernel,
                                  .law = cell->law,
                                  .alpha = cell->alpha,
                                  .r1 = cell->radius,
                                  .r1_volume = cell->radius_volume,
                                  .reference = cell->reference_radius,
                                  .k = cell->k};
  if (cell->integrator->accepts && !cell->integrator->accepts(scene, cell->footprint, problem))
    return false;
  if (!cell->integrator->photons) return true;
  if (!check_law(cell, problem) || !check_points(cell, scene, problem) ||
      !check_media(cell, scene, problem))
    return false;
  if (cell->photons > MOST_PHOTONS)
    return problem_set(problem,
                       "photons: %" PRIu64 " at once do not fit into memory; more iterations of "
                       "fewer photons say the same",
                       cell->photons);
  if (!cell_radius_is_known(cell)) return true; // it is found when the points are
  int d = scene_features(scene).media ? cell->integrator->volume_dimension : 0;
  return check_radius(cell, scene, cell->radius, 2, problem) &&
         (!d || check_radius(cell, scene, estimator_r1(estimator, IN_VOLUME), d, problem));
}

// The default probes: the centres of a 3x3 partition of the film.
static struct pixel *probe_grid(const struct camera *camera, struct arena *arena) {
  struct pixel *probe = arena_new(arena, struct pixel, 9);
  for (int k = 0; k < 9; k++)
    probe[k] = (struct pixel){camera->width * (2 * (k % 3) + 1) / 6,
                              camera->height * (2 * (k / 3) + 1) / 6};
  return probe;
}

static bool plan_pixels(struct group_plan *plan, struct arena *arena, struct problem *problem) {
  const struct camera *camera = &plan->loaded->scene.camera;
  const struct cell *cell = plan->cell;
  if (!cell->n_probes && (camera->width < 3 || camera->height < 3))
    return problem_set(problem,
                       "%s: a film of %d x %d pixels has no nine default probes, say `probes`",
                       cell->scene_path, camera->width, camera->height);
  plan->n_probes = cell->n_probes ? cell->n_probes : 9;
  plan->probe_pixel = cell->n_probes ? cell->probe : probe_grid(camera, arena);
  for (int p = 0; p < plan->n_probes; p++) {
    struct pixel at = plan->probe_pixel[p];
    if (at.x < 0 || at.y < 0 || at.x >= camera->width || at.y >= camera->height)
      return problem_set(problem, "%s: probe [%d, %d] lies outside the film of %d x %d pixels",
                         cell->scene_path, at.x, at.y, camera->width, camera->height);
  }
  plan->probe_point = arena_new(arena, int, plan->n_probes);
  struct measurement *measure = &plan->measure;
  bool film = plan->n_images > 0 || plan->cell->n_discs > 0 || (measure->skip_off & SKIP_PROBES);
  measure->n_points = plan->n_probes;
  measure->pixel = film ? plan_film(&plan->loaded->scene, &measure->n_points, arena, problem)
                        : plan->probe_pixel;
  if (!measure->pixel) return false;
  for (int p = 0; p < plan->n_probes; p++)
    plan->probe_point[p] =
        film ? plan->probe_pixel[p].y * camera->width + plan->probe_pixel[p].x : p;
  return true;
}

static bool check_probes_hit(const struct group_plan *plan, struct arena scratch,
                             struct problem *problem) {
  struct probe *probe = arena_new(&scratch, struct probe, plan->n_probes);
  plan_probes(plan, probe, scratch);
  for (int p = 0; p < plan->n_probes; p++)
    if (!probe[p].hit && !probe[p].volume)
      return problem_set(problem, "%s: %s [%d, %d] sees no surface%s, choose pixels that do",
                         plan->cell->scene_path, plan->cell->n_probes ? "probe" : "default probe",
                         probe[p].x, probe[p].y,
                         plan->measure.features.media ? " and no medium" : "");
  return true;
}

static bool plan_estimators(struct group_plan *plan, const struct experiment *experiment,
                            struct arena *arena, struct problem *problem) {
  struct measurement *measure = &plan->measure;
  int n_cells = plan->group->n_cells, n = n_cells;
  struct estimator *estimator = arena_new(arena, struct estimator, 2 * (ptrdiff_t)n_cells);
  plan->companion = arena_new(arena, int, n_cells);
  for (int e = 0; e < n_cells; e++) {
    struct cell cell = experiment->cell[plan->group->cell[e]];
    if (!plan_estimator(&cell, &plan->loaded->scene, &estimator[e], problem)) return false;
    if (!cell_has_companion(&cell)) continue;
    cell.radius *= 0.5;
    cell.radius_volume *= 0.5;
    plan->companion[e] = n;
    if (!plan_estimator(&cell, &plan->loaded->scene, &estimator[n++], problem)) return false;
  }
  measure->estimator = estimator;
  measure->n_estimators = n;
  return true;
}

// Where the parts of a series begin, and how long it is.
static void plan_series_layout(struct group_plan *plan) {
  long n = (long)plan->cell->iterations;
  plan->average_at = n;
  plan->series_width = n + plan->n_checkpoints;
  if (plan->cell->integrator->local) {
    plan->radius_at = plan->series_width;
    plan->series_width += n;
  }
  if (plan->measure.n_estimators > plan->group->n_cells) {
    plan->richardson_at = plan->series_width;
    plan->series_width += n;
  }
}

long plan_kept(const struct group_plan *plan, int cell, int probe) {
  int series = plan->richardson_at ? 2 : 1;
  return ((long)cell * plan->n_probes + probe) * series * plan->n_checkpoints;
}

static void plan_layout(struct group_plan *plan, struct arena *arena) {
  const struct measurement *measure = &plan->measure;
  const struct cell *cell = plan->cell;
  plan->checkpoint = plan_checkpoints(cell->iterations, &plan->n_checkpoints, arena);
  plan_series_layout(plan);
  long image = (long)measure->n_points * measure->features.n_channels;
  plan->width =
      plan->group->n_cells * (plan->n_probes * plan->series_width + plan->n_images * image);
  if (cell->keeps_runs) plan->kept_width = plan_kept(plan, plan->group->n_cells, 0);
  bool last = cell->n_images && cell->image[cell->n_images - 1] == cell->iterations;
  plan->n_times = cell->n_images + !last;
}

long plan_series(const struct group_plan *plan, int cell, int probe) {
  return ((long)cell * plan->n_probes + probe) * plan->series_width;
}

long plan_image(const struct group_plan *plan, int cell, int image) {
  long size = (long)plan->measure.n_points * plan->measure.features.n_channels;
  return plan_series(plan, plan->group->n_cells, 0) + ((long)cell * plan->n_images + image) * size;
}

uint64_t plan_time_at(const struct group_plan *plan, int t) {
  return t < plan->cell->n_images ? plan->cell->image[t] : plan->cell->iterations;
}

static bool plan_group(struct plan *plan, const struct group *group, struct group_plan *out,
                       struct arena *arena, struct problem *problem) {
  const struct cell *cell = &plan->experiment->cell[group->cell[0]];
  out->group = group;
  out->cell = cell;
  out->loaded = load(plan, cell->scene_path, arena, problem);
  if (!out->loaded) return false;
  const struct scene *scene = &out->loaded->scene;
  if (scene->n_lights == 0)
    return problem_set(problem, "%s: the scene has no light, there is nothing to measure",
                       cell->scene_path);
  out->n_images = cell->n_images + cell->n_singles;
  out->measure = plan_measurement(cell, scene, out->loaded->bvh, plan->options.skip_off);
  if (!plan_pixels(out, arena, problem) || !check_probes_hit(out, *arena, problem)) return false;
  if (!plan_estimators(out, plan->experiment, arena, problem)) return false;
  if (!resolved_at_probes(out, *arena, problem)) return false;
  plan_layout(out, arena);
  return true;
}

// The commit, which stands for the program whatever compiled it, so that machines can share work. A
// program of changed or unknown source is told apart by its bytes.
static void hash_program(XXH64_state_t *state, struct arena scratch) {
  const char *dirty = strstr(photonlab_version, "-dirty");
  struct text program;
  struct problem ignored = {0};
  XXH64_update(state, photonlab_version, strlen(photonlab_version));
  if (!dirty && strcmp(photonlab_version, "unknown") != 0) return;
  if (file_read("/proc/self/exe", &scratch, &program, &ignored))
    XXH64_update(state, program.data, (size_t)program.length);
}

// Everything that may change a number: the experiment's text, quality and seeds, the scenes, and
// the program. What is skipped changes none, but it does change the images' channels, and how many
// runs are made.
static void plan_fingerprint(struct plan *plan, struct arena scratch) {
  XXH64_state_t *state = XXH64_createState();
  XXH64_reset(state, 0);
  XXH64_update(state, plan->experiment->text.data, (size_t)plan->experiment->text.length);
  XXH64_update(state, plan->experiment->quality, strlen(plan->experiment->quality));
  hash_program(state, scratch);
  for (int s = 0; s < plan->n_scenes; s++)
    XXH64_update(state, &plan->scene[s].scene.hash, sizeof plan->scene[s].scene.hash);
  for (int c = 0; c < plan->experiment->n_cells; c++)
    XXH64_update(state, &plan->experiment->cell[c].seed, sizeof(uint64_t));
  for (int g = 0; g < plan->n_groups; g++)
    XXH64_update(state, &plan->group[g].width, sizeof plan->group[g].width);
  if (plan->options.skip_off & SKIP_RUNS) XXH64_update(state, "runs", 4);
  plan->fingerprint = XXH64_digest(state);
  XXH64_freeState(state);
  for (int g = 0; g < plan->n_groups; g++)
    plan->group[g].fingerprint = plan->fingerprint + (uint64_t)g;
}

bool plan_make(const struct experiment *experiment, struct run_options options, struct arena *arena,
               struct plan *plan, struct problem *problem) {
  *plan = (struct plan){.experiment = experiment, .options = options};
  struct group *group = experiment_groups(experiment, arena, &plan->n_groups);
  plan->scene = arena_new(arena, struct loaded_scene, experiment->n_cells);
  plan->group = arena_new(arena, struct group_plan, plan->n_groups);
  for (int g = 0; g < plan->n_groups; g++) {
    plan->group[g].number = g;
    if (!plan_group(plan, &group[g], &plan->group[g], arena, problem)) return false;
  }
  plan_fingerprint(plan, *arena);
  look_begin(plan);
  return true;
}
