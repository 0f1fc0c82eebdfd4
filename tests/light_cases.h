// Lights that all tests of the rows loop over: each registered one, narrow, wide, with images.
#ifndef TESTS_LIGHT_CASES_H
#define TESTS_LIGHT_CASES_H

#include "tests/light_statistics.h"

static struct arena arena;

// An image of 7 x 7 texels in three colours that differ by factors of hundreds, some of them black.
#define IMAGE "image.pfm"

static char image_folder[] = P_tmpdir "/photonlab-lights-XXXXXX", image_path[128];

static inline void write_image(void) {
  assert_non_null(mkdtemp(image_folder));
  light_folder = image_folder;
  snprintf(image_path, sizeof image_path, "%s/" IMAGE, image_folder);
  FILE *file = fopen(image_path, "wb");
  assert_non_null(file);
  fprintf(file, "PF\n7 7\n-1\n");
  for (int k = 0; k < 7 * 7; k++) {
    float value = k % 5 == 0 ? 0 : (float)(1 + 200 * (k % 11 == 3) + k % 3);
    const float rgb[3] = {value, k % 2 ? 0.25f * value : value, 0.5f + value};
    fwrite(rgb, sizeof *rgb, 3, file);
  }
  fclose(file);
}

static inline void remove_image(void) {
  unlink(image_path);
  rmdir(image_folder);
}

// One row of light_types, or a variant of it. Two colours, so that channels cannot be mixed up. The
// patch is inside the scene's bounds (LIGHT_PLANE's square), with nothing between it and the light.
struct case_of_light {
  const char *row, *text;
  struct vec centre, n;
  double half;
};

#define UP                                                                                         \
  { 0, 0, 1 }
#define TILTED                                                                                     \
  { 0.36, -0.48, 0.8 }
#define AIMED " \"point3 from\" [1 2 3] \"point3 to\" [1.36 1.52 2.2] "

static const struct case_of_light cases[] = {
    {"point", "LightSource \"point\" \"point3 from\" [1 2 3] \"rgb I\" [2 1 3]", {1, 2, 2}, UP, 1},
    {"point",
     "LightSource \"point\" \"string emission\" \"lambertian\" \"rgb I\" [2 1 3]" AIMED,
     {1.36, 1.52, 2.2},
     UP,
     1},
    {"distant", "LightSource \"distant\" \"rgb L\" [3 1 2]" AIMED, {0, 0, 0}, UP, 3},
    {"beam",
     "LightSource \"beam\" \"rgb power\" [3 1 2] \"float radius\" 1.7" AIMED,
     {1.36, 1.52, 2.2},
     UP,
     1},
    {"spot", "LightSource \"spot\" \"rgb I\" [3 1 2]" AIMED, {1.36, 1.52, 2.2}, UP, 0.5},
    {"spot",
     "LightSource \"spot\" \"rgb I\" [3 1 2] \"float coneangle\" 85 \"float conedeltaangle\" "
     "85" AIMED,
     {1.5, 1.2, 2.2},
     TILTED,
     0.8},
    {"spot",
     "LightSource \"spot\" \"rgb I\" [3 1 2] \"float coneangle\" 160 \"float conedeltaangle\" "
     "30" AIMED,
     {1.5, 1.2, 2.2},
     TILTED,
     2},
    {"goniometric",
     "AttributeBegin\nTranslate 1 2 3\nRotate 40 0.3 0.2 1\nLightSource \"goniometric\" \"rgb I\" "
     "[2 1 3] \"string filename\" \"" IMAGE "\" \"float power\" 5\nAttributeEnd",
     {1, 2, 2},
     UP,
     1},
    {"projection",
     "AttributeBegin\nTranslate 1 2 3\nRotate 160 0.3 1 0\nScale -1 1 1\nLightSource "
     "\"projection\" \"float fov\" 110 \"string filename\" \"" IMAGE "\" \"float power\" 5\n"
     "AttributeEnd",
     {1, 2, 2},
     UP,
     1},
    {"infinite", "LightSource \"infinite\" \"rgb L\" [3 1 2]", {0.4, -0.3, 0.1}, TILTED, 2},
    {"infinite",
     "AttributeBegin\nRotate 40 0.3 0.2 1\nScale -1 1 1\nLightSource \"infinite\" \"string "
     "filename\" \"" IMAGE "\" \"float scale\" 0.7\nAttributeEnd",
     {0.4, -0.3, 0.1},
     TILTED,
     2},
    {"diffuse",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 1 2]\nTranslate 0 0 1.3\n"
     "Rotate 170 1 0 0\nShape \"disk\" \"float radius\" 0.8\nAttributeEnd",
     {0.4, 0, 0},
     UP,
     0.9},
    {"diffuse",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"blackbody L\" 3000 \"float power\" 5\n"
     "Translate 0 0 1.3\nShape \"sphere\" \"float radius\" 0.5\nAttributeEnd",
     {0.4, 0, 0},
     TILTED,
     0.9},
    {"diffuse",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"string filename\" \"" IMAGE
     "\" \"bool twosided\" "
     "true \"float power\" 3\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 "
     "P\" "
     "[-1 -1 1.3 1 -1 1.3 1 1 1.3 -1 1 1.3] \"point2 uv\" [0 0 1 0 1 1 0 1]\nAttributeEnd",
     {-0.4, 0.2, 0},
     UP,
     0.9},
    {"diffuse",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 1 2]\nReverseOrientation\nShape "
     "\"bilinearmesh\" \"point3 P\" [-1 -1 1.3 1 -1 1 -1 1 1 1 1 1.6] \"float alpha\" 0.4\n"
     "AttributeEnd",
     {-0.4, 0.2, 0},
     UP,
     0.9},
    {"diffuse",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 1 2]\nTranslate 0 0 1\nRotate 90 0 "
     "1 "
     "0\nShape \"cylinder\" \"float radius\" 0.3 \"float phimax\" 200 \"float alpha\" 0\n"
     "AttributeEnd",
     {0.4, -0.2, 0},
     UP,
     0.9},
};
enum { N_CASES = sizeof cases / sizeof *cases };

static inline struct scene scene_of(const struct case_of_light *c) {
  return light_scene(arena_format(&arena, "%s%s", c->text, LIGHT_PLANE), &arena);
}

#endif
