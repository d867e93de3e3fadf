/* Meshes of distorted cells for the rebuild test, written as MSH 2.2 text. */
#ifndef CDEM_TESTS_CLI_REBUILD_MESH_H
#define CDEM_TESTS_CLI_REBUILD_MESH_H

#include "reference_element.h"

#include <stdint.h>

enum { REBUILD_MAX_NODES = 256, REBUILD_MAX_CELLS = 32, REBUILD_MAX_GROUPS = 9 };

typedef struct rebuild_cell {
  const reference_element *element;
  int64_t tag;
  int group; /* 1 .. groups; 0: in none */
  int node[REFERENCE_MAX_NODES];
} rebuild_cell;

typedef struct rebuild_mesh {
  int dimension, nodes, cells, groups;
  double ideal[REBUILD_MAX_NODES][3]; /* place before the distortion: tells shared nodes apart */
  double x[REBUILD_MAX_NODES][3];
  int64_t tag[REBUILD_MAX_NODES];
  rebuild_cell cell[REBUILD_MAX_CELLS];
  const char *group[REBUILD_MAX_GROUPS + 1];
  uint64_t seed;
} rebuild_mesh;

/* Uniform in -1 .. 1. */
double rebuild_random(uint64_t *seed);

/* Cells of one kind that fill the unit box from x = box on, in local orders turned at random;
 * boxes side by side share nodes. `group` as in rebuild_cell. */
void rebuild_mesh_add_box(rebuild_mesh *mesh, const char *kind, int box, int group);

/* Moves corners by up to `amount` in each direction and mid-edge nodes by a third of that from the
 * middle of their edge; then a stretch, a turn, and tags with gaps, in no order. */
void rebuild_mesh_distort(rebuild_mesh *mesh, double amount, const double stretch[3]);

/* False when the file cannot be written. Adds cells of the dimension below, which are no elements.
 */
bool rebuild_mesh_write(const rebuild_mesh *mesh, const char *path);

/* An orthonormal right-handed triad in the rows of axis (dimension 2: turned about z). */
void rebuild_random_axes(uint64_t *seed, int dimension, double axis[3][3]);

#endif
