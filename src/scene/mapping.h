// Where a surface point lies on a texture: pbrt's 2D mappings ("string mapping") and texture space.
#ifndef SCENE_MAPPING_H
#define SCENE_MAPPING_H

#include "scene/read.h"

struct mapping {
  const struct mapping_type *type;
  struct transform texture_from_world; // not used by uv
  double scale[2], delta[2];
  struct vec axis[2]; // planar
};

// The Texture directive's mapping, uscale, vscale, udelta, vdelta, v1, v2; false: problem set.
bool mapping_read(struct scene_builder *, struct params *, struct mapping *);
void mapping_st(const struct mapping *, const struct surface *, double st[2]);

// From world to the space that was current at the Texture directive.
bool mapping_read_space(const struct scene_builder *, struct params *,
                        struct transform *texture_from_world);

#endif
