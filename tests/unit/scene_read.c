#include "scene_text.h"

#include <float.h>
#include <glob.h>

#define HEAD "WorldBegin LightSource \"point\" "
#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0]\n"

// The normal in the first vertex of a shape's first primitive.
static struct vec normal_of(const struct scene *scene, uint32_t shape) {
  const struct shape *s = &scene->shape[shape];
  struct vec p, n;
  s->type->sample(scene, s, s->first, 0.25, 0.5, &p, &n);
  return n;
}

static void assert_vec(struct vec a, double x, double y, double z) {
  if (!(vec_length(vec_sub(a, vec(x, y, z))) <= 8 * DBL_EPSILON))
    fail_msg("(%.17g %.17g %.17g) is not (%g %g %g)", a.x, a.y, a.z, x, y, z);
}

static void every_scene_of_the_project_is_read_and_gray_but_for_the_balls(void **state) {
  (void)state;
  glob_t files;
  assert_int_equal(glob("scenes/*.pbrt", 0, NULL, &files), 0);
  for (size_t i = 0; i < files.gl_pathc; i++) {
    struct arena keep = test_memory()->keep;
    struct scene scene;
    struct problem problem = {{0}};
    if (!scene_read(files.gl_pathv[i], &keep, &scene, &problem)) fail_msg("%s", problem.text);
    assert_true(scene.n_primitives > 0 && scene.n_lights > 0 && scene.hash != 0);
    bool gray = !strstr(files.gl_pathv[i], "balls"); // made for pictures
    if (scene_features(&scene).gray != gray)
      fail_msg("%s is %sgray", files.gl_pathv[i], gray ? "not " : "");
  }
  globfree(&files);
}

// The box of pbrt's documentation: floor of two triangles, a light of radiance 8 and side 0.6.
static void a_cornell_box_becomes_arrays(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "LookAt 0 1 -3.4  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" [38]\n"
      "Film \"rgb\" \"integer xresolution\" [64] \"integer yresolution\" [48] "
      "\"string filename\" [\"a.pfm\"]\nSampler \"zsobol\" \"integer pixelsamples\" [512]\n"
      "Integrator \"volpath\" \"integer maxdepth\" [64]\nWorldBegin\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
      "[-1 0 -1 1 0 -1 1 0 1 -1 0 1]\nAttributeBegin\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
      "[-0.3 1.99 -0.3 0.3 1.99 -0.3 0.3 1.99 0.3 -0.3 1.99 0.3]\nAttributeEnd\n" TRIANGLE);
  assert_int_equal(scene.n_primitives, 5);
  assert_int_equal(scene.n_positions, 11);
  assert_int_equal(scene.n_lights, 1);
  assert_int_equal(scene.shape_of[1], 0);
  assert_int_equal(scene.shape_of[3], 1);
  assert_int_equal(scene.shape_of[4], 2);
  assert_int_equal(scene.triangle[3][0], 4);
  assert_int_equal(scene.shape[0].light, LIGHT_NONE);
  assert_int_equal(scene.shape[1].light, 0);
  assert_int_equal(scene.shape[2].light, LIGHT_NONE);
  assert_true(fabs(scene.light[0].power[1] - acos(-1.0) * 8 * 0.36) < 1e-6); // floats: 0.6 +- 6e-8
  assert_true(scene.bounds.lo[0] == -1 && scene.bounds.hi[1] == 1.99f && scene.bounds.hi[2] == 1);
  assert_string_equal(scene.settings.integrator, "path");
  assert_string_equal(scene.settings.filename, "a.pfm");
  assert_int_equal(scene.settings.max_depth, 64);
  assert_int_equal(scene.settings.spp, 512);
  assert_int_equal(scene.camera.height, 48);
}

static void what_the_file_does_not_say_has_pbrts_default(void **state) {
  (void)state;
  struct scene scene = scene_of(HEAD TRIANGLE);
  const struct scene_settings *settings = &scene.settings;
  assert_true(scene.camera.fov == 90);
  assert_int_equal(settings->max_depth, 5);
  assert_int_equal(settings->spp, 16);
  assert_null(settings->integrator);
  assert_null(settings->filename);
  assert_false(settings->centre);
  assert_true(isnan(settings->radius) && isnan(settings->alpha));
  assert_true(settings->photons == 0 && settings->iterations == 0 && settings->seed == -1);
  struct surface surface = {.ng = vec(0, 0, 1), .ns = vec(0, 0, 1)};
  struct bsdf bsdf;
  surface_bsdf(&scene, &surface, 0, &bsdf);
  double f[3];
  bsdf_value(&bsdf, vec(0, 0, 1), vec(0, 0, 1), TRANSPORT_RADIANCE, f);
  assert_true(fabs(f[0] - 0.5 / acos(-1.0)) <= DBL_EPSILON);
}

static void our_integrators_parameters_arrive(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "Integrator \"probabilistic\" \"integer maxdepth\" 7 \"float radius\" 0.125 \"float alpha\" "
      "0.75 "
      "\"integer photonsperiteration\" 4096 \"integer iterations\" 300 \"string kernel\" \"box\" "
      "\"string law\" \"knaus-zwicker\" \"string direct\" \"nee\" \"integer seed\" 99\n"
      "Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 1 \"bool jitter\" false "
      "\"integer seed\" 5\n" HEAD TRIANGLE);
  const struct scene_settings *settings = &scene.settings;
  assert_string_equal(settings->integrator, "probabilistic");
  assert_true(settings->radius == 0.125 && settings->alpha == 0.75);
  assert_true(settings->photons == 4096 && settings->iterations == 300 && settings->seed == 99);
  assert_true(settings->max_depth == 7 && settings->centre && settings->spp == 1);
  assert_string_equal(settings->kernel, "box");
  assert_string_equal(settings->law, "knaus-zwicker");
  assert_string_equal(settings->direct, "nee");
}

static void integrator_names_of_pbrt_mean_path_and_others_are_kept(void **state) {
  (void)state;
  assert_string_equal(scene_of("Integrator \"bdpt\"" HEAD TRIANGLE).settings.integrator, "path");
  assert_string_equal(scene_of("Integrator \"sppm\"" HEAD TRIANGLE).settings.integrator, "sppm");
  assert_string_equal(
      scene_of("Integrator \"ambientocclusion\" \"float maxdistance\" 3 " HEAD TRIANGLE)
          .settings.integrator,
      "ambientocclusion");
}

static void values_at_their_defaults_are_accepted(void **state) {
  (void)state;
  scene_of("Camera \"perspective\" \"float screenwindow\" [-2 2 -1 1] \"float lensradius\" 0 "
           "\"float focaldistance\" 3 \"float shutteropen\" 0 \"float frameaspectratio\" 2 "
           "Film \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 10 "
           "\"bool savefp16\" false ColorSpace \"srgb\" PixelFilter \"box\" \"float xradius\" .5 "
           "Integrator \"path\" \"bool regularize\" false \"string lightsampler\" \"bvh\" " HEAD
               TRIANGLE);
}

static void the_last_transform_acts_first_and_attribute_end_undoes(void **state) {
  (void)state;
  struct scene scene =
      scene_of(HEAD "Translate 10 0 0 AttributeBegin Scale 2 2 2 Rotate 90 0 0 1\n" TRIANGLE
                    "AttributeEnd\n" TRIANGLE "Identity\n" TRIANGLE);
  const float(*p)[3] = (const float(*)[3])scene.position;
  assert_true(p[1][0] == 10 && p[1][1] == 2 && p[1][2] == 0); // (1 0 0) turned, doubled, moved
  assert_true(p[4][0] == 11 && p[4][1] == 0);
  assert_true(p[7][0] == 1 && p[7][1] == 0);
}

static void world_begin_resets_the_matrix(void **state) {
  (void)state;
  struct scene scene = scene_of("Translate 5 5 5 " HEAD TRIANGLE);
  assert_true(scene.position[0][0] == 0);
}

static void transform_replaces_and_concat_transform_multiplies(void **state) {
  (void)state;
  struct scene scene =
      scene_of(HEAD "Translate 9 9 9 Transform [2 0 0 0 0 2 0 0 0 0 2 0 1 2 3 1]\n" TRIANGLE
                    "ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 10 0 0 1]\n" TRIANGLE);
  assert_true(scene.position[1][0] == 3 && scene.position[0][2] == 3);
  assert_true(scene.position[3][0] == 21);
}

static void attributes_hold_material_light_and_orientation(void **state) {
  (void)state;
  struct scene scene =
      scene_of("WorldBegin Material \"diffuse\" \"rgb reflectance\" [.25 .25 .25]\n" TRIANGLE
               "AttributeBegin ReverseOrientation AreaLightSource \"diffuse\" "
               "Material \"diffuse\" \"rgb reflectance\" [.5 .25 .25]\n" TRIANGLE TRIANGLE
               "AttributeEnd\n" TRIANGLE);
  assert_int_equal(scene.shape[0].material, scene.shape[3].material);
  assert_int_not_equal(scene.shape[0].material, scene.shape[1].material);
  assert_true(!scene.shape[0].flip && scene.shape[1].flip && !scene.shape[3].flip);
  assert_int_equal(scene.n_lights, 2); // one light a shape
  assert_int_equal(scene.shape[1].light, 0);
  assert_int_equal(scene.shape[2].light, 1);
  assert_int_equal(scene.shape[3].light, LIGHT_NONE);
  assert_false(scene_features(&scene).gray);
  assert_int_equal(scene_features(&scene).n_channels, 3);
}

static void an_unused_coloured_material_leaves_the_scene_gray(void **state) {
  (void)state;
  struct scene scene = scene_of(HEAD "Material \"diffuse\" \"rgb reflectance\" [.5 .25 .25]\n"
                                     "Material \"diffuse\"\n" TRIANGLE);
  assert_true(scene_features(&scene).gray);
}

// pbrt: (p0 - p2) x (p1 - p2) in world space, reversed by ReverseOrientation xor a mirrored matrix;
// quadrics' normals move with the map before that.
static void normals_point_where_pbrt_says(void **state) {
  (void)state;
  struct scene scene = scene_of(
      HEAD TRIANGLE "AttributeBegin ReverseOrientation\n" TRIANGLE
                    "AttributeEnd AttributeBegin Scale 1 1 -1\n" TRIANGLE
                    "Shape \"disk\" ReverseOrientation Shape \"disk\" AttributeEnd Shape \"disk\"\n"
                    "AttributeBegin Scale -1 1 1\n" TRIANGLE "AttributeEnd\n");
  assert_vec(normal_of(&scene, 0), 0, 0, 1);
  assert_vec(normal_of(&scene, 1), 0, 0, -1);
  assert_vec(normal_of(&scene, 2), 0, 0, -1); // same vertices, flipped
  assert_vec(normal_of(&scene, 3), 0, 0, 1);  // +z mirrored to -z, then flipped
  assert_vec(normal_of(&scene, 4), 0, 0, -1);
  assert_vec(normal_of(&scene, 5), 0, 0, 1);
  assert_vec(normal_of(&scene, 6), 0, 0, 1); // mirrored winding, flipped back
}

static void lights_are_chosen_in_proportion_to_their_mean_power(void **state) {
  (void)state;
  struct scene scene = scene_of("WorldBegin LightSource \"point\" \"rgb I\" [1 2 3]\n"
                                "LightSource \"point\" \"rgb I\" [0 0 0]\n"
                                "LightSource \"point\" \"rgb I\" [9 6 3]\n" TRIANGLE);
  static const double wanted[4] = {0, 0.25, 0.25, 1};
  for (int k = 0; k < 4; k++) assert_true(fabs(scene.light_cdf[k] - wanted[k]) <= DBL_EPSILON);
  assert_true(fabs(scene.light[2].probability - 0.75) <= DBL_EPSILON);
  assert_true(scene.light[1].probability == 0);
}

// The probabilities of these three, added up one by one, fall short of 1 by 2^-53; the dark light
// behind them must not get it.
static void a_dark_light_at_the_end_is_never_chosen(void **state) {
  (void)state;
  struct scene scene = scene_of("WorldBegin LightSource \"point\" \"rgb I\" [.1 .1 .1]\n"
                                "LightSource \"point\" \"rgb I\" [.4 .4 .4]\n"
                                "LightSource \"point\" \"rgb I\" [.1 .1 .1]\n"
                                "LightSource \"point\" \"rgb I\" [0 0 0]\n" TRIANGLE);
  assert_true(scene.light_cdf[3] == 1 && scene.light_cdf[4] == 1);
}

static void a_scene_without_light_is_read(void **state) {
  (void)state;
  assert_int_equal(scene_of("WorldBegin " TRIANGLE).n_lights, 0);
}

static void vertices_are_rounded_once_to_the_nearest_float(void **state) {
  (void)state;
  struct scene scene = scene_of(HEAD "Translate 0.1 0 0 Shape \"trianglemesh\" \"point3 P\" "
                                     "[0.2 0 0  1 16777217 0  0 1 0]");
  assert_true(scene.position[0][0] == (float)(0.2 + 0.1));
  assert_true(scene.position[1][1] == 16777216.0f);
}

static void a_triangle_without_area_is_kept_and_never_hit(void **state) {
  (void)state;
  struct scene scene = scene_of(HEAD "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  2 0 0]\n");
  const struct shape *shape = &scene.shape[0];
  assert_int_equal(scene.n_primitives, 1);
  assert_true(shape->type->area(&scene, shape, 0) == 0);
  struct ray ray = {vec(0.5, 0, -1), vec(0, 0, 1), INFINITY, PRIMITIVE_NONE};
  double t;
  assert_false(shape->type->intersect(&scene, shape, 0, &ray, &t));
}

// The same bytes, the same hash; one more byte, another.
static void the_hash_is_of_the_bytes(void **state) {
  (void)state;
  uint64_t a = scene_of(HEAD TRIANGLE).hash, b = scene_of(HEAD TRIANGLE "#").hash;
  assert_true(a == scene_of(HEAD TRIANGLE).hash);
  assert_true(a != b);
}

static void a_surface_is_the_hit_point_and_its_normal(void **state) {
  (void)state;
  struct scene scene = scene_of(HEAD TRIANGLE "Translate 0 0 5 Shape \"sphere\"");
  struct ray ray = {vec(0, 0, 2), vec(0, 0, 0.5), INFINITY, PRIMITIVE_NONE};
  double t;
  assert_true(scene.shape[1].type->intersect(&scene, &scene.shape[1], 1, &ray, &t));
  struct surface surface;
  scene_surface(&scene, &ray, (struct hit){t, 1}, &surface);
  assert_int_equal(surface.shape, 1);
  assert_int_equal(surface.primitive, 1);
  assert_vec(surface.p, 0, 0, 4);
  assert_vec(surface.ng, 0, 0, -1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_scene_of_the_project_is_read_and_gray_but_for_the_balls),
      cmocka_unit_test(a_cornell_box_becomes_arrays),
      cmocka_unit_test(what_the_file_does_not_say_has_pbrts_default),
      cmocka_unit_test(our_integrators_parameters_arrive),
      cmocka_unit_test(integrator_names_of_pbrt_mean_path_and_others_are_kept),
      cmocka_unit_test(values_at_their_defaults_are_accepted),
      cmocka_unit_test(the_last_transform_acts_first_and_attribute_end_undoes),
      cmocka_unit_test(world_begin_resets_the_matrix),
      cmocka_unit_test(transform_replaces_and_concat_transform_multiplies),
      cmocka_unit_test(attributes_hold_material_light_and_orientation),
      cmocka_unit_test(an_unused_coloured_material_leaves_the_scene_gray),
      cmocka_unit_test(normals_point_where_pbrt_says),
      cmocka_unit_test(lights_are_chosen_in_proportion_to_their_mean_power),
      cmocka_unit_test(a_dark_light_at_the_end_is_never_chosen),
      cmocka_unit_test(a_scene_without_light_is_read),
      cmocka_unit_test(vertices_are_rounded_once_to_the_nearest_float),
      cmocka_unit_test(a_triangle_without_area_is_kept_and_never_hit),
      cmocka_unit_test(the_hash_is_of_the_bytes),
      cmocka_unit_test(a_surface_is_the_hit_point_and_its_normal),
  };
  return cmocka_run_group_tests_name("scene_read", tests, NULL, NULL);
}
