// Every registered light draws what it says it is: photons leave with the flux that connections
// find (or, of area lights, by the cosine law and as their image), and what `sample` draws for
// next-event estimation has the density `pdf`. Chi-squared each, over 16 x 16 cells, of sums of
// flux or of numbers; level 1e-5; finds, of 2^18 in all cells, 3 % rms with probability 0.99.
// Shapes draw their points in tests/unit/shape*.c.
#define _GNU_SOURCE // mkstemp
#include "bvh/bvh.h"
#include "tests/light_cases.h"
#include "tests/p_values.h"

enum { DRAWN = N / 4, FINE = 48, RARE = 20 };
static struct p_values p_values;

// Sums of weights in cells of the unit square, and what each draw expects there.
struct cells {
  double sum[CELLS][CELLS], squares[CELLS][CELLS], expected[CELLS][CELLS];
};

static double *at_cell(double cell[CELLS][CELLS], double a, double b) {
  int i = (int)(a * CELLS), j = (int)(b * CELLS);
  assert_true(a >= 0 && a <= 1 + 1e-9 && b >= 0 && b <= 1 + 1e-9);
  return &cell[i < CELLS ? i : CELLS - 1][j < CELLS ? j : CELLS - 1];
}

static void cells_add(struct cells *cells, double a, double b, double weight) {
  *at_cell(cells->sum, a, b) += weight;
  *at_cell(cells->squares, a, b) += weight * weight;
}

// The density of a cell at the midpoints of FINE x FINE parts, `measure` that of the unit square.
typedef double density_at(const void *of, double a, double b);

static void cells_expect(struct cells *cells, density_at *density, const void *of) {
  enum { SIDE = CELLS * FINE };
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++)
      cells->expected[i / FINE][j / FINE] +=
          density(of, (i + 0.5) / SIDE, (j + 0.5) / SIDE) / ((double)SIDE * SIDE);
}

struct total {
  double sum, squares, expected;
};

static double term(struct total cell, double mean_weight) {
  double weight = cell.sum > 0 ? cell.squares / cell.sum : mean_weight;
  double z = cell.sum - cell.expected;
  return z * z / (cell.expected * weight);
}

// Cells that expect less than RARE draws are one. What is not drawn (`sample` may fail) is none.
static void assert_chi2(const char *what, const struct cells *cells) {
  struct total all = {0}, rare = {0};
  const double *sum = cells->sum[0], *squares = cells->squares[0], *mean = cells->expected[0];
  for (int k = 0; k < CELLS * CELLS; k++) all.sum += sum[k], all.squares += squares[k];
  double weight = all.squares / all.sum, chi2 = 0;
  int terms = 0;
  for (int k = 0; k < CELLS * CELLS; k++) {
    struct total cell = {sum[k], squares[k], DRAWN * mean[k]};
    if (cell.expected == 0 && cell.sum > 0) fail_msg("%s: where there is no light", what);
    if (cell.expected >= RARE * weight) {
      chi2 += term(cell, weight), terms++;
      continue;
    }
    rare.sum += cell.sum, rare.squares += cell.squares, rare.expected += cell.expected;
  }
  if (rare.expected >= RARE * weight) chi2 += term(rare, weight), terms++;
  assert_true(terms > 8);
  double p = gsl_cdf_chisq_Q(chi2, terms - 1);
  if (getenv("LIGHT_VERBOSE")) print_message("%-50s %6.1f of %3d, p %.3g\n", what, chi2, terms, p);
  p_values_add(&p_values, p);
  if (!(p >= level)) fail_msg("%s: chi-squared %.1f of %d, p = %.2g", what, chi2, terms - 1, p);
}

// ---- directions and discs as unit squares ----

// Finer around the axis: a^2 is the share of the sphere within.
static struct vec direction_at(struct vec axis, double a, double b) {
  struct vec x, y;
  frame(axis, vec(0.1, 0.7, -0.4), &x, &y);
  double z = 1 - 2 * a * a, r = sqrt((1 - z) * (1 + z));
  struct vec across = vec_add(vec_scale(x, r * cos(2 * pi * b)), vec_scale(y, r * sin(2 * pi * b)));
  return vec_along(across, axis, z);
}

static void square_of(struct vec axis, struct vec d, double *a, double *b) {
  struct vec x, y;
  frame(axis, vec(0.1, 0.7, -0.4), &x, &y);
  *a = sqrt(fmax(0, 1 - vec_dot(d, axis)) / 2);
  *b = turn(vec_dot(d, x), vec_dot(d, y));
}

// Of solid angle, at a.
static double directions_measure(double a) { return 4 * pi * 2 * a; }

struct lit {
  const struct scene *scene;
  const struct light *light;
  struct vec from, axis;
  double radius;
  int channel;
};

static struct lit lit_of(const struct scene *scene, int i) {
  return (struct lit){.scene = scene,
                      .light = &scene->light[0],
                      .from = {1, 2, 3},
                      .axis = {0.36, -0.48, -0.8},
                      .channel = i % 3};
}

// ---- photons ----

static struct emission emitted(const struct lit *lit, struct stream *stream, uint64_t j) {
  double u[LIGHT_U];
  struct emission photon;
  stream_read(stream, j, u);
  lit->light->type->emit(lit->scene, lit->light, u, &photon);
  return photon;
}

// What a connection from p finds, without the cosine.
static double connected(const struct lit *lit, struct vec p) {
  struct light_sample nee;
  bool found = lit->light->type->sample(lit->scene, lit->light, p, (double[]){0.5, 0.5}, &nee);
  return found ? nee.radiance_over_pdf[lit->channel] : 0;
}

static double intensity(const void *of, double a, double b) {
  const struct lit *lit = of;
  return directions_measure(a) * connected(lit, vec_add(lit->from, direction_at(lit->axis, a, b)));
}

static void check_point(const char *what, const struct lit *lit) {
  struct stream stream = stream_begin(what);
  struct cells cells = {0};
  for (uint64_t j = 0; j < DRAWN; j++) {
    struct emission photon = emitted(lit, &stream, j);
    double a, b;
    square_of(lit->axis, photon.ray.d, &a, &b);
    assert_true(vec_length(vec_sub(photon.ray.o, lit->from)) < 1e-12);
    cells_add(&cells, a, b, photon.flux[lit->channel]);
  }
  cells_expect(&cells, intensity, lit);
  assert_chi2(what, &cells);
}

// Parallel light through the disc of `radius` around `from`, and a little more.
static double through_disc(const void *of, double a, double b) {
  const struct lit *lit = of;
  struct vec x, y;
  frame(lit->axis, vec(0.1, 0.7, -0.4), &x, &y);
  double R = 1.2 * lit->radius, r = R * sqrt(a);
  struct vec p = vec_along(vec_along(lit->from, x, r * cos(2 * pi * b)), y, r * sin(2 * pi * b));
  return r <= lit->radius ? pi * R * R * connected(lit, vec_along(p, lit->axis, 20)) : 0;
}

static void check_parallel(const char *what, const struct lit *lit) {
  struct stream stream = stream_begin(what);
  struct cells cells = {0};
  struct vec x, y;
  frame(lit->axis, vec(0.1, 0.7, -0.4), &x, &y);
  for (uint64_t j = 0; j < DRAWN; j++) {
    struct emission photon = emitted(lit, &stream, j);
    struct vec v = vec_scale(vec_sub(photon.ray.o, lit->from), 1 / (1.2 * lit->radius));
    assert_true(vec_length(vec_sub(photon.ray.d, lit->axis)) < 1e-12);
    double s = vec_dot(v, x), t = vec_dot(v, y);
    cells_add(&cells, s * s + t * t, turn(s, t), photon.flux[lit->channel]);
  }
  cells_expect(&cells, through_disc, lit);
  assert_chi2(what, &cells);
}

static double constant(const void *of, double a, double b) {
  return (void)a, (void)b, *(const double *)of;
}

static double from_far(const void *of, double a, double b) {
  const struct lit *lit = of;
  double rgb[3], disc = pi * lit->radius * lit->radius;
  struct vec d = direction_at(lit->axis, a, b);
  lit->light->type->background(lit->scene, lit->light, d, rgb);
  return directions_measure(a) * disc * rgb[lit->channel];
}

// Directions as the environment has them, and from each the disc of the scene's sphere, whatever
// the direction.
static void check_infinite(const char *what, const struct lit *lit, bool image) {
  struct stream stream = stream_begin(what);
  struct cells directions = {0}, disc = {0}, joint = {0};
  double power = lit->light->power[lit->channel];
  for (uint64_t j = 0; j < DRAWN; j++) {
    struct emission photon = emitted(lit, &stream, j);
    struct vec x, y, d = photon.ray.d, o = vec_scale(photon.ray.o, 1 / lit->radius);
    double a, b, flux = photon.flux[lit->channel];
    square_of(lit->axis, vec_scale(d, -1), &a, &b);
    cells_add(&directions, a, b, flux);
    frame(d, vec(0.3, 0.5, 0.2), &x, &y);
    double s = vec_dot(o, x), t = vec_dot(o, y);
    cells_add(&disc, fmin(1, s * s + t * t), turn(s, t), flux);
    if (!image) cells_add(&joint, (1 + d.z) / 2, fmin(1, s * s + t * t), flux);
  }
  cells_expect(&directions, from_far, lit);
  cells_expect(&disc, constant, &power);
  assert_chi2(arena_format(&arena, "%s, directions", what), &directions);
  assert_chi2(arena_format(&arena, "%s, disc", what), &disc);
  if (image) return;
  cells_expect(&joint, constant, &power);
  assert_chi2(arena_format(&arena, "%s, both", what), &joint);
}

// Of the square with an image, which is [-1, 1]^2.
static double from_square(const void *of, double a, double b) {
  const struct lit *lit = of;
  struct surface surface = {.ng = {0, 0, 1}, .uv = {a, b}};
  double rgb[3];
  lit->light->type->radiance(lit->scene, lit->light, &surface, vec(0, 0, 1), rgb);
  return 2 * pi * 4 * rgb[lit->channel]; // two sides, an area of 4
}

static void check_area(const char *what, const struct lit *lit, bool image) {
  struct stream stream = stream_begin(what);
  struct cells cosine_law = {0}, square = {0};
  double power = lit->light->power[lit->channel];
  const struct shape *shape = &lit->scene->shape[0];
  assert_true(shape->light == 0);
  for (uint64_t j = 0; j < DRAWN; j++) {
    struct emission photon = emitted(lit, &stream, j);
    struct vec x, y, d = photon.ray.d, o = photon.ray.o;
    double flux = photon.flux[lit->channel];
    struct vec n = shape->type->normal(lit->scene, shape, photon.ray.leaving, o);
    frame(n, vec(0.1, 0.7, -0.4), &x, &y);
    double z = vec_dot(d, n);
    assert_true(image || z >= -1e-6); // of one side
    cells_add(&cosine_law, fmin(1, z * z), turn(vec_dot(d, x), vec_dot(d, y)), flux);
    if (image) cells_add(&square, (o.x + 1) / 2, (o.y + 1) / 2, flux);
  }
  cells_expect(&cosine_law, constant, &power);
  assert_chi2(arena_format(&arena, "%s, cosine law", what), &cosine_law);
  if (!image) return;
  cells_expect(&square, from_square, lit);
  assert_chi2(arena_format(&arena, "%s, image", what), &square);
}

static void test_photons(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    const char *row = cases[i].row, *what = arena_format(&arena, "photons of %s (case %d)", row, i);
    struct scene scene = scene_of(&cases[i]);
    struct lit lit = lit_of(&scene, i);
    bool distant = !strcmp(row, "distant"), image = strstr(cases[i].text, IMAGE);
    lit.radius = !strcmp(row, "beam") ? 1.7 : sqrt(32); // of LIGHT_PLANE's bounds
    if (distant) lit.from = vec(0, 0, 0);
    if (distant || !strcmp(row, "beam"))
      check_parallel(what, &lit);
    else if (!strcmp(row, "infinite"))
      check_infinite(what, &lit, image);
    else if (!strcmp(row, "diffuse"))
      check_area(what, &lit, image);
    else
      check_point(what, &lit);
  }
}

// ---- next-event estimation ----

static double density_of_directions(const void *of, double a, double b) {
  const struct lit *lit = of;
  struct vec d = direction_at(lit->axis, a, b);
  return directions_measure(a) * lit->light->type->pdf(lit->scene, lit->light, lit->from, NULL, d);
}

// Whether a ray meets the lit side.
static double seen(const void *of, double a, double b) {
  const struct lit *lit = of;
  struct ray ray = {lit->from, direction_at(lit->axis, a, b), INFINITY, PRIMITIVE_NONE};
  struct hit hit;
  bvh_closest_brute_force(lit->scene, &ray, &hit, 1);
  if (hit.primitive == PRIMITIVE_NONE) return 0;
  struct surface surface;
  scene_surface(lit->scene, &ray, hit, &surface);
  if (lit->scene->shape[surface.shape].light == LIGHT_NONE) return 0;
  return lit->light->type->pdf(lit->scene, lit->light, ray.o, &surface, ray.d) > 0
             ? directions_measure(a)
             : 0;
}

// The density of an environment is that of the draws. Of a surface it is not bounded where it is
// seen edge-on: there each draw weighs one over it, which makes solid angles.
static void check_sample(const char *what, const struct lit *lit) {
  struct stream stream = stream_begin(what);
  struct cells cells = {0};
  bool far = lit->light->type->background;
  for (uint64_t j = 0; j < DRAWN; j++) {
    double u[LIGHT_U], a, b;
    struct light_sample nee;
    stream_read(&stream, j, u);
    if (!lit->light->type->sample(lit->scene, lit->light, lit->from, u, &nee)) continue;
    square_of(lit->axis, nee.wi, &a, &b);
    cells_add(&cells, a, b, far ? 1 : 1 / nee.pdf_solid_angle);
  }
  cells_expect(&cells, far ? density_of_directions : seen, lit);
  assert_chi2(what, &cells);
}

// From where all of the lit side is seen, as in light_rows.c.
static void test_samples(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    const struct case_of_light *c = &cases[i];
    struct scene scene = scene_of(c);
    struct lit lit = lit_of(&scene, i);
    if (lit.light->type->delta || strstr(c->text, "cylinder")) continue;
    lit.from = vec(c->centre.x, c->centre.y, 0.05);
    lit.axis = vec_normalize(vec_sub(vec(0, 0, 1.3), lit.from));
    check_sample(arena_format(&arena, "samples of %s (case %d)", c->row, i), &lit);
  }
}

static void test_p_values(void **state) {
  (void)state;
  assert_p_uniform(&p_values, 25);
}

int main(void) {
  arena = arena_reserve();
  write_image();
  const struct CMUnitTest tests[] = {
      {"photons leave as the light shines", test_photons, NULL, NULL, NULL},
      {"what is sampled has the density that is asked", test_samples, NULL, NULL, NULL},
      {"the p-values of all are uniform", test_p_values, NULL, NULL, NULL},
  };
  int failed = cmocka_run_group_tests_name("light_sampling", tests, NULL, NULL);
  remove_image();
  return failed;
}
