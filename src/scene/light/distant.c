// LightSource "distant": `L`, `scale`, `illuminance`, `point3 from`, `to` as pbrt-v4: the
// irradiance perpendicular to the light, which travels from `from` to `to`, is L (times the
// illuminance, if one is given). Photons start on the disc that the scene's bounding sphere fills,
// so each carries L pi R^2.
#include "scene/light/light.h"

struct distant {
  struct vec axis;        // of travel, unit length
  struct vec start, s, t; // centre of the disc and its axes, of length R
  double irradiance[3];   // perpendicular, W m^-2
};

// The disc touches the bounding sphere where the light comes from.
static double place_disc(const struct scene *scene, struct distant *distant) {
  struct vec centre;
  double radius = light_bounding_sphere(scene, &centre);
  distant->start = vec_along(centre, distant->axis, -radius);
  vec_basis(distant->axis, &distant->s, &distant->t);
  distant->s = vec_scale(distant->s, radius);
  distant->t = vec_scale(distant->t, radius);
  return radius;
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct distant *distant = arena_new(builder->arena, struct distant, 1);
  struct vec from;
  light_from_to(builder, params, &from, &distant->axis);
  light_spectrum(builder, params, "L", distant->irradiance);
  double total = light_total(params, "illuminance", 1);
  double radius = place_disc(builder->scene, distant);
  for (int c = 0; c < 3; c++) {
    distant->irradiance[c] *= total;
    light->power[c] = distant->irradiance[c] * light_pi * radius * radius;
  }
  light->data = distant;
  return light_finish(params, light);
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct distant *distant = light->data;
  double x, y;
  light_sample_disc(u[0], u[1], &x, &y);
  struct vec o = vec_along(vec_along(distant->start, distant->s, x), distant->t, y);
  out->ray = (struct ray){o, distant->axis, INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c];
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)p, (void)u;
  const struct distant *distant = light->data;
  *out = (struct light_sample){
      .wi = vec_scale(distant->axis, -1), .distance = INFINITY, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = distant->irradiance[c];
  return true;
}

static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  (void)scene, (void)p;
  const struct distant *distant = light->data;
  double cosine = -vec_dot(n, distant->axis);
  *out = (struct light_closed_form){.clear_radius = INFINITY};
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = cosine > 0 ? distant->irradiance[c] * cosine : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

const struct light_type light_distant = {
    .name = "distant",
    .about = "parallel light of perpendicular irradiance L",
    .delta = true,
    .at_infinity = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .closed_form = closed_form,
    .is_gray = light_is_gray,
};
