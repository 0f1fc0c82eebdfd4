#include "app/predict.h"

#include "base/file.h"
#include "experiment/value.h"

static bool read_from(const struct cli *cli, uint64_t *from, struct problem *problem) {
  const char *text = cli_setting_of(cli, "from");
  struct node node = {
      .kind = NODE_SCALAR, .place = {.file = "command line"}, .text = text ? text : ""};
  struct reading reading = {cli->arena, problem, "--from"};
  *from = 0;
  return !text || value_count(&reading, &node, 1, UINT64_MAX, from);
}

bool predict_line(struct predicted *predicted, uint64_t from, struct problem *problem) {
  uint64_t n = predicted->cell->iterations;
  predicted->from = from ? from : n > 100 ? n / 100 : 1;
  if (from > n)
    return problem_set(problem, "--from: %llu is beyond the %llu iterations",
                       (unsigned long long)from, (unsigned long long)n);
  predicted->slopes = curve_slopes(&predicted->curve, predicted->from);
  return true;
}

static bool write_csv(const char *path, const struct predicted *predicted, int n,
                      struct problem *problem) {
  struct file_out out;
  if (!file_begin(&out, path, problem)) return false;
  predict_print_csv(predicted, n, out.stream);
  return file_commit(&out, problem);
}

static int predict(struct cli *cli, struct problem *problem) {
  int n;
  uint64_t from;
  if (!read_from(cli, &from, problem)) return 1;
  struct predicted *predicted = cli->argument ? predict_experiment(cli, from, &n, problem)
                                              : predict_said(cli, from, &n, problem);
  if (!predicted) return 1;
  if (cli->output && !write_csv(cli->output, predicted, n, problem)) return 1;
  if (cli->csv)
    predict_print_csv(predicted, n, stdout);
  else
    predict_print(predicted, n, stdout);
  return 0;
}

const struct command command_predict = {
    "predict", "[EXPERIMENT]",
    "exact curves, limits and optima of N iterations, before they are run",
    "output csv quality law kernel dimension alpha photons radius iterations lambda density "
    "curvature laplacian bilaplacian from lenient",
    predict};
