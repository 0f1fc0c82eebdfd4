// LightSource "point": `point3 from`, `I` [W/sr], `scale`, `power` as pbrt-v4: the irradiance
// at distance d is I cos / d^2, and a power P [W] means I = P / (4 pi) for each unit of `I`.
// Ours: `"string emission" "lambertian"` with `point3 to`. Intensity I cos(theta) around the axis
// from `from` to `to`, nothing behind: `rgb I` is the peak, the flux is P = pi I, so I = P / pi.
// Over a plane at distance h this is theory 5 (ii): cos^4 and zero-bias ring at h / sqrt 2
// (isotropic: cos^3, ring at h sqrt(2/3)).
#include "scene/light/light.h"

struct point {
  struct vec from, axis;
  bool lambertian;
  double intensity[3]; // W/sr, at the peak
};

static double profile(const struct point *point, struct vec direction) {
  if (!point->lambertian) return 1;
  double cosine = vec_dot(point->axis, direction);
  return cosine > 0 ? cosine : 0;
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct point *point = arena_new(builder->arena, struct point, 1);
  const char *emission = params_string(params, "emission", "isotropic");
  point->lambertian = !strcmp(emission, "lambertian");
  if (!point->lambertian && strcmp(emission, "isotropic"))
    params_complain(params, "emission",
                    "\"emission\" is \"isotropic\" or \"lambertian\", not \"%s\"", emission);
  if (point->lambertian)
    light_from_to(builder, params, &point->from, &point->axis);
  else
    point->from =
        transform_point(&builder->world_from_object, params_point3(params, "from", vec(0, 0, 0)));
  double solid_angle = point->lambertian ? light_pi : 4 * light_pi; // weighted with the profile
  light_spectrum(builder, params, "I", point->intensity);
  double total = light_total(params, "power", solid_angle);
  for (int c = 0; c < 3; c++) {
    point->intensity[c] *= total;
    light->power[c] = solid_angle * point->intensity[c];
  }
  light->data = point;
  return light_finish(params, light);
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct point *point = light->data;
  struct vec d = point->lambertian ? light_sample_cosine(point->axis, u[2], u[3])
                                   : light_sample_sphere(u[2], u[3]);
  out->ray = (struct ray){point->from, d, INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c];
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)u;
  const struct point *point = light->data;
  struct vec to_light = vec_sub(point->from, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2);
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  double per_d2 = profile(point, vec_scale(wi, -1)) / d2;
  if (!(per_d2 > 0)) return false;
  *out = (struct light_sample){.wi = wi, .distance = distance, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = point->intensity[c] * per_d2;
  return true;
}

// A Lambertian light's profile has a kink where the receiver crosses the plane behind which it is
// dark; everything else about a plane that does not contain the light is smooth.
static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  const struct point *point = light->data;
  struct light_sample nee;
  bool lit = sample(scene, light, p, NULL, &nee);
  double cosine = lit ? vec_dot(n, nee.wi) : 0;
  double height = vec_dot(vec_sub(p, point->from), point->axis);
  *out = (struct light_closed_form){.clear_radius = INFINITY};
  if (point->lambertian) out->clear_radius = light_distance_in_plane(height, point->axis, n);
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = cosine > 0 ? nee.radiance_over_pdf[c] * cosine : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

const struct light_type light_point = {
    .name = "point",
    .about = "a point of intensity I, isotropic or (ours) Lambertian",
    .delta = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .closed_form = closed_form,
    .is_gray = light_is_gray,
};
