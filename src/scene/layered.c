#include "scene/layered.h"
#include "numeric/rng.h"

#include <float.h>
#include <string.h>

static const double one_over_4pi = 0x1.45f306dc9c883p-4, one_over_pi = 0x1.45f306dc9c883p-2;

// ---- the numbers of one walk ----

struct draws {
  struct rng_key key;
  uint32_t block;
  uint32_t word[4];
  int left;
};

static uint64_t absorb(uint64_t hash, double x) { // splitmix64's finalizer over the bits
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  hash = (hash ^ bits) + 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111eb;
  return hash ^ hash >> 31;
}

static struct draws draws_of(double u, struct vec wo, struct vec wi) {
  const double seed[7] = {u, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z};
  uint64_t hash = 0;
  for (int i = 0; i < 7; i++) hash = absorb(hash, seed[i]);
  return (struct draws){.key = {{(uint32_t)hash, (uint32_t)(hash >> 32)}}};
}

static double draw(struct draws *draws) { // in (0, 1)
  if (!draws->left) {
    const uint32_t counter[4] = {draws->block++, 0, 0, 0};
    rng_philox(draws->key, counter, draws->word);
    draws->left = 4;
  }
  return (draws->word[--draws->left] + 0.5) * 0x1p-32;
}

static void draw_two(struct draws *draws, double u[2]) {
  u[0] = draw(draws);
  u[1] = draw(draws);
}

// ---- the base ----

static bool base_is_smooth(const struct layered *l) {
  return l->is_conductor && l->conductor.facets.smooth;
}

// Directions above the base, not of a smooth one.
static void base_value(const struct layered *l, struct vec wo, struct vec wi, double f[3]) {
  if (l->is_conductor) {
    conductor_value(&l->conductor, wo, wi, f);
    return;
  }
  for (int c = 0; c < 3; c++) f[c] = l->reflectance[c] * one_over_pi;
}

static double base_pdf(const struct layered *l, struct vec wo, struct vec wi) {
  return l->is_conductor ? conductor_pdf(&l->conductor, wo, wi) : wi.z * one_over_pi;
}

// weight: f |cos| / pdf; pdf 0: a delta.
static bool base_sample(const struct layered *l, struct vec wo, const double u[2], struct vec *wi,
                        double weight[3], double *pdf) {
  if (l->is_conductor) {
    if (!conductor_sample(&l->conductor, wo, u, wi, weight, pdf)) return false;
    if (l->conductor.facets.smooth) *pdf = 0;
    return true;
  }
  *wi = layered_cosine_direction(u);
  *pdf = wi->z * one_over_pi;
  for (int c = 0; c < 3; c++) weight[c] = l->reflectance[c];
  return wi->z > 0;
}

// ---- the medium ----

// cosine between the directions, both away from the point: -1 is straight on.
static double phase(double g, double cosine) {
  double denominator = 1 + g * g + 2 * g * cosine;
  return one_over_4pi * (1 - g * g) / (denominator * sqrt(denominator));
}

// Density and value are the same. With x = 1 - 2 u and y = -(g + x) / (1 + g x) the inversion
// -(1 + g^2 - q^2) / (2 g), q = 1 + g y, needs no division by g: it holds for g = 0 too.
static struct vec phase_sample(double g, struct vec wo, const double u[2]) {
  double x = 1 - 2 * u[0], y = -(g + x) / (1 + g * x);
  double cosine = y - g * (1 - y) * (1 + y) / 2;
  double square = (1 - cosine) * (1 + cosine), r = square > 0 ? sqrt(square) : 0, sin_phi, cos_phi;
  struct vec s, t;
  vec_basis(wo, &s, &t);
  num_sincos_turns(u[1], &sin_phi, &cos_phi);
  return vec_along(vec_along(vec_scale(s, r * cos_phi), t, r * sin_phi), wo, cosine);
}

// ---- the walk ----

struct walk {
  const struct layered *layered;
  struct draws draws;
  struct vec wi;                // outside, where the walk must leave to
  struct vec exit;              // inside, downwards: sampled from wi through the coat
  double exit_weight, exit_pdf; // of `exit`: f |cos| / pdf and pdf
  struct vec w;                 // where the walk goes
  double z;                     // above the base
  double beta[3];
  int depth;
  double *f; // the sum over walks
};

// Power heuristic, one sample each.
static double heuristic(double pdf, double other) {
  double a = pdf * pdf, b = other * other;
  return a / (a + b);
}

static void add(struct walk *walk, double scale, const double f[3]) {
  for (int c = 0; c < 3; c++) walk->f[c] += walk->beta[c] * f[c] * scale;
}

static void multiply(double beta[3], const double weight[3]) {
  for (int c = 0; c < 3; c++) beta[c] *= weight[c];
}

// Through the coat to wi by the direction that was sampled from there; pdf: with which the base
// or the medium would have sampled it.
static void connect_sampled(struct walk *walk, const double f[3], double pdf, double distance) {
  double weight = walk->layered->coat.facets.smooth ? 1 : heuristic(walk->exit_pdf, pdf);
  add(walk, weight * walk->exit_weight * coat_attenuation(distance, walk->exit.z), f);
}

// By the direction w that the base or the medium sampled with density pdf (0: a delta).
static void connect_direct(struct walk *walk, double pdf, double distance) {
  static const double one[3] = {1, 1, 1};
  if (walk->layered->coat.facets.smooth) return;
  double exit_pdf;
  double f =
      coat_transmission(&walk->layered->coat, walk->wi, layered_opposite(walk->w), &exit_pdf);
  if (!(f > 0)) return;
  double weight = pdf > 0 ? heuristic(pdf, exit_pdf) : 1;
  add(walk, weight * f * coat_attenuation(distance, walk->w.z), one);
}

// Between smooth interfaces the medium's light leaves along `exit` either directly or by way of the
// metal, and after any number of turns between metal and coat: none of it could be sampled
// otherwise. (pbrt-v4's f has the direct one only, its sampling has all.)
static void connect_smooth(struct walk *walk, struct vec back) {
  const struct layered *l = walk->layered;
  struct vec up = layered_opposite(walk->exit), down = vec(up.x, up.y, -up.z);
  double turn = coat_attenuation(2 * l->thickness, up.z);
  double direct = phase(l->g, vec_dot(back, up)) * coat_attenuation(l->thickness - walk->z, up.z);
  double by_metal =
      phase(l->g, vec_dot(back, down)) * coat_attenuation(l->thickness + walk->z, up.z);
  double fresnel = fresnel_dielectric(walk->exit.z, l->coat.eta), metal[3], sum[3] = {0};
  conductor_fresnel(&l->conductor, up.z, 1, metal);
  for (int c = 0; c < 3; c++) {
    double power = 1;
    for (int depth = walk->depth + 1; depth < l->max_depth && power > DBL_EPSILON; depth += 2) {
      sum[c] += power * direct;
      if (depth + 1 < l->max_depth) sum[c] += power * by_metal * metal[c];
      power *= fresnel * metal[c] * turn;
    }
  }
  add(walk, walk->exit_weight / up.z, sum);
}

static bool survives_roulette(struct walk *walk) {
  double largest = layered_max3(walk->beta);
  if (walk->depth <= 3 || largest >= 0.25) return true;
  if (!(draw(&walk->draws) < largest)) return false;
  for (int c = 0; c < 3; c++) walk->beta[c] /= largest;
  return true;
}

enum event { AT_BASE, AT_COAT, IN_MEDIUM };

static enum event advance(struct walk *walk) {
  const struct layered *l = walk->layered;
  enum event next = walk->w.z > 0 ? AT_COAT : AT_BASE;
  if (layered_has_medium(l)) {
    walk->z -= num_log(draw(&walk->draws)) * walk->w.z;
    if (walk->z > 0 && walk->z < l->thickness) return IN_MEDIUM;
  } else {
    double through = coat_attenuation(l->thickness, walk->w.z);
    for (int c = 0; c < 3; c++) walk->beta[c] *= through;
  }
  walk->z = next == AT_COAT ? l->thickness : 0;
  return next;
}

static bool scatter_in_medium(struct walk *walk) {
  const struct layered *l = walk->layered;
  struct vec back = layered_opposite(walk->w);
  double u[2], p = phase(l->g, vec_dot(back, layered_opposite(walk->exit)));
  double above = l->thickness - walk->z;
  // The phase function knows no cosine; exit_weight has one.
  double per_cosine = p / fabs(walk->exit.z), f[3] = {per_cosine, per_cosine, per_cosine};
  multiply(walk->beta, l->albedo);
  if (layered_is_smooth(l))
    connect_smooth(walk, back);
  else
    connect_sampled(walk, f, p, above);
  draw_two(&walk->draws, u);
  walk->w = phase_sample(l->g, back, u);
  if (walk->w.z > 0) connect_direct(walk, phase(l->g, vec_dot(back, walk->w)), above);
  return walk->w.z != 0;
}

static bool scatter_at_base(struct walk *walk) {
  const struct layered *l = walk->layered;
  struct vec wo = layered_opposite(walk->w), to = layered_opposite(walk->exit);
  double f[3], u[2], weight[3], pdf;
  if (!base_is_smooth(l)) {
    base_value(l, wo, to, f);
    connect_sampled(walk, f, base_pdf(l, wo, to), l->thickness);
  }
  draw_two(&walk->draws, u);
  if (!base_sample(l, wo, u, &walk->w, weight, &pdf)) return false;
  multiply(walk->beta, weight);
  connect_direct(walk, pdf, l->thickness);
  return true;
}

static bool reflect_at_coat(struct walk *walk) {
  double u[2], weight;
  struct vec out;
  draw_two(&walk->draws, u);
  if (!coat_sample_reflection(&walk->layered->coat, layered_opposite(walk->w), u, &out, &weight))
    return false;
  walk->w = out;
  for (int c = 0; c < 3; c++) walk->beta[c] *= weight;
  return out.z != 0;
}

static bool enter(struct walk *walk, struct vec wo) {
  const struct dielectric *coat = &walk->layered->coat;
  double u[2], weight;
  draw_two(&walk->draws, u);
  if (!coat_sample_transmission(coat, wo, u, &walk->w, &weight)) return false;
  draw_two(&walk->draws, u);
  if (!coat_sample_transmission(coat, walk->wi, u, &walk->exit, &walk->exit_weight)) return false;
  walk->exit_pdf = 0;
  if (!coat->facets.smooth) coat_transmission(coat, walk->wi, walk->exit, &walk->exit_pdf);
  walk->z = walk->layered->thickness;
  for (int c = 0; c < 3; c++) walk->beta[c] = weight / (coat->eta * coat->eta);
  return walk->w.z < 0 && walk->exit.z < 0;
}

static void walk_once(struct walk *walk, struct vec wo) {
  if (!enter(walk, wo)) return;
  for (walk->depth = 0; walk->depth < walk->layered->max_depth; walk->depth++) {
    if (!survives_roulette(walk)) return;
    enum event event = advance(walk);
    bool goes_on = event == AT_BASE   ? scatter_at_base(walk)
                   : event == AT_COAT ? reflect_at_coat(walk)
                                      : scatter_in_medium(walk);
    if (!goes_on) return;
  }
}

void layered_value(const struct layered *l, struct vec wo, struct vec wi, double u, double f[3]) {
  for (int c = 0; c < 3; c++) f[c] = 0;
  if ((wo.z > 0) != (wi.z > 0) || (layered_is_smooth(l) && !layered_has_medium(l))) return;
  if (wo.z < 0) {
    wo = layered_opposite(wo);
    wi = layered_opposite(wi);
  }
  struct walk walk = {.layered = l, .draws = draws_of(u, wo, wi), .wi = wi, .f = f};
  for (int i = 0; i < l->n_samples; i++) walk_once(&walk, wo);
  double top = dielectric_value(&l->coat, wo, wi, TRANSPORT_IMPORTANCE);
  for (int c = 0; c < 3; c++) f[c] = top + f[c] / l->n_samples;
}
