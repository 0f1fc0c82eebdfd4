// Textures that other textures look into.
#ifndef SCENE_TEXTURE_IMAGEMAP_H
#define SCENE_TEXTURE_IMAGEMAP_H

#include "scene/read.h"

extern const struct texture_type texture_imagemap, texture_constant;

// The same image with `scale` multiplied by a factor.
const struct texture *imagemap_scaled(const struct texture *, double factor, struct arena *);

#endif
