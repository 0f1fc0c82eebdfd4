#include "log/log.h"

#include <inttypes.h>

const struct log_column log_columns[] = {
    {"cell", "1", "number of the cell, from 0, in the order of the experiment"},
    {"scene", "name", "base name of the scene file"},
    {"probe", "1", "number of the probe, from 0 (probes.csv says where it is)"},
    {"integrator", "name", "what computed the iteration"},
    {"kernel", "name", "of the density estimate"},
    {"law", "name", "radius sequence"},
    {"alpha", "1", "fraction kept"},
    {"series", "name",
     "iteration: of iteration i alone; average: running average of 1..i; squared-radius: of the "
     "probe in iteration i (local statistics, of points on surfaces); richardson: bias of "
     "iteration i, 4/3 of what half "
     "the radius takes away"},
    {"i", "1", "iteration, from 1"},
    {"radius", "reference radius",
     "kernel support of iteration i, of a probe in a medium the one there; scene unit where it is "
     "global"},
    {"n", "1", "runs"},
    {"mean", "W sr^-1 m^-2",
     "mean over runs of the luminance of radiance (squared-radius: scene unit^2)"},
    {"m2", "(W sr^-1 m^-2)^2", "sum over runs of (x - mean)^2"},
    {"m3", "(W sr^-1 m^-2)^3", "sum over runs of (x - mean)^3"},
    {"m4", "(W sr^-1 m^-2)^4", "sum over runs of (x - mean)^4"},
};
const int n_log_columns = sizeof log_columns / sizeof *log_columns;

void log_write_header(FILE *out) {
  for (int k = 0; k < n_log_columns; k++) fprintf(out, "%s%s", k ? "," : "", log_columns[k].name);
  fputc('\n', out);
}

static void write_row(FILE *out, const struct cell *cell, double radius, int probe,
                      const char *series, uint64_t i, struct moments m) {
  fprintf(out, "%d,%s,%d,%s,%s,%s,%.17g,%s,%" PRIu64 ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
          cell->number, cell->scene, probe, cell->integrator->name, cell->kernel->name,
          cell->law->name, cell->alpha, series, i, radius, m.n, m.mean, m.m2, m.m3, m.m4);
}

static double radius_of(const struct cell *cell, const struct probe *probe, uint64_t i) {
  return law_radius(cell->law, cell->alpha, probe_radius(cell, probe), probe_dimension(cell, probe),
                    i);
}

void log_write_series(FILE *out, const struct cell *cell, const struct probe *probe,
                      const struct series *series) {
  uint64_t n = series->n_iterations;
  for (uint64_t i = 1; i <= n; i++)
    write_row(out, cell, radius_of(cell, probe, i), series->probe, "iteration", i,
              series->iteration[i - 1]);
  for (int k = 0; k < series->n_checkpoints; k++)
    write_row(out, cell, radius_of(cell, probe, series->checkpoint[k]), series->probe, "average",
              series->checkpoint[k], series->average[k]);
  for (uint64_t i = 1; series->radius2 && i <= n; i++)
    write_row(out, cell, radius_of(cell, probe, i), series->probe, "squared-radius", i,
              series->radius2[i - 1]);
  for (uint64_t i = 1; series->richardson && i <= n; i++)
    write_row(out, cell, radius_of(cell, probe, i), series->probe, "richardson", i,
              series->richardson[i - 1]);
}

const char probes_header[] = "cell,probe,x,y,hit,px,py,pz,nx,ny,nz,scale_r,scale_g,scale_b,"
                             "emitted,reference,reference_se";

void probes_write(FILE *out, const struct cell *cell, const struct probe *probe, int n_probes) {
  for (int p = 0; p < n_probes; p++, probe++) {
    int hit = probe->hit + 2 * probe->volume + 4 * probe->ends;
    fprintf(out,
            "%d,%d,%d,%d,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,"
            "%.17g\n",
            cell->number, p, probe->x, probe->y, hit, probe->p.x, probe->p.y, probe->p.z,
            probe->n.x, probe->n.y, probe->n.z, probe->scale_rgb[0], probe->scale_rgb[1],
            probe->scale_rgb[2], probe->emitted, probe->reference, probe->reference_se);
  }
}
