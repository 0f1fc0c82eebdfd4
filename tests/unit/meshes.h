// Scenes made by hand for the tests of the tree and the ray tests, and random numbers for them.
#ifndef TESTS_UNIT_MESHES_H
#define TESTS_UNIT_MESHES_H

#include "base/arena.h"
#include "bvh/bvh.h"
#include "numeric/rng.h"
#include "scene/scene.h"

extern const struct shape_type shape_trianglemesh, shape_sphere, shape_disk, shape_cylinder,
    shape_bilinearmesh;

// A stream of numbers named by its test.
struct draw {
  struct rng_key key;
  uint64_t path;
};

static inline struct draw draw_named(const char *name) {
  return (struct draw){.key = rng_key(rng_hash_name(name), 1, RNG_TEST)};
}

static inline double draw_unit(struct draw *draw) {
  double u0, u1;
  rng_fill(draw->key, 1, &draw->path, 1, 0, &u0, &u1);
  draw->path++;
  return u0;
}

static inline double draw_between(struct draw *draw, double lo, double hi) {
  return lo + (hi - lo) * draw_unit(draw);
}

static inline int draw_below(struct draw *draw, int n) { return (int)(n * draw_unit(draw)); }

static inline struct vec draw_in_cube(struct draw *draw, double half) {
  double x = draw_between(draw, -half, half), y = draw_between(draw, -half, half);
  return vec(x, y, draw_between(draw, -half, half));
}

static inline struct vec draw_direction(struct draw *draw) {
  for (;;) {
    struct vec v = draw_in_cube(draw, 1);
    double r2 = vec_dot(v, v);
    if (r2 > 0.01 && r2 < 1) return vec_normalize(v);
  }
}

// Room for `shapes` shapes and `primitives` primitives (and four vertices each).
struct mesh {
  struct arena start, arena;
  struct scene scene;
};

// Gives an arena, or takes one back to give it again: to reserve one is dear under asan.
static inline struct arena mesh_memory(const struct arena *back) {
  static struct arena free[8];
  static int n;
  if (back && n < 8) free[n++] = *back;
  if (back) return *back;
  return n ? free[--n] : arena_reserve();
}

static inline struct mesh mesh_new(int shapes, int primitives) {
  struct mesh m = {.start = mesh_memory(NULL)};
  m.arena = m.start;
  m.scene.position = arena_alloc(&m.arena, 4 * primitives, sizeof(float[3]), alignof(float));
  m.scene.triangle = arena_alloc(&m.arena, primitives, sizeof(uint32_t[3]), alignof(uint32_t));
  m.scene.patch = arena_alloc(&m.arena, primitives, sizeof(uint32_t[4]), alignof(uint32_t));
  m.scene.quadric = arena_new(&m.arena, struct quadric, primitives);
  m.scene.shape = arena_new(&m.arena, struct shape, shapes);
  m.scene.shape_of = arena_new(&m.arena, uint32_t, primitives);
  return m;
}

static inline void mesh_release(struct mesh *m) { mesh_memory(&m->start); }

static inline void mesh_add_shape(struct mesh *m, const struct shape_type *type) {
  struct scene *s = &m->scene;
  uint32_t local = type == &shape_trianglemesh   ? s->n_triangles
                   : type == &shape_bilinearmesh ? s->n_patches
                                                 : s->n_quadrics;
  s->shape[s->n_shapes++] = (struct shape){.type = type,
                                           .first = s->n_primitives,
                                           .local = local,
                                           .normal = ROW_NONE,
                                           .uv = ROW_NONE,
                                           .tangent = ROW_NONE};
}

static inline void mesh_count_primitive(struct mesh *m) {
  struct scene *s = &m->scene;
  s->shape_of[s->n_primitives++] = s->n_shapes - 1;
  s->shape[s->n_shapes - 1].count++;
}

static inline uint32_t mesh_add_vertex(struct mesh *m, struct vec p) {
  float *at = m->scene.position[m->scene.n_positions];
  at[0] = (float)p.x, at[1] = (float)p.y, at[2] = (float)p.z;
  return m->scene.n_positions++;
}

// Of the last shape, which is a triangle mesh.
static inline void mesh_add_rows(struct mesh *m, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *row = m->scene.triangle[m->scene.n_triangles++];
  row[0] = a, row[1] = b, row[2] = c;
  mesh_count_primitive(m);
}

static inline void mesh_add_triangle(struct mesh *m, struct vec a, struct vec b, struct vec c) {
  uint32_t first = mesh_add_vertex(m, a);
  mesh_add_vertex(m, b), mesh_add_vertex(m, c);
  mesh_add_rows(m, first, first + 1, first + 2);
}

// Of the last shape, which is a bilinear mesh: p00, p10, p01, p11.
static inline void mesh_add_bilinear(struct mesh *m, const struct vec corner[4]) {
  uint32_t *row = m->scene.patch[m->scene.n_patches++];
  for (int i = 0; i < 4; i++) row[i] = mesh_add_vertex(m, corner[i]);
  mesh_count_primitive(m);
}

// A shape of its own.
static inline void mesh_add_quadric(struct mesh *m, const struct shape_type *type,
                                    struct quadric q) {
  mesh_add_shape(m, type);
  m->scene.quadric[m->scene.n_quadrics++] = q;
  mesh_count_primitive(m);
}

static inline struct vec mesh_vertex(const struct mesh *m, uint32_t row) {
  const float *p = m->scene.position[row];
  return vec((double)p[0], (double)p[1], (double)p[2]);
}

// The bounds, when everything has been added.
static inline void mesh_finish(struct mesh *m) {
  struct scene *s = &m->scene;
  for (uint32_t p = 0; p < s->n_primitives; p++) {
    const struct shape *shape = &s->shape[s->shape_of[p]];
    struct box box = shape->type->bounds(s, shape, p);
    for (int k = 0; k < 3; k++) {
      if (p == 0 || box.lo[k] < s->bounds.lo[k]) s->bounds.lo[k] = box.lo[k];
      if (p == 0 || box.hi[k] > s->bounds.hi[k]) s->bounds.hi[k] = box.hi[k];
    }
  }
}

// Closed and convex. Neighbours compute a shared vertex from the same numbers, so they share its
// bits.
static inline void mesh_add_patch(struct mesh *m, struct vec center, double radius, struct vec a,
                                  struct vec b, struct vec c, int level) {
  if (level == 0) {
    mesh_add_triangle(m, vec_along(center, a, radius), vec_along(center, b, radius),
                      vec_along(center, c, radius));
    return;
  }
  struct vec ab = vec_normalize(vec_add(a, b)), bc = vec_normalize(vec_add(b, c)),
             ca = vec_normalize(vec_add(c, a));
  mesh_add_patch(m, center, radius, a, ab, ca, level - 1);
  mesh_add_patch(m, center, radius, ab, b, bc, level - 1);
  mesh_add_patch(m, center, radius, ca, bc, c, level - 1);
  mesh_add_patch(m, center, radius, ab, bc, ca, level - 1);
}

// 20 * 4^level triangles.
static inline void mesh_add_icosphere(struct mesh *m, struct vec center, double radius, int level) {
  static const int face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const double g = (1 + sqrt(5)) / 2;
  const struct vec corner[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                 {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                 {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (int i = 0; i < 20; i++)
    mesh_add_patch(m, center, radius, vec_normalize(corner[face[i][0]]),
                   vec_normalize(corner[face[i][1]]), vec_normalize(corner[face[i][2]]), level);
}

// A box of 12 n^2 triangles, or 6 n^2 patches if the last shape is a bilinear mesh.
static inline void mesh_add_grid_box(struct mesh *m, struct vec center, double half, int n) {
  bool patches = m->scene.shape[m->scene.n_shapes - 1].type == &shape_bilinearmesh;
  for (int face = 0; face < 6; face++)
    for (int i = 0; i < n * n; i++) {
      struct vec corner[4];
      for (int c = 0; c < 4; c++) {
        double at[3];
        at[face / 2] = face % 2 ? half : -half;
        at[(face / 2 + 1) % 3] = half * (2.0 * (i % n + c % 2) / n - 1);
        at[(face / 2 + 2) % 3] = half * (2.0 * (i / n + c / 2) / n - 1);
        corner[c] = vec_add(center, vec(at[0], at[1], at[2]));
      }
      if (patches) {
        mesh_add_bilinear(m, corner);
        continue;
      }
      mesh_add_triangle(m, corner[0], corner[1], corner[3]);
      mesh_add_triangle(m, corner[0], corner[3], corner[2]);
    }
}

#endif
