/* Shape functions of a mesh at points that lie in its cells: the matrix N of the bridging scale (Li
 * & Wan 2010, eq. 3), one row a point, with its gradients.
 *
 *     u(x_a) = sum over I of N_I(x_a) d_I,    f_I = sum over a of N_I(x_a) F_a      (N and N^T)
 *
 * A row has the nodes of one cell. First-order cells only: tri3 quad4 tet4 pyr5 wedge6 hex8.
 */
#ifndef CDEM_BSM_WEIGHTS_H
#define CDEM_BSM_WEIGHTS_H

#include "mesh/mesh.h"

/* Which of these cells of a mesh hold which points. cell [cells] mesh cell ids, ascending; xyz
 * [points][3] m. found [points] receives the mesh cell (the first of those that share the place),
 * -1 for none; xi [points][3] the place in its reference coordinates. A point counts as inside when
 * it is beyond a face by at most 1e-9 of the cell. Takes time of order cells + points. CDEM_INPUT:
 * a cell of higher order (its tag). */
cdem_status cdem_locate(const cdem_mesh *mesh, int32_t cells, const int32_t *cell, int64_t points,
                        const double *xyz, int32_t *found, double *xi, cdem_fault *fault);

typedef struct {
  int64_t points;
  int64_t *start; /* [points + 1] into node */
  int32_t *node;  /* [start[points]] node ids, in the order of the cell's own numbering */
  double *n;      /* [start[points]] */
  double *dn;     /* [start[points]][3] gradients, 1/m; unused components 0 */
} cdem_weights;

/* From what cdem_locate found: every cell[a] must be a cell. Release at any stage. */
cdem_status cdem_weights_init(const cdem_mesh *mesh, int64_t points, const int32_t *cell,
                              const double *xi, cdem_weights *weights, cdem_fault *fault);
void cdem_weights_release(cdem_weights *weights);

/* u [points][width] = N d, d [nodes][width]. */
void cdem_weights_interpolate(const cdem_weights *weights, int width, const double *d, double *u);
/* d [nodes][width] += N^T f, f [points][width]. */
void cdem_weights_gather(const cdem_weights *weights, int width, const double *f, double *d);

#endif
