#include "bvh/few.h"

static void run(const struct bvh *bvh, enum search_kind kind, struct queries queries) {
  if (bvh->few)
    SIMD_TABLE(few_level)->run[kind](bvh, &queries);
  else
    SIMD_TABLE(search_level)->run[kind](bvh, &queries);
}

void bvh_closest(const struct bvh *bvh, const struct ray *rays, struct hit *hits, int n) {
  run(bvh, SEARCH_CLOSEST, (struct queries){.ray = rays, .hit = hits, .n = n});
}

void bvh_any(const struct bvh *bvh, const struct ray *rays, unsigned char *blocked, int n) {
  run(bvh, SEARCH_ANY, (struct queries){.ray = rays, .blocked = blocked, .n = n});
}

void bvh_blockers(const struct bvh *bvh, const struct ray *rays, const double *distance,
                  const uint32_t *emitter, struct hit *hits, int n) {
  run(bvh, SEARCH_BLOCKER,
      (struct queries){.ray = rays, .distance = distance, .emitter = emitter, .hit = hits, .n = n});
}
