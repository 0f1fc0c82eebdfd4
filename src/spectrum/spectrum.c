#include "spectrum/spectrum.h"

#include "base/vec.h"
#include "numeric/elementary.h"
#include "spectrum/observer.h"

#include <assert.h>

double spectrum_at(const struct spectrum *spectrum, double nm) {
  const double(*sample)[2] = spectrum->sample;
  ptrdiff_t lo = 0, hi = spectrum->count - 1;
  if (!(nm >= sample[lo][0] && nm <= sample[hi][0])) return 0;
  while (hi - lo > 1) {
    ptrdiff_t middle = (lo + hi) / 2;
    if (sample[middle][0] <= nm)
      lo = middle;
    else
      hi = middle;
  }
  double t = (nm - sample[lo][0]) / (sample[hi][0] - sample[lo][0]);
  return nm == sample[hi][0] ? sample[hi][1] : sample[lo][1] + t * (sample[hi][1] - sample[lo][1]);
}

static double d65_at(int nm) {
  int k = (nm - D65_FIRST) / D65_STEP, rest = (nm - D65_FIRST) % D65_STEP;
  if (rest == 0) return d65_power[k];
  return d65_power[k] + (d65_power[k + 1] - d65_power[k]) * rest / D65_STEP;
}

static struct vec matching(int k) {
  const double *xyz = observer_matching[k];
  return vec(xyz[0], xyz[1], xyz[2]);
}

// The cubic through four neighbours (at the ends the line through two): narrow lines need it, whose
// chromaticities it gives as published.
static struct vec matching_at(int nm) {
  int k = (nm - OBSERVER_FIRST) / OBSERVER_STEP, rest = (nm - OBSERVER_FIRST) % OBSERVER_STEP;
  if (rest == 0) return matching(k);
  double t = (double)rest / OBSERVER_STEP;
  if (k == 0 || k + 2 >= OBSERVER_COUNT)
    return vec_along(vec_scale(matching(k), 1 - t), matching(k + 1), t);
  struct vec sum = vec_scale(matching(k - 1), -t * (t - 1) * (t - 2) / 6);
  sum = vec_along(sum, matching(k), (t + 1) * (t - 1) * (t - 2) / 2);
  sum = vec_along(sum, matching(k + 1), -(t + 1) * t * (t - 2) / 2);
  return vec_along(sum, matching(k + 2), (t + 1) * t * (t - 1) / 6);
}

// The sums over 1 nm of value times x, y, z.
static struct vec tristimulus(const double value[SPECTRUM_COUNT]) {
  struct vec sum = vec(0, 0, 0);
  for (int j = 0; j < SPECTRUM_COUNT; j++)
    sum = vec_along(sum, matching_at(SPECTRUM_FIRST + j), value[j]);
  return sum;
}

// XYZ to linear sRGB with `white` at (1, 1, 1): by Cramer's rule the amounts of the primaries, each
// relative to its amount in white.
static void to_rgb(struct vec xyz, struct vec white, double rgb[3]) {
  static const struct vec primary[3] = {{0.64, 0.33, 0.03}, {0.30, 0.60, 0.10}, {0.15, 0.06, 0.79}};
  for (int c = 0; c < 3; c++) {
    struct vec others = vec_cross(primary[(c + 1) % 3], primary[(c + 2) % 3]);
    rgb[c] = vec_dot(xyz, others) / vec_dot(white, others);
  }
}

static struct vec white_point(void) {
  double value[SPECTRUM_COUNT];
  for (int j = 0; j < SPECTRUM_COUNT; j++) value[j] = d65_at(SPECTRUM_FIRST + j);
  return tristimulus(value);
}

static bool emitted(const double value[SPECTRUM_COUNT], double rgb[3]) {
  struct vec xyz = tristimulus(value), white = white_point();
  if (!(xyz.y > 0 && 1 / xyz.y < INFINITY)) return false; // that of a subnormal number overflows
  to_rgb(vec_scale(xyz, 1 / xyz.y), vec_scale(white, 1 / white.y), rgb);
  return true;
}

void spectrum_reflected(const double value[SPECTRUM_COUNT], double rgb[3]) {
  double left[SPECTRUM_COUNT];
  for (int j = 0; j < SPECTRUM_COUNT; j++) left[j] = value[j] * d65_at(SPECTRUM_FIRST + j);
  to_rgb(tristimulus(left), white_point(), rgb);
}

static void sample_all(const struct spectrum *spectrum, double value[SPECTRUM_COUNT]) {
  for (int j = 0; j < SPECTRUM_COUNT; j++) value[j] = spectrum_at(spectrum, SPECTRUM_FIRST + j);
}

bool spectrum_illuminant(const struct spectrum *spectrum, double rgb[3]) {
  double value[SPECTRUM_COUNT];
  sample_all(spectrum, value);
  return emitted(value, rgb);
}

// A constant is gray to the last bit.
static void reflected(const struct spectrum *spectrum, double rgb[3]) {
  double value[SPECTRUM_COUNT];
  sample_all(spectrum, value);
  spectrum_reflected(value, rgb);
  for (int j = 1; j < SPECTRUM_COUNT; j++)
    if (value[j] != value[0]) return;
  for (int c = 0; c < 3; c++) rgb[c] = value[0];
}

void spectrum_albedo(const struct spectrum *spectrum, double rgb[3]) {
  reflected(spectrum, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = rgb[c] < 0 ? 0 : rgb[c] > 1 ? 1 : rgb[c];
}

void spectrum_unbounded(const struct spectrum *spectrum, double rgb[3]) {
  reflected(spectrum, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = rgb[c] < 0 ? 0 : rgb[c];
}

double spectrum_index(const struct spectrum *spectrum) {
  const double d_line = 587.6, *first = spectrum->sample[0],
               *last = spectrum->sample[spectrum->count - 1];
  return d_line < first[0] ? first[1] : d_line > last[0] ? last[1] : spectrum_at(spectrum, d_line);
}

// 1 - exp(-a); the next term of the series is below 1e-15 a.
static double one_minus_exp(double a) { return a < 1e-7 ? a * (1 - a / 2) : 1 - num_exp(-a); }

// Relative to the longest wavelength, the largest of exponents: nothing overflows. Proportional to
// nm^-5 / (exp(a) - 1) with a = c2 / (nm kelvin).
void spectrum_blackbody(double kelvin, double rgb[3]) {
  const double c2 = 1.438776877e7; // h c / k in nm K (SI 2019)
  const double longest = SPECTRUM_FIRST + SPECTRUM_COUNT - 1;
  double value[SPECTRUM_COUNT], a_longest = c2 / longest / kelvin;
  for (int j = 0; j < SPECTRUM_COUNT; j++) {
    double nm = SPECTRUM_FIRST + j, a = c2 / nm / kelvin, ratio = longest / nm;
    double power5 = ratio * ratio * ratio * ratio * ratio;
    value[j] = power5 * num_exp(a_longest - a) * (one_minus_exp(a_longest) / one_minus_exp(a));
  }
  bool bright = emitted(value, rgb);
  assert(bright);
}
