// Directives that change the current transformation: two matrices, those of the start and of the
// end of a motion.
#include "scene/reader.h"

#include <string.h>

// Every shape, light and camera needs the inverse, so a singular matrix is an error where it
// arises.
static bool check_transform(struct reader *reader, const struct call *call, struct transform t) {
  struct transform inverse;
  if (!transform_is_finite(&t))
    return problem_at(reader->problem, call->place, "%s: the transformation overflows", call->name);
  if (!transform_invert(t, &inverse))
    return problem_at(reader->problem, call->place,
                      "%s: the transformation becomes singular (it flattens space)", call->name);
  return true;
}

static bool set_transform(struct reader *reader, const struct call *call, struct transform t) {
  struct attributes *now = &reader->now;
  if (!check_transform(reader, call, t)) return false;
  for (int end = START; end < N_ENDS; end++)
    if (now->active[end]) now->world_from_object[end] = t;
  return true;
}

// pbrt post-multiplies: the last directive acts first.
static bool concatenate(struct reader *reader, const struct call *call, struct transform t) {
  struct attributes *now = &reader->now;
  for (int end = START; end < N_ENDS; end++) {
    struct transform product = transform_multiply(now->world_from_object[end], t);
    if (!now->active[end]) continue;
    if (!check_transform(reader, call, product)) return false;
    now->world_from_object[end] = product;
  }
  return true;
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

bool read_active_transform(struct reader *reader, struct call *call) {
  static const struct {
    const char *name;
    bool active[N_ENDS];
  } known[] = {{"StartTime", {true, false}}, {"EndTime", {false, true}}, {"All", {true, true}}};
  for (int i = 0; i < 3; i++) {
    if (strcmp(call->type, known[i].name) != 0) continue;
    memcpy(reader->now.active, known[i].active, sizeof known[i].active);
    return true;
  }
  return problem_at(reader->problem, call->type_place,
                    "ActiveTransform: expected StartTime, EndTime or All, found %s", call->type);
}

bool read_transform_times(struct reader *reader, struct call *call) {
  if (!(call->number[START] < call->number[END]))
    return problem_at(reader->problem, call->place,
                      "TransformTimes: the start must be before the end");
  memcpy(reader->transform_times, call->number, sizeof reader->transform_times);
  return true;
}

bool read_is_moving(const struct transform t[N_ENDS]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      if (t[START].m[i][j] != t[END].m[i][j]) return true;
  return false;
}

void read_name_coordinate_system(struct reader *reader, const char *name,
                                 const struct transform world_from_object[N_ENDS]) {
  struct coordinate_system system;
  memcpy(system.world_from_object, world_from_object, sizeof system.world_from_object);
  uint32_t known = names_find(&reader->coordinate_systems, name);
  if (known != NAME_NONE) {
    reader->coordinate_system.item[known] = system;
    return;
  }
  names_add(&reader->coordinate_systems, &reader->lists, name);
  *arena_push(&reader->lists, &reader->coordinate_system) = system;
}

bool read_coordinate_system(struct reader *reader, struct call *call) {
  read_name_coordinate_system(reader, call->type, reader->now.world_from_object);
  return true;
}

// Both matrices, whichever are active.
bool read_coord_sys_transform(struct reader *reader, struct call *call) {
  uint32_t known = names_find(&reader->coordinate_systems, call->type);
  if (known == NAME_NONE)
    return problem_at(reader->problem, call->type_place, "unknown coordinate system \"%s\"%s",
                      call->type, names_suggest(&reader->coordinate_systems, call->type).text);
  memcpy(reader->now.world_from_object, reader->coordinate_system.item[known].world_from_object,
         sizeof reader->now.world_from_object);
  return true;
}

void read_default_transform(struct reader *reader) {
  for (int end = START; end < N_ENDS; end++) {
    reader->now.world_from_object[end] = transform_identity();
    reader->now.active[end] = true;
  }
}

bool read_world_begin(struct reader *reader, struct call *call) {
  reader->world_begin = call->place;
  read_default_transform(reader);
  read_name_coordinate_system(reader, "world", reader->now.world_from_object);
  return true;
}
