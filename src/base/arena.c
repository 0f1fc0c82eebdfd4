#define _GNU_SOURCE // MAP_ANONYMOUS, MAP_NORESERVE
#include "base/arena.h"

#include "base/problem.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

#if defined(__SANITIZE_ADDRESS__)
#define ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ASAN 1
#endif
#endif

#ifdef ASAN
#include <sanitizer/asan_interface.h>
// Poisoning writes an eighth of the size, so less is reserved.
#define RESERVE_BITS 28
enum { RED_ZONE = 32 };
static void arena_poison(void *at, size_t n) { ASAN_POISON_MEMORY_REGION(at, n); }
static void arena_unpoison(void *at, size_t n) { ASAN_UNPOISON_MEMORY_REGION(at, n); }
#else
#ifndef RESERVE_BITS // emulated: less (Makefile)
#define RESERVE_BITS 36
#endif
enum { RED_ZONE = 0 };
static void arena_poison(void *at, size_t n) { (void)at, (void)n; }
static void arena_unpoison(void *at, size_t n) { (void)at, (void)n; }
#endif

struct arena arena_reserve(void) {
  // Address space, not memory; where even that is limited (ulimit -v) we take what there is.
  for (size_t size = (size_t)1 << RESERVE_BITS; size >= (size_t)1 << 20; size /= 2) {
    unsigned char *at = mmap(NULL, size, PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) continue;
    arena_poison(at, size);
    return (struct arena){at, at + size};
  }
  die("out of memory: cannot reserve even 1 MiB of address space");
}

void arena_release(struct arena arena) {
  size_t size = (size_t)(arena.end - arena.next);
  arena_unpoison(arena.next, size);
  munmap(arena.next, size);
}

void *arena_alloc(struct arena *arena, ptrdiff_t count, ptrdiff_t size, ptrdiff_t align) {
  ptrdiff_t pad = -(ptrdiff_t)((uintptr_t)arena->next & (uintptr_t)(align - 1)) & (align - 1);
  ptrdiff_t room = arena->end - arena->next - pad - RED_ZONE;
  if (count < 0 || room < 0 || count > room / size)
    die("out of memory: %td objects of %td bytes do not fit into the %td bytes left", count, size,
        room);
  unsigned char *at = arena->next + pad;
  arena->next = at + count * size + RED_ZONE;
  arena_unpoison(at, (size_t)(count * size));
  arena_poison(at + count * size, RED_ZONE); // scratch that is used again was unpoisoned before
  memset(at, 0, (size_t)(count * size));
  return at;
}

void *arena_grow(struct arena *arena, void *array, ptrdiff_t old, ptrdiff_t count, ptrdiff_t size,
                 ptrdiff_t align) {
  if (array && (unsigned char *)array + old * size + RED_ZONE == arena->next) {
    ptrdiff_t room = arena->end - arena->next;
    if (count - old > room / size) die("out of memory: cannot grow an array to %td objects", count);
    unsigned char *tail = (unsigned char *)array + old * size;
    arena->next += (count - old) * size;
    arena_unpoison(tail, (size_t)((count - old) * size));
    arena_poison(tail + (count - old) * size, RED_ZONE);
    memset(tail, 0, (size_t)((count - old) * size));
    return array;
  }
  void *fresh = arena_alloc(arena, count, size, align);
  if (old) memcpy(fresh, array, (size_t)(old * size));
  return fresh;
}

char *arena_string(struct arena *arena, const char *text, ptrdiff_t length) {
  char *copy = arena_new(arena, char, length + 1);
  memcpy(copy, text, (size_t)length);
  return copy;
}

char *arena_format(struct arena *arena, const char *format, ...) {
  va_list args, again;
  va_start(args, format);
  va_copy(again, args);
  int length = vsnprintf(NULL, 0, format, args);
  char *text = arena_new(arena, char, length + 1);
  vsnprintf(text, (size_t)length + 1, format, again);
  va_end(args);
  va_end(again);
  return text;
}
