#include "scene/transform.h"

#include "numeric/elementary.h"

#include <math.h>

struct transform transform_identity(void) {
  return transform_scale(vec(1, 1, 1));
}

struct transform transform_multiply(struct transform a, struct transform b) {
  struct transform c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j] +
                  (j == 3 ? a.m[i][3] : 0);
  return c;
}

static struct vec column(const struct transform *t, int j) {
  return vec(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static void set_row(struct transform *t, int i, struct vec v, double w) {
  t->m[i][0] = v.x;
  t->m[i][1] = v.y;
  t->m[i][2] = v.z;
  t->m[i][3] = w;
}

double transform_determinant(struct transform t) {
  return vec_dot(column(&t, 0), vec_cross(column(&t, 1), column(&t, 2)));
}

// Rows of the inverse are the columns' cross products over the determinant.
bool transform_invert(struct transform t, struct transform *inverse) {
  double determinant = transform_determinant(t);
  if (!(fabs(determinant) > 0)) return false;
  struct vec origin = column(&t, 3);
  for (int i = 0; i < 3; i++) {
    struct vec row = vec_cross(column(&t, (i + 1) % 3), column(&t, (i + 2) % 3));
    row = vec(row.x / determinant, row.y / determinant, row.z / determinant);
    set_row(inverse, i, row, 0 - vec_dot(row, origin));
  }
  return transform_is_finite(inverse);
}

struct transform transform_translate(struct vec d) {
  return (struct transform){{{1, 0, 0, d.x}, {0, 1, 0, d.y}, {0, 0, 1, d.z}}};
}

struct transform transform_scale(struct vec s) {
  return (struct transform){{{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}}};
}

// Rodrigues: R v = cos v + (1 - cos)(a.v) a + sin a x v.
struct transform transform_rotate(double degrees, struct vec axis) {
  double turns = degrees / 360, sine, cosine;
  num_sincos_turns(turns - floor(turns), &sine, &cosine);
  struct vec a = vec_normalize(axis);
  double k = 1 - cosine;
  struct transform t;
  set_row(&t, 0,
          vec(cosine + k * a.x * a.x, k * a.x * a.y - sine * a.z, k * a.x * a.z + sine * a.y), 0);
  set_row(&t, 1,
          vec(k * a.y * a.x + sine * a.z, cosine + k * a.y * a.y, k * a.y * a.z - sine * a.x), 0);
  set_row(&t, 2,
          vec(k * a.z * a.x - sine * a.y, k * a.z * a.y + sine * a.x, cosine + k * a.z * a.z), 0);
  return t;
}

bool transform_look_at(struct vec eye, struct vec look, struct vec up, struct transform *t) {
  struct vec forward = vec_normalize(vec_sub(look, eye));
  struct vec right = vec_normalize(vec_cross(vec_normalize(up), forward));
  struct vec new_up = vec_cross(forward, right);
  set_row(t, 0, right, 0 - vec_dot(right, eye));
  set_row(t, 1, new_up, 0 - vec_dot(new_up, eye));
  set_row(t, 2, forward, 0 - vec_dot(forward, eye));
  return transform_is_finite(t); // a vector of length zero became NaN
}

bool transform_from_columns(const double c[16], struct transform *t) {
  for (int i = 0; i < 3; i++) set_row(t, i, vec(c[i], c[4 + i], c[8 + i]), c[12 + i]);
  return c[3] == 0 && c[7] == 0 && c[11] == 0 && c[15] == 1;
}

bool transform_is_finite(const struct transform *t) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      if (!isfinite(t->m[i][j])) return false;
  return true;
}
