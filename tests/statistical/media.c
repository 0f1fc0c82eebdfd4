// Flights through media against closed forms and quadrature, coloured ones channel by channel.
// Level 1e-6 a test (|z| < 4.9, chi-squared likewise): there are some two hundred.
#include "../unit/scene_text.h"

#include "integrator/integrator.h"
#include "walk/flight.h"

#include <gsl/gsl_cdf.h>

enum { PATHS = 32 * WALK_BATCH, CELLS = 24 };
static const double level = 1e-6, z_limit = 4.9;

static struct arena arena;

struct sums {
  double n, sum, squares;
};

static void add(struct sums *to, double x) {
  to->n += 1;
  to->sum += x;
  to->squares += x * x;
}

static double mean(struct sums s) { return s.sum / s.n; }
static double se2(struct sums s) { return (s.squares / s.n - mean(s) * mean(s)) / (s.n - 1); }

static void check_z(const char *what, struct sums s, double truth) {
  double se = sqrt(se2(s));
  if (!(fabs(mean(s) - truth) <= z_limit * se))
    fail_msg("%s: %g, not %g: z %.2f", what, mean(s), truth, (mean(s) - truth) / se);
}

// ---- one ray through one medium ----

struct flights {
  struct scene scene;
  struct walk *walk;
  struct ray ray;
  double last; // where it hits
};

static struct flights flights_of(const char *medium, struct ray ray, double last,
                                 const char *test) {
  struct flights flights = {.ray = ray, .last = last};
  struct scene *kept = arena_new(&arena, struct scene, 1);
  *kept = scene_of(arena_format(&arena,
                                "MakeNamedMedium \"a\" %s\nMediumInterface \"a\" Camera "
                                "\"perspective\" WorldBegin Shape \"sphere\"",
                                medium));
  flights.scene = *kept;
  flights.walk = walk_new(kept, NULL, scene_features(kept), &arena);
  flights.walk->key = rng_key(rng_hash_name(test), 1, RNG_TEST);
  return flights;
}

static void fly_batch(const struct flights *flights, int batch) {
  struct walk *walk = flights->walk;
  walk->n = WALK_BATCH;
  for (int j = 0; j < WALK_BATCH; j++) {
    walk->path[j] = (uint64_t)batch * WALK_BATCH + (uint64_t)j;
    walk->ray[j] = flights->ray;
    walk->hit[j] = (struct hit){flights->last, 0};
    walk->medium[j] = 0;
    for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] = 1;
  }
  flight_all(walk);
}

// Mean of what arrives, of delta tracking and of ratio tracking.
struct passed {
  struct sums delta[3], ratio[3];
};

static struct passed fly(const struct flights *flights) {
  struct passed passed = {0};
  struct walk *walk = flights->walk;
  for (int batch = 0; batch < PATHS / WALK_BATCH; batch++) {
    fly_batch(flights, batch);
    for (int j = 0; j < WALK_BATCH; j++) {
      double value[3] = {1, 1, 1};
      uint32_t used = 0;
      flight_shadow(walk, 0, &flights->ray, flights->last, walk->path[j], 0, &used, value);
      for (int c = 0; c < walk->n_channels; c++) {
        add(&passed.delta[c], walk_collided(walk, j) ? 0 : walk->throughput[c][j]);
        add(&passed.ratio[c], value[c]);
      }
    }
  }
  return passed;
}

static void check_passed(const char *what, const struct passed *passed, const double *truth,
                         int n_channels) {
  for (int c = 0; c < n_channels; c++) {
    check_z(arena_format(&arena, "%s, delta tracking, channel %d", what, c), passed->delta[c],
            truth[c]);
    check_z(arena_format(&arena, "%s, ratio tracking, channel %d", what, c), passed->ratio[c],
            truth[c]);
  }
}

// ---- density that grows linearly: rho(x) = 1 + 3 x between the centres of two samples ----

#define LINEAR                                                                                     \
  "\"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" [1 4]\n"                     \
  "\"point3 p0\" [-.5 -1 -1] \"point3 p1\" [1.5 1 1] "

// Along x at y = z = 0, which is the centre of the one sample across.
static const struct ray along = {{0, 0, 0}, {1, 0, 0}, INFINITY, PRIMITIVE_NONE};
static double depth_at(double x) { return x + 1.5 * x * x; }

// What passes x = 0.9 is exp(-sigma_t 2.115), exactly; 2^17 paths: 2 % of it is found in the
// channel that is left with 0.12. The third absorbs thirteen times as much as the first.
static void what_passes_a_linear_density_is_its_closed_form(void **state) {
  (void)state;
  static const double sigma_t[] = {0.3, 1, 4};
  struct flights flights = flights_of(LINEAR "\"rgb sigma_a\" [.1 .6 1] \"rgb sigma_s\" [.2 .4 3]",
                                      along, 0.9, __func__);
  struct passed passed = fly(&flights);
  double truth[3];
  for (int c = 0; c < 3; c++) truth[c] = exp(-sigma_t[c] * depth_at(0.9));
  check_passed("coloured", &passed, truth, 3);
  flights = flights_of(LINEAR "\"rgb sigma_a\" [.6 .6 .6] \"rgb sigma_s\" [.4 .4 .4]", along, 0.9,
                       __func__);
  assert_int_equal(flights.walk->n_channels, 1);
  passed = fly(&flights);
  check_passed("gray", &passed, (double[]){exp(-depth_at(0.9))}, 1);
}

// Cells of equal probability; chi-squared finds densities 2.5 % rms wrong (non-centrality 80 of 24
// degrees of freedom).
static void collisions_are_where_a_linear_density_has_them(void **state) {
  (void)state;
  struct flights flights = flights_of(
      LINEAR "\"rgb sigma_a\" [.6 .6 .6] \"rgb sigma_s\" [.4 .4 .4]", along, 1, __func__);
  double count[CELLS + 1] = {0}, chi2 = 0, collide = 1 - exp(-depth_at(1));
  for (int batch = 0; batch < PATHS / WALK_BATCH; batch++) {
    fly_batch(&flights, batch);
    for (int j = 0; j < WALK_BATCH; j++) {
      double share = (1 - exp(-depth_at(flights.walk->hit[j].t))) / collide;
      int cell = walk_collided(flights.walk, j) ? (int)(share * CELLS) : CELLS;
      count[cell]++;
    }
  }
  for (int k = 0; k <= CELLS; k++) {
    double expected = PATHS * (k < CELLS ? collide / CELLS : 1 - collide);
    chi2 += (count[k] - expected) * (count[k] - expected) / expected;
  }
  double p = gsl_cdf_chisq_Q(chi2, CELLS);
  if (!(p >= level)) fail_msg("chi-squared %.1f of %d, p = %.2g", chi2, CELLS, p);
}

// Each channel's fluence in ten parts of the way: the integral of its transmittance, from the
// weights of one set of paths.
static void weights_of_collisions_are_each_channels_fluence(void **state) {
  (void)state;
  enum { PARTS = 10, STEPS = 1000 };
  static const double sigma_t[] = {0.3, 1, 4};
  struct flights flights =
      flights_of(LINEAR "\"rgb sigma_a\" [.1 .6 1] \"rgb sigma_s\" [.2 .4 3]", along, 1, __func__);
  struct sums part[3][PARTS] = {0};
  struct walk *walk = flights.walk;
  for (int batch = 0; batch < PATHS / WALK_BATCH; batch++) {
    fly_batch(&flights, batch);
    for (int j = 0; j < WALK_BATCH; j++)
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < PARTS; k++)
          add(&part[c][k], (int)(walk->hit[j].t * PARTS) == k ? walk->collision[j].weight[c] : 0);
  }
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < PARTS; k++) {
      double truth = 0;
      for (int i = 0; i < STEPS; i++)
        truth += exp(-sigma_t[c] * depth_at((k + (i + 0.5) / STEPS) / PARTS)) / (PARTS * STEPS);
      check_z(arena_format(&arena, "fluence of channel %d in part %d", c, k), part[c][k], truth);
    }
}

// ---- any density ----

static void quadrature(const struct flights *flights, double passes[3]) {
  enum { STEPS = 100000 };
  const struct medium *medium = &flights->scene.medium[0];
  double sum[3] = {0};
  for (int i = 0; i < STEPS; i++) {
    struct medium_point at;
    double t = (i + 0.5) / STEPS * flights->last;
    medium->type->at(medium, vec_along(flights->ray.o, flights->ray.d, t), &at);
    for (int c = 0; c < 3; c++) sum[c] += at.sigma_a[c] + at.sigma_s[c];
  }
  for (int c = 0; c < 3; c++) passes[c] = exp(-sum[c] / STEPS * flights->last);
}

// 20 x 20 x 20 samples, three in four of them empty, rays from outside and within,
// along axes and across. The quadrature's error is below 1e-5.
static void what_passes_a_random_grid_is_its_quadrature(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  static char text[1 << 17];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "\"string type\" \"uniformgrid\" \"rgb sigma_a\" [1 .2 4] "
                                 "\"integer nx\" 20 \"integer ny\" 20 \"integer nz\" 20 "
                                 "\"float density\" [");
  for (int k = 0; k < 8000; k++)
    used += (size_t)snprintf(text + used, sizeof text - used, "%.6g ",
                             draw_between(&draw, 0, 1) < 0.75 ? 0 : draw_between(&draw, 0, 5));
  snprintf(text + used, sizeof text - used, "]");
  static const struct ray rays[] = {{{-1, 0.31, 0.47}, {1, 0, 0}, INFINITY, PRIMITIVE_NONE},
                                    {{0.52, 0.5, 0.5}, {0, -0.6, 0.8}, INFINITY, PRIMITIVE_NONE},
                                    {{2, 2, 2}, {-0.48, -0.6, -0.64}, INFINITY, PRIMITIVE_NONE}};
  static const double last[] = {1.7, 0.3, 5};
  for (int k = 0; k < 3; k++) {
    struct flights flights = flights_of(text, rays[k], last[k], __func__);
    struct passed passed = fly(&flights);
    double truth[3];
    quadrature(&flights, truth);
    assert_true(truth[0] > 0.02 && truth[0] < 0.98);
    check_passed(arena_format(&arena, "ray %d", k), &passed, truth, 3);
  }
}

// ---- whole paths ----

// A ball of fog under a lamp, all paths up to 20 vertices; of the grid the part where all samples
// around are one. Mean of the picture.
static struct sums picture_of(const char *medium, const char *name, uint64_t iterations) {
  enum { WIDTH = 8 };
  static struct pixel pixel[WIDTH * WIDTH];
  for (int k = 0; k < WIDTH * WIDTH; k++) pixel[k] = (struct pixel){k % WIDTH, k / WIDTH};
  struct scene *scene = arena_new(&arena, struct scene, 1);
  *scene = scene_of(
      arena_format(&arena,
                   "LookAt 0 0 -4 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 30\n"
                   "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 WorldBegin\n"
                   "LightSource \"point\" \"point3 from\" [0 3 -1]\n"
                   "MakeNamedMedium \"a\" \"rgb sigma_s\" [2 1 .5] \"rgb sigma_a\" [.1 .2 .3] "
                   "\"float g\" .4 %s\n"
                   "Material \"interface\" MediumInterface \"a\" \"\" Shape \"sphere\"",
                   medium));
  struct measurement measure = {.scene = scene,
                                .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                                .features = scene_features(scene),
                                .pixel = pixel,
                                .n_points = WIDTH * WIDTH,
                                .n_replicas = 1,
                                .depth = 20,
                                .nee = true,
                                .seed = rng_hash_name(name)};
  const struct integrator_type *path = integrator_find("path");
  void *state = path->create(&measure, &arena);
  static double frame[3 * WIDTH * WIDTH];
  struct sums out = {0};
  path->begin(state, 1);
  for (uint64_t i = 1; i <= iterations; i++) {
    double sum = 0;
    path->step(state, i, frame);
    for (int k = 0; k < 3 * WIDTH * WIDTH; k++) sum += (k % 3 + 1) * frame[k];
    add(&out, sum);
  }
  return out;
}

// The two differ in nothing but how they are sampled; 3 % is found.
static void a_grid_of_one_density_is_homogeneous(void **state) {
  (void)state;
  char grid[1024];
  size_t used =
      (size_t)snprintf(grid, sizeof grid,
                       "\"string type\" \"uniformgrid\" \"integer nx\" 4 \"integer ny\" 4 "
                       "\"integer nz\" 4 \"point3 p0\" [-2 -2 -2] \"point3 p1\" [2 2 2] "
                       "\"float scale\" .25 \"float density\" [");
  for (int k = 0; k < 64; k++) used += (size_t)snprintf(grid + used, sizeof grid - used, "4 ");
  snprintf(grid + used, sizeof grid - used, "]");
  struct sums a = picture_of("\"string type\" \"homogeneous\"", "homogeneous", 4000);
  struct sums b = picture_of(grid, "grid", 4000);
  double se = sqrt(se2(a) + se2(b)), z = (mean(a) - mean(b)) / se;
  assert_true(se < 0.005 * mean(a));
  if (!(fabs(z) < z_limit)) fail_msg("%g and %g: z %.2f", mean(a), mean(b), z);
}

// Emission alone, seen along a ray of length s: j (1 - exp(-sigma s)) / sigma, j = sigma_a L_e; in
// a ball that is exact in the mean over no pixel but its centre.
static void emission_is_seen_through_its_own_fog(void **state) {
  (void)state;
  static const struct pixel centre = {0, 0};
  struct scene *scene = arena_new(&arena, struct scene, 1);
  *scene =
      scene_of("LookAt 0 0 -4 0 0 0 0 1 0 Camera \"perspective\"\n"
               "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1 WorldBegin\n"
               "LightSource \"point\" \"rgb I\" [1e-30 1e-30 1e-30] \"point3 from\" [0 9 0]\n"
               "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0]\n"
               "\"rgb sigma_a\" [.2 .7 3] \"rgb Le\" [5 1 2] \"float Lescale\" 1.5\n"
               "Material \"interface\" MediumInterface \"a\" \"\" Shape \"sphere\"");
  struct measurement measure = {.scene = scene,
                                .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                                .features = scene_features(scene),
                                .pixel = &centre,
                                .n_points = 1,
                                .n_replicas = 1,
                                .depth = 4,
                                .nee = true,
                                .seed = rng_hash_name(__func__)};
  static const double sigma[] = {0.2, 0.7, 3}, radiance[] = {7.5, 1.5, 3};
  const struct integrator_type *path = integrator_find("path");
  void *tracer = path->create(&measure, &arena);
  struct sums seen[3] = {0};
  path->begin(tracer, 1);
  for (uint64_t i = 1; i <= 100000; i++) {
    double frame[3];
    path->step(tracer, i, frame);
    for (int c = 0; c < 3; c++) add(&seen[c], frame[c]);
  }
  for (int c = 0; c < 3; c++)
    check_z(arena_format(&arena, "emission, channel %d", c), seen[c],
            radiance[c] * (1 - exp(-2 * sigma[c])));
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_passes_a_linear_density_is_its_closed_form),
      cmocka_unit_test(collisions_are_where_a_linear_density_has_them),
      cmocka_unit_test(weights_of_collisions_are_each_channels_fluence),
      cmocka_unit_test(what_passes_a_random_grid_is_its_quadrature),
      cmocka_unit_test(a_grid_of_one_density_is_homogeneous),
      cmocka_unit_test(emission_is_seen_through_its_own_fog),
  };
  return cmocka_run_group_tests_name("media", tests, NULL, NULL);
}
