/* Private to run: a case made into a solver, with everything that the solver borrows. */
#ifndef CDEM_RUN_SETUP_H
#define CDEM_RUN_SETUP_H

#include "cases/case.h"
#include "cdem/cdem.h"
#include "run/run.h"

/* What waves and penalty springs need of a material in the formulation of the run, Pa. */
typedef struct {
  double wave, shear; /* lambda + 2G (of the sheet in plane stress), G */
} cdem_run_moduli;

/* What acts on the body. Names and series are the case's; the arrays of nodes, facets and vectors
 * belong to their entry. */
typedef struct {
  int supports;
  cdem_support *support;
  int loads;
  cdem_load *load;
  int pressures;
  cdem_pressure *pressure;
  int quiets;
  cdem_quiet *quiet;
  int plates;
  cdem_plate *plate;
  double *velocity; /* [nodes][dofs]; NULL: rest */
  cdem_series unit; /* 1 at all times; owned */
  int64_t capacity[5];
} cdem_run_conditions;

typedef struct {
  const cdem_run_options *options;
  cdem_case cases;
  uint64_t case_sum, mesh_sum; /* FNV-1a of the case's text and of the mesh's arrays */
  uint64_t kept_sum;  /* of the text in the folder, which names the mesh from the root on */
  cdem_mesh mesh;     /* as read */
  cdem_blocks blocks; /* cut */
  cdem_model model;   /* of blocks.mesh */
  cdem_section section;
  double *density;         /* [materials] kg/m^3 */
  double *micro_inertia;   /* [materials] m^2 */
  cdem_run_moduli *moduli; /* [materials] */
  int32_t *model_of;       /* [blocks.mesh.cells] index into the model, -1 */
  double *volume;          /* [model.cells] m^3 */
  int threads;             /* as asked, or what the size of the body is worth */
  cdem_body body;
  cdem_interfaces interfaces;
  cdem_contact contact;
  bool has_interfaces, has_contact;
  double contact_wave, contact_size; /* stiffest modulus and mean facet size, for penalties */
  double contact_ratio;              /* G/(lambda + 2G) of that material */
  cdem_run_conditions conditions;
  cdem_solver_options solver_options;
  cdem_solver solver;
  char limiter[64]; /* what limits the step */
} cdem_run_setup;

/* The whole way from options to a solver at time zero. `checkpoint`: state of a broken run, whose
 * mesh is taken (the solver is restored by the caller); NULL: the mesh is read or generated.
 * Release at any stage. */
cdem_status cdem_run_setup_init(const cdem_run_options *options, const cdem_state *checkpoint,
                                cdem_run_setup *setup, cdem_fault *fault);
void cdem_run_setup_release(cdem_run_setup *setup);

/* ---- its steps, one file each ---- */

/* mesh.c */
cdem_status cdem_run_setup_mesh(cdem_run_setup *setup, cdem_fault *fault);
/* body.c: blocks, model, body */
cdem_status cdem_run_setup_body(cdem_run_setup *setup, cdem_fault *fault);
/* interfaces.c, contact.c */
cdem_status cdem_run_setup_interfaces(cdem_run_setup *setup, cdem_fault *fault);
cdem_status cdem_run_setup_contact(cdem_run_setup *setup, cdem_fault *fault);
/* conditions.c: supports, plates, initial velocities; loads.c: loads, pressures, quiet boundaries
 */
cdem_status cdem_run_setup_conditions(cdem_run_setup *setup, cdem_fault *fault);
cdem_status cdem_run_setup_loads(cdem_run_setup *setup, cdem_fault *fault);
void cdem_run_conditions_release(cdem_run_conditions *conditions);
/* solver.c: time step and solver */
cdem_status cdem_run_setup_solver(cdem_run_setup *setup, cdem_fault *fault);

/* ---- what they share (setup.c) ---- */

/* A group of the mesh (once there is one, of the cut mesh) that the value at `key` names;
 * CDEM_INPUT at that place when there is none or when its dimension is not between least and most.
 */
cdem_status cdem_run_find_group(const cdem_run_setup *setup, const char *key, const char *name,
                                int least, int most, const cdem_group **group, cdem_fault *fault);
/* Is this cell in the group? */
bool cdem_run_group_holds(const cdem_group *group, int32_t cell);
/* "'a', 'b'": groups that hold the cell; or of all with a dimension in the range (cell -1). */
void cdem_run_group_names(const cdem_mesh *mesh, int32_t cell, int least, int most, char text[200]);
/* Density of a cell of the cut mesh, or an error at its material that names what it is for. */
cdem_status cdem_run_density(const cdem_run_setup *setup, int material, const char *purpose,
                             cdem_fault *fault);
/* Area of a facet in the reference position, m^2, its corners' shares and its outward area vector.
 */
double cdem_run_facet(const cdem_run_setup *setup, const cdem_facet *facet, double area[3],
                      double share[4]);
/* Degree of freedom of component x y z rotation; -1 and an error at section[i].rest.COMPONENT when
 * the model has none. */
cdem_status cdem_run_dof(const cdem_run_setup *setup, const char *key, int component, int *dof,
                         cdem_fault *fault);
extern const char *const cdem_run_component[4];
/* Moduli of a cell of the cut mesh. */
static inline const cdem_run_moduli *cdem_run_cell_moduli(const cdem_run_setup *setup,
                                                          int32_t cell) {
  return &setup->moduli[setup->model.material[setup->model_of[cell]]];
}
static inline const cdem_case_values *cdem_run_values(const cdem_run_setup *setup) {
  return &setup->cases.values;
}
/* "section[i].rest" or "section.name.rest" into text [96]. */
const char *cdem_run_key(char text[96], const char *section, int64_t index, const char *rest);
const char *cdem_run_named_key(char text[96], const char *section, const char *name,
                               const char *rest);

#endif
