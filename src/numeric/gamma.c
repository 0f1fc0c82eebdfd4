// 1 / Gamma(1 + a) on [0, 1].
#include "numeric/elementary.h"

#include <assert.h>

// 1 / Gamma(1 + a) = 1 + a (1 - a) (h0 + h1 a + h2 a^2 + ...): exact at both ends. With the power
// series 1 / Gamma(z) = c1 z + c2 z^2 + ... (Abramowitz & Stegun 6.1.34), hk = c2 + ... + c(k+2).
double num_rgamma1p(double a) {
  static const double h[] = {
      0x1.2788cfc6fb619p-1,  -0x1.423382fda20a7p-4,  -0x1.ee3e777ab58cbp-4,
      0x1.77cbd937a4d64p-5,  0x1.e1cc8fb70cd19p-9,   -0x1.85af9d2d815b6p-8,
      0x1.4da89fe9d2beep-10, 0x1.c378d1b989465p-14,  -0x1.c3512b24a1815p-14,
      0x1.570f19da76e39p-16, 0x1.5023b97e0dedfp-22,  -0x1.f748a73963007p-21,
      0x1.a405b1f87aefbp-23, -0x1.592b46e47361cp-27, -0x1.0e0b1226b960ep-28,
      0x1.26c4b6732b496p-30, -0x1.df01869783f97p-34, -0x1.41a1f3b6b9902p-38,
      0x1.c3fdaf9148f9ap-39, -0x1.112718012e16fp-41, 0x1.bf1fa23eb6c24p-46,
      0x1.315065516f6d6p-48, -0x1.403c353bbea63p-50, 0x1.0ae09ef628b4cp-53,
  };
  assert(a >= 0 && a <= 1);
  double p = 0;
  for (int k = (int)(sizeof h / sizeof h[0]) - 1; k >= 0; k--) p = p * a + h[k];
  return 1 + a * (1 - a) * p;
}
