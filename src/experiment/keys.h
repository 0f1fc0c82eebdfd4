// One reader for each key of an experiment: fills its fields of a cell (or sets a problem).
#ifndef EXPERIMENT_KEYS_H
#define EXPERIMENT_KEYS_H

#include "experiment/experiment.h"
#include "experiment/value.h"

bool key_read_scene(struct reading *, const struct node *, struct cell *);
bool key_read_integrator(struct reading *, const struct node *, struct cell *);
bool key_read_alpha(struct reading *, const struct node *, struct cell *);
bool key_read_kernel(struct reading *, const struct node *, struct cell *);
bool key_read_law(struct reading *, const struct node *, struct cell *);
bool key_read_radius(struct reading *, const struct node *, struct cell *);
bool key_read_radius_volume(struct reading *, const struct node *, struct cell *);
bool key_read_reference_radius(struct reading *, const struct node *, struct cell *);
bool key_read_k(struct reading *, const struct node *, struct cell *);
bool key_read_photons(struct reading *, const struct node *, struct cell *);
bool key_read_iterations(struct reading *, const struct node *, struct cell *);
bool key_read_runs(struct reading *, const struct node *, struct cell *);
bool key_read_seed(struct reading *, const struct node *, struct cell *);
bool key_read_direct(struct reading *, const struct node *, struct cell *);
bool key_read_view(struct reading *, const struct node *, struct cell *);
bool key_read_depth(struct reading *, const struct node *, struct cell *);
bool key_read_pixel(struct reading *, const struct node *, struct cell *);
bool key_read_hit_points(struct reading *, const struct node *, struct cell *);
bool key_read_probes(struct reading *, const struct node *, struct cell *);
bool key_read_quantity(struct reading *, const struct node *, struct cell *);
bool key_read_images(struct reading *, const struct node *, struct cell *);
bool key_read_single_images(struct reading *, const struct node *, struct cell *);
bool key_read_discs(struct reading *, const struct node *, struct cell *);
bool key_read_keep(struct reading *, const struct node *, struct cell *);
bool key_read_until(struct reading *, const struct node *, struct cell *);
bool key_read_reference(struct reading *, const struct node *, struct cell *);

#endif
