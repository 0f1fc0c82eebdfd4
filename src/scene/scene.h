// A scene as the integrators see it: plain arrays, world space, linear sRGB.
// Shapes, lights, materials, textures and cameras are slots: one file each in shape/, light/,
// material/, texture/, camera/, whose last definition is its row (`const struct light_type
// light_point = {...}`); the build collects the rows from the file names, so adding one touches
// nothing else.
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/arena.h"
#include "base/problem.h"
#include "pbrt/params.h"
#include "scene/animation.h"
#include "scene/bsdf.h"
#include "scene/medium.h"
#include "scene/ray.h"
#include "scene/texture.h"
#include "scene/transform.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define LIGHT_NONE UINT32_MAX
#define ROW_NONE UINT32_MAX

struct scene;

struct box {
  float lo[3], hi[3]; // closed; rounded outward when made from doubles
};

// What was hit. Of shapes that are not `detailed`, ns = ng, and dpdu and uv are zero.
struct surface {
  struct vec p;  // o + t d
  struct vec ng; // geometric normal, unit length, on the side pbrt gives it
  uint32_t primitive;
  uint32_t shape;
  struct vec ns;   // shading normal, unit length; ng is on its side where the shape has normals
  struct vec dpdu; // of any length; zero: no direction across ns is special
  double uv[2];
};

// ---- shapes ----
// A shape is one `Shape` directive: `count` primitives from number `first`. Primitives are numbered
// in the order of the file. Flat = triangle or disk: a ray that leaves one cannot hit it again.
struct shape {
  const struct shape_type *type;
  uint32_t first, count;      // global primitive numbers
  uint32_t local;             // first row of scene.triangle, scene.patch or scene.quadric
  uint32_t vertex;            // meshes: first row of scene.position
  uint32_t normal, uv;        // meshes: rows of scene.normal, scene.uv of the first vertex, or ROW_NONE
  uint32_t tangent;           // of scene.tangent
  uint32_t material, light;   // rows of scene.material, scene.light (or LIGHT_NONE)
  const struct input *alpha;  // opacity, NULL: opaque
  bool flip;                  // geometric normal reversed (ReverseOrientation xor mirrored matrix)
  bool detailed;              // somebody wants ns, dpdu, uv
  bool see_through;           // a ray may pass: alpha, or a material that is an interface
  bool faceted;               // a normal of its own for each primitive, in scene.facet
  const struct bsdf *bsdf;    // of every point, but for the frame; NULL: it depends on the point
  bool lambert;               // faceted and Lambertian, the same at every point, in one medium
  uint32_t inside, outside;   // rows of scene.medium or MEDIUM_NONE, behind and before ng; where they
                              // differ, what crosses the shape changes its medium
};

// Sphere, disk and cylinder, partial sweeps as in pbrt-v4. The world transform has no limits but
// invertible.
struct quadric {
  struct transform world_from_object, object_from_world;
  double radius, z_min, z_max; // sphere, cylinder
  double height, inner_radius; // disk
  double phi_max;              // radians
  double mean_stretch;         // of area by world_from_object; 0: the same everywhere
};

// A shape that moves: its point p is at instance * object * p, and scene.position, normal or quadric
// hold it at one time (scene/motion.h). Outside of instances the first is the identity.
struct motion {
  uint32_t shape, n_shapes;           // a mesh may be two, which share its vertices
  struct animation instance, object;
  uint32_t n_vertices, n_normals, n_tangents; // meshes
  float (*position)[3], (*normal)[3], (*tangent)[3]; // before both transformations; or NULL
  struct box bounds;                  // at all times
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
  // Fills ns, dpdu and uv of a surface whose other fields are set, and may turn ng to the side of
  // ns (pbrt's rule for meshes with normals). Called where shape.detailed.
  void (*detail)(const struct scene *, const struct shape *, struct surface *);
  // Geometric normal at p on the primitive, unit length, flip applied.
  struct vec (*normal)(const struct scene *, const struct shape *, uint32_t primitive, struct vec p);
  double (*area)(const struct scene *, const struct shape *, uint32_t primitive);
  // A point of the primitive, with its normal; pdf_area = density / area.
  void (*sample)(const struct scene *, const struct shape *, uint32_t primitive, double u0, double u1,
                 struct vec *p, struct vec *ng);
  // Of `sample` at p, relative to the mean; NULL: 1, uniform.
  double (*density)(const struct scene *, const struct shape *, uint32_t primitive, struct vec p);
};

// ---- materials ----
struct material {
  const struct material_type *type;
  const void *data; // the type's own
  unsigned needs;   // bits of enum material_needs; `read` sets them (input_read_* sets MATERIAL_DETAIL)
};

enum material_needs {
  MATERIAL_DETAIL = 1, // reads uv, dpdu or a texture
  MATERIAL_RANDOM = 2, // reads bsdf.u: its value is random
  MATERIAL_DELTA = 4,  // may have delta lobes
};

struct material_type {
  const char *name, *about;
  bool passed; // rays pass without scattering (interface); bsdf is never called
  bool (*read)(struct scene_builder *, struct params *, struct material *);
  // The scattering at a surface, textures looked up: type, data and x of a bsdf whose frame and u
  // are set (surface_bsdf). Leaves type NULL where nothing is scattered.
  void (*bsdf)(const struct scene *, const struct material *, const struct surface *,
               struct bsdf *);
  bool (*is_gray)(const struct scene *, const struct material *);
  bool (*is_black)(const struct material *); // scatters nothing anywhere; NULL: it scatters
};

// ---- lights ----
enum { LIGHT_U = 4 }; // random numbers an emission may use: u[0..1] position, u[2..3] direction

struct light {
  const struct light_type *type;
  const void *data;
  double power[3];     // W per channel, all of what it emits
  double probability;  // of being chosen, in proportion to the mean over channels of power; sums to 1
  uint32_t medium;     // where its photons start; of area lights the shape's
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
  bool at_infinity;         // its light comes from without the scene: in a vacuum, as in pbrt
  // Called when the file is complete; for area lights the builder's `shape` is the emitter. Fills data
  // and power.
  bool (*read)(struct scene_builder *, struct params *, struct light *);
  // u[LIGHT_U]. The ray's t_max is INFINITY.
  void (*emit)(const struct scene *, const struct light *, const double *u, struct emission *);
  bool (*sample)(const struct scene *, const struct light *, struct vec p, const double u[2],
                 struct light_sample *); // false: contributes nothing here
  // Solid angle at p of having sampled this surface point (infinite lights: this direction, surface
  // NULL); 0 for delta.
  double (*pdf)(const struct scene *, const struct light *, struct vec p, const struct surface *,
                struct vec wi);
  // Radiance leaving the emitter's surface towards w (area lights), else NULL.
  void (*radiance)(const struct scene *, const struct light *, const struct surface *, struct vec w,
                   double rgb[3]);
  // Radiance that arrives from direction d where nothing is hit (infinite lights), else NULL.
  void (*background)(const struct scene *, const struct light *, struct vec d, double rgb[3]);
  // NULL if there is no closed form. Exact (theory 5); the statistics compare measurements with it.
  bool (*closed_form)(const struct scene *, const struct light *, struct vec p, struct vec n,
                      struct light_closed_form *);
  bool (*is_gray)(const struct light *);
};

// ---- camera and film ----
struct pixel {
  int x, y; // from the top left of the image, from 0
};

struct camera {
  const struct camera_type *type;
  struct transform world_from_camera;
  struct animation animation;         // of world_from_camera
  int width, height;                  // of the image, pixels
  int full_width, full_height;        // of the film it is cut from
  int crop_x, crop_y;                 // where the image's top left pixel is on the film
  double window[4];                   // x0 x1 y0 y1 of the film at z = 1 (orthographic: anywhere), camera space
  double fov;                         // perspective: degrees, shorter axis
  bool equirectangular;               // spherical: longitude and latitude, else equal areas
  double lens_radius, focal_distance; // 0: a pinhole
  double shutter_open, shutter_close;
};

struct camera_type {
  const char *name, *about;
  bool has_lens;                                  // and a screen window
  bool (*read)(struct camera *, struct params *); // what is the type's own (fov)
  // Fills `window` from the screen window x0 x1 y0 y1.
  void (*set_window)(struct camera *, const double screen[4]);
  // The ray in camera space through (x, y) of the window, before the lens; d need not be of unit
  // length.
  void (*ray)(const struct camera *, double x, double y, struct vec *o, struct vec *d);
  // Its inverse: the (x, y) whose ray meets p, false if none does. An element of surface at p, as a
  // vector along its normal, covers the area |flow . element| of the window. NULL: there is none.
  bool (*find)(const struct camera *, struct vec p, double xy[2], struct vec *flow);
};

// The ray through continuous pixel coordinates of the image (0.5, 0.5 is the centre of the top left
// pixel) and a point of the lens, u[2] uniform (NULL: its centre). d is of unit length.
struct ray camera_ray(const struct camera *, double x, double y, const double u[2]);

// How the positions of a pixel's samples are distributed around its centre; their weight is 1.
struct filter {
  const struct filter_type *type;
  double radius[2], sigma; // pixels
};

struct filter_type {
  const char *name, *about;
  bool (*read)(struct filter *, struct params *);
  void (*sample)(const struct filter *, const double u[2], double offset[2]); // from the centre
  double (*density)(const struct filter *, int axis, double offset); // of `sample` in x or y
};
const struct filter_type *filter_find(const char *name); // scene/filter.c
extern const struct filter_type *const filter_types[];   // NULL-terminated

// What the file asks `render` for; the command line overrides it, experiments do not look.
struct scene_settings {
  const char *filename;    // Film
  const char *integrator;  // Integrator, NULL if none
  int max_depth;           // pbrt's maxdepth; default 5 as pbrt
  int64_t spp;             // Sampler pixelsamples
  double exposure;         // Film: what a picture multiplies radiance with (shutter time, iso)
  bool centre;             // pixel centres (Sampler "stratified" "bool jitter" false), else the footprint
  double radius, alpha;    // our own integrators; NAN where the file says nothing
  int64_t photons, iterations, seed; // 0, 0, -1 where the file says nothing
  const char *kernel, *law, *direct; // NULL where the file says nothing
};

// What the file holds that the arrays no longer show, for `photonlab info`.
struct inventory {
  uint32_t n_files, n_objects, n_instances, n_named_materials, n_textures;
  uint32_t *textures; // by row of texture_types, floats and spectra
};

struct scene {
  const char *path;
  uint64_t hash; // xxh64 over the bytes of every file read, in order
  struct camera camera;
  struct filter filter;
  struct scene_settings settings;

  float (*position)[3];    // vertices in world space, rounded once to float
  float (*normal)[3];      // of vertices, in world space, the longest of a mesh of unit length (build_mesh.c)
  float (*uv)[2];
  float (*tangent)[3];     // as normal
  uint32_t (*triangle)[3]; // rows of position
  uint32_t (*patch)[4];    // rows of position: p00, p10, p01, p11
  struct quadric *quadric;
  struct shape *shape;
  uint32_t *shape_of;      // by primitive
  struct vec *facet;       // by primitive: ng where shape.faceted
  struct material *material;
  struct light *light;
  struct medium *medium;
  double *light_cdf;       // [n_lights + 1], cumulative `probability`
  uint32_t *infinite;      // rows of light with a background
  struct motion *motion;
  double motion_time[2];   // TransformTimes
  uint32_t n_positions, n_normals, n_uvs, n_tangents, n_triangles, n_patches, n_quadrics, n_shapes,
      n_primitives, n_materials, n_lights, n_infinite, n_motions, n_media;
  uint32_t camera_medium; // where eye paths start: row of `medium` or MEDIUM_NONE

  struct box bounds;       // of all primitives, at all times
  struct inventory inventory;
};

// Reads a pbrt-v4 file (the subset of README) and everything in it.
bool scene_read(const char *path, struct arena *, struct scene *, struct problem *);

struct scene_options {
  bool lenient;    // displacement, normal maps and the like are left out instead of refused
  FILE *notes;     // what was left out is said here, a line each; NULL: nowhere
  bool own_folder; // files outside of the scene's folder are refused (absolute names, ..)
};
bool scene_read_with(const char *path, struct scene_options, struct arena *, struct scene *,
                     struct problem *);

// Whether there are only triangles, and so few of them that no tree is needed.
bool scene_is_few_triangles(const struct scene *);

// The surface a hit of this ray found.
void scene_surface(const struct scene *, const struct ray *, struct hit, struct surface *);

static inline const struct material *scene_material(const struct scene *scene,
                                                    const struct surface *surface) {
  return &scene->material[scene->shape[surface->shape].material];
}

// The medium of a ray that leaves the surface along w, if it arrived through `medium`.
static inline uint32_t surface_medium(const struct scene *scene, const struct surface *surface,
                                      struct vec w, uint32_t medium) {
  const struct shape *shape = &scene->shape[surface->shape];
  if (shape->inside == shape->outside) return medium;
  return vec_dot(w, surface->ng) > 0 ? shape->outside : shape->inside;
}

// The scattering at a surface; u: a uniform random number of this vertex (for MATERIAL_RANDOM).
// type is NULL where nothing is scattered.
void surface_bsdf(const struct scene *, const struct surface *, double u, struct bsdf *);

// How much of what arrives is stopped: alpha in [0, 1]; 0 of an interface.
double surface_opacity(const struct scene *, const struct surface *);

// What the scene needs; what it does not is skipped (design 6). Decided once.
struct features {
  bool gray;             // every spectrum has equal channels: one is carried instead of three
  int n_channels;        // 1 if gray, else 3
  bool random_materials; // some material reads bsdf.u
  bool random_eye;       // a pixel's centre does not always see the same: lens, motion, delta lobes,
                         // alpha, random materials
  bool see_through;      // some shape lets rays pass
  bool motion;
  bool background;       // some light is infinite
  bool media;            // some ray may be in a medium
};
struct features scene_features(const struct scene *);

// Whether some ray may be in it: media that are only defined do not count.
bool scene_uses_medium(const struct scene *, uint32_t row);

// The registered rows, NULL-terminated, sorted by file name.
extern const struct shape_type *const shape_types[];
extern const struct light_type *const light_types[];
extern const struct material_type *const material_types[];
extern const struct texture_type *const texture_types[];
extern const struct camera_type *const camera_types[];

#endif
