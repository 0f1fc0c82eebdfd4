#include "pbrt/params.h"

#include "pbrt/parse.h"
#include "pbrt/suggest.h"
#include "scene_text.h"

static struct problem problem;

// The parameters of a text that begins with one.
static bool parse(const char *text, struct params *params) {
  struct test_memory memory = *test_memory();
  problem = (struct problem){{0}};
  struct text bytes = {arena_string(&memory.keep, text, (ptrdiff_t)strlen(text)),
                       (ptrdiff_t)strlen(text)};
  struct lexer lexer = lexer_begin("t.pbrt", bytes, &problem);
  return lexer_advance(&lexer) &&
         params_parse(&lexer, &memory.keep, "Thing \"x\"", lexer.token.place, params);
}

static struct params parsed(const char *text) {
  struct params params;
  if (!parse(text, &params)) fail_msg("%s", problem.text);
  return params;
}

static void values_come_back_with_and_without_brackets(void **state) {
  (void)state;
  struct params params =
      parsed("\"float a\" 2.385 \"float b\" [ -7.25 ] # comment ] \"\n"
             "\"integer i\"[12]\"bool t\" true \"bool f\" [\"false\"] \"string s\" \"x\\\"\\\\y\"\n"
             "\"point3 p\" [1 2.5 -3] \"rgb c\" [.25 .5 .75] \"integer n\" [3 1 2 9]");
  assert_true(params_float(&params, "a", 0) == 2.385);
  assert_true(params_float(&params, "b", 0) == -7.25);
  assert_int_equal(params_integer(&params, "i", 0), 12);
  assert_true(params_bool(&params, "t", false));
  assert_false(params_bool(&params, "f", true));
  assert_string_equal(params_string(&params, "s", ""), "x\"\\y");
  struct vec p = params_point3(&params, "p", vec(0, 0, 0));
  assert_true(p.x == 1 && p.y == 2.5 && p.z == -3);
  double c[3];
  assert_true(params_rgb(&params, "c", c));
  assert_true(c[0] == 0.25 && c[1] == 0.5 && c[2] == 0.75);
  ptrdiff_t count;
  const double *n = params_array(&params, "integer", "n", &count);
  assert_true(count == 4 && n[0] == 3 && n[3] == 9);
  assert_true(params_finish(&params));
}

static void absent_parameters_give_the_fallback(void **state) {
  (void)state;
  struct params params = parsed("");
  double c[3] = {7, 8, 9};
  ptrdiff_t count = 5;
  assert_true(params_float(&params, "a", 2.385) == 2.385);
  assert_int_equal(params_integer(&params, "i", -3), -3);
  assert_true(params_bool(&params, "t", true));
  assert_string_equal(params_string(&params, "s", "fallback"), "fallback");
  assert_false(params_rgb(&params, "c", c));
  assert_true(c[0] == 7 && c[2] == 9);
  assert_null(params_array(&params, "point3", "P", &count));
  assert_int_equal(count, 0);
  assert_true(params_finish(&params));
}

static void what_nobody_took_is_a_problem_that_names_the_nearest(void **state) {
  (void)state;
  struct params params = parsed("\"float radius\" 1\n  \"float raduis2\" 2");
  params_float(&params, "radius", 0);
  params_float(&params, "radius2", 0);
  params_float(&params, "height", 0);
  assert_false(params_finish(&params));
  assert_string_equal(problem.text,
                      "t.pbrt:2:3: Thing \"x\" does not read a parameter \"raduis2\"; "
                      "did you mean \"radius2\"?");
}

static void the_wrong_type_or_count_is_a_problem_and_the_first_is_kept(void **state) {
  (void)state;
  struct params params = parsed("\"integer fov\" 38 \"float two\" [1 2]");
  assert_true(params_float(&params, "fov", 90) == 90);
  assert_true(params_float(&params, "two", 5) == 5);
  assert_false(params_finish(&params));
  assert_string_equal(problem.text,
                      "t.pbrt:1:1: Thing \"x\": \"fov\" must be of type float, not integer");
  params = parsed("\"float two\" [1 2]");
  assert_true(params_float(&params, "two", 5) == 5);
  assert_string_equal(problem.text, "t.pbrt:1:1: Thing \"x\": \"float two\" needs 1 value, has 2");
}

static void a_complaint_stands_at_its_parameter(void **state) {
  (void)state;
  struct params params = parsed("\"float a\" 1\n\n \"float b\" 2");
  assert_false(params_complain(&params, "b", "too %s", "small"));
  assert_string_equal(problem.text, "t.pbrt:3:2: Thing \"x\": too small");
}

static void names_are_as_far_apart_as_their_letters(void **state) {
  (void)state;
  assert_int_equal(suggest_distance("kitten", "sitting"), 3);
  assert_int_equal(suggest_distance("Shape", "shape"), 0);
  assert_int_equal(suggest_distance("Shpae", "Shape"), 1);
  assert_int_equal(suggest_distance("", "abc"), 3);
  static const char *const names[] = {"Camera", "Shape", "Sampler"};
  assert_string_equal(suggest_name("Samper", names, 3), "Sampler");
  assert_null(suggest_name("Texture", names, 3));
}

// A parameter type that pbrt has must be known by its name, with its group of numbers.
static void all_parameter_types_are_read(void **state) {
  (void)state;
  static const char *const texts[] = {
      "\"integer a\" -3",        "\"float a\" 1e-3",     "\"point2 a\" [1 2]",
      "\"vector2 a\" [1 2]",     "\"point3 a\" [1 2 3]", "\"vector3 a\" [1 2 3]",
      "\"normal3 a\" [1 2 3]",   "\"point a\" [1 2 3]",  "\"vector a\" [1 2 3]",
      "\"normal a\" [1 2 3]",    "\"rgb a\" [1 2 3]",    "\"blackbody a\" 6500",
      "\"spectrum a\" \"Au-k\"", "\"spectrum a\" [1 2]", "\"texture a\" \"wood\"",
      "\"string a\" \"wood\"",   "\"bool a\" true"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    assert_int_equal(parsed(texts[i]).count, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_come_back_with_and_without_brackets),
      cmocka_unit_test(absent_parameters_give_the_fallback),
      cmocka_unit_test(what_nobody_took_is_a_problem_that_names_the_nearest),
      cmocka_unit_test(the_wrong_type_or_count_is_a_problem_and_the_first_is_kept),
      cmocka_unit_test(a_complaint_stands_at_its_parameter),
      cmocka_unit_test(names_are_as_far_apart_as_their_letters),
      cmocka_unit_test(all_parameter_types_are_read),
  };
  return cmocka_run_group_tests_name("pbrt_params", tests, NULL, NULL);
}
