// The reader's state while a scene file is read: what a shape's or light's `read` may see and do.
#ifndef SCENE_READ_H
#define SCENE_READ_H

#include "scene/scene.h"

struct scene_builder {
  struct arena *arena;
  struct scene *scene;                // under construction; complete (with bounds) when lights are read
  struct transform world_from_object; // the current transformation at the directive
  bool reverse_orientation;           // at the directive
  bool emits;                         // shapes: an area light comes with this one
  const struct shape *shape;          // area lights: the emitter; NULL otherwise
};

// For shapes: append world-space vertices (rounded here, once, to float; a non-finite one is a
// problem), triangles (rows counted from the first vertex of this shape) or one quadric.
// They return false with the problem set in params.
bool scene_add_triangles(struct scene_builder *, struct params *, const double (*vertex)[3],
                         uint32_t n_vertices, const double *index, uint32_t n_triangles);
bool scene_add_quadric(struct scene_builder *, struct params *, const struct quadric *);

#endif
