/* Points against facets: planes, feet, shape functions and their gradients.
 *
 * A quadrilateral is four triangles around the mean of its corners, so that a warped one is still a
 * continuous surface and no diagonal is preferred; a triangle corner at the centre belongs to each
 * of the four corners by a quarter.
 */
#include "cdem/contact_store.h"

#include <math.h>

void cdem_contact_corners(const cdem_contact *contact, int32_t facet, double corner[4][3]) {
  const cdem_facet *f = &contact->blocks->facet[facet];
  for (int k = 0; k < f->corners; k++)
    for (int i = 0; i < 3; i++)
      corner[k][i] = contact->store->x[3 * (int64_t)f->node[k] + i];
}

static void unit(double a[3]) {
  double length = cdem_norm3(a);
  for (int i = 0; i < 3; i++)
    a[i] = length > 0.0 ? a[i] / length : 0.0;
}

/* Outward: in 2-D the interior is on the left of corner 0 -> corner 1. */
static void mean_normal(int corners, const double c[4][3], double normal[3]) {
  double a[3], b[3];
  int last = corners == 4 ? 3 : 1;
  int first = corners == 4 ? 1 : 0;
  if (corners == 2) {
    normal[0] = c[1][1] - c[0][1];
    normal[1] = c[0][0] - c[1][0];
    normal[2] = 0.0;
  } else {
    for (int i = 0; i < 3; i++) {
      a[i] = c[2][i] - c[0][i];
      b[i] = c[last][i] - c[first][i];
    }
    if (corners == 4)
      cdem_cross3(a, b, normal);
    else
      cdem_cross3(b, a, normal);
  }
  unit(normal);
}

void cdem_contact_face_now(const cdem_contact *contact, int32_t facet, cdem_contact_face *face) {
  double c[4][3];
  int corners = contact->blocks->facet[facet].corners;
  cdem_contact_corners(contact, facet, c);
  mean_normal(corners, (const double(*)[3])c, face->normal);
  for (int i = 0; i < 3; i++) {
    face->centre[i] = 0.0;
    for (int k = 0; k < corners; k++)
      face->centre[i] += c[k][i] / corners;
  }
  face->warp = face->radius = 0.0;
  for (int k = 0; k < corners; k++) {
    double r[3] = {c[k][0] - face->centre[0], c[k][1] - face->centre[1], c[k][2] - face->centre[2]};
    if (corners == 4)
      face->warp = fmax(face->warp, fabs(cdem_dot3(r, face->normal)));
    face->radius = fmax(face->radius, cdem_dot3(r, r));
  }
  face->radius = sqrt(face->radius);
}

/* Rows: two tangents and the normal of the facet as it lies now; they turn with it. */
void cdem_contact_axes(const cdem_contact *contact, int32_t facet, double axes[9]) {
  double c[4][3];
  int corners = contact->blocks->facet[facet].corners;
  cdem_contact_corners(contact, facet, c);
  mean_normal(corners, (const double(*)[3])c, axes + 6);
  for (int i = 0; i < 3; i++)
    axes[i] = corners == 4 ? c[1][i] + c[2][i] - c[0][i] - c[3][i] : c[1][i] - c[0][i];
  double along = cdem_dot3(axes, axes + 6);
  for (int i = 0; i < 3; i++)
    axes[i] -= along * axes[6 + i];
  unit(axes);
  cdem_cross3(axes + 6, axes, axes + 3);
}

static void segment(const double a[3], const double b[3], const double at[3], cdem_projection *p) {
  double t[3] = {b[0] - a[0], b[1] - a[1], 0.0}, r[3] = {at[0] - a[0], at[1] - a[1], 0.0};
  double length = cdem_norm3(t), along;
  unit(t);
  along = cdem_dot3(r, t);
  p->normal[0] = t[1];
  p->normal[1] = -t[0];
  p->normal[2] = 0.0;
  p->gap = -cdem_dot3(r, p->normal);
  p->lambda[1] = along / length;
  p->lambda[0] = 1.0 - p->lambda[1];
  p->lambda[2] = 0.0;
  p->beyond = fmax(0.0, fmax(-along, along - length));
  for (int i = 0; i < 3; i++)
    p->foot[i] = a[i] + along * t[i];
  p->part = 0;
}

/* Distance from q to the segment a b. */
static double to_segment(const double a[3], const double b[3], const double q[3]) {
  double t[3], r[3];
  for (int i = 0; i < 3; i++) {
    t[i] = b[i] - a[i];
    r[i] = q[i] - a[i];
  }
  double along = fmin(1.0, fmax(0.0, cdem_dot3(r, t) / cdem_dot3(t, t)));
  for (int i = 0; i < 3; i++)
    r[i] -= along * t[i];
  return cdem_norm3(r);
}

static void triangle(const double a[3], const double b[3], const double c[3], const double at[3],
                     cdem_projection *p) {
  double e[3], f[3], r[3], n[3], cross[3];
  for (int i = 0; i < 3; i++) {
    e[i] = b[i] - a[i];
    f[i] = c[i] - a[i];
    r[i] = at[i] - a[i];
  }
  cdem_cross3(e, f, n);
  double square = cdem_dot3(n, n), twice = sqrt(square);
  cdem_cross3(r, f, cross);
  p->lambda[1] = cdem_dot3(cross, n) / square;
  cdem_cross3(e, r, cross);
  p->lambda[2] = cdem_dot3(cross, n) / square;
  p->lambda[0] = 1.0 - p->lambda[1] - p->lambda[2];
  for (int i = 0; i < 3; i++)
    p->normal[i] = n[i] / twice;
  p->gap = -cdem_dot3(r, p->normal);
  for (int i = 0; i < 3; i++)
    p->foot[i] = at[i] + p->gap * p->normal[i];
  /* The nearest point lies on a side that the foot is beyond. */
  p->beyond = p->lambda[0] < 0.0 || p->lambda[1] < 0.0 || p->lambda[2] < 0.0 ? INFINITY : 0.0;
  if (p->beyond == 0.0)
    return;
  if (p->lambda[0] < 0.0)
    p->beyond = fmin(p->beyond, to_segment(b, c, p->foot));
  if (p->lambda[1] < 0.0)
    p->beyond = fmin(p->beyond, to_segment(c, a, p->foot));
  if (p->lambda[2] < 0.0)
    p->beyond = fmin(p->beyond, to_segment(a, b, p->foot));
}

static void centre_of(const double corner[4][3], double centre[3]) {
  for (int i = 0; i < 3; i++)
    centre[i] = 0.25 * ((corner[0][i] + corner[1][i]) + (corner[2][i] + corner[3][i]));
}

static bool is_flat(const cdem_contact_store *s, int32_t facet) {
  return s->face[facet].warp < 1e-9 * s->size[facet];
}

/* Which triangle of a flat quadrilateral the foot is in, seen from the centre. */
static int sector(const double c[4][3], const double centre[3], const double at[3]) {
  double a[3], b[3], normal[3], r[3], turn[4];
  for (int i = 0; i < 3; i++) {
    a[i] = c[2][i] - c[0][i];
    b[i] = c[3][i] - c[1][i];
    r[i] = at[i] - centre[i];
  }
  cdem_cross3(a, b, normal);
  cdem_cross3(normal, a, a);
  cdem_cross3(normal, b, b);
  turn[2] = cdem_dot3(a, r);
  turn[3] = cdem_dot3(b, r);
  turn[0] = -turn[2];
  turn[1] = -turn[3];
  /* with diagonals that meet in the centre; otherwise the triangle tells, and all are tried */
  for (int k = 0; k < 3; k++)
    if (turn[k] >= 0.0 && turn[k + 1] <= 0.0)
      return k;
  return 3;
}

void cdem_contact_project(const cdem_contact *contact, int32_t facet, const double corner[4][3],
                          const double at[3], cdem_projection *p) {
  int corners = contact->blocks->facet[facet].corners;
  if (corners == 2) {
    segment(corner[0], corner[1], at, p);
    return;
  }
  p->part = 0;
  if (corners == 3) {
    triangle(corner[0], corner[1], corner[2], at, p);
    return;
  }
  double centre[3], best = INFINITY;
  bool flat = is_flat(contact->store, facet);
  centre_of(corner, centre);
  if (flat) { /* most often inside: then one triangle is enough */
    p->part = sector(corner, centre, at);
    triangle(corner[p->part], corner[(p->part + 1) % 4], centre, at, p);
    if (p->beyond == 0.0)
      return;
  }
  for (int k = 0; k < 4; k++) {
    cdem_projection q;
    triangle(corner[k], corner[(k + 1) % 4], centre, at, &q);
    double square = q.beyond * q.beyond + q.gap * q.gap;
    if (square < best) {
      best = square;
      *p = q;
      p->part = k;
    }
    if (flat && q.beyond == 0.0)
      return;
  }
}

/* Shape functions of the corners, and their gradients in the plane: sum x (x) gradient is the
 * identity of the plane, so that the corrections of moments are exact. */
void cdem_contact_shapes(const cdem_contact *contact, int32_t facet, const double corner[4][3],
                         const cdem_projection *p, double shape[4], double gradient[4][3]) {
  int corners = contact->blocks->facet[facet].corners;
  double c[3][3], g[3][3] = {{0.0}};
  for (int k = 0; k < 4; k++) {
    shape[k] = 0.0;
    for (int i = 0; i < 3; i++)
      gradient[k][i] = 0.0;
  }
  if (corners == 2) {
    double square = 0.0;
    for (int i = 0; i < 3; i++)
      square += (corner[1][i] - corner[0][i]) * (corner[1][i] - corner[0][i]);
    for (int k = 0; k < 2; k++) {
      shape[k] = p->lambda[k];
      for (int i = 0; i < 3; i++)
        gradient[k][i] = (k == 1 ? 1.0 : -1.0) * (corner[1][i] - corner[0][i]) / square;
    }
    return;
  }
  int id[2] = {p->part, (p->part + 1) % corners};
  for (int i = 0; i < 3; i++) {
    c[0][i] = corner[id[0]][i];
    c[1][i] = corner[id[1]][i];
    c[2][i] = corner[2][i];
  }
  if (corners == 4)
    centre_of(corner, c[2]);
  double e[3], f[3], n[3];
  for (int i = 0; i < 3; i++) {
    e[i] = c[1][i] - c[0][i];
    f[i] = c[2][i] - c[0][i];
  }
  cdem_cross3(e, f, n);
  double twice = cdem_norm3(n);
  for (int k = 0; k < 3; k++) {
    double opposite[3];
    for (int i = 0; i < 3; i++)
      opposite[i] = c[(k + 2) % 3][i] - c[(k + 1) % 3][i];
    cdem_cross3(p->normal, opposite, g[k]);
  }
  for (int k = 0; k < corners; k++) {
    double part[3] = {k == id[0], k == id[1], corners == 4 ? 0.25 : (k == 2)};
    for (int m = 0; m < 3; m++) {
      shape[k] += part[m] * p->lambda[m];
      for (int i = 0; i < 3; i++)
        gradient[k][i] += part[m] * g[m][i] / twice;
    }
  }
}

/* ---- the part of a point's area that lies over the master ---- */

/* A corner of the patch, with the shape functions of the slave's facet there. */
typedef struct {
  double x[3], own[4];
} patch_corner;

typedef struct {
  int corners;
  patch_corner corner[9];
} patch_polygon;

static void add_corner(const double c[4][3], const double own[4], patch_polygon *polygon) {
  patch_corner *p = &polygon->corner[polygon->corners++];
  for (int i = 0; i < 3; i++)
    p->x[i] = 0.0;
  for (int k = 0; k < 4; k++) {
    p->own[k] = own[k];
    for (int i = 0; i < 3 && own[k] > 0.0; i++)
      p->x[i] += own[k] * c[k][i];
  }
}

/* Corner, middle of a side, middle of the facet, middle of the other side; 2-D: half of the side.
 */
static void make_patch(const double c[4][3], int n, int k, patch_polygon *polygon) {
  double own[4] = {0.0};
  polygon->corners = 0;
  own[k] = 1.0;
  add_corner(c, own, polygon);
  own[k] = own[(k + 1) % n] = 0.5;
  add_corner(c, own, polygon);
  if (n == 2)
    return;
  for (int i = 0; i < n; i++)
    own[i] = 1.0 / n;
  add_corner(c, own, polygon);
  for (int i = 0; i < n; i++)
    own[i] = 0.0;
  own[k] = own[(k + n - 1) % n] = 0.5;
  add_corner(c, own, polygon);
}

static void between(const patch_corner *a, const patch_corner *b, double t, patch_corner *to) {
  for (int i = 0; i < 3; i++)
    to->x[i] = a->x[i] + t * (b->x[i] - a->x[i]);
  for (int i = 0; i < 4; i++)
    to->own[i] = a->own[i] + t * (b->own[i] - a->own[i]);
}

/* Keeps what is on the inner side of a line (Sutherland and Hodgman 1974). */
static void clip(const double from[3], const double out[3], patch_polygon *polygon) {
  patch_polygon old = *polygon;
  int n = old.corners;
  polygon->corners = 0;
  for (int k = 0; k < n && (n > 2 || k < 2); k++) {
    const patch_corner *a = &old.corner[k], *b = &old.corner[(k + 1) % n];
    double off_a = 0.0, off_b = 0.0;
    for (int i = 0; i < 3; i++) {
      off_a += (a->x[i] - from[i]) * out[i];
      off_b += (b->x[i] - from[i]) * out[i];
    }
    if (off_a <= 0.0)
      polygon->corner[polygon->corners++] = *a;
    if ((off_a < 0.0 && off_b > 0.0) || (off_a > 0.0 && off_b < 0.0))
      if (n > 2 || k == 0)
        between(a, b, off_a / (off_a - off_b), &polygon->corner[polygon->corners++]);
  }
}

/* Area, of a patch in 2-D length. */
static double extent(const patch_polygon *p, bool plane) {
  double area[3] = {0.0}, a[3], b[3], cross[3];
  if (p->corners < (plane ? 2 : 3))
    return 0.0;
  for (int k = 2; k < p->corners; k++) {
    for (int i = 0; i < 3; i++) {
      a[i] = p->corner[k - 1].x[i] - p->corner[0].x[i];
      b[i] = p->corner[k].x[i] - p->corner[0].x[i];
    }
    cdem_cross3(a, b, cross);
    for (int i = 0; i < 3; i++)
      area[i] += 0.5 * cross[i];
  }
  if (!plane)
    return cdem_norm3(area);
  for (int i = 0; i < 3; i++)
    a[i] = p->corner[1].x[i] - p->corner[0].x[i];
  return cdem_norm3(a);
}

/* The point of the polygon nearest to `at`, which lies outside or on its edge. */
static void nearest(const patch_polygon *p, const double at[3], patch_corner *to) {
  double best = INFINITY;
  for (int k = 0; k < p->corners; k++) {
    const patch_corner *a = &p->corner[k], *b = &p->corner[(k + 1) % p->corners];
    double along = 0.0, square = 0.0, distance = 0.0;
    patch_corner c;
    for (int i = 0; i < 3; i++) {
      along += (at[i] - a->x[i]) * (b->x[i] - a->x[i]);
      square += (b->x[i] - a->x[i]) * (b->x[i] - a->x[i]);
    }
    between(a, b, square > 0.0 ? fmin(1.0, fmax(0.0, along / square)) : 0.0, &c);
    for (int i = 0; i < 3; i++)
      distance += (c.x[i] - at[i]) * (c.x[i] - at[i]);
    if (distance < best) {
      best = distance;
      *to = c;
    }
  }
}

/* Out of a side, in the plane; not of unit length. */
static void side_out(int corners, const double corner[4][3], int side, const double normal[3],
                     double out[3]) {
  double edge[3];
  int to = corners == 2 ? 1 - side : (side + 1) % corners;
  for (int i = 0; i < 3; i++)
    edge[i] = corner[to][i] - corner[side][i];
  if (corners == 2)
    for (int i = 0; i < 3; i++)
      out[i] = -edge[i];
  else
    cdem_cross3(edge, normal, out);
}

/* Which sharp sides cut the patch (bits); -1: nothing of it is over the master. Signs only, so that
 * most points of other places go away here. */
static int sides_that_cut(const cdem_contact_store *s, int32_t master, int corners,
                          const double corner[4][3], const double normal[3],
                          const patch_polygon *patch) {
  int cut = 0;
  for (int side = 0; side < corners; side++) {
    double out[3];
    int inside = 0, outside = 0;
    if (!(s->border[master] >> side & 1))
      continue;
    side_out(corners, corner, side, normal, out);
    for (int k = 0; k < patch->corners; k++) {
      double off = 0.0;
      for (int i = 0; i < 3; i++)
        off += (patch->corner[k].x[i] - corner[side][i]) * out[i];
      inside += off < 0.0;
      outside += off > 0.0;
    }
    if (inside == 0)
      return -1;
    cut |= (outside > 0) << side;
  }
  return cut;
}

bool cdem_contact_place(const cdem_contact *contact, const cdem_contact_point *point,
                        int32_t master, const double corner[4][3], cdem_projection *p) {
  const cdem_contact_store *s = contact->store;
  const double *at = s->x + 3 * (int64_t)point->node;
  int corners = contact->blocks->facet[master].corners, cut = 0;
  bool flat = is_flat(s, master);
  patch_polygon polygon;
  double c[4][3] = {{0.0}};
  if (!flat || s->border[master] == 0)
    cdem_contact_project(contact, master, corner, at, p);
  if (s->border[master] != 0) {
    cdem_contact_corners(contact, point->facet, c);
    make_patch((const double(*)[3])c, contact->blocks->facet[point->facet].corners, point->corner,
               &polygon);
    cut = sides_that_cut(s, master, corners, corner, flat ? s->face[master].normal : p->normal,
                         &polygon);
    if (cut < 0)
      return false;
    if (flat)
      cdem_contact_project(contact, master, corner, at, p);
  }
  p->outside = p->beyond;
  p->cover = 1.0;
  p->inset = 0.0;
  for (int k = 0; k < 4; k++)
    p->own[k] = k == point->corner;
  if (cut == 0)
    return true;
  double whole = extent(&polygon, corners == 2);
  for (int side = 0; side < corners && polygon.corners > 0; side++) {
    double out[3];
    if (!(cut >> side & 1))
      continue;
    side_out(corners, corner, side, p->normal, out);
    clip(corner[side], out, &polygon);
  }
  p->cover = extent(&polygon, corners == 2) / whole;
  if (!(p->cover > 0.0))
    return false;
  patch_corner near;
  nearest(&polygon, at, &near);
  if (near.own[point->corner] == 1.0)
    return true;
  double cover = p->cover, outside = p->outside;
  cdem_contact_project(contact, master, corner, near.x, p);
  p->cover = cover;
  p->outside = outside;
  p->inset = 1.0 - near.own[point->corner];
  for (int k = 0; k < 4; k++)
    p->own[k] = near.own[k];
  return true;
}
