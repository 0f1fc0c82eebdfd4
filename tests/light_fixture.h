// Scenes for the tests of the lights: the text of a pbrt file, read by the reader itself.
#ifndef TESTS_LIGHT_FIXTURE_H
#define TESTS_LIGHT_FIXTURE_H

#include "base/file.h"
#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double pi = 0x1.921fb54442d18p+1;

// Where the files are written; a test that leaves any there sets a folder of its own.
static const char *light_folder = P_tmpdir;

// Reads `world` after a camera; false: problem set.
static inline bool light_scene_try(const char *world, struct arena *arena, struct scene *scene,
                                   struct problem *problem) {
  char path[128];
  snprintf(path, sizeof path, "%s/photonlab-light-XXXXXX", light_folder);
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  FILE *file = fdopen(fd, "w");
  fprintf(file, "LookAt 0 0 9  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n%s\n", world);
  fclose(file);
  *problem = (struct problem){0};
  bool read = scene_read(path, arena, scene, problem);
  unlink(path);
  return read;
}

static inline struct scene light_scene(const char *world, struct arena *arena) {
  struct scene scene = {0};
  struct problem problem;
  if (!light_scene_try(world, arena, &scene, &problem)) fail_msg("%s", problem.text);
  return scene;
}

// A receiver, for what only wants a light.
#define LIGHT_PLANE                                                                                \
  "\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "                                    \
  "\"point3 P\" [-4 -4 0 4 -4 0 4 4 0 -4 4 0]\n"

// All colours of these scenes are equal unless a test says otherwise: one number an answer.
static inline struct light_closed_form light_form(const struct scene *scene, struct vec p,
                                                  struct vec n) {
  struct light_closed_form form;
  const struct light *light = &scene->light[0];
  assert_true(light->type->closed_form(scene, light, p, n, &form));
  return form;
}

static inline double light_irradiance(const struct scene *scene, struct vec p, struct vec n) {
  return light_form(scene, p, n).irradiance[0];
}

#endif
