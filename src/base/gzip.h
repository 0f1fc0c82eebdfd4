// Files compressed by gzip, expanded in memory.
#ifndef BASE_GZIP_H
#define BASE_GZIP_H

#include "base/file.h"

// Whether it begins as a gzip file does.
bool gzip_is(struct text);

// What `from` was compressed from; *to may be the same. `path` is for messages.
bool gzip_expand(const char *path, struct text from, struct arena *, struct text *to,
                 struct problem *);

#endif
