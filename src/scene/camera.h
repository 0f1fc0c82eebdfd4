// What the reader makes of Camera and Film.
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/scene.h"

// Fills half_x and half_y from fov, width and height: fov spans the shorter axis.
void camera_set_window(struct camera *);

#endif
