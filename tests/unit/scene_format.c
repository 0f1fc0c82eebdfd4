// Directives that give, save and name: defaults, coordinate systems, two matrices, objects,
// options.
#include "scene_text.h"

#define W "WorldBegin LightSource \"point\"\n"
#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0]\n"
#define SPHERE "Shape \"sphere\"\n"

static void assert_position(const struct scene *scene, uint32_t row, double x, double y, double z) {
  const float *p = scene->position[row];
  if (p[0] != (float)x || p[1] != (float)y || p[2] != (float)z)
    fail_msg("vertex %u is %g %g %g", row, (double)p[0], (double)p[1], (double)p[2]);
}

static double reflectance_of(const struct scene *scene, uint32_t shape) {
  struct vec n = vec(0, 0, 1);
  struct surface surface = {.shape = shape, .ng = n, .ns = n};
  struct bsdf bsdf;
  surface_bsdf(scene, &surface, 0.5, &bsdf);
  double f[3];
  bsdf_value(&bsdf, n, n, TRANSPORT_RADIANCE, f);
  return f[0] * acos(-1.0);
}

// ---- Attribute ----

static void a_default_is_used_until_the_attribute_end_and_what_is_given_wins(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "AttributeBegin Attribute \"shape\" \"float radius\" 2.385\n" SPHERE
                 "Shape \"sphere\" \"float radius\" 0.75 Attribute \"shape\" \"float radius\" 3.5\n"
                 "Shape \"disk\" AttributeEnd\n" SPHERE);
  static const double wanted[] = {2.385, 0.75, 3.5, 1};
  for (int k = 0; k < 4; k++) assert_true(scene.quadric[k].radius == wanted[k]);
}

static void a_default_that_is_unread_or_of_another_type_is_no_error(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "Attribute \"shape\" \"float innerradius\" 0.125 "
                 "\"point3 radius\" [1 2 3] \"string colour\" \"red\"\n" SPHERE "Shape \"disk\"");
  assert_true(scene.quadric[0].radius == 1);
  assert_true(scene.quadric[1].inner_radius == 0.125);
}

static void materials_and_lights_have_defaults_too(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Attribute \"material\" \"rgb reflectance\" [.25 .25 .25]\n"
               "Attribute \"light\" \"float scale\" 3 \"rgb I\" [2 2 2] \"rgb L\" [2 2 2]\n"
               "WorldBegin Attribute \"light\" \"rgb I\" [5 5 5] LightSource \"point\"\n"
               "AreaLightSource \"diffuse\" Material \"diffuse\"\n" TRIANGLE);
  assert_true(fabs(reflectance_of(&scene, 0) - 0.25) <= 1e-15);
  assert_true(fabs(scene.light[0].power[0] - 4 * acos(-1.0) * 15) <= 1e-12);
  assert_true(fabs(scene.light[1].power[0] - acos(-1.0) * 6 * 0.5) <= 1e-12);
}

static void an_area_lights_defaults_are_those_at_its_directive(void **state) {
  (void)state;
  struct scene scene =
      scene_of("WorldBegin AttributeBegin Attribute \"light\" \"float scale\" 3\n"
               "AreaLightSource \"diffuse\" Attribute \"light\" \"float scale\" 7\n" TRIANGLE
               "AttributeEnd\n");
  assert_true(fabs(scene.light[0].power[0] - acos(-1.0) * 3 * 0.5) <= 1e-12);
}

// ---- transformations ----

static void a_named_coordinate_system_is_what_it_was_when_named(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "Translate 2 0 0 CoordinateSystem \"a\" AttributeBegin Scale 3 3 3 "
                 "CoordinateSystem \"b\" AttributeEnd Identity CoordSysTransform \"b\"\n" TRIANGLE
                 "CoordSysTransform \"a\"\n" TRIANGLE "CoordinateSystem \"b\" Identity\n"
                 "CoordSysTransform \"b\"\n" TRIANGLE "CoordSysTransform \"world\"\n" TRIANGLE);
  assert_position(&scene, 1, 5, 0, 0);
  assert_position(&scene, 4, 3, 0, 0);
  assert_position(&scene, 7, 3, 0, 0);
  assert_position(&scene, 10, 1, 0, 0);
}

// pbrt's "camera" is world from camera: what stands at the origin of it is where the camera is.
static void the_cameras_coordinate_system_has_a_name(void **state) {
  (void)state;
  struct scene scene = scene_of("Translate 1 -2 3 Camera \"perspective\"\n" W
                                "CoordSysTransform \"camera\"\n" TRIANGLE);
  assert_position(&scene, 0, -1, 2, -3);
}

static void only_active_matrices_change(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime\n"
                 "Translate 1 0 0 ActiveTransform All Scale 2 2 2\n" TRIANGLE
                 "AttributeBegin ActiveTransform EndTime AttributeEnd Identity\n" TRIANGLE
                 "ActiveTransform EndTime Translate 7 0 0 CoordSysTransform \"world\"\n" TRIANGLE);
  assert_position(&scene, 1, 3, 0, 0);
  assert_position(&scene, 4, 1, 0, 0);
  assert_position(&scene, 7, 1, 0, 0);
}

// As pbrt: lights do not move, they stay where the motion starts.
static void a_light_is_where_its_motion_starts(void **state) {
  (void)state;
  struct scene scene =
      scene_of("WorldBegin AttributeBegin ActiveTransform EndTime Translate 5 0 0\n"
               "LightSource \"point\" AttributeEnd\n" TRIANGLE);
  struct light_sample sample;
  const double u[2] = {0.5, 0.5};
  const struct light *light = &scene.light[0];
  assert_true(light->type->sample(&scene, light, vec(0, 0, 2), u, &sample));
  assert_true(sample.distance == 2);
}

static void world_begin_makes_both_matrices_active(void **state) {
  (void)state;
  struct scene scene = scene_of("ActiveTransform EndTime\n" W "Translate 3 0 0\n" TRIANGLE);
  assert_position(&scene, 0, 3, 0, 0);
}

// To pbrt-v4 TransformBegin is AttributeBegin: the material is restored too.
static void transform_begin_is_attribute_begin(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "TransformBegin Translate 9 0 0 Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                 "AttributeEnd AttributeBegin TransformEnd\n" TRIANGLE);
  assert_position(&scene, 0, 0, 0, 0);
  assert_true(fabs(reflectance_of(&scene, 0) - 0.5) <= 1e-15);
}

// ---- objects ----

static void an_instance_is_its_matrix_times_that_of_the_definition(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "Translate 1 0 0 ObjectBegin \"a\" Scale 2 2 2\n" TRIANGLE "ObjectEnd\n"
                 "AttributeBegin Scale 10 10 10 ObjectInstance \"a\" AttributeEnd\n"
                 "ObjectInstance \"a\" Identity\n" TRIANGLE);
  assert_int_equal(scene.n_shapes, 3);
  assert_position(&scene, 0, 0, 0, 0); // instances come last
  // (1 0 0) -> definition: translate, scale -> (3 0 0); first use: translate, scale by 10.
  assert_position(&scene, 4, 31, 0, 0);
  assert_position(&scene, 7, 4, 0, 0);
}

static void a_definition_has_its_own_attributes_and_costs_nothing_unused(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "ObjectBegin \"a\" Material \"diffuse\" \"rgb reflectance\" [.25 .25 .25]\n"
                 "Attribute \"shape\" \"float radius\" 2 " SPHERE "ObjectEnd\n"
                 "ObjectBegin \"unused\"\n" TRIANGLE SPHERE "ObjectEnd\n"
                 "Material \"diffuse\" \"rgb reflectance\" [.75 .75 .75]\n"
                 "ObjectInstance \"a\"\n");
  assert_int_equal(scene.n_shapes, 1);
  assert_int_equal(scene.n_positions, 0);
  assert_true(scene.quadric[0].radius == 2);
  assert_true(fabs(reflectance_of(&scene, 0) - 0.25) <= 1e-15);
}

static void an_object_may_be_defined_after_its_use(void **state) {
  (void)state;
  struct scene scene = scene_of(W "ObjectInstance \"b\" ObjectBegin \"a\"\n" SPHERE
                                  "ObjectEnd ObjectBegin \"b\"\n" TRIANGLE TRIANGLE "ObjectEnd\n");
  assert_int_equal(scene.n_shapes, 2);
  assert_int_equal(scene.n_triangles, 2);
}

// pbrt maps an instance's normals like vectors perpendicular to the surface: a mirror turns none of
// them over, whatever made them.
static void a_mirrored_instance_turns_no_normal_over(void **state) {
  (void)state;
  struct scene scene = scene_of(W "ObjectBegin \"a\" Shape \"disk\"\n" TRIANGLE
                                  "ObjectEnd Scale -1 1 1 ObjectInstance \"a\" Identity\n"
                                  "Scale 1 1 -1 ObjectInstance \"a\"\n");
  for (uint32_t k = 0; k < 4; k++) {
    const struct shape *shape = &scene.shape[k];
    struct vec n = shape->type->normal(&scene, shape, shape->first, vec(0, 0, 0));
    assert_true(n.x == 0 && n.y == 0 && n.z == (k < 2 ? 1 : -1));
  }
}

// ---- materials, media ----

static void a_named_material_may_be_made_after_its_use(void **state) {
  (void)state;
  struct scene scene =
      scene_of(W "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                 "AttributeBegin NamedMaterial \"b\"\n" SPHERE "NamedMaterial \"a\"\n" SPHERE
                 "Attribute \"material\" \"rgb reflectance\" [.25 .25 .25]\n"
                 "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" AttributeEnd\n" SPHERE
                 "NamedMaterial \"b\"\n" SPHERE);
  static const double wanted[] = {0.25, 0, 0.5, 0.25};
  for (uint32_t k = 0; k < 4; k++)
    assert_true(fabs(reflectance_of(&scene, k) - wanted[k]) <= 1e-15);
}

static void alpha_belongs_to_any_shape(void **state) {
  (void)state;
  struct scene scene = scene_of(
      W "Shape \"sphere\" \"float alpha\" .375 Attribute \"shape\" \"float alpha\" -.5\n" SPHERE
        "Attribute \"shape\" \"float alpha\" 1.5\n" TRIANGLE);
  assert_true(scene.shape[0].alpha->value[0] == 0.375 && scene.shape[0].see_through);
  assert_true(scene.shape[1].alpha->value[0] == 0);
  assert_true(!scene.shape[2].alpha && !scene.shape[2].see_through);
}

static void media_that_nothing_is_in_are_accepted(void **state) {
  (void)state;
  scene_of("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3]\n" W
           "MediumInterface \"fog\" \"fog\"\n" SPHERE
           "MediumInterface \"fog\" MediumInterface \"\"\n"
           "LightSource \"point\"\n" SPHERE);
}

// ---- Option, Accelerator ----

static void options_that_cannot_change_the_image_are_accepted(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Option \"disablewavelengthjitter\" true Option \"pixel-stats\" [\"true\"]\n"
               "Option \"bool disable_texture_filtering\" false Option \"forceDiffuse\" false\n"
               "Option \"displacementedgescale\" 2.5 Option \"msereferenceimage\" \"a.exr\"\n"
               "Option \"string rendercoordsys\" \"world\" Option \"wavefront\" false\n"
               "Accelerator \"kdtree\" \"integer maxprims\" 7\n" W TRIANGLE);
  assert_false(scene.settings.centre);
  assert_true(scene.settings.seed == -1);
}

static void options_that_change_the_image_are_honoured(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Option \"disablepixeljitter\" true Option \"seed\" 17\n" W TRIANGLE);
  assert_true(scene.settings.centre && scene.settings.seed == 17);
  scene =
      scene_of("Option \"disablepixeljitter\" true Camera \"perspective\" \"float lensradius\" .5 "
               "\"float shutterclose\" .25\n" W TRIANGLE);
  assert_true(scene.camera.lens_radius == 0 && scene.camera.shutter_open == 0.125);
  assert_true(scene.camera.shutter_close == 0.125 && scene.settings.exposure == 0.25);
  scene = scene_of("Option \"seed\" 17 Sampler \"halton\" \"integer seed\" 4\n" W TRIANGLE);
  assert_true(scene.settings.seed == 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_default_is_used_until_the_attribute_end_and_what_is_given_wins),
      cmocka_unit_test(a_default_that_is_unread_or_of_another_type_is_no_error),
      cmocka_unit_test(materials_and_lights_have_defaults_too),
      cmocka_unit_test(an_area_lights_defaults_are_those_at_its_directive),
      cmocka_unit_test(a_named_coordinate_system_is_what_it_was_when_named),
      cmocka_unit_test(the_cameras_coordinate_system_has_a_name),
      cmocka_unit_test(only_active_matrices_change),
      cmocka_unit_test(a_light_is_where_its_motion_starts),
      cmocka_unit_test(world_begin_makes_both_matrices_active),
      cmocka_unit_test(transform_begin_is_attribute_begin),
      cmocka_unit_test(an_instance_is_its_matrix_times_that_of_the_definition),
      cmocka_unit_test(a_definition_has_its_own_attributes_and_costs_nothing_unused),
      cmocka_unit_test(an_object_may_be_defined_after_its_use),
      cmocka_unit_test(a_mirrored_instance_turns_no_normal_over),
      cmocka_unit_test(a_named_material_may_be_made_after_its_use),
      cmocka_unit_test(alpha_belongs_to_any_shape),
      cmocka_unit_test(media_that_nothing_is_in_are_accepted),
      cmocka_unit_test(options_that_cannot_change_the_image_are_accepted),
      cmocka_unit_test(options_that_change_the_image_are_honoured),
  };
  return cmocka_run_group_tests_name("scene_format", tests, NULL, NULL);
}
