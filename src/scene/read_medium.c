// MakeNamedMedium and MediumInterface are read and checked; what is really inside a medium is
// refused.
#include "pbrt/suggest.h"
#include "scene/reader.h"

#include <string.h>

static const char *const known[] = {"cloud", "homogeneous", "nanovdb", "rgbgrid", "uniformgrid"};
enum { N_KNOWN = (int)(sizeof known / sizeof *known) };

static bool check_type(struct params *params) {
  const char *type = params_string(params, "type", NULL);
  if (!type) return params_complain(params, "type", "\"string type\" is missing: say which medium");
  for (int i = 0; i < N_KNOWN; i++)
    if (strcmp(known[i], type) == 0) return !params->problem->text[0];
  const char *nearest = suggest_name(type, known, N_KNOWN);
  return params_complain(params, "type", "unknown medium \"%s\"%s%s%s", type,
                         nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                         nearest ? "\"?" : "");
}

bool read_make_named_medium(struct reader *reader, struct call *call) {
  if (names_find(&reader->media, call->type) != NAME_NONE)
    return problem_at(reader->problem, call->type_place, "the medium \"%s\" is already defined",
                      call->type);
  names_add(&reader->media, &reader->lists, call->type);
  return check_type(&call->params);
}

// One name is both inside and outside; "" is a vacuum.
bool read_medium_interface(struct reader *reader, struct call *call) {
  const char *outside = call->value ? call->value : call->type;
  reader->now.inside = arena_string(&reader->lists, call->type, (ptrdiff_t)strlen(call->type));
  reader->now.outside = arena_string(&reader->lists, outside, (ptrdiff_t)strlen(outside));
  return true;
}

static bool refuse(struct reader *reader, struct place place, const char *directive,
                   const char *side, const char *medium) {
  if (names_find(&reader->media, medium) == NAME_NONE)
    return problem_at(reader->problem, place, "%s: unknown medium \"%s\"%s", directive, medium,
                      names_suggest(&reader->media, medium).text);
  return problem_at(reader->problem, place,
                    "%s: participating media are not in this version, and \"%s\" is %s it",
                    directive, medium, side);
}

// A shape with the same medium on both sides changes nothing, in pbrt too.
bool read_check_media(struct reader *reader, const struct attributes *attributes,
                      const struct params *params) {
  const char *inside = attributes->inside ? attributes->inside : "";
  const char *outside = attributes->outside ? attributes->outside : "";
  if (strcmp(inside, outside) == 0) return true;
  return *inside ? refuse(reader, params->place, params->directive, "inside", inside)
                 : refuse(reader, params->place, params->directive, "outside", outside);
}

bool read_check_outside(struct reader *reader, const struct call *call) {
  const char *outside = reader->now.outside;
  return !outside || !*outside ||
         refuse(reader, call->place, call->params.directive, "around", outside);
}
