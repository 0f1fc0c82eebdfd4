// What `photonlab info` says of a scene.
#ifndef SCENE_INFO_H
#define SCENE_INFO_H

#include "scene/scene.h"

#include <stdio.h>

void scene_info(const struct scene *, FILE *);

#endif
