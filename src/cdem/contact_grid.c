/* Broad phase for points: surface nodes in a hashed uniform grid, facets look for theirs.
 *
 * The side of a grid cell is the mean facet size (and at least the skin), so that a cell holds a
 * few nodes; a large facet looks through many cells, but only along its plane, and through all
 * nodes where these are fewer. The lists are then turned around: facets for each node, ascending.
 */
#include "cdem/contact_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  double low[3], side;
  int64_t buckets;
  uint64_t *hash;
  int64_t (*cell)[3]; /* [surface_nodes] */
  int64_t *start, *order;
  int64_t *found_start; /* [facets + 1] */
  int32_t *found;       /* surface nodes near each facet */
  int64_t *fill;
  int64_t *visit; /* [facets] */
} grid;

static int64_t cell_of(double x, double low, double side) {
  double c = floor((x - low) / side);
  return (int64_t)fmax(-4e18, fmin(4e18, c));
}

static cdem_status fill_grid(const cdem_contact *contact, grid *g, cdem_fault *fault) {
  const cdem_contact_store *s = contact->store;
  double mean = 0.0;
  for (int32_t f = 0; f < s->facets; f++)
    mean += s->size[s->facet[f]];
  g->side = fmax(mean / fmax(1.0, s->facets), s->skin);
  for (int i = 0; i < 3; i++)
    g->low[i] = s->surface_nodes > 0 ? s->x[3 * (int64_t)s->surface_node[0] + i] : 0.0;
  g->buckets = cdem_contact_bucket_count(s->surface_nodes);
  CDEM_NEW(g->hash, s->surface_nodes, fault);
  CDEM_NEW(g->cell, s->surface_nodes, fault);
  CDEM_NEW(g->order, s->surface_nodes, fault);
  CDEM_NEW(g->start, g->buckets + 1, fault);
  CDEM_NEW(g->found_start, (int64_t)s->facets + 1, fault);
  CDEM_NEW(g->visit, s->facets, fault);
  for (int32_t n = 0; n < s->surface_nodes; n++) {
    const double *x = s->x + 3 * (int64_t)s->surface_node[n];
    for (int i = 0; i < 3; i++)
      g->cell[n][i] = cell_of(x[i], g->low[i], g->side);
    g->hash[n] = cdem_contact_hash(g->cell[n]);
  }
  cdem_contact_buckets(s->surface_nodes, g->hash, g->buckets, g->start, g->order);
  return CDEM_OK;
}

/* Nodes of the facet's cell, and those bonded to them, do not touch it - but for the points of the
 * face it was bonded to itself. */
static bool may_touch(const cdem_contact *contact, int32_t node, int32_t facet) {
  const cdem_contact_store *s = contact->store;
  const cdem_blocks *blocks = contact->blocks;
  const cdem_facet *f = &blocks->facet[facet];
  bool bonded = false;
  for (int64_t i = blocks->mesh.cell_start[f->cell]; i < blocks->mesh.cell_start[f->cell + 1];
       i++) {
    if (blocks->mesh.cell_node[i] == node)
      return false;
    bonded |= s->cluster[blocks->mesh.cell_node[i]] == s->cluster[node];
  }
  if (!bonded || f->pair < 0)
    return !bonded;
  const int32_t *both = blocks->pair_facet + 2 * (int64_t)f->pair;
  const cdem_facet *partner = &blocks->facet[both[0] == facet ? both[1] : both[0]];
  if (!s->active[both[0]] || !s->active[both[1]])
    return false;
  for (int k = 0; k < partner->corners; k++)
    if (partner->node[k] == node)
      return true;
  return false;
}

/* Whether a point so near now could touch the facet before the next rebuild. */
static bool is_near(const cdem_contact *contact, int32_t node, int32_t facet,
                    const double corner[4][3], double skin) {
  const cdem_contact_store *s = contact->store;
  const cdem_contact_face *face = &s->face[facet];
  const double *x = s->x + 3 * (int64_t)node;
  double r[3] = {x[0] - face->centre[0], x[1] - face->centre[1], x[2] - face->centre[2]};
  double off = cdem_dot3(r, face->normal), radius;
  if (off > skin + face->warp || off < -(s->depth[facet] + skin + face->warp))
    return false;
  double over = s->depth[facet];
  if (s->border[facet] != 0)
    over = fmax(over, fmin(s->size[facet], s->reach[node]));
  radius = face->radius + over + 2.0 * skin + face->warp + s->depth[facet];
  if (cdem_dot3(r, r) > radius * radius)
    return false;
  /* Not beyond a side by more than that, in the facet's plane. */
  int corners = contact->blocks->facet[facet].corners;
  for (int k = 0; k < corners; k++) {
    int to = corners == 2 ? 1 - k : (k + 1) % corners;
    double side[3], out[3], length = 0.0, beyond = 0.0;
    for (int i = 0; i < 3; i++)
      side[i] = corner[to][i] - corner[k][i];
    cdem_cross3(side, face->normal, out);
    for (int i = 0; i < 3; i++) {
      out[i] = corners == 2 ? -side[i] : out[i];
      beyond += (x[i] - corner[k][i]) * out[i];
      length += out[i] * out[i];
    }
    double most = over + skin + face->warp;
    if (beyond > 0.0 && beyond * beyond > most * most * length)
      return false;
  }
  return true;
}

static void take(const cdem_contact *contact, int32_t f, int32_t n, const double corner[4][3],
                 double skin, grid *g, int64_t *count) {
  const cdem_contact_store *s = contact->store;
  int32_t facet = s->facet[f], node = s->surface_node[n];
  if (!is_near(contact, node, facet, corner, skin) || !may_touch(contact, node, facet))
    return;
  if (g->found != NULL)
    g->found[g->found_start[f] + *count] = n;
  ++*count;
}

static void look_in_cell(const cdem_contact *contact, int32_t f, const int64_t c[3],
                         const double corner[4][3], double skin, grid *g, int64_t *count) {
  int64_t bucket = (int64_t)(cdem_contact_hash(c) & (uint64_t)(g->buckets - 1));
  g->visit[f] += 1 + g->start[bucket + 1] - g->start[bucket];
  for (int64_t k = g->start[bucket]; k < g->start[bucket + 1]; k++) {
    int64_t n = g->order[k];
    if (g->cell[n][0] == c[0] && g->cell[n][1] == c[1] && g->cell[n][2] == c[2])
      take(contact, f, (int32_t)n, corner, skin, g, count);
  }
}

/* Nodes near facet f: counted, and written where `found` is there. */
static int64_t nodes_near(const cdem_contact *contact, int32_t f, grid *g) {
  const cdem_contact_store *s = contact->store;
  int32_t facet = s->facet[f];
  int corners = contact->blocks->facet[facet].corners;
  double corner[4][3], skin = s->skin + s->sweep, cells = 1.0, thick;
  const cdem_contact_face *face = &s->face[facet];
  int64_t low[3], high[3], count = 0, c[3];
  cdem_contact_corners(contact, facet, corner);
  double out = skin + fmax(s->depth[facet], s->border[facet] != 0 ? s->size[facet] : 0.0);
  for (int i = 0; i < 3; i++) {
    double a = INFINITY, b = -INFINITY;
    for (int k = 0; k < corners; k++) {
      a = fmin(a, corner[k][i]);
      b = fmax(b, corner[k][i]);
    }
    low[i] = cell_of(a - out, g->low[i], g->side);
    high[i] = cell_of(b + out, g->low[i], g->side);
    cells *= (double)(high[i] - low[i] + 1);
  }
  if (cells > 4.0 * s->surface_nodes + 64.0) {
    g->visit[f] += s->surface_nodes;
    for (int32_t n = 0; n < s->surface_nodes; n++)
      take(contact, f, n, (const double(*)[3])corner, skin, g, &count);
    return count;
  }
  thick = s->depth[facet] + skin + face->warp + 0.5 * sqrt(3.0) * g->side;
  for (c[0] = low[0]; c[0] <= high[0]; c[0]++)
    for (c[1] = low[1]; c[1] <= high[1]; c[1]++)
      for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
        double off = 0.0;
        for (int i = 0; i < 3; i++)
          off += face->normal[i] * (g->low[i] + ((double)c[i] + 0.5) * g->side - face->centre[i]);
        if (fabs(off) <= thick)
          look_in_cell(contact, f, c, (const double(*)[3])corner, skin, g, &count);
      }
  return count;
}

static cdem_status turn_around(cdem_contact *contact, grid *g, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t total = g->found_start[s->facets];
  free(s->candidate);
  free(s->candidate_start);
  s->candidate = NULL;
  s->candidate_start = NULL;
  CDEM_NEW(s->candidate_start, (int64_t)s->surface_nodes + 1, fault);
  CDEM_NEW(s->candidate, total, fault);
  CDEM_NEW(g->fill, s->surface_nodes, fault);
  for (int64_t i = 0; i < total; i++)
    s->candidate_start[g->found[i] + 1]++;
  for (int32_t n = 0; n < s->surface_nodes; n++)
    s->candidate_start[n + 1] += s->candidate_start[n];
  for (int32_t f = 0; f < s->facets; f++)
    for (int64_t i = g->found_start[f]; i < g->found_start[f + 1]; i++) {
      int32_t n = g->found[i];
      s->candidate[s->candidate_start[n] + g->fill[n]++] = s->facet[f];
    }
  for (int32_t f = 0; f < s->facets; f++)
    s->visits += g->visit[f];
  return CDEM_OK;
}

static cdem_status find_all(cdem_contact *contact, grid *g, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  CDEM_TRY(fill_grid(contact, g, fault));
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->threads)
  for (int32_t f = 0; f < s->facets; f++)
    g->found_start[f + 1] = nodes_near(contact, f, g);
  for (int32_t f = 0; f < s->facets; f++)
    g->found_start[f + 1] += g->found_start[f];
  CDEM_NEW(g->found, g->found_start[s->facets], fault);
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->threads)
  for (int32_t f = 0; f < s->facets; f++)
    nodes_near(contact, f, g);
  return turn_around(contact, g, fault);
}

/* Candidates of every surface node, from the present positions and faces. */
cdem_status cdem_contact_candidates(cdem_contact *contact, cdem_fault *fault) {
  grid g = {0};
  contact->store->visits = 0;
  cdem_status status = find_all(contact, &g, fault);
  free(g.hash);
  free(g.cell);
  free(g.order);
  free(g.start);
  free(g.found_start);
  free(g.found);
  free(g.fill);
  free(g.visit);
  return status;
}
