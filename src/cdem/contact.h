/* Contact: penalty springs with Coulomb friction between any facets that meet.
 *
 * Slave points are the corners of active facets, each with its share of the facet's area (the same
 * points on which interfaces stand, so that a released interface hands over without a jump); master
 * faces are active facets of other cells. Both sides are slave and master with half of the
 * stiffness each (where flat faces of different fineness meet, the finer side with more). In 3-D
 * edges of the surface meet edges too, so that crossing bars do not pass.
 *
 *     F_n = max(0, w (kn g + cn g'))     F_t = -w kt s, cut back to |F_t| <= mu F_n           (1)
 *
 * g overlap along the master's outward normal, w the part of the point's area that faces the master
 * and lies over it (m^2; docs/rooms/cdem-contact.md), s the elastic part of the sliding in the
 * frame that turns with the master face. The reaction goes to the master's nodes by its shape
 * functions at the point's projection: forces sum to zero and so do their moments. The force is
 * never larger than the energy that the contact was given can drive (contact_law.c): contact is
 * passive whatever appears, turns or changes.
 *
 * History is kept by (slave point, opposing surface) and follows when the slave moves from one
 * master face to its neighbour. Broad phase: a uniform grid over facets with a skin; rebuilt when
 * something has moved half a skin, which the search itself watches at every step with the velocity
 * of that step, so that no pair is missed. O(n).
 */
#ifndef CDEM_CDEM_CONTACT_H
#define CDEM_CDEM_CONTACT_H

#include "cdem/blocks.h"
#include "results/state.h"

typedef struct {
  double kn, kt;   /* Pa/m */
  double friction; /* mu */
  double damping;  /* fraction of critical of a facet's normal spring with its nodes' mass, >= 0 */
} cdem_contact_law;

typedef struct {
  const cdem_blocks *blocks; /* borrowed */
  int dofs;
  double thickness;
  cdem_contact_law law;             /* when no pair says otherwise */
  int laws;                         /* laws of pairs of groups */
  const cdem_contact_law *pair_law; /* [laws] */
  const int16_t
      *law_of; /* [colours][colours] index into pair_law or -1; NULL: one law everywhere */
  int colours;
  const int16_t *colour; /* [blocks->mesh.cells] colour of a cell (its group); NULL: 0 */
  double skin;           /* m; 0: a fifth of the mean facet size */
  const double *mass;    /* [nodes][dofs], borrowed; for the damping and the step */
  int threads;
} cdem_contact_options;

typedef struct cdem_contact_store cdem_contact_store;

typedef struct {
  const cdem_blocks *blocks;
  int64_t version; /* grows with every rebuild of the candidate list */
  cdem_contact_store *store;
} cdem_contact;

/* No facet is active at first. */
cdem_status cdem_contact_init(const cdem_contact_options *options, cdem_contact *contact,
                              cdem_fault *fault);
void cdem_contact_release(cdem_contact *contact);

/* Activates a facet as slave and master (idempotent). */
void cdem_contact_activate(cdem_contact *contact, int32_t facet);
/* Makes both facets of a pair active and starts the history of their points from the force on side
 * 1 (N, by corner); NULL: from nothing. To be called after the forces of the step in which the pair
 * was released: the next evaluation has it. */
void cdem_contact_hand_over(cdem_contact *contact, int32_t pair, const double force[4][3]);

/* Adds contact forces at displacements u and velocities v [nodes][dofs] (v of the last half step)
 * to force; dt: the step over which v led to u (0: u was set, contacts take the energy of their
 * overlap). CDEM_NUMERIC: something is deeper inside than a facet's size (names the elements, the
 * time step is too long or the speed too large). */
cdem_status cdem_contact_forces(cdem_contact *contact, const double *u, const double *v, double dt,
                                double *force, cdem_fault *fault);

typedef struct {
  double stored, friction, damping; /* J; the last two since the start, never falling */
  int64_t contacts, candidates, rebuilds;
  int64_t visits; /* grid cells and nodes that the last rebuild looked at: its cost */
} cdem_contact_totals;
void cdem_contact_sum(const cdem_contact *contact, cdem_contact_totals *totals);

/* Greatest squared frequency of the contacts by Gershgorin, (rad/s)^2, dashpots included: of all
 * points within the skin of a face, touching or not, so that it holds until the next rebuild. */
double cdem_contact_frequency2(const cdem_contact *contact);

/* The present contacts for results: position, normal (out of the master), force on the slave.
 * Newly allocated; release with free. */
typedef struct {
  int64_t contacts;
  double *position, *normal, *force; /* [contacts][3] */
  uint8_t *sliding;                  /* [contacts] */
  int32_t *slave_cell, *master_cell; /* [contacts] mesh cell ids */
} cdem_contact_fields;
cdem_status cdem_contact_fields_get(const cdem_contact *contact, cdem_contact_fields *fields,
                                    cdem_fault *fault);
void cdem_contact_fields_release(cdem_contact_fields *fields);

cdem_status cdem_contact_save(const cdem_contact *contact, cdem_state *state, cdem_fault *fault);
cdem_status cdem_contact_restore(cdem_contact *contact, const cdem_state *state, cdem_fault *fault);

#endif
