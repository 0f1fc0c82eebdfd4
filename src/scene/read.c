// scene_read: the table of directives, and the loop over those of a file.
#include "scene/read.h"

#include "base/gzip.h"
#include "pbrt/suggest.h"
#include "scene/reader.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

static const struct directive directives[] = {
    {"LookAt", ANYWHERE, NUMBERS, 9, .run = read_look_at},
    {"Translate", ANYWHERE, NUMBERS, 3, .run = read_translate},
    {"Rotate", ANYWHERE, NUMBERS, 4, .run = read_rotate},
    {"Scale", ANYWHERE, NUMBERS, 3, .run = read_scale},
    {"Identity", ANYWHERE, BARE, .run = read_identity},
    {"Transform", ANYWHERE, MATRIX, .run = read_transform},
    {"ConcatTransform", ANYWHERE, MATRIX, .run = read_concat_transform},
    {"ActiveTransform", ANYWHERE, WORD, .run = read_active_transform},
    {"TransformTimes", BEFORE_WORLD, NUMBERS, 2, .run = read_transform_times},
    {"CoordinateSystem", ANYWHERE, NAME, .run = read_coordinate_system},
    {"CoordSysTransform", ANYWHERE, NAME, .run = read_coord_sys_transform},
    {"ReverseOrientation", ANYWHERE, BARE, .run = read_reverse_orientation},
    {"ColorSpace", ANYWHERE, NAME, .run = read_color_space},
    {"Option", ANYWHERE, NAME_VALUE, .run = read_option},
    {"Include", ANYWHERE, NAME, .run = read_include},
    {"Import", IN_WORLD, NAME, .run = read_import},
    {"Camera", BEFORE_WORLD, PARAMETERS, .keep = true, .run = read_camera},
    {"Film", BEFORE_WORLD, PARAMETERS, .keep = true, .run = read_film},
    {"PixelFilter", BEFORE_WORLD, PARAMETERS, .run = read_pixel_filter},
    {"Sampler", BEFORE_WORLD, PARAMETERS, .run = read_sampler},
    {"Accelerator", BEFORE_WORLD, PARAMETERS, .run = read_accelerator},
    {"Integrator", BEFORE_WORLD, PARAMETERS, .keep = true, .run = read_integrator},
    {"WorldBegin", BEFORE_WORLD, BARE, .run = read_world_begin},
    {"AttributeBegin", IN_WORLD, BARE, .run = read_attribute_begin},
    {"AttributeEnd", IN_WORLD, BARE, .run = read_attribute_end},
    {"TransformBegin", IN_WORLD, BARE, .run = read_attribute_begin},
    {"TransformEnd", IN_WORLD, BARE, .run = read_attribute_end},
    {"Attribute", ANYWHERE, PARAMETERS, .keep = true, .run = read_attribute},
    {"ObjectBegin", IN_WORLD, NAME, .run = read_object_begin},
    {"ObjectEnd", IN_WORLD, BARE, .run = read_object_end},
    {"ObjectInstance", IN_WORLD, NAME, .run = read_object_instance},
    {"Shape", IN_WORLD, PARAMETERS, .target = FOR_SHAPE, .run = read_shape},
    {"Material", IN_WORLD, PARAMETERS, .target = FOR_MATERIAL, .run = read_material},
    {"MakeNamedMaterial", IN_WORLD, PARAMETERS, .target = FOR_MATERIAL,
     .run = read_make_named_material},
    {"NamedMaterial", IN_WORLD, NAME, .run = read_named_material},
    {"Texture", IN_WORLD, TEXTURE, .target = FOR_TEXTURE, .run = read_texture},
    {"MakeNamedMedium", ANYWHERE, PARAMETERS, .target = FOR_MEDIUM, .run = read_make_named_medium},
    {"MediumInterface", ANYWHERE, NAMES, .run = read_medium_interface},
    {"LightSource", IN_WORLD, PARAMETERS, 0, true, FOR_LIGHT, read_light_source},
    {"AreaLightSource", IN_WORLD, PARAMETERS, 0, true, FOR_LIGHT, read_area_light_source},
};
enum { N_DIRECTIVES = (int)(sizeof directives / sizeof *directives) };

static bool token_is(const struct token *token, const char *name) {
  return (size_t)token->length == strlen(name) && memcmp(token->text, name, strlen(name)) == 0;
}

static bool unknown_directive(struct reader *reader) {
  const struct token *token = &reader->lexer.token;
  if (token_is(token, "WorldEnd")) // of pbrt-v3
    return problem_at(reader->problem, token->place,
                      "WorldEnd: take it out, the file's end is enough");
  const char *names[N_DIRECTIVES];
  for (int i = 0; i < N_DIRECTIVES; i++) names[i] = directives[i].name;
  struct token_text text = lexer_describe(token);
  const char *nearest = suggest_name(text.text, names, N_DIRECTIVES);
  return problem_at(reader->problem, token->place, "unknown directive %s%s%s%s", text.text,
                    nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : "");
}

static const struct directive *find_directive(struct reader *reader) {
  const struct token *token = &reader->lexer.token;
  if (token->kind != TOKEN_WORD) {
    problem_at(reader->problem, token->place, "expected a directive, found %s",
               lexer_describe(token).text);
    return NULL;
  }
  for (int i = 0; i < N_DIRECTIVES; i++)
    if (token_is(token, directives[i].name)) return &directives[i];
  unknown_directive(reader);
  return NULL;
}

static bool check_where(struct reader *reader, const struct directive *directive,
                        struct place place) {
  bool in_world = reader->world_begin.line > 0;
  if (directive->where == IN_WORLD && !in_world)
    return problem_at(reader->problem, place, "%s must come after WorldBegin", directive->name);
  if (directive->where == BEFORE_WORLD && in_world)
    return problem_at(reader->problem, place, "%s must come before WorldBegin (line %d)",
                      directive->name, reader->world_begin.line);
  return true;
}

// What an object's definition needs waits for the instances.
static struct arena *arena_for(struct reader *reader, bool keep, struct arena *scratch) {
  if (keep) return reader->builder.arena;
  return reader->in_object ? &reader->lists : scratch;
}

static bool read_directive(struct reader *reader, struct arena scratch) {
  const struct directive *directive = find_directive(reader);
  struct call call = {.place = reader->lexer.token.place};
  if (!directive || !check_where(reader, directive, call.place)) return false;
  call.name = directive->name;
  struct arena *arena = arena_for(reader, directive->keep, &scratch);
  if (!read_parse_call(reader, directive, arena, &call)) return false;
  call.scratch = scratch;
  return directive->run(reader, &call);
}

bool read_directives(struct reader *reader, struct arena scratch) {
  if (!lexer_advance(&reader->lexer)) return false;
  while (reader->lexer.token.kind != TOKEN_END)
    if (!read_directive(reader, scratch)) return false;
  return true;
}

static bool read_main(struct reader *reader, struct arena scratch) {
  if (!read_directives(reader, scratch) || !read_all_popped(reader, 0)) return false;
  if (reader->world_begin.line == 0)
    return problem_at(reader->problem, reader->lexer.token.place, "the file has no WorldBegin");
  return true;
}

bool read_all(struct reader *reader, const char *path, const char *folder, struct text text,
              struct arena scratch) {
  struct scene *scene = reader->builder.scene;
  *scene =
      (struct scene){.path = arena_string(reader->builder.arena, path, (ptrdiff_t)strlen(path)),
                     .hash = XXH64(text.data, (size_t)text.length, 0),
                     .camera_medium = MEDIUM_NONE};
  struct reading file = {.path = scene->path};
  reader->lexer = lexer_begin(scene->path, text, reader->problem);
  reader->builder.folder = folder;
  reader->builder.own_folder = reader->options.own_folder;
  reader->reading = &file;
  read_default_transform(reader);
  read_default_options(reader);
  read_default_material(reader);
  return read_main(reader, scratch) && scene_finish(reader);
}

bool scene_read_text(const char *path, const char *folder, struct text text, struct arena *arena,
                     struct arena lists, struct arena scratch, struct scene *scene,
                     struct problem *problem) {
  struct reader reader = {
      .builder = {.arena = arena, .scene = scene}, .problem = problem, .lists = lists};
  return read_all(&reader, path, folder, text, scratch);
}

// "scenes/box.pbrt" -> "scenes/", "box.pbrt" -> "".
static const char *folder_of(const char *path, struct arena *arena) {
  const char *slash = strrchr(path, '/');
  return arena_string(arena, path, slash ? slash + 1 - path : 0);
}

bool scene_read_with(const char *path, struct scene_options options, struct arena *arena,
                     struct scene *scene, struct problem *problem) {
  struct arena own = arena_reserve(), scratch = arena_reserve(), lists = own;
  struct text text;
  bool ok = file_read(path, &lists, &text, problem) &&
            (!gzip_is(text) || gzip_expand(path, text, &lists, &text, problem));
  if (ok) {
    struct reader reader = {.builder = {.arena = arena, .scene = scene},
                            .problem = problem,
                            .lists = lists,
                            .options = options};
    ok = read_all(&reader, path, folder_of(path, arena), text, scratch);
  }
  arena_release(scratch);
  arena_release(own);
  return ok;
}

bool scene_read(const char *path, struct arena *arena, struct scene *scene,
                struct problem *problem) {
  return scene_read_with(path, (struct scene_options){0}, arena, scene, problem);
}
