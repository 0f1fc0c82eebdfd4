// Texture "checkerboard": cells of unit size, tex1 [1] in the cell at 0 and tex2 [0] beside it, on
// the surface ("integer dimension" 2) or in the texture's space (3). Not filtered: pbrt averages it
// over a pixel's footprint, which tends to this at edges seen closely.
#include "scene/mapping.h"
#include "scene/texture/inputs.h"

struct checkerboard {
  struct input tex1, tex2;
  int dimension;
  struct mapping mapping;              // 2D
  struct transform texture_from_world; // 3D
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct checkerboard *board = arena_new(builder->arena, struct checkerboard, 1);
  board->tex1 = texture_input(builder, params, spectrum, "tex1", 1);
  board->tex2 = texture_input(builder, params, spectrum, "tex2", 0);
  board->dimension = (int)params_integer(params, "dimension", 2);
  texture->data = board;
  if (board->dimension != 2 && board->dimension != 3)
    return params_complain(params, "dimension", "\"dimension\" is 2 or 3");
  bool ok = board->dimension == 2 ? mapping_read(builder, params, &board->mapping)
                                  : mapping_read_space(builder, params, &board->texture_from_world);
  return ok && params_finish(params);
}

static bool is_odd(double x) {
  double cell = floor(x);
  return cell != 2 * floor(cell / 2);
}

static bool is_second(const struct checkerboard *board, const struct surface *surface) {
  if (board->dimension == 3) {
    struct vec p = transform_point(&board->texture_from_world, surface->p);
    return is_odd(p.x) ^ is_odd(p.y) ^ is_odd(p.z);
  }
  double st[2];
  mapping_st(&board->mapping, surface, st);
  return is_odd(st[0]) ^ is_odd(st[1]);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct checkerboard *board = texture->data;
  input_rgb(is_second(board, surface) ? &board->tex2 : &board->tex1, surface, value);
}

static bool is_gray(const struct texture *texture) {
  const struct checkerboard *board = texture->data;
  return input_is_gray(&board->tex1) && input_is_gray(&board->tex2);
}

const struct texture_type texture_checkerboard = {
    .name = "checkerboard",
    .about = "two textures in squares or cubes, not filtered",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
