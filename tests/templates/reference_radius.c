// A reference radius, here the distance of the point from the camera. The function goes into
// src/estimate/reference_radius.c above its table, the row at the end of the table; nothing else
// knows of it. An experiment says `reference-radius: distance` and counts its radii in it:
// `radius: 0.1` is then a tenth of that distance at i = 1.

// Scene units. No iteration's photons may change it, or its estimates are no longer independent.
// 0 or infinite: the point has no disc. k is the experiment's (`.nearest` below).
static double distance_at(struct radii *radii, const struct eye_point *point, int k) {
  (void)k;
  const struct camera *camera = &radii->map->walk->scene->camera; // at the iteration's time
  struct vec eye = transform_point(&camera->world_from_camera, vec(0, 0, 0));
  return vec_length(vec_sub(point->p, eye));
}

// The row: name, about, source, the function; and if so .differentials = true (point->across and
// ->footprint are wanted), .nearest = true (k is).
  {"distance", "the point's distance from the camera", "a template", .at = distance_at},
