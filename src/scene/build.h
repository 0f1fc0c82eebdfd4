// The scene's arrays while they grow.
#ifndef SCENE_BUILD_H
#define SCENE_BUILD_H

#include "scene/read.h"

// `array` of `count` objects with room for `more`: the capacity is always the power of two that
// holds the count, so nothing else need be stored. May move it.
void *build_grow(struct arena *, void *array, uint32_t count, uint32_t more, size_t size);

// A new shape row without primitives; what scene_add_* adds belongs to it. Returns the row.
uint32_t build_begin_shape(struct scene_builder *, const struct shape_type *, uint32_t material,
                           bool flip);

#endif
