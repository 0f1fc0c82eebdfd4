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

static void add_count(struct bench *bench, const char *name, int n, int of) {
  bench_add(
      bench, "rays",
      (struct row){
          .name = name, .kind = COUNT, .unit = arena_format(bench->arena, "of %d", of), .work = n});
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
  add_count(bench, arena_format(bench->arena, "%s/embree-differs", name), differ, rays->n);
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

static void add_leaks_of_peer(struct bench *bench, const struct bench_scene *scene,
                              const struct rays *rays, bool robust) {
  struct embree *embree = embree_new(&scene->scene, robust, bench->arena);
  if (!embree) return;
  struct embree_rays *peer = embree_rays_new(embree, rays, false, bench->arena);
  int n = 0;
  embree_modes[0].trace(peer, 0);
  for (int j = 0; j < rays->n; j++) n += !rays_hit_largest(scene, embree_primitive(peer, j));
  add_count(bench, robust ? "leaks/embree-robust" : "leaks/embree-1", n, rays->n);
  embree_release(embree);
}

// Rays from inside a closed mesh that do not hit it.
static void add_leaks(struct bench *bench) {
  const struct bench_scene *scene = bench_scene(bench, "ball-1e5");
  struct rays rays = rays_at_edges(scene, PHOTON_RAYS, bench->arena);
  int n = 0;
  for (int j = 0; j < rays.n; j++) n += !rays_hit_largest(scene, rays.hit[j].primitive);
  add_count(bench, "leaks/photonlab", n, rays.n);
  add_leaks_of_peer(bench, scene, &rays, false);
  add_leaks_of_peer(bench, scene, &rays, true);
}

static void add_scene(struct bench *bench, const struct bench_scene *scene) {
  struct embree *embree = embree_new(&scene->scene, false, bench->arena);
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
  if (bench_wants(bench, "rays", "leaks")) add_leaks(bench);
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++)
    if (bench_wants(bench, "rays", scenes[s])) add_scene(bench, bench_scene(bench, scenes[s]));
}

const struct part_type part_rays = {
    "rays", "photon paths' and camera's rays (closest hit), and from there to lights (any hit)", 5,
    rows};
