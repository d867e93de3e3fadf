/* Private to fdem: a triaxial specimen of deformable grains: membrane, plates, pressure
 * (dem/confinement.h says what it is).
 *
 * Nodes of the membrane are penalty points that the skins of grains push out, as in dem; the force
 * on the grain goes to the triangle that is touched. Candidates stand as rows of nodes and again by
 * grain, so that each grain adds its forces in a fixed order.
 */
#ifndef CDEM_FDEM_CONFINE_H
#define CDEM_FDEM_CONFINE_H

#include "dem/confine_host.h"
#include "fdem/solver_store.h"

/* A node of the membrane near a grain, and what the grain gets from it now. */
typedef struct {
  int32_t grain, node;
  bool touches;
  int32_t corner[3];
  double weight[3], push[3]; /* N, on the grain */
} cdem_fdem_membrane_touch;

struct cdem_fdem_confine {
  cdem_confine_host host;
  double skin;                     /* m */
  int64_t *row;                    /* [nodes + 1] of the membrane */
  cdem_fdem_membrane_touch *touch; /* [row[nodes]] grains ascending in each row */
  int64_t *grain_row;              /* [grains + 1] */
  int64_t *of_grain;               /* [row[nodes]] touches of each grain, ascending */
  int64_t capacity[2];
  double *built; /* [grains][3] centres when the rows were made */
  double *stiff; /* [rings] largest stiffness on one node, N/m */
};

cdem_status cdem_fdem_confine_init(cdem_fdem *fdem, cdem_fault *fault);
void cdem_fdem_confine_release(cdem_fdem_store *s);
/* The pressure the plate is to carry, before walls move; then the membrane goes with them. */
void cdem_fdem_confine_aim(cdem_fdem *fdem);
void cdem_fdem_confine_move(cdem_fdem *fdem);
/* Forces of t_n + 1 on both, those on grains added to s->force; step: that led here. CDEM_NUMERIC:
 * a grain is outside. */
cdem_status cdem_fdem_confine_forces(cdem_fdem *fdem, double step, cdem_fault *fault);
/* After the step was changed from `old`, while nothing else moved. */
void cdem_fdem_confine_change_step(cdem_fdem *fdem, double old);
/* With the first step: damping while a packing comes to rest. */
void cdem_fdem_confine_calm(cdem_fdem *fdem);
/* Largest step for the nodes of the membrane, s. */
double cdem_fdem_confine_limit(const cdem_fdem_store *s);
void cdem_fdem_confine_energies(const cdem_fdem *fdem, cdem_fdem_energies *energies);
cdem_status cdem_fdem_confine_save(const cdem_fdem_store *s, cdem_state *state, cdem_fault *fault);
cdem_status cdem_fdem_confine_restore(cdem_fdem *fdem, const cdem_state *state, cdem_fault *fault);

/* confine_lists.c: rows anew when they are outlived. */
cdem_status cdem_fdem_confine_lists(cdem_fdem *fdem, bool always, cdem_fault *fault);

#endif
