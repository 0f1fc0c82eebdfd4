// A kernel, here 1 - t^4 at t = distance / radius. The functions go into
// src/density/kernel.lanes.c above its table, the row at the end of the table; nothing else knows of
// it. Then `make validate` compares the closed forms with quadrature, and an experiment may say
// `kernel: quartic`.

// ---- 1 - t^4 ----
// psi(u) / psi(0) at |u|^2 = t2 in [0, 1), of several photons at once: 1 at the centre, nowhere
// rising, nowhere 0. Only + - * / and the vector vocabulary (base/lanes.h, numeric/lanes.h,
// numeric/lanes_exp.h): every SIMD level has the bits of the scalar one, and libm has others on
// other machines.
static inline lanes quartic_shape(lanes t2) { return 1 - t2 * t2; }
WEIGH(quartic)

// Integral over [0, 1] of t^m w(t), and of t^m w(t)^2 with w^2 = 1 - 2 t^4 + t^8.
static double quartic_moment(int m) { return 1.0 / (m + 1) - 1.0 / (m + 5); }

static double quartic_square_moment(int m) {
  return 1.0 / (m + 1) - 2.0 / (m + 5) + 1.0 / (m + 9);
}

// In d = 1, 2, 3 dimensions; `sphere` is the area of the unit sphere (d = 1: its two points).
static struct kernel_constants quartic_constants(int d) {
  double sphere = d * ball_volume(d), c = 1 / (sphere * quartic_moment(d - 1));
  return (struct kernel_constants){
      .c = c,
      .mu2 = quartic_moment(d + 1) / (d * quartic_moment(d - 1)),
      .roughness = c * c * sphere * quartic_square_moment(d - 1),
      .roughness2 = c * c * sphere * quartic_square_moment(d + 1),
  };
}

// The row: name, formula, source, functions.
  {"quartic", "1 - t^4", "a template", quartic_weigh, quartic_constants},
