// A scene as the integrators see it: plain arrays, world space, linear sRGB.
// Shapes, lights and materials are slots: one file each in shape/, light/, material/, whose last
// definition is its row (`const struct light_type light_point = {...}`); the build collects the rows
// from the file names, so adding one touches nothing else.
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/arena.h"
#include "base/problem.h"
#include "pbrt/params.h"
#include "scene/ray.h"
#include "scene/transform.h"

#include <stdbool.h>
#include <stdint.h>

#define LIGHT_NONE UINT32_MAX

struct scene;

struct box {
  float lo[3], hi[3]; // closed; rounded outward when made from doubles
};

// What was hit.
struct surface {
  struct vec p;  // o + t d
  struct vec ng; // geometric normal, unit length, on the side pbrt gives it
  uint32_t primitive;
  uint32_t shape;
};

// ---- shapes ----
// A shape is one `Shape` directive: `count` primitives from number `first`. Primitives are numbered
// in the order of the file. Flat = triangle or disk: a ray that leaves one cannot hit it again.
struct shape {
  const struct shape_type *type;
  uint32_t first, count;       // global primitive numbers
  uint32_t local;              // triangles: first row of scene.triangle; quadrics: of scene.quadric
  uint32_t material, light;    // rows of scene.material, scene.light (or LIGHT_NONE)
  bool flip;                   // geometric normal reversed (ReverseOrientation xor mirrored matrix)
};

// Sphere and disk, partial sweeps as in pbrt-v4. The world transform has no limits but invertible.
struct quadric {
  struct transform world_from_object, object_from_world;
  double radius, z_min, z_max; // sphere
  double height, inner_radius; // disk
  double phi_max;              // radians
};

struct scene_builder; // the reader's state while a file is read (scene/read.h)

struct shape_type {
  const char *name;  // as in `Shape "name"`
  const char *about; // one line for `photonlab list`
  bool flat;
  // Reads the parameters and appends primitives to the scene under construction; false: problem set.
  bool (*read)(struct scene_builder *, struct params *);
  struct box (*bounds)(const struct scene *, const struct shape *, uint32_t primitive);
  // Fills *t if the ray hits within (0, t_max); scalar reference of what the BVH does.
  bool (*intersect)(const struct scene *, const struct shape *, uint32_t primitive,
                    const struct ray *, double *t);
  // Geometric normal at p on the primitive, unit length, flip applied.
  struct vec (*normal)(const struct scene *, const struct shape *, uint32_t primitive, struct vec p);
  double (*area)(const struct scene *, const struct shape *, uint32_t primitive);
  // A point uniform over the primitive's area (pdf_area = 1/area), with its normal.
  void (*sample)(const struct scene *, const struct shape *, uint32_t primitive, double u0, double u1,
                 struct vec *p, struct vec *ng);
};

// ---- materials ----
struct bsdf_sample {
  struct vec wi;
  double weight[3]; // f |cos| / pdf
  double pdf_solid_angle;
};

struct material {
  const struct material_type *type;
  const void *data; // the type's own
};

// Directions point away from the surface and are of unit length. wo: where the path came from.
struct material_type {
  const char *name, *about;
  bool (*read)(struct params *, struct arena *, struct material *);
  // f(wo, wi) in 1/sr per channel; zero where the material does not scatter.
  void (*value)(const struct material *, const struct surface *, struct vec wo, struct vec wi,
                double f[3]);
  double (*pdf)(const struct material *, const struct surface *, struct vec wo, struct vec wi);
  // False: absorbed (nothing to sample). u: two numbers for the direction, one for a component.
  bool (*sample)(const struct material *, const struct surface *, struct vec wo, const double u[3],
                 struct bsdf_sample *);
  bool (*is_gray)(const struct material *);
  bool (*is_black)(const struct material *); // scatters nothing
};

// ---- lights ----
enum { LIGHT_U = 4 }; // random numbers an emission may use: u[0..1] position, u[2..3] direction

struct light {
  const struct light_type *type;
  const void *data;
  double power[3];     // W per channel, all of what it emits
  double probability;  // of being chosen, in proportion to the mean over channels of power; sums to 1
};

struct emission {
  struct ray ray;
  double flux[3]; // W: power / pdf of this photon, not divided by n_emitted nor by `probability`
};

struct light_sample { // next-event estimation, from point p
  struct vec wi;                // unit length, towards the light
  double distance;              // INFINITY for a light at infinity
  double radiance_over_pdf[3];  // radiance (or intensity / d^2) / pdf
  double pdf_solid_angle;       // 0 for a delta light
  uint32_t primitive;           // the emitting primitive, or PRIMITIVE_NONE
};

// What a closed form says of a light's direct illumination at a point of a plane, nothing in between.
struct light_closed_form {
  double irradiance[3];  // W m^-2 at p on the side n
  double photon_flux[3]; // W: the constant `flux` every emitted photon carries
  double clear_radius;   // the profile is smooth in the disc of this radius around p (INFINITY: everywhere)
};

struct light_type {
  const char *name, *about; // name as in `LightSource "name"` (area: `AreaLightSource`)
  bool area;                // comes with a shape
  bool delta;               // cannot be hit by a ray: no MIS
  // Called when the file is complete; for area lights the builder's `shape` is the emitter. Fills data
  // and power.
  bool (*read)(struct scene_builder *, struct params *, struct light *);
  // u[LIGHT_U]. The ray's t_max is INFINITY.
  void (*emit)(const struct scene *, const struct light *, const double *u, struct emission *);
  bool (*sample)(const struct scene *, const struct light *, struct vec p, const double u[2],
                 struct light_sample *); // false: contributes nothing here
  double (*pdf)(const struct scene *, const struct light *, struct vec p, const struct surface *,
                struct vec wi); // solid angle at p of having sampled this surface point; 0 for delta
  // Radiance leaving the emitter's surface towards w (area lights), else NULL.
  void (*radiance)(const struct scene *, const struct light *, const struct surface *, struct vec w,
                   double rgb[3]);
  // NULL if there is no closed form. Exact (theory 5); the statistics compare measurements with it.
  bool (*closed_form)(const struct scene *, const struct light *, struct vec p, struct vec n,
                      struct light_closed_form *);
  bool (*is_gray)(const struct light *);
};

// ---- camera and film ----
struct pixel {
  int x, y; // from the top left, from 0
};

struct camera {
  struct transform world_from_camera;
  double fov;            // degrees, shorter axis
  int width, height;     // pixels
  double half_x, half_y; // of the image plane at z = 1, camera space
};

// The ray through continuous pixel coordinates (0.5, 0.5 is the centre of the top left pixel). d is
// of unit length.
struct ray camera_ray(const struct camera *, double x, double y);

// What the file asks `render` for; the command line overrides it, experiments do not look.
struct scene_settings {
  const char *filename;    // Film
  const char *integrator;  // Integrator, NULL if none
  int max_depth;           // pbrt's maxdepth; default 5 as pbrt
  int64_t spp;             // Sampler pixelsamples
  bool centre;             // pixel centres (Sampler "stratified" "bool jitter" false), else the footprint
  double radius, alpha;    // our own integrators; NAN where the file says nothing
  int64_t photons, iterations, seed; // 0, 0, -1 where the file says nothing
  const char *kernel, *law, *direct; // NULL where the file says nothing
};

struct scene {
  const char *path;
  uint64_t hash; // xxh64 over the bytes of every file read, in order
  struct camera camera;
  struct scene_settings settings;

  float (*position)[3];    // vertices in world space, rounded once to float
  uint32_t (*triangle)[3]; // rows of position
  struct quadric *quadric;
  struct shape *shape;
  uint32_t *shape_of;      // by primitive
  struct material *material;
  struct light *light;
  double *light_cdf;       // [n_lights + 1], cumulative `probability`
  uint32_t n_positions, n_triangles, n_quadrics, n_shapes, n_primitives, n_materials, n_lights;

  struct box bounds;       // of all primitives
};

// Reads a pbrt-v4 file (the subset of README) and everything in it.
bool scene_read(const char *path, struct arena *, struct scene *, struct problem *);

// The surface a hit of this ray found.
struct surface scene_surface(const struct scene *, const struct ray *, struct hit);

static inline const struct material *scene_material(const struct scene *scene,
                                                    const struct surface *surface) {
  return &scene->material[scene->shape[surface->shape].material];
}

// What the scene does not need (design 6), decided once.
struct features {
  bool gray;             // every spectrum has equal channels: one is carried instead of three
  int n_channels;        // 1 if gray, else 3
};
struct features scene_features(const struct scene *);

// The registered rows, NULL-terminated, sorted by file name.
extern const struct shape_type *const shape_types[];
extern const struct light_type *const light_types[];
extern const struct material_type *const material_types[];

#endif
