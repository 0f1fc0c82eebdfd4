#include "walk/eye.h"

#include "walk/dimension.h"

void eye_emitted(const struct scene *scene, const struct surface *surface, struct vec w,
                 double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = 0;
  uint32_t light = scene->shape[surface->shape].light;
  if (light == LIGHT_NONE) return;
  scene->light[light].type->radiance(scene, &scene->light[light], surface, w, rgb);
}

void eye_rays(struct walk *walk, const struct pixel *pixel, int n, bool footprint) {
  const struct camera *camera = &walk->scene->camera;
  const struct filter *filter = &walk->scene->filter;
  bool lens = camera->lens_radius > 0;
  walk->n = n;
  walk->vertex = 0;
  walk->transport = TRANSPORT_RADIANCE;
  if (footprint) walk_random(walk, 0, PAIR_PIXEL);
  if (lens) walk_random(walk, 1, PAIR_LENS);
  for (int j = 0; j < n; j++) {
    double offset[2] = {0, 0}, u[2];
    if (footprint)
      filter->type->sample(filter, (double[2]){walk->u[0][0][j], walk->u[0][1][j]}, offset);
    if (lens) u[0] = walk->u[1][0][j], u[1] = walk->u[1][1][j];
    double x = pixel[j].x + 0.5 + offset[0], y = pixel[j].y + 0.5 + offset[1];
    struct ray ray = camera_ray(camera, x, y, lens ? u : NULL);
    walk_start(walk, j, ray.o, ray.d, PRIMITIVE_NONE);
    if (walk->differential)
      walk->differential[j] = differential_of_camera(camera, x, y, lens ? u : NULL);
    walk->owner[j] = j;
    walk->pdf[j] = 0;
    if (walk->owed) walk->owed[j] = 1;
    walk->kind[j] = LIGHT_PATH_EMITTED;
    if (walk->medium) walk->medium[j] = walk->scene->camera_medium;
    for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] = 1;
  }
}

static void add_background(const struct walk *walk, struct eye_point *point) {
  const struct scene *scene = walk->scene;
  for (int j = 0; j < walk->n; j++) {
    if (!walk_escaped(walk, j)) continue;
    for (uint32_t k = 0; k < scene->n_infinite; k++) {
      const struct light *light = &scene->light[scene->infinite[k]];
      double rgb[3];
      light->type->background(scene, light, walk->ray[j].d, rgb);
      for (int c = 0; c < walk->n_channels; c++)
        point[walk->owner[j]].emitted[c] += walk->throughput[c][j] * rgb[c];
    }
  }
}

// The path ends here: `share` is the probability with which it does.
static void stop(const struct walk *walk, int j, const struct surface *surface,
                 const struct bsdf *bsdf, double share, struct eye_point *point) {
  point->hit = true;
  point->vertex = walk->vertex;
  point->medium = walk->medium ? walk->medium[j] : MEDIUM_NONE;
  point->p = surface->p;
  point->primitive = surface->primitive;
  point->bsdf = *bsdf;
  point->wo = vec_scale(walk->ray[j].d, -1);
  for (int c = 0; c < walk->n_channels; c++) point->weight[c] = walk->throughput[c][j] / share;
  if (!walk->differential) return;
  point->across = differential_across(&walk->differential[j]);
  point->footprint = differential_footprint(&walk->differential[j]);
}

// At a facet that emits nothing.
static void stop_at_facet(const struct walk *walk, int j, const struct shape *facet, int depth,
                          struct eye_point *point) {
  if (walk->vertex >= depth) return;
  point->hit = true;
  point->vertex = walk->vertex;
  point->medium = walk->medium ? walk->medium[j] : MEDIUM_NONE;
  point->p = walk_point(walk, j);
  point->primitive = walk->hit[j].primitive;
  walk_facet_bsdf(walk, j, facet, &point->bsdf);
  point->wo = vec_scale(walk->ray[j].d, -1);
  for (int c = 0; c < walk->n_channels; c++) point->weight[c] = walk->throughput[c][j];
}

// In a medium it ends at the first collision: what the medium scatters there stands for the ray.
static void stop_in_medium(const struct walk *walk, int j, int depth, struct eye_point *point) {
  const struct collision *collision = &walk->collision[j];
  for (int c = 0; c < walk->n_channels; c++)
    point->emitted[c] += collision->weight[c] * collision->at.emission[c];
  if (walk->vertex >= depth) return;
  point->hit = point->volume = true;
  point->vertex = walk->vertex;
  point->medium = walk->medium[j];
  point->p = walk_point(walk, j);
  point->primitive = PRIMITIVE_NONE;
  point->bsdf = medium_bsdf(&walk->scene->medium[walk->medium[j]]);
  point->wo = vec_scale(walk->ray[j].d, -1);
  for (int c = 0; c < walk->n_channels; c++)
    point->weight[c] = collision->weight[c] * collision->at.sigma_s[c];
}

// At a hit: add what it emits, then stop here or follow a delta lobe. True: the path goes on.
static bool meet(struct walk *walk, int j, int depth, struct eye_point *point) {
  if (walk_collided(walk, j)) {
    stop_in_medium(walk, j, depth, point);
    return false;
  }
  const struct shape *facet = walk_facet_shape(walk, j);
  if (facet && facet->light == LIGHT_NONE) {
    stop_at_facet(walk, j, facet, depth, point);
    return false;
  }
  struct surface surface;
  scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
  struct vec wo = vec_scale(walk->ray[j].d, -1);
  if (walk->differential)
    differential_transfer(&walk->differential[j], walk->from[j], walk->ray[j].d, &surface);
  double emitted[3];
  eye_emitted(walk->scene, &surface, wo, emitted);
  for (int c = 0; c < walk->n_channels; c++)
    point->emitted[c] += walk->throughput[c][j] * emitted[c];
  if (walk->vertex >= depth) return false;
  struct bsdf bsdf;
  walk_bsdf(walk, j, &surface, &bsdf);
  double delta = bsdf.type ? bsdf_delta_probability(&bsdf, wo, TRANSPORT_RADIANCE) : 0;
  if (delta > 0 && walk->u[1][0][j] < delta) return walk_scatter(walk, j, &surface, &bsdf);
  stop(walk, j, &surface, &bsdf, 1 - delta, point);
  return false;
}

static void trace_batch(struct walk *walk, int depth, struct eye_point *point) {
  for (; walk->n > 0 && walk->vertex <= depth; walk->vertex++) {
    walk_trace_through(walk);
    if (walk->features.background) add_background(walk, point);
    walk_drop_escaped(walk);
    if (walk->features.random_eye) walk_vertex_random(walk); // else no path goes on
    int alive = 0;
    for (int j = 0; j < walk->n; j++)
      if (meet(walk, j, depth, &point[walk->owner[j]])) walk_move(walk, alive++, j);
    walk->n = alive;
  }
}

// Most of a point means nothing without a bsdf.
static void point_clear(struct eye_point *point) {
  point->hit = point->volume = false;
  point->medium = MEDIUM_NONE;
  point->vertex = 0;
  point->primitive = PRIMITIVE_NONE;
  point->bsdf.type = NULL;
  for (int c = 0; c < 3; c++) point->emitted[c] = 0;
  point->across = point->footprint = 0;
}

void eye_trace(struct walk *walk, const struct pixel *pixel, int n, bool footprint, int depth,
               struct eye_point *point) {
  for (int first = 0; first < n; first += WALK_BATCH) {
    int batch = n - first < WALK_BATCH ? n - first : WALK_BATCH;
    for (int j = 0; j < batch; j++) {
      walk->path[j] = eye_path(&walk->scene->camera, pixel[first + j]);
      point_clear(&point[first + j]);
    }
    eye_rays(walk, pixel + first, batch, footprint);
    trace_batch(walk, depth, point + first);
  }
}
