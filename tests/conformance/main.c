// conformance [--full] [--images] [--scene NAME]: this program's images against pbrt-v4's stored
// ones. Without --full a glance of a few seconds, as `make test` wants it. The folders are the
// environment's CONFORMANCE, SCENES and OUTPUT; one that does not exist is skipped.
#define _GNU_SOURCE // access, mkdir
#include "tests/conformance/parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char no_media[] = "MakeNamedMedium is not in this version";

const struct conformance_scene conformance_scenes[] = {
    {"c01-cornell-diffuse", "closed box, area light, two rotated blocks", NULL},
    {"c02-shapes-point-spot", "sphere, disk, cylinder; point and spot lights", NULL},
    {"c03-distant-infinite", "distant light and constant environment", NULL},
    {"c04-glass-mirror", "smooth glass and smooth conductor", NULL},
    {"c05-rough", "rough conductors (anisotropic too) and rough glass", NULL},
    {"c06-coated-transmitting", "coated diffuse, diffuse transmission, thin dielectric, mix", NULL},
    {"c07-textures", "checkerboard, image texture, texture scale", NULL},
    {"c08-lens", "thin lens", NULL},
    {"c09-motion", "motion blur", NULL},
    {"c10-fog", "fog around everything", no_media},
    {"c11-media-in-shapes", "media inside shapes, interface, medium inside glass", no_media},
    {"c12-instances", "Include, instances, transforms, bilinear patch", NULL},
    {"c13-environment", "image environment", NULL},
    {"c14-light-units", "scale, power, twosided, blackbody", NULL},
    {"c15-ortho", "orthographic, screen window, non-square", NULL},
    {NULL, NULL, NULL},
};

bool selected(const struct options *options, const char *name) {
  return !options->only || strstr(name, options->only);
}

void refused(struct report *report, const char *name, const char *refusal,
             const struct problem *problem) {
  bool expected = refusal && strstr(problem->text, refusal);
  report_line(report, expected ? PASSED : FAILED, "%-24s %s%s", name,
              expected ? "refused as it should be: " : "", problem->text);
}

static const char *folder(const char *variable, const char *fallback) {
  const char *said = getenv(variable);
  return said && *said ? said : fallback;
}

static bool options_read(int argc, char **argv, struct options *options) {
  *options = (struct options){.conformance = folder("CONFORMANCE", "../shared/conformance"),
                              .scenes = folder("SCENES", "../shared/scenes"),
                              .output = folder("OUTPUT", NULL)};
  for (int a = 1; a < argc; a++) {
    if (!strcmp(argv[a], "--full"))
      options->full = true;
    else if (!strcmp(argv[a], "--images"))
      options->always_pictures = true;
    else if (!strcmp(argv[a], "--scene") && a + 1 < argc)
      options->only = argv[++a];
    else
      return false;
  }
  if (options->always_pictures && !options->output) options->output = "build/conformance";
  if (options->output) mkdir(options->output, 0777);
  return true;
}

int main(int argc, char **argv) {
  struct options options;
  if (!options_read(argc, argv, &options)) {
    fprintf(stderr, "usage: conformance [--full] [--images] [--scene NAME]\n");
    return 2;
  }
  const char *output = getenv("CMOCKA_MESSAGE_OUTPUT");
  struct report report = {.tap = output && !strcmp(output, "TAP")};
  struct path_result result[sizeof conformance_scenes / sizeof *conformance_scenes] = {{0}};
  if (access(options.conformance, R_OK) == 0) {
    paths_check(&options, &report, result);
    photons_check(&options, &report, result);
  } else
    report_line(&report, SKIPPED, "there is no %s", options.conformance);
  if (access(options.scenes, R_OK) == 0)
    others_check(&options, &report);
  else
    report_line(&report, SKIPPED, "there is no %s", options.scenes);
  return report_end(&report);
}
