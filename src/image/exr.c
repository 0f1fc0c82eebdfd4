// OpenEXR through OpenEXRCore's C API; its types stay in this file. Written: one scanline part,
// 32-bit float channels, ZIP, no time, host or commit: the same image gives the same bytes (with
// the same zlib). The library works on our stream or our bytes, so it never opens or names a file.
#include "image/format.h"

#include <OpenEXR/openexr.h>
#include <string.h>

static const char manifest_attribute[] = "photonlab/manifest";

// Its default prints to stderr; we take the result codes.
static void on_error(exr_const_context_t file, exr_result_t code, const char *message) {
  (void)file, (void)code, (void)message;
}

static bool complain(struct problem *problem, const char *path, const char *what,
                     exr_result_t code) {
  return problem_set(problem, "%s: %s: %s", path, what, exr_get_default_error_message(code));
}

static bool same_name(const char *a, const char *b) { return strcmp(a, b) == 0; }

// ---- writing ----

static int64_t stream_write(exr_const_context_t file, void *stream, const void *bytes, uint64_t n,
                            uint64_t offset, exr_stream_error_func_ptr_t error) {
  (void)file, (void)error;
  if (fseek(stream, (long)offset, SEEK_SET) != 0) return -1;
  return fwrite(bytes, 1, n, stream) == n ? (int64_t)n : -1;
}

static exr_result_t write_header(exr_context_t file, const struct image *image) {
  int part;
  exr_result_t code = exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part);
  if (!code)
    code = exr_initialize_required_attr_simple(file, part, image->width, image->height,
                                               EXR_COMPRESSION_ZIP);
  for (int c = 0; !code && c < image->n_channels; c++)
    code = exr_add_channel(file, part, image->name[c], EXR_PIXEL_FLOAT,
                           EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  if (!code && image->manifest)
    code = exr_attr_set_string(file, part, manifest_attribute, image->manifest);
  return code ? code : exr_write_header(file);
}

// The library sorts channels, so planes are found by name.
static void aim_encoder(exr_encode_pipeline_t *pipe, const struct image *image, int y) {
  for (int c = 0; c < pipe->channel_count; c++) {
    exr_coding_channel_info_t *channel = &pipe->channels[c];
    int plane = 0;
    while (!same_name(image->name[plane], channel->channel_name)) plane++;
    channel->encode_from_ptr = (const uint8_t *)(image->plane[plane] + (ptrdiff_t)y * image->width);
    channel->user_pixel_stride = 4;
    channel->user_line_stride = 4 * image->width;
    channel->user_bytes_per_element = 4;
    channel->user_data_type = EXR_PIXEL_FLOAT;
  }
}

// Libraries up to OpenEXR 3.4.7 keep deflate's output when it is exactly as long as the pixels,
// and readers take it for the pixels themselves (openexr issue 2306). We store the pixels then.
struct compressor {
  exr_result_t (*library)(exr_encode_pipeline_t *);
};

static exr_result_t compress(exr_encode_pipeline_t *pipe) {
  const struct compressor *compressor = pipe->encoding_user_data;
  exr_result_t code = compressor->library(pipe);
  if (!code && pipe->compressed_bytes == pipe->packed_bytes)
    memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
  return code;
}

static exr_result_t choose_routines(exr_context_t file, exr_encode_pipeline_t *pipe,
                                    struct compressor *compressor) {
  exr_result_t code = exr_encoding_choose_default_routines(file, 0, pipe);
  compressor->library = pipe->compress_fn;
  pipe->encoding_user_data = compressor;
  pipe->compress_fn = compress;
  return code;
}

static exr_result_t write_chunks(exr_context_t file, const struct image *image) {
  exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
  struct compressor compressor;
  int32_t lines;
  exr_result_t code = exr_get_scanlines_per_chunk(file, 0, &lines);
  for (int y = 0; !code && y < image->height; y += lines) {
    exr_chunk_info_t chunk;
    code = exr_write_scanline_chunk_info(file, 0, y, &chunk);
    if (!code)
      code = y == 0 ? exr_encoding_initialize(file, 0, &chunk, &pipe)
                    : exr_encoding_update(file, 0, &chunk, &pipe);
    if (code) break;
    aim_encoder(&pipe, image, y);
    if (y == 0) code = choose_routines(file, &pipe, &compressor);
    if (!code) code = exr_encoding_run(file, 0, &pipe);
  }
  exr_encoding_destroy(file, &pipe);
  return code;
}

bool exr_file_write(FILE *stream, const char *path, const struct image *image,
                    struct problem *problem) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = on_error;
  setup.user_data = stream;
  setup.write_fn = stream_write;
  setup.zip_level = 6;
  exr_context_t file;
  exr_result_t code = exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &setup);
  if (code) return complain(problem, path, "cannot write it", code);
  code = write_header(file, image);
  if (!code) code = write_chunks(file, image);
  exr_result_t closed = exr_finish(&file);
  if (!code) code = closed;
  return code ? complain(problem, path, "cannot write it", code) : true;
}

// ---- reading ----

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
    return 1032;
  default:
    return 0; // loses bits
  }
}

static bool check_kind(exr_context_t file, const char *path, struct problem *problem) {
  int parts;
  exr_storage_t storage;
  exr_compression_t compression;
  if (exr_get_count(file, &parts) || parts != 1)
    return problem_set(problem, "%s: has several parts; only single-part files are read", path);
  if (exr_get_storage(file, 0, &storage) || storage != EXR_STORAGE_SCANLINE)
    return problem_set(problem, "%s: is tiled or deep; only scanline files are read", path);
  if (exr_get_compression(file, 0, &compression) || !expansion(compression))
    return problem_set(problem, "%s: its compression loses bits; save it with zip", path);
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
  if (!check_kind(file, path, problem)) return false;
  exr_result_t code = exr_get_channels(file, 0, &outline->channels);
  if (code) return complain(problem, path, "has no channels", code);
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
  if (!exr_attr_get_string(file, 0, manifest_attribute, &length, &manifest))
    image.manifest = arena_string(arena, manifest, length);
  return image;
}

static void aim_decoder(exr_decode_pipeline_t *pipe, const struct image *image, int row) {
  for (int c = 0; c < pipe->channel_count; c++) {
    exr_coding_channel_info_t *channel = &pipe->channels[c];
    int plane = 0;
    while (!same_name(image->name[plane], channel->channel_name)) plane++;
    channel->decode_to_ptr = (uint8_t *)(image->plane[plane] + (ptrdiff_t)row * image->width);
    channel->user_pixel_stride = 4;
    channel->user_line_stride = 4 * image->width;
    channel->user_bytes_per_element = 4;
    channel->user_data_type = EXR_PIXEL_FLOAT;
  }
}

// The library does not look whether uncompressed pixels are all there.
static exr_result_t find_chunk(exr_context_t file, int y, exr_chunk_info_t *chunk) {
  exr_result_t code = exr_read_scanline_chunk_info(file, 0, y, chunk);
  if (code || chunk->compression != EXR_COMPRESSION_NONE) return code;
  return chunk->packed_size == chunk->unpacked_size ? EXR_ERR_SUCCESS : EXR_ERR_CORRUPT_CHUNK;
}

static exr_result_t read_chunks(exr_context_t file, const struct image *image, int32_t top) {
  exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
  int32_t lines;
  exr_result_t code = exr_get_scanlines_per_chunk(file, 0, &lines);
  for (int64_t row = 0; !code && row < image->height; row += lines) {
    exr_chunk_info_t chunk;
    code = find_chunk(file, (int)(top + row), &chunk);
    if (!code)
      code = row == 0 ? exr_decoding_initialize(file, 0, &chunk, &pipe)
                      : exr_decoding_update(file, 0, &chunk, &pipe);
    if (code) break;
    aim_decoder(&pipe, image, (int)row);
    if (row == 0) code = exr_decoding_choose_default_routines(file, 0, &pipe);
    if (!code) code = exr_decoding_run(file, 0, &pipe);
  }
  exr_decoding_destroy(file, &pipe);
  return code;
}

bool exr_file_read(struct text text, const char *path, struct arena *arena, struct image *image,
                   struct problem *problem) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = on_error;
  setup.user_data = &text;
  setup.read_fn = bytes_read;
  setup.size_fn = bytes_size;
  setup.flags =
      EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  exr_context_t file;
  exr_result_t code = exr_start_read(&file, path, &setup);
  if (code) return complain(problem, path, "not an exr file we can read", code);
  struct outline outline;
  bool ok = read_outline(file, path, text.length, &outline, problem);
  if (ok) {
    *image = make_image(file, &outline, arena);
    code = read_chunks(file, image, outline.top);
    if (code) ok = complain(problem, path, "damaged exr file", code);
  }
  exr_finish(&file);
  return ok;
}
