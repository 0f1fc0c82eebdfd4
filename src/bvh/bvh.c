// Traversal: near child first, the other one waits on the stack. Exactness is argued in
// scene/shape/clip.h: a box is skipped only if its clip is empty or begins beyond the closest t.
#include "bvh/tree.h"

#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

#include <string.h>

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

static inline void search_triangle(struct search *s, const struct bvh_item *item) {
  double t;
  if (!triangle_accepts(&s->shear, item->vertex) || item->primitive == s->ray->leaving) return;
  if (triangle_distance(&s->cone, s->ray, item->vertex, &t)) search_keep(s, t, item->primitive);
}

static void search_mixed(struct search *s, const struct bvh_item *item) {
  const struct scene *scene = s->bvh->scene;
  const struct shape *shape = &scene->shape[scene->shape_of[item->primitive]];
  double t;
  if (shape->type->intersect(scene, shape, item->primitive, s->ray, &t))
    search_keep(s, t, item->primitive);
}

static inline void search_leaf(struct search *s, struct bvh_child leaf) {
  const struct bvh_item *item = &s->bvh->item[leaf.first], *end = item + leaf.count;
  if (leaf.kind == BVH_TRIANGLES)
    for (; item < end; item++) search_triangle(s, item);
  else
    for (; item < end; item++) search_mixed(s, item);
}

static inline bool search_clip(const struct search *s, const struct bvh_node *node, int side,
                               double *t0) {
  struct box box;
  double t1;
  for (int k = 0; k < 3; k++)
    box.lo[k] = node->face[0][k][side], box.hi[k] = node->face[1][k][side];
  return cone_clip(&s->cone, &box, t0, &t1) && *t0 <= s->best.t;
}

struct waiting {
  struct bvh_child child;
  double t0;
};

static inline void search_tree(struct search *s, bool any) {
  struct waiting stack[BVH_MAX_DEPTH];
  int n = 0;
  struct bvh_child child = s->bvh->root;
  for (;;) {
    if (child.kind == BVH_NODE) {
      const struct bvh_node *node = &s->bvh->node[child.first];
      double t0[2];
      bool in0 = search_clip(s, node, 0, &t0[0]), in1 = search_clip(s, node, 1, &t0[1]);
      if (in0 || in1) {
        int near = !in0 || (in1 && t0[1] < t0[0]);
        if (in0 && in1) stack[n++] = (struct waiting){node->child[1 - near], t0[1 - near]};
        child = node->child[near];
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

static inline struct search search_new(const struct bvh *bvh, const struct ray *ray) {
  return (struct search){bvh, ray, cone_of(ray), shear_of(ray), {ray->t_max, PRIMITIVE_NONE}};
}

void bvh_closest(const struct bvh *bvh, const struct ray *rays, struct hit *hits, int n) {
  for (int j = 0; j < n; j++) {
    struct search search = search_new(bvh, &rays[j]);
    search_tree(&search, false);
    hits[j] = search.best;
    if (hits[j].primitive == PRIMITIVE_NONE) hits[j].t = INFINITY;
  }
}

void bvh_any(const struct bvh *bvh, const struct ray *rays, unsigned char *blocked, int n) {
  for (int j = 0; j < n; j++) {
    struct search search = search_new(bvh, &rays[j]);
    search_tree(&search, true);
    blocked[j] = search.best.primitive != PRIMITIVE_NONE;
  }
}
