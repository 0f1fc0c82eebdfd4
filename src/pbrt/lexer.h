// The tokens of a pbrt-v4 scene file: words, "strings", numbers, [ and ]. # begins a comment.
#ifndef PBRT_LEXER_H
#define PBRT_LEXER_H

#include "base/file.h"
#include "base/problem.h"

#include <stdbool.h>
#include <stddef.h>

enum token_kind { TOKEN_END, TOKEN_WORD, TOKEN_STRING, TOKEN_NUMBER, TOKEN_OPEN, TOKEN_CLOSE };

struct token {
  enum token_kind kind;
  const char *text; // into the file's text; strings without their quotes, escapes not yet replaced
  ptrdiff_t length;
  double number; // finite
  struct place place;
};

struct lexer {
  const char *file, *at, *end, *line_start;
  int line;
  struct token token; // the one to look at
  struct problem *problem;
};

// Stands before the first token; the text must stay.
struct lexer lexer_begin(const char *file, struct text, struct problem *);

// Steps to the next token; false: not a token (problem set). After the end it stays there.
bool lexer_advance(struct lexer *);

// A string token's contents, escapes replaced.
char *lexer_string(const struct token *, struct arena *);

// What the token is, for messages: the first characters as written, "the end of the file", ...
struct token_text {
  char text[64];
};
struct token_text lexer_describe(const struct token *);

#endif
