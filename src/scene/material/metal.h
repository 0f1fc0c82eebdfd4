// pbrt-v4's named indices of refraction for three channels.
// Metals: for each channel the eta and k whose Fresnel reflectance is, over all angles, nearest to
// the linear sRGB of what pbrt's spectra reflect of D65 (least squares in cos dcos; within 0.006
// from normal incidence to grazing, where eta and k projected to sRGB are off by up to 0.05). Gold
// in red lies outside sRGB (1.02): there it reflects all. Glasses: the mean over the luminance of
// D65; what they disperse, three channels cannot show.
#ifndef SCENE_MATERIAL_METAL_H
#define SCENE_MATERIAL_METAL_H

#include <stddef.h>
#include <string.h>

struct metal {
  const char *eta_name, *k_name;
  double eta[3], k[3];
};

static const struct metal metals[] = {
    {"metal-Ag-eta", "metal-Ag-k", {0.12933, 0.12534, 0.15132}, {4.1107, 3.3513, 2.4129}},
    {"metal-Al-eta", "metal-Al-k", {1.4275, 0.92947, 0.59156}, {7.7362, 6.6057, 5.3648}},
    {"metal-Au-eta", "metal-Au-k", {0, 0.40634, 1.5726}, {3, 2.347, 1.7199}},
    {"metal-Cu-eta", "metal-Cu-k", {0.16811, 0.97644, 1.2114}, {3.6403, 2.6211, 2.3663}},
    {"metal-CuZn-eta", "metal-CuZn-k", {0.46752, 0.52339, 1.1263}, {4.272, 2.668, 1.8111}},
    {"metal-MgO-eta", "metal-MgO-k", {1.7337, 1.7409, 1.7535}, {0, 0, 0}},
    {"metal-TiO2-eta", "metal-TiO2-k", {2.86, 2.9575, 3.1856}, {0, 0, 0}},
};

static const struct {
  const char *name;
  double eta;
} glasses[] = {
    {"glass-BK7", 1.5184},   {"glass-BAF10", 1.6729}, {"glass-FK51A", 1.4877},
    {"glass-LASF9", 1.8556}, {"glass-F5", 1.6769},    {"glass-F10", 1.7334},
    {"glass-F11", 1.7909},
};

static inline const double *metal_find(const char *name) {
  for (size_t i = 0; i < sizeof metals / sizeof *metals; i++) {
    if (!strcmp(name, metals[i].eta_name)) return metals[i].eta;
    if (!strcmp(name, metals[i].k_name)) return metals[i].k;
  }
  return NULL;
}

static inline const double *glass_find(const char *name) {
  for (size_t i = 0; i < sizeof glasses / sizeof *glasses; i++)
    if (!strcmp(name, glasses[i].name)) return &glasses[i].eta;
  return NULL;
}

#endif
