#include "scene/motion.h"

#include "scene/box.h"
#include "scene/build.h"

#include <assert.h>
#include <float.h>
#include <string.h>

struct motion_start motion_start(const struct scene *scene) {
  return (struct motion_start){scene->n_shapes, scene->n_positions, scene->n_normals,
                               scene->n_tangents};
}

// ---- where it is ----
static void move_vertices(struct scene *scene, const struct motion *motion,
                          const struct transform *world_from_object) {
  float(*to)[3] = scene->position + scene->shape[motion->shape].vertex;
  for (uint32_t k = 0; k < motion->n_vertices; k++) {
    const float *from = motion->position[k];
    struct vec p =
        transform_point(world_from_object, vec((double)from[0], (double)from[1], (double)from[2]));
    to[k][0] = (float)p.x, to[k][1] = (float)p.y, to[k][2] = (float)p.z;
  }
}

static struct vec moved(const struct transform *t, const float v[3]) {
  return transform_direction(t, vec((double)v[0], (double)v[1], (double)v[2]));
}

// Normals and tangents: their lengths keep their ratios, the longest is 1, as where nothing moves
// (build_mesh.c).
static void move_vectors(float (*to)[3], float (*from)[3], uint32_t n, const struct transform *t) {
  double longest = 0;
  for (uint32_t k = 0; k < n; k++) {
    double length = vec_length(moved(t, from[k]));
    longest = length > longest ? length : longest;
  }
  for (uint32_t k = 0; k < n; k++) {
    struct vec v = moved(t, from[k]);
    v = longest > 0 ? vec_scale(v, 1 / longest) : v;
    to[k][0] = (float)v.x, to[k][1] = (float)v.y, to[k][2] = (float)v.z;
  }
}

// The inverse's transpose, which moves normals.
static struct transform transpose(const struct transform *t) {
  struct transform transposed = transform_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) transposed.m[i][j] = t->m[j][i];
  return transposed;
}

static struct transform place_at(const struct motion *motion, double share) {
  return transform_multiply(animation_at(&motion->instance, share),
                            animation_at(&motion->object, share));
}

// Between two matrices that are not singular there may be one that is, for a moment of measure
// zero: the shape is then taken at its start, whose matrix the reader has checked.
static void move_shape(struct scene *scene, const struct motion *motion, double share) {
  struct transform t = place_at(motion, share), inverse;
  if (!transform_invert(t, &inverse)) {
    t = place_at(motion, 0);
    transform_invert(t, &inverse);
  }
  const struct shape *shape = &scene->shape[motion->shape];
  if (motion->n_vertices == 0) {
    scene->quadric[shape->local].world_from_object = t;
    scene->quadric[shape->local].object_from_world = inverse;
    return;
  }
  move_vertices(scene, motion, &t);
  struct transform of_normals = transpose(&inverse);
  if (motion->n_normals)
    move_vectors(scene->normal + shape->normal, motion->normal, motion->n_normals, &of_normals);
  if (motion->n_tangents)
    move_vectors(scene->tangent + shape->tangent, motion->tangent, motion->n_tangents, &t);
}

void motion_set(struct scene *copy, double time) {
  const double *end = copy->motion_time;
  double share = (time - end[0]) / (end[1] - end[0]);
  for (uint32_t k = 0; k < copy->n_motions; k++) move_shape(copy, &copy->motion[k], share);
  copy->camera.world_from_camera = animation_at(&copy->camera.animation, share);
}

static void *copy_of(struct arena *arena, const void *array, uint32_t count, size_t size) {
  void *copy = arena_alloc(arena, count, (ptrdiff_t)size, alignof(max_align_t));
  if (count) memcpy(copy, array, count * size);
  return copy;
}

struct scene *motion_copy(const struct scene *scene, struct arena *arena) {
  struct scene *copy = arena_new(arena, struct scene, 1);
  *copy = *scene;
  if (scene->n_motions == 0) return copy;
  copy->position = copy_of(arena, scene->position, scene->n_positions, sizeof *copy->position);
  copy->normal = copy_of(arena, scene->normal, scene->n_normals, sizeof *copy->normal);
  copy->tangent = copy_of(arena, scene->tangent, scene->n_tangents, sizeof *copy->tangent);
  copy->quadric = copy_of(arena, scene->quadric, scene->n_quadrics, sizeof *copy->quadric);
  return copy;
}

// ---- all places ----
static struct vec corner_of(const struct box *box, int corner) {
  return vec((double)(corner & 1 ? box->hi : box->lo)[0],
             (double)(corner & 2 ? box->hi : box->lo)[1],
             (double)(corner & 4 ? box->hi : box->lo)[2]);
}

static struct vec places_of(const struct animation *a, struct vec p, int step, double *slack) {
  struct transform t = animation_at(a, (double)step / ANIMATION_STEPS);
  *slack = animation_slack(a, p);
  return transform_point(&t, p);
}

// What a box passes through: an affine image of it lies within its corners' images. Vertices are
// rounded to float, so a unit in the last place of one is added. Arithmetic that overflows leads
// anywhere.
static struct box swept(const struct animation *a, struct box box) {
  static const struct box everywhere = {{-INFINITY, -INFINITY, -INFINITY},
                                        {INFINITY, INFINITY, INFINITY}};
  struct box all = box_empty();
  for (int corner = 0; corner < 8; corner++)
    for (int step = 0; step <= ANIMATION_STEPS; step++) {
      double slack;
      struct vec p = places_of(a, corner_of(&box, corner), step, &slack);
      slack += (fabs(p.x) + fabs(p.y) + fabs(p.z)) * (double)FLT_EPSILON;
      if (!(slack < INFINITY)) return everywhere;
      all = box_union(all, box_around(p, vec(slack, slack, slack), vec(slack, slack, slack)));
    }
  return all;
}

static bool box_is_finite(const struct box *box) {
  for (int i = 0; i < 3; i++)
    if (!(box->lo[i] >= -FLT_MAX && box->hi[i] <= FLT_MAX)) return false;
  return true;
}

static struct box bounds_of(const struct scene *scene, const struct motion *motion) {
  struct box box = box_empty();
  for (uint32_t s = motion->shape; s < motion->shape + motion->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    for (uint32_t p = shape->first; p < shape->first + shape->count; p++)
      box = box_union(box, shape->type->bounds(scene, shape, p));
  }
  return box;
}

bool motion_add(struct scene_builder *builder, struct params *params,
                const struct motion_start *start, const struct motion_place *place) {
  struct scene *scene = builder->scene;
  struct motion motion = {.shape = start->shape,
                          .n_shapes = scene->n_shapes - start->shape,
                          .instance = place->instance,
                          .object = place->object,
                          .n_vertices = scene->n_positions - start->position,
                          .n_normals = scene->n_normals - start->normal,
                          .n_tangents = scene->n_tangents - start->tangent};
  const struct shape *shape = &scene->shape[motion.shape];
  if (shape->count == 0) return true;
  assert(motion.n_vertices == 0 || shape->vertex == start->position);
  if (motion.n_vertices)
    motion.position = copy_of(builder->arena, scene->position + start->position, motion.n_vertices,
                              sizeof *motion.position);
  if (motion.n_normals)
    motion.normal = copy_of(builder->arena, scene->normal + start->normal, motion.n_normals,
                            sizeof *motion.normal);
  if (motion.n_tangents)
    motion.tangent = copy_of(builder->arena, scene->tangent + start->tangent, motion.n_tangents,
                             sizeof *motion.tangent);
  motion.bounds = swept(&motion.instance, swept(&motion.object, bounds_of(scene, &motion)));
  if (!box_is_finite(&motion.bounds))
    return params_complain(params, "P", "it moves out of the range of floats");
  scene->motion = build_grow(builder->arena, scene->motion, scene->n_motions, 1, sizeof motion);
  scene->motion[scene->n_motions++] = motion;
  move_shape(scene, &motion, 0);
  return true;
}
