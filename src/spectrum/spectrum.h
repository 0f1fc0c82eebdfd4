// What a pbrt-v4 spectrum becomes in a renderer that carries linear sRGB (Rec. 709 primaries, D65
// white, CIE 1931 2-degree observer). Three uses, three conversions:
//   illuminant   the sRGB of its chromaticity at luminance Y = 1, as pbrt-v4 normalises emission
//                that is not rgb; its default sensor adapts no white point. A colour that sRGB
//                does not hold has a negative channel, as in pbrt-v4's own images.
//   albedo,      the sRGB of what it reflects (or multiplies) of D65, so that one reflection of
//   unbounded    white light is exact; moved into [0, 1] or [0, infinity) channel by channel
//                where sRGB does not hold the colour.
//   conductor    eta and k together: the pair a channel whose reflectance is that of the metal.
// Indices of refraction of glasses are one number, at the helium d line: there is no dispersion.
#ifndef SPECTRUM_SPECTRUM_H
#define SPECTRUM_SPECTRUM_H

#include "base/arena.h"
#include "base/file.h"
#include "base/problem.h"

#include <stdbool.h>
#include <stddef.h>

// Piecewise linear through (nm, value), nm ascending; beyond its ends zero, as in pbrt-v4.
struct spectrum {
  const double (*sample)[2];
  ptrdiff_t count; // at least 2
};

// From n numbers nm value nm value ...; they are kept. NULL, or what is wrong with them.
const char *spectrum_from_numbers(const double *number, ptrdiff_t n, struct spectrum *);

// From a file of such numbers (.spd): spaces and lines between them, # begins a comment.
bool spectrum_parse(struct text, const char *path, struct arena *, struct spectrum *,
                    struct problem *);

double spectrum_at(const struct spectrum *, double nm);

// False if it has no luminance to normalise.
bool spectrum_illuminant(const struct spectrum *, double rgb[3]);
void spectrum_albedo(const struct spectrum *, double rgb[3]);
void spectrum_unbounded(const struct spectrum *, double rgb[3]);
double spectrum_index(const struct spectrum *); // at 587.6 nm; beyond the ends: the value there

// Each channel's (eta, k) has the metal's reflectance of D65 at normal incidence and its average
// over the hemisphere (beyond their ends the spectra keep their last values). In between, largest
// error over the angles: Ag 0.0005, Al 0.001, Cu 0.013, CuZn 0.014 (both at 85 degrees and red;
// below 60 degrees 0.002), Au 0.003 in green and blue. Red of gold would be 1.022, which no
// conductor has: it becomes 0.9999.
void spectrum_conductor(const struct spectrum *eta, const struct spectrum *k, double eta_rgb[3],
                        double k_rgb[3]);

// Planck's law: an illuminant. kelvin > 0.
void spectrum_blackbody(double kelvin, double rgb[3]);

// pbrt-v4's named spectra, converted.
struct named_spectrum {
  const char *name;
  enum { NAMED_ILLUMINANT, NAMED_METAL, NAMED_GLASS } kind; // metal, glass: an index, eta or k
  double rgb[3];
};
extern const struct named_spectrum named_spectra[];
extern const int n_named_spectra;
const struct named_spectrum *spectrum_named(const char *name); // or NULL

// ---- for the conversions themselves ----

enum { SPECTRUM_FIRST = 360, SPECTRUM_COUNT = 471 }; // 360 to 830 nm, the sums' step is 1 nm

// sRGB of what a reflectance at these wavelengths leaves of D65.
void spectrum_reflected(const double value[SPECTRUM_COUNT], double rgb[3]);

#endif
