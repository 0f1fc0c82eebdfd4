// Photon beams: crossings against an integral over both lines, the tree against all beams, pieces
// against the whole, segments of the eye's ray against closed forms.
#define _GNU_SOURCE // mkstemp
#include "bvh/bvh.h"
#include "density/beam_gather.h"
#include "tests/light_fixture.h"
#include "walk/photons.h"

#include <math.h>

static struct arena arena;

struct stream {
  struct rng_key key;
  uint64_t next;
};

static struct stream stream_of(const char *name) {
  return (struct stream){rng_key(rng_hash_name(name), 1, RNG_TEST), 0};
}

static double uniform(struct stream *stream) {
  double u, unused;
  rng_fill(stream->key, 1, &stream->next, 1, 0, &u, &unused);
  stream->next++;
  return u;
}

static struct vec point_in_cube(struct stream *stream, double half) {
  double x = uniform(stream), y = uniform(stream), z = uniform(stream);
  return vec((2 * x - 1) * half, (2 * y - 1) * half, (2 * z - 1) * half);
}

static struct vec direction(struct stream *stream) {
  for (;;) {
    struct vec v = point_in_cube(stream, 1);
    if (vec_dot(v, v) > 0.01 && vec_dot(v, v) < 1) return vec_normalize(v);
  }
}

// ---- one crossing ----

static const double sigma_a = 0.2, sigma_s = 0.7, g = 0.4, flux = 2.385;

#define FOG                                                                                        \
  "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.2 0.2 0.2] "         \
  "\"rgb sigma_s\" [0.7 0.7 0.7] \"float g\" 0.4\n"
#define FILLED FOG "MediumInterface \"fog\" \"fog\"\n"

static double henyey_greenstein(double cosine) {
  double squared = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * pi * squared * sqrt(squared));
}

// The radiance before blur and division by sin theta are done in closed form: the integral over
// both lines of T sigma_s f flux k(x - y), x on the eye's and y on the beam, k = k_r across the
// plane of both directions, and a Gaussian in that plane so narrow that T does not change over it.
// The trapezoidal rule converges faster than any power.
static double by_quadrature(const struct eye_segment *eye, const struct photon_beam *beam,
                            const struct kernel *kernel, double r, double t0, double s0) {
  enum { STEPS = 160 };
  const double width = 1e-4, reach = 8 * width / vec_length(vec_cross(eye->d, beam->d));
  double step = 2 * reach / STEPS, sum = 0, cosine = -vec_dot(eye->d, beam->d);
  struct vec n = vec_normalize(vec_cross(eye->d, beam->d));
  for (int i = 0; i <= STEPS; i++)
    for (int j = 0; j <= STEPS; j++) {
      double t = t0 - reach + i * step, s = s0 - reach + j * step;
      struct vec apart = vec_sub(vec_along(eye->o, eye->d, t), vec_along(beam->o, beam->d, s));
      double u = vec_dot(apart, n), in2 = vec_dot(apart, apart) - u * u;
      double k = kernel_value(kernel, 1, u * u / (r * r)) / r * exp(-in2 / (2 * width * width)) /
                 (2 * pi * width * width);
      sum += k * exp(-(sigma_a + sigma_s) * t) * step * step;
    }
  return sum * sigma_s * henyey_greenstein(cosine) * flux;
}

static struct walk walk_in(const struct scene *scene) {
  return (struct walk){.scene = scene, .n_channels = 1, .iteration = 1};
}

static double gathered(const struct walk *walk, const struct eye_segment *eye,
                       struct photon_beam *beam, const struct kernel *kernel, double r) {
  static struct beam_gather gather;
  double power = flux, out = 0;
  struct beams beams = {.count = 1, .n_channels = 1, .beam = beam, .flux = {&power}};
  struct strip strip = strip_of(kernel, kernel->constants(1).c, r, 4);
  beam_gather_segment(&gather, walk, &beams, NULL, eye, 5, &strip, 1, &out, 1, &arena);
  return out;
}

static void crossings_are_integrals(void **state) {
  (void)state;
  struct scene scene = light_scene(FILLED "LightSource \"point\"" LIGHT_PLANE, &arena);
  struct walk walk = walk_in(&scene);
  struct stream stream = stream_of("beams crossings");
  for (int j = 0; j < 40; j++) {
    double t = 0.5 + uniform(&stream), s = 0.5 + uniform(&stream), r = 0.3;
    struct vec x = point_in_cube(&stream, 2), d = direction(&stream), b = direction(&stream);
    struct vec n = vec_normalize(vec_cross(d, b)), y = vec_along(x, n, 0.28 * uniform(&stream));
    struct eye_segment eye = {
        .o = vec_along(x, d, -t), .d = d, .length = 2, .weight = {1.7}, .medium = 0};
    struct photon_beam beam = {.o = vec_along(y, b, -s), .d = b, .length = 2};
    const struct kernel *kernel = kernel_find(j % 2 ? "biweight" : "epanechnikov");
    double expected = 1.7 / 4 * by_quadrature(&eye, &beam, kernel, r, t, s);
    double found = gathered(&walk, &eye, &beam, kernel, r);
    if (!(fabs(found - expected) <= 1e-6 * expected)) fail_msg("%.9g, not %.9g", found, expected);
  }
}

static void what_counts(void **state) {
  (void)state;
  struct scene scene = light_scene(FILLED "LightSource \"point\"" LIGHT_PLANE, &arena);
  struct walk walk = walk_in(&scene);
  const struct kernel *box = kernel_find("box");
  struct eye_segment eye = {.o = {0, 0, 0}, .d = {1, 0, 0}, .length = 1, .weight = {1}};
  struct photon_beam across = {.o = {0.5, -1, 0.1}, .d = {0, 1, 0}, .length = 2};
  assert_true(gathered(&walk, &eye, &across, box, 0.11) > 0);
  assert_true(gathered(&walk, &eye, &across, box, 0.09) == 0);
  struct photon_beam beam = across;
  beam.length = 0.99; // ends before the ray
  assert_true(gathered(&walk, &eye, &beam, box, 0.2) == 0);
  beam = across, beam.o.x = 1.01; // passes behind the ray's end
  assert_true(gathered(&walk, &eye, &beam, box, 0.2) == 0);
  beam = across, beam.o.x = -0.01;
  assert_true(gathered(&walk, &eye, &beam, box, 0.2) == 0);
  beam = across, beam.d = eye.d; // parallel
  assert_true(gathered(&walk, &eye, &beam, box, 2) == 0);
  beam = across, beam.vertex = 3, eye.vertex = 1; // depth 5: three, one and the crossing
  assert_true(gathered(&walk, &eye, &beam, box, 0.2) > 0);
  eye.vertex = 2;
  assert_true(gathered(&walk, &eye, &beam, box, 0.2) == 0);
  eye.vertex = 0;
  static const double no_radius[] = {0, INFINITY};
  for (int j = 0; j < 2; j++) assert_true(gathered(&walk, &eye, &across, box, no_radius[j]) == 0);
}

// ---- many ----

static struct beams beams_at_random(struct stream *stream, int n, double longest) {
  struct beams beams = {.count = n, .n_channels = 1};
  beams.beam = arena_new(&arena, struct photon_beam, n);
  beams.flux[0] = arena_new(&arena, double, n);
  for (int j = 0; j < n; j++) {
    double u = uniform(stream);
    beams.beam[j] = (struct photon_beam){
        .o = point_in_cube(stream, 1), .d = direction(stream), .length = longest * u * u * u};
    if (j % 7 == 0) beams.beam[j].d = vec(0, j % 2 ? -1 : 1, 0);
    if (j % 11 == 0) beams.beam[j].o = vec(0.25, -0.5, 0.125);
  }
  return beams;
}

static void the_tree_finds_what_is_there(void **state) {
  (void)state;
  enum { MOST = 3000 };
  static uint32_t expected[MOST], found[MOST];
  static const int count[] = {0, 1, 4, 5, 64, MOST};
  struct stream stream = stream_of("beams tree");
  struct beam_tree tree = {0};
  int64_t total = 0;
  for (int c = 0; c < 6; c++) {
    struct beams beams = beams_at_random(&stream, count[c], c % 2 ? 4 : 0.3);
    beam_tree_build(&tree, &beams, &arena);
    for (int j = 0; j < 300; j++) {
      double r = 0.2 * uniform(&stream) * uniform(&stream);
      struct eye_segment eye = {.o = point_in_cube(&stream, j % 3 ? 1 : 30),
                                .length = j % 2 ? INFINITY : uniform(&stream)};
      struct vec at = point_in_cube(&stream, 1);
      eye.d = vec_normalize(vec_sub(at, eye.o));
      if (j % 5 == 0) eye.d = vec(0, 0, j % 10 ? 1 : -1);
      int64_t n = beam_find_all(&beams, &eye, r, expected);
      assert_int_equal(beam_tree_find(&tree, &beams, &eye, r, found), n);
      assert_memory_equal(found, expected, (size_t)n * sizeof *found);
      total += n;
    }
  }
  assert_true(total > 1000);
}

// Two halves of each beam, and of each ray, are crossed as often as the whole.
static void nothing_is_lost_between_pieces(void **state) {
  (void)state;
  enum { N = 2000 };
  static uint32_t found[2 * N];
  struct stream stream = stream_of("beams pieces");
  struct beams whole = beams_at_random(&stream, N, 4), parted = {.n_channels = 1};
  parted.beam = arena_new(&arena, struct photon_beam, 2 * N);
  for (int j = 0; j < N; j++) {
    struct photon_beam first = whole.beam[j], second = first;
    first.length /= 2;
    second.o = vec_along(first.o, first.d, first.length);
    second.length = first.length;
    parted.beam[parted.count++] = first;
    parted.beam[parted.count++] = second;
  }
  int64_t total = 0;
  for (int j = 0; j < 200; j++) {
    struct eye_segment eye = {
        .o = point_in_cube(&stream, 1), .d = direction(&stream), .length = 3 * uniform(&stream)};
    struct eye_segment near = eye, far = eye;
    near.length = eye.length / 2;
    far.o = vec_along(eye.o, eye.d, near.length);
    far.length = near.length;
    int64_t n = beam_find_all(&whole, &eye, 0.1, found);
    assert_int_equal(beam_find_all(&parted, &eye, 0.1, found), n);
    assert_int_equal(
        beam_find_all(&whole, &near, 0.1, found) + beam_find_all(&whole, &far, 0.1, found), n);
    total += n;
  }
  assert_true(total > 1000);
}

// ---- passes ----

// A sphere of fog of radius 1 in a vacuum, before a wall 3 behind its middle; the camera is at 9.
#define SPHERE                                                                                     \
  FOG "AttributeBegin\nMediumInterface \"fog\" \"\"\nMaterial \"interface\"\nShape \"sphere\"\n"   \
      "AttributeEnd\nTranslate 0 0 -3\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 5]" LIGHT_PLANE

static struct walk *walk_through(const struct scene *scene) {
  struct walk *walk = walk_new(scene, bvh_build(scene, (struct bvh_options){.threads = 1}, &arena),
                               scene_features(scene), &arena);
  walk->key = rng_key(rng_hash_name("beams passes"), 1, RNG_EYE);
  walk_begin(walk, 1, 1, 1);
  return walk;
}

static void rays_are_followed_through_fog(void **state) {
  (void)state;
  struct scene scene = light_scene(SPHERE, &arena);
  const struct pixel pixel = {scene.camera.width / 2, scene.camera.height / 2};
  struct eye_segments segments = {0};
  struct eye_point point;
  eye_segments_trace(&segments, walk_through(&scene), &pixel, 1, false, 5, &point, &arena);
  assert_int_equal(segments.count, 1);
  const struct eye_segment *segment = segments.segment;
  assert_true(fabs(vec_length(segment->o) - 1) < 1e-6); // where it enters the sphere
  assert_true(fabs(segment->length - 2) < 1e-3 && segment->weight[0] == 1);
  assert_true(segment->point == 0 && segment->vertex == 0 && segment->number == 0);
  double left = exp(-(sigma_a + sigma_s) * segment->length);
  assert_true(point.hit && !point.volume);
  assert_true(fabs(point.weight[0] / left - 1) < 1e-12);
  assert_true(fabs(point.emitted[0] / (5 * left) - 1) < 1e-6);
}

// The length that photons fly in fog without end is 1 / sigma_t a flight, and they scatter with the
// albedo. All of one scattering or none: the mean of length times flux is Phi (1 + albedo) /
// sigma_t; its z in n paths, |z| < 4.4: level 1e-5.
static void beams_are_as_long_as_photons_fly(void **state) {
  (void)state;
  struct scene scene =
      light_scene(FILLED "LightSource \"beam\"\nTranslate 0 0 -50" LIGHT_PLANE, &arena);
  struct walk *walk = walk_through(&scene);
  enum { N = 20000 };
  struct photon_pass pass = {.n_emitted = N, .depth = 2};
  struct photons photons = {0};
  struct beams beams = {0};
  struct photon_sinks sinks = {.surface = {&photons, NULL}, .beams = &beams};
  photons_trace(walk, &pass, &sinks, &arena);
  double sum = 0, sigma = sigma_a + sigma_s, albedo = sigma_s / sigma;
  int64_t scattered = 0;
  for (int64_t j = 0; j < beams.count; j++) {
    sum += beams.beam[j].length * beams.flux[0][j];
    scattered += beams.beam[j].vertex == 1;
    assert_true(beams.beam[j].length > 0 && beams.beam[j].vertex < 2);
  }
  assert_int_equal(beams.count, N + scattered);
  // Lengths are exponential; roulette makes the second flight's number binomial.
  double variance = (1 + 2 * albedo - albedo * albedo) / (sigma * sigma);
  double z = (sum / N - (1 + albedo) / sigma) / sqrt(variance / N);
  if (!(fabs(z) < 4.4)) fail_msg("z = %g", z);
  pass.first_vertex = 1;
  int64_t all = beams.count;
  photons_trace(walk, &pass, &sinks, &arena);
  assert_int_equal(beams.count, scattered);
  assert_true(all > scattered && !walk->flown);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crossings_are_integrals),
      cmocka_unit_test(what_counts),
      cmocka_unit_test(the_tree_finds_what_is_there),
      cmocka_unit_test(nothing_is_lost_between_pieces),
      cmocka_unit_test(rays_are_followed_through_fog),
      cmocka_unit_test(beams_are_as_long_as_photons_fly),
  };
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  arena_release(arena);
  return failed;
}
