/* Inner pairs of regular meshes: what the nets of other authors are compared with. E = t = edge = 1
 * throughout. */
#ifndef CDEM_VERIFY_NETS_H
#define CDEM_VERIFY_NETS_H

#include "springs/springs.h"

/* The block between the centre of a 2x2x2 block of unit cubes and its neighbour along x (edge), in
 * the xy diagonal (face) or the space diagonal (body): assembled from the springs of all cubes. */
cdem_status cdem_net_cube_block(cdem_class class_, double nu, double s[9], cdem_fault *fault);

/* The block of the bond, along x, that two equilateral triangles share. */
cdem_status cdem_net_triangle_block(bool plane_stress, double nu, double s[4], cdem_fault *fault);

#endif
