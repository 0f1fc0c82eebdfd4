// The vector body that samples Lambertian facets against the material's own, bit for bit, at every
// SIMD level and for every length.
#include "scene/reader.h"
#include "walk/facets_level.h"

#include "tests/unit/scene_text.h"

static struct scene scene;

static void a_block_is_what_the_material_samples_at_every_level(void **state) {
  (void)state;
  struct bsdf bsdf = *scene.shape[0].bsdf;
  assert_true(bsdf.type->lambert);
  static uint64_t path[3 * FACETS];
  static double u[4][3 * FACETS];
  for (int j = 0; j < 3 * FACETS; j++) path[j] = (uint64_t)j;
  for (int level = 0; level <= (int)simd_best(); level++) {
    simd_choose((enum simd)level);
    for (int n = 0; n <= FACETS; n++) {
      static struct facets facets;
      struct vec d[FACETS], ng[FACETS];
      for (uint32_t pair = 0; pair < 2; pair++)
        rng_fill(rng_key(rng_hash_name(__func__), (uint64_t)n, RNG_TEST), 1, path, 3 * FACETS, pair,
                 u[2 * pair], u[2 * pair + 1]);
      for (int j = 0; j < n; j++) {
        d[j] = vec_normalize(vec(u[0][j] - 0.5, u[1][j] - 0.5, u[2][j] - 0.5));
        ng[j] = vec_normalize(vec(u[0][FACETS + j] - 0.5, u[1][FACETS + j] - 0.5, u[2][j] - 0.5));
        if (j % 5 == 0) ng[j] = vec(0, 0, j % 2 ? 1 : -1);         // the basis' poles
        if (j % 7 == 0) d[j] = vec(0, 1, 0), ng[j] = vec(1, 0, 0); // along the surface
        facets.d[0][j] = d[j].x, facets.d[1][j] = d[j].y, facets.d[2][j] = d[j].z;
        facets.n[0][j] = ng[j].x, facets.n[1][j] = ng[j].y, facets.n[2][j] = ng[j].z;
        facets.u[0][j] = j % 11 == 0 ? 0 : u[0][2 * FACETS + j];
        facets.u[1][j] = j % 3 == 0 ? (j % 16) / 16.0 : u[1][2 * FACETS + j]; // octants' ends
      }
      SIMD_TABLE(facets_level)->sample(&facets, n);
      for (int j = 0; j < n; j++) {
        struct bsdf_sample want;
        bsdf.n = bsdf.ng = ng[j];
        vec_basis(bsdf.n, &bsdf.s, &bsdf.t);
        double of[3] = {facets.u[0][j], facets.u[1][j], 0.5};
        bool met = bsdf_sample(&bsdf, vec_scale(d[j], -1), of, TRANSPORT_IMPORTANCE, &want);
        assert_int_equal(met, facets.cosine[j] != 0);
        if (!met) continue;
        assert_true(facets.wi[0][j] == want.wi.x && facets.wi[1][j] == want.wi.y &&
                    facets.wi[2][j] == want.wi.z && facets.pdf[j] == want.pdf);
      }
    }
  }
}

// A point whose normal or reflectance is not its shape's has no constant.
static void constants_are_only_where_nothing_varies(void **state) {
  (void)state;
  assert_true(scene.shape[0].faceted && scene.shape[0].bsdf);
  assert_true(scene.shape[1].faceted && !scene.shape[1].bsdf); // textured
  assert_true(!scene.shape[2].faceted && scene.shape[2].bsdf); // sphere
  assert_false(scene.shape[3].faceted);                        // normals of vertices
  assert_false(scene.shape[4].faceted);                        // moves
  for (int s = 0; s < 5; s++) assert_int_equal(scene.shape[s].lambert, s == 0);
  struct vec n = scene.facet[scene.shape[0].first];
  assert_true(n.x == 0 && n.y == 0 && n.z == -1); // ReverseOrientation
}

int main(void) {
  static const char text[] =
      "WorldBegin\n"
      "Texture \"checks\" \"spectrum\" \"checkerboard\"\n"
      "ReverseOrientation\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
      "ReverseOrientation\n"
      "Material \"diffuse\" \"texture reflectance\" \"checks\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 1 1 0 1 0 1 1]\n"
      "Material \"diffuse\"\n"
      "Shape \"sphere\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 2 1 0 2 0 1 2] \"normal N\" [0 0 1 0 1 1 0 0 1]\n"
      "ActiveTransform EndTime Translate 0 0 1 ActiveTransform All\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 3 1 0 3 0 1 3]\n";
  scene = scene_of(text);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_block_is_what_the_material_samples_at_every_level),
      cmocka_unit_test(constants_are_only_where_nothing_varies),
  };
  return cmocka_run_group_tests_name("facets", tests, NULL, NULL);
}
