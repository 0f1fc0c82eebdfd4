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

// Rows and primitives are counted in 32 bits; the last number means none. False: too many.
bool build_check_room(struct params *, uint64_t count, uint64_t more);

#endif
