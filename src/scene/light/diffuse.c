// AreaLightSource "diffuse": `rgb L` [W sr^-1 m^-2], `scale`, `bool twosided`, `float power` as
// pbrt-v4: radiance L leaves the side of the geometric normal (n.w >= 0), or both sides. pbrt's
// shape is our primitive, so a `power` P [W] is what each primitive emits: L = P / (pi A), A its
// own area (half of it if two-sided), for each unit of `rgb L`. Primitives are chosen in proportion
// to their power: where the shape's samples are uniform every photon carries the same flux, and
// radiance / pdf_area is the same everywhere.
#include "scene/light/light.h"

struct diffuse {
  const struct shape *shape;
  bool two_sided;
  bool by_power; // each primitive emits the same power, else the same radiance
  double L[3];   // radiance; by_power: times the area of the primitive
  double *cdf;   // [shape->count + 1] of the choice of a primitive, relative to the last entry
};

static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  return shape->type->area(scene, shape, primitive);
}

// Of the points that the shape samples, relative to the mean.
static double density(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                      struct vec p) {
  return shape->type->density ? shape->type->density(scene, shape, primitive, p) : 1;
}

// What a primitive weighs in the choice. One without area never emits.
static double weight(const struct scene *scene, const struct diffuse *diffuse, uint32_t primitive) {
  double a = area(scene, diffuse->shape, primitive);
  return diffuse->by_power && a > 0 ? 1 : a;
}

static void build_cdf(const struct scene *scene, struct diffuse *diffuse, struct arena *arena) {
  const struct shape *shape = diffuse->shape;
  diffuse->cdf = arena_new(arena, double, (ptrdiff_t)shape->count + 1);
  for (uint32_t k = 0; k < shape->count; k++)
    diffuse->cdf[k + 1] = diffuse->cdf[k] + weight(scene, diffuse, shape->first + k);
}

static double cdf_total(const struct diffuse *diffuse) {
  return diffuse->cdf[diffuse->shape->count];
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct diffuse *diffuse = arena_new(builder->arena, struct diffuse, 1);
  diffuse->shape = builder->shape;
  diffuse->two_sided = params_bool(params, "twosided", false);
  diffuse->by_power = light_given(params, "float", "power");
  light_spectrum(builder, params, "L", diffuse->L);
  double sides = diffuse->two_sided ? 2 : 1;
  double total = light_total(params, "power", sides * light_pi);
  build_cdf(builder->scene, diffuse, builder->arena);
  if (!(cdf_total(diffuse) > 0)) params_complain(params, "L", "the emitter has no area");
  for (int c = 0; c < 3; c++) {
    diffuse->L[c] *= total;
    light->power[c] = sides * light_pi * diffuse->L[c] * cdf_total(diffuse);
  }
  light->data = diffuse;
  return light_finish(params, light);
}

static void primitive_radiance(const struct scene *scene, const struct diffuse *diffuse,
                               uint32_t primitive, double rgb[3]) {
  double divisor = diffuse->by_power ? area(scene, diffuse->shape, primitive) : 1;
  for (int c = 0; c < 3; c++) rgb[c] = diffuse->L[c] / divisor;
}

static double pdf_area(const struct scene *scene, const struct diffuse *diffuse, uint32_t primitive,
                       struct vec p) {
  double a = diffuse->by_power ? area(scene, diffuse->shape, primitive) : 1;
  return density(scene, diffuse->shape, primitive, p) / (a * cdf_total(diffuse));
}

// The primitive k with cdf[k] <= x < cdf[k + 1]: bisection keeps both true.
static uint32_t choose(const struct diffuse *diffuse, double x) {
  uint32_t lo = 0, hi = diffuse->shape->count;
  while (hi - lo > 1) {
    uint32_t middle = lo + (hi - lo) / 2;
    if (diffuse->cdf[middle] <= x)
      lo = middle;
    else
      hi = middle;
  }
  return lo;
}

// A point of the emitter; u0 is used twice: which primitive, and its remainder within that one. The
// remainder stays below 1: x and cdf[k + 1] differ by an ulp at least, and so do both differences.
static uint32_t sample_point(const struct scene *scene, const struct diffuse *diffuse, double u0,
                             double u1, struct vec *p, struct vec *ng) {
  double x = u0 * cdf_total(diffuse);
  uint32_t k = choose(diffuse, x), primitive = diffuse->shape->first + k;
  double rest = (x - diffuse->cdf[k]) / (diffuse->cdf[k + 1] - diffuse->cdf[k]);
  diffuse->shape->type->sample(scene, diffuse->shape, primitive, rest, u1, p, ng);
  return primitive;
}

// Two sides: the first bit of u[2] is the side, the rest the direction.
static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  const struct diffuse *diffuse = light->data;
  struct vec p, n;
  uint32_t primitive = sample_point(scene, diffuse, u[0], u[1], &p, &n);
  double u2 = u[2];
  if (diffuse->two_sided) {
    bool back = u2 >= 0.5;
    u2 = 2 * u2 - back;
    if (back) n = vec_scale(n, -1);
  }
  out->ray = (struct ray){p, light_sample_cosine(n, u2, u[3]), INFINITY, primitive};
  double relative = density(scene, diffuse->shape, primitive, p);
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c] / relative;
}

// The cosine at the emitter, 0 where it does not shine.
static double emitted_cosine(const struct diffuse *diffuse, struct vec n, struct vec w) {
  double cosine = vec_dot(n, w);
  return diffuse->two_sided ? fabs(cosine) : (cosine > 0 ? cosine : 0);
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  const struct diffuse *diffuse = light->data;
  struct vec q, n;
  uint32_t primitive = sample_point(scene, diffuse, u[0], u[1], &q, &n);
  struct vec to_light = vec_sub(q, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2);
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  double cosine = emitted_cosine(diffuse, n, vec_scale(wi, -1));
  if (!(cosine > 0)) return false;
  double pdf = pdf_area(scene, diffuse, primitive, q) * d2 / cosine, radiance[3];
  primitive_radiance(scene, diffuse, primitive, radiance);
  *out = (struct light_sample){
      .wi = wi, .distance = distance, .pdf_solid_angle = pdf, .primitive = primitive};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = radiance[c] / pdf;
  return true;
}

static double pdf(const struct scene *scene, const struct light *light, struct vec p,
                  const struct surface *surface, struct vec wi) {
  const struct diffuse *diffuse = light->data;
  double cosine = emitted_cosine(diffuse, surface->ng, vec_scale(wi, -1));
  if (!(cosine > 0)) return 0; // as `sample`, which never gives this point
  struct vec v = vec_sub(surface->p, p);
  return pdf_area(scene, diffuse, surface->primitive, surface->p) * vec_dot(v, v) / cosine;
}

static void radiance(const struct scene *scene, const struct light *light,
                     const struct surface *surface, struct vec w, double rgb[3]) {
  const struct diffuse *diffuse = light->data;
  rgb[0] = rgb[1] = rgb[2] = 0;
  if (diffuse->two_sided || vec_dot(surface->ng, w) >= 0)
    primitive_radiance(scene, diffuse, surface->primitive, rgb);
}

// ---- closed form: a disc above a plane parallel to it (theory 5 vi) ----

struct disc {
  struct vec centre, n; // n on the side of the geometric normal
  double radius;
};

// Deviations from a full circle, or from parallel, of 1e-12 (a thousand roundings of a rotated
// matrix) change the irradiance by as much relative to L: nothing a measurement resolves.
static const double round_off = 1e-12;

static bool is_disc(const struct scene *scene, const struct shape *shape, struct disc *disc) {
  if (strcmp(shape->type->name, "disk")) return false;
  const struct quadric *quadric = &scene->quadric[shape->local];
  const struct transform *to_world = &quadric->world_from_object;
  struct vec s = transform_direction(to_world, vec(quadric->radius, 0, 0));
  struct vec t = transform_direction(to_world, vec(0, quadric->radius, 0));
  double r2 = vec_dot(s, s), full = light_pi * r2;
  disc->centre = transform_point(to_world, vec(0, 0, quadric->height));
  disc->n = shape->type->normal(scene, shape, shape->first, disc->centre);
  disc->radius = sqrt(r2);
  return fabs(vec_dot(t, t) - r2) <= round_off * r2 && fabs(vec_dot(s, t)) <= round_off * r2 &&
         fabs(area(scene, shape, shape->first) - full) <= round_off * full;
}

// E / (pi L) = (1 - u / sqrt D) / 2 with u = rho^2 + h^2 - R^2 and D = u^2 + 4 h^2 R^2, which is
// where the cancellation for u > 0 has been multiplied out.
static double form_factor(double rho2, double h2, double r2) {
  double u = rho2 + h2 - r2, root = sqrt(u * u + 4 * h2 * r2);
  return u > 0 ? 2 * h2 * r2 / (root * (root + u)) : (1 - u / root) / 2;
}

static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  const struct diffuse *diffuse = light->data;
  struct disc disc;
  if (!is_disc(scene, diffuse->shape, &disc)) return false;
  if (vec_length(vec_cross(disc.n, n)) > round_off) return false;
  struct vec v = vec_sub(p, disc.centre);
  double h = vec_dot(v, disc.n);
  if (h == 0) return false; // the plane of the disc: E is the emitter's edge
  struct vec across = vec_along(v, disc.n, -h);
  bool lit = h * vec_dot(n, disc.n) < 0 && (h > 0 || diffuse->two_sided);
  double factor = form_factor(vec_dot(across, across), h * h, disc.radius * disc.radius), L[3];
  primitive_radiance(scene, diffuse, diffuse->shape->first, L);
  out->clear_radius = INFINITY;
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = lit ? light_pi * L[c] * factor : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

const struct light_type light_diffuse = {
    .name = "diffuse",
    .about = "a shape that emits the radiance L, from one side or both",
    .area = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = pdf,
    .radiance = radiance,
    .closed_form = closed_form,
    .is_gray = light_is_gray,
};
