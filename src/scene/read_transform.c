// Directives that change the current transformation and attributes.
#include "scene/reader.h"

// Every shape, light and camera needs the inverse, so a singular matrix is an error where it
// arises.
static bool set_transform(struct reader *reader, const struct call *call, struct transform t) {
  struct transform inverse;
  if (!transform_is_finite(&t))
    return problem_at(reader->problem, call->place, "%s: the transformation overflows", call->name);
  if (!transform_invert(t, &inverse))
    return problem_at(reader->problem, call->place,
                      "%s: the transformation becomes singular (it flattens space)", call->name);
  reader->now.world_from_object = t;
  return true;
}

// pbrt post-multiplies: the last directive acts first.
static bool concatenate(struct reader *reader, const struct call *call, struct transform t) {
  return set_transform(reader, call, transform_multiply(reader->now.world_from_object, t));
}

static struct vec vector(const double *number) { return vec(number[0], number[1], number[2]); }

bool read_look_at(struct reader *reader, struct call *call) {
  const double *x = call->number;
  struct transform t;
  if (!transform_look_at(vector(x), vector(x + 3), vector(x + 6), &t))
    return problem_at(reader->problem, call->place,
                      "LookAt: the eye must not be the point looked at, and up not along the view");
  return concatenate(reader, call, t);
}

bool read_translate(struct reader *reader, struct call *call) {
  return concatenate(reader, call, transform_translate(vector(call->number)));
}

bool read_rotate(struct reader *reader, struct call *call) {
  struct vec axis = vector(call->number + 1);
  double length = vec_length(axis);
  if (!(length > 0 && length < INFINITY))
    return problem_at(reader->problem, call->place, "Rotate: the axis has no length");
  return concatenate(reader, call, transform_rotate(call->number[0], axis));
}

bool read_scale(struct reader *reader, struct call *call) {
  return concatenate(reader, call, transform_scale(vector(call->number)));
}

bool read_identity(struct reader *reader, struct call *call) {
  return set_transform(reader, call, transform_identity());
}

static bool matrix(struct reader *reader, const struct call *call, struct transform *t) {
  if (transform_from_columns(call->number, t)) return true;
  return problem_at(reader->problem, call->place,
                    "%s: numbers 4, 8, 12 and 16 must be 0 0 0 1 (columns, no projection)",
                    call->name);
}

bool read_transform(struct reader *reader, struct call *call) {
  struct transform t;
  return matrix(reader, call, &t) && set_transform(reader, call, t);
}

bool read_concat_transform(struct reader *reader, struct call *call) {
  struct transform t;
  return matrix(reader, call, &t) && concatenate(reader, call, t);
}

bool read_attribute_begin(struct reader *reader, struct call *call) {
  *arena_push(&reader->lists, &reader->saved) = (struct saved_attributes){reader->now, call->place};
  return true;
}

bool read_attribute_end(struct reader *reader, struct call *call) {
  if (reader->saved.count == 0)
    return problem_at(reader->problem, call->place, "AttributeEnd without AttributeBegin");
  reader->now = reader->saved.item[--reader->saved.count].attributes;
  return true;
}

bool read_reverse_orientation(struct reader *reader, struct call *call) {
  (void)call;
  reader->now.reverse_orientation = !reader->now.reverse_orientation;
  return true;
}

bool read_world_begin(struct reader *reader, struct call *call) {
  reader->world_begin = call->place;
  reader->now.world_from_object = transform_identity();
  return true;
}
