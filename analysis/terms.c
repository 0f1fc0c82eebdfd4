#include "analysis/terms.h"

#include "analysis/pairs.h"
#include "walk/light_path.h"

#include <math.h>

static bool scatters_alike(const struct medium *medium) {
  return medium->type->uniform && medium->type->is_gray(medium) && medium->g == 0;
}

// Of points; a second photon needs a second collision, where its light is indirect. Two beams of
// one path cross the same ray near each other as seldom as r^2 ln r: less than a constant in the
// variance, but for the logarithm.
static double pairs_of(const struct scene *scene, const struct cell *cell,
                       const struct probe *probe) {
  double radius = probe_radius(cell, probe), sigma_s = 0;
  if (cell->depth < 2 || (cell->left_out & LIGHT_PATH_INDIRECT)) return 0;
  for (uint32_t k = 0; k < scene->n_media; k++) {
    struct medium_point at;
    if (scene->n_media > 1 || !scatters_alike(&scene->medium[k])) return NAN;
    scene->medium[k].type->at(&scene->medium[k], (struct vec){0}, &at);
    sigma_s = at.sigma_s[0];
  }
  return 2 * sigma_s * radius * pairs_constant(cell->kernel);
}

struct terms terms_of(const struct scene *scene, const struct cell *cell,
                      const struct probe *probe) {
  struct terms terms = {.d = probe_dimension(cell, probe)};
  if (!probe->volume) return terms;
  terms.ends = probe->ends;
  if (terms.d == 3) terms.pairs = pairs_of(scene, cell, probe);
  return terms;
}
