/* Contact: making, activating, and one evaluation. */
#include "cdem/contact.h"

#include "cdem/contact_store.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static cdem_status check_law(const cdem_contact_law *law, const char *name, cdem_fault *fault) {
  CDEM_REQUIRE(law->kn > 0.0 && isfinite(law->kn), fault, CDEM_INPUT,
               "contact: the normal stiffness kn of %s is %g Pa/m; give a positive number", name,
               law->kn);
  CDEM_REQUIRE(law->kt >= 0.0 && isfinite(law->kt), fault, CDEM_INPUT,
               "contact: the shear stiffness kt of %s is %g Pa/m; give 0 or a positive number",
               name, law->kt);
  CDEM_REQUIRE(law->friction >= 0.0 && isfinite(law->friction), fault, CDEM_INPUT,
               "contact: the friction of %s is %g; give 0 or a positive number", name,
               law->friction);
  CDEM_REQUIRE(law->damping >= 0.0 && isfinite(law->damping), fault, CDEM_INPUT,
               "contact: the damping of %s is %g; give 0 or a positive fraction of critical", name,
               law->damping);
  return CDEM_OK;
}

static cdem_status copy_laws(const cdem_contact_options *o, cdem_contact_store *s,
                             cdem_fault *fault) {
  CDEM_TRY(check_law(&o->law, "the law of all pairs", fault));
  CDEM_NEW(s->law, (int64_t)o->laws + 1, fault);
  s->law[0] = o->law;
  for (int l = 0; l < o->laws; l++) {
    CDEM_TRY(check_law(&o->pair_law[l], "a pair of groups", fault));
    s->law[l + 1] = o->pair_law[l];
  }
  s->colours = o->law_of != NULL ? o->colours : 0;
  if (o->law_of == NULL)
    return CDEM_OK;
  int64_t colours = o->colours, cells = o->blocks->mesh.cells;
  CDEM_NEW(s->law_of, colours * colours, fault);
  for (int64_t i = 0; i < colours * colours; i++) {
    CDEM_REQUIRE(o->law_of[i] >= -1 && o->law_of[i] < o->laws, fault, CDEM_USAGE,
                 "contact: law %d of a pair of colours does not exist; there are %d", o->law_of[i],
                 o->laws);
    s->law_of[i] = o->law_of[i];
  }
  if (o->colour == NULL)
    return CDEM_OK;
  CDEM_NEW(s->colour, cells, fault);
  for (int64_t c = 0; c < cells; c++) {
    CDEM_REQUIRE(o->blocks->block[c] < 0 || (o->colour[c] >= 0 && o->colour[c] < colours), fault,
                 CDEM_USAGE, "contact: cell %" PRId64 " has colour %d; there are %d",
                 o->blocks->mesh.cell_tag[c], o->colour[c], o->colours);
    s->colour[c] = o->colour[c];
  }
  return CDEM_OK;
}

/* From corner k to the farthest place of its patch: middle of the facet, or of a side. */
static double patch_reach(const cdem_facet *facet, const double *xyz, int k) {
  double reach = 0.0, middle[3] = {0.0};
  const double *at = xyz + 3 * (int64_t)facet->node[k];
  for (int j = 0; j < facet->corners; j++) {
    const double *x = xyz + 3 * (int64_t)facet->node[j];
    double side[3] = {x[0] - at[0], x[1] - at[1], x[2] - at[2]};
    for (int i = 0; i < 3; i++)
      middle[i] += side[i] / facet->corners;
    reach = fmax(reach, 0.5 * cdem_norm3(side));
  }
  return fmax(reach, cdem_norm3(middle));
}

/* Shares, size, and how deep a point may be: half of the size or of the cell's height behind the
 * facet, whichever is less, so that nothing is pushed out through the back of a thin body. */
static void measure_facet(cdem_contact *contact, int32_t f) {
  cdem_contact_store *s = contact->store;
  const cdem_mesh *mesh = &contact->blocks->mesh;
  const cdem_facet *facet = &contact->blocks->facet[f];
  double area[3], height = 0.0;
  cdem_facet_area(facet, mesh->xyz, s->thickness, area, s->share[f]);
  double size = cdem_norm3(area), measure = size / (s->dim == 2 ? s->thickness : 1.0);
  for (int64_t i = mesh->cell_start[facet->cell]; i < mesh->cell_start[facet->cell + 1]; i++) {
    double off = 0.0;
    for (int k = 0; k < 3; k++)
      off -= area[k] / size *
             (mesh->xyz[3 * (int64_t)mesh->cell_node[i] + k] -
              mesh->xyz[3 * (int64_t)facet->node[0] + k]);
    height = fmax(height, off);
  }
  s->size[f] = s->dim == 2 ? measure : sqrt(measure * (facet->corners == 3 ? 2.0 : 1.0));
  s->depth[f] = 0.5 * fmin(s->size[f], height);
  for (int k = 0; k < facet->corners; k++) {
    s->node_area[facet->node[k]] += s->share[f][k];
    s->patch[f] = fmax(s->patch[f], patch_reach(facet, mesh->xyz, k));
  }
}

static cdem_status make_arrays(const cdem_blocks *blocks, cdem_contact_store *s,
                               cdem_fault *fault) {
  int64_t facets = blocks->facets, nodes = blocks->mesh.nodes, pairs = blocks->pairs;
  CDEM_NEW(s->share, facets, fault);
  CDEM_NEW(s->size, facets, fault);
  CDEM_NEW(s->depth, facets, fault);
  CDEM_NEW(s->patch, facets, fault);
  CDEM_NEW(s->node_area, nodes, fault);
  CDEM_NEW(s->active, facets, fault);
  CDEM_NEW(s->handed_pair, pairs, fault);
  CDEM_NEW(s->handed_force, pairs, fault);
  CDEM_NEW(s->handed_mark, pairs, fault);
  CDEM_NEW(s->cluster, nodes, fault);
  CDEM_NEW(s->component, facets, fault);
  CDEM_NEW(s->border, facets, fault);
  CDEM_NEW(s->facet, facets, fault);
  CDEM_NEW(s->point_start, facets, fault);
  CDEM_NEW(s->point, 4 * facets, fault);
  CDEM_NEW(s->live_point, 4 * facets, fault);
  CDEM_NEW(s->busy, 4 * facets, fault);
  CDEM_NEW(s->surface_node, nodes, fault);
  CDEM_NEW(s->x, 3 * nodes, fault);
  CDEM_NEW(s->built, 3 * nodes, fault);
  CDEM_NEW(s->reach, nodes, fault);
  CDEM_NEW(s->row, nodes, fault);
  CDEM_NEW(s->face, facets, fault);
  CDEM_NEW(s->marked_facet, facets, fault);
  CDEM_NEW(s->mark, facets, fault);
  return CDEM_OK;
}

static cdem_status init(const cdem_contact_options *o, cdem_contact *contact, cdem_fault *fault) {
  CDEM_NEW(contact->store, 1, fault);
  cdem_contact_store *s = contact->store;
  contact->blocks = o->blocks;
  s->dim = o->blocks->dimension;
  s->dofs = o->dofs;
  s->thickness = s->dim == 2 ? o->thickness : 1.0;
  s->threads = o->threads > 0 ? o->threads : omp_get_max_threads();
  s->mass = o->mass;
  CDEM_REQUIRE(o->mass != NULL && s->dofs >= s->dim, fault, CDEM_USAGE,
               "contact needs the nodes' masses and at least %d unknowns a node", s->dim);
  CDEM_REQUIRE(s->thickness > 0.0, fault, CDEM_INPUT,
               "contact: the thickness is %g m; give a positive number", s->thickness);
  CDEM_REQUIRE(o->skin >= 0.0 && isfinite(o->skin), fault, CDEM_INPUT,
               "contact: the skin is %g m; give a positive length, or 0 for a fifth of the mean "
               "facet size",
               o->skin);
  CDEM_TRY(copy_laws(o, s, fault));
  CDEM_TRY(make_arrays(o->blocks, s, fault));
  double mean = 0.0;
  for (int32_t f = 0; f < o->blocks->facets; f++) {
    measure_facet(contact, f);
    mean += s->size[f] / o->blocks->facets;
  }
  s->skin = o->skin > 0.0 ? o->skin : 0.2 * mean;
  s->topology_stale = s->list_stale = true;
  return CDEM_OK;
}

cdem_status cdem_contact_init(const cdem_contact_options *options, cdem_contact *contact,
                              cdem_fault *fault) {
  memset(contact, 0, sizeof *contact);
  cdem_status status = init(options, contact, fault);
  if (status != CDEM_OK)
    cdem_contact_release(contact);
  return status;
}

void cdem_contact_release(cdem_contact *contact) {
  cdem_contact_store *s = contact->store;
  if (s != NULL) {
    void *all[] = {s->law,         s->law_of,       s->colour,         s->share,
                   s->size,        s->depth,        s->node_area,      s->active,
                   s->handed_pair, s->handed_force, s->handed_mark,    s->cluster,
                   s->component,   s->border,       s->facet,          s->point_start,
                   s->point,       s->live_point,   s->surface_node,   s->edge,
                   s->x,           s->built,        s->reach,          s->row,
                   s->face,        s->marked_facet, s->mark,           s->candidate_start,
                   s->candidate,   s->slot_start,   s->slot_component, s->trial,
                   s->deep,        s->score,        s->slot_touch,     s->edge_pair,
                   s->edge_touch,  s->edge_busy,    s->pool,           s->carry,
                   s->edge_key,    s->edge_carry,   s->patch,          s->busy};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
      free(all[i]);
    free(s);
  }
  memset(contact, 0, sizeof *contact);
}

void cdem_contact_activate(cdem_contact *contact, int32_t facet) {
  cdem_contact_store *s = contact->store;
  if (s->active[facet])
    return;
  s->active[facet] = CDEM_FRESH;
  s->topology_stale = s->list_stale = true;
}

void cdem_contact_hand_over(cdem_contact *contact, int32_t pair, const double force[4][3]) {
  cdem_contact_store *s = contact->store;
  cdem_contact_activate(contact, contact->blocks->pair_facet[2 * (int64_t)pair]);
  cdem_contact_activate(contact, contact->blocks->pair_facet[2 * (int64_t)pair + 1]);
  if (force == NULL)
    return;
  if (!s->handed_mark[pair])
    s->handed_pair[s->handed++] = pair;
  s->handed_mark[pair] = 1;
  s->list_stale = true;
  memset(s->handed_force[pair], 0, sizeof s->handed_force[pair]);
  for (int k = 0; k < contact->blocks->pair[pair].corners; k++)
    memcpy(s->handed_force[pair][k], force[k], sizeof force[k]);
}

/* ---- one evaluation ---- */

enum { MOVED = 1, INVALID = 2, ROOM_OF_POINT = 4 };

/* Present positions of the surface; whether something has left half of its skin. */
static int update_positions(cdem_contact *contact, const double *u) {
  cdem_contact_store *s = contact->store;
  const double *xyz = contact->blocks->mesh.xyz;
  int seen = 0;
  double bound = 0.25 * s->skin * s->skin;
#pragma omp parallel for schedule(static) num_threads(s->threads) reduction(| : seen)
  for (int32_t i = 0; i < s->surface_nodes; i++) {
    int64_t n = s->surface_node[i];
    double square = 0.0;
    for (int k = 0; k < s->dim; k++) {
      s->x[3 * n + k] = xyz[3 * n + k] + u[n * s->dofs + k];
      double off = s->x[3 * n + k] - s->built[3 * (int64_t)i + k];
      square += off * off;
    }
    if (!(square <= bound))
      seen |= isfinite(s->x[3 * n] + s->x[3 * n + 1] + s->x[3 * n + 2]) ? MOVED : INVALID;
  }
  return seen;
}

/* Twice the largest motion of this step: how far apart two things may come in the next. */
static double largest_motion(const cdem_contact_store *s) {
  double largest = 0.0;
  for (int32_t i = 0; i < s->surface_nodes && s->v != NULL; i++) {
    const double *v = s->v + (int64_t)s->surface_node[i] * s->dofs;
    double square = 0.0;
    for (int k = 0; k < s->dim; k++)
      square += v[k] * v[k];
    largest = fmax(largest, square);
  }
  return 2.0 * sqrt(largest) * s->dt;
}

static cdem_status too_deep(const cdem_contact *contact, int32_t slave, int32_t master,
                            cdem_fault *fault) {
  const cdem_blocks *b = contact->blocks;
  const cdem_contact_store *s = contact->store;
  const double *at = s->face[master].centre;
  return cdem_fail(fault, CDEM_NUMERIC,
                   "contact: element %" PRId64 " is inside element %" PRId64
                   " by more than %.4g m (half of its size) near (%.4g, %.4g, %.4g); the time step "
                   "is too long, the speed too large or the contact stiffness too small",
                   b->mesh.cell_tag[b->facet[slave].cell], b->mesh.cell_tag[b->facet[master].cell],
                   s->depth[master], at[0], at[1], at[2]);
}

/* All points, or those that found the pool full before. *failed: the first slot that is too deep.
 */
static int64_t step_points(cdem_contact *contact, bool again, int64_t *failed) {
  cdem_contact_store *s = contact->store;
  int64_t full = 0, first = *failed;
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->threads) reduction(+ : full)         \
    reduction(min : first)
  for (int32_t i = 0; i < s->live; i++) {
    if (again && s->busy[i] != CDEM_DEFERRED)
      continue;
    int64_t deep = cdem_contact_point_step(contact, i);
    full += s->busy[i] == CDEM_DEFERRED;
    first = deep >= 0 && deep < first ? deep : first;
  }
  *failed = first;
  return full;
}

static int32_t slave_of_slot(const cdem_contact_store *s, int64_t slot) {
  int32_t p = 0;
  while (s->slot_start[p + 1] <= slot)
    p++;
  return s->point[p].facet;
}

static cdem_status find_contacts(cdem_contact *contact, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  int64_t deferred = 0;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t f = 0; f < s->marked; f++)
    cdem_contact_face_now(contact, s->marked_facet[f], &s->face[s->marked_facet[f]]);
  int64_t slots = s->slot_start[s->points], failed = slots;
  for (bool again = false; !again || deferred > 0; again = true) {
    CDEM_TRY(cdem_contact_make_room(s, ROOM_OF_POINT * deferred, fault));
    deferred = step_points(contact, again, &failed);
  }
  if (failed < slots)
    return too_deep(contact, slave_of_slot(s, failed), s->deep[failed], fault);
  failed = s->edge_pairs;
  for (bool again = false; !again || deferred > 0; again = true) {
    CDEM_TRY(cdem_contact_make_room(s, deferred, fault));
    deferred = cdem_contact_edges_step(contact, again, &failed);
  }
  if (failed < s->edge_pairs)
    return too_deep(contact, s->edge[s->edge_pair[failed].edge[1]].facet[0],
                    s->edge[s->edge_pair[failed].edge[0]].facet[0], fault);
  return CDEM_OK;
}

static void add_touch(cdem_contact_store *s, const cdem_touch *t, double *force) {
  s->friction += t->friction;
  s->damping += t->damping;
  if (t->facet < 0)
    return;
  s->contacts++;
  for (int k = 0; k < t->nodes; k++)
    for (int i = 0; i < s->dim; i++)
      force[(int64_t)t->node[k] * s->dofs + i] += t->nodal[k][i];
}

static cdem_status prepare(cdem_contact *contact, const double *u, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  if (s->topology_stale) {
    CDEM_TRY(cdem_contact_carry(contact, fault));
    CDEM_TRY(cdem_contact_topology(contact, fault));
  }
  int seen = update_positions(contact, u);
  CDEM_REQUIRE(!(seen & INVALID), fault, CDEM_NUMERIC,
               "contact: the position of a surface node is no longer a number; the motion has "
               "diverged, reduce the time step");
  if (!s->list_stale && seen == 0)
    return CDEM_OK;
  s->list_stale = true;
  s->sweep = largest_motion(s);
  return cdem_contact_rebuild(contact, fault);
}

cdem_status cdem_contact_forces(cdem_contact *contact, const double *u, const double *v, double dt,
                                double *force, cdem_fault *fault) {
  cdem_contact_store *s = contact->store;
  s->v = v;
  s->dt = dt;
  CDEM_TRY(prepare(contact, u, fault));
  CDEM_TRY(find_contacts(contact, fault));
  s->contacts = 0;
  for (int32_t i = 0; i < s->live; i++) {
    int32_t p = s->live_point[i];
    for (int64_t t = s->slot_start[p]; t < s->slot_start[p + 1] && s->busy[i]; t++)
      if (s->slot_touch[t] >= 0)
        add_touch(s, &s->pool[s->slot_touch[t]], force);
  }
  for (int64_t i = 0; i < s->edge_pairs; i++)
    if (s->edge_busy[i])
      add_touch(s, &s->pool[s->edge_touch[i]], force);
  for (int32_t f = 0; f < s->facets; f++)
    s->active[s->facet[f]] = CDEM_ACTIVE;
  s->v = NULL;
  return CDEM_OK;
}

void cdem_contact_sum(const cdem_contact *contact, cdem_contact_totals *totals) {
  const cdem_contact_store *s = contact->store;
  memset(totals, 0, sizeof *totals);
  totals->friction = s->friction;
  totals->damping = s->damping;
  totals->contacts = s->contacts;
  totals->rebuilds = s->rebuilds;
  totals->visits = s->visits;
  if (s->slot_start == NULL)
    return;
  totals->candidates = s->candidate_start[s->surface_nodes] + s->edge_pairs;
  for (int64_t i = 0; i < s->slot_start[s->points]; i++) {
    const cdem_touch *t = cdem_touch_of(s, s->slot_touch[i]);
    totals->stored += t != NULL ? t->stored : 0.0;
  }
  for (int64_t i = 0; i < s->edge_pairs; i++) {
    const cdem_touch *t = cdem_touch_of(s, s->edge_touch[i]);
    totals->stored += t != NULL ? t->stored : 0.0;
  }
}
