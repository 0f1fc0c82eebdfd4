#include "experiment/keys.h"
#include "numeric/rng.h"
#include "scene/scene.h"
#include "walk/light_path.h"

#include <limits.h>
#include <string.h>

// The counter of the random numbers gives iterations and paths 48 bits each (numeric/rng.h).
static const uint64_t most_counted = (UINT64_C(1) << 48) - 1;
// Runs are counted in doubles by the moments.
static const uint64_t most_runs = 1000000000000000;

bool key_read_scene(struct reading *reading, const struct node *node, struct cell *cell) {
  cell->scene_path = value_text(reading, node, "a file");
  if (!cell->scene_path) return false;
  cell->scene = file_base_name(cell->scene_path, reading->arena);
  return file_exists(cell->scene_path) ||
         value_complain(reading, node, "does not exist (paths start at the working directory)");
}

// ---- rows of tables: the names are the tables' own ----

bool key_read_integrator(struct reading *reading, const struct node *node, struct cell *cell) {
  int n = 0, choice;
  while (integrator_types[n]) n++;
  const char **names = arena_new(reading->arena, const char *, n);
  for (int j = 0; j < n; j++) names[j] = integrator_types[j]->name;
  if (!value_choice(reading, node, names, n, &choice)) return false;
  cell->integrator = integrator_types[choice];
  return true;
}

bool key_read_kernel(struct reading *reading, const struct node *node, struct cell *cell) {
  int choice;
  const char **names = arena_new(reading->arena, const char *, n_kernels);
  for (int j = 0; j < n_kernels; j++) names[j] = kernels[j].name;
  if (!value_choice(reading, node, names, n_kernels, &choice)) return false;
  cell->kernel = &kernels[choice];
  return true;
}

bool key_read_law(struct reading *reading, const struct node *node, struct cell *cell) {
  int choice;
  const char **names = arena_new(reading->arena, const char *, n_laws);
  for (int j = 0; j < n_laws; j++) names[j] = laws[j].name;
  if (!value_choice(reading, node, names, n_laws, &choice)) return false;
  cell->law = &laws[choice];
  return true;
}

bool key_read_reference_radius(struct reading *reading, const struct node *node,
                               struct cell *cell) {
  int choice;
  const char **names = arena_new(reading->arena, const char *, n_reference_radii);
  for (int j = 0; j < n_reference_radii; j++) names[j] = reference_radii[j].name;
  if (!value_choice(reading, node, names, n_reference_radii, &choice)) return false;
  cell->reference_radius = &reference_radii[choice];
  return true;
}

// ---- numbers ----

bool key_read_alpha(struct reading *reading, const struct node *node, struct cell *cell) {
  if (!value_number(reading, node, &cell->alpha)) return false;
  return (cell->alpha >= 0 && cell->alpha <= 1) ||
         value_complain(reading, node, "is outside [0, 1]");
}

bool key_read_radius(struct reading *reading, const struct node *node, struct cell *cell) {
  if (!value_number(reading, node, &cell->radius)) return false;
  return cell->radius > 0 || value_complain(reading, node, "is not positive");
}

bool key_read_radius_volume(struct reading *reading, const struct node *node, struct cell *cell) {
  if (!value_number(reading, node, &cell->radius_volume)) return false;
  return cell->radius_volume > 0 || value_complain(reading, node, "is not positive");
}

bool key_read_k(struct reading *reading, const struct node *node, struct cell *cell) {
  uint64_t k;
  if (!value_count(reading, node, 1, INT_MAX, &k)) return false;
  cell->k = (int)k;
  return true;
}

bool key_read_photons(struct reading *reading, const struct node *node, struct cell *cell) {
  return value_count(reading, node, 1, most_counted, &cell->photons);
}

bool key_read_iterations(struct reading *reading, const struct node *node, struct cell *cell) {
  return value_count(reading, node, 1, most_counted, &cell->iterations);
}

bool key_read_runs(struct reading *reading, const struct node *node, struct cell *cell) {
  return value_count(reading, node, 1, most_runs, &cell->runs);
}

// "rate_se <= 0.004".
bool key_read_until(struct reading *reading, const struct node *node, struct cell *cell) {
  static const char condition[] = "rate_se <=";
  const char *text = value_text(reading, node, "a condition as \"rate_se <= 0.004\"");
  if (!text) return false;
  if (strncmp(text, condition, sizeof condition - 1) != 0)
    return value_complain(reading, node, "is not a condition as \"rate_se <= 0.004\"");
  struct node number = *node;
  number.text = text + sizeof condition - 1 + strspn(text + sizeof condition - 1, " ");
  if (!value_number(reading, &number, &cell->until_se)) return false;
  return cell->until_se > 0 || value_complain(reading, node, "is never reached");
}

bool key_read_hit_points(struct reading *reading, const struct node *node, struct cell *cell) {
  return value_count(reading, node, 1, INT_MAX, &cell->hit_points);
}

bool key_read_depth(struct reading *reading, const struct node *node, struct cell *cell) {
  uint64_t depth;
  if (!value_count(reading, node, 0, INT_MAX, &depth)) return false;
  cell->depth = (int)depth;
  return true;
}

// What begins like a number is one; anything else is a name.
bool key_read_seed(struct reading *reading, const struct node *node, struct cell *cell) {
  const char *text = value_text(reading, node, "a number or a name");
  if (!text) return false;
  if (strchr("+-.0123456789", text[0]))
    return value_count(reading, node, 0, UINT64_MAX, &cell->seed);
  cell->seed = rng_hash_name(text);
  return true;
}

// ---- choices ----

bool key_read_direct(struct reading *reading, const struct node *node, struct cell *cell) {
  static const char *const names[] = {[DIRECT_PHOTONS] = "photons", [DIRECT_NEE] = "nee"};
  int choice;
  if (!value_choice(reading, node, names, 2, &choice)) return false;
  cell->direct = (enum direct)choice;
  return true;
}

static bool complain_view(struct reading *reading, const struct node *node) {
  return value_complain(
      reading, node, "is neither \"all\" nor a sum as \"direct+caustics\" (known: %s, %s, %s, %s)",
      light_paths[0].name, light_paths[1].name, light_paths[2].name, light_paths[3].name);
}

// "all", or names with + between them; no name twice.
bool key_read_view(struct reading *reading, const struct node *node, struct cell *cell) {
  const char *at = value_text(reading, node, "light paths to be seen");
  if (!at) return false;
  cell->left_out = 0;
  if (strcmp(at, "all") == 0) return true;
  cell->left_out = LIGHT_PATH_ALL;
  for (;; at++) {
    size_t length = strcspn(at, "+");
    int k = 0;
    while (k < LIGHT_PATHS &&
           (strlen(light_paths[k].name) != length || memcmp(at, light_paths[k].name, length) != 0))
      k++;
    if (k == LIGHT_PATHS) return complain_view(reading, node);
    if (!(cell->left_out & light_paths[k].bit))
      return value_complain(reading, node, "names %s twice", light_paths[k].name);
    cell->left_out &= ~(unsigned)light_paths[k].bit;
    at += length;
    if (!*at) return true;
  }
}

bool key_read_pixel(struct reading *reading, const struct node *node, struct cell *cell) {
  static const char *const names[] = {"centre", "footprint"};
  int choice;
  if (!value_choice(reading, node, names, 2, &choice)) return false;
  cell->footprint = choice == 1;
  return true;
}

bool key_read_keep(struct reading *reading, const struct node *node, struct cell *cell) {
  static const char *const names[] = {"moments", "runs"};
  int choice;
  if (!value_choice(reading, node, names, 2, &choice)) return false;
  cell->keeps_runs = choice == 1;
  return true;
}

// ---- lists that do not cross ----

// A single value stands for a list of one.
static int list_count(const struct node *node) { return node->kind == NODE_LIST ? node->count : 1; }

static const struct node *list_item(const struct node *node, int j) {
  return node->kind == NODE_LIST ? node->item[j] : node;
}

bool key_read_quantity(struct reading *reading, const struct node *node, struct cell *cell) {
  static const char *const names[] = {"variance", "bias", "none"};
  static const unsigned bits[] = {QUANTITY_VARIANCE, QUANTITY_BIAS, 0};
  cell->quantities = 0;
  for (int j = 0; j < list_count(node); j++) {
    int choice;
    if (!value_choice(reading, list_item(node, j), names, 3, &choice)) return false;
    if (!bits[choice] && list_count(node) > 1)
      return value_complain(reading, list_item(node, j), "stands alone");
    if (cell->quantities & bits[choice])
      return value_complain(reading, list_item(node, j), "is listed twice");
    cell->quantities |= bits[choice];
  }
  return true;
}

static bool read_ascending(struct reading *reading, const struct node *node, uint64_t **list,
                           int *n) {
  uint64_t *value = arena_new(reading->arena, uint64_t, list_count(node));
  for (int j = 0; j < list_count(node); j++) {
    const struct node *item = list_item(node, j);
    if (!value_count(reading, item, 1, most_counted, &value[j])) return false;
    if (j > 0 && value[j] <= value[j - 1]) return value_complain(reading, item, "does not ascend");
  }
  *list = value;
  *n = list_count(node);
  return true;
}

bool key_read_images(struct reading *reading, const struct node *node, struct cell *cell) {
  return read_ascending(reading, node, &cell->image, &cell->n_images);
}

bool key_read_single_images(struct reading *reading, const struct node *node, struct cell *cell) {
  return read_ascending(reading, node, &cell->single, &cell->n_singles);
}

bool key_read_discs(struct reading *reading, const struct node *node, struct cell *cell) {
  return read_ascending(reading, node, &cell->discs, &cell->n_discs);
}

static bool read_pixel(struct reading *reading, const struct node *node, struct pixel *pixel) {
  uint64_t x, y;
  if (node->kind != NODE_LIST || node->count != 2)
    return value_complain(reading, node, "where a pixel [x, y] is expected");
  if (!value_count(reading, node->item[0], 0, INT_MAX, &x) ||
      !value_count(reading, node->item[1], 0, INT_MAX, &y))
    return false;
  *pixel = (struct pixel){(int)x, (int)y};
  return true;
}

bool key_read_probes(struct reading *reading, const struct node *node, struct cell *cell) {
  if (node->kind != NODE_LIST)
    return value_complain(reading, node, "where pixels [[x, y], ...] are expected");
  cell->n_probes = node->count;
  cell->probe = arena_new(reading->arena, struct pixel, node->count);
  for (int j = 0; j < node->count; j++) {
    struct pixel *probe = &cell->probe[j];
    if (!read_pixel(reading, node->item[j], probe)) return false;
    for (int k = 0; k < j; k++)
      if (cell->probe[k].x == probe->x && cell->probe[k].y == probe->y)
        return problem_at(reading->problem, node->item[j]->place, "%s: [%d, %d] is listed twice",
                          reading->key, probe->x, probe->y);
  }
  return true;
}

// ---- the reference ----

static bool read_reference_name(struct reading *reading, const struct node *node,
                                struct cell *cell) {
  static const char *const names[] = {"analytic", "path", "richardson", "none"};
  int choice;
  if (!value_choice(reading, node, names, 4, &choice)) return false;
  cell->reference_integrator = names[choice];
  return true;
}

// A radiance, or "3%" of the smallest bias to be fitted.
static bool read_reference_se(struct reading *reading, const struct node *node, struct cell *cell) {
  const char *text = value_text(reading, node, "a standard error");
  if (!text) return false;
  size_t length = strlen(text);
  bool share = length > 0 && text[length - 1] == '%';
  struct node number = *node;
  if (share) number.text = arena_string(reading->arena, text, (ptrdiff_t)length - 1);
  double value;
  if (!value_number(reading, &number, &value)) return false;
  *(share ? &cell->reference_share : &cell->reference_se) = share ? value / 100 : value;
  return value > 0 || value_complain(reading, node, "is not positive");
}

static bool read_reference_mapping(struct reading *reading, const struct node *node,
                                   struct cell *cell) {
  static const char *const names[] = {"integrator", "se"};
  for (int j = 0; j < node->count; j++) {
    int choice;
    struct reading inner = *reading;
    if (!value_choice(&inner, node->key[j], names, 2, &choice)) return false;
    inner.key = choice == 0 ? "reference integrator" : "reference se";
    if (choice == 0 ? !read_reference_name(&inner, node->item[j], cell)
                    : !read_reference_se(&inner, node->item[j], cell))
      return false;
  }
  return true;
}

// `analytic`, `richardson`, `none`, or {integrator: path, se: 0.001}.
bool key_read_reference(struct reading *reading, const struct node *node, struct cell *cell) {
  cell->reference_integrator = "analytic";
  cell->reference_se = cell->reference_share = 0;
  if (node->kind == NODE_MAPPING ? !read_reference_mapping(reading, node, cell)
                                 : !read_reference_name(reading, node, cell))
    return false;
  bool traced = strcmp(cell->reference_integrator, "path") == 0;
  bool precise = cell->reference_se > 0 || cell->reference_share > 0;
  if (traced && !precise)
    return problem_at(
        reading->problem, node->place,
        "reference: path needs a standard error to reach, {integrator: path, se: ...}");
  if (!traced && precise)
    return problem_at(reading->problem, node->place, "reference: se belongs to integrator path");
  return true;
}
