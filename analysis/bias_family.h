// The bias of iteration i with its rate varied, for fitting the rate: theory's own curve, tilted.
#ifndef ANALYSIS_BIAS_FAMILY_H
#define ANALYSIS_BIAS_FAMILY_H

#include "analysis/prediction.h"

// Theory's rate: of |bias of iteration i| ~ i^-rate, or where discs come clear of an edge and bias
// ends, of |bias of the average of N iterations| ~ N^-rate. NAN: none, the edge stays in the disc.
double bias_theory_rate(const struct prediction *);

// shape[i - 1] at this rate, in units of prediction.bias, and its derivative by the rate; [n].
void bias_family(const struct prediction *, double rate, double *shape, double *slope);

#endif
