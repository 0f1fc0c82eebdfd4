// Henyey and Greenstein's phase function (1941), g the mean cosine between the directions before
// and after scattering: p = (1 - g^2) / (4 pi (1 + g^2 + 2 g wo.wi)^(3/2)), wo and wi both leading
// away. The frame is the world's.
#include "numeric/elementary.h"
#include "scene/medium.h"

static double density(const struct bsdf *bsdf, struct vec wo, struct vec wi) {
  double g = bsdf->x[0], squared = 1 + g * g + 2 * g * vec_dot(wo, wi);
  return (1 - g * g) * 0x1.45f306dc9c883p-4 / (squared * sqrt(squared)); // 1 / (4 pi)
}

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)transport;
  f[0] = f[1] = f[2] = density(bsdf, wo, wi);
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  return density(bsdf, wo, wi);
}

// The inverse of the cumulative distribution, its cancellation at small g worked out: with
// s = 2 u - 1, (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g).
static double sample_cosine(double g, double u) {
  double s = 2 * u - 1, below = 1 + g * s;
  double cosine = (s + g * (g * s + (s * s + 3) / 2 - g * g * (1 - s * s) / 2)) / (below * below);
  return cosine < -1 ? -1 : cosine > 1 ? 1 : cosine; // by rounding
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *sample) {
  (void)transport;
  struct vec forward = vec_scale(wo, -1), s, t;
  double sine, cosine, along = sample_cosine(bsdf->x[0], u[0]);
  double across = sqrt((1 - along) * (1 + along));
  vec_basis(forward, &s, &t);
  num_sincos_turns(u[1], &sine, &cosine);
  struct vec wi =
      vec_along(vec_along(vec_scale(forward, along), s, across * cosine), t, across * sine);
  *sample = (struct bsdf_sample){.wi = wi, .weight = {1, 1, 1}, .eta2 = 1};
  sample->pdf = density(bsdf, wo, wi);
  return true;
}

static const struct bsdf_type phase = {.value = value, .pdf = pdf, .sample = sample};

struct bsdf medium_bsdf(const struct medium *medium) {
  return (struct bsdf){.type = &phase,
                       .s = {1, 0, 0},
                       .t = {0, 1, 0},
                       .n = {0, 0, 1},
                       .ng = {0, 0, 1},
                       .volume = true,
                       .x = {medium->g}};
}
