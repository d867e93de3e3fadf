/* Private to run: the engine of grains: a case made into a solver, with everything that the solver
 * borrows. */
#ifndef CDEM_RUN_GRAINS_H
#define CDEM_RUN_GRAINS_H

#include "dem/dem.h"
#include "dem/pictures.h"
#include "dem/pushes.h"
#include "run/setup.h"
#include "run/triaxial.h"

/* Triangles or segments of a wall, read from a file or a checkpoint. */
typedef struct {
  int64_t corners, facets;
  double *corner; /* [corners][3] m */
  int32_t *facet; /* [facets][dim] */
} cdem_run_facets;

typedef struct {
  cdem_run_setup *run;
  int dim;
  cdem_grains grains;     /* at the start, all arrays; material: index into `material` */
  int32_t *case_material; /* [grains] index into grains.materials of the case */
  double low[3], high[3]; /* box of the packing, after it was pressed together */
  int materials;          /* those that grains or walls use */
  int *used;              /* [materials] index into grains.materials of the case */
  int *model_of;          /* [grains.materials of the case] the other way round; -1: not used */
  bool *of_grains;        /* [materials] some grain consists of it */
  cdem_grain_material *material; /* [materials] */
  cdem_contact_input *contact;   /* [materials][materials] */
  int *contact_entry;            /* [materials][materials] of the case's contacts; -1: none */
  int walls;
  cdem_wall *wall;         /* [walls] */
  cdem_run_facets *facets; /* [walls] */
  cdem_bond_law *bond_law; /* [bonds of the case] */
  int64_t bonds, bond_room;
  cdem_bond *bond; /* [bonds] */
  cdem_cell cell;
  bool has_cell;
  bool has_triaxial;
  cdem_run_triaxial triaxial;
  cdem_membrane_options membrane;
  cdem_confinement confinement;
  cdem_dem_options options;
  cdem_dem dem;
  double *velocity;              /* [grains][3] scratch of the columns */
  cdem_strain_reference *strain; /* the start, where a picture or a band is wanted */
  double *bands;                 /* [grains][4] places and effective strains of ... */
  int64_t bands_step;            /* ... this step; -1: none yet */
} cdem_run_grains;

/* Grains at their places; then materials, contacts and walls, as grains that deform have them, too;
 * then those and everything else up to the solver; then that. Where the first fails nothing is
 * made. */
cdem_status cdem_run_grains_create(cdem_run_setup *run, const cdem_state *checkpoint,
                                   cdem_run_grains **grains, cdem_fault *fault);
cdem_status cdem_run_grains_surround(cdem_run_grains *g, const cdem_state *checkpoint,
                                     cdem_fault *fault);
cdem_status cdem_run_grains_build(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault);

/* ---- the steps of its making, one file each ---- */

/* grains_start.c: places, sizes, initial motion; from a file, a packing, or a checkpoint */
cdem_status cdem_run_grains_start(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault);
/* ... what of that a checkpoint keeps (borrowed) */
cdem_status cdem_run_grains_save(const cdem_run_grains *g, cdem_state *state, cdem_fault *fault);
/* grains_walls.c: walls and the cell */
cdem_status cdem_run_grains_walls(cdem_run_grains *g, const cdem_state *checkpoint,
                                  cdem_fault *fault);
cdem_status cdem_run_grains_cell(cdem_run_grains *g, cdem_fault *fault);
/* grains_triaxial.c: plates, side and plan of a triaxial test; steps with its stages; its columns
 */
cdem_status cdem_run_grains_triaxial(cdem_run_grains *g, cdem_fault *fault);
void cdem_run_grains_triaxial_materials(cdem_run_grains *g,
                                        void (*take)(cdem_run_grains *g, int from));
cdem_status cdem_run_grains_advance(cdem_run_grains *g, int64_t steps, cdem_fault *fault);
void cdem_run_grains_triaxial_columns(cdem_run_grains *g, cdem_run_row *row);
/* grains_contacts.c: which materials are used, and the numbers of each pair */
cdem_status cdem_run_grains_materials(cdem_run_grains *g, cdem_fault *fault);
cdem_status cdem_run_grains_contacts(cdem_run_grains *g, cdem_fault *fault);
/* grains_bonds.c */
cdem_status cdem_run_grains_bonds(cdem_run_grains *g, cdem_fault *fault);
/* grains_solver.c: the solver and its step; `look` of the engine; threads for so many grains */
int cdem_run_grains_threads(const cdem_run_grains *g);
cdem_status cdem_run_grains_solver(cdem_run_grains *g, cdem_fault *fault);
cdem_status cdem_run_grains_look(cdem_run_setup *run, cdem_fault *fault);

/* ---- what is looked at ---- */

/* grains_columns.c */
void cdem_run_grains_columns(cdem_run_setup *run, cdem_run_row *row);
/* grains_probes.c */
const char *cdem_run_grains_unit(const cdem_case_probe *probe);
cdem_status cdem_run_grains_probe(cdem_run_grains *g, const cdem_case_probe *probe, double *value,
                                  cdem_fault *fault);
/* grains_frames.c: with the coarse-grained fields of the case; strain: NULL, or of the start */
cdem_status cdem_run_grains_frames(const cdem_run_grains *g, const cdem_strain_reference *strain,
                                   int64_t index, const cdem_frame_sink *sink, cdem_fault *fault);
/* grains_pictures.c: which are wanted, and what pictures and probes need of the start */
cdem_status cdem_run_grains_pictures_init(cdem_run_grains *g, cdem_fault *fault);
cdem_status cdem_run_grains_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                     cdem_fault *fault);
/* ... names in grains.pictures: fields of grains and two more, which are maps; and curves of the
 * contacts, the distributions of their pushes and of their directions; -1: no such */
enum {
  CDEM_RUN_CHAINS = CDEM_GRAIN_FIELDS,
  CDEM_RUN_VELOCITIES,
  CDEM_RUN_MAPS,
  CDEM_RUN_PUSHES = CDEM_RUN_MAPS,
  CDEM_RUN_DIRECTIONS,
  CDEM_RUN_CHOICES
};
int cdem_run_picture_find(const char *name);
/* ... what the case says of a picture: kind, window, ends of the colour bar */
cdem_picture cdem_run_picture(const cdem_run_setup *run, int choice,
                              const cdem_strain_reference *strain, const char *title);
/* grains_pushes.c: the distribution of the pushes over their mean, as figure and data */
cdem_status cdem_run_pushes(int64_t contacts, const cdem_push *push, const char *title,
                            const char *folder, const char *name, cdem_fault *fault);
/* grains_curves.c: the curves of the contacts */
cdem_status cdem_run_grains_curve(const cdem_run_grains *g, int choice, const char *title,
                                  const char *folder, const char *tag, cdem_fault *fault);
/* ... name of its file; of displacement it is "pattern", as for bodies */
const char *cdem_run_picture_file(char text[96], int choice, const char *tag);

/* Index of a material of the case; NULL: the first. Names were checked with the case. */
int cdem_run_grains_material(const cdem_run_grains *g, const char *name);

static inline const cdem_case_values *cdem_run_grains_values(const cdem_run_grains *g) {
  return &g->run->cases.values;
}

#endif
