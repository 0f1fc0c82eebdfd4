// Directives after WorldBegin: shapes and lights.
#include "scene/build.h"
#include "scene/motion.h"
#include "scene/reader.h"

#include <string.h>

enum { MAX_NAMES = 64 };

static const struct shape_type *find_shape(struct reader *reader, const struct call *call) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (const struct shape_type *const *type = shape_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  read_unknown_type(reader, call, names, n);
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
  read_unknown_type(reader, call, names, n);
  return NULL;
}

static void add_pending_light(struct reader *reader, const struct light_type *type,
                              const struct params *params, uint32_t shape, uint32_t medium) {
  *arena_push(&reader->lists, &reader->lights) =
      (struct pending_light){.type = type,
                             .params = *params,
                             .world_from_object = reader->now.world_from_object[START],
                             .reverse_orientation = reader->now.reverse_orientation,
                             .shape = shape,
                             .medium = medium};
}

// `float alpha` or `texture alpha` of any shape. As in pbrt a constant of 1 or more is opaque, and
// nothing is seen of one of 0 or less.
static void read_alpha(struct reader *reader, struct params *params, struct shape *shape) {
  struct scene_builder *builder = &reader->builder;
  if (!input_is_given(params, "alpha")) return;
  struct input input = input_read_float(builder, params, "alpha", 1);
  if (!input.texture && input.value[0] >= 1) return;
  if (shape->inside != shape->outside && builder->scene->material[shape->material].type->passed)
    params_complain(params, "alpha",
                    "an interface between media has no holes: rays that pass one would stay in "
                    "the medium they are in");
  for (int c = 0; c < 3; c++)
    if (!(input.value[c] >= 0)) input.value[c] = 0;
  struct input *alpha = arena_new(builder->arena, struct input, 1);
  *alpha = input;
  shape->alpha = alpha;
}

static void set_builder(struct scene_builder *builder, const struct attributes *attributes) {
  builder->world_from_object = attributes->world_from_object[START];
  builder->reverse_orientation = attributes->reverse_orientation;
  builder->emits = attributes->area_light != NULL;
}

static bool read_one_shape(struct reader *reader, const struct shape_type *type, bool flip,
                           const struct attributes *attributes, struct params *params) {
  struct scene_builder *builder = &reader->builder;
  uint32_t inside, outside;
  if (!read_shape_media(reader, attributes, params, &inside, &outside)) return false;
  uint32_t row = build_begin_shape(builder, type, attributes->material, flip);
  builder->scene->shape[row].inside = inside;
  builder->scene->shape[row].outside = outside;
  read_alpha(reader, params, &builder->scene->shape[row]);
  read_leave_out(reader, params, "displacement");
  read_leave_out(reader, params, "displacement.edgelength");
  return type->read(builder, params) && params_finish(params);
}

bool read_place_shape(struct reader *reader, const struct shape_type *type,
                      const struct attributes *attributes, struct params *params, uint32_t *row) {
  struct scene_builder *builder = &reader->builder;
  *row = builder->scene->n_shapes;
  set_builder(builder, attributes);
  bool mirrored = transform_determinant(builder->world_from_object) < 0;
  return read_one_shape(reader, type, attributes->reverse_orientation != mirrored, attributes,
                        params);
}

// Where it is at the start of the motion, which its own matrix and its instance's make.
bool read_place_moving_shape(struct reader *reader, const struct shape_type *type,
                             const struct attributes *attributes,
                             const struct transform instance[N_ENDS], struct params *params) {
  struct scene_builder *builder = &reader->builder;
  const struct transform *object = attributes->world_from_object;
  struct motion_place place = {animation_new(instance[START], instance[END]),
                               animation_new(object[START], object[END])};
  bool mirrored = transform_determinant(object[START]) < 0,
       mirrors = transform_determinant(instance[START]) < 0;
  set_builder(builder, attributes);
  builder->world_from_object = transform_identity(); // motion_add does the rest
  // To pbrt a matrix that moves mirrors a quadric's normals as an instance's does.
  builder->mirrored_instance = mirrors != (place.object.moves && mirrored);
  struct motion_start start = motion_start(builder->scene);
  bool ok = read_one_shape(reader, type, attributes->reverse_orientation != (mirrored != mirrors),
                           attributes, params) &&
            motion_add(builder, params, &start, &place);
  builder->mirrored_instance = false;
  return ok;
}

// A definition's shapes wait for the instances. pbrt-v4 warns and renders them without the light.
static bool add_to_object(struct reader *reader, const struct shape_type *type,
                          const struct call *call) {
  const char *directive = call->params.directive;
  if (reader->now.area_light && !reader->options.lenient)
    return problem_at(
        reader->problem, call->place,
        "%s: an area light in an object's definition does not shine; --lenient leaves "
        "it out",
        directive);
  if (reader->now.area_light)
    read_note(reader, call->place, directive, "its area light is left out");
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
  if (now->area_light && read_is_moving(now->world_from_object))
    return problem_at(reader->problem, call->place, "%s: an area light cannot move",
                      call->params.directive);
  if (read_is_moving(now->world_from_object)) {
    const struct transform none[N_ENDS] = {transform_identity(), transform_identity()};
    return read_place_moving_shape(reader, type, now, none, &call->params);
  }
  if (!read_place_shape(reader, type, now, &call->params, &row)) return false;
  for (; now->area_light && row < reader->builder.scene->n_shapes; row++) // a mesh may be two
    add_pending_light(reader, now->area_light->type, &now->area_light->params, row,
                      reader->builder.scene->shape[row].outside);
  return true;
}

bool read_light_source(struct reader *reader, struct call *call) {
  const struct light_type *type = find_light(reader, call, false);
  uint32_t medium;
  if (!type || !read_outside(reader, call, &medium)) return false;
  add_pending_light(reader, type, &call->params, 0, medium);
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
