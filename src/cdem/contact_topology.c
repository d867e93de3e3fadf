/* Topology of the active surface: what is bonded, which facets are neighbours, where it has sharp
 * convex edges. Angles are those of the reference configuration. O(facets + pairs). */
#include "base/sets.h"
#include "cdem/contact_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* 135 degrees inside and less is sharp: cubes and hexagonal prisms are, octagonal ones are not. */
static const double sharp_angle = 0.75 * 3.14159265358979323846 + 1e-6;

int64_t cdem_contact_bucket_count(int64_t count) {
  int64_t buckets = 16;
  while (buckets < 2 * count)
    buckets *= 2;
  return buckets;
}

void cdem_contact_buckets(int64_t count, const uint64_t *hash, int64_t buckets, int64_t *start,
                          int64_t *order) {
  memset(start, 0, (size_t)(buckets + 1) * sizeof *start);
  for (int64_t i = 0; i < count; i++)
    start[(int64_t)(hash[i] & (uint64_t)(buckets - 1)) + 1]++;
  for (int64_t b = 0; b < buckets; b++)
    start[b + 1] += start[b];
  for (int64_t i = 0; i < count; i++)
    order[start[hash[i] & (uint64_t)(buckets - 1)]++] = i;
  for (int64_t b = buckets; b > 0; b--)
    start[b] = start[b - 1];
  start[0] = 0;
}

/* Nodes and blocks held together by pairs that are not in contact's hands. */
static cdem_status find_bonds(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  const cdem_blocks *blocks = contact->blocks;
  int32_t *block;
  CDEM_NEW(block, blocks->blocks, fault);
  cdem_sets_init(block, 0, blocks->blocks);
  cdem_sets_init(s->cluster, 0, blocks->mesh.nodes);
  for (int32_t p = 0; p < blocks->pairs; p++) {
    const cdem_face_pair *pair = &blocks->pair[p];
    const int32_t *facet = blocks->pair_facet + 2 * (int64_t)p;
    if (s->active[facet[0]] && s->active[facet[1]])
      continue;
    for (int k = 0; k < pair->corners; k++)
      cdem_sets_join(s->cluster, pair->node[0][k], pair->node[1][k]);
    cdem_sets_join(block, blocks->block[pair->cell[0]], blocks->block[pair->cell[1]]);
  }
  cdem_sets_label(s->cluster, 0, blocks->mesh.nodes);
  for (int32_t f = 0; f < blocks->facets; f++)
    s->component[f] = cdem_sets_root(block, blocks->block[blocks->facet[f].cell]);
  free(block);
  return CDEM_OK;
}

static void list_surface(cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  const cdem_blocks *blocks = contact->blocks;
  s->facets = s->points = s->surface_nodes = 0;
  memset(s->reach, 0, (size_t)blocks->mesh.nodes * sizeof *s->reach);
  for (int32_t f = 0; f < blocks->facets; f++) {
    s->point_start[f] = -1;
    if (!s->active[f])
      continue;
    s->point_start[f] = s->points;
    s->facet[s->facets++] = f;
    for (int k = 0; k < blocks->facet[f].corners; k++) {
      int32_t n = blocks->facet[f].node[k];
      s->point[s->points++] = (cdem_contact_point){f, n, -1, (uint8_t)k};
      s->reach[n] = fmax(s->reach[n], s->patch[f]);
    }
  }
  /* `surface` of the points by way of a table that the frequency owns. */
  for (int32_t n = 0; n < blocks->mesh.nodes; n++)
    if (s->reach[n] > 0.0) {
      s->row[n] = s->surface_nodes;
      s->surface_node[s->surface_nodes++] = n;
    }
  for (int32_t p = 0; p < s->points; p++)
    s->point[p].surface = (int32_t)s->row[s->point[p].node];
}

/* A side of a facet: in 3-D the edge from corner k to the next; in 2-D the end k. */
typedef struct {
  int32_t facet, from, to; /* clusters; 2-D: the same twice */
  uint8_t side;
} side_entry;

static void side_vectors(const cdem_contact *contact, const side_entry *e, double normal[3],
                         double inward[3]) {
  const cdem_facet *f = &contact->blocks->facet[e->facet];
  const double *xyz = contact->blocks->mesh.xyz;
  double share[4], along[3];
  int to = f->corners == 2 ? 1 - e->side : (e->side + 1) % f->corners;
  cdem_facet_area(f, xyz, 1.0, normal, share);
  double length = 0.0, size = cdem_norm3(normal);
  for (int i = 0; i < 3; i++) {
    along[i] = xyz[3 * (int64_t)f->node[to] + i] - xyz[3 * (int64_t)f->node[e->side] + i];
    length += along[i] * along[i];
    normal[i] /= size;
  }
  for (int i = 0; i < 3; i++)
    along[i] /= sqrt(length);
  if (f->corners == 2)
    memcpy(inward, along, sizeof along);
  else
    cdem_cross3(normal, along, inward);
}

/* Angle of the material between two facets at a common side, 0 .. 2 pi. */
static double inner_angle(const cdem_contact *contact, const side_entry *a, const side_entry *b) {
  double na[3], ua[3], nb[3], ub[3];
  side_vectors(contact, a, na, ua);
  side_vectors(contact, b, nb, ub);
  double angle = atan2(-cdem_dot3(na, ub), cdem_dot3(ua, ub));
  return angle < 1e-6 ? angle + 2.0 * 3.14159265358979323846 : angle;
}

static bool meet(const side_entry *a, const side_entry *b, int dim) {
  if (a->facet == b->facet)
    return false;
  return dim == 2 ? a->from == b->from && a->side != b->side : a->from == b->to && a->to == b->from;
}

static cdem_status add_edge(cdem_contact *contact, const side_entry *a, const side_entry *b,
                            int64_t *capacity, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  const cdem_facet *f = &contact->blocks->facet[a->facet];
  CDEM_TRY(cdem_grow(&s->edge, capacity, (int64_t)s->edges + 1, sizeof *s->edge, fault));
  int to = (a->side + 1) % f->corners;
  /* The facets' width across the edge, where that is less than their size. */
  const double *p = contact->blocks->mesh.xyz + 3 * (int64_t)f->node[a->side];
  const double *q = contact->blocks->mesh.xyz + 3 * (int64_t)f->node[to];
  double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  double size = fmin(s->size[a->facet], s->size[b->facet]);
  s->edge[s->edges++] = (cdem_contact_edge){.facet = {a->facet, b->facet},
                                            .side = {a->side, b->side},
                                            .node = {f->node[a->side], f->node[to]},
                                            .size = fmin(size, size * size / cdem_norm3(along)),
                                            .depth = fmin(s->depth[a->facet], s->depth[b->facet])};
  return CDEM_OK;
}

/* The neighbour across a side is the facet reached first through the material. */
static cdem_status find_borders(cdem_contact *contact, const side_entry *entry, int64_t entries,
                                const uint64_t *hash, const int64_t *start, const int64_t *order,
                                int64_t buckets, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t capacity = 0;
  free(s->edge);
  s->edge = NULL;
  s->edges = 0;
  memset(s->border, 0, (size_t)contact->blocks->facets);
  for (int64_t i = 0; i < entries; i++) {
    int64_t bucket = (int64_t)(hash[i] & (uint64_t)(buckets - 1));
    const side_entry *best = NULL;
    double angle = 7.0;
    for (int64_t j = start[bucket]; j < start[bucket + 1]; j++) {
      const side_entry *other = &entry[order[j]];
      if (!meet(&entry[i], other, s->dim))
        continue;
      double a = inner_angle(contact, &entry[i], other);
      if (a < angle) {
        angle = a;
        best = other;
      }
    }
    if (best == NULL || angle >= sharp_angle)
      continue;
    s->border[entry[i].facet] |= (uint8_t)(1u << entry[i].side);
    if (s->dim == 3 && entry[i].facet < best->facet)
      CDEM_TRY(add_edge(contact, &entry[i], best, &capacity, fault));
  }
  return CDEM_OK;
}

typedef struct {
  side_entry *entry;
  uint64_t *hash;
  int64_t *start, *order;
} side_tables;

static cdem_status fill_borders(cdem_contact *contact, side_tables *t, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t count = s->points, buckets = cdem_contact_bucket_count(count);
  CDEM_NEW(t->entry, count, fault);
  CDEM_NEW(t->hash, count, fault);
  CDEM_NEW(t->order, count, fault);
  CDEM_NEW(t->start, buckets + 1, fault);
  for (int64_t p = 0; p < count; p++) {
    const cdem_facet *f = &contact->blocks->facet[s->point[p].facet];
    int k = s->point[p].corner;
    int32_t from = s->cluster[f->node[k]];
    int32_t to = f->corners == 2 ? from : s->cluster[f->node[(k + 1) % f->corners]];
    uint32_t low = (uint32_t)(from < to ? from : to), high = (uint32_t)(from < to ? to : from);
    t->entry[p] = (side_entry){s->point[p].facet, from, to, (uint8_t)k};
    uint64_t key = ((uint64_t)high << 32 | low) * 0x9e3779b97f4a7c15u;
    t->hash[p] = key ^ key >> 29;
  }
  cdem_contact_buckets(count, t->hash, buckets, t->start, t->order);
  return find_borders(contact, t->entry, count, t->hash, t->start, t->order, buckets, fault);
}

cdem_status cdem_contact_topology(cdem_contact *contact, cdem_fault *fault) {
  CDEM_TRY(find_bonds(contact, fault));
  list_surface(contact);
  side_tables t = {0};
  cdem_status status = fill_borders(contact, &t, fault);
  free(t.entry);
  free(t.hash);
  free(t.order);
  free(t.start);
  if (status == CDEM_OK)
    contact->store->topology_stale = false;
  return status;
}
