// Sums of the measure ratio rho_i over iterations: what the average of N iterations inherits from
// each (theory 3.1). Closed forms for the Knaus-Zwicker law, sums of blocks for any other.
#ifndef ANALYSIS_SUMS_H
#define ANALYSIS_SUMS_H

#include "density/law.h"

#include <stdint.h>

// Knaus-Zwicker, alpha in [0, 1], n from 1 to 1e15.
double sums_minus(double alpha, uint64_t n);           // S-: sum of 1/rho_i, i = 1..n
double sums_plus(double alpha, uint64_t n);            // S+: sum of rho_i
double sums_power(double alpha, double p, uint64_t n); // T_p: sum of rho_i^p

// The sum of rho_i^p for any law: closed forms for the sequence of Knaus and Zwicker, else blocks
// of doubling length, right to 1e-13 in a time of ln n where rho is smooth.
double sums_law(const struct law *, double alpha, double p, uint64_t n);

// Term by term: time in proportion to n.
double sums_direct(const struct law *, double alpha, double p, uint64_t n);

#endif
