// MakeNamedMedium, MediumInterface, and what is inside and outside of shapes, lights and the
// camera. A medium's number among the names is its row of scene.medium.
#include "pbrt/suggest.h"
#include "scene/build.h"
#include "scene/reader.h"

#include <string.h>

// Those of pbrt-v4 that this version has not.
static const char *const others[] = {"cloud", "nanovdb", "rgbgrid"};
enum { N_OTHERS = (int)(sizeof others / sizeof *others), MAX_NAMES = 64 };

static const struct medium_type *find_type(struct params *params, const char *wanted) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (int i = 0; i < N_OTHERS; i++)
    if (strcmp(others[i], wanted) == 0) {
      params_complain(params, "type",
                      "a medium \"%s\" is not in this version; \"uniformgrid\" comes nearest",
                      wanted);
      return NULL;
    }
  for (const struct medium_type *const *type = medium_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, wanted) == 0) return *type;
    names[n++] = (*type)->name;
  }
  const char *nearest = suggest_name(wanted, names, n);
  params_complain(params, "type", "unknown medium \"%s\"%s%s%s", wanted,
                  nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                  nearest ? "\"?" : " (photonlab list media)");
  return NULL;
}

static bool read_medium(struct reader *reader, struct params *params, struct medium *medium) {
  const char *type = params_string(params, "type", NULL);
  if (reader->problem->text[0]) return false;
  if (!type) return params_complain(params, "type", "\"string type\" is missing: say which medium");
  medium->type = find_type(params, type);
  if (!medium->type) return false;
  if (!medium->type->uniform && read_is_moving(reader->now.world_from_object))
    return params_complain(params, "", "a medium cannot move");
  reader->builder.world_from_object = reader->now.world_from_object[START];
  return medium->type->read(&reader->builder, params, medium) && params_finish(params);
}

bool read_make_named_medium(struct reader *reader, struct call *call) {
  struct arena *arena = reader->builder.arena;
  struct scene *scene = reader->builder.scene;
  if (names_find(&reader->media, call->type) != NAME_NONE)
    return problem_at(reader->problem, call->type_place, "the medium \"%s\" is already defined",
                      call->type);
  names_add(&reader->media, &reader->lists, call->type);
  struct medium medium = {.name = arena_string(arena, call->type, (ptrdiff_t)strlen(call->type))};
  if (!read_medium(reader, &call->params, &medium)) return false;
  scene->medium = build_grow(arena, scene->medium, scene->n_media, 1, sizeof *scene->medium);
  scene->medium[scene->n_media++] = medium;
  return true;
}

// One name is both inside and outside; "" is a vacuum.
bool read_medium_interface(struct reader *reader, struct call *call) {
  const char *outside = call->value ? call->value : call->type;
  reader->now.inside = arena_string(&reader->lists, call->type, (ptrdiff_t)strlen(call->type));
  reader->now.outside = arena_string(&reader->lists, outside, (ptrdiff_t)strlen(outside));
  return true;
}

static bool find_medium(struct reader *reader, struct place place, const char *directive,
                        const char *name, uint32_t *row) {
  *row = MEDIUM_NONE;
  if (!name || !*name) return true;
  uint32_t number = names_find(&reader->media, name);
  if (number == NAME_NONE)
    return problem_at(reader->problem, place, "%s: unknown medium \"%s\"%s", directive, name,
                      names_suggest(&reader->media, name).text);
  *row = number;
  return true;
}

bool read_shape_media(struct reader *reader, const struct attributes *attributes,
                      const struct params *params, uint32_t *inside, uint32_t *outside) {
  return find_medium(reader, params->place, params->directive, attributes->inside, inside) &&
         find_medium(reader, params->place, params->directive, attributes->outside, outside);
}

bool read_outside(struct reader *reader, const struct call *call, uint32_t *row) {
  return find_medium(reader, call->place, call->params.directive, reader->now.outside, row);
}
