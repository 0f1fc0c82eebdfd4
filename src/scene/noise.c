#include "scene/noise.h"

#include <stdint.h>

static const uint8_t permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

// d times one of 12 edge directions of a cube (4 of them twice), chosen by the lattice point.
static double gradient(int x, int y, int z, struct vec d) {
  int h = permutation[(permutation[(permutation[x & 255] + y) & 255] + z) & 255] & 15;
  double u = h < 8 || h == 12 || h == 13 ? d.x : d.y;
  double v = h < 4 || h == 12 || h == 13 ? d.y : d.z;
  return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

static double mix(double t, double a, double b) { return (1 - t) * a + t * b; }

// The lattice repeats every 256. (What is not finite has no cell.)
static int cell(double floor_x) {
  double in_period = floor_x - 256 * floor(floor_x / 256);
  return in_period >= 0 && in_period < 256 ? (int)in_period : 0;
}

double noise(double x, double y, double z) {
  double fx = floor(x), fy = floor(y), fz = floor(z), plane[2];
  int ix = cell(fx), iy = cell(fy), iz = cell(fz);
  struct vec d = vec(x - fx, y - fy, z - fz);
  for (int k = 0; k < 2; k++) {
    double row[2];
    for (int j = 0; j < 2; j++)
      row[j] = mix(fade(d.x), gradient(ix, iy + j, iz + k, vec(d.x, d.y - j, d.z - k)),
                   gradient(ix + 1, iy + j, iz + k, vec(d.x - 1, d.y - j, d.z - k)));
    plane[k] = mix(fade(d.y), row[0], row[1]);
  }
  return mix(fade(d.z), plane[0], plane[1]);
}

static double octave(struct vec p, double lambda) {
  return noise(lambda * p.x, lambda * p.y, lambda * p.z);
}

double noise_fbm(struct vec p, double omega, int octaves) {
  double sum = 0, lambda = 1, strength = 1;
  for (int i = 0; i < octaves; i++) {
    sum += strength * octave(p, lambda);
    lambda *= 1.99;
    strength *= omega;
  }
  return sum;
}

// pbrt adds the mean, 0.2, of the octave that comes next.
double noise_turbulence(struct vec p, double omega, int octaves) {
  double sum = 0, lambda = 1, strength = 1;
  for (int i = 0; i < octaves; i++) {
    sum += strength * fabs(octave(p, lambda));
    lambda *= 1.99;
    strength *= omega;
  }
  return sum + 0.2 * strength;
}
