// What scene/material/diffuse.c and scene/bsdf.h do to one direction, to eight at a time.
#include "numeric/lanes.h"
#include "walk/facets_level.h"

#define NUMBER lanes
#include "numeric/circular_series.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct vectors {
  lanes x, y, z;
};

static inline struct vectors load(double v[3][FACETS], int j) {
  return (struct vectors){lanes_load(v[0] + j), lanes_load(v[1] + j), lanes_load(v[2] + j)};
}

// ---- num_sincos_turns, u in [0, 1) ----

static inline void sincos_turns(lanes u, lanes *sine, lanes *cosine) {
  const lanes zero = {0}, one = lanes_set(1);
  lanes quarters = 4 * u, k = zero;
  lanes_some from[4]; // of quarter 1, 2, 3 and the end of the turn
  for (int q = 0; q < 4; q++) {
    from[q] = lanes_less(lanes_set(q + 0.5), quarters);
    k += lanes_choose(from[q], one, zero);
  }
  lanes b = u - 0.25 * k;
  // pair_scale(two_pi, b)
  const double hi = 0x1.921fb54442d18p+2, lo = 0x1.1a62633145c07p-52, ta = 0x1.0000002p27 * hi;
  const double a1 = ta - (ta - hi), a2 = hi - a1;
  lanes tb = 0x1.0000002p27 * b, b1 = tb - (tb - b), b2 = b - b1, p = hi * b;
  lanes rest = (((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2) + lo * b;
  lanes r = p + rest, r_lo = rest - (r - p);
  lanes s = sine_series(r, r_lo), c = cosine_series(r, r_lo);
  const lanes sines[5] = {s, c, -s, -c, s}, cosines[5] = {c, -s, -c, s, c};
  *sine = sines[0], *cosine = cosines[0];
  for (int q = 0; q < 4; q++) {
    *sine = lanes_choose(from[q], sines[q + 1], *sine);
    *cosine = lanes_choose(from[q], cosines[q + 1], *cosine);
  }
}

// ---- the direction ----

static inline lanes to_world(lanes s, lanes t, lanes n, const struct vectors *local) {
  return (s * local->x + local->y * t) + local->z * n;
}

static void sample_lanes(struct facets *facets, int j) {
  struct vectors d = load(facets->d, j), n = load(facets->n, j), local;
  lanes u0 = lanes_load(facets->u[0] + j), sine, cosine;
  lanes from = (-d.x * n.x + -d.y * n.y) + -d.z * n.z;
  lanes r = lanes_sqrt(u0), z = lanes_sqrt(1 - u0);
  sincos_turns(lanes_load(facets->u[1] + j), &sine, &cosine);
  local.x = r * cosine;
  local.y = r * sine;
  local.z = lanes_choose(lanes_less(from, lanes_set(0)), -z, z);
  // vec_basis
  lanes sign = lanes_choose(lanes_less(n.z, lanes_set(0)), lanes_set(-1), lanes_set(1));
  lanes a = -1 / (sign + n.z), b = n.x * n.y * a;
  lanes_store(facets->cosine + j, from);
  lanes_store(facets->wi[0] + j, to_world(1 + sign * n.x * n.x * a, b, n.x, &local));
  lanes_store(facets->wi[1] + j, to_world(sign * b, sign + n.y * n.y * a, n.y, &local));
  lanes_store(facets->wi[2] + j, to_world(-sign * n.x, -n.y, n.z, &local));
  lanes_store(facets->pdf + j, z * one_over_pi);
}

static void sample(struct facets *facets, int n) {
  for (int j = 0; j < n; j += LANES) sample_lanes(facets, j);
}

const struct facets_level SIMD_NAME(facets_level) = {sample};
