// What the probes of a group see.
#include "run/plan.h"
#include "walk/eye.h"

#include <limits.h>

static void note_flight(void *data, const struct walk *walk, int j, double t0, double t1) {
  (void)walk, (void)j, (void)t0, (void)t1;
  *(bool *)data = true;
}

// Whether the ray flies through a medium before it ends: where a flight ends is random, but not
// whether there is one.
static bool sees_medium(struct walk *walk, struct pixel pixel) {
  struct eye_point point;
  bool seen = false;
  walk->flown = note_flight;
  walk->flown_data = &seen;
  eye_trace(walk, &pixel, 1, false, INT_MAX, &point);
  return seen;
}

// Only a ray that meets nothing at all, in a medium that is the same everywhere, never leaves it.
static bool never_leaves(const struct scene *scene, const struct bvh *bvh, struct pixel pixel) {
  struct ray ray = camera_ray(&scene->camera, pixel.x + 0.5, pixel.y + 0.5, NULL);
  struct hit hit;
  bvh_closest(bvh, &ray, &hit, 1);
  return hit.primitive == PRIMITIVE_NONE && scene->camera_medium != MEDIUM_NONE &&
         scene->medium[scene->camera_medium].type->uniform;
}

// The surface, past all media.
static void see_surface(struct walk *walk, struct pixel pixel, struct probe *probe) {
  struct eye_point point;
  eye_trace(walk, &pixel, 1, false, INT_MAX, &point);
  probe->hit = point.hit;
  if (!point.hit) return;
  probe->p = point.p;
  probe->n = eye_normal(&point);
  bsdf_value(&point.bsdf, point.wo, probe->n, TRANSPORT_RADIANCE, probe->scale_rgb);
  for (int c = 0; c < 3; c++) probe->scale_rgb[c] *= point.weight[c];
  probe->scale = luminance(probe->scale_rgb, 3);
  probe->emitted = luminance(point.emitted, 3);
}

void plan_probes(const struct group_plan *plan, struct probe *probe, struct arena scratch) {
  const struct scene *scene = &plan->loaded->scene;
  const struct bvh *bvh = plan->loaded->bvh;
  struct features all = scene_features(scene), clear = all;
  all.n_channels = clear.n_channels = 3;
  clear.media = false;
  struct walk *walk = walk_new(scene, bvh, clear, &scratch);
  struct walk *through = all.media ? walk_new(scene, bvh, all, &scratch) : NULL;
  for (int p = 0; p < plan->n_probes; p++) {
    struct pixel pixel = plan->probe_pixel[p];
    probe[p] = (struct probe){.x = pixel.x, .y = pixel.y, .reference = NAN, .reference_se = NAN};
    see_surface(walk, pixel, &probe[p]);
    if (!through) continue;
    probe[p].volume = sees_medium(through, pixel);
    probe[p].ends = probe[p].volume && !never_leaves(scene, bvh, pixel);
  }
}
