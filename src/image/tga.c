// Truevision TGA 2.0: colour-mapped, true-colour and gray images, plain or run-length encoded, from
// any corner. Alpha is dropped, as pbrt does.
#include "image/format.h"

enum { HEADER = 18 };

struct tga {
  const unsigned char *at, *end; // what is left of the file
  const char *path;
  struct problem *problem;
  int width, height;
  int bytes;   // of a pixel in the file
  int kind;    // 1 colour-mapped, 2 true-colour, 3 gray
  bool packed; // run-length encoded
  bool from_top, from_right;
  const unsigned char *map; // colour-mapped: entries
  int map_first, map_count, map_bytes;
};

static int get_16(const unsigned char *at) { return at[0] | at[1] << 8; }

// Blue, green, red from 5 bits each, or 8 bits each and perhaps alpha.
static void get_colour(const unsigned char *at, int bytes, unsigned char rgb[3]) {
  if (bytes >= 3) {
    for (int c = 0; c < 3; c++) rgb[c] = at[2 - c];
    return;
  }
  int word = get_16(at);
  for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)((word >> 5 * (2 - c) & 31) * 255 / 31);
}

static bool read_map(struct tga *tga, const unsigned char *header) {
  tga->map_first = get_16(header + 3);
  tga->map_count = get_16(header + 5);
  tga->map_bytes = (header[7] + 7) / 8;
  ptrdiff_t length = (ptrdiff_t)tga->map_count * tga->map_bytes;
  if (length > tga->end - tga->at)
    return problem_set(tga->problem, "%s: ends within its colour map", tga->path);
  tga->map = tga->at;
  tga->at += length;
  if (tga->kind != 1) return true;
  if (header[1] != 1 || tga->map_count == 0 || tga->map_bytes < 2 || tga->map_bytes > 4)
    return problem_set(tga->problem, "%s: has no colour map of 15 to 32 bits", tga->path);
  return true;
}

// Plain pixels are all there; a packet gives at most 128 for its byte and a pixel.
static bool check_length(const struct tga *tga) {
  ptrdiff_t n = (ptrdiff_t)tga->width * tga->height, length = tga->end - tga->at;
  if (tga->packed ? n <= length / (1 + tga->bytes) * 128 : n <= length / tga->bytes) return true;
  return problem_set(tga->problem, "%s: is too short for its %d x %d pixels", tga->path, tga->width,
                     tga->height);
}

static bool read_header(struct tga *tga) {
  const unsigned char *header = tga->at;
  if (tga->end - tga->at < HEADER || tga->end - tga->at < HEADER + header[0])
    return problem_set(tga->problem, "%s: is too short for a tga file", tga->path);
  tga->at += HEADER + header[0];
  tga->kind = header[2] & 7;
  tga->packed = header[2] & 8;
  tga->width = get_16(header + 12);
  tga->height = get_16(header + 14);
  tga->bytes = (header[16] + 7) / 8;
  tga->from_right = header[17] & 16;
  tga->from_top = header[17] & 32;
  int lo = tga->kind == 2 ? 2 : 1, hi = tga->kind == 2 ? 4 : 2;
  if ((header[2] & ~8) < 1 || (header[2] & ~8) > 3 || header[17] & 192 || header[1] > 1)
    return problem_set(tga->problem, "%s: not a tga file of type 1, 2, 3, 9, 10 or 11", tga->path);
  if (tga->width == 0 || tga->height == 0)
    return problem_set(tga->problem, "%s: has no pixels", tga->path);
  if ((header[16] % 8 > 0 && header[16] != 15) || tga->bytes < lo || tga->bytes > hi)
    return problem_set(tga->problem, "%s: has %d bits a pixel (tga: 8, 15, 16, 24 or 32)",
                       tga->path, header[16]);
  return read_map(tga, header) && check_length(tga);
}

static bool put_pixel(const struct tga *tga, const unsigned char *at, unsigned char *pixel) {
  if (tga->kind == 3) {
    pixel[0] = at[0]; // a second byte is alpha
    return true;
  }
  if (tga->kind == 2) {
    get_colour(at, tga->bytes, pixel);
    return true;
  }
  int row = (tga->bytes == 2 ? get_16(at) : at[0]) - tga->map_first;
  if (row < 0 || row >= tga->map_count)
    return problem_set(tga->problem, "%s: a pixel asks for entry %d of a colour map of %d to %d",
                       tga->path, row + tga->map_first, tga->map_first,
                       tga->map_first + tga->map_count - 1);
  get_colour(tga->map + (ptrdiff_t)row * tga->map_bytes, tga->map_bytes, pixel);
  return true;
}

static ptrdiff_t place_of(const struct tga *tga, ptrdiff_t j) {
  ptrdiff_t x = j % tga->width, y = j / tga->width;
  if (tga->from_right) x = tga->width - 1 - x;
  if (!tga->from_top) y = tga->height - 1 - y;
  return y * tga->width + x;
}

static bool read_pixels(struct tga *tga, unsigned char *byte, int n_channels) {
  ptrdiff_t n = (ptrdiff_t)tga->width * tga->height;
  int left = 0; // pixels of the packet
  bool repeat = false;
  for (ptrdiff_t j = 0; j < n; j++) {
    bool first = left == 0;
    if (tga->packed && first && tga->at < tga->end) {
      repeat = *tga->at & 128;
      left = 1 + (*tga->at++ & 127);
    }
    if (repeat && !first) tga->at -= tga->bytes;
    if (tga->end - tga->at < tga->bytes)
      return problem_set(tga->problem, "%s: ends before its last pixel", tga->path);
    if (!put_pixel(tga, tga->at, byte + place_of(tga, j) * n_channels)) return false;
    tga->at += tga->bytes;
    if (tga->packed) left--;
  }
  return true;
}

bool tga_file_texels(struct text text, const char *path, struct encoding encoding,
                     struct arena *arena, struct arena scratch, struct raster *raster,
                     struct problem *problem) {
  (void)encoding, (void)scratch;
  const unsigned char *data = (const unsigned char *)text.data;
  struct tga tga = {.at = data, .end = data + text.length, .path = path, .problem = problem};
  if (!read_header(&tga)) return false;
  int n = tga.kind == 3 ? 1 : 3;
  unsigned char *byte = arena_new(arena, unsigned char, (ptrdiff_t)tga.width *tga.height *n);
  *raster =
      (struct raster){.width = tga.width, .height = tga.height, .n_channels = n, .byte = byte};
  return read_pixels(&tga, byte, n);
}
