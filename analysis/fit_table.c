// The table on the terminal. Columns that are the same in every row are left out.
#define _POSIX_C_SOURCE 200809L // fileno, isatty

#include "analysis/fit_methods.h"
#include "experiment/cell_keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CELL_SIZE = 96 };

// A column beside those of the keys.
struct column {
  const char *head;
  bool left;         // aligned
  bool only_varying; // left out where every row says the same
  void (*print)(const struct fit_row *, char text[CELL_SIZE]);
};

static void copy(char *text, const char *from) { snprintf(text, CELL_SIZE, "%s", from); }

static void print_number(char *text, const char *format, double x) {
  if (isfinite(x))
    snprintf(text, CELL_SIZE, format, x);
  else
    copy(text, "-");
}

static void print_probe(const struct fit_row *row, char *text) {
  snprintf(text, CELL_SIZE, "%d,%d", row->probe->x, row->probe->y);
}
static void print_quantity(const struct fit_row *row, char *text) {
  copy(text, row->quantity == QUANTITY_VARIANCE ? "variance" : "bias");
}
static void print_first(const struct fit_row *row, char *text) {
  snprintf(text, CELL_SIZE, "%llu", (unsigned long long)row->first);
}
static void print_theory(const struct fit_row *row, char *text) {
  print_number(text, "%.4f", row->rate_theory);
}
static void print_rate(const struct fit_row *row, char *text) {
  copy(text, "-");
  if (isfinite(row->rate)) snprintf(text, CELL_SIZE, "%.4f +- %.4f", row->rate, row->rate_se);
}
static void print_interval(const struct fit_row *row, char *text) {
  copy(text, "");
  if (isfinite(row->rate_lo)) snprintf(text, CELL_SIZE, "[%.3f, %.3f]", row->rate_lo, row->rate_hi);
}
static void print_ratio(const struct fit_row *row, char *text) {
  copy(text, "-");
  double theory = row->coefficient_theory;
  if (isfinite(row->coefficient / theory))
    snprintf(text, CELL_SIZE, "%.3f +- %.3f", row->coefficient / theory,
             row->coefficient_se / fabs(theory));
}
static void print_verdict(const struct fit_row *row, char *text) {
  copy(text, verdict_names[row->verdict]);
  const char *separator = ":";
  bool unknown = row->verdict == VERDICT_NOT_RESOLVABLE || row->verdict == VERDICT_NOT_DETECTED;
  if (row->why && unknown)
    snprintf(text, CELL_SIZE, "%s: %s", verdict_names[row->verdict], row->why);
  for (int t = 0; t < row->n_tests; t++) {
    size_t length = strlen(text);
    if (!row->test[t].rejects) continue;
    snprintf(text + length, CELL_SIZE - length, "%s %s", separator, row->test[t].name);
    separator = ",";
  }
}

static const struct column columns[] = {
    {"probe", false, true, print_probe},         {"quantity", true, false, print_quantity},
    {"from", false, true, print_first},          {"theory", false, false, print_theory},
    {"rate", false, false, print_rate},          {"95 %", false, false, print_interval},
    {"coeff/theory", false, false, print_ratio}, {"verdict", true, false, print_verdict},
};
enum { N_COLUMNS = CELL_KEYS + sizeof columns / sizeof *columns };

// How column c is set: keys first, then `columns`.
struct setting {
  const char *head;
  bool left, shown;
  int width, digits;
};

static const char *text_of(const struct fit_row *row, int c, int digits, char buffer[CELL_SIZE]) {
  if (c < CELL_KEYS) return cell_keys[c].text(row->cell, digits, buffer);
  columns[c - CELL_KEYS].print(row, buffer);
  return buffer;
}

static bool differ(const struct fit_row *row, int c, int digits) {
  char one[CELL_SIZE], other[CELL_SIZE];
  return strcmp(text_of(&row[0], c, digits, one), text_of(&row[1], c, digits, other)) != 0;
}

// What differs from scene to scene needs no column: the scene tells it.
static bool must_differ(const struct fit_row *row, int c) {
  bool told_by_scene = c < CELL_KEYS && !cell_keys[c].always;
  return differ(row, c, 17) &&
         !(told_by_scene && strcmp(row[0].cell->scene, row[1].cell->scene) != 0);
}

// Where one row must differ from the next, so does what is shown of them: from four digits up.
static struct setting column_setting(const struct fit *fit, int c) {
  bool key = c < CELL_KEYS;
  const struct column *column = key ? NULL : &columns[c - CELL_KEYS];
  struct setting set = {.head = key ? cell_keys[c].name : column->head,
                        .left = key ? cell_keys[c].kind == KEY_NAME : column->left,
                        .shown = key ? cell_keys[c].always : !column->only_varying,
                        .digits = 4};
  for (int r = 0; r + 1 < fit->n_rows; r++)
    if (must_differ(&fit->row[r], c)) {
      set.shown = true;
      while (!differ(&fit->row[r], c, set.digits)) set.digits++;
    }
  set.width = (int)strlen(set.head);
  for (int r = 0; r < fit->n_rows; r++) {
    char buffer[CELL_SIZE];
    int length = (int)strlen(text_of(&fit->row[r], c, set.digits, buffer));
    set.width = length > set.width ? length : set.width;
  }
  return set;
}

static const char *colour_of(enum verdict verdict) {
  static const char *const colours[] = {"\033[32m", "\033[31m", "\033[33m", "\033[33m", "\033[33m"};
  return colours[verdict];
}

static bool in_colour(FILE *stream) {
  const char *forbidden = getenv("NO_COLOR");
  return !(forbidden && *forbidden) && isatty(fileno(stream));
}

static void print_cell(FILE *stream, int c, const struct setting *set, const char *text) {
  if (c == N_COLUMNS - 1)
    fprintf(stream, "%s", text);
  else
    fprintf(stream, set->left ? "%-*s  " : "%*s  ", set->width, text);
}

static void print_row(const struct fit_row *row, const struct setting *set, bool colour,
                      FILE *stream) {
  char buffer[CELL_SIZE];
  for (int c = 0; c < N_COLUMNS; c++) {
    if (!set[c].shown) continue;
    bool coloured = colour && c == N_COLUMNS - 1;
    if (coloured) fputs(colour_of(row->verdict), stream);
    print_cell(stream, c, &set[c], text_of(row, c, set[c].digits, buffer));
    if (coloured) fputs("\033[0m", stream);
  }
  fputc('\n', stream);
}

// How many rows say what, since rows that cannot tell do not decide the run's verdict.
static void print_counts(const struct fit *fit, FILE *stream) {
  const char *separator = "";
  for (int v = 0; v < N_VERDICTS; v++) {
    int count = 0;
    for (int r = 0; r < fit->n_rows; r++) count += fit->row[r].verdict == (enum verdict)v;
    if (count) fprintf(stream, "%s%d %s", separator, count, verdict_names[v]);
    if (count) separator = ", ";
  }
}

void fit_print_table(const struct fit *fit, FILE *stream) {
  bool colour = in_colour(stream);
  struct setting set[N_COLUMNS];
  if (fit->n_rows == 0) {
    fprintf(stream, "%s: no rate is asked for (quantity: none)\n", fit->experiment->name);
    return;
  }
  for (int c = 0; c < N_COLUMNS; c++) {
    set[c] = column_setting(fit, c);
    if (set[c].shown) print_cell(stream, c, &set[c], set[c].head);
  }
  fputc('\n', stream);
  for (int r = 0; r < fit->n_rows; r++) print_row(&fit->row[r], set, colour, stream);
  fprintf(stream, "%s: %s%s%s (", fit->experiment->name, colour ? colour_of(fit->verdict) : "",
          verdict_names[fit->verdict], colour ? "\033[0m" : "");
  print_counts(fit, stream);
  if (fit->method->caveat)
    fprintf(stream, "; %s: %s)\n", fit->method->name, fit->method->caveat);
  else
    fprintf(stream, "; family-wise level %g, each test at %.2g)\n", fit->level, fit->test_level);
}
