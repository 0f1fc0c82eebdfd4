#include "mesh/level.h"

#include <string.h>

struct level level_new(uint32_t n_vertices, uint32_t n_triangles, struct arena *arena) {
  struct level level = {.n_vertices = n_vertices, .n_triangles = n_triangles};
  level.p = arena_new(arena, struct vec, n_vertices);
  level.start = arena_new(arena, uint32_t, n_vertices);
  level.boundary = arena_new(arena, bool, n_vertices);
  level.vertex = arena_alloc(arena, n_triangles, sizeof *level.vertex, alignof(uint32_t));
  level.across = arena_alloc(arena, n_triangles, sizeof *level.across, alignof(uint32_t));
  return level;
}

int level_corner(const struct level *level, uint32_t triangle, uint32_t vertex) {
  const uint32_t *v = level->vertex[triangle];
  return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
}

// ---- who lies across each edge ----
struct edge {
  uint32_t low, high, triangle;
  int k;
};

// Stable, by one end: counts, their running sum, then each edge to its place.
static void sort_edges(const struct edge *from, struct edge *to, int64_t n, bool by_low,
                       uint32_t n_vertices, struct arena scratch) {
  int64_t *place = arena_new(&scratch, int64_t, (ptrdiff_t)n_vertices + 1);
  for (int64_t i = 0; i < n; i++) place[(by_low ? from[i].low : from[i].high) + 1]++;
  for (uint32_t v = 0; v < n_vertices; v++) place[v + 1] += place[v];
  for (int64_t i = 0; i < n; i++) to[place[by_low ? from[i].low : from[i].high]++] = from[i];
}

static bool same_edge(const struct edge *a, const struct edge *b) {
  return a->low == b->low && a->high == b->high;
}

static bool connect(struct level *level, struct arena scratch, struct problem *problem) {
  int64_t n = 3 * (int64_t)level->n_triangles;
  struct edge *a = arena_new(&scratch, struct edge, n), *b = arena_new(&scratch, struct edge, n);
  for (int64_t i = 0; i < n; i++) {
    int k = (int)(i % 3);
    uint32_t t = (uint32_t)(i / 3), from = level->vertex[t][k],
             to = level->vertex[t][level_next(k)];
    if (from == to) return problem_set(problem, "triangle %u has vertex %u twice", t, from);
    a[i] = (struct edge){from < to ? from : to, from < to ? to : from, t, k};
  }
  sort_edges(a, b, n, false, level->n_vertices, scratch);
  sort_edges(b, a, n, true, level->n_vertices, scratch);
  memset(level->across, 0xff, (size_t)n * sizeof **level->across);
  for (int64_t i = 0; i + 1 < n; i++) {
    if (!same_edge(&a[i], &a[i + 1])) continue;
    if (i + 2 < n && same_edge(&a[i], &a[i + 2]))
      return problem_set(problem, "more than two triangles share the edge from vertex %u to %u",
                         a[i].low, a[i].high);
    uint32_t t = a[i].triangle, u = a[i + 1].triangle;
    if (level->vertex[t][a[i].k] == level->vertex[u][a[i + 1].k])
      return problem_set(problem, "triangles %u and %u, which share an edge, face opposite sides",
                         t, u);
    level->across[t][a[i].k] = u, level->across[u][a[i + 1].k] = t;
  }
  return true;
}

// ---- around a vertex ----
static uint32_t next_triangle(const struct level *level, uint32_t triangle, uint32_t vertex) {
  return level->across[triangle][level_corner(level, triangle, vertex)];
}

static uint32_t previous_triangle(const struct level *level, uint32_t triangle, uint32_t vertex) {
  return level->across[triangle][level_previous(level_corner(level, triangle, vertex))];
}

int level_ring(const struct level *level, uint32_t vertex, uint32_t *ring) {
  uint32_t triangle = level->start[vertex], first = triangle, beyond;
  int n = 0;
  if (!level->boundary[vertex]) {
    do {
      ring[n++] = level->vertex[triangle][level_next(level_corner(level, triangle, vertex))];
      triangle = next_triangle(level, triangle, vertex);
    } while (triangle != first);
    return n;
  }
  while ((beyond = next_triangle(level, triangle, vertex)) != LEVEL_NONE) triangle = beyond;
  ring[n++] = level->vertex[triangle][level_next(level_corner(level, triangle, vertex))];
  for (; triangle != LEVEL_NONE; triangle = previous_triangle(level, triangle, vertex))
    ring[n++] = level->vertex[triangle][level_previous(level_corner(level, triangle, vertex))];
  return n;
}

static bool is_boundary(const struct level *level, uint32_t vertex) {
  uint32_t triangle = level->start[vertex];
  do triangle = next_triangle(level, triangle, vertex);
  while (triangle != LEVEL_NONE && triangle != level->start[vertex]);
  return triangle == LEVEL_NONE;
}

bool level_of_mesh(const struct mesh *mesh, struct arena *arena, struct level *level,
                   struct problem *problem) {
  *level = level_new(mesh->n_vertices, mesh->n_triangles, arena);
  for (uint32_t v = 0; v < mesh->n_vertices; v++) {
    level->p[v] = vec(mesh->p[v][0], mesh->p[v][1], mesh->p[v][2]);
    level->start[v] = LEVEL_NONE;
  }
  for (uint32_t t = 0; t < mesh->n_triangles; t++)
    for (int k = 0; k < 3; k++) level->start[level->vertex[t][k] = mesh->triangle[t][k]] = t;
  if (!connect(level, *arena, problem)) return false;
  for (uint32_t v = 0; v < level->n_vertices; v++)
    level->boundary[v] = level->start[v] != LEVEL_NONE && is_boundary(level, v);
  return true;
}

ptrdiff_t level_longest_ring(const struct level *level, struct arena scratch) {
  ptrdiff_t *count = arena_new(&scratch, ptrdiff_t, level->n_vertices), longest = 0;
  for (uint32_t t = 0; t < level->n_triangles; t++)
    for (int k = 0; k < 3; k++) {
      ptrdiff_t n = ++count[level->vertex[t][k]] + 1; // a boundary has one more than triangles
      if (n > longest) longest = n;
    }
  return longest;
}
