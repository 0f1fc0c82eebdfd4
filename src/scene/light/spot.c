// LightSource "spot": `I` [W/sr], `scale`, `power`, `point3 from`, `to`, `float coneangle` 30,
// `float conedeltaangle` 5 (degrees) as pbrt-v4: intensity I within coneangle - conedeltaangle of
// the axis, nothing beyond coneangle, and a smoothstep of the cosine in between. With c1 and c0 the
// cosines of the two angles the flux is 2 pi I (1 - c0 + (c0 - c1) / 2), for the smoothstep's
// average is 1/2: a power P means that I is P over the factor. Photons are drawn in proportion to
// the intensity and all carry the same flux.
#include "scene/light/light.h"

struct spot {
  struct vec from, axis;
  double cos_end, sin_end, cos_start, sin_start; // of the outer and the inner angle
  double full, falloff;                          // 1 - c0, c0 - c1
  double intensity[3];                           // W/sr on the axis
};

// 3 t^2 - 2 t^3 for t from 0 at the outer to 1 at the inner angle.
static double profile(const struct spot *spot, double cosine) {
  if (cosine >= spot->cos_start) return 1;
  if (cosine <= spot->cos_end) return 0;
  double t = (cosine - spot->cos_end) / spot->falloff;
  return t * t * (3 - 2 * t);
}

static void read_angles(struct params *params, struct spot *spot) {
  double angle = params_float(params, "coneangle", 30);
  double delta = params_float(params, "conedeltaangle", 5);
  if (!(angle > 0 && angle <= 180))
    params_complain(params, "coneangle", "the cone's angle must be in (0, 180] degrees");
  else if (!(delta >= 0 && delta <= angle))
    params_complain(params, "conedeltaangle", "\"conedeltaangle\" must be in [0, coneangle]");
  double start = (angle - delta) / 360, end = angle / 360, half_start, half_end, cosine;
  num_sincos_turns(start, &spot->sin_start, &spot->cos_start);
  num_sincos_turns(end, &spot->sin_end, &spot->cos_end);
  num_sincos_turns(start / 2, &half_start, &cosine);
  num_sincos_turns(end / 2, &half_end, &cosine);
  // 1 - cos x = 2 sin^2 (x / 2): nothing cancels in narrow cones.
  spot->full = 2 * half_start * half_start;
  spot->falloff = 2 * (half_end - half_start) * (half_end + half_start);
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct spot *spot = arena_new(builder->arena, struct spot, 1);
  light_from_to(builder, params, &spot->from, &spot->axis);
  read_angles(params, spot);
  light_spectrum(builder, params, "I", spot->intensity);
  double solid_angle = 2 * light_pi * (spot->full + spot->falloff / 2); // weighted with the profile
  double total = light_total(params, "power", solid_angle);
  for (int c = 0; c < 3; c++) {
    spot->intensity[c] *= total;
    light->power[c] = solid_angle * spot->intensity[c];
  }
  light->data = spot;
  return light_finish(params, light);
}

// t with the density 2 (3 t^2 - 2 t^3): the root of 2 t^3 - t^4 = u by Newton's method. The
// function rises and is convex, and t = cbrt(u) lies above the root: the steps go down to it and
// end where rounding stops them.
static double sample_falloff(double u) {
  double t = num_cbrt(u);
  for (;;) {
    double slope = t * t * (6 - 4 * t), next = t - (t * t * t * (2 - t) - u) / slope;
    if (!(next < t)) return t;
    t = next;
  }
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct spot *spot = light->data;
  bool inside = u[0] * (spot->full + spot->falloff / 2) < spot->full;
  // h = 1 - cosine
  double h = inside ? u[2] * spot->full : spot->full + spot->falloff * (1 - sample_falloff(u[2]));
  double sine, cosine, radius = sqrt(h * (2 - h));
  num_sincos_turns(u[3], &sine, &cosine);
  struct vec s, t;
  vec_basis(spot->axis, &s, &t);
  struct vec d = vec_along(vec_scale(spot->axis, 1 - h), s, radius * cosine);
  out->ray = (struct ray){spot->from, vec_along(d, t, radius * sine), INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c];
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)u;
  const struct spot *spot = light->data;
  struct vec to_light = vec_sub(spot->from, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2);
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  double per_d2 = profile(spot, -vec_dot(wi, spot->axis)) / d2;
  if (!(per_d2 > 0)) return false;
  *out = (struct light_sample){.wi = wi, .distance = distance, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = spot->intensity[c] * per_d2;
  return true;
}

// From p, at `distance` from the apex and an angle (cosine, sine) from the axis, to the cone of
// another angle, in any plane at least.
static double distance_to_cone(double distance, double cosine, double sine, double cone_cosine,
                               double cone_sine) {
  bool beside = cosine * cone_cosine + sine * cone_sine > 0;
  return beside ? distance * fabs(sine * cone_cosine - cosine * cone_sine) : distance;
}

// The profile has kinks (of its second derivative) on the two cones.
static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  const struct spot *spot = light->data;
  struct vec v = vec_sub(p, spot->from);
  double distance = vec_length(v);
  if (!(distance > 0)) return false;
  double cosine = vec_dot(v, spot->axis) / distance;
  double sine = vec_length(vec_cross(v, spot->axis)) / distance;
  double inner = distance_to_cone(distance, cosine, sine, spot->cos_start, spot->sin_start);
  double outer = distance_to_cone(distance, cosine, sine, spot->cos_end, spot->sin_end);
  struct light_sample nee;
  double facing = sample(scene, light, p, NULL, &nee) ? vec_dot(n, nee.wi) : 0;
  out->clear_radius = inner < outer ? inner : outer;
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = facing > 0 ? nee.radiance_over_pdf[c] * facing : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

const struct light_type light_spot = {
    .name = "spot",
    .about = "a cone of intensity I with a smooth edge",
    .delta = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .closed_form = closed_form,
    .is_gray = light_is_gray,
};
