// Reads the parameter list of a directive.
#ifndef PBRT_PARSE_H
#define PBRT_PARSE_H

#include "pbrt/lexer.h"
#include "pbrt/params.h"

// Reads `"type name" value ...` from the current token up to the first that begins no parameter.
// `directive` and `place` are for messages. Types, numbers of values and duplicates are checked.
bool params_parse(struct lexer *, struct arena *, const char *directive, struct place,
                  struct params *);

#endif
