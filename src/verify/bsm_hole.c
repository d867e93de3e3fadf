/* The hole in a Cosserat medium by the static solver: a quarter ring between R = 1 m and 4 m under
 * the tractions and couples of the closed form, so that the ring's own size has no part in the
 * error (as the classical plate of cdem_plate.c). Plane strain. */
#include "verify/bsm.h"
#include "verify/cdem_world.h"
#include "verify/cosserat_hole.h"

#include <math.h>
#include <stdlib.h>

static const double outer = 4.0, tension = 1e6;
static const double poisson = 0.3, length = 1.0 / 1.063;
static const double coupling_of[] = {0.25, 0.5, 0.75, 0.9, 1e-3};

cdem_status cdem_bsm_measure_hole_closed(int parameter, double *value, cdem_fault *fault) {
  (void)fault;
  *value = cdem_cosserat_hole_factor(1.0, poisson, coupling_of[parameter], length);
  return CDEM_OK;
}

static cdem_material medium(double coupling) {
  const double young = 30e9, shear = 0.5 * young / (1.0 + poisson), n2 = coupling * coupling;
  return (cdem_material){.model = CDEM_COSSERAT,
                         .parameter = {young, poisson, shear * n2 / (1.0 - n2), length, 4.0}};
}

/* Work-equivalent forces and couples of an edge by two Gauss points on the arc. */
static void load_edge(const cdem_facet *facet, const double *xyz, const cdem_cosserat_hole *hole,
                      double *vector) {
  const double *a = xyz + 3 * facet->node[0], *b = xyz + 3 * facet->node[1];
  double from = atan2(a[1], a[0]), to = atan2(b[1], b[0]);
  for (int point = 0; point < 2; point++) {
    double share = 0.5 + (point == 0 ? -0.5 : 0.5) / sqrt(3.0), t = from + share * (to - from);
    cdem_polar_stress s;
    cdem_cosserat_hole_stress(hole, outer, t, &s);
    const double load[3] = {s.rr * cos(t) - s.rt * sin(t), s.rr * sin(t) + s.rt * cos(t), s.mr};
    for (int k = 0; k < 3; k++) {
      double force = 0.5 * outer * fabs(to - from) * load[k];
      vector[3 * facet->node[0] + k] += (1.0 - share) * force;
      vector[3 * facet->node[1] + k] += share * force;
    }
  }
}

static cdem_status load_circle(cdem_world *world, double coupling, cdem_fault *fault) {
  const double none[3] = {0.0, 0.0, 0.0};
  cdem_series constant = {0};
  cdem_cosserat_hole hole;
  int32_t facets, *facet;
  cdem_cosserat_hole_init(1.0, tension, poisson, coupling, length, &hole);
  CDEM_TRY(cdem_series_constant(1.0, &constant, fault));
  CDEM_TRY(cdem_world_traction(world, "x1", none, &constant, fault));
  CDEM_TRY(cdem_blocks_group_facets(&world->blocks, "x1", &facets, &facet, fault));
  for (int32_t f = 0; f < facets; f++)
    load_edge(&world->blocks.facet[facet[f]], world->blocks.mesh.xyz, &hole,
              (double *)world->load[0].vector);
  free(facet);
  return CDEM_OK;
}

/* Root mean square error of the rotation over its largest value. */
static double rotation_error(const cdem_world *world, double coupling) {
  cdem_cosserat_hole hole;
  const double *p = world->material.parameter;
  double modulus = p[4] * 0.5 * p[0] / (1.0 + p[1]) * p[3] * p[3], sum = 0.0, largest = 0.0;
  cdem_cosserat_hole_init(1.0, tension, poisson, coupling, length, &hole);
  for (int32_t i = 0; i < world->body.nodes; i++) {
    const double *x = world->blocks.mesh.xyz + 3 * i;
    cdem_polar_stress s;
    cdem_cosserat_hole_stress(&hole, hypot(x[0], x[1]), atan2(x[1], x[0]), &s);
    sum += pow(world->solver.u[3 * i + 2] - s.psi / modulus, 2.0);
    largest = fmax(largest, fabs(s.psi / modulus));
  }
  return sqrt(sum / world->body.nodes) / largest;
}

/* On both axes of symmetry neither the displacement across nor the rotation can be. */
static cdem_status solve(cdem_world *world, double coupling, int n, double *factor,
                         cdem_fault *fault) {
  const cdem_material material = medium(coupling);
  const cdem_world_options options = {.density = 2700.0, .material = &material};
  CDEM_TRY(cdem_world_quarter_ring(world, n, outer, fault));
  CDEM_TRY(cdem_world_build(world, &options, fault));
  CDEM_TRY(cdem_world_support(world, "y0", 1, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y0", 2, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y1", 0, false, 0.0, 0.0, fault));
  CDEM_TRY(cdem_world_support(world, "y1", 2, false, 0.0, 0.0, fault));
  CDEM_TRY(load_circle(world, coupling, fault));
  CDEM_TRY(cdem_world_start(world, fault));
  CDEM_TRY(cdem_solver_static(&world->solver, 0.0, fault));
  return cdem_world_crown_stress(world, factor, fault);
}

typedef struct {
  double factor, rotation; /* errors, relative */
} errors;

static cdem_status errors_at(double coupling, int n, errors *found, cdem_fault *fault) {
  cdem_world world = {0};
  double stress = 0.0, exact = cdem_cosserat_hole_factor(1.0, poisson, coupling, length);
  cdem_status status = solve(&world, coupling, n, &stress, fault);
  if (status == CDEM_OK) {
    found->factor = stress / tension / exact - 1.0;
    found->rotation = rotation_error(&world, coupling);
  }
  cdem_world_release(&world);
  return status;
}

cdem_status cdem_bsm_measure_hole(int parameter, double *value, cdem_fault *fault) {
  double coupling = coupling_of[parameter % 10];
  int what = parameter / 10;
  errors coarse = {0.0, 0.0}, fine = {0.0, 0.0};
  if (what == 1 || what == 3)
    CDEM_TRY(errors_at(coupling, 16, &coarse, fault));
  CDEM_TRY(errors_at(coupling, what == 2 ? 64 : 32, &fine, fault));
  *value = what == 1   ? log2(fabs(coarse.factor) / fabs(fine.factor))
           : what == 3 ? log2(coarse.rotation / fine.rotation)
                       : 1.0 + fine.factor;
  return CDEM_OK;
}
