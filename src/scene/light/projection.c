// LightSource "projection": a point that throws an image (`string filename`) along its +z axis, top
// upwards (+y); `float fov` 90 (degrees, shorter side), `scale`, `power` as pbrt-v4. The intensity
// [W/sr] in a direction is the value of its texel, constant each. With A the image's area at
// distance 1 and dw = cos^3 dA the flux is a sum over texels of value times solid angle; pbrt-v4's
// `power` P takes cos^3 at the centre of each: scale = P / (A / n sum of luminance cos^3).
#include "scene/light/light.h"
#include "scene/texels.h"

struct projection {
  struct vec from, axis[3];
  double half_x, half_y; // of the image at distance 1
  struct texels texels;
  double scale;
  bool gray;
};

// From the point (u, v) of the image, v downwards, to the plane at distance 1.
static struct vec on_plane(const struct projection *projection, double u, double v) {
  return vec((2 * u - 1) * projection->half_x, (1 - 2 * v) * projection->half_y, 1);
}

static double cosine3(struct vec on_plane) {
  double r2 = vec_dot(on_plane, on_plane);
  return 1 / (r2 * sqrt(r2));
}

static double centre_cosine3(const void *data, int x, int y) {
  const struct projection *projection = data;
  const struct texels *texels = &projection->texels;
  return cosine3(on_plane(projection, (x + 0.5) / texels->width, (y + 0.5) / texels->height));
}

// Of the rectangle between the axis and the corner (x, y) of the plane.
static double corner_solid_angle(struct vec corner) {
  return num_atan2(corner.x * corner.y, vec_length(corner));
}

static double texel_solid_angle(const void *data, int x, int y) {
  const struct projection *projection = data;
  double w = projection->texels.width, h = projection->texels.height, sum = 0;
  for (int k = 0; k < 4; k++) {
    double a = corner_solid_angle(on_plane(projection, (x + k % 2) / w, (y + k / 2) / h));
    sum += k == 0 || k == 3 ? a : -a;
  }
  return fabs(sum);
}

static void read_angle(struct params *params, struct projection *projection) {
  double fov = params_float(params, "fov", 90), sine, cosine;
  if (!(fov > 0 && fov < 180))
    params_complain(params, "fov", "the field of view must be in (0, 180) degrees");
  num_sincos_turns(fov / 720, &sine, &cosine);
  double w = projection->texels.width, h = projection->texels.height, shorter = sine / cosine;
  projection->half_x = w > h ? shorter * w / h : shorter;
  projection->half_y = w > h ? shorter : shorter * h / w;
}

static double plane_area(const struct projection *projection) {
  return 4 * projection->half_x * projection->half_y;
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct projection *projection = arena_new(builder->arena, struct projection, 1);
  struct texels *texels = &projection->texels;
  double rgb[3];
  if (!texels_read(builder, params, texels)) return false;
  if (!light_axes(builder, params, projection->axis)) return false;
  projection->from = transform_point(&builder->world_from_object, vec(0, 0, 0));
  read_angle(params, projection);
  texels_weigh(texels, centre_cosine3, projection, builder->arena);
  texels_sum(texels, centre_cosine3, projection, rgb);
  double n = (double)texels->width * texels->height;
  double unit = plane_area(projection) / n * light_luminance(rgb);
  projection->scale = light_scale(params) * light_total(params, "power", unit);
  projection->gray = texels_are_gray(texels);
  texels_sum(texels, texel_solid_angle, projection, rgb);
  for (int c = 0; c < 3; c++) light->power[c] = projection->scale * rgb[c];
  light->data = projection;
  return light_finish(params, light);
}

// Within its texel uniform on the plane: per solid angle that is the density over cos^3.
static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct projection *projection = light->data;
  struct texel texel = texels_choose(&projection->texels, u + 2);
  struct vec at = on_plane(projection, texel.u, texel.v);
  struct vec d = light_from_axes(projection->axis, vec_normalize(at));
  double n = (double)projection->texels.width * projection->texels.height, rgb[3];
  double pdf_area = texel.chance * n / plane_area(projection);
  texels_rgb(&projection->texels, texel.x, texel.y, rgb);
  out->ray = (struct ray){projection->from, d, INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = projection->scale * rgb[c] * cosine3(at) / pdf_area;
}

// The intensity in direction d. False: outside the image.
static bool intensity(const struct projection *projection, struct vec d, double rgb[3]) {
  struct vec w = light_to_axes(projection->axis, d);
  if (!(w.z > 0)) return false;
  double u = (w.x / w.z / projection->half_x + 1) / 2;
  double v = (1 - w.y / w.z / projection->half_y) / 2;
  if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return false;
  struct texel texel = texels_at(&projection->texels, u, v);
  texels_rgb(&projection->texels, texel.x, texel.y, rgb);
  for (int c = 0; c < 3; c++) rgb[c] *= projection->scale;
  return true;
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)u;
  const struct projection *projection = light->data;
  struct vec to_light = vec_sub(projection->from, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2), rgb[3];
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  if (!intensity(projection, vec_scale(wi, -1), rgb)) return false;
  *out = (struct light_sample){.wi = wi, .distance = distance, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = rgb[c] / d2;
  return true;
}

static bool is_gray(const struct light *light) {
  const struct projection *projection = light->data;
  return projection->gray;
}

const struct light_type light_projection = {
    .name = "projection",
    .about = "a point that throws an image",
    .delta = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .is_gray = is_gray,
};
