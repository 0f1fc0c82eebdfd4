// The eye pass of photon beams: rays are not ended by collisions. What lies in media of a pixel's
// path, up to the first surface that scatters light other than as a mirror or clear glass does, is
// a list of segments; what a medium leaves of the light on the way is in the weights of what comes
// after.
#ifndef WALK_EYE_SEGMENTS_H
#define WALK_EYE_SEGMENTS_H

#include "walk/eye.h"

struct eye_segment {
  struct vec o, d;  // d of unit length, away from the eye
  double length;    // INFINITY: the medium has no end there
  double weight[3]; // of radiance towards the eye at o, in the pixel
  uint32_t medium;  // row of scene.medium
  int vertex;       // scatterings between the camera and here
  int point;        // whose path this is on
  int number;       // on this path, from 0
};

// In the order of (batch, vertex, crossing, point).
struct eye_segments {
  int64_t count, capacity;
  struct eye_segment *segment;
  struct eye_point *point; // those of the batch, and how many segments each has
  int number[WALK_BATCH];
  int first; // point of the batch
  struct arena *arena;
};

// eye_trace (walk/eye.h) with segments: no point is in a medium, `emitted` holds what media emit
// along the segments too. Segments are emptied first and grow in the arena.
void eye_segments_trace(struct eye_segments *, struct walk *, const struct pixel *, int n,
                        bool footprint, int depth, struct eye_point *, struct arena *);

// Transmittance per channel of a segment from its start to distance t. In media that are not
// uniform it is an estimate, random in (walk->key, walk->iteration, crossing, segment.number).
void eye_segment_transmittance(const struct walk *, const struct eye_segment *, double t,
                               uint64_t crossing, double value[3]);

#endif
