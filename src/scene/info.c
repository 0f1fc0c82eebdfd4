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
  fprintf(out, "%s\n", camera->moves ? ", moves" : "");
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

static void print_materials(const struct scene *scene, FILE *out) {
  fprintf(out, "materials\n");
  for (const struct material_type *const *type = material_types; *type; type++) {
    uint32_t shapes = 0, black = 0, coloured = 0;
    for (uint32_t k = 0; k < scene->n_shapes; k++) {
      const struct material *material = &scene->material[scene->shape[k].material];
      if (material->type != *type) continue;
      shapes++;
      black += material->type->is_black && material->type->is_black(material);
      coloured += !material->type->is_gray(scene, material);
    }
    if (shapes)
      fprintf(out, "  %-12s on %" PRIu32 " shapes: %" PRIu32 " black, %" PRIu32 " coloured\n",
              (*type)->name, shapes, black, coloured);
  }
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

static const char *applies(enum skip bit, const struct scene *scene,
                           const struct features *features) {
  switch (bit) {
  case SKIP_GRAY:
    return features->gray ? "yes" : "no, a spectrum is coloured";
  case SKIP_STATIC_EYE:
    return scene->settings.centre ? "yes" : "where pixel centres are asked for";
  default:
    return "wherever it can";
  }
}

static void print_features(const struct scene *scene, FILE *out) {
  struct features features = scene_features(scene);
  fprintf(out, "features     %s, %d channel%s\n", features.gray ? "gray" : "coloured",
          features.n_channels, features.n_channels == 1 ? "" : "s");
  fprintf(out, "skips        (--no-skip=NAME switches one off; no result changes)\n");
  for (int k = 0; k < n_skip_rows; k++)
    fprintf(out, "  %-12s %s: %s\n", skip_rows[k].name, applies(skip_rows[k].bit, scene, &features),
            skip_rows[k].about);
}

void scene_info(const struct scene *scene, FILE *out) {
  const struct box *box = &scene->bounds;
  fprintf(out, "scene        %s\n", scene->path);
  fprintf(out, "  hash       %016" PRIx64 " (xxh64)\n", scene->hash);
  fprintf(out, "  bounds     %g %g %g to %g %g %g\n", (double)box->lo[0], (double)box->lo[1],
          (double)box->lo[2], (double)box->hi[0], (double)box->hi[1], (double)box->hi[2]);
  print_camera(scene, out);
  print_settings(&scene->settings, out);
  print_shapes(scene, out);
  print_materials(scene, out);
  print_lights(scene, out);
  print_features(scene, out);
}
