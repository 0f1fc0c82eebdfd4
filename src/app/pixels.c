#define _GNU_SOURCE // opendir
#include "app/pixels.h"

#include "base/file.h"
#include "image/image.h"

#include <dirent.h>
#include <string.h>

static const float *plane_of(const struct image *image, const char *name) {
  for (int c = 0; c < image->n_channels; c++)
    if (strcmp(image->name[c], name) == 0) return image->plane[c];
  return NULL;
}

static bool write_one(const char *exr, const char *csv, struct arena scratch,
                      struct problem *problem) {
  struct image image;
  struct file_out out;
  if (!image_read(exr, &scratch, &image, problem)) return false;
  const float *r = plane_of(&image, "R"), *g = plane_of(&image, "G"), *b = plane_of(&image, "B");
  if (!r || !g || !b) return problem_set(problem, "%s: has no channels R, G, B", exr);
  if (!file_begin(&out, csv, problem)) return false;
  fputs("x,y,R,G,B\n", out.stream);
  for (int j = 0; j < image.width * image.height; j++)
    fprintf(out.stream, "%d,%d,%.9g,%.9g,%.9g\n", j % image.width, j / image.width, (double)r[j],
            (double)g[j], (double)b[j]);
  return file_commit(&out, problem);
}

bool pixels_write(const char *directory, struct arena scratch, struct problem *problem) {
  const char *folder = arena_format(&scratch, "%s/images", directory);
  DIR *list = opendir(folder);
  bool ok = true;
  for (struct dirent *entry; ok && list && (entry = readdir(list));) {
    ptrdiff_t length = (ptrdiff_t)strlen(entry->d_name) - 4;
    struct arena own = scratch;
    if (length <= 0 || strcmp(entry->d_name + length, ".exr") != 0) continue;
    char *exr = arena_format(&own, "%s/%s", folder, entry->d_name);
    char *csv = arena_format(&own, "%s/%.*s.csv", folder, (int)length, entry->d_name);
    ok = write_one(exr, csv, own, problem);
  }
  if (list) closedir(list);
  return ok;
}
