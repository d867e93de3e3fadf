/* Eigenvalues of the symmetric part of an assembled network, by sparse methods.
 *
 * Counting uses Sylvester's law of inertia: K - s I = L D L^T has as many negative entries in D as
 * K has eigenvalues below s (CHOLMOD, simplicial). The lowest eigenvalues themselves come from
 * Lanczos iterations on (K - s I)^-1 with s below all of them (ARPACK); matrices of up to 300 rows
 * are solved dense (LAPACK). Cosserat rotations are scaled by the model's length, so that all
 * eigenvalues are N/m.
 */
#ifndef CDEM_NETWORK_SPECTRUM_H
#define CDEM_NETWORK_SPECTRUM_H

#include "network/assemble.h"

typedef struct cdem_spectrum cdem_spectrum;

/* length: the model's; 1 for classical networks. Destroy at any stage; it is nulled. */
cdem_status cdem_spectrum_create(const cdem_sparse *sparse, double length, cdem_spectrum **spectrum,
                                 cdem_fault *fault);
void cdem_spectrum_destroy(cdem_spectrum **spectrum);

/* Largest absolute row sum: a bound of every |eigenvalue|, N/m. */
double cdem_spectrum_norm(const cdem_spectrum *spectrum);

/* How many eigenvalues lie below `shift` (N/m). CDEM_NUMERIC when the factorisation breaks down
 * there. */
cdem_status cdem_spectrum_below(cdem_spectrum *spectrum, double shift, int64_t *count,
                                cdem_fault *fault);

/* The `wanted` lowest eigenvalues, ascending; wanted <= rows. CDEM_NUMERIC without convergence. */
cdem_status cdem_spectrum_lowest(cdem_spectrum *spectrum, int wanted, double *value,
                                 cdem_fault *fault);

#endif
