// LightSource "beam" (ours): parallel photons of total power Phi [W] from the plane through `from`
// perpendicular to the axis `from` -> `to`, with a profile whose Laplacian is known (theory 5 i,
// iii):
//   `rgb power` or `float power`  Phi, default 1, times `float scale`
//   `string profile`  irradiance on a plane perpendicular to the axis, rho the distance from it:
//     "uniform"    `float radius` a       Phi / (pi a^2) for rho < a
//     "quadratic"  `float radius` a       2 Phi / (pi a^2) (1 - rho^2 / a^2) for rho < a
//     "gaussian"   `float sigma` s        Phi / (2 pi s^2) exp(-rho^2 / (2 s^2)), not truncated
//     "cosine"     `float radius` a       E0 (1 + m cos(2 pi x / wavelength)) in the square
//                  `float wavelength`     |x|, |y| < a; E0 = Phi / (4 a^2 (1 + m sinc(kappa a))),
//                  `float contrast` m     kappa = 2 pi / wavelength; wavelength is required, m = 1
//                  `vector3 across`       the direction of x (its part perpendicular to the axis);
//                                         default 1 0 0
//     "slab"       `float radius` a       3 Phi / (4 a w) (1 - y^2 / a^2) for |y| < a, |x| < w / 2,
//                  `float width` w        y perpendicular to x; default 2 a
//                  `vector3 across`       as above
// `from`, `to` and `across` follow the current transformation; lengths are in world units.
#include "scene/light/light.h"

struct beam {
  struct vec from, axis, x, y; // orthonormal; x and y span the cross-section
  const struct profile *profile;
  double size;                 // radius, sigma or half side
  double half_width;           // along x, of a slab or grating
  double wavelength, contrast; // of the grating, and
  double integral;             // its integral from 0 to the edge, in periods
};

// A profile is a row of the table below; x and y are coordinates in the cross-section.
struct profile {
  const char *name;
  void (*read)(struct scene_builder *, struct params *, struct beam *);
  double (*density)(const struct beam *, double x, double y); // m^-2, integral 1
  void (*sample)(const struct beam *, double u0, double u1, double *x, double *y);
  double (*clear)(const struct beam *, double x, double y); // distance to the nearest kink
};

// ---- discs ----

static void disc_read(struct scene_builder *builder, struct params *params, struct beam *beam) {
  (void)builder;
  beam->size = light_positive(params, "radius", 1);
}

static double disc_clear(const struct beam *beam, double x, double y) {
  return fabs(beam->size - sqrt(x * x + y * y));
}

static double uniform_density(const struct beam *beam, double x, double y) {
  double a2 = beam->size * beam->size;
  return x * x + y * y < a2 ? 1 / (light_pi * a2) : 0;
}

static void uniform_sample(const struct beam *beam, double u0, double u1, double *x, double *y) {
  light_sample_disc(u0, u1, x, y);
  *x *= beam->size;
  *y *= beam->size;
}

static double quadratic_density(const struct beam *beam, double x, double y) {
  double a2 = beam->size * beam->size, t2 = (x * x + y * y) / a2;
  return t2 < 1 ? 2 / (light_pi * a2) * (1 - t2) : 0;
}

// rho^2 / a^2 = 1 - sqrt(1 - u), written without its cancellation at small u.
static void quadratic_sample(const struct beam *beam, double u0, double u1, double *x, double *y) {
  uniform_sample(beam, u0 / (1 + sqrt(1 - u0)), u1, x, y);
}

// ---- gaussian ----

static void gaussian_read(struct scene_builder *builder, struct params *params, struct beam *beam) {
  (void)builder;
  beam->size = light_positive(params, "sigma", 1);
}

static double gaussian_density(const struct beam *beam, double x, double y) {
  double s2 = beam->size * beam->size;
  return num_exp(-(x * x + y * y) / (2 * s2)) / (2 * light_pi * s2);
}

// Box and Muller; 1 - u0 is exact and never zero.
static void gaussian_sample(const struct beam *beam, double u0, double u1, double *x, double *y) {
  uniform_sample(beam, -2 * num_log(1 - u0), u1, x, y);
}

static double gaussian_clear(const struct beam *beam, double x, double y) {
  (void)beam, (void)x, (void)y;
  return INFINITY;
}

// ---- cosine grating ----

static const double most_periods = 1e5; // from the axis to the edge: what num_sincos_turns takes

// x along `across`; the direction is as good as 1e-10 while it is more than 1e-6 rad off the axis.
static void read_across(struct scene_builder *builder, struct params *params, struct beam *beam) {
  ptrdiff_t count = 3;
  const double *across = params_array(params, "vector3", "across", &count);
  if (across && count != 3) {
    params_complain(params, "across", "\"across\" takes three numbers");
    return;
  }
  struct vec v = across ? vec(across[0], across[1], across[2]) : vec(1, 0, 0);
  v = transform_direction(&builder->world_from_object, v);
  struct vec y = vec_cross(beam->axis, v);
  if (!(vec_length(y) > 1e-6 * vec_length(v)))
    params_complain(params, "across", "\"across\" must not be parallel to the beam");
  beam->y = vec_normalize(y);
  beam->x = vec_cross(beam->y, beam->axis);
}

// v + m / (2 pi) sin(2 pi v), the integral of 1 + m cos(2 pi v), which is *slope.
static double grating_integral(double m, double v, double *slope) {
  double sine, cosine;
  num_sincos_turns(v, &sine, &cosine);
  *slope = 1 + m * cosine;
  return v + m / (2 * light_pi) * sine;
}

static void cosine_read(struct scene_builder *builder, struct params *params, struct beam *beam) {
  disc_read(builder, params, beam);
  read_across(builder, params, beam);
  beam->half_width = beam->size;
  beam->wavelength = light_positive(params, "wavelength", 0); // no default
  beam->contrast = params_float(params, "contrast", 1);
  if (!(beam->contrast >= 0 && beam->contrast <= 1))
    params_complain(params, "contrast", "\"contrast\" must be between 0 and 1");
  double periods = beam->size / beam->wavelength, slope;
  if (periods <= most_periods)
    beam->integral = grating_integral(beam->contrast, periods, &slope);
  else
    params_complain(params, "wavelength", "\"wavelength\" is too short for the radius");
}

static double cosine_density(const struct beam *beam, double x, double y) {
  double a = beam->size, slope;
  if (!(fabs(x) < a && fabs(y) < a)) return 0;
  grating_integral(beam->contrast, x / beam->wavelength, &slope);
  return slope / (2 * beam->integral * beam->wavelength * 2 * a);
}

// v with grating_integral(m, v) = s, for s in [-1/2, 1/2], to the last bit the integral resolves.
// Newton, or bisection where Newton leaves the bracket; the bracket shrinks each time, so it ends.
static double grating_inverse(double m, double s) {
  double lo = -0.5, hi = 0.5, v = s;
  for (;;) {
    double slope, error = grating_integral(m, v, &slope) - s, next = v - error / slope;
    if (error == 0 || next == v) return v;
    *(error > 0 ? &hi : &lo) = v;
    if (!(lo < next && next < hi)) next = lo + (hi - lo) / 2;
    if (next == lo || next == hi) return v;
    v = next;
  }
}

static void cosine_sample(const struct beam *beam, double u0, double u1, double *x, double *y) {
  double s = (2 * u0 - 1) * beam->integral;
  double period = floor(s + 0.5); // the integral grows by 1 in each
  *x = beam->wavelength * (period + grating_inverse(beam->contrast, s - period));
  *y = (2 * u1 - 1) * beam->size;
}

static double rectangle_clear(const struct beam *beam, double x, double y) {
  double dx = fabs(x) - beam->half_width, dy = fabs(y) - beam->size;
  if (dx < 0 && dy < 0) return -(dx > dy ? dx : dy);
  dx = dx > 0 ? dx : 0;
  dy = dy > 0 ? dy : 0;
  return sqrt(dx * dx + dy * dy);
}

// ---- slab ----

static void slab_read(struct scene_builder *builder, struct params *params, struct beam *beam) {
  disc_read(builder, params, beam);
  read_across(builder, params, beam);
  beam->half_width = light_positive(params, "width", 2 * beam->size) / 2;
}

static double slab_density(const struct beam *beam, double x, double y) {
  double v = y / beam->size;
  if (!(fabs(x) < beam->half_width && fabs(v) < 1)) return 0;
  return 0.375 * (1 - v) * (1 + v) / (beam->size * beam->half_width);
}

// v = y / a with (2 + 3 v - v^3) / 4 = u is 2 cos phi, cos 3 phi = 1 - 2 u, phi from 2 pi / 3 to
// pi / 3.
static void slab_sample(const struct beam *beam, double u0, double u1, double *x, double *y) {
  double sine, cosine;
  num_sincos_turns((1 - num_acos(1 - 2 * u0) / (2 * light_pi)) / 3, &sine, &cosine);
  *x = (2 * u1 - 1) * beam->half_width;
  *y = 2 * cosine * beam->size;
}

static const struct profile profiles[] = {
    {"uniform", disc_read, uniform_density, uniform_sample, disc_clear},
    {"quadratic", disc_read, quadratic_density, quadratic_sample, disc_clear},
    {"gaussian", gaussian_read, gaussian_density, gaussian_sample, gaussian_clear},
    {"cosine", cosine_read, cosine_density, cosine_sample, rectangle_clear},
    {"slab", slab_read, slab_density, slab_sample, rectangle_clear},
};

static const struct profile *profile_find(const char *name) {
  for (size_t i = 0; i < sizeof profiles / sizeof *profiles; i++)
    if (!strcmp(profiles[i].name, name)) return &profiles[i];
  return NULL;
}

// ---- the light ----

static void read_power(struct scene_builder *builder, struct params *params, double power[3]) {
  if (!light_given(params, "float", "power")) {
    light_spectrum(builder, params, "power", power);
    return;
  }
  double total = params_float(params, "power", 1);
  if (total < 0) params_complain(params, "power", "\"power\" must not be negative");
  power[0] = power[1] = power[2] = total * light_scale(params);
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct beam *beam = arena_new(builder->arena, struct beam, 1);
  const char *name = params_string(params, "profile", "uniform");
  beam->profile = profile_find(name);
  if (!beam->profile)
    return params_complain(
        params, "profile",
        "\"%s\" is no beam profile; there are uniform, quadratic, gaussian, cosine, slab", name);
  light_from_to(builder, params, &beam->from, &beam->axis);
  vec_basis(beam->axis, &beam->x, &beam->y);
  read_power(builder, params, light->power);
  beam->profile->read(builder, params, beam);
  light->data = beam;
  return light_finish(params, light);
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct beam *beam = light->data;
  double x, y;
  beam->profile->sample(beam, u[0], u[1], &x, &y);
  struct vec o = vec_along(vec_along(beam->from, beam->x, x), beam->y, y);
  out->ray = (struct ray){o, beam->axis, INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c];
}

// p in the beam's coordinates: z along the axis, from the plane of emission.
static struct vec beam_coordinates(const struct beam *beam, struct vec p) {
  struct vec v = vec_sub(p, beam->from);
  return vec(vec_dot(v, beam->x), vec_dot(v, beam->y), vec_dot(v, beam->axis));
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)u;
  const struct beam *beam = light->data;
  struct vec q = beam_coordinates(beam, p);
  double density = q.z > 0 ? beam->profile->density(beam, q.x, q.y) : 0;
  if (!(density > 0)) return false;
  *out = (struct light_sample){
      .wi = vec_scale(beam->axis, -1), .distance = q.z, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = light->power[c] * density;
  return true;
}

// On a tilted plane the distance to a kink is at least the one in the cross-section, and the
// profile also ends where the plane crosses that of emission.
static bool closed_form(const struct scene *scene, const struct light *light, struct vec p,
                        struct vec n, struct light_closed_form *out) {
  const struct beam *beam = light->data;
  struct vec q = beam_coordinates(beam, p);
  double kink = beam->profile->clear(beam, q.x, q.y);
  double end = light_distance_in_plane(q.z, beam->axis, n);
  double cosine = -vec_dot(n, beam->axis);
  struct light_sample nee;
  bool lit = cosine > 0 && sample(scene, light, p, NULL, &nee);
  out->clear_radius = kink < end ? kink : end;
  for (int c = 0; c < 3; c++) {
    out->irradiance[c] = lit ? nee.radiance_over_pdf[c] * cosine : 0;
    out->photon_flux[c] = light->power[c];
  }
  return true;
}

const struct light_type light_beam = {
    .name = "beam",
    .about = "parallel photons with a uniform, quadratic, gaussian, cosine or slab profile (ours)",
    .delta = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .closed_form = closed_form,
    .is_gray = light_is_gray,
};
