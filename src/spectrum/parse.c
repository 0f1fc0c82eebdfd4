// Sampled spectra as files and parameters give them.
#include "pbrt/number.h"
#include "spectrum/spectrum.h"

const char *spectrum_from_numbers(const double *number, ptrdiff_t n, struct spectrum *spectrum) {
  if (n % 2) return "a spectrum is pairs of wavelength and value, but the count of numbers is odd";
  if (n < 4) return "a spectrum needs two pairs of wavelength (nm) and value at least";
  const double most = 1e30; // its fourth power is finite: indices of refraction are squared twice
  for (ptrdiff_t k = 0; k < n; k += 2) {
    if (!(number[k] > 0)) return "a wavelength must be greater than zero";
    if (k > 0 && !(number[k] > number[k - 2])) return "the wavelengths must ascend";
    if (!(number[k + 1] >= 0)) return "a spectrum must not be negative";
    if (!(number[k] < most && number[k + 1] < most)) return "a number of a spectrum is above 1e30";
  }
  spectrum->sample = (const double(*)[2])number;
  spectrum->count = n / 2;
  return NULL;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

struct cursor {
  const char *at, *end, *line_begin;
  int line;
};

static void skip_space(struct cursor *cursor) {
  bool comment = false;
  for (; cursor->at < cursor->end; cursor->at++) {
    if (*cursor->at == '#') comment = true;
    if (*cursor->at == '\n') {
      comment = false;
      cursor->line++;
      cursor->line_begin = cursor->at + 1;
    }
    if (!comment && !is_space(*cursor->at)) return;
  }
}

bool spectrum_parse(struct text text, const char *path, struct arena *arena,
                    struct spectrum *spectrum, struct problem *problem) {
  struct cursor cursor = {text.data, text.data + text.length, text.data, 1};
  struct {
    double *item;
    ptrdiff_t count, capacity;
  } numbers = {0};
  for (skip_space(&cursor); cursor.at < cursor.end; skip_space(&cursor)) {
    const char *begin = cursor.at;
    while (cursor.at < cursor.end && !is_space(*cursor.at) && *cursor.at != '#') cursor.at++;
    double value;
    if (!number_scan(begin, cursor.at - begin, &value))
      return problem_at(
          problem, (struct place){path, cursor.line, (int)(begin - cursor.line_begin) + 1},
          "a spectrum file holds pairs of wavelength (nm) and value, and this is no number");
    *arena_push(arena, &numbers) = value;
  }
  const char *wrong = spectrum_from_numbers(numbers.item, numbers.count, spectrum);
  return !wrong || problem_set(problem, "%s: %s", path, wrong);
}
