// The parameter list of one pbrt-v4 directive: `"float fov" [38] "string filename" "x.pfm"`.
// A slot's `read` takes what it knows; what nobody took is an error (params_finish), so nothing a
// scene says is ignored silently. A parameter of the wrong type or count is an error with its
// place.
#ifndef PBRT_PARAMS_H
#define PBRT_PARAMS_H

#include "base/arena.h"
#include "base/problem.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

struct param {
  const char *type, *name; // "point3", "P"
  struct place place;
  ptrdiff_t count; // values
  double *number;  // for numeric types, always finite
  const char **string;
  bool *truth;
  bool taken;
  bool is_default; // given for other directives too: of another type or unread, it is no error
};

enum { PARAMS_MAX_ASKED = 32 };

struct params {
  const char *directive; // for messages: "Shape \"sphere\""
  struct place place;
  struct param *item;
  int count;
  struct problem *problem; // set by the first getter that fails; getters then return the fallback
  const char *asked[PARAMS_MAX_ASKED]; // what the getters were asked for, for messages
  int n_asked;
};

// Each takes the named parameter if it is there (of exactly that type), else gives the fallback.
double params_float(struct params *, const char *name, double fallback);
int64_t params_integer(struct params *, const char *name, int64_t fallback);
bool params_bool(struct params *, const char *name, bool fallback);
const char *params_string(struct params *, const char *name, const char *fallback);
struct vec params_point3(struct params *, const char *name, struct vec fallback);
bool params_rgb(struct params *, const char *name, double rgb[3]); // false: absent, rgb untouched
// An array of numbers of `type` ("point3", "integer", ...), NULL if absent; *count in numbers.
const double *params_array(struct params *, const char *type, const char *name, ptrdiff_t *count);
// The parameter of any type, taken; NULL if absent.
const struct param *params_any(struct params *, const char *name);
// Where the parameter is, or where the directive is if it is absent.
struct place params_place(const struct params *, const char *name);
// A reader's own complaint about a value it took (place of that parameter, else of the directive).
bool params_complain(struct params *, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// False if a getter failed or a parameter was not taken.
bool params_finish(struct params *);

#endif
