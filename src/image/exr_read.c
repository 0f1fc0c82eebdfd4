// OpenEXR read: one part of scanlines or tiles (of several resolutions the finest), any channels as
// 32-bit floats.
#include "image/exr.h"

#include "base/exact.h"

static int64_t bytes_read(exr_const_context_t file, void *text, void *to, uint64_t n,
                          uint64_t offset, exr_stream_error_func_ptr_t error) {
  (void)file, (void)error;
  const struct text *bytes = text;
  uint64_t length = (uint64_t)bytes->length;
  if (offset >= length) return 0;
  if (n > length - offset) n = length - offset;
  memcpy(to, bytes->data + offset, n);
  return (int64_t)n;
}

static int64_t bytes_size(exr_const_context_t file, void *text) {
  (void)file;
  return ((const struct text *)text)->length;
}

// What the file says of itself, checked before anything is allocated.
struct outline {
  int32_t width, height, top;
  bool tiled;
  const exr_attr_chlist_t *channels;
};

// Bytes one byte of the file can become: deflate's limit, which run lengths and PIZ stay below.
static int expansion(exr_compression_t compression) {
  switch (compression) {
  case EXR_COMPRESSION_NONE:
    return 1;
  case EXR_COMPRESSION_RLE:
  case EXR_COMPRESSION_ZIPS:
  case EXR_COMPRESSION_ZIP:
  case EXR_COMPRESSION_PIZ:
  case EXR_COMPRESSION_PXR24:
  case EXR_COMPRESSION_B44:
  case EXR_COMPRESSION_B44A:
    return 1032;
  default:
    return 0; // DWA: cosines in floats, whose bits depend on the processor
  }
}

static bool check_kind(exr_context_t file, const char *path, struct outline *outline,
                       struct problem *problem) {
  int parts;
  exr_storage_t storage;
  exr_compression_t compression;
  if (exr_get_count(file, &parts) || parts != 1)
    return problem_set(problem, "%s: has several parts; only single-part files are read", path);
  if (exr_get_storage(file, 0, &storage) ||
      (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED))
    return problem_set(problem, "%s: is deep; only scanline and tiled files are read", path);
  outline->tiled = storage == EXR_STORAGE_TILED;
  if (exr_get_compression(file, 0, &compression) || !expansion(compression))
    return problem_set(problem, "%s: is compressed with DWA; save it with zip", path);
  return true;
}

// The spaces other than sRGB that pbrt knows; what it does not know it takes for sRGB, and so do
// we.
static bool check_primaries(exr_context_t file, const char *path, struct problem *problem) {
  static const struct {
    const char *name;
    double red[2];
  } other[] = {
      {"DCI-P3", {.68, .32}}, {"Rec. 2020", {.708, .292}}, {"ACES 2065-1", {.7347, .2653}}};
  exr_attr_chromaticities_t of;
  if (exr_attr_get_chromaticities(file, 0, "chromaticities", &of)) return true;
  for (size_t k = 0; k < sizeof other / sizeof *other; k++)
    if (fabs(of.red_x - other[k].red[0]) < 1e-3 * other[k].red[0] &&
        fabs(of.red_y - other[k].red[1]) < 1e-3 * other[k].red[1])
      return problem_set(problem, "%s: has the primaries of %s; convert it to sRGB", path,
                         other[k].name);
  return true;
}

static bool check_channels(const exr_attr_chlist_t *channels, const char *path,
                           struct problem *problem) {
  if (channels->num_channels < 1 || channels->num_channels > IMAGE_MAX_CHANNELS)
    return problem_set(problem, "%s: has %d channels (1 to %d are read)", path,
                       channels->num_channels, IMAGE_MAX_CHANNELS);
  for (int c = 0; c < channels->num_channels; c++)
    if (channels->entries[c].x_sampling != 1 || channels->entries[c].y_sampling != 1)
      return problem_set(problem, "%s: has subsampled channels", path);
  return true;
}

static bool check_window(exr_context_t file, const char *path, struct outline *outline,
                         struct problem *problem) {
  exr_attr_box2i_t data, display;
  if (exr_get_data_window(file, 0, &data) || exr_get_display_window(file, 0, &display))
    return problem_set(problem, "%s: has no data or display window", path);
  int64_t width = (int64_t)data.max.x - data.min.x + 1,
          height = (int64_t)data.max.y - data.min.y + 1;
  if (width < 1 || height < 1 || width > INT32_MAX / 4 || height > INT32_MAX)
    return problem_set(problem, "%s: its data window is empty or too large", path);
  if (memcmp(&data, &display, sizeof data) != 0)
    return problem_set(problem, "%s: is cropped (its data window is not its display window)", path);
  outline->width = (int32_t)width;
  outline->height = (int32_t)height;
  outline->top = data.min.y;
  return true;
}

// Whether so few bytes can hold that many pixels (at least 2 bytes per value before compression).
static bool check_length(exr_context_t file, const struct outline *outline, ptrdiff_t length) {
  exr_compression_t compression;
  int32_t chunks;
  if (exr_get_compression(file, 0, &compression) || exr_get_chunk_count(file, 0, &chunks))
    return false;
  double values = (double)outline->width * outline->height * outline->channels->num_channels;
  return 8.0 * chunks <= (double)length && 2 * values <= (double)length * expansion(compression);
}

static bool read_outline(exr_context_t file, const char *path, ptrdiff_t length,
                         struct outline *outline, struct problem *problem) {
  if (!check_kind(file, path, outline, problem) || !check_primaries(file, path, problem))
    return false;
  exr_result_t code = exr_get_channels(file, 0, &outline->channels);
  if (code) return exr_complain(problem, path, "has no channels", code);
  if (!check_channels(outline->channels, path, problem) ||
      !check_window(file, path, outline, problem))
    return false;
  if (!check_length(file, outline, length))
    return problem_set(problem, "%s: is too short for its %d x %d pixels", path, outline->width,
                       outline->height);
  return true;
}

static struct image make_image(exr_context_t file, const struct outline *outline,
                               struct arena *arena) {
  const char *names[IMAGE_MAX_CHANNELS], *manifest;
  for (int c = 0; c < outline->channels->num_channels; c++)
    names[c] = outline->channels->entries[c].name.str;
  struct image image =
      image_new(outline->width, outline->height, outline->channels->num_channels, names, arena);
  int32_t length;
  if (!exr_attr_get_string(file, 0, EXR_MANIFEST, &length, &manifest))
    image.manifest = arena_string(arena, manifest, length);
  return image;
}

// A chunk is a rectangle of the image: some scanlines, or a tile.
struct block {
  int32_t column, row; // of its first pixel
  exr_chunk_info_t chunk;
};

static void aim_decoder(exr_decode_pipeline_t *pipe, const struct image *image,
                        const struct block *block) {
  for (int c = 0; c < pipe->channel_count; c++) {
    exr_coding_channel_info_t *channel = &pipe->channels[c];
    int plane = 0;
    while (!exr_same_name(image->name[plane], channel->channel_name)) plane++;
    ptrdiff_t first = (ptrdiff_t)block->row * image->width + block->column;
    channel->decode_to_ptr = (uint8_t *)(image->plane[plane] + first);
    channel->user_pixel_stride = 4;
    channel->user_line_stride = 4 * image->width;
    channel->user_bytes_per_element = 4;
    channel->user_data_type = EXR_PIXEL_FLOAT;
  }
}

static exr_result_t read_block(exr_context_t file, const struct image *image,
                               const struct block *block, exr_decode_pipeline_t *pipe) {
  // The library does not look whether uncompressed pixels are all there.
  const exr_chunk_info_t *chunk = &block->chunk;
  if (chunk->compression == EXR_COMPRESSION_NONE && chunk->packed_size != chunk->unpacked_size)
    return EXR_ERR_CORRUPT_CHUNK;
  bool first = block->row == 0 && block->column == 0;
  exr_result_t code = first ? exr_decoding_initialize(file, 0, chunk, pipe)
                            : exr_decoding_update(file, 0, chunk, pipe);
  if (code) return code;
  aim_decoder(pipe, image, block);
  if (first) code = exr_decoding_choose_default_routines(file, 0, pipe);
  return code ? code : exr_decoding_run(file, 0, pipe);
}

static exr_result_t read_scanlines(exr_context_t file, const struct image *image, int32_t top,
                                   exr_decode_pipeline_t *pipe) {
  int32_t lines;
  exr_result_t code = exr_get_scanlines_per_chunk(file, 0, &lines);
  for (int64_t row = 0; !code && row < image->height; row += lines) {
    struct block block = {0, (int32_t)row, {0}};
    code = exr_read_scanline_chunk_info(file, 0, (int)(top + row), &block.chunk);
    if (!code) code = read_block(file, image, &block, pipe);
  }
  return code;
}

static exr_result_t read_tiles(exr_context_t file, const struct image *image,
                               exr_decode_pipeline_t *pipe) {
  int32_t width, height;
  exr_result_t code = exr_get_tile_sizes(file, 0, 0, 0, &width, &height);
  if (!code && (width < 1 || height < 1)) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t row = 0; !code && row < image->height; row += height)
    for (int64_t column = 0; !code && column < image->width; column += width) {
      struct block block = {(int32_t)column, (int32_t)row, {0}};
      code = exr_read_tile_chunk_info(file, 0, (int)(column / width), (int)(row / height), 0, 0,
                                      &block.chunk);
      if (!code) code = read_block(file, image, &block, pipe);
    }
  return code;
}

static exr_result_t read_chunks(exr_context_t file, const struct image *image,
                                const struct outline *outline) {
  exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
  exr_result_t code = outline->tiled ? read_tiles(file, image, &pipe)
                                     : read_scanlines(file, image, outline->top, &pipe);
  exr_decoding_destroy(file, &pipe);
  return code;
}

bool exr_file_read(struct text text, const char *path, struct arena *arena, struct image *image,
                   struct problem *problem) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = exr_on_error;
  setup.user_data = &text;
  setup.read_fn = bytes_read;
  setup.size_fn = bytes_size;
  setup.flags =
      EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  exr_context_t file;
  exr_result_t code = exr_start_read(&file, path, &setup);
  if (code) return exr_complain(problem, path, "not an exr file we can read", code);
  struct outline outline;
  bool ok = read_outline(file, path, text.length, &outline, problem);
  if (ok) {
    *image = make_image(file, &outline, arena);
    code = read_chunks(file, image, &outline);
    if (code) ok = exr_complain(problem, path, "damaged exr file", code);
  }
  exr_finish(&file);
  return ok;
}
