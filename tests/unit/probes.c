// What probes see through media, and what the log says of it.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run/plan.h"
#include "tests/unit/run_fixture.h"

#include <math.h>

#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.1 0.1 0.1] "
#define FILM                                                                                       \
  "Camera \"perspective\" \"float fov\" 20\nFilm \"rgb\" \"integer xresolution\" 9 \"integer "     \
  "yresolution\" 9\n"
#define LAMP "LightSource \"point\" \"point3 from\" [0 5 0]\n"
#define BALL "Shape \"sphere\" \"float radius\" 1\n"

// The camera is at (0, 0, -4) and looks at the origin, or away from it.
static const char *scene_file(const char *name, const char *towards, const char *media,
                              const char *world) {
  const char *path = path_in(arena_format(&arena, "%s.pbrt", name));
  write_text(path,
             arena_format(&arena, "LookAt 0 0 -4  0 0 %s  0 1 0\n%s\n%s" FILM "WorldBegin\n%s",
                          towards, FOG, media, world));
  return path;
}

static bool planned(const char *scene, struct plan *plan, struct problem *problem) {
  struct experiment experiment =
      experiment_of("probes", arena_format(&arena,
                                           "scene: %s\nintegrator: probabilistic\nalpha: 4/7\n"
                                           "radius: 0.5\nphotons: 10\nprobes: [[4, 4]]\n"
                                           "iterations: 3\nruns: 2\nreference: none\n",
                                           scene));
  struct experiment *kept = arena_new(&arena, struct experiment, 1);
  *kept = experiment;
  *problem = (struct problem){0};
  return plan_make(kept, quiet, &arena, plan, problem);
}

static struct probe probe_of(const char *scene) {
  struct plan plan;
  struct problem problem;
  struct probe probe;
  if (!planned(scene, &plan, &problem)) fail_msg("%s", problem.text);
  plan_probes(&plan.group[0], &probe, arena);
  return probe;
}

static void assert_seen(const char *scene, bool hit, bool volume, bool ends) {
  struct probe probe = probe_of(scene);
  if (probe.hit != hit || probe.volume != volume || probe.ends != ends)
    fail_msg("%s: surface %d, medium %d that ends %d", scene, probe.hit, probe.volume, probe.ends);
}

// Fog everywhere: before a ball, and where there is nothing else.
#define IN_FOG "MediumInterface \"\" \"fog\"\n"
static void in_fog(void **state) {
  (void)state;
  const char *world = "MediumInterface \"fog\" \"fog\"\n" LAMP BALL;
  assert_seen(scene_file("ball", "0", IN_FOG, world), true, true, true);
  assert_seen(scene_file("away", "-9", IN_FOG, world), false, true, false);
}

// A ball of fog in a vacuum, alone and before a wall.
static void fog_ball(void **state) {
  (void)state;
  const char *ball =
      LAMP "AttributeBegin\nMediumInterface \"fog\" \"\"\nMaterial \"interface\"\n" BALL
           "AttributeEnd\n";
  const char *wall = arena_format(&arena, "%sTranslate 0 0 3\n" BALL, ball);
  assert_seen(scene_file("fog-ball", "0", "", ball), false, true, true);
  assert_seen(scene_file("fog-before-ball", "0", "", wall), true, true, true);
}

static void nothing_at_all(void **state) {
  (void)state;
  struct plan plan;
  struct problem problem;
  const char *ball =
      LAMP "AttributeBegin\nMediumInterface \"fog\" \"\"\nMaterial \"interface\"\n" BALL
           "AttributeEnd\n";
  assert_seen(scene_file("clear", "0", "", LAMP BALL), true, false, false);
  assert_false(planned(scene_file("nothing", "-9", "", LAMP BALL), &plan, &problem));
  assert_non_null(strstr(problem.text, "probe [4, 4] sees no surface, choose"));
  assert_false(planned(scene_file("no-fog", "-9", "", ball), &plan, &problem));
  assert_non_null(strstr(problem.text, "sees no surface and no medium"));
}

// Radii of probes in media are those of r^3, from radius-volume.
static void logged(void **state) {
  (void)state;
  const char *world = "MediumInterface \"fog\" \"fog\"\n" LAMP BALL;
  const char *scene = scene_file("logged", "-9", IN_FOG, world);
  struct results results = run(
      "probes-logged",
      arena_format(&arena,
                   "scene: %s\nintegrator: probabilistic\nalpha: 4/7\nradius: 0.5\n"
                   "radius-volume: 0.25\nphotons: 10\nprobes: [[4, 4]]\niterations: 2\nruns: 2\n"
                   "reference: none\n",
                   scene));
  struct probe probe = results.probe[0][0];
  assert_true(!probe.hit && probe.volume && !probe.ends);
  char *log = read_text(path_in("probes-logged/log.csv"));
  double second = 0.25 * cbrt((1 + 4.0 / 7) / 2), radius = NAN;
  char *row = strstr(log, ",iteration,2,");
  assert_non_null(row);
  assert_int_equal(sscanf(row, ",iteration,2,%lf,", &radius), 1);
  assert_true(fabs(radius - second) < 1e-15);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(in_fog),
      cmocka_unit_test(fog_ball),
      cmocka_unit_test(nothing_at_all),
      cmocka_unit_test(logged),
  };
  return cmocka_run_group_tests_name("probes", tests, make_folder, remove_folder);
}
