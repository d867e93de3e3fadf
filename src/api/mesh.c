/* Meshes: read, generated or built. */
#include "api/store.h"

#include <stdlib.h>

static cdem_status create(libcdem_mesh **mesh, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(mesh, "a place for the mesh", fault));
  CDEM_NEW(*mesh, 1, fault);
  return CDEM_OK;
}

libcdem_status libcdem_mesh_create(libcdem_mesh **mesh, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(create(mesh, &own), &own, fault);
}

void libcdem_mesh_destroy(libcdem_mesh **mesh) {
  if (mesh == NULL || *mesh == NULL)
    return;
  cdem_mesh_release(&(*mesh)->mesh);
  free(*mesh);
  *mesh = NULL;
}

/* A handle of what a reader or generator has made. */
static cdem_status hand_out(cdem_mesh *made, libcdem_mesh **mesh, cdem_fault *fault) {
  libcdem_mesh *handle = NULL;
  cdem_status status = create(&handle, fault);
  if (status != CDEM_OK) {
    cdem_mesh_release(made);
    return status;
  }
  handle->mesh = *made;
  *mesh = handle;
  return CDEM_OK;
}

static cdem_status read_mesh(const char *path, const libcdem_listener *listener,
                             libcdem_mesh **mesh, cdem_fault *fault) {
  cdem_api_ears ears;
  cdem_mesh made = {0};
  CDEM_TRY(cdem_api_want(path, "the path of a mesh", fault));
  CDEM_TRY(cdem_api_want(mesh, "a place for the mesh", fault));
  cdem_api_listen(listener, &ears);
  CDEM_TRY(cdem_read_mesh(path, &made, &ears.warnings, fault));
  return hand_out(&made, mesh, fault);
}

libcdem_status libcdem_mesh_read(const char *path, const libcdem_listener *listener,
                                 libcdem_mesh **mesh, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(read_mesh(path, listener, mesh, &own), &own, fault);
}

static cdem_status find_shape(const char *name, cdem_shape *shape, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(name, "the name of a shape", fault));
  *shape = cdem_shape_find(name);
  CDEM_REQUIRE(*shape != CDEM_SHAPE_COUNT, fault, CDEM_USAGE, "there is no shape '%.40s'", name);
  return CDEM_OK;
}

static cdem_status make_box(const char *shape, const int32_t *count, const double *size,
                            libcdem_mesh **mesh, cdem_fault *fault) {
  cdem_mesh_grid_options options = {0};
  cdem_mesh made = {0};
  CDEM_TRY(find_shape(shape, &options.shape, fault));
  CDEM_TRY(cdem_api_want(count, "a number of bricks", fault));
  CDEM_TRY(cdem_api_want(size, "a size", fault));
  CDEM_TRY(cdem_api_want(mesh, "a place for the mesh", fault));
  for (int c = 0; c < 3; c++) {
    options.count[c] = count[c];
    options.size[c] = size[c];
  }
  CDEM_TRY(cdem_mesh_grid(&options, &made, fault));
  return hand_out(&made, mesh, fault);
}

libcdem_status libcdem_mesh_box(const char *shape, const int32_t *count, const double *size,
                                libcdem_mesh **mesh, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(make_box(shape, count, size, mesh, &own), &own, fault);
}

/* ---- built node by node ---- */

static cdem_status add_nodes(libcdem_mesh *mesh, int64_t nodes, const double *xyz,
                             cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(mesh, "a mesh", fault));
  CDEM_TRY(cdem_api_want(xyz, "coordinates", fault));
  return cdem_mesh_add_nodes(&mesh->mesh, nodes, xyz, NULL, fault);
}

libcdem_status libcdem_mesh_add_nodes(libcdem_mesh *mesh, int64_t nodes, const double *xyz,
                                      libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(add_nodes(mesh, nodes, xyz, &own), &own, fault);
}

static cdem_status add_cells(libcdem_mesh *mesh, const char *shape, int64_t cells,
                             const int32_t *node, cdem_fault *fault) {
  cdem_shape found;
  CDEM_TRY(cdem_api_want(mesh, "a mesh", fault));
  CDEM_TRY(find_shape(shape, &found, fault));
  CDEM_TRY(cdem_api_want(node, "the nodes of the cells", fault));
  return cdem_mesh_add_cells(&mesh->mesh, found, cells, node, NULL, fault);
}

libcdem_status libcdem_mesh_add_cells(libcdem_mesh *mesh, const char *shape, int64_t cells,
                                      const int32_t *node, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(add_cells(mesh, shape, cells, node, &own), &own, fault);
}

static cdem_status add_group(libcdem_mesh *mesh, const char *name, int64_t cells,
                             const int32_t *cell, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(mesh, "a mesh", fault));
  CDEM_TRY(cdem_api_want(name, "the name of the group", fault));
  CDEM_TRY(cdem_api_want(cell, "the cells of the group", fault));
  const cdem_mesh *m = &mesh->mesh;
  CDEM_REQUIRE(cells > 0, fault, CDEM_USAGE, "group '%.60s' needs a cell at least", name);
  CDEM_REQUIRE(cell[0] >= 0 && cell[0] < m->cells, fault, CDEM_USAGE,
               "group '%.60s' names cell %d, but the mesh has %d", name, (int)cell[0],
               (int)m->cells);
  int dimension = cdem_shape_get((cdem_shape)m->cell_shape[cell[0]])->dimension;
  return cdem_mesh_add_group(&mesh->mesh, name, dimension, cells, cell, fault);
}

libcdem_status libcdem_mesh_add_group(libcdem_mesh *mesh, const char *name, int64_t cells,
                                      const int32_t *cell, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(add_group(mesh, name, cells, cell, &own), &own, fault);
}

int64_t libcdem_mesh_nodes(const libcdem_mesh *mesh) {
  return mesh != NULL ? mesh->mesh.nodes : 0;
}

int64_t libcdem_mesh_cells(const libcdem_mesh *mesh) {
  return mesh != NULL ? mesh->mesh.cells : 0;
}
