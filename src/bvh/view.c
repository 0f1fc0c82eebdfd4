#include "bvh/view.h"

#include "scene/motion.h"

#include <string.h>

static bool any_moves(const struct scene *scene) {
  return scene->n_motions > 0 || scene->camera.animation.moves;
}

static void move(struct view *view, double share) {
  const struct camera *camera = &view->own->camera;
  view->share = share;
  if (any_moves(view->own))
    motion_set(view->own, (1 - share) * camera->shutter_open + share * camera->shutter_close);
  if (view->tree) bvh_refit(view->tree);
}

struct view view_new(const struct scene *scene, const struct bvh *bvh, bool moves,
                     struct arena *arena) {
  struct view view = {.scene = scene, .bvh = bvh};
  if (!moves && !any_moves(scene)) return view;
  view.scene = view.own = motion_copy(scene, arena);
  if (moves || scene->n_motions) {
    bool *shapes = arena_new(arena, bool, scene->n_shapes);
    for (uint32_t k = 0; k < scene->n_motions; k++)
      memset(shapes + scene->motion[k].shape, true, scene->motion[k].n_shapes * sizeof *shapes);
    view.bvh = view.tree = bvh_clone(bvh, view.own, scene->n_motions ? shapes : NULL, arena);
  }
  move(&view, 0);
  return view;
}

void view_set(struct view *view, double share) {
  if (view->own && share != view->share) move(view, share);
}
