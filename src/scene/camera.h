// What the reader makes of Camera and Film.
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/scene.h"

// Fills the window when camera and film are known: the shorter axis spans [-1, 1] times the type's
// scale.
void camera_set_window(struct camera *);

#endif
