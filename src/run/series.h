// The series of one cell of a group at one probe, within the group's moments over runs.
#ifndef RUN_SERIES_H
#define RUN_SERIES_H

#include "run/plan.h"

static inline struct series series_of(const struct group_plan *group, int cell, int probe,
                                      struct moments *moments) {
  struct moments *at = moments + plan_series(group, cell, probe);
  struct series series = {.cell = group->group->cell[cell],
                          .probe = probe,
                          .n_iterations = group->cell->iterations,
                          .iteration = at,
                          .n_checkpoints = group->n_checkpoints,
                          .checkpoint = group->checkpoint,
                          .average = at + group->average_at};
  if (group->radius_at) series.radius2 = at + group->radius_at;
  if (group->companion[cell]) series.richardson = at + group->richardson_at;
  return series;
}

#endif
