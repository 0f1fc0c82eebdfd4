// Files that a scene names: meshes, images.
#include "scene/read.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

bool scene_read_file(struct scene_builder *builder, struct params *params, const char *name,
                     const char *filename, struct arena *arena, struct text *text) {
  if (!builder->folder) return params_complain(params, name, "no other file may be read here");
  const char *path =
      filename[0] == '/' ? filename : arena_format(arena, "%s%s", builder->folder, filename);
  struct problem problem = {0};
  if (!file_read(path, arena, text, &problem))
    return params_complain(params, name, "%s", problem.text);
  builder->scene->hash = XXH64(text->data, (size_t)text->length, builder->scene->hash);
  return true;
}
