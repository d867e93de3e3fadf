/* Components and boundary of a set of cells. */
#include "base/sets.h"
#include "mesh/mesh.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The chosen cells are cells of the mesh and share one dimension, which is returned through
 * *dimension (-1 for no cells). */
static cdem_status check_choice(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                int *dimension, cdem_fault *fault) {
  *dimension = -1;
  CDEM_REQUIRE(cells >= 0, fault, CDEM_USAGE, "cannot choose %" PRId32 " cells", cells);
  for (int32_t i = 0; i < cells; i++) {
    CDEM_REQUIRE(cell[i] >= 0 && cell[i] < mesh->cells, fault, CDEM_USAGE,
                 "chosen cell id %" PRId32 " is outside the mesh of %" PRId32 " cells", cell[i],
                 mesh->cells);
    int own = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[i]])->dimension;
    CDEM_REQUIRE(*dimension < 0 || own == *dimension, fault, CDEM_USAGE,
                 "chosen cells are of mixed dimension: element %" PRId64
                 " has dimension %d, those before it %d",
                 mesh->cell_tag[cell[i]], own, *dimension);
    *dimension = own;
  }
  return CDEM_OK;
}

cdem_status cdem_mesh_components(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                 int32_t *node_component, int32_t *components, cdem_fault *fault) {
  int dimension;
  CDEM_TRY(check_choice(mesh, cell, cells, &dimension, fault));
  int32_t *parent;
  CDEM_NEW(parent, mesh->nodes, fault);
  for (int32_t n = 0; n < mesh->nodes; n++)
    parent[n] = -1;
  for (int32_t i = 0; i < cells; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, cell[i]);
    int nodes = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[i]])->nodes;
    for (int k = 0; k < nodes; k++) {
      if (parent[node[k]] < 0)
        parent[node[k]] = node[k];
      cdem_sets_join(parent, node[0], node[k]);
    }
  }
  /* A root comes before the nodes of its set, so its number is known when they ask for it. */
  int32_t found = 0;
  for (int32_t n = 0; n < mesh->nodes; n++) {
    if (parent[n] < 0)
      node_component[n] = -1;
    else if (parent[n] == n)
      node_component[n] = found++;
    else
      node_component[n] = node_component[cdem_sets_root(parent, n)];
  }
  *components = found;
  free(parent);
  return CDEM_OK;
}

/* A facet without its smallest corner, by which facets are bucketed: the other corners ascending
 * (-1 where there is none), and the chosen cell it belongs to. */
typedef struct {
  int32_t corner[3];
  int32_t cell;
} facet;

static int facet_count(const cdem_shape_info *info) {
  return info->dimension == 3   ? info->faces
         : info->dimension == 2 ? info->edges
         : info->dimension == 1 ? info->corners
                                : 0;
}

/* Local nodes of a facet, corners first, into local [8]; returns how many, and the corners. */
static int facet_nodes(const cdem_shape_info *info, int index, int8_t local[8], int *corners) {
  int nodes = 0;
  if (info->dimension == 3) {
    while (nodes < 8 && info->face[index][nodes] >= 0) {
      local[nodes] = info->face[index][nodes];
      nodes++;
    }
    *corners = info->face_corners[index];
    return nodes;
  }
  if (info->dimension == 1) {
    local[0] = (int8_t)index;
    *corners = 1;
    return 1;
  }
  while (nodes < 3 && info->edge[index][nodes] >= 0) {
    local[nodes] = info->edge[index][nodes];
    nodes++;
  }
  *corners = 2;
  return nodes;
}

/* Sorted corners of a facet: returns the smallest, fills rest [3]. */
static int32_t facet_key(const cdem_shape_info *info, const int32_t *node, int index,
                         int32_t rest[3]) {
  int8_t local[8];
  int corners;
  facet_nodes(info, index, local, &corners);
  int32_t sorted[4] = {-1, -1, -1, -1};
  for (int k = 0; k < corners; k++) {
    int32_t id = node[local[k]];
    int at = k;
    for (; at > 0 && sorted[at - 1] > id; at--)
      sorted[at] = sorted[at - 1];
    sorted[at] = id;
  }
  memcpy(rest, sorted + 1, 3 * sizeof *rest);
  return sorted[0];
}

static int compare_corners(const int32_t a[3], const int32_t b[3]) {
  for (int k = 0; k < 3; k++)
    if (a[k] != b[k])
      return a[k] < b[k] ? -1 : 1;
  return 0;
}

static int compare_facets(const void *a, const void *b) {
  return compare_corners(((const facet *)a)->corner, ((const facet *)b)->corner);
}

/* Buckets are short (12 in a hexahedral mesh) unless the mesh is a fan, where qsort takes over. */
static void sort_bucket(facet *facets, int64_t count) {
  if (count > 32) {
    qsort(facets, (size_t)count, sizeof *facets, compare_facets);
    return;
  }
  for (int64_t i = 1; i < count; i++) {
    facet moved = facets[i];
    int64_t at = i;
    for (; at > 0 && compare_facets(&facets[at - 1], &moved) > 0; at--)
      facets[at] = facets[at - 1];
    facets[at] = moved;
  }
}

/* Marks all nodes, mid nodes too, of the facet with these corners. */
static void mark_facet(const cdem_mesh *mesh, int32_t smallest, const facet *open, bool *boundary) {
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[open->cell]);
  const int32_t *node = cdem_mesh_cell(mesh, open->cell);
  for (int f = 0; f < facet_count(info); f++) {
    int32_t rest[3];
    if (facet_key(info, node, f, rest) != smallest || compare_corners(rest, open->corner) != 0)
      continue;
    int8_t local[8];
    int corners, nodes = facet_nodes(info, f, local, &corners);
    for (int k = 0; k < nodes; k++)
      boundary[node[local[k]]] = true;
  }
}

/* start [nodes + 1] receives the offsets of the buckets, one a smallest corner. */
static void count_facets(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                         int64_t *start) {
  for (int32_t i = 0; i < cells; i++) {
    const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[i]]);
    for (int f = 0; f < facet_count(info); f++) {
      int32_t rest[3];
      start[facet_key(info, cdem_mesh_cell(mesh, cell[i]), f, rest) + 1]++;
    }
  }
  for (int32_t n = 0; n < mesh->nodes; n++)
    start[n + 1] += start[n];
}

/* Puts every facet into its bucket; start [n] is then the end of bucket n. */
static void fill_facets(const cdem_mesh *mesh, const int32_t *cell, int32_t cells, int64_t *start,
                        facet *facets) {
  for (int32_t i = 0; i < cells; i++) {
    const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[cell[i]]);
    for (int f = 0; f < facet_count(info); f++) {
      facet one = {.cell = cell[i]};
      int32_t smallest = facet_key(info, cdem_mesh_cell(mesh, cell[i]), f, one.corner);
      facets[start[smallest]++] = one;
    }
  }
}

/* A facet on the boundary differs from its neighbours in the sorted bucket. */
static void mark_bucket(const cdem_mesh *mesh, int32_t smallest, facet *facets, int64_t count,
                        bool *boundary) {
  sort_bucket(facets, count);
  for (int64_t i = 0; i < count; i++) {
    bool same_before = i > 0 && compare_facets(&facets[i - 1], &facets[i]) == 0;
    bool same_after = i + 1 < count && compare_facets(&facets[i + 1], &facets[i]) == 0;
    if (!same_before && !same_after)
      mark_facet(mesh, smallest, &facets[i], boundary);
  }
}

cdem_status cdem_mesh_boundary_nodes(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                     bool *boundary, cdem_fault *fault) {
  int dimension;
  CDEM_TRY(check_choice(mesh, cell, cells, &dimension, fault));
  int64_t *start;
  CDEM_NEW(start, (int64_t)mesh->nodes + 1, fault);
  count_facets(mesh, cell, cells, start);
  facet *facets = cdem_allocate(start[mesh->nodes], sizeof *facets, fault);
  if (facets == NULL) {
    free(start);
    return CDEM_MEMORY;
  }
  fill_facets(mesh, cell, cells, start, facets);
  for (int32_t n = 0; n < mesh->nodes; n++)
    boundary[n] = false;
  int64_t from = 0;
  for (int32_t n = 0; n < mesh->nodes; n++) {
    mark_bucket(mesh, n, facets + from, start[n] - from, boundary);
    from = start[n];
  }
  free(facets);
  free(start);
  return CDEM_OK;
}
