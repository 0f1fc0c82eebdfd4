#include "scene/coat.h"

static const double pi = 0x1.921fb54442d18p+1;
static const struct vec normal = {0, 0, 1};

// ---- the interface ----

// Transmission is certain where a direction is sampled by it, so Fresnel's share is not in the pdf.
double coat_transmission(const struct dielectric *coat, struct vec outside, struct vec inside,
                         double *pdf) {
  struct dielectric_event event;
  *pdf = 0;
  if (!dielectric_meet(coat, outside, inside, &event) || !(event.fresnel < 1)) return 0;
  double share = event.d * dielectric_share(&event);
  *pdf = share * 2 /
         ((1 - event.fresnel) * (microfacet_stretch(&coat->facets, outside) + fabs(outside.z)));
  return share * microfacet_g_over_cosines(&coat->facets, outside, inside);
}

// G(wo, wi) / G1(wo), finite at grazing angles: what a sampled normal leaves of f |cos| / pdf.
static double unmasked(const struct microfacet *m, struct vec wo, struct vec wi) {
  double so = microfacet_stretch(m, wo), si = microfacet_stretch(m, wi);
  double o = fabs(wo.z), i = fabs(wi.z);
  return i * (so + o) / (so * i + si * o);
}

static struct vec facet(const struct dielectric *coat, struct vec w, const double u[2]) {
  return coat->facets.smooth ? normal : microfacet_sample(&coat->facets, w, u);
}

bool coat_sample_reflection(const struct dielectric *coat, struct vec w, const double u[2],
                            struct vec *out, double *weight) {
  struct vec m = facet(coat, w, u);
  *weight = fresnel_dielectric(vec_dot(w, m), coat->eta);
  *out = fresnel_reflect(w, m);
  if (!(*weight > 0 && out->z * w.z > 0)) return false;
  if (!coat->facets.smooth) *weight *= unmasked(&coat->facets, w, *out);
  return true;
}

bool coat_sample_transmission(const struct dielectric *coat, struct vec w, const double u[2],
                              struct vec *out, double *weight) {
  struct vec m = facet(coat, w, u);
  double eta_path;
  if (!fresnel_refract(w, m, coat->eta, &eta_path, out)) return false;
  *weight = 1 - fresnel_dielectric(vec_dot(w, m), coat->eta);
  if (w.z < 0 ? !(out->z > 0) : !(out->z < 0)) return false;
  if (!coat->facets.smooth) *weight *= unmasked(&coat->facets, w, *out);
  return true;
}

// ---- quadrature ----

enum { GAUSS = 16 };
static const double gauss[GAUSS / 2][2] = { // nodes in [0, 1/2] and weights, for [0, 1]
    {0x1.5b4f66ca1e083p-8, 0x1.bcddab4b7c211p-7}, {0x1.c60a99e906503p-6, 0x1.fdfb1a2c1265dp-6},
    {0x1.132ff2bac6df4p-4, 0x1.85c4ee79cc258p-5}, {0x1.f4ee8896e3653p-4, 0x1.fe7af2bad386ap-5},
    {0x1.874b732542e9p-3, 0x1.325f61bca3cbfp-4},  {0x1.157ed32de2c47p-2, 0x1.5a6ebbb5a75fcp-4},
    {0x1.6fd1a8cdee642p-2, 0x1.75f8c77e0c00fp-4}, {0x1.cf5a853312ac1p-2, 0x1.83feae80e4dfcp-4}};

static double gauss_node(int i) {
  return i < GAUSS / 2 ? gauss[i][0] : 1 - gauss[GAUSS - 1 - i][0];
}
static double gauss_weight(int i) { return gauss[i < GAUSS / 2 ? i : GAUSS - 1 - i][1]; }

static bool is_isotropic(const struct dielectric *coat) {
  return coat->facets.smooth || coat->facets.alpha_x == coat->facets.alpha_y;
}

static double enter_by(const struct dielectric *coat, double thickness, struct vec w,
                       const double u[2]) {
  struct vec in;
  double weight;
  if (!coat_sample_transmission(coat, w, u, &in, &weight)) return 0;
  return weight * coat_attenuation(thickness, in.z);
}

// Over the disc of visible normals, which makes the integrand bounded: Gauss in the radius 1 - y^2,
// which removes the root at its rim; midpoints around, half of it where the halves are mirror
// images.
double coat_entering(const struct dielectric *coat, double thickness, struct vec w) {
  if (coat->facets.smooth) return enter_by(coat, thickness, w, (double[2]){0});
  bool half = is_isotropic(coat);
  int n = half ? GAUSS : 2 * GAUSS;
  double sum = 0;
  for (int i = 0; i < GAUSS; i++) {
    double y = gauss_node(i), r = 1 - y * y, ring = 0;
    for (int j = 0; j < n; j++)
      ring += enter_by(coat, thickness, w, (double[2]){r * r, (j + 0.5) / (2 * GAUSS) - 0.25});
    sum += gauss_weight(i) * 4 * r * y * ring / n;
  }
  return sum;
}

// Light that leaves the base towards a facet and is sent back down.
static double return_by(const struct dielectric *coat, double thickness, struct vec up,
                        struct vec m) {
  struct vec w = vec_scale(up, -1), back = fresnel_reflect(w, m);
  if (!(w.z < 0 && back.z < 0)) return 0;
  double g = coat->facets.smooth ? 1 : microfacet_g(&coat->facets, w, back);
  return fresnel_dielectric(vec_dot(w, m), coat->eta) * g * coat_attenuation(thickness, w.z) *
         coat_attenuation(thickness, back.z);
}

// Over directions around the facet's normal m: cosines c in two panels, since reflection is total
// below the critical one and leaves it with a root, then n midpoints around, `turn` of the circle.
static double return_from_facet(const struct dielectric *coat, double thickness, struct vec m,
                                int n, double turn) {
  double critical = coat->eta > 1 ? sqrt((1 - 1 / coat->eta) * (1 + 1 / coat->eta)) : 0, sum = 0;
  // s lies in the plane of m and z: the halves on its two sides are mirror images.
  double tilt = sqrt(m.x * m.x + m.y * m.y);
  struct vec s = tilt > 0 ? vec(m.x / tilt * m.z, m.y / tilt * m.z, -tilt) : vec(1, 0, 0);
  struct vec t = vec_cross(m, s);
  for (int i = 0; i < 2 * GAUSS; i++) {
    double x = gauss_node(i % GAUSS), weight = gauss_weight(i % GAUSS);
    double above = 1 - critical, c = i < GAUSS ? critical * x : critical + above * x * x;
    weight *= i < GAUSS ? critical : 2 * x * above;
    double sine = sqrt((1 - c) * (1 + c)), ring = 0;
    for (int j = 0; j < n; j++) {
      double sin_phi, cos_phi;
      num_sincos_turns(turn * (j + 0.5) / n, &sin_phi, &cos_phi);
      struct vec up = vec_along(vec_along(vec_scale(m, c), s, sine * cos_phi), t, sine * sin_phi);
      ring += return_by(coat, thickness, up, m);
    }
    sum += weight * c * ring / n;
  }
  return 2 * sum;
}

// K = (1/pi) int D(m) int (up.m) F(up.m) G attenuations dup dm: facet by facet, not direction by
// direction, so that the critical angle is at one place. With u = 1 - y^2 of the stretched facets
// below it, m = (alpha_x k cos, alpha_y k sin, 1) / length, k^2 = u / (1 - u), has density D |m.z|.
double coat_returned(const struct dielectric *coat, double thickness) {
  if (coat->facets.smooth) return return_from_facet(coat, thickness, normal, 1, 1);
  bool isotropic = is_isotropic(coat);
  int n_azimuths = isotropic ? 1 : GAUSS / 2;
  double sum = 0;
  for (int i = 0; i < GAUSS; i++) {
    double y = gauss_node(i), k = sqrt((1 - y) * (1 + y)) / y, ring = 0;
    for (int j = 0; j < n_azimuths; j++) { // of the quarter [0, 1/4]
      double sine = 0, cosine = 1;
      if (!isotropic) num_sincos_turns((j + 0.5) / (4 * n_azimuths), &sine, &cosine);
      struct vec slope = vec(coat->facets.alpha_x * k * cosine, coat->facets.alpha_y * k * sine, 1);
      double length = vec_length(slope);
      ring += length * return_from_facet(coat, thickness, vec_scale(slope, 1 / length),
                                         isotropic ? 2 * GAUSS : 4 * GAUSS, isotropic ? 0.5 : 1);
    }
    sum += gauss_weight(i) * 2 * y * ring / n_azimuths;
  }
  return sum;
}

// ---- tables ----

static double table_cosine(int j) { // denser towards grazing angles
  double x = (double)j / (COAT_COSINES - 1);
  return x * x;
}

static double table_alpha(int i) { // denser towards smooth
  double x = (double)i / (COAT_ALPHAS - 1);
  return COAT_ALPHA_MAX * x * x * x * x;
}

static void fill_row(double *row, const struct dielectric *coat, double thickness, double azimuth) {
  double sin_phi, cos_phi;
  num_sincos_turns(azimuth, &sin_phi, &cos_phi);
  for (int j = 0; j < COAT_COSINES; j++) {
    double z = table_cosine(j), sine = sqrt((1 - z) * (1 + z));
    row[j] = coat_entering(coat, thickness, vec(sine * cos_phi, sine * sin_phi, z));
  }
}

static struct coat_table table_of(struct arena *arena, double eta, double thickness,
                                  enum coat_axis axis) {
  struct coat_table table = {.eta = eta, .thickness = thickness, .axis = axis};
  table.n_rows = axis == COAT_AXIS_ALPHA     ? COAT_ALPHAS
                 : axis == COAT_AXIS_AZIMUTH ? COAT_AZIMUTHS
                                             : 1;
  table.entering = arena_new(arena, double, table.n_rows *COAT_COSINES);
  table.returned = arena_new(arena, double, table.n_rows);
  return table;
}

struct coat_table coat_table_one(struct arena *arena, const struct dielectric *coat,
                                 double thickness) {
  enum coat_axis axis = is_isotropic(coat) ? COAT_AXIS_NONE : COAT_AXIS_AZIMUTH;
  struct coat_table table = table_of(arena, coat->eta, thickness, axis);
  for (int i = 0; i < table.n_rows && !coat->facets.smooth; i++)
    fill_row(&table.entering[i * COAT_COSINES], coat, thickness, 0.25 * i / (COAT_AZIMUTHS - 1));
  table.returned[0] = coat_returned(coat, thickness);
  return table;
}

struct coat_table coat_table_alphas(struct arena *arena, double eta, double thickness) {
  struct coat_table table = table_of(arena, eta, thickness, COAT_AXIS_ALPHA);
  for (int i = 0; i < table.n_rows; i++) {
    struct dielectric coat = dielectric_of(eta, microfacet_of(table_alpha(i), table_alpha(i)));
    fill_row(&table.entering[i * COAT_COSINES], &coat, thickness, 0);
    table.returned[i] = coat_returned(&coat, thickness);
  }
  return table;
}

// Lagrange's cubic through nodes first .. first + 3 of 0 .. n - 1, at `position`.
static int cubic(double position, int n, double weight[4]) {
  int first = (int)position - 1;
  if (first < 0) first = 0;
  if (first > n - 4) first = n - 4;
  double x = position - first;
  weight[0] = -(x - 1) * (x - 2) * (x - 3) / 6;
  weight[1] = x * (x - 2) * (x - 3) / 2;
  weight[2] = -x * (x - 1) * (x - 3) / 2;
  weight[3] = x * (x - 1) * (x - 2) / 6;
  return first;
}

// What is not is computed: quickly where smooth, slowly where a texture is rougher than sense.
static bool is_tabulated(const struct coat_table *table, const struct dielectric *coat) {
  if (coat->facets.smooth) return false;
  return table->axis != COAT_AXIS_ALPHA || coat->facets.alpha_x <= COAT_ALPHA_MAX;
}

static int row_stencil(const struct coat_table *table, const struct dielectric *coat, struct vec w,
                       double weight[4]) {
  if (table->axis == COAT_AXIS_ALPHA)
    return cubic(sqrt(sqrt(coat->facets.alpha_x / COAT_ALPHA_MAX)) * (COAT_ALPHAS - 1), COAT_ALPHAS,
                 weight);
  double quarters = num_atan2(fabs(w.y), fabs(w.x)) * 2 / pi;
  return cubic(quarters * (COAT_AZIMUTHS - 1), COAT_AZIMUTHS, weight);
}

double coat_table_entering(const struct coat_table *table, const struct dielectric *coat,
                           struct vec w) {
  if (!is_tabulated(table, coat)) return coat_entering(coat, table->thickness, w);
  double across[4], along[4], sum = 0;
  int column = cubic(sqrt(fabs(w.z)) * (COAT_COSINES - 1), COAT_COSINES, across), row = 0, rows = 1;
  along[0] = 1;
  if (table->axis != COAT_AXIS_NONE) {
    row = row_stencil(table, coat, w, along);
    rows = 4;
  }
  for (int i = 0; i < rows; i++) {
    const double *t = &table->entering[(row + i) * COAT_COSINES + column];
    sum += along[i] * (across[0] * t[0] + across[1] * t[1] + across[2] * t[2] + across[3] * t[3]);
  }
  return sum;
}

double coat_table_returned(const struct coat_table *table, const struct dielectric *coat) {
  if (table->axis != COAT_AXIS_ALPHA || coat->facets.smooth) return table->returned[0];
  if (!is_tabulated(table, coat)) return coat_returned(coat, table->thickness);
  double along[4];
  const double *k = &table->returned[row_stencil(table, coat, normal, along)];
  return along[0] * k[0] + along[1] * k[1] + along[2] * k[2] + along[3] * k[3];
}
