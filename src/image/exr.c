// OpenEXR written: one scanline part, 32-bit float channels, ZIP, no time, host or commit: the same
// image gives the same bytes (with the same zlib).
#include "image/exr.h"

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
    code = exr_attr_set_string(file, part, EXR_MANIFEST, image->manifest);
  return code ? code : exr_write_header(file);
}

// The library sorts channels, so planes are found by name.
static void aim_encoder(exr_encode_pipeline_t *pipe, const struct image *image, int y) {
  for (int c = 0; c < pipe->channel_count; c++) {
    exr_coding_channel_info_t *channel = &pipe->channels[c];
    int plane = 0;
    while (!exr_same_name(image->name[plane], channel->channel_name)) plane++;
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
  setup.error_handler_fn = exr_on_error;
  setup.user_data = stream;
  setup.write_fn = stream_write;
  setup.zip_level = 6;
  exr_context_t file;
  exr_result_t code = exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &setup);
  if (code) return exr_complain(problem, path, "cannot write it", code);
  code = write_header(file, image);
  if (!code) code = write_chunks(file, image);
  exr_result_t closed = exr_finish(&file);
  if (!code) code = closed;
  return code ? exr_complain(problem, path, "cannot write it", code) : true;
}
