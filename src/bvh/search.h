// What every walk of the tree does where it arrives: the tests of triangle.h and clip.h on what a
// leaf holds, and what a hit means for what is asked.
#ifndef BVH_SEARCH_H
#define BVH_SEARCH_H

#include "base/simd.h"
#include "bvh/tree.h"
#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

// Coordinates and directions for which no product of the tests over- or underflows; search_one
// knows the others, too.
#define SEARCH_LARGEST 0x1p60
#define SEARCH_SMALLEST 0x1p-60

enum search_kind {
  SEARCH_CLOSEST,
  SEARCH_ANY,     // ends with the first hit
  SEARCH_BLOCKER, // ends with the first that bvh_blockers may answer
};

struct search {
  const struct ray *ray;
  struct hit best;  // hits before it are looked for
  uint32_t emitter; // SEARCH_BLOCKER
  bool found;       // best is a hit
};

// What is asked of ray j.
struct queries {
  const struct ray *ray;
  const double *distance;  // SEARCH_BLOCKER
  const uint32_t *emitter; // SEARCH_BLOCKER
  struct hit *hit;         // all but SEARCH_ANY
  unsigned char *blocked;  // SEARCH_ANY
  int n;
};

struct search_level {
  void (*run[3])(const struct bvh *, const struct queries *); // [enum search_kind]
};
SIMD_TABLES(search_level);

// One ray, in double: the plain walk, which is right for any ray and any tree.
void search_one(const struct bvh *, const struct queries *, int j, enum search_kind);

static inline void search_begin(struct search *s, const struct queries *q, int j,
                                enum search_kind kind) {
  s->ray = &q->ray[j];
  s->best = (struct hit){s->ray->t_max, PRIMITIVE_NONE};
  s->emitter = PRIMITIVE_NONE;
  s->found = false;
  if (kind != SEARCH_BLOCKER) return;
  s->best = (struct hit){q->distance[j], 0}; // no number is less: a hit at the distance is none
  s->emitter = q->emitter[j];
}

static inline void search_end(const struct search *s, const struct queries *q, int j,
                              enum search_kind kind) {
  if (kind == SEARCH_ANY)
    q->blocked[j] = s->found;
  else
    q->hit[j] = s->found ? s->best : (struct hit){INFINITY, PRIMITIVE_NONE};
}

static inline bool hit_is_before(double t, uint32_t primitive, const struct hit *other) {
  return t < other->t || (t == other->t && primitive < other->primitive);
}

static inline bool emitter_is_before(const struct bvh *bvh, struct search *s) {
  if (s->emitter == PRIMITIVE_NONE) return false;
  const struct scene *scene = bvh->scene;
  const struct shape *shape = &scene->shape[scene->shape_of[s->emitter]];
  double t;
  if (!shape->type->intersect(scene, shape, s->emitter, s->ray, &t)) return false;
  if (!hit_is_before(t, s->emitter, &s->best)) return false;
  s->best = (struct hit){t, s->emitter};
  return true;
}

// Takes a hit before the best. True: the search is over. A blocker is one only if the emitter is
// not hit before it; the emitter's own hit bounds the search like any other.
static inline bool search_keep(const struct bvh *bvh, struct search *s, enum search_kind kind,
                               double t, uint32_t primitive) {
  bool emitter_met = s->found;
  s->best = (struct hit){t, primitive};
  s->found = true;
  if (kind == SEARCH_CLOSEST) return false;
  if (kind == SEARCH_ANY) return true;
  if (primitive == s->emitter) return false;
  return emitter_met || !emitter_is_before(bvh, s);
}

// A triangle that the edge functions accept, met by its plane at t.
static inline bool search_triangle(const struct bvh *bvh, struct search *s, enum search_kind kind,
                                   const struct cone *cone, const struct bvh_block *block, int lane,
                                   double t) {
  uint32_t primitive = block->primitive[lane];
  if (primitive == s->ray->leaving) return false;
  float vertex[3][3];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) vertex[i][k] = block->vertex[i][k][lane];
  struct box box = triangle_box((const float(*)[3])vertex);
  if (!clip_accept(cone, &box, s->ray->t_max, &t)) return false;
  if (!hit_is_before(t, primitive, &s->best)) return false;
  if (s->ray->leaving != PRIMITIVE_NONE &&
      triangle_is_left_behind(bvh->scene, s->ray, (const float(*)[3])vertex))
    return false;
  return search_keep(bvh, s, kind, t, primitive);
}

static inline bool other_hit(const struct scene *scene, const struct bvh_other *other,
                             const struct ray *ray, const struct cone *cone, double *t) {
  const struct shape *shape = &scene->shape[scene->shape_of[other->primitive]];
  bool leaving = ray->leaving == other->primitive;
  if (shape->type->intersect == sphere_intersect)
    return sphere_hit(shape_quadric(scene, shape, other->primitive), &other->box, cone, ray,
                      leaving, t);
  if (shape->type->intersect == disk_intersect)
    return !leaving &&
           disk_hit(shape_quadric(scene, shape, other->primitive), &other->box, cone, ray, t);
  return shape->type->intersect(scene, shape, other->primitive, ray, t);
}

static inline bool search_other(const struct bvh *bvh, struct search *s, enum search_kind kind,
                                const struct cone *cone, const struct bvh_other *other) {
  double t;
  return other_hit(bvh->scene, other, s->ray, cone, &t) &&
         hit_is_before(t, other->primitive, &s->best) &&
         search_keep(bvh, s, kind, t, other->primitive);
}

#endif
