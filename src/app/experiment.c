// photonlab run, fit, plot: an experiment from its file to its figure.
#define _GNU_SOURCE // readlink
#include "analysis/fit_methods.h"
#include "analysis/fit_radii.h"
#include "app/cli.h"
#include "app/pixels.h"
#include "base/file.h"
#include "run/interrupt.h"
#include "run/run.h"

#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static int run(struct cli *cli, struct problem *problem) {
  const char *quality = cli->quality ? cli->quality : "default";
  struct experiment experiment;
  if (!experiment_read(cli->argument, quality, cli->arena, &experiment, problem)) return 1;
  for (int c = 0; c < experiment.n_cells; c++)
    if (!cli_apply(cli, &experiment.cell[c], problem)) return 1;
  const char *directory =
      cli->output ? cli->output : arena_format(cli->arena, "results/%s", experiment.name);
  cli->options.largest_rate_se = fit_largest_rate_se;
  switch (run_experiment(&experiment, directory, cli->options, cli->arena, problem)) {
  case RUN_DONE:
    printf("%s\n", directory);
    return 0;
  case RUN_INTERRUPTED:
    return 128 + interrupt_signal();
  default:
    return 1;
  }
}

// The figure's curves are those of the iterations' fits: another method leaves them alone.
static bool write_curves(const struct cli *cli, const struct fit *fit, struct problem *problem) {
  return fit->method != &fit_methods[0] ||
         fit_write_curves(fit, arena_format(cli->arena, "%s/curves.csv", cli->argument), problem);
}

static int fit(struct cli *cli, struct problem *problem) {
  const struct fit_method *method = cli->method ? cli->method : &fit_methods[0];
  struct results results;
  struct fit fit;
  struct fit_radii radii;
  if (!results_read(cli->argument, cli->arena, &results, problem) ||
      !fit_results_by(method, &results, cli->arena, &fit, problem) ||
      !fit_write_json(&fit, arena_format(cli->arena, "%s/fit.json", cli->argument), problem) ||
      !write_curves(cli, &fit, problem) || !fit_radii(&results, cli->arena, &radii, problem) ||
      !fit_radii_write(&radii, arena_format(cli->arena, "%s/radii.csv", cli->argument), problem))
    return 1;
  fit_print_table(&fit, stdout);
  fit_radii_print(&radii, stdout);
  return 0;
}

// A file of paper-figures: in the working directory, or where `make install` puts it; NULL:
// neither.
static char *figure_script(const char *name, struct arena *arena) {
  char *here = arena_format(arena, "paper-figures/%s.gp", name);
  if (file_exists(here)) return here;
  char self[4096];
  ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
  if (length <= 0) return NULL;
  self[length] = 0;
  *strrchr(self, '/') = 0;
  char *installed = arena_format(arena, "%s/../share/photonlab/%s", self, here);
  return file_exists(installed) ? installed : NULL;
}

// The experiment's own figure, else the one that draws whatever there is.
static int plot(struct cli *cli, struct problem *problem) {
  const char *name;
  if (!results_name(cli->argument, cli->arena, &name, problem)) return 1;
  char *script = figure_script(name, cli->arena);
  if (!script) script = figure_script("default", cli->arena);
  if (!script)
    return problem_set(problem, "paper-figures: neither %s.gp nor default.gp is there", name), 1;
  char *figures = arena_format(cli->arena, "%s/figures", cli->argument);
  if (!file_make_directory(figures, problem)) return 1;
  if (!pixels_write(cli->argument, *cli->arena, problem)) return 1;
  char *const words[] = {"gnuplot", "-c", script, (char *)cli->argument, NULL};
  pid_t child;
  int status;
  if (posix_spawnp(&child, words[0], NULL, NULL, words, environ) != 0 ||
      waitpid(child, &status, 0) != child)
    return problem_set(problem, "cannot run gnuplot: is it installed?"), 1;
  if (status != 0)
    return problem_set(problem, "%s: gnuplot failed; is %s/curves.csv there (photonlab fit)?",
                       script, cli->argument),
           1;
  printf("%s\n", figures);
  return 0;
}

const struct command command_run = {"run", "EXPERIMENT",
                                    "runs an experiment file, into results/NAME or -o DIR",
                                    "output threads quiet no-skip lenient quality seed", run};

const struct command command_fit = {
    "fit", "DIR", "fits rates to the results in DIR: table, fit.json, curves.csv, radii.csv",
    "method", fit};

const struct command command_plot = {
    "plot", "DIR", "draws the experiment's figure from the results in DIR", "", plot};
