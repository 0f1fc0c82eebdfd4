#include "pbrt/params.h"

#include "pbrt/suggest.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void note_asked(struct params *params, const char *name) {
  for (int i = 0; i < params->n_asked; i++)
    if (strcmp(params->asked[i], name) == 0) return;
  if (params->n_asked < PARAMS_MAX_ASKED) params->asked[params->n_asked++] = name;
}

static struct param *find(const struct params *params, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (strcmp(params->item[i].name, name) == 0) return &params->item[i];
  return NULL;
}

// The parameter if it is there, has this type and `count` values (0: any number); notes the
// question.
static struct param *take(struct params *params, const char *type, const char *name,
                          ptrdiff_t count) {
  note_asked(params, name);
  struct param *param = find(params, name);
  if (!param || params->problem->text[0]) return NULL;
  if (param->is_default && strcmp(param->type, type) != 0) return NULL;
  param->taken = true;
  if (strcmp(param->type, type) != 0) {
    problem_at(params->problem, param->place, "%s: \"%s\" must be of type %s, not %s",
               params->directive, name, type, param->type);
    return NULL;
  }
  if (count && param->count != count) {
    problem_at(params->problem, param->place, "%s: \"%s %s\" needs %td value%s, has %td",
               params->directive, type, name, count, count == 1 ? "" : "s", param->count);
    return NULL;
  }
  return param;
}

double params_float(struct params *params, const char *name, double fallback) {
  const struct param *param = take(params, "float", name, 1);
  return param ? param->number[0] : fallback;
}

int64_t params_integer(struct params *params, const char *name, int64_t fallback) {
  const struct param *param = take(params, "integer", name, 1);
  return param ? (int64_t)param->number[0] : fallback;
}

bool params_bool(struct params *params, const char *name, bool fallback) {
  const struct param *param = take(params, "bool", name, 1);
  return param ? param->truth[0] : fallback;
}

const char *params_string(struct params *params, const char *name, const char *fallback) {
  const struct param *param = take(params, "string", name, 1);
  return param ? param->string[0] : fallback;
}

struct vec params_point3(struct params *params, const char *name, struct vec fallback) {
  const struct param *param = take(params, "point3", name, 3);
  return param ? vec(param->number[0], param->number[1], param->number[2]) : fallback;
}

bool params_rgb(struct params *params, const char *name, double rgb[3]) {
  const struct param *param = take(params, "rgb", name, 3);
  if (param) memcpy(rgb, param->number, 3 * sizeof *rgb);
  return param != NULL;
}

const double *params_array(struct params *params, const char *type, const char *name,
                           ptrdiff_t *count) {
  const struct param *param = take(params, type, name, 0);
  *count = param ? param->count : 0;
  return param ? param->number : NULL;
}

const struct param *params_any(struct params *params, const char *name) {
  note_asked(params, name);
  struct param *param = find(params, name);
  if (!param || params->problem->text[0]) return NULL;
  param->taken = true;
  return param;
}

struct place params_place(const struct params *params, const char *name) {
  const struct param *param = find(params, name);
  return param ? param->place : params->place;
}

bool params_complain(struct params *params, const char *name, const char *format, ...) {
  char text[sizeof params->problem->text];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  return problem_at(params->problem, params_place(params, name), "%s: %s", params->directive, text);
}

// "; it reads a, b, c" or "; did you mean "a"?"
static void write_hint(const struct params *params, const char *name, char *hint, size_t size) {
  const char *nearest = suggest_name(name, params->asked, params->n_asked);
  if (nearest) {
    snprintf(hint, size, "; did you mean \"%s\"?", nearest);
    return;
  }
  size_t used = (size_t)snprintf(hint, size, params->n_asked ? "; it reads" : "; it reads none");
  for (int i = 0; i < params->n_asked && used < size; i++)
    used += (size_t)snprintf(hint + used, size - used, "%s %s", i ? "," : "", params->asked[i]);
}

bool params_finish(struct params *params) {
  if (params->problem->text[0]) return false;
  for (int i = 0; i < params->count; i++) {
    const struct param *param = &params->item[i];
    if (param->taken || param->is_default) continue;
    char hint[512];
    write_hint(params, param->name, hint, sizeof hint);
    return problem_at(params->problem, param->place, "%s does not read a parameter \"%s\"%s",
                      params->directive, param->name, hint);
  }
  return true;
}
