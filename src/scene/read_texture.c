// Texture.
#include "scene/reader.h"

#include <string.h>

enum { MAX_NAMES = 64 };

static const struct texture_type *find_texture(struct reader *reader, struct call *call) {
  const char *names[MAX_NAMES];
  int n = 0;
  for (const struct texture_type *const *type = texture_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  read_unknown_type(reader, call, names, n);
  return NULL;
}

// For `photonlab info`.
static void count_texture(struct reader *reader, const struct texture_type *type) {
  struct inventory *inventory = &reader->builder.scene->inventory;
  int row = 0, n = 0;
  while (texture_types[n]) row = texture_types[n] == type ? n : row, n++;
  if (!inventory->textures) inventory->textures = arena_new(reader->builder.arena, uint32_t, n);
  inventory->textures[row]++;
  inventory->n_textures++;
}

// Texture "name" "kind" "type": floats and spectra have names of their own.
bool read_texture(struct reader *reader, struct call *call) {
  struct scene_builder *builder = &reader->builder;
  bool spectrum = strcmp(call->kind, "spectrum") == 0;
  if (!spectrum && strcmp(call->kind, "float") != 0)
    return problem_at(reader->problem, call->kind_place,
                      "a texture is of \"float\" or \"spectrum\", not \"%s\"", call->kind);
  struct names *names = spectrum ? &reader->spectrum_texture_names : &reader->float_texture_names;
  if (names_find(names, call->title) != NAME_NONE)
    return problem_at(reader->problem, call->title_place,
                      "the %s texture \"%s\" is already defined", call->kind, call->title);
  names_add(names, &reader->lists, call->title);
  struct named_texture entry = {.texture.type = find_texture(reader, call)};
  if (!entry.texture.type) return false;
  builder->world_from_object = reader->now.world_from_object[START];
  if (!entry.texture.type->read(builder, &call->params, spectrum, &entry.texture) ||
      !params_finish(&call->params))
    return false;
  entry.name = arena_string(builder->arena, call->title, (ptrdiff_t)strlen(call->title));
  struct named_textures *list = spectrum ? &builder->spectrum_textures : &builder->float_textures;
  *arena_push(builder->arena, list) = entry;
  count_texture(reader, entry.texture.type);
  return true;
}
