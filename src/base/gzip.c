#include "base/gzip.h"

#include <limits.h>
#include <zlib.h>

// A few bytes may claim to be anything (a factor of 1000): what is larger than the readers take is
// refused.
static const ptrdiff_t largest = INT_MAX;

bool gzip_is(struct text text) {
  const unsigned char *byte = (const unsigned char *)text.data;
  return text.length >= 2 && byte[0] == 0x1f && byte[1] == 0x8b;
}

// One part of the stream after the other into a growing buffer with room for a zero at its end.
static int inflate_all(z_stream *stream, struct arena *arena, struct text *to) {
  ptrdiff_t capacity = 65536;
  to->data = arena_new(arena, char, capacity);
  for (;;) {
    stream->next_out = (Bytef *)to->data + to->length;
    stream->avail_out = (uInt)(capacity - 1 - to->length);
    int status = inflate(stream, Z_NO_FLUSH);
    to->length = capacity - 1 - stream->avail_out;
    if (status == Z_STREAM_END && stream->avail_in > 0) status = inflateReset(stream); // another
    if (status != Z_OK || capacity > largest / 2) return status;
    if (stream->avail_out > 0) continue;
    to->data = arena_grow(arena, to->data, capacity, 2 * capacity, 1, 1);
    capacity *= 2;
  }
}

bool gzip_expand(const char *path, struct text from, struct arena *arena, struct text *to,
                 struct problem *problem) {
  enum { GZIP_WINDOW = 15 + 16 }; // 32 KiB, with gzip's header
  if (from.length > largest) return problem_set(problem, "%s: larger than 2 GiB", path);
  z_stream stream = {.next_in = (Bytef *)from.data, .avail_in = (uInt)from.length};
  if (inflateInit2(&stream, GZIP_WINDOW) != Z_OK) die("out of memory: zlib cannot start");
  struct text out = {0};
  int status = inflate_all(&stream, arena, &out);
  inflateEnd(&stream);
  if (status == Z_OK) return problem_set(problem, "%s: expands to more than 1 GiB", path);
  if (status == Z_BUF_ERROR) return problem_set(problem, "%s: the gzip file is cut off", path);
  if (status != Z_STREAM_END) return problem_set(problem, "%s: a damaged gzip file", path);
  *to = out;
  return true;
}
