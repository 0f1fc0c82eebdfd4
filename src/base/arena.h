// Memory is in the signature: a function that keeps memory takes `struct arena *`, one that needs
// scratch takes `struct arena` by value, one that takes none does not allocate.
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stdalign.h>
#include <stddef.h>

struct arena {
  unsigned char *next, *end;
};

// Reserves address space (pages are taken when first touched). Dies if there is none.
struct arena arena_reserve(void);
// `arena` as arena_reserve returned it.
void arena_release(struct arena arena);

// Zeroed memory for `count` objects; never NULL: dies when the reserve is used up.
void *arena_alloc(struct arena *, ptrdiff_t count, ptrdiff_t size, ptrdiff_t align);
#define arena_new(arena, type, count) \
  ((type *)arena_alloc((arena), (count), (ptrdiff_t)sizeof(type), (ptrdiff_t)alignof(type)))

// A larger copy of an array of `old` objects; in place when it was the last thing allocated.
void *arena_grow(struct arena *, void *array, ptrdiff_t old, ptrdiff_t count, ptrdiff_t size,
                 ptrdiff_t align);

char *arena_string(struct arena *, const char *text, ptrdiff_t length);
char *arena_format(struct arena *, const char *format, ...) __attribute__((format(printf, 2, 3)));

// An array that grows in an arena: struct { T *item; ptrdiff_t count, capacity; }.
#define arena_push(arena, list)                                                                  \
  ((list)->count == (list)->capacity                                                             \
       ? ((list)->item = arena_grow((arena), (list)->item, (list)->capacity,                     \
                                    (list)->capacity ? 2 * (list)->capacity : 8,                 \
                                    (ptrdiff_t)sizeof *(list)->item,                             \
                                    (ptrdiff_t)alignof(max_align_t)),                            \
          (list)->capacity = (list)->capacity ? 2 * (list)->capacity : 8, (void)0)               \
       : (void)0,                                                                                \
   &(list)->item[(list)->count++])

#endif
