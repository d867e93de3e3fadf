/* Node coordinates of one element, from a mesh or from a list of coordinates. */
#include "command.h"
#include "io/io.h"
#include "poisson.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has_ending(const char *path, const char *ending) {
  size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcmp(path + length - tail, ending) == 0;
}

/* Numbers of one line, parted by spaces or commas; -1 when something else stands there. */
static int numbers_of(char *line, double value[4]) {
  int count = 0;
  line[strcspn(line, "#\r\n")] = '\0';
  for (char *at = line;;) {
    while (isspace((unsigned char)*at) || *at == ',')
      at++;
    if (*at == '\0')
      return count;
    char *end;
    double number = strtod(at, &end);
    if (end == at || !isfinite(number) || count == 4)
      return -1;
    value[count++] = number;
    at = end;
  }
}

static cdem_status read_lines(FILE *file, const char *path, const cdem_element *element,
                              double (*xyz)[3], cdem_fault *fault) {
  char line[512];
  int nodes = cdem_element_nodes(element), dimension = cdem_element_dimension(element);
  int node = 0, number = 0;
  while (fgets(line, sizeof line, file) != NULL) {
    double value[4] = {0};
    int count = numbers_of(line, value);
    number++;
    if (count == 0)
      continue;
    CDEM_REQUIRE(count == dimension || (count == 3 && dimension == 2), fault, CDEM_INPUT,
                 "cannot read '%s': line %d: %d coordinates are wanted", path, number, dimension);
    CDEM_REQUIRE(node < nodes, fault, CDEM_INPUT,
                 "cannot read '%s': line %d: %s has %d nodes, here is one more", path, number,
                 element->name, nodes);
    for (int d = 0; d < 3; d++)
      xyz[node][d] = d < dimension ? value[d] : 0.0;
    node++;
  }
  CDEM_REQUIRE(!ferror(file), fault, CDEM_FILE, "cannot read '%s': %s", path, strerror(errno));
  CDEM_REQUIRE(node == nodes, fault, CDEM_INPUT,
               "cannot read '%s': %d nodes are there, %s has %d; give one node a line", path, node,
               element->name, nodes);
  return CDEM_OK;
}

static cdem_status read_text(const char *path, const cdem_element *element, double (*xyz)[3],
                             cdem_fault *fault) {
  FILE *file = fopen(path, "r");
  CDEM_REQUIRE(file != NULL, fault, CDEM_FILE, "cannot open '%s': %s", path, strerror(errno));
  cdem_status status = read_lines(file, path, element, xyz, fault);
  fclose(file);
  return status;
}

static cdem_status take_cell(const cdem_mesh *mesh, const char *path, const cdem_element *element,
                             double (*xyz)[3], cdem_fault *fault) {
  int32_t found = -1;
  int dimension = cdem_element_dimension(element);
  for (int32_t c = 0; c < mesh->cells; c++) {
    if (cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension != dimension)
      continue;
    CDEM_REQUIRE(found < 0, fault, CDEM_INPUT,
                 "mesh '%s' has more than one cell of dimension %d; one is wanted", path,
                 dimension);
    found = c;
  }
  CDEM_REQUIRE(found >= 0, fault, CDEM_INPUT, "mesh '%s' has no cell of dimension %d", path,
               dimension);
  CDEM_REQUIRE(mesh->cell_shape[found] == element->shape, fault, CDEM_INPUT,
               "the cell of mesh '%s' is a %s; element %s wants a %s", path,
               cdem_shape_get((cdem_shape)mesh->cell_shape[found])->name, element->name,
               cdem_shape_get(element->shape)->name);
  const int32_t *node = cdem_mesh_cell(mesh, found);
  for (int a = 0; a < cdem_element_nodes(element); a++)
    memcpy(xyz[a], mesh->xyz + 3 * (int64_t)node[a], sizeof xyz[a]);
  return CDEM_OK;
}

cdem_status poisson_read_shape(const char *path, const cdem_element *element,
                               const cdem_warnings *warnings, double (*xyz)[3], cdem_fault *fault) {
  if (has_ending(path, ".txt") || has_ending(path, ".csv") || has_ending(path, ".dat"))
    return read_text(path, element, xyz, fault);
  cdem_mesh mesh = {0};
  command_guard(path);
  cdem_status status = cdem_read_mesh(path, &mesh, warnings, fault);
  command_guard(NULL);
  if (status == CDEM_OK)
    status = take_cell(&mesh, path, element, xyz, fault);
  cdem_mesh_release(&mesh);
  return status;
}
