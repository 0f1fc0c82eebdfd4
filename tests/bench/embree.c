#include "tests/bench/embree.h"

#ifdef BENCH_EMBREE
#include <embree3/rtcore.h>
#include <math.h>
#include <string.h>

enum { PACKET = 16, STREAM = 256 };

struct embree {
  RTCDevice device;
  RTCScene scene;
};

// Ray and answer in one piece of memory, as Embree wants them; they are copied before each trace,
// which writes to them.
struct embree_rays {
  RTCScene scene;
  enum RTCIntersectContextFlags flags;
  int n;
  struct RTCRayHit *single;
  struct RTCRayHit16 *packet;
  uint32_t *primitive; // the answers: of any hit 0 or RTC_INVALID_GEOMETRY_ID
  float *t;
};

// Our rays leave a primitive and start at it; Embree's leave a distance behind.
static const float near = 1e-4f;

static bool only_triangles(const struct scene *scene) {
  return scene->n_triangles == scene->n_primitives;
}

struct embree *embree_new(const struct scene *scene, bool robust, struct arena *arena) {
  if (!only_triangles(scene)) return NULL;
  struct embree *embree = arena_new(arena, struct embree, 1);
  embree->device = rtcNewDevice("threads=1");
  embree->scene = rtcNewScene(embree->device);
  RTCGeometry mesh = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 sizeof scene->position[0], scene->n_positions),
         scene->position, scene->n_positions * sizeof scene->position[0]);
  memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                 sizeof scene->triangle[0], scene->n_triangles),
         scene->triangle, scene->n_triangles * sizeof scene->triangle[0]);
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(embree->scene, mesh);
  rtcReleaseGeometry(mesh);
  rtcSetSceneFlags(embree->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcCommitScene(embree->scene);
  return embree;
}

void embree_release(struct embree *embree) {
  rtcReleaseScene(embree->scene);
  rtcReleaseDevice(embree->device);
}

static void set_single(struct RTCRayHit *out, const struct ray *ray) {
  *out = (struct RTCRayHit){
      .ray = {.org_x = (float)ray->o.x,
              .org_y = (float)ray->o.y,
              .org_z = (float)ray->o.z,
              .tnear = near,
              .dir_x = (float)ray->d.x,
              .dir_y = (float)ray->d.y,
              .dir_z = (float)ray->d.z,
              .tfar = (float)ray->t_max,
              .mask = ~0u},
      .hit = {.primID = RTC_INVALID_GEOMETRY_ID, .geomID = RTC_INVALID_GEOMETRY_ID}};
}

static void set_lane(struct RTCRayHit16 *out, int lane, const struct RTCRayHit *from) {
  out->ray.org_x[lane] = from->ray.org_x, out->ray.org_y[lane] = from->ray.org_y;
  out->ray.org_z[lane] = from->ray.org_z, out->ray.tnear[lane] = near;
  out->ray.dir_x[lane] = from->ray.dir_x, out->ray.dir_y[lane] = from->ray.dir_y;
  out->ray.dir_z[lane] = from->ray.dir_z, out->ray.tfar[lane] = from->ray.tfar;
  out->ray.time[lane] = 0, out->ray.mask[lane] = ~0u, out->ray.flags[lane] = 0;
  out->hit.primID[lane] = out->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  out->hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

struct embree_rays *embree_rays_new(const struct embree *embree, const struct rays *rays,
                                    bool coherent, struct arena *arena) {
  struct embree_rays *out = arena_new(arena, struct embree_rays, 1);
  int n_packets = (rays->n + PACKET - 1) / PACKET;
  out->scene = embree->scene;
  out->flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_NONE;
  out->n = rays->n;
  out->single = arena_alloc(arena, rays->n, sizeof(struct RTCRayHit), 64);
  out->packet = arena_alloc(arena, n_packets, sizeof(struct RTCRayHit16), 64);
  out->primitive = arena_new(arena, uint32_t, n_packets * PACKET);
  out->t = arena_new(arena, float, n_packets *PACKET);
  for (int j = 0; j < rays->n; j++) {
    set_single(&out->single[j], &rays->ray[j]);
    set_lane(&out->packet[j / PACKET], j % PACKET, &out->single[j]);
  }
  return out;
}

static struct RTCIntersectContext context_of(const struct embree_rays *rays) {
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = rays->flags;
  return context;
}

static void keep(struct embree_rays *rays, int j, uint32_t primitive, float t) {
  rays->primitive[j] = primitive;
  rays->t[j] = t;
}

// Of any hit: tfar is -infinity where something is hit.
static void keep_any(struct embree_rays *rays, int j, float tfar) {
  keep(rays, j, tfar < 0 ? 0 : RTC_INVALID_GEOMETRY_ID, tfar);
}

static void closest_1(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  (void)repetition;
  for (int j = 0; j < rays->n; j++) {
    struct RTCRayHit ray = rays->single[j];
    rtcIntersect1(rays->scene, &context, &ray);
    keep(rays, j, ray.hit.primID, ray.ray.tfar);
  }
}

static void any_1(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  (void)repetition;
  for (int j = 0; j < rays->n; j++) {
    struct RTCRay ray = rays->single[j].ray;
    rtcOccluded1(rays->scene, &context, &ray);
    keep_any(rays, j, ray.tfar);
  }
}

// Which lanes of the packet from ray j hold one.
static void lanes_valid(const struct embree_rays *rays, int j, int valid[PACKET]) {
  for (int lane = 0; lane < PACKET; lane++) valid[lane] = j + lane < rays->n ? -1 : 0;
}

static void closest_16(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  _Alignas(64) int valid[PACKET];
  (void)repetition;
  for (int j = 0; j < rays->n; j += PACKET) {
    struct RTCRayHit16 packet = rays->packet[j / PACKET];
    lanes_valid(rays, j, valid);
    rtcIntersect16(valid, rays->scene, &context, &packet);
    memcpy(rays->primitive + j, packet.hit.primID, sizeof packet.hit.primID);
    memcpy(rays->t + j, packet.ray.tfar, sizeof packet.ray.tfar);
  }
}

static void any_16(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  _Alignas(64) int valid[PACKET];
  (void)repetition;
  for (int j = 0; j < rays->n; j += PACKET) {
    struct RTCRay16 packet = rays->packet[j / PACKET].ray;
    lanes_valid(rays, j, valid);
    rtcOccluded16(valid, rays->scene, &context, &packet);
    for (int lane = 0; lane < PACKET; lane++) keep_any(rays, j + lane, packet.tfar[lane]);
  }
}

static void closest_stream(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  struct RTCRayHit stream[STREAM];
  (void)repetition;
  for (int first = 0; first < rays->n; first += STREAM) {
    int left = rays->n - first, n = left < STREAM ? left : STREAM;
    memcpy(stream, rays->single + first, (size_t)n * sizeof *stream);
    rtcIntersect1M(rays->scene, &context, stream, (unsigned)n, sizeof *stream);
    for (int j = 0; j < n; j++) keep(rays, first + j, stream[j].hit.primID, stream[j].ray.tfar);
  }
}

static void any_stream(void *data, int repetition) {
  struct embree_rays *rays = data;
  struct RTCIntersectContext context = context_of(rays);
  struct RTCRay stream[STREAM];
  (void)repetition;
  for (int first = 0; first < rays->n; first += STREAM) {
    int left = rays->n - first, n = left < STREAM ? left : STREAM;
    for (int j = 0; j < n; j++) stream[j] = rays->single[first + j].ray;
    rtcOccluded1M(rays->scene, &context, stream, (unsigned)n, sizeof *stream);
    for (int j = 0; j < n; j++) keep_any(rays, first + j, stream[j].tfar);
  }
}

const struct embree_mode embree_modes[] = {{"embree-1", false, closest_1},
                                           {"embree-16", false, closest_16},
                                           {"embree-stream", false, closest_stream},
                                           {"embree-1", true, any_1},
                                           {"embree-16", true, any_16},
                                           {"embree-stream", true, any_stream},
                                           {NULL, false, NULL}};

// The same primitive, or one as far away: at an edge either is right.
static bool agrees(const struct embree_rays *rays, int j, const struct hit *hit, bool any) {
  bool theirs = rays->primitive[j] != RTC_INVALID_GEOMETRY_ID;
  if (theirs != (hit->primitive != PRIMITIVE_NONE)) return false;
  if (any || !theirs || rays->primitive[j] == hit->primitive) return true;
  return fabs((double)rays->t[j] - hit->t) <= 1e-5 * hit->t;
}

int embree_differs(const struct embree_rays *theirs, const struct embree_mode *mode,
                   const struct rays *ours) {
  int n = 0;
  for (int j = 0; j < ours->n; j++) n += !agrees(theirs, j, &ours->hit[j], mode->any);
  return n;
}

uint32_t embree_primitive(const struct embree_rays *rays, int j) { return rays->primitive[j]; }

#else
const struct embree_mode embree_modes[] = {{NULL, false, NULL}};
struct embree *embree_new(const struct scene *scene, bool robust, struct arena *arena) {
  (void)scene, (void)robust, (void)arena;
  return NULL;
}
void embree_release(struct embree *embree) { (void)embree; }
struct embree_rays *embree_rays_new(const struct embree *embree, const struct rays *rays,
                                    bool coherent, struct arena *arena) {
  (void)embree, (void)rays, (void)coherent, (void)arena;
  return NULL;
}
int embree_differs(const struct embree_rays *theirs, const struct embree_mode *mode,
                   const struct rays *ours) {
  (void)theirs, (void)mode, (void)ours;
  return 0;
}
uint32_t embree_primitive(const struct embree_rays *rays, int j) {
  (void)rays, (void)j;
  return PRIMITIVE_NONE;
}
#endif
