#include "verify/nets.h"

#include "network/assemble.h"
#include "verify/specimen.h"

#include <math.h>

/* Position of the node at (x, y, z) in the assembled matrix, -1 when there is none. */
static int32_t position_at(const cdem_mesh *mesh, const cdem_sparse *sparse, double x, double y,
                           double z) {
  for (int32_t n = 0; n < mesh->nodes; n++) {
    const double *at = mesh->xyz + 3 * (int64_t)n;
    if (fabs(at[0] - x) + fabs(at[1] - y) + fabs(at[2] - z) < 1e-9)
      return cdem_sparse_position(sparse, n);
  }
  return -1;
}

typedef struct {
  cdem_mesh mesh;
  cdem_model model;
  cdem_sparse sparse;
} network;

static cdem_status assemble(double nu, network *net, cdem_fault *fault) {
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {2, 2, 2}, .size = {2.0, 2.0, 2.0}};
  const cdem_material material = cdem_material_isotropic(1.0, nu);
  const cdem_model_options options = {.mesh = &net->mesh,
                                      .materials = 1,
                                      .material = &material,
                                      .section = {CDEM_PLANE_STRAIN, 1.0}};
  const cdem_convert_options convert = {.frame = CDEM_FRAME_BODY};
  CDEM_TRY(cdem_mesh_grid(&grid, &net->mesh, fault));
  CDEM_TRY(cdem_model_init(&options, &net->model, fault));
  CDEM_TRY(cdem_sparse_init(&net->model, &net->sparse, fault));
  cdem_pair_sink sink = cdem_sparse_sink(&net->sparse);
  return cdem_network_convert(&net->model, &convert, &sink, 1, fault);
}

static cdem_status inner_block(cdem_class class_, const network *net, double s[9],
                               cdem_fault *fault) {
  int32_t centre = position_at(&net->mesh, &net->sparse, 1, 1, 1);
  int32_t other = position_at(&net->mesh, &net->sparse, 2, class_ == CDEM_CLASS_EDGE ? 1 : 2,
                              class_ == CDEM_CLASS_BODY ? 2 : 1);
  const double *block =
      centre >= 0 && other >= 0 ? cdem_sparse_block(&net->sparse, centre, other) : NULL;
  CDEM_REQUIRE(block != NULL, fault, CDEM_NUMERIC, "the inner pair is not in the network");
  for (int i = 0; i < 9; i++)
    s[i] = -block[i];
  return CDEM_OK;
}

cdem_status cdem_net_cube_block(cdem_class class_, double nu, double s[9], cdem_fault *fault) {
  network net = {0};
  cdem_status status = assemble(nu, &net, fault);
  if (status == CDEM_OK)
    status = inner_block(class_, &net, s, fault);
  cdem_sparse_release(&net.sparse);
  cdem_model_release(&net.model);
  cdem_mesh_release(&net.mesh);
  return status;
}

/* The second triangle is the first turned by 180 degrees, which keeps its blocks and exchanges the
 * nodes: it adds the transposed block. */
cdem_status cdem_net_triangle_block(bool plane_stress, double nu, double s[4], cdem_fault *fault) {
  cdem_specimen_options options = {.element = cdem_element_find("tri3")};
  cdem_specimen triangle = {0};
  double one[3 * 4];
  options.section.plane = plane_stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN;
  CDEM_TRY(cdem_specimen_init(&options, &triangle, fault));
  cdem_status status = cdem_specimen_blocks(&triangle, nu, one, fault);
  cdem_specimen_release(&triangle);
  CDEM_TRY(status);
  for (int i = 0; i < 4; i++)
    s[i] = one[i] + one[2 * (i % 2) + i / 2];
  return CDEM_OK;
}
