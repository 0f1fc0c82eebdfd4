#include "pbrt/number.h"

#include "scene_text.h"

#include <stdlib.h>

static double scanned(const char *text) {
  double value;
  if (!number_scan(text, (ptrdiff_t)strlen(text), &value)) fail_msg("rejected: %s", text);
  return value;
}

static void halfway_tiny_and_long_numbers_round_to_the_nearest_double(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double value; // hexadecimal: exact
  } cases[] = {
      {"9007199254740993", 0x1p53},
      {"9007199254740995", 0x1.0000000000002p53},
      {"9007199254740993.00000000000000000000000000001", 0x1.0000000000001p53},
      {"1e23", 0x1.52d02c7e14af6p76},
      {"2.2250738585072014e-308", 0x1p-1022},
      {"5e-324", 0x1p-1074},
      {"2e-324", 0},
      {"1.7976931348623157e308", 0x1.fffffffffffffp1023},
      {"1.7976931348623159e308", INFINITY},
      {"-1e999999999999", -INFINITY},
      {"0e999999999999", 0},
      {"1e-999999999999", 0},
      {".5", 0.5},
      {"+5.", 5},
      {"-.25E+1", -2.5},
      {"0.1", 0x1.999999999999ap-4},
      {"00000000000000000000000000000001", 1},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    if (scanned(cases[i].text) != cases[i].value)
      fail_msg("%s gave %a", cases[i].text, scanned(cases[i].text));
  assert_true(signbit(scanned("-0")));
}

// 3 to 22 digits, exponents -40 to 40: both the one-operation path and the slow one. libc's strtod
// is exactly rounded.
static void random_decimals_equal_the_exact_strtod(void **state) {
  (void)state;
  struct draw draw = draw_named("random_decimals_equal_the_exact_strtod");
  for (int i = 0; i < 200000; i++) {
    char text[64];
    int used = snprintf(text, sizeof text, "%s", i % 2 ? "-" : "");
    int digits = 3 + (int)draw_between(&draw, 0, 20), point = (int)draw_between(&draw, 0, digits);
    for (int k = 0; k < digits; k++) {
      if (k == point) text[used++] = '.';
      text[used++] = (char)('0' + (int)draw_between(&draw, 0, 10));
    }
    snprintf(text + used, sizeof text - (size_t)used, "e%d", (int)draw_between(&draw, -40, 41));
    if (scanned(text) != strtod(text, NULL)) fail_msg("%s", text);
  }
}

static void what_is_no_decimal_number_is_rejected(void **state) {
  (void)state;
  static const char *const cases[] = {"",     "+",   "-",    ".",     "-.",  "e5",
                                      "1e",   "1e+", "0x10", "1.2.3", "nan", "inf",
                                      "-inf", "1f",  "--1",  "1 ",    "1,5", "1e5.0"};
  double value;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    if (number_scan(cases[i], (ptrdiff_t)strlen(cases[i]), &value)) fail_msg("took %s", cases[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halfway_tiny_and_long_numbers_round_to_the_nearest_double),
      cmocka_unit_test(random_decimals_equal_the_exact_strtod),
      cmocka_unit_test(what_is_no_decimal_number_is_rejected),
  };
  return cmocka_run_group_tests_name("pbrt_number", tests, NULL, NULL);
}
