/* The certificate of a network: how a reader knows that the springs are the finite-element body.
 *
 * Feed the sink of a certifier every pair of a model (unfiltered), then finish. Bounds are part of
 * the certificate; a number that could not be had is NaN (or -1 for counts) and its bound does not
 * count.
 */
#ifndef CDEM_NETWORK_CERTIFICATE_H
#define CDEM_NETWORK_CERTIFICATE_H

#include "network/assemble.h"

typedef struct {
  double value;    /* worst seen; NaN: not computed */
  int64_t element; /* tag of the element where; -1: none */
  int64_t node[2]; /* tags of the pair; -1: none */
} cdem_worst;

typedef struct {
  int64_t elements, nodes, pairs, springs;
  int64_t census[CDEM_CLASS_COUNT][CDEM_FORM_COUNT]; /* pairs by class and form */
  int64_t negative;                                  /* springs with stiffness below zero */
  int64_t robust;                                    /* pairs that took the robust path */
  cdem_worst rebuild;     /* |S - rows| / |S|                                     <= 1e-12 */
  cdem_worst translation; /* |K_ii - sum_j S_ij T_ij| / |K_ii|, K_ii by B^T D B    <= 1e-12 */
  bool has_rotation;      /* false for Cosserat: `translation` holds the rotation there */
  cdem_worst rotation; /* |sum_j S_ij (theta x (x_j - x_i))| / sum |S_ij||x_j - x_i|, classical only
                          <= 1e-12 */
  double assembled;    /* largest |network - finite element| / largest |entry| <= 1e-12 */
  double skew_mean;    /* over the pairs, of |S - S^T| / (2 |S|) */
  cdem_worst skew, cond; /* largest skew fraction, largest cond(P): reported, no bound */
  double patch; /* largest interior force / largest row sum of |K||u|, uniform strains <= 1e-12 */
  int64_t patch_nodes;    /* interior nodes tested, 0: none is interior */
  int32_t components;     /* connected parts */
  int64_t rigid_modes;    /* expected zero modes: 3 or 6 a part */
  int64_t zero_modes;     /* of the balanced matrix (spectrum.h); -1: not counted == rigid_modes */
  int64_t negative_modes; /* likewise == 0 */
  double rotation_bound, rebuild_bound, translation_bound, assembled_bound, patch_bound;
} cdem_certificate;

typedef struct cdem_certifier cdem_certifier;

/* The model must outlive the certifier. */
cdem_status cdem_certifier_create(const cdem_model *model, cdem_certifier **certifier,
                                  cdem_fault *fault);
void cdem_certifier_destroy(cdem_certifier **certifier);
/* Feed it to cdem_network_convert. */
cdem_pair_sink cdem_certifier_sink(cdem_certifier *certifier);
/* mode_rows: count zero modes when the matrix has at most this many rows (0: never). */
cdem_status cdem_certifier_finish(cdem_certifier *certifier, int64_t mode_rows,
                                  const cdem_progress *progress, cdem_certificate *certificate,
                                  cdem_fault *fault);

/* Do all bounds hold? */
bool cdem_certificate_holds(const cdem_certificate *certificate);

#endif
