// Scenes made by hand for the tests of the tree and the ray tests, and random numbers for them.
#ifndef TESTS_UNIT_MESHES_H
#define TESTS_UNIT_MESHES_H

#include "base/arena.h"
#include "bvh/bvh.h"
#include "numeric/rng.h"
#include "scene/scene.h"

extern const struct shape_type shape_trianglemesh, shape_sphere, shape_disk;

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

// Room for `shapes` shapes and `primitives` primitives (and twice as many vertices each).
struct mesh {
  struct arena start, arena;
  struct scene scene;
};

static inline struct mesh mesh_new(int shapes, int primitives) {
  struct mesh m = {.start = arena_reserve()};
  m.arena = m.start;
  m.scene.position = arena_alloc(&m.arena, 3 * primitives, sizeof(float[3]), alignof(float));
  m.scene.triangle = arena_alloc(&m.arena, primitives, sizeof(uint32_t[3]), alignof(uint32_t));
  m.scene.quadric = arena_new(&m.arena, struct quadric, primitives);
  m.scene.shape = arena_new(&m.arena, struct shape, shapes);
  m.scene.shape_of = arena_new(&m.arena, uint32_t, primitives);
  return m;
}

static inline void mesh_release(struct mesh *m) { arena_release(m->start); }

static inline void mesh_add_shape(struct mesh *m, const struct shape_type *type) {
  struct scene *s = &m->scene;
  uint32_t local = type == &shape_trianglemesh ? s->n_triangles : s->n_quadrics;
  s->shape[s->n_shapes++] = (struct shape){.type = type, .first = s->n_primitives, .local = local};
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

#endif
