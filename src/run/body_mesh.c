/* The mesh of a case: read from a file, or a grid. */
#include "io/case_file.h"
#include "run/body.h"

#include <stdlib.h>

/* Shapes of a grid, in the order of the choices of `mesh.shape`. */
static const char *const grid_shape[] = {"tri3", "quad4", "tet4", "pyr5", "wedge6", "hex8"};

static cdem_status read_file(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_mesh *wanted = &cdem_run_values(setup->run)->mesh;
  int count = (int)wanted->parameters.count;
  char *path = cdem_case_file_path(&setup->run->cases, wanted->file, fault);
  const char **name = cdem_allocate(count, sizeof *name, fault);
  double *value = cdem_allocate(count, sizeof *value, fault);
  cdem_status status = path == NULL || name == NULL || value == NULL ? CDEM_MEMORY : CDEM_OK;
  for (int i = 0; status == CDEM_OK && i < count; i++) {
    name[i] = wanted->parameters.item[i].name;
    value[i] = wanted->parameters.item[i].value;
  }
  if (status == CDEM_OK)
    status = cdem_read_mesh_with(path, count, name, value, &setup->mesh,
                                 setup->run->options->warnings, fault);
  if (status != CDEM_OK && status != CDEM_MEMORY)
    cdem_case_blame(&setup->run->cases, "mesh.file", fault);
  free(value);
  free(name);
  free(path);
  return status;
}

static cdem_status make_grid(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_mesh *wanted = &cdem_run_values(setup->run)->mesh;
  cdem_mesh_grid_options grid = {.shape = cdem_shape_find(grid_shape[wanted->shape - 1]),
                                 .distortion = wanted->distortion,
                                 .seed = (uint64_t)wanted->seed};
  for (int k = 0; k < 3; k++) {
    grid.count[k] = (int32_t)wanted->count[k];
    grid.size[k] = wanted->size[k];
  }
  cdem_status status = cdem_mesh_grid(&grid, &setup->mesh, fault);
  if (status == CDEM_USAGE) {
    cdem_case_blame(&setup->run->cases, "mesh", fault);
    if (fault != NULL)
      fault->status = CDEM_INPUT;
    return CDEM_INPUT;
  }
  return status;
}

cdem_status cdem_run_body_mesh(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_mesh *wanted = &cdem_run_values(setup->run)->mesh;
  bool grid = wanted->file == NULL;
  CDEM_TRY(grid ? make_grid(setup, fault) : read_file(setup, fault));
  double *xyz = setup->mesh.xyz;
  double unit = grid || !(wanted->unit > 0.0) ? 1.0 : wanted->unit;
  for (int64_t i = 0; i < setup->mesh.nodes; i++)
    for (int k = 0; k < 3; k++)
      xyz[3 * i + k] = unit * xyz[3 * i + k] + (grid ? wanted->origin[k] : 0.0);
  return CDEM_OK;
}
