// What the reader makes of Camera and Film.
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/scene.h"

const struct camera_type *camera_find(const char *name); // NULL: none

// pbrt's default screen window x0 x1 y0 y1: the shorter axis spans [-1, 1].
void camera_screen(double aspect, double screen[4]);

#endif
