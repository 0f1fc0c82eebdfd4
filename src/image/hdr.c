// Radiance pictures: three mantissas and a shared exponent, value = mantissa 2^(exponent - 136) as
// pbrt has it (no half added); scanlines flat, or run-length encoded the new or the old way.
// Exposure and primaries in the header are not looked at, as in pbrt.
#include "image/format.h"

#include <stdlib.h>
#include <string.h>

struct hdr {
  const unsigned char *at, *end; // what is left of the file
  const char *path;
  struct problem *problem;
  int width, height;
  bool from_bottom, from_right;
};

// A line of the header without its end; false where there is none.
static bool next_line(struct hdr *hdr, char line[128]) {
  int n = 0;
  while (hdr->at < hdr->end && *hdr->at != '\n') {
    if (n < 127) line[n++] = (char)*hdr->at;
    hdr->at++;
  }
  line[n] = 0;
  if (hdr->at == hdr->end) return false;
  hdr->at++;
  return true;
}

// "-Y 480 +X 640": rows from the top (+Y: bottom), pixels from the left (-X: right).
static bool parse_resolution(struct hdr *hdr, const char *line) {
  char *rest;
  if ((line[0] != '-' && line[0] != '+') || strncmp(line + 1, "Y ", 2) != 0) return false;
  long height = strtol(line + 3, &rest, 10);
  const char *x = rest;
  if ((strncmp(x, " +X ", 4) != 0 && strncmp(x, " -X ", 4) != 0)) return false;
  long width = strtol(x + 4, &rest, 10);
  if (*rest != 0 || height < 1 || width < 1 || height > 1 << 24 || width > 1 << 24) return false;
  hdr->from_bottom = line[0] == '+';
  hdr->from_right = x[1] == '-';
  hdr->width = (int)width;
  hdr->height = (int)height;
  return true;
}

static bool read_header(struct hdr *hdr) {
  char line[128];
  bool rgbe = false;
  if (!next_line(hdr, line) || strncmp(line, "#?", 2) != 0)
    return problem_set(hdr->problem, "%s: not a Radiance file (it must begin with #?)", hdr->path);
  do {
    if (!next_line(hdr, line))
      return problem_set(hdr->problem, "%s: ends in its header", hdr->path);
    if (strcmp(line, "FORMAT=32-bit_rle_rgbe") == 0) rgbe = true;
  } while (line[0] != 0);
  if (!rgbe) return problem_set(hdr->problem, "%s: is not FORMAT=32-bit_rle_rgbe", hdr->path);
  if (!next_line(hdr, line) || !parse_resolution(hdr, line))
    return problem_set(hdr->problem, "%s: bad resolution (\"-Y height +X width\" expected)",
                       hdr->path);
  // 127 pixels take 8 bytes of new runs, 255 take 4 of old ones; longer old runs are unheard of.
  if ((double)hdr->width * hdr->height > 64.0 * (double)(hdr->end - hdr->at))
    return problem_set(hdr->problem, "%s: is too short for its %d x %d pixels", hdr->path,
                       hdr->width, hdr->height);
  return true;
}

static bool truncated(const struct hdr *hdr) {
  return problem_set(hdr->problem, "%s: ends before its last pixel", hdr->path);
}

static bool overrun(const struct hdr *hdr) {
  return problem_set(hdr->problem, "%s: damaged: a run is longer than its scanline", hdr->path);
}

// One component of a new scanline: a count above 128 repeats the next byte, others copy bytes.
static bool read_component(struct hdr *hdr, unsigned char *pixel) {
  for (int x = 0; x < hdr->width;) {
    if (hdr->end - hdr->at < 2) return truncated(hdr);
    int count = *hdr->at++;
    bool repeat = count > 128;
    if (repeat) count -= 128;
    if (count == 0 || count > hdr->width - x) return overrun(hdr);
    if (hdr->end - hdr->at < (repeat ? 1 : count)) return truncated(hdr);
    for (int k = 0; k < count; k++) pixel[4 * x++] = repeat ? *hdr->at : *hdr->at++;
    if (repeat) hdr->at++;
  }
  return true;
}

// Pixels one by one; 1, 1, 1, n repeats the one before n times (256 n the second time in a row).
static bool read_pixels(struct hdr *hdr, unsigned char *pixel) {
  int shift = 0;
  for (int x = 0; x < hdr->width; hdr->at += 4) {
    if (hdr->end - hdr->at < 4) return truncated(hdr);
    if (hdr->at[0] != 1 || hdr->at[1] != 1 || hdr->at[2] != 1) {
      memcpy(pixel + 4 * (ptrdiff_t)x++, hdr->at, 4);
      shift = 0;
      continue;
    }
    if (shift > 16 || x == 0) return overrun(hdr);
    int64_t count = (int64_t)hdr->at[3] << shift;
    if (count > hdr->width - x) return overrun(hdr);
    for (; count > 0; count--, x++)
      memcpy(pixel + 4 * (ptrdiff_t)x, pixel + 4 * (ptrdiff_t)(x - 1), 4);
    shift += 8;
  }
  return true;
}

static bool read_scanline(struct hdr *hdr, unsigned char *pixel) {
  const unsigned char *at = hdr->at;
  bool may_be_new = hdr->width >= 8 && hdr->width <= 32767 && hdr->end - at >= 4;
  if (!may_be_new || at[0] != 2 || at[1] != 2 || at[2] & 128) return read_pixels(hdr, pixel);
  if ((at[2] << 8 | at[3]) != hdr->width)
    return problem_set(hdr->problem, "%s: damaged: a scanline of another width", hdr->path);
  hdr->at += 4;
  for (int c = 0; c < 4; c++)
    if (!read_component(hdr, pixel + c)) return false;
  return true;
}

// 2^(exponent - 136), exactly: down to 2^-135, below the normal range of floats.
static double scale_of(int exponent) {
  double scale = 1;
  for (int e = 136; e < exponent; e++) scale *= 2;
  for (int e = 136; e > exponent; e--) scale /= 2;
  return scale;
}

bool hdr_file_read(struct text text, const char *path, struct arena *arena, struct image *image,
                   struct problem *problem) {
  static const char *const colour[] = {"R", "G", "B"};
  const unsigned char *data = (const unsigned char *)text.data;
  struct hdr hdr = {.at = data, .end = data + text.length, .path = path, .problem = problem};
  if (!read_header(&hdr)) return false;
  double scale[256] = {0}; // exponent 0 is black
  for (int e = 1; e < 256; e++) scale[e] = scale_of(e);
  *image = image_new(hdr.width, hdr.height, 3, colour, arena);
  unsigned char *pixel = arena_new(arena, unsigned char, 4 * (ptrdiff_t)hdr.width);
  for (int row = 0; row < hdr.height; row++) {
    if (!read_scanline(&hdr, pixel)) return false;
    ptrdiff_t y = hdr.from_bottom ? hdr.height - 1 - row : row;
    for (int k = 0; k < hdr.width; k++) {
      ptrdiff_t at = y * hdr.width + (hdr.from_right ? hdr.width - 1 - k : k);
      for (int c = 0; c < 3; c++)
        image->plane[c][at] =
            (float)(pixel[4 * (ptrdiff_t)k + c] * scale[pixel[4 * (ptrdiff_t)k + 3]]);
    }
  }
  return true;
}
