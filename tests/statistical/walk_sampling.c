// What paths draw, as hypotheses: positions in the pixel and on the lens, lights and where from and
// whereto, directions at every surface, what survives and what passes, times. Each number is mapped
// to the unit interval by the distribution it should have; four of them at a time must fill 4^4
// cells evenly: also a number that is drawn twice, for two purposes or two vertices, is found.
//
// Chi-squared, 2^16 paths, 255 degrees of freedom: densities that are 5.4 % rms wrong are found
// with probability 0.99 (non-centrality 190) at level 1e-5. Together the p-values must be uniform.
#include "tests/p_values.h"
#include "tests/unit/scene_text.h"
#include "walk/eye.h"
#include "walk/light.h"
#include "walk/photons.h"

#include <gsl/gsl_cdf.h>

enum { BATCHES = 16, PATHS = BATCHES * WALK_BATCH, PARTS = 4, CELLS = 256 };

static const double pi = 0x1.921fb54442d18p+1, level = 1e-5;
static struct p_values p_values;

static void check_p(const char *what, double p) {
  if (getenv("WALK_VERBOSE")) print_message("%-40s p %.4f\n", what, p);
  p_values_add(&p_values, p);
  if (!(p >= level)) fail_msg("%s: p = %.2g", what, p);
}

// ---- four numbers at a time ----

struct cells {
  double count[CELLS], total;
};

static void cells_add(struct cells *cells, const double u[4]) {
  int cell = 0;
  for (int k = 0; k < 4; k++) {
    int part = (int)(u[k] * PARTS);
    assert_true(u[k] > -1e-9 && u[k] < 1 + 1e-9); // rounding of what maps them
    cell = cell * PARTS + (part < PARTS ? part : PARTS - 1);
  }
  cells->count[cell] += 1;
  cells->total += 1;
}

static void check_cells(const char *what, const struct cells *cells) {
  double chi2 = 0, each = cells->total / CELLS;
  for (int k = 0; k < CELLS; k++)
    chi2 += (cells->count[k] - each) * (cells->count[k] - each) / each;
  check_p(what, gsl_cdf_chisq_Q(chi2, CELLS - 1));
}

static double turn(double x, double y) {
  double a = atan2(y, x) / (2 * pi);
  return a < 0 ? a + 1 : a;
}

static void check_share(const char *what, double count, double n, double share) {
  double z = (count - n * share) / sqrt(n * share * (1 - share));
  check_p(what, p_of_z(z));
}

// ---- walks ----

struct walks {
  struct arena arena, kept;
  struct scene scene;
  struct walk *walk;
};

static struct walks walks_of(const char *text, enum rng_purpose purpose, const char *name) {
  struct arena kept = arena_reserve();
  struct walks walks = {.arena = kept, .kept = kept, .scene = scene_of(text)};
  struct scene *scene = arena_new(&walks.arena, struct scene, 1);
  *scene = walks.scene;
  walks.walk = walk_new(scene, bvh_build(scene, (struct bvh_options){0}, &walks.arena),
                        scene_features(scene), &walks.arena);
  walks.walk->key = rng_key(rng_hash_name(name), 1, purpose);
  return walks;
}

static void walks_begin(struct walk *walk, int batch) {
  walk->iteration = 1;
  walk->n = WALK_BATCH;
  walk->vertex = 0;
  for (int j = 0; j < WALK_BATCH; j++) walk->path[j] = (uint64_t)(batch * WALK_BATCH + j);
}

// ---- the eye ----

// The share of a filter below x, in units of its radius r.
static double below_box(double x) { return (x + 1) / 2; }
static double below_triangle(double x) {
  return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2;
}
static double below_gaussian(double x) { // r = 1.5, sigma = 0.5
  double end = 3 / sqrt(2), floor = exp(-end * end);
  double whole = sqrt(pi) / 2 * erf(end) - floor * end;
  return 0.5 + (sqrt(pi) / 2 * erf(x * end) - floor * x * end) / (2 * whole);
}

static const struct {
  const char *name;
  double radius, (*below)(double x);
} filters[] = {
    {"box", 0.5, below_box}, {"triangle", 2, below_triangle}, {"gaussian", 1.5, below_gaussian}};

// At 7, 5 of a square film of 10 pixels, by the plane in focus at 2.5.
static void see(const char *camera, double half, int filter) {
  const char *text =
      arena_format(&test_memory()->keep,
                   "Camera \"%s\" \"float lensradius\" .3 \"float focaldistance\" 2.5 Film \"rgb\" "
                   "\"integer xresolution\" 10 \"integer yresolution\" 10 PixelFilter \"%s\" "
                   "WorldBegin LightSource \"point\" Shape \"sphere\"",
                   camera, filters[filter].name);
  const char *name = arena_format(&test_memory()->keep, "%s, %s", camera, filters[filter].name);
  struct walks walks = walks_of(text, RNG_EYE, name);
  struct cells cells = {.total = 0};
  static struct pixel pixel[WALK_BATCH];
  for (int j = 0; j < WALK_BATCH; j++) pixel[j] = (struct pixel){7, 5};
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    eye_rays(walks.walk, pixel, WALK_BATCH, true);
    for (int j = 0; j < WALK_BATCH; j++) {
      struct ray ray = walks.walk->ray[j];
      struct vec p = vec_along(ray.o, ray.d, (2.5 - ray.o.z) / ray.d.z);
      double x = (p.x / half + 1) * 5 - 7.5, y = (1 - p.y / half) * 5 - 5.5;
      double r = filters[filter].radius, u[4];
      u[0] = filters[filter].below(x / r), u[1] = filters[filter].below(y / r);
      u[2] = (ray.o.x * ray.o.x + ray.o.y * ray.o.y) / 0.09, u[3] = turn(ray.o.x, ray.o.y);
      cells_add(&cells, u);
    }
  }
  check_cells(name, &cells);
  arena_release(walks.kept);
}

static void eyes_draw_pixel_and_lens(void **state) {
  (void)state;
  for (int k = 0; k < (int)(sizeof filters / sizeof *filters); k++) {
    bool known = filter_types[k] && filter_find(filters[k].name);
    assert_true(known);         // every registered filter, once
    see("perspective", 2.5, k); // 90 degrees
    see("orthographic", 1, k);
  }
  assert_null(filter_types[sizeof filters / sizeof *filters]);
}

// ---- lights ----

// Five lights, one black. Which one is told by where it is.
static void lights_are_chosen_by_power(void **state) {
  (void)state;
  static const double power[] = {1, 0, 2.5, 0.4, 4};
  enum { LIGHTS = 5, DIRECTIONS = 16 };
  char text[2048] = "WorldBegin Shape \"sphere\" ";
  for (int k = 0; k < LIGHTS; k++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "LightSource \"point\" \"point3 from\" [%d 9 9] \"rgb I\" [%g %g %g] ", k, power[k],
             power[k], power[k]);
  struct walks walks = walks_of(text, RNG_PHOTONS, __func__);
  double count[LIGHTS][DIRECTIONS] = {{0}}, chi2 = 0;
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    photons_emit(walks.walk);
    for (int j = 0; j < WALK_BATCH; j++) {
      struct ray ray = walks.walk->ray[j];
      int a = (int)((1 + ray.d.z) * 2), b = (int)(turn(ray.d.x, ray.d.y) * 4);
      count[(int)(ray.o.x + 0.5)][4 * (a < 4 ? a : 3) + (b < 4 ? b : 3)] += 1;
    }
  }
  for (int k = 0; k < LIGHTS; k++)
    for (int d = 0; d < DIRECTIONS; d++) {
      double expected = PATHS * power[k] / 7.9 / DIRECTIONS, z = count[k][d] - expected;
      assert_true(expected > 0 || count[k][d] == 0);
      if (expected > 0) chi2 += z * z / expected;
    }
  check_p("lights", gsl_cdf_chisq_Q(chi2, 4 * DIRECTIONS - 1));
  arena_release(walks.kept);
}

static void a_disk_light_draws_position_and_direction(void **state) {
  (void)state;
  struct walks walks =
      walks_of("WorldBegin AreaLightSource \"diffuse\" Shape \"disk\" \"float radius\" 2",
               RNG_PHOTONS, __func__);
  struct cells cells = {.total = 0};
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    photons_emit(walks.walk);
    for (int j = 0; j < WALK_BATCH; j++) {
      struct ray r = walks.walk->ray[j];
      double u[4] = {(r.o.x * r.o.x + r.o.y * r.o.y) / 4, turn(r.o.x, r.o.y), r.d.z * r.d.z,
                     turn(r.d.x, r.d.y)};
      cells_add(&cells, u);
    }
  }
  check_cells("position and direction", &cells);
  arena_release(walks.kept);
}

// ---- scattering ----

// One step of all paths: to the next surface, and from there what walk_scatter decides.
static void scatter_all(struct walk *walk) {
  int alive = 0;
  walk_vertex_random(walk);
  for (int j = 0; j < walk->n; j++) {
    struct surface surface;
    scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
    struct bsdf bsdf;
    walk_bsdf(walk, j, &surface, &bsdf);
    if (walk_scatter(walk, j, &surface, &bsdf)) walk_move(walk, alive++, j);
  }
  walk->n = alive;
  walk->vertex++;
}

#define SPHERE_OF(reflectance)                                                                     \
  "WorldBegin LightSource \"point\" Material \"diffuse\" \"rgb reflectance\" " reflectance         \
  " Shape \"sphere\""

// Within a diffuse sphere every point is reached from every other with the same probability. So the
// points of vertices v and v + 1 are independent and uniform, whatever v.
static void directions_of_neighbouring_vertices_are_independent(void **state) {
  (void)state;
  enum { VERTICES = 4 };
  struct walks walks = walks_of(SPHERE_OF("[1 1 1]"), RNG_PHOTONS, __func__);
  static struct cells cells[VERTICES];
  static double before[WALK_BATCH][2];
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    photons_emit(walks.walk);
    for (int v = 0; v < VERTICES; v++) {
      walk_trace(walks.walk);
      assert_int_equal(walks.walk->n, WALK_BATCH);
      for (int j = 0; j < WALK_BATCH; j++) {
        struct vec p = vec_along(walks.walk->ray[j].o, walks.walk->ray[j].d, walks.walk->hit[j].t);
        double u[4] = {before[j][0], before[j][1], (1 + p.z) / 2, turn(p.x, p.y)};
        if (v > 0) cells_add(&cells[v], u);
        before[j][0] = u[2], before[j][1] = u[3];
      }
      scatter_all(walks.walk);
    }
  }
  for (int v = 1; v < VERTICES; v++)
    check_cells(arena_format(&test_memory()->keep, "vertices %d and %d", v - 1, v), &cells[v]);
  arena_release(walks.kept);
}

// Roulette keeps the share of the largest channel, whatever the direction and the last roulette.
static void roulette_keeps_the_largest_reflectance(void **state) {
  (void)state;
  enum { VERTICES = 4 };
  struct walks walks = walks_of(SPHERE_OF("[.3 .7 .5]"), RNG_PHOTONS, __func__);
  static const double weight[] = {0.3 / 0.7, 1, 0.5 / 0.7};
  double alive[VERTICES + 1] = {PATHS};
  static struct cells cells[VERTICES];
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    photons_emit(walks.walk);
    double flux[3];
    for (int c = 0; c < 3; c++) flux[c] = walks.walk->throughput[c][0];
    for (int v = 0; v < VERTICES; v++) {
      walk_trace(walks.walk);
      scatter_all(walks.walk);
      alive[v + 1] += walks.walk->n;
      for (int j = 0; j < walks.walk->n; j++) {
        struct ray ray = walks.walk->ray[j];
        struct vec x, y, n = vec_scale(ray.o, -1);
        vec_basis(n, &x, &y);
        double z = vec_dot(ray.d, n);
        double u[4] = {(1 + n.z) / 2, turn(n.x, n.y), fmin(1, z * z),
                       turn(vec_dot(ray.d, x), vec_dot(ray.d, y))};
        cells_add(&cells[v], u);
      }
      for (int c = 0; c < 3; c++) {
        flux[c] *= weight[c];
        assert_true(walks.walk->n == 0 || fabs(walks.walk->throughput[c][0] / flux[c] - 1) < 1e-12);
      }
    }
  }
  for (int v = 0; v < VERTICES; v++) {
    check_share(arena_format(&test_memory()->keep, "survivors of %d", v), alive[v + 1], alive[v],
                0.7);
    check_cells(arena_format(&test_memory()->keep, "directions from %d", v), &cells[v]);
  }
  arena_release(walks.kept);
}

// ---- what lets pass ----

// Sheets of opacity 0.3, 0.6 and 0.5 before a wall: each decides by a number of its own, and passes
// through them leave the path's other numbers alone.
static void sheets_stop_their_share(void **state) {
  (void)state;
  struct walks walks = walks_of(
      "Camera \"orthographic\" Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1 "
      "WorldBegin LightSource \"point\" Translate 0 0 1 Shape \"disk\" \"float radius\" 9 \"float "
      "alpha\" .3 Translate 0 0 1 Shape \"disk\" \"float radius\" 9 \"float alpha\" .6 Translate 0 "
      "0 1 Shape \"disk\" \"float radius\" 9 \"float alpha\" .5 Translate 0 0 1 Shape \"disk\" "
      "\"float radius\" 9",
      RNG_EYE, __func__);
  static const double share[] = {0.3, 0.7 * 0.6, 0.7 * 0.4 * 0.5, 0.7 * 0.4 * 0.5};
  static struct pixel pixel[WALK_BATCH];
  double count[4][16] = {{0}}, chi2 = 0;
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walks.walk, batch);
    eye_rays(walks.walk, pixel, WALK_BATCH, true);
    walk_trace_through(walks.walk);
    walk_vertex_random(walks.walk);
    for (int j = 0; j < WALK_BATCH; j++) {
      const struct walk *walk = walks.walk;
      int sheet = (int)(walk->ray[j].o.z + walk->hit[j].t + 0.5) - 1;
      int cell = 4 * (int)(4 * walk->u[0][0][j]) + (int)(4 * walk->u[1][1][j]);
      assert_in_range(sheet, 0, 3);
      count[sheet][cell] += 1;
    }
  }
  for (int k = 0; k < 64; k++) {
    double expected = PATHS * share[k / 16] / 16, z = count[k / 16][k % 16] - expected;
    chi2 += z * z / expected;
  }
  check_p("sheets", gsl_cdf_chisq_Q(chi2, 63));
  arena_release(walks.kept);
}

// ---- the shutter ----

// Times of iterations, of the next one, of the same in the next run, and a number of the eye.
static void times_fill_the_shutter(void **state) {
  (void)state;
  struct walks walks =
      walks_of("ActiveTransform EndTime Translate -1 0 0 ActiveTransform All Camera "
               "\"perspective\" Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2 "
               "WorldBegin LightSource \"point\" Shape \"sphere\"",
               RNG_EYE, __func__);
  struct walk *walk = walks.walk;
  uint64_t seed = rng_hash_name(__func__);
  struct cells cells = {.total = 0};
  for (uint64_t i = 1; i <= 8192; i++) {
    double u[4];
    for (int k = 0; k < 3; k++) {
      walk_begin(walk, seed, 2 * i + (k == 2), 2 * i + (k == 1));
      u[k] = camera_ray(&walk->scene->camera, 1, 1, NULL).o.x;
    }
    walk_begin(walk, seed, 2 * i, 2 * i);
    walk->key = rng_key(seed, 2 * i, RNG_EYE);
    walk->n = 1, walk->path[0] = 0;
    walk_random(walk, 0, 0);
    u[3] = walk->u[0][0][0];
    cells_add(&cells, u);
  }
  check_cells("times", &cells);
  arena_release(walks.kept);
}

// ---- media ----

// Henyey and Greenstein's cumulative distribution of the cosine towards the direction of flight,
// and the azimuth; two scatterings, one after the other.
static void phase_functions_scatter_as_they_say(void **state) {
  (void)state;
  static const double gs[] = {0, 0.3, -0.6, 0.9, -0.99, 1e-9};
  for (int k = 0; k < (int)(sizeof gs / sizeof *gs); k++) {
    double g = gs[k];
    struct medium medium = {.g = g};
    struct bsdf bsdf = medium_bsdf(&medium);
    struct draw draw =
        draw_named(arena_format(&test_memory()->keep, "phase_functions_scatter %g", g));
    struct cells cells = {.total = 0};
    for (int j = 0; j < PATHS; j++) {
      struct vec forward = vec(0.36, -0.48, 0.8), x, y;
      double u[4], number[4];
      for (int s = 0; s < 2; s++) {
        struct bsdf_sample sample;
        draw_pair(&draw, &number[0], &number[1]);
        number[2] = 0;
        assert_true(
            bsdf_sample(&bsdf, vec_scale(forward, -1), number, TRANSPORT_RADIANCE, &sample));
        double z = vec_dot(sample.wi, forward);
        double root = sqrt(1 + g * g - 2 * g * z);
        u[2 * s] = (1 - g * g) * (1 + z) / (root * (1 + g) * (1 + g + root));
        vec_basis(forward, &x, &y);
        u[2 * s + 1] = turn(vec_dot(sample.wi, x), vec_dot(sample.wi, y));
        forward = sample.wi;
      }
      cells_add(&cells, u);
    }
    check_cells(arena_format(&test_memory()->keep, "phase function, g = %g", g), &cells);
  }
}

// In fog of sigma_t = 0.7 that absorbs nothing: how far, whereto, and how far again.
static void flights_end_exponentially(void **state) {
  (void)state;
  struct walks walks =
      walks_of("WorldBegin MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb "
               "sigma_a\" [0 0 0] \"rgb sigma_s\" [.7 .7 .7] MediumInterface \"fog\" \"fog\" "
               "LightSource \"point\" Shape \"sphere\" \"float radius\" 100",
               RNG_PHOTONS, __func__);
  struct walk *walk = walks.walk;
  struct cells cells = {.total = 0};
  static double first[WALK_BATCH], cosine[WALK_BATCH], azimuth[WALK_BATCH];
  for (int batch = 0; batch < BATCHES; batch++) {
    walks_begin(walk, batch);
    photons_emit(walk);
    walk_trace(walk);
    walk_vertex_random(walk);
    for (int j = 0; j < WALK_BATCH; j++) {
      struct vec x, y, d = walk->ray[j].d;
      vec_basis(d, &x, &y);
      first[j] = 1 - exp(-0.7 * walk->hit[j].t);
      assert_true(walk_collided(walk, j) && walk_scatter_in_medium(walk, j));
      struct vec wi = walk->ray[j].d;
      cosine[j] = (1 + vec_dot(wi, d)) / 2, azimuth[j] = turn(vec_dot(wi, x), vec_dot(wi, y));
    }
    walk->vertex++;
    walk_trace(walk);
    for (int j = 0; j < WALK_BATCH; j++)
      cells_add(&cells,
                (double[]){first[j], cosine[j], azimuth[j], 1 - exp(-0.7 * walk->hit[j].t)});
  }
  check_cells("flights", &cells);
  arena_release(walks.kept);
}

static void p_values_are_uniform(void **state) {
  (void)state;
  assert_p_uniform(&p_values, 25);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(eyes_draw_pixel_and_lens),
      cmocka_unit_test(lights_are_chosen_by_power),
      cmocka_unit_test(a_disk_light_draws_position_and_direction),
      cmocka_unit_test(directions_of_neighbouring_vertices_are_independent),
      cmocka_unit_test(roulette_keeps_the_largest_reflectance),
      cmocka_unit_test(sheets_stop_their_share),
      cmocka_unit_test(times_fill_the_shutter),
      cmocka_unit_test(phase_functions_scatter_as_they_say),
      cmocka_unit_test(flights_end_exponentially),
      cmocka_unit_test(p_values_are_uniform),
  };
  return cmocka_run_group_tests_name("walk_sampling", tests, NULL, NULL);
}
