#include "pbrt/parse.h"

#include "pbrt/suggest.h"

#include <math.h>
#include <string.h>

enum value_kind { VALUE_NUMBER, VALUE_STRING, VALUE_TRUTH, VALUE_ANY };

struct param_type {
  const char *name, *canonical;
  enum value_kind kind;
  int group; // numbers come in groups of so many
  bool integer;
};

static const struct param_type types[] = {
    {"integer", "integer", VALUE_NUMBER, 1, true},
    {"float", "float", VALUE_NUMBER, 1, false},
    {"point2", "point2", VALUE_NUMBER, 2, false},
    {"vector2", "vector2", VALUE_NUMBER, 2, false},
    {"point3", "point3", VALUE_NUMBER, 3, false},
    {"vector3", "vector3", VALUE_NUMBER, 3, false},
    {"normal3", "normal", VALUE_NUMBER, 3, false},
    {"point", "point3", VALUE_NUMBER, 3, false},
    {"vector", "vector3", VALUE_NUMBER, 3, false},
    {"normal", "normal", VALUE_NUMBER, 3, false},
    {"rgb", "rgb", VALUE_NUMBER, 3, false},
    {"blackbody", "blackbody", VALUE_NUMBER, 1, false},
    {"spectrum", "spectrum", VALUE_ANY, 1, false},
    {"string", "string", VALUE_STRING, 1, false},
    {"texture", "texture", VALUE_STRING, 1, false},
    {"bool", "bool", VALUE_TRUTH, 1, false},
};
enum { N_TYPES = (int)(sizeof types / sizeof *types) };

// A directive with more is no scene; keeps the search for duplicates cheap.
enum { MAX_PARAMS = 256 };

struct values {
  struct {
    double *item;
    ptrdiff_t count, capacity;
  } number;
  struct {
    const char **item;
    ptrdiff_t count, capacity;
  } string;
  struct {
    bool *item;
    ptrdiff_t count, capacity;
  } truth;
};

static const struct param_type *find_type(struct lexer *lexer, const char *name) {
  const char *names[N_TYPES];
  for (int i = 0; i < N_TYPES; i++) {
    if (strcmp(types[i].name, name) == 0) return &types[i];
    names[i] = types[i].name;
  }
  if (strcmp(name, "color") == 0) { // of pbrt-v3
    problem_at(lexer->problem, lexer->token.place, "unknown parameter type \"color\"; use \"rgb\"");
    return NULL;
  }
  const char *nearest = suggest_name(name, names, N_TYPES);
  problem_at(lexer->problem, lexer->token.place, "unknown parameter type \"%s\"%s%s%s", name,
             nearest ? "; did you mean \"" : "", nearest ? nearest : "", nearest ? "\"?" : "");
  return NULL;
}

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

// "float fov" -> type and name. Both point into one new string.
static bool split_declaration(struct lexer *lexer, struct arena *arena, char **type, char **name) {
  char *at = lexer_string(&lexer->token, arena);
  while (is_blank(*at)) at++;
  *type = at;
  while (*at && !is_blank(*at)) at++;
  char *type_end = at;
  while (is_blank(*at)) at++;
  *name = at;
  while (*at && !is_blank(*at)) at++;
  char *name_end = at;
  while (is_blank(*at)) at++;
  if (*at || !**name)
    return problem_at(lexer->problem, lexer->token.place,
                      "expected a parameter as \"type name\", found %s",
                      lexer_describe(&lexer->token).text);
  *type_end = *name_end = 0;
  return true;
}

static bool truth_of(const struct token *token, bool *truth) {
  if (token->kind != TOKEN_WORD && token->kind != TOKEN_STRING) return false;
  *truth = token->length == 4 && memcmp(token->text, "true", 4) == 0;
  return *truth || (token->length == 5 && memcmp(token->text, "false", 5) == 0);
}

static bool wrong_value(struct lexer *lexer, const struct param *param, const char *wanted) {
  return problem_at(lexer->problem, lexer->token.place, "\"%s %s\": expected %s, found %s",
                    param->type, param->name, wanted, lexer_describe(&lexer->token).text);
}

static bool take_number(struct lexer *lexer, struct arena *arena, const struct param_type *type,
                        const struct param *param, struct values *values) {
  if (lexer->token.kind != TOKEN_NUMBER) return wrong_value(lexer, param, "a number");
  double x = lexer->token.number;
  if (type->integer && (x != floor(x) || fabs(x) > 9007199254740992.0)) // 2^53: all are doubles
    return wrong_value(lexer, param, "an integer");
  *arena_push(arena, &values->number) = x;
  return true;
}

static bool take_string(struct lexer *lexer, struct arena *arena, const struct param *param,
                        struct values *values) {
  if (lexer->token.kind != TOKEN_STRING) return wrong_value(lexer, param, "a string");
  const char *string = lexer_string(&lexer->token, arena);
  *arena_push(arena, &values->string) = string;
  return true;
}

static bool take_truth(struct lexer *lexer, struct arena *arena, const struct param *param,
                       struct values *values) {
  bool truth;
  if (!truth_of(&lexer->token, &truth)) return wrong_value(lexer, param, "true or false");
  *arena_push(arena, &values->truth) = truth;
  return true;
}

static bool take_value(struct lexer *lexer, struct arena *arena, const struct param_type *type,
                       const struct param *param, struct values *values) {
  bool named = type->kind == VALUE_ANY && lexer->token.kind == TOKEN_STRING; // a named spectrum
  if (type->kind == VALUE_STRING || named) return take_string(lexer, arena, param, values);
  if (type->kind == VALUE_TRUTH) return take_truth(lexer, arena, param, values);
  return take_number(lexer, arena, type, param, values);
}

// One value, or [ values ].
static bool take_values(struct lexer *lexer, struct arena *arena, const struct param_type *type,
                        const struct param *param, struct values *values) {
  if (lexer->token.kind != TOKEN_OPEN)
    return take_value(lexer, arena, type, param, values) && lexer_advance(lexer);
  struct place open = lexer->token.place;
  if (!lexer_advance(lexer)) return false;
  while (lexer->token.kind != TOKEN_CLOSE) {
    if (lexer->token.kind == TOKEN_END) return problem_at(lexer->problem, open, "this [ has no ]");
    if (!take_value(lexer, arena, type, param, values) || !lexer_advance(lexer)) return false;
  }
  return lexer_advance(lexer);
}

static bool finish_param(struct lexer *lexer, const struct param_type *type, struct values *values,
                         struct param *param) {
  param->number = values->number.item;
  param->string = values->string.item;
  param->truth = values->truth.item;
  param->count = values->number.count + values->string.count + values->truth.count;
  if (values->number.count && values->string.count)
    return problem_at(lexer->problem, param->place, "\"%s %s\" mixes numbers and strings",
                      param->type, param->name);
  if (param->count == 0)
    return problem_at(lexer->problem, param->place, "\"%s %s\" has no value", param->type,
                      param->name);
  if (param->count % type->group)
    return problem_at(lexer->problem, param->place,
                      "\"%s %s\" needs groups of %d numbers, has %td numbers", param->type,
                      param->name, type->group, param->count);
  return true;
}

static bool parse_param(struct lexer *lexer, struct arena *arena, struct param *param) {
  char *type_name, *name;
  if (!split_declaration(lexer, arena, &type_name, &name)) return false;
  const struct param_type *type = find_type(lexer, type_name);
  if (!type) return false;
  *param = (struct param){.type = type->canonical, .name = name, .place = lexer->token.place};
  struct values values = {0};
  return lexer_advance(lexer) && take_values(lexer, arena, type, param, &values) &&
         finish_param(lexer, type, &values, param);
}

static bool check_new(struct lexer *lexer, const struct param *item, ptrdiff_t count,
                      const struct param *param) {
  if (count >= MAX_PARAMS)
    return problem_at(lexer->problem, param->place, "more than %d parameters", MAX_PARAMS);
  for (ptrdiff_t i = 0; i < count; i++)
    if (strcmp(item[i].name, param->name) == 0)
      return problem_at(lexer->problem, param->place,
                        "parameter \"%s\" was already given at line %d", param->name,
                        item[i].place.line);
  return true;
}

bool params_parse(struct lexer *lexer, struct arena *arena, const char *directive,
                  struct place place, struct params *params) {
  struct {
    struct param *item;
    ptrdiff_t count, capacity;
  } list = {0};
  while (lexer->token.kind == TOKEN_STRING) {
    struct param param;
    if (!parse_param(lexer, arena, &param)) return false;
    if (!check_new(lexer, list.item, list.count, &param)) return false;
    *arena_push(arena, &list) = param;
  }
  *params = (struct params){.directive = directive,
                            .place = place,
                            .item = list.item,
                            .count = (int)list.count,
                            .problem = lexer->problem};
  return true;
}
