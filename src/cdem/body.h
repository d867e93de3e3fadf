/* The elastic body: the spring network of a model in a corotated frame.
 *
 * Each element e has one rotation R, the polar rotation of the deformation gradient F at its
 * centre. With d_i = R^T (x_i - x_0) - (X_i - X_0) the local displacements, S_ij the spring
 * tensors,
 *
 *     f_i = R sum_j S_ij (d_j - T_ij d_i)  +  terms of dR/dx                               (1)
 *     U   = -1/2 sum_i d_i . (R^T f_i)  of the first term                                  (2)
 *
 * so that a rigidly turned element feels no force. The second part of (1) makes f the exact
 * gradient of -U: energy and angular momentum are then kept at any strain (docs/theory/cdem.md).
 * T_ij is the rigid transport of a Cosserat node (identity otherwise); its rotations enter as omega
 * minus the angle of R.
 *
 * A material may carry no tension. Each of its elements then opens by the uniform strain a, without
 * negative eigenvalue, that leaves its springs the least energy: (1) and (2) hold with d_i - a X_i
 * in place of d_i, the terms of dR/dx too, and f is still the exact gradient. No principal stress
 * of the element's mean is then tensile; the rest (hourglass modes; the skew stress and the couples
 * of a Cosserat element) stays linear. There is no history. See tension_law.h.
 *
 * Unknowns: u [nodes][dofs], node-major, ids of the model's mesh; dofs = 2 (ux uy), 3 (ux uy uz) or
 * 3 (ux uy omega). Displacements, not positions, are kept: a small motion of a body far from the
 * origin loses no digits.
 *
 * Storage: one template (reference coordinates, inverse Jacobian at the centre, spring tensors) for
 * each distinct element; congruent elements (equal kind, material and relative coordinates, to
 * 1e-12 of their size) share it. Elements go in batches of CDEM_LANES, either all of one template
 * (broadcast) or each with its own (interleaved). Element forces are written once and gathered per
 * node in a fixed order, so that bits do not depend on the number of threads.
 */
#ifndef CDEM_CDEM_BODY_H
#define CDEM_CDEM_BODY_H

#include "network/assemble.h"
#include "network/network.h"

enum { CDEM_CLASSES = 3 }; /* edge, face, body: cdem_class - 1 */

typedef struct {
  const double *density;       /* [model->materials] kg/m^3 */
  const double *micro_inertia; /* [model->materials] m^2, Cosserat: inertia of a node = this times
                                  its mass; NULL: cdem_material_micro_inertia */
  const bool *no_tension; /* [model->materials] carries no tension; NULL: all do. CDEM_INPUT for
                             one that is not isotropic (Cosserat: cubic is good too) */
  bool linear;            /* no rotation: small displacements (tests, static comparison) */
  bool separate;          /* congruent elements share nothing (tests, benchmark) */
  int threads;            /* 0: OpenMP's default */
} cdem_body_options;

typedef struct cdem_body_store cdem_body_store; /* private: templates, batches, gather lists */

typedef struct {
  const cdem_model *model; /* borrowed */
  int dofs;
  int32_t nodes;
  double *mass; /* [nodes][dofs] lumped by row sums; kg, Cosserat rotation kg m^2; 0 for nodes of no
                   cell */
  int64_t distinct; /* templates */
  int64_t inverted; /* at the last cdem_body_forces: the first model cell with det F not positive,
                       -1 when there is none */
  int threads;
  bool linear;
  int tensionless; /* the first material of cells that carries no tension, -1 when there is none */
  cdem_body_store *store;
} cdem_body;

/* First-order elements only: CDEM_INPUT names the first other one ("mesh the volume with order 1").
 */
cdem_status cdem_body_init(const cdem_model *model, const cdem_body_options *options,
                           cdem_body *body, cdem_fault *fault);
void cdem_body_release(cdem_body *body);

/* Internal forces at displacements u; force [nodes][dofs] is overwritten. Needs room private to the
 * body: one call at a time. */
void cdem_body_forces(cdem_body *body, const double *u, double *force);
/* The same by plain loops, one element after the other, straight from (1). */
void cdem_body_forces_reference(const cdem_body *body, const double *u, double *force);

/* The first model cell that displacements u turn inside out at its centre (det F not positive, or
 * not a number), -1 when there is none. Forces find the same on their way (body->inverted). */
int64_t cdem_body_inverted(const cdem_body *body, const double *u);

/* Elastic energy, J, and its parts by spring class, which add up to it: the energy of a pair is
 * -1/2 (d_i . S_ij (d_j - d_i) + d_j . S_ji (d_i - d_j)), d measured from the element's mean (only
 * then do skew parts of S not depend on the origin). Deterministic. */
double cdem_body_energy(const cdem_body *body, const double *u, double by_class[CDEM_CLASSES]);

/* Fields of the cells of the model, any may be NULL:
 *   stress, strain [cells][6] xx yy zz yz xz xy, global axes, at the element's centre: Cauchy
 *     stress (tensile positive, Pa; the small-strain law in the corotated frame) and strain
 *     (engineering shears); plane stress fills strain zz, plane strain stress zz. Of a material
 *     without tension: the stress of what is not opening, the strain with it
 *   energy [cells][CDEM_CLASSES] J    pair_force [cells][CDEM_CLASSES] sum over the pairs of a
 *     class of |S_ij (d_j - T d_i)|, N (rotations left out)   rotation [cells][9] R row-major */
typedef struct {
  double *stress, *strain, *energy, *pair_force, *rotation;
} cdem_body_fields;
void cdem_body_cell_fields(const cdem_body *body, const double *u, const cdem_body_fields *fields);

/* The same stress alone, [cells][6], by the kernels of the forces: what is wanted in every step. */
void cdem_body_cell_stress(const cdem_body *body, const double *u, double *stress);

/* Stress at nodes [nodes][6]: each element's stress at its own corners, averaged by volume share
 * over the elements around. Sharper than cell values at a free surface. */
void cdem_body_node_stress(const cdem_body *body, const double *u, double *stress);

/* An upper bound of the largest eigenfrequency, rad/s, of body plus lumped mass: the largest over
 * the elements (Irons), each from a high power of its matrix (1.25 % above at most), at the
 * undeformed state. Elements without tension are no stiffer than linear ones in any state, but
 * count twice, as contacts do: what opens and closes between steps must not be stepped over. *cell:
 * where (model cell index). */
double cdem_body_frequency(const cdem_body *body, int32_t *cell);

/* Safe row sums: stiffness [nodes] N/m, for each node the sum over its elements of the largest
 * Gershgorin row sum over the translations, which is at least that of the assembled network
 * (Cosserat: rotations count by the model's length; their own rows, N m, in `couple`, may be NULL).
 * For fictitious masses of a relaxation: with these as masses no eigenvalue exceeds 1. */
void cdem_body_row_sums(const cdem_body *body, double *stiffness, double *couple);

/* The network's matrix through the one assembler. */
cdem_status cdem_body_stiffness(const cdem_body *body, cdem_sparse *stiffness, cdem_fault *fault);

/* Bytes a force evaluation must move at least (the memory bound of bench/cdem.c), and bytes held.
 */
int64_t cdem_body_traffic(const cdem_body *body);
int64_t cdem_body_memory(const cdem_body *body);

#endif
