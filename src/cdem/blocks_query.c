/* Blocks: what lies on a group, and how large a facet is. */
#include "cdem/blocks_cut.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Facets by their nodes. A joint that ends on both sides within one element leaves two facets with
 * the same nodes; they are sides of one pair, so that either leads to both. */
typedef struct {
  int64_t entries;
  int32_t *entry; /* facet + 1, 0: empty */
} facet_table;

static int64_t table_entry(const cdem_blocks *blocks, const facet_table *table,
                           const int32_t key[4]) {
  int64_t at = (int64_t)(cdem_cut_hash(key) & (uint64_t)(table->entries - 1));
  for (; table->entry[at] != 0; at = (at + 1) & (table->entries - 1)) {
    const cdem_facet *facet = &blocks->facet[table->entry[at] - 1];
    int32_t other[4];
    cdem_cut_key(facet->node, NULL, facet->corners, other);
    if (memcmp(key, other, sizeof other) == 0)
      break;
  }
  return at;
}

static cdem_status table_fill(const cdem_blocks *blocks, facet_table *table, cdem_fault *fault) {
  for (table->entries = 16; table->entries < 2 * (int64_t)blocks->facets;)
    table->entries *= 2;
  CDEM_NEW(table->entry, table->entries, fault);
  for (int32_t f = 0; f < blocks->facets; f++) {
    int32_t key[4];
    cdem_cut_key(blocks->facet[f].node, NULL, blocks->facet[f].corners, key);
    int64_t at = table_entry(blocks, table, key);
    if (table->entry[at] == 0)
      table->entry[at] = f + 1;
  }
  return CDEM_OK;
}

/* mark [facets] receives which facets lie on the group: both sides of a pair. Faces between two
 * cells that are not cut are no facets. */
static cdem_status mark_facets(const cdem_blocks *blocks, const cdem_group *group, bool *mark,
                               cdem_fault *fault) {
  facet_table table = {0};
  CDEM_TRY(table_fill(blocks, &table, fault));
  for (int32_t k = 0; k < group->cells; k++) {
    int32_t id = group->cell[k], key[4];
    const cdem_shape_info *info = cdem_shape_get((cdem_shape)blocks->mesh.cell_shape[id]);
    cdem_cut_key(cdem_mesh_cell(&blocks->mesh, id), NULL, info->corners, key);
    int32_t facet = table.entry[table_entry(blocks, &table, key)] - 1;
    if (facet < 0)
      continue;
    int32_t pair = blocks->facet[facet].pair;
    mark[facet] = true;
    if (pair >= 0)
      mark[blocks->pair_facet[2 * (int64_t)pair]] =
          mark[blocks->pair_facet[2 * (int64_t)pair + 1]] = true;
  }
  free(table.entry);
  return CDEM_OK;
}

/* The positions of what is marked, as a new array. */
static cdem_status list_marked(const bool *mark, int32_t of, int32_t *count, int32_t **list,
                               cdem_fault *fault) {
  int32_t found = 0, *made;
  for (int32_t i = 0; i < of; i++)
    found += mark[i];
  CDEM_NEW(made, found, fault);
  *count = found;
  *list = made;
  for (int32_t i = 0, at = 0; i < of; i++)
    if (mark[i])
      made[at++] = i;
  return CDEM_OK;
}

cdem_status cdem_blocks_group_facets(const cdem_blocks *blocks, const char *group, int32_t *count,
                                     int32_t **facet, cdem_fault *fault) {
  const cdem_group *found;
  CDEM_TRY(cdem_cut_group(&blocks->mesh, group, &found, fault));
  CDEM_REQUIRE(found->dimension == blocks->dimension - 1, fault, CDEM_INPUT,
               "group '%s' has dimension %d; a surface of cells of dimension %d is a group of %s",
               group, found->dimension, blocks->dimension,
               blocks->dimension == 3 ? "faces" : "edges");
  bool *mark;
  CDEM_NEW(mark, blocks->facets, fault);
  cdem_status status = mark_facets(blocks, found, mark, fault);
  if (status == CDEM_OK)
    status = list_marked(mark, blocks->facets, count, facet, fault);
  free(mark);
  return status;
}

/* Facets lead to the nodes of both sides of a pair. */
static cdem_status mark_facet_nodes(const cdem_blocks *blocks, const cdem_group *group, bool *mark,
                                    cdem_fault *fault) {
  bool *on;
  CDEM_NEW(on, blocks->facets, fault);
  cdem_status status = mark_facets(blocks, group, on, fault);
  for (int32_t f = 0; f < blocks->facets; f++)
    for (int k = 0; on[f] && k < blocks->facet[f].corners; k++)
      mark[blocks->facet[f].node[k]] = true;
  free(on);
  return status;
}

/* Copies of one node follow each other. */
static void mark_copies(const cdem_blocks *blocks, bool *mark) {
  int32_t nodes = blocks->mesh.nodes;
  for (int32_t n = 1; n < nodes; n++)
    mark[n] |= mark[n - 1] && blocks->original[n] == blocks->original[n - 1];
  for (int32_t n = nodes - 1; n > 0; n--)
    mark[n - 1] |= mark[n] && blocks->original[n] == blocks->original[n - 1];
}

cdem_status cdem_blocks_group_nodes(const cdem_blocks *blocks, const char *group, int32_t *count,
                                    int32_t **node, cdem_fault *fault) {
  const cdem_group *found;
  CDEM_TRY(cdem_cut_group(&blocks->mesh, group, &found, fault));
  bool *mark;
  CDEM_NEW(mark, blocks->mesh.nodes, fault);
  for (int32_t k = 0; k < found->cells; k++)
    for (int64_t c = blocks->mesh.cell_start[found->cell[k]];
         c < blocks->mesh.cell_start[found->cell[k] + 1]; c++)
      mark[blocks->mesh.cell_node[c]] = true;
  cdem_status status = CDEM_OK;
  if (found->dimension == blocks->dimension - 1)
    status = mark_facet_nodes(blocks, found, mark, fault);
  else if (found->dimension < blocks->dimension - 1)
    mark_copies(blocks, mark);
  if (status == CDEM_OK)
    status = list_marked(mark, blocks->mesh.nodes, count, node, fault);
  free(mark);
  return status;
}

static void difference(const double *a, const double *b, double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = a[i] - b[i];
}

/* A bilinear face x(xi, eta) has the area element x_xi x x_eta = J0 + xi J1 + eta J2 with J0 = a x
 * b, J1 = a x c, J2 = c x b, where x = m + a xi + b eta + c xi eta; the shape function of the
 * corner at (xi_i, eta_i) weighs it with J0 + (xi_i J1 + eta_i J2)/3. Along the mean normal the
 * four add up to |area|, on warped faces too. */
static void quad_area(const double *const x[4], double area[3], double share[4]) {
  static const double xi[4] = {-1, 1, 1, -1}, eta[4] = {-1, -1, 1, 1};
  double a[3], b[3], c[3], j[3][3];
  for (int i = 0; i < 3; i++) {
    a[i] = (x[1][i] + x[2][i] - x[0][i] - x[3][i]) / 4;
    b[i] = (x[2][i] + x[3][i] - x[0][i] - x[1][i]) / 4;
    c[i] = (x[0][i] + x[2][i] - x[1][i] - x[3][i]) / 4;
  }
  cdem_cross3(a, b, j[0]);
  cdem_cross3(a, c, j[1]);
  cdem_cross3(c, b, j[2]);
  double size = cdem_norm3(j[0]);
  for (int k = 0; k < 4; k++)
    share[k] = size > 0 ? size + (xi[k] * cdem_dot3(j[1], j[0]) + eta[k] * cdem_dot3(j[2], j[0])) /
                                     (3 * size)
                        : 0;
  for (int i = 0; i < 3; i++)
    area[i] = 4 * j[0][i];
}

void cdem_facet_area(const cdem_facet *facet, const double *xyz, double thickness, double area[3],
                     double share[4]) {
  const double *x[4] = {0};
  for (int k = 0; k < facet->corners; k++)
    x[k] = xyz + 3 * (int64_t)facet->node[k];
  if (facet->corners == 4) {
    quad_area(x, area, share);
    return;
  }
  double d[2][3];
  difference(x[1], x[0], d[0]);
  if (facet->corners == 2) {
    area[0] = d[0][1] * thickness; /* the interior is on the left of the edge, outside right */
    area[1] = -d[0][0] * thickness;
    area[2] = 0;
  } else {
    difference(x[2], x[0], d[1]);
    cdem_cross3(d[0], d[1], area);
    for (int i = 0; i < 3; i++)
      area[i] /= 2;
  }
  for (int k = 0; k < 4; k++)
    share[k] = k < facet->corners ? cdem_norm3(area) / facet->corners : 0;
}
