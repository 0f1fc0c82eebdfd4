// Texture "imagemap": an image on the unit square of (s, t), its bottom row at t = 0. Always its
// finest level, bilinear ("point": the nearest texel); pbrt blurs it over a pixel's footprint.
// Floats of an image with colours are their mean ("point": red), of one with alpha its alpha, as in
// pbrt.
#include "scene/texture/imagemap.h"
#include "scene/mapping.h"
#include "scene/resize.h"
#include "scene/texture/inputs.h"
#include "scene/wrap.h"

#include <string.h>

struct imagemap {
  struct mapping mapping;
  const struct wrap *wrap;
  const struct raster *raster;
  const char *filename; // with encoding and wrap, what tells rasters apart
  struct encoding encoding;
  double scale;
  bool invert, point, spectrum, gray;
};

const struct texture *imagemap_scaled(const struct texture *texture, double factor,
                                      struct arena *arena) {
  struct imagemap *map = arena_new(arena, struct imagemap, 1);
  struct texture *scaled = arena_new(arena, struct texture, 1);
  *map = *(const struct imagemap *)texture->data;
  map->scale *= factor;
  *scaled = (struct texture){texture->type, map};
  return scaled;
}

// ---- looking up ----

static void look_up_nearest(const struct imagemap *map, double x, double y, int first, int n,
                            double texel[3]) {
  // Halves away from zero, as C's round.
  wrap_texel(map->wrap, map->raster, x < 0 ? -floor(0.5 - x) : floor(x + 0.5),
             y < 0 ? -floor(0.5 - y) : floor(y + 0.5), first, n, texel);
}

static void look_up_bilinear(const struct imagemap *map, double x, double y, int first, int n,
                             double sum[3]) {
  double x0 = floor(x), y0 = floor(y), dx = x - x0, dy = y - y0, corner[4][3];
  for (int k = 0; k < 4; k++)
    wrap_texel(map->wrap, map->raster, x0 + (k & 1), y0 + (k >> 1), first, n, corner[k]);
  for (int c = 0; c < n; c++)
    sum[c] = (1 - dx) * (1 - dy) * corner[0][c] + dx * (1 - dy) * corner[1][c] +
             (1 - dx) * dy * corner[2][c] + dx * dy * corner[3][c];
}

// Texel centres are at halves; the image's first row is its top, t runs from the bottom.
static void look_up(const struct imagemap *map, const double st[2], int first, int n,
                    double texel[3]) {
  double x = st[0] * map->raster->width - 0.5, y = (1 - st[1]) * map->raster->height - 0.5;
  (map->point ? look_up_nearest : look_up_bilinear)(map, x, y, first, n, texel);
}

static double look_up_float(const struct imagemap *map, const double st[2]) {
  int n = map->raster->n_channels;
  double texel[3];
  bool mean = n == 3 && !map->point;
  look_up(map, st, n == 4 && !map->point ? 3 : 0, mean ? 3 : 1, texel);
  return mean ? (texel[0] + texel[1] + texel[2]) / 3 : texel[0];
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct imagemap *map = texture->data;
  bool three = map->spectrum && map->raster->n_channels > 1;
  double st[2];
  mapping_st(&map->mapping, surface, st);
  if (map->spectrum)
    look_up(map, st, 0, three ? 3 : 1, value);
  else
    value[0] = look_up_float(map, st);
  for (int c = 0; c < (three ? 3 : 1); c++) {
    value[c] = map->invert ? 1 - map->scale * value[c] : map->scale * value[c];
    if ((map->spectrum || map->invert) && value[c] < 0) value[c] = 0;
  }
  if (!three) value[1] = value[2] = value[0];
}

// ---- reading ----

static bool is_gray_raster(const struct raster *raster) {
  if (raster->n_channels == 1) return true;
  for (int y = 0; y < raster->height; y++)
    for (int x = 0; x < raster->width; x++) {
      double r = raster_value(raster, x, y, 0);
      if (raster_value(raster, x, y, 1) != r || raster_value(raster, x, y, 2) != r) return false;
    }
  return true;
}

static bool read_wrap(struct params *params, struct imagemap *map) {
  const char *name = params_string(params, "wrap", "repeat");
  map->wrap = wrap_find(name);
  return map->wrap ||
         params_complain(params, "wrap",
                         "\"%s\" does not wrap (known: repeat, black, clamp, octahedralsphere)",
                         name);
}

static bool read_filter(struct params *params, struct imagemap *map) {
  static const char *const names[] = {"point", "bilinear", "trilinear", "ewa", "EWA"};
  const char *name = params_string(params, "filter", "bilinear");
  params_float(params, "maxanisotropy", 8); // of a filter's footprint, which we do not have
  map->point = strcmp(name, "point") == 0;
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (strcmp(names[k], name) == 0) return true;
  return params_complain(params, "filter",
                         "\"%s\" is no filter (known: point, bilinear, trilinear, EWA)", name);
}

static bool read_encoding(struct params *params, struct imagemap *map) {
  const char *name = params_string(params, "encoding", "sRGB");
  return encoding_parse(name, &map->encoding) ||
         params_complain(params, "encoding",
                         "\"%s\" is no encoding (known: sRGB, linear, gamma and a number)", name);
}

static bool is_same_file(const struct imagemap *a, const struct imagemap *b) {
  return strcmp(a->filename, b->filename) == 0 && a->encoding.curve == b->encoding.curve &&
         a->encoding.gamma == b->encoding.gamma && a->wrap == b->wrap;
}

// The raster of a texture named before, so that every file is read once.
static const struct imagemap *find_same(const struct named_textures *textures,
                                        const struct imagemap *map) {
  for (ptrdiff_t k = 0; k < textures->count; k++) {
    const struct texture *other = &textures->item[k].texture;
    if (other->type == &texture_imagemap && is_same_file(other->data, map)) return other->data;
  }
  return NULL;
}

static bool read_raster(struct scene_builder *builder, struct params *params, struct imagemap *map,
                        struct arena scratch) {
  struct raster *raster = arena_new(builder->arena, struct raster, 1);
  struct problem problem = {0};
  struct text text;
  if (!scene_read_file(builder, params, "filename", map->filename, &scratch, &text)) return false;
  if (!raster_decode(text, map->filename, map->encoding, builder->arena, scratch, raster, &problem))
    return params_complain(params, "filename", "%s", problem.text);
  resize_to_powers_of_two(raster, map->wrap, builder->arena, scratch);
  map->raster = raster;
  map->gray = is_gray_raster(raster);
  return true;
}

static bool read_image(struct scene_builder *builder, struct params *params, struct imagemap *map) {
  const char *filename = params_string(params, "filename", "");
  if (!*filename) return params_complain(params, "filename", "imagemap needs \"string filename\"");
  map->filename = arena_string(builder->arena, filename, (ptrdiff_t)strlen(filename));
  const struct imagemap *same = find_same(&builder->spectrum_textures, map);
  if (!same) same = find_same(&builder->float_textures, map);
  if (same) {
    map->raster = same->raster;
    map->gray = same->gray;
    return true;
  }
  struct arena scratch = arena_reserve();
  bool ok = read_raster(builder, params, map, scratch);
  arena_release(scratch);
  return ok;
}

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct imagemap *map = arena_new(builder->arena, struct imagemap, 1);
  map->scale = params_float(params, "scale", 1);
  map->invert = params_bool(params, "invert", false);
  map->spectrum = spectrum;
  texture->data = map;
  return mapping_read(builder, params, &map->mapping) && read_wrap(params, map) &&
         read_filter(params, map) && read_encoding(params, map) &&
         read_image(builder, params, map) && params_finish(params);
}

static bool is_gray(const struct texture *texture) {
  const struct imagemap *map = texture->data;
  return !map->spectrum || map->gray;
}

const struct texture_type texture_imagemap = {
    .name = "imagemap",
    .about = "an image (png, jpg, tga, exr, pfm, hdr), its finest level",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
