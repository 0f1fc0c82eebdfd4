// LightSource "goniometric": a point of intensity `I` [W/sr] times an image (`string filename`, the
// mean of its channels) in pbrt-v4's equal-area octahedral map, whose pole is the light's +y axis;
// `scale`, `power` as pbrt-v4: the flux is 4 pi I times the image's mean, and a power P means that
// I is P over the factor. Texels are constant, as in pbrt-v4, and photons are drawn in proportion
// to them: all carry the same flux.
#include "scene/light/light.h"
#include "scene/octahedral.h"
#include "scene/texels.h"

struct goniometric {
  struct vec from, axis[3]; // of the map, in world space: the light's x, z and y
  struct texels texels;
  double intensity[3]; // of a texel of 1
};

static double image_mean(const struct texels *texels) {
  double rgb[3];
  texels_sum(texels, NULL, NULL, rgb);
  return (rgb[0] + rgb[1] + rgb[2]) / 3 / ((double)texels->width * texels->height);
}

static bool read(struct scene_builder *builder, struct params *params, struct light *light) {
  struct goniometric *gonio = arena_new(builder->arena, struct goniometric, 1);
  struct texels *texels = &gonio->texels;
  if (!texels_read(builder, params, texels)) return false;
  if (texels->width != texels->height)
    return params_complain(params, "filename",
                           "an equal-area map is square, and this image has %d x %d pixels",
                           texels->width, texels->height);
  struct vec axis[3];
  if (!light_axes(builder, params, axis)) return false;
  gonio->axis[0] = axis[0], gonio->axis[1] = axis[2], gonio->axis[2] = axis[1];
  gonio->from = transform_point(&builder->world_from_object, vec(0, 0, 0));
  texels_weigh(texels, NULL, NULL, builder->arena);
  light_spectrum(builder, params, "I", gonio->intensity);
  double solid_angle = 4 * light_pi * image_mean(texels); // weighted with the image
  double total = light_total(params, "power", solid_angle);
  for (int c = 0; c < 3; c++) {
    gonio->intensity[c] *= total;
    light->power[c] = solid_angle * gonio->intensity[c];
  }
  light->data = gonio;
  return light_finish(params, light);
}

static void emit(const struct scene *scene, const struct light *light, const double *u,
                 struct emission *out) {
  (void)scene;
  const struct goniometric *gonio = light->data;
  struct texel texel = texels_choose(&gonio->texels, u + 2);
  struct vec d = light_from_axes(gonio->axis, octahedral_direction(texel.u, texel.v));
  out->ray = (struct ray){gonio->from, d, INFINITY, PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->flux[c] = light->power[c];
}

// Of the texel in direction d.
static double profile(const struct goniometric *gonio, struct vec d) {
  double u, v, rgb[3];
  octahedral_square(light_to_axes(gonio->axis, d), &u, &v);
  struct texel texel = texels_at(&gonio->texels, u, v);
  texels_rgb(&gonio->texels, texel.x, texel.y, rgb);
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

static bool sample(const struct scene *scene, const struct light *light, struct vec p,
                   const double u[2], struct light_sample *out) {
  (void)scene, (void)u;
  const struct goniometric *gonio = light->data;
  struct vec to_light = vec_sub(gonio->from, p);
  double d2 = vec_dot(to_light, to_light), distance = sqrt(d2);
  if (!(d2 > 0)) return false;
  struct vec wi = vec_scale(to_light, 1 / distance);
  double per_d2 = profile(gonio, vec_scale(wi, -1)) / d2;
  if (!(per_d2 > 0)) return false;
  *out = (struct light_sample){.wi = wi, .distance = distance, .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < 3; c++) out->radiance_over_pdf[c] = gonio->intensity[c] * per_d2;
  return true;
}

const struct light_type light_goniometric = {
    .name = "goniometric",
    .about = "a point whose intensity is an image of directions",
    .delta = true,
    .read = read,
    .emit = emit,
    .sample = sample,
    .pdf = light_pdf_delta,
    .is_gray = light_is_gray,
};
