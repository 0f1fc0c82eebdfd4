// Option: those of pbrt-v4. What changes the image is honoured or refused, what cannot is accepted.
#include "pbrt/number.h"
#include "pbrt/suggest.h"
#include "scene/reader.h"

#include <math.h>
#include <string.h>

struct option {
  const char *name;
  enum { TRUTH, NUMBER, STRING } value;
  bool (*run)(struct reader *, const struct call *); // NULL: it cannot change the image here
};

static bool is_true(const struct call *call) { return strcmp(call->value, "true") == 0; }

static double number_of(const struct call *call) {
  double number = NAN;
  return number_scan(call->value, (ptrdiff_t)strlen(call->value), &number) ? number : NAN;
}

// The sampler's seed, unless that has its own.
static bool run_seed(struct reader *reader, const struct call *call) {
  double seed = number_of(call);
  if (!(seed >= 0 && seed <= 9007199254740992.0 && seed == floor(seed)))
    return problem_at(reader->problem, call->value_place,
                      "Option \"seed\": expected an integer from 0 to 2^53, found %s", call->value);
  reader->option_seed = (int64_t)seed;
  return true;
}

static bool run_pixel_jitter(struct reader *reader, const struct call *call) {
  reader->no_pixel_jitter = is_true(call);
  return true;
}

static bool run_force_diffuse(struct reader *reader, const struct call *call) {
  if (!is_true(call)) return true;
  return problem_at(reader->problem, call->place,
                    "Option \"%s\" is not in this version: it changes every material", call->type);
}

static const struct option options[] = {
    {"disablepixeljitter", TRUTH, run_pixel_jitter},
    {"disabletexturefiltering", TRUTH, NULL}, // there is none here
    {"disablewavelengthjitter", TRUTH, NULL},
    {"displacementedgescale", NUMBER, NULL}, // there is no displacement
    {"forcediffuse", TRUTH, run_force_diffuse},
    {"msereferenceimage", STRING, NULL},
    {"msereferenceout", STRING, NULL},
    {"pixelstats", TRUTH, NULL},
    {"rendercoordsys", STRING, NULL},
    {"seed", NUMBER, run_seed},
    {"wavefront", TRUTH, NULL},
};
enum { N_OPTIONS = (int)(sizeof options / sizeof *options) };

// As pbrt: without upper case, - and _; and without the type of a parameter ("bool pixelstats").
static void normalize(const char *name, char *out, size_t size) {
  const char *blank = strrchr(name, ' ');
  size_t n = 0;
  for (const char *at = blank ? blank + 1 : name; *at && n < size - 1; at++)
    if (*at != '-' && *at != '_')
      out[n++] = *at >= 'A' && *at <= 'Z' ? (char)(*at - 'A' + 'a') : *at;
  out[n] = 0;
}

static const struct option *find_option(struct reader *reader, const struct call *call) {
  const char *names[N_OPTIONS];
  char name[64];
  normalize(call->type, name, sizeof name);
  for (int i = 0; i < N_OPTIONS; i++) {
    if (strcmp(options[i].name, name) == 0) return &options[i];
    names[i] = options[i].name;
  }
  const char *nearest = suggest_name(name, names, N_OPTIONS);
  problem_at(reader->problem, call->type_place, "unknown option \"%s\"%s%s%s", call->type,
             nearest ? "; did you mean \"" : "", nearest ? nearest : "", nearest ? "\"?" : "");
  return NULL;
}

bool read_option(struct reader *reader, struct call *call) {
  const struct option *option = find_option(reader, call);
  if (!option) return false;
  if (option->value == TRUTH && !is_true(call) && strcmp(call->value, "false") != 0)
    return problem_at(reader->problem, call->value_place,
                      "Option \"%s\": expected true or false, found %s", call->type, call->value);
  if (option->value == NUMBER && isnan(number_of(call)))
    return problem_at(reader->problem, call->value_place,
                      "Option \"%s\": expected a number, found %s", call->type, call->value);
  return !option->run || option->run(reader, call);
}
