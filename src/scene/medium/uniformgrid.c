// Medium "uniformgrid": samples of a density in a box, trilinear between them; nothing outside.
//   `integer nx`, `ny`, `nz`  samples along the axes, default 1
//   `float density`           [nx ny nz], x fastest; multiplies sigma_a and sigma_s
//   `point3 p0`, `p1`         the box's corners in the medium's space, default 0 0 0 and 1 1 1
//   `rgb sigma_a`, `rgb sigma_s`  default 1, times `float scale`; `float g`
//   `spectrum Le`             emitted radiance, times `float Lescale` [nx ny nz], default one
//                             sample of 1, which as in pbrt-v4 falls off to the faces
// Lengths are the world's: a transformation that enlarges the box leaves sigma_a as it is.
#include "scene/medium/coefficients.h"
#include "scene/medium/majorant.h"
#include "scene/medium/sampled_grid.h"

struct uniform_grid {
  struct medium_point point; // where density and Lescale are 1
  struct sampled_grid density, emitted;
  double densest, brightest; // the largest samples
  struct majorant majorant;
  struct transform world_from_unit;
};

enum { MOST_SAMPLES = 1 << 30 };

static bool read_resolution(struct params *params, int n[3]) {
  static const char *const names[] = {"nx", "ny", "nz"};
  int64_t total = 1;
  for (int i = 0; i < 3; i++) {
    int64_t count = params_integer(params, names[i], 1);
    if (count < 1) return params_complain(params, names[i], "\"%s\" must be at least 1", names[i]);
    if (count > MOST_SAMPLES / total)
      return params_complain(params, names[i], "the grid has more than 2^30 samples");
    total *= count;
    n[i] = (int)count;
  }
  return true;
}

static bool read_samples(struct scene_builder *builder, struct params *params, const char *name,
                         const int n[3], struct sampled_grid *grid) {
  ptrdiff_t count, expected = (ptrdiff_t)n[0] * n[1] * n[2];
  const double *number = params_array(params, "float", name, &count);
  if (params->problem->text[0]) return false;
  if (count != expected)
    return params_complain(params, name, "\"%s\" has %td samples, and nx * ny * nz is %td", name,
                           count, expected);
  float *value = arena_new(builder->arena, float, count);
  for (ptrdiff_t k = 0; k < count; k++) {
    value[k] = (float)number[k];
    if (!(value[k] >= 0 && value[k] < INFINITY))
      return params_complain(params, name, "\"%s\" must not be negative, and fit into floats",
                             name);
  }
  *grid = (struct sampled_grid){{n[0], n[1], n[2]}, value};
  return true;
}

static bool read_grids(struct scene_builder *builder, struct params *params,
                       struct uniform_grid *grid) {
  static const float one = 1;
  int n[3];
  if (!read_resolution(params, n)) return false;
  if (!input_is_given(params, "density"))
    return params_complain(params, "density", "\"float density\" is missing: nx * ny * nz samples");
  if (!read_samples(builder, params, "density", n, &grid->density)) return false;
  grid->emitted = (struct sampled_grid){{1, 1, 1}, &one};
  return !input_is_given(params, "Lescale") ||
         read_samples(builder, params, "Lescale", n, &grid->emitted);
}

// pbrt-v4 sorts the corners.
static bool read_box(struct scene_builder *builder, struct params *params,
                     struct uniform_grid *grid) {
  struct vec a = params_point3(params, "p0", vec(0, 0, 0)),
             b = params_point3(params, "p1", vec(1, 1, 1));
  struct vec lo = vec(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
  struct vec size = vec(fabs(b.x - a.x), fabs(b.y - a.y), fabs(b.z - a.z));
  struct transform *unit = &grid->majorant.unit_from_world;
  grid->world_from_unit =
      transform_multiply(builder->world_from_object,
                         transform_multiply(transform_translate(lo), transform_scale(size)));
  return (transform_invert(grid->world_from_unit, unit) && transform_is_finite(unit) &&
          majorant_is_invertible(unit)) ||
         params_complain(params, "p1", "the grid's box is flat, or nearly");
}

static double largest_sample(const struct sampled_grid *grid) {
  return sampled_grid_largest(grid, (double[]){0, 0, 0}, (double[]){1, 1, 1});
}

// Of sigma_t where the density is at most this: the factor is more than what is rounded between
// here and `at`, the sum more than what is lost to numbers near zero.
static double bound(const struct uniform_grid *grid, double density) {
  double sigma_t = medium_largest(&grid->point) * density;
  return sigma_t > 0 ? sigma_t * (1 + 0x1p-40) + 0x1p-1000 : 0;
}

static void build_majorant(struct scene_builder *builder, struct uniform_grid *grid) {
  struct majorant *majorant = &grid->majorant;
  int *n = majorant->n, k[3];
  for (int i = 0; i < 3; i++)
    n[i] = grid->density.n[i] < MAJORANT_CELLS ? grid->density.n[i] : MAJORANT_CELLS;
  double *value = arena_new(builder->arena, double, n[0] * n[1] * n[2]);
  majorant->value = value;
  majorant->most = bound(grid, grid->densest);
  for (k[2] = 0; k[2] < n[2]; k[2]++)
    for (k[1] = 0; k[1] < n[1]; k[1]++)
      for (k[0] = 0; k[0] < n[0]; k[0]++) {
        double lo[3], hi[3];
        for (int i = 0; i < 3; i++) {
          lo[i] = (k[i] - majorant_grown) / n[i];
          hi[i] = (k[i] + 1 + majorant_grown) / n[i];
        }
        *value++ = bound(grid, sampled_grid_largest(&grid->density, lo, hi));
      }
}

static void set(const struct uniform_grid *grid, double density, double emitted,
                struct medium_point *point) {
  for (int c = 0; c < 3; c++) {
    point->sigma_a[c] = grid->point.sigma_a[c] * density;
    point->sigma_s[c] = grid->point.sigma_s[c] * density;
    point->emission[c] = grid->point.emission[c] * density * emitted;
  }
}

static bool is_finite(const struct uniform_grid *grid) {
  struct medium_point most;
  set(grid, grid->densest, grid->brightest, &most);
  for (int c = 0; c < 3; c++)
    if (!isfinite(most.emission[c])) return false;
  return isfinite(grid->majorant.most);
}

static bool read(struct scene_builder *builder, struct params *params, struct medium *medium) {
  struct uniform_grid *grid = arena_new(builder->arena, struct uniform_grid, 1);
  if (input_is_given(params, "temperature"))
    return params_complain(params, "temperature", "\"temperature\" is not in this version; use Le");
  if (!medium_coefficients(builder, params, &grid->point)) return false;
  if (!medium_read(builder, params, medium, &grid->point)) return false;
  if (!read_grids(builder, params, grid) || !read_box(builder, params, grid)) return false;
  grid->densest = largest_sample(&grid->density);
  grid->brightest = largest_sample(&grid->emitted);
  build_majorant(builder, grid);
  medium->data = grid;
  return is_finite(grid) ||
         params_complain(params, "density", "the medium's coefficients are too large");
}

static void at(const struct medium *medium, struct vec p, struct medium_point *point) {
  const struct uniform_grid *grid = medium->data;
  struct vec u = transform_point(&grid->majorant.unit_from_world, p);
  if (!(u.x >= 0 && u.y >= 0 && u.z >= 0 && u.x <= 1 && u.y <= 1 && u.z <= 1)) {
    *point = (struct medium_point){0};
    return;
  }
  set(grid, sampled_grid_lookup(&grid->density, u), sampled_grid_lookup(&grid->emitted, u), point);
}

static void peak(const struct medium *medium, struct medium_point *point) {
  const struct uniform_grid *grid = medium->data;
  set(grid, grid->densest, grid->brightest, point);
}

static bool piece(const struct medium *medium, const struct ray *ray, double t, double *end,
                  double *majorant) {
  return majorant_piece(&((const struct uniform_grid *)medium->data)->majorant, ray, t, end,
                        majorant);
}

static bool is_gray(const struct medium *medium) {
  return medium_point_is_gray(&((const struct uniform_grid *)medium->data)->point);
}

static void say(const struct medium *medium, FILE *out) {
  const struct uniform_grid *grid = medium->data;
  const int *n = grid->density.n;
  struct vec lo = vec(INFINITY, INFINITY, INFINITY), hi = vec_scale(lo, -1);
  for (int k = 0; k < 8; k++) {
    struct vec p = transform_point(&grid->world_from_unit, vec(k & 1, k >> 1 & 1, k >> 2));
    lo = vec(p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z);
    hi = vec(p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z);
  }
  fprintf(out, "  %-12s %d x %d x %d samples up to %g, within %g %g %g to %g %g %g\n", "", n[0],
          n[1], n[2], grid->densest, lo.x, lo.y, lo.z, hi.x, hi.y, hi.z);
}

const struct medium_type medium_uniformgrid = {
    .name = "uniformgrid",
    .about = "a density on a grid, trilinear between its samples, nothing outside of its box",
    .read = read,
    .at = at,
    .piece = piece,
    .is_gray = is_gray,
    .peak = peak,
    .say = say,
};
