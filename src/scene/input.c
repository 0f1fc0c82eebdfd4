// What texture.h declares: the inputs of materials, shapes and lights as a scene file gives them.
#include "pbrt/suggest.h"
#include "scene/read.h"

#include <string.h>

bool input_is_given(const struct params *params, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name)) return true;
  return false;
}

bool input_is_gray(const struct input *input) {
  if (input->texture) return input->texture->type->is_gray(input->texture);
  return input->value[0] == input->value[1] && input->value[1] == input->value[2];
}

const struct texture *scene_find_texture(const struct scene_builder *builder, bool spectrum,
                                         const char *name) {
  const struct named_textures *textures =
      spectrum ? &builder->spectrum_textures : &builder->float_textures;
  for (ptrdiff_t k = 0; k < textures->count; k++)
    if (!strcmp(textures->item[k].name, name)) return &textures->item[k].texture;
  return NULL;
}

uint32_t scene_find_material(const struct scene_builder *builder, const char *name) {
  for (ptrdiff_t k = 0; k < builder->materials.count; k++)
    if (!strcmp(builder->materials.item[k].name, name)) return builder->materials.item[k].material;
  return ROW_NONE;
}

static void unknown_texture(const struct named_textures *textures, struct params *params,
                            const char *name, const char *texture) {
  enum { MAX_NAMES = 64 };
  const char *names[MAX_NAMES];
  int n = 0;
  for (; n < textures->count && n < MAX_NAMES; n++) names[n] = textures->item[n].name;
  const char *nearest = suggest_name(texture, names, n);
  params_complain(params, name, "there is no texture \"%s\" of this kind so far%s%s%s", texture,
                  nearest ? "; did you mean \"" : "", nearest ? nearest : "", nearest ? "\"?" : "");
}

static struct input input_texture(struct scene_builder *builder, bool spectrum,
                                  struct params *params, const char *name,
                                  const struct param *param) {
  struct input input = {0};
  const struct texture *texture = scene_find_texture(builder, spectrum, param->string[0]);
  if (!texture) {
    unknown_texture(spectrum ? &builder->spectrum_textures : &builder->float_textures, params, name,
                    param->string[0]);
    return input;
  }
  struct texture *kept = arena_new(builder->arena, struct texture, 1);
  *kept = *texture; // the list of names may move
  input.texture = kept;
  builder->textured = true;
  return input;
}

static bool is_texture(const struct param *param) { return !strcmp(param->type, "texture"); }

static const struct param *find_param(const struct params *params, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name)) return &params->item[i];
  return NULL;
}

struct input input_read_float(struct scene_builder *builder, struct params *params,
                              const char *name, double fallback) {
  const struct param *param = find_param(params, name);
  if (param && is_texture(param) && params_any(params, name))
    return input_texture(builder, false, params, name, param);
  double value = params_float(params, name, fallback);
  return (struct input){.value = {value, value, value}};
}

struct input input_read_spectrum(struct scene_builder *builder, struct params *params,
                                 const char *name, enum spectrum_use use,
                                 const double fallback[3]) {
  const struct param *param = find_param(params, name);
  if (param && is_texture(param) && params_any(params, name))
    return input_texture(builder, true, params, name, param);
  struct input input = {.value = {fallback[0], fallback[1], fallback[2]}};
  spectrum_read(builder, params, name, use, input.value);
  return input;
}
