#include "walk/connect.h"

#include "walk/flight.h"
#include "walk/light.h"

// The light's share in the balance heuristic.
static double light_share(const struct connection *from, const struct light *light,
                          const struct light_sample *sample) {
  double by_light = sample->pdf_solid_angle * light->probability;
  double by_material = bsdf_pdf(from->bsdf, from->wo, sample->wi, TRANSPORT_RADIANCE);
  return by_light / (by_light + by_material);
}

// One light sample; false if it contributes nothing. value[c] is without visibility.
static bool sample_light(const struct walk *walk, const struct connection *from, double u_light,
                         const double u[2], bool mis, struct light_sample *sample,
                         double value[3]) {
  const struct scene *scene = walk->scene;
  const struct light *light = light_choose(scene, u_light);
  if (!light->type->sample(scene, light, from->p, u, sample)) return false;
  double f[3], cosine = bsdf_cosine(from->bsdf, sample->wi);
  bsdf_value(from->bsdf, from->wo, sample->wi, TRANSPORT_RADIANCE, f);
  double weight = mis && sample->pdf_solid_angle > 0 ? light_share(from, light, sample) : 1;
  bool any = false;
  for (int c = 0; c < walk->n_channels; c++) {
    value[c] = from->weight[c] * f[c] * cosine * sample->radiance_over_pdf[c] / light->probability *
               weight;
    any = any || value[c] != 0;
  }
  return any;
}

void connect_begin(struct walk *walk) { walk->shadow.n = 0; }

static void add_ray(struct walk *walk, const struct ray *ray, double distance, uint32_t emitter,
                    const double value[3], int owner) {
  struct shadow *shadow = &walk->shadow;
  int k = shadow->n++;
  shadow->ray[k] = *ray;
  shadow->distance[k] = distance;
  shadow->emitter[k] = emitter;
  shadow->owner[k] = owner;
  for (int c = 0; c < walk->n_channels; c++) shadow->value[c][k] = value[c];
}

void connect_ray(struct walk *walk, const struct ray *ray, double distance, const double value[3],
                 int owner) {
  add_ray(walk, ray, distance, PRIMITIVE_NONE, value, owner);
}

// The medium in which the last shadow ray begins.
static void begin_shadow(struct walk *walk, const struct connection *from, struct vec wi) {
  struct shadow *shadow = &walk->shadow;
  int k = shadow->n - 1;
  shadow->path[k] = from->path;
  shadow->flights[k] = 0;
  shadow->medium[k] = from->medium;
  if (from->primitive == PRIMITIVE_NONE) return;
  struct surface surface = {.ng = from->bsdf->ng, .shape = walk->scene->shape_of[from->primitive]};
  shadow->medium[k] = surface_medium(walk->scene, &surface, wi, from->medium);
}

void connect_add(struct walk *walk, const struct connection *from, double u_light,
                 const double u[2], bool mis) {
  struct light_sample sample;
  double value[3];
  if (walk->scene->n_lights == 0) return;
  if (!sample_light(walk, from, u_light, u, mis, &sample, value)) return;
  // Rounding may put the emitter a little before or behind the distance: search to the end.
  struct ray ray = {from->p, sample.wi, INFINITY, from->primitive};
  add_ray(walk, &ray, sample.distance, sample.primitive, value, from->owner);
  if (walk->medium) begin_shadow(walk, from, sample.wi);
}

// A shadow ray sees the sampled point iff nothing is hit before it. The emitter itself ends the
// ray, at the same t up to rounding: what counts is that the primitive is the sampled one, met from
// the same side.
static bool sees(const struct scene *scene, const struct ray *ray, struct hit hit, double distance,
                 uint32_t emitter) {
  if (hit.t >= distance) return true;
  if (hit.primitive != emitter) return false;
  const struct shape *shape = &scene->shape[scene->shape_of[emitter]];
  if (shape->type->flat) return true;
  struct vec there = vec_along(ray->o, ray->d, distance);
  struct surface here;
  scene_surface(scene, ray, hit, &here);
  struct vec ng_there = shape->type->normal(scene, shape, emitter, there);
  return (vec_dot(here.ng, ray->d) < 0) == (vec_dot(ng_there, ray->d) < 0);
}

static void move_shadow(struct walk *walk, int to, int from) {
  struct shadow *shadow = &walk->shadow;
  shadow->ray[to] = shadow->ray[from];
  shadow->distance[to] = shadow->distance[from];
  shadow->emitter[to] = shadow->emitter[from];
  shadow->owner[to] = shadow->owner[from];
  for (int c = 0; c < walk->n_channels; c++) shadow->value[c][to] = shadow->value[c][from];
  if (!walk->medium) return;
  shadow->medium[to] = shadow->medium[from];
  shadow->flights[to] = shadow->flights[from];
  shadow->path[to] = shadow->path[from];
}

// What the medium leaves of shadow ray k after `distance`.
static void attenuate(struct walk *walk, int k, double distance) {
  struct shadow *shadow = &walk->shadow;
  if (!walk->medium || shadow->medium[k] == MEDIUM_NONE) return;
  double value[3];
  for (int c = 0; c < walk->n_channels; c++) value[c] = shadow->value[c][k];
  flight_shadow(walk, shadow->medium[k], &shadow->ray[k], distance, shadow->path[k], walk->vertex,
                &shadow->flights[k], value);
  for (int c = 0; c < walk->n_channels; c++) shadow->value[c][k] = value[c];
}

// A see-through surface before the light: attenuates shadow ray k and sends it on. False: opaque
// here.
static bool pass(struct walk *walk, int k) {
  struct shadow *shadow = &walk->shadow;
  if (!walk_meets_see_through(walk->scene, shadow->hit[k])) return false;
  struct surface surface;
  scene_surface(walk->scene, &shadow->ray[k], shadow->hit[k], &surface);
  double passed = 1 - surface_opacity(walk->scene, &surface);
  if (!(passed > 0)) return false;
  for (int c = 0; c < walk->n_channels; c++) shadow->value[c][k] *= passed;
  attenuate(walk, k, shadow->hit[k].t);
  if (walk->medium && scene_material(walk->scene, &surface)->type->passed)
    shadow->medium[k] = surface_medium(walk->scene, &surface, shadow->ray[k].d, shadow->medium[k]);
  shadow->distance[k] -= shadow->hit[k].t;
  shadow->ray[k] = walk_ray_beyond(&surface, &shadow->ray[k]);
  return true;
}

void connect_finish(struct walk *walk, double *sum) {
  struct shadow *shadow = &walk->shadow;
  while (shadow->n > 0) {
    if (walk->features.see_through) // what is in the way may let light pass: which comes first?
      bvh_closest(walk->bvh, shadow->ray, shadow->hit, shadow->n);
    else
      bvh_blockers(walk->bvh, shadow->ray, shadow->distance, shadow->emitter, shadow->hit,
                   shadow->n);
    int left = 0;
    for (int k = 0; k < shadow->n; k++) {
      if (sees(walk->scene, &shadow->ray[k], shadow->hit[k], shadow->distance[k],
               shadow->emitter[k])) {
        attenuate(walk, k, shadow->distance[k]);
        for (int c = 0; c < walk->n_channels; c++)
          sum[shadow->owner[k] * walk->n_channels + c] += shadow->value[c][k];
      } else if (walk->features.see_through && pass(walk, k)) {
        move_shadow(walk, left++, k);
      }
    }
    shadow->n = left;
  }
}

static double material_share(const struct light *light, double by_light, double pdf) {
  return pdf / (pdf + by_light * light->probability);
}

double connect_mis_weight(const struct scene *scene, const struct surface *emitter, struct vec p,
                          struct vec wi, double pdf) {
  const struct light *light = &scene->light[scene->shape[emitter->shape].light];
  return material_share(light, light->type->pdf(scene, light, p, emitter, wi), pdf);
}

double connect_mis_weight_background(const struct scene *scene, const struct light *light,
                                     struct vec p, struct vec wi, double pdf) {
  return material_share(light, light->type->pdf(scene, light, p, NULL, wi), pdf);
}
