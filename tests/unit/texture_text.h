// For tests: textures from the text of their parameters, named like Texture directives name them.
#ifndef TESTS_UNIT_TEXTURE_TEXT_H
#define TESTS_UNIT_TEXTURE_TEXT_H

#include "pbrt/parse.h"
#include "scene/read.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

struct texture_world {
  struct arena arena;
  struct scene scene;
  struct scene_builder builder;
};

static inline void texture_world_begin(struct texture_world *world, const char *folder) {
  *world = (struct texture_world){.arena = arena_reserve()};
  world->builder = (struct scene_builder){.arena = &world->arena,
                                          .scene = &world->scene,
                                          .folder = folder,
                                          .world_from_object = transform_identity()};
}

static inline const struct texture_type *texture_type_named(const char *name) {
  for (int k = 0; texture_types[k]; k++)
    if (strcmp(texture_types[k]->name, name) == 0) return texture_types[k];
  fail_msg("no texture type %s", name);
  return NULL;
}

// `Texture "name" "float|spectrum" "type" text`
static inline bool try_texture(struct texture_world *world, const char *name, bool spectrum,
                               const char *type, const char *text, struct texture *texture,
                               struct problem *problem) {
  *problem = (struct problem){0};
  struct text bytes = {arena_string(&world->arena, text, (ptrdiff_t)strlen(text)),
                       (ptrdiff_t)strlen(text)};
  struct lexer lexer = lexer_begin("t.pbrt", bytes, problem);
  struct params params;
  const char *title = arena_format(&world->arena, "Texture \"%s\"", type);
  *texture = (struct texture){.type = texture_type_named(type)};
  if (!lexer_advance(&lexer) ||
      !params_parse(&lexer, &world->arena, title, (struct place){"t.pbrt", 1, 1}, &params) ||
      !texture->type->read(&world->builder, &params, spectrum, texture))
    return false;
  struct named_textures *list =
      spectrum ? &world->builder.spectrum_textures : &world->builder.float_textures;
  *arena_push(&world->arena, list) = (struct named_texture){name, *texture};
  return true;
}

static inline struct texture make_texture(struct texture_world *world, const char *name,
                                          bool spectrum, const char *type, const char *text) {
  struct texture texture;
  struct problem problem;
  if (!try_texture(world, name, spectrum, type, text, &texture, &problem))
    fail_msg("%s %s: %s", type, text, problem.text);
  return texture;
}

static inline void assert_texture_refused(struct texture_world *world, bool spectrum,
                                          const char *type, const char *text, const char *says) {
  struct texture texture;
  struct problem problem;
  if (try_texture(world, "bad", spectrum, type, text, &texture, &problem))
    fail_msg("%s %s was accepted", type, text);
  if (!strstr(problem.text, says) || strchr(problem.text, '\n'))
    fail_msg("\nexpected %s\ngot      %s", says, problem.text);
}

static inline struct vec texture_at(struct texture texture, const struct surface *surface) {
  double value[3];
  texture.type->evaluate(&texture, surface, value);
  return vec(value[0], value[1], value[2]);
}

static inline struct vec texture_at_uv(struct texture texture, double u, double v) {
  return texture_at(texture, &(struct surface){.uv = {u, v}});
}

static inline struct vec texture_at_p(struct texture texture, double x, double y, double z) {
  return texture_at(texture, &(struct surface){.p = vec(x, y, z)});
}

// Within rounding of values of order `scale`.
static inline void assert_near(double value, double expected, double scale) {
  if (!(fabs(value - expected) <= 1e-13 * scale)) fail_msg("%.17g, not %.17g", value, expected);
}

#endif
