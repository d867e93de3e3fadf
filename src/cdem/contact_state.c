/* Contact as seen from outside: the step's limit, results, checkpoints. */
#include "cdem/contact_store.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- frequency ---- */

/* A contact adds K = k B^T B with B = [b_i I], b_i 1 at the slave and -N_i at the master's nodes, k
 * the larger of w kn, w kt (the directions of K are orthogonal). By Gershgorin's theorem for blocks
 * the largest eigenvalue of M^-1 K is at most the largest over the nodes of
 * sum k |b_i| (sum_j |b_j|) / m_i. */
static void add_row(cdem_contact_store *s, const int32_t *node, const double *b, int nodes,
                    double k) {
  double sum = 0.0;
  for (int i = 0; i < nodes; i++)
    sum += fabs(b[i]);
  for (int i = 0; i < nodes; i++)
    s->row[node[i]] += k * fabs(b[i]) * sum;
}

/* Points within the skin count too, touching or not: what could touch before the next rebuild. */
static void add_point(cdem_contact *contact, int32_t point, double *lag) {
  cdem_contact_store *s = contact->store;
  const cdem_contact_point *p = &s->point[point];
  cdem_contact_look(contact, point, -s->skin, NULL);
  for (int64_t i = s->slot_start[point]; i < s->slot_start[point + 1]; i++) {
    int32_t master = s->trial[i];
    if (master < 0)
      continue;
    const cdem_contact_law *law = cdem_contact_law_between(s, contact->blocks, p->facet, master);
    cdem_touch t = {0};
    double weight = cdem_contact_lever(contact, p, master, &t), mass;
    if (!(weight > 0.0))
      continue;
    add_row(s, t.node, t.nodal[0], t.nodes, weight * fmax(law->kn, law->kt));
    mass = s->mass[(int64_t)p->node * s->dofs] / s->node_area[p->node];
    *lag = fmax(*lag, 2.0 * law->damping * sqrt(mass / law->kn));
  }
}

double cdem_contact_frequency2(const cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  double largest = 0.0, lag = 0.0;
  if (s->slot_start == NULL)
    return 0.0;
  memset(s->row, 0, (size_t)contact->blocks->mesh.nodes * sizeof *s->row);
  cdem_contact scratch = *contact;
  for (int32_t i = 0; i < s->live; i++)
    add_point(&scratch, s->live_point[i], &lag);
  for (int64_t i = 0; i < s->edge_pairs; i++) {
    const cdem_touch *t = cdem_touch_of(s, s->edge_touch[i]);
    if (t == NULL)
      continue;
    double b[4] = {1.0 - t->shape[0], t->shape[0], 1.0 - t->shape[1], t->shape[1]};
    add_row(s, t->node, b, 4, t->weight * fmax(t->kn, t->kt));
  }
  for (int32_t i = 0; i < s->surface_nodes; i++) {
    int64_t n = s->surface_node[i];
    double mass = s->mass[n * s->dofs];
    if (mass > 0.0)
      largest = fmax(largest, s->row[n] / mass);
  }
  /* The dashpot works with the velocity half a step behind: stable while dt^2 L + 2 dt lag L <= 4,
   * L the squared frequency, lag the dashpot over the spring. */
  double omega = 0.5 * (lag * largest + sqrt(lag * lag * largest * largest + 4.0 * largest));
  return omega * omega;
}

/* ---- results ---- */

static void put(const cdem_contact *contact, const cdem_touch *t, int32_t slave,
                cdem_contact_fields *f) {
  int64_t i = f->contacts++;
  for (int k = 0; k < 3; k++) {
    f->position[3 * i + k] = t->position[k];
    f->normal[3 * i + k] = t->normal[k];
    f->force[3 * i + k] = t->force[k];
  }
  f->sliding[i] = t->sliding;
  f->slave_cell[i] = contact->blocks->facet[slave].cell;
  f->master_cell[i] = contact->blocks->facet[t->facet].cell;
}

static cdem_status make_fields(int64_t count, cdem_contact_fields *f, cdem_fault *fault) {
  CDEM_NEW(f->position, 3 * count, fault);
  CDEM_NEW(f->normal, 3 * count, fault);
  CDEM_NEW(f->force, 3 * count, fault);
  CDEM_NEW(f->sliding, count, fault);
  CDEM_NEW(f->slave_cell, count, fault);
  CDEM_NEW(f->master_cell, count, fault);
  return CDEM_OK;
}

cdem_status cdem_contact_fields_get(const cdem_contact *contact, cdem_contact_fields *fields,
                                    cdem_fault *fault) {
  const cdem_contact_store *s = contact->store;
  int64_t count = 0, slots = s->slot_start != NULL ? s->slot_start[s->points] : 0;
  memset(fields, 0, sizeof *fields);
  for (int64_t i = 0; i < slots; i++)
    count += cdem_touch_of(s, s->slot_touch[i]) != NULL;
  for (int64_t i = 0; i < s->edge_pairs; i++)
    count += cdem_touch_of(s, s->edge_touch[i]) != NULL;
  cdem_status status = make_fields(count, fields, fault);
  if (status != CDEM_OK) {
    cdem_contact_fields_release(fields);
    return status;
  }
  for (int32_t p = 0; p < s->points && slots > 0; p++)
    for (int64_t i = s->slot_start[p]; i < s->slot_start[p + 1]; i++)
      if (cdem_touch_of(s, s->slot_touch[i]) != NULL)
        put(contact, &s->pool[s->slot_touch[i]], s->point[p].facet, fields);
  for (int64_t i = 0; i < s->edge_pairs; i++)
    if (cdem_touch_of(s, s->edge_touch[i]) != NULL)
      put(contact, &s->pool[s->edge_touch[i]], s->edge[s->edge_pair[i].edge[1]].facet[0], fields);
  return CDEM_OK;
}

void cdem_contact_fields_release(cdem_contact_fields *fields) {
  free(fields->position);
  free(fields->normal);
  free(fields->force);
  free(fields->sliding);
  free(fields->slave_cell);
  free(fields->master_cell);
  memset(fields, 0, sizeof *fields);
}

/* ---- checkpoints ---- */

enum { REALS = 50, IDS = 18, SCALARS = 3, COUNTERS = 8 };

static void pack(const cdem_touch *t, double *real, int32_t *id) {
  double scalar[] = {t->weight, t->gap, t->kn, t->kt, t->dashpot, t->stored};
  memcpy(real, t->shape, 4 * sizeof *real);
  memcpy(real + 4, t->stick, 3 * sizeof *real);
  memcpy(real + 7, scalar, sizeof scalar);
  memcpy(real + 13, t->force, 3 * sizeof *real);
  memcpy(real + 16, t->normal, 3 * sizeof *real);
  memcpy(real + 19, t->position, 3 * sizeof *real);
  memcpy(real + 22, t->own, 4 * sizeof *real);
  memcpy(real + 26, t->nodal, sizeof t->nodal);
  int32_t small[] = {t->facet, t->nodes, t->sliding, t->handed};
  memcpy(id, small, sizeof small);
  memcpy(id + 4, t->node, 8 * sizeof *id);
}

static void unpack(const double *real, const int32_t *id, cdem_touch *t) {
  memset(t, 0, sizeof *t);
  memcpy(t->shape, real, 4 * sizeof *real);
  memcpy(t->stick, real + 4, 3 * sizeof *real);
  t->weight = real[7];
  t->gap = real[8];
  t->kn = real[9];
  t->kt = real[10];
  t->dashpot = real[11];
  t->stored = real[12];
  memcpy(t->force, real + 13, 3 * sizeof *real);
  memcpy(t->normal, real + 16, 3 * sizeof *real);
  memcpy(t->position, real + 19, 3 * sizeof *real);
  memcpy(t->own, real + 22, 4 * sizeof *real);
  memcpy(t->nodal, real + 26, sizeof t->nodal);
  t->facet = id[0];
  t->nodes = (uint8_t)id[1];
  t->sliding = (uint8_t)id[2];
  t->handed = (uint8_t)id[3];
  memcpy(t->node, id + 4, 8 * sizeof *id);
}

/* The keys of a contact: ids 12..15 are its slave point or its two edges, 16 tells. */
static void pack_all(const cdem_contact_store *s, double *real, int32_t *id) {
  int64_t n = 0;
  for (int32_t p = 0; s->slot_start != NULL && p < s->points; p++)
    for (int64_t i = s->slot_start[p]; i < s->slot_start[p + 1]; i++)
      if (cdem_touch_of(s, s->slot_touch[i]) != NULL) {
        pack(&s->pool[s->slot_touch[i]], real + REALS * n, id + IDS * n);
        id[IDS * n + 12] = s->point[p].facet;
        id[IDS * n++ + 13] = s->point[p].corner;
      }
  for (int64_t i = 0; i < s->edge_pairs; i++)
    if (cdem_touch_of(s, s->edge_touch[i]) != NULL) {
      pack(&s->pool[s->edge_touch[i]], real + REALS * n, id + IDS * n);
      for (int k = 0; k < 2; k++) {
        const cdem_contact_edge *e = &s->edge[s->edge_pair[i].edge[k]];
        id[IDS * n + 12 + 2 * k] = e->facet[0];
        id[IDS * n + 13 + 2 * k] = e->side[0];
      }
      id[IDS * n++ + 16] = 1;
    }
}

static cdem_status save_touches(const cdem_contact_store *s, cdem_state *state, cdem_fault *fault) {
  int64_t slots = s->slot_start != NULL ? s->slot_start[s->points] : 0, count = 0;
  for (int64_t i = 0; i < slots; i++)
    count += cdem_touch_of(s, s->slot_touch[i]) != NULL;
  for (int64_t i = 0; i < s->edge_pairs; i++)
    count += cdem_touch_of(s, s->edge_touch[i]) != NULL;
  double *real = cdem_allocate(REALS * count, sizeof *real, fault);
  int32_t *id = cdem_allocate(IDS * count, sizeof *id, fault);
  cdem_status status = real != NULL && id != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK) {
    pack_all(s, real, id);
    status =
        cdem_state_add_owned(state, "contact/touch", CDEM_ARRAY_REAL, REALS * count, real, fault);
  }
  if (status != CDEM_OK) {
    free(real);
    free(id);
    return status;
  }
  status = cdem_state_add_owned(state, "contact/ids", CDEM_ARRAY_INT32, IDS * count, id, fault);
  if (status != CDEM_OK)
    free(id);
  return status;
}

cdem_status cdem_contact_save(const cdem_contact *contact, cdem_state *state, cdem_fault *fault) {
  const cdem_contact_store *s = contact->store;
  int64_t counter[COUNTERS] = {contact->version,  s->rebuilds,          s->contacts,
                               s->topology_stale, s->list_stale,        s->handed,
                               s->surface_nodes,  s->slot_start != NULL};
  double scalar[SCALARS] = {s->friction, s->damping, s->sweep};
  int64_t nodes = contact->blocks->mesh.nodes, pairs = contact->blocks->pairs;
  CDEM_TRY(
      cdem_state_add_copy(state, "contact/counters", CDEM_ARRAY_INT64, COUNTERS, counter, fault));
  CDEM_TRY(cdem_state_add_copy(state, "contact/scalars", CDEM_ARRAY_REAL, SCALARS, scalar, fault));
  CDEM_TRY(cdem_state_add(state, "contact/active", CDEM_ARRAY_BYTE, contact->blocks->facets,
                          s->active, fault));
  CDEM_TRY(cdem_state_add(state, "contact/positions", CDEM_ARRAY_REAL, 3 * nodes, s->x, fault));
  CDEM_TRY(cdem_state_add(state, "contact/built", CDEM_ARRAY_REAL, 3 * nodes, s->built, fault));
  CDEM_TRY(
      cdem_state_add(state, "contact/handed_pair", CDEM_ARRAY_INT32, pairs, s->handed_pair, fault));
  CDEM_TRY(cdem_state_add(state, "contact/handed_force", CDEM_ARRAY_REAL, 12 * pairs,
                          s->handed_force, fault));
  return save_touches(s, state, fault);
}

static cdem_status carry_restored(cdem_contact_store *s, const double *real, const int32_t *id,
                                  int64_t count, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&s->carry, &s->carried_capacity, count, sizeof *s->carry, fault));
  CDEM_TRY(cdem_grow(&s->edge_key, &s->edge_carried_capacity, count, sizeof *s->edge_key, fault));
  CDEM_TRY(cdem_grow(&s->edge_carry, &s->edge_touch_capacity, count, sizeof *s->edge_carry, fault));
  s->carried = s->edge_carried = 0;
  for (int64_t n = 0; n < count; n++) {
    const int32_t *key = id + IDS * n + 12;
    cdem_touch touch;
    unpack(real + REALS * n, id + IDS * n, &touch);
    if (key[4] == 0) {
      s->carry[s->carried++] = (cdem_carried){4 * (int64_t)key[0] + key[1], touch};
    } else {
      s->edge_key[s->edge_carried][0] = 4 * (int64_t)key[0] + key[1];
      s->edge_key[s->edge_carried][1] = 4 * (int64_t)key[2] + key[3];
      s->edge_carry[s->edge_carried++] = touch;
    }
  }
  return CDEM_OK;
}

static cdem_status check_touches(const cdem_contact *contact, const int32_t *id, int64_t count,
                                 cdem_fault *fault) {
  const cdem_blocks *b = contact->blocks;
  for (int64_t n = 0; n < count; n++) {
    const int32_t *at = id + IDS * n;
    bool good = at[0] >= 0 && at[0] < b->facets && at[12] >= 0 && at[12] < b->facets &&
                at[13] >= 0 && at[13] < 4 && at[14] >= 0 && at[14] < b->facets && at[1] >= 0 &&
                at[1] <= 8;
    for (int k = 0; k < 8; k++)
      good = good && at[4 + k] >= 0 && at[4 + k] < b->mesh.nodes;
    CDEM_REQUIRE(good, fault, CDEM_INPUT,
                 "contact %" PRId64 " of the checkpoint names a facet or node that does not exist; "
                 "the checkpoint does not belong to this case",
                 n);
  }
  return CDEM_OK;
}

/* The list was made at the positions of the last rebuild, and is again. */
static cdem_status rebuild_list(cdem_contact *contact, const int64_t counter[COUNTERS],
                                cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  CDEM_TRY(cdem_contact_topology(contact, fault));
  CDEM_REQUIRE(s->surface_nodes == counter[6], fault, CDEM_INPUT,
               "contact: the checkpoint has %" PRId64 " surface nodes, the case %d; the checkpoint "
               "does not belong to this case",
               counter[6], s->surface_nodes);
  double *now;
  CDEM_NEW(now, 3 * (int64_t)contact->blocks->mesh.nodes, fault);
  memcpy(now, s->x, 3 * (size_t)contact->blocks->mesh.nodes * sizeof *now);
  for (int32_t i = 0; i < s->surface_nodes; i++)
    memcpy(s->x + 3 * (int64_t)s->surface_node[i], s->built + 3 * (int64_t)i, 3 * sizeof *now);
  cdem_status status = cdem_contact_rebuild(contact, fault);
  memcpy(s->x, now, 3 * (size_t)contact->blocks->mesh.nodes * sizeof *now);
  free(now);
  CDEM_TRY(status);
  for (int32_t f = 0; f < s->marked; f++)
    cdem_contact_face_now(contact, s->marked_facet[f], &s->face[s->marked_facet[f]]);
  return CDEM_OK;
}

static cdem_status restore_arrays(cdem_contact *contact, const cdem_state *state,
                                  const int64_t counter[COUNTERS], cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t nodes = contact->blocks->mesh.nodes, pairs = contact->blocks->pairs;
  CDEM_TRY(cdem_state_get(state, "contact/active", CDEM_ARRAY_BYTE, contact->blocks->facets,
                          s->active, fault));
  CDEM_TRY(cdem_state_get(state, "contact/positions", CDEM_ARRAY_REAL, 3 * nodes, s->x, fault));
  CDEM_TRY(cdem_state_get(state, "contact/built", CDEM_ARRAY_REAL, 3 * nodes, s->built, fault));
  CDEM_TRY(
      cdem_state_get(state, "contact/handed_pair", CDEM_ARRAY_INT32, pairs, s->handed_pair, fault));
  CDEM_TRY(cdem_state_get(state, "contact/handed_force", CDEM_ARRAY_REAL, 12 * pairs,
                          s->handed_force, fault));
  memset(s->handed_mark, 0, (size_t)pairs);
  CDEM_REQUIRE(counter[5] >= 0 && counter[5] <= pairs, fault, CDEM_INPUT,
               "contact: the checkpoint hands over %" PRId64 " pairs of %" PRId64
               "; the checkpoint does not belong to this case",
               counter[5], pairs);
  s->handed = (int32_t)counter[5];
  for (int32_t h = 0; h < s->handed; h++) {
    CDEM_REQUIRE(s->handed_pair[h] >= 0 && s->handed_pair[h] < pairs, fault, CDEM_INPUT,
                 "contact: the checkpoint hands over a pair that does not exist; the checkpoint "
                 "does not belong to this case");
    s->handed_mark[s->handed_pair[h]] = 1;
  }
  return CDEM_OK;
}

static cdem_status restore_touches(cdem_contact *contact, const cdem_state *state,
                                   cdem_fault *fault) {
  int64_t reals = 0, ids = 0;
  double *real = NULL;
  int32_t *id = NULL;
  cdem_status status =
      cdem_state_take(state, "contact/touch", CDEM_ARRAY_REAL, &reals, &real, fault);
  if (status == CDEM_OK)
    status = cdem_state_take(state, "contact/ids", CDEM_ARRAY_INT32, &ids, &id, fault);
  if (status == CDEM_OK && (reals % REALS != 0 || ids % IDS != 0 || reals / REALS != ids / IDS))
    status = cdem_fail(fault, CDEM_INPUT,
                       "contact: the checkpoint's arrays do not fit each other; the checkpoint "
                       "does not belong to this case");
  if (status == CDEM_OK)
    status = check_touches(contact, id, ids / IDS, fault);
  if (status == CDEM_OK)
    status = carry_restored(contact->store, real, id, ids / IDS, fault);
  free(real);
  free(id);
  return status;
}

cdem_status cdem_contact_restore(cdem_contact *contact, const cdem_state *state,
                                 cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t counter[COUNTERS];
  double scalar[SCALARS];
  CDEM_TRY(cdem_state_get(state, "contact/counters", CDEM_ARRAY_INT64, COUNTERS, counter, fault));
  CDEM_TRY(cdem_state_get(state, "contact/scalars", CDEM_ARRAY_REAL, SCALARS, scalar, fault));
  for (int k = 0; k < 3; k++)
    CDEM_REQUIRE(counter[k] >= 0 && counter[k] < INT64_MAX / 2, fault, CDEM_INPUT,
                 "contact: the checkpoint counts %" PRId64
                 " of its versions, lists or contacts; the checkpoint does not belong to this case",
                 counter[k]);
  free(s->slot_start);
  s->slot_start = NULL;
  s->edge_pairs = 0;
  s->topology_stale = s->list_stale = true;
  CDEM_TRY(restore_arrays(contact, state, counter, fault));
  CDEM_TRY(restore_touches(contact, state, fault));
  s->sweep = scalar[2];
  if (!counter[3] && !counter[4])
    CDEM_TRY(rebuild_list(contact, counter, fault));
  s->friction = scalar[0];
  s->damping = scalar[1];
  contact->version = counter[0];
  s->rebuilds = counter[1];
  s->contacts = counter[2];
  return CDEM_OK;
}
