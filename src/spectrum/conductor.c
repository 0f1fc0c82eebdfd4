// The (eta, k) of a channel from the spectra of eta and k.
#include "base/exact.h"
#include "spectrum/spectrum.h"

// Unpolarised Fresnel reflectance of a metal in air (Born, Wolf 13.4, without complex numbers):
// with u + i v = sqrt((eta + i k)^2 - sin^2), Rs and Rp follow from u and |u + i v|^2.
static double reflectance(double eta, double k, double cosine) {
  double c2 = cosine * cosine, s2 = 1 - c2, real = eta * eta - k * k - s2;
  double size = sqrt(real * real + 4 * eta * eta * k * k);
  double u = sqrt(size + real > 0 ? 0.5 * (size + real) : 0);
  double rs = (size + c2 - 2 * u * cosine) / (size + c2 + 2 * u * cosine);
  double a = c2 * size + s2 * s2, b = 2 * u * cosine * s2;
  return a + b > 0 ? 0.5 * rs * (1 + (a - b) / (a + b)) : rs; // eta = k = 0, head on
}

// The average over the hemisphere weighted with the cosine: cos^2 is uniform. The midpoint rule of
// 32 is right to 1e-4, and both sides of the fit make the same error.
static double average(double eta, double k) {
  enum { N = 32 };
  double sum = 0;
  for (int j = 0; j < N; j++) sum += reflectance(eta, k, sqrt((j + 0.5) / N));
  return sum / N;
}

// R = ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2), solved for k (Gulbrandsen 2014).
static double k_of(double r, double eta) {
  double k2 = (r * (eta + 1) * (eta + 1) - (eta - 1) * (eta - 1)) / (1 - r);
  return k2 > 0 ? sqrt(k2) : 0;
}

// Among the pairs of reflectance r the average falls with eta, from one dielectric (k = 0) to the
// other. pbrt-v4 stops a reflectance at 0.9999 too, and then has eta = 1.
static void fit(double r, double wanted, double *eta, double *k) {
  const double most = 0.9999;
  if (r < 0) r = 0;
  double lo = (1 - sqrt(r)) / (1 + sqrt(r)), hi = 1 / lo;
  if (r >= most) r = most, lo = hi = 1;
  for (int i = 0; i < 60; i++) {
    double middle = 0.5 * (lo + hi);
    if (average(middle, k_of(r, middle)) > wanted)
      lo = middle;
    else
      hi = middle;
  }
  *eta = hi;
  *k = k_of(r, hi);
}

static double held(const struct spectrum *spectrum, double nm) {
  const double *first = spectrum->sample[0], *last = spectrum->sample[spectrum->count - 1];
  return nm < first[0] ? first[1] : nm > last[0] ? last[1] : spectrum_at(spectrum, nm);
}

void spectrum_conductor(const struct spectrum *eta, const struct spectrum *k, double eta_rgb[3],
                        double k_rgb[3]) {
  double normal[SPECTRUM_COUNT], mean[SPECTRUM_COUNT], r[3], wanted[3];
  for (int j = 0; j < SPECTRUM_COUNT; j++) {
    double e = held(eta, SPECTRUM_FIRST + j), x = held(k, SPECTRUM_FIRST + j);
    normal[j] = reflectance(e, x, 1);
    mean[j] = average(e, x);
  }
  spectrum_reflected(normal, r);
  spectrum_reflected(mean, wanted);
  for (int c = 0; c < 3; c++) fit(r[c], wanted[c], &eta_rgb[c], &k_rgb[c]);
}
