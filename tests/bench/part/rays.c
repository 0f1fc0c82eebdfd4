#include "tests/bench/embree.h"

#include "bvh/bvh.h"

#include <string.h>

enum { PHOTON_RAYS = 131072 };

static const char *const scenes[] = {"box", "torus", "ball-1e5", "ball-1e6"};

// What the tree leaves of one kind of rays.
struct job {
  const struct bench_scene *scene;
  struct rays rays;
  struct hit *hit;
  unsigned char *blocked;
};

static void closest(void *data, int repetition) {
  struct job *job = data;
  (void)repetition;
  bvh_closest(job->scene->bvh, job->rays.ray, job->hit, job->rays.n);
}

static void any(void *data, int repetition) {
  struct job *job = data;
  (void)repetition;
  bvh_any(job->scene->bvh, job->rays.ray, job->blocked, job->rays.n);
}

// Padding of a hit is no part of it.
static uint64_t hash_closest(const void *data) {
  const struct job *job = data;
  uint64_t sum = 0;
  for (int j = 0; j < job->rays.n; j++) {
    uint64_t t;
    memcpy(&t, &job->hit[j].t, sizeof t);
    sum = sum * 0x9e3779b97f4a7c15u + (t ^ job->hit[j].primitive);
  }
  return sum;
}

static uint64_t hash_any(const void *data) {
  const struct job *job = data;
  return bench_hash(job->blocked, (size_t)job->rays.n);
}

// The peer's modes, and of how many rays the answer of any differs from ours.
static void add_peer(struct bench *bench, const struct embree *embree, struct job *job,
                     const char *name, bool shadow, bool coherent) {
  const struct rays *rays = &job->rays;
  int differ = 0;
  for (int m = 0; embree_modes[m].name; m++) {
    const struct embree_mode *mode = &embree_modes[m];
    if (mode->any != shadow) continue;
    struct embree_rays *theirs = embree_rays_new(embree, rays, coherent, bench->arena);
    mode->trace(theirs, 0);
    int n = embree_differs(theirs, mode, rays);
    differ = n > differ ? n : differ;
    bench_add(bench, "rays",
              (struct row){.name = arena_format(bench->arena, "%s/%s", name, mode->name),
                           .kind = RATE,
                           .unit = "Mrays/s",
                           .work = 1e-6 * rays->n,
                           .body = mode->trace,
                           .data = theirs});
  }
  bench_add(bench, "rays",
            (struct row){.name = arena_format(bench->arena, "%s/embree-differs", name),
                         .kind = COUNT,
                         .unit = arena_format(bench->arena, "of %d", rays->n),
                         .work = differ});
}

// The first mode of a peer is what ours is compared to.
static void add_kind(struct bench *bench, const struct bench_scene *scene,
                     const struct embree *embree, struct rays rays, const char *kind, bool shadow) {
  const char *name = arena_format(bench->arena, "%s/%s", scene->name, kind);
  struct job *job = arena_new(bench->arena, struct job, 1);
  *job = (struct job){scene, rays, arena_new(bench->arena, struct hit, rays.n),
                      arena_new(bench->arena, unsigned char, rays.n)};
  rays_check(scene, &rays, name);
  if (embree) add_peer(bench, embree, job, name, shadow, strcmp(kind, "camera") == 0);
  const char *base = embree ? arena_format(bench->arena, "%s/embree-1", name) : NULL;
  bench_add(bench, "rays",
            (struct row){.name = arena_format(bench->arena, "%s/photonlab", name),
                         .kind = RATE,
                         .unit = "Mrays/s",
                         .work = 1e-6 * rays.n,
                         .body = shadow ? any : closest,
                         .data = job,
                         .hash = shadow ? hash_any : hash_closest,
                         .base = base});
}

static void add_scene(struct bench *bench, const struct bench_scene *scene) {
  struct embree *embree = embree_new(&scene->scene, bench->arena);
  struct rays camera = rays_of_camera(scene, bench->arena);
  struct rays photons = rays_of_photons(scene, PHOTON_RAYS, bench->arena);
  add_kind(bench, scene, embree, photons, "photon", false);
  add_kind(bench, scene, embree, camera, "camera", false);
  add_kind(bench, scene, embree, rays_to_lights(scene, &photons, bench->arena), "photon-shadow",
           true);
  add_kind(bench, scene, embree, rays_to_lights(scene, &camera, bench->arena), "camera-shadow",
           true);
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++)
    if (bench_wants(bench, "rays", scenes[s])) add_scene(bench, bench_scene(bench, scenes[s]));
}

const struct part_type part_rays = {
    "rays", "photon paths' and camera's rays (closest hit), and from there to lights (any hit)", 5,
    rows};
