// Files that a scene names: meshes, images, other scene files.
#include "scene/read.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

char *scene_path_of(const struct scene_builder *builder, const char *filename,
                    struct arena *arena) {
  bool whole = filename[0] == '/' || !builder->folder;
  return arena_format(arena, "%s%s", whole ? "" : builder->folder, filename);
}

static bool leaves_folder(const struct scene_builder *builder, const char *path) {
  size_t length = strlen(builder->folder);
  bool within = strncmp(path, builder->folder, length) == 0;
  return !within || path[length] == '/' || strstr(path + length, "..");
}

bool scene_read_path(struct scene_builder *builder, const char *path, struct arena *arena,
                     struct text *text, struct problem *problem) {
  if (!builder->folder) return problem_set(problem, "%s: no other file may be read here", path);
  if (builder->own_folder && leaves_folder(builder, path))
    return problem_set(problem, "%s: is outside of the scene's folder", path);
  if (!file_read(path, arena, text, problem)) return false;
  builder->scene->hash = XXH64(text->data, (size_t)text->length, builder->scene->hash);
  return true;
}

bool scene_read_file(struct scene_builder *builder, struct params *params, const char *name,
                     const char *filename, struct arena *arena, struct text *text) {
  struct problem problem = {0};
  const char *path = scene_path_of(builder, filename, arena);
  return scene_read_path(builder, path, arena, text, &problem) ||
         params_complain(params, name, "%s", problem.text);
}
