#include "log/csv.h"

#include "base/file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

bool csv_bad(struct csv *csv, const char *what) {
  struct place place = {csv->path, csv->line, 1};
  return problem_at(csv->problem, place, "%s: the file is damaged, run the experiment again", what);
}

bool csv_row(struct csv *csv, int n, char **field) {
  csv->line++;
  for (int k = 0; k < n; k++) {
    size_t length = strcspn(csv->at, ",\n");
    if (csv->at[length] != (k + 1 < n ? ',' : '\n'))
      return csv_bad(csv, "a row has not as many fields as columns");
    field[k] = csv->at;
    field[k][length] = 0;
    csv->at += length + 1;
  }
  return true;
}

bool csv_numbers(struct csv *csv, char *const *field, int n, double *const *value) {
  for (int k = 0; k < n; k++) {
    char *end;
    *value[k] = strtod(field[k], &end);
    if (end == field[k] || *end) return csv_bad(csv, "a number is missing");
  }
  return true;
}

bool csv_whole(struct csv *csv, char *field, uint64_t least, uint64_t most, uint64_t *value) {
  double number = 0;
  if (!csv_numbers(csv, &field, 1, (double *[]){&number})) return false;
  if (!(number >= (double)least && number <= (double)most) || number != floor(number))
    return csv_bad(csv, "a number is out of range");
  *value = (uint64_t)number;
  return true;
}

bool csv_open(struct csv *csv, const char *path, const char *header, struct arena *arena,
              struct problem *problem) {
  struct text text;
  if (!file_read(path, arena, &text, problem)) return false;
  *csv = (struct csv){path, text.data, 1, XXH64(text.data, (size_t)text.length, 0), problem};
  size_t length = strcspn(text.data, "\n");
  if (length != strlen(header) || memcmp(text.data, header, length) != 0)
    return csv_bad(csv, "unexpected columns");
  csv->at += length + (text.data[length] != 0);
  return true;
}

bool csv_close(const struct csv *csv, uint64_t sum) {
  return csv->sum == sum ||
         problem_set(csv->problem, "%s: was changed after the run, run the experiment again",
                     csv->path);
}
