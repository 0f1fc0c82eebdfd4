// ObjectBegin, ObjectEnd, ObjectInstance. Instances become primitives of their own: one tree over
// all, and one definition of a hit (the smallest t and primitive number), at the price of memory.
#include "scene/reader.h"

#include <string.h>

bool read_object_begin(struct reader *reader, struct call *call) {
  if (reader->in_object)
    return problem_at(reader->problem, call->place,
                      "ObjectBegin within an object's definition: end that one first");
  if (names_find(&reader->objects, call->type) != NAME_NONE)
    return problem_at(reader->problem, call->type_place, "the object \"%s\" is already defined",
                      call->type);
  read_push_attributes(reader, call);
  names_add(&reader->objects, &reader->lists, call->type);
  *arena_push(&reader->lists, &reader->object) = (struct object){0};
  reader->in_object = &reader->object.item[reader->object.count - 1];
  return true;
}

bool read_object_end(struct reader *reader, struct call *call) {
  if (!read_pop_attributes(reader, call, "ObjectBegin")) return false;
  reader->in_object = NULL;
  return true;
}

// Looked up at the end of the file: as in pbrt, the definition may follow.
bool read_object_instance(struct reader *reader, struct call *call) {
  if (reader->in_object)
    return problem_at(reader->problem, call->place,
                      "ObjectInstance within an object's definition is not possible; repeat its "
                      "shapes");
  const char *name = arena_string(&reader->lists, call->type, (ptrdiff_t)strlen(call->type));
  struct instance instance = {.name = name, .place = call->place, .name_place = call->type_place};
  memcpy(instance.world_from_object, reader->now.world_from_object,
         sizeof instance.world_from_object);
  *arena_push(&reader->lists, &reader->instances) = instance;
  return true;
}

// Point = matrix at ObjectInstance * matrix at the shape * p.
static bool compose(struct reader *reader, const struct instance *instance,
                    struct attributes *shape) {
  for (int end = START; end < N_ENDS; end++) {
    struct transform *t = &shape->world_from_object[end], inverse;
    *t = transform_multiply(instance->world_from_object[end], *t);
    if (!transform_is_finite(t) || !transform_invert(*t, &inverse))
      return problem_at(reader->problem, instance->place,
                        "ObjectInstance: the transformation overflows or flattens space");
  }
  return true;
}

static bool place_shape(struct reader *reader, const struct instance *instance,
                        const struct object_shape *shape) {
  struct attributes attributes = shape->attributes;
  struct params params = shape->params;
  uint32_t row;
  for (int i = 0; i < params.count; i++)
    params.item[i].taken = false; // there may be many instances
  if (read_is_moving(attributes.world_from_object) ||
      (instance && read_is_moving(instance->world_from_object))) {
    const struct transform none[N_ENDS] = {transform_identity(), transform_identity()};
    return read_place_moving_shape(reader, shape->type, &attributes,
                                   instance ? instance->world_from_object : none, &params);
  }
  if (instance && !compose(reader, instance, &attributes)) return false;
  reader->builder.mirrored_instance =
      instance && transform_determinant(instance->world_from_object[START]) < 0;
  bool ok = read_place_shape(reader, shape->type, &attributes, &params, &row);
  reader->builder.mirrored_instance = false;
  return ok;
}

static bool place_object(struct reader *reader, const struct instance *instance,
                         const struct object *object) {
  for (ptrdiff_t k = 0; k < object->shapes.count; k++)
    if (!place_shape(reader, instance, &object->shapes.item[k])) return false;
  return true;
}

static bool read_instance(struct reader *reader, const struct instance *instance) {
  uint32_t number = names_find(&reader->objects, instance->name);
  if (number == NAME_NONE)
    return problem_at(reader->problem, instance->name_place, "unknown object \"%s\"%s",
                      instance->name, names_suggest(&reader->objects, instance->name).text);
  struct object *object = &reader->object.item[number];
  reader->in_later_instance = object->used;
  object->used = true;
  bool ok = place_object(reader, instance, object);
  reader->in_later_instance = false;
  return ok;
}

// Read as the others are, so that its errors are found, and forgotten.
static bool check_unused(struct reader *reader, const struct object *object) {
  struct scene scene = *reader->builder.scene;
  struct arena arena = *reader->builder.arena;
  bool ok = place_object(reader, NULL, object);
  *reader->builder.scene = scene;
  *reader->builder.arena = arena;
  return ok;
}

bool read_instances(struct reader *reader) {
  for (ptrdiff_t k = 0; k < reader->instances.count; k++)
    if (!read_instance(reader, &reader->instances.item[k])) return false;
  for (ptrdiff_t k = 0; k < reader->object.count; k++)
    if (!reader->object.item[k].used && !check_unused(reader, &reader->object.item[k]))
      return false;
  return true;
}
