// PLY files in every format and type, what is skipped and what is refused; expected values are
// those the files are written with.
#include "mesh/mesh.h"
#include "numeric/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static struct arena keep, scratch;

static int reserve(void **state) {
  (void)state;
  keep = arena_reserve(), scratch = arena_reserve();
  return 0;
}

// ---- a writer ----
enum { ASCII, LITTLE, BIG, N_FORMATS };
static const char *const format_names[] = {"ascii", "binary_little_endian", "binary_big_endian"};

struct writer {
  char bytes[8192];
  ptrdiff_t length;
  int format;
};

static void put(struct writer *w, const char *format, ...) {
  va_list args;
  va_start(args, format);
  w->length += vsnprintf(w->bytes + w->length, sizeof w->bytes - (size_t)w->length, format, args);
  va_end(args);
}

static struct writer begin(int format) {
  struct writer w = {.format = format};
  put(&w, "ply\nformat %s 1.0\ncomment made here\n", format_names[format]);
  return w;
}

// type: the first letters of a type's name: b B s S i I f d (capitals unsigned)
static void put_value(struct writer *w, char type, double value) {
  if (w->format == ASCII) {
    put(w, "%.17g ", value);
    return;
  }
  float single = (float)value;
  uint64_t bits = (uint64_t)(int64_t)value;
  uint32_t low;
  if (type == 'd') memcpy(&bits, &value, 8);
  if (type == 'f') memcpy(&low, &single, 4), bits = low;
  int size = strchr("bB", type) ? 1 : strchr("sS", type) ? 2 : type == 'd' ? 8 : 4;
  for (int k = 0; k < size; k++)
    w->bytes[w->length++] = (char)(bits >> 8 * (w->format == BIG ? size - 1 - k : k));
}

static void put_list(struct writer *w, char count_type, char type, int n, const int *value) {
  put_value(w, count_type, n);
  for (int k = 0; k < n; k++) put_value(w, type, value[k]);
}

static bool read_bytes(const char *bytes, ptrdiff_t length, struct mesh *mesh,
                       struct problem *problem) {
  struct arena a = keep, b = scratch;
  *problem = (struct problem){{0}};
  struct text text = {arena_string(&b, bytes, length), length};
  return mesh_read_ply("m.ply", text, &a, b, mesh, problem);
}

static struct mesh mesh_of(const struct writer *w) {
  struct mesh mesh;
  struct problem problem;
  if (!read_bytes(w->bytes, w->length, &mesh, &problem)) fail_msg("%s", problem.text);
  return mesh;
}

// ---- everything a file may hold ----
static const double corner[4][8] = {{0.1, -2.385, 3, 0, 0, 1, 0.25, 0.75},
                                    {1e-30, 7.25, -0.0, 0.6, 0, 0.8, 1, 0},
                                    {-4, 5.5, 1e20, 0, -1, 0, -3.5, 2},
                                    {8, 1, 0.3, 1, 0, 0, 0, 0}};

// Faces before vertices, a skipped element between them, skipped properties of every kind.
static struct writer everything(int format) {
  struct writer w = begin(format);
  put(&w, "element face 3\nproperty uchar flags\nproperty list ushort uint vertex_indices\n"
          "property list uchar double skipped\nproperty int face_indices\n"
          "element edge 2\nproperty list int8 int16 ends\nproperty float64 sharpness\n"
          "obj_info x\nelement vertex 4\nproperty double nx\nproperty double ny\n"
          "property double nz\nproperty list uint8 float32 weights\nproperty double x\n"
          "property uchar red\nproperty double y\nproperty double z\nproperty double s\n"
          "property double t\nelement nothing 4000000000\nelement tail 1\nproperty int8 last\n"
          "end_header\n");
  static const int polygon[3][5] = {{3, 1, 0, 2, 1}, {1, 0, 2}, {0, 1, 2, 3}};
  static const int length[] = {5, 3, 4};
  for (int k = 0; k < 3; k++) {
    put_value(&w, 'B', 200);
    put_list(&w, 'S', 'I', length[k], polygon[k]);
    put_list(&w, 'B', 'd', k, polygon[k]);
    put_value(&w, 'i', -7);
  }
  for (int k = 0; k < 2; k++) put_list(&w, 'b', 's', 2 * k, polygon[0]), put_value(&w, 'd', 0.5);
  for (int k = 0; k < 4; k++) {
    const double *c = corner[k];
    for (int j = 3; j < 6; j++) put_value(&w, 'd', c[j]);
    put_list(&w, 'B', 'f', k, polygon[2]);
    put_value(&w, 'd', c[0]), put_value(&w, 'B', 255);
    for (int j = 1; j < 3; j++) put_value(&w, 'd', c[j]);
    for (int j = 6; j < 8; j++) put_value(&w, 'd', c[j]);
  }
  put_value(&w, 'b', 1);
  return w;
}

static void check_everything(const struct mesh *m) {
  static const uint32_t triangle[4][3] = {{3, 1, 0}, {3, 0, 2}, {3, 2, 1}, {1, 0, 2}};
  static const uint32_t quad[4] = {0, 1, 2, 3};
  assert_int_equal(m->n_vertices, 4);
  assert_int_equal(m->n_triangles, 4);
  assert_int_equal(m->n_quads, 1);
  assert_memory_equal(m->triangle, triangle, sizeof triangle);
  assert_memory_equal(m->quad, quad, sizeof quad);
  for (int k = 0; k < 4; k++) {
    assert_memory_equal(m->p[k], corner[k], 3 * sizeof(double));
    assert_memory_equal(m->n[k], corner[k] + 3, 3 * sizeof(double));
    assert_memory_equal(m->uv[k], corner[k] + 6, 2 * sizeof(double));
  }
}

static void every_format_holds_the_same_mesh(void **state) {
  (void)state;
  for (int format = 0; format < N_FORMATS; format++) {
    struct writer w = everything(format);
    struct mesh mesh = mesh_of(&w);
    check_everything(&mesh);
  }
}

static void every_type_is_read_under_both_names(void **state) {
  (void)state;
  static const struct {
    char type;
    const char *name[2];
    double low, high;
  } types[] = {{'b', {"char", "int8"}, -128, 127},
               {'B', {"uchar", "uint8"}, 0, 255},
               {'s', {"short", "int16"}, -32768, 32767},
               {'S', {"ushort", "uint16"}, 0, 65535},
               {'i', {"int", "int32"}, -2147483648.0, 2147483647},
               {'I', {"uint", "uint32"}, 0, 4294967295},
               {'f', {"float", "float32"}, -0x1.fffffep127, 0x1p-149},
               {'d', {"double", "float64"}, -0x1.fffffffffffffp1023, 0x1p-1074}};
  for (int i = 0; i < 16 * N_FORMATS; i++) {
    int k = i / 2 % 8;
    struct writer w = begin(i / 16);
    put(&w,
        "element vertex 3\nproperty %s x\nproperty %s y\nproperty %s z\nelement face 1\n"
        "property list %s %s vertex_index\nend_header\n",
        types[k].name[i % 2], types[k].name[i % 2], types[k].name[i % 2],
        k < 6 ? types[k].name[i % 2] : "int", k < 6 ? types[k].name[i % 2] : "int");
    for (int v = 0; v < 3; v++)
      put_value(&w, types[k].type, types[k].low), put_value(&w, types[k].type, types[k].high),
          put_value(&w, types[k].type, 77);
    char type = k < 6 ? types[k].type : 'i';
    put_list(&w, type, type, 3, (const int[]){2, 0, 1});
    struct mesh mesh = mesh_of(&w);
    assert_true(mesh.p[2][0] == types[k].low && mesh.p[2][1] == types[k].high);
    assert_true(mesh.p[2][2] == 77 && mesh.triangle[0][0] == 2 && mesh.triangle[0][2] == 1);
    assert_true(!mesh.n && !mesh.uv);
  }
}

// ---- text files ----
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define FACE "element face 1\nproperty list uchar int vertex_indices\nend_header\n"

static void texture_coordinates_have_four_names(void **state) {
  (void)state;
  static const struct {
    const char *declared;
    double u, v; // NAN: none
  } cases[] = {{"property float u\nproperty float v\n", 5, 6},
               {"property float t\nproperty float s\n", 6, 5},
               {"property float texture_u\nproperty float texture_v\n", 5, 6},
               {"property float texture_s\nproperty float texture_t\n", 5, 6},
               {"property float u\nproperty float t\n", NAN, NAN},
               {"property float s\nproperty float nx\n", NAN, NAN}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct writer w = begin(ASCII);
    put(&w, "element vertex 3\n" XYZ "%s" FACE, cases[k].declared);
    put(&w, "0 0 0 5 6\r\n1 0 0 5 6\r\n0 1 0 5 6\r\n3 0 1 2");
    struct mesh mesh = mesh_of(&w);
    assert_true(mesh.n == NULL);
    if (isnan(cases[k].u))
      assert_true(mesh.uv == NULL);
    else
      assert_true(mesh.uv[1][0] == cases[k].u && mesh.uv[1][1] == cases[k].v);
  }
}

static void a_normal_that_is_not_finite_is_none(void **state) {
  (void)state;
  struct writer w = begin(ASCII);
  put(&w, "element vertex 3\n" XYZ "property float nx\nproperty float ny\nproperty float nz\n" FACE
          "0 0 0 nan 0 0\n1 0 0 1 -inf 0\n0 1 0 0 0 -2\n3 0 1 2\n");
  struct mesh mesh = mesh_of(&w);
  assert_true(mesh.n[0][0] == 0 && mesh.n[1][0] == 0 && mesh.n[2][2] == -2);
}

static void headers_may_end_lines_as_windows_does(void **state) {
  (void)state;
  static const char text[] = "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\n"
                             "property float y\r\nproperty float z\r\nelement face 1\r\n"
                             "property list uchar int vertex_indices\r\nend_header\r\n"
                             "0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n";
  struct mesh mesh;
  struct problem problem;
  if (!read_bytes(text, sizeof text - 1, &mesh, &problem)) fail_msg("%s", problem.text);
  assert_int_equal(mesh.n_triangles, 1);
}

// ---- what is refused ----
#define ASCII_HEAD "ply\nformat ascii 1.0\n"
#define BINARY_HEAD "ply\nformat binary_little_endian 1.0\n"
#define THREE "element vertex 3\n" XYZ

static void malformed_files_are_refused_in_one_line(void **state) {
  (void)state;
  static const struct {
    const char *text, *said;
  } cases[] = {
      {"", "m.ply: is not a PLY file"},
      {"ply", "is not a PLY file"},
      {"plyx\nformat ascii 1.0\n", "is not a PLY file"},
      {"solid cube\n", "is not a PLY file"},
      {"ply\nformat ascii 1.0\n", "m.ply:3: the file ends before \"end_header\""},
      {"ply\nformat text 1.0\n", "m.ply:2: \"text\" is not one of the formats"},
      {"ply\nformat ascii 2.0\n", "m.ply:2: the format's version is \"2.0\""},
      {ASCII_HEAD "format ascii 1.0\n", "m.ply:3: the format is given twice"},
      {"ply\n" THREE FACE "0 0 0 1 1 1 2 2 2 3 0 1 2", "no \"format\" line"},
      {ASCII_HEAD "elements vertex 3\n", "m.ply:3: \"elements\" does not belong"},
      {ASCII_HEAD "element\n", "m.ply:3: the element has no name"},
      {ASCII_HEAD "element vertex\n", "m.ply:3: element vertex needs a number"},
      {ASCII_HEAD "element vertex -3\n", "element vertex needs a number"},
      {ASCII_HEAD "element vertex 9999999999999999999\n", "element vertex needs a number"},
      {ASCII_HEAD "property float x\n", "m.ply:3: a property before the first element"},
      {ASCII_HEAD "element vertex 3\nproperty real x\n", "m.ply:4: \"real\" is not a type"},
      {ASCII_HEAD "element vertex 3\nproperty float\n", "m.ply:4: the property has no name"},
      {ASCII_HEAD "element face 3\nproperty list float int vertex_indices\n",
       "must be of an integer type"},
      {ASCII_HEAD FACE "3 0 1 2\n", "it has no vertices"},
      {ASCII_HEAD "element vertex 0\n" XYZ FACE "3 0 1 2\n", "it has no vertices"},
      {ASCII_HEAD THREE "end_header\n0 0 0 1 1 1 2 2 2", "it has no faces"},
      {ASCII_HEAD "element vertex 1\nproperty float x\nproperty float z\n" FACE "0 0 3 0 0 0",
       "its vertices have no y"},
      {ASCII_HEAD "element vertex 1\nproperty list uchar float x\nproperty float y\n" FACE
                  "1 0 0 3 0 0 0",
       "its vertices have no x"},
      {ASCII_HEAD THREE "element face 1\nproperty list uchar float vertex_indices\nend_header\n"
                        "0 0 0 1 1 1 2 2 2 3 0 1 2",
       "no list vertex_indices"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 zero\n3 0 1 2\n", "m.ply:12: \"zero\" is not a"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n",
       "m.ply:12: vertex 2 is not finite"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
       "m.ply:13: 3 is not a vertex of 0 to 2"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "m.ply:13: -1 is not a vertex"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", "m.ply:13: 1.5 is not a vertex"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", "m.ply:13: nan is not a vertex"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "m.ply:13: a face of 2 vertices"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n-3 0 1\n", "-3 is not the length of a list"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\nnan 0 1\n", "nan is not the length of a list"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n1e300 0 1\n", "does not fit into the rest"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1", "m.ply:13: a list of 3 values does"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n          \n   ",
       "m.ply:13: the file ends before its last row"},
      {ASCII_HEAD THREE FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 2"
                             "\x01\x1b",
       "\"2\?\?\" is not a number"},
      {ASCII_HEAD "element vertex 4000000000\n" XYZ FACE "0 0 0\n",
       "4000000000 rows of element vertex do not fit"},
      {BINARY_HEAD "element vertex 4000000000\n" XYZ FACE "0 0 0\n",
       "m.ply: byte 178: 4000000000 rows of element vertex do not fit"},
      {BINARY_HEAD "element junk 999999999999999999\nproperty list uchar int a\n" THREE FACE "0",
       "999999999999999999 rows of element junk do not fit"},
      {"\x1f\x8b\x08", "m.ply: the gzip file is cut off"},
      {"\x1f\x8b\x08zzzzzzzzzzzzzzzzzzz", "m.ply: a damaged gzip file"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct mesh mesh;
    struct problem problem;
    if (read_bytes(cases[k].text, (ptrdiff_t)strlen(cases[k].text), &mesh, &problem))
      fail_msg("accepted: %s", cases[k].text);
    if (!strstr(problem.text, cases[k].said))
      fail_msg("case %zu says \"%s\", not \"%s\"", k, problem.text, cases[k].said);
  }
}

static bool is_one_line(const char *text) {
  if (strncmp(text, "m.ply", 5) != 0) return false;
  for (; *text; text++)
    if ((unsigned char)*text < 0x20) return false;
  return true;
}

static void check_refusal(bool ok, const struct problem *problem) {
  if (ok == (problem->text[0] != 0) || (!ok && !is_one_line(problem->text)))
    fail_msg("%d: \"%s\"", ok, problem->text);
}

static void check_mesh(const struct mesh *m) {
  for (uint32_t k = 0; k < m->n_vertices; k++)
    for (int j = 0; j < 3; j++)
      assert_true(isfinite(m->p[k][j]) && (!m->n || isfinite(m->n[k][j])));
  for (uint32_t k = 0; m->uv && k < m->n_vertices; k++)
    assert_true(isfinite(m->uv[k][0]) && isfinite(m->uv[k][1]));
  for (uint32_t k = 0; k < m->n_triangles; k++)
    for (int j = 0; j < 3; j++) assert_true(m->triangle[k][j] < m->n_vertices);
  for (uint32_t k = 0; k < m->n_quads; k++)
    for (int j = 0; j < 4; j++) assert_true(m->quad[k][j] < m->n_vertices);
}

// A file cut anywhere is refused; of a text, its last number may lose digits and the space.
static void a_file_that_is_cut_off_is_refused(void **state) {
  (void)state;
  for (int format = 0; format < N_FORMATS; format++) {
    struct writer w = everything(format);
    for (ptrdiff_t length = 0; length < w.length; length++) {
      struct mesh mesh;
      struct problem problem;
      bool ok = read_bytes(w.bytes, length, &mesh, &problem);
      check_refusal(ok, &problem);
      assert_false(ok && (format != ASCII || length < w.length - 1));
    }
  }
}

static void edited_files_are_read_or_refused(void **state) {
  (void)state;
  struct rng_key key = rng_key(rng_hash_name(__func__), 1, RNG_TEST);
  int accepted = 0;
  enum { N = 30000 };
  for (uint64_t k = 0; k < N; k++) {
    struct writer w = everything((int)(k % N_FORMATS));
    double u0, u1;
    for (uint32_t edit = 0; edit < 2; edit++) {
      rng_fill(key, 1, &k, 1, edit, &u0, &u1);
      w.bytes[(ptrdiff_t)(u0 * (double)w.length)] = (char)(u1 < 0.5 ? '0' + 20 * u1 : 256 * u1);
    }
    struct mesh mesh;
    struct problem problem;
    bool ok = read_bytes(w.bytes, w.length, &mesh, &problem);
    check_refusal(ok, &problem);
    if (ok) check_mesh(&mesh), accepted++;
  }
  assert_true(accepted > N / 20 && accepted < N - N / 20); // both ways are exercised
}

// ---- gzip ----
static ptrdiff_t compress_to(const struct writer *w, ptrdiff_t from, ptrdiff_t to,
                             unsigned char *out, size_t room) {
  z_stream stream = {0};
  assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  stream.next_in = (Bytef *)w->bytes + from, stream.avail_in = (uInt)(to - from);
  stream.next_out = out, stream.avail_out = (uInt)room;
  assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
  ptrdiff_t length = (ptrdiff_t)stream.total_out;
  deflateEnd(&stream);
  return length;
}

static void compressed_files_are_the_same(void **state) {
  (void)state;
  unsigned char packed[8192];
  for (int format = 0; format < N_FORMATS; format++)
    for (int members = 1; members <= 2; members++) { // gzip files may be joined
      struct writer w = everything(format);
      ptrdiff_t cut = members == 1 ? w.length : 100;
      ptrdiff_t length = compress_to(&w, 0, cut, packed, sizeof packed);
      if (members == 2)
        length += compress_to(&w, cut, w.length, packed + length, sizeof packed - (size_t)length);
      struct mesh mesh;
      struct problem problem;
      if (!read_bytes((const char *)packed, length, &mesh, &problem)) fail_msg("%s", problem.text);
      check_everything(&mesh);
      for (ptrdiff_t n = 0; n < length; n++)
        if (read_bytes((const char *)packed, n, &mesh, &problem)) fail_msg("cut at %td", n);
    }
}

// ---- files of others ----
static long header_count(const struct text *text, const char *element) {
  const char *at = strstr(text->data, element);
  return at ? strtol(at + strlen(element), NULL, 10) : -1;
}

static void real_files_hold_what_their_headers_say(void **state) {
  (void)state;
  glob_t found;
  char pattern[4096];
  const char *scenes = getenv("SCENES"); // as make test gives it
  snprintf(pattern, sizeof pattern, "%s/*/models/*.ply", scenes ? scenes : "../shared/scenes");
  if (glob(pattern, 0, NULL, &found) != 0) {
    print_message("no PLY files of others here: skipped\n");
    skip();
  }
  for (size_t k = 0; k < found.gl_pathc; k++) {
    struct arena a = keep, b = scratch;
    struct text text;
    struct mesh mesh;
    struct problem problem = {{0}};
    if (!file_read(found.gl_pathv[k], &b, &text, &problem) ||
        !mesh_read_ply(found.gl_pathv[k], text, &a, b, &mesh, &problem))
      fail_msg("%s", problem.text);
    assert_int_equal(mesh.n_vertices, header_count(&text, "element vertex "));
    assert_int_equal(mesh.n_triangles + mesh.n_quads, header_count(&text, "element face "));
    assert_true((mesh.n != NULL) == (strstr(text.data, "property float nx") != NULL));
    check_mesh(&mesh);
  }
  globfree(&found);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_format_holds_the_same_mesh),
      cmocka_unit_test(every_type_is_read_under_both_names),
      cmocka_unit_test(texture_coordinates_have_four_names),
      cmocka_unit_test(a_normal_that_is_not_finite_is_none),
      cmocka_unit_test(headers_may_end_lines_as_windows_does),
      cmocka_unit_test(malformed_files_are_refused_in_one_line),
      cmocka_unit_test(a_file_that_is_cut_off_is_refused),
      cmocka_unit_test(edited_files_are_read_or_refused),
      cmocka_unit_test(compressed_files_are_the_same),
      cmocka_unit_test(real_files_hold_what_their_headers_say),
  };
  return cmocka_run_group_tests_name("ply", tests, reserve, NULL);
}
