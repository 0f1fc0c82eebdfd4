#include "pbrt/lexer.h"

#include "pbrt/number.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct lexer lexer_begin(const char *file, struct text text, struct problem *problem) {
  return (struct lexer){.file = file,
                        .at = text.data,
                        .end = text.data + text.length,
                        .line_start = text.data,
                        .line = 1,
                        .problem = problem};
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// Of a word or number.
static bool is_delimiter(char c) {
  return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

static bool is_control(char c) { return (unsigned char)c < 0x20 || c == 0x7f; }

static void skip_space_and_comments(struct lexer *lexer) {
  for (; lexer->at < lexer->end; lexer->at++) {
    if (*lexer->at == '#') {
      const char *newline = memchr(lexer->at, '\n', (size_t)(lexer->end - lexer->at));
      lexer->at = newline ? newline : lexer->end;
      if (!newline) return;
    }
    if (!is_space(*lexer->at)) return;
    if (*lexer->at == '\n') {
      lexer->line++;
      lexer->line_start = lexer->at + 1;
    }
  }
}

static bool is_escapable(char c) { return c == '"' || c == '\\' || c == '\''; }

static struct place place_here(const struct lexer *lexer) {
  return (struct place){lexer->file, lexer->line, (int)(lexer->at - lexer->line_start) + 1};
}

static bool scan_string(struct lexer *lexer) {
  struct token *token = &lexer->token;
  const char *open = lexer->at++;
  for (; lexer->at < lexer->end && *lexer->at != '"'; lexer->at++) {
    if (*lexer->at == '\n' || *lexer->at == '\r') break;
    if (is_control(*lexer->at) && *lexer->at != '\t')
      return problem_at(lexer->problem, place_here(lexer), "control character 0x%02x in a string",
                        (unsigned char)*lexer->at);
    if (*lexer->at != '\\') continue;
    lexer->at++;
    // pbrt has \n and the like too; without them a string, and a message with it, is one line.
    if (lexer->at == lexer->end || !is_escapable(*lexer->at))
      return problem_at(lexer->problem, place_here(lexer),
                        "unknown escape in a string; write \\\\ for a backslash");
  }
  if (lexer->at == lexer->end || *lexer->at != '"')
    return problem_at(lexer->problem, token->place, "this string has no closing quote on its line");
  token->kind = TOKEN_STRING;
  token->text = open + 1;
  token->length = lexer->at - open - 1;
  lexer->at++;
  return true;
}

static bool scan_number(struct lexer *lexer) {
  struct token *token = &lexer->token;
  token->kind = TOKEN_NUMBER;
  if (!number_scan(token->text, token->length, &token->number))
    return problem_at(lexer->problem, token->place, "%s is not a number",
                      lexer_describe(token).text);
  if (!isfinite(token->number))
    return problem_at(lexer->problem, token->place, "%s is too large for a number",
                      lexer_describe(token).text);
  return true;
}

static bool scan_word_or_number(struct lexer *lexer) {
  struct token *token = &lexer->token;
  char first = *lexer->at;
  token->kind = TOKEN_WORD;
  token->text = lexer->at;
  for (; lexer->at < lexer->end && !is_delimiter(*lexer->at); lexer->at++)
    if (is_control(*lexer->at) || (unsigned char)*lexer->at >= 0x80)
      return problem_at(lexer->problem, place_here(lexer), "unexpected byte 0x%02x",
                        (unsigned char)*lexer->at);
  token->length = lexer->at - token->text;
  bool number = (first >= '0' && first <= '9') || first == '+' || first == '-' || first == '.';
  return number ? scan_number(lexer) : true;
}

static bool scan_bracket(struct lexer *lexer, enum token_kind kind) {
  lexer->token.kind = kind;
  lexer->token.text = lexer->at++;
  lexer->token.length = 1;
  return true;
}

bool lexer_advance(struct lexer *lexer) {
  if (lexer->end - lexer->line_start > INT_MAX)
    return problem_set(lexer->problem, "%s: larger than 2 GiB; split it", lexer->file);
  skip_space_and_comments(lexer);
  lexer->token = (struct token){.kind = TOKEN_END, .place = place_here(lexer)};
  if (lexer->at == lexer->end) return true;
  if (*lexer->at == '"') return scan_string(lexer);
  if (*lexer->at == '[') return scan_bracket(lexer, TOKEN_OPEN);
  if (*lexer->at == ']') return scan_bracket(lexer, TOKEN_CLOSE);
  return scan_word_or_number(lexer);
}

char *lexer_string(const struct token *token, struct arena *arena) {
  char *string = arena_new(arena, char, token->length + 1), *out = string;
  for (const char *at = token->text; at < token->text + token->length; at++)
    *out++ = *at == '\\' ? *++at : *at;
  return string;
}

struct token_text lexer_describe(const struct token *token) {
  struct token_text out;
  if (token->kind == TOKEN_END) {
    snprintf(out.text, sizeof out.text, "the end of the file");
    return out;
  }
  const char *quote = token->kind == TOKEN_STRING ? "\"" : "";
  int shown = token->length > 40 ? 40 : (int)token->length;
  snprintf(out.text, sizeof out.text, "%s%.*s%s%s", quote, shown, token->text,
           shown < token->length ? "..." : "", quote);
  return out;
}
