#include "mesh/ply.h"
#include "pbrt/number.h"

#include <math.h>
#include <string.h>

ptrdiff_t ply_size(enum ply_type type) {
  static const ptrdiff_t size[PLY_N_TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};
  return size[type];
}

// ---- text ----
static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static bool next_word(struct ply *ply, struct ply_word *word) {
  for (; ply->at < ply->end && is_space(*ply->at); ply->at++) ply->line += *ply->at == '\n';
  *word = (struct ply_word){ply->at, 0};
  while (ply->at < ply->end && !is_space(*ply->at)) ply->at++;
  word->length = ply->at - word->text;
  return word->length > 0 || ply_complain(ply, "the file ends before its last row");
}

// What printf writes where there is no number.
static bool scan_special(struct ply_word word, double *value) {
  static const struct {
    const char *text;
    double value;
  } special[] = {{"nan", NAN}, {"-nan", NAN}, {"inf", INFINITY}, {"-inf", -INFINITY}};
  for (int k = 0; k < 4; k++)
    if (ply_is(word, special[k].text)) {
      *value = special[k].value;
      return true;
    }
  return false;
}

static bool read_text(struct ply *ply, double *value) {
  struct ply_word word;
  if (!next_word(ply, &word)) return false;
  if (number_scan(word.text, word.length, value) || scan_special(word, value)) return true;
  return ply_complain(ply, "\"%s\" is not a number", ply_quote(word).text);
}

// ---- binary ----
static double decode(enum ply_type type, uint64_t bits) {
  uint32_t low = (uint32_t)bits;
  float single;
  double value;
  switch (type) {
  case PLY_INT8:
    return (int8_t)bits;
  case PLY_INT16:
    return (int16_t)bits;
  case PLY_INT32:
    return (int32_t)bits;
  case PLY_FLOAT32:
    memcpy(&single, &low, sizeof single);
    return (double)single;
  case PLY_FLOAT64:
    memcpy(&value, &bits, sizeof value);
    return value;
  default:
    return (double)bits;
  }
}

static bool check_room(const struct ply *ply, ptrdiff_t size, int64_t count) {
  return count <= (ply->end - ply->at) / size ||
         ply_complain(ply, "the file ends before its last row");
}

bool ply_read_value(struct ply *ply, enum ply_type type, double *value) {
  if (!ply->binary) return read_text(ply, value);
  ptrdiff_t size = ply_size(type);
  if (!check_room(ply, size, 1)) return false;
  const unsigned char *byte = (const unsigned char *)ply->at;
  uint64_t bits = 0;
  for (ptrdiff_t k = 0; k < size; k++)
    bits = bits << 8 | byte[ply->format == PLY_BIG_ENDIAN ? k : size - 1 - k];
  *value = decode(type, bits);
  ply->at += size;
  return true;
}

bool ply_skip_values(struct ply *ply, enum ply_type type, int64_t count) {
  struct ply_word word;
  if (!ply->binary) {
    for (; count > 0; count--)
      if (!next_word(ply, &word)) return false;
    return true;
  }
  if (!check_room(ply, ply_size(type), count)) return false;
  ply->at += count * ply_size(type);
  return true;
}

bool ply_read_count(struct ply *ply, const struct ply_property *property, int64_t *count) {
  double value;
  if (!ply_read_value(ply, property->count_type, &value)) return false;
  ptrdiff_t size = ply->binary ? ply_size(property->type) : 2; // a digit and what separates it
  ptrdiff_t most = (ply->end - ply->at + !ply->binary) / size;
  if (!(value >= 0 && value == floor(value)))
    return ply_complain(ply, "%g is not the length of a list", value);
  if (value > (double)most)
    return ply_complain(ply, "a list of %.0f values does not fit into the rest of the file", value);
  *count = (int64_t)value;
  return true;
}

bool ply_skip_property(struct ply *ply, const struct ply_property *property) {
  int64_t count = 1;
  if (property->list && !ply_read_count(ply, property, &count)) return false;
  return ply_skip_values(ply, property->type, count);
}
