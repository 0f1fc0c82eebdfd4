// Every registered material: light paths measure what eye paths measure, shading normals included.
// A square with shading normals that turn across it, lit by a square above it, seen by one above
// and one below it. The flux that the lit square sends to each, by eye paths (from the receiver,
// each point and direction alike), by light paths, and by photons that wait on the square for the
// receiver to look.
#include "tests/bsdf_statistics.h"

struct square {
  struct vec centre, x, y, n; // half edges; rays leave and arrive on the side of n, unit length
};

static const struct square scatterer = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const struct square emitter = {{0.4, 0.1, 1}, {0.7, 0, 0}, {0, 0.9, 0}, {0, 0, -1}};
static const struct square receivers[] = {
    {{-0.5, -0.2, 1.1}, {0.8, 0, 0}, {0, 0.7, 0}, {0, 0, -1}},
    {{-0.3, 0.1, -0.9}, {0.9, 0, 0}, {0, 0.8, 0}, {0, 0, 1}},
};
enum { N_RECEIVERS = 2 };

static double square_area(const struct square *square) {
  return 4 * vec_length(square->x) * vec_length(square->y);
}

static struct vec square_point(const struct square *square, struct draw *draw) {
  double u, v;
  draw_pair(draw, &u, &v);
  return vec_along(vec_along(square->centre, square->x, 2 * u - 1), square->y, 2 * v - 1);
}

static struct vec draw_cosine(struct draw *draw, struct vec n) {
  double u, v;
  struct vec s, t;
  draw_pair(draw, &u, &v);
  vec_basis(n, &s, &t);
  double r = sqrt(u), phi = 2 * pi * v;
  struct vec across = vec_along(vec_scale(s, r * cos(phi)), t, r * sin(phi));
  return vec_along(across, n, sqrt(1 - u));
}

// Where the ray meets the square; `front`: only from the side of n.
static bool square_hit(const struct square *square, struct vec o, struct vec d, bool front,
                       struct vec *p) {
  double toward = vec_dot(d, square->n);
  if (toward == 0 || (front && toward > 0)) return false;
  double t = vec_dot(vec_sub(square->centre, o), square->n) / toward;
  if (!(t > 1e-9)) return false;
  *p = vec_along(o, d, t);
  struct vec v = vec_sub(*p, square->centre);
  return fabs(vec_dot(v, square->x)) <= vec_dot(square->x, square->x) &&
         fabs(vec_dot(v, square->y)) <= vec_dot(square->y, square->y);
}

// Normals up to 35 degrees off, differently everywhere.
static struct bsdf bent_bsdf(const struct scene *scene, struct vec p, struct draw *draw) {
  double u, unused;
  struct surface surface = {.p = p, .ng = vec(0, 0, 1), .dpdu = vec(1, 0.3, 0), .uv = {p.x, p.y}};
  surface.ns = vec_normalize(vec(0.4 * p.x + 0.1, 0.2 - 0.5 * p.y, 1));
  draw_pair(draw, &u, &unused);
  struct bsdf out;
  surface_bsdf(scene, &surface, u, &out);
  return out;
}

// A path's first two vertices: false if it misses the square or scatters nowhere.
static bool bounce(const struct scene *scene, const struct square *from, enum transport transport,
                   struct draw *draw, struct vec *p, struct bsdf_sample *sample) {
  struct vec o = square_point(from, draw), d = draw_cosine(draw, from->n);
  if (!square_hit(&scatterer, o, d, false, p)) return false;
  struct bsdf bsdf = bent_bsdf(scene, *p, draw);
  return draw_sample(draw, &bsdf, vec_scale(d, -1), transport, sample);
}

static struct mean flux_by_eye(const struct scene *scene, const struct square *receiver, int n,
                               struct draw *draw) {
  struct mean flux = {0};
  for (int k = 0; k < n; k++) {
    struct vec p, q;
    struct bsdf_sample s;
    bool lit = bounce(scene, receiver, TRANSPORT_RADIANCE, draw, &p, &s) &&
               square_hit(&emitter, p, s.wi, true, &q);
    mean_add(&flux, lit ? s.weight[0] * square_area(receiver) * pi : 0);
  }
  return flux;
}

static struct mean flux_by_light(const struct scene *scene, const struct square *receiver, int n,
                                 struct draw *draw) {
  struct mean flux = {0};
  for (int k = 0; k < n; k++) {
    struct vec p, q;
    struct bsdf_sample s;
    bool seen = bounce(scene, &emitter, TRANSPORT_IMPORTANCE, draw, &p, &s) &&
                square_hit(receiver, p, s.wi, true, &q);
    mean_add(&flux, seen ? s.weight[0] * square_area(&emitter) * pi : 0);
  }
  return flux;
}

static struct mean flux_by_photons(const struct scene *scene, const struct square *receiver, int n,
                                   struct draw *draw) {
  struct mean flux = {0};
  for (int k = 0; k < n; k++) {
    struct vec o = square_point(&emitter, draw), d = draw_cosine(draw, emitter.n), p;
    double value = 0;
    if (square_hit(&scatterer, o, d, false, &p)) {
      struct bsdf bsdf = bent_bsdf(scene, p, draw);
      struct vec to = vec_sub(square_point(receiver, draw), p), wi = vec_scale(d, -1);
      double d2 = vec_dot(to, to), f[3];
      struct vec wo = vec_scale(to, 1 / sqrt(d2));
      bsdf_value(&bsdf, wo, wi, TRANSPORT_RADIANCE, f);
      value = f[0] * bsdf_photon_factor(&bsdf, wi) * fabs(vec_dot(wo, bsdf.ng)) *
              fmax(-vec_dot(wo, receiver->n), 0) / d2 * square_area(receiver) *
              square_area(&emitter) * pi;
    }
    mean_add(&flux, value);
  }
  return flux;
}

enum { N_PATHS = 100000, N_FLUX_TESTS = N_MATERIAL_CASES * N_RECEIVERS * 2 };

// A path counts pi times the area it starts on, over N_PATHS: an estimate may miss what 30 of them
// would bring (probability exp(-30)), and then knows no variance.
static void compare(const char *text, const char *what, struct mean a, struct mean b) {
  double difference = mean_of(&a) - mean_of(&b), unit = pi * square_area(&emitter) / N_PATHS;
  double se = sqrt(variance_of_mean(&a) + variance_of_mean(&b));
  double limit = gsl_cdf_ugaussian_Qinv(level / N_FLUX_TESTS / 2) * se + 30 * unit;
  if (!(fabs(difference) <= limit))
    fail_msg("%s, %s: %.5f and %.5f +- %.5f", text, what, mean_of(&a), mean_of(&b), se);
}

// 100,000 paths give the flux to about 1.5 %. Without the factor for shading normals a diffuse
// surface would send 7 % less by light paths, an anisotropic metal 12 %.
static void light_paths_measure_what_eye_paths_measure(void **state) {
  (void)state;
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct draw draw = draw_case("light_paths_measure_what_eye_paths_measure", i);
    bool delta = material_of(&scene)->needs & MATERIAL_DELTA;
    for (int r = 0; r < N_RECEIVERS; r++) {
      struct mean eye = flux_by_eye(&scene, &receivers[r], N_PATHS, &draw);
      struct mean light = flux_by_light(&scene, &receivers[r], N_PATHS, &draw);
      compare(material_cases[i].text, "eye and light paths", eye, light);
      if (delta) continue;
      struct mean photons = flux_by_photons(&scene, &receivers[r], N_PATHS, &draw);
      compare(material_cases[i].text, "eye paths and photons", eye, photons);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(light_paths_measure_what_eye_paths_measure),
  };
  return cmocka_run_group_tests_name("bsdf_adjoint", tests, NULL, NULL);
}
