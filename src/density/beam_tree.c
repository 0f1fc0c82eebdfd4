#include "density/beam_tree.h"

#include "scene/box.h"

#include <assert.h>
#include <stdlib.h>

enum {
  LEAF = 4,           // parts that are not halved further
  PARTS_PER_BEAM = 4, // on average, besides one each
};

// ---- parts ----

static uint32_t count_parts(const struct beam_tree *tree, const struct photon_beam *beam) {
  double parts = floor(beam->length / tree->part_length) + 1;
  assert(parts < UINT32_MAX);
  return (uint32_t)parts;
}

// Where part k of n begins, and part k - 1 ends: the same number.
static double part_begin(const struct photon_beam *beam, uint32_t k, uint32_t n) {
  return beam->length * ((double)k / n);
}

static void bound(const struct photon_beam *beam, uint32_t k, uint32_t n, struct beam_part *part) {
  struct vec a = vec_along(beam->o, beam->d, part_begin(beam, k, n));
  struct vec b = vec_along(beam->o, beam->d, part_begin(beam, k + 1, n));
  const double p[3] = {a.x, a.y, a.z}, q[3] = {b.x, b.y, b.z};
  for (int axis = 0; axis < 3; axis++) {
    part->lo[axis] = box_round_down(p[axis] < q[axis] ? p[axis] : q[axis]);
    part->hi[axis] = box_round_up(p[axis] < q[axis] ? q[axis] : p[axis]);
  }
}

static void list_parts(struct beam_tree *tree, const struct beams *beams) {
  tree->n_parts = 0;
  for (int64_t j = 0; j < beams->count; j++) {
    uint32_t n = count_parts(tree, &beams->beam[j]);
    for (uint32_t k = 0; k < n; k++) {
      struct beam_part *part = &tree->part[tree->n_parts++];
      bound(&beams->beam[j], k, n, part);
      part->beam = (uint32_t)j;
      part->part = k;
    }
  }
}

static void reserve(struct beam_tree *tree, const struct beams *beams, struct arena *arena) {
  double length = 0;
  int64_t parts = 0;
  for (int64_t j = 0; j < beams->count; j++) length += beams->beam[j].length;
  tree->part_length = length / (PARTS_PER_BEAM * (double)beams->count);
  for (int64_t j = 0; j < beams->count; j++) parts += count_parts(tree, &beams->beam[j]);
  assert(parts < UINT32_MAX);
  if (parts > tree->parts_capacity) {
    tree->parts_capacity = 2 * parts;
    tree->part = arena_new(arena, struct beam_part, tree->parts_capacity);
  }
  if (parts > tree->nodes_capacity) { // more than halves of at least LEAF / 2 + 1 parts can be
    tree->nodes_capacity = 2 * parts;
    tree->node = arena_new(arena, struct beam_node, tree->nodes_capacity);
  }
}

// ---- halving ----

static float middle_of(const struct beam_part *part, int axis) {
  return part->lo[axis] + part->hi[axis];
}

static int widest(const struct beam_part *part, int64_t n) {
  int widest = 0;
  float most = -1;
  for (int axis = 0; axis < 3; axis++) {
    float lo = INFINITY, hi = -INFINITY;
    for (int64_t j = 0; j < n; j++) {
      float x = middle_of(&part[j], axis);
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    if (hi - lo > most) most = hi - lo, widest = axis;
  }
  return widest;
}

static void swap(struct beam_part *a, struct beam_part *b) {
  struct beam_part kept = *a;
  *a = *b;
  *b = kept;
}

// Brings the part of rank `at` to its place, smaller ones before it (Hoare's selection, which parts
// many equal ones evenly too).
static void select_rank(struct beam_part *part, int64_t n, int64_t at, int axis) {
  for (int64_t lo = 0, hi = n - 1; lo < hi;) {
    float pivot = middle_of(&part[lo + (hi - lo) / 2], axis);
    int64_t i = lo, j = hi;
    while (i <= j) {
      while (middle_of(&part[i], axis) < pivot) i++;
      while (pivot < middle_of(&part[j], axis)) j--;
      if (i <= j) swap(&part[i++], &part[j--]);
    }
    if (at <= j)
      hi = j;
    else if (at >= i)
      lo = i;
    else
      return;
  }
}

static void grow(struct beam_node *node, const float lo[3], const float hi[3]) {
  for (int axis = 0; axis < 3; axis++) {
    node->lo[axis] = node->lo[axis] < lo[axis] ? node->lo[axis] : lo[axis];
    node->hi[axis] = node->hi[axis] > hi[axis] ? node->hi[axis] : hi[axis];
  }
}

static uint32_t build(struct beam_tree *tree, struct beam_part *part, int64_t n) {
  uint32_t at = (uint32_t)tree->n_nodes++;
  struct beam_node node = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
  if (n <= LEAF) {
    for (int64_t j = 0; j < n; j++) grow(&node, part[j].lo, part[j].hi);
  } else {
    select_rank(part, n, n / 2, widest(part, n));
    build(tree, part, n / 2);
    node.right = build(tree, part + n / 2, n - n / 2);
    grow(&node, tree->node[at + 1].lo, tree->node[at + 1].hi);
    grow(&node, tree->node[node.right].lo, tree->node[node.right].hi);
  }
  tree->node[at] = node;
  return at;
}

void beam_tree_build(struct beam_tree *tree, const struct beams *beams, struct arena *arena) {
  tree->n_parts = tree->n_nodes = 0;
  if (beams->count == 0) return;
  reserve(tree, beams, arena);
  list_parts(tree, beams);
  build(tree, tree->part, tree->n_parts);
}

// ---- finding ----

struct query {
  const struct beam_tree *tree;
  const struct beams *beams;
  const struct eye_segment *eye;
  double inverse[3];           // of the eye's direction
  double before[3], behind[3]; // its origin, moved by what boxes are widened by
  double r2;
  uint32_t *found;
  int64_t n_found;
};

// What rounding may move a point of the ray or of a box by, in units of the largest coordinate: a
// few times 2^-53.
static double rounding(const struct beam_node *root, const double origin[3]) {
  double most = 0;
  for (int axis = 0; axis < 3; axis++) {
    double lo = fabs(root->lo[axis]), hi = fabs(root->hi[axis]), o = fabs(origin[axis]);
    double largest = lo < hi ? hi : lo;
    largest = largest < o ? o : largest;
    most = most < largest ? largest : most;
  }
  return most * 0x1p-44;
}

// Products of 0 and infinity are no numbers, and pass.
static bool passes(const struct query *query, const float lo[3], const float hi[3]) {
  double near = 0, far = query->eye->length;
  for (int axis = 0; axis < 3; axis++) {
    double a = (lo[axis] - query->behind[axis]) * query->inverse[axis];
    double b = (hi[axis] - query->before[axis]) * query->inverse[axis];
    double in = a < b ? a : b, out = a < b ? b : a;
    if (in > near) near = in;
    if (out < far) far = out;
  }
  return near <= far;
}

// What belongs to another part of the beam is found there.
static void meet(struct query *query, const struct beam_part *part) {
  const struct photon_beam *beam = &query->beams->beam[part->beam];
  struct crossing_point point;
  if (!passes(query, part->lo, part->hi)) return;
  if (!crossing_find(query->eye, beam, query->r2, &point)) return;
  uint32_t n = count_parts(query->tree, beam);
  if (point.s < part_begin(beam, part->part, n) || !(point.s < part_begin(beam, part->part + 1, n)))
    return;
  query->found[query->n_found++] = part->beam;
}

static void descend(struct query *query, uint32_t at, const struct beam_part *part, int64_t n) {
  const struct beam_node *node = &query->tree->node[at];
  if (!passes(query, node->lo, node->hi)) return;
  if (node->right) {
    descend(query, at + 1, part, n / 2);
    descend(query, node->right, part + n / 2, n - n / 2);
    return;
  }
  for (int64_t j = 0; j < n; j++) meet(query, &part[j]);
}

static int by_number(const void *a, const void *b) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

int64_t beam_tree_find(const struct beam_tree *tree, const struct beams *beams,
                       const struct eye_segment *eye, double r, uint32_t *found) {
  if (tree->n_nodes == 0) return 0;
  struct query query = {.tree = tree,
                        .beams = beams,
                        .eye = eye,
                        .inverse = {1 / eye->d.x, 1 / eye->d.y, 1 / eye->d.z},
                        .r2 = r * r,
                        .found = found};
  const double origin[3] = {eye->o.x, eye->o.y, eye->o.z};
  double reach = r + rounding(&tree->node[0], origin);
  for (int axis = 0; axis < 3; axis++) {
    query.before[axis] = origin[axis] - reach;
    query.behind[axis] = origin[axis] + reach;
  }
  descend(&query, 0, tree->part, tree->n_parts);
  qsort(found, (size_t)query.n_found, sizeof *found, by_number);
  return query.n_found;
}

int64_t beam_find_all(const struct beams *beams, const struct eye_segment *eye, double r,
                      uint32_t *found) {
  struct crossing_point point;
  int64_t n = 0;
  for (int64_t j = 0; j < beams->count; j++)
    if (crossing_find(eye, &beams->beam[j], r * r, &point)) found[n++] = (uint32_t)j;
  return n;
}
