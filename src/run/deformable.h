/* Private to run: the engine of grains that deform. Grains, materials and walls come from the case
 * as those of rigid grains do (grains.h), the solver is another. */
#ifndef CDEM_RUN_DEFORMABLE_H
#define CDEM_RUN_DEFORMABLE_H

#include "dem/clusters.h"
#include "fdem/fdem.h"
#include "run/grains.h"

typedef struct {
  cdem_run_setup *run;
  cdem_run_grains *grains; /* up to its walls; its own solver is not made */
  int shapes;              /* one a material that grains are of */
  cdem_template *shape;
  int32_t *shape_of;          /* [grains] */
  double *orientation;        /* [grains][4] */
  double *density;            /* [materials] */
  cdem_fdem_contact_law *law; /* [materials][materials] */
  cdem_fdem fdem;
  double *velocity; /* [grains][3] scratch of the columns */
} cdem_run_deformable;

static inline cdem_run_deformable *cdem_run_deformable_of(const cdem_run_setup *run) {
  return run->context;
}
static inline const cdem_case_values *cdem_run_deformable_values(const cdem_run_deformable *d) {
  return &d->run->cases.values;
}

/* deformable_solver.c: templates, laws, orientations; then the solver. */
cdem_status cdem_run_deformable_solver(cdem_run_deformable *d, cdem_fault *fault);
/* deformable_columns.c */
void cdem_run_deformable_columns(cdem_run_setup *run, cdem_run_row *row);
/* deformable_frames.c: "grains": their elements; "walls" are not drawn. */
cdem_status cdem_run_deformable_frames(cdem_run_setup *run, int64_t index,
                                       const cdem_frame_sink *sink, cdem_fault *fault);
/* deformable_triaxial.c: a triaxial test: its stages, its columns, and the frames of its membrane.
 */
cdem_status cdem_run_deformable_advance(cdem_run_deformable *d, int64_t steps, cdem_fault *fault);
void cdem_run_deformable_triaxial_columns(cdem_run_deformable *d, cdem_run_row *row);
cdem_status cdem_run_deformable_membrane(const cdem_run_deformable *d, int64_t index,
                                         const cdem_frame_sink *sink, cdem_fault *fault);
/* deformable_contacts.c: nodes that touch, put together to contacts of two grains or of a grain and
 * a wall, in the form of rigid ones; free() them. */
cdem_status cdem_run_deformable_contacts(const cdem_run_deformable *d, int64_t *contacts,
                                         cdem_dem_contact **contact, cdem_fault *fault);
/* ... and as the source counts them: clusters of nodes by density, paired across two grains
 * (dem/clusters.h). */
cdem_status cdem_run_deformable_pushes(const cdem_run_deformable *d,
                                       cdem_cluster_contacts *contacts, cdem_fault *fault);

#endif
