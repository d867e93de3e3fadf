/* Points on faces: which facet, what share, and the law. */
#include "cdem/contact_store.h"

#include <math.h>

const cdem_contact_law *cdem_contact_law_between(const cdem_contact_store *s,
                                                 const cdem_blocks *blocks, int32_t slave,
                                                 int32_t master) {
  if (s->law_of == NULL)
    return &s->law[0];
  int a = s->colour != NULL ? s->colour[blocks->facet[slave].cell] : 0;
  int b = s->colour != NULL ? s->colour[blocks->facet[master].cell] : 0;
  return &s->law[1 + s->law_of[a * s->colours + b]];
}

/* From 0 where a facet stands at right angles to the master to 1 where it faces it within 70
 * degrees; flat faces and 45-degree corners lie on the plateau. */
enum { FACING_LOW = 5, FACING_HIGH = 35 }; /* hundredths, of the cosine */

static double facing_share(double facing) {
  return fmin(1.0, (100.0 * facing - FACING_LOW) / (FACING_HIGH - FACING_LOW));
}

/* 1 for faces within 18 degrees, 0 from 37 on. */
static double flat_share(double facing) {
  return fmin(1.0, fmax(0.0, (facing - 0.8) / 0.15));
}

/* Two-pass share: a half each. Where flat faces of different fineness meet, the finer side is the
 * slave (Hallquist's rule), since its points sample the common area well: from a half for equal
 * sizes to all at half the size. The shares of two sides add up to one. */
static double pass_share(double facing, double ratio) {
  double finer = fmin(1.0, fmax(0.0, 0.5 - 0.5 * log2(ratio)));
  return 0.5 + flat_share(facing) * (finer - 0.5);
}

static double share_of(const cdem_contact *contact, const cdem_contact_point *point, int32_t master,
                       const cdem_projection *p) {
  const cdem_contact_store *s = contact->store;
  double facing = -cdem_dot3(s->face[point->facet].normal, s->face[master].normal);
  /* Away from its corner a point stands for a flat facet only. */
  double beside = 1.0 - (1.0 - flat_share(facing)) * fmin(1.0, 10.0 * p->inset);
  return s->share[point->facet][point->corner] * facing_share(facing) *
         pass_share(facing, s->size[point->facet] / s->size[master]) * p->cover * beside;
}

/* The overlap one step ago: everything moves back by v dt. */
static double gap_before(const cdem_contact *contact, const cdem_contact_point *point,
                         int32_t master, const double own[4]) {
  const cdem_contact_store *s = contact->store;
  const cdem_facet *f = &contact->blocks->facet[master];
  double c[4][3], at[3] = {0.0};
  cdem_projection p;
  for (int k = 0; k < f->corners; k++)
    for (int i = 0; i < 3; i++)
      c[k][i] =
          s->x[3 * (int64_t)f->node[k] + i] -
          (s->v != NULL && i < s->dim ? s->dt * s->v[(int64_t)f->node[k] * s->dofs + i] : 0.0);
  const cdem_facet *slave = &contact->blocks->facet[point->facet];
  for (int k = 0; k < slave->corners; k++) {
    const double *v = s->v != NULL ? s->v + (int64_t)slave->node[k] * s->dofs : NULL;
    for (int i = 0; i < s->dim; i++)
      at[i] += own[k] * (s->x[3 * (int64_t)slave->node[k] + i] - (v != NULL ? s->dt * v[i] : 0.0));
  }
  cdem_contact_project(contact, master, (const double(*)[3])c, at, &p);
  return p.gap;
}

/* A contact begins at the surface: a point that is found deep below a face it never crossed came in
 * through another one (the side of a step, say). */
static bool may_begin(const cdem_contact *contact, const cdem_contact_point *point, int32_t master,
                      const cdem_projection *p) {
  const cdem_contact_store *s = contact->store;
  double shallow = 0.1 * fmin(s->size[master], s->size[point->facet]);
  if (p->gap <= shallow || s->active[master] == CDEM_FRESH || s->active[point->facet] == CDEM_FRESH)
    return true;
  return gap_before(contact, point, master, p->own) <= shallow;
}

static int64_t slot_of(const cdem_contact_store *s, int32_t point, int32_t component) {
  int64_t i = s->slot_start[point];
  while (s->slot_component[i] != component)
    i++;
  return i;
}

static void try_facet(cdem_contact *contact, int32_t point, int32_t master, double floor,
                      cdem_projection *best) {
  cdem_contact_store *s = contact->store;
  const cdem_contact_point *p = &s->point[point];
  const double *at = s->x + 3 * (int64_t)p->node;
  const cdem_contact_face *face = &s->face[master];
  if (-100.0 * cdem_dot3(s->face[p->facet].normal, face->normal) <= FACING_LOW)
    return;
  double r[3] = {at[0] - face->centre[0], at[1] - face->centre[1], at[2] - face->centre[2]};
  double near = -cdem_dot3(r, face->normal), size = fmin(s->size[master], s->size[p->facet]);
  double far = face->radius + fmax(size, 1.5 * s->patch[p->facet]);
  if (near + face->warp <= floor || cdem_dot3(r, r) > near * near + far * far)
    return;
  double corner[4][3];
  cdem_projection q;
  cdem_contact_corners(contact, master, corner);
  if (!cdem_contact_place(contact, p, master, (const double(*)[3])corner, &q) || q.outside > size)
    return;
  /* In a concave edge the foot may leave both faces by as much as the point is inside. */
  if (q.gap <= floor || q.beyond > fmax(1e-9 * size, fabs(q.gap)))
    return;
  int64_t slot = slot_of(s, point, s->component[master]);
  const cdem_touch *touch = cdem_touch_of(s, s->slot_touch[slot]);
  if (q.gap > s->depth[master]) {
    if (q.outside == 0.0 &&
        ((touch != NULL && touch->facet == master) || gap_before(contact, p, master, q.own) <= 0.0))
      s->deep[slot] = master;
    return;
  }
  double score = q.gap * q.gap + q.outside * q.outside;
  if (s->trial[slot] >= 0 && score >= s->score[slot])
    return;
  if (touch == NULL && !may_begin(contact, p, master, &q))
    return;
  s->trial[slot] = master;
  s->score[slot] = score;
  int64_t place = slot - s->slot_start[point];
  if (best != NULL && place < CDEM_CONTACT_BEST)
    best[place] = q;
}

void cdem_contact_look(cdem_contact *contact, int32_t point, double floor, cdem_projection *best) {
  cdem_contact_store *s = contact->store;
  int32_t surface = s->point[point].surface;
  for (int64_t i = s->slot_start[point]; i < s->slot_start[point + 1]; i++)
    s->trial[i] = s->deep[i] = -1;
  for (int64_t c = s->candidate_start[surface]; c < s->candidate_start[surface + 1]; c++)
    try_facet(contact, point, s->candidate[c], floor, best);
}

/* Mass per area of the two surfaces in series. */
static double surface_mass(const cdem_contact *contact, const cdem_contact_point *point,
                           const cdem_facet *master, const double shape[4]) {
  const cdem_contact_store *s = contact->store;
  double a = s->mass[(int64_t)point->node * s->dofs] / s->node_area[point->node], b = 0.0;
  for (int k = 0; k < master->corners; k++)
    b += fmax(0.0, shape[k]) * s->mass[(int64_t)master->node[k] * s->dofs] /
         s->node_area[master->node[k]];
  return a * b > 0.0 ? a * b / (a + b) : 0.0;
}

/* How far the foot has moved over the master since the last step, in the geometry of now, but for
 * the point's own motion in its facet. */
static void slip_since(const cdem_contact *contact, const cdem_contact_point *point,
                       const cdem_touch *t, const cdem_projection *p, double slip[3]) {
  const cdem_contact_store *s = contact->store;
  const cdem_facet *old = &contact->blocks->facet[t->facet];
  const cdem_facet *own = &contact->blocks->facet[point->facet];
  for (int i = 0; i < 3; i++) {
    slip[i] = p->foot[i];
    for (int k = 0; k < own->corners; k++)
      slip[i] -= (p->own[k] - t->own[k]) * s->x[3 * (int64_t)own->node[k] + i];
    for (int k = 0; k < old->corners; k++)
      slip[i] -= t->shape[k] * s->x[3 * (int64_t)old->node[k] + i];
  }
  double off = cdem_dot3(slip, p->normal);
  for (int i = 0; i < 3; i++)
    slip[i] -= off * p->normal[i];
}

static double overlap_rate(const cdem_contact_store *s, const cdem_contact_input *in) {
  double rate = 0.0;
  if (s->v == NULL)
    return 0.0;
  for (int k = 0; k < in->nodes; k++)
    for (int i = 0; i < s->dim; i++)
      rate -= in->coefficient[k] * in->normal[i] * s->v[(int64_t)in->node[k] * s->dofs + i];
  return rate;
}

/* Nodes and coefficients: the master's with -N, then the slave or its facet. */
static void fill_nodes(const cdem_contact *contact, const cdem_contact_point *point,
                       const cdem_facet *f, const double shape[4], const double own[4],
                       cdem_contact_input *in) {
  const cdem_facet *slave = &contact->blocks->facet[point->facet];
  int n = f->corners;
  for (int k = 0; k < n; k++) {
    in->node[k] = f->node[k];
    in->coefficient[k] = -shape[k];
  }
  for (int k = 0; k < slave->corners; k++) {
    if (own[k] == 0.0)
      continue;
    in->node[n] = slave->node[k];
    in->coefficient[n++] = own[k];
  }
  in->nodes = n;
}

double cdem_contact_lever(const cdem_contact *contact, const cdem_contact_point *point,
                          int32_t master, cdem_touch *t) {
  double corner[4][3], shape[4];
  cdem_projection p;
  cdem_contact_input in = {0};
  cdem_contact_corners(contact, master, corner);
  if (!cdem_contact_place(contact, point, master, (const double(*)[3])corner, &p))
    return 0.0;
  cdem_contact_shapes(contact, master, (const double(*)[3])corner, &p, shape, in.gradient);
  fill_nodes(contact, point, &contact->blocks->facet[master], shape, p.own, &in);
  t->nodes = (uint8_t)in.nodes;
  for (int k = 0; k < in.nodes; k++) {
    t->node[k] = in.node[k];
    t->nodal[k / 3][k % 3] = in.coefficient[k];
  }
  return share_of(contact, point, master, &p);
}

static void press(cdem_contact *contact, const cdem_contact_point *point, int32_t master,
                  const cdem_projection *p, cdem_touch *t) {
  cdem_contact_store *s = contact->store;
  const cdem_facet *f = &contact->blocks->facet[master];
  double corner[4][3], shape[4];
  cdem_contact_input in = {
      .law = cdem_contact_law_between(s, contact->blocks, point->facet, master), .gap = p->gap};
  in.weight = share_of(contact, point, master, p);
  in.whole = in.weight / p->cover;
  if (!(in.weight > 0.0)) {
    if (t->facet >= 0)
      cdem_touch_end(contact, t);
    return;
  }
  cdem_contact_corners(contact, master, corner);
  cdem_contact_shapes(contact, master, (const double(*)[3])corner, p, shape, in.gradient);
  fill_nodes(contact, point, f, shape, p->own, &in);
  for (int i = 0; i < 3; i++)
    in.normal[i] = p->normal[i];
  in.rate = overlap_rate(s, &in);
  in.surface_mass = surface_mass(contact, point, f, shape);
  if (t->facet >= 0)
    slip_since(contact, point, t, p, in.slip);
  cdem_touch_update(contact, &in, master, t);
  for (int k = 0; k < 4; k++) {
    t->shape[k] = shape[k];
    t->own[k] = p->own[k];
  }
  for (int i = 0; i < 3; i++)
    t->position[i] = p->foot[i];
}

/* Every slot that is tried has room for its contact; false: the pool is full. */
static bool find_room(cdem_contact_store *s, int64_t from, int64_t to) {
  for (int64_t i = from; i < to; i++)
    if (s->trial[i] >= 0 && s->slot_touch[i] < 0 && (s->slot_touch[i] = cdem_contact_take(s)) < 0)
      return false;
  return true;
}

static void step_slot(cdem_contact *contact, int32_t point, int64_t i,
                      const cdem_projection *known) {
  cdem_contact_store *s = contact->store;
  cdem_touch *t = &s->pool[s->slot_touch[i]];
  t->friction = t->damping = 0.0;
  if (s->trial[i] < 0) {
    if (t->facet >= 0 && s->deep[i] < 0)
      cdem_touch_end(contact, t);
    return;
  }
  double corner[4][3];
  cdem_projection other;
  if (known == NULL) {
    cdem_contact_corners(contact, s->trial[i], corner);
    cdem_contact_place(contact, &s->point[point], s->trial[i], (const double(*)[3])corner, &other);
  }
  press(contact, &s->point[point], s->trial[i], known != NULL ? known : &other, t);
}

int64_t cdem_contact_point_step(cdem_contact *contact, int32_t live) {
  cdem_contact_store *s = contact->store;
  int32_t point = s->live_point[live];
  int64_t failed = -1, first = s->slot_start[point], end = s->slot_start[point + 1];
  cdem_projection best[CDEM_CONTACT_BEST];
  cdem_contact_look(contact, point, 0.0, best);
  s->busy[live] = 0;
  if (!find_room(s, first, end)) {
    s->busy[live] = CDEM_DEFERRED;
    return -1;
  }
  for (int64_t i = first; i < end; i++) {
    if (s->deep[i] >= 0 && s->trial[i] < 0)
      failed = i;
    if (s->slot_touch[i] < 0)
      continue;
    s->busy[live] = CDEM_BUSY;
    step_slot(contact, point, i, i - first < CDEM_CONTACT_BEST ? &best[i - first] : NULL);
  }
  return failed;
}
