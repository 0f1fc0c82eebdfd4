// Traversal: near child first, the other one waits on the stack. Exactness is argued in
// scene/shape/clip.h: a box is skipped only if its clip is empty or begins beyond the closest t.
// What is done here to two triangles or two boxes at a time is what triangle.h and clip.h do to
// one.
#include "bvh/tree.h"

#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

// A ray under way.
struct search {
  const struct bvh *bvh;
  const struct ray *ray;
  struct cone cone;
  struct shear shear;
  struct hit best; // t = t_max while nothing is hit
};

static inline void search_keep(struct search *s, double t, uint32_t primitive) {
  if (t < s->best.t || (t == s->best.t && primitive < s->best.primitive))
    s->best = (struct hit){t, primitive};
}

// ---- triangles ----
// triangle_accepts
static inline lanes_mask block_accepts(const struct shear *s, const struct bvh_block *block) {
  lanes x[3], y[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    lanes z = lanes_from(block->vertex[i][s->z]) - s->o[s->z];
    x[i] = (lanes_from(block->vertex[i][s->x]) - s->o[s->x]) - s->along_x * z;
    y[i] = (lanes_from(block->vertex[i][s->y]) - s->o[s->y]) - s->along_y * z;
  }
  lanes e0 = x[1] * y[2] - y[1] * x[2];
  lanes e1 = x[2] * y[0] - y[2] * x[0];
  lanes e2 = x[0] * y[1] - y[0] * x[1];
  return ((e0 >= 0) & (e1 >= 0) & (e2 >= 0)) | ((e0 <= 0) & (e1 <= 0) & (e2 <= 0));
}

// triangle_plane
static inline lanes block_plane(const struct ray *ray, const struct bvh_block *block) {
  lanes p[3][3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++)
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) p[i][k] = lanes_from(block->vertex[i][k]);
  lanes ax = p[0][0] - p[2][0], ay = p[0][1] - p[2][1], az = p[0][2] - p[2][2];
  lanes bx = p[1][0] - p[2][0], by = p[1][1] - p[2][1], bz = p[1][2] - p[2][2];
  lanes nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
  lanes x = p[0][0] - ray->o.x, y = p[0][1] - ray->o.y, z = p[0][2] - ray->o.z;
  return (nx * x + ny * y + nz * z) / (nx * ray->d.x + ny * ray->d.y + nz * ray->d.z);
}

static inline void block_gather(const struct bvh_block *block, int lane, float vertex[3][3]) {
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) vertex[i][k] = block->vertex[i][k][lane];
}

static inline void search_block(struct search *s, const struct bvh_block *block) {
  lanes_mask accepted = block_accepts(&s->shear, block);
  if (!lanes_bits(accepted)) return;
  lanes t = block_plane(s->ray, block);
  unsigned bits = lanes_bits(accepted & (t > 0) & (t < INFINITY));
  for (int lane = 0; bits; lane++, bits >>= 1) {
    if (!(bits & 1) || block->primitive[lane] == s->ray->leaving) continue;
    float vertex[3][3];
    block_gather(block, lane, vertex);
    struct box box = triangle_box(vertex);
    double t_lane = t[lane];
    if (clip_accept(&s->cone, &box, s->ray->t_max, &t_lane) &&
        !triangle_is_left_behind(s->bvh->scene, s->ray, vertex))
      search_keep(s, t_lane, block->primitive[lane]);
  }
}

// ---- others ----
static bool other_hit(const struct search *s, const struct bvh_other *other, double *t) {
  const struct scene *scene = s->bvh->scene;
  const struct shape *shape = &scene->shape[scene->shape_of[other->primitive]];
  bool leaving = s->ray->leaving == other->primitive;
  if (shape->type->intersect == sphere_intersect)
    return sphere_hit(shape_quadric(scene, shape, other->primitive), &other->box, &s->cone, s->ray,
                      leaving, t);
  if (shape->type->intersect == disk_intersect)
    return !leaving && disk_hit(shape_quadric(scene, shape, other->primitive), &other->box,
                                &s->cone, s->ray, t);
  return shape->type->intersect(scene, shape, other->primitive, s->ray, t);
}

static void search_other(struct search *s, const struct bvh_other *other) {
  double t;
  if (other_hit(s, other, &t)) search_keep(s, t, other->primitive);
}

static inline void search_leaf(struct search *s, struct bvh_child leaf) {
  if (leaf.kind == BVH_TRIANGLES)
    for (uint32_t i = 0; i < leaf.count; i++) search_block(s, &s->bvh->block[leaf.first + i]);
  else
    for (uint32_t i = 0; i < leaf.count; i++) search_other(s, &s->bvh->other[leaf.first + i]);
}

// ---- nodes ----
// cone_clip of both children. t0: where their clips begin, INFINITY where there is nothing to find.
// `parallel`: whether any axis is.
static inline lanes node_clip(const struct search *s, const struct bvh_node *node, bool parallel) {
  const struct cone *cone = &s->cone;
  lanes near = {0, 0}, far = {INFINITY, INFINITY};
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    int enter = cone->backward[k];
    lanes first = lanes_from(node->face[enter][k]) - cone->o[k];
    lanes last = lanes_from(node->face[1 - enter][k]) - cone->o[k];
    if (parallel && cone->parallel[k]) {
      lanes outside = enter ? lanes_max(last, -first) : lanes_max(first, -last);
      near = lanes_max(outside * cone->near_scale[k], near);
    } else {
      near = lanes_max(first * cone->near_scale[k], near);
      far = lanes_min(last * cone->far_scale[k], far);
    }
  }
  lanes limit = lanes_min(lanes_set(s->best.t), far);
  return (lanes){near[0] <= limit[0] ? near[0] : INFINITY,
                 near[1] <= limit[1] ? near[1] : INFINITY};
}

struct waiting {
  struct bvh_child child;
  double t0;
};

static inline void search_tree(struct search *s, bool any, bool parallel) {
  struct waiting stack[BVH_MAX_DEPTH];
  int n = 0;
  struct bvh_child child = s->bvh->root;
  for (;;) {
    if (child.kind == BVH_NODE) {
      const struct bvh_node *node = &s->bvh->node[child.first];
      lanes t0 = node_clip(s, node, parallel);
      // Branches, not selections: what is predicted need not be waited for.
      if (t0[0] < INFINITY && t0[1] < INFINITY) {
        if (t0[1] < t0[0]) {
          stack[n++] = (struct waiting){node->child[0], t0[0]};
          child = node->child[1];
        } else {
          stack[n++] = (struct waiting){node->child[1], t0[1]};
          child = node->child[0];
        }
        continue;
      }
      if (t0[0] < INFINITY) {
        child = node->child[0];
        continue;
      }
      if (t0[1] < INFINITY) {
        child = node->child[1];
        continue;
      }
    } else {
      search_leaf(s, child);
      if (any && s->best.primitive != PRIMITIVE_NONE) return;
    }
    do
      if (n-- == 0) return;
    while (stack[n].t0 > s->best.t);
    child = stack[n].child;
  }
}

static struct hit search_run(const struct bvh *bvh, const struct ray *ray, bool any) {
  struct search search;
  search.bvh = bvh, search.ray = ray;
  search.best = (struct hit){ray->t_max, PRIMITIVE_NONE};
  cone_set(&search.cone, ray);
  shear_set(&search.shear, ray);
  if (search.cone.any_parallel)
    search_tree(&search, any, true);
  else
    search_tree(&search, any, false);
  return search.best;
}

void bvh_closest(const struct bvh *bvh, const struct ray *rays, struct hit *hits, int n) {
  for (int j = 0; j < n; j++) {
    hits[j] = search_run(bvh, &rays[j], false);
    if (hits[j].primitive == PRIMITIVE_NONE) hits[j].t = INFINITY;
  }
}

void bvh_any(const struct bvh *bvh, const struct ray *rays, unsigned char *blocked, int n) {
  for (int j = 0; j < n; j++)
    blocked[j] = search_run(bvh, &rays[j], true).primitive != PRIMITIVE_NONE;
}
