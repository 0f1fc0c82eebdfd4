// JPEG (baseline and progressive, gray and YCbCr) through libjpeg; its types stay in this file.
// The same bits everywhere: the integer inverse transform and the triangle-filtered chroma, which
// libjpeg-turbo computes alike in C and in every instruction set (its float and fast transforms,
// its merged upsampling and the smoothing of unfinished progressive files are not; we use none of
// them).
#include "image/format.h"

#include <setjmp.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>

// Each scan of a progressive file visits all blocks, however few bits it has; a scan for every bit
// of every coefficient of three components is still below this.
enum { MAX_SCANS = 4096 };

struct jpg_job {
  struct jpeg_error_mgr errors; // first: the library hands it back
  struct jpeg_progress_mgr progress;
  jmp_buf jump;
  const char *path;
  struct problem *problem;
};

static _Noreturn void give_up(j_common_ptr jpeg) {
  longjmp(((struct jpg_job *)jpeg->err)->jump, 1);
}

static void on_error(j_common_ptr jpeg) {
  struct jpg_job *job = (struct jpg_job *)jpeg->err;
  char message[JMSG_LENGTH_MAX];
  jpeg->err->format_message(jpeg, message);
  problem_set(job->problem, "%s: not a jpg file we can read: %s", job->path, message);
  give_up(jpeg);
}

// What the library would only warn of is missing or damaged data.
static void on_message(j_common_ptr jpeg, int level) {
  if (level < 0) on_error(jpeg);
}

static void refuse(j_decompress_ptr jpeg, const char *why) {
  struct jpg_job *job = (struct jpg_job *)jpeg->err;
  problem_set(job->problem, "%s: %s", job->path, why);
  give_up((j_common_ptr)jpeg);
}

static void on_progress(j_common_ptr jpeg) {
  if (((j_decompress_ptr)jpeg)->input_scan_number > MAX_SCANS)
    refuse((j_decompress_ptr)jpeg, "has more scans than a progressive jpg needs");
}

// Huffman codes are of at least one bit, and a block of 64 samples has at least one code.
static void check_header(j_decompress_ptr jpeg, ptrdiff_t length) {
  if (jpeg->arith_code) refuse(jpeg, "is an arithmetic-coded jpg; save it as a usual one");
  if (jpeg->jpeg_color_space != JCS_GRAYSCALE && jpeg->jpeg_color_space != JCS_YCbCr &&
      jpeg->jpeg_color_space != JCS_RGB)
    refuse(jpeg, "is a CMYK jpg; save it as RGB");
  if ((double)jpeg->image_width * jpeg->image_height > 512.0 * (double)length)
    refuse(jpeg, "is too short for the size it claims");
}

static void start(j_decompress_ptr jpeg, struct text text) {
  jpeg_mem_src(jpeg, (const unsigned char *)text.data, (unsigned long)text.length);
  jpeg_read_header(jpeg, TRUE);
  check_header(jpeg, text.length);
  if (jpeg->jpeg_color_space != JCS_GRAYSCALE) jpeg->out_color_space = JCS_RGB;
  jpeg->dct_method = JDCT_ISLOW;
  jpeg->do_fancy_upsampling = TRUE;
  jpeg->do_block_smoothing = FALSE;
  jpeg_start_decompress(jpeg);
}

static bool read_all(j_decompress_ptr jpeg, struct jpg_job *job, struct text text,
                     struct arena *arena, struct raster *raster) {
  if (setjmp(job->jump)) return false;
  start(jpeg, text);
  ptrdiff_t row = (ptrdiff_t)jpeg->output_width * jpeg->output_components;
  unsigned char *byte = arena_new(arena, unsigned char, row * jpeg->output_height);
  *raster = (struct raster){.width = (int)jpeg->output_width,
                            .height = (int)jpeg->output_height,
                            .n_channels = jpeg->output_components,
                            .byte = byte};
  while (jpeg->output_scanline < jpeg->output_height)
    jpeg_read_scanlines(jpeg, &(JSAMPROW){byte + jpeg->output_scanline * row}, 1);
  jpeg_finish_decompress(jpeg);
  return true;
}

bool jpg_file_texels(struct text text, const char *path, struct encoding encoding,
                     struct arena *arena, struct arena scratch, struct raster *raster,
                     struct problem *problem) {
  (void)encoding, (void)scratch;
  struct jpg_job job = {.path = path, .problem = problem};
  struct jpeg_decompress_struct jpeg = {.err = jpeg_std_error(&job.errors)};
  job.errors.error_exit = on_error;
  job.errors.emit_message = on_message;
  job.progress.progress_monitor = on_progress;
  if (setjmp(job.jump)) return false; // before anything of the library's is there
  jpeg_create_decompress(&jpeg);
  jpeg.progress = &job.progress;
  bool ok = read_all(&jpeg, &job, text, arena, raster);
  jpeg_destroy_decompress(&jpeg);
  return ok;
}
