// Loop subdivision with the masks of pbrt-v4 (Loop 1987; boundaries and tangents: Hoppe et al.
// 1994, "Piecewise Smooth Surface Reconstruction"). Edge k of a triangle leads from its vertex k to
// k + 1. pbrt-v4 moves boundary vertices with the weights 1/5, 3/5, 1/5 in the end, where the limit
// of its own rule is 1/6, 4/6, 1/6, and it takes tangents from the positions already moved. So do
// we.
#include "mesh/level.h"
#include "numeric/elementary.h"

#include <string.h>

// ---- positions ----
static double loop_beta(int valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8 * valence); }

static double loop_gamma(int valence) { return 1 / (valence + 3 / (8 * loop_beta(valence))); }

// `weight` for each of the ring that counts, the rest for the vertex.
static struct vec blend(const struct level *level, uint32_t vertex, const uint32_t *ring, int n,
                        double weight) {
  int step = level->boundary[vertex] ? n - 1 : 1; // of a boundary, only its two ends
  struct vec sum = vec(0, 0, 0);
  for (int k = 0; k < n; k += step) sum = vec_add(sum, level->p[ring[k]]);
  int counted = level->boundary[vertex] ? 2 : n;
  return vec_along(vec_scale(level->p[vertex], 1 - counted * weight), sum, weight);
}

static struct vec edge_point(const struct level *level, uint32_t triangle, int k) {
  const uint32_t *v = level->vertex[triangle];
  struct vec ends = vec_add(level->p[v[k]], level->p[v[level_next(k)]]);
  uint32_t other = level->across[triangle][k];
  if (other == LEVEL_NONE) return vec_scale(ends, 0.5);
  int opposite = level_next(level_corner(level, other, v[k]));
  struct vec sides =
      vec_add(level->p[v[level_previous(k)]], level->p[level->vertex[other][opposite]]);
  return vec_along(vec_scale(ends, 3.0 / 8), sides, 1.0 / 8);
}

// ---- one refinement ----
// The triangles 4 t + j of t: at its corner j, or (3) in the middle. Old vertices keep their
// numbers.
static uint32_t child_at(const struct level *level, uint32_t triangle, uint32_t vertex) {
  return triangle == LEVEL_NONE ? LEVEL_NONE
                                : 4 * triangle + (uint32_t)level_corner(level, triangle, vertex);
}

// The new vertex of each edge, numbered as the triangles come; how many.
static uint32_t number_edges(const struct level *level, uint32_t (*edge)[3]) {
  uint32_t n = 0;
  for (uint32_t t = 0; t < level->n_triangles; t++)
    for (int k = 0; k < 3; k++) {
      uint32_t other = level->across[t][k];
      edge[t][k] =
          other == LEVEL_NONE || t < other
              ? level->n_vertices + n++
              : edge[other][level_previous(level_corner(level, other, level->vertex[t][k]))];
    }
  return n;
}

static void add_children(const struct level *level, uint32_t t, const uint32_t edge[3],
                         struct level *fine) {
  for (int j = 0; j < 3; j++) {
    uint32_t v = level->vertex[t][j], child = 4 * t + (uint32_t)j, middle = 4 * t + 3;
    fine->vertex[child][j] = v;
    fine->vertex[child][level_next(j)] = edge[j];
    fine->vertex[child][level_previous(j)] = edge[level_previous(j)];
    fine->vertex[middle][j] = edge[j];
    fine->across[child][j] = child_at(level, level->across[t][j], v);
    fine->across[child][level_previous(j)] =
        child_at(level, level->across[t][level_previous(j)], v);
    fine->across[child][level_next(j)] = middle;
    fine->across[middle][j] = 4 * t + (uint32_t)level_next(j);
  }
}

static void add_edge_points(const struct level *level, uint32_t t, const uint32_t edge[3],
                            struct level *fine) {
  for (int k = 0; k < 3; k++) {
    uint32_t other = level->across[t][k];
    if (other != LEVEL_NONE && other < t) continue;
    fine->p[edge[k]] = edge_point(level, t, k);
    fine->boundary[edge[k]] = other == LEVEL_NONE;
    fine->start[edge[k]] = 4 * t + 3;
  }
}

static struct level refine(const struct level *level, uint32_t *ring, struct arena *arena) {
  uint32_t(*edge)[3] = arena_alloc(arena, level->n_triangles, sizeof *edge, alignof(uint32_t));
  uint32_t n_edges = number_edges(level, edge);
  struct level fine = level_new(level->n_vertices + n_edges, 4 * level->n_triangles, arena);
  for (uint32_t v = 0; v < level->n_vertices; v++) {
    fine.p[v] = level->p[v];
    fine.boundary[v] = level->boundary[v];
    fine.start[v] = child_at(level, level->start[v], v);
    if (level->start[v] == LEVEL_NONE) continue;
    int n = level_ring(level, v, ring);
    fine.p[v] = blend(level, v, ring, n, level->boundary[v] ? 1.0 / 8 : loop_beta(n));
  }
  for (uint32_t t = 0; t < level->n_triangles; t++) {
    add_children(level, t, edge[t], &fine);
    add_edge_points(level, t, edge[t], &fine);
  }
  return fine;
}

// ---- the limit ----
static struct vec boundary_tangent(const struct level *level, uint32_t vertex, const uint32_t *ring,
                                   int n) {
  const struct vec *p = level->p;
  struct vec ends = vec_add(p[ring[0]], p[ring[n - 1]]);
  if (n == 2) return vec_along(ends, p[vertex], -2);
  if (n == 3) return vec_sub(p[ring[1]], p[vertex]);
  if (n == 4)
    return vec_along(vec_along(vec_scale(vec_add(p[ring[1]], p[ring[2]]), 2), ends, -1), p[vertex],
                     -2);
  double sine, cosine, turn = 0.5 / (n - 1); // theta = pi / (n - 1)
  num_sincos_turns(turn, &sine, &cosine);
  double scale = 2 - 2 * cosine;
  struct vec t = vec_scale(ends, -sine);
  for (int k = 1; k < n - 1; k++) {
    num_sincos_turns(k * turn, &sine, &cosine);
    t = vec_along(t, p[ring[k]], scale * sine);
  }
  return t;
}

static struct vec limit_normal(const struct level *level, uint32_t vertex, const uint32_t *ring,
                               int n) {
  if (level->boundary[vertex])
    return vec_cross(vec_sub(level->p[ring[n - 1]], level->p[ring[0]]),
                     boundary_tangent(level, vertex, ring, n));
  struct vec s = vec(0, 0, 0), t = s;
  for (int k = 0; k < n; k++) {
    double sine, cosine;
    num_sincos_turns((double)k / n, &sine, &cosine);
    s = vec_along(s, level->p[ring[k]], cosine);
    t = vec_along(t, level->p[ring[k]], sine);
  }
  return vec_cross(s, t);
}

static void push_to_limit(struct level *level, uint32_t *ring, struct arena scratch) {
  struct vec *limit = arena_new(&scratch, struct vec, level->n_vertices);
  for (uint32_t v = 0; v < level->n_vertices; v++) {
    limit[v] = level->p[v];
    if (level->start[v] == LEVEL_NONE) continue;
    int n = level_ring(level, v, ring);
    limit[v] = blend(level, v, ring, n, level->boundary[v] ? 1.0 / 5 : loop_gamma(n));
  }
  memcpy(level->p, limit, level->n_vertices * sizeof *limit);
}

// ---- all of it ----
static void copy_out(const struct level *level, uint32_t *ring, struct arena *arena,
                     struct mesh *out) {
  *out = (struct mesh){.n_vertices = level->n_vertices, .n_triangles = level->n_triangles};
  out->p = arena_alloc(arena, out->n_vertices, sizeof *out->p, alignof(double));
  out->n = arena_alloc(arena, out->n_vertices, sizeof *out->n, alignof(double));
  out->triangle = arena_alloc(arena, out->n_triangles, sizeof *out->triangle, alignof(uint32_t));
  memcpy(out->triangle, level->vertex, out->n_triangles * sizeof *out->triangle);
  for (uint32_t v = 0; v < level->n_vertices; v++) {
    struct vec p = level->p[v], n = vec(0, 0, 0);
    if (level->start[v] != LEVEL_NONE) n = limit_normal(level, v, ring, level_ring(level, v, ring));
    out->p[v][0] = p.x, out->p[v][1] = p.y, out->p[v][2] = p.z;
    out->n[v][0] = n.x, out->n[v][1] = n.y, out->n[v][2] = n.z;
  }
}

bool mesh_subdivide(const struct mesh *mesh, int levels, struct arena *arena, struct arena scratch,
                    struct mesh *out, struct problem *problem) {
  // A closed surface has half as many vertices as triangles, but separate triangles three each.
  double n = mesh->n_triangles, vertices = (double)mesh->n_vertices;
  for (int k = 0; k < levels && n < UINT32_MAX; k++) vertices += 3 * n, n *= 4;
  if (!(n < UINT32_MAX && vertices < UINT32_MAX))
    return problem_set(problem, "%d levels make more than 2^32 - 2 triangles or vertices", levels);
  struct level level;
  if (!level_of_mesh(mesh, &scratch, &level, problem)) return false;
  ptrdiff_t longest =
      level_longest_ring(&level, scratch); // new vertices have six neighbours or less
  uint32_t *ring = arena_new(&scratch, uint32_t, longest > 6 ? longest : 6);
  for (int k = 0; k < levels; k++) level = refine(&level, ring, &scratch);
  push_to_limit(&level, ring, scratch);
  copy_out(&level, ring, arena, out);
  return true;
}
