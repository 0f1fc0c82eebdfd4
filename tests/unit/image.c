// Images on disk: what is written is read back bit for bit, bad files are problems, and nothing
// half-written stays.
#define _GNU_SOURCE // mkdtemp
#include "image/image.h"
#include "base/file.h"
#include "numeric/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct arena arena;
static char folder[64];

static const char *path_of(const char *name) { return arena_format(&arena, "%s/%s", folder, name); }

static int files_in_folder(void) {
  int n = 0;
  DIR *dir = opendir(folder);
  while (readdir(dir)) n++;
  closedir(dir);
  return n - 2; // . and ..
}

// Any bits at all, NaN payloads and denormals included, in every other channel; the rest repeats,
// so that compression has something to do.
static struct image image_of_bits(int width, int height, int n, const char *const *names) {
  struct rng_key key = rng_key(rng_hash_name("image bits"), 1, RNG_TEST);
  struct image image = image_new(width, height, n, names, &arena);
  for (int c = 0; c < n; c++)
    for (ptrdiff_t j = 0; j < (ptrdiff_t)width * height; j++) {
      uint32_t counter[4] = {(uint32_t)j, (uint32_t)c, 0, 0}, word[4];
      rng_philox(key, counter, word);
      if (c % 2 == 1) word[0] = UINT32_C(0x4018a3d7) + (uint32_t)(j % 7);
      memcpy(&image.plane[c][j], word, 4);
    }
  return image;
}

static const float *plane_named(const struct image *image, const char *name) {
  for (int c = 0; c < image->n_channels; c++)
    if (strcmp(image->name[c], name) == 0) return image->plane[c];
  fail_msg("no channel %s", name);
  return NULL;
}

static void assert_same_bits(const struct image *a, const struct image *b) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  assert_int_equal(a->n_channels, b->n_channels);
  for (int c = 0; c < a->n_channels; c++)
    assert_memory_equal(a->plane[c], plane_named(b, a->name[c]),
                        (size_t)a->width * (size_t)a->height * 4);
}

static void write_ok(const char *path, const struct image *image) {
  struct problem problem = {0};
  if (!image_write(path, image, &problem)) fail_msg("%s", problem.text);
}

static struct image read_ok(const char *path) {
  struct problem problem = {0};
  struct image image;
  if (!image_read(path, &arena, &image, &problem)) fail_msg("%s", problem.text);
  return image;
}

static struct text bytes_of(const char *path) {
  struct problem problem = {0};
  struct text text;
  if (!file_read(path, &arena, &text, &problem)) fail_msg("%s", problem.text);
  return text;
}

static void write_bytes(const char *path, const char *data, ptrdiff_t length) {
  FILE *stream = fopen(path, "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(data, 1, (size_t)length, stream), length);
  fclose(stream);
}

static const char *const rgb[] = {"R", "G", "B"};
// Not in the order the library sorts them into.
static const char *const layers[] = {"R", "G", "B", "variance.R", "n", "bias.Y", "a"};
static const int sizes[][2] = {{1, 1}, {1, 17}, {17, 1}, {16, 16}, {15, 33}, {37, 48}, {257, 3}};
enum { N_SIZES = sizeof sizes / sizeof *sizes };

static void exr_keeps_every_bit_of_every_channel(void **state) {
  (void)state;
  for (int s = 0; s < N_SIZES; s++)
    for (int n = 1; n <= 7; n += 3) {
      struct image image = image_of_bits(sizes[s][0], sizes[s][1], n, layers);
      write_ok(path_of("a.exr"), &image);
      struct image back = read_ok(path_of("a.exr"));
      assert_same_bits(&image, &back);
      assert_null(back.manifest);
    }
}

// Among so many small chunks some compress to exactly their own length, which the library alone
// gets wrong (openexr issue 2306; with zlib 1.2.13 here 3 x 5, 3 x 21, 5 x 3 and 5 x 19).
static void exr_keeps_every_bit_of_chunks_that_hardly_compress(void **state) {
  (void)state;
  static const char *const gray[] = {"Y"};
  for (int width = 3; width <= 5; width += 2)
    for (int height = 1; height < 22; height++) {
      struct arena kept = arena;
      struct image image = image_new(width, height, 1, gray, &arena);
      for (int j = 0; j < width * height; j++) image.plane[0][j] = 0.2385f * (float)(j % 11);
      write_ok(path_of("a.exr"), &image);
      struct image back = read_ok(path_of("a.exr"));
      assert_same_bits(&image, &back);
      arena = kept;
    }
}

static void exr_keeps_the_manifest(void **state) {
  (void)state;
  struct image image = image_of_bits(5, 4, 3, rgb);
  image.manifest = "{\"cell\": 3, \"note\": \"\xc3\xa9\"}";
  write_ok(path_of("a.exr"), &image);
  assert_string_equal(read_ok(path_of("a.exr")).manifest, image.manifest);
}

static void pfm_keeps_every_bit_of_colour_and_gray(void **state) {
  (void)state;
  static const char *const gray[] = {"Y"};
  for (int s = 0; s < N_SIZES; s++)
    for (int n = 1; n <= 3; n += 2) {
      struct image image = image_of_bits(sizes[s][0], sizes[s][1], n, n == 1 ? gray : rgb);
      write_ok(path_of("a.pfm"), &image);
      struct image back = read_ok(path_of("a.pfm"));
      assert_same_bits(&image, &back);
    }
}

// The bytes of the format itself (1 x 2 pixels, rows from the bottom, 2.385f = 0x4018a3d7).
static void pfm_is_bottom_up_in_the_byte_order_its_scale_says(void **state) {
  (void)state;
  static const char little[] = "Pf\n1 2\n-1.0\n\xd7\xa3\x18\x40\0\0\x80\x3f";
  static const char big[] = "Pf 1 2 1\n\x40\x18\xa3\xd7\x3f\x80\0\0";
  static const char twice[] = "Pf 1 2 2.\n\x40\x18\xa3\xd7\x3f\x80\0\0";
  write_bytes(path_of("a.pfm"), little, sizeof little - 1);
  struct image image = read_ok(path_of("a.pfm"));
  assert_true(image.plane[0][0] == 1 && image.plane[0][1] == 2.385f);
  write_ok(path_of("b.pfm"), &image);
  assert_memory_equal(bytes_of(path_of("b.pfm")).data, little, sizeof little - 1);
  write_bytes(path_of("a.pfm"), big, sizeof big - 1);
  image = read_ok(path_of("a.pfm"));
  assert_true(image.plane[0][0] == 1 && image.plane[0][1] == 2.385f);
  write_bytes(path_of("a.pfm"), twice, sizeof twice - 1);
  image = read_ok(path_of("a.pfm"));
  assert_true(image.plane[0][0] == 2 && image.plane[0][1] == 2 * 2.385f);
}

static void the_same_image_gives_the_same_bytes(void **state) {
  (void)state;
  static const char *const extension[] = {"exr", "pfm", "png"};
  for (int e = 0; e < 3; e++) {
    struct image image = image_of_bits(61, 47, 3, rgb);
    const char *a = path_of(arena_format(&arena, "a.%s", extension[e]));
    const char *b = path_of(arena_format(&arena, "another.%s", extension[e]));
    write_ok(a, &image);
    sleep(e == 0); // a time in the file would show
    write_ok(b, &image);
    struct text one = bytes_of(a), two = bytes_of(b);
    assert_int_equal(one.length, two.length);
    assert_memory_equal(one.data, two.data, (size_t)one.length);
  }
}

// IEC 61966-2-1 in libm's double arithmetic; none of the values below lies within 1e-6 of a tie.
static int srgb_expected(double v) {
  if (!(v > 0)) return 0;
  if (v >= 1) return 255;
  return (int)(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055) + 0.5);
}

static void png_decodes_to_the_srgb_curve_of_the_clipped_values(void **state) {
  (void)state;
  static const float value[] = {0,   1,    0.5f,  0.18f,    0.0031308f, 0.002f, -3,      2.5f,
                                NAN, 0.9f, 1e-9f, INFINITY, 0.7385f,    0.04f,  0.2385f, 0.99f};
  struct image image = image_new(4, 4, 3, rgb, &arena);
  for (int j = 0; j < 16; j++)
    for (int c = 0; c < 3; c++) image.plane[c][j] = value[(j + 5 * c) % 16];
  write_ok(path_of("a.png"), &image);

  png_image png = {.version = PNG_IMAGE_VERSION};
  assert_true(png_image_begin_read_from_file(&png, path_of("a.png")));
  assert_int_equal(png.width, 4);
  assert_int_equal(png.height, 4);
  png.format = PNG_FORMAT_RGB;
  unsigned char pixel[4 * 4 * 3];
  assert_true(png_image_finish_read(&png, NULL, pixel, 0, NULL));
  for (int j = 0; j < 16; j++)
    for (int c = 0; c < 3; c++)
      assert_int_equal(pixel[3 * j + c], srgb_expected(value[(j + 5 * c) % 16]));
  // Anchors from the standard itself: middle gray and one half.
  assert_int_equal(srgb_expected(0.5), 188);
  assert_int_equal(srgb_expected(0.18), 118);
}

static void assert_problem(bool ok, const struct problem *problem, const char *says) {
  assert_false(ok);
  assert_non_null(strstr(problem->text, says));
  assert_null(strchr(problem->text, '\n'));
}

static void an_unknown_extension_lists_the_known_ones(void **state) {
  (void)state;
  static const char *const name[] = {"a.jpg", "a", "a.exr.bak", "a.d/b", "exr"};
  struct image image = image_of_bits(2, 2, 3, rgb);
  for (int j = 0; j < 5; j++) {
    struct problem problem = {0};
    assert_problem(image_can_write(name[j], &problem), &problem, ".exr, .pfm, .png");
    problem = (struct problem){0};
    assert_problem(image_write(name[j], &image, &problem), &problem, ".exr, .pfm, .png");
    problem = (struct problem){0};
    assert_problem(image_read(name[j], &arena, &image, &problem), &problem, ".exr, .pfm");
    assert_false(file_exists(name[j]));
  }
}

static void a_format_without_the_channels_it_needs_says_so_and_leaves_nothing(void **state) {
  (void)state;
  struct image image = image_of_bits(2, 2, 2, rgb); // R, G
  static const char *const name[] = {"none.pfm", "none.png"};
  for (int j = 0; j < 2; j++) {
    struct problem problem = {0};
    int before = files_in_folder();
    assert_problem(image_write(path_of(name[j]), &image, &problem), &problem, "R, G, B or Y");
    assert_int_equal(files_in_folder(), before);
  }
}

static void an_impossible_place_is_a_problem_and_leaves_nothing(void **state) {
  (void)state;
  struct image image = image_of_bits(8, 8, 3, rgb);
  static const char *const extension[] = {"exr", "pfm", "png"};
  // A folder that is a file, and a file name that is a folder: neither stops root.
  write_bytes(path_of("file"), "x", 1);
  for (int e = 0; e < 3; e++) {
    const char *in_file = arena_format(&arena, "%s/file/a.%s", folder, extension[e]);
    const char *is_folder = arena_format(&arena, "%s/folder.%s", folder, extension[e]);
    mkdir(is_folder, 0777);
    int before = files_in_folder();
    struct problem problem = {0};
    assert_problem(image_write(in_file, &image, &problem), &problem, "cannot write it");
    problem = (struct problem){0};
    assert_problem(image_write(is_folder, &image, &problem), &problem, "cannot write it");
    assert_int_equal(files_in_folder(), before);
    rmdir(is_folder);
  }
}

static void a_full_disk_is_a_problem(void **state) {
  (void)state;
  if (!file_exists("/dev/full")) skip();
  struct image image = image_of_bits(200, 200, 3, rgb);
  static const char *const extension[] = {"exr", "pfm", "png"};
  for (int e = 0; e < 3; e++) {
    // The name the writer works on is a link to a device that refuses every byte.
    const char *path = path_of(arena_format(&arena, "full.%s", extension[e]));
    const char *temporary = arena_format(&arena, "%s.tmp%ld", path, (long)getpid());
    assert_int_equal(symlink("/dev/full", temporary), 0);
    struct problem problem = {0};
    assert_problem(image_write(path, &image, &problem), &problem, "cannot write it");
    assert_false(file_exists(path));
    unlink(temporary);
  }
}

static void a_file_that_is_cut_anywhere_is_a_problem(void **state) {
  (void)state;
  static const char *const name[] = {"a.exr", "a.pfm"};
  struct image image = image_of_bits(19, 23, 3, rgb);
  for (int f = 0; f < 2; f++) {
    const char *path = path_of(name[f]);
    write_ok(path, &image);
    struct text text = bytes_of(path);
    for (ptrdiff_t length = 0; length < text.length; length += length < 400 ? 1 : 97) {
      struct arena scratch = arena;
      struct problem problem = {0};
      write_bytes(path, text.data, length);
      struct image back;
      assert_false(image_read(path, &scratch, &back, &problem));
      assert_true(problem.text[0] && !strchr(problem.text, '\n'));
    }
  }
}

// Anything may come back, but never a crash, a hang or an image whose size the file cannot hold.
static void flipped_bytes_never_crash_the_readers(void **state) {
  (void)state;
  static const char *const name[] = {"a.exr", "a.pfm"};
  struct rng_key key = rng_key(rng_hash_name("flipped bytes"), 1, RNG_TEST);
  struct image image = image_of_bits(19, 23, 3, rgb);
  int refused[2] = {0};
  for (int f = 0; f < 2; f++) {
    const char *path = path_of(name[f]);
    write_ok(path, &image);
    struct text text = bytes_of(path);
    for (uint32_t trial = 0; trial < 1500; trial++) {
      uint32_t counter[4] = {trial, (uint32_t)f, 0, 0}, word[4];
      rng_philox(key, counter, word);
      uint32_t head = f == 0 ? 330 : 14; // most trials in the header
      uint32_t at = word[0] % (trial % 4 ? head : (uint32_t)text.length);
      char kept = text.data[at];
      text.data[at] = (char)word[1];
      write_bytes(path, text.data, text.length);
      text.data[at] = kept;
      struct arena scratch = arena;
      struct problem problem = {0};
      struct image back;
      if (image_read(path, &scratch, &back, &problem))
        assert_true((double)back.width * back.height * back.n_channels <=
                    1032.0 * (double)text.length);
      else
        refused[f] += problem.text[0] != 0;
    }
  }
  assert_true(refused[0] > 300 && refused[1] > 300);
}

static void pfm_headers_that_lie_are_refused(void **state) {
  (void)state;
  static const char *const head[] = {
      "P6\n1 1\n-1\nxxxx",
      "Pf\n0 1\n-1\n",
      "Pf\n-1 1\n-1\nxxxx",
      "Pf\n1 1\n0\nxxxx",
      "Pf\n1 1\nnan\nxxxx",
      "Pf\n1 1\n-1",
      "Pf\n1 1\n-1\nxxxxx",
      "Pf\n1x 1\n-1\nxxxx",
      "Pf\n2147483647 2147483647\n-1\nxxxx",
      "PF\n1 1\n-1\nxxxxxxxxxxx",
      "Pf\n4294967297 1\n-1\nxxxx",
      "",
      "PF 1073741824 1 -1\nxxxx",
      "Pf\n1.0 1\n-1\nxxxx",
  };
  for (size_t j = 0; j < sizeof head / sizeof *head; j++) {
    struct image image;
    struct problem problem = {0};
    write_bytes(path_of("a.pfm"), head[j], (ptrdiff_t)strlen(head[j]));
    assert_problem(image_read(path_of("a.pfm"), &arena, &image, &problem), &problem, "a.pfm: ");
  }
}

int main(void) {
  arena = arena_reserve();
  // In memory where there is such a place: every image is fsynced.
  snprintf(folder, sizeof folder, "%s/photonlab-image-XXXXXX",
           file_exists("/dev/shm") ? "/dev/shm" : P_tmpdir);
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exr_keeps_every_bit_of_every_channel),
      cmocka_unit_test(exr_keeps_every_bit_of_chunks_that_hardly_compress),
      cmocka_unit_test(exr_keeps_the_manifest),
      cmocka_unit_test(pfm_keeps_every_bit_of_colour_and_gray),
      cmocka_unit_test(pfm_is_bottom_up_in_the_byte_order_its_scale_says),
      cmocka_unit_test(the_same_image_gives_the_same_bytes),
      cmocka_unit_test(png_decodes_to_the_srgb_curve_of_the_clipped_values),
      cmocka_unit_test(an_unknown_extension_lists_the_known_ones),
      cmocka_unit_test(a_format_without_the_channels_it_needs_says_so_and_leaves_nothing),
      cmocka_unit_test(an_impossible_place_is_a_problem_and_leaves_nothing),
      cmocka_unit_test(a_full_disk_is_a_problem),
      cmocka_unit_test(a_file_that_is_cut_anywhere_is_a_problem),
      cmocka_unit_test(flipped_bytes_never_crash_the_readers),
      cmocka_unit_test(pfm_headers_that_lie_are_refused),
  };
  int failed = cmocka_run_group_tests_name("image", tests, NULL, NULL);
  DIR *dir = opendir(folder);
  for (struct dirent *entry; (entry = readdir(dir));)
    if (entry->d_name[0] != '.') unlink(path_of(entry->d_name));
  closedir(dir);
  rmdir(folder);
  return failed;
}
