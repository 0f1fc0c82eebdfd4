// pbrt-v4's camera: fov spans the shorter axis, +z forward, +x right, +y up, image y down.
#include "scene/camera.h"
#include "scene_text.h"

#include <float.h>
#include <stdlib.h>

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

#define SQUARE "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 10 "
#define WIDE "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 10 "

static void the_screen_window_is_what_the_film_shows(void **state) {
  (void)state;
  struct scene scene = scene_of("Camera \"perspective\" \"float screenwindow\" [-.5 2 -.25 .75] "
                                "\"float fov\" 60 " SQUARE WORLD);
  double half = 1 / sqrt(3); // tan 30 degrees
  assert_along(ray(&scene, 0, 0).d, -.5 * half, .75 * half, 1);
  assert_along(ray(&scene, 10, 10).d, 2 * half, -.25 * half, 1);
}

static void frame_aspect_ratio_replaces_that_of_the_film(void **state) {
  (void)state;
  struct scene wide = scene_of("Camera \"perspective\" \"float frameaspectratio\" 2 " SQUARE WORLD);
  assert_along(ray(&wide, 10, 0).d, 2, 1, 1);
  struct scene tall =
      scene_of("Camera \"perspective\" \"float frameaspectratio\" .25 " SQUARE WORLD);
  assert_along(ray(&tall, 10, 0).d, 1, 4, 1);
}

static void orthographic_rays_are_parallel(void **state) {
  (void)state;
  struct scene scene = scene_of("LookAt 3 0 0  0 0 0  0 0 1 Camera \"orthographic\" "
                                "\"float screenwindow\" [-1.5 1.5 -.5 .5] " WIDE WORLD);
  for (int j = 0; j <= 30; j += 5) {
    struct ray r = ray(&scene, j, 2.5);
    assert_along(r.d, -1, 0, 0);
    // right is +y: up x forward as in look_at_places_the_eye, mirrored; up is +z
    struct vec wanted = vec(3, 1.5 - j / 10.0, .25);
    assert_true(vec_length(vec_sub(r.o, wanted)) <= 8 * DBL_EPSILON);
  }
}

static struct ray lens_ray(const struct scene *scene, double x, double y, double u0, double u1) {
  return camera_ray(&scene->camera, x, y, (const double[2]){u0, u1});
}

static void rays_through_a_pixel_meet_at_the_focal_plane(void **state) {
  (void)state;
  struct scene scene = scene_of("Camera \"perspective\" \"float fov\" 60 \"float lensradius\" .3 "
                                "\"float focaldistance\" 2.385 " SQUARE WORLD);
  struct vec pinhole = ray(&scene, 7, 2).d, focus = vec_scale(pinhole, 2.385 / pinhole.z);
  for (int k = 0; k < 64; k++) {
    double u0 = (k % 8 + .5) / 8, u1 = (k / 8) / 8.0;
    struct ray r = lens_ray(&scene, 7, 2, u0, u1);
    double t = 2.385 / r.d.z, sine, cosine;
    assert_true(vec_length(vec_sub(vec_along(r.o, r.d, t), focus)) <= 16 * DBL_EPSILON);
    // uniform on the disc: the share u0 of its area is within the radius
    sine = sin(2 * acos(-1) * u1), cosine = cos(2 * acos(-1) * u1);
    struct vec on_lens = vec(.3 * sqrt(u0) * cosine, .3 * sqrt(u0) * sine, 0);
    assert_true(vec_length(vec_sub(r.o, on_lens)) <= 4 * DBL_EPSILON);
  }
}

// pbrt-v4's lens lies around the origin for every pixel, parallel rays or not.
static void an_orthographic_lens_is_pbrts(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "Camera \"orthographic\" \"float lensradius\" .25 \"float focaldistance\" 4 " SQUARE WORLD);
  struct ray r = lens_ray(&scene, 10, 5, .25, .25);
  assert_true(vec_length(vec_sub(r.o, vec(0, .125, 0))) <= DBL_EPSILON);
  assert_along(r.d, 1, -.125, 4);
}

static void a_spherical_camera_sees_all_directions(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Camera \"spherical\" \"string mapping\" \"equirectangular\" " WIDE WORLD);
  assert_along(ray(&scene, 0, 0).d, 0, 1, 0); // up
  assert_along(ray(&scene, 0, 5).d, 1, 0, 0);
  assert_along(ray(&scene, 7.5, 5).d, 0, 0, 1);
  assert_along(ray(&scene, 15, 7.5).d, -sqrt(.5), -sqrt(.5), 0);
}

// As many pixels in a cap as its share of the sphere; directions go on across the film's edges.
static void the_default_sphere_has_equal_areas(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Camera \"spherical\" \"string mapping\" \"equalarea\" " SQUARE WORLD);
  static const struct vec axis[] = {{0, 1, 0}, {0, -1, 0}, {.6, 0, .8}, {-.48, .6, -.64}};
  enum { N = 400 };
  for (int a = 0; a < 4; a++) {
    int inside = 0;
    for (int j = 0; j < N * N; j++) {
      struct vec d = ray(&scene, (j % N + .5) * 10 / N, (j / N + .5) * 10 / N).d;
      inside += vec_dot(d, axis[a]) > .4; // a cap of 0.3 of the sphere
    }
    // Midpoints miss the area by the pixels the boundary crosses, of which half cancel at random:
    // at most 8 N pixels, so an error below 8 N / 2.
    assert_true(abs(inside - 3 * N * N / 10) < 4 * N);
  }
  for (int j = 1; j < 20; j++) {
    struct vec in = ray(&scene, j / 2.0, 1e-7).d, out = ray(&scene, j / 2.0, -1e-7).d;
    assert_true(vec_length(vec_sub(in, out)) < 1e-6);
    in = ray(&scene, 10 - 1e-7, j / 2.0).d, out = ray(&scene, 10 + 1e-7, j / 2.0).d;
    assert_true(vec_length(vec_sub(in, out)) < 1e-6);
  }
}

static void check_crop(const char *film, int x, int y, int width, int height) {
  char text[512];
  struct scene whole = scene_of("Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 100 "
                                "\"integer yresolution\" 50 " WORLD);
  struct ray r = ray(&whole, x + 1.385, y + .25);
  snprintf(text, sizeof text,
           "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 100 "
           "\"integer yresolution\" 50 %s " WORLD,
           film);
  struct scene scene = scene_of(text);
  assert_int_equal(scene.camera.width, width);
  assert_int_equal(scene.camera.height, height);
  struct ray cropped = ray(&scene, 1.385, .25);
  assert_memory_equal(&cropped, &r, offsetof(struct ray, leaving)); // what follows is padding
  assert_int_equal(cropped.leaving, r.leaving);
}

static void a_cropped_image_is_that_part_of_the_film(void **state) {
  (void)state;
  check_crop("\"float cropwindow\" [.1 .35 .5 1]", 10, 25, 25, 25);
  check_crop("\"float cropwindow\" [.35 .1 .5 1]", 10, 25, 25, 25);  // in either order
  check_crop("\"float cropwindow\" [.07 .701 0 .51]", 7, 0, 64, 26); // rounded up, in float
  check_crop("\"integer pixelbounds\" [12 100 7 8]", 12, 7, 88, 1);
}

// ---- the inverse ----

static const char *const findable[] = {
    "LookAt 3 1 0  0 0 .3  0 0 1 Camera \"perspective\" \"float fov\" 50 " WIDE WORLD,
    "Scale -2 3 .5 Rotate 20 1 2 3 Camera \"perspective\" \"float screenwindow\" [-.5 2 -.25 .75] "
    "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 \"float cropwindow\" "
    "[.1 .35 .5 1] " WORLD,
    "LookAt 3 1 0  0 0 .3  0 0 1 Camera \"perspective\" \"float lensradius\" .3 "
    "\"float focaldistance\" 2.385 " WIDE WORLD,
    "Scale 2 .7 1.3 Camera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -.5 .5] " WIDE WORLD,
    "Translate 1 2 3 Camera \"orthographic\" \"float lensradius\" .25 \"float focaldistance\" "
    "4 " WIDE WORLD,
};

// A point on a ray is found where the ray came from.
static void a_point_is_found_on_the_ray_that_meets_it(void **state) {
  (void)state;
  struct draw draw = draw_named("a_point_is_found_on_the_ray_that_meets_it");
  for (size_t s = 0; s < sizeof findable / sizeof *findable; s++) {
    struct scene scene = scene_of(findable[s]);
    struct camera_finder finder = camera_finder(&scene.camera);
    for (int k = 0; k < 200; k++) {
      double x = draw_between(&draw, -2, 32), y = draw_between(&draw, -2, 12), u[2];
      draw_pair(&draw, &u[0], &u[1]);
      struct ray ray = camera_ray(&scene.camera, x, y, u);
      double t = draw_between(&draw, 0.1, 20);
      struct sight sight;
      assert_true(camera_find_point(&finder, vec_along(ray.o, ray.d, t), u, &sight));
      // Rounding of p, at most 30 units off, comes back 30 / 0.1 times larger, in pixels 10 times
      // more.
      assert_true(fabs(sight.x - x) < 1e-11 && fabs(sight.y - y) < 1e-11);
      assert_true(vec_length(vec_sub(sight.o, ray.o)) < 1e-12);
      assert_true(vec_length(vec_sub(sight.d, ray.d)) < 1e-12 && fabs(sight.distance - t) < 1e-12);
      struct vec behind = vec_along(ray.o, ray.d, -t);
      assert_false(camera_find_point(&finder, behind, u, &sight));
    }
  }
}

// The film's area of a small square that faces the ray, by central differences of step h = 1e-4:
// their error is about (h / distance)^2 = 1e-6 at the nearest.
static void the_density_is_the_films_area_of_a_surface(void **state) {
  (void)state;
  struct draw draw = draw_named("the_density_is_the_films_area_of_a_surface");
  const double h = 1e-4;
  for (size_t s = 0; s < sizeof findable / sizeof *findable; s++) {
    struct scene scene = scene_of(findable[s]);
    struct camera_finder finder = camera_finder(&scene.camera);
    for (int k = 0; k < 50; k++) {
      double x = draw_between(&draw, -2, 32), y = draw_between(&draw, -2, 12), u[2];
      draw_pair(&draw, &u[0], &u[1]);
      struct ray ray = camera_ray(&scene.camera, x, y, u);
      struct vec p = vec_along(ray.o, ray.d, draw_between(&draw, 0.3, 5)), axis[2];
      struct sight sight, a, b;
      double jacobian[2][2];
      vec_basis(ray.d, &axis[0], &axis[1]);
      assert_true(camera_find_point(&finder, p, u, &sight));
      for (int j = 0; j < 2; j++) {
        assert_true(camera_find_point(&finder, vec_along(p, axis[j], h), u, &a));
        assert_true(camera_find_point(&finder, vec_along(p, axis[j], -h), u, &b));
        jacobian[j][0] = (a.x - b.x) / (2 * h), jacobian[j][1] = (a.y - b.y) / (2 * h);
      }
      double area = fabs(jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0]);
      if (!(fabs(sight.density / area - 1) < 2e-5))
        fail_msg("camera %d: %g pixels^2, not %g", (int)s, sight.density, area);
    }
  }
}

static void exposure_is_shutter_time_and_iso(void **state) {
  (void)state;
  assert_true(scene_of(WORLD).settings.exposure == 1);
  assert_true(scene_of("Camera \"perspective\" \"float shutteropen\" .25 \"float shutterclose\" .5 "
                       "Film \"rgb\" \"float iso\" 200 " WORLD)
                  .settings.exposure == .5);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fov_90_sees_the_corners_of_the_unit_window),
      cmocka_unit_test(fov_spans_the_shorter_axis),
      cmocka_unit_test(the_default_is_fov_90_on_1280_by_720),
      cmocka_unit_test(look_at_places_the_eye),
      cmocka_unit_test(scale_minus_one_mirrors_and_scaling_does_not_zoom),
      cmocka_unit_test(transforms_after_camera_do_not_move_it),
      cmocka_unit_test(the_screen_window_is_what_the_film_shows),
      cmocka_unit_test(frame_aspect_ratio_replaces_that_of_the_film),
      cmocka_unit_test(orthographic_rays_are_parallel),
      cmocka_unit_test(rays_through_a_pixel_meet_at_the_focal_plane),
      cmocka_unit_test(an_orthographic_lens_is_pbrts),
      cmocka_unit_test(a_spherical_camera_sees_all_directions),
      cmocka_unit_test(the_default_sphere_has_equal_areas),
      cmocka_unit_test(a_cropped_image_is_that_part_of_the_film),
      cmocka_unit_test(a_point_is_found_on_the_ray_that_meets_it),
      cmocka_unit_test(the_density_is_the_films_area_of_a_surface),
      cmocka_unit_test(exposure_is_shutter_time_and_iso),
  };
  return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
