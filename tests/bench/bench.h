// What `make bench` times: parts of rows. A part is a file in part/, collected by its name; it sets
// its rows up and checks what they compute, which is never timed unchecked. The rows of a part are
// then timed in turns, so that whatever else the machine does falls on all alike.
#ifndef TESTS_BENCH_BENCH_H
#define TESTS_BENCH_BENCH_H

#include "base/arena.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

// Work a second, seconds a unit of work, or a number that is not timed.
enum quantity_kind { RATE, COST, COUNT };

struct row {
  const char *name; // within the part; in words with slashes between, from the scene on
  enum quantity_kind kind;
  const char *unit; // of the figure
  double work;      // of one repetition, in the unit's terms; a count: the number itself
  void (*body)(void *data, int repetition); // from 0; one before, untimed, is -1
  void *data;
  // Of what the body leaves: the same after every repetition, or nothing is reported. NULL: the
  // part has compared it.
  uint64_t (*hash)(const void *data);
  const char *base; // a row before it in the part, to which its figure has a ratio; or NULL
  bool pair;        // one of two, which are told on a line: the second has the first for its base
  int threads;      // 0 or 1: CPU seconds, pinned to one core; more: wall seconds, not pinned
  bool mean;        // over repetitions that differ (iterations of a run), in place of the median
};

struct bench {
  const char *filter; // "part/row": what begins with this, or is asked for by it; "": all
  const char *perf;   // folder of the performance scenes
  const char *folder; // where scenes made here go
  int repetitions;    // 0: the part's own
  struct arena *arena;
  struct row *row; // of the part at work
  int n_rows;
};

struct part_type {
  const char *name, *about;
  int repetitions; // each of some 20 ms or more
  void (*rows)(struct bench *);
};
extern const struct part_type *const part_types[]; // NULL-terminated

// Whether any row whose name begins so is asked for; name NULL: any of the part.
bool bench_wants(const struct bench *, const char *part, const char *name);

// Keeps the row if it is asked for.
void bench_add(struct bench *, const char *part, struct row);

// Dies where two ways to compute something differ: `what` says which.
void bench_check(bool same, const char *what, const char *name);

uint64_t bench_hash(const void *bytes, size_t n);

// ---- scenes ----
// By name (scenes.c), with its tree, loaded once; NULL: its folder is not there.
struct bench_scene {
  const char *name;
  struct scene scene;
  struct bvh *bvh;
  struct pixel *pixel; // all of the film
  int n_pixels;
};
const struct bench_scene *bench_scene(struct bench *, const char *name);

#endif
