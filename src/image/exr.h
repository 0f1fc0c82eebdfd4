// OpenEXR through OpenEXRCore's C API; its types stay in exr.c and exr_read.c. The library works on
// our stream or our bytes, so it never opens or names a file.
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include "image/format.h"

#include <OpenEXR/openexr.h>
#include <string.h>

#define EXR_MANIFEST "photonlab/manifest" // the attribute

// Its default prints to stderr; we take the result codes.
static inline void exr_on_error(exr_const_context_t file, exr_result_t code, const char *message) {
  (void)file, (void)code, (void)message;
}

static inline bool exr_complain(struct problem *problem, const char *path, const char *what,
                                exr_result_t code) {
  return problem_set(problem, "%s: %s: %s", path, what, exr_get_default_error_message(code));
}

static inline bool exr_same_name(const char *a, const char *b) { return strcmp(a, b) == 0; }

#endif
