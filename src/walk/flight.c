#include "walk/flight.h"

#include "numeric/elementary.h"
#include "walk/dimension.h"

// Distance to the next collision of density `majorant`.
static double free_path(double u, double majorant) { return -num_log(1 - u) / majorant; }

// A tentative collision: real or not, each with the probability of its part of the majorant,
// channels weighted by what the path carries (Kutz et al. 2017), so that one that carries nothing
// has no say. True: it is real, and `weight` is throughput / (majorant * probability).
static bool collides(struct walk *walk, int j, const struct medium_point *at, double majorant,
                     double u, double weight[3]) {
  double real[3] = {0}, null[3] = {0};
  int n = walk->n_channels;
  for (int c = 0; c < n; c++) {
    double sigma_t = at->sigma_a[c] + at->sigma_s[c];
    real[c] = walk->throughput[c][j] * sigma_t;
    null[c] = walk->throughput[c][j] * (majorant - sigma_t);
  }
  double p_real = walk_largest(real, n), p_null = walk_largest(null, n);
  double p = p_real + p_null > 0 ? p_real / (p_real + p_null) : 1; // carries nothing at all
  if (u < p) {
    for (int c = 0; c < n; c++) weight[c] = walk->throughput[c][j] / (majorant * p);
    return true;
  }
  for (int c = 0; c < n; c++) walk->throughput[c][j] = null[c] / (majorant * (1 - p));
  return false;
}

static void random_pair(const struct walk *walk, uint64_t path, enum pair_between what, int vertex,
                        uint32_t *k, double *u0, double *u1) {
  rng_fill(walk->key, walk->iteration, &path, 1, pair_between(what, vertex, (*k)++), u0, u1);
}

static void fly(const struct walk *walk, int j, double t0, double t1) {
  if (walk->flown) walk->flown(walk->flown_data, walk, j, t0, t1);
}

// u: the numbers of the first collision; those of the others are drawn.
static void flight_from(struct walk *walk, int j, double u0, double u1) {
  const struct medium *medium = &walk->scene->medium[walk->medium[j]];
  const struct ray *ray = &walk->ray[j];
  struct collision *collision = &walk->collision[j];
  double end, majorant, t = 0, last = walk->hit[j].t;
  while (t < last && medium->type->piece(medium, ray, t, &end, &majorant)) {
    end = end < last ? end : last;
    double next = majorant > 0 ? t + free_path(u0, majorant) : INFINITY;
    if (!(next < end)) { // the flight is forgotten: where it begins anew does not matter
      fly(walk, j, t, end);
      t = end;
      if (majorant > 0 && t < last)
        random_pair(walk, walk->path[j], BETWEEN_FLIGHT, walk->vertex, &walk->flights[j], &u0, &u1);
      continue;
    }
    fly(walk, j, t, next);
    t = next;
    medium->type->at(medium, vec_along(ray->o, ray->d, t), &collision->at);
    if (collides(walk, j, &collision->at, majorant, u1, collision->weight)) {
      walk->hit[j] = (struct hit){t, PRIMITIVE_NONE};
      return;
    }
    random_pair(walk, walk->path[j], BETWEEN_FLIGHT, walk->vertex, &walk->flights[j], &u0, &u1);
  }
}

void flight_path(struct walk *walk, int j) {
  double u0, u1;
  if (walk->medium[j] == MEDIUM_NONE) return;
  if (walk->through) {
    walk->through(walk->through_data, walk, j);
    return;
  }
  random_pair(walk, walk->path[j], BETWEEN_FLIGHT, walk->vertex, &walk->flights[j], &u0, &u1);
  flight_from(walk, j, u0, u1);
}

void flight_all(struct walk *walk) {
  bool any = false;
  for (int j = 0; j < walk->n; j++) {
    walk->flights[j] = 0;
    any |= walk->medium[j] != MEDIUM_NONE;
  }
  if (!any) return;
  if (walk->through) {
    for (int j = 0; j < walk->n; j++) flight_path(walk, j);
    return;
  }
  walk_random(walk, 0, pair_between(BETWEEN_FLIGHT, walk->vertex, 0));
  for (int j = 0; j < walk->n; j++) {
    if (walk->medium[j] == MEDIUM_NONE) continue;
    walk->flights[j] = 1;
    flight_from(walk, j, walk->u[0][0][j], walk->u[0][1][j]);
  }
}

// emitted: the integral of emission T over the distance, (1 - T) emission / sigma_t.
static void attenuate_uniform(const struct medium *medium, int n_channels, double distance,
                              double value[3], double *emitted) {
  struct medium_point at;
  medium->type->at(medium, (struct vec){0}, &at);
  for (int c = 0; c < n_channels; c++) {
    double sigma_t = at.sigma_a[c] + at.sigma_s[c];
    if (!(sigma_t > 0)) continue; // what absorbs nothing emits nothing
    double left = num_exp(-sigma_t * distance);
    if (emitted) emitted[c] += value[c] * (1 - left) * at.emission[c] / sigma_t;
    value[c] *= left;
  }
}

// At a tentative collision, which stands for 1 / majorant of the ray.
static void attenuate_at(const struct medium_point *at, int n_channels, double majorant,
                         double value[3], double *emitted) {
  for (int c = 0; c < n_channels; c++) {
    if (emitted) emitted[c] += value[c] * at->emission[c] / majorant;
    value[c] *= 1 - (at->sigma_a[c] + at->sigma_s[c]) / majorant;
  }
}

void flight_along(const struct walk *walk, uint32_t row, const struct ray *ray, double distance,
                  uint64_t path, int vertex, uint32_t *flights, double value[3], double *emitted) {
  const struct medium *medium = &walk->scene->medium[row];
  if (medium->type->uniform) {
    attenuate_uniform(medium, walk->n_channels, distance, value, emitted);
    return;
  }
  double end, majorant, t = 0;
  while (t < distance && medium->type->piece(medium, ray, t, &end, &majorant)) {
    double u0, u1, next = INFINITY;
    end = end < distance ? end : distance;
    if (majorant > 0) {
      random_pair(walk, path, BETWEEN_SHADOW, vertex, flights, &u0, &u1);
      next = t + free_path(u0, majorant);
    }
    if (!(next < end)) {
      t = end;
      continue;
    }
    struct medium_point at;
    t = next;
    medium->type->at(medium, vec_along(ray->o, ray->d, t), &at);
    attenuate_at(&at, walk->n_channels, majorant, value, emitted);
  }
}

void flight_shadow(const struct walk *walk, uint32_t row, const struct ray *ray, double distance,
                   uint64_t path, int vertex, uint32_t *flights, double value[3]) {
  flight_along(walk, row, ray, distance, path, vertex, flights, value, NULL);
}
