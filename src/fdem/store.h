/* Private to fdem: how a solver holds its grains, and who does what in a step.
 *
 * Grains stand in the order of their ids. Surface nodes of all grains are one list: those of grain
 * g are first[g] .. first[g + 1] - 1.
 *
 * A step from t_n:
 *   1. contact.c      forces on surface nodes from the places at t_n (and the way since t_{n-1})
 *   2. motion.c       forces to amplitudes (product), v and L to t_n + dt/2, all to t_{n+1},
 * amplitudes to places (product); walls move so that `place`, `now`, `force` are of t_n between
 * steps: after motion the forces are found anew.
 */
#ifndef CDEM_FDEM_STORE_H
#define CDEM_FDEM_STORE_H

#include "dem/walls_store.h"
#include "fdem/fdem.h"

/* ---- what contact reads and writes ---- */

typedef struct {
  int64_t grains;
  const cdem_skin *const *surface; /* [grains] skin of each grain's template */
  const int64_t *first;            /* [grains + 1] */
  const double *scale;             /* [grains] m a unit of the reference */
  const int32_t *material;         /* [grains] */
  /* now, t_n */
  const double *center; /* [grains][3] */
  const double *turn;   /* [grains][9] rotation from the frame of the body to space, row-major */
  const double *place;  /* [nodes][3] in the frame of the body, from the centre, m */
  const double *now;    /* [nodes][3] center + turn place */
  const double *before; /* [nodes][3] the same a step ago (t_0: now - v dt) */
  const double *area;   /* [nodes] m^2 */
  const double *mass;   /* [nodes] kg */
  int walls;
  const cdem_wall_body *wall;
  int materials;
  const cdem_fdem_contact_law *law;
  double step; /* that led here; 0: springs stay as they are, no dashpots */
} cdem_contact_view;

typedef struct cdem_fdem_contacts
    cdem_fdem_contacts; /* contact.c; its own memory: list, histories */

/* What one evaluation found. */
typedef struct {
  double normal, shear;     /* stored in springs, J */
  double friction, damping; /* dissipated over the step that led here, J */
  double walls;             /* work of the walls on the grains over that step, J */
} cdem_contact_book;

cdem_status cdem_fdem_contacts_create(const cdem_contact_view *view, double skin, int threads,
                                      cdem_fdem_contacts **contacts, cdem_fault *fault);
void cdem_fdem_contacts_destroy(cdem_fdem_contacts **contacts);
/* Where an evaluation puts what it finds; all is overwritten. */
typedef struct {
  double *force;      /* [nodes][3] on surface nodes, in space, N */
  double *wall_force; /* [walls][3] of the grains, N */
  double *wall_stiff; /* [walls] sum of its contacts' stiffnesses, N/m */
  double *stiff;      /* [grains] of the contacts it takes part in, as node or as triangle, N/m */
} cdem_contact_forces;
/* Builds the list of neighbours anew when it is outlived. Deterministic for any number of
 * threads. */
cdem_status cdem_fdem_contacts_forces(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                      const cdem_contact_forces *out, cdem_contact_book *book,
                                      cdem_fault *fault);
/* The same of the last evaluation once more, to the same bits: what a restored solver asks for. */
void cdem_fdem_contacts_gather(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                               const cdem_contact_forces *out);
/* Nodes that touch, in the order of grains and nodes. */
cdem_status cdem_fdem_contacts_list(const cdem_fdem_contacts *contacts,
                                    const cdem_contact_view *view, int64_t *touches,
                                    cdem_fdem_touch **touch, cdem_fault *fault);
/* Grains and walls each grain touches now: [grains]. */
void cdem_fdem_contacts_count(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                              int32_t *count);
/* Histories: names under "contact/". Restored after the places of the view; forces are then those
 * of cdem_fdem_contacts_gather. */
cdem_status cdem_fdem_contacts_save(const cdem_fdem_contacts *contacts, cdem_state *state,
                                    cdem_fault *fault);
cdem_status cdem_fdem_contacts_restore(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                       const cdem_state *state, cdem_fault *fault);

#endif
