#include "scene/build.h"

#include "scene/box.h"
#include "scene/reader.h"

#include <float.h>

static uint64_t capacity_for(uint64_t count) {
  uint64_t capacity = 8;
  while (capacity < count) capacity *= 2;
  return count ? capacity : 0;
}

void *build_grow(struct arena *arena, void *array, uint32_t count, uint32_t more, size_t size) {
  uint64_t old = capacity_for(count), wanted = capacity_for((uint64_t)count + more);
  if (old == wanted) return array;
  return arena_grow(arena, array, (ptrdiff_t)old, (ptrdiff_t)wanted, (ptrdiff_t)size,
                    (ptrdiff_t)alignof(max_align_t));
}

uint32_t build_begin_shape(struct scene_builder *builder, const struct shape_type *type,
                           uint32_t material, bool flip) {
  struct scene *scene = builder->scene;
  scene->shape = build_grow(builder->arena, scene->shape, scene->n_shapes, 1, sizeof *scene->shape);
  scene->shape[scene->n_shapes] = (struct shape){.type = type,
                                                 .first = scene->n_primitives,
                                                 .normal = ROW_NONE,
                                                 .uv = ROW_NONE,
                                                 .tangent = ROW_NONE,
                                                 .material = material,
                                                 .light = LIGHT_NONE,
                                                 .inside = MEDIUM_NONE,
                                                 .outside = MEDIUM_NONE,
                                                 .flip = flip};
  return scene->n_shapes++;
}

static struct shape *current_shape(struct scene *scene) {
  return &scene->shape[scene->n_shapes - 1];
}

bool build_check_room(struct params *params, uint64_t count, uint64_t more) {
  if (count + more < UINT32_MAX) return true;
  return params_complain(params, "P", "the scene has more than 2^32 - 2 primitives or vertices");
}

static bool box_is_finite(const struct box *box) {
  for (int i = 0; i < 3; i++)
    if (!(box->lo[i] >= -FLT_MAX && box->hi[i] <= FLT_MAX)) return false;
  return true;
}

bool scene_add_quadric(struct scene_builder *builder, struct params *params,
                       const struct quadric *quadric) {
  struct scene *scene = builder->scene;
  if (!build_check_room(params, scene->n_primitives, 1)) return false;
  scene->quadric =
      build_grow(builder->arena, scene->quadric, scene->n_quadrics, 1, sizeof *scene->quadric);
  struct quadric *row = &scene->quadric[scene->n_quadrics];
  *row = *quadric;
  row->world_from_object = builder->world_from_object;
  transform_invert(row->world_from_object, &row->object_from_world); // the reader checked it
  struct shape *shape = current_shape(scene);
  // To pbrt an instance's matrix mirrors normals like any other vector. Vertices say so by
  // themselves; a quadric's normal was flipped for it, as for the matrix it was defined with.
  if (builder->mirrored_instance) shape->flip = !shape->flip;
  shape->local = scene->n_quadrics++;
  shape->count = 1;
  struct box box = shape->type->bounds(scene, shape, scene->n_primitives++);
  return box_is_finite(&box) || params_complain(params, "radius", "it does not fit into floats");
}

// Details cost time at every hit: only where somebody reads them. A light that does says so itself.
static void finish_shape(struct scene *scene, struct shape *shape) {
  const struct material *material = &scene->material[shape->material];
  shape->see_through = shape->alpha || material->type->passed;
  shape->detailed =
      shape->normal != ROW_NONE || shape->alpha || (material->needs & MATERIAL_DETAIL);
}

// What every point of a shape has in common is worked out once. Shapes that move are left out.
static void fill_constants(struct scene *scene, struct shape *shape, struct arena *arena) {
  const struct material *material = &scene->material[shape->material];
  bool faceted = shape->type->flat && shape->normal == ROW_NONE;
  for (uint32_t k = shape->first; faceted && k < shape->first + shape->count; k++)
    scene->facet[k] = shape->type->normal(scene, shape, k, vec(0, 0, 0));
  shape->faceted = faceted;
  if (shape->detailed || material->needs & MATERIAL_RANDOM || material->type->passed) return;
  struct bsdf *bsdf = arena_new(arena, struct bsdf, 1);
  struct surface surface = {.primitive = shape->first, .shape = (uint32_t)(shape - scene->shape)};
  material->type->bsdf(scene, material, &surface, bsdf);
  shape->bsdf = bsdf;
  shape->lambert = faceted && bsdf->type && bsdf->type->lambert && shape->inside == shape->outside;
}

static bool moves(const struct scene *scene, uint32_t shape) {
  for (uint32_t k = 0; k < scene->n_motions; k++)
    if (shape - scene->motion[k].shape < scene->motion[k].n_shapes) return true;
  return false;
}

static void fill_tables(struct scene_builder *builder) {
  struct scene *scene = builder->scene;
  scene->shape_of = arena_new(builder->arena, uint32_t, scene->n_primitives);
  scene->facet = arena_new(builder->arena, struct vec, scene->n_primitives);
  scene->bounds = box_empty();
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    struct shape *shape = &scene->shape[s];
    finish_shape(scene, shape);
    if (!moves(scene, s)) fill_constants(scene, shape, builder->arena);
    for (uint32_t k = shape->first; k < shape->first + shape->count; k++) {
      scene->shape_of[k] = s;
      scene->bounds = box_union(scene->bounds, shape->type->bounds(scene, shape, k));
    }
  }
  for (uint32_t k = 0; k < scene->n_motions; k++)
    scene->bounds = box_union(scene->bounds, scene->motion[k].bounds);
}

static bool read_light(struct reader *reader, struct pending_light *pending, struct light *light) {
  struct scene_builder *builder = &reader->builder;
  builder->world_from_object = pending->world_from_object;
  builder->reverse_orientation = pending->reverse_orientation;
  builder->shape = NULL;
  if (pending->type->area) {
    struct shape *shape = &builder->scene->shape[pending->shape];
    shape->light = (uint32_t)(light - builder->scene->light);
    builder->shape = shape;
  }
  // Several shapes may share the parameters of one AreaLightSource.
  for (int i = 0; i < pending->params.count; i++) pending->params.item[i].taken = false;
  light->type = pending->type;
  light->medium = light->type->at_infinity ? MEDIUM_NONE : pending->medium;
  return pending->type->read(builder, &pending->params, light) && params_finish(&pending->params);
}

static bool read_lights(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  scene->light = arena_new(reader->builder.arena, struct light, reader->lights.count);
  scene->n_lights = (uint32_t)reader->lights.count;
  for (ptrdiff_t k = 0; k < reader->lights.count; k++)
    if (!read_light(reader, &reader->lights.item[k], &scene->light[k])) return false;
  return true;
}

static double mean_power(const struct light *light) {
  return (light->power[0] + light->power[1] + light->power[2]) / 3;
}

static bool choose_lights(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  scene->light_cdf = arena_new(reader->builder.arena, double, (ptrdiff_t)scene->n_lights + 1);
  if (scene->n_lights == 0) return true;
  double total = 0;
  for (uint32_t k = 0; k < scene->n_lights; k++) total += mean_power(&scene->light[k]);
  struct place place = reader->lights.item[0].params.place;
  if (total == 0) return problem_at(reader->problem, place, "no light emits anything");
  if (!(total > 0 && total < INFINITY))
    return problem_at(reader->problem, place, "the lights' power is not a positive number");
  for (uint32_t k = 0; k < scene->n_lights; k++) {
    scene->light[k].probability = mean_power(&scene->light[k]) / total;
    scene->light_cdf[k + 1] = scene->light_cdf[k] + scene->light[k].probability;
  }
  // What rounding left over belongs to the last light that emits: a dark one is never chosen.
  for (uint32_t k = scene->n_lights; k > 0; k--) {
    scene->light_cdf[k] = 1;
    if (scene->light[k - 1].probability > 0) break;
  }
  return true;
}

static bool list_infinite(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  scene->infinite = arena_new(reader->builder.arena, uint32_t, scene->n_lights);
  for (uint32_t k = 0; k < scene->n_lights; k++)
    if (scene->light[k].type->background) scene->infinite[scene->n_infinite++] = k;
  return true;
}

static void count_names(struct reader *reader) {
  struct inventory *inventory = &reader->builder.scene->inventory;
  inventory->n_files = (uint32_t)reader->n_files + 1;
  inventory->n_objects = (uint32_t)reader->objects.count;
  inventory->n_instances = (uint32_t)reader->instances.count;
  inventory->n_named_materials = (uint32_t)reader->material_names.count;
}

bool scene_finish(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  if (!read_finish_options(reader) || !read_check_materials(reader) || !read_instances(reader))
    return false;
  if (scene->n_primitives == 0)
    return problem_at(reader->problem, reader->lexer.token.place, "the scene has no Shape");
  count_names(reader);
  fill_tables(&reader->builder);
  return read_lights(reader) && choose_lights(reader) && list_infinite(reader);
}
