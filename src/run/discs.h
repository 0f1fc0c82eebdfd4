// The points of run 1 with their own radii, after the passes that cells ask for (key `discs`).
#ifndef RUN_DISCS_H
#define RUN_DISCS_H

#include "run/plan.h"

// Repeats run 1 of the group, as far as the last pass wanted, and writes for each of its cells
// discs/SCENE-cellCCC-I.csv: a row for each point that scatters light,
//   x,y            its pixel
//   px,py,pz       where it is, scene units
//   nx,ny,nz       unit geometric normal on the side of the eye
//   radius         kernel support after pass I, scene units
//   u,v            where the camera sees it, pixels from the top left corner of the film (of what
//                  is seen in mirrors or through glass: where the straight line meets the film);
//                  nan behind the camera
//   u1,v1,u2,v2    conjugate half-axes of the disc's image, pixels: what the projection is near it
bool discs_write(const struct group_plan *, const struct experiment *, const char *directory,
                 struct arena scratch, struct problem *);

#endif
