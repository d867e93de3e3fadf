/* The springs of one cube, from the library: which stiffness joins which corners.
 *
 *   cc cube.c $(pkg-config --cflags --libs cdem) -o cube && ./cube
 */
#include "network/network.h"

#include <stdio.h>

static cdem_status print_pairs(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                               cdem_fault *fault) {
  (void)context, (void)buffer, (void)fault;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    const cdem_pair *pair = &chunk->pair[p];
    printf("%d-%d %s %s:", pair->local[0] + 1, pair->local[1] + 1, cdem_class_name(pair->class_),
           cdem_form_name(pair->set.form));
    for (int r = 0; r < pair->set.rows; r++)
      printf(" %.6g", pair->set.row[r].stiffness);
    printf("\n");
  }
  return CDEM_OK;
}

int main(void) {
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_mesh_grid_options cube = {
      .shape = CDEM_SHAPE_HEX8, .count = {1, 1, 1}, .size = {1.0, 1.0, 1.0}};
  cdem_material rock = cdem_material_isotropic(40e9, 0.25);
  cdem_model_options body = {
      .mesh = &mesh, .materials = 1, .material = &rock, .section = {CDEM_PLANE_STRAIN, 1.0}};
  cdem_convert_options convert = {.frame = CDEM_FRAME_BODY};
  cdem_pair_sink sink = {.write = print_pairs};
  cdem_status status = cdem_mesh_grid(&cube, &mesh, &fault);
  if (status == CDEM_OK)
    status = cdem_model_init(&body, &model, &fault);
  if (status == CDEM_OK)
    status = cdem_network_convert(&model, &convert, &sink, 1, &fault);
  if (status != CDEM_OK)
    fprintf(stderr, "error: %s\n", fault.message);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  return cdem_status_exit_code(status);
}
