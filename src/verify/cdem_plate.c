/* The plate with a hole: a quarter ring between the hole, r = 1 m, and r = 4 m under Kirsch's
 * tractions (docs/theory/cdem.md, eq. (16)). Plane stress; the factor does not depend on it. */
#include "verify/cdem.h"
#include "verify/cdem_world.h"

#include <math.h>
#include <stdlib.h>

static const double outer = 4.0, tension = 1e6;

/* Traction on the circle at angle t: rows of the stress in polar axes turned to x and y. */
static void traction(double angle, double t[2]) {
  double q = 1.0 / (outer * outer), s = 0.5 * tension;
  double rr = s * (1.0 - q + (1.0 - 4.0 * q + 3.0 * q * q) * cos(2.0 * angle));
  double rt = -s * (1.0 + 2.0 * q - 3.0 * q * q) * sin(2.0 * angle);
  t[0] = rr * cos(angle) - rt * sin(angle);
  t[1] = rr * sin(angle) + rt * cos(angle);
}

/* Work-equivalent forces of an edge by two Gauss points on the arc. */
static void load_edge(const cdem_facet *facet, const double *xyz, double *vector) {
  const double *a = xyz + 3 * facet->node[0], *b = xyz + 3 * facet->node[1];
  double from = atan2(a[1], a[0]), to = atan2(b[1], b[0]);
  for (int point = 0; point < 2; point++) {
    double share = 0.5 + (point == 0 ? -0.5 : 0.5) / sqrt(3.0), t[2];
    traction(from + share * (to - from), t);
    for (int k = 0; k < 2; k++) {
      double force = 0.5 * outer * fabs(to - from) * t[k];
      vector[2 * facet->node[0] + k] += (1.0 - share) * force;
      vector[2 * facet->node[1] + k] += share * force;
    }
  }
}

static cdem_status load_circle(cdem_world *world, cdem_fault *fault) {
  const double none[3] = {0.0, 0.0, 0.0};
  cdem_series constant = {0};
  int32_t facets, *facet;
  CDEM_TRY(cdem_series_constant(1.0, &constant, fault));
  CDEM_TRY(cdem_world_traction(world, "x1", none, &constant, fault));
  CDEM_TRY(cdem_blocks_group_facets(&world->blocks, "x1", &facets, &facet, fault));
  for (int32_t f = 0; f < facets; f++)
    load_edge(&world->blocks.facet[facet[f]], world->blocks.mesh.xyz,
              (double *)world->load[0].vector);
  free(facet);
  return CDEM_OK;
}

static cdem_status solve(cdem_world *world, int n, double *factor, cdem_fault *fault) {
  const cdem_world_options options = {
      .young = 30e9, .poisson = 0.3, .density = 2700.0, .plane_stress = true};
  CDEM_TRY(cdem_world_quarter_ring(world, n, outer, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(cdem_world_support(world, "y0", 1, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y1", 0, false, 0.0, 0.0, fault));
  CDEM_TRY(load_circle(world, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  CDEM_TRY(cdem_solver_static(&world->solver, 0.0, fault));
  CDEM_TRY(cdem_world_crown_stress(world, factor, fault));
  *factor /= tension;
  return CDEM_OK;
}

cdem_status cdem_cdem_measure_kirsch(int parameter, double *value, cdem_fault *fault) {
  double factor[2] = {0.0, 0.0};
  for (int i = 0; i < 2; i++) {
    cdem_world world = {0};
    cdem_status status = solve(&world, i == 0 ? 16 : 32, &factor[i], fault);
    cdem_world_release(&world);
    CDEM_TRY(status);
  }
  *value = parameter == 0 ? factor[1] : log2(fabs(factor[0] - 3.0) / fabs(factor[1] - 3.0));
  return CDEM_OK;
}
