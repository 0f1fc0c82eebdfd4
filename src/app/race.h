// The results of an experiment that races methods against each other: cells of one run, several
// seeds a method, against references, which are the cells of several runs of the same scene.
#ifndef APP_RACE_H
#define APP_RACE_H

#include "analysis/pace.h"
#include "analysis/reference_image.h"
#include "log/results.h"

// A method's runs at the N of its images.
struct method {
  const char *name;         // its integrator, and what tells it from others of that integrator
  const struct cell **cell; // [n_runs]
  int n_runs, n_points;
  double *time_s, *error; // [n_runs][n_points]; CPU seconds, relative mean square errors
  double *mean;           // [n_runs], of the last image
  int n_counted;          // points before the first whose error the reference's has a share in
  struct pace pace;       // of those
};

// A scene with its methods.
struct field {
  const char *scene;
  const struct cell *truth;
  struct reference_image reference;
  int n_methods;
  struct method *method;
  double last_s; // the last time that all methods have reached; NAN: there is none, as where a
                 // method has no point that counts
};

struct race {
  const struct results *results;
  int n_fields;
  struct field *field;
};

// A reference counts for nothing where errors are at least so many times its own.
enum { REFERENCE_MARGIN = 5 };

bool race_read(const struct results *, struct arena *, struct race *, struct problem *);

// How far the mean of a method's last images is from the reference's, as a share of that.
struct pace_error method_mean(const struct field *, const struct method *);

struct pace_error method_point(const struct method *, int j); // error over runs at point j
double method_time(const struct method *, int j);             // mean over runs

#endif
