/* The mesh of a membrane and its sizes. */
#include "base/mat3.h"
#include "base/memory.h"
#include "dem/membrane_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---- sizes ---- */

void cdem_membrane_complete(cdem_membrane_options *o, double pressure, double diameter,
                            double density) {
  if (o->spacing == 0.0)
    o->spacing = diameter / 3.0;
  if (o->penalty == 0.0)
    o->penalty = 1000.0 * pressure / diameter;
  if (o->thickness == 0.0)
    o->thickness = diameter / 100.0;
  if (o->young == 0.0)
    o->young = 0.1 * (pressure * diameter) / o->thickness;
  if (o->bending == 0.0)
    o->bending = 0.1 * pressure * (diameter * diameter * diameter);
  if (o->areal_density == 0.0)
    o->areal_density = 0.5 * density * diameter;
  if (o->damping == 0.0)
    o->damping = 0.2;
  if (o->contact_damping == 0.0)
    o->contact_damping = 0.2;
}

static cdem_status check_size(double value, bool zero, const char *name, const char *unit,
                              cdem_fault *fault) {
  bool good = isfinite(value) && (zero ? value >= 0.0 : value > 0.0);
  CDEM_REQUIRE(good, fault, CDEM_INPUT, "the membrane has %s %g%s%s; it is %s", name, value,
               *unit != '\0' ? " " : "", unit, zero ? "not negative" : "positive");
  return CDEM_OK;
}

cdem_status cdem_membrane_check(const cdem_membrane_options *o, double diameter,
                                cdem_fault *fault) {
  CDEM_TRY(check_size(o->radius, false, "the radius", "m", fault));
  CDEM_TRY(check_size(o->high - o->low, false, "the height", "m", fault));
  CDEM_TRY(check_size(o->spacing, false, "the spacing", "m", fault));
  CDEM_TRY(check_size(o->areal_density, false, "the areal density", "kg/m2", fault));
  CDEM_TRY(check_size(o->penalty, false, "the penalty", "Pa/m", fault));
  CDEM_TRY(check_size(o->young, true, "Young's modulus", "Pa", fault));
  CDEM_TRY(check_size(o->thickness, o->young == 0.0, "the thickness", "m", fault));
  CDEM_TRY(check_size(o->bending, true, "the bending stiffness", "N m", fault));
  CDEM_TRY(check_size(o->damping, true, "the damping ratio", "", fault));
  CDEM_TRY(check_size(o->contact_damping, true, "the damping ratio of contacts", "", fault));
  CDEM_REQUIRE(o->poisson > -1.0 && o->poisson <= 0.5, fault, CDEM_INPUT,
               "the membrane has Poisson's ratio %g; it is above -1, at most 0.5", o->poisson);
  CDEM_REQUIRE(
      diameter <= 0.0 || o->spacing <= 0.5 * diameter * (1.0 + 1e-12), fault, CDEM_INPUT,
      "nodes of the membrane at %.4g m let grains of %.4g m through: between three of them "
      "a grain would sink in by more than 0.18 radii; take a spacing of at most %.4g m, "
      "better %.4g m",
      o->spacing, diameter, 0.5 * diameter, diameter / 3.0);
  double nodes = 2.0 * pi * o->radius / o->spacing * ((o->high - o->low) / o->spacing);
  CDEM_REQUIRE(nodes < 1e8, fault, CDEM_INPUT,
               "a membrane of %.3g nodes at %.4g m is too large; take a wider spacing", nodes,
               o->spacing);
  return CDEM_OK;
}

/* ---- mesh ---- */

static int32_t at(const cdem_membrane *m, int32_t ring, int32_t place) {
  int32_t n = m->around;
  return ring * n + (place % n + n) % n;
}

/* Nodes of the next (or last) ring beside node `place` of a ring: `place` + shift and the one
 * after; odd rings are half a spacing ahead. */
static int32_t beside(int32_t ring) {
  return ring % 2 == 0 ? -1 : 0;
}

static void place_nodes(cdem_membrane *m) {
  const cdem_membrane_options *o = &m->options;
  for (int32_t k = 0; k < m->rings; k++)
    for (int32_t j = 0; j < m->around; j++) {
      double turn = (2.0 * j + k % 2) / (2.0 * m->around), *x = m->x + 3 * (int64_t)at(m, k, j);
      x[0] = o->center[0] + o->radius * cos(2.0 * pi * turn);
      x[1] = o->center[1] + o->radius * sin(2.0 * pi * turn);
      x[2] = o->low + (o->high - o->low) * ((double)k / (m->rings - 1));
    }
  memcpy(m->start, m->x, (size_t)m->nodes * 3 * sizeof *m->x);
}

static void make_faces(cdem_membrane *m) {
  int32_t *f = m->face;
  for (int32_t k = 0; k + 1 < m->rings; k++)
    for (int32_t j = 0; j < m->around; j++, f += 6) {
      int32_t up = j + beside(k); /* the first of the two above node j */
      const int32_t two[6] = {at(m, k, j), at(m, k, j + 1),      at(m, k + 1, up + 1),
                              at(m, k, j), at(m, k + 1, up + 1), at(m, k + 1, up)};
      memcpy(f, two, sizeof two);
    }
}

static void make_near(cdem_membrane *m) {
  for (int32_t k = 0; k < m->rings; k++)
    for (int32_t j = 0; j < m->around; j++) {
      int32_t node = at(m, k, j), *near = m->store->near + CDEM_MEMBRANE_NEAR * (int64_t)node;
      bool end = cdem_membrane_is_end(m, node);
      int32_t side = j + beside(k);
      near[0] = at(m, k, j + 1);
      near[1] = at(m, k, j - 1);
      near[2] = end ? -1 : at(m, k + 1, side);
      near[3] = end ? -1 : at(m, k + 1, side + 1);
      near[4] = end ? -1 : at(m, k - 1, side);
      near[5] = end ? -1 : at(m, k - 1, side + 1);
      for (int c = 0; c < CDEM_MEMBRANE_NEAR; c++)
        m->store->corner[CDEM_MEMBRANE_NEAR * (int64_t)node + c] = -1;
    }
  for (int32_t c = 0; c < 3 * m->faces; c++) {
    int32_t *corner = m->store->corner + CDEM_MEMBRANE_NEAR * (int64_t)m->face[c];
    while (*corner >= 0)
      corner++;
    *corner = c;
  }
}

/* Node i stands in the D of its neighbours, but in that of an end ring only if it is in it. */
static void make_takers(cdem_membrane *m) {
  for (int64_t k = 0; k < CDEM_MEMBRANE_NEAR * (int64_t)m->nodes; k++)
    m->store->taker[k] = -1;
  for (int32_t i = 0; i < m->nodes; i++)
    for (int k = 0; k < CDEM_MEMBRANE_NEAR; k++) {
      int32_t near = m->store->near[CDEM_MEMBRANE_NEAR * (int64_t)i + k];
      if (near < 0)
        break;
      int32_t *taker = m->store->taker + CDEM_MEMBRANE_NEAR * (int64_t)near;
      while (*taker >= 0)
        taker++;
      *taker = i;
    }
}

/* Edges at rest in the plane of a face: the first along its first edge. */
static void rest_faces(cdem_membrane *m) {
  for (int32_t f = 0; f < m->faces; f++) {
    const int32_t *node = m->face + 3 * (int64_t)f;
    const double *a = m->x + 3 * (int64_t)node[0], *b = m->x + 3 * (int64_t)node[1],
                 *c = m->x + 3 * (int64_t)node[2];
    double u[3], w[3], n[3];
    for (int k = 0; k < 3; k++) {
      u[k] = b[k] - a[k];
      w[k] = c[k] - a[k];
    }
    cdem_cross3(u, w, n);
    double length = cdem_norm3(u), twice = cdem_norm3(n), along = cdem_dot3(u, w) / length;
    double *inverse = m->store->inverse + 4 * (int64_t)f; /* of [length along; 0 twice/length] */
    inverse[0] = 1.0 / length;
    inverse[1] = -along / twice;
    inverse[2] = 0.0;
    inverse[3] = length / twice;
    m->store->rest[f] = 0.5 * twice;
    for (int k = 0; k < 3; k++)
      m->area[node[k]] += 0.5 * twice / 3.0;
  }
}

/* Rings are alike, so one node of a kind stands for all. In an equilateral mesh of spacing s with
 * area A = s^2 sqrt(3)/2 a node, D = 3/2 s^2 (Laplacian): b D^2 = B A (Laplacian)^2 gives B/(3 A).
 * In an end ring D = s^2 w'' and half the area: 3 B/(8 A). */
static void set_bending(cdem_membrane *m) {
  const cdem_membrane_options *o = &m->options;
  cdem_membrane_store *s = m->store;
  double angle = 2.0 * pi / m->around;
  int32_t inner = m->rings > 2 ? m->around : 0;
  double area = m->rings > 2 ? m->area[inner] : 2.0 * m->area[0];
  s->round[0] = 2.0 * (1.0 - cos(angle));
  s->round[1] = s->round[0] + 4.0 * (1.0 - cos(0.5 * angle));
  s->stiff[0] = 0.375 * o->bending / area;
  s->stiff[1] = o->bending / (3.0 * area);
  for (int k = 0; k < 2; k++) /* the highest mode has |D| = 9 |x| inside, 4 |x| in an end ring */
    s->dash[k] = 2.0 * o->damping / (k == 0 ? 4.0 : 9.0) *
                 sqrt(s->stiff[k] * (k == 0 ? m->mass[0] : m->mass[inner]));
}

/* ---- all ---- */

static cdem_status allocate(cdem_membrane *m, cdem_fault *fault) {
  int64_t n = m->nodes, f = m->faces;
  CDEM_NEW(m->store, 1, fault);
  cdem_membrane_store *s = m->store;
  CDEM_NEW(m->face, 3 * f, fault);
  CDEM_NEW(m->start, 3 * n, fault);
  CDEM_NEW(m->x, 3 * n, fault);
  CDEM_NEW(m->v, 3 * n, fault);
  CDEM_NEW(m->force, 3 * n, fault);
  CDEM_NEW(m->contact, 3 * n, fault);
  CDEM_NEW(m->mass, n, fault);
  CDEM_NEW(m->area, n, fault);
  CDEM_NEW(s->near, CDEM_MEMBRANE_NEAR * n, fault);
  CDEM_NEW(s->corner, CDEM_MEMBRANE_NEAR * n, fault);
  CDEM_NEW(s->inverse, 4 * f, fault);
  CDEM_NEW(s->rest, f, fault);
  CDEM_NEW(s->pull, 9 * f, fault);
  CDEM_NEW(s->normal, 3 * f, fault);
  CDEM_NEW(s->stored, f, fault);
  CDEM_NEW(s->taker, CDEM_MEMBRANE_NEAR * n, fault);
  CDEM_NEW(s->size, 2 * (int64_t)m->rings, fault);
  CDEM_NEW(s->bent, 3 * n, fault);
  CDEM_NEW(s->rate, 3 * n, fault);
  CDEM_NEW(s->mean, 6 * (int64_t)m->rings, fault);
  CDEM_NEW(s->band, m->rings, fault);
  CDEM_NEW(s->press, 3 * n, fault);
  CDEM_NEW(s->damp, 3 * n, fault);
  CDEM_NEW(s->marked, 3 * n, fault);
  return CDEM_OK;
}

/* A tolerance of rounding, so that spacings that fit exactly do. */
static int32_t parts(double length, double part, int32_t least) {
  double count = ceil(length / part * (1.0 - 1e-12));
  return count < least ? least : (int32_t)count;
}

static int32_t around(const cdem_membrane_options *o) {
  return parts(2.0 * pi * o->radius, o->spacing, 6);
}

static int32_t rings(const cdem_membrane_options *o) {
  return 1 + parts(o->high - o->low, 0.5 * sqrt(3.0) * o->spacing, 2);
}

int64_t cdem_membrane_nodes(const cdem_membrane_options *options) {
  return (int64_t)rings(options) * around(options);
}

cdem_status cdem_membrane_create(const cdem_membrane_options *options, cdem_membrane *m,
                                 cdem_fault *fault) {
  *m = (cdem_membrane){.options = *options};
  CDEM_TRY(cdem_membrane_check(options, 0.0, fault));
  m->around = around(options);
  m->rings = rings(options);
  m->nodes = m->rings * m->around;
  m->faces = 2 * (m->rings - 1) * m->around;
  m->spacing = 2.0 * pi * options->radius / m->around;
  cdem_status status = allocate(m, fault);
  if (status != CDEM_OK) {
    cdem_membrane_release(m);
    return status;
  }
  place_nodes(m);
  make_faces(m);
  make_near(m);
  make_takers(m);
  rest_faces(m);
  for (int32_t i = 0; i < m->nodes; i++)
    m->mass[i] = options->areal_density * m->area[i];
  set_bending(m);
  cdem_membrane_mark(m);
  return CDEM_OK;
}

void cdem_membrane_release(cdem_membrane *m) {
  cdem_membrane_store *s = m->store;
  free(m->face);
  free(m->start);
  free(m->x);
  free(m->v);
  free(m->force);
  free(m->contact);
  free(m->mass);
  free(m->area);
  if (s != NULL) {
    free(s->near);
    free(s->corner);
    free(s->inverse);
    free(s->rest);
    free(s->pull);
    free(s->normal);
    free(s->stored);
    free(s->taker);
    free(s->size);
    free(s->bent);
    free(s->rate);
    free(s->mean);
    free(s->band);
    free(s->press);
    free(s->damp);
    free(s->marked);
    free(s);
  }
  *m = (cdem_membrane){0};
}
