// Motion: the interpolation of transformations against closed forms, scenes at a time against
// scenes without motion, and what is seen over the shutter's time against exact values.
#include "scene/motion.h"
#include "bvh/view.h"
#include "integrator/integrator.h"
#include "run/render.h"
#include "scene_text.h"

#include <float.h>

// ---- animation ----
static void assert_transform(struct transform a, struct transform b, double tolerance) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      if (!(fabs(a.m[i][j] - b.m[i][j]) <= tolerance))
        fail_msg("element %d %d is %.17g, not %.17g", i, j, a.m[i][j], b.m[i][j]);
}

static struct transform product(struct transform a, struct transform b, struct transform c) {
  return transform_multiply(a, transform_multiply(b, c));
}

// Decomposition, arc and product: some tens of roundings of numbers up to 5.
static const double tolerance = 100 * 5 * DBL_EPSILON;

static void rotations_go_by_the_shorter_arc(void **state) {
  (void)state;
  struct vec axis = vec(1, -2, 0.5);
  struct transform start = transform_rotate(25, axis);
  static const struct {
    double end, arc;
  } cases[] = {{115, 90}, {25 + 179, 179}, {25 + 200, -160}, {385 - 1e-9, -1e-9}, {-60, -85}};
  for (int k = 0; k < 5; k++) {
    struct animation a = animation_new(start, transform_rotate(cases[k].end, axis));
    for (int j = 0; j <= 8; j++)
      assert_transform(animation_at(&a, j / 8.0),
                       transform_rotate(25 + cases[k].arc * j / 8.0, axis), tolerance);
  }
}

static void translations_and_stretches_go_linearly(void **state) {
  (void)state;
  struct transform turn = transform_rotate(40, vec(0.3, 1, 2));
  struct transform start =
      product(transform_translate(vec(1, -2, 3)), turn, transform_scale(vec(1, 2, 0.5)));
  struct transform end =
      product(transform_translate(vec(-1, 0.5, 3)), turn, transform_scale(vec(4, 1, 0.25)));
  struct animation a = animation_new(start, end);
  assert_transform(animation_at(&a, 0.25),
                   product(transform_translate(vec(0.5, -1.375, 3)), turn,
                           transform_scale(vec(1.75, 1.75, 0.4375))),
                   tolerance);
}

// T R S with S symmetric, in any axes: each factor goes its own way. Mirrored: S is.
static void factors_are_interpolated_apart(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int k = 0; k < 50; k++) {
    struct transform t[3],
        turn = transform_rotate(draw_between(&draw, 0, 360), draw_direction(&draw)), back;
    struct vec axis = draw_direction(&draw);
    double mirror = k % 2 ? -1 : 1, angle = draw_between(&draw, -170, 170);
    assert_true(transform_invert(turn, &back));
    for (int end = 0; end < 3; end++) { // start, end, and the middle of them
      double share = end == 2 ? 0.5 : end;
      struct transform stretch = product(
          turn, transform_scale(vec(mirror * (1 + share), mirror * (3 - share), mirror * 0.7)),
          back);
      t[end] = product(transform_translate(vec(share, 2, -3 * share)),
                       transform_rotate(20 + angle * share, axis), stretch);
    }
    struct animation a = animation_new(t[0], t[1]);
    assert_transform(animation_at(&a, 0.5), t[2], tolerance);
  }
}

static void before_and_after_are_the_ends_themselves(void **state) {
  (void)state;
  struct transform start = transform_rotate(33, vec(1, 1, 0)),
                   end = transform_translate(vec(1, 2, 3));
  struct animation a = animation_new(start, end);
  static const double shares[] = {-1, 0, 1, 7.5};
  for (int k = 0; k < 4; k++) {
    struct transform t = animation_at(&a, shares[k]);
    assert_memory_equal(&t, k < 2 ? &start : &end, sizeof t);
  }
  assert_false(animation_new(start, start).moves);
}

static void tiny_and_huge_scales_are_decomposed(void **state) {
  (void)state;
  struct transform turn = transform_rotate(77, vec(3, 1, 0));
  static const double scales[] = {1e-40, 1e40};
  for (int k = 0; k < 2; k++) {
    struct vec s = vec(scales[k], 5 * scales[k], scales[k]);
    struct animation a =
        animation_new(transform_scale(s), transform_multiply(turn, transform_scale(s)));
    assert_transform(
        animation_at(&a, 0.5),
        transform_multiply(transform_rotate(77 / 2.0, vec(3, 1, 0)), transform_scale(s)),
        tolerance * scales[k]);
  }
}

// ---- scenes ----
#define MOVE(start, end, shape)                                                                    \
  "AttributeBegin ActiveTransform StartTime " start " ActiveTransform EndTime " end                \
  " ActiveTransform All " shape " AttributeEnd\n"
#define SPHERE "Shape \"sphere\" \"float radius\" .3\n"
#define MESH                                                                                       \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "                                      \
  "\"point3 P\" [-1 0 -1 1 0 -1 1 0 1 -1 0 1]\n"
#define BENT                                                                                       \
  "Shape \"trianglemesh\" \"point3 P\" [-1 0 -1 1 0 -1 1 0 1] "                                    \
  "\"normal N\" [0 1 0 .6 .8 0 0 .6 .8] \"vector3 S\" [1 0 0 0 .5 0 .6 0 .8]\n"                    \
  "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]\n"
#define TIMES "TransformTimes .5 2.5 "
#define LIGHT "LightSource \"point\"\n"

// Geometric, of each primitive.
static struct vec *normals_of(const struct scene *scene, struct arena *arena) {
  struct vec *ng = arena_new(arena, struct vec, scene->n_primitives);
  for (uint32_t p = 0; p < scene->n_primitives; p++) {
    const struct shape *shape = &scene->shape[scene->shape_of[p]];
    ng[p] = shape->type->normal(scene, shape, p, vec(0.3, 0.2, 0.1));
  }
  return ng;
}

// The moving scene at a quarter of its motion, and another without motion that is the same.
static void check_at_a_quarter(const char *moving, const char *still) {
  struct scene scene = scene_of(moving);
  struct arena arena = arena_reserve(), own = arena;
  struct scene *copy = motion_copy(&scene, &own);
  motion_set(copy, 1);
  struct vec *ng = normals_of(copy, &own);
  struct scene other = scene_of(still); // the copy's own arrays are left as they are
  uint32_t n = copy->n_positions;
  assert_int_equal(other.n_positions, n);
  for (uint32_t k = 0; k < n; k++)
    for (int axis = 0; axis < 3; axis++)
      assert_true(fabs((double)copy->position[k][axis] - (double)other.position[k][axis]) <=
                  4 * FLT_EPSILON);
  assert_int_equal(other.n_normals, copy->n_normals);
  for (uint32_t k = 0; k < copy->n_normals; k++)
    for (int axis = 0; axis < 3; axis++)
      assert_true(fabs((double)copy->normal[k][axis] - (double)other.normal[k][axis]) <=
                  4 * FLT_EPSILON);
  assert_int_equal(other.n_tangents, copy->n_tangents);
  for (uint32_t k = 0; k < copy->n_tangents; k++)
    for (int axis = 0; axis < 3; axis++)
      assert_true(fabs((double)copy->tangent[k][axis] - (double)other.tangent[k][axis]) <=
                  4 * FLT_EPSILON);
  struct vec *wanted = normals_of(&other, &own); // the same side faces outward
  for (uint32_t p = 0; p < copy->n_primitives; p++)
    assert_true(vec_length(vec_sub(ng[p], wanted[p])) <= 8 * FLT_EPSILON);
  if (other.n_quadrics) {
    assert_transform(copy->quadric[0].world_from_object, other.quadric[0].world_from_object,
                     tolerance);
    assert_transform(copy->quadric[0].object_from_world, other.quadric[0].object_from_world,
                     tolerance);
  }
  arena_release(arena);
}

static void a_scene_at_a_time_is_the_scene_without_motion(void **state) {
  (void)state;
  check_at_a_quarter(TIMES "WorldBegin " LIGHT MOVE("Translate 0 1 0", "Translate 4 1 0", SPHERE),
                     "WorldBegin " LIGHT "Translate 1 1 0 " SPHERE);
  check_at_a_quarter(TIMES "WorldBegin " LIGHT MOVE("Identity", "Rotate 80 0 1 0", MESH),
                     "WorldBegin " LIGHT "Rotate 20 0 1 0 " MESH);
  check_at_a_quarter(TIMES "WorldBegin " LIGHT MOVE("Scale -1 2 3", "Scale -1 2 3",
                                                    MOVE("Scale 1 1 1", "Translate 0 4 0", BENT)),
                     "WorldBegin " LIGHT "Scale -1 2 3 Translate 0 1 0 " BENT);
}

#define OBJECT "ObjectBegin \"o\" Translate 2 0 0 " SPHERE MESH "ObjectEnd\n"
#define INSTANCE "ObjectInstance \"o\" "

// The shapes of an instance that turns go around with it, not along the chord.
static void an_instance_moves_as_a_whole(void **state) {
  (void)state;
  check_at_a_quarter(TIMES
                     "WorldBegin " LIGHT OBJECT MOVE("Identity", "Rotate 120 0 1 0", INSTANCE),
                     "WorldBegin " LIGHT OBJECT "Rotate 30 0 1 0 " INSTANCE);
}

static void what_moves_within_an_instance_moves_with_it_too(void **state) {
  (void)state;
#define TURNING "ObjectBegin \"o\" " MOVE("Identity", "Translate 0 0 4", SPHERE) "ObjectEnd\n"
  check_at_a_quarter(TIMES
                     "WorldBegin " LIGHT TURNING MOVE("Identity", "Rotate 120 0 1 0", INSTANCE),
                     "WorldBegin " LIGHT "Rotate 30 0 1 0 Translate 0 0 1 " SPHERE);
}

static void the_bounds_hold_at_all_times(void **state) {
  (void)state;
  static const char *const scenes[] = {
      "WorldBegin " LIGHT MOVE("Translate 0 1 0", "Translate 4 -1 0", SPHERE),
      "WorldBegin " LIGHT MOVE("Identity", "Rotate 175 1 1 0", "Translate 3 0 0 " MESH),
      "WorldBegin " LIGHT MOVE("Scale 1 3 1", "Rotate 100 0 0 1 Scale .2 1 4", MESH),
      "WorldBegin " LIGHT OBJECT MOVE("Rotate 90 0 1 0", "Scale 2 1 1", INSTANCE)};
  for (int s = 0; s < 4; s++) {
    struct scene scene = scene_of(scenes[s]);
    struct arena arena = arena_reserve(), own = arena;
    struct scene *copy = motion_copy(&scene, &own);
    for (int k = 0; k <= 200; k++) {
      motion_set(copy, k / 200.0);
      for (uint32_t p = 0; p < copy->n_primitives; p++) {
        const struct shape *shape = &copy->shape[copy->shape_of[p]];
        struct box box = shape->type->bounds(copy, shape, p);
        for (int axis = 0; axis < 3; axis++)
          assert_true(box.lo[axis] >= scene.bounds.lo[axis] &&
                      box.hi[axis] <= scene.bounds.hi[axis]);
      }
    }
    arena_release(arena);
  }
}

static void rays_of_a_camera_that_turns_turn_with_it(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "ActiveTransform EndTime Rotate 60 0 1 0 ActiveTransform All Camera \"perspective\" "
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 WorldBegin " LIGHT SPHERE);
  struct arena arena = arena_reserve(), own = arena;
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &own);
  struct view view = view_new(&scene, bvh, false, &own);
  assert_true(view.bvh == bvh); // shared: no shape moves
  view_set(&view, 0.5);
  struct vec d = camera_ray(&view.scene->camera, 2, 2, NULL).d; // inverse of a turn of +z by 30
  assert_true(vec_length(vec_sub(d, vec(-0.5, 0, sqrt(3) / 2))) <= tolerance);
  arena_release(arena);
}

static void a_scene_without_motion_is_not_copied(void **state) {
  (void)state;
  struct scene scene = scene_of("WorldBegin " LIGHT SPHERE);
  struct arena arena = arena_reserve(), own = arena;
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &own);
  struct view view = view_new(&scene, bvh, false, &own);
  assert_true(view.scene == &scene && view.bvh == bvh);
  arena_release(arena);
}

// ---- over the shutter's time ----
static struct measurement measure_pixel(const struct scene *scene, const char *name,
                                        struct arena *arena) {
  static const struct pixel pixel = {0, 0};
  static struct estimator estimator;
  estimator = (struct estimator){
      .kernel = kernel_find("box"), .law = law_find("fixed"), .alpha = 1, .r1 = 0.2};
  return (struct measurement){.scene = scene,
                              .bvh = bvh_build(scene, (struct bvh_options){0}, arena),
                              .features = scene_features(scene),
                              .pixel = &pixel,
                              .n_points = 1,
                              .n_replicas = 1,
                              .depth = 1,
                              .n_emitted = 4000,
                              .seed = rng_hash_name(name),
                              .estimator = &estimator,
                              .n_estimators = 1};
}

#define ONE_PIXEL                                                                                  \
  "Camera \"orthographic\" \"float shutteropen\" .25 Film \"rgb\" \"integer xresolution\" 1 "      \
  "\"integer yresolution\" 1 WorldBegin\n"
#define GLOW "AreaLightSource \"diffuse\" Translate 0 0 9 Scale -1 1 -1 Shape \"disk\"\n"

// A black disc of radius 0.3 passes in front of a lamp of radiance 1 at x = 4 t - 2: it covers the
// axis for a time of 0.15 around t = 0.5, of the 0.75 that the shutter is open. Level 1e-6 (z
// = 4.9); with n = 2500, sigma is 0.008, so a share of 0.24 instead of 0.2 is seen (all of
// TransformTimes would be 0.15).
static void a_disc_that_passes_covers_its_share_of_the_time(void **state) {
  (void)state;
  enum { N = 2500 };
  struct scene scene = scene_of(
      ONE_PIXEL "AttributeBegin " GLOW "AttributeEnd "
                "Material \"diffuse\" \"rgb reflectance\" [0 0 0] " MOVE(
                    "Translate -2 0 3", "Translate 2 0 3", "Shape \"disk\" \"float radius\" .3"));
  struct arena arena = arena_reserve(), own = arena;
  struct measurement measure = measure_pixel(&scene, __func__, &own);
  const struct integrator_type *path = integrator_find("path");
  void *integrator = path->create(&measure, &own);
  double sum = 0, frame[3];
  path->begin(integrator, 1);
  for (uint64_t i = 1; i <= N; i++) {
    path->step(integrator, i, frame);
    assert_true(frame[0] == 0 || fabs(frame[0] - 1) < 1e-12);
    sum += frame[0];
  }
  double z = (sum / N - 0.8) / sqrt(0.2 * 0.8 / N);
  if (!(fabs(z) < 4.9)) fail_msg("the lamp is seen for a share of %g, not 0.8", sum / N);
  arena_release(arena);
}

// A floor that rises under a distant light always receives the same: where eye and photon paths had
// times of their own, photons would lie far from the points that look for them.
static void eye_and_photon_paths_share_their_time(void **state) {
  (void)state;
  struct scene scene =
      scene_of(ONE_PIXEL "LightSource \"distant\" \"point3 from\" [0 0 -1] "
                         "\"point3 to\" [0 0 0]\n" MOVE("Translate 0 0 3", "Translate 0 0 9",
                                                        "Rotate 90 1 0 0 " MESH));
  struct arena arena = arena_reserve(), own = arena;
  struct measurement measure = measure_pixel(&scene, __func__, &own);
  const struct integrator_type *mapping = integrator_find("probabilistic");
  void *integrator = mapping->create(&measure, &own);
  enum { N = 500 };
  double sum = 0, sum2 = 0, frame[3];
  mapping->begin(integrator, 1);
  for (uint64_t i = 1; i <= N; i++) {
    mapping->step(integrator, i, frame);
    sum += frame[0], sum2 += frame[0] * frame[0];
  }
  double mean = sum / N, se = sqrt((sum2 / N - mean * mean) / (N - 1));
  double expected = 0.5 / acos(-1); // reflectance 0.5, irradiance 1
  // Times apart would leave a share of about 2 * 0.2 / 4.5 of it. A tenth is seen at z = 4.9.
  assert_true(4.9 * se < 0.1 * expected);
  if (!(fabs(mean - expected) < 4.9 * se)) fail_msg("%g +- %g, not %g", mean, se, expected);
  arena_release(arena);
}

// Whatever was computed before, by whichever thread: the same bits.
static void iterations_do_not_depend_on_each_other(void **state) {
  (void)state;
  struct scene scene = scene_of(
      ONE_PIXEL LIGHT OBJECT MOVE("Rotate 90 1 0 0", "Translate 0 0 4 Rotate 30 0 1 0", INSTANCE));
  struct arena arena = arena_reserve(), own = arena;
  struct measurement measure = measure_pixel(&scene, __func__, &own);
  measure.depth = 4;
  const struct integrator_type *path = integrator_find("path");
  double forward[8][3] = {{0}}, backward[3] = {0};
  void *one = path->create(&measure, &own), *other = path->create(&measure, &own);
  path->begin(one, 1), path->begin(other, 1);
  for (uint64_t i = 1; i <= 8; i++) path->step(one, i, forward[i - 1]);
  for (uint64_t i = 8; i >= 1; i--) {
    path->step(other, i, backward);
    assert_memory_equal(backward, forward[i - 1], sizeof backward);
  }
  arena_release(arena);
}

static void pictures_do_not_depend_on_the_number_of_threads(void **state) {
  (void)state;
  enum { SIDE = 8, N = SIDE * SIDE };
  struct scene scene = scene_of(
      "ActiveTransform EndTime Rotate 20 0 1 0 ActiveTransform All Camera \"perspective\" "
      "\"float lensradius\" .1 Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 "
      "WorldBegin " LIGHT OBJECT MOVE("Translate -2 0 2", "Translate -1 0 4", INSTANCE));
  struct arena arena = arena_reserve(), own = arena;
  struct measurement measure = measure_pixel(&scene, __func__, &own);
  struct pixel pixel[N];
  for (int j = 0; j < N; j++) pixel[j] = (struct pixel){j % SIDE, j / SIDE};
  measure.pixel = pixel, measure.n_points = N, measure.footprint = true;
  static const char *const names[] = {"path", "probabilistic"};
  for (int k = 0; k < 2; k++) {
    struct image image[2];
    for (int threads = 1; threads <= 2; threads++) {
      struct run_options options = {.threads = threads, .quiet = true};
      assert_true(render_image(integrator_find(names[k]), &measure, 20, options, &own,
                               &image[threads - 1]));
    }
    float most = 0;
    for (int j = 0; j < N; j++) most = image[0].plane[0][j] > most ? image[0].plane[0][j] : most;
    assert_true(most > 0); // something is seen
    for (int plane = 0; plane < 6; plane++)
      assert_memory_equal(image[0].plane[plane], image[1].plane[plane], N * sizeof(float));
  }
  arena_release(arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rotations_go_by_the_shorter_arc),
      cmocka_unit_test(translations_and_stretches_go_linearly),
      cmocka_unit_test(factors_are_interpolated_apart),
      cmocka_unit_test(before_and_after_are_the_ends_themselves),
      cmocka_unit_test(tiny_and_huge_scales_are_decomposed),
      cmocka_unit_test(a_scene_at_a_time_is_the_scene_without_motion),
      cmocka_unit_test(an_instance_moves_as_a_whole),
      cmocka_unit_test(what_moves_within_an_instance_moves_with_it_too),
      cmocka_unit_test(the_bounds_hold_at_all_times),
      cmocka_unit_test(rays_of_a_camera_that_turns_turn_with_it),
      cmocka_unit_test(a_scene_without_motion_is_not_copied),
      cmocka_unit_test(a_disc_that_passes_covers_its_share_of_the_time),
      cmocka_unit_test(eye_and_photon_paths_share_their_time),
      cmocka_unit_test(iterations_do_not_depend_on_each_other),
      cmocka_unit_test(pictures_do_not_depend_on_the_number_of_threads),
  };
  return cmocka_run_group_tests_name("motion", tests, NULL, NULL);
}
