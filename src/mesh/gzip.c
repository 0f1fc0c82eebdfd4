#include "mesh/ply.h"

#include <string.h>
#include <zlib.h>

enum { GZIP = 15 + 16 }; // zlib's code for the largest window and a gzip wrapper

// As much as zlib's 32-bit counters take at once.
static uInt piece(ptrdiff_t length) { return length > 1 << 30 ? 1 << 30 : (uInt)length; }

// To the end of the last member; Z_OK or zlib's error.
static int inflate_all(z_stream *stream, struct text in, struct arena *arena, struct text *out) {
  ptrdiff_t capacity = 4 * in.length + 4096, used = 0;
  for (;;) {
    if (out->length + 1 >= capacity || !out->data) {
      ptrdiff_t wanted = out->data ? 2 * capacity : capacity;
      out->data = arena_grow(arena, out->data, out->data ? capacity : 0, wanted, 1, 1);
      capacity = wanted;
    }
    uInt give = piece(in.length - used), room = piece(capacity - 1 - out->length);
    stream->next_in = (Bytef *)in.data + used;
    stream->next_out = (Bytef *)out->data + out->length;
    stream->avail_in = give, stream->avail_out = room;
    int status = inflate(stream, Z_NO_FLUSH);
    used += (ptrdiff_t)(give - stream->avail_in);
    out->length += (ptrdiff_t)(room - stream->avail_out);
    if (status == Z_STREAM_END && used == in.length) return Z_OK;
    if (status == Z_STREAM_END) status = inflateReset(stream);
    if (status != Z_OK) return status;
  }
}

bool mesh_gunzip(const char *file, struct text in, struct arena *arena, struct text *out,
                 struct problem *problem) {
  z_stream stream = {0};
  if (inflateInit2(&stream, GZIP) != Z_OK) die("zlib cannot be initialised");
  *out = (struct text){0};
  int status = inflate_all(&stream, in, arena, out);
  inflateEnd(&stream);
  if (status == Z_OK) return true;
  return problem_set(problem, "%s: the gzip data is %s", file,
                     status == Z_BUF_ERROR ? "cut off" : "damaged");
}
