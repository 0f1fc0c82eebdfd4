// A PLY file: a header that declares elements (tables) and their properties (columns), then the
// rows, as text or binary (Turk 1994, "The PLY Polygon File Format").
#ifndef MESH_PLY_H
#define MESH_PLY_H

#include "mesh/mesh.h"

enum ply_type {
  PLY_INT8,
  PLY_UINT8,
  PLY_INT16,
  PLY_UINT16,
  PLY_INT32,
  PLY_UINT32,
  PLY_FLOAT32,
  PLY_FLOAT64,
  PLY_N_TYPES
};

struct ply_word { // of the file's text
  const char *text;
  ptrdiff_t length;
};

struct ply_property {
  struct ply_word name;
  enum ply_type type;
  bool list;
  enum ply_type count_type; // of a list, never of floats
};

struct ply_element {
  struct ply_word name;
  int64_t count;
  struct {
    struct ply_property *item;
    ptrdiff_t count, capacity;
  } properties;
};

struct ply {
  const char *file;
  const char *begin, *at, *end; // the byte at `end` is a zero
  int line;                     // of `at`, in text
  enum { PLY_NO_FORMAT, PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } format;
  bool binary; // what is at `at`; the header never is
  struct {
    struct ply_element *item;
    ptrdiff_t count, capacity;
  } elements;
  struct problem *problem;
};

// Sets the problem with the line (text) or the byte (binary) where it is; false.
bool ply_complain(const struct ply *, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

bool ply_is(struct ply_word, const char *text);

// A word for messages: printable and short.
struct ply_quote {
  char text[32];
};
struct ply_quote ply_quote(struct ply_word);

// From "ply" to "end_header"; the elements live in the arena.
bool ply_read_header(struct ply *, struct arena *);

ptrdiff_t ply_size(enum ply_type); // in bytes, binary

// The next value; false: there is none (problem set). Text may hold nan and inf.
bool ply_read_value(struct ply *, enum ply_type, double *value);
bool ply_skip_values(struct ply *, enum ply_type, int64_t count);
// The length of a list, at most what the rest of the file can hold.
bool ply_read_count(struct ply *, const struct ply_property *, int64_t *count);
// All values of a property in one row.
bool ply_skip_property(struct ply *, const struct ply_property *);

#endif
