/* The springs of one cube, from the library: which stiffness joins which corners.
 *
 *   cc cube.c $(pkg-config --cflags --libs cdem) -o cube && ./cube
 */
#include <libcdem.h>
#include <stdio.h>

static bool print_pair(void *context, const libcdem_pair *pair) {
  (void)context;
  printf("%d-%d %s %s:", pair->place[0] + 1, pair->place[1] + 1, libcdem_class_name(pair->kind),
         libcdem_form_name(pair->springs.form));
  for (int t = 0; t < pair->springs.terms; t++)
    printf(" %.6g", pair->springs.term[t].stiffness);
  printf("\n");
  return true;
}

int main(void) {
  const int32_t bricks[3] = {1, 1, 1};
  const double edge[3] = {1.0, 1.0, 1.0}, young_and_poisson[2] = {40e9, 0.25};
  libcdem_fault fault = {0};
  libcdem_mesh *cube = NULL;
  libcdem_model *rock = NULL;
  libcdem_status status = libcdem_mesh_box("hex8", bricks, edge, &cube, &fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_create(cube, &rock, &fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_material(rock, "isotropic", 2, young_and_poisson, &fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_visit(rock, print_pair, NULL, NULL, &fault);
  if (status != LIBCDEM_OK)
    fprintf(stderr, "error: %s\n", fault.message);
  libcdem_model_destroy(&rock);
  libcdem_mesh_destroy(&cube);
  return (int)status;
}
