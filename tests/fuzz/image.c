// Fuzzes the image readers: the first byte chooses the extension and the encoding, the rest is the
// file. Whatever it is, it is decoded or refused in one line.
#include "image/raster.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static const char *const paths[] = {"a.png", "a.jpg", "a.tga", "a.hdr", "a.pfm", "a.exr"};
enum { N_PATHS = sizeof paths / sizeof *paths };

static uint32_t get_word(const unsigned char *at) {
  return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

// Checksums made right, or nearly all changes to a png would be found by them alone.
static void mend_png(unsigned char *data, size_t length) {
  for (size_t at = 8; at + 12 <= length;) {
    size_t n = get_word(data + at);
    if (n > length - at - 12) return;
    uint32_t sum = (uint32_t)crc32(0, data + at + 4, (uInt)(n + 4));
    for (int b = 0; b < 4; b++) data[at + 8 + n + (size_t)b] = (unsigned char)(sum >> 8 * (3 - b));
    at += n + 12;
  }
}

static void use(const struct raster *raster) {
  double sum = 0;
  for (int y = 0; y < raster->height; y++)
    for (int x = 0; x < raster->width; x++)
      for (int c = 0; c < raster->n_channels; c++) sum += raster_value(raster, x, y, c);
  if (sum - sum != 0) abort(); // finite, as raster.h says, and so few that no sum overflows
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length) {
  static struct arena keep, scratch;
  if (!keep.next) keep = arena_reserve(), scratch = arena_reserve();
  if (length < 1) return 0;
  const char *path = paths[data[0] % N_PATHS];
  struct encoding encoding = {data[0] / N_PATHS % 3, 2.2};
  struct arena arena = keep, files = scratch;
  // No byte more than the file has, so that one read behind it is seen.
  unsigned char *copy = arena_new(&files, unsigned char, (ptrdiff_t)length - 1);
  memcpy(copy, data + 1, length - 1);
  if (path == paths[0]) mend_png(copy, length - 1);
  struct raster raster;
  struct problem problem = {0};
  bool ok = raster_decode((struct text){(char *)copy, (ptrdiff_t)length - 1}, path, encoding,
                          &arena, files, &raster, &problem);
  if (ok != (problem.text[0] == 0) || strchr(problem.text, '\n')) abort();
  if (ok) use(&raster);
  return 0;
}
