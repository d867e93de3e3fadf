#include "rebuild_mesh.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* xorshift64* (Vigna 2016); the seed must not be 0. */
double rebuild_random(uint64_t *seed) {
  uint64_t s = *seed;
  s ^= s >> 12;
  s ^= s << 25;
  s ^= s >> 27;
  *seed = s;
  return 2 * ((double)(s * UINT64_C(0x2545F4914F6CDD1D) >> 11) * 0x1p-53) - 1;
}

static int random_below(uint64_t *seed, int n) {
  int k = (int)((rebuild_random(seed) + 1) * 0.5 * n);
  return k < n ? k : n - 1;
}

/* How a unit box splits into cells: corners of the box 0 .. 7 as a hexahedron's, 8 its centre. */
typedef struct box_split {
  const char *stem; /* a kind's name starts with it */
  int cells;
  int corner[6][8];
} box_split;

static const box_split splits[] = {
    {"tri", 2, {{0, 1, 2}, {0, 2, 3}}},
    {"quad", 1, {{0, 1, 2, 3}}},
    {"hex", 1, {{0, 1, 2, 3, 4, 5, 6, 7}}},
    {"wedge", 2, {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}}},
    {"pyr",
     6,
     {{0, 1, 2, 3, 8},
      {4, 7, 6, 5, 8},
      {0, 4, 5, 1, 8},
      {1, 5, 6, 2, 8},
      {2, 6, 7, 3, 8},
      {3, 7, 4, 0, 8}}},
    /* Six tetrahedra around the diagonal 0-6. */
    {"tet",
     6,
     {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}},
};
static const double box_corner[9][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},   {0, 0, 1},
                                        {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {.5, .5, .5}};

/* Ideal places are multiples of 1/4: equal places compare equal. */
static int node_at(rebuild_mesh *mesh, const double place[3]) {
  for (int n = 0; n < mesh->nodes; n++)
    if (memcmp(mesh->ideal[n], place, sizeof mesh->ideal[n]) == 0)
      return n;
  assert(mesh->nodes < REBUILD_MAX_NODES);
  memcpy(mesh->ideal[mesh->nodes], place, sizeof mesh->ideal[0]);
  return mesh->nodes++;
}

/* The same cell in another of the orders its symmetry allows. */
static void turn_corners(rebuild_mesh *mesh, const reference_shape *shape, double corner[8][3]) {
  for (int k = 0; k < 6; k++) {
    const int *turn = shape->turn[random_below(&mesh->seed, 2)];
    double old[8][3];
    memcpy(old, corner, sizeof old);
    for (int c = 0; c < shape->corners; c++)
      memcpy(corner[c], old[turn[c]], sizeof old[0]);
  }
}

static void add_cell(rebuild_mesh *mesh, const reference_element *element, const int *corners,
                     int box, int group) {
  assert(mesh->cells < REBUILD_MAX_CELLS);
  rebuild_cell *cell = &mesh->cell[mesh->cells++];
  cell->element = element;
  cell->group = group;
  double corner[8][3];
  for (int c = 0; c < element->shape->corners; c++) {
    memcpy(corner[c], box_corner[corners[c]], sizeof corner[0]);
    corner[c][0] += box;
  }
  turn_corners(mesh, element->shape, corner);
  for (int n = 0; n < element->nodes; n++) {
    int edge[2] = {n, n};
    if (n >= element->shape->corners)
      reference_edge_of(element, n, edge);
    double place[3];
    for (int k = 0; k < 3; k++)
      place[k] = (corner[edge[0]][k] + corner[edge[1]][k]) / 2;
    cell->node[n] = node_at(mesh, place);
  }
}

void rebuild_mesh_add_box(rebuild_mesh *mesh, const char *kind, int box, int group) {
  const reference_element *element = reference_element_find(kind);
  mesh->dimension = element->shape->dimension;
  for (size_t s = 0; s < sizeof splits / sizeof *splits; s++)
    if (strncmp(kind, splits[s].stem, strlen(splits[s].stem)) == 0)
      for (int c = 0; c < splits[s].cells; c++)
        add_cell(mesh, element, splits[s].corner[c], box, group);
}

void rebuild_random_axes(uint64_t *seed, int dimension, double axis[3][3]) {
  double q[4], norm = 0;
  for (int k = 0; k < 4; k++) {
    q[k] = dimension == 2 && (k == 1 || k == 2) ? 0 : rebuild_random(seed);
    norm += q[k] * q[k];
  }
  norm = sqrt(norm);
  double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
  double turned[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
      {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
      {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
  };
  memcpy(axis, turned, sizeof turned);
}

/* Tags with gaps that run against the order of the file. */
static void number(rebuild_mesh *mesh) {
  for (int n = 0; n < mesh->nodes; n++)
    mesh->tag[n] = 3 + 7 * (int64_t)((n * 37 + 11) % mesh->nodes) + random_below(&mesh->seed, 7);
  for (int c = 0; c < mesh->cells; c++)
    mesh->cell[c].tag = 20 + 5 * (int64_t)(mesh->cells - c) + random_below(&mesh->seed, 5);
  for (int n = 0; n < mesh->nodes; n++)
    for (int m = 0; m < n; m++)
      assert(mesh->tag[n] != mesh->tag[m]);
}

static void move_middles(rebuild_mesh *mesh, double amount) {
  bool done[REBUILD_MAX_NODES] = {false};
  for (int c = 0; c < mesh->cells; c++) {
    const rebuild_cell *cell = &mesh->cell[c];
    for (int n = cell->element->shape->corners; n < cell->element->nodes; n++) {
      int node = cell->node[n], edge[2];
      if (done[node])
        continue;
      done[node] = true;
      reference_edge_of(cell->element, n, edge);
      for (int k = 0; k < mesh->dimension; k++)
        mesh->x[node][k] = (mesh->x[cell->node[edge[0]]][k] + mesh->x[cell->node[edge[1]]][k]) / 2 +
                           amount * rebuild_random(&mesh->seed);
    }
  }
}

void rebuild_mesh_distort(rebuild_mesh *mesh, double amount, const double stretch[3]) {
  for (int n = 0; n < mesh->nodes; n++)
    for (int k = 0; k < 3; k++)
      mesh->x[n][k] =
          mesh->ideal[n][k] + (k < mesh->dimension ? amount * rebuild_random(&mesh->seed) : 0);
  move_middles(mesh, amount / 3);
  double axis[3][3];
  rebuild_random_axes(&mesh->seed, mesh->dimension, axis);
  for (int n = 0; n < mesh->nodes; n++) {
    double turned[3] = {0};
    for (int k = 0; k < 3; k++)
      for (int c = 0; c < 3; c++)
        turned[c] += mesh->x[n][k] * stretch[k] * axis[k][c];
    memcpy(mesh->x[n], turned, sizeof turned);
  }
  number(mesh);
}

static void write_cells(const rebuild_mesh *mesh, FILE *file) {
  const rebuild_cell *first = &mesh->cell[0];
  int boundary = mesh->dimension == 2 ? 2 : 3; /* a line or a triangle on the first corners */
  fprintf(file, "$Elements\n%d\n", mesh->cells + 2);
  for (int b = 0; b < 2; b++) {
    fprintf(file, "%d %d 2 0 %d", 2 + b, mesh->dimension == 2 ? 1 : 2, 90 + b);
    for (int n = 0; n < boundary; n++)
      fprintf(file, " %" PRId64, mesh->tag[first->node[(n + b) % boundary]]);
    fputc('\n', file);
  }
  for (int c = 0; c < mesh->cells; c++) {
    const rebuild_cell *cell = &mesh->cell[c];
    fprintf(file, "%" PRId64 " %d 2 %d %d", cell->tag, cell->element->gmsh_type, cell->group,
            1 + c % 3);
    for (int n = 0; n < cell->element->nodes; n++)
      fprintf(file, " %" PRId64, mesh->tag[cell->node[n]]);
    fputc('\n', file);
  }
  fputs("$EndElements\n", file);
}

bool rebuild_mesh_write(const rebuild_mesh *mesh, const char *path) {
  FILE *file = fopen(path, "w");
  if (file == NULL)
    return false;
  fputs("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", file);
  if (mesh->groups > 0) {
    fprintf(file, "$PhysicalNames\n%d\n", mesh->groups);
    for (int g = 1; g <= mesh->groups; g++)
      fprintf(file, "%d %d \"%s\"\n", mesh->dimension, g, mesh->group[g]);
    fputs("$EndPhysicalNames\n", file);
  }
  fprintf(file, "$Nodes\n%d\n", mesh->nodes);
  for (int n = 0; n < mesh->nodes; n++)
    fprintf(file, "%" PRId64 " %.17g %.17g %.17g\n", mesh->tag[n], mesh->x[n][0], mesh->x[n][1],
            mesh->x[n][2]);
  fputs("$EndNodes\n", file);
  write_cells(mesh, file);
  bool written = ferror(file) == 0;
  return fclose(file) == 0 && written;
}
