#include "analysis/expected_radius.h"

#include "analysis/local_radius.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// The light of a probe as the box kernel sees it: its estimate is the mean density in a disc.
struct light_in_disc {
  double r1;
  struct profile profile;
};

static bool find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                 double r1, struct arena scratch, struct light_in_disc *light) {
  struct ring_mean ring;
  if (cell->footprint) return false; // the first disc is anywhere in the pixel
  if (!ring_mean_find(scene, cell, probe, r1, scratch, &ring)) return false;
  if (!(ring.flux > 0)) return false; // a black surface: nothing tells its photons
  *light = (struct light_in_disc){r1, profile_new(&ring, kernel_find("box"), r1)};
  return true;
}

static double fraction(const void *of, double s) {
  const struct light_in_disc *light = of;
  double r = light->r1 * sqrt(s);
  return pi * r * r * profile_moment(&light->profile, 1, r) / light->profile.flux;
}

bool expected_radius(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                     double r1, int power, uint64_t n, double *moment, struct arena scratch) {
  struct light_in_disc light;
  if (!cell->law->count || cell->alpha == 0) return false;
  if (!find(scene, cell, probe, r1, scratch, &light)) return false;
  const struct local_radius local = {cell->law, cell->alpha, (double)cell->photons, fraction,
                                     &light};
  local_radius_moment(&local, power, n, moment, scratch);
  return true;
}

double expected_first_disc(const struct scene *scene, const struct cell *cell,
                           const struct probe *probe, double r1, struct arena scratch) {
  struct light_in_disc light;
  if (!find(scene, cell, probe, r1, scratch, &light)) return NAN;
  return (double)cell->photons * fraction(&light, 1);
}
