// The curves of predictions, for other programs.
#include "app/predict.h"

#include <inttypes.h>
#include <math.h>

static void print_real(FILE *out, double x) {
  isfinite(x) ? fprintf(out, ",%.17g", x) : fputs(",nan", out);
}

// Names of ours need no quotes; a scene's might, then quotes in it are doubled.
static void print_name(FILE *out, const char *text) {
  fputs(",\"", out);
  for (; *text; text++) fprintf(out, *text == '"' ? "\"%c" : "%c", *text);
  fputc('"', out);
}

static void print_csv_point(const struct predicted *p, int k, FILE *out) {
  const struct curve_point *point = &p->curve.point[k];
  const struct local_light *light = &p->model.light;
  struct slopes slopes = curve_local_slopes(&p->curve, k);
  fprintf(out, "%d", p->cell->number);
  print_name(out, p->probe ? p->cell->scene : "");
  if (p->probe)
    fprintf(out, ",%d,%d", p->probe->x, p->probe->y);
  else
    fputs(",,", out);
  fprintf(out, ",%s,%s,%d,%.17g,%" PRIu64, p->model.law->name, p->model.kernel->name, p->model.d,
          p->model.alpha, p->cell->photons);
  const double light_value[] = {light->lambda, light->curvature, light->mu};
  for (int j = 0; j < 3; j++) print_real(out, light_value[j]);
  fprintf(out, ",%" PRIu64, point->n);
  const double sum[] = {point->rho, point->radius, point->plus, point->minus};
  for (int j = 0; j < 4; j++) print_real(out, sum[j]);
  const double value[] = {point->variance_one, point->bias_one, point->variance, point->bias,
                          point->rmse};
  for (int j = 0; j < 5; j++) print_real(out, p->curve.shape ? NAN : value[j]);
  print_real(out, slopes.variance);
  print_real(out, slopes.bias);
  fputc('\n', out);
}

void predict_print_csv(const struct predicted *p, int n, FILE *out) {
  fputs("cell,scene,x,y,law,kernel,dimension,alpha,photons,lambda,curvature,mu,N,rho,radius,s_plus,"
        "s_minus,variance_one,bias_one,variance,bias,rmse,variance_slope,bias_slope\n",
        out);
  for (int k = 0; k < n; k++)
    for (int j = 0; j < p[k].curve.n; j++) print_csv_point(&p[k], j, out);
}
