// Materials that all tests of scattering loop over: each registered one, smooth, rough, extreme.
#ifndef TESTS_MATERIAL_CASES_H
#define TESTS_MATERIAL_CASES_H

#include "tests/unit/scene_text.h"

struct material_case {
  const char *text;
  bool gray;
  double albedo; // the share of importance that is scattered, from everywhere; NAN: depends
};

static const struct material_case material_cases[] = {
    {"'diffuse'", true, 0.5},
    {"'diffuse' 'rgb reflectance' [.75 .25 0]", false, 0.75},
    {"'diffuse' 'rgb reflectance' [0 0 0]", true, 0},
    {"'diffusetransmission'", true, 0.5},
    {"'diffusetransmission' 'rgb reflectance' [.5 .4 .2] 'rgb transmittance' [.3 .1 .4] "
     "'float scale' .8",
     false, 0.64},
    {"'diffusetransmission' 'rgb reflectance' [0 0 0]", true, 0.25},
    {"'conductor'", false, NAN},
    {"'conductor' 'float roughness' .04 'spectrum eta' 'metal-Au-eta' 'spectrum k' 'metal-Au-k'",
     false, NAN},
    {"'conductor' 'float roughness' .3 'rgb reflectance' [.385 .385 .385]", true, NAN},
    {"'conductor' 'float uroughness' .6 'float vroughness' .05 'bool remaproughness' false "
     "'rgb eta' [1.4 .9 .6] 'rgb k' [7.7 6.6 5.3]",
     false, NAN},
    {"'dielectric'", true, 1},
    {"'dielectric' 'float eta' 1 'float roughness' .3", true, 1},
    {"'dielectric' 'spectrum eta' 'glass-BK7' 'float roughness' .02", true, NAN},
    {"'dielectric' 'float eta' .6 'float roughness' .25", true, NAN},
    {"'dielectric' 'float eta' 2.385 'float uroughness' .4 'float vroughness' .12 "
     "'bool remaproughness' false",
     true, NAN},
    {"'thindielectric'", true, 1},
    {"'thindielectric' 'float eta' 2.385", true, 1},
    {"'coateddiffuse'", true, NAN},
    {"'coateddiffuse' 'float roughness' .3 'rgb reflectance' [.8 .6 .2] 'float eta' 1.8", false,
     NAN},
    {"'coateddiffuse' 'float roughness' .1 'rgb albedo' [.6 .6 .6] 'float g' .4 'float thickness' "
     ".3",
     true, NAN},
    {"'coatedconductor'", false, NAN},
    {"'coatedconductor' 'float interface.roughness' .2 'float conductor.roughness' .1 "
     "'rgb reflectance' [.7 .7 .7]",
     true, NAN},
    {"'mix' 'string materials' ['paper' 'mirror'] 'float amount' .3", true, NAN},
    {"'mix' 'string materials' ['frosted' 'mirror'] 'float amount' .6", true, NAN},
};
enum { N_MATERIAL_CASES = (int)(sizeof material_cases / sizeof *material_cases) };

// A sphere of that material ('name' for "name").
static inline struct scene material_scene_of(const char *material) {
  char text[2048];
  int n = snprintf(text, sizeof text,
                   "WorldBegin LightSource 'point' "
                   "MakeNamedMaterial 'paper' 'string type' 'diffusetransmission' "
                   "MakeNamedMaterial 'mirror' 'string type' 'conductor' 'rgb reflectance' [1 1 1] "
                   "MakeNamedMaterial 'frosted' 'string type' 'dielectric' 'float roughness' .2 "
                   "Texture 'fine' 'float' 'constant' 'float value' .05 "
                   "Texture 'coarse' 'float' 'constant' 'float value' .6 "
                   "Texture 'none' 'float' 'constant' 'float value' 0 "
                   "Texture 'red' 'spectrum' 'constant' 'rgb value' [.7 .2 .1] "
                   "Texture 'bright' 'spectrum' 'scale' 'texture tex' 'red' 'float scale' 5 "
                   "Material %s Shape 'sphere'",
                   material);
  assert_true(n > 0 && n < (int)sizeof text);
  for (char *c = text; *c; c++)
    if (*c == '\'') *c = '"';
  return scene_of(text);
}

static inline struct scene material_scene(int i) {
  return material_scene_of(material_cases[i].text);
}

static inline const struct material *material_of(const struct scene *scene) {
  return &scene->material[scene->shape[0].material];
}

// Its scattering where the frame is x, y, z.
static inline struct bsdf material_bsdf(const struct scene *scene, double u) {
  struct surface surface = {
      .ng = vec(0, 0, 1), .ns = vec(0, 0, 1), .dpdu = vec(2, 0, 0), .uv = {0.385, 0.62}};
  struct bsdf out;
  surface_bsdf(scene, &surface, u, &out);
  return out;
}

// It draws from bsdf.u and, where it likes, from the directions: what it promises of f is the mean.
static inline bool material_is_random(const struct scene *scene) {
  return material_of(scene)->needs & MATERIAL_RANDOM;
}

#endif
