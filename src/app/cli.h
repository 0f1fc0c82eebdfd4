// The command line: one table of commands, one table of options.
#ifndef APP_CLI_H
#define APP_CLI_H

#include "base/arena.h"
#include "base/problem.h"
#include "run/plan.h"

enum { EXIT_USAGE = 2, CLI_MAX_SETTINGS = 32 };

// What was said on the command line.
struct cli {
  const char *argument;   // the file or directory the command is about, or NULL
  const char **arguments; // all of them, where a command takes more than one
  int n_arguments;
  const char *output, *quality;    // NULL: not said
  const struct fit_method *method; // NULL: not said
  bool csv;
  struct run_options options;
  struct cli_setting { // keys of an experiment, in the order given
    const char *option, *key, *text;
  } setting[CLI_MAX_SETTINGS];
  int n_settings;
  const char *source; // where the settings were said, for messages
  struct arena *arena;
};

struct command {
  const char *name;
  const char *argument; // "SCENE", shown in the usage; "[WHAT]": may be left out; "FILE...": or
                        // more; NULL: none
  const char *about;
  const char *options; // names of those that have an effect, separated by spaces
  int (*run)(struct cli *, struct problem *); // the exit status; 0 with a problem set counts as 1
};

// Applies the settings to a cell through the experiment's own readers.
bool cli_apply(const struct cli *, struct cell *, struct problem *);

// The text said for a key, or NULL.
const char *cli_setting_of(const struct cli *, const char *key);

// The program; returns the exit status: 0, 1 (a problem), 2 (usage), 128 + signal (interrupted).
int cli_main(int argc, char **argv);

extern const struct command command_predict, command_plan, command_run, command_fit, command_plot,
    command_render, command_info, command_reference, command_compare, command_list,
    command_validate, command_efficiency;

#endif
