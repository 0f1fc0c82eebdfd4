#define _DEFAULT_SOURCE // fork
#include "tests/bench/measure.h"

#include "base/file.h"
#include "base/problem.h"
#include "tests/bench/clock.h"
#include "tests/bench/trial.h"

#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

// Four runs of four iterations, of the measurement that the iteration parts time.
static const char experiment[] = "scene: scenes/cornell-box.pbrt\nintegrator: probabilistic\n"
                                 "radius: 0.05\nphotons: 65536\ndirect: nee\n"
                                 "iterations: 4\nruns: 4\n";
enum { ITERATIONS = 16 };

// The same experiment by two processes that share nothing but the machine.
struct pair {
  struct trial *trial[2];
  int ask, answer; // pipes of the other process
};

static void say(int to) {
  if (write(to, "", 1) != 1) die("bench: the other process is gone");
}

static bool hear(int from) {
  char byte;
  return read(from, &byte, 1) == 1;
}

static void by_processes(void *data, int repetition) {
  struct pair *pair = data;
  say(pair->ask);
  trial_run(pair->trial[0], repetition);
  if (!hear(pair->answer)) die("bench: the other process is gone");
}

// A process that runs the experiment whenever it is asked, until nobody can ask.
static void start_process(struct pair *pair) {
  int ask[2], answer[2];
  if (pipe(ask) || pipe(answer)) die("bench: no pipe");
  pid_t child = fork();
  if (child < 0) die("bench: cannot start a process");
  pair->ask = ask[1], pair->answer = answer[0];
  if (child > 0) {
    close(ask[0]), close(answer[1]);
    return;
  }
  close(ask[1]), close(answer[0]);
  while (hear(ask[0])) {
    trial_run(pair->trial[1], 0);
    say(answer[1]);
  }
  _exit(0);
}

static void write_experiment(struct bench *bench, const char *path) {
  struct problem problem = {{0}};
  struct file_out out;
  if (!file_make_directory(bench->folder, &problem) || !file_begin(&out, path, &problem))
    die("%s", problem.text);
  fputs(experiment, out.stream);
  if (!file_commit(&out, &problem)) die("%s", problem.text);
}

static struct trial *trial_of(struct bench *bench, const char *name, int threads) {
  const char *path = arena_format(bench->arena, "%s/threads.yaml", bench->folder);
  write_experiment(bench, path);
  struct trial *trial =
      trial_new(bench, path, "default", arena_format(bench->arena, "threads/%s", name));
  trial->options.threads = threads;
  return trial;
}

static void add(struct bench *bench, const char *name, const char *base, double iterations,
                void (*body)(void *, int), void *data) {
  bench_add(bench, "threads",
            (struct row){.name = name,
                         .kind = RATE,
                         .unit = "iterations/s",
                         .work = iterations,
                         .body = body,
                         .data = data,
                         .base = base,
                         .threads = 2});
}

static double thread_cpu(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// CPU seconds of all threads over those of this one, which does what is not shared out: what two
// cores would gain if nobody else wanted them.
static void add_share(struct bench *bench, const char *name, void (*body)(void *, int),
                      void *data) {
  if (!bench_wants(bench, "threads", name)) return;
  body(data, -1);
  struct seconds begin = clock_now();
  double own = thread_cpu();
  for (int k = 0; k < 4; k++) body(data, k);
  bench_add(bench, "threads",
            (struct row){.name = name,
                         .kind = COUNT,
                         .unit = "at best",
                         .work = clock_since(begin).cpu / (thread_cpu() - own)});
}

static void add_experiments(struct bench *bench) {
  struct pair *pair = arena_new(bench->arena, struct pair, 1);
  struct trial *one = trial_of(bench, "one", 1), *two = trial_of(bench, "two", 2);
  pair->trial[0] = trial_of(bench, "here", 1);
  pair->trial[1] = trial_of(bench, "there", 1);
  start_process(pair); // before there are threads
  trial_check_same(one, two, false);
  add(bench, "experiment-1", NULL, ITERATIONS, trial_run, one);
  add(bench, "experiment-2", "experiment-1", ITERATIONS, trial_run, two);
  add_share(bench, "experiment-share", trial_run, two);
  add(bench, "processes-2", "experiment-1", 2 * ITERATIONS, by_processes, pair);
}

static void rows(struct bench *bench) {
  add_experiments(bench);
  struct measurement measure = measure_of(bench_scene(bench, "box"), true);
  struct steps *one = steps_new("sppm", measure, bench->arena);
  steps_check(one, 2, "one-iteration");
  measure.threads = 2;
  struct steps *two = steps_new("sppm", measure, bench->arena);
  add(bench, "one-iteration-1", NULL, 1, steps_run, one);
  add(bench, "one-iteration-2", "one-iteration-1", 1, steps_run, two);
  add_share(bench, "one-iteration-share", steps_run, two);
}

const struct part_type part_threads = {
    "threads",
    "wall time of an experiment of four runs, and of sppm's iteration, by one and by two threads",
    7, rows};
