#include "scene/info.h"

#include "scene/skip.h"

#include <inttypes.h>
#include <string.h>

// Longer lists are cut, and say so.
enum { MAX_ROWS = 32 };

static void print_camera(const struct scene *scene, FILE *out) {
  const struct camera *camera = &scene->camera;
  struct ray axis = camera_ray(camera, camera->width / 2.0, camera->height / 2.0, NULL);
  const struct filter *filter = &scene->filter;
  fprintf(out, "camera       %s", camera->type->name);
  if (strcmp(camera->type->name, "perspective") == 0)
    fprintf(out, ", fov %g degrees (shorter axis)", camera->fov);
  if (camera->lens_radius > 0)
    fprintf(out, ", lens of radius %g focused at %g", camera->lens_radius, camera->focal_distance);
  fprintf(out, "%s\n", camera->animation.moves ? ", moves" : "");
  fprintf(out, "  eye        %g %g %g\n", axis.o.x, axis.o.y, axis.o.z);
  fprintf(out, "  towards    %g %g %g\n", axis.d.x, axis.d.y, axis.d.z);
  const char *filename = scene->settings.filename;
  fprintf(out, "film         %d x %d pixels", camera->width, camera->height);
  if (camera->width < camera->full_width || camera->height < camera->full_height)
    fprintf(out, " from (%d, %d) of %d x %d", camera->crop_x, camera->crop_y, camera->full_width,
            camera->full_height);
  if (scene->settings.exposure != 1) fprintf(out, ", exposure %g", scene->settings.exposure);
  fprintf(out, "%s%s\n", filename ? ", " : "", filename ? filename : "");
  fprintf(out, "filter       %s, radius %g x %g\n", filter->type->name, filter->radius[0],
          filter->radius[1]);
}

static void print_name(FILE *out, const char *name, const char *value) {
  if (value) fprintf(out, "  %-10s %s\n", name, value);
}

static void print_number(FILE *out, const char *name, double value) {
  if (!isnan(value)) fprintf(out, "  %-10s %.9g\n", name, value);
}

static void print_count(FILE *out, const char *name, int64_t value, int64_t silent) {
  if (value != silent) fprintf(out, "  %-10s %" PRId64 "\n", name, value);
}

// What the file does not say is not printed: it is up to the command.
static void print_settings(const struct scene_settings *settings, FILE *out) {
  fprintf(out, "settings\n");
  print_name(out, "integrator", settings->integrator);
  print_count(out, "maxdepth", settings->max_depth, -1);
  print_count(out, "samples", settings->spp, -1);
  print_name(out, "pixel", settings->centre ? "centre" : "footprint");
  print_number(out, "radius", settings->radius);
  print_number(out, "alpha", settings->alpha);
  print_count(out, "photons", settings->photons, 0);
  print_count(out, "iterations", settings->iterations, 0);
  print_name(out, "kernel", settings->kernel);
  print_name(out, "law", settings->law);
  print_name(out, "direct", settings->direct);
  print_count(out, "seed", settings->seed, -1);
}

static void print_shapes(const struct scene *scene, FILE *out) {
  fprintf(out, "shapes       %" PRIu32 " with %" PRIu32 " primitives\n", scene->n_shapes,
          scene->n_primitives);
  for (const struct shape_type *const *type = shape_types; *type; type++) {
    uint32_t shapes = 0, primitives = 0;
    for (uint32_t k = 0; k < scene->n_shapes; k++) {
      if (scene->shape[k].type != *type) continue;
      shapes++;
      primitives += scene->shape[k].count;
    }
    if (shapes)
      fprintf(out, "  %-12s %" PRIu32 " with %" PRIu32 " primitives\n", (*type)->name, shapes,
              primitives);
  }
}

static uint32_t count_shapes(const struct scene *scene, bool (*is)(const struct shape *)) {
  uint32_t count = 0;
  for (uint32_t k = 0; k < scene->n_shapes; k++) count += is(&scene->shape[k]);
  return count;
}

static bool has_alpha(const struct shape *shape) { return shape->alpha; }
static bool has_normals(const struct shape *shape) { return shape->normal != ROW_NONE; }

static void print_shape_uses(const struct scene *scene, FILE *out) {
  const struct inventory *inventory = &scene->inventory;
  uint32_t alpha = count_shapes(scene, has_alpha), normals = count_shapes(scene, has_normals);
  if (inventory->n_objects)
    fprintf(out, "  objects      %" PRIu32 ", %" PRIu32 " instances (primitives of their own)\n",
            inventory->n_objects, inventory->n_instances);
  if (alpha) fprintf(out, "  alpha        on %" PRIu32 " shapes\n", alpha);
  if (normals) fprintf(out, "  normals      on %" PRIu32 " shapes\n", normals);
  if (scene->n_motions) fprintf(out, "  moving       %" PRIu32 " shapes\n", scene->n_motions);
}

struct material_use {
  uint32_t shapes, black, coloured, detailed, delta;
};

static struct material_use use_of(const struct scene *scene, const struct material_type *type) {
  struct material_use use = {0};
  for (uint32_t k = 0; k < scene->n_shapes; k++) {
    const struct material *material = &scene->material[scene->shape[k].material];
    if (material->type != type) continue;
    use.shapes++;
    use.black += type->is_black && type->is_black(material);
    use.coloured += !type->is_gray(scene, material);
    use.detailed += (material->needs & MATERIAL_DETAIL) != 0;
    use.delta += (material->needs & MATERIAL_DELTA) != 0;
  }
  return use;
}

static void print_use(FILE *out, uint32_t count, const char *what) {
  if (count) fprintf(out, ", %" PRIu32 " %s", count, what);
}

static void print_materials(const struct scene *scene, FILE *out) {
  fprintf(out, "materials    %" PRIu32 " named\n", scene->inventory.n_named_materials);
  for (const struct material_type *const *type = material_types; *type; type++) {
    struct material_use use = use_of(scene, *type);
    if (!use.shapes) continue;
    fprintf(out, "  %-20s on %" PRIu32 " shapes", (*type)->name, use.shapes);
    print_use(out, use.black, "black");
    print_use(out, use.coloured, "coloured");
    print_use(out, use.detailed, "with textures or directions");
    print_use(out, use.delta, "with delta lobes");
    fprintf(out, "\n");
  }
}

static void print_textures(const struct scene *scene, FILE *out) {
  const struct inventory *inventory = &scene->inventory;
  if (!inventory->n_textures) return;
  fprintf(out, "textures     %" PRIu32 "\n", inventory->n_textures);
  for (int k = 0; texture_types[k]; k++)
    if (inventory->textures[k])
      fprintf(out, "  %-20s %" PRIu32 "\n", texture_types[k]->name, inventory->textures[k]);
}

static void print_light(const struct light *light, FILE *out) {
  const double *power = light->power;
  fprintf(out, "  %-12s power", light->type->name);
  if (light->type->is_gray(light))
    fprintf(out, " %g W", power[0]);
  else
    fprintf(out, " (%g %g %g) W", power[0], power[1], power[2]);
  fprintf(out, ", probability %g%s\n", light->probability, light->type->area ? ", a shape" : "");
}

static void print_lights(const struct scene *scene, FILE *out) {
  fprintf(out, "lights       %" PRIu32 "\n", scene->n_lights);
  for (uint32_t k = 0; k < scene->n_lights && k < MAX_ROWS; k++) print_light(&scene->light[k], out);
  if (scene->n_lights > MAX_ROWS)
    fprintf(out, "  ... and %" PRIu32 " more\n", scene->n_lights - MAX_ROWS);
}

static void print_spectrum(FILE *out, const char *name, const double value[3]) {
  if (value[0] == value[1] && value[1] == value[2])
    fprintf(out, ", %s %g", name, value[0]);
  else
    fprintf(out, ", %s (%g %g %g)", name, value[0], value[1], value[2]);
}

static void print_medium(const struct scene *scene, uint32_t row, FILE *out) {
  const struct medium *medium = &scene->medium[row];
  uint32_t inside = 0, outside = 0, lights = 0;
  struct medium_point at;
  for (uint32_t k = 0; k < scene->n_shapes; k++) {
    inside += scene->shape[k].inside == row;
    outside += scene->shape[k].outside == row;
  }
  for (uint32_t k = 0; k < scene->n_lights; k++) lights += scene->light[k].medium == row;
  medium->type->peak(medium, &at);
  fprintf(out, "  %-12s %s%s", medium->name, medium->type->name,
          medium->type->uniform ? "" : ", where it is densest");
  print_spectrum(out, "sigma_a", at.sigma_a);
  print_spectrum(out, "sigma_s", at.sigma_s);
  if (at.emission[0] > 0 || at.emission[1] > 0 || at.emission[2] > 0)
    print_spectrum(out, "emits", at.emission);
  fprintf(out, ", g %g\n", medium->g);
  if (medium->type->say) medium->type->say(medium, out);
  fprintf(out,
          "  %-12s inside of %" PRIu32 " and outside of %" PRIu32 " shapes, around %" PRIu32
          " lights%s\n",
          "", inside, outside, lights, scene->camera_medium == row ? " and the camera" : "");
}

static void print_media(const struct scene *scene, FILE *out) {
  if (scene->n_media == 0) return;
  fprintf(out, "media        %" PRIu32 " (lengths in scene units)\n", scene->n_media);
  for (uint32_t k = 0; k < scene->n_media && k < MAX_ROWS; k++) print_medium(scene, k, out);
  if (scene->n_media > MAX_ROWS)
    fprintf(out, "  ... and %" PRIu32 " more\n", scene->n_media - MAX_ROWS);
}

static const char *applies(enum skip bit, const struct scene *scene,
                           const struct features *features) {
  switch (bit) {
  case SKIP_GRAY:
    return features->gray ? "yes" : "no, a spectrum is coloured";
  case SKIP_STATIC_EYE:
    if (features->random_eye) return "no, what a pixel's centre sees is random";
    return scene->settings.centre ? "yes" : "where pixel centres are asked for";
  case SKIP_MEDIA:
    return features->media ? "no, the scene has media" : "yes";
  case SKIP_MOTION:
    return features->motion ? "no, something moves" : "yes";
  case SKIP_TREE:
    if (scene->n_primitives <= SKIP_FEW_PRIMITIVES || scene_is_few_triangles(scene)) return "yes";
    return "no, there are more";
  case SKIP_UNSEEN:
    return "where a few points are measured";
  case SKIP_PROBES:
    return "where no image is asked for";
  case SKIP_LAST:
    return "of paths as long as `depth` allows";
  case SKIP_RUNS:
    return "where an experiment says `until`";
  case SKIP_REFERENCES:
    return "where there is one";
  }
  return "no";
}

static void print_feature(FILE *out, const char *name, bool there, const char *without) {
  fprintf(out, "  %-12s %s%s\n", name, there ? "yes" : "no: ", there ? "" : without);
}

static void print_features(const struct scene *scene, FILE *out) {
  struct features features = scene_features(scene);
  fprintf(out, "features\n");
  print_feature(out, "colour", !features.gray, "one channel is enough");
  print_feature(out, "motion", features.motion, "there is no time");
  print_feature(out, "see-through", features.see_through, "a ray ends where it hits");
  print_feature(out, "background", features.background, "a ray that hits nothing sees nothing");
  print_feature(out, "media", features.media, "a ray goes on until it hits");
  print_feature(out, "random", features.random_materials, "no material is random at a point");
  print_feature(out, "random eye", features.random_eye, "a pixel's centre always sees the same");
  fprintf(out, "skips        (--no-skip=NAME switches one off; no result changes)\n");
  for (int k = 0; k < n_skip_rows; k++)
    fprintf(out, "  %-12s %s: %s\n", skip_rows[k].name, applies(skip_rows[k].bit, scene, &features),
            skip_rows[k].about);
}

void scene_info(const struct scene *scene, FILE *out) {
  const struct box *box = &scene->bounds;
  fprintf(out, "scene        %s\n", scene->path);
  fprintf(out,
          "  hash       %016" PRIx64 " (xxh64 of %" PRIu32 " scene file%s and all they name)\n",
          scene->hash, scene->inventory.n_files, scene->inventory.n_files == 1 ? "" : "s");
  fprintf(out, "  bounds     %g %g %g to %g %g %g\n", (double)box->lo[0], (double)box->lo[1],
          (double)box->lo[2], (double)box->hi[0], (double)box->hi[1], (double)box->hi[2]);
  print_camera(scene, out);
  print_settings(&scene->settings, out);
  print_shapes(scene, out);
  print_shape_uses(scene, out);
  print_materials(scene, out);
  print_textures(scene, out);
  print_lights(scene, out);
  print_media(scene, out);
  print_features(scene, out);
}
