/* Grains against facets that may meet.
 *
 * What counts as one contact: a local minimum of the distance from the grain's centre to the whole
 * surface. The nearest point q of a facet is one unless q also belongs to a facet g that has a
 * nearer point p: facets are convex, so on the way from q to p in g the distance falls. From this
 * one rule follows what is wanted of edges and corners: on a flat floor, however it is cut into
 * triangles and whether or not their corners meet, only the triangle under the centre is felt; an
 * edge that stands out is felt once, though two facets share it; a valley is felt on both its
 * sides. (Known eliminations, as of Hu et al. 2013, sort by kind of contact, face before edge
 * before corner; sorting by distance needs no kinds and no topology.)
 *
 * In a valley so flat that its bottom, too, is inside the grain, both sides are one patch of
 * contact, and the second would appear at full force. Its overlap is counted only from the bottom:
 * d_s - d instead of r - d, with d_s the distance of the line where the two planes meet. So the
 * force grows from zero, and the rule is silent (d_s > r) in every sharper valley.
 *
 * History belongs to a facet while its contact lasts and is handed on when the contact goes over to
 * another facet: to a fresh contact from a lost one whose point was close to its own. */
#include "dem/wall_mesh.h"

#include <string.h>

enum { NEAR_FACETS = 64 };

/* ---- one facet ---- */

/* Nearest point to p on the segment s, s + e, both about the corner a: its squared distance. */
static inline double on_segment(const double s[3], const double e[3], double inverse,
                                const double p[3], double q[3]) {
  double t = ((p[0] - s[0]) * e[0] + (p[1] - s[1]) * e[1] + (p[2] - s[2]) * e[2]) * inverse;
  t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
  double square = 0.0;
  for (int c = 0; c < 3; c++) {
    q[c] = s[c] + t * e[c];
    square += (q[c] - p[c]) * (q[c] - p[c]);
  }
  return square;
}

/* How far p, about the corner a, lies out of each edge; the furthest. */
static inline double out_of(int dim, const cdem_wall_facet *f, const double p[3], double out[3]) {
  if (dim == 2) {
    double t = cdem_dot3(p, f->e[0]) * f->inverse[0];
    out[0] = t < 0.0 || t > 1.0 ? 1.0 : -1.0;
    return out[0] > 0.0 ? 0.0 : -1.0; /* the ends tell how far */
  }
  out[0] = cdem_dot3(p, f->out[0]);
  out[1] = cdem_dot3(p, f->out[1]);
  out[2] = cdem_dot3(p, f->out[2]) - f->offset;
  double most = out[0] > out[1] ? out[0] : out[1];
  return out[2] > most ? out[2] : most;
}

/* The nearest point of a triangle to a point beside it is on an edge that it is out of. */
static double on_border(int dim, const cdem_wall_facet *f, const double p[3], const double out[3],
                        double q[3]) {
  static const double origin[3] = {0.0, 0.0, 0.0};
  double least = INFINITY, point[3];
  for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
    if (!(out[k] > 0.0))
      continue;
    double square = on_segment(k == 2 ? f->e[0] : origin, f->e[k], f->inverse[k], p, point);
    if (square < least) {
      least = square;
      memcpy(q, point, sizeof point);
    }
  }
  return least;
}

bool cdem_facet_nearest(int dim, const cdem_wall_facet *f, const double x[3], double within,
                        cdem_facet_near *near) {
  double p[3] = {x[0] - f->a[0], x[1] - f->a[1], x[2] - f->a[2]}, out[3], q[3];
  double h = cdem_dot3(p, f->n);
  if (!(fabs(h) < within))
    return false;
  double beside = out_of(dim, f, p, out);
  near->inside = !(beside > 0.0) && (dim == 3 || out[0] < 0.0);
  if (near->inside) {
    near->distance = fabs(h);
    for (int c = 0; c < 3; c++) {
      near->n[c] = h >= 0.0 ? -f->n[c] : f->n[c];
      near->q[c] = x[c] - h * f->n[c];
    }
    return true;
  }
  if (h * h + beside * beside >= within * within)
    return false;
  double square = on_border(dim, f, p, out, q);
  if (!(square < within * within))
    return false;
  near->distance = sqrt(square);
  for (int c = 0; c < 3; c++) {
    near->n[c] = near->distance > 0.0 ? (q[c] - p[c]) / near->distance : f->n[c];
    near->q[c] = f->a[c] + q[c];
  }
  return true;
}

/* ---- all facets that a grain overlaps ---- */

typedef struct {
  int32_t slot;
  bool kept;
  double overlap;
  cdem_facet_near near;
} facet_contact;

/* The nearest NEAR_FACETS of them, by distance, the lower slot first where two are as near. */
static int overlapping(const cdem_wall_finding *finding, const double x[3],
                       facet_contact contact[NEAR_FACETS]) {
  const cdem_walls *walls = finding->store->walls;
  const cdem_wall_facets *mesh = walls->body[finding->wall].facets;
  cdem_facet_near near;
  int count = 0;
  for (int32_t slot = finding->from; slot < finding->to; slot++) {
    const cdem_wall_facet *facet = mesh->facet + walls->slots.facet[slot];
    if (!cdem_facet_nearest(mesh->dim, facet, x, finding->radius, &near) ||
        (count == NEAR_FACETS && !(near.distance < contact[count - 1].near.distance)))
      continue;
    int k = count < NEAR_FACETS ? count++ : count - 1;
    for (; k > 0 && contact[k - 1].near.distance > near.distance; k--)
      contact[k] = contact[k - 1];
    contact[k].slot = slot;
    contact[k].kept = true;
    contact[k].overlap = finding->radius - near.distance;
    contact[k].near = near;
  }
  return count;
}

/* The distance from x of the line where the planes of two facets meet, whose own distances are a
 * and b, cos the cosine of their directions. */
static double valley(double a, double b, double cosine) {
  double sine2 = (1.0 - cosine) * (1.0 + cosine);
  return sqrt((a * a + b * b - 2.0 * a * b * cosine) / sine2);
}

static void eliminate(const cdem_wall_finding *finding, int count, facet_contact *contact) {
  const cdem_walls *walls = finding->store->walls;
  const cdem_wall_facets *mesh = walls->body[finding->wall].facets;
  cdem_facet_near touched;
  for (int k = 1; k < count; k++) {
    facet_contact *c = contact + k;
    for (int j = 0; j < k && c->kept; j++) {
      const cdem_wall_facet *g = mesh->facet + walls->slots.facet[contact[j].slot];
      c->kept = !cdem_facet_nearest(mesh->dim, g, c->near.q, mesh->close, &touched);
    }
    for (int j = 0; j < k && c->kept; j++) {
      const facet_contact *g = contact + j;
      double cosine = cdem_dot3(c->near.n, g->near.n);
      if (!g->kept || !g->near.inside || !c->near.inside || !(cosine > 0.0) || !(cosine < 1.0))
        continue;
      double bottom = valley(c->near.distance, g->near.distance, cosine);
      if (bottom - c->near.distance < c->overlap)
        c->overlap = bottom - c->near.distance;
      c->kept = c->overlap > 0.0;
    }
  }
}

/* ---- history ---- */

static double apart2(const double a[3], const double b[3]) {
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return cdem_dot3(d, d);
}

/* The lost contact nearest to this fresh one; -1: none is close. Touching points of one grain lie
 * r |n - n'| apart, so a quarter of its radius is an angle of 15 degrees; in a step none moves by
 * more than a small part of that. */
static int32_t lost_near(const cdem_wall_finding *finding, const facet_contact *c) {
  const cdem_wall_slots *slots = &finding->store->walls->slots;
  double least = 0.0625 * finding->radius * finding->radius;
  int32_t best = -1;
  for (int32_t slot = finding->from; slot < finding->to; slot++) {
    if (slots->touch[slot] != 1)
      continue;
    double square = apart2(slots->last + 3 * (int64_t)slot, c->near.q);
    if (square < least) {
      least = square;
      best = slot;
    }
  }
  return best;
}

/* While it works, slots of contacts that go on hold 2 instead of 1. */
static void hand_on(const cdem_wall_finding *finding, int count, const facet_contact *contact) {
  cdem_wall_slots *slots = &finding->store->walls->slots;
  size_t histories = (size_t)finding->store->histories;
  for (int k = 0; k < count; k++)
    if (contact[k].kept && slots->touch[contact[k].slot] == 1)
      slots->touch[contact[k].slot] = 2;
  for (int k = 0; k < count; k++) {
    int32_t to = contact[k].slot, from;
    if (!contact[k].kept || slots->touch[to] == 2 || (from = lost_near(finding, contact + k)) < 0)
      continue;
    if (histories > 0)
      memcpy(slots->history + histories * (size_t)to, slots->history + histories * (size_t)from,
             histories * sizeof *slots->history);
    slots->touch[from] = 0;
    slots->touch[to] = 2;
  }
  for (int32_t slot = finding->from; slot < finding->to; slot++)
    slots->touch[slot] = slots->touch[slot] == 2;
  for (int k = 0; k < count; k++)
    if (contact[k].kept)
      memcpy(slots->last + 3 * (int64_t)contact[k].slot, contact[k].near.q, 3 * sizeof(double));
}

static int find(const cdem_wall_finding *finding, int room, cdem_wall_touch *touch) {
  cdem_wall_body *body = finding->store->walls->body + finding->wall;
  facet_contact contact[NEAR_FACETS];
  double x[3], p[3];
  for (int c = 0; c < 3; c++)
    p[c] = finding->x[c] - body->center[c];
  cdem_wall_turned_back(body->turn, p, x);
  int count = overlapping(finding, x, contact), found = 0, kept = 0;
  eliminate(finding, count, contact);
  for (int k = 0; k < count; k++)
    contact[k].kept = contact[k].kept && kept++ < room;
  hand_on(finding, count, contact);
  /* By facet, so that sums of forces do not hang on which contact is deeper. */
  for (int32_t last = -1; found < kept && found < room; found++) {
    const facet_contact *next = NULL;
    for (int k = 0; k < count; k++)
      if (contact[k].kept && contact[k].slot > last &&
          (next == NULL || contact[k].slot < next->slot))
        next = contact + k;
    touch[found].wall = finding->wall;
    touch[found].slot = last = next->slot;
    cdem_wall_turned(body->turn, next->near.n, touch[found].n);
    cdem_wall_fill(body, finding->x, finding->radius, next->near.distance, touch + found);
    touch[found].overlap = next->overlap;
  }
  return found;
}

/* The way of a point is an affine function of the point: no facet goes further than the furthest
 * corner of the box around them. */
static double moved(const cdem_wall_body *body) {
  const cdem_wall_facets *mesh = body->facets;
  double furthest = 0.0;
  for (int corner = 0; corner < 8; corner++) {
    double point[3], now[3], before[3];
    for (int c = 0; c < 3; c++)
      point[c] = corner >> c & 1 ? mesh->high[c] : mesh->low[c];
    cdem_wall_turned(body->turn, point, now);
    cdem_wall_turned(body->built_turn, point, before);
    for (int c = 0; c < 3; c++)
      now[c] += body->center[c] - body->built_center[c] - before[c];
    furthest = fmax(furthest, cdem_norm3(now));
  }
  return furthest;
}

const cdem_wall_kind cdem_wall_mesh_kind = {.name = "mesh",
                                            .check = cdem_wall_facets_check,
                                            .init = cdem_wall_facets_init,
                                            .release = cdem_wall_facets_release,
                                            .collect = cdem_wall_facets_collect,
                                            .find = find,
                                            .moved = moved};
