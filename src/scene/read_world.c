// Directives after WorldBegin: shapes, materials, lights.
#include "pbrt/suggest.h"
#include "scene/build.h"
#include "scene/reader.h"

#include <string.h>

enum { MAX_NAMES = 64 };

// `"name" is unknown; did you mean ..., or: known are ...`
static bool unknown_type(struct reader *reader, const struct call *call, const char *const *names,
                         int n) {
  char list[256] = "";
  size_t used = 0;
  for (int i = 0; i < n && used < sizeof list; i++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
  const char *nearest = suggest_name(call->type, names, n);
  return problem_at(reader->problem, call->type_place,
                    "%s \"%s\" is not in this version%s%s%s (known: %s)", call->name, call->type,
                    nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                    nearest ? "\"?" : "", list);
}

static const struct shape_type *find_shape(struct reader *reader, const struct call *call) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (const struct shape_type *const *type = shape_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  unknown_type(reader, call, names, n);
  return NULL;
}

// Materials of pbrt-v4 that this version has not, and those of pbrt-v3: what comes nearest.
static const char *const other_materials[][2] = {
    {"hair", "conductor"},
    {"measured", "conductor"},
    {"subsurface", "coateddiffuse"},
    {"principled", "coateddiffuse"},
    {"disney", "coateddiffuse"},
    {"glass", "dielectric"},
    {"matte", "diffuse"},
    {"metal", "conductor"},
    {"mirror", "conductor"},
    {"plastic", "coateddiffuse"},
    {"substrate", "coateddiffuse"},
    {"translucent", "diffusetransmission"},
    {"uber", "coateddiffuse"},
};

static const struct material_type *find_material(struct reader *reader, const struct call *call) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (size_t i = 0; i < sizeof other_materials / sizeof *other_materials; i++)
    if (strcmp(other_materials[i][0], call->type) == 0) {
      problem_at(reader->problem, call->type_place,
                 "Material \"%s\" is not in this version; \"%s\" comes nearest", call->type,
                 other_materials[i][1]);
      return NULL;
    }
  for (const struct material_type *const *type = material_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  unknown_type(reader, call, names, n);
  return NULL;
}

static const struct light_type *find_light(struct reader *reader, const struct call *call,
                                           bool area) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (const struct light_type *const *type = light_types; *type && n < MAX_NAMES; type++) {
    if ((*type)->area != area) continue;
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  unknown_type(reader, call, names, n);
  return NULL;
}

static void add_pending_light(struct reader *reader, const struct light_type *type,
                              const struct params *params, uint32_t shape) {
  *arena_push(&reader->lists, &reader->lights) =
      (struct pending_light){.type = type,
                             .params = *params,
                             .world_from_object = reader->now.world_from_object[START],
                             .reverse_orientation = reader->now.reverse_orientation,
                             .shape = shape};
}

bool read_place_shape(struct reader *reader, const struct shape_type *type,
                      const struct attributes *attributes, struct params *params, uint32_t *row) {
  struct scene_builder *builder = &reader->builder;
  if (read_is_moving(attributes))
    return problem_at(reader->problem, params->place, "%s: motion is not in this version",
                      params->directive);
  builder->world_from_object = attributes->world_from_object[START];
  builder->reverse_orientation = attributes->reverse_orientation;
  builder->emits = attributes->area_light != NULL;
  bool mirrored = transform_determinant(builder->world_from_object) < 0;
  *row = build_begin_shape(builder, type, attributes->material,
                           attributes->reverse_orientation != mirrored);
  return type->read(builder, params) && params_finish(params);
}

// A definition's shapes wait for the instances.
static bool add_to_object(struct reader *reader, const struct shape_type *type,
                          const struct call *call) {
  if (reader->now.area_light)
    return problem_at(reader->problem, call->place,
                      "%s: an area light in an object's definition is not possible",
                      call->params.directive);
  *arena_push(&reader->lists, &reader->in_object->shapes) =
      (struct object_shape){type, call->params, reader->now};
  return true;
}

bool read_shape(struct reader *reader, struct call *call) {
  const struct shape_type *type = find_shape(reader, call);
  const struct attributes *now = &reader->now;
  uint32_t row;
  if (!type) return false;
  if (reader->in_object) return add_to_object(reader, type, call);
  if (now->area_light && read_is_moving(now))
    return problem_at(reader->problem, call->place, "%s: an area light cannot move",
                      call->params.directive);
  if (!read_place_shape(reader, type, now, &call->params, &row)) return false;
  if (now->area_light)
    add_pending_light(reader, now->area_light->type, &now->area_light->params, row);
  return true;
}

static void add_material(struct reader *reader, struct material material) {
  struct scene *scene = reader->builder.scene;
  scene->material = build_grow(reader->builder.arena, scene->material, scene->n_materials, 1,
                               sizeof *scene->material);
  reader->now.material = scene->n_materials;
  scene->material[scene->n_materials++] = material;
}

bool read_material(struct reader *reader, struct call *call) {
  struct material material = {.type = find_material(reader, call)};
  if (!material.type) return false;
  struct scene_builder *builder = &reader->builder;
  builder->textured = false;
  if (!material.type->read(builder, &call->params, &material) || !params_finish(&call->params))
    return false;
  if (builder->textured) material.needs |= MATERIAL_DETAIL;
  add_material(reader, material);
  return true;
}

// pbrt's: diffuse with reflectance 0.5, which is what "diffuse" without parameters is.
void read_default_material(struct reader *reader) {
  extern const struct material_type material_diffuse;
  struct params none = {.directive = "the default material", .problem = reader->problem};
  struct material material = {.type = &material_diffuse};
  material.type->read(&reader->builder, &none, &material);
  add_material(reader, material);
}

bool read_light_source(struct reader *reader, struct call *call) {
  const struct light_type *type = find_light(reader, call, false);
  if (!type) return false;
  add_pending_light(reader, type, &call->params, 0);
  return true;
}

bool read_area_light_source(struct reader *reader, struct call *call) {
  const struct light_type *type = find_light(reader, call, true);
  if (!type) return false;
  struct area_light *light = arena_new(reader->builder.arena, struct area_light, 1);
  *light = (struct area_light){type, call->params};
  reader->now.area_light = light;
  return true;
}
