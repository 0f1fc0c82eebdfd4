#include "mesh/ply.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// The two names of each type, in the order of ply_type.
static const char *const type_names[PLY_N_TYPES][2] = {
    {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
    {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"},
};

bool ply_complain(const struct ply *ply, const char *format, ...) {
  char text[sizeof ply->problem->text];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (ply->binary)
    return problem_set(ply->problem, "%s: byte %td: %s", ply->file, ply->at - ply->begin, text);
  return problem_set(ply->problem, "%s:%d: %s", ply->file, ply->line, text);
}

bool ply_is(struct ply_word word, const char *text) {
  return (size_t)word.length == strlen(text) && memcmp(word.text, text, strlen(text)) == 0;
}

struct ply_quote ply_quote(struct ply_word word) {
  struct ply_quote quote = {{0}};
  ptrdiff_t most = (ptrdiff_t)sizeof quote.text - 4;
  for (ptrdiff_t k = 0; k < word.length && k < most; k++)
    quote.text[k] = word.text[k] > ' ' && word.text[k] <= '~' ? word.text[k] : '?';
  if (word.length > most) strcpy(quote.text + most, "...");
  return quote;
}

// ---- lines ----
static struct ply_word next_word(struct ply_word *line) {
  while (line->length > 0 && (*line->text == ' ' || *line->text == '\t'))
    line->text++, line->length--;
  struct ply_word word = {line->text, 0};
  while (line->length > 0 && *line->text != ' ' && *line->text != '\t')
    line->text++, line->length--, word.length++;
  return word;
}

static bool next_line(struct ply *ply, struct ply_word *line) {
  const char *end = memchr(ply->at, '\n', (size_t)(ply->end - ply->at));
  if (!end) {
    ply->line++;
    return ply_complain(ply, "the file ends before \"end_header\"");
  }
  *line = (struct ply_word){ply->at, end - ply->at};
  if (line->length > 0 && end[-1] == '\r') line->length--;
  ply->at = end + 1;
  ply->line++;
  return true;
}

// ---- what a line may say; each gets the words after the first ----
static bool read_format(struct ply *ply, struct ply_word line) {
  static const char *const names[] = {NULL, "ascii", "binary_little_endian", "binary_big_endian"};
  struct ply_word name = next_word(&line), version = next_word(&line);
  if (ply->format) return ply_complain(ply, "the format is given twice");
  if (!ply_is(version, "1.0"))
    return ply_complain(ply, "the format's version is \"%s\", not 1.0", ply_quote(version).text);
  for (int k = PLY_ASCII; k <= PLY_BIG_ENDIAN; k++)
    if (ply_is(name, names[k])) ply->format = k;
  return ply->format || ply_complain(ply,
                                     "\"%s\" is not one of the formats ascii, "
                                     "binary_little_endian, binary_big_endian",
                                     ply_quote(name).text);
}

static bool read_element(struct ply *ply, struct ply_word line, struct arena *arena) {
  struct ply_element element = {.name = next_word(&line)};
  struct ply_word count = next_word(&line);
  if (element.name.length == 0) return ply_complain(ply, "the element has no name");
  if (count.length == 0 || count.length > 18) count.length = 0; // 10^18 rows fit no file
  for (ptrdiff_t k = 0; k < count.length; k++) {
    if (count.text[k] < '0' || count.text[k] > '9') count.length = 0;
    element.count = 10 * element.count + (count.text[k] - '0');
  }
  if (count.length == 0)
    return ply_complain(ply, "element %s needs a number of rows", ply_quote(element.name).text);
  *arena_push(arena, &ply->elements) = element;
  return true;
}

static bool read_type(const struct ply *ply, struct ply_word word, enum ply_type *type) {
  for (int k = 0; k < PLY_N_TYPES; k++)
    if (ply_is(word, type_names[k][0]) || ply_is(word, type_names[k][1])) {
      *type = k;
      return true;
    }
  return ply_complain(ply, "\"%s\" is not a type of PLY", ply_quote(word).text);
}

static bool read_property(struct ply *ply, struct ply_word line, struct arena *arena) {
  struct ply_property property = {0};
  if (ply->elements.count == 0) return ply_complain(ply, "a property before the first element");
  struct ply_word word = next_word(&line);
  if (ply_is(word, "list")) {
    property.list = true;
    if (!read_type(ply, next_word(&line), &property.count_type)) return false;
    if (property.count_type >= PLY_FLOAT32)
      return ply_complain(ply, "the length of a list must be of an integer type");
    word = next_word(&line);
  }
  if (!read_type(ply, word, &property.type)) return false;
  property.name = next_word(&line);
  if (property.name.length == 0) return ply_complain(ply, "the property has no name");
  *arena_push(arena, &ply->elements.item[ply->elements.count - 1].properties) = property;
  return true;
}

static bool read_line(struct ply *ply, struct ply_word line, struct arena *arena) {
  struct ply_word word = next_word(&line);
  if (ply_is(word, "format")) return read_format(ply, line);
  if (ply_is(word, "element")) return read_element(ply, line, arena);
  if (ply_is(word, "property")) return read_property(ply, line, arena);
  return ply_is(word, "comment") || ply_is(word, "obj_info") || word.length == 0 ||
         ply_complain(ply, "\"%s\" does not belong in the header of a PLY file",
                      ply_quote(word).text);
}

bool ply_read_header(struct ply *ply, struct arena *arena) {
  struct ply_word line = {ply->at, 0};
  if (!memchr(ply->at, '\n', (size_t)(ply->end - ply->at)) || !next_line(ply, &line) ||
      !ply_is(line, "ply"))
    return problem_set(ply->problem, "%s: is not a PLY file: its first line is not \"ply\"",
                       ply->file);
  for (;;) {
    if (!next_line(ply, &line)) return false;
    if (ply_is(line, "end_header")) break;
    if (!read_line(ply, line, arena)) return false;
  }
  if (!ply->format) return ply_complain(ply, "the header has no \"format\" line");
  ply->binary = ply->format != PLY_ASCII;
  ply->line++;
  return true;
}
