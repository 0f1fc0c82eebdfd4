// triangle_accepts, triangle_plane and clip_accept in the lanes of several rays, triangles in their
// order, so that of equal t the smaller number stays. Rays whose largest |d| is of one axis share a
// packet: their shear is along it. Of those with another axis parallel (clip.h), or of extreme
// coordinates, search_one knows what to do.
#include "bvh/few.h"

#include "numeric/lanes.h"

enum { MOST = 4096 }; // rays that are sorted at once

// LANES rays.
struct packet {
  double o[3][LANES], d[3][LANES], t_max[LANES], limit[LANES];
  uint64_t unmet[LANES];
};

// What the tests want of them.
struct cones {
  lanes o[3], d[3], along_x, along_y, near_scale[3], far_scale[3], t_max;
};

// ---- rays ----
static inline int axis_of(const struct ray *ray) {
  double x = cone_abs(ray->d.x), y = cone_abs(ray->d.y), z = cone_abs(ray->d.z);
  int axis = x > y ? 0 : 1; // as shear_set
  double largest = axis ? y : x;
  if (z > largest) axis = 2, largest = z;
  double w = CLIP_APERTURE * largest;
  bool small = cone_abs(ray->o.x) <= SEARCH_LARGEST && cone_abs(ray->o.y) <= SEARCH_LARGEST &&
               cone_abs(ray->o.z) <= SEARCH_LARGEST && largest >= SEARCH_SMALLEST &&
               largest <= SEARCH_LARGEST;
  return small && x > w && y > w && z > w ? axis : -1;
}

static inline uint64_t unmet_of(const struct few *few, const struct ray *ray) {
  if (ray->leaving == PRIMITIVE_NONE) return 0;
  const double *n = few->triangle[ray->leaving].n;
  double side = vec_dot(vec(n[0], n[1], n[2]), ray->d);
  return few->unmet[ray->leaving][side > 0 ? FEW_FORWARD : side < 0 ? FEW_BACKWARD : FEW_ALONG];
}

static inline void packet_set(struct packet *packet, int lane, const struct few *few,
                              const struct queries *q, int j, enum search_kind kind) {
  const struct ray *ray = &q->ray[j];
  packet->o[0][lane] = ray->o.x, packet->o[1][lane] = ray->o.y, packet->o[2][lane] = ray->o.z;
  packet->d[0][lane] = ray->d.x, packet->d[1][lane] = ray->d.y, packet->d[2][lane] = ray->d.z;
  packet->t_max[lane] = ray->t_max;
  packet->limit[lane] = kind == SEARCH_BLOCKER ? q->distance[j] : ray->t_max;
  packet->unmet[lane] = unmet_of(few, ray);
}

static inline __attribute__((always_inline)) void
cones_set(struct cones *cones, const struct packet *packet, int x, int y, int z) {
  for (int k = 0; k < 3; k++) {
    cones->o[k] = lanes_load(packet->o[k]);
    cones->d[k] = lanes_load(packet->d[k]);
  }
  cones->along_x = cones->d[x] / cones->d[z];
  cones->along_y = cones->d[y] / cones->d[z];
  lanes zero = {0}, w = CLIP_APERTURE * lanes_max(cones->d[z], -cones->d[z]);
  for (int k = 0; k < 3; k++) {
    lanes side = lanes_choose(lanes_less(cones->d[k], zero), -w, w);
    cones->near_scale[k] = 1 / (cones->d[k] + side);
    cones->far_scale[k] = 1 / (cones->d[k] - side);
  }
  cones->t_max = lanes_load(packet->t_max);
}

// ---- a triangle ----
static inline __attribute__((always_inline)) lanes_some
accepts(const struct cones *c, const struct few_triangle *triangle, int x, int y, int z) {
  lanes at_x[3], at_y[3], zero = {0};
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    lanes at_z = triangle->vertex[i][z] - c->o[z];
    at_x[i] = (triangle->vertex[i][x] - c->o[x]) - c->along_x * at_z;
    at_y[i] = (triangle->vertex[i][y] - c->o[y]) - c->along_y * at_z;
  }
  lanes e0 = at_x[1] * at_y[2] - at_y[1] * at_x[2];
  lanes e1 = at_x[2] * at_y[0] - at_y[2] * at_x[0];
  lanes e2 = at_x[0] * at_y[1] - at_y[0] * at_x[1];
  lanes low = lanes_min(lanes_min(e0, e1), e2), high = lanes_max(lanes_max(e0, e1), e2);
  return lanes_or(lanes_at_most(zero, low), lanes_at_most(high, zero));
}

// t = above / below of the triangle's plane. Returns where that may be positive.
static inline __attribute__((always_inline)) lanes_some
ahead(const struct cones *c, const struct few_triangle *triangle, lanes *above, lanes *below) {
  const double *n = triangle->n, *p = triangle->vertex[0];
  lanes zero = {0};
  *above = n[0] * (p[0] - c->o[0]) + n[1] * (p[1] - c->o[1]) + n[2] * (p[2] - c->o[2]);
  *below = n[0] * c->d[0] + n[1] * c->d[1] + n[2] * c->d[2];
  return lanes_alike(lanes_less(zero, *above), lanes_less(zero, *below));
}

// Where this t is a hit, as it is within the clip of the triangle's box.
static inline __attribute__((always_inline)) lanes_some
clip(const struct cones *c, const struct few_triangle *triangle, lanes *t) {
  lanes near = {0}, far = near + INFINITY, zero = {0};
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    lanes lo = triangle->lo[k] - c->o[k], hi = triangle->hi[k] - c->o[k];
    // The product of the face by which the axis is entered is the smaller: rounding is monotone.
    near = lanes_max(lanes_min(lo * c->near_scale[k], hi * c->near_scale[k]), near);
    far = lanes_min(lanes_max(lo * c->far_scale[k], hi * c->far_scale[k]), far);
  }
  lanes_some finite = lanes_and(lanes_less(zero, *t), lanes_less(*t, zero + INFINITY));
  lanes_some clipped = lanes_and(finite, lanes_at_most(near, far));
  *t = lanes_min(far, lanes_max(near, *t));
  return lanes_and(clipped, lanes_and(lanes_less(zero, *t), lanes_less(*t, c->t_max)));
}

// The closest hits before the limits: best, and their numbers in `which`, -1 where there are none.
static inline __attribute__((always_inline)) void test_all(const struct few *few,
                                                           const struct packet *packet, int x,
                                                           int y, int z, lanes *best,
                                                           lanes *which) {
  struct cones cones;
  cones_set(&cones, packet, x, y, z);
  *best = lanes_load(packet->limit);
  *which = lanes_set(-1);
  for (int k = 0; k < few->n; k++) {
    lanes_some hit =
        lanes_and(accepts(&cones, &few->triangle[k], x, y, z), lanes_without_bit(packet->unmet, k));
    if (lanes_count(hit) == 0) continue;
    lanes above, below, t;
    hit = lanes_and(hit, ahead(&cones, &few->triangle[k], &above, &below));
    if (lanes_count(hit) == 0) continue;
    t = above / below;
    hit = lanes_and(hit, clip(&cones, &few->triangle[k], &t));
    hit = lanes_and(hit, lanes_less(t, *best));
    *best = lanes_choose(hit, t, *best);
    *which = lanes_choose(hit, lanes_set(k), *which);
  }
}

static inline void answer(const struct queries *q, enum search_kind kind, int j, double t,
                          double which) {
  if (kind == SEARCH_ANY)
    q->blocked[j] = which >= 0;
  else
    q->hit[j] =
        which >= 0 ? (struct hit){t, (uint32_t)which} : (struct hit){INFINITY, PRIMITIVE_NONE};
}

// The rays of one list, LANES at a time; the last packet repeats its last ray.
static inline __attribute__((always_inline)) void run_axis(const struct few *few,
                                                           const struct queries *q,
                                                           enum search_kind kind, const int *list,
                                                           int n, int x, int y, int z) {
  for (int first = 0; first < n; first += LANES) {
    struct packet packet;
    lanes best, which;
    for (int lane = 0; lane < LANES; lane++) {
      int at = first + lane < n ? first + lane : n - 1;
      packet_set(&packet, lane, few, q, list[at], kind);
    }
    test_all(few, &packet, x, y, z, &best, &which);
    for (int lane = 0; lane < LANES && first + lane < n; lane++)
      answer(q, kind, list[first + lane], best[lane], which[lane]);
  }
}

static inline __attribute__((always_inline)) void
run(const struct bvh *bvh, const struct queries *q, enum search_kind kind) {
  int list[3][MOST];
  for (int first = 0; first < q->n; first += MOST) {
    int count[3] = {0}, end = q->n - first < MOST ? q->n : first + MOST;
    for (int j = first; j < end; j++) {
      int axis = axis_of(&q->ray[j]);
      if (axis < 0)
        search_one(bvh, q, j, kind);
      else
        list[axis][count[axis]++] = j;
    }
    run_axis(bvh->few, q, kind, list[0], count[0], 1, 2, 0);
    run_axis(bvh->few, q, kind, list[1], count[1], 2, 0, 1);
    run_axis(bvh->few, q, kind, list[2], count[2], 0, 1, 2);
  }
}

static void closest(const struct bvh *bvh, const struct queries *q) { run(bvh, q, SEARCH_CLOSEST); }
static void any(const struct bvh *bvh, const struct queries *q) { run(bvh, q, SEARCH_ANY); }
static void blocker(const struct bvh *bvh, const struct queries *q) { run(bvh, q, SEARCH_BLOCKER); }

const struct few_level SIMD_NAME(few_level) = {{closest, any, blocker}};
