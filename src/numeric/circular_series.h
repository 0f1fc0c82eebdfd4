// Taylor series of sine and cosine of hi + lo, |hi| <= pi/4; errors below 2^-62. NUMBER, defined by
// whoever includes this: double, or a vector of them.

static inline NUMBER sine_series(NUMBER hi, NUMBER lo) {
  NUMBER z = hi * hi;
  NUMBER p = 1.0 / 355687428096000 * z - 1.0 / 1307674368000; // 17!, 15!
  p = p * z + 1.0 / 6227020800;
  p = p * z - 1.0 / 39916800;
  p = p * z + 1.0 / 362880;
  p = p * z - 1.0 / 5040;
  p = p * z + 1.0 / 120;
  p = p * z - 1.0 / 6;
  return hi + (hi * z * p + (lo - 0.5 * z * lo));
}

static inline NUMBER cosine_series(NUMBER hi, NUMBER lo) {
  NUMBER z = hi * hi, half = 0.5 * z, w = 1 - half;
  NUMBER p = 1.0 / 20922789888000 * z - 1.0 / 87178291200; // 16!, 14!
  p = p * z + 1.0 / 479001600;
  p = p * z - 1.0 / 3628800;
  p = p * z + 1.0 / 40320;
  p = p * z - 1.0 / 720;
  p = p * z + 1.0 / 24;
  return w + (((1 - w) - half) + (z * z * p - hi * lo));
}
