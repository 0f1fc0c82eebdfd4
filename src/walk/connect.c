#include "walk/connect.h"

#include "walk/dimension.h"
#include "walk/light.h"

// One light sample; false if it contributes nothing. value[c] is without visibility.
static bool sample_light(const struct walk *walk, const struct connection *from,
                         const double u_light, const double u[2], bool mis,
                         struct light_sample *sample, double value[3]) {
  const struct scene *scene = walk->scene;
  const struct light *light = light_choose(scene, u_light);
  if (!light->type->sample(scene, light, from->surface.p, u, sample)) return false;
  const struct material *material = scene_material(scene, &from->surface);
  double f[3], cosine = fabs(vec_dot(sample->wi, from->surface.ng)), weight = 1;
  material->type->value(material, &from->surface, from->wo, sample->wi, f);
  if (mis && !light->type->delta) {
    double by_light = sample->pdf_solid_angle * light->probability;
    double by_material = material->type->pdf(material, &from->surface, from->wo, sample->wi);
    weight = by_light / (by_light + by_material);
  }
  bool any = false;
  for (int c = 0; c < walk->n_channels; c++) {
    value[c] = from->weight[c] * f[c] * cosine * sample->radiance_over_pdf[c] / light->probability *
               weight;
    any = any || value[c] != 0;
  }
  return any;
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
  struct vec ng_hit = scene_surface(scene, ray, hit).ng;
  struct vec ng_there = shape->type->normal(scene, shape, emitter, there);
  return (vec_dot(ng_hit, ray->d) < 0) == (vec_dot(ng_there, ray->d) < 0);
}

static void random_pairs(struct walk *walk, const struct connection *from, int n, int vertex) {
  for (int j = 0; j < n; j++) walk->shadow.path[j] = from[j].path;
  for (int k = 0; k < 2; k++)
    rng_fill(walk->key, walk->iteration, walk->shadow.path, n,
             pair_of_vertex(vertex, k == 0 ? VERTEX_LIGHT : VERTEX_EMITTER), walk->u[2 + k][0],
             walk->u[2 + k][1]);
}

// Light samples that may contribute, packed into the shadow batch.
static int shadow_rays(struct walk *walk, const struct connection *from, int n, bool mis) {
  struct shadow *shadow = &walk->shadow;
  int rays = 0;
  for (int j = 0; j < n; j++) {
    struct light_sample sample;
    double value[3], u[2] = {walk->u[3][0][j], walk->u[3][1][j]};
    if (!sample_light(walk, &from[j], walk->u[2][0][j], u, mis, &sample, value)) continue;
    // Rounding may put the emitter a little before or behind the distance: search to the end.
    shadow->ray[rays] =
        (struct ray){from[j].surface.p, sample.wi, INFINITY, from[j].surface.primitive};
    shadow->distance[rays] = sample.distance;
    shadow->emitter[rays] = sample.primitive;
    shadow->owner[rays] = from[j].owner;
    for (int c = 0; c < walk->n_channels; c++) shadow->value[c][rays] = value[c];
    rays++;
  }
  return rays;
}

void connect_lights(struct walk *walk, const struct connection *from, int n, int vertex, bool mis,
                    double *sum) {
  if (walk->scene->n_lights == 0) return;
  struct shadow *shadow = &walk->shadow;
  random_pairs(walk, from, n, vertex);
  int rays = shadow_rays(walk, from, n, mis);
  bvh_closest(walk->bvh, shadow->ray, shadow->hit, rays);
  for (int j = 0; j < rays; j++) {
    if (!sees(walk->scene, &shadow->ray[j], shadow->hit[j], shadow->distance[j],
              shadow->emitter[j]))
      continue;
    for (int c = 0; c < walk->n_channels; c++)
      sum[shadow->owner[j] * walk->n_channels + c] += shadow->value[c][j];
  }
}

double connect_mis_weight(const struct scene *scene, const struct surface *emitter, struct vec p,
                          struct vec wi, double pdf) {
  const struct light *light = &scene->light[scene->shape[emitter->shape].light];
  double by_light = light->type->pdf(scene, light, p, emitter, wi) * light->probability;
  return pdf / (pdf + by_light);
}
