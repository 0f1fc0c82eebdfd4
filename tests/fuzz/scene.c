// Any bytes are a scene or a problem of one line that begins with a place. Files are named relative
// to the corpus, and those outside of it are refused.
#include "scene/reader.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_problem(const char *text) {
  if (strncmp(text, "t.pbrt:", 7) != 0 && strncmp(text, "tests/fuzz/corpus/scene/", 24) != 0)
    abort();
  for (; *text; text++)
    if ((unsigned char)*text < 0x20 && *text != '\t') abort();
}

// A ray passes it in pieces that end after they begin, at most one a plane of the bounds.
static void check_medium(const struct medium *medium) {
  struct ray ray = {{0.1, -0.2, 0.3}, {0.48, 0.6, -0.64}, INFINITY, PRIMITIVE_NONE};
  double t = 0, end, majorant;
  int pieces = 0;
  if (!(medium->g > -1 && medium->g < 1)) abort();
  for (; t < INFINITY && medium->type->piece(medium, &ray, t, &end, &majorant); t = end) {
    struct medium_point at;
    if (!(end > t) || pieces++ > 60) abort();
    medium->type->at(medium, vec_along(ray.o, ray.d, t), &at);
    for (int c = 0; c < 3; c++)
      if (!(at.sigma_a[c] + at.sigma_s[c] <= majorant && at.emission[c] >= 0)) abort();
  }
}

static void check_scene(const struct scene *scene) {
  for (uint32_t k = 0; k < scene->n_primitives; k++)
    if (scene->shape_of[k] >= scene->n_shapes) abort();
  for (uint32_t k = 0; k < scene->n_shapes; k++)
    if (scene->shape[k].material >= scene->n_materials) abort();
  for (uint32_t k = 0; k < scene->n_media; k++) check_medium(&scene->medium[k]);
  for (int i = 0; i < 3; i++)
    if (!(scene->bounds.lo[i] <= scene->bounds.hi[i])) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct arena keep, lists, scratch;
  if (!keep.next) keep = arena_reserve(), lists = arena_reserve(), scratch = arena_reserve();
  struct arena arena = keep;
  struct scene scene;
  struct problem problem = {{0}};
  struct reader reader = {.builder = {.arena = &arena, .scene = &scene},
                          .problem = &problem,
                          .options = {.lenient = size & 1, .own_folder = true},
                          .lists = lists};
  struct text text = {arena_string(&reader.lists, (const char *)data, (ptrdiff_t)size),
                      (ptrdiff_t)size};
  if (read_all(&reader, "t.pbrt", "tests/fuzz/corpus/scene/", text, scratch))
    check_scene(&scene);
  else
    check_problem(problem.text);
  return 0;
}
