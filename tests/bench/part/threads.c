#define _DEFAULT_SOURCE // fork
#include "tests/bench/measure.h"

#include "base/problem.h"

#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

// Two iterations by two threads, or by two processes that share nothing but the machine.
struct pair {
  struct steps *steps[2];
  int ask, answer; // pipes of the other process
};

static void by_threads(void *data, int repetition) {
  struct pair *pair = data;
#pragma omp parallel for num_threads(2) schedule(static, 1)
  for (int t = 0; t < 2; t++) steps_run(pair->steps[t], repetition);
}

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
  steps_run(pair->steps[0], repetition);
  if (!hear(pair->answer)) die("bench: the other process is gone");
}

// A process that runs the steps whenever it is asked, until nobody can ask.
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
    steps_run(pair->steps[1], 0);
    say(answer[1]);
  }
  _exit(0);
}

static struct pair *pair_new(const struct bench_scene *scene, struct arena *arena) {
  struct pair *pair = arena_new(arena, struct pair, 1);
  for (int t = 0; t < 2; t++)
    pair->steps[t] = steps_new("probabilistic", measure_of(scene, true), arena);
  return pair;
}

static void add(struct bench *bench, const char *name, const char *base, double iterations,
                int threads, void (*body)(void *, int), void *data) {
  bench_add(bench, "threads",
            (struct row){.name = name,
                         .kind = RATE,
                         .unit = "iterations/s",
                         .work = iterations,
                         .body = body,
                         .data = data,
                         .base = base,
                         .threads = threads});
}

static void rows(struct bench *bench) {
  const struct bench_scene *scene = bench_scene(bench, "box");
  struct measurement measure = measure_of(scene, true);
  struct pair *processes = pair_new(scene, bench->arena), *threads = pair_new(scene, bench->arena);
  start_process(processes); // before there are threads
  struct steps *one = steps_new("sppm", measure, bench->arena);
  steps_check(one, 2, "one-iteration");
  steps_check(threads->steps[0], 1, "independent");
  measure.threads = 2;
  struct steps *two = steps_new("sppm", measure, bench->arena);
  add(bench, "one-iteration-1", NULL, 1, 2, steps_run, one);
  add(bench, "one-iteration-2", "one-iteration-1", 1, 2, steps_run, two);
  add(bench, "independent-1", NULL, 1, 2, steps_run,
      steps_new("probabilistic", measure_of(scene, true), bench->arena));
  add(bench, "independent-2", "independent-1", 2, 2, by_threads, threads);
  add(bench, "processes-2", "independent-1", 2, 2, by_processes, processes);
}

const struct part_type part_threads = {
    "threads", "wall time of one thread and two: within sppm's iteration, and side by side", 7,
    rows};
