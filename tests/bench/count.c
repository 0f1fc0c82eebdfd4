// The linker sends calls of bvh_closest and bvh_blockers here (--wrap); a batch costs one addition.
#include "tests/bench/count.h"

#include "bvh/bvh.h"

void __real_bvh_closest(const struct bvh *, const struct ray *, struct hit *, int n);
void __wrap_bvh_closest(const struct bvh *, const struct ray *, struct hit *, int n);

void __real_bvh_blockers(const struct bvh *, const struct ray *, const double *, const uint32_t *,
                         struct hit *, int n);
void __wrap_bvh_blockers(const struct bvh *, const struct ray *, const double *, const uint32_t *,
                         struct hit *, int n);

static _Thread_local int64_t counted;

void __wrap_bvh_closest(const struct bvh *bvh, const struct ray *rays, struct hit *hits, int n) {
  counted += n;
  __real_bvh_closest(bvh, rays, hits, n);
}

void __wrap_bvh_blockers(const struct bvh *bvh, const struct ray *rays, const double *distance,
                         const uint32_t *emitter, struct hit *hits, int n) {
  counted += n;
  __real_bvh_blockers(bvh, rays, distance, emitter, hits, n);
}

int64_t count_rays(void) {
  int64_t n = counted;
  counted = 0;
  return n;
}
