/* The sphere of the source (Wang et al. 2024, table 2): at refinement 1 an icosphere of 42 corners
 * and 80 faces, one ten-node tetrahedron a face to the centre, 205 nodes. */
#include "fdem/icosphere.h"
#include "fdem/template.h"

static cdem_status make(const cdem_grain_shape_options *options, cdem_mesh *mesh,
                        cdem_fault *fault) {
  return cdem_icosphere_mesh(options->refinement, true, mesh, fault);
}

const cdem_grain_shape cdem_grain_shape_icosphere = {
    .name = "icosphere",
    .help = "sphere of ten-node tetrahedra over an icosahedron cut `refinement` times (1: 80 "
            "elements, 205 nodes)",
    .least = 0,
    .most = 2,
    .ball = true,
    .make = make};
