#include "fdem/icosphere.h"

#include <stdlib.h>
#include <string.h>

/* Corners and faces of the unit sphere. */
typedef struct {
  int32_t corners, faces;
  double (*corner)[3];
  int32_t (*face)[3];
} sphere;

/* Nodes in the middle of edges, found by the two ends. */
typedef struct {
  int64_t slots;
  uint64_t *key; /* 0: free */
  int32_t *node;
} edge_table;

static cdem_status edges_init(int64_t edges, edge_table *table, cdem_fault *fault) {
  table->slots = 64;
  while (table->slots < 2 * edges)
    table->slots *= 2;
  CDEM_NEW(table->key, table->slots, fault);
  CDEM_NEW(table->node, table->slots, fault);
  return CDEM_OK;
}

static void edges_release(edge_table *table) {
  free(table->key);
  free(table->node);
}

/* The slot of an edge, in use or free. */
static int64_t edges_find(const edge_table *table, int32_t a, int32_t b) {
  uint64_t low = (uint64_t)(a < b ? a : b), high = (uint64_t)(a < b ? b : a);
  uint64_t key = low << 32 | high;
  int64_t slot = (int64_t)((key * 0x9e3779b97f4a7c15u) >> 20) & (table->slots - 1);
  while (table->key[slot] != 0 && table->key[slot] != key)
    slot = (slot + 1) & (table->slots - 1);
  if (table->key[slot] == 0) {
    table->key[slot] = key;
    table->node[slot] = -1;
  }
  return slot;
}

static void to_length(double x[3], double length) {
  double norm = cdem_norm3(x);
  for (int c = 0; c < 3; c++)
    x[c] *= length / norm;
}

/* ---- the sphere ---- */

static void icosahedron(sphere *s) {
  static const int8_t face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const double g = 0.5 * (1.0 + sqrt(5.0));
  const double corner[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  s->corners = 12;
  s->faces = 20;
  for (int i = 0; i < 12; i++) {
    memcpy(s->corner[i], corner[i], sizeof corner[i]);
    to_length(s->corner[i], 1.0);
  }
  for (int i = 0; i < 20; i++)
    for (int k = 0; k < 3; k++)
      s->face[i][k] = face[i][k];
}

static int32_t middle_of(sphere *s, edge_table *table, int32_t a, int32_t b) {
  int64_t slot = edges_find(table, a, b);
  if (table->node[slot] < 0) {
    int32_t node = table->node[slot] = s->corners++;
    for (int c = 0; c < 3; c++)
      s->corner[node][c] = 0.5 * (s->corner[a][c] + s->corner[b][c]);
    to_length(s->corner[node], 1.0);
  }
  return table->node[slot];
}

/* Each face becomes four, the first at its place and three behind all others. */
static void cut_faces(sphere *s, edge_table *table) {
  int32_t faces = s->faces;
  for (int32_t f = 0; f < faces; f++) {
    int32_t *face = s->face[f], mid[3];
    for (int k = 0; k < 3; k++)
      mid[k] = middle_of(s, table, face[k], face[(k + 1) % 3]);
    for (int k = 0; k < 3; k++) {
      int32_t *made = s->face[s->faces++];
      made[0] = face[k], made[1] = mid[k], made[2] = mid[(k + 2) % 3];
    }
    memcpy(face, mid, sizeof mid);
  }
}

static cdem_status sphere_init(int refinement, sphere *s, cdem_fault *fault) {
  int64_t faces = (int64_t)20 << (2 * refinement);
  CDEM_NEW(s->corner, faces / 2 + 2, fault);
  CDEM_NEW(s->face, faces, fault);
  icosahedron(s);
  for (int r = 0; r < refinement; r++) {
    edge_table table = {0};
    cdem_status status = edges_init(3 * (int64_t)s->faces / 2, &table, fault);
    if (status == CDEM_OK)
      cut_faces(s, &table);
    edges_release(&table);
    CDEM_TRY(status);
  }
  return CDEM_OK;
}

static void sphere_release(sphere *s) {
  free(s->corner);
  free(s->face);
}

/* ---- the ball ---- */

/* Corner i of shell k: shells are numbered from outside, the centre comes last. */
static cdem_status add_corners(const sphere *s, int shells, cdem_mesh *mesh, cdem_fault *fault) {
  for (int k = 0; k < shells; k++)
    for (int32_t i = 0; i < s->corners; i++) {
      double x[3], radius = (double)(shells - k) / shells;
      for (int c = 0; c < 3; c++)
        x[c] = radius * s->corner[i][c];
      CDEM_TRY(cdem_mesh_add_nodes(mesh, 1, x, NULL, fault));
    }
  const double centre[3] = {0.0, 0.0, 0.0};
  return cdem_mesh_add_nodes(mesh, 1, centre, NULL, fault);
}

static void make_positive(const cdem_mesh *mesh, int32_t t[4]) {
  double e[9];
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++)
      e[3 * k + c] = mesh->xyz[3 * t[k + 1] + c] - mesh->xyz[3 * t[0] + c];
  if (cdem_det3(e) < 0.0) {
    int32_t spare = t[2];
    t[2] = t[3];
    t[3] = spare;
  }
}

/* The mid nodes of a tetrahedron in gmsh's order, made where there are none. */
static cdem_status add_middles(cdem_mesh *mesh, edge_table *table, int32_t node[10],
                               cdem_fault *fault) {
  const cdem_shape_info *shape = cdem_shape_get(CDEM_SHAPE_TET10);
  for (int e = 0; e < shape->edges; e++) {
    int32_t a = node[shape->edge[e][0]], b = node[shape->edge[e][1]];
    int64_t slot = edges_find(table, a, b);
    if (table->node[slot] < 0) {
      const double *xa = mesh->xyz + 3 * a, *xb = mesh->xyz + 3 * b;
      double x[3], ra = cdem_norm3(xa), rb = cdem_norm3(xb);
      for (int c = 0; c < 3; c++)
        x[c] = 0.5 * (xa[c] + xb[c]);
      if (fabs(ra - rb) < 1e-9 * (ra + rb))
        to_length(x, 0.5 * (ra + rb));
      table->node[slot] = mesh->nodes;
      CDEM_TRY(cdem_mesh_add_nodes(mesh, 1, x, NULL, fault));
    }
    node[shape->edge[e][2]] = table->node[slot];
  }
  return CDEM_OK;
}

static cdem_status add_tet(cdem_mesh *mesh, edge_table *table, const int32_t corner[4],
                           cdem_fault *fault) {
  int32_t node[10] = {corner[0], corner[1], corner[2], corner[3]};
  make_positive(mesh, node);
  if (table == NULL)
    return cdem_mesh_add_cells(mesh, CDEM_SHAPE_TET4, 1, node, NULL, fault);
  CDEM_TRY(add_middles(mesh, table, node, fault));
  return cdem_mesh_add_cells(mesh, CDEM_SHAPE_TET10, 1, node, NULL, fault);
}

/* The column below one face. Prisms are cut by the order of their corners, so that neighbours cut
 * the side they share alike. */
static cdem_status add_column(const sphere *s, int shells, const int32_t face[3], cdem_mesh *mesh,
                              edge_table *table, cdem_fault *fault) {
  int32_t v[3] = {face[0], face[1], face[2]};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++)
      if (v[k] > v[k + 1]) {
        int32_t spare = v[k];
        v[k] = v[k + 1];
        v[k + 1] = spare;
      }
  for (int k = 0; k + 1 < shells; k++) {
    int32_t out = k * s->corners, in = (k + 1) * s->corners;
    const int32_t tet[3][4] = {{in + v[0], in + v[1], in + v[2], out + v[2]},
                               {in + v[0], in + v[1], out + v[1], out + v[2]},
                               {in + v[0], out + v[0], out + v[1], out + v[2]}};
    for (int t = 0; t < 3; t++)
      CDEM_TRY(add_tet(mesh, table, tet[t], fault));
  }
  int32_t in = (shells - 1) * s->corners;
  const int32_t core[4] = {in + v[0], in + v[1], in + v[2], shells * s->corners};
  return add_tet(mesh, table, core, fault);
}

static cdem_status fill(const sphere *s, int shells, bool second, cdem_mesh *mesh,
                        cdem_fault *fault) {
  edge_table table = {0};
  cdem_status status = add_corners(s, shells, mesh, fault);
  if (status == CDEM_OK && second)
    status = edges_init(12 * (int64_t)s->faces * shells, &table, fault);
  for (int32_t f = 0; f < s->faces && status == CDEM_OK; f++)
    status = add_column(s, shells, s->face[f], mesh, second ? &table : NULL, fault);
  edges_release(&table);
  return status;
}

cdem_status cdem_icosphere_mesh(int refinement, bool second, cdem_mesh *mesh, cdem_fault *fault) {
  sphere s = {0};
  int shells = refinement < 2 ? 1 : 1 << (refinement - 1);
  memset(mesh, 0, sizeof *mesh);
  cdem_status status = sphere_init(refinement, &s, fault);
  if (status == CDEM_OK)
    status = fill(&s, shells, second, mesh, fault);
  sphere_release(&s);
  if (status != CDEM_OK)
    cdem_mesh_release(mesh);
  return status;
}
