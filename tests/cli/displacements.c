/* Displacements of a run against a table of another program: "tag ux uy uz" a line, m.
 *
 * usage: displacements CHECKPOINT TABLE BOUND
 * Exit status 0 when no node differs by more than BOUND times the largest displacement. */
#include "io/run_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
  int64_t seen;
  double worst, largest;
} comparison;

static void compare_line(const cdem_mesh *mesh, const cdem_array *u, const char *line,
                         comparison *found) {
  long long tag;
  double x[3];
  if (sscanf(line, "%lld %lf %lf %lf", &tag, &x[0], &x[1], &x[2]) != 4)
    return;
  int dofs = (int)(u->count / mesh->nodes);
  for (int32_t n = 0; n < mesh->nodes; n++) {
    if (mesh->node_tag[n] != tag)
      continue;
    found->seen++;
    for (int k = 0; k < dofs; k++) {
      found->worst = fmax(found->worst, fabs(x[k] - ((const double *)u->data)[dofs * n + k]));
      found->largest = fmax(found->largest, fabs(x[k]));
    }
  }
}

int main(int argc, char **argv) {
  if (argc != 4) {
    fprintf(stderr, "usage: displacements CHECKPOINT TABLE BOUND\n");
    return 2;
  }
  cdem_fault fault = {0};
  cdem_state state = {0};
  cdem_mesh mesh = {0};
  if (cdem_read_state(argv[1], &state, &fault) != CDEM_OK ||
      cdem_mesh_from_state(&state, "mesh", &mesh, &fault) != CDEM_OK) {
    fprintf(stderr, "%s\n", fault.message);
    return 2;
  }
  const cdem_array *u = cdem_state_find(&state, "solver/u");
  FILE *table = fopen(argv[2], "r");
  if (u == NULL || table == NULL) {
    fprintf(stderr, "no displacements in %s, or no file %s\n", argv[1], argv[2]);
    return 2;
  }
  comparison found = {0};
  char line[256];
  while (fgets(line, sizeof line, table) != NULL)
    compare_line(&mesh, u, line, &found);
  fclose(table);
  printf("%lld nodes, largest displacement %.6e m, largest difference %.2e of it\n",
         (long long)found.seen, found.largest, found.worst / found.largest);
  int64_t nodes = mesh.nodes;
  cdem_mesh_release(&mesh);
  cdem_state_release(&state);
  return found.seen == nodes && found.largest > 0.0 &&
                 found.worst <= strtod(argv[3], NULL) * found.largest
             ? 0
             : 1;
}
