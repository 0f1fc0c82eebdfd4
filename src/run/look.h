// Runs that end when rates are known well enough (key `until`): after 32, 64, 128, ... of them what
// is asked for is looked at; the last look is at all the runs a file allows. A look sees standard
// errors, never whether anything agrees; how many there were goes to the manifest, and the fit
// divides its level by it.
#ifndef RUN_LOOK_H
#define RUN_LOOK_H

#include "run/plan.h"

// The first runs of groups with `until`; all runs of the others.
void look_begin(struct plan *);

// After all planned runs are made: groups whose rates are not known well enough get twice as many.
// False: none does. Problem set: a look failed.
bool look_again(struct plan *, struct probe *const *probe, const char *folder, struct arena scratch,
                struct problem *);

// The plan's experiment with the runs that were made.
void look_end(struct plan *, struct arena *);

#endif
