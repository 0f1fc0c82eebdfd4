// What is asked on the command line: a light, and lists that cross.
#include "app/predict.h"
#include "experiment/keys.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const uint64_t most_iterations = 100000000000000; // within what laws promise of rho
enum { MOST_PREDICTIONS = 10000 };                       // of one command; more is a slip

// ---- what the command line asks ----

struct question {
  struct cell cell;
  uint64_t d;
  double lambda, density, curvature, laplacian, bilaplacian; // NAN: not said
};

struct setting {
  const char *key, *fallback; // NULL: none
  bool (*cell)(struct reading *, const struct node *, struct cell *);
  bool (*own)(struct reading *, const struct node *, struct question *);
};

static bool positive(struct reading *reading, const struct node *node, double *value) {
  return value_number(reading, node, value) &&
         (*value > 0 || value_complain(reading, node, "is not positive"));
}

static bool read_dimension(struct reading *reading, const struct node *node,
                           struct question *question) {
  return value_count(reading, node, 1, 3, &question->d);
}
static bool read_iterations(struct reading *reading, const struct node *node,
                            struct question *question) {
  return value_count(reading, node, 1, most_iterations, &question->cell.iterations);
}
static bool read_lambda(struct reading *reading, const struct node *node,
                        struct question *question) {
  return positive(reading, node, &question->lambda);
}
static bool read_density(struct reading *reading, const struct node *node,
                         struct question *question) {
  return positive(reading, node, &question->density);
}
static bool read_curvature(struct reading *reading, const struct node *node,
                           struct question *question) {
  return value_number(reading, node, &question->curvature);
}
static bool read_laplacian(struct reading *reading, const struct node *node,
                           struct question *question) {
  return value_number(reading, node, &question->laplacian);
}
static bool read_bilaplacian(struct reading *reading, const struct node *node,
                             struct question *question) {
  return value_number(reading, node, &question->bilaplacian);
}

// All may be lists, which cross; the first varies slowest.
static const struct setting settings[] = {
    {"law", "knaus-zwicker", key_read_law, NULL},  {"kernel", "box", key_read_kernel, NULL},
    {"dimension", "2", NULL, read_dimension},      {"alpha", "2/3", key_read_alpha, NULL},
    {"photons", "65536", key_read_photons, NULL},  {"radius", "1", key_read_radius, NULL},
    {"iterations", "1000", NULL, read_iterations}, {"lambda", NULL, NULL, read_lambda},
    {"density", NULL, NULL, read_density},         {"curvature", NULL, NULL, read_curvature},
    {"laplacian", NULL, NULL, read_laplacian},     {"bilaplacian", "0", NULL, read_bilaplacian},
};
enum { N_SETTINGS = sizeof settings / sizeof *settings };

struct questions {
  struct question *item;
  ptrdiff_t count, capacity;
};

// The names of a table, for "all".
static const char *all_of(const char *key, struct arena *arena) {
  const char *names = "";
  for (int k = 0; strcmp(key, "law") == 0 && k < n_laws; k++)
    names = arena_format(arena, "%s%s%s", names, k ? "," : "", laws[k].name);
  for (int k = 0; strcmp(key, "kernel") == 0 && k < n_kernels; k++)
    names = arena_format(arena, "%s%s%s", names, k ? "," : "", kernels[k].name);
  return *names ? names : "all";
}

// Every question so far with every value of one setting, "a,b,c".
static bool cross(const struct setting *setting, const char *text, struct questions *questions,
                  struct arena *arena, struct problem *problem) {
  struct questions crossed = {0};
  struct reading reading = {arena, problem, arena_format(arena, "--%s", setting->key)};
  if (strcmp(text, "all") == 0) text = all_of(setting->key, arena);
  for (ptrdiff_t k = 0; k < questions->count; k++)
    for (const char *at = text;; at++) {
      size_t length = strcspn(at, ",");
      struct question question = questions->item[k];
      struct node node = {.kind = NODE_SCALAR,
                          .place = {.file = "command line"},
                          .text = arena_string(arena, at, (ptrdiff_t)length)};
      if (!(setting->cell ? setting->cell(&reading, &node, &question.cell)
                          : setting->own(&reading, &node, &question)))
        return false;
      if (crossed.count == MOST_PREDICTIONS)
        return problem_set(problem, "the lists cross to more than %d predictions",
                           MOST_PREDICTIONS);
      *arena_push(arena, &crossed) = question;
      at += length;
      if (!*at) break;
    }
  *questions = crossed;
  return true;
}

static bool read_questions(const struct cli *cli, struct questions *questions,
                           struct problem *problem) {
  if (cli_setting_of(cli, "lambda") && cli_setting_of(cli, "density"))
    return problem_set(problem, "--lambda and --density say the same: give one");
  if (cli_setting_of(cli, "curvature") && cli_setting_of(cli, "laplacian"))
    return problem_set(problem, "--curvature and --laplacian say the same: give one");
  *arena_push(cli->arena, questions) = (struct question){
      .lambda = NAN, .density = NAN, .curvature = NAN, .laplacian = NAN, .bilaplacian = NAN};
  for (int k = 0; k < N_SETTINGS; k++) {
    const char *said = cli_setting_of(cli, settings[k].key);
    const char *text = said ? said : settings[k].fallback;
    if (text && !cross(&settings[k], text, questions, cli->arena, problem)) return false;
  }
  for (ptrdiff_t k = 0; k < questions->count; k++) questions->item[k].cell.number = (int)k;
  return true;
}

// ---- the light ----

double predict_ball(int d, double radius) {
  const double pi = 0x1.921fb54442d18p+1;
  return d == 1   ? 2 * radius
         : d == 2 ? pi * radius * radius
                  : 4 * pi / 3 * radius * radius * radius;
}

static struct local_light light_of(const struct question *question) {
  double photons = (double)question->cell.photons, r1 = question->cell.radius, r2 = r1 * r1;
  struct local_light light = {.mu = 1, .photons = photons, .lambda = 100, .curvature = -0.1};
  if (!isnan(question->lambda)) light.lambda = question->lambda;
  if (!isnan(question->density))
    light.lambda = question->density * predict_ball((int)question->d, r1) * photons;
  if (!isnan(question->curvature)) light.curvature = question->curvature;
  if (!isnan(question->laplacian)) light.curvature = question->laplacian * r2;
  light.bicurvature = question->bilaplacian * r2 * r2;
  return light;
}

// An estimate is a mean of what is not negative, and so is a variance.
static bool check_light(const struct model *model, struct problem *problem) {
  const struct local_light *light = &model->light;
  if (!(light->lambda > 0 && light->lambda <= light->photons))
    return problem_set(problem,
                       "%.4g of %.15g photons in the first disc: more than 0 and at most all are "
                       "expected (--lambda, --density, --radius, --photons)",
                       light->lambda, light->photons);
  double mean = 1 + expansion_value(&model->bias, 1);
  double variance = expansion_value(&model->variance, 1);
  if (!(mean >= 0 && mean < INFINITY && variance >= 0 && variance < INFINITY))
    return problem_set(problem,
                       "curvature %.4g: the first disc reaches beyond where the light is as said "
                       "(its mean would be %.3g, its variance %.3g); take a smaller --radius",
                       light->curvature, mean, variance);
  return true;
}

static bool check_law(const struct law *law, double alpha, uint64_t n, struct problem *problem) {
  return law->rho(alpha, n) >= DBL_MIN ||
         problem_set(problem, "--law %s: has no radius of iteration %llu at alpha %g", law->name,
                     (unsigned long long)n, alpha);
}

// ---- answers ----

static bool answer(const struct question *question, uint64_t from, struct arena *arena,
                   struct predicted *predicted, struct problem *problem) {
  const struct cell *cell = &question->cell;
  if (!check_law(cell->law, cell->alpha, cell->iterations, problem)) return false;
  struct model model =
      model_new(cell->law, cell->kernel, cell->alpha, (int)question->d, light_of(question));
  if (!check_light(&model, problem)) return false;
  *predicted = (struct predicted){.cell = cell, .model = model};
  predicted->curve = curve_of_model(&model, cell->radius, cell->iterations, arena);
  predicted->rates = rates_new(&model, cell->iterations);
  return predict_line(predicted, from, problem);
}

struct predicted *predict_said(const struct cli *cli, uint64_t from, int *n,
                               struct problem *problem) {
  struct questions questions = {0};
  if (!read_questions(cli, &questions, problem)) return NULL;
  struct predicted *predicted = arena_new(cli->arena, struct predicted, questions.count);
  for (ptrdiff_t k = 0; k < questions.count; k++)
    if (!answer(&questions.item[k], from, cli->arena, &predicted[k], problem)) return NULL;
  *n = (int)questions.count;
  return predicted;
}
