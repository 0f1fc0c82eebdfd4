// The reader's state while a scene file is read: what a shape's or light's `read` may see and do.
#ifndef SCENE_READ_H
#define SCENE_READ_H

#include "base/file.h"
#include "scene/scene.h"

struct mesh; // mesh/mesh.h

struct named_texture {
  const char *name;
  struct texture texture;
};

struct named_material {
  const char *name;
  uint32_t material; // row of scene.material
};

struct scene_builder {
  struct arena *arena;
  struct scene *scene;                // under construction; complete (with bounds) when lights are read
  struct transform world_from_object; // the current transformation at the directive
  bool reverse_orientation;           // at the directive
  bool mirrored_instance;             // the shape is part of an ObjectInstance that mirrors
  bool emits;                         // shapes: an area light comes with this one
  bool textured;                      // set by input_read_*: a texture was taken
  const char *folder;                 // of the scene's file, to which others are relative, as in
                                      // pbrt, whichever names them; NULL: no other may be read
  bool own_folder;                    // of scene_options
  struct shape *shape;                // area lights: the emitter (a light that reads its uv sets
                                      // `detailed`); NULL otherwise
  struct named_textures {
    struct named_texture *item;
    ptrdiff_t count, capacity;
  } float_textures, spectrum_textures; // by Texture directives so far
  struct {
    struct named_material *item;
    ptrdiff_t count, capacity;
  } materials; // by MakeNamedMaterial directives so far
};

// For shapes: append a mesh or one quadric to the scene, in world space. Vertices are rounded here,
// once, to float; a non-finite one is a problem. Quads are bilinear patches: the shape becomes a
// bilinearmesh, or gets one beside it for them. They return false with the problem set in params.
bool scene_add_mesh(struct scene_builder *, struct params *, const struct mesh *);
bool scene_add_quadric(struct scene_builder *, struct params *, const struct quadric *);

// For meshes and images: the bytes of a file named by parameter `name`, relative to the folder of the
// scene file, in the arena; they count in scene.hash.
bool scene_read_file(struct scene_builder *, struct params *, const char *name,
                     const char *filename, struct arena *, struct text *);

// The same for the reader itself: where a file of that name is, and its bytes.
char *scene_path_of(const struct scene_builder *, const char *filename, struct arena *);
bool scene_read_path(struct scene_builder *, const char *path, struct arena *, struct text *,
                     struct problem *);

// A spectrum texture or float texture named so far, NULL if none.
const struct texture *scene_find_texture(const struct scene_builder *, bool spectrum,
                                         const char *name);
// A material named so far: its row, ROW_NONE if none.
uint32_t scene_find_material(const struct scene_builder *, const char *name);

#endif
