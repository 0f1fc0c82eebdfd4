#include "scene/mapping.h"

#include "numeric/elementary.h"

#include <string.h>

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct mapping_type {
  const char *name;
  bool in_space; // of the texture, else on the surface
  bool (*read)(struct params *, struct mapping *);
  void (*st)(const struct mapping *, const struct surface *, double st[2]);
};

static void read_delta(struct params *params, struct mapping *mapping) {
  mapping->delta[0] = params_float(params, "udelta", 0);
  mapping->delta[1] = params_float(params, "vdelta", 0);
}

static bool read_uv(struct params *params, struct mapping *mapping) {
  mapping->scale[0] = params_float(params, "uscale", 1);
  mapping->scale[1] = params_float(params, "vscale", 1);
  read_delta(params, mapping);
  return true;
}

static void st_uv(const struct mapping *mapping, const struct surface *surface, double st[2]) {
  for (int k = 0; k < 2; k++) st[k] = mapping->scale[k] * surface->uv[k] + mapping->delta[k];
}

static bool read_nothing(struct params *params, struct mapping *mapping) {
  (void)params, (void)mapping;
  return true;
}

static struct vec in_space(const struct mapping *mapping, const struct surface *surface) {
  return transform_point(&mapping->texture_from_world, surface->p);
}

// Polar angle from z over pi, then azimuth from x over 2 pi. (The centre lies on +z.)
static void st_spherical(const struct mapping *mapping, const struct surface *surface,
                         double st[2]) {
  struct vec p = in_space(mapping, surface);
  double length = vec_length(p), cosine = length > 0 ? p.z / length : 1;
  st[0] = num_acos(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine) * one_over_pi;
  st[1] = num_atan2(p.y, p.x) * (0.5 * one_over_pi);
  if (st[1] < 0) st[1] += 1;
}

static void st_cylindrical(const struct mapping *mapping, const struct surface *surface,
                           double st[2]) {
  struct vec p = in_space(mapping, surface);
  st[0] = 0.5 + num_atan2(p.y, p.x) * (0.5 * one_over_pi);
  st[1] = p.z;
}

static struct vec read_axis(struct params *params, const char *name, struct vec fallback) {
  ptrdiff_t n;
  const double *xyz = params_array(params, "vector3", name, &n);
  if (!xyz) return fallback;
  if (n == 3) return vec(xyz[0], xyz[1], xyz[2]);
  params_complain(params, name, "\"%s\" is one vector of 3 numbers", name);
  return fallback;
}

static bool read_planar(struct params *params, struct mapping *mapping) {
  mapping->axis[0] = read_axis(params, "v1", vec(1, 0, 0));
  mapping->axis[1] = read_axis(params, "v2", vec(0, 1, 0));
  read_delta(params, mapping);
  return true;
}

static void st_planar(const struct mapping *mapping, const struct surface *surface, double st[2]) {
  struct vec p = in_space(mapping, surface);
  for (int k = 0; k < 2; k++) st[k] = mapping->delta[k] + vec_dot(p, mapping->axis[k]);
}

static const struct mapping_type mappings[] = {
    {"uv", false, read_uv, st_uv},
    {"spherical", true, read_nothing, st_spherical},
    {"cylindrical", true, read_nothing, st_cylindrical},
    {"planar", true, read_planar, st_planar},
};
enum { N_MAPPINGS = sizeof mappings / sizeof *mappings };

bool mapping_read_space(const struct scene_builder *builder, struct params *params,
                        struct transform *texture_from_world) {
  return transform_invert(builder->world_from_object, texture_from_world) ||
         params_complain(params, "mapping", "the current transformation has no inverse");
}

bool mapping_read(struct scene_builder *builder, struct params *params, struct mapping *mapping) {
  const char *name = params_string(params, "mapping", "uv");
  *mapping = (struct mapping){0};
  for (int k = 0; k < N_MAPPINGS; k++)
    if (strcmp(mappings[k].name, name) == 0) mapping->type = &mappings[k];
  if (!mapping->type)
    return params_complain(params, "mapping",
                           "\"%s\" is no mapping (known: uv, spherical, cylindrical, planar)",
                           name);
  if (mapping->type->in_space && !mapping_read_space(builder, params, &mapping->texture_from_world))
    return false;
  return mapping->type->read(params, mapping);
}

void mapping_st(const struct mapping *mapping, const struct surface *surface, double st[2]) {
  mapping->type->st(mapping, surface, st);
}
