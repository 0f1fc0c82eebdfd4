// AreaLightSource "diffuse": `L` [W sr^-1 m^-2] or an image (`string filename`), `scale`, `bool
// twosided`, `float power` as pbrt-v4: radiance L leaves the side of the geometric normal (n.w >=
// 0), or both sides. pbrt's shape is our primitive, so a `power` P [W] is what each primitive
// emits: L = P / (pi A), A its own area (half of it if two-sided), for each unit of `L` or of the
// image's mean luminance. Primitives are chosen in proportion to their power: where the shape's
// samples are uniform and L is no image, every photon carries the same flux, and radiance /
// pdf_area is the same everywhere. An image is looked up at uv, v upwards, between texels, as in
// pbrt-v4.
// Where alpha lets rays pass, alpha L is emitted. As in pbrt-v4 a shape whose alpha is the constant
// 0 emits all of L and is never hit, and one of material "interface" emits nothing.
#include "scene/light/light.h"
#include "scene/texels.h"

struct diffuse {
  const struct shape *shape;
  bool two_sided;
  bool by_power;  // each primitive emits the same power, else the same radiance
  bool invisible; // no ray hits it
  bool gray;
  double L[3];     // radiance, or what multiplies the image; by_power: times the primitive's area
  double per_area; // pdf of a point where all are alike
  double *cdf;     // [shape->count + 1] of the choice of a primitive, relative to the last entry
  const struct texels *texels; // or NULL
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

// The mean over the image; 1 without one.
static bool read_image(struct scene_builder *builder, struct params *params,
                       struct diffuse *diffuse, double mean[3]) {
  for (int c = 0; c < 3; c++) mean[c] = 1;
  if (!input_is_given(params, "filename")) return true;
  struct texels *texels = arena_new(builder->arena, struct texels, 1);
  if (input_is_given(params, "L"))
    return params_complain(params, "L", "\"L\" and \"filename\" exclude each other");
  if (!texels_read(builder, params, texels)) return false;
  texels_sum(texels, NULL, NULL, mean);
  for (int c = 0; c < 3; c++) mean[c] /= (double)texels->width * texels->height;
  diffuse->texels = texels;
  builder->shape->detailed = true;
  return true;
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct diffuse *diffuse = arena_new(builder->arena, struct diffuse, 1);
  const struct shape *shape = diffuse->shape = builder->shape;
  double mean[3];
  if (!read_image(builder, params, diffuse, mean)) return false;
  diffuse->two_sided = params_bool(params, "twosided", false);
  diffuse->by_power = light_given(params, "float", "power");
  diffuse->invisible = shape->alpha && !shape->alpha->texture && shape->alpha->value[0] <= 0;
  light_spectrum(builder, params, "L", diffuse->L);
  double sides = diffuse->two_sided ? 2 : 1;
  double total = light_total(params, "power", sides * light_pi * light_luminance(mean));
  bool dark = builder->scene->material[shape->material].type->passed;
  double alpha =
      shape->alpha && !shape->alpha->texture && !diffuse->invisible ? shape->alpha->value[0] : 1;
  build_cdf(builder->scene, diffuse, builder->arena);
  diffuse->per_area = 1 / cdf_total(diffuse);
  if (!(cdf_total(diffuse) > 0)) params_complain(params, "L", "the emitter has no area");
  for (int c = 0; c < 3; c++) {
    diffuse->L[c] *= dark ? 0 : total;
    light->power[c] = sides * light_pi * diffuse->L[c] * mean[c] * alpha * cdf_total(diffuse);
  }
  diffuse->gray = light_is_gray(light) && (!diffuse->texels || texels_are_gray(diffuse->texels));
  light->data = diffuse;
  return light_finish(params, light);
}

// What leaves a point of the emitter, alpha left out.
static void point_radiance(const struct scene *scene, const struct diffuse *diffuse,
                           const struct surface *at, double rgb[3]) {
  for (int c = 0; c < 3; c++) rgb[c] = diffuse->L[c];
  if (diffuse->by_power) {
    double divisor = area(scene, diffuse->shape, at->primitive);
    for (int c = 0; c < 3; c++) rgb[c] /= divisor;
  }
  if (!diffuse->texels) return;
  double texel[3];
  texels_between(diffuse->texels, at->uv[0], 1 - at->uv[1], texel);
  for (int c = 0; c < 3; c++) rgb[c] *= texel[c];
}

static double opacity(const struct diffuse *diffuse, const struct surface *at) {
  if (!diffuse->shape->alpha || diffuse->invisible) return 1;
  double alpha = input_float(diffuse->shape->alpha, at);
  return alpha > 1 ? 1 : alpha > 0 ? alpha : 0;
}

static double pdf_area(const struct scene *scene, const struct diffuse *diffuse,
                       const struct surface *at) {
  if (!diffuse->by_power && !diffuse->shape->type->density) return diffuse->per_area;
  double a = diffuse->by_power ? area(scene, diffuse->shape, at->primitive) : 1;
  return density(scene, diffuse->shape, at->primitive, at->p) / (a * cdf_total(diffuse));
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
static void sample_point(const struct scene *scene, const struct diffuse *diffuse, double u0,
                         double u1, struct surface *at) {
  const struct shape *shape = diffuse->shape;
  double x = u0 * cdf_total(diffuse);
  uint32_t k = choose(diffuse, x);
  double rest = (x - diffuse->cdf[k]) / (diffuse->cdf[k + 1] - diffuse->cdf[k]);
  at->primitive = shape->first + k;
  at->shape = (uint32_t)(shape - scene->shape);
  shape->type->sample(scene, shape, at->primitive, rest, u1, &at->p, &at->ng);
  if (!shape->detailed) return; // nobody asks for more
  at->ns = at->ng;
  at->dpdu = vec(0, 0, 0);
  at->uv[0] = at->uv[1] = 0;
  shape->type->detail(scene, shape, at);
}

// Pi times the radiance over the density of its point, both sides counted. Without an image and
// alpha that is the power over the relative density.
static void emitted_flux(const struct scene *scene, const struct light *light,
                         const struct surface *at, double flux[3]) {
  const struct diffuse *diffuse = light->data;
  if (!diffuse->texels && !diffuse->shape->alpha) {
    double relative = density(scene, diffuse->shape, at->primitive, at->p);
    for (int c = 0; c < 3; c++) flux[c] = light->power[c] / relative;
    return;
  }
  double factor =
      (diffuse->two_sided ? 2 : 1) * light_pi * opacity(diffuse, at) / pdf_area(scene, diffuse, at);
  point_radiance(scene, diffuse, at, flux);
  for (int c = 0; c < 3; c++) flux[c] *= factor;
}

// Two sides: the first bit of u[2] is the side, the rest the direction.
static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  const struct diffuse *diffuse = light->data;
  struct surface at;
  sample_point(scene, diffuse, u[0], u[1], &at);
  struct vec n = at.ng;
  double u2 = u[2];
  if (diffuse->two_sided) {
    bool back = u2 >= 0.5;
    u2 = 2 * u2 - back;
    if (back) n = vec_scale(n, -1);
  }
  out->ray = (struct ray){at.p, light_sample_cosine(n, u2, u[3]), INFINITY, at.primitive};
  emitted_flux(scene, light, &at, out->flux);
}

// The cosine at the emitter, 0 where it does not shine.
static double emitted_cosine(const struct diffuse *diffuse, struct vec n, struct vec w) {
  double cosine = vec_dot(n, w);
  return diffuse->two_sided ? fabs(cosine) : (cosine > 0 ? cosine : 0);
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  const struct diffuse *diffuse = light->data;
  struct surface at;
  sample_point(scene, diffuse, u[0], u[1], &at);
  struct vec to_light = vec_sub(at.p, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2);
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  double cosine = emitted_cosine(diffuse, at.ng, vec_scale(wi, -1));
  if (!(cosine > 0)) return false;
  double pdf = pdf_area(scene, diffuse, &at) * d2 / cosine, radiance[3];
  double over_pdf = opacity(diffuse, &at) / pdf;
  point_radiance(scene, diffuse, &at, radiance);
  out->wi = wi;
  out->distance = distance;
  out->pdf_solid_angle = diffuse->invisible ? 0 : pdf;
  out->primitive = at.primitive;
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = radiance[c] * over_pdf;
  return true;
}

// As `sample`, which never gives a point that does not shine towards p.
static double pdf(const struct scene *scene, const struct light *light, struct vec p,
                  const struct surface *surface, struct vec wi) {
  const struct diffuse *diffuse = light->data;
  double cosine = emitted_cosine(diffuse, surface->ng, vec_scale(wi, -1));
  if (!(cosine > 0) || diffuse->invisible) return 0;
  struct vec v = vec_sub(surface->p, p);
  return pdf_area(scene, diffuse, surface) * vec_dot(v, v) / cosine;
}

static void radiance(const struct scene *scene, const struct light *light,
                     const struct surface *surface, struct vec w, double rgb[3]) {
  const struct diffuse *diffuse = light->data;
  rgb[0] = rgb[1] = rgb[2] = 0;
  if (diffuse->two_sided || vec_dot(surface->ng, w) >= 0)
    point_radiance(scene, diffuse, surface, rgb);
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
  if (diffuse->texels || diffuse->shape->alpha) return false;
  if (!is_disc(scene, diffuse->shape, &disc)) return false;
  if (vec_length(vec_cross(disc.n, n)) > round_off) return false;
  struct vec v = vec_sub(p, disc.centre);
  double h = vec_dot(v, disc.n);
  if (h == 0) return false; // the plane of the disc: E is the emitter's edge
  struct vec across = vec_along(v, disc.n, -h);
  bool lit = h * vec_dot(n, disc.n) < 0 && (h > 0 || diffuse->two_sided);
  double factor = form_factor(vec_dot(across, across), h * h, disc.radius * disc.radius), L[3];
  struct surface any = {.primitive = diffuse->shape->first};
  point_radiance(scene, diffuse, &any, L);
  out->clear_radius = INFINITY;
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = lit ? light_pi * L[c] * factor : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

static bool is_gray(const struct light *light) {
  const struct diffuse *diffuse = light->data;
  return diffuse->gray;
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
    .is_gray = is_gray,
};
