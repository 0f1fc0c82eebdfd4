// LightSource "infinite": `L` [W sr^-1 m^-2] from everywhere, or an image (`string filename`) in
// pbrt-v4's equal-area octahedral map; `scale`, `illuminance` as pbrt-v4. Light arrives from the
// direction whose texel it is, without interpolation, as in pbrt-v4; so one choice of texels in
// proportion to their mean radiance serves connections, photons and their density exactly. Photons
// start on a disc as large as the scene's bounding sphere, perpendicular to their direction: the
// flux is pi R^2 times the integral of the radiance over the sphere.
#include "scene/light/light.h"
#include "scene/octahedral.h"
#include "scene/texels.h"

struct infinite {
  struct vec axis[3];          // of the map, in world space
  double L[3];                 // radiance, or what multiplies the image
  const struct texels *texels; // NULL: constant
  bool gray;
  struct vec centre; // of the bounding sphere
  double radius;
};

// ---- reading ----

static double upward_cosine(const void *data, int x, int y) {
  const struct texels *texels = data;
  double z = octahedral_direction((x + 0.5) / texels->width, (y + 0.5) / texels->height).z;
  return z > 0 ? z : 0;
}

// The illuminance of a surface that faces the map's pole, as pbrt-v4 computes it: with 2 pi where
// the sphere has 4 pi, so that an illuminance E gives 2 E.
static double image_illuminance(const struct texels *texels) {
  double rgb[3], n = (double)texels->width * texels->height;
  texels_sum(texels, upward_cosine, texels, rgb);
  return light_luminance(rgb) * 2 * light_pi / n;
}

static bool read_image(struct scene_builder *builder, struct params *params,
                       struct infinite *infinite, double integral[3]) {
  struct texels *texels = arena_new(builder->arena, struct texels, 1);
  if (input_is_given(params, "L"))
    return params_complain(params, "L", "\"L\" and \"filename\" exclude each other");
  if (!texels_read(builder, params, texels)) return false;
  if (texels->width != texels->height)
    return params_complain(params, "filename",
                           "an equal-area map is square, and this image has %d x %d pixels",
                           texels->width, texels->height);
  if (!light_axes(builder, params, infinite->axis)) return false;
  texels_weigh(texels, NULL, NULL, builder->arena);
  double n = (double)texels->width * texels->height;
  double total = input_is_given(params, "illuminance")
                     ? light_total(params, "illuminance", image_illuminance(texels))
                     : 1;
  double scale = light_scale(params) * total;
  texels_sum(texels, NULL, NULL, integral);
  for (int c = 0; c < 3; c++) {
    infinite->L[c] = scale;
    integral[c] *= scale * 4 * light_pi / n;
  }
  infinite->texels = texels;
  infinite->gray = texels_are_gray(texels);
  return true;
}

static void read_constant(struct scene_builder *builder, struct params *params,
                          struct infinite *infinite, double integral[3]) {
  light_spectrum(builder, params, "L", infinite->L);
  double total = light_total(params, "illuminance", light_pi);
  for (int c = 0; c < 3; c++) {
    infinite->L[c] *= total;
    integral[c] = 4 * light_pi * infinite->L[c];
  }
  infinite->gray = infinite->L[0] == infinite->L[1] && infinite->L[1] == infinite->L[2];
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct infinite *infinite = arena_new(builder->arena, struct infinite, 1);
  double integral[3]; // of the radiance over the sphere
  if (input_is_given(params, "portal"))
    return params_complain(params, "portal", "portals are not in this version");
  infinite->radius = light_bounding_sphere(builder->scene, &infinite->centre);
  if (!input_is_given(params, "filename"))
    read_constant(builder, params, infinite, integral);
  else if (!read_image(builder, params, infinite, integral))
    return false;
  double disc = light_pi * infinite->radius * infinite->radius;
  for (int c = 0; c < 3; c++) light->power[c] = integral[c] * disc;
  light->data = infinite;
  return light_finish(params, light);
}

// ---- directions ----

// From the scene towards the light, its density, and the radiance that arrives from there.
struct arrival {
  struct vec wi;
  double pdf_solid_angle, radiance[3];
};

static void texel_radiance(const struct infinite *infinite, const struct texel *texel,
                           double rgb[3]) {
  texels_rgb(infinite->texels, texel->x, texel->y, rgb);
  for (int c = 0; c < 3; c++) rgb[c] *= infinite->L[c];
}

static double texel_pdf(const struct infinite *infinite, const struct texel *texel) {
  double n = (double)infinite->texels->width * infinite->texels->height;
  return texel->chance * n / (4 * light_pi);
}

static struct arrival sample_direction(const struct infinite *infinite, const double u[2]) {
  struct arrival out;
  if (!infinite->texels) {
    out.wi = light_sample_sphere(u[0], u[1]);
    out.pdf_solid_angle = 1 / (4 * light_pi);
    for (int c = 0; c < 3; c++) out.radiance[c] = infinite->L[c];
    return out;
  }
  struct texel texel = texels_choose(infinite->texels, u);
  out.wi = light_from_axes(infinite->axis, octahedral_direction(texel.u, texel.v));
  out.pdf_solid_angle = texel_pdf(infinite, &texel);
  texel_radiance(infinite, &texel, out.radiance);
  return out;
}

static struct texel find_texel(const struct infinite *infinite, struct vec d) {
  double u, v;
  octahedral_square(light_to_axes(infinite->axis, d), &u, &v);
  return texels_at(infinite->texels, u, v);
}

static void background(const struct scene *scene, const struct light *light, struct vec d,
                       double rgb[3]) {
  (void)scene;
  const struct infinite *infinite = light->data;
  if (infinite->texels) {
    struct texel texel = find_texel(infinite, d);
    texel_radiance(infinite, &texel, rgb);
    return;
  }
  for (int c = 0; c < 3; c++) rgb[c] = infinite->L[c];
}

static double pdf(const struct scene *scene, const struct light *light, struct vec p,
                  const struct surface *surface, struct vec wi) {
  (void)scene, (void)p, (void)surface;
  const struct infinite *infinite = light->data;
  if (!infinite->texels) return 1 / (4 * light_pi);
  struct texel texel = find_texel(infinite, wi);
  return texel_pdf(infinite, &texel);
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)p;
  struct arrival arrival = sample_direction(light->data, u);
  *out = (struct light_sample){.wi = arrival.wi,
                               .distance = INFINITY,
                               .pdf_solid_angle = arrival.pdf_solid_angle,
                               .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++)
    out->radiance_over_pdf[c] = arrival.radiance[c] / arrival.pdf_solid_angle;
  return true;
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct infinite *infinite = light->data;
  struct arrival arrival = sample_direction(infinite, u + 2);
  double x, y, R = infinite->radius;
  struct vec s, t;
  light_sample_disc(u[0], u[1], &x, &y);
  vec_basis(arrival.wi, &s, &t);
  struct vec o = vec_along(infinite->centre, arrival.wi, R);
  o = vec_along(vec_along(o, s, R * x), t, R * y);
  out->ray = (struct ray){o, vec_scale(arrival.wi, -1), INFINITY, PRIMITIVE_NONE};
  double over_pdf = light_pi * R * R / arrival.pdf_solid_angle;
  for (int c = 0; c < 3; c++) out->flux[c] = arrival.radiance[c] * over_pdf;
}

// ---- closed form: a constant lights any surface with pi L ----

static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  (void)scene, (void)p, (void)n;
  const struct infinite *infinite = light->data;
  if (infinite->texels) return false;
  out->clear_radius = INFINITY;
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = light_pi * infinite->L[c];
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

static bool is_gray(const struct light *light) {
  const struct infinite *infinite = light->data;
  return infinite->gray;
}

const struct light_type light_infinite = {
    .name = "infinite",
    .about = "radiance L from everywhere, or an image of it",
    .at_infinity = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = pdf,
    .background = background,
    .closed_form = closed_form,
    .is_gray = is_gray,
};
