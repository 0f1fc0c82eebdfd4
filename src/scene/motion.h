// Shapes that move, and the camera. A scene at one time is a scene without motion: a copy whose
// moving vertices, quadrics and camera are worked out for that time.
#ifndef SCENE_MOTION_H
#define SCENE_MOTION_H

#include "scene/read.h"

// How far the scene's arrays were filled before a shape was read.
struct motion_start {
  uint32_t shape, position, normal, tangent;
};
struct motion_start motion_start(const struct scene *);

// Sets in motion the shape that was read since, in a space of its own, and moves it to where it
// starts. False: it leaves the range of floats (problem set in params).
struct motion_place {
  struct animation instance, object;
};
bool motion_add(struct scene_builder *, struct params *, const struct motion_start *,
                const struct motion_place *);

// A copy with arrays of its own for what moves.
struct scene *motion_copy(const struct scene *, struct arena *);

// Brings the copy to a time (that of shutteropen, TransformTimes).
void motion_set(struct scene *copy, double time);

#endif
