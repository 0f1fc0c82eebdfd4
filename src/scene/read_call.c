// What follows a directive's name: numbers, names or parameters.
#include "pbrt/parse.h"
#include "scene/reader.h"

#include <stdio.h>

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

static bool parse_word(struct reader *reader, struct arena *arena, struct call *call) {
  const struct token *token = &reader->lexer.token;
  if (!expect(reader, call, TOKEN_WORD, "a word")) return false;
  call->type = arena_string(arena, token->text, token->length);
  call->type_place = token->place;
  return lexer_advance(&reader->lexer);
}

// "name" value, where the value is a word, a string or a number, perhaps in brackets.
static bool parse_name_value(struct reader *reader, struct arena *arena, struct call *call) {
  struct lexer *lexer = &reader->lexer;
  if (!parse_name(reader, arena, call)) return false;
  bool bracket = lexer->token.kind == TOKEN_OPEN;
  if (bracket && !lexer_advance(lexer)) return false;
  enum token_kind kind = lexer->token.kind;
  if (kind != TOKEN_WORD && kind != TOKEN_NUMBER && !expect(reader, call, TOKEN_STRING, "a value"))
    return false;
  call->value = kind == TOKEN_STRING ? lexer_string(&lexer->token, arena)
                                     : arena_string(arena, lexer->token.text, lexer->token.length);
  call->value_place = lexer->token.place;
  if (!lexer_advance(lexer)) return false;
  return !bracket || (expect(reader, call, TOKEN_CLOSE, "]") && lexer_advance(lexer));
}

// "name" or "name" "name".
static bool parse_names(struct reader *reader, struct arena *arena, struct call *call) {
  struct lexer *lexer = &reader->lexer;
  if (!parse_name(reader, arena, call)) return false;
  if (lexer->token.kind != TOKEN_STRING) return true;
  call->value = lexer_string(&lexer->token, arena);
  call->value_place = lexer->token.place;
  return lexer_advance(lexer);
}

// "title" "kind", before what every directive with parameters has.
static bool parse_texture(struct reader *reader, struct arena *arena, struct call *call) {
  if (!parse_name(reader, arena, call)) return false;
  call->title = call->type;
  call->title_place = call->type_place;
  if (!parse_name(reader, arena, call)) return false;
  call->kind = call->type;
  call->kind_place = call->type_place;
  return true;
}

bool read_parse_call(struct reader *reader, const struct directive *directive, struct arena *arena,
                     struct call *call) {
  if (!lexer_advance(&reader->lexer)) return false;
  switch (directive->form) {
  case BARE:
    return true;
  case NUMBERS:
    return parse_numbers(reader, call, directive->n_numbers);
  case MATRIX:
    return parse_matrix(reader, call);
  case WORD:
    return parse_word(reader, arena, call);
  case NAME:
    return parse_name(reader, arena, call);
  case NAMES:
    return parse_names(reader, arena, call);
  case NAME_VALUE:
    return parse_name_value(reader, arena, call);
  case TEXTURE:
    if (!parse_texture(reader, arena, call)) return false;
    break;
  case PARAMETERS:
    break;
  }
  if (!parse_name(reader, arena, call)) return false;
  const char *title = arena_format(arena, "%s \"%s\"", call->name, call->type);
  if (!params_parse(&reader->lexer, arena, title, call->place, &call->params)) return false;
  read_apply_defaults(reader, directive->target, arena, call);
  return true;
}
