// scene_read: the table of directives, and the loop over those of a file.
#include "scene/read.h"

#include "pbrt/parse.h"
#include "pbrt/suggest.h"
#include "scene/reader.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

static const struct directive directives[] = {
    {"LookAt", ANYWHERE, NUMBERS, 9, false, read_look_at},
    {"Translate", ANYWHERE, NUMBERS, 3, false, read_translate},
    {"Rotate", ANYWHERE, NUMBERS, 4, false, read_rotate},
    {"Scale", ANYWHERE, NUMBERS, 3, false, read_scale},
    {"Identity", ANYWHERE, BARE, 0, false, read_identity},
    {"Transform", ANYWHERE, MATRIX, 16, false, read_transform},
    {"ConcatTransform", ANYWHERE, MATRIX, 16, false, read_concat_transform},
    {"ReverseOrientation", ANYWHERE, BARE, 0, false, read_reverse_orientation},
    {"ColorSpace", ANYWHERE, NAME, 0, false, read_color_space},
    {"Camera", BEFORE_WORLD, PARAMETERS, 0, true, read_camera},
    {"Film", BEFORE_WORLD, PARAMETERS, 0, true, read_film},
    {"PixelFilter", BEFORE_WORLD, PARAMETERS, 0, false, read_pixel_filter},
    {"Sampler", BEFORE_WORLD, PARAMETERS, 0, false, read_sampler},
    {"Integrator", BEFORE_WORLD, PARAMETERS, 0, true, read_integrator},
    {"WorldBegin", BEFORE_WORLD, BARE, 0, false, read_world_begin},
    {"AttributeBegin", IN_WORLD, BARE, 0, false, read_attribute_begin},
    {"AttributeEnd", IN_WORLD, BARE, 0, false, read_attribute_end},
    {"Shape", IN_WORLD, PARAMETERS, 0, false, read_shape},
    {"Material", IN_WORLD, PARAMETERS, 0, false, read_material},
    {"LightSource", IN_WORLD, PARAMETERS, 0, true, read_light_source},
    {"AreaLightSource", IN_WORLD, PARAMETERS, 0, true, read_area_light_source},
};
enum { N_DIRECTIVES = (int)(sizeof directives / sizeof *directives) };

// What pbrt-v4 knows and we do not, and what to do about it.
static const struct {
  const char *name, *advice;
} unsupported[] = {
    {"Accelerator", "take the line out: there is only one here"},
    {"ActiveTransform", "there is no motion"},
    {"Attribute", "give the parameters to each directive"},
    {"CoordSysTransform", "write the transformation out"},
    {"CoordinateSystem", "write the transformation out"},
    {"Import", "put the file's text here"},
    {"Include", "put the file's text here"},
    {"MakeNamedMaterial", "use Material before each shape"},
    {"MakeNamedMedium", "there are no media"},
    {"MediumInterface", "there are no media"},
    {"NamedMaterial", "use Material before each shape"},
    {"ObjectBegin", "there are no instances: repeat the shapes"},
    {"ObjectEnd", "there are no instances: repeat the shapes"},
    {"ObjectInstance", "there are no instances: repeat the shapes"},
    {"Option", "take the line out"},
    {"Texture", "there are no textures: use constant values"},
    {"TransformBegin", "use AttributeBegin"},
    {"TransformEnd", "use AttributeEnd"},
    {"TransformTimes", "there is no motion"},
};
enum { N_UNSUPPORTED = (int)(sizeof unsupported / sizeof *unsupported) };

static bool token_is(const struct token *token, const char *name) {
  return (size_t)token->length == strlen(name) && memcmp(token->text, name, strlen(name)) == 0;
}

static bool unknown_directive(struct reader *reader) {
  const struct token *token = &reader->lexer.token;
  for (int i = 0; i < N_UNSUPPORTED; i++)
    if (token_is(token, unsupported[i].name))
      return problem_at(reader->problem, token->place, "%s is not in this version; %s",
                        unsupported[i].name, unsupported[i].advice);
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

static bool expect(struct reader *reader, const struct call *call, enum token_kind kind,
                   const char *what) {
  const struct token *token = &reader->lexer.token;
  if (token->kind == kind) return true;
  return problem_at(reader->problem, token->place, "%s: expected %s, found %s", call->name, what,
                    lexer_describe(token).text);
}

static bool parse_numbers(struct reader *reader, struct call *call, int n) {
  char what[64];
  for (int i = 0; i < n; i++) {
    snprintf(what, sizeof what, "number %d of %d", i + 1, n);
    if (!expect(reader, call, TOKEN_NUMBER, what)) return false;
    call->number[i] = reader->lexer.token.number;
    if (!lexer_advance(&reader->lexer)) return false;
  }
  return true;
}

static bool parse_matrix(struct reader *reader, struct call *call) {
  return expect(reader, call, TOKEN_OPEN, "[ and 16 numbers") && lexer_advance(&reader->lexer) &&
         parse_numbers(reader, call, 16) && expect(reader, call, TOKEN_CLOSE, "]") &&
         lexer_advance(&reader->lexer);
}

static bool parse_name(struct reader *reader, struct arena *arena, struct call *call) {
  if (!expect(reader, call, TOKEN_STRING, "a name in quotes")) return false;
  call->type = lexer_string(&reader->lexer.token, arena);
  call->type_place = reader->lexer.token.place;
  return lexer_advance(&reader->lexer);
}

static bool parse_call(struct reader *reader, const struct directive *directive,
                       struct arena *arena, struct call *call) {
  if (!lexer_advance(&reader->lexer)) return false;
  switch (directive->form) {
  case BARE:
    return true;
  case NUMBERS:
    return parse_numbers(reader, call, directive->n_numbers);
  case MATRIX:
    return parse_matrix(reader, call);
  case NAME:
    return parse_name(reader, arena, call);
  case PARAMETERS:
    break;
  }
  if (!parse_name(reader, arena, call)) return false;
  const char *title = arena_format(arena, "%s \"%s\"", call->name, call->type);
  return params_parse(&reader->lexer, arena, title, call->place, &call->params);
}

static bool read_directive(struct reader *reader, struct arena scratch) {
  const struct directive *directive = find_directive(reader);
  struct call call = {.place = reader->lexer.token.place};
  if (!directive || !check_where(reader, directive, call.place)) return false;
  call.name = directive->name;
  struct arena *arena = directive->keep ? reader->builder.arena : &scratch;
  return parse_call(reader, directive, arena, &call) && directive->run(reader, &call);
}

static bool read_directives(struct reader *reader, struct arena scratch) {
  if (!lexer_advance(&reader->lexer)) return false;
  while (reader->lexer.token.kind != TOKEN_END)
    if (!read_directive(reader, scratch)) return false;
  if (reader->saved.count)
    return problem_at(reader->problem, reader->saved.item[reader->saved.count - 1].begin,
                      "this AttributeBegin has no AttributeEnd");
  if (reader->world_begin.line == 0)
    return problem_at(reader->problem, reader->lexer.token.place, "the file has no WorldBegin");
  return true;
}

bool scene_read_text(const char *path, const char *folder, struct text text, struct arena *arena,
                     struct arena lists, struct arena scratch, struct scene *scene,
                     struct problem *problem) {
  *scene = (struct scene){.path = arena_string(arena, path, (ptrdiff_t)strlen(path)),
                          .hash = XXH64(text.data, (size_t)text.length, 0)};
  struct reader reader = {.lexer = lexer_begin(scene->path, text, problem),
                          .builder = {.arena = arena, .scene = scene, .folder = folder},
                          .problem = problem,
                          .lists = lists,
                          .now = {.world_from_object = transform_identity()}};
  read_default_options(&reader);
  read_default_material(&reader);
  return read_directives(&reader, scratch) && scene_finish(&reader);
}

// "scenes/box.pbrt" -> "scenes/", "box.pbrt" -> "".
static const char *folder_of(const char *path, struct arena *arena) {
  const char *slash = strrchr(path, '/');
  return arena_string(arena, path, slash ? slash + 1 - path : 0);
}

bool scene_read(const char *path, struct arena *arena, struct scene *scene,
                struct problem *problem) {
  struct arena own = arena_reserve(), scratch = arena_reserve(), lists = own;
  struct text text;
  bool ok = file_read(path, &lists, &text, problem) &&
            scene_read_text(path, folder_of(path, arena), text, arena, lists, scratch, scene, problem);
  arena_release(scratch);
  arena_release(own);
  return ok;
}
