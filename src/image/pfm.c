// Portable float map: "PF" (colour) or "Pf" (gray), width, height, a scale whose sign gives the
// byte order (negative: little endian), then 32-bit floats, the bottom row first.
#include "image/format.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

bool pfm_file_write(FILE *stream, const char *path, const struct image *image,
                    struct problem *problem) {
  const float *plane[3];
  int n = image_colour(image, path, plane, problem);
  if (!n) return false;
  fprintf(stream, "%s\n%d %d\n-1.0\n", n == 3 ? "PF" : "Pf", image->width, image->height);
  for (int y = image->height - 1; y >= 0; y--)
    for (int x = 0; x < image->width; x++)
      for (int c = 0; c < n; c++) {
        uint32_t bits;
        memcpy(&bits, &plane[c][(ptrdiff_t)y * image->width + x], 4);
        for (int b = 0; b < 4; b++) putc((int)(bits >> 8 * b & 255), stream);
      }
  return true; // file_commit looks at the stream's error
}

static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

// The next word of the header, which ends at white space; an empty string if there is none.
static const char *next_word(const char **at, const char *end, char word[32]) {
  while (*at < end && is_space(**at)) (*at)++;
  int n = 0;
  while (*at < end && !is_space(**at) && n < 31) word[n++] = *(*at)++;
  word[*at < end && is_space(**at) ? n : 0] = 0;
  return word;
}

static bool parse_size(const char *word, int *size) {
  char *rest;
  long value = strtol(word, &rest, 10);
  *size = (int)value;
  return rest != word && *rest == 0 && value >= 1 && value <= INT_MAX;
}

static bool parse_scale(const char *word, float *scale) {
  char *rest;
  *scale = strtof(word, &rest);
  return rest != word && *rest == 0 && *scale != 0 && *scale - *scale == 0;
}

static float get_float(const unsigned char *at, bool little) {
  uint32_t bits = 0;
  for (int b = 0; b < 4; b++) bits |= (uint32_t)at[b] << 8 * (little ? b : 3 - b);
  float value;
  memcpy(&value, &bits, 4);
  return value;
}

static void get_planes(const unsigned char *at, float scale, struct image *image) {
  float factor = scale < 0 ? -scale : scale;
  for (int y = image->height - 1; y >= 0; y--)
    for (int x = 0; x < image->width; x++)
      for (int c = 0; c < image->n_channels; c++, at += 4) {
        float value = get_float(at, scale < 0);
        image->plane[c][(ptrdiff_t)y * image->width + x] = factor == 1 ? value : factor * value;
      }
}

bool pfm_file_read(struct text text, const char *path, struct arena *arena, struct image *image,
                   struct problem *problem) {
  static const char *const gray[] = {"Y"}, *const colour[] = {"R", "G", "B"};
  const char *at = text.data, *end = text.data + text.length;
  char word[32];
  next_word(&at, end, word);
  bool is_colour = strcmp(word, "PF") == 0;
  if (!is_colour && strcmp(word, "Pf") != 0)
    return problem_set(problem, "%s: not a pfm file (it must begin with PF or Pf)", path);
  int width, height, n = is_colour ? 3 : 1;
  float scale;
  if (!parse_size(next_word(&at, end, word), &width) ||
      !parse_size(next_word(&at, end, word), &height) ||
      !parse_scale(next_word(&at, end, word), &scale))
    return problem_set(problem, "%s: bad pfm header (width, height, scale expected)", path);
  at++; // exactly one white space ends the header
  ptrdiff_t per_row = (ptrdiff_t)width * n * 4;
  if ((end - at) / height != per_row || (end - at) % height != 0)
    return problem_set(problem, "%s: %d x %d pixels need %.0f bytes, the file has %td", path, width,
                       height, (double)per_row * height, end - at);
  *image = image_new(width, height, n, is_colour ? colour : gray, arena);
  get_planes((const unsigned char *)at, scale, image);
  return true;
}
