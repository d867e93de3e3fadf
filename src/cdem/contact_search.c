/* A new list of candidates: slots for what may touch until the next rebuild, and the histories of
 * the present contacts moved into them. */
#include "cdem/contact_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Puts the present contacts aside, by slave point and opposing facet. */
cdem_status cdem_contact_carry(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  if (s->slot_start == NULL)
    return CDEM_OK;
  int64_t slots = s->slot_start[s->points], found = 0, edges = 0;
  for (int64_t i = 0; i < slots; i++)
    found += cdem_touch_of(s, s->slot_touch[i]) != NULL;
  for (int64_t i = 0; i < s->edge_pairs; i++)
    edges += cdem_touch_of(s, s->edge_touch[i]) != NULL;
  CDEM_TRY(cdem_grow(&s->carry, &s->carried_capacity, found, sizeof *s->carry, fault));
  CDEM_TRY(cdem_grow(&s->edge_key, &s->edge_carried_capacity, edges, sizeof *s->edge_key, fault));
  CDEM_TRY(cdem_grow(&s->edge_carry, &s->edge_touch_capacity, edges, sizeof *s->edge_carry, fault));
  s->carried = s->edge_carried = 0;
  for (int32_t p = 0; p < s->points; p++)
    for (int64_t i = s->slot_start[p]; i < s->slot_start[p + 1]; i++)
      if (cdem_touch_of(s, s->slot_touch[i]) != NULL)
        s->carry[s->carried++] = (cdem_carried){4 * (int64_t)s->point[p].facet + s->point[p].corner,
                                                s->pool[s->slot_touch[i]]};
  for (int64_t i = 0; i < s->edge_pairs; i++) {
    if (cdem_touch_of(s, s->edge_touch[i]) == NULL)
      continue;
    for (int k = 0; k < 2; k++) {
      const cdem_contact_edge *e = &s->edge[s->edge_pair[i].edge[k]];
      s->edge_key[s->edge_carried][k] = 4 * (int64_t)e->facet[0] + e->side[0];
    }
    s->edge_carry[s->edge_carried++] = s->pool[s->edge_touch[i]];
  }
  free(s->slot_start);
  s->slot_start = NULL;
  s->edge_pairs = 0;
  return CDEM_OK;
}

/* One slot for each component among the candidates of a point, in the order of appearance. */
static int64_t components_of(cdem_contact_store *s, int32_t point, int32_t *into) {
  int32_t n = s->point[point].surface;
  int64_t count = 0;
  for (int64_t c = s->candidate_start[n]; c < s->candidate_start[n + 1]; c++) {
    int32_t component = s->component[s->candidate[c]];
    bool known = false;
    for (int64_t d = s->candidate_start[n]; d < c && !known; d++)
      known = s->component[s->candidate[d]] == component;
    if (known)
      continue;
    if (into != NULL)
      into[count] = component;
    count++;
  }
  return count;
}

static cdem_status make_slot_arrays(cdem_contact_store *s, int64_t slots, cdem_fault *fault) {
  free(s->slot_component);
  free(s->trial);
  free(s->deep);
  free(s->score);
  free(s->slot_touch);
  s->slot_component = s->trial = s->deep = NULL;
  s->score = NULL;
  s->slot_touch = NULL;
  CDEM_NEW(s->slot_component, slots, fault);
  CDEM_NEW(s->trial, slots, fault);
  CDEM_NEW(s->deep, slots, fault);
  CDEM_NEW(s->score, slots, fault);
  CDEM_NEW(s->slot_touch, slots, fault);
  return CDEM_OK;
}

static cdem_status make_slots(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t *start;
  CDEM_NEW(start, (int64_t)s->points + 1, fault);
  s->live = 0;
  for (int32_t p = 0; p < s->points; p++) {
    int64_t count = components_of(s, p, NULL);
    start[p + 1] = start[p] + count;
    if (count > 0)
      s->live_point[s->live++] = p;
  }
  cdem_status status = make_slot_arrays(s, start[s->points], fault);
  if (status != CDEM_OK) {
    free(start);
    return status;
  }
  for (int32_t p = 0; p < s->points; p++)
    components_of(s, p, s->slot_component + start[p]);
  for (int64_t i = 0; i < start[s->points]; i++)
    s->slot_touch[i] = -1;
  s->slot_start = start;
  return CDEM_OK;
}

/* Room for the contact of a point with the component of a facet; NULL when they are no longer near.
 */
static cdem_touch *find_slot(cdem_contact_store *s, int32_t facet, int corner, int32_t master) {
  if (s->point_start[facet] < 0)
    return NULL;
  int32_t p = s->point_start[facet] + corner;
  for (int64_t i = s->slot_start[p]; i < s->slot_start[p + 1]; i++)
    if (s->slot_component[i] == s->component[master]) {
      if (s->slot_touch[i] < 0)
        s->slot_touch[i] = cdem_contact_take(s);
      return &s->pool[s->slot_touch[i]];
    }
  return NULL;
}

/* Contacts that are no longer near anything end here. */
static void lose(cdem_contact_store *s, cdem_touch touch, const cdem_contact *contact) {
  cdem_touch_end(contact, &touch);
  s->friction += touch.friction;
  s->damping += touch.damping;
}

static int compare_edge_pair(const void *a, const void *b) {
  const cdem_edge_pair *x = a, *y = b;
  int first = (x->edge[0] > y->edge[0]) - (x->edge[0] < y->edge[0]);
  return first != 0 ? first : (x->edge[1] > y->edge[1]) - (x->edge[1] < y->edge[1]);
}

/* Edges are ordered by (facet, side): their key. */
static int32_t find_edge(const cdem_contact_store *s, int64_t key) {
  int32_t low = 0, high = s->edges - 1;
  while (low <= high) {
    int32_t middle = low + (high - low) / 2;
    int64_t k = 4 * (int64_t)s->edge[middle].facet[0] + s->edge[middle].side[0];
    if (k == key)
      return middle;
    if (k < key)
      low = middle + 1;
    else
      high = middle - 1;
  }
  return -1;
}

static void place_carried(cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  for (int64_t i = 0; i < s->carried; i++) {
    int64_t key = s->carry[i].key;
    cdem_touch *slot = find_slot(s, (int32_t)(key / 4), (int)(key % 4), s->carry[i].touch.facet);
    if (slot != NULL && slot->facet < 0)
      *slot = s->carry[i].touch;
    else
      lose(s, s->carry[i].touch, contact);
  }
  for (int64_t i = 0; i < s->edge_carried; i++) {
    cdem_edge_pair key = {{find_edge(s, s->edge_key[i][0]), find_edge(s, s->edge_key[i][1])}};
    const cdem_edge_pair *found =
        s->edge_pairs == 0
            ? NULL
            : bsearch(&key, s->edge_pair, (size_t)s->edge_pairs, sizeof key, compare_edge_pair);
    if (found != NULL) {
      s->edge_touch[found - s->edge_pair] = cdem_contact_take(s);
      s->pool[s->pooled - 1] = s->edge_carry[i];
    } else
      lose(s, s->edge_carry[i], contact);
  }
  s->carried = s->edge_carried = 0;
}

/* The history of one corner: half of the force each way, F_t/2 = -w kt s with w half the corner's
 * share. `sign`: of the force on the slave. */
static void start_history(cdem_contact *contact, int32_t slave, int corner, int32_t master,
                          int32_t partner, const double force[3], double sign) {
  cdem_contact_store *s = contact->store;
  cdem_touch *t = find_slot(s, slave, corner, master);
  if (t == NULL || t->facet >= 0)
    return;
  const cdem_contact_law *law = cdem_contact_law_between(s, contact->blocks, slave, master);
  double c[4][3], gradient[4][3], axes[9], world[3];
  int32_t node = contact->blocks->facet[slave].node[corner];
  cdem_projection p;
  cdem_contact_corners(contact, master, c);
  cdem_contact_project(contact, master, (const double(*)[3])c, s->x + 3 * (int64_t)node, &p);
  cdem_contact_shapes(contact, master, (const double(*)[3])c, &p, t->shape, gradient);
  cdem_contact_axes(contact, master, axes);
  double along = cdem_dot3(force, p.normal), stiffness = s->share[slave][corner] * law->kt;
  for (int i = 0; i < 3; i++)
    world[i] = stiffness > 0.0 ? -sign * (force[i] - along * p.normal[i]) / stiffness : 0.0;
  for (int i = 0; i < 3; i++)
    t->stick[i] = cdem_dot3(axes + 3 * i, world);
  /* Until now the springs acted between the two nodes, and held f^2/2k. */
  double normal = along * along / (s->share[slave][corner] * law->kn);
  t->stored = 0.25 * (normal + stiffness * cdem_dot3(world, world));
  t->nodes = 2;
  t->node[0] = node;
  t->node[1] = partner;
  for (int i = 0; i < 3; i++) {
    t->nodal[0][i] = 0.5 * sign * force[i];
    t->nodal[1][i] = -0.5 * sign * force[i];
  }
  t->facet = master;
  t->own[corner] = 1.0;
  t->handed = 1;
}

static int corner_of(const cdem_facet *facet, int32_t node) {
  for (int k = 0; k < facet->corners; k++)
    if (facet->node[k] == node)
      return k;
  return 0;
}

static void place_handed(cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  const cdem_blocks *blocks = contact->blocks;
  for (int32_t h = 0; h < s->handed; h++) {
    int32_t p = s->handed_pair[h];
    const cdem_face_pair *pair = &blocks->pair[p];
    for (int side = 0; side < 2; side++) {
      int32_t slave = blocks->pair_facet[2 * (int64_t)p + side];
      int32_t master = blocks->pair_facet[2 * (int64_t)p + 1 - side];
      for (int k = 0; k < pair->corners; k++)
        start_history(contact, slave, corner_of(&blocks->facet[slave], pair->node[side][k]), master,
                      pair->node[1 - side][k], s->handed_force[p][k], side == 1 ? 1.0 : -1.0);
    }
    s->handed_mark[p] = 0;
  }
  s->handed = 0;
}

/* Facets that take part, whose planes are kept up to date. */
static void mark_facets(cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  memset(s->mark, 0, (size_t)contact->blocks->facets);
  for (int32_t n = 0; n < s->surface_nodes; n++)
    for (int64_t c = s->candidate_start[n]; c < s->candidate_start[n + 1]; c++)
      s->mark[s->candidate[c]] = 1;
  for (int32_t i = 0; i < s->live; i++)
    s->mark[s->point[s->live_point[i]].facet] = 1;
  for (int64_t i = 0; i < s->edge_pairs; i++)
    for (int k = 0; k < 4; k++)
      s->mark[s->edge[s->edge_pair[i].edge[k / 2]].facet[k % 2]] = 1;
  s->marked = 0;
  for (int32_t f = 0; f < s->facets; f++)
    if (s->mark[s->facet[f]])
      s->marked_facet[s->marked++] = s->facet[f];
}

/* From present positions; the topology is that of the active facets. */
cdem_status cdem_contact_rebuild(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  CDEM_TRY(cdem_contact_carry(contact, fault));
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t f = 0; f < s->facets; f++)
    cdem_contact_face_now(contact, s->facet[f], &s->face[s->facet[f]]);
  CDEM_TRY(cdem_contact_candidates(contact, fault));
  CDEM_TRY(cdem_contact_edge_candidates(contact, fault));
  CDEM_TRY(make_slots(contact, fault));
  if (s->edge_pairs > 0)
    qsort(s->edge_pair, (size_t)s->edge_pairs, sizeof *s->edge_pair, compare_edge_pair);
  s->pooled = 0;
  CDEM_TRY(
      cdem_contact_make_room(s, s->carried + s->edge_carried + 8 * (int64_t)s->handed + 64, fault));
  place_carried(contact);
  place_handed(contact);
  mark_facets(contact);
  for (int32_t n = 0; n < s->surface_nodes; n++)
    memcpy(s->built + 3 * (int64_t)n, s->x + 3 * (int64_t)s->surface_node[n], 3 * sizeof(double));
  s->list_stale = false;
  s->rebuilds++;
  contact->version++;
  return CDEM_OK;
}
