/* Any closed solid mesh. */
#include "fdem/template.h"

static cdem_status make(const cdem_grain_shape_options *options, cdem_mesh *mesh,
                        cdem_fault *fault) {
  const cdem_mesh *from = options->mesh;
  *mesh = (cdem_mesh){0};
  CDEM_REQUIRE(from != NULL && cdem_mesh_dimension(from) == 3, fault, CDEM_INPUT,
               "a grain shape needs a mesh of solid cells (tetrahedra, hexahedra, ...); this one "
               "has none");
  cdem_status status = cdem_mesh_add_nodes(mesh, from->nodes, from->xyz, from->node_tag, fault);
  for (int32_t c = 0; c < from->cells && status == CDEM_OK; c++) {
    cdem_shape shape = (cdem_shape)from->cell_shape[c];
    if (cdem_shape_get(shape)->dimension == 3)
      status =
          cdem_mesh_add_cells(mesh, shape, 1, cdem_mesh_cell(from, c), &from->cell_tag[c], fault);
  }
  if (status != CDEM_OK)
    cdem_mesh_release(mesh);
  return status;
}

const cdem_grain_shape cdem_grain_shape_mesh = {
    .name = "mesh",
    .help = "the solid cells of a mesh file: any closed body, convex or not",
    .make = make};
