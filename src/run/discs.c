#include "run/discs.h"

#include "base/file.h"
#include "estimate/local.h"
#include "scene/camera.h"

#include <inttypes.h>
#include <math.h>

// The centre of a disc on the film, and its image's half-axes: differences of the projection, of a
// hundredth of the radius, so that a disc that reaches behind the camera has one too.
static void project(const struct camera_finder *finder, struct vec p, struct vec n, double radius,
                    double out[6]) {
  const double step = 0.01;
  struct vec axis[2];
  struct sight at, moved;
  vec_basis(n, &axis[0], &axis[1]);
  for (int k = 0; k < 6; k++) out[k] = NAN;
  if (!camera_find_point(finder, p, NULL, &at)) return;
  out[0] = at.x;
  out[1] = at.y;
  for (int k = 0; k < 2; k++) {
    struct vec near = vec_along(p, axis[k], step * radius);
    if (!camera_find_point(finder, near, NULL, &moved)) return;
    out[2 + 2 * k] = (moved.x - at.x) / step;
    out[3 + 2 * k] = (moved.y - at.y) / step;
  }
}

static bool write_one(const char *path, const struct local *local, int estimator,
                      const struct camera_finder *finder, struct problem *problem) {
  const struct measurement *measure = local->map->measure;
  struct file_out out;
  if (!file_begin(&out, path, problem)) return false;
  fputs("x,y,px,py,pz,nx,ny,nz,radius,u,v,u1,v1,u2,v2\n", out.stream);
  for (int j = 0; j < measure->n_points; j++) {
    const struct eye_point *point = &local->map->point[j];
    if (!point->bsdf.type) continue;
    struct vec n = point->volume ? point->wo : eye_normal(point); // of a ball: as it is seen
    double radius = local_radius(local, j, estimator), on_film[6];
    project(finder, point->p, n, radius, on_film);
    fprintf(out.stream, "%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", measure->pixel[j].x,
            measure->pixel[j].y, point->p.x, point->p.y, point->p.z, n.x, n.y, n.z, radius);
    for (int k = 0; k < 6; k++) fprintf(out.stream, ",%.9g", on_film[k]);
    fputc('\n', out.stream);
  }
  return file_commit(&out, problem);
}

static bool write_cells(const struct group_plan *group, const struct experiment *experiment,
                        const struct local *local, uint64_t i, const char *folder,
                        struct arena scratch, struct problem *problem) {
  struct camera_finder finder = camera_finder(&group->loaded->scene.camera);
  for (int e = 0; e < group->group->n_cells; e++) {
    const struct cell *cell = &experiment->cell[group->group->cell[e]];
    char *path = arena_format(&scratch, "%s/%s-cell%03d-%" PRIu64 ".csv", folder, cell->scene,
                              cell->number, i);
    if (!write_one(path, local, e, &finder, problem)) return false;
  }
  return true;
}

bool discs_write(const struct group_plan *group, const struct experiment *experiment,
                 const char *directory, struct arena scratch, struct problem *problem) {
  const struct cell *cell = group->cell;
  const struct integrator_type *integrator = cell->integrator;
  const char *folder = arena_format(&scratch, "%s/discs", directory);
  struct measurement own = group->measure, *measure = &own;
  own.keep_points = true;
  if (cell->n_discs == 0) return true;
  if (!file_make_directory(folder, problem)) return false;
  double *frame =
      arena_new(&scratch, double,
                (long)measure->n_estimators * measure->n_points * measure->features.n_channels);
  void *state = integrator->create(measure, &scratch);
  integrator->begin(state, 1);
  int next = 0;
  for (uint64_t i = 1; next < cell->n_discs; i++) {
    integrator->step(state, i, frame);
    if (cell->discs[next] != i) continue;
    next++;
    if (!write_cells(group, experiment, integrator->local(state), i, folder, scratch, problem))
      return false;
  }
  return true;
}
