/* Loads where the fine region touches the edge of the mesh (Li & Wan 2010, eq. 18): a traction on
 * faces becomes forces on the grains that touch them,
 *
 *     t_a = integral of N_a(x) t(x) dS,
 *
 * N_a the interpolation between the points where grains touch the edge: linear between neighbours
 * in 2-D, exactly integrated; in 3-D the part of the face that is nearer to grain a's point than to
 * any other's. Both are partitions of unity, so that the sum of the forces is that of the traction.
 * Driven grains, which obey no force, carry none: beside them the interpolation is constant.
 */
#ifndef CDEM_BSM_TRACTION_H
#define CDEM_BSM_TRACTION_H

#include "dem/grains.h"
#include "mesh/mesh.h"

/* A face of the edge: nodes of the mesh in outward order (2-D: two, the interior on the left). */
typedef struct {
  int corners;
  int32_t node[4];
} cdem_bsm_face;

/* Grains that touch a face: centre above it by at most radius + `gap` times the largest radius, and
 * its foot on the face or less than a radius beside it. touch [grains] is set true for them, others
 * are left alone. */
void cdem_bsm_touching(const cdem_mesh *mesh, int64_t faces, const cdem_bsm_face *face,
                       const cdem_grains *grains, double gap, bool *touch);

/* area [grains] += the integral of N_a over the faces, m^2; normal [grains][3] += that of N_a n, n
 * outward; either may be NULL. CDEM_INPUT: a face that no grain touches which may move (its place).
 */
cdem_status cdem_bsm_tributary(const cdem_mesh *mesh, int64_t faces, const cdem_bsm_face *face,
                               const cdem_grains *grains, double gap, double thickness,
                               double *area, double *normal, cdem_fault *fault);

#endif
