// A tree that follows its primitives: after any motion it finds what brute force finds, bit for
// bit, and the tree it was copied from is as it was.
#include "bvh/tree.h"
#include "tests/unit/meshes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { N_SHAPES = 12, PER_SHAPE = 40 };

static struct quadric small_sphere(struct draw *draw) {
  struct vec at = draw_in_cube(draw, 2.7);
  struct quadric q = {.world_from_object = transform_translate(at),
                      .object_from_world = transform_translate(vec_scale(at, -1)),
                      .radius = 0.4,
                      .z_min = -0.4,
                      .z_max = 0.4,
                      .phi_max = 6.283185307179586};
  return q;
}

// Meshes and spheres in turn.
static void fill(struct mesh *m, struct draw *draw) {
  for (int s = 0; s < N_SHAPES; s++) {
    mesh_add_shape(m, &shape_trianglemesh);
    for (int i = 0; i < PER_SHAPE; i++) {
      struct vec at = draw_in_cube(draw, 2.7);
      mesh_add_triangle(m, vec_add(at, draw_in_cube(draw, 0.6)),
                        vec_add(at, draw_in_cube(draw, 0.6)), vec_add(at, draw_in_cube(draw, 0.6)));
    }
    mesh_add_quadric(m, &shape_sphere, small_sphere(draw));
  }
  mesh_finish(m);
}

// A scene of its own, with its own vertices and quadrics.
static struct scene scene_copy(const struct scene *scene, struct arena *arena) {
  struct scene copy = *scene;
  copy.position = arena_alloc(arena, copy.n_positions, sizeof *copy.position, alignof(float));
  copy.quadric = arena_new(arena, struct quadric, copy.n_quadrics);
  memcpy(copy.position, scene->position, copy.n_positions * sizeof *copy.position);
  memcpy(copy.quadric, scene->quadric, copy.n_quadrics * sizeof *copy.quadric);
  return copy;
}

static void move(struct scene *scene, const struct scene *from, const bool *moves,
                 struct draw *draw) {
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    struct vec by = draw_in_cube(draw, 3.1);
    if (!moves[s]) continue;
    if (shape->type == &shape_sphere) {
      struct quadric *q = &scene->quadric[shape->local];
      q->world_from_object = transform_translate(by);
      q->object_from_world = transform_translate(vec_scale(by, -1));
      continue;
    }
    const double step[3] = {by.x, by.y, by.z};
    for (uint32_t t = shape->local; t < shape->local + shape->count; t++)
      for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
          uint32_t row = scene->triangle[t][i];
          scene->position[row][k] = (float)((double)from->position[row][k] + step[k]);
        }
  }
}

static int check_rays(const struct scene *scene, const struct bvh *bvh, struct draw *draw) {
  enum { N = 400 };
  struct ray ray[N];
  struct hit hit[N], expected[N];
  int hits = 0;
  for (int j = 0; j < N; j++)
    ray[j] = (struct ray){draw_in_cube(draw, 6), draw_direction(draw), INFINITY, PRIMITIVE_NONE};
  bvh_closest(bvh, ray, hit, N);
  bvh_closest_brute_force(scene, ray, expected, N);
  for (int j = 0; j < N; j++) {
    assert_int_equal(hit[j].primitive, expected[j].primitive);
    assert_memory_equal(&hit[j].t, &expected[j].t, sizeof hit[j].t);
    hits += hit[j].primitive != PRIMITIVE_NONE;
  }
  return hits;
}

// Every third shape moves, or all.
static void check_motion(bool all, int leaf_size, const char *name) {
  struct draw draw = draw_named(name);
  draw.path = (uint64_t)leaf_size << 24;
  struct mesh m = mesh_new(2 * N_SHAPES, N_SHAPES * (PER_SHAPE + 1));
  fill(&m, &draw);
  bool moves[2 * N_SHAPES];
  for (int s = 0; s < 2 * N_SHAPES; s++) moves[s] = all || s % 3 == 0;
  struct bvh *bvh = bvh_build(&m.scene, (struct bvh_options){.leaf_size = leaf_size}, &m.arena);
  struct scene scene = scene_copy(&m.scene, &m.arena);
  struct bvh *clone = bvh_clone(bvh, &scene, all ? NULL : moves, &m.arena);
  int hits = 0;
  for (int time = 0; time < 5; time++) {
    move(&scene, &m.scene, moves, &draw);
    bvh_refit(clone);
    hits += check_rays(&scene, clone, &draw);
  }
  hits += check_rays(&m.scene, bvh, &draw);
  assert_true(hits > 300);
  mesh_release(&m);
}

static void a_refitted_tree_finds_what_brute_force_finds(void **state) {
  (void)state;
  check_motion(true, 0, __func__);
  check_motion(true, 1, __func__);
}

static void only_what_moves_needs_to_be_refitted(void **state) {
  (void)state;
  check_motion(false, 0, __func__);
  check_motion(false, 1, __func__);
  check_motion(false, 100000, __func__); // no nodes
}

static void a_refit_of_nothing_new_is_the_tree_itself(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  struct mesh m = mesh_new(2 * N_SHAPES, N_SHAPES * (PER_SHAPE + 1));
  fill(&m, &draw);
  struct bvh *bvh = bvh_build(&m.scene, (struct bvh_options){0}, &m.arena);
  struct bvh *clone = bvh_clone(bvh, &m.scene, NULL, &m.arena);
  bvh_refit(clone);
  assert_memory_equal(clone->node, bvh->node, bvh->n_nodes * sizeof *bvh->node);
  assert_memory_equal(clone->block, bvh->block, bvh->n_blocks * sizeof *bvh->block);
  assert_memory_equal(clone->other, bvh->other, bvh->n_others * sizeof *bvh->other);
  mesh_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_refitted_tree_finds_what_brute_force_finds),
      cmocka_unit_test(only_what_moves_needs_to_be_refitted),
      cmocka_unit_test(a_refit_of_nothing_new_is_the_tree_itself),
  };
  return cmocka_run_group_tests_name("bvh_refit", tests, NULL, NULL);
}
