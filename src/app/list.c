// photonlab list, info, validate: what is registered, what a scene holds, whether the tables are
// right.
#include "analysis/fit_methods.h"
#include "app/cli.h"
#include "app/stability.h"
#include "app/validate.h"
#include "base/file.h"
#include "pbrt/suggest.h"
#include "scene/info.h"
#include "spectrum/spectrum.h"
#include "walk/light_path.h"

#include <stdio.h>
#include <string.h>

static void list_laws(void) {
  for (int k = 0; k < n_laws; k++)
    printf("  %-15s %s\n  %15s   rho_i %s-> %s, %.6f at alpha = 2/3\n  %15s   %s\n", laws[k].name,
           laws[k].formula, "", laws[k].measure_exponent(0) > 0 ? "i^(1 - alpha) " : "",
           laws[k].constant_formula, laws[k].constant(2.0 / 3), "", laws[k].source);
}

static void list_kernels(void) {
  for (int k = 0; k < n_kernels; k++) {
    struct kernel_constants c = kernels[k].constants(2);
    printf("  %-15s %-42s in the plane: c %.6f, mu2 %.6f, R %.6f\n  %15s   %s\n", kernels[k].name,
           kernels[k].formula, c.c, c.mu2, c.roughness, "", kernels[k].source);
  }
}

static void list_reference_radii(void) {
  for (int k = 0; k < n_reference_radii; k++)
    printf("  %-18s %s\n  %18s   %s\n", reference_radii[k].name, reference_radii[k].about, "",
           reference_radii[k].source);
}

static void list_integrators(void) {
  for (int k = 0; integrator_types[k]; k++)
    printf("  %-15s %s\n  %15s   %s\n", integrator_types[k]->name, integrator_types[k]->about, "",
           integrator_types[k]->source);
}

static void list_shapes(void) {
  for (int k = 0; shape_types[k]; k++)
    printf("  %-15s %s\n", shape_types[k]->name, shape_types[k]->about);
}

static void list_materials(void) {
  for (int k = 0; material_types[k]; k++)
    printf("  %-15s %s\n", material_types[k]->name, material_types[k]->about);
}

static void list_lights(void) {
  for (int k = 0; light_types[k]; k++)
    printf("  %-15s %s\n", light_types[k]->name, light_types[k]->about);
}

static void list_media(void) {
  for (int k = 0; medium_types[k]; k++)
    printf("  %-15s %s\n", medium_types[k]->name, medium_types[k]->about);
}

static void list_presets(void) {
  for (int k = 0; k < n_medium_presets; k++) {
    const struct medium_preset *preset = &medium_presets[k];
    const double *a = preset->sigma_a, *s = preset->sigma_s;
    printf("  %-27s %11.5g %11.5g %11.5g  %11.5g %11.5g %11.5g\n", preset->name, a[0], a[1], a[2],
           s[0], s[1], s[2]);
  }
}

static void list_textures(void) {
  for (int k = 0; texture_types[k]; k++)
    printf("  %-15s %s\n", texture_types[k]->name, texture_types[k]->about);
}

static void list_spectra(void) {
  static const char *const kinds[] = {[NAMED_ILLUMINANT] = "light, at luminance 1",
                                      [NAMED_METAL] = "index of a metal",
                                      [NAMED_GLASS] = "index of a glass, at 587.6 nm"};
  for (int k = 0; k < n_named_spectra; k++) {
    const struct named_spectrum *named = &named_spectra[k];
    printf("  %-15s %9.4f %9.4f %9.4f  %s\n", named->name, named->rgb[0], named->rgb[1],
           named->rgb[2], kinds[named->kind]);
  }
}

static void list_cameras(void) {
  for (int k = 0; camera_types[k]; k++)
    printf("  %-15s %s\n", camera_types[k]->name, camera_types[k]->about);
}

static void list_filters(void) {
  for (int k = 0; filter_types[k]; k++)
    printf("  %-15s %s\n", filter_types[k]->name, filter_types[k]->about);
}

static void list_views(void) {
  for (int k = 0; k < LIGHT_PATHS; k++)
    printf("  %-15s %s\n", light_paths[k].name, light_paths[k].about);
}

static void list_skips(void) {
  for (int k = 0; k < n_skip_rows; k++)
    printf("  %-15s %s\n", skip_rows[k].name, skip_rows[k].about);
}

static void list_fit_methods(void) {
  for (int k = 0; k < n_fit_methods; k++)
    printf("  %-15s %s\n", fit_methods[k].name, fit_methods[k].about);
}

static void list_experiment(void) {
  for (int k = 0; k < n_experiment_keys; k++)
    printf("  %-17s %-24s %s\n", experiment_keys[k].name, experiment_keys[k].fallback,
           experiment_keys[k].meaning);
}

static void list_log(void) {
  for (int k = 0; k < n_log_columns; k++)
    printf("  %-15s %-18s %s\n", log_columns[k].name, log_columns[k].unit, log_columns[k].meaning);
}

static const struct {
  const char *name, *about;
  void (*print)(void);
} lists[] = {
    {"integrators", "what one iteration computes", list_integrators},
    {"laws", "radius sequences, rho_i = r_i^d / r_1^d", list_laws},
    {"kernels", "psi / psi(0) on the unit ball; t = distance / radius", list_kernels},
    {"reference-radii", "what an experiment's radius counts in, at each point",
     list_reference_radii},
    {"shapes", "of scene files", list_shapes},
    {"materials", "of scene files", list_materials},
    {"lights", "of scene files", list_lights},
    {"media", "of scene files", list_media},
    {"presets", "of homogeneous media: sigma_a and sigma_s per mm, as linear sRGB", list_presets},
    {"textures", "of scene files", list_textures},
    {"spectra", "of scene files by name, as linear sRGB", list_spectra},
    {"cameras", "of scene files", list_cameras},
    {"filters", "of a pixel's samples, in scene files; radii in pixels", list_filters},
    {"views", "light paths: L light, S delta lobe, D any other scattering, E eye", list_views},
    {"skips", "what is left out where a scene does not need it", list_skips},
    {"fit-methods", "how rates are found", list_fit_methods},
    {"experiment", "keys of an experiment file: name, default, meaning", list_experiment},
    {"log", "columns of log.csv: name, unit, meaning", list_log},
};
enum { N_LISTS = sizeof lists / sizeof *lists };

static int list(struct cli *cli, struct problem *problem) {
  const char *names[N_LISTS];
  bool found = false;
  for (int k = 0; k < N_LISTS; k++) {
    names[k] = lists[k].name;
    if (cli->argument && strcmp(cli->argument, lists[k].name) != 0) continue;
    printf("%s: %s\n", lists[k].name, lists[k].about);
    lists[k].print();
    found = true;
  }
  if (found) return 0;
  const char *hint = suggest_name(cli->argument, names, N_LISTS);
  char *known = "";
  for (int k = 0; k < N_LISTS; k++)
    known = arena_format(cli->arena, "%s%s%s", known, k ? ", " : "", names[k]);
  problem_set(problem, "there is no list '%s'%s%s%s (there are: %s)", cli->argument,
              hint ? "; did you mean '" : "", hint ? hint : "", hint ? "'?" : "", known);
  return EXIT_USAGE;
}

static int info(struct cli *cli, struct problem *problem) {
  struct scene scene;
  struct scene_options options = {.lenient = cli->options.lenient, .notes = stderr};
  if (!scene_read_with(cli->argument, options, cli->arena, &scene, problem)) return 1;
  scene_info(&scene, stdout);
  return 0;
}

// Every level of every stress into -o, for the figure.
static int validate_stability(struct cli *cli, struct problem *problem) {
  if (!cli->output) return stability_run(stdout, NULL) ? 0 : 1;
  struct file_out out;
  if (!file_begin(&out, cli->output, problem)) return 1;
  bool ok = stability_run(stdout, out.stream);
  return file_commit(&out, problem) && ok ? 0 : 1;
}

static int validate(struct cli *cli, struct problem *problem) {
  if (cli->argument && strcmp(cli->argument, "stability") == 0)
    return validate_stability(cli, problem);
  if (!cli->argument && !cli->output) return validate_run(stdout) ? 0 : 1;
  problem_set(problem,
              cli->argument ? "there is only 'stability' to validate apart, not '%s'"
                            : "-o is for the levels of 'validate stability'%s",
              cli->argument ? cli->argument : "");
  return EXIT_USAGE;
}

const struct command command_list = {"list", "[WHAT]", "what is registered: laws, kernels, ...", "",
                                     list};

const struct command command_info = {
    "info", "SCENE", "what a scene holds and which features it lets us skip", "lenient", info};

const struct command command_validate = {
    "validate", "[stability]",
    "checks laws, kernels and functions against theory's values; or their errors under stress",
    "output", validate};
