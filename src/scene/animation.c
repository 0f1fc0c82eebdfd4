#include "scene/animation.h"

#include "numeric/elementary.h"

// ---- polar decomposition ----
// Higham 1986: R <- (R + R^-T) / 2 converges to the rotation quadratically, from a large ratio of
// stretches by halves at first. The last step is the first that changes nothing but rounding.
static struct transform nearest_rotation(struct transform m) {
  for (int step = 0; step < 100; step++) {
    struct transform inverse, next = m;
    double change = 0;
    if (!transform_invert(m, &inverse)) return m; // the reader refuses singular matrices
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        next.m[i][j] = 0.5 * (m.m[i][j] + inverse.m[j][i]);
        double d = fabs(next.m[i][j] - m.m[i][j]);
        change = d > change ? d : change;
      }
    m = next;
    if (change <= 0x1p-50) break;
  }
  return m;
}

// A mirrored matrix has a mirrored stretch: quaternions know rotations only.
static void decompose(const struct transform *t, struct transform *rotation, double stretch[3][3]) {
  struct transform linear = *t;
  double scale = 1 / num_cbrt(fabs(transform_determinant(*t)));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) linear.m[i][j] = j < 3 ? scale * t->m[i][j] : 0;
  *rotation = nearest_rotation(linear);
  double sign = transform_determinant(*rotation) < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) rotation->m[i][j] *= sign;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      stretch[i][j] = 0;
      for (int k = 0; k < 3; k++) stretch[i][j] += rotation->m[k][i] * t->m[k][j];
    }
}

// ---- quaternions ----
// Shoemake 1985: from the largest of the four components, so that nothing cancels.
static void quaternion_of(const struct transform *r, double q[4]) {
  const double(*m)[4] = r->m;
  double trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0) {
    double s = sqrt(trace + 1);
    q[3] = 0.5 * s;
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      q[i] = (m[k][j] - m[j][k]) * (0.5 / s);
    }
    return;
  }
  int i = m[1][1] > m[0][0] ? 1 : 0;
  if (m[2][2] > m[i][i]) i = 2;
  int j = (i + 1) % 3, k = (i + 2) % 3;
  double s = sqrt(m[i][i] - m[j][j] - m[k][k] + 1);
  q[i] = 0.5 * s;
  q[j] = (m[j][i] + m[i][j]) * (0.5 / s);
  q[k] = (m[k][i] + m[i][k]) * (0.5 / s);
  q[3] = (m[k][j] - m[j][k]) * (0.5 / s);
}

static double dot4(const double a[4], const double b[4]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static double length_of_sum(const double a[4], const double b[4], double sign) {
  double sum[4];
  for (int k = 0; k < 4; k++) sum[k] = a[k] + sign * b[k];
  return sqrt(dot4(sum, sum));
}

// Between unit quaternions in one half of the sphere: [0, pi / 2]; half the angle of the rotation.
static double angle_between(const double a[4], const double b[4]) {
  return 2 * num_atan2(length_of_sum(a, b, -1), length_of_sum(a, b, 1));
}

static double sine(double x) {
  double s, c;
  num_sincos(x, &s, &c);
  return s;
}

// The great arc; below an angle of 1e-8 its chord, which is the same to rounding.
static void slerp(const double a[4], const double b[4], double share, double q[4]) {
  double angle = angle_between(a, b), wa = 1 - share, wb = share;
  if (angle > 1e-8) {
    wa = sine((1 - share) * angle) / sine(angle);
    wb = sine(share * angle) / sine(angle);
  }
  for (int k = 0; k < 4; k++) q[k] = wa * a[k] + wb * b[k];
}

static void rotation_of(const double q[4], double m[3][3]) {
  double x = q[0], y = q[1], z = q[2], w = q[3];
  m[0][0] = 1 - 2 * (y * y + z * z), m[0][1] = 2 * (x * y - z * w), m[0][2] = 2 * (x * z + y * w);
  m[1][0] = 2 * (x * y + z * w), m[1][1] = 1 - 2 * (x * x + z * z), m[1][2] = 2 * (y * z - x * w);
  m[2][0] = 2 * (x * z - y * w), m[2][1] = 2 * (y * z + x * w), m[2][2] = 1 - 2 * (x * x + y * y);
}

// ---- the whole ----
static bool equal(const struct transform *a, const struct transform *b) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      if (a->m[i][j] != b->m[i][j]) return false;
  return true;
}

struct animation animation_new(struct transform start, struct transform end) {
  struct animation a = {.moves = !equal(&start, &end), .end = {start, end}};
  for (int e = 0; e < 2 && a.moves; e++) {
    struct transform rotation;
    const double(*m)[4] = a.end[e].m;
    a.translation[e] = vec(m[0][3], m[1][3], m[2][3]);
    decompose(&a.end[e], &rotation, a.stretch[e]);
    quaternion_of(&rotation, a.rotation[e]);
  }
  if (dot4(a.rotation[0], a.rotation[1]) < 0)
    for (int k = 0; k < 4; k++) a.rotation[1][k] = -a.rotation[1][k];
  return a;
}

static double between(double a, double b, double share) { return (1 - share) * a + share * b; }

struct transform animation_at(const struct animation *a, double share) {
  if (!a->moves || share <= 0) return a->end[0];
  if (share >= 1) return a->end[1];
  double q[4], r[3][3];
  slerp(a->rotation[0], a->rotation[1], share, q);
  rotation_of(q, r);
  struct vec from = a->translation[0], to = a->translation[1];
  struct transform t = transform_translate(vec(
      between(from.x, to.x, share), between(from.y, to.y, share), between(from.z, to.z, share)));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      t.m[i][j] = 0;
      for (int k = 0; k < 3; k++)
        t.m[i][j] += r[i][k] * between(a->stretch[0][k][j], a->stretch[1][k][j], share);
    }
  return t;
}

static struct vec stretched(const double s[3][3], struct vec p) {
  return vec(s[0][0] * p.x + s[0][1] * p.y + s[0][2] * p.z,
             s[1][0] * p.x + s[1][1] * p.y + s[1][2] * p.z,
             s[2][0] * p.x + s[2][1] * p.y + s[2][2] * p.z);
}

// A path x(u) departs from its chord over a step h by at most h^2 / 8 max |x''|. Here x = T + R S p
// with T, S linear in u and R turning by w in all, so |x''| <= w^2 |S p| + 2 w |S' p|.
double animation_slack(const struct animation *a, struct vec p) {
  if (!a->moves) return 0;
  struct vec from = stretched(a->stretch[0], p), to = stretched(a->stretch[1], p);
  double w = 2 * angle_between(a->rotation[0], a->rotation[1]);
  double reach = vec_length(from) > vec_length(to) ? vec_length(from) : vec_length(to);
  double bend = w * w * reach + 2 * w * vec_length(vec_sub(to, from));
  return bend / (8.0 * ANIMATION_STEPS * ANIMATION_STEPS);
}
