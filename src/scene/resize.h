// pbrt makes the sides of a texture's image powers of two before it is looked up.
#ifndef SCENE_RESIZE_H
#define SCENE_RESIZE_H

#include "scene/wrap.h"

// Enlarges the image to the next powers of two; bytes stay bytes. Nothing happens to one that has
// them.
void resize_to_powers_of_two(struct raster *, const struct wrap *, struct arena *,
                             struct arena scratch);

#endif
