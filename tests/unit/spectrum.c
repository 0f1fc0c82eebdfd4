// Spectra to linear sRGB: the CIE's published chromaticities, pbrt-v4's measured black body,
// metals.
#include "spectrum/spectrum.h"
#include "spectrum/observer.h"

#include "base/exact.h"

#include <complex.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

static struct arena arena;

static void near(double got, double want, double tolerance, const char *what) {
  if (!(fabs(got - want) <= tolerance))
    fail_msg("%s: %.9g, not %.9g (tolerance %.2g)", what, got, want, tolerance);
}

static void near_rgb(const double rgb[3], double r, double g, double b, double tolerance,
                     const char *what) {
  near(rgb[0], r, tolerance, what);
  near(rgb[1], g, tolerance, what);
  near(rgb[2], b, tolerance, what);
}

// The matrix of IEC 61966-2-1, four digits: luminance and chromaticity of an sRGB triple to 1e-4.
static double luminance(const double rgb[3]) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static void assert_chromaticity(const double rgb[3], double x, double y, const char *what) {
  double X = 0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2], Y = luminance(rgb);
  double Z = 0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2];
  near(X / (X + Y + Z), x, 1e-4, what);
  near(Y / (X + Y + Z), y, 1e-4, what);
}

static void the_observer_s_sums_are_the_cie_s(void **state) {
  (void)state;
  double sum[3] = {0}; // CIE 15, over 380 to 780 nm
  for (int k = 0; k < OBSERVER_COUNT; k++) {
    int nm = OBSERVER_FIRST + k * OBSERVER_STEP;
    for (int c = 0; c < 3; c++) sum[c] += nm >= 380 && nm <= 780 ? observer_matching[k][c] : 0;
  }
  near_rgb(sum, 21.371524, 21.371327, 21.371540, 2e-6, "sums of x, y, z");
}

// ---- illuminants ----

static void named_illuminants_have_the_cie_s_chromaticities(void **state) {
  (void)state;
  static const struct {
    const char *name;
    double x, y;
  } published[] = {
      {"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35851},
      {"stdillum-D65", 0.31272, 0.32903}, {"illum-acesD60", 0.32168, 0.33767},
      {"stdillum-F1", 0.3131, 0.3372},    {"stdillum-F2", 0.3721, 0.3752},
      {"stdillum-F3", 0.4091, 0.3942},    {"stdillum-F4", 0.4402, 0.4032},
      {"stdillum-F5", 0.3138, 0.3453},    {"stdillum-F6", 0.3779, 0.3883},
      {"stdillum-F7", 0.3129, 0.3293},    {"stdillum-F8", 0.3459, 0.3587},
      {"stdillum-F9", 0.3742, 0.3728},    {"stdillum-F10", 0.3461, 0.3590},
      {"stdillum-F11", 0.3805, 0.3771},   {"stdillum-F12", 0.4370, 0.4044},
  };
  int n = sizeof published / sizeof published[0], illuminants = 0;
  for (int k = 0; k < n; k++) {
    const struct named_spectrum *named = spectrum_named(published[k].name);
    assert_non_null(named);
    assert_int_equal(named->kind, NAMED_ILLUMINANT);
    assert_chromaticity(named->rgb, published[k].x, published[k].y, named->name);
    near(luminance(named->rgb), 1, 2e-4, named->name);
  }
  for (int k = 0; k < n_named_spectra; k++)
    illuminants += named_spectra[k].kind == NAMED_ILLUMINANT;
  assert_int_equal(illuminants, n);
  assert_null(spectrum_named("stdillum-F13"));
}

// CIE 15, every 5 nm from 380 to 780.
enum { LAMP_COUNT = 81 };
// clang-format off
static const double f2[LAMP_COUNT] = {
    1.18, 1.48, 1.84, 2.15, 3.44, 15.69, 3.85, 3.74, 4.19, 4.62, 5.06, 34.98, 11.81, 6.27, 6.63,
    6.93, 7.19, 7.4, 7.54, 7.62, 7.65, 7.62, 7.62, 7.45, 7.28, 7.15, 7.05, 7.04, 7.16, 7.47, 8.04,
    8.88, 10.01, 24.88, 16.64, 14.59, 16.16, 17.56, 18.62, 21.47, 22.79, 19.29, 18.66, 17.73, 16.54,
    15.21, 13.8, 12.36, 10.95, 9.65, 8.4, 7.32, 6.31, 5.43, 4.68, 4.02, 3.45, 2.96, 2.55, 2.19,
    1.89, 1.64, 1.53, 1.27, 1.1, 0.99, 0.88, 0.76, 0.68, 0.61, 0.56, 0.54, 0.51, 0.47, 0.47, 0.43,
    0.46, 0.47, 0.4, 0.33, 0.27,
};
static const double f11[LAMP_COUNT] = {
    0.91, 0.63, 0.46, 0.37, 1.29, 12.68, 1.59, 1.79, 2.46, 3.33, 4.49, 33.94, 12.13, 6.95, 7.19,
    7.12, 6.72, 6.13, 5.46, 4.79, 5.66, 14.29, 14.96, 8.97, 4.72, 2.33, 1.47, 1.1, 0.89, 0.83, 1.18,
    4.9, 39.59, 72.84, 32.61, 7.52, 2.83, 1.96, 1.67, 4.43, 11.28, 14.76, 12.73, 9.74, 7.33, 9.72,
    55.27, 42.58, 13.18, 13.16, 12.26, 5.11, 2.07, 2.34, 3.58, 3.01, 2.48, 2.14, 1.54, 1.33, 1.46,
    1.94, 2, 1.2, 1.35, 4.1, 5.58, 2.51, 0.57, 0.27, 0.23, 0.21, 0.24, 0.24, 0.2, 0.24, 0.32, 0.26,
    0.16, 0.12, 0.09,
};
// clang-format on

static struct spectrum lamp(const double *power) {
  double *number = arena_new(&arena, double, 2 * LAMP_COUNT);
  for (int k = 0; k < LAMP_COUNT; k++) number[2 * k] = 380 + 5 * k, number[2 * k + 1] = power[k];
  struct spectrum spectrum;
  assert_null(spectrum_from_numbers(number, 2 * LAMP_COUNT, &spectrum));
  return spectrum;
}

static void sampled_lamps_are_the_named_ones(void **state) {
  (void)state;
  const char *name[] = {"stdillum-F2", "stdillum-F11"};
  const double *power[] = {f2, f11};
  for (int k = 0; k < 2; k++) {
    struct spectrum spectrum = lamp(power[k]);
    double rgb[3];
    assert_true(spectrum_illuminant(&spectrum, rgb));
    const double *row = spectrum_named(name[k])->rgb;
    near_rgb(rgb, row[0], row[1], row[2], 1e-4, name[k]); // rows have four digits
    near(luminance(rgb), 1, 2e-4, name[k]);
  }
}

static void illuminant_a_is_its_formula(void **state) {
  (void)state;
  double number[2 * 95], rgb[3];
  for (int k = 0; k < 95; k++) {
    double nm = 360 + 5 * k;
    number[2 * k] = nm;
    number[2 * k + 1] = 100 * pow(560 / nm, 5) * (exp(1.435e7 / (2848 * 560)) - 1) /
                        (exp(1.435e7 / (2848 * nm)) - 1);
  }
  struct spectrum spectrum;
  assert_null(spectrum_from_numbers(number, 2 * 95, &spectrum));
  assert_true(spectrum_illuminant(&spectrum, rgb));
  const double *row = spectrum_named("stdillum-A")->rgb;
  near_rgb(rgb, row[0], row[1], row[2], 2e-4, "A"); // lines between 5 nm of a curve
}

static void d65_is_white(void **state) {
  (void)state;
  double number[2 * D65_COUNT], rgb[3];
  for (int k = 0; k < D65_COUNT; k++) {
    number[2 * k] = D65_FIRST + k * D65_STEP;
    number[2 * k + 1] = d65_power[k];
  }
  struct spectrum spectrum;
  assert_null(spectrum_from_numbers(number, 2 * D65_COUNT, &spectrum));
  assert_true(spectrum_illuminant(&spectrum, rgb));
  near_rgb(rgb, 1, 1, 1, 1e-14, "D65");
  assert_chromaticity(rgb, 0.31272, 0.32903, "D65");
  struct spectrum dark = {(const double[][2]){{400, 0}, {500, 0}}, 2};
  assert_false(spectrum_illuminant(&dark, rgb));
}

static void black_bodies_are_on_the_planckian_locus(void **state) {
  (void)state;
  double rgb[3];
  spectrum_blackbody(6500, rgb); // pbrt-v4's image of one, three digits
  near_rgb(rgb, 1.043, 0.984, 1.035, 6e-4, "6500 K");
  static const double locus[][3] = {{1000, 0.6528, 0.3444},
                                    {2000, 0.5267, 0.4133},
                                    {4000, 0.3805, 0.3768},
                                    {10000, 0.2806, 0.2883}};
  for (int k = 0; k < 4; k++) { // Wyszecki, Stiles, table 1(3.11), of c2 = 1.4388e7
    spectrum_blackbody(locus[k][0], rgb);
    assert_chromaticity(rgb, locus[k][1], locus[k][2], "locus");
    near(luminance(rgb), 1, 1e-3, "luminance"); // the matrix has four digits
  }
  static const double extreme[] = {1e-3, 1, 24, 1e5, 1e9, 1e100, 1e300};
  for (int k = 0; k < 7; k++) {
    spectrum_blackbody(extreme[k], rgb);
    near(luminance(rgb), 1, 1e-3, "luminance");
  }
}

// ---- reflectances ----

static void constants_are_gray(void **state) {
  (void)state;
  struct spectrum constant = {(const double[][2]){{300, 0.2385}, {900, 0.2385}}, 2};
  double rgb[3];
  spectrum_albedo(&constant, rgb);
  assert_true(rgb[0] == 0.2385 && rgb[1] == 0.2385 && rgb[2] == 0.2385);
  spectrum_unbounded(&constant, rgb);
  assert_true(rgb[0] == 0.2385 && rgb[1] == 0.2385 && rgb[2] == 0.2385);
}

static void a_saturated_albedo_stays_one(void **state) {
  (void)state;
  for (double nm = 400; nm < 700; nm += 10) {
    const double sample[][2] = {{nm, 0}, {nm + 1, 1}, {nm + 30, 1}, {nm + 31, 0}};
    struct spectrum band = {sample, 4};
    double rgb[3];
    spectrum_albedo(&band, rgb);
    for (int c = 0; c < 3; c++) assert_true(rgb[c] >= 0 && rgb[c] <= 1);
  }
}

// What two halves of the spectrum reflect adds up to white.
static void reflectances_add_up(void **state) {
  (void)state;
  double low[SPECTRUM_COUNT], high[SPECTRUM_COUNT], a[3], b[3];
  for (int j = 0; j < SPECTRUM_COUNT; j++) low[j] = j < 200, high[j] = j >= 200;
  spectrum_reflected(low, a);
  spectrum_reflected(high, b);
  for (int c = 0; c < 3; c++) near(a[c] + b[c], 1, 1e-13, "halves");
}

// ---- metals ----

// eta and k of gold and copper as pbrt-v4 has them: {nm, eta Au, k Au, eta Cu, k Cu}.
enum { METAL_COUNT = 41 };
// clang-format off
static const double metal[METAL_COUNT][5] = {
    {359.374, 1.7276, 1.8524, 1.2816, 1.9317}, {364.659, 1.716, 1.862, 1.27, 1.95},
    {370.102, 1.7059, 1.883, 1.2491, 1.9724}, {375.710, 1.696, 1.906, 1.225, 2.015},
    {381.490, 1.6847, 1.9225, 1.2, 2.1216}, {387.451, 1.674, 1.936, 1.18, 2.21},
    {393.601, 1.666, 1.9478, 1.1744, 2.1772}, {399.949, 1.658, 1.956, 1.175, 2.13},
    {406.505, 1.6473, 1.9594, 1.1775, 2.1601}, {413.281, 1.636, 1.958, 1.18, 2.21},
    {420.285, 1.628, 1.9514, 1.1781, 2.2499}, {427.532, 1.616, 1.94, 1.175, 2.289},
    {435.032, 1.5962, 1.9245, 1.1728, 2.326}, {442.801, 1.562, 1.904, 1.17, 2.362},
    {450.852, 1.5021, 1.8759, 1.1653, 2.3976}, {459.201, 1.426, 1.846, 1.16, 2.433},
    {467.865, 1.3459, 1.8146, 1.1553, 2.4692}, {476.862, 1.242, 1.796, 1.15, 2.504},
    {486.212, 1.0868, 1.7974, 1.1428, 2.5359}, {495.937, 0.916, 1.84, 1.135, 2.564},
    {506.058, 0.7545, 1.9565, 1.1316, 2.5896}, {516.601, 0.608, 2.12, 1.12, 2.605},
    {527.592, 0.4918, 2.3262, 1.0924, 2.5956}, {539.062, 0.402, 2.54, 1.04, 2.583},
    {551.041, 0.3455, 2.7306, 0.9504, 2.5765}, {563.564, 0.306, 2.88, 0.826, 2.599},
    {576.671, 0.2676, 2.9406, 0.6459, 2.6781}, {590.401, 0.236, 2.97, 0.468, 2.809},
    {604.801, 0.2124, 3.015, 0.3513, 3.0107}, {619.921, 0.194, 3.06, 0.272, 3.24},
    {635.816, 0.1777, 3.07, 0.2308, 3.4582}, {652.548, 0.166, 3.15, 0.214, 3.67},
    {670.185, 0.161, 3.4458, 0.2092, 3.8631}, {688.801, 0.16, 3.8, 0.213, 4.05},
    {708.481, 0.1609, 4.0877, 0.2162, 4.2396}, {729.319, 0.164, 4.357, 0.223, 4.43},
    {751.419, 0.1695, 4.6102, 0.2365, 4.6196}, {774.901, 0.176, 4.86, 0.25, 4.817},
    {799.898, 0.1814, 5.1258, 0.2542, 5.0341}, {826.561, 0.188, 5.39, 0.26, 5.26}, {855.063, 0.1981, 5.6312, 0.28, 5.4856},
};
// clang-format on

static struct spectrum metal_spectrum(int column) {
  double *number = arena_new(&arena, double, 2 * METAL_COUNT);
  for (int k = 0; k < METAL_COUNT; k++)
    number[2 * k] = metal[k][0], number[2 * k + 1] = metal[k][column];
  struct spectrum spectrum;
  assert_null(spectrum_from_numbers(number, 2 * METAL_COUNT, &spectrum));
  return spectrum;
}

// Fresnel's amplitudes, with complex numbers.
static double fresnel(double eta, double k, double cosine) {
  double complex n = eta + I * k, c = csqrt(1 - (1 - cosine * cosine) / (n * n));
  double s = cabs((cosine - n * c) / (cosine + n * c)),
         p = cabs((n * cosine - c) / (n * cosine + c));
  return 0.5 * (s * s + p * p);
}

static void spectral_reflectance(int column, double cosine, double rgb[3]) {
  struct spectrum eta = metal_spectrum(column), k = metal_spectrum(column + 1);
  double value[SPECTRUM_COUNT];
  for (int j = 0; j < SPECTRUM_COUNT; j++) {
    double nm = SPECTRUM_FIRST + j;
    value[j] = fresnel(spectrum_at(&eta, nm), spectrum_at(&k, nm), cosine);
  }
  spectrum_reflected(value, rgb);
}

// The errors spectrum.h states, at 0, 30, 60, 75 and 85 degrees.
static void conductors_keep_the_spectral_reflectance(void **state) {
  (void)state;
  static const double cosines[] = {1, 0.8660254, 0.5, 0.25881905, 0.08715574};
  static const double limit[] = {1e-4, 1e-3, 3e-3, 6e-3, 0.015};
  for (int column = 1; column <= 3; column += 2) {
    struct spectrum eta = metal_spectrum(column), k = metal_spectrum(column + 1);
    double e[3], x[3], wanted[3];
    spectrum_conductor(&eta, &k, e, x);
    for (int j = 0; j < 5; j++) {
      spectral_reflectance(column, cosines[j], wanted);
      for (int c = 0; c < 3; c++) {
        bool gold_red = column == 1 && c == 0; // above 1 at normal incidence
        near(fresnel(e[c], x[c], cosines[j]), wanted[c], gold_red ? 0.023 : limit[j], "F");
      }
    }
  }
}

static void named_metals_are_the_sampled_ones(void **state) {
  (void)state;
  const char *name[] = {"metal-Au-eta", "metal-Au-k", "metal-Cu-eta", "metal-Cu-k"};
  for (int m = 0; m < 4; m += 2) {
    struct spectrum eta = metal_spectrum(m + 1), k = metal_spectrum(m + 2);
    double e[3], x[3];
    spectrum_conductor(&eta, &k, e, x);
    const double *row_e = spectrum_named(name[m])->rgb, *row_k = spectrum_named(name[m + 1])->rgb;
    for (int c = 0; c < 3; c++)
      for (double cosine = 1; cosine > 0; cosine -= 0.1)
        near(fresnel(row_e[c], row_k[c], cosine), fresnel(e[c], x[c], cosine), 1e-3, name[m]);
  }
}

// Normal reflectances as published (Real-Time Rendering, 4th edition, table 9.2; three digits).
static void metals_have_the_published_colours(void **state) {
  (void)state;
  static const struct {
    const char *name;
    double rgb[3];
  } published[] = {{"Ag", {0.972, 0.960, 0.915}},
                   {"Al", {0.913, 0.922, 0.924}},
                   {"Au", {0.9999, 0.782, 0.344}}, // red: 1.022, which no conductor has
                   {"Cu", {0.955, 0.638, 0.538}}};
  for (int m = 0; m < 4; m++) {
    const char *name = published[m].name;
    const double *eta = spectrum_named(arena_format(&arena, "metal-%s-eta", name))->rgb;
    const double *k = spectrum_named(arena_format(&arena, "metal-%s-k", name))->rgb;
    for (int c = 0; c < 3; c++) near(fresnel(eta[c], k[c], 1), published[m].rgb[c], 1e-3, name);
  }
}

// ---- reading ----

static void a_spectrum_is_linear_between_samples_and_zero_beyond(void **state) {
  (void)state;
  struct spectrum s = {(const double[][2]){{400, 1}, {500, 3}, {520, 2}}, 3};
  assert_true(spectrum_at(&s, 399.999) == 0 && spectrum_at(&s, 520.001) == 0);
  assert_true(spectrum_at(&s, 400) == 1 && spectrum_at(&s, 500) == 3 && spectrum_at(&s, 520) == 2);
  near(spectrum_at(&s, 425), 1.5, 1e-15, "between");
  near(spectrum_at(&s, 515), 2.25, 1e-15, "between");
  assert_true(spectrum_index(&s) == 2); // 587.6 nm is beyond the end
}

static void wrong_numbers_are_refused(void **state) {
  (void)state;
  struct spectrum s;
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1, 500}, 3, &s), "odd"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1}, 2, &s), "two pairs"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1, 400, 2}, 4, &s), "ascend"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1, 500, -2}, 4, &s), "negative"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){0, 1, 500, 2}, 4, &s), "greater"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1, 500, NAN}, 4, &s), "negative"));
  assert_non_null(strstr(spectrum_from_numbers((double[]){400, 1, 500, 1e31}, 4, &s), "1e30"));
  assert_non_null(strstr(spectrum_from_numbers(NULL, 0, &s), "two pairs"));
}

static bool parse(const char *text, struct spectrum *spectrum, struct problem *problem) {
  *problem = (struct problem){0};
  struct text file = {arena_string(&arena, text, (ptrdiff_t)strlen(text)), (ptrdiff_t)strlen(text)};
  return spectrum_parse(file, "a.spd", &arena, spectrum, problem);
}

static void files_of_pairs_are_read(void **state) {
  (void)state;
  struct spectrum s;
  struct problem problem;
  assert_true(parse("# a comment\n400 1.5# more\n\t500 2.5\r\n600 .5", &s, &problem));
  assert_int_equal(s.count, 3);
  assert_true(s.sample[2][0] == 600 && s.sample[2][1] == 0.5);
  assert_false(parse("400 1\n500 x2\n", &s, &problem));
  assert_non_null(strstr(problem.text, "a.spd:2:5: "));
  assert_false(parse("400 1\n500\n", &s, &problem));
  assert_non_null(strstr(problem.text, "a.spd: "));
  assert_false(parse("", &s, &problem));
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_observer_s_sums_are_the_cie_s),
      cmocka_unit_test(named_illuminants_have_the_cie_s_chromaticities),
      cmocka_unit_test(sampled_lamps_are_the_named_ones),
      cmocka_unit_test(illuminant_a_is_its_formula),
      cmocka_unit_test(d65_is_white),
      cmocka_unit_test(black_bodies_are_on_the_planckian_locus),
      cmocka_unit_test(constants_are_gray),
      cmocka_unit_test(a_saturated_albedo_stays_one),
      cmocka_unit_test(reflectances_add_up),
      cmocka_unit_test(conductors_keep_the_spectral_reflectance),
      cmocka_unit_test(named_metals_are_the_sampled_ones),
      cmocka_unit_test(metals_have_the_published_colours),
      cmocka_unit_test(a_spectrum_is_linear_between_samples_and_zero_beyond),
      cmocka_unit_test(wrong_numbers_are_refused),
      cmocka_unit_test(files_of_pairs_are_read),
  };
  return cmocka_run_group_tests_name("spectrum", tests, NULL, NULL);
}
