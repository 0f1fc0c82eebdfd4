// pbrt-v4's named spectra as they are after conversion; the spectra are not kept.
// Illuminants: CIE 15's tables (A: its formula, D50 and ACES D60: their chromaticities) through
// spectrum_illuminant. Metals: the measurements pbrt-v4 has (of 1985 and before, as in Palik's
// handbook) through spectrum_conductor; tests/unit/spectrum.c does it again. Glasses: Schott's
// values at 587.6 nm; pbrt-v4 calls the flints SF5, SF10 and SF11 by F5, F10 and F11.
#include "spectrum/spectrum.h"

#include <string.h>

// clang-format off
const struct named_spectrum named_spectra[] = {
  {"stdillum-A", NAMED_ILLUMINANT, {1.8451, 0.8261, 0.2333}},
  {"stdillum-D50", NAMED_ILLUMINANT, {1.1759, 0.9757, 0.722}},
  {"stdillum-D65", NAMED_ILLUMINANT, {1, 1, 1}},
  {"stdillum-F1", NAMED_ILLUMINANT, {0.9542, 1.0193, 0.9436}},
  {"stdillum-F2", NAMED_ILLUMINANT, {1.34, 0.943, 0.5628}},
  {"stdillum-F3", NAMED_ILLUMINANT, {1.5764, 0.8911, 0.3808}},
  {"stdillum-F4", NAMED_ILLUMINANT, {1.8062, 0.8342, 0.267}},
  {"stdillum-F5", NAMED_ILLUMINANT, {0.9154, 1.0362, 0.8903}},
  {"stdillum-F6", NAMED_ILLUMINANT, {1.3161, 0.9578, 0.4864}},
  {"stdillum-F7", NAMED_ILLUMINANT, {1.0003, 1.0002, 0.9973}},
  {"stdillum-F8", NAMED_ILLUMINANT, {1.1767, 0.9757, 0.72}},
  {"stdillum-F9", NAMED_ILLUMINANT, {1.3768, 0.9314, 0.5693}},
  {"stdillum-F10", NAMED_ILLUMINANT, {1.1775, 0.9756, 0.7183}},
  {"stdillum-F11", NAMED_ILLUMINANT, {1.4121, 0.9247, 0.5315}},
  {"stdillum-F12", NAMED_ILLUMINANT, {1.7684, 0.8451, 0.2708}},
  {"illum-acesD60", NAMED_ILLUMINANT, {1.0469, 0.9946, 0.9155}},
  {"metal-Ag-eta", NAMED_METAL, {0.128, 0.1271, 0.151}},
  {"metal-Ag-k", NAMED_METAL, {4.0861, 3.38, 2.4098}},
  {"metal-Al-eta", NAMED_METAL, {1.4382, 0.9324, 0.5929}},
  {"metal-Al-k", NAMED_METAL, {7.766, 6.6164, 5.3716}},
  {"metal-Au-eta", NAMED_METAL, {1, 0.399, 1.5809}},
  {"metal-Au-k", NAMED_METAL, {199.99, 2.3193, 1.7233}},
  {"metal-Cu-eta", NAMED_METAL, {0.2307, 0.9783, 1.215}},
  {"metal-Cu-k", NAMED_METAL, {4.3744, 2.6238, 2.37}},
  {"metal-CuZn-eta", NAMED_METAL, {0.5514, 0.5258, 1.1321}},
  {"metal-CuZn-k", NAMED_METAL, {4.6911, 2.6751, 1.8166}},
  {"metal-MgO-eta", NAMED_METAL, {1.7337, 1.7409, 1.7535}},
  {"metal-MgO-k", NAMED_METAL, {0, 0, 0}},
  {"metal-TiO2-eta", NAMED_METAL, {2.8604, 2.9569, 3.1857}},
  {"metal-TiO2-k", NAMED_METAL, {0, 0, 0}},
  {"glass-BK7", NAMED_GLASS, {1.5168, 1.5168, 1.5168}},
  {"glass-BAF10", NAMED_GLASS, {1.67003, 1.67003, 1.67003}},
  {"glass-FK51A", NAMED_GLASS, {1.48656, 1.48656, 1.48656}},
  {"glass-LASF9", NAMED_GLASS, {1.85025, 1.85025, 1.85025}},
  {"glass-F5", NAMED_GLASS, {1.6727, 1.6727, 1.6727}},
  {"glass-SF5", NAMED_GLASS, {1.6727, 1.6727, 1.6727}},
  {"glass-F10", NAMED_GLASS, {1.72825, 1.72825, 1.72825}},
  {"glass-SF10", NAMED_GLASS, {1.72825, 1.72825, 1.72825}},
  {"glass-F11", NAMED_GLASS, {1.78472, 1.78472, 1.78472}},
  {"glass-SF11", NAMED_GLASS, {1.78472, 1.78472, 1.78472}},
};
// clang-format on
const int n_named_spectra = sizeof named_spectra / sizeof named_spectra[0];

const struct named_spectrum *spectrum_named(const char *name) {
  for (int k = 0; k < n_named_spectra; k++)
    if (!strcmp(named_spectra[k].name, name)) return &named_spectra[k];
  return NULL;
}
