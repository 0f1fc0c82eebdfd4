// Batches of paths that advance together: trace the batch, then at every hit store or connect,
// scatter, and close the gaps. Photon and eye paths share this body; what happens at a hit is
// theirs.
#ifndef WALK_WALK_H
#define WALK_WALK_H

#include "bvh/view.h"
#include "numeric/rng.h"
#include "scene/scene.h"
#include "walk/differential.h"
#include "walk/facets.h"
#include "walk/light_path.h"

enum { WALK_BATCH = 4096 };

// Where a segment has ended within a medium. Photons: throughput [W], so weight [W x scene unit];
// eye paths: weight of what is met next, per length.
struct collision {
  struct medium_point at;
  double weight[3]; // throughput / density of collisions: its mean over paths is the fluence there
};

struct walk {
  const struct scene *scene; // of this iteration, as the tree
  const struct bvh *bvh;
  struct view view;
  struct features features;
  int n_channels;
  enum transport transport; // photons: importance
  struct rng_key key;
  uint64_t iteration;

  int n;           // paths alive, packed at the front of the arrays below
  int vertex;      // how many times they have been scattered: 0 before the first trace
  uint64_t *path;  // [n] number of the path, its identity for random numbers
  struct ray *ray; // d of unit length
  struct hit *hit;
  struct vec *from;      // where the segment began; ray.o is where it last passed a surface
  double *throughput[3]; // photons: flux [W]; eye paths: weight of what is met next
  double *pdf;           // solid angle pdf of ray.d by the last scattering; 0: next-event
                         // estimation cannot find what it meets (delta lobe, camera)
  double *owed; // [n] what roulette has not yet taken of the weight; NULL: it takes at once
  int *owner;   // eye paths: the point this path belongs to
  struct differential *differential; // [n] of eye paths; NULL: nobody asks
  uint8_t *kind; // enum light_path: what an emitter (photons: an eye) here completes
  // Only where there are media, else NULL.
  uint32_t *medium;            // [n] of the segment: row of scene.medium or MEDIUM_NONE
  struct collision *collision; // [n] of those that collided: walk_collided
  uint32_t *flights;           // [n] random numbers used since `vertex` (walk/flight.h)
  // Told of each piece from t0 to t1 of ray j that is flown through a medium with the throughput
  // as it stands; NULL: nobody asks.
  void (*flown)(void *data, const struct walk *, int j, double t0, double t1);
  void *flown_data;
  // Takes path j through a medium to its hit in place of a flight, which may end before; NULL:
  // paths fly.
  void (*through)(void *data, struct walk *, int j);
  void *through_data;

  double *u[4][2]; // scratch: pairs of random numbers
  struct {         // scratch of walk_sample_facets
    int first;
    const struct shape *shape[FACETS]; // walk_facet_shape of the block's paths
    int8_t row[FACETS];                // of a path that has one in `facets`
    struct facets facets;
  } block;
  struct shadow { // scratch of connect_lights, [WALK_BATCH] each
    struct ray *ray;
    struct hit *hit;
    double *distance, *value[3];
    uint32_t *emitter;
    int *owner;
    int n;
    uint32_t *medium, *flights; // only where there are media
    uint64_t *path;
  } shadow;
  struct crossing {          // paths before a see-through surface; only where the scene has any
    int n, number;           // of paths that stand before one; of the next crossing since `vertex`
    int *slot;               // [n] which
    int n_passed;            // of those the last walk_cross let pass
    int *passed;             // [n_passed] which
    struct surface *surface; // [n_passed] what they passed; the path's ray begins there now
    struct ray *ray;         // scratch
    struct hit *hit;
    uint64_t *path;
    double *u[2];
  } crossing;
};

// Of n channels: what roulette and collisions go by, so that one channel equals three.
static inline double walk_largest(const double *value, int n) {
  double most = value[0];
  for (int c = 1; c < n; c++) most = most < value[c] ? value[c] : most;
  return most;
}

struct walk *walk_new(const struct scene *, const struct bvh *, struct features, struct arena *);

// From now on eye paths carry their differentials.
void walk_follow_differentials(struct walk *, struct arena *);

// From now on paths meet roulette from their second scattering on, with what both leave of their
// weight: as in pbrt-v4, so that what lies near the eye is not left out.
void walk_delay_roulette(struct walk *, struct arena *);

// Begins iteration i of a run: where things move, at its time, which eye and photon paths share.
void walk_begin(struct walk *, uint64_t seed, uint64_t run, uint64_t i);

// The pairs of random numbers of all paths alive: u[slot][0..1][j].
void walk_random(struct walk *, int slot, uint32_t pair);

// Starts segment j: ray and from.
static inline void walk_start(struct walk *walk, int j, struct vec o, struct vec d,
                              uint32_t leaving) {
  struct ray *ray = &walk->ray[j];
  ray->o = walk->from[j] = o;
  ray->d = d;
  ray->t_max = INFINITY;
  ray->leaving = leaving;
}

// Closest hits of all rays. Where the scene has see-through shapes the paths before one are listed
// in `crossing`, and walk_cross lets each of them pass or not, until none is listed.
void walk_trace(struct walk *);
void walk_cross(struct walk *);

// Both: past all surfaces that let the rays through.
void walk_trace_through(struct walk *);

// For shadow rays, which carry transmittance instead of a choice.
bool walk_meets_see_through(const struct scene *, struct hit);
struct ray walk_ray_beyond(const struct surface *, const struct ray *);

// A path that hit nothing: it left the scene, or it ended in a medium, at hit.t.
static inline bool walk_collided(const struct walk *walk, int j) {
  return walk->hit[j].primitive == PRIMITIVE_NONE && walk->hit[j].t < INFINITY;
}
static inline bool walk_escaped(const struct walk *walk, int j) {
  return walk->hit[j].primitive == PRIMITIVE_NONE && walk->hit[j].t == INFINITY;
}

// Where path j has hit something or collided.
static inline struct vec walk_point(const struct walk *walk, int j) {
  return vec_along(walk->ray[j].o, walk->ray[j].d, walk->hit[j].t);
}

// Ends the paths that left the scene.
void walk_drop_escaped(struct walk *);

// The numbers that paths need at a vertex: u[0] direction, u[1] choice, and u[2][1] the material's
// own where one reads it (else zero, u[2] untouched): walk_bsdf, walk_scatter.
void walk_vertex_random(struct walk *);

// The scattering at the surface that path j has hit.
void walk_bsdf(const struct walk *, int j, const struct surface *, struct bsdf *);

// Moves path `from` to place `to` (closing gaps keeps the order).
void walk_move(struct walk *, int to, int from);

// The same for n paths, in ascending order, to places `to` and on: a while after they were written,
// as a load of what two stores wrote waits until both are in the cache.
void walk_pack(struct walk *, int to, const int *from, int n);

// Samples the bsdf with u[0] (direction) and u[1] (choice, roulette) of path j. Roulette survives
// with the largest channel of the weight, the scaling of radiance by refraction left out.
// False: absorbed. True: ray, from, throughput, pdf and kind are those of the next segment.
bool walk_scatter(struct walk *, int j, const struct surface *, const struct bsdf *);

// The Lambertian facet that path j has hit, which is met the same at every point; NULL: something
// else, or a path that carries differentials (they need more of a surface).
static inline const struct shape *walk_facet_shape(const struct walk *walk, int j) {
  uint32_t primitive = walk->hit[j].primitive;
  if (primitive == PRIMITIVE_NONE || walk->differential) return NULL;
  const struct shape *shape = &walk->scene->shape[walk->scene->shape_of[primitive]];
  return shape->lambert ? shape : NULL;
}

// Its scattering; of the frame only n.
void walk_facet_bsdf(const struct walk *, int j, const struct shape *, struct bsdf *);

// Where the paths of the block from `first` on that have hit Lambertian facets are scattered to:
// u[0] (direction) of each. How many paths are in the block, up to FACETS.
int walk_sample_facets(struct walk *, int first);

// walk_facet_shape of a path of the block.
static inline const struct shape *walk_facet(const struct walk *walk, int j) {
  return walk->block.shape[j - walk->block.first];
}

// walk_scatter of path j that has hit a facet.
bool walk_scatter_facet(struct walk *, int j);

// The same where path j has collided; roulette survives with the largest channel of the albedo.
bool walk_scatter_in_medium(struct walk *, int j);

#endif
