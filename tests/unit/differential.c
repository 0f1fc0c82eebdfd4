// The pixel's width on a surface against closed forms of Gaussian optics, and against neighbouring
// pixels traced themselves.
#include "bvh/bvh.h"
#include "scene_text.h"
#include "walk/eye.h"

// A pinhole at the origin that looks along z, with pixels of 2 tan(10 degrees) / 2001 = 1.8e-4 rad.
enum { FILM = 2001, CENTRE = 1000 };
#define FILM_TEXT                                                                                  \
  "Film \"rgb\" \"integer xresolution\" 2001 \"integer yresolution\" 2001\nPixelFilter \"box\"\n"
#define PINHOLE                                                                                    \
  FILM_TEXT "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n"
#define MIRROR "Material \"conductor\" \"rgb reflectance\" [1 1 1] \"float roughness\" 0\n"
#define GLASS "Material \"dielectric\" \"float eta\" 1.5\n"
#define DIFFUSE "Material \"diffuse\"\n"
#define DISK(place) "AttributeBegin\n" place " Shape \"disk\" \"float radius\" 40\nAttributeEnd\n"

static double pixel_width(void) { return 2 * tan(acos(-1.0) / 18) / FILM; }

struct seen {
  double footprint, across;
  double traced; // the footprint from the points that the four neighbours see
};

// Through `vertices` specular bounces: which of them a path takes is random, so iterations are
// tried until the pixel and its neighbours agree.
static struct seen look(const char *text, struct pixel at, int vertices) {
  struct scene scene = scene_of(text);
  struct arena arena = arena_reserve();
  struct bvh *bvh = bvh_build(&scene, (struct bvh_options){0}, &arena);
  struct walk *walk = walk_new(&scene, bvh, scene_features(&scene), &arena);
  struct pixel pixel[5] = {
      at, {at.x - 1, at.y}, {at.x + 1, at.y}, {at.x, at.y - 1}, {at.x, at.y + 1}};
  struct eye_point point[5], met;
  walk_follow_differentials(walk, &arena);
  walk->key = rng_key(rng_hash_name("differential"), 1, RNG_EYE);
  for (int k = 0; k < 5; k++) {
    point[k].hit = false;
    for (uint64_t i = 1; i < 2000 && !point[k].hit; i++) {
      walk_begin(walk, 0, 1, i);
      eye_trace(walk, &pixel[k], 1, false, 64, &met);
      if (met.hit && met.vertex == vertices) point[k] = met;
    }
    if (!point[k].hit) fail_msg("no path of %d bounces in: %s", vertices, text);
  }
  struct vec dx = vec_scale(vec_sub(point[2].p, point[1].p), 0.5),
             dy = vec_scale(vec_sub(point[4].p, point[3].p), 0.5);
  double traced = sqrt((vec_dot(dx, dx) + vec_dot(dy, dy)) / 2);
  arena_release(arena);
  return (struct seen){point[0].footprint, point[0].across, traced};
}

static const struct pixel centre = {CENTRE, CENTRE};

// The derivatives at the camera are good to 1e-10 (differential.c), those of normals to 1e-9, and
// the fov is a float.
static void check(double measured, double width) {
  double expected = width * pixel_width();
  if (!(fabs(measured / expected - 1) < 1e-7))
    fail_msg("%.12g instead of %.12g", measured, expected);
}

static void planes(void **state) {
  (void)state;
  struct seen seen = look(PINHOLE DIFFUSE DISK("Translate 0 0 3"), centre, 0);
  check(seen.footprint, 3);
  check(seen.across, 3);
  // A plane across the view is as wide everywhere; the path to it is longer at the edge.
  seen = look(PINHOLE DIFFUSE DISK("Translate 0 0 3"), (struct pixel){300, 1700}, 0);
  check(seen.footprint, 3);
  // Tilted by 60 degrees: twice as long in one direction.
  seen = look(PINHOLE DIFFUSE DISK("Translate 0 0 3 Rotate 60 0 1 0"), centre, 0);
  check(seen.footprint, 3 * sqrt(2.5));
  check(seen.across, 3);
}

static void a_plane_mirror_unfolds(void **state) {
  (void)state;
  struct seen seen = look(PINHOLE MIRROR DISK("Translate 0 0 3 Rotate 45 0 1 0")
                              DIFFUSE DISK("Translate -2 0 3 Rotate 90 0 1 0"),
                          centre, 1);
  check(seen.footprint, 5);
  check(seen.across, 5);
}

// At distance s a ray at the angle phi meets the sphere at height s phi and leaves at the angle
// phi + 2 s phi / R (R > 0: convex), then goes a distance t.
static void a_spherical_mirror_magnifies(void **state) {
  (void)state;
  double s = 2, t = 3, r = 1.5;
  struct seen seen =
      look(PINHOLE MIRROR "AttributeBegin Translate 0 0 3.5 Shape \"sphere\" \"float radius\" 1.5 "
                          "AttributeEnd\n" DIFFUSE DISK("Translate 0 0 -1"),
           centre, 1);
  check(seen.footprint, s + t + 2 * s * t / r);
  check(seen.across, s + t);
  s = 5, t = 6, r = -4; // from within
  seen = look(
      PINHOLE MIRROR
      "AttributeBegin Translate 0 0 1 Shape \"sphere\" \"float radius\" 4 AttributeEnd\n" DIFFUSE
      "AttributeBegin Translate 0 0 -1 Shape \"disk\" \"float radius\" 2 AttributeEnd\n",
      centre, 1);
  check(seen.footprint, fabs(s + t + 2 * s * t / r));
}

// A slab of thickness d and index n is as wide as a way of d / n.
static void a_slab_of_glass_shortens(void **state) {
  (void)state;
  struct seen seen = look(PINHOLE GLASS DISK("ReverseOrientation Translate 0 0 2")
                              DISK("Translate 0 0 3") DIFFUSE DISK("Translate 0 0 5"),
                          centre, 2);
  check(seen.footprint, 2 + 1 / 1.5 + 2);
  check(seen.across, 5);
}

// Both surfaces of a ball of glass have the power (n - 1) / R.
static void a_ball_of_glass_is_a_lens(void **state) {
  (void)state;
  double s = 2.5, r = 1, t = 1, n = 1.5, power = (n - 1) / r;
  double height = s, angle = (1 - power * height) / n;
  height += 2 * r * angle;
  angle = n * angle - power * height;
  struct seen seen = look(
      PINHOLE GLASS "AttributeBegin Translate 0 0 3.5 Shape \"sphere\" AttributeEnd\n" DIFFUSE DISK(
          "Translate 0 0 5.5"),
      centre, 2);
  check(seen.footprint, fabs(height + t * angle));
}

// Off the axis. Neighbours are a pixel away: the difference is (pixel / size)^2 of the shape times
// what its third derivative says, far below 1e-4 here.
static void neighbours_are_where_the_differentials_say(void **state) {
  (void)state;
  static const struct {
    const char *text;
    struct pixel at;
    int vertices;
  } row[] = {
      {PINHOLE DIFFUSE DISK("Translate 0 0 3 Rotate 50 1 2 0"), {250, 1630}, 0},
      {PINHOLE MIRROR DISK("Translate 0 0 3 Rotate 40 0 1 0.2")
           DIFFUSE DISK("Translate -2 0 3 Rotate 65 0.3 1 0"),
       {400, 1300},
       1},
      {PINHOLE MIRROR "AttributeBegin Translate 0.3 0.2 3 Shape \"sphere\" \"float radius\" 0.9 "
                      "AttributeEnd\n" DIFFUSE DISK("Translate 0 0 -1"),
       {1350, 800},
       1},
      {PINHOLE MIRROR "AttributeBegin Translate 0 0 4 Scale 1 0.5 0.7 Rotate 80 1 0.3 0 Shape "
                      "\"cylinder\" \"float zmin\" -3 \"float zmax\" 3 AttributeEnd\n" DIFFUSE DISK(
                          "Translate 0 0 -1"),
       {1100, 950},
       1},
      {PINHOLE GLASS DISK("ReverseOrientation Translate 0 0 2 Rotate 40 0 1 0")
           DISK("Translate 0 0 3 Rotate 30 1 0 0") DIFFUSE DISK("Translate 0 0 7"),
       {800, 1400},
       2},
      {PINHOLE GLASS
       "AttributeBegin Translate 0.2 0 3.5 Shape \"sphere\" AttributeEnd\n" DIFFUSE DISK(
           "Translate 0 0 7 Rotate 30 1 0 0"),
       {1200, 1250},
       2},
      // within the ball once more
      {PINHOLE GLASS
       "AttributeBegin Translate 0.2 0 3.5 Shape \"sphere\" AttributeEnd\n" DIFFUSE DISK(
           "Translate 0 0 -20"),
       {1500, 1250},
       3},
      // normals that are interpolated, and not those of the plane
      {PINHOLE MIRROR
       "Shape \"trianglemesh\" \"point3 P\" [-4 -4 3  4 -4 3  0 6 4] \"normal N\" "
       "[-0.6 -0.3 -1  0.5 -0.4 -1  0 0.4 -1] \"integer indices\" [0 1 2]\n" DIFFUSE DISK(
           "Translate 0 0 -1"),
       {900, 1200},
       1},
      {PINHOLE MIRROR
       "Shape \"bilinearmesh\" \"point3 P\" [-3 -3 3  3 -3 4  -3 3 4.5  3 3 3]\n" DIFFUSE DISK(
           "Translate 0 0 -1"),
       {900, 1200},
       1},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    struct seen seen = look(row[k].text, row[k].at, row[k].vertices);
    if (!(fabs(seen.footprint / seen.traced - 1) < 1e-4))
      fail_msg("row %zu: %.9g, traced %.9g", k, seen.footprint, seen.traced);
  }
}

// All rays of a parallel camera have one direction; those through one point of a lens meet where it
// is focused, and a plane across the view at distance h is h wide for each.
static void cameras_without_a_pinhole(void **state) {
  (void)state;
  struct seen seen =
      look(FILM_TEXT "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"orthographic\" \"float screenwindow\" "
                     "[-3 3 -3 3]\nWorldBegin\n" DIFFUSE DISK("Translate 0 0 3 Rotate 60 0 1 0"),
           centre, 0);
  assert_true(fabs(seen.across / (6.0 / FILM) - 1) < 1e-9);
  assert_true(fabs(seen.footprint / (6.0 / FILM * sqrt(2.5)) - 1) < 1e-9);
  seen = look(
      FILM_TEXT
      "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 20 \"float "
      "lensradius\" 0.3 \"float focaldistance\" 5\nWorldBegin\n" DIFFUSE DISK("Translate 0 0 3"),
      (struct pixel){700, 1200}, 0);
  check(seen.footprint, 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes),
      cmocka_unit_test(a_plane_mirror_unfolds),
      cmocka_unit_test(a_spherical_mirror_magnifies),
      cmocka_unit_test(a_slab_of_glass_shortens),
      cmocka_unit_test(a_ball_of_glass_is_a_lens),
      cmocka_unit_test(neighbours_are_where_the_differentials_say),
      cmocka_unit_test(cameras_without_a_pinhole),
  };
  return cmocka_run_group_tests_name("differential", tests, NULL, NULL);
}
