#include "experiment/cell_keys.h"

#include "walk/light_path.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char *count(uint64_t n, char *buffer) {
  snprintf(buffer, CELL_KEY_SIZE, "%" PRIu64, n);
  return buffer;
}

static const char *real(double x, int digits, char *buffer) {
  snprintf(buffer, CELL_KEY_SIZE, "%.*g", digits, x);
  return buffer;
}

// A function for each key; not every one needs the digits or the buffer.
#define KEY(name, value)                                                                           \
  static const char *key_##name(const struct cell *cell, int digits, char *buffer) {               \
    (void)digits, (void)buffer;                                                                    \
    return value;                                                                                  \
  }
KEY(cell, count((uint64_t)cell->number, buffer))
KEY(scene, cell->scene)
KEY(integrator, cell->integrator->name)
KEY(kernel, cell->kernel->name)
KEY(law, cell->law->name)
KEY(alpha, real(cell->alpha, digits, buffer))
KEY(reference_radius, cell->reference_radius->name)
KEY(k, count((uint64_t)cell->k, buffer))
KEY(radius, real(cell->radius, digits, buffer))
KEY(radius_volume, real(cell->radius_volume, digits, buffer))
KEY(photons, count(cell->photons, buffer))
KEY(iterations, count(cell->iterations, buffer))
KEY(runs, count(cell->runs, buffer))
KEY(direct, cell->direct == DIRECT_NEE ? "nee" : "photons")
KEY(depth, count((uint64_t)cell->depth, buffer))
KEY(hit_points, count(cell->hit_points, buffer))
KEY(pixel, cell->footprint ? "footprint" : "centre")

// A sum of names, as a file may give it.
static const char *key_view(const struct cell *cell, int digits, char *buffer) {
  (void)digits;
  if (!cell->left_out) return "all";
  buffer[0] = 0;
  for (int k = 0; k < LIGHT_PATHS; k++) {
    if (cell->left_out & light_paths[k].bit) continue;
    size_t length = strlen(buffer);
    snprintf(buffer + length, CELL_KEY_SIZE - length, "%s%s", length ? "+" : "",
             light_paths[k].name);
  }
  return buffer;
}

// As in manifest.json: JSON's numbers do not hold 64 bits everywhere.
static const char *key_seed(const struct cell *cell, int digits, char *buffer) {
  (void)digits;
  snprintf(buffer, CELL_KEY_SIZE, "%016" PRIx64, cell->seed);
  return buffer;
}

const struct cell_key cell_keys[CELL_KEYS] = {
    {"cell", KEY_COUNT, false, key_cell},
    {"scene", KEY_NAME, true, key_scene},
    {"integrator", KEY_NAME, true, key_integrator},
    {"kernel", KEY_NAME, false, key_kernel},
    {"law", KEY_NAME, false, key_law},
    {"alpha", KEY_REAL, true, key_alpha},
    {"reference-radius", KEY_NAME, false, key_reference_radius},
    {"radius", KEY_REAL, false, key_radius},
    {"radius-volume", KEY_REAL, false, key_radius_volume},
    {"k", KEY_COUNT, false, key_k},
    {"photons", KEY_COUNT, false, key_photons},
    {"iterations", KEY_COUNT, false, key_iterations},
    {"runs", KEY_COUNT, false, key_runs},
    {"seed", KEY_NAME, false, key_seed},
    {"direct", KEY_NAME, false, key_direct},
    {"view", KEY_NAME, false, key_view},
    {"depth", KEY_COUNT, false, key_depth},
    {"pixel", KEY_NAME, false, key_pixel},
    {"hit-points", KEY_COUNT, false, key_hit_points},
};
