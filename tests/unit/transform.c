#include "scene/transform.h"

#include "scene_text.h"

#include <float.h>

static void assert_near(struct vec a, struct vec b, double tolerance) {
  if (!(vec_length(vec_sub(a, b)) <= tolerance))
    fail_msg("(%.17g %.17g %.17g) is not (%.17g %.17g %.17g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

static struct vec at(struct transform t, double x, double y, double z) {
  return transform_point(&t, vec(x, y, z));
}

static void a_product_applies_its_right_factor_first(void **state) {
  (void)state;
  struct transform move = transform_translate(vec(2, 3, 5)), grow = transform_scale(vec(7, 11, 13));
  assert_near(at(transform_multiply(move, grow), 1, 1, 1), vec(9, 14, 18), 0);
  assert_near(at(transform_multiply(grow, move), 1, 1, 1), vec(21, 44, 78), 0);
}

static void quarter_turns_are_exact_and_turn_x_to_y(void **state) {
  (void)state;
  assert_near(at(transform_rotate(90, vec(0, 0, 2.385)), 1, 0, 0), vec(0, 1, 0), 0);
  assert_near(at(transform_rotate(90, vec(1, 0, 0)), 0, 1, 0), vec(0, 0, 1), 0);
  assert_near(at(transform_rotate(90, vec(0, 1, 0)), 0, 0, 1), vec(1, 0, 0), 0);
  assert_near(at(transform_rotate(-90, vec(0, 0, 1)), 1, 0, 0), vec(0, -1, 0), 0);
  assert_near(at(transform_rotate(450, vec(0, 0, 1)), 1, 0, 0), vec(0, 1, 0), 0);
}

// A third of a turn around the diagonal permutes the axes; 30 degrees have sine 1/2.
static void other_rotations_have_their_known_values(void **state) {
  (void)state;
  assert_near(at(transform_rotate(120, vec(1, 1, 1)), 2, 3, 5), vec(5, 2, 3), 16 * DBL_EPSILON * 6);
  assert_near(at(transform_rotate(30, vec(0, 0, 1)), 1, 0, 0), vec(sqrt(3) / 2, 0.5, 0),
              4 * DBL_EPSILON);
}

static void columns_are_columns_and_projections_are_refused(void **state) {
  (void)state;
  double c[16] = {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1};
  struct transform t;
  assert_true(transform_from_columns(c, &t));
  assert_near(at(t, 1, 0, 0), vec(12, 14, 16), 0);
  assert_near(at(t, 0, 1, 0), vec(15, 17, 19), 0);
  assert_near(at(t, 0, 0, 0), vec(11, 12, 13), 0);
  c[7] = 0.1;
  assert_false(transform_from_columns(c, &t));
}

static struct transform draw_transform(struct draw *draw) {
  struct transform t;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] = draw_between(draw, -3, 3);
  return t;
}

// The cofactor inverse has a residual of a few roundings times |M|^3 / |det|, sizes below 3 sqrt 3.
static void a_matrix_times_its_inverse_is_the_identity(void **state) {
  (void)state;
  struct draw draw = draw_named("a_matrix_times_its_inverse_is_the_identity");
  for (int k = 0; k < 1000; k++) {
    struct transform t = draw_transform(&draw), inverse;
    double determinant = transform_determinant(t);
    assert_true(transform_invert(t, &inverse));
    struct vec p = vec(2.385, -1.25, 0.75);
    struct vec back = transform_point(&inverse, transform_point(&t, p));
    assert_near(back, p, 16 * DBL_EPSILON * 141 * 6 / fabs(determinant));
  }
}

static void determinants_have_the_sign_of_the_handedness(void **state) {
  (void)state;
  assert_true(transform_determinant(transform_scale(vec(2, 3, -5))) == -30);
  assert_true(transform_determinant(transform_rotate(90, vec(0, 1, 0))) == 1);
}

static void flat_matrices_have_no_inverse(void **state) {
  (void)state;
  struct transform inverse;
  assert_false(transform_invert(transform_scale(vec(1, 0, 1)), &inverse));
  struct transform equal_columns = {{{1, 1, 5, 0}, {2, 2, 6, 0}, {3, 3, 7, 0}}};
  assert_false(transform_invert(equal_columns, &inverse));
}

static void look_at_puts_the_eye_at_the_origin_and_looks_along_z(void **state) {
  (void)state;
  struct transform t;
  assert_true(transform_look_at(vec(0, 1, -3.4), vec(0, 1, 0), vec(0, 1, 0), &t));
  assert_near(at(t, 0, 1, -3.4), vec(0, 0, 0), 0);
  assert_near(at(t, 0, 1, 0), vec(0, 0, 3.4), 0);
  assert_near(at(t, 1, 1, -3.4), vec(1, 0, 0), 0); // left-handed: x is to the right
  assert_near(at(t, 0, 2, -3.4), vec(0, 1, 0), 0);
  assert_true(transform_look_at(vec(3, 0, 0), vec(0, 0, 0), vec(1, 0, 7), &t)); // up is tilted
  assert_near(at(t, 0, 0, 0), vec(0, 0, 3), 8 * DBL_EPSILON);
  assert_near(at(t, 3, 0, 1), vec(0, 1, 0), 8 * DBL_EPSILON);
  assert_near(at(t, 3, -1, 0), vec(1, 0, 0), 8 * DBL_EPSILON); // right = up x forward
}

static void look_at_without_a_direction_is_refused(void **state) {
  (void)state;
  struct transform t;
  assert_false(transform_look_at(vec(1, 2, 3), vec(1, 2, 3), vec(0, 1, 0), &t));
  assert_false(transform_look_at(vec(1, 2, 3), vec(1, 5, 3), vec(0, -1, 0), &t));
  assert_false(transform_look_at(vec(1, 2, 3), vec(1, 5, 4), vec(0, 0, 0), &t));
}

// n . v is kept when v moves with the map and n with the inverse's transpose.
static void normals_stay_perpendicular(void **state) {
  (void)state;
  struct draw draw = draw_named("normals_stay_perpendicular");
  for (int k = 0; k < 1000; k++) {
    struct transform t = draw_transform(&draw), inverse;
    assert_true(transform_invert(t, &inverse));
    struct vec n = draw_direction(&draw), v = draw_direction(&draw);
    double moved = vec_dot(transform_normal(&inverse, n), transform_direction(&t, v));
    assert_true(fabs(moved - vec_dot(n, v)) <=
                16 * DBL_EPSILON * 141 / fabs(transform_determinant(t)));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_product_applies_its_right_factor_first),
      cmocka_unit_test(quarter_turns_are_exact_and_turn_x_to_y),
      cmocka_unit_test(other_rotations_have_their_known_values),
      cmocka_unit_test(columns_are_columns_and_projections_are_refused),
      cmocka_unit_test(a_matrix_times_its_inverse_is_the_identity),
      cmocka_unit_test(determinants_have_the_sign_of_the_handedness),
      cmocka_unit_test(flat_matrices_have_no_inverse),
      cmocka_unit_test(look_at_puts_the_eye_at_the_origin_and_looks_along_z),
      cmocka_unit_test(look_at_without_a_direction_is_refused),
      cmocka_unit_test(normals_stay_perpendicular),
  };
  return cmocka_run_group_tests_name("transform", tests, NULL, NULL);
}
