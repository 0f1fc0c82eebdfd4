// Every registered material as hypotheses: samples follow the pdf, weights are what the value
// integrates to, no importance is created; and the p-values of the first are uniform.
#include "tests/bsdf_statistics.h"
#include "tests/p_values.h"

static const enum transport transports[] = {TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE};
static const struct vec views[] = {{0, 0, 1},           {0.48, -0.36, 0.8}, {-0.6, 0.77, 0.2},
                                   {0.998, 0.01, 0.05}, {0.28, 0.57, -0.6}, {-0.1, -0.99, -0.1}};
enum { N_VIEWS = (int)(sizeof views / sizeof *views) };

// ---- integrals over the sphere ----
// In cells of (theta, phi), split until they do not change: pdf, then f |cos| of the first channel.

enum { ROWS = 16, COLUMNS = 16, CELLS = ROWS * COLUMNS, MAX_SPLITS = 7 };

struct integrand {
  const struct bsdf *bsdf;
  struct vec wo;
  enum transport transport;
  bool random; // f is
};

struct box2 {
  double theta[2], phi[2];
};

static void evaluate(const struct integrand *g, double theta, double phi, double out[2]) {
  double f[3] = {0, 0, 0};
  struct vec wi = vec(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
  if (!g->random) bsdf_value(g->bsdf, g->wo, wi, g->transport, f);
  out[0] = bsdf_pdf(g->bsdf, g->wo, wi, g->transport) * sin(theta);
  out[1] = f[0] * fabs(wi.z) * sin(theta);
}

static void gauss(const struct integrand *g, struct box2 box, double out[2]) {
  // Gauss-Legendre, 4 points: roots and weights on [-1, 1].
  static const double root[] = {-0.861136311594052575, -0.339981043584856265, 0.339981043584856265,
                                0.861136311594052575};
  static const double weight[] = {0.347854845137453857, 0.652145154862546143, 0.652145154862546143,
                                  0.347854845137453857};
  double half_theta = (box.theta[1] - box.theta[0]) / 2, half_phi = (box.phi[1] - box.phi[0]) / 2;
  out[0] = out[1] = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double value[2], w = weight[i] * weight[j] * half_theta * half_phi;
      evaluate(g, box.theta[0] + half_theta * (1 + root[i]), box.phi[0] + half_phi * (1 + root[j]),
               value);
      for (int k = 0; k < 2; k++) out[k] += w * value[k];
    }
}

static void integrate(const struct integrand *g, struct box2 box, const double whole[2],
                      double tolerance, int splits, double sum[2]) {
  double middle[2] = {(box.theta[0] + box.theta[1]) / 2, (box.phi[0] + box.phi[1]) / 2};
  double part[4][2], total[2] = {0, 0};
  struct box2 parts[4];
  for (int k = 0; k < 4; k++) {
    parts[k] = box;
    parts[k].theta[1 - k % 2] = middle[0];
    parts[k].phi[1 - k / 2] = middle[1];
    gauss(g, parts[k], part[k]);
    for (int c = 0; c < 2; c++) total[c] += part[k][c];
  }
  bool done = fabs(total[0] - whole[0]) <= tolerance && fabs(total[1] - whole[1]) <= tolerance;
  if (splits == MAX_SPLITS || done) {
    for (int c = 0; c < 2; c++) sum[c] += total[c];
    return;
  }
  for (int k = 0; k < 4; k++) integrate(g, parts[k], part[k], tolerance / 2, splits + 1, sum);
}

// cell[k][0]: probability; cell[k][1]: of f |cos|. Within 1e-5: 0.3 of the samples below.
static void integrate_cells(const struct integrand *g, double cell[CELLS][2]) {
  for (int k = 0; k < CELLS; k++) {
    int row = k / COLUMNS, column = k % COLUMNS;
    struct box2 box = {{pi * row / ROWS, pi * (row + 1) / ROWS},
                       {2 * pi * column / COLUMNS, 2 * pi * (column + 1) / COLUMNS}};
    double whole[2];
    gauss(g, box, whole);
    cell[k][0] = cell[k][1] = 0;
    integrate(g, box, whole, 1e-5, 0, cell[k]);
  }
}

static int cell_of(struct vec w) {
  double phi = atan2(w.y, w.x) / (2 * pi);
  int row = (int)(acos(w.z) / pi * ROWS), column = (int)((phi < 0 ? phi + 1 : phi) * COLUMNS);
  return (row < ROWS ? row : ROWS - 1) * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1);
}

// ---- samples against pdf and value ----

struct tally {
  double count[CELLS], delta, none;
  struct mean weight; // without delta lobes
};

static void take_samples(const struct integrand *g, struct draw *draw, int n, struct tally *tally) {
  *tally = (struct tally){.none = 0};
  for (int k = 0; k < n; k++) {
    struct bsdf_sample s;
    bool sampled = draw_sample(draw, g->bsdf, g->wo, g->transport, &s);
    mean_add(&tally->weight, sampled && s.pdf > 0 ? s.weight[0] : 0);
    if (!sampled)
      tally->none += 1;
    else if (s.pdf == 0)
      tally->delta += 1;
    else
      tally->count[cell_of(s.wi)] += 1;
  }
}

// f |cos| integrated by uniform directions: where f is random, cells cannot tell.
static struct mean uniform_energy(const struct integrand *g, struct draw *draw, int n) {
  struct mean energy = {0};
  for (int k = 0; k < n; k++) {
    double f[3];
    struct vec wi = draw_direction(draw);
    bsdf_value(g->bsdf, g->wo, wi, g->transport, f);
    mean_add(&energy, f[0] * fabs(wi.z) * 4 * pi);
  }
  return energy;
}

struct chi2 {
  double sum, rare_expected, rare_count;
  int terms;
};

// What expects less than 5 is one term.
static void chi2_add(struct chi2 *chi2, double expected, double count) {
  if (expected < 5) {
    chi2->rare_expected += expected;
    chi2->rare_count += count;
    return;
  }
  chi2->sum += (count - expected) * (count - expected) / expected;
  chi2->terms++;
}

static struct p_values p_values;

static double chi2_p(struct chi2 *chi2) {
  double expected = chi2->rare_expected, count = chi2->rare_count;
  if (expected <
      5) { // the upper tail of a Poisson variable, 0.3 a cell of integration error allowed
    double p = count > 0 ? gsl_cdf_gamma_P(expected + 0.5, count, 1) : 1;
    if (p < level) return p;
  } else {
    chi2->sum += (count - expected) * (count - expected) / expected;
    chi2->terms++;
  }
  if (chi2->terms < 2) return 1;
  double p = gsl_cdf_chisq_Q(chi2->sum, chi2->terms - 1);
  p_values_add(&p_values, p);
  return p;
}

// 30,000 samples in 256 cells: a lobe that is 10 % too wide or a share of 0.02 that goes elsewhere
// gives a chi-squared of some hundreds more than its degrees of freedom. The mean weight is known
// to some 0.002: a Fresnel term or a cosine that is left out is hundreds of that.
enum { N_SAMPLES = 30000, N_TESTS = N_MATERIAL_CASES * N_VIEWS * 2 * 2 };

static void check_distribution(const char *what, const struct integrand *g, double cell[CELLS][2],
                               const struct tally *tally) {
  struct chi2 chi2 = {0};
  double delta = bsdf_delta_probability(g->bsdf, g->wo, g->transport), total = 0;
  for (int c = 0; c < CELLS; c++) {
    total += cell[c][0];
    chi2_add(&chi2, N_SAMPLES * cell[c][0], tally->count[c]);
  }
  if (!(total <= 1 - delta + 1e-3)) fail_msg("%s: the pdf integrates to %.6f", what, total);
  chi2_add(&chi2, N_SAMPLES * delta, tally->delta);
  chi2_add(&chi2, N_SAMPLES * fmax(1 - delta - total, 0), tally->none);
  double p = chi2_p(&chi2);
  if (!(p >= level / N_TESTS))
    fail_msg("%s: chi-squared %.1f over %d cells, p = %.2g", what, chi2.sum, chi2.terms, p);
}

static void check_energy(const char *what, const struct integrand *g, double cell[CELLS][2],
                         const struct tally *tally, struct draw *draw) {
  double energy = 0, variance = variance_of_mean(&tally->weight), mean = mean_of(&tally->weight);
  for (int c = 0; c < CELLS; c++) energy += cell[c][1];
  if (g->random) {
    struct mean uniform = uniform_energy(g, draw, N_SAMPLES);
    energy = mean_of(&uniform);
    variance += variance_of_mean(&uniform);
  }
  double limit = gsl_cdf_ugaussian_Qinv(level / N_TESTS / 2) * sqrt(variance) + 1e-3; // of cells
  if (!(fabs(mean - energy) <= limit))
    fail_msg("%s: weights have mean %.5f +- %.5f, the value %.5f", what, mean, sqrt(variance),
             energy);
}

static void samples_follow_the_pdf_and_weigh_the_value(void **state) {
  (void)state;
  static double cell[CELLS][2];
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    struct draw draw = draw_case("samples_follow_the_pdf_and_weigh_the_value", i);
    for (int k = 0; bsdf.type && k < 2 * N_VIEWS; k++) {
      struct integrand g = {&bsdf, vec_normalize(views[k / 2]), transports[k % 2],
                            material_is_random(&scene)};
      struct tally tally;
      char what[512];
      snprintf(what, sizeof what, "%s, view %d, %s", material_cases[i].text, k / 2,
               k % 2 ? "importance" : "radiance");
      integrate_cells(&g, cell);
      take_samples(&g, &draw, N_SAMPLES, &tally);
      check_distribution(what, &g, cell, &tally);
      check_energy(what, &g, cell, &tally, &draw);
    }
  }
}

// Where a lobe fills some ten cells or more. Of some 200, a distance of 0.17 is accepted, one of
// 0.23 found.
static void p_values_are_uniform(void **state) {
  (void)state;
  assert_p_uniform(&p_values, 150);
}

// ---- energy ----

// Importance is not created: the mean weight is at most 1, and the albedo where one is known.
static void importance_is_not_created(void **state) {
  (void)state;
  enum { N = 10000, TESTS = N_MATERIAL_CASES * N_VIEWS };
  double z = gsl_cdf_ugaussian_Qinv(level / TESTS / 2);
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct draw draw = draw_case("importance_is_not_created", i);
    double albedo = material_cases[i].albedo;
    for (int v = 0; v < N_VIEWS; v++) {
      struct mean weight = {0};
      for (int k = 0; k < N; k++) {
        double u, unused;
        struct bsdf_sample s;
        draw_pair(&draw, &u, &unused);
        struct bsdf bsdf = material_bsdf(&scene, u);
        bool sampled = draw_sample(&draw, &bsdf, vec_normalize(views[v]), TRANSPORT_IMPORTANCE, &s);
        mean_add(&weight, sampled ? s.weight[0] : 0);
      }
      double mean = mean_of(&weight), slack = z * sqrt(fmax(variance_of_mean(&weight), 0)) + 1e-12;
      if (!(mean <= 1 + slack) || (!isnan(albedo) && !(fabs(mean - albedo) <= slack)))
        fail_msg("%s, view %d: albedo %.5f, not %.5f", material_cases[i].text, v, mean, albedo);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_follow_the_pdf_and_weigh_the_value),
      cmocka_unit_test(p_values_are_uniform),
      cmocka_unit_test(importance_is_not_created),
  };
  return cmocka_run_group_tests_name("bsdf", tests, NULL, NULL);
}
