// Every registered material, point by point: what value, pdf, sample and delta_probability owe each
// other (scene/bsdf.h), and reciprocity. What they integrate to: tests/statistical/bsdf.c.
#include "tests/material_cases.h"

#include <float.h>

enum { N_DRAWS = 2000 };

static const enum transport transports[] = {TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE};

// Half of them graze.
static struct vec draw_wo(struct draw *draw, int i) {
  struct vec w = draw_direction(draw);
  return i % 2 ? w : vec_normalize(vec(w.x, w.y, w.z * 0.01));
}

static void draw_three(struct draw *draw, double u[3]) {
  double unused;
  draw_pair(draw, &u[0], &u[1]);
  draw_pair(draw, &u[2], &unused);
}

static void every_registered_material_is_a_case(void **state) {
  (void)state;
  for (const struct material_type *const *type = material_types; *type; type++) {
    char quoted[64];
    bool found = (*type)->passed;
    snprintf(quoted, sizeof quoted, "'%s'", (*type)->name);
    for (int i = 0; i < N_MATERIAL_CASES; i++)
      found |= strncmp(material_cases[i].text, quoted, strlen(quoted)) == 0;
    if (!found) fail_msg("add a case for the material %s", (*type)->name);
  }
}

// Gray: equal channels to the bit, for one is carried instead of three. Black: nothing is sampled.
static void gray_and_black_are_what_is_scattered(void **state) {
  (void)state;
  struct draw draw = draw_named("gray_and_black_are_what_is_scattered");
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    const struct material *material = material_of(&scene);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    bool black = material->type->is_black && material->type->is_black(material);
    assert_int_equal(material->type->is_gray(&scene, material), material_cases[i].gray);
    assert_int_equal(black, material_cases[i].albedo == 0);
    if (black) assert_null(bsdf.type);
    for (int k = 0; bsdf.type && material_cases[i].gray && k < N_DRAWS; k++) {
      double f[3], u[3];
      struct bsdf_sample s;
      struct vec wo = draw_wo(&draw, k);
      bsdf_value(&bsdf, wo, draw_direction(&draw), TRANSPORT_RADIANCE, f);
      assert_true(f[0] == f[1] && f[1] == f[2]);
      draw_three(&draw, u);
      if (!bsdf_sample(&bsdf, wo, u, TRANSPORT_RADIANCE, &s)) continue;
      assert_true(s.weight[0] == s.weight[1] && s.weight[1] == s.weight[2]);
    }
  }
}

// weight = f |cos| / pdf, pdf is what pdf() says, wi of unit length; a delta lobe is sampled
// exactly where u[2] is below delta_probability, and then pdf is 0. Half vectors have an error of
// about epsilon, which a facet density of width alpha >= 0.12^2 turns into epsilon / alpha^2, and
// at grazing angles z has lost two digits more.
static void samples_agree_with_value_and_pdf(void **state) {
  (void)state;
  struct draw draw = draw_named("samples_agree_with_value_and_pdf");
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    for (int k = 0; bsdf.type && k < 2 * N_DRAWS; k++) {
      enum transport transport = transports[k % 2];
      double f[3], u[3];
      struct bsdf_sample s;
      struct vec wo = draw_wo(&draw, k / 2);
      draw_three(&draw, u);
      bool delta = u[2] < bsdf_delta_probability(&bsdf, wo, transport);
      if (delta) assert_true(material_of(&scene)->needs & MATERIAL_DELTA);
      if (!bsdf_sample(&bsdf, wo, u, transport, &s)) continue;
      assert_int_equal(s.pdf == 0, delta);
      assert_true(fabs(vec_length(s.wi) - 1) <= 1e-14 && s.wi.z != 0);
      assert_true(s.eta2 > 0 && (transport == TRANSPORT_RADIANCE || s.eta2 == 1));
      for (int c = 0; c < 3; c++) assert_true(s.weight[c] >= 0 && isfinite(s.weight[c]));
      if (delta) continue;
      double pdf = bsdf_pdf(&bsdf, wo, s.wi, transport), slack = 1e-10;
      if (!(fabs(pdf - s.pdf) <= slack * s.pdf))
        fail_msg("%s: pdf %.15g, sampled with %.15g", material_cases[i].text, pdf, s.pdf);
      bsdf_value(&bsdf, wo, s.wi, transport, f);
      for (int c = 0; c < 3; c++)
        assert_true(fabs(f[c] * fabs(s.wi.z) - s.weight[c] * pdf) <= slack * s.weight[c] * pdf);
    }
  }
}

// Importance is the adjoint: f of radiance from wi to wo is f of importance from wo to wi, across
// the surface too (Veach 1997, 3.7.5 and 5.2). And where radiance is sampled, eta2 is what its f
// misses to be that of importance.
// Beside rounding: where a facet all but reflects totally, 1 - F is the root of a small difference,
// good to the root of epsilon.
static void value_is_adjoint(void **state) {
  (void)state;
  struct draw draw = draw_named("value_is_adjoint");
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    if (material_is_random(&scene)) continue;
    for (int k = 0; bsdf.type && k < N_DRAWS; k++) {
      struct vec wo = draw_wo(&draw, k), wi = draw_wo(&draw, k / 2);
      double f[3], adjoint[3], u[3];
      struct bsdf_sample s;
      draw_three(&draw, u);
      bool sampled = bsdf_sample(&bsdf, wo, u, TRANSPORT_RADIANCE, &s);
      if (k % 4 && sampled) wi = s.wi;
      bsdf_value(&bsdf, wo, wi, TRANSPORT_RADIANCE, f);
      bsdf_value(&bsdf, wi, wo, TRANSPORT_IMPORTANCE, adjoint);
      for (int c = 0; c < 3; c++)
        if (!(fabs(f[c] - adjoint[c]) <= 1e-10 * f[c] + 1e-8))
          fail_msg("%s: %.15g and %.15g", material_cases[i].text, f[c], adjoint[c]);
      if (wi.x != s.wi.x || !sampled) continue;
      bsdf_value(&bsdf, wo, wi, TRANSPORT_IMPORTANCE, adjoint);
      for (int c = 0; c < 3; c++)
        assert_true(fabs(f[c] * s.eta2 - adjoint[c]) <= 1e-11 * adjoint[c]);
    }
  }
}

// A delta lobe and its way back: what refraction does to radiance is eta2, and undone.
static void delta_lobes_are_adjoint(void **state) {
  (void)state;
  struct draw draw = draw_named("delta_lobes_are_adjoint");
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    if (!(material_of(&scene)->needs & MATERIAL_DELTA) || material_is_random(&scene)) continue;
    for (int k = 0; k < N_DRAWS; k++) {
      struct vec wo = draw_direction(&draw);
      struct bsdf_sample radiance, importance;
      double u[3];
      draw_three(&draw, u);
      if (!bsdf_sample(&bsdf, wo, u, TRANSPORT_RADIANCE, &radiance) || radiance.pdf > 0) continue;
      assert_true(bsdf_sample(&bsdf, wo, u, TRANSPORT_IMPORTANCE, &importance));
      assert_true(vec_length(vec_sub(radiance.wi, importance.wi)) == 0);
      for (int c = 0; c < 3; c++)
        assert_true(fabs(radiance.weight[c] * radiance.eta2 - importance.weight[c]) <= 1e-14);
      // Refraction bends towards the normal by eta: sin_o = eta sin_i.
      double so2 = wo.x * wo.x + wo.y * wo.y,
             si2 = radiance.wi.x * radiance.wi.x + radiance.wi.y * radiance.wi.y;
      assert_true(fabs(so2 - radiance.eta2 * si2) <= 1e-13 * (1 + radiance.eta2));
    }
  }
}

// From anywhere to anywhere, however grazing: finite, not negative.
static void values_are_finite_and_not_negative(void **state) {
  (void)state;
  struct draw draw = draw_named("values_are_finite_and_not_negative");
  for (int i = 0; i < N_MATERIAL_CASES; i++) {
    struct scene scene = material_scene(i);
    struct bsdf bsdf = material_bsdf(&scene, 0.385);
    for (int k = 0; k < N_DRAWS; k++) {
      struct vec wo = draw_direction(&draw), wi = draw_direction(&draw);
      wo = vec_normalize(vec(wo.x, wo.y, wo.z * exp(draw_between(&draw, -30, 0))));
      if (k % 2) wi = vec_normalize(vec(wi.x, wi.y, wi.z * exp(draw_between(&draw, -30, 0))));
      if (k % 3 == 0) wi = vec(-wo.x, -wo.y, k % 2 ? wo.z : -wo.z);
      for (int t = 0; t < 2; t++) {
        double f[3], pdf = bsdf_pdf(&bsdf, wo, wi, transports[t]);
        bsdf_value(&bsdf, wo, wi, transports[t], f);
        assert_true(pdf >= 0 && isfinite(pdf));
        for (int c = 0; c < 3; c++) assert_true(f[c] >= 0 && isfinite(f[c]));
      }
    }
  }
}

// To the bit. pbrt-v4 keeps textured reflectances below 1 (conductors: 0.9999).
static void textures_give_what_constants_give(void **state) {
  (void)state;
  static const char *const pairs[][2] = {
      {"'diffuse' 'texture reflectance' 'red'", "'diffuse' 'rgb reflectance' [.7 .2 .1]"},
      {"'diffuse' 'texture reflectance' 'bright'", "'diffuse' 'rgb reflectance' [1 1 .5]"},
      {"'diffusetransmission' 'texture reflectance' 'red' 'texture transmittance' 'bright'",
       "'diffusetransmission' 'rgb reflectance' [.7 .2 .1] 'rgb transmittance' [1 1 .5]"},
      {"'diffusetransmission' 'texture reflectance' 'bright' 'float scale' .5",
       "'diffusetransmission' 'rgb reflectance' [1 .5 .25] 'rgb transmittance' [.125 .125 .125]"},
      {"'conductor' 'texture reflectance' 'bright' 'texture roughness' 'fine'",
       "'conductor' 'rgb reflectance' [.9999 .9999 .5] 'float roughness' .05"},
      {"'conductor' 'texture eta' 'red' 'texture uroughness' 'fine' 'texture vroughness' 'coarse'",
       "'conductor' 'rgb eta' [.7 .2 .1] 'spectrum k' 'metal-Cu-k' 'float uroughness' .05 "
       "'float vroughness' .6"},
      {"'conductor' 'texture roughness' 'none'",
       "'conductor' 'spectrum eta' 'metal-Cu-eta' 'bool remaproughness' false"},
      {"'dielectric' 'texture roughness' 'coarse' 'texture vroughness' 'fine'",
       "'dielectric' 'float uroughness' .6 'float vroughness' .05"},
      {"'dielectric' 'texture roughness' 'none'", "'dielectric' 'float eta' 1.5"},
  };
  struct draw draw = draw_named("textures_give_what_constants_give");
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
    struct scene scene = material_scene_of(pairs[i][0]);
    unsigned needs = material_of(&scene)->needs;
    struct bsdf textured = material_bsdf(&scene, 0.385);
    scene = material_scene_of(pairs[i][1]);
    struct bsdf constant = material_bsdf(&scene, 0.385);
    assert_true(needs & MATERIAL_DETAIL);
    for (int k = 0; k < 100; k++) {
      struct vec wo = draw_direction(&draw), wi = draw_direction(&draw);
      struct bsdf_sample s[2];
      double f[2][3], u[3];
      draw_three(&draw, u);
      bsdf_value(&textured, wo, wi, TRANSPORT_RADIANCE, f[0]);
      bsdf_value(&constant, wo, wi, TRANSPORT_RADIANCE, f[1]);
      assert_memory_equal(f[0], f[1], sizeof f[0]);
      bool sampled = bsdf_sample(&textured, wo, u, TRANSPORT_RADIANCE, &s[0]);
      assert_int_equal(sampled, bsdf_sample(&constant, wo, u, TRANSPORT_RADIANCE, &s[1]));
      if (sampled) assert_memory_equal(&s[0], &s[1], sizeof s[0]);
      double delta = bsdf_delta_probability(&textured, wo, TRANSPORT_RADIANCE);
      assert_true(delta == bsdf_delta_probability(&constant, wo, TRANSPORT_RADIANCE));
      assert_true(delta == 0 || needs & MATERIAL_DELTA);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_registered_material_is_a_case),
      cmocka_unit_test(gray_and_black_are_what_is_scattered),
      cmocka_unit_test(samples_agree_with_value_and_pdf),
      cmocka_unit_test(value_is_adjoint),
      cmocka_unit_test(delta_lobes_are_adjoint),
      cmocka_unit_test(values_are_finite_and_not_negative),
      cmocka_unit_test(textures_give_what_constants_give),
  };
  return cmocka_run_group_tests_name("bsdf", tests, NULL, NULL);
}
