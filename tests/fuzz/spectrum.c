// Any bytes are a spectrum or a problem of one line, and whatever its numbers, its colours are in
// range.
#include "spectrum/spectrum.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void check(bool right) {
  if (!right) abort();
}

static void convert(const struct spectrum *spectrum) {
  double rgb[3], k[3];
  spectrum_albedo(spectrum, rgb);
  for (int c = 0; c < 3; c++) check(rgb[c] >= 0 && rgb[c] <= 1);
  spectrum_unbounded(spectrum, rgb);
  for (int c = 0; c < 3; c++) check(rgb[c] >= 0);
  if (spectrum_illuminant(spectrum, rgb))
    for (int c = 0; c < 3; c++) check(isfinite(rgb[c]));
  spectrum_conductor(spectrum, spectrum, rgb, k);
  for (int c = 0; c < 3; c++) check(rgb[c] >= 0 && k[c] >= 0 && isfinite(rgb[c]) && isfinite(k[c]));
  check(spectrum_index(spectrum) >= 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct arena arena;
  if (!arena.next) arena = arena_reserve();
  if (size > 1 << 12) return 0;
  struct arena a = arena;
  struct text text = {arena_string(&a, (const char *)data, (ptrdiff_t)size), (ptrdiff_t)size};
  struct spectrum spectrum;
  struct problem problem = {{0}};
  bool ok = spectrum_parse(text, "fuzz", &a, &spectrum, &problem);
  check(ok == (problem.text[0] == 0) && !strchr(problem.text, '\n'));
  if (ok) convert(&spectrum);
  return 0;
}
