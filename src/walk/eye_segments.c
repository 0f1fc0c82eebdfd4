#include "walk/eye_segments.h"

#include "walk/flight.h"

static void append(struct eye_segments *segments, const struct walk *walk, int j) {
  int owner = walk->owner[j];
  if (segments->count == segments->capacity) {
    int64_t capacity = segments->capacity ? 2 * segments->capacity : WALK_BATCH;
    segments->segment = arena_grow(segments->arena, segments->segment, segments->capacity, capacity,
                                   sizeof *segments->segment, alignof(struct eye_segment));
    segments->capacity = capacity;
  }
  struct eye_segment *segment = &segments->segment[segments->count++];
  *segment = (struct eye_segment){
      .o = walk->ray[j].o,
      .d = walk->ray[j].d,
      .length = walk->hit[j].t,
      .medium = walk->medium[j],
      .vertex = walk->vertex,
      .point = segments->first + owner,
      .number = segments->number[owner]++,
  };
  for (int c = 0; c < walk->n_channels; c++) segment->weight[c] = walk->throughput[c][j];
}

// In place of a flight: lists the segment, adds its emission and leaves what passes.
static void go_through(void *data, struct walk *walk, int j) {
  struct eye_segments *segments = data;
  double left[3];
  append(segments, walk, j);
  for (int c = 0; c < walk->n_channels; c++) left[c] = walk->throughput[c][j];
  flight_along(walk, walk->medium[j], &walk->ray[j], walk->hit[j].t, walk->path[j], walk->vertex,
               &walk->flights[j], left, segments->point[walk->owner[j]].emitted);
  for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] = left[c];
}

void eye_segments_trace(struct eye_segments *segments, struct walk *walk, const struct pixel *pixel,
                        int n, bool footprint, int depth, struct eye_point *point,
                        struct arena *arena) {
  segments->count = 0;
  segments->arena = arena;
  walk->through = go_through;
  walk->through_data = segments;
  for (int first = 0; first < n; first += WALK_BATCH) {
    int batch = n - first < WALK_BATCH ? n - first : WALK_BATCH;
    for (int j = 0; j < batch; j++) segments->number[j] = 0;
    segments->first = first;
    segments->point = point + first;
    eye_trace(walk, pixel + first, batch, footprint, depth, point + first);
  }
  walk->through = NULL;
}

void eye_segment_transmittance(const struct walk *walk, const struct eye_segment *segment, double t,
                               uint64_t crossing, double value[3]) {
  struct ray ray = {segment->o, segment->d, INFINITY, PRIMITIVE_NONE};
  uint32_t flights = 0;
  for (int c = 0; c < walk->n_channels; c++) value[c] = 1;
  flight_shadow(walk, segment->medium, &ray, t, crossing, segment->number, &flights, value);
}
