// Media that overlap, or end where a lamp thinks they do, are refused with the place.
#include "scene_text.h"

#include "walk/media_check.h"

#define MEDIA                                                                                      \
  "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"                                      \
  "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\"\n"
#define IN_FOG MEDIA "MediumInterface \"\" \"fog\"\n"
#define EYE                                                                                        \
  "LookAt 0 0 -5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 60\n"                            \
  "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 9 WorldBegin\n"
#define POINT "LightSource \"point\" \"point3 from\" [0 4 0]\n"
#define BALL(inside, outside, radius)                                                              \
  "MediumInterface \"" inside "\" \"" outside "\" Shape \"sphere\" \"float radius\" " radius "\n"
#define INTERFACE "Material \"interface\"\n"
#define GLASS "Material \"dielectric\"\n"
#define FLOOR                                                                                      \
  "AttributeBegin Material \"diffuse\" Translate 0 -3 0 Rotate -90 1 0 0\n"                        \
  "Shape \"disk\" \"float radius\" 30 AttributeEnd\n"

static const char *const good[] = {
    MEDIA EYE POINT FLOOR INTERFACE BALL("fog", "", "1"),
    MEDIA EYE POINT FLOOR GLASS BALL("fog", "", "1"),
    // all in fog, a lamp too
    IN_FOG EYE "MediumInterface \"fog\"\n" POINT FLOOR
               "AreaLightSource \"diffuse\" Shape \"sphere\"",
    // one within the other, and a thing in it that says nothing
    MEDIA EYE POINT FLOOR INTERFACE BALL("fog", "", "2")
        BALL("haze", "fog", "1.5") "MediumInterface \"\" \"\" Material \"diffuse\" Shape "
                                   "\"sphere\" \"float radius\" .5",
    // the sky shines on a planet of fog from which the eye looks
    IN_FOG EYE "LightSource \"infinite\" LightSource \"distant\"\n" INTERFACE BALL(
        "fog", "", "20") "MediumInterface \"fog\" Material \"diffuse\" Shape \"sphere\"",
    // a lamp that shines away from the fog
    MEDIA EYE "AttributeBegin AreaLightSource \"diffuse\" Translate 0 0 -5\n"
              "Shape \"disk\" \"float radius\" .1 AttributeEnd\n" INTERFACE BALL("fog", "", "1"),
    MEDIA EYE POINT "LightSource \"infinite\" Shape \"sphere\"",
};

static const struct {
  const char *text, *words[3];
} bad[] = {
    // inside and outside swapped
    {MEDIA EYE POINT INTERFACE BALL("", "fog", "1"),
     {"t.pbrt: media overlap: at (", "a ray from the camera is in a vacuum",
      "the sphere it meets has medium \"fog\" on that side"}},
    // overlap
    {MEDIA EYE POINT INTERFACE BALL("fog", "", "1") "Translate .7 0 0\n" BALL("haze", "", "1"),
     {"media overlap", "is in medium \"fog\"", "has a vacuum on that side"}},
    {MEDIA EYE POINT INTERFACE BALL("fog", "", "1") BALL("haze", "haze", ".5"),
     {"is in medium \"fog\"", "sphere", "has medium \"haze\""}},
    // the camera stands in it and does not know
    {MEDIA EYE POINT INTERFACE BALL("fog", "", "9"),
     {"from the camera is in a vacuum", "sphere", "has medium \"fog\" on that side"}},
    // nor does the lamp; seen from the lamp only
    {MEDIA EYE POINT INTERFACE "Translate 0 4 0\n" BALL("fog", "", ".2"),
     {"from a light is in a vacuum", "sphere", "has medium \"fog\""}},
    {IN_FOG EYE "MediumInterface \"\" \"\" AreaLightSource \"diffuse\" Shape \"sphere\"",
     {"from the camera is in medium \"fog\"", "sphere", "has a vacuum on that side"}},
    // behind glass
    {MEDIA EYE POINT GLASS BALL("fog", "", "1") INTERFACE BALL("haze", "", ".5"),
     {"is in medium \"fog\"", "sphere", "has a vacuum"}},
    {IN_FOG EYE "LightSource \"infinite\" MediumInterface \"fog\" Shape \"sphere\"",
     {"t.pbrt: a ray from the camera leaves the scene from (", "in medium \"fog\"",
      "\"infinite\" shines from infinity: nothing of it arrives through the unbounded medium; e"}},
    {IN_FOG EYE "LightSource \"distant\" MediumInterface \"fog\" Shape \"sphere\"",
     {"leaves the scene", "in medium \"fog\"", "\"distant\" shines from infinity: nothing"}},
    {"MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"float density\" 1\n"
     "MediumInterface \"grid\"\n" EYE "LightSource \"infinite\" Shape \"sphere\"",
     {"leaves the scene", "in medium \"grid\"", "what it emits begins in a vacuum"}},
};

static bool check(const char *text, struct problem *problem) {
  struct scene scene = scene_of(text);
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &test_memory()->lists);
  *problem = (struct problem){{0}};
  return media_check(&scene, bvh, test_memory()->scratch, problem);
}

static void media_that_fit_together_are_accepted(void **state) {
  (void)state;
  struct problem problem;
  for (size_t k = 0; k < sizeof good / sizeof *good; k++)
    if (!check(good[k], &problem)) fail_msg("%s\nis refused: %s", good[k], problem.text);
}

static void media_that_do_not_are_refused_with_the_place(void **state) {
  (void)state;
  struct problem problem;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    if (check(bad[k].text, &problem)) fail_msg("%s\nis accepted", bad[k].text);
    for (int w = 0; w < 3; w++)
      if (!strstr(problem.text, bad[k].words[w]))
        fail_msg("%s\ngives %s\nwithout %s", bad[k].text, problem.text, bad[k].words[w]);
    assert_null(strchr(problem.text, '\n'));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(media_that_fit_together_are_accepted),
      cmocka_unit_test(media_that_do_not_are_refused_with_the_place),
  };
  return cmocka_run_group_tests_name("media_check", tests, NULL, NULL);
}
