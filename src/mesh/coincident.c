/* Different nodes at one place, found by hashing: nodes fall into cubes of side h, and each node
 * looks into the one to eight cubes that its ball of radius `tolerance` can reach. A cube is wide
 * against the tolerance, so that most balls touch one cube only, and never finer than the grid of
 * double precision. Nodes at exactly the same place share one entry with a count, so that a heap of
 * such nodes costs no more than any other. Cost: O(N) for a mesh whose nodes are further apart than
 * the tolerance. */
#include "mesh/mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

typedef struct {
  const double *xyz;
  double side, tolerance; /* m */
  int64_t slots;          /* a power of two */
  int32_t *head;          /* [slots] 1 + first node of the chain, 0: none */
  int32_t *next;          /* [nodes] 1 + next node */
  int32_t *heap;          /* [nodes] nodes at this very place, the node itself included */
} place_table;

static void release(place_table *table) {
  free(table->head);
  free(table->next);
  free(table->heap);
}

static int64_t slot_of(const place_table *table, const int64_t cube[3]) {
  uint64_t hash = 0;
  for (int i = 0; i < 3; i++) {
    cdem_random mix = {hash ^ (uint64_t)cube[i]};
    hash = cdem_random_next(&mix);
  }
  return (int64_t)(hash & (uint64_t)(table->slots - 1));
}

static bool is_near(const place_table *table, const double *a, const double *b, bool *same) {
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  *same = d[0] == 0 && d[1] == 0 && d[2] == 0;
  return cdem_dot3(d, d) <= table->tolerance * table->tolerance;
}

/* What a node finds among the nodes entered before it. */
typedef struct {
  int64_t pairs;
  int32_t nearest; /* smallest id found, -1: none */
  int32_t same;    /* entry of the very same place, -1: none */
} place_answer;

static void ask_cube(const place_table *table, const int64_t cube[3], const double *place,
                     place_answer *answer) {
  for (int32_t at = table->head[slot_of(table, cube)]; at != 0; at = table->next[at - 1]) {
    const double *other = table->xyz + 3 * (int64_t)(at - 1);
    bool same, in_cube = true;
    /* Chains mix cubes of one slot; a node must answer for its own cube only. */
    for (int i = 0; i < 3; i++)
      in_cube &= (int64_t)floor(other[i] / table->side) == cube[i];
    if (!in_cube || !is_near(table, place, other, &same))
      continue;
    answer->pairs += table->heap[at - 1];
    if (answer->nearest < 0 || at - 1 < answer->nearest)
      answer->nearest = at - 1;
    if (same)
      answer->same = at - 1;
  }
}

static void enter(place_table *table, int32_t node, place_answer *answer) {
  const double *place = table->xyz + 3 * (int64_t)node;
  int64_t low[3], high[3], cube[3], own[3];
  for (int i = 0; i < 3; i++) {
    own[i] = (int64_t)floor(place[i] / table->side);
    low[i] = (int64_t)floor((place[i] - table->tolerance) / table->side);
    high[i] = (int64_t)floor((place[i] + table->tolerance) / table->side);
  }
  *answer = (place_answer){.nearest = -1, .same = -1};
  for (cube[0] = low[0]; cube[0] <= high[0]; cube[0]++)
    for (cube[1] = low[1]; cube[1] <= high[1]; cube[1]++)
      for (cube[2] = low[2]; cube[2] <= high[2]; cube[2]++)
        ask_cube(table, cube, place, answer);
  if (answer->same >= 0) {
    table->heap[answer->same]++;
    return;
  }
  int64_t slot = slot_of(table, own);
  table->heap[node] = 1;
  table->next[node] = table->head[slot];
  table->head[slot] = node + 1;
}

/* Marks the nodes of the given cells and finds the largest coordinate. */
static cdem_status mark_nodes(const cdem_mesh *mesh, const int32_t *cell, int32_t cells, bool *used,
                              double *largest, cdem_fault *fault) {
  *largest = 0;
  for (int32_t i = 0; i < cells; i++) {
    int32_t id = cell != NULL ? cell[i] : i;
    CDEM_REQUIRE(id >= 0 && id < mesh->cells, fault, CDEM_USAGE,
                 "chosen cell id %" PRId32 " is outside the mesh of %" PRId32 " cells", id,
                 mesh->cells);
    for (int64_t k = mesh->cell_start[id]; k < mesh->cell_start[id + 1]; k++)
      used[mesh->cell_node[k]] = true;
  }
  for (int32_t n = 0; n < mesh->nodes; n++)
    for (int i = 0; i < 3 && used[n]; i++) {
      double x = fabs(mesh->xyz[3 * (int64_t)n + i]);
      CDEM_REQUIRE(isfinite(x), fault, CDEM_INPUT,
                   "node %" PRId64 ": coordinate %c is not a finite number", mesh->node_tag[n],
                   'x' + i);
      *largest = fmax(*largest, x);
    }
  return CDEM_OK;
}

static cdem_status fill_table(const cdem_mesh *mesh, place_table *table, cdem_fault *fault) {
  for (table->slots = 16; table->slots < mesh->nodes;)
    table->slots *= 2;
  CDEM_NEW(table->head, table->slots, fault);
  CDEM_NEW(table->next, mesh->nodes, fault);
  CDEM_NEW(table->heap, mesh->nodes, fault);
  return CDEM_OK;
}

cdem_status cdem_mesh_coincident_nodes(const cdem_mesh *mesh, const int32_t *cell, int32_t cells,
                                       double tolerance, int64_t *pairs, int32_t *first,
                                       int32_t *second, cdem_fault *fault) {
  CDEM_REQUIRE(tolerance >= 0 && isfinite(tolerance), fault, CDEM_USAGE,
               "tolerance of coincident nodes is %g m; it must be 0 or more", tolerance);
  bool *used;
  double largest;
  CDEM_NEW(used, mesh->nodes, fault);
  place_table table = {.xyz = mesh->xyz, .tolerance = tolerance};
  cdem_status status =
      mark_nodes(mesh, cell, cell != NULL ? cells : mesh->cells, used, &largest, fault);
  if (status == CDEM_OK)
    status = fill_table(mesh, &table, fault);
  if (status == CDEM_OK) {
    /* Not a round multiple: nodes of a regular grid would all lie on faces of the cubes. 2^-48
     * keeps the cube numbers whole in a double; 2^-1000 when all nodes are at 0. */
    table.side = fmax(fmax(8.7548776662466927 * tolerance, largest * 0x1p-48), 0x1p-1000);
    int64_t found = 0;
    int32_t a = -1, b = -1;
    for (int32_t n = 0; n < mesh->nodes; n++) {
      place_answer answer;
      if (!used[n])
        continue;
      enter(&table, n, &answer);
      found += answer.pairs;
      if (b < 0 && answer.nearest >= 0) {
        a = answer.nearest;
        b = n;
      }
    }
    *pairs = found;
    *first = a;
    *second = b;
  }
  release(&table);
  free(used);
  return status;
}
