#include "experiment/value.h"
#include "pbrt/suggest.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool value_complain(struct reading *reading, const struct node *node, const char *format, ...) {
  char says[512];
  va_list args;
  va_start(args, format);
  vsnprintf(says, sizeof says, format, args);
  va_end(args);
  return problem_at(reading->problem, node->place, "%s: %s %s", reading->key,
                    node_show(node, reading->arena), says);
}

const char *value_text(struct reading *reading, const struct node *node, const char *noun) {
  if (node->kind == NODE_SCALAR && node->text[0]) return node->text;
  if (node->kind != NODE_SCALAR)
    value_complain(reading, node, "where %s is expected", noun);
  else
    problem_at(reading->problem, node->place, "%s: no value", reading->key);
  return NULL;
}

static const char *skip_digits(const char *at) { return at + strspn(at, "0123456789"); }

// Where the decimal number at `text` ends; NULL if there is none. (strtod would take hex and nan.)
static const char *decimal_end(const char *text) {
  const char *at = text + (*text == '+' || *text == '-');
  const char *whole = skip_digits(at);
  const char *end = *whole == '.' ? skip_digits(whole + 1) : whole;
  if (end - at < 1 + (*whole == '.')) return NULL; // not one digit
  if (*end != 'e' && *end != 'E') return end;
  const char *exponent = end + 1 + (end[1] == '+' || end[1] == '-');
  const char *last = skip_digits(exponent);
  return last > exponent ? last : NULL;
}

bool value_number(struct reading *reading, const struct node *node, double *value) {
  const char *text = value_text(reading, node, "a number");
  if (!text) return false;
  const char *end = decimal_end(text);
  double result = strtod(text, NULL);
  if (end && *end == '/') {
    const char *below = end + 1;
    end = decimal_end(below);
    result /= strtod(below, NULL);
  }
  if (!end || *end) return value_complain(reading, node, "is not a number or a ratio such as 2/3");
  if (!isfinite(result)) return value_complain(reading, node, "is not a finite number");
  *value = result;
  return true;
}

// False when the digits exceed 64 bits.
static bool parse_digits(const char *text, uint64_t *value) {
  uint64_t sum = 0;
  for (; *text; text++) {
    uint64_t digit = (uint64_t)(*text - '0');
    if (sum > (UINT64_MAX - digit) / 10) return false;
    sum = 10 * sum + digit;
  }
  *value = sum;
  return true;
}

bool value_count(struct reading *reading, const struct node *node, uint64_t least, uint64_t most,
                 uint64_t *value) {
  const char *text = value_text(reading, node, "a whole number");
  if (!text) return false;
  const char *end = decimal_end(text);
  if (!end || *end) return value_complain(reading, node, "is not a whole number");
  double number = strtod(text, NULL);
  if (isfinite(number) && number != floor(number))
    return value_complain(reading, node, "is not a whole number");
  uint64_t count = 0;
  bool fits = number >= 0 && number < 0x1p64;
  if (*skip_digits(text) == 0)
    fits = parse_digits(text, &count);
  else if (fits)
    count = (uint64_t)number;
  if (!fits || count < least || count > most)
    return value_complain(reading, node, "is out of range (%llu to %llu)",
                          (unsigned long long)least, (unsigned long long)most);
  *value = count;
  return true;
}

static const char *join(const char *const *names, int n, struct arena *arena) {
  const char *all = "";
  for (int j = 0; j < n; j++) all = arena_format(arena, "%s%s%s", all, j ? ", " : "", names[j]);
  return all;
}

bool value_choice(struct reading *reading, const struct node *node, const char *const *names, int n,
                  int *choice) {
  const char *text = value_text(reading, node, "a name");
  if (!text) return false;
  for (int j = 0; j < n; j++)
    if (strcmp(text, names[j]) == 0) {
      *choice = j;
      return true;
    }
  const char *meant = suggest_name(text, names, n);
  const char *known = join(names, n, reading->arena);
  if (!meant) return value_complain(reading, node, "is unknown (known: %s)", known);
  return value_complain(reading, node, "is unknown; did you mean %s? (known: %s)", meant, known);
}
