// Directives that save, restore and set attributes, and the defaults of parameters.
#include "pbrt/suggest.h"
#include "scene/reader.h"

#include <string.h>

// More for one target is no scene; keeps applying them cheap.
enum { MAX_DEFAULTS = 64 };

void read_push_attributes(struct reader *reader, const struct call *call) {
  *arena_push(&reader->lists, &reader->saved) =
      (struct saved_attributes){reader->now, call->name, call->place};
}

// Files that a file imports cannot end what it began.
bool read_pop_attributes(struct reader *reader, const struct call *call, const char *begin) {
  if (reader->saved.count == reader->saved_outside)
    return problem_at(reader->problem, call->place, "%s without %s", call->name, begin);
  const struct saved_attributes *top = &reader->saved.item[reader->saved.count - 1];
  bool object = strcmp(top->directive, "ObjectBegin") == 0;
  if (object != (strcmp(begin, "ObjectBegin") == 0))
    return problem_at(reader->problem, call->place, "%s: the %s in line %d is to be ended first",
                      call->name, top->directive, top->begin.line);
  reader->now = top->attributes;
  reader->saved.count--;
  return true;
}

bool read_all_popped(struct reader *reader, ptrdiff_t outside) {
  if (reader->saved.count == outside) return true;
  const struct saved_attributes *top = &reader->saved.item[reader->saved.count - 1];
  return problem_at(reader->problem, top->begin, "this %s has no %.*sEnd", top->directive,
                    (int)strlen(top->directive) - 5, top->directive);
}

// TransformBegin too: to pbrt-v4 it is another name of AttributeBegin.
bool read_attribute_begin(struct reader *reader, struct call *call) {
  read_push_attributes(reader, call);
  return true;
}

bool read_attribute_end(struct reader *reader, struct call *call) {
  return read_pop_attributes(reader, call, "AttributeBegin");
}

bool read_reverse_orientation(struct reader *reader, struct call *call) {
  (void)call;
  reader->now.reverse_orientation = !reader->now.reverse_orientation;
  return true;
}

static bool is_given(const struct param *item, int count, const char *name) {
  for (int i = 0; i < count; i++)
    if (strcmp(item[i].name, name) == 0) return true;
  return false;
}

// `first`, and behind it those of `defaults` whose names are not in it.
static struct param *merge(const struct param *first, int *count, const struct defaults *defaults,
                           struct arena *arena) {
  struct param *item = arena_new(arena, struct param, *count + defaults->count);
  if (*count) memcpy(item, first, (size_t)*count * sizeof *item);
  for (int i = 0, n = *count; i < defaults->count; i++)
    if (!is_given(first, n, defaults->item[i].name)) item[(*count)++] = defaults->item[i];
  return item;
}

bool read_attribute(struct reader *reader, struct call *call) {
  static const char *const names[] = {"shape", "light", "material", "medium", "texture"};
  struct params *params = &call->params;
  int target = 0;
  while (target < N_TARGETS - 1 && strcmp(names[target], call->type) != 0) target++;
  if (target == N_TARGETS - 1) {
    const char *nearest = suggest_name(call->type, names, N_TARGETS - 1);
    return problem_at(reader->problem, call->type_place,
                      "Attribute \"%s\": expected shape, light, material, medium or texture%s%s%s",
                      call->type, nearest ? "; did you mean " : "", nearest ? nearest : "",
                      nearest ? "?" : "");
  }
  struct defaults *defaults = &reader->now.defaults[target + 1];
  if (params->count == 0) return true;
  for (int i = 0; i < params->count; i++) params->item[i].is_default = true;
  defaults->item = merge(params->item, &params->count, defaults, &reader->lists);
  defaults->count = params->count;
  if (defaults->count > MAX_DEFAULTS)
    return params_complain(params, "", "more than %d defaults", MAX_DEFAULTS);
  return true;
}

void read_apply_defaults(const struct reader *reader, enum target target, struct arena *arena,
                         struct call *call) {
  const struct defaults *defaults = &reader->now.defaults[target];
  if (defaults->count)
    call->params.item = merge(call->params.item, &call->params.count, defaults, arena);
}
