// photonlab predict: what theory expects of an average of N iterations, before any is run.
#ifndef APP_PREDICT_H
#define APP_PREDICT_H

#include "analysis/curve.h"
#include "analysis/rates.h"
#include "app/cli.h"

#include <stdio.h>

// One law, kernel, alpha and dimension under one light.
struct predicted {
  const struct cell *cell;
  const struct probe *probe; // NULL: the light was said, not found in a scene
  struct model model;        // its light NAN where theory does not know it
  struct curve curve;
  uint64_t from; // of the straight line
  struct slopes slopes;
  struct rates rates;
};

// `from`: where the straight line begins; 0: two decades before the end. NULL: a problem.
// Of lists of laws, kernels, alphas, ..., and a light, said on the command line.
struct predicted *predict_said(const struct cli *, uint64_t from, int *n, struct problem *);
// Of each cell and probe of the experiment that is the command's argument, in their order.
struct predicted *predict_experiment(const struct cli *, uint64_t from, int *n, struct problem *);

// Sets `from` and the slopes, all else being there; false: `from` is beyond the end.
bool predict_line(struct predicted *, uint64_t from, struct problem *);

// One: its curve and what follows. Several: a line each.
void predict_print(const struct predicted *, int n, FILE *);
// A line for each point of each curve.
void predict_print_csv(const struct predicted *, int n, FILE *);

// ---- what they are made of ----

// The measure of a ball of d dimensions.
double predict_ball(int d, double radius);

enum { PREDICT_TEXT = 64 };
// A dash for what is not known.
void predict_number(char text[PREDICT_TEXT], double);
// What the column of this head says.
void predict_text(const struct predicted *, const char *head, char text[PREDICT_TEXT]);
// In one line what is the same of all that was asked, in a table the rest.
void predict_print_common(const struct predicted *, int n, FILE *);
void predict_print_table(const struct predicted *, int n, FILE *);

#endif
