// Pixel filters: how a pixel's samples are distributed around its centre. A sample's weight is 1, so
// pixels stay independent of each other.
#include "scene/scene.h"

#include <string.h>

static bool box_read(struct filter *filter, struct params *params) {
  filter->radius[0] = params_float(params, "xradius", 0.5);
  filter->radius[1] = params_float(params, "yradius", 0.5);
  return !params->problem->text[0];
}

static void box_sample(const struct filter *filter, const double u[2], double offset[2]) {
  for (int k = 0; k < 2; k++) offset[k] = filter->radius[k] * (2 * u[k] - 1);
}

static const struct filter_type box = {"box", "the same everywhere", box_read, box_sample};

const struct filter_type *const filter_types[] = {&box, NULL};

const struct filter_type *filter_find(const char *name) {
  for (int k = 0; filter_types[k]; k++)
    if (!strcmp(filter_types[k]->name, name)) return filter_types[k];
  return NULL;
}
