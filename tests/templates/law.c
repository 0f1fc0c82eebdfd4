// A radius law, here `power` with i + 1 for i. The functions go into src/density/law.c above its
// table, the row at the end of the table; nothing else knows of it. Then `make validate` checks what
// every law promises, and an experiment may say `law: delayed`.

// rho = r_i^d / r_1^d, 1 at i = 1, for alpha in [0, 1] and i up to 1e15: a closed form, since a
// product over i loses digits. x^alpha / x, not x^(alpha - 1): alpha is exact, alpha - 1 may round.
static double delayed_rho(double alpha, uint64_t i) {
  double x = 0.5 * ((double)i + 1);
  return alpha == 1 ? 1 : num_pow(x, alpha) / x;
}

// lim rho_i i^(1 - alpha).
static double delayed_constant(double alpha) { return num_pow(2, 1 - alpha); }

// The row: name, formula, source; rho, the e of rho ~ i^-e, the limit of rho_i i^e as a formula and
// as a function. Last, NULL: radii depend on i alone; a law of local statistics has a function of
// the photons found there (law.h), and then rho is what constant density gives.
  {"delayed", "((i + 1) / 2)^(alpha - 1)", "a template",
   delayed_rho, shrinking_exponent, "2^(1 - alpha)", delayed_constant, NULL},
