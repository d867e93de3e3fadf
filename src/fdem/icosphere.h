/* Private to fdem: the sphere as an icosahedron whose faces are cut into four again and again, in
 * shells about its centre. */
#ifndef CDEM_FDEM_ICOSPHERE_H
#define CDEM_FDEM_ICOSPHERE_H

#include "mesh/mesh.h"

/* Tetrahedra of the unit ball: 20 * 4^refinement faces, max(1, 2^(refinement - 1)) shells; the
 * innermost consists of tetrahedra to the centre, the others of prisms cut in three. With `second`
 * their edges have mid nodes (tet10), those between two corners at one distance from the centre at
 * that distance too. */
cdem_status cdem_icosphere_mesh(int refinement, bool second, cdem_mesh *mesh, cdem_fault *fault);

#endif
