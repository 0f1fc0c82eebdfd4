// Material "mix": one of two named materials at each vertex of a path, the second with probability
// `amount` [0.5], a float or a texture. `"string materials" ["first" "second"]`.
#include "scene/read.h"

struct mix {
  struct material material[2]; // copies: the scene's array grows
  struct input amount;
};

static const struct material *find(struct scene_builder *builder, struct params *params,
                                   const char *name) {
  uint32_t row = scene_find_material(builder, name);
  if (row == ROW_NONE) {
    params_complain(params, "materials",
                    "there is no material \"%s\" so far (MakeNamedMaterial makes one)", name);
    return NULL;
  }
  const struct material *material = &builder->scene->material[row];
  if (!material->type->passed) return material;
  params_complain(params, "materials", "\"%s\" is an interface, which a mix cannot have", name);
  return NULL;
}

// pbrt-v4 takes all below 0 for 0 and all above 1 for 1.
static bool is_random(const struct input *amount) {
  return amount->texture || (amount->value[0] > 0 && amount->value[0] < 1);
}

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  struct mix *mix = arena_new(builder->arena, struct mix, 1);
  const struct param *names = params_any(params, "materials");
  mix->amount = input_read_float(builder, params, "amount", 0.5);
  if (!names || !names->string || names->count != 2)
    return params_complain(params, "materials",
                           "a mix needs \"string materials\" with two names of materials");
  for (int i = 0; i < 2; i++) {
    const struct material *part = find(builder, params, names->string[i]);
    if (!part) return false;
    mix->material[i] = *part;
  }
  material->data = mix;
  material->needs = mix->material[0].needs | mix->material[1].needs;
  if (is_random(&mix->amount)) material->needs |= MATERIAL_RANDOM;
  return params_finish(params);
}

// What is left of u after the choice is uniform again: the material chosen may be random too.
static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  const struct mix *mix = material->data;
  double amount = input_float(&mix->amount, surface);
  bool second = amount >= 1 || (amount > 0 && out->u < amount);
  if (amount > 0 && amount < 1)
    out->u = second ? out->u / amount : (out->u - amount) / (1 - amount);
  const struct material *chosen = &mix->material[second];
  chosen->type->bsdf(scene, chosen, surface, out);
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  const struct mix *mix = material->data;
  for (int i = 0; i < 2; i++)
    if (!mix->material[i].type->is_gray(scene, &mix->material[i])) return false;
  return true;
}

static bool is_black(const struct material *material) {
  const struct mix *mix = material->data;
  for (int i = 0; i < 2; i++) {
    const struct material *part = &mix->material[i];
    if (!part->type->is_black || !part->type->is_black(part)) return false;
  }
  return true;
}

const struct material_type material_mix = {
    .name = "mix",
    .about = "one of two materials by chance, or by a texture",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
    .is_black = is_black,
};
