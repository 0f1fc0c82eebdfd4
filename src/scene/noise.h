// Perlin's improved noise (2002) with the permutation of its reference program, as pbrt has it.
#ifndef SCENE_NOISE_H
#define SCENE_NOISE_H

#include "base/vec.h"

double noise(double x, double y, double z);
// Octaves of noise, each 1.99 times as fine and omega times as strong as the one before.
double noise_fbm(struct vec p, double omega, int octaves);
double noise_turbulence(struct vec p, double omega, int octaves); // of their absolute values

#endif
