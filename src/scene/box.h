// Boxes of floats made from doubles, rounded outward.
#ifndef SCENE_BOX_H
#define SCENE_BOX_H

#include "scene/scene.h"

struct box box_empty(void); // lo > hi
struct box box_union(struct box, struct box);

// The largest float <= x and the smallest >= x; x within the range of float.
float box_round_down(double x);
float box_round_up(double x);

// Contains center +- half, both computed by at most 8 roundings on sums of terms whose magnitudes
// add up to `terms` (so that cancellation is covered).
struct box box_around(struct vec center, struct vec half, struct vec terms);

// The sum of the magnitudes in transform_point(t, p).
struct vec box_terms(const struct transform *, struct vec p);

// Contains the image under t of the object-space box lo..hi.
struct box box_transform(const struct transform *, struct vec lo, struct vec hi);

struct box box_intersection(struct box, struct box);

#endif
