#include "density/beam_gather.h"

#include "numeric/sum.h"

static void reserve(struct beam_gather *gather, int64_t count, int n_channels,
                    struct arena *arena) {
  if (count <= gather->capacity) return;
  gather->capacity = 2 * count;
  gather->found = arena_new(arena, uint32_t, gather->capacity);
  gather->u2 = arena_new(arena, double, gather->capacity);
  gather->weight = arena_new(arena, double, gather->capacity);
  for (int c = 0; c < n_channels; c++)
    gather->value[c] = arena_new(arena, double, gather->capacity);
}

// Whether light of this beam may be seen, on a path of at most `depth` scatterings.
static bool is_seen(const struct beam_gather *gather, const struct photon_beam *beam,
                    const struct eye_segment *eye, int depth) {
  return beam->vertex + eye->vertex < depth && !(beam->kind & gather->left_out);
}

// value[c] of a crossing: all but the kernel and what all crossings of the segment share.
static void weigh_one(struct beam_gather *gather, const struct walk *walk,
                      const struct beams *beams, const struct eye_segment *eye, uint32_t number,
                      const struct crossing_point *crossing, int at) {
  const struct medium *medium = &walk->scene->medium[eye->medium];
  const struct photon_beam *beam = &beams->beam[number];
  struct bsdf phase = medium_bsdf(medium);
  struct medium_point x;
  double f[3], left[3], sine = sqrt(crossing->sine2);
  medium->type->at(medium, vec_along(eye->o, eye->d, crossing->t), &x);
  bsdf_value(&phase, vec_scale(eye->d, -1), vec_scale(beam->d, -1), TRANSPORT_RADIANCE, f);
  eye_segment_transmittance(walk, eye, crossing->t, number, left);
  for (int c = 0; c < walk->n_channels; c++)
    gather->value[c][at] = left[c] * x.sigma_s[c] * f[c] * beams->flux[c][number] / sine;
  gather->u2[at] = crossing->u2;
}

static int weigh(struct beam_gather *gather, const struct walk *walk, const struct beams *beams,
                 const struct eye_segment *eye, int depth, double r, int64_t found) {
  int kept = 0;
  for (int64_t j = 0; j < found; j++) {
    const struct photon_beam *beam = &beams->beam[gather->found[j]];
    struct crossing_point crossing;
    if (!is_seen(gather, beam, eye, depth)) continue;
    if (!crossing_find(eye, beam, r * r, &crossing)) continue; // always does
    weigh_one(gather, walk, beams, eye, gather->found[j], &crossing, kept++);
  }
  return kept;
}

static bool is_a_strip(double r) { return r * r > 0 && r * r < INFINITY; }

static double largest_radius(const struct strip *strip, int n_strips) {
  double r = 0;
  for (int e = 0; e < n_strips; e++)
    if (is_a_strip(strip[e].r)) r = r < strip[e].r ? strip[e].r : r;
  return r;
}

void beam_gather_segment(struct beam_gather *gather, const struct walk *walk,
                         const struct beams *beams, const struct beam_tree *tree,
                         const struct eye_segment *eye, int depth, const struct strip *strip,
                         int n_strips, double *out, long stride, struct arena *arena) {
  reserve(gather, beams->count, beams->n_channels, arena);
  double r = largest_radius(strip, n_strips);
  int64_t found = tree ? beam_tree_find(tree, beams, eye, r, gather->found)
                       : beam_find_all(beams, eye, r, gather->found);
  int n = weigh(gather, walk, beams, eye, depth, r, found);
  for (int e = 0; e < n_strips; e++) {
    if (n == 0 || !is_a_strip(strip[e].r)) continue;
    kernel_weigh(strip[e].kernel, gather->u2, strip[e].r, gather->weight, n);
    for (int c = 0; c < beams->n_channels; c++)
      out[e * stride + c] +=
          eye->weight[c] * (strip[e].scale * sum_products(gather->weight, gather->value[c], n));
  }
}
