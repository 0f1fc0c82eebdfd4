#include "app/cli.h"

#include "analysis/fit_methods.h"
#include "base/simd.h"
#include "base/version.h"
#include "experiment/keys.h"
#include "pbrt/suggest.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An option sets a key of an experiment, or is taken by a function of its own.
struct option {
  const char *name, *value, *key, *about;
  bool (*take)(struct cli *, const char *text, struct problem *);
};

static bool take_output(struct cli *cli, const char *text, struct problem *problem) {
  (void)problem;
  cli->output = text;
  return true;
}

static bool take_quality(struct cli *cli, const char *text, struct problem *problem) {
  (void)problem;
  cli->quality = text;
  return true;
}

static bool take_quiet(struct cli *cli, const char *text, struct problem *problem) {
  (void)text, (void)problem;
  cli->options.quiet = true;
  return true;
}

static bool take_csv(struct cli *cli, const char *text, struct problem *problem) {
  (void)text, (void)problem;
  cli->csv = true;
  return true;
}

static bool take_method(struct cli *cli, const char *text, struct problem *problem) {
  cli->method = fit_method_find(text);
  return cli->method ||
         problem_set(problem, "--method: there is no method '%s' (photonlab list fit-methods)",
                     text);
}

static bool take_lenient(struct cli *cli, const char *text, struct problem *problem) {
  (void)text, (void)problem;
  cli->options.lenient = true;
  return true;
}

static bool take_no_skip(struct cli *cli, const char *text, struct problem *problem) {
  return skip_read(text, &cli->options.skip_off, problem);
}

static bool take_threads(struct cli *cli, const char *text, struct problem *problem) {
  char *end;
  long threads = strtol(text, &end, 10);
  if (end == text || *end || threads < 1 || threads > 4096)
    return problem_set(problem, "--threads: '%s' is not a number of threads", text);
  cli->options.threads = (int)threads;
  return true;
}

static const struct option options[] = {
    {"output", "PATH", NULL, "where the results go (also -o)", take_output},
    {"threads", "N", NULL, "threads; default all cores; any number gives the same bits",
     take_threads},
    {"quiet", NULL, NULL, "no progress", take_quiet},
    {"no-skip", "NAMES", NULL, "do not skip: all, or names of 'photonlab list skips'",
     take_no_skip},
    {"lenient", NULL, NULL, "leave displacement, normal maps and the like out, and say so",
     take_lenient},
    {"quality", "NAME", NULL, "default or paper", take_quality},
    {"until", "CONDITION", "until", "a standard error of every rate, as \"rate_se <= 0.004\"",
     NULL},
    {"seed", "SEED", "seed", "a number, or a name that is hashed", NULL},
    {"integrator", "NAME", "integrator", "see 'photonlab list integrators'", NULL},
    {"iterations", "N", "iterations", "how many iterations are averaged", NULL},
    {"spp", "N", "iterations", "samples a pixel: the same as --iterations", NULL},
    {"photons", "N", "photons", "emitted paths per iteration", NULL},
    {"radius", "R", "radius", "kernel support of iteration 1, in reference radii", NULL},
    {"radius-volume", "R", "radius-volume", "the same in participating media; default as --radius",
     NULL},
    {"reference-radius", "NAME", "reference-radius", "see 'photonlab list reference-radii'", NULL},
    {"k", "N", "k", "nearest photons, of knn or of photonmap", NULL},
    {"alpha", "A", "alpha", "fraction kept, in [0, 1]; a number or a ratio", NULL},
    {"kernel", "NAME", "kernel", "see 'photonlab list kernels'", NULL},
    {"law", "NAME", "law", "see 'photonlab list laws'", NULL},
    {"direct", "HOW", "direct", "direct light by photons or nee (next-event estimation)", NULL},
    {"view", "PATHS", "view", "all, or a sum of emitted, direct, caustics, indirect", NULL},
    {"maxdepth", "N", "depth", "most scatterings of a path, as in pbrt", NULL},
    {"pixel", "WHERE", "pixel", "centre or footprint", NULL},
    {"hit-points", "N", "hit-points", "ppm: points of its one eye pass in each pixel", NULL},
    {"method", "NAME", NULL, "see 'photonlab list fit-methods'; default likelihood", take_method},
    {"csv", NULL, NULL, "comma-separated values instead of a table", take_csv},
    {"dimension", "D", "dimension", "1 (beams), 2 (surfaces) or 3 (points in a volume)", NULL},
    {"lambda", "L", "lambda", "photons expected in the first disc", NULL},
    {"density", "P", "density", "instead: photons stored per emitted path and unit of area", NULL},
    {"curvature", "C", "curvature", "radius^2 Laplacian f / f of the light f", NULL},
    {"laplacian", "L", "laplacian", "instead: Laplacian f / f, per unit of area", NULL},
    {"bilaplacian", "B", "bilaplacian", "Laplacian of the Laplacian / f, per unit of area^2", NULL},
    {"from", "N", "from", "where the straight line begins; default two decades before the end",
     NULL},
};
enum { N_OPTIONS = sizeof options / sizeof *options };

static const struct command *const commands[] = {
    &command_predict,   &command_plan,   &command_run,     &command_fit,
    &command_plot,      &command_render, &command_compare, &command_efficiency,
    &command_reference, &command_info,   &command_list,    &command_validate};
enum { N_COMMANDS = sizeof commands / sizeof *commands };

// ---- help ----

static bool lists(const char *names, const char *option) {
  size_t length = strlen(option);
  for (const char *at = names; (at = strstr(at, option)); at += length)
    if ((at == names || at[-1] == ' ') && (at[length] == ' ' || !at[length])) return true;
  return false;
}

// Scripts may give these to any command, also where they change nothing.
static bool takes(const struct command *command, const char *option) {
  return lists("seed threads quiet", option) || lists(command->options, option);
}

static void print_help(void) {
  printf("photonlab measures how progressive photon mapping converges.\n\nusage: photonlab COMMAND "
         "...\n\n");
  for (int k = 0; k < N_COMMANDS; k++)
    printf("  %-10s %-12s %s\n", commands[k]->name,
           commands[k]->argument ? commands[k]->argument : "", commands[k]->about);
  printf(
      "\nphotonlab COMMAND --help lists a command's options; photonlab --version the version.\n");
}

static void print_command_help(const struct command *command) {
  printf("usage: photonlab %s%s%s [OPTIONS]\n%s\n\n", command->name, command->argument ? " " : "",
         command->argument ? command->argument : "", command->about);
  for (int k = 0; k < N_OPTIONS; k++) {
    if (!takes(command, options[k].name)) continue;
    char left[64];
    snprintf(left, sizeof left, "--%s%s%s", options[k].name, options[k].value ? " " : "",
             options[k].value ? options[k].value : "");
    bool matters = lists(command->options, options[k].name);
    printf("  %-20s %s\n", left, matters ? options[k].about : "accepted, without effect here");
  }
}

static int usage(const char *format, const char *what, const char *hint) {
  fputs("photonlab: ", stderr);
  fprintf(stderr, format, what);
  if (hint) fprintf(stderr, "; did you mean '%s'?", hint);
  fputs(" (photonlab --help)\n", stderr);
  return EXIT_USAGE;
}

// ---- reading ----

static const struct option *option_find(const char *name, size_t length) {
  for (int k = 0; k < N_OPTIONS; k++)
    if (strlen(options[k].name) == length && memcmp(options[k].name, name, length) == 0)
      return &options[k];
  return NULL;
}

static bool take(const struct option *option, const char *text, struct cli *cli,
                 struct problem *problem) {
  if (option->take) return option->take(cli, text, problem);
  if (cli->n_settings == CLI_MAX_SETTINGS) return problem_set(problem, "too many options");
  char *name = arena_format(cli->arena, "--%s", option->name);
  cli->setting[cli->n_settings++] = (struct cli_setting){name, option->key, text};
  return true;
}

// One option at argv[*at]; 0 or the exit status.
static int read_option(const struct command *command, char **argv, int argc, int *at,
                       struct cli *cli, struct problem *problem) {
  const char *word = argv[*at];
  bool brief = word[1] != '-';
  const char *name = brief ? (strcmp(word, "-o") == 0 ? "output" : "") : word + 2;
  size_t length = strcspn(name, "=");
  const struct option *option = option_find(name, length);
  if (!option || !takes(command, option->name)) {
    const char *names[N_OPTIONS];
    int n = 0;
    for (int k = 0; k < N_OPTIONS; k++)
      if (takes(command, options[k].name)) names[n++] = options[k].name;
    const char *hint = suggest_name(arena_string(cli->arena, name, (ptrdiff_t)length), names, n);
    return usage("unknown option '%s'", word, hint ? arena_format(cli->arena, "--%s", hint) : NULL);
  }
  const char *text = name[length] == '=' ? name + length + 1 : NULL;
  if (!option->value && text) return usage("option '%s' takes no value", word, NULL);
  if (option->value && !text && ++*at < argc) text = argv[*at];
  if (option->value && (!text || !*text)) return usage("option '%s' needs a value", word, NULL);
  take(option, text, cli, problem);
  return 0;
}

static int read_arguments(const struct command *command, int argc, char **argv, struct cli *cli,
                          struct problem *problem) {
  cli->arguments = arena_new(cli->arena, const char *, argc);
  for (int at = 2; at < argc; at++) {
    if (argv[at][0] == '-' && argv[at][1]) {
      int status = read_option(command, argv, argc, &at, cli, problem);
      if (status) return status;
    } else if (!command->argument || (cli->argument && !strstr(command->argument, "..."))) {
      return usage("unexpected argument '%s'", argv[at], NULL);
    } else {
      if (!cli->argument) cli->argument = argv[at];
      cli->arguments[cli->n_arguments++] = argv[at];
    }
  }
  if (command->argument && command->argument[0] != '[' && !cli->argument)
    return usage("%s is missing", command->argument, NULL);
  return 0;
}

const char *cli_setting_of(const struct cli *cli, const char *key) {
  for (int k = cli->n_settings - 1; k >= 0; k--)
    if (strcmp(cli->setting[k].key, key) == 0) return cli->setting[k].text;
  return NULL;
}

bool cli_apply(const struct cli *cli, struct cell *cell, struct problem *problem) {
  for (int s = 0; s < cli->n_settings; s++) {
    const struct cli_setting *setting = &cli->setting[s];
    struct node node = {.kind = NODE_SCALAR, .place = {.file = cli->source}, .text = setting->text};
    struct reading reading = {cli->arena, problem, setting->option};
    for (int k = 0; k < n_experiment_keys; k++)
      if (strcmp(experiment_keys[k].name, setting->key) == 0 &&
          !experiment_keys[k].read(&reading, &node, cell))
        return false;
  }
  return true;
}

static bool wants_help(int argc, char **argv) {
  for (int at = 2; at < argc; at++)
    if (strcmp(argv[at], "--help") == 0 || strcmp(argv[at], "-h") == 0) return true;
  return false;
}

int cli_main(int argc, char **argv) {
  const char *word = argc > 1 ? argv[1] : "--help";
  if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0) {
    print_help();
    return argc > 1 ? 0 : EXIT_USAGE;
  }
  if (strcmp(word, "--version") == 0) {
    printf("photonlab %s\n", photonlab_version);
    return 0;
  }
  const char *names[N_COMMANDS];
  const struct command *command = NULL;
  for (int k = 0; k < N_COMMANDS; k++) {
    names[k] = commands[k]->name;
    if (strcmp(word, names[k]) == 0) command = commands[k];
  }
  if (!command) return usage("unknown command '%s'", word, suggest_name(word, names, N_COMMANDS));
  if (wants_help(argc, argv)) {
    print_command_help(command);
    return 0;
  }
  simd_chosen(); // dies if PHOTONLAB_SIMD names none
  struct arena arena = arena_reserve();
  struct cli cli = {.source = "command line", .arena = &arena};
  struct problem problem = {0};
  int status = read_arguments(command, argc, argv, &cli, &problem);
  if (!status && !problem.text[0]) status = command->run(&cli, &problem);
  if (problem.text[0]) {
    fprintf(stderr, "photonlab: %s\n", problem.text);
    if (!status) status = 1;
  }
  if (fflush(stdout) != 0 || ferror(stdout)) die("cannot write to standard output");
  return status;
}
