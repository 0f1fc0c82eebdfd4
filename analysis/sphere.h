// The inside of one diffuse sphere (theory 5 vii): photons start at its centre, or at its own wall
// if that emits (the white furnace), and are scattered until they are absorbed.
#ifndef ANALYSIS_SPHERE_H
#define ANALYSIS_SPHERE_H

#include "analysis/profile.h"

// False: the scene is something else, or not all paths are followed to their end.
bool sphere_find(const struct scene *, const struct cell *, const struct probe *, double radius,
                 struct profile *);

// The same from numbers: `albedo` survives at each hit, `area` is that of the sphere.
struct profile sphere_profile(double flux, double area, double albedo, bool from_wall,
                              const struct kernel *, double radius);

#endif
