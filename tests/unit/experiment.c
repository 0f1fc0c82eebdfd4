// Experiment files: every bad file gives one line with its place; good ones give the cells they
// say.
#define _GNU_SOURCE // mkdtemp
#include "experiment/experiment.h"
#include "base/file.h"
#include "experiment/cell_keys.h"
#include "numeric/rng.h"
#include "walk/light_path.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-experiment-XXXXXX";
static const char *mine; // a file in it

#define SCENE "tests/data/experiments/scene.pbrt"
#define ANOTHER "tests/data/experiments/another.pbrt"
static const char base[] = "scene: " SCENE "\nradius: 0.25\n";

static struct experiment read_file(const char *path, const char *quality) {
  struct problem problem = {0};
  struct experiment experiment;
  if (!experiment_read(path, quality, &arena, &experiment, &problem)) fail_msg("%s", problem.text);
  return experiment;
}

static const char *write_text(const char *text) {
  FILE *stream = fopen(mine, "wb");
  assert_non_null(stream);
  fputs(text, stream);
  fclose(stream);
  return mine;
}

// The base, and what a test adds to it.
static struct experiment read_text(const char *text) {
  return read_file(write_text(arena_format(&arena, "%s%s", base, text)), "default");
}

// ---- bad files ----

// The file's first line: "# LINE:COLUMN: how the problem begins".
static const char *expected_problem(const char *path) {
  struct problem problem = {0};
  struct text text;
  if (!file_read(path, &arena, &text, &problem)) fail_msg("%s", problem.text);
  assert_memory_equal(text.data, "# ", 2);
  int length = (int)strcspn(text.data + 2, "\n");
  return arena_format(&arena, "%s:%.*s", path, length, text.data + 2);
}

static void every_bad_file_gives_the_line_its_first_line_expects(void **state) {
  (void)state;
  static const char bad[] = "tests/data/experiments/bad";
  DIR *dir = opendir(bad);
  assert_non_null(dir);
  int n = 0;
  for (struct dirent *entry; (entry = readdir(dir));) {
    if (entry->d_name[0] == '.') continue;
    const char *path = arena_format(&arena, "%s/%s", bad, entry->d_name);
    const char *expected = expected_problem(path);
    struct problem problem = {0};
    struct experiment experiment;
    assert_false(experiment_read(path, "default", &arena, &experiment, &problem));
    if (strncmp(problem.text, expected, strlen(expected)) != 0)
      fail_msg("\nexpected %s\ngot      %s", expected, problem.text);
    assert_null(strchr(problem.text, '\n'));
    n++;
  }
  closedir(dir);
  assert_true(n >= 100);
}

static void a_missing_file_or_an_unknown_quality_is_a_problem(void **state) {
  (void)state;
  struct experiment experiment;
  struct problem problem = {0};
  assert_false(experiment_read("no-such.yaml", "default", &arena, &experiment, &problem));
  assert_memory_equal(problem.text, "no-such.yaml: ", 14);
  problem = (struct problem){0};
  assert_false(experiment_read(write_text(base), "papr", &arena, &experiment, &problem));
  assert_string_equal(problem.text, "unknown quality \"papr\" (known: default, paper)");
}

// Flipped bytes: any answer but a crash, and every refusal is one line.
static void flipped_bytes_never_crash_the_reader(void **state) {
  (void)state;
  struct rng_key key = rng_key(rng_hash_name("flipped experiment"), 1, RNG_TEST);
  struct problem unused = {0};
  struct text text;
  file_read("tests/data/experiments/parts.yaml", &arena, &text, &unused);
  int refused = 0;
  for (uint32_t trial = 0; trial < 1500; trial++) {
    uint32_t counter[4] = {trial, 0, 0, 0}, word[4];
    rng_philox(key, counter, word);
    struct arena scratch = arena;
    char *copy = arena_string(&scratch, text.data, text.length);
    copy[word[0] % (uint32_t)text.length] = (char)(word[1] % 127 + 1);
    struct problem problem = {0};
    struct experiment experiment;
    bool ok = experiment_read(write_text(copy), "paper", &scratch, &experiment, &problem);
    assert_true(ok == !problem.text[0] && !strchr(problem.text, '\n'));
    refused += !ok;
  }
  assert_true(refused > 300 && refused < 1500);
}

// ---- defaults and values ----

static void a_minimal_file_takes_every_default_of_the_table(void **state) {
  (void)state;
  struct experiment experiment = read_text("");
  assert_int_equal(experiment.n_cells, 1);
  assert_int_equal(experiment.n_parts, 1);
  assert_string_equal(experiment.name, "mine");
  assert_string_equal(experiment.title, "mine");
  assert_int_equal(experiment.text.length, strlen(base));
  const struct cell *cell = &experiment.cell[0];
  assert_string_equal(cell->scene_path, SCENE);
  assert_string_equal(cell->scene, "scene");
  assert_string_equal(cell->integrator->name, "probabilistic");
  assert_string_equal(cell->kernel->name, "box");
  assert_string_equal(cell->law->name, "knaus-zwicker");
  assert_true(cell->alpha == 2.0 / 3 && cell->radius == 0.25);
  assert_true(cell->photons == 65536 && cell->iterations == 1000 && cell->runs == 32);
  assert_true(cell->seed == rng_hash_name("mine"));
  assert_true(!cell->probe && !cell->n_probes && !cell->n_images && !cell->footprint);
  assert_false(cell->keeps_runs);
  assert_true(cell->direct == DIRECT_PHOTONS && cell->depth == 64);
  assert_int_equal(cell->quantities, QUANTITY_VARIANCE | QUANTITY_BIAS);
  assert_string_equal(cell->reference_integrator, "analytic");
  assert_true(cell->reference_se == 0);
}

static void every_key_reaches_its_field(void **state) {
  (void)state;
  const struct cell *cell =
      read_text("integrator: path\nlaw: knaus-zwicker\nkernel: box\nalpha: 2.385e-1\nphotons: 7\n"
                "iterations: 11\nruns: 13\nseed: alpha\ndirect: nee\ndepth: 3\npixel: footprint\n"
                "probes: [[1, 2], [30, 4]]\nquantity: [variance]\nimages: [5, 11]\n"
                "single-images: [3, 7]\nkeep: runs\nradius-volume: 0.3\n"
                "reference: {se: 1/8, integrator: path}\n")
          .cell;
  assert_string_equal(cell->integrator->name, "path");
  assert_true(cell->alpha == 0.2385);
  assert_true(cell->photons == 7 && cell->iterations == 11 && cell->runs == 13);
  assert_true(cell->seed == rng_hash_name("alpha"));
  assert_true(cell->direct == DIRECT_NEE && cell->depth == 3 && cell->footprint);
  assert_int_equal(cell->n_probes, 2);
  assert_true(cell->probe[1].x == 30 && cell->probe[1].y == 4);
  assert_int_equal(cell->quantities, QUANTITY_VARIANCE);
  assert_true(cell->n_images == 2 && cell->image[0] == 5 && cell->image[1] == 11);
  assert_true(cell->n_singles == 2 && cell->single[0] == 3 && cell->single[1] == 7);
  assert_true(cell->keeps_runs && cell->radius_volume == 0.3);
  assert_string_equal(cell->reference_integrator, "path");
  assert_true(cell->reference_se == 0.125);
  assert_string_equal(read_text("reference: none\n").cell->reference_integrator, "none");
  assert_string_equal(read_text("title: A title\n").title, "A title");
}

static void counts_are_exact_and_powers_are_taken_where_whole(void **state) {
  (void)state;
  static const struct {
    const char *text;
    uint64_t value;
  } row[] = {
      {"1", 1},
      {"65536", 65536},
      {"1e6", 1000000},
      {"2.5e1", 25},
      {"1e15", 1000000000000000},
      {"999999999999999", 999999999999999},
      {"1000000000000000", 1000000000000000},
      {"+12", 12},
      {"007", 7},
      {"\"32\"", 32},
  };
  for (size_t j = 0; j < sizeof row / sizeof *row; j++)
    assert_true(read_text(arena_format(&arena, "runs: %s\n", row[j].text)).cell->runs ==
                row[j].value);
  // Digits that no double holds.
  assert_true(read_text("seed: 18446744073709551615\n").cell->seed == UINT64_MAX);
  assert_true(read_text("seed: 9007199254740993\n").cell->seed == 9007199254740993);
  assert_true(read_text("seed: 0\n").cell->seed == 0);
}

static void alpha_is_a_number_or_a_ratio_rounded_once(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double value;
  } row[] = {{"0", 0},    {"1", 1},     {"2/3", 2.0 / 3},   {"0.3", 0.3}, {"1e-300", 1e-300},
             {".5", 0.5}, {"1.", 1},    {"4/7", 4.0 / 7},   {"+.8", 0.8}, {"1e-1/2e-1", 0.5},
             {"-0", 0},   {"0/3", 0.0}, {"2.0/3.", 2.0 / 3}};
  for (size_t j = 0; j < sizeof row / sizeof *row; j++)
    assert_true(read_text(arena_format(&arena, "alpha: %s\n", row[j].text)).cell->alpha ==
                row[j].value);
}

// Whatever is registered can be asked for by its name.
static void every_registered_kernel_law_and_integrator_is_known(void **state) {
  (void)state;
  for (int j = 0; j < n_kernels; j++)
    assert_ptr_equal(read_text(arena_format(&arena, "kernel: %s\n", kernels[j].name)).cell->kernel,
                     &kernels[j]);
  for (int j = 0; j < n_laws; j++)
    assert_ptr_equal(read_text(arena_format(&arena, "law: %s\n", laws[j].name)).cell->law,
                     &laws[j]);
  for (int j = 0; integrator_types[j]; j++)
    assert_ptr_equal(read_text(arena_format(&arena, "integrator: %s\n", integrator_types[j]->name))
                         .cell->integrator,
                     integrator_types[j]);
}

static void a_radius_is_needed_only_where_photons_are_gathered(void **state) {
  (void)state;
  struct experiment experiment =
      read_file(write_text("scene: " SCENE "\nintegrator: path\n"), "default");
  assert_true(!experiment.cell->integrator->photons && experiment.cell->radius == 0);
}

// ---- crossing, parts, groups ----

static void lists_cross_in_the_order_of_the_table(void **state) {
  (void)state;
  // The order in the file is not the order of the table: scene, then alpha, then runs.
  struct experiment experiment =
      read_file(write_text("runs: [3, 5]\nalpha: [0.25, 1/2, 0.75]\nradius: 1\nscene: [" SCENE
                           ", " ANOTHER "]\n"),
                "default");
  assert_int_equal(experiment.n_cells, 2 * 3 * 2);
  for (int c = 0; c < experiment.n_cells; c++) {
    const struct cell *cell = &experiment.cell[c];
    assert_int_equal(cell->number, c);
    assert_int_equal(cell->part, 0);
    assert_string_equal(cell->scene, c / 6 == 0 ? "scene" : "another");
    assert_true(cell->alpha == 0.25 * (c / 2 % 3 + 1));
    assert_int_equal(cell->runs, c % 2 == 0 ? 3 : 5);
  }
}

static void every_key_that_crosses_takes_a_list(void **state) {
  (void)state;
  static const char *const row[][2] = {{"integrator", "[probabilistic, path]"},
                                       {"law", "[knaus-zwicker, knaus-zwicker]"},
                                       {"kernel", "[box, box]"},
                                       {"alpha", "[0.5, 0.6]"},
                                       {"reference-radius", "[global, ray-differentials]"},
                                       {"radius-volume", "[0.1, 0.2]"},
                                       {"k", "[2, 3]\nreference-radius: knn"},
                                       {"photons", "[1, 2]"},
                                       {"iterations", "[1, 2]"},
                                       {"runs", "[1, 2]"},
                                       {"seed", "[1, two]"},
                                       {"direct", "[photons, nee]"},
                                       {"view", "[direct, caustics+indirect]"},
                                       {"depth", "[1, 2]"},
                                       {"pixel", "[centre, footprint]"},
                                       {"hit-points", "[1, 2]"}};
  int n_crossing = 0;
  for (int k = 0; k < n_experiment_keys; k++) n_crossing += experiment_keys[k].crosses;
  int n_rows = sizeof row / sizeof *row;
  assert_int_equal(n_crossing, n_rows + 2); // scene and radius stand in the base
  for (int j = 0; j < n_rows; j++)
    assert_int_equal(read_text(arena_format(&arena, "%s: %s\n", row[j][0], row[j][1])).n_cells, 2);
}

// What a key says may follow from another.
static void radius_k_and_law_follow_from_each_other(void **state) {
  (void)state;
  static const struct {
    const char *text, *reference, *law;
    double radius;
    int k;
  } row[] = {
      {"radius: 0.25", "global", "knaus-zwicker", 0.25, 0},
      {"reference-radius: pixel", "pixel", "knaus-zwicker", 1, 0},
      {"reference-radius: ray-differentials\nradius: 3", "ray-differentials", "knaus-zwicker", 3,
       0},
      {"reference-radius: knn", "knn", "knaus-zwicker", 1, 50},
      {"reference-radius: knn\nk: 1\nradius: 0.5", "knn", "knaus-zwicker", 0.5, 1},
      {"integrator: photonmap\nradius: 0.5", "global", "fixed", 0.5, 0},
      {"integrator: photonmap\nk: 20\nlaw: fixed", "global", "fixed", 0, 20},
      {"integrator: path", "global", "knaus-zwicker", 0, 0},
  };
  for (size_t j = 0; j < sizeof row / sizeof *row; j++) {
    struct experiment experiment = read_file(
        write_text(arena_format(&arena, "scene: " SCENE "\n%s\n", row[j].text)), "default");
    const struct cell *cell = &experiment.cell[0];
    assert_string_equal(cell->reference_radius->name, row[j].reference);
    assert_string_equal(cell->law->name, row[j].law);
    assert_true(cell->radius == row[j].radius);
    assert_int_equal(cell->k, row[j].k);
  }
}

static void a_view_is_all_or_a_sum(void **state) {
  (void)state;
  static const struct {
    const char *text;
    unsigned left_out;
    const char *shown;
  } row[] = {
      {"all", 0, "all"},
      {"emitted+direct+caustics+indirect", 0, "all"},
      {"caustics", LIGHT_PATH_ALL - LIGHT_PATH_CAUSTICS, "caustics"},
      {"indirect+emitted", LIGHT_PATH_DIRECT | LIGHT_PATH_CAUSTICS, "emitted+indirect"},
      {"emitted+caustics+indirect", LIGHT_PATH_DIRECT, "emitted+caustics+indirect"},
  };
  for (size_t j = 0; j < sizeof row / sizeof *row; j++) {
    struct cell cell = read_text(arena_format(&arena, "view: %s\n", row[j].text)).cell[0];
    assert_int_equal(cell.left_out, row[j].left_out);
    for (int k = 0; k < CELL_KEYS; k++) {
      char buffer[CELL_KEY_SIZE];
      if (strcmp(cell_keys[k].name, "view") == 0)
        assert_string_equal(cell_keys[k].text(&cell, 17, buffer), row[j].shown);
    }
  }
}

struct expected_cell {
  int part;
  const char *scene;
  double alpha;
  int runs, photons;
};

static void assert_cells(const struct experiment *experiment, const struct expected_cell *row,
                         int n) {
  assert_int_equal(experiment->n_cells, n);
  for (int c = 0; c < n; c++) {
    const struct cell *cell = &experiment->cell[c];
    assert_int_equal(cell->number, c);
    assert_int_equal(cell->part, row[c].part);
    assert_string_equal(cell->scene, row[c].scene);
    assert_true(cell->alpha == row[c].alpha);
    assert_int_equal(cell->runs, row[c].runs);
    assert_int_equal(cell->photons, row[c].photons);
  }
}

static void parts_inherit_and_their_own_values_win(void **state) {
  (void)state;
  static const struct expected_cell row[] = {
      {0, "scene", 0.25, 10, 65536},   {0, "scene", 0.75, 10, 65536},
      {1, "scene", 0.5, 20, 65536},    {2, "another", 0.25, 10, 65536},
      {2, "another", 0.75, 10, 65536},
  };
  struct experiment experiment = read_file("tests/data/experiments/parts.yaml", "default");
  assert_string_equal(experiment.title, "Parts and papers");
  assert_string_equal(experiment.name, "parts");
  assert_int_equal(experiment.n_parts, 3);
  assert_cells(&experiment, row, 5);
  assert_int_equal(experiment.cell[2].n_images, 2);
  assert_int_equal(experiment.cell[2].quantities, QUANTITY_BIAS);
  assert_int_equal(experiment.cell[3].n_images, 0);
}

static void quality_paper_replaces_at_the_top_and_in_a_part(void **state) {
  (void)state;
  static const struct expected_cell row[] = {
      {0, "scene", 0.25, 1000, 1000000}, {0, "scene", 0.75, 1000, 1000000},
      {1, "scene", 0.5, 20, 1000000}, // its own runs win over the inherited paper
      {2, "scene", 0.1, 5000, 1000000},  {2, "scene", 0.2, 5000, 1000000},
      {2, "scene", 0.3, 5000, 1000000},
  };
  struct experiment experiment = read_file("tests/data/experiments/parts.yaml", "paper");
  assert_string_equal(experiment.quality, "paper");
  assert_cells(&experiment, row, 6);
}

static void assert_group(struct group group, const int *cell, int n) {
  assert_int_equal(group.n_cells, n);
  assert_memory_equal(group.cell, cell, (size_t)n * sizeof *cell);
}

static void cells_that_differ_only_in_the_estimator_share_a_photon_pass(void **state) {
  (void)state;
  int n;
  struct experiment experiment =
      read_file(write_text(arena_format(&arena,
                                        "scene: %s\nradius: [1, 2]\nalpha: [0.5, 0.6]\n"
                                        "runs: [3, 5]\nlaw: knaus-zwicker\n",
                                        SCENE)),
                "default");
  // Cells are (alpha, radius, runs), the last fastest.
  struct group *group = experiment_groups(&experiment, &arena, &n);
  assert_int_equal(n, 2);
  assert_group(group[0], (const int[]){0, 2, 4, 6}, 4);
  assert_group(group[1], (const int[]){1, 3, 5, 7}, 4);
}

static void every_key_that_changes_the_paths_splits_the_group(void **state) {
  (void)state;
  static const char *const row[] = {
      ("scene: " ANOTHER),     "photons: 7",       "depth: 3",
      "direct: nee",           "seed: other",      "runs: 7",
      "iterations: 7",         "probes: [[3, 4]]", "probes: [[1, 2], [3, 4]]",
      "until: rate_se <= 0.1", "images: [3]",      "single-images: 3",
      "pixel: footprint",      "integrator: path", "view: direct",
      "hit-points: 3",         "keep: runs",
  };
  static const char *const shared[] = {"quantity: bias", "reference: none", "alpha: 0.1",
                                       "radius: 3", "radius-volume: 3"};
  int n;
  for (size_t j = 0; j < sizeof row / sizeof *row; j++) {
    struct experiment experiment =
        read_text(arena_format(&arena, "probes: [[1, 2]]\nparts: [{alpha: 0.5}, {%s}]\n", row[j]));
    struct group *group = experiment_groups(&experiment, &arena, &n);
    assert_int_equal(n, 2);
    assert_group(group[1], (const int[]){1}, 1);
  }
  for (size_t j = 0; j < sizeof shared / sizeof *shared; j++) {
    struct experiment experiment =
        read_text(arena_format(&arena, "parts: [{alpha: 0.5}, {%s}]\n", shared[j]));
    experiment_groups(&experiment, &arena, &n);
    assert_int_equal(n, 1);
  }
}

// ---- the project's own files and the table ----

static void every_experiment_of_the_project_is_read_in_both_qualities(void **state) {
  (void)state;
  DIR *dir = opendir("experiments");
  assert_non_null(dir);
  int n = 0;
  for (struct dirent *entry; (entry = readdir(dir));) {
    if (!strstr(entry->d_name, ".yaml")) continue;
    const char *path = arena_format(&arena, "experiments/%s", entry->d_name);
    assert_true(read_file(path, "default").n_cells >= 1);
    assert_true(read_file(path, "paper").n_cells >= 1);
    n++;
  }
  closedir(dir);
  assert_true(n >= 1);
}

static void every_key_of_the_table_is_described(void **state) {
  (void)state;
  assert_int_equal(n_experiment_keys, 29);
  for (int k = 0; k < n_experiment_keys; k++) {
    const struct experiment_key *key = &experiment_keys[k];
    assert_true(key->name[0] && key->fallback[0] && key->meaning[0]);
    for (int j = 0; j < k; j++) assert_string_not_equal(key->name, experiment_keys[j].name);
  }
}

int main(void) {
  arena = arena_reserve();
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  mine = arena_format(&arena, "%s/mine.yaml", folder);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bad_file_gives_the_line_its_first_line_expects),
      cmocka_unit_test(a_missing_file_or_an_unknown_quality_is_a_problem),
      cmocka_unit_test(flipped_bytes_never_crash_the_reader),
      cmocka_unit_test(a_minimal_file_takes_every_default_of_the_table),
      cmocka_unit_test(every_key_reaches_its_field),
      cmocka_unit_test(counts_are_exact_and_powers_are_taken_where_whole),
      cmocka_unit_test(alpha_is_a_number_or_a_ratio_rounded_once),
      cmocka_unit_test(every_registered_kernel_law_and_integrator_is_known),
      cmocka_unit_test(a_radius_is_needed_only_where_photons_are_gathered),
      cmocka_unit_test(lists_cross_in_the_order_of_the_table),
      cmocka_unit_test(every_key_that_crosses_takes_a_list),
      cmocka_unit_test(radius_k_and_law_follow_from_each_other),
      cmocka_unit_test(a_view_is_all_or_a_sum),
      cmocka_unit_test(parts_inherit_and_their_own_values_win),
      cmocka_unit_test(quality_paper_replaces_at_the_top_and_in_a_part),
      cmocka_unit_test(cells_that_differ_only_in_the_estimator_share_a_photon_pass),
      cmocka_unit_test(every_key_that_changes_the_paths_splits_the_group),
      cmocka_unit_test(every_experiment_of_the_project_is_read_in_both_qualities),
      cmocka_unit_test(every_key_of_the_table_is_described),
  };
  int failed = cmocka_run_group_tests_name("experiment", tests, NULL, NULL);
  unlink(mine);
  rmdir(folder);
  return failed;
}
