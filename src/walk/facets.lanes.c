// What scene/material/diffuse.c and scene/bsdf.h do to one direction, to eight at a time.
#include "base/lanes.h"
#include "walk/facets_level.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct vectors {
  lanes x, y, z;
};

static inline struct vectors load(double v[3][FACETS], int j) {
  return (struct vectors){lanes_load(v[0] + j), lanes_load(v[1] + j), lanes_load(v[2] + j)};
}

// ---- num_sincos_turns, u in [0, 1) ----

// sine_of and cosine_of of numeric/circular.c
static inline lanes sine_of(lanes hi, lanes lo) {
  lanes z = hi * hi, p = lanes_set(1.0 / 355687428096000);
  p = p * z - 1.0 / 1307674368000;
  p = p * z + 1.0 / 6227020800;
  p = p * z - 1.0 / 39916800;
  p = p * z + 1.0 / 362880;
  p = p * z - 1.0 / 5040;
  p = p * z + 1.0 / 120;
  p = p * z - 1.0 / 6;
  return hi + (hi * z * p + (lo - 0.5 * z * lo));
}

static inline lanes cosine_of(lanes hi, lanes lo) {
  lanes z = hi * hi, half = 0.5 * z, w = 1 - half, p = lanes_set(1.0 / 20922789888000);
  p = p * z - 1.0 / 87178291200;
  p = p * z + 1.0 / 479001600;
  p = p * z - 1.0 / 3628800;
  p = p * z + 1.0 / 40320;
  p = p * z - 1.0 / 720;
  p = p * z + 1.0 / 24;
  return w + (((1 - w) - half) + (z * z * p - hi * lo));
}

static inline lanes one_if(lanes_mask mask) { return (lanes)(mask & (lanes_mask)lanes_set(1)); }

static inline void sincos_turns(lanes u, lanes *sine, lanes *cosine) {
  lanes quarters = 4 * u;
  lanes_mask from1 = quarters > 0.5, from2 = quarters > 1.5, from3 = quarters > 2.5,
             from4 = quarters > 3.5;
  lanes k = one_if(from1) + one_if(from2) + one_if(from3) + one_if(from4), b = u - 0.25 * k;
  // pair_scale(two_pi, b)
  const double hi = 0x1.921fb54442d18p+2, lo = 0x1.1a62633145c07p-52, ta = 0x1.0000002p27 * hi;
  const double a1 = ta - (ta - hi), a2 = hi - a1;
  lanes tb = 0x1.0000002p27 * b, b1 = tb - (tb - b), b2 = b - b1, p = hi * b;
  lanes rest = (((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2) + lo * b;
  lanes r = p + rest, r_lo = rest - (r - p);
  lanes s = sine_of(r, r_lo), c = cosine_of(r, r_lo);
  lanes_mask odd = (from1 & ~from2) | (from3 & ~from4);
  *sine = lanes_negate_if(from2 & ~from4, lanes_select(odd, c, s));
  *cosine = lanes_negate_if(from1 & ~from3, lanes_select(odd, s, c));
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
  local.z = lanes_negate_if(from < 0, z);
  // vec_basis
  lanes sign = lanes_select(n.z < 0, lanes_set(-1), lanes_set(1));
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
