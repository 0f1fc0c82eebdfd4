// pbrt-v4's camera: fov spans the shorter axis, +z forward, +x right, +y up, image y down.
#include "scene_text.h"

#include <float.h>

#define WORLD "WorldBegin LightSource \"point\" Shape \"sphere\""

static void assert_along(struct vec d, double x, double y, double z) {
  struct vec wanted = vec_normalize(vec(x, y, z));
  if (!(vec_length(vec_sub(d, wanted)) <= 8 * DBL_EPSILON))
    fail_msg("(%.17g %.17g %.17g) is not along (%g %g %g)", d.x, d.y, d.z, x, y, z);
}

static struct ray ray(const struct scene *scene, double x, double y) {
  struct ray r = camera_ray(&scene->camera, x, y, NULL);
  assert_true(fabs(vec_length(r.d) - 1) <= 4 * DBL_EPSILON);
  assert_true(r.t_max == INFINITY && r.leaving == PRIMITIVE_NONE);
  return r;
}

static void fov_90_sees_the_corners_of_the_unit_window(void **state) {
  (void)state;
  struct scene scene = scene_of("Camera \"perspective\" \"float fov\" 90 Film \"rgb\" "
                                "\"integer xresolution\" 4 \"integer yresolution\" 4 " WORLD);
  assert_along(ray(&scene, 2, 2).d, 0, 0, 1);
  assert_along(ray(&scene, 0, 0).d, -1, 1, 1); // top left: left and up
  assert_along(ray(&scene, 4, 0).d, 1, 1, 1);
  assert_along(ray(&scene, 0, 4).d, -1, -1, 1);
  assert_along(ray(&scene, 0.5, 0.5).d, -0.75, 0.75, 1);
}

static void fov_spans_the_shorter_axis(void **state) {
  (void)state;
  struct scene wide = scene_of("Camera \"perspective\" \"float fov\" 60 Film \"rgb\" "
                               "\"integer xresolution\" 30 \"integer yresolution\" 10 " WORLD);
  double half = 1 / sqrt(3); // tan 30 degrees
  assert_along(ray(&wide, 15, 0).d, 0, half, 1);
  assert_along(ray(&wide, 30, 5).d, 3 * half, 0, 1);
  struct scene tall = scene_of("Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 25 "
                               "Camera \"perspective\" \"float fov\" 60 " WORLD);
  assert_along(ray(&tall, 10, 12.5).d, half, 0, 1);
  assert_along(ray(&tall, 5, 25).d, 0, -2.5 * half, 1);
}

static void the_default_is_fov_90_on_1280_by_720(void **state) {
  (void)state;
  struct scene scene = scene_of(WORLD);
  assert_int_equal(scene.camera.width, 1280);
  assert_int_equal(scene.camera.height, 720);
  assert_along(ray(&scene, 640, 0).d, 0, 1, 1);
  assert_along(ray(&scene, 1280, 360).d, 1280.0 / 720, 0, 1);
}

static void look_at_places_the_eye(void **state) {
  (void)state;
  struct scene scene = scene_of("LookAt 3 0 0  0 0 0  0 0 1 Camera \"perspective\" Film \"rgb\" "
                                "\"integer xresolution\" 2 \"integer yresolution\" 2 " WORLD);
  struct ray r = ray(&scene, 2, 0); // right = up x forward = -y, up is +z
  assert_true(vec_length(vec_sub(r.o, vec(3, 0, 0))) <= 8 * DBL_EPSILON);
  assert_along(r.d, -1, -1, 1);
}

static void scale_minus_one_mirrors_and_scaling_does_not_zoom(void **state) {
  (void)state;
  struct scene scene = scene_of("Scale -5 5 5 Camera \"perspective\" Film \"rgb\" "
                                "\"integer xresolution\" 2 \"integer yresolution\" 2 " WORLD);
  assert_along(ray(&scene, 2, 0).d, -1, 1, 1);
}

static void transforms_after_camera_do_not_move_it(void **state) {
  (void)state;
  struct scene scene = scene_of("Camera \"perspective\" Translate 7 8 9 " WORLD);
  struct ray r = ray(&scene, 640, 360);
  assert_true(r.o.x == 0 && r.o.y == 0 && r.o.z == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fov_90_sees_the_corners_of_the_unit_window),
      cmocka_unit_test(fov_spans_the_shorter_axis),
      cmocka_unit_test(the_default_is_fov_90_on_1280_by_720),
      cmocka_unit_test(look_at_places_the_eye),
      cmocka_unit_test(scale_minus_one_mirrors_and_scaling_does_not_zoom),
      cmocka_unit_test(transforms_after_camera_do_not_move_it),
  };
  return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
