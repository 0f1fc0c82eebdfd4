// Pictures as tables: what figures draw is what the images hold.
#define _GNU_SOURCE // mkdtemp
#include "app/pixels.h"
#include "base/file.h"
#include "image/image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-pixels-XXXXXX";

static void a_table_has_the_pixels_of_its_image(void **state) {
  (void)state;
  static const char *const names[] = {"R", "G", "B", "variance.R"};
  struct problem problem = {0};
  struct image image = image_new(3, 2, 4, names, &arena);
  for (int c = 0; c < 4; c++)
    for (int j = 0; j < 6; j++) image.plane[c][j] = 0.1f * (float)(j + 1) + (float)c;
  char *images = arena_format(&arena, "%s/images", folder);
  assert_true(pixels_write(folder, arena, &problem)); // no folder of images: nothing to do
  assert_true(file_make_directory(images, &problem));
  char *exr = arena_format(&arena, "%s/box-1.exr", images);
  char *csv = arena_format(&arena, "%s/box-1.csv", images);
  assert_true(image_write(exr, &image, &problem));
  assert_true(pixels_write(folder, arena, &problem));
  FILE *in = fopen(csv, "r");
  char header[32];
  assert_non_null(in);
  assert_non_null(fgets(header, sizeof header, in));
  assert_string_equal(header, "x,y,R,G,B\n");
  for (int j = 0; j < 6; j++) {
    int x, y;
    float rgb[3];
    assert_int_equal(fscanf(in, "%d,%d,%f,%f,%f", &x, &y, &rgb[0], &rgb[1], &rgb[2]), 5);
    assert_true(x == j % 3 && y == j / 3);
    for (int c = 0; c < 3; c++) assert_true(rgb[c] == image.plane[c][j]);
  }
  fclose(in);
  unlink(exr), unlink(csv), rmdir(images);
}

static int make_folder(void **state) {
  (void)state;
  arena = arena_reserve();
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_table_has_the_pixels_of_its_image)};
  return cmocka_run_group_tests_name("pixels", tests, make_folder, remove_folder);
}
