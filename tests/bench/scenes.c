// The scenes that are timed: ours, those of the folder --perf, and a knobbly ball of as many
// triangles as its name says, in a closed room; made here, written as pbrt-v4 reads it too.
#include "base/file.h"
#include "tests/bench/bench.h"

#include "bvh/bvh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILM = 256, MOST_SCENES = 16 };

// ---- the ball ----
// A point of the cube's surface moved to a sphere whose radius waves. A function of the place
// alone, so that neighbouring faces share its bits and the mesh is closed.
static void knob(const double at[3], float out[3]) {
  double length = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]), n[3];
  for (int k = 0; k < 3; k++) n[k] = at[k] / length;
  double r = 0.6 + 0.06 * sin(9 * n[0] + 1) * sin(9 * n[1] + 2) * sin(9 * n[2] + 3) +
             0.01 * sin(40 * n[0]) * sin(40 * n[1]) * sin(40 * n[2]);
  const double center[3] = {0, 0.8, -0.6};
  for (int k = 0; k < 3; k++) out[k] = (float)(center[k] + r * n[k]);
}

static void write_vertices(FILE *out, int n) {
  for (int face = 0; face < 6; face++)
    for (int i = 0; i <= n; i++)
      for (int j = 0; j <= n; j++) {
        double at[3];
        float p[3];
        at[face / 2] = face % 2 ? 1 : -1;
        at[(face / 2 + 1) % 3] = 2.0 * i / n - 1;
        at[(face / 2 + 2) % 3] = 2.0 * j / n - 1;
        knob(at, p);
        fwrite(p, sizeof p, 1, out);
      }
}

static void write_faces(FILE *out, int n) {
  for (int face = 0; face < 6; face++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        uint32_t a = (uint32_t)((face * (n + 1) + i) * (n + 1) + j), b = a + (uint32_t)n + 1;
        const uint32_t corner[2][3] = {{a, b, b + 1}, {a, b + 1, a + 1}};
        for (int half = 0; half < 2; half++) {
          fputc(3, out);
          fwrite(corner[half], sizeof corner[half], 1, out);
        }
      }
}

static void write_ply(FILE *out, int n) {
  fprintf(out,
          "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n"
          "property float y\nproperty float z\nelement face %d\n"
          "property list uchar int vertex_indices\nend_header\n",
          6 * (n + 1) * (n + 1), 12 * n * n);
  write_vertices(out, n);
  write_faces(out, n);
}

static const char room[] =
    "LookAt 0 1 -2.9  0 0.9 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" [45]\n"
    "Film \"rgb\" \"integer xresolution\" [256] \"integer yresolution\" [256]\n"
    "  \"string filename\" [\"ball.exr\"]\n"
    "Integrator \"path\" \"integer maxdepth\" [64]\n"
    "WorldBegin\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\n"
    "Shape \"trianglemesh\" \"point3 P\" [-1 0 -3 -1 0 1 1 0 1 1 0 -3 -1 2 -3 -1 2 1 1 2 1 1 2 "
    "-3]\n"
    "  \"integer indices\" [0 1 2 0 2 3 4 7 6 4 6 5 1 5 6 1 6 2 0 4 5 0 5 1 3 2 6 3 6 7 0 3 7 0 7 "
    "4]\n"
    "AttributeBegin\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [15 15 15]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point3 P\" [-0.25 1.99 -0.25 0.25 1.99 -0.25 0.25 1.99 0.25 -0.25 1.99 0.25]\n"
    "AttributeEnd\n";

static void commit(struct file_out *out) {
  struct problem problem = {{0}};
  if (!file_commit(out, &problem)) die("%s", problem.text);
}

static struct file_out begin(const char *path) {
  struct file_out out;
  struct problem problem = {{0}};
  if (!file_begin(&out, path, &problem)) die("%s", problem.text);
  return out;
}

static const char *make_ball(struct bench *bench, const char *name, double triangles) {
  const char *path = arena_format(bench->arena, "%s/%s.pbrt", bench->folder, name);
  struct problem problem = {{0}};
  if (!file_make_directory(bench->folder, &problem)) die("%s", problem.text);
  struct file_out mesh = begin(arena_format(bench->arena, "%s/%s.ply", bench->folder, name));
  write_ply(mesh.stream, (int)ceil(sqrt(triangles / 12)));
  commit(&mesh);
  struct file_out scene = begin(path);
  fprintf(scene.stream, "%sShape \"plymesh\" \"string filename\" [\"%s.ply\"]\n", room, name);
  commit(&scene);
  return path;
}

// ---- names ----
static const struct known {
  const char *name, *file;
  double triangles; // of a ball that is made; 0: the file is there
  bool perf;
} known[] = {
    {"box", "scenes/cornell-box.pbrt", 0, false},
    {"torus", "scenes/torus-in-glass.pbrt", 0, false},
    {"ball-1e5", NULL, 1e5, false},
    {"ball-1e6", NULL, 1e6, false},
    {"cornell-gray", "cornell-gray.pbrt", 0, true},
    {"cornell-glass", "cornell-glass.pbrt", 0, true},
    {"cornell-torus-glass", "cornell-torus-glass.pbrt", 0, true},
};

static const char *path_of(struct bench *bench, const char *name) {
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
    if (strcmp(known[k].name, name) != 0) continue;
    if (known[k].triangles > 0) return make_ball(bench, name, known[k].triangles);
    if (!known[k].perf) return known[k].file;
    const char *path = arena_format(bench->arena, "%s/%s", bench->perf, known[k].file);
    return file_exists(path) ? path : NULL;
  }
  die("bench: no scene %s", name);
}

static void set_film(struct bench_scene *scene, struct arena *arena) {
  struct camera *camera = &scene->scene.camera;
  camera->width = camera->height = camera->full_width = camera->full_height = FILM;
  scene->n_pixels = FILM * FILM;
  scene->pixel = arena_new(arena, struct pixel, scene->n_pixels);
  for (int j = 0; j < scene->n_pixels; j++) scene->pixel[j] = (struct pixel){j % FILM, j / FILM};
}

const struct bench_scene *bench_scene(struct bench *bench, const char *name) {
  static struct bench_scene *loaded[MOST_SCENES];
  int n = 0;
  for (; loaded[n]; n++)
    if (strcmp(loaded[n]->name, name) == 0) return loaded[n];
  const char *path = path_of(bench, name);
  if (!path) return NULL;
  struct bench_scene *scene = loaded[n] = arena_new(bench->arena, struct bench_scene, 1);
  struct problem problem = {{0}};
  scene->name = name;
  if (!scene_read(path, bench->arena, &scene->scene, &problem)) die("%s", problem.text);
  scene->bvh = bvh_build(&scene->scene, (struct bvh_options){.threads = 1}, bench->arena);
  set_film(scene, bench->arena);
  return scene;
}
