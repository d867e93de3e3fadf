/* Eigenvalues of the symmetric part of an assembled network, by sparse methods.
 *
 * Counting uses Sylvester's law of inertia: K - s I = L D L^T has as many negative entries in D as
 * K has eigenvalues below s (CHOLMOD, simplicial). The lowest eigenvalues themselves come from
 * Lanczos iterations on (K - s I)^-1 with s below all of them (ARPACK); matrices of up to 300 rows
 * are solved dense (LAPACK).
 */
#ifndef CDEM_NETWORK_SPECTRUM_H
#define CDEM_NETWORK_SPECTRUM_H

#include "network/assemble.h"

typedef struct cdem_spectrum cdem_spectrum;

/* All entries of `sparse` in one unit (cdem_sparse_scale_rotations). balanced: the spectrum of
 * D^-1/2 K D^-1/2 with D the diagonal of K in size. It has as many zero and negative eigenvalues as
 * K, and stiff materials, needles and units no longer hide the soft modes. Destroy at any stage; it
 * is nulled. */
cdem_status cdem_spectrum_create(const cdem_sparse *sparse, bool balanced, cdem_spectrum **spectrum,
                                 cdem_fault *fault);
void cdem_spectrum_destroy(cdem_spectrum **spectrum);

/* Largest absolute row sum: a bound of every |eigenvalue|, N/m. */
double cdem_spectrum_norm(const cdem_spectrum *spectrum);

/* Eigenvalues within this of zero are zero: 1e-14 sqrt(rows) of the norm, some ten times the
 * rounding of assembly and factorisation. */
double cdem_spectrum_width(const cdem_spectrum *spectrum);

/* Negative and zero eigenvalues, by two counts. */
cdem_status cdem_spectrum_count(cdem_spectrum *spectrum, const cdem_progress *progress,
                                int64_t *negative, int64_t *zero, cdem_fault *fault);

/* How many eigenvalues lie below `shift` (N/m). CDEM_NUMERIC when the factorisation breaks down
 * there. */
cdem_status cdem_spectrum_below(cdem_spectrum *spectrum, double shift, int64_t *count,
                                cdem_fault *fault);

/* The `wanted` lowest eigenvalues, ascending; wanted <= rows. CDEM_NUMERIC without convergence. */
cdem_status cdem_spectrum_lowest(cdem_spectrum *spectrum, int wanted, double *value,
                                 cdem_fault *fault);

#endif
