#include "experiment/experiment.h"
#include "experiment/keys.h"
#include "numeric/rng.h"
#include "pbrt/suggest.h"

#include <string.h>

const struct experiment_key experiment_keys[] = {
    {"title", "(the file's name)", "one line for tables and figures", false, NULL},
    {"scene", "(required)", "pbrt-v4 file, from the working directory", true, key_read_scene},
    {"integrator", "probabilistic", "what one iteration computes", true, key_read_integrator},
    {"law", "(the integrator's)", "radius law; ppm, sppm: hachisuka, else knaus-zwicker", true,
     key_read_law},
    {"kernel", "box", "kernel", true, key_read_kernel},
    {"alpha", "2/3", "parameter of the law, in [0, 1]; a number or a ratio", true, key_read_alpha},
    {"reference-radius", "global", "what the radius counts in at each point", true,
     key_read_reference_radius},
    {"radius", "(required, or 1)", "support at i = 1, in reference radii (global: scene units)",
     true, key_read_radius},
    {"radius-volume", "(as radius)", "the same of points in participating media, scene units", true,
     key_read_radius_volume},
    {"k", "(50 for knn)", "nearest photons: of knn, or photonmap's estimate instead of a radius",
     true, key_read_k},
    {"photons", "65536", "emitted paths per iteration", true, key_read_photons},
    {"iterations", "1000", "N", true, key_read_iterations},
    {"runs", "32", "K, independent replications; with until: at most", true, key_read_runs},
    {"until", "(all runs are made)",
     "rate_se <= 0.004: no more runs once every rate is so well known", false, key_read_until},
    {"seed", "(the file's name)", "a number, or a name that is hashed", true, key_read_seed},
    {"direct", "photons", "direct light by photons or nee (next-event estimation)", true,
     key_read_direct},
    {"view", "all", "light paths seen: all, or a sum of emitted, direct, caustics, indirect", true,
     key_read_view},
    {"depth", "64", "pbrt's maxdepth", true, key_read_depth},
    {"pixel", "centre", "centre, or footprint: uniform in the pixel, new each iteration", true,
     key_read_pixel},
    {"hit-points", "1", "ppm: points of its one eye pass in each pixel", true, key_read_hit_points},
    {"probes", "(a fixed 3x3 grid)", "pixels [[x, y], ...] from the top left", false,
     key_read_probes},
    {"quantity", "(variance and bias)", "what is fitted: variance, bias, both or none", false,
     key_read_quantity},
    {"keep", "moments",
     "moments over runs, or runs: also each run's running averages, for fit --method bootstrap",
     false, key_read_keep},
    {"images", "(none)", "N at which the running average is kept as a moment image", false,
     key_read_images},
    {"single-images", "(none)", "i whose iteration alone is kept as a moment image", false,
     key_read_single_images},
    {"discs", "(none)", "i after which run 1's points and their own radii are kept (ppm, sppm)",
     false, key_read_discs},
    {"reference", "analytic",
     "bias against: analytic, none, richardson (the same photons at half the radius) or "
     "{integrator: path, se: 0.001}; se: 3% is of the smallest bias to be fitted; a closed form, "
     "where "
     "there is one, comes before none and path",
     false, key_read_reference},
    {"parts", "(one)", "list of mappings, each an experiment that inherits the keys above it",
     false, NULL},
    {"paper", "(nothing)", "mapping of the keys that quality paper replaces, also in a part", false,
     NULL},
};
enum { N_KEYS = sizeof experiment_keys / sizeof *experiment_keys };
const int n_experiment_keys = N_KEYS;

enum { MAX_CELLS = 100000 }; // of one experiment; more is a slip, and said

// The values in force at one level of the file, by key; NULL: the default.
struct level {
  const struct node *value[N_KEYS];
  struct place place; // of the mapping
};

struct reader {
  struct reading reading;
  struct experiment *experiment;
  bool paper;
};

static int key_number(const char *name) {
  int k = 0;
  while (k < N_KEYS && strcmp(experiment_keys[k].name, name) != 0) k++;
  return k;
}

static bool complain_unknown(struct reader *reader, const struct node *key) {
  const char *names[N_KEYS];
  for (int k = 0; k < N_KEYS; k++) names[k] = experiment_keys[k].name;
  const char *meant = suggest_name(key->text, names, N_KEYS);
  const char *shown = node_show(key, reader->reading.arena);
  if (meant)
    return problem_at(reader->reading.problem, key->place,
                      "unknown key \"%s\"; did you mean \"%s\"?", shown, meant);
  return problem_at(reader->reading.problem, key->place,
                    "unknown key \"%s\" (`photonlab list experiment` lists the keys)", shown);
}

// Every value is checked where it stands, also one that this quality or a part replaces.
static bool check_value(struct reader *reader, int k, const struct node *value) {
  const struct experiment_key *key = &experiment_keys[k];
  struct cell unused = {0};
  reader->reading.key = key->name;
  if (!key->read) return true;
  if (value->kind == NODE_LIST && value->count == 0)
    return problem_at(reader->reading.problem, value->place, "%s: an empty list", key->name);
  if (!key->crosses || value->kind != NODE_LIST) return key->read(&reader->reading, value, &unused);
  for (int j = 0; j < value->count; j++)
    if (!key->read(&reader->reading, value->item[j], &unused)) return false;
  return true;
}

// Puts a mapping's values over those of the level. `structural`: which of title, parts and paper
// may stand in it, as one string.
static bool lay_over(struct reader *reader, const struct node *mapping, const char *structural,
                     const char *where, struct level *level) {
  if (mapping->kind != NODE_MAPPING)
    return problem_at(reader->reading.problem, mapping->place,
                      "%s: keys and values expected, not %s", where,
                      node_show(mapping, reader->reading.arena));
  for (int j = 0; j < mapping->count; j++) {
    const struct node *key = mapping->key[j];
    int k = key_number(key->text);
    if (k == N_KEYS) return complain_unknown(reader, key);
    if (!experiment_keys[k].read && !strstr(structural, key->text))
      return problem_at(reader->reading.problem, key->place, "%s cannot stand in %s", key->text,
                        where);
    if (!check_value(reader, k, mapping->item[j])) return false;
    level->value[k] = mapping->item[j];
  }
  return true;
}

// A mapping and then its `paper`, which is checked in any case.
static bool read_level(struct reader *reader, const struct node *mapping, const char *structural,
                       const char *where, struct level *level) {
  int paper = key_number("paper");
  level->place = mapping->place;
  level->value[paper] = NULL;
  if (!lay_over(reader, mapping, structural, where, level)) return false;
  if (!level->value[paper]) return true;
  struct level replaced = *level;
  if (!lay_over(reader, level->value[paper], "", "paper", &replaced)) return false;
  if (reader->paper) *level = replaced;
  return true;
}

// ---- crossing ----

static bool is_crossed(const struct level *level, int k) {
  return experiment_keys[k].crosses && level->value[k] && level->value[k]->kind == NODE_LIST;
}

// The node of key k in combination `number`; NULL: nothing to read.
static const struct node *pick(const struct level *level, int k, const int *choice,
                               struct node *fallback) {
  if (is_crossed(level, k)) return level->value[k]->item[choice[k]];
  if (level->value[k]) return level->value[k];
  if (experiment_keys[k].fallback[0] == '(') return NULL;
  *fallback = (struct node){.kind = NODE_SCALAR, .text = experiment_keys[k].fallback};
  return fallback;
}

enum { DEFAULT_K = 50 };

// Of an integrator that stores photons.
static const char *settle_radius(struct cell *cell) {
  bool nearest = cell->reference_radius->nearest;
  if (!cell->reference_radius->global && !cell->integrator->takes_reference)
    return "reference-radius: this integrator knows only global";
  if (cell->k > 0 && !nearest && !cell->integrator->takes_k)
    return "k: belongs to reference-radius knn or to integrator photonmap";
  if (nearest && cell->k == 0) cell->k = DEFAULT_K;
  if (!nearest && cell->k == 1) return "k: the first of one nearest photon is none, at least 2";
  if (!nearest && cell->k > 0)
    return cell->radius > 0 ? "k and radius: an estimate takes one of them" : NULL;
  if (!cell->reference_radius->global && !(cell->radius > 0)) cell->radius = 1;
  if (!(cell->radius > 0))
    return "radius is missing (the kernel's support at i = 1, in scene units)";
  return NULL;
}

const char *cell_settle(struct cell *cell) {
  if (cell->integrator->fixed && strcmp(cell->law->name, "fixed") != 0)
    return "law: all iterations of this integrator have the same radius, take fixed or none";
  if (cell->integrator->only_photons && cell->direct == DIRECT_NEE)
    return "direct: this integrator has no next-event estimation, take photons";
  return cell->integrator->photons ? settle_radius(cell) : NULL;
}

// An ascending list of iterations.
static bool check_list(struct reader *reader, const struct level *level, const char *key,
                       const uint64_t *list, int n, const struct cell *cell) {
  return n == 0 || list[n - 1] <= cell->iterations ||
         problem_at(reader->reading.problem, level->value[key_number(key)]->place,
                    "%s: %llu is beyond the %llu iterations", key, (unsigned long long)list[n - 1],
                    (unsigned long long)cell->iterations);
}

static bool check_richardson(struct reader *reader, const struct level *level,
                             const struct cell *cell) {
  bool asked = cell_has_companion(cell) || cell->reference_share > 0;
  if (!asked || cell_can_have_companion(cell)) return true;
  return problem_at(reader->reading.problem, level->value[key_number("reference")]->place,
                    "reference: %s needs photons and radii that no photon changes (%s, "
                    "law %s%s)",
                    cell_has_companion(cell) ? "richardson" : "a share of the bias",
                    cell->integrator->name, cell->law->name, cell->k ? ", k" : "");
}

static bool check_cell(struct reader *reader, const struct level *level, struct cell *cell) {
  struct problem *problem = reader->reading.problem;
  if (!cell->scene_path) return problem_at(problem, level->place, "scene is missing");
  const char *wrong = cell_settle(cell);
  if (wrong) return problem_at(problem, level->place, "%s", wrong);
  if (cell->n_discs && !cell->integrator->local)
    return problem_at(problem, level->value[key_number("discs")]->place,
                      "discs: the points of integrator %s have no radii of their own",
                      cell->integrator->name);
  return check_richardson(reader, level, cell) &&
         check_list(reader, level, "images", cell->image, cell->n_images, cell) &&
         check_list(reader, level, "single-images", cell->single, cell->n_singles, cell) &&
         check_list(reader, level, "discs", cell->discs, cell->n_discs, cell);
}

// Outputs name a scene by its base name, so it must not name two.
static bool check_scene_names(struct reader *reader, const struct level *level,
                              const struct cell *cell) {
  const struct experiment *experiment = reader->experiment;
  for (int c = 0; c < experiment->n_cells; c++) {
    const struct cell *other = &experiment->cell[c];
    if (strcmp(other->scene_path, cell->scene_path) == 0) return true;
    if (strcmp(other->scene, cell->scene) == 0)
      return problem_at(reader->reading.problem, level->value[key_number("scene")]->place,
                        "scene: %s and %s have the same name, results could not tell them apart",
                        other->scene_path, cell->scene_path);
  }
  return true;
}

const struct law *cell_default_law(const struct cell *cell) {
  const char *name = cell->integrator->law;
  return law_find(name ? name : "knaus-zwicker");
}

static bool add_cell(struct reader *reader, const struct level *level, const int *choice) {
  struct experiment *experiment = reader->experiment;
  struct cell cell = {.number = experiment->n_cells,
                      .part = experiment->n_parts - 1,
                      .seed = rng_hash_name(experiment->name),
                      .quantities = QUANTITY_VARIANCE | QUANTITY_BIAS};
  for (int k = 0; k < N_KEYS; k++) {
    struct node fallback;
    const struct node *node = pick(level, k, choice, &fallback);
    reader->reading.key = experiment_keys[k].name;
    if (experiment_keys[k].read && node && !experiment_keys[k].read(&reader->reading, node, &cell))
      return false;
  }
  if (!cell.law) cell.law = cell_default_law(&cell);
  if (!check_cell(reader, level, &cell) || !check_scene_names(reader, level, &cell)) return false;
  experiment->cell[experiment->n_cells++] = cell;
  return true;
}

static void grow_cells(struct reader *reader, ptrdiff_t n) {
  struct experiment *experiment = reader->experiment;
  experiment->cell = arena_grow(reader->reading.arena, experiment->cell, experiment->n_cells,
                                experiment->n_cells + n, (ptrdiff_t)sizeof *experiment->cell,
                                (ptrdiff_t)alignof(struct cell));
}

// The lists of a level crossed, the last key of the table fastest.
static bool cross(struct reader *reader, const struct level *level) {
  int choice[N_KEYS] = {0};
  long n = 1;
  for (int k = 0; k < N_KEYS && n <= MAX_CELLS; k++)
    if (is_crossed(level, k)) n *= level->value[k]->count;
  if (n + reader->experiment->n_cells > MAX_CELLS)
    return problem_at(reader->reading.problem, level->place,
                      "the lists cross to more than %d cells", MAX_CELLS);
  reader->experiment->n_parts++;
  grow_cells(reader, n);
  for (long j = 0; j < n; j++) {
    if (!add_cell(reader, level, choice)) return false;
    for (int k = N_KEYS - 1; k >= 0; k--) {
      if (!is_crossed(level, k)) continue;
      if (++choice[k] < level->value[k]->count) break;
      choice[k] = 0;
    }
  }
  return true;
}

// ---- the file ----

static bool read_parts(struct reader *reader, const struct level *top, const struct node *parts) {
  if (parts->kind != NODE_LIST || parts->count == 0)
    return problem_at(reader->reading.problem, parts->place,
                      "parts: a list of mappings is expected");
  for (int p = 0; p < parts->count; p++) {
    struct level level = *top;
    if (!read_level(reader, parts->item[p], "paper", "a part", &level) || !cross(reader, &level))
      return false;
  }
  return true;
}

static bool read_title(struct reader *reader, const struct level *top) {
  const struct node *title = top->value[key_number("title")];
  struct experiment *experiment = reader->experiment;
  reader->reading.key = "title";
  experiment->title = title ? value_text(&reader->reading, title, "a text") : experiment->name;
  return experiment->title != NULL;
}

static bool read_root(struct reader *reader, const struct node *root) {
  struct level top = {0};
  if (!read_level(reader, root, "title parts paper", "an experiment", &top)) return false;
  const struct node *parts = top.value[key_number("parts")];
  if (!read_title(reader, &top)) return false;
  return parts ? read_parts(reader, &top, parts) : cross(reader, &top);
}

bool experiment_read(const char *path, const char *quality, struct arena *arena,
                     struct experiment *experiment, struct problem *problem) {
  bool paper = strcmp(quality, "paper") == 0;
  if (!paper && strcmp(quality, "default") != 0)
    return problem_set(problem, "unknown quality \"%s\" (known: default, paper)", quality);
  struct text text;
  if (!file_read(path, arena, &text, problem)) return false;
  const char *name = file_base_name(path, arena);
  *experiment = (struct experiment){
      .path = path, .name = name, .quality = quality, .text = {text.data, text.length}};
  struct reader reader = {{arena, problem, NULL}, experiment, paper};
  struct node *root;
  return tree_read(text, path, arena, &root, problem) && read_root(&reader, root);
}
