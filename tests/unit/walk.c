// Photon and eye paths: flux is conserved, batches do not matter, roulette and depth do what they
// say.
#include "walk/eye.h"
#include "walk/photons.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

static struct arena arena;

static struct scene scene_load(const char *path) {
  struct scene scene;
  struct problem problem = {0};
  if (!scene_read(path, &arena, &scene, &problem)) fail_msg("%s", problem.text);
  return scene;
}

static struct photons trace(const struct scene *scene, struct photon_pass pass, int n_channels,
                            uint64_t iteration) {
  struct bvh *bvh = bvh_build(scene, (struct bvh_options){0}, &arena);
  struct features features = scene_features(scene);
  features.n_channels = n_channels;
  struct walk *walk = walk_new(scene, bvh, features, &arena);
  struct photons photons = {0};
  walk->key = rng_key(rng_hash_name("walk"), 1, RNG_PHOTONS);
  walk->iteration = iteration;
  struct photon_sinks sinks = {.surface = {&photons, NULL}};
  photons_trace(walk, &pass, &sinks, &arena);
  return photons;
}

static double total_flux(const struct photons *photons, int c) {
  double sum = 0;
  for (int64_t j = 0; j < photons->count; j++) sum += photons->flux[c][j];
  return sum;
}

static void a_beam_delivers_all_of_its_power(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/plane-uniform-beam.pbrt");
  struct photons photons =
      trace(&scene, (struct photon_pass){.n_emitted = 10000, .depth = 1}, 1, 1);
  assert_int_equal(photons.count, 10000);
  // Every photon carries the light's power; it is divided by n_emitted, never by what is stored.
  assert_true(fabs(total_flux(&photons, 0) / 10000 / scene.light[0].power[0] - 1) < 1e-12);
}

static void an_isotropic_light_above_a_plane_delivers_what_the_plane_sees(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/plane-point-light-isotropic.pbrt");
  // The solid angle of a square of half side a seen from height h above its centre over 4 pi:
  // asin(a^2 / (a^2 + h^2)) * 4 / (4 pi). Level 1e-5 (z = 4.4), n = 200000: 1 % off gives z = 6.
  double a = scene.bounds.hi[0], h = 1;
  double p = asin(a * a / (a * a + h * h)) / 3.141592653589793;
  struct photons photons =
      trace(&scene, (struct photon_pass){.n_emitted = 200000, .depth = 1}, 1, 1);
  double z = ((double)photons.count - 200000 * p) / sqrt(200000 * p * (1 - p));
  assert_true(fabs(z) < 4.4);
}

static void deeper_paths_only_add_photons(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/cornell-box.pbrt");
  struct photons shallow = trace(&scene, (struct photon_pass){.n_emitted = 1000, .depth = 1}, 1, 1);
  struct photons deep = trace(&scene, (struct photon_pass){.n_emitted = 1000, .depth = 8}, 1, 1);
  struct photons indirect =
      trace(&scene, (struct photon_pass){.n_emitted = 1000, .depth = 8, .first_vertex = 1}, 1, 1);
  assert_true(deep.count > shallow.count);
  assert_int_equal(indirect.count, deep.count - shallow.count);
  // One batch: the first vertices come first, and they are the same photons.
  assert_memory_equal(deep.position, shallow.position,
                      (size_t)shallow.count * sizeof *shallow.position);
}

static void batches_do_not_matter_to_a_path(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/cornell-box.pbrt");
  // Path 0 .. 999 are the same whether they travel alone or with 5000 others.
  struct photons few = trace(&scene, (struct photon_pass){.n_emitted = 1000, .depth = 1}, 1, 3);
  struct photons many = trace(&scene, (struct photon_pass){.n_emitted = 6000, .depth = 1}, 1, 3);
  assert_memory_equal(few.position, many.position, (size_t)few.count * sizeof *few.position);
  assert_memory_equal(few.flux[0], many.flux[0], (size_t)few.count * sizeof *few.flux[0]);
}

static void gray_scenes_have_equal_channels(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/cornell-box.pbrt");
  struct photons one = trace(&scene, (struct photon_pass){.n_emitted = 2000, .depth = 64}, 1, 1);
  struct photons three = trace(&scene, (struct photon_pass){.n_emitted = 2000, .depth = 64}, 3, 1);
  assert_int_equal(one.count, three.count);
  for (int c = 0; c < 3; c++)
    assert_memory_equal(one.flux[0], three.flux[c], (size_t)one.count * sizeof *one.flux[0]);
}

static void stored_photons_lie_on_surfaces_and_point_back(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/cornell-box.pbrt");
  struct photons photons =
      trace(&scene, (struct photon_pass){.n_emitted = 2000, .depth = 64}, 1, 1);
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &arena);
  for (int64_t j = 0; j < photons.count; j++) {
    assert_true(fabs(vec_length(photons.wi[j]) - 1) < 1e-12);
    // From a little way back along wi, the ray forward meets the photon's surface there.
    struct ray ray = {vec_along(photons.position[j], photons.wi[j], 1e-3),
                      vec_scale(photons.wi[j], -1), 1, PRIMITIVE_NONE};
    struct hit hit;
    bvh_closest(bvh, &ray, &hit, 1);
    assert_true(fabs(hit.t - 1e-3) < 1e-9);
  }
}

static void eye_points_are_where_the_scene_file_says(void **state) {
  (void)state;
  struct scene scene = scene_load("scenes/plane-quadratic-beam.pbrt");
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &arena);
  struct walk *walk = walk_new(&scene, bvh, scene_features(&scene), &arena);
  struct pixel pixel[] = {{32, 32}, {52, 32}};
  struct eye_point point[2];
  eye_trace(walk, pixel, 2, false, 1, point);
  assert_true(point[0].hit && point[1].hit);
  assert_true(vec_length(point[0].p) < 1e-7);
  assert_true(fabs(vec_length(point[1].p) - 0.70711) < 1e-4);
  assert_true(eye_normal(&point[0]).z > 0.999999 && point[0].wo.z > 0.999999);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_beam_delivers_all_of_its_power),
      cmocka_unit_test(an_isotropic_light_above_a_plane_delivers_what_the_plane_sees),
      cmocka_unit_test(deeper_paths_only_add_photons),
      cmocka_unit_test(batches_do_not_matter_to_a_path),
      cmocka_unit_test(gray_scenes_have_equal_channels),
      cmocka_unit_test(stored_photons_lie_on_surfaces_and_point_back),
      cmocka_unit_test(eye_points_are_where_the_scene_file_says),
  };
  return cmocka_run_group_tests_name("walk", tests, NULL, NULL);
}
