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

// pbrt-v4's LayeredBxDF::f weighs the second of its two ways through a rough coat with the density
// of sampling wi from w instead of w from wi. For eta 1.5 and alpha 0.1^(1/2) that is 5.5 % too
// much for light along the normal, 7 % at 36 degrees, 12.5 % at 72 degrees; in c06 it is seen on
// the sphere at the left. (Its Sample_f is right, so no BSDF renders as pbrt-v4 does.) A copy with
// its value agrees in all blocks: tests/conformance/pbrt-coat.
static const struct doubt coat = {{11, 40, 16, 18}, 0.111};

const struct conformance_scene conformance_scenes[] = {
    {.name = "c01-cornell-diffuse", .about = "closed box, area light, two rotated blocks"},
    {.name = "c02-shapes-point-spot", .about = "sphere, disk, cylinder; point and spot lights"},
    {.name = "c03-distant-infinite", .about = "distant light and constant environment"},
    {.name = "c04-glass-mirror", .about = "smooth glass and smooth conductor"},
    {.name = "c05-rough", .about = "rough conductors (anisotropic too) and rough glass"},
    {.name = "c06-coated-transmitting",
     .about = "coated diffuse, diffuse transmission, thin dielectric, mix",
     .doubt = &coat},
    {.name = "c07-textures", .about = "checkerboard, image texture, texture scale"},
    {.name = "c08-lens", .about = "thin lens"},
    {.name = "c09-motion", .about = "motion blur"},
    {.name = "c10-fog", .about = "fog around everything", .fog = true},
    {.name = "c11-media-in-shapes", .about = "media inside shapes, interface, medium inside glass"},
    {.name = "c12-instances", .about = "Include, instances, transforms, bilinear patch"},
    {.name = "c13-environment", .about = "image environment"},
    {.name = "c14-light-units", .about = "scale, power, twosided, blackbody"},
    {.name = "c15-ortho", .about = "orthographic, screen window, non-square"},
    {0},
};

bool selected(const struct options *options, const char *name) {
  return !options->only || strstr(name, options->only);
}

void refused(struct report *report, const char *name, const struct problem *problem) {
  report_line(report, FAILED, "%-24s %s", name, problem->text);
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
  bool conformance = access(options.conformance, R_OK) == 0;
  if (conformance)
    paths_check(&options, &report);
  else
    report_line(&report, SKIPPED, "there is no %s", options.conformance);
  agree_check(&options, &report, conformance);
  if (access(options.scenes, R_OK) == 0)
    others_check(&options, &report);
  else
    report_line(&report, SKIPPED, "there is no %s", options.scenes);
  return report_end(&report);
}
