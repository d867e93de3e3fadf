/* Private to run: the engine of bodies on spring networks: a case made into a solver, with
 * everything that the solver borrows. */
#ifndef CDEM_RUN_BODY_H
#define CDEM_RUN_BODY_H

#include "cdem/cdem.h"
#include "run/setup.h"

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

/* A probe of the case, resolved. */
typedef struct {
  int32_t nodes;
  int32_t *node; /* displacement, velocity, force; stress of a group of points, lines or faces */
  const cdem_group *cells; /* stress of a group of volumes: mean by volume; else NULL */
} cdem_run_probe;

typedef struct {
  cdem_run_probe *probe; /* [probes of the case] */
  double *velocity;      /* [nodes][dofs] scratch */
  double *cell_stress;   /* [model cells][6] scratch; NULL when no probe needs it */
  double *node_stress;   /* [nodes][6] scratch, likewise */
} cdem_run_probes;

typedef struct {
  cdem_run_setup *run;
  cdem_mesh mesh;     /* as read */
  cdem_blocks blocks; /* cut */
  cdem_model model;   /* of blocks.mesh */
  cdem_section section;
  double *density;         /* [materials] kg/m^3 */
  double *micro_inertia;   /* [materials] m^2 */
  bool *no_tension;        /* [materials] */
  cdem_run_moduli *moduli; /* [materials] */
  int32_t *model_of;       /* [blocks.mesh.cells] index into the model, -1 */
  double *volume;          /* [model.cells] m^3 */
  cdem_body body;
  cdem_interfaces interfaces;
  cdem_contact contact;
  bool has_interfaces, has_contact;
  double contact_wave, contact_size; /* stiffest modulus and mean facet size, for penalties */
  double contact_ratio;              /* G/(lambda + 2G) of that material */
  cdem_run_conditions conditions;
  cdem_solver_options solver_options;
  cdem_solver solver;
  cdem_run_probes probes;
  /* What a coupled run asks for; 0 in others. */
  const char *only;       /* group of the mesh that the body is made of; NULL: all of it */
  int32_t spare;          /* nodes of the mesh that are kept though no cell of it has them: */
  const int32_t *spares;  /* [spare]; they are the last of blocks.mesh, in this order */
  double rotation_factor; /* on micro_inertia; 0: 1 */
  double fixed_step;      /* s; 0: as the case says */
} cdem_run_body;

/* A body with its mesh read (or taken from a checkpoint); then everything but the solver; then the
 * solver and the probes. Where the first fails nothing is made. */
cdem_status cdem_run_body_create(cdem_run_setup *run, const cdem_state *checkpoint,
                                 cdem_run_body **body, cdem_fault *fault);
cdem_status cdem_run_body_build(cdem_run_body *body, cdem_fault *fault);
cdem_status cdem_run_body_start(cdem_run_body *body, cdem_fault *fault);

/* ---- the steps of its making, one file each ---- */

/* body_mesh.c */
cdem_status cdem_run_body_mesh(cdem_run_body *setup, cdem_fault *fault);
/* body_model.c: blocks, model, body; the body alone, again with another rotation_factor */
cdem_status cdem_run_body_model(cdem_run_body *setup, cdem_fault *fault);
cdem_status cdem_run_body_elastic(cdem_run_body *setup, cdem_fault *fault);
/* body_interfaces.c, body_contact.c */
cdem_status cdem_run_body_interfaces(cdem_run_body *setup, cdem_fault *fault);
cdem_status cdem_run_body_contact(cdem_run_body *setup, cdem_fault *fault);
/* Normal stiffness of the contact, Pa/m. */
double cdem_run_contact_stiffness(const cdem_run_body *setup);
/* body_conditions.c: supports, plates, initial velocities; body_loads.c: loads, pressures, quiet
 * boundaries */
cdem_status cdem_run_body_conditions(cdem_run_body *setup, cdem_fault *fault);
cdem_status cdem_run_body_loads(cdem_run_body *setup, cdem_fault *fault);
void cdem_run_conditions_release(cdem_run_conditions *conditions);
/* body_solver.c: time step and solver */
cdem_status cdem_run_body_solver(cdem_run_body *setup, cdem_fault *fault);

/* ---- what is looked at ---- */

/* body_columns.c */
void cdem_run_body_columns(cdem_run_setup *run, cdem_run_row *row);
/* body_pictures.c */
cdem_status cdem_run_body_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                   cdem_fault *fault);
/* body_probes.c */
cdem_status cdem_run_probes_init(const cdem_run_body *setup, cdem_run_probes *probes,
                                 cdem_fault *fault);
void cdem_run_probes_release(const cdem_run_body *setup, cdem_run_probes *probes);
/* Fields that probes look at, once a row. */
void cdem_run_probes_update(const cdem_run_body *setup, cdem_run_probes *probes);
double cdem_run_probe_value(const cdem_run_body *setup, const cdem_run_probes *probes,
                            int64_t probe);
const char *cdem_run_probe_unit(const cdem_case_probe *probe);

/* ---- what they share (body_groups.c) ---- */

/* A group of the mesh (once there is one, of the cut mesh) that the value at `key` names;
 * CDEM_INPUT at that place when there is none or when its dimension is not between least and most.
 */
cdem_status cdem_run_find_group(const cdem_run_body *setup, const char *key, const char *name,
                                int least, int most, const cdem_group **group, cdem_fault *fault);
/* Is this cell in the group? */
bool cdem_run_group_holds(const cdem_group *group, int32_t cell);
/* "'a', 'b'": groups that hold the cell; or of all with a dimension in the range (cell -1). */
void cdem_run_group_names(const cdem_mesh *mesh, int32_t cell, int least, int most, char text[200]);
/* Density of a cell of the cut mesh, or an error at its material that names what it is for. */
cdem_status cdem_run_density(const cdem_run_body *setup, int material, const char *purpose,
                             cdem_fault *fault);
/* Area of a facet in the reference position, m^2, its corners' shares and its outward area vector.
 */
double cdem_run_facet(const cdem_run_body *setup, const cdem_facet *facet, double area[3],
                      double share[4]);
/* Degree of freedom of component x y z rotation; -1 and an error at section[i].rest.COMPONENT when
 * the model has none. */
cdem_status cdem_run_dof(const cdem_run_body *setup, const char *key, int component, int *dof,
                         cdem_fault *fault);
/* Moduli of a cell of the cut mesh. */
static inline const cdem_run_moduli *cdem_run_cell_moduli(const cdem_run_body *setup,
                                                          int32_t cell) {
  return &setup->moduli[setup->model.material[setup->model_of[cell]]];
}

#endif
