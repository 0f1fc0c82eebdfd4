#include "walk/eye.h"

#include "walk/dimension.h"

void eye_emitted(const struct scene *scene, const struct surface *surface, struct vec w,
                 double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = 0;
  uint32_t light = scene->shape[surface->shape].light;
  if (light == LIGHT_NONE) return;
  scene->light[light].type->radiance(scene, &scene->light[light], surface, w, rgb);
}

void eye_rays(struct walk *walk, const struct camera *camera, const struct pixel *pixel, int n,
              bool footprint) {
  walk->n = n;
  walk->vertex = 0;
  if (footprint) walk_random(walk, 0, PAIR_PIXEL);
  for (int j = 0; j < n; j++) {
    double x = footprint ? walk->u[0][0][j] : 0.5, y = footprint ? walk->u[0][1][j] : 0.5;
    walk->ray[j] = camera_ray(camera, pixel[j].x + x, pixel[j].y + y);
    walk->owner[j] = j;
    walk->pdf[j] = 0;
    for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] = 1;
  }
}

static void eye_point_fill(const struct walk *walk, int j, struct eye_point *point) {
  point->surface = scene_surface(walk->scene, &walk->ray[j], walk->hit[j]);
  point->hit = true;
  point->wo = vec_scale(walk->ray[j].d, -1);
  struct vec ng = point->surface.ng;
  point->n = vec_dot(ng, point->wo) < 0 ? vec_scale(ng, -1) : ng;
  double emitted[3];
  eye_emitted(walk->scene, &point->surface, point->wo, emitted);
  for (int c = 0; c < walk->n_channels; c++) {
    point->weight[c] = walk->throughput[c][j];
    point->emitted[c] = walk->throughput[c][j] * emitted[c];
  }
}

void eye_trace(struct walk *walk, const struct camera *camera, const struct pixel *pixel, int n,
               bool footprint, struct eye_point *point) {
  for (int first = 0; first < n; first += WALK_BATCH) {
    int batch = n - first < WALK_BATCH ? n - first : WALK_BATCH;
    for (int j = 0; j < batch; j++) {
      walk->path[j] = eye_path(camera, pixel[first + j]);
      point[first + j] = (struct eye_point){0};
    }
    eye_rays(walk, camera, pixel + first, batch, footprint);
    walk_trace(walk);
    for (int j = 0; j < walk->n; j++) eye_point_fill(walk, j, &point[first + walk->owner[j]]);
  }
}
