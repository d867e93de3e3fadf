/* Private to run: the engine of coupled cases, made of those of bodies and grains.
 *
 * One case, four versions (cases/case.h): coupled, frozen, grains everywhere, continuum everywhere.
 * Each has a body, grains or both; what a version has not stays zero.
 *
 *     version     body                   grains                       interface grains
 *     coupled     outer cells            fine and interface           move with the body
 *     frozen      -                      fine and interface           at rest
 *     grains      -                      all                          are grains like others
 *     continuum   all cells              -                            -
 */
#ifndef CDEM_RUN_COUPLED_H
#define CDEM_RUN_COUPLED_H

#include "bsm/bsm.h"
#include "run/body.h"
#include "run/grains.h"

/* A grain that a support of the mesh holds: some components follow functions of time. */
typedef struct {
  int32_t grain;
  unsigned bits; /* 1 << c, of vx vy vz wx wy wz */
  const cdem_series *series[6];
  bool velocity[6]; /* the series is one of velocities */
} cdem_run_guided;

/* A load on grains by eq. (18): area (or area vectors, of a pressure) of each grain. */
typedef struct {
  const cdem_case_load *load;
  double *area, *normal; /* [grains], [grains][3]; NULL */
} cdem_run_edge_load;

/* What is looked at of the fine grains, once a row. */
typedef struct {
  double volumetric_strain, effective_strain; /* smallest, largest */
  double volumetric_stress, effective_stress; /* Pa; likewise */
  double kinetic, coarse_part; /* J: of the fine grains, and of what a mesh can express */
  int64_t strayed;             /* fine grains that have left the fine region for the medium */
} cdem_run_fine;

typedef struct {
  cdem_run_setup *run;
  cdem_case_version version;
  cdem_run_setup body_run, grains_run; /* the case again, each with its engine's context */
  cdem_run_body *body;                 /* of every version: it holds the mesh; solved where ... */
  bool has_body, has_grains;
  cdem_run_grains *grains; /* NULL without */
  int32_t fine_cells;
  int32_t *fine_cell; /* [fine_cells] of the mesh as read, ascending */
  cdem_partition partition;
  int64_t fine;
  int32_t *fine_grain; /* [fine] ids */
  uint8_t *not_fine;   /* [grains] 1: an interface grain, which is part of the coarse medium */
  int32_t *spare;      /* nodes inside the fine region, of the form virtual-work */
  int64_t guides, guide_room;
  cdem_run_guided *guide;
  int64_t loads, load_room;
  cdem_run_edge_load *load;
  cdem_projector projector;
  cdem_tie tie, fine_tie;
  cdem_absorb absorb; /* zero: none */
  cdem_coupling coupling;
  cdem_strain_reference *strain;
  int cycles;
  double coarse_limit;  /* s, longest stable step of the body with its interface grains */
  double *u, *d, *kept; /* [fine][width], [projector nodes][width], [fine][width] scratch */
} cdem_run_coupled;

static inline cdem_run_coupled *cdem_run_coupled_of(const cdem_run_setup *run) {
  return run->context;
}
static inline const cdem_case_coupling *cdem_run_coupled_values(const cdem_run_coupled *c) {
  return &cdem_run_values(c->run)->coupling;
}
/* Displacements and rotations of a grain that the mesh is asked to express: those of discs, in 3-D
 * displacements and all rotations. */
static inline cdem_projector_shape cdem_run_coupled_shape(const cdem_run_coupled *c) {
  return c->grains->dim == 2 ? (cdem_projector_shape){2, 1} : (cdem_projector_shape){3, 3};
}

/* coupled_parts.c: which cells and grains are fine; grains that are not needed go */
cdem_status cdem_run_coupled_cells(cdem_run_coupled *c, cdem_fault *fault);
cdem_status cdem_run_coupled_check_grains(const cdem_run_coupled *c, cdem_fault *fault);
cdem_status cdem_run_coupled_divide(cdem_run_coupled *c, cdem_fault *fault);
/* ... the operators between them, once both solvers' inputs stand */
cdem_status cdem_run_coupled_projector(cdem_run_coupled *c, cdem_fault *fault);
cdem_status cdem_run_coupled_ties(cdem_run_coupled *c, cdem_fault *fault);

/* coupled_edge.c: supports and loads where grains are at the edge of the mesh */
cdem_status cdem_run_coupled_supports(cdem_run_coupled *c, cdem_fault *fault);
cdem_status cdem_run_coupled_loads(cdem_run_coupled *c, cdem_fault *fault);
/* ... over the step to come */
void cdem_run_coupled_edge(cdem_run_coupled *c, double from, double to);
void cdem_run_coupled_edge_release(cdem_run_coupled *c);

/* coupled_steps.c: cycles, the two steps, the body's solver and the coupling */
cdem_status cdem_run_coupled_start(cdem_run_coupled *c, cdem_fault *fault);

/* coupled_fields.c: a field of all grains, [grains][3] twice, gathered for the projector into c->u;
 * and of an element's stress and strain, in the order of cdem_body_fields, what grains have: small
 * strains, stresses as cdem_effective_stress */
typedef struct {
  double volumetric_strain, effective_strain, volumetric_stress, effective_stress;
} cdem_run_cell_numbers;
void cdem_run_coupled_gather(const cdem_run_coupled *c, const double *linear,
                             const double *angular);
cdem_run_cell_numbers cdem_run_coupled_cell(int dim, const double stress[6],
                                            const double strain[6]);

/* coupled_columns.c, coupled_frames.c, coupled_pictures.c */
void cdem_run_coupled_columns(cdem_run_setup *run, cdem_run_row *row);
cdem_status cdem_run_coupled_frames(cdem_run_setup *run, int64_t index, const cdem_frame_sink *sink,
                                    cdem_fault *fault);
cdem_status cdem_run_coupled_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                      cdem_fault *fault);

#endif
