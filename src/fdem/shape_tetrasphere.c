/* The same sphere of four-node tetrahedra: stiffer and cheaper. */
#include "fdem/icosphere.h"
#include "fdem/template.h"

static cdem_status make(const cdem_grain_shape_options *options, cdem_mesh *mesh,
                        cdem_fault *fault) {
  return cdem_icosphere_mesh(options->refinement, false, mesh, fault);
}

const cdem_grain_shape cdem_grain_shape_tetrasphere = {
    .name = "tetrasphere",
    .help = "sphere of four-node tetrahedra over an icosahedron cut `refinement` times",
    .least = 0,
    .most = 3,
    .ball = true,
    .make = make};
