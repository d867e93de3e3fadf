/* Sharp convex edges of the surface against each other: what points on faces do not see, such as
 * two bars that cross.
 *
 * Two segments touch where their lines come closest, when that is inside both, the common normal
 * n = a x b lies between the normals of the two facets of each edge (so that it points out of one
 * body and into the other), and the overlap along it is positive. The contact stands for the area
 * h_1 h_2/4, a quarter of a facet each way, less the area of the points of the four facets that are
 * already in contact with the other surface nearby: where points on faces carry, edges add nothing,
 * and the change from one to the other is continuous.
 */
#include "cdem/contact_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  double low[3], high[3];
} box;

typedef struct {
  double side;
  box *box;
  int64_t entries, larges;
  int32_t *edge; /* [entries] */
  int64_t (*cell)[3];
  uint64_t *hash;
  int64_t *start, *order;
  int32_t *large;
  uint8_t *is_large;
  int64_t capacity;
} edge_grid;

enum { LARGE = 1000 }; /* grid cells of one edge */

static void edge_box(const cdem_contact *contact, const cdem_contact_edge *e, box *b) {
  const cdem_contact_store *s = contact->store;
  double out = 0.5 * (s->skin + s->sweep) + 0.5 * e->depth;
  for (int i = 0; i < 3; i++) {
    double p = s->x[3 * (int64_t)e->node[0] + i], q = s->x[3 * (int64_t)e->node[1] + i];
    b->low[i] = fmin(p, q) - out;
    b->high[i] = fmax(p, q) + out;
  }
}

static int64_t cell_of(const edge_grid *g, double x) {
  return (int64_t)fmax(-4e18, fmin(4e18, floor(x / g->side)));
}

static bool overlap(const box *a, const box *b) {
  for (int i = 0; i < 3; i++)
    if (a->low[i] > b->high[i] || b->low[i] > a->high[i])
      return false;
  return true;
}

static bool shares_bond(const cdem_contact *contact, const int32_t node[2], int32_t facet) {
  const cdem_contact_store *s = contact->store;
  const cdem_mesh *mesh = &contact->blocks->mesh;
  int32_t cell = contact->blocks->facet[facet].cell;
  for (int64_t i = mesh->cell_start[cell]; i < mesh->cell_start[cell + 1]; i++)
    for (int k = 0; k < 2; k++)
      if (s->cluster[mesh->cell_node[i]] == s->cluster[node[k]])
        return true;
  return false;
}

static cdem_status add_pair(cdem_contact *contact, edge_grid *g, int32_t a, int32_t b,
                            cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  const cdem_contact_edge *p = &s->edge[a], *q = &s->edge[b];
  if (!overlap(&g->box[a], &g->box[b]))
    return CDEM_OK;
  for (int k = 0; k < 2; k++)
    if (shares_bond(contact, p->node, q->facet[k]) || shares_bond(contact, q->node, p->facet[k]))
      return CDEM_OK;
  CDEM_TRY(cdem_grow(&s->edge_pair, &g->capacity, s->edge_pairs + 1, sizeof *s->edge_pair, fault));
  s->edge_pair[s->edge_pairs++] = (cdem_edge_pair){{a < b ? a : b, a < b ? b : a}};
  return CDEM_OK;
}

/* Entries of the edges in the grid cells of their boxes; counted first, then written. */
static void enter(const cdem_contact_store *s, edge_grid *g, bool write) {
  g->entries = g->larges = 0;
  for (int32_t e = 0; e < s->edges; e++) {
    int64_t low[3], high[3], c[3];
    double cells = 1.0;
    for (int i = 0; i < 3; i++) {
      low[i] = cell_of(g, g->box[e].low[i]);
      high[i] = cell_of(g, g->box[e].high[i]);
      cells *= (double)(high[i] - low[i] + 1);
    }
    if (cells > LARGE) {
      g->large[g->larges++] = e;
      g->is_large[e] = 1;
      continue;
    }
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++)
      for (c[1] = low[1]; c[1] <= high[1]; c[1]++)
        for (c[2] = low[2]; c[2] <= high[2]; c[2]++, g->entries++)
          if (write) {
            g->edge[g->entries] = e;
            memcpy(g->cell[g->entries], c, sizeof c);
            g->hash[g->entries] = cdem_contact_hash(c);
          }
  }
}

/* Both edges are in several common cells: the one at the low corner of the common box counts. */
static bool first_common(const edge_grid *g, int32_t a, int32_t b, const int64_t c[3]) {
  for (int i = 0; i < 3; i++)
    if (cell_of(g, fmax(g->box[a].low[i], g->box[b].low[i])) != c[i])
      return false;
  return true;
}

static cdem_status pair_up(cdem_contact *contact, edge_grid *g, int64_t buckets,
                           cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  for (int64_t bucket = 0; bucket < buckets; bucket++)
    for (int64_t i = g->start[bucket]; i < g->start[bucket + 1]; i++)
      for (int64_t j = i + 1; j < g->start[bucket + 1]; j++) {
        int64_t p = g->order[i], q = g->order[j];
        s->visits++;
        if (memcmp(g->cell[p], g->cell[q], sizeof g->cell[p]) == 0 &&
            first_common(g, g->edge[p], g->edge[q], g->cell[p]))
          CDEM_TRY(add_pair(contact, g, g->edge[p], g->edge[q], fault));
      }
  for (int64_t k = 0; k < g->larges; k++)
    for (int32_t e = 0; e < s->edges; e++, s->visits++)
      if (!g->is_large[e] || e > g->large[k])
        CDEM_TRY(add_pair(contact, g, g->large[k], e, fault));
  return CDEM_OK;
}

static cdem_status fill(cdem_contact *contact, edge_grid *g, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  CDEM_NEW(g->box, s->edges, fault);
  CDEM_NEW(g->large, s->edges, fault);
  CDEM_NEW(g->is_large, s->edges, fault);
  for (int32_t e = 0; e < s->edges; e++) {
    double longest = 0.0;
    edge_box(contact, &s->edge[e], &g->box[e]);
    for (int i = 0; i < 3; i++)
      longest = fmax(longest, g->box[e].high[i] - g->box[e].low[i]);
    g->side += longest / s->edges;
  }
  enter(s, g, false);
  int64_t buckets = cdem_contact_bucket_count(g->entries);
  CDEM_NEW(g->edge, g->entries, fault);
  CDEM_NEW(g->cell, g->entries, fault);
  CDEM_NEW(g->hash, g->entries, fault);
  CDEM_NEW(g->order, g->entries, fault);
  CDEM_NEW(g->start, buckets + 1, fault);
  enter(s, g, true);
  cdem_contact_buckets(g->entries, g->hash, buckets, g->start, g->order);
  return pair_up(contact, g, buckets, fault);
}

cdem_status cdem_contact_edge_candidates(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  edge_grid g = {0};
  free(s->edge_pair);
  free(s->edge_touch);
  free(s->edge_busy);
  s->edge_pair = NULL;
  s->edge_touch = NULL;
  s->edge_busy = NULL;
  s->edge_pairs = 0;
  cdem_status status = s->edges > 0 ? fill(contact, &g, fault) : CDEM_OK;
  free(g.box);
  free(g.edge);
  free(g.cell);
  free(g.hash);
  free(g.start);
  free(g.order);
  free(g.large);
  free(g.is_large);
  int64_t pairs = s->edge_pairs;
  if (status != CDEM_OK)
    s->edge_pairs = 0;
  CDEM_TRY(status);
  s->edge_pairs = 0;
  CDEM_NEW(s->edge_touch, pairs, fault);
  CDEM_NEW(s->edge_busy, pairs, fault);
  s->edge_pairs = pairs;
  for (int64_t i = 0; i < pairs; i++)
    s->edge_touch[i] = -1;
  return CDEM_OK;
}

/* Whether `n` points out of the body between the two facets of an edge. */
static bool within_cone(const cdem_contact *contact, const cdem_contact_edge *e,
                        const double n[3]) {
  const cdem_contact_store *s = contact->store;
  for (int k = 0; k < 2; k++) {
    const cdem_facet *f = &contact->blocks->facet[e->facet[k]];
    int from = e->side[k], to = (e->side[k] + 1) % f->corners;
    double along[3], inward[3];
    for (int i = 0; i < 3; i++)
      along[i] = s->x[3 * (int64_t)f->node[to] + i] - s->x[3 * (int64_t)f->node[from] + i];
    cdem_cross3(s->face[e->facet[k]].normal, along, inward);
    if (cdem_dot3(inward, n) > 0.2 * cdem_norm3(along))
      return false;
  }
  return true;
}

/* Area of the points of the facets of edge e in contact with `component` near `at`. */
static double carried_by_points(const cdem_contact *contact, const cdem_contact_edge *e,
                                int32_t component, const double at[3]) {
  const cdem_contact_store *s = contact->store;
  double sum = 0.0;
  for (int k = 0; k < 2; k++) {
    int32_t first = s->point_start[e->facet[k]];
    for (int32_t p = first; p < first + contact->blocks->facet[e->facet[k]].corners; p++) {
      for (int64_t i = s->slot_start[p]; i < s->slot_start[p + 1]; i++) {
        const cdem_touch *touch = cdem_touch_of(s, s->slot_touch[i]);
        if (touch == NULL || s->slot_component[i] != component)
          continue;
        double r[3] = {touch->position[0] - at[0], touch->position[1] - at[1],
                       touch->position[2] - at[2]};
        if (cdem_norm3(r) <= 2.0 * e->size)
          sum += touch->weight;
      }
    }
  }
  return sum;
}

/* Two edges as they lie now. */
typedef struct {
  const cdem_contact_edge *one, *two;
  double a[3], b[3], p[3], q[3]; /* directions (not unit), nearest points */
  double t[2], normal[3], gap;
} crossing;

/* False: apart, or not a crossing of sharp edges. */
static bool find_crossing(const cdem_contact *contact, const cdem_edge_pair *pair, crossing *c) {
  const cdem_contact_store *s = contact->store;
  c->one = &s->edge[pair->edge[0]];
  c->two = &s->edge[pair->edge[1]];
  const double *x[4] = {s->x + 3 * (int64_t)c->one->node[0], s->x + 3 * (int64_t)c->one->node[1],
                        s->x + 3 * (int64_t)c->two->node[0], s->x + 3 * (int64_t)c->two->node[1]};
  double r[3], outward = 0.0;
  for (int i = 0; i < 3; i++) {
    c->a[i] = x[1][i] - x[0][i];
    c->b[i] = x[3][i] - x[2][i];
    r[i] = x[2][i] - x[0][i];
  }
  double aa = cdem_dot3(c->a, c->a), bb = cdem_dot3(c->b, c->b), ab = cdem_dot3(c->a, c->b);
  double ra = cdem_dot3(r, c->a), rb = cdem_dot3(r, c->b), det = aa * bb - ab * ab;
  if (det < 0.03 * aa * bb) /* nearer to parallel than 10 degrees: points and faces do it */
    return false;
  c->t[0] = (ra * bb - rb * ab) / det;
  c->t[1] = (ra * ab - rb * aa) / det;
  if (c->t[0] < 0.0 || c->t[0] > 1.0 || c->t[1] < 0.0 || c->t[1] > 1.0)
    return false;
  cdem_cross3(c->a, c->b, c->normal);
  for (int i = 0; i < 3; i++)
    outward +=
        c->normal[i] * (s->face[c->one->facet[0]].normal[i] + s->face[c->one->facet[1]].normal[i]);
  double scale = (outward < 0.0 ? -1.0 : 1.0) / sqrt(det);
  c->gap = 0.0;
  for (int i = 0; i < 3; i++) {
    c->normal[i] *= scale;
    c->p[i] = x[0][i] + c->t[0] * c->a[i];
    c->q[i] = x[2][i] + c->t[1] * c->b[i];
    c->gap += (c->p[i] - c->q[i]) * c->normal[i];
  }
  if (c->gap <= 0.0)
    return false;
  double back[3] = {-c->normal[0], -c->normal[1], -c->normal[2]};
  return within_cone(contact, c->one, c->normal) && within_cone(contact, c->two, back);
}

/* Coefficients and gradients of (1) in contact_law.c for two lines: the turn of the normal is
 * dn = -(n . da) a* - (n . db) b*, with a*, b* dual to a, b in the plane. */
static void fill_input(const cdem_contact *contact, const crossing *c, const cdem_touch *t,
                       cdem_contact_input *in) {
  const cdem_contact_store *s = contact->store;
  double a_dual[3], b_dual[3];
  cdem_cross3(c->b, c->normal, a_dual);
  cdem_cross3(c->normal, c->a, b_dual);
  double a_scale = cdem_dot3(c->a, a_dual), b_scale = cdem_dot3(c->b, b_dual);
  in->coefficient[0] = c->t[0] - 1.0;
  in->coefficient[1] = -c->t[0];
  in->coefficient[2] = 1.0 - c->t[1];
  in->coefficient[3] = c->t[1];
  for (int i = 0; i < 3; i++) {
    in->normal[i] = c->normal[i];
    in->gradient[1][i] = a_dual[i] / a_scale;
    in->gradient[0][i] = -in->gradient[1][i];
    in->gradient[3][i] = b_dual[i] / b_scale;
    in->gradient[2][i] = -in->gradient[3][i];
    if (t->facet >= 0)
      in->slip[i] = c->a[i] * (c->t[0] - t->shape[0]) - c->b[i] * (c->t[1] - t->shape[1]);
  }
  in->nodes = 4;
  for (int k = 0; k < 2; k++) {
    in->node[k] = c->one->node[k];
    in->node[k + 2] = c->two->node[k];
  }
  for (int k = 0; k < 4 && s->v != NULL; k++)
    for (int i = 0; i < 3; i++)
      in->rate -= in->coefficient[k] * in->normal[i] * s->v[(int64_t)in->node[k] * s->dofs + i];
  double m[2] = {0.0};
  for (int k = 0; k < 4; k++)
    m[k / 2] += fabs(in->coefficient[k]) * s->mass[(int64_t)in->node[k] * s->dofs] /
                s->node_area[in->node[k]];
  in->surface_mass = m[0] * m[1] > 0.0 ? m[0] * m[1] / (m[0] + m[1]) : 0.0;
}

static double edge_weight(const cdem_contact *contact, const crossing *c) {
  const cdem_contact_store *s = contact->store;
  double area = 0.25 * c->one->size * c->two->size;
  double points = carried_by_points(contact, c->one, s->component[c->two->facet[0]], c->p) +
                  carried_by_points(contact, c->two, s->component[c->one->facet[0]], c->q);
  return fmax(0.0, area - points);
}

static bool edge_is_fresh(const cdem_contact_store *s, const cdem_contact_edge *e) {
  return s->active[e->facet[0]] == CDEM_FRESH || s->active[e->facet[1]] == CDEM_FRESH;
}

static bool may_begin(const cdem_contact_store *s, const crossing *c, double before) {
  double shallow = 0.1 * fmin(c->one->size, c->two->size);
  return c->gap <= shallow || before <= shallow || edge_is_fresh(s, c->one) ||
         edge_is_fresh(s, c->two);
}

static void end_edge(cdem_contact *contact, int64_t i) {
  cdem_touch *t = cdem_touch_of(contact->store, contact->store->edge_touch[i]);
  if (t != NULL)
    cdem_touch_end(contact, t);
}

static void press_edge(cdem_contact *contact, int64_t i, const crossing *c,
                       const cdem_contact_input *in) {
  cdem_contact_store *s = contact->store;
  if (s->edge_touch[i] < 0)
    s->edge_touch[i] = cdem_contact_take(s);
  s->edge_busy[i] = s->edge_touch[i] < 0 ? CDEM_DEFERRED : CDEM_BUSY;
  if (s->edge_touch[i] < 0)
    return;
  cdem_touch *t = &s->pool[s->edge_touch[i]];
  cdem_touch_update(contact, in, c->one->facet[0], t);
  t->shape[0] = c->t[0];
  t->shape[1] = c->t[1];
  for (int k = 0; k < 3; k++)
    t->position[k] = c->p[k];
}

/* False: deeper than the facets allow, and no points carry. */
static bool edge_step(cdem_contact *contact, int64_t i) {
  cdem_contact_store *s = contact->store;
  const cdem_touch *t = cdem_touch_of(s, s->edge_touch[i]), none = {.facet = -1};
  crossing c;
  s->edge_busy[i] = t != NULL ? CDEM_BUSY : 0;
  if (!find_crossing(contact, &s->edge_pair[i], &c)) {
    end_edge(contact, i);
    return true;
  }
  cdem_contact_input in = {
      .law = cdem_contact_law_between(s, contact->blocks, c.two->facet[0], c.one->facet[0]),
      .gap = c.gap};
  fill_input(contact, &c, t != NULL ? t : &none, &in);
  double before = c.gap - in.rate * s->dt;
  bool deep = c.gap > fmin(c.one->depth, c.two->depth);
  if (t == NULL && !deep && !may_begin(s, &c, before))
    return true;
  in.whole = in.weight = edge_weight(contact, &c);
  if (deep && in.weight > 0.0 && (t != NULL || before <= 0.0))
    return false;
  if (deep || !(in.weight > 0.0))
    end_edge(contact, i);
  else
    press_edge(contact, i, &c, &in);
  return true;
}

/* All pairs, or those that found the pool full before: how many did now. *failed: the first that is
 * too deep. */
int64_t cdem_contact_edges_step(cdem_contact *contact, bool again, int64_t *failed) {
  cdem_contact_store *s = contact->store;
  int64_t first = *failed, full = 0;
#pragma omp parallel for schedule(dynamic, 256) num_threads(s->threads) reduction(+ : full)        \
    reduction(min : first)
  for (int64_t i = 0; i < s->edge_pairs; i++) {
    if (again && s->edge_busy[i] != CDEM_DEFERRED)
      continue;
    bool good = edge_step(contact, i);
    full += s->edge_busy[i] == CDEM_DEFERRED;
    first = !good && i < first ? i : first;
  }
  *failed = first;
  return full;
}
