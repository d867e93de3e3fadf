/* Forces of a membrane, ring by ring, and what they say of its stiffness and shape. */
#include "base/mat3.h"
#include "base/simd.h"
#include "dem/membrane_store.h"

#include <math.h>
#include <string.h>

/* ---- first look: faces above a ring, its mean, its differences ---- */

CDEM_ALWAYS_INLINE void mean_of_ring(cdem_membrane *m, int32_t ring) {
  double *mean = m->store->mean + 6 * (int64_t)ring, sum[6] = {0};
  for (int64_t i = (int64_t)ring * m->around; i < (int64_t)(ring + 1) * m->around; i++)
    for (int c = 0; c < 3; c++) {
      sum[c] += m->x[3 * i + c];
      sum[3 + c] += m->v[3 * i + c];
    }
  for (int c = 0; c < 6; c++)
    mean[c] = sum[c] / m->around;
}

static double plane_modulus(const cdem_membrane_options *o) {
  return o->young * o->thickness / (1.0 - o->poisson * o->poisson);
}

/* Area vector; and with a stiffness the St Venant-Kirchhoff forces: F = edges * inverse, E = (F^T F
 * - 1)/2, S = t Y/(1 - nu^2) ((1 - nu) E + nu tr E 1), forces on corners 1, 2: -A F S inverse^T. */
CDEM_ALWAYS_INLINE void look_face(cdem_membrane *m, int64_t f, double plane) {
  const double nu = m->options.poisson;
  cdem_membrane_store *s = m->store;
  const int32_t *node = m->face + 3 * f;
  const double *a = m->x + 3 * (int64_t)node[0], *b = m->x + 3 * (int64_t)node[1],
               *c = m->x + 3 * (int64_t)node[2], *inverse = s->inverse + 4 * f;
  double u[3], w[3], first[3], second[3], *normal = s->normal + 3 * f, *pull = s->pull + 9 * f;
  for (int k = 0; k < 3; k++) {
    u[k] = b[k] - a[k];
    w[k] = c[k] - a[k];
    first[k] = u[k] * inverse[0];
    second[k] = u[k] * inverse[1] + w[k] * inverse[3];
  }
  cdem_cross3(u, w, normal);
  for (int k = 0; k < 3; k++)
    normal[k] *= 0.5;
  if (plane == 0.0)
    return;
  double e[3] = {0.5 * (cdem_dot3(first, first) - 1.0), 0.5 * (cdem_dot3(second, second) - 1.0),
                 0.5 * cdem_dot3(first, second)};
  double xx = plane * (e[0] + nu * e[1]), yy = plane * (e[1] + nu * e[0]);
  double xy = plane * (1.0 - nu) * e[2], area = s->rest[f];
  s->stored[f] = 0.5 * area * (e[0] * xx + e[1] * yy + 2.0 * e[2] * xy);
  for (int k = 0; k < 3; k++) {
    double px = first[k] * xx + second[k] * xy, py = first[k] * xy + second[k] * yy;
    pull[3 + k] = -area * (px * inverse[0] + py * inverse[1]);
    pull[6 + k] = -area * (py * inverse[3]);
    pull[k] = -(pull[3 + k] + pull[6 + k]);
  }
}

/* Of the pyramid from the low end of the axis. */
CDEM_ALWAYS_INLINE double volume_of_face(const cdem_membrane *m, int64_t f) {
  const double *a = m->x + 3 * (int64_t)m->face[3 * f];
  const double r[3] = {a[0] - m->options.center[0], a[1] - m->options.center[1],
                       a[2] - m->options.low};
  return cdem_dot3(m->store->normal + 3 * f, r) / 3.0;
}

/* g: square of the radius at rest over the mean square distance from the axis now. */
CDEM_ALWAYS_INLINE double ring_size(cdem_membrane *m, int32_t ring) {
  const double *mean = m->store->mean + 6 * (int64_t)ring;
  double sum = 0.0;
  for (int64_t i = (int64_t)ring * m->around; i < (int64_t)(ring + 1) * m->around; i++)
    for (int c = 0; c < 2; c++)
      sum += (m->x[3 * i + c] - mean[c]) * (m->x[3 * i + c] - mean[c]);
  return sum / m->around;
}

/* Of places (from 0) or velocities (from 3). */
CDEM_ALWAYS_INLINE void difference(const cdem_membrane *m, int64_t i, int count, const double *of,
                                   const double *mean, double out[3]) {
  const int32_t *near = m->store->near + CDEM_MEMBRANE_NEAR * i;
  const double *own = of + 3 * i;
  double round = m->store->round[count > 2];
  for (int c = 0; c < 3; c++)
    out[c] = round * (own[c] - mean[c]) - count * own[c];
  for (int k = 0; k < count; k++)
    for (int c = 0; c < 3; c++)
      out[c] += of[3 * (int64_t)near[k] + c];
}

/* Differences of a ring by their stiffness. E of what is across the axis goes with g, and g with
 * the size of the ring: -dE/dx_i = 2 E/(n r^2) (x_i - mean) outwards. */
CDEM_ALWAYS_INLINE void bend_ring(cdem_membrane *m, int32_t ring) {
  cdem_membrane_store *s = m->store;
  int64_t from = (int64_t)ring * m->around, to = from + m->around;
  bool end = ring == 0 || ring == m->rings - 1;
  int count = end ? 2 : CDEM_MEMBRANE_NEAR;
  const double *mean = s->mean + 6 * (int64_t)ring;
  double square = ring_size(m, ring), energy = 0.0;
  double g = m->options.radius * m->options.radius / square;
  for (int64_t i = from; i < to; i++) {
    double *bent = s->bent + 3 * i, *rate = s->rate + 3 * i, d[3], way[3];
    difference(m, i, count, m->x, mean, d);
    difference(m, i, count, m->v, mean + 3, way);
    energy += 0.5 * s->stiff[!end] * g * (d[0] * d[0] + d[1] * d[1]);
    for (int c = 0; c < 3; c++) {
      bent[c] = s->stiff[!end] * (c < 2 ? g : 1.0) * d[c];
      rate[c] = s->dash[!end] * way[c];
    }
  }
  s->size[2 * ring] = g;
  s->size[2 * ring + 1] = 2.0 * energy / (m->around * square);
}

CDEM_MULTIVERSION void cdem_membrane_look(cdem_membrane *m, int32_t ring) {
  int64_t from = (int64_t)ring * m->around, to = from + m->around;
  double plane = plane_modulus(&m->options), volume = 0.0;
  for (int64_t f = 2 * from; ring + 1 < m->rings && f < 2 * to; f++) {
    look_face(m, f, plane);
    volume += volume_of_face(m, f);
  }
  m->store->band[ring] = volume;
  mean_of_ring(m, ring);
  if (m->options.bending != 0.0)
    bend_ring(m, ring);
}

/* ---- then: forces of its nodes ---- */

/* Minus the gradient: what is bent counts of itself, and against that of who has it as neighbour;
 * the part with the ring's mean falls to all of the ring alike. */
CDEM_ALWAYS_INLINE void bend(cdem_membrane *m, int64_t i, const double sum[6], double force[3]) {
  const cdem_membrane_store *s = m->store;
  const int32_t *taker = s->taker + CDEM_MEMBRANE_NEAR * i;
  const double *mean = s->mean + 6 * (i / m->around), *bent = s->bent, *rate = s->rate;
  double *damp = m->store->damp + 3 * i, swell = s->size[2 * (i / m->around) + 1];
  bool end = cdem_membrane_is_end(m, (int32_t)i);
  double round = s->round[!end], own = (end ? 2.0 : CDEM_MEMBRANE_NEAR) - round;
  for (int c = 0; c < 3; c++) {
    force[c] = own * bent[3 * i + c] + round * sum[c];
    damp[c] = own * rate[3 * i + c] + round * sum[3 + c];
  }
  for (int k = 0; k < CDEM_MEMBRANE_NEAR && taker[k] >= 0; k++)
    for (int c = 0; c < 3; c++) {
      force[c] -= bent[3 * (int64_t)taker[k] + c];
      damp[c] -= rate[3 * (int64_t)taker[k] + c];
    }
  for (int c = 0; c < 2; c++)
    force[c] += swell * (m->x[3 * i + c] - mean[c]);
}

CDEM_ALWAYS_INLINE void mean_moment(const cdem_membrane *m, int32_t ring, double mean[6]) {
  memset(mean, 0, 6 * sizeof *mean);
  for (int64_t i = (int64_t)ring * m->around; i < (int64_t)(ring + 1) * m->around; i++)
    for (int c = 0; c < 3; c++) {
      mean[c] += m->store->bent[3 * i + c];
      mean[3 + c] += m->store->rate[3 * i + c];
    }
  for (int c = 0; c < 6; c++)
    mean[c] /= m->around;
}

CDEM_ALWAYS_INLINE void normal_of(const cdem_membrane *m, int64_t node, double normal[3]) {
  const int32_t *corner = m->store->corner + CDEM_MEMBRANE_NEAR * node;
  normal[0] = normal[1] = normal[2] = 0.0;
  for (int k = 0; k < CDEM_MEMBRANE_NEAR && corner[k] >= 0; k++)
    for (int c = 0; c < 3; c++)
      normal[c] += m->store->normal[3 * (int64_t)(corner[k] / 3) + c];
  for (int c = 0; c < 3; c++)
    normal[c] /= 3.0;
}

void cdem_membrane_normal(const cdem_membrane *m, int32_t node, double normal[3]) {
  normal_of(m, node, normal);
}

CDEM_MULTIVERSION void cdem_membrane_gather(cdem_membrane *m, int32_t ring) {
  cdem_membrane_store *s = m->store;
  double mean[6];
  bool bends = m->options.bending != 0.0, stretches = m->options.young != 0.0;
  if (bends)
    mean_moment(m, ring, mean);
  for (int64_t i = (int64_t)ring * m->around; i < (int64_t)(ring + 1) * m->around; i++) {
    const int32_t *corner = s->corner + CDEM_MEMBRANE_NEAR * i;
    double force[3] = {0}, normal[3], *press = s->press + 3 * i;
    if (bends)
      bend(m, i, mean, force);
    for (int k = 0; stretches && k < CDEM_MEMBRANE_NEAR && corner[k] >= 0; k++)
      for (int c = 0; c < 3; c++)
        force[c] += s->pull[3 * (int64_t)corner[k] + c];
    normal_of(m, i, normal);
    for (int c = 0; c < 3; c++) {
      press[c] = -m->pressure * normal[c];
      m->force[3 * i + c] = force[c] + press[c] + s->damp[3 * i + c] + m->contact[3 * i + c];
    }
  }
}

void cdem_membrane_set_time(cdem_membrane *m, double time) {
  m->pressure = cdem_series_at(&m->options.pressure, time);
}

void cdem_membrane_evaluate(cdem_membrane *m, double time) {
  cdem_membrane_set_time(m, time);
  for (int32_t k = 0; k < m->rings; k++)
    cdem_membrane_look(m, k);
  for (int32_t k = 0; k < m->rings; k++)
    cdem_membrane_gather(m, k);
}

/* ---- bounds ---- */

/* Of the differences: |D| <= (12 + 2 c) |x| by rows and by columns. Of a face: its trace at rest,
 * sum of |grad N|^2 times the plane moduli, four times that at a stretch of 2. Of the pressure:
 * each corner's force changes by at most p/2 the edge per movement. A node has six faces. */
void cdem_membrane_bounds(const cdem_membrane *m, double *k, double *c) {
  const cdem_membrane_options *o = &m->options;
  const cdem_membrane_store *s = m->store;
  double plane = plane_modulus(o), most = 0.0;
  double least = m->mass[0], bend = 12.0 + 2.0 * s->round[1];
  for (int32_t f = 0; f < m->faces; f++) {
    const double *i = s->inverse + 4 * (int64_t)f;
    double slope =
        i[0] * i[0] + i[1] * i[1] + i[3] * i[3] + (i[0] * i[0] + (i[1] + i[3]) * (i[1] + i[3]));
    most = fmax(most, s->rest[f] * plane * (1.0 + 0.5 * (1.0 - o->poisson)) * slope);
  }
  for (int32_t i = 0; i < m->nodes; i++)
    least = fmin(least, m->mass[i]);
  double stiff = bend * bend * fmax(s->stiff[0], s->stiff[1]) + 6.0 * 4.0 * most +
                 3.0 * fabs(m->pressure) * m->spacing;
  *k = stiff / least;
  *c = bend * bend * fmax(s->dash[0], s->dash[1]) / least;
}

/* ---- shape ---- */

/* A triangle's part of the volume about the low end of the axis, and of its rate. */
static void add_triangle(const cdem_membrane *m, const double *const x[3], const double *const v[3],
                         cdem_membrane_shape *shape) {
  double u[3], w[3], n[3];
  const double r[3] = {x[0][0] - m->options.center[0], x[0][1] - m->options.center[1],
                       x[0][2] - m->options.low};
  for (int c = 0; c < 3; c++) {
    u[c] = x[1][c] - x[0][c];
    w[c] = x[2][c] - x[0][c];
  }
  cdem_cross3(u, w, n);
  shape->volume += cdem_dot3(n, r) / 6.0;
  for (int c = 0; c < 3; c++)
    shape->rate += n[c] * (v[0][c] + v[1][c] + v[2][c]) / 6.0;
}

/* An end of the tube, as a fan around its middle. */
static void add_end(const cdem_membrane *m, int32_t ring, cdem_membrane_shape *shape) {
  const double *mean = m->store->mean + 6 * (int64_t)ring;
  for (int32_t j = 0; j < m->around; j++) {
    int64_t a = (int64_t)ring * m->around + j, b = (int64_t)ring * m->around + (j + 1) % m->around;
    if (ring == 0) {
      int64_t swap = a;
      a = b;
      b = swap;
    }
    const double *const x[3] = {mean, m->x + 3 * a, m->x + 3 * b};
    const double *const v[3] = {mean + 3, m->v + 3 * a, m->v + 3 * b};
    add_triangle(m, x, v, shape);
  }
}

double cdem_membrane_volume(const cdem_membrane *m) {
  cdem_membrane_shape ends = {0};
  double sum = 0.0;
  for (int32_t k = 0; k + 1 < m->rings; k++)
    sum += m->store->band[k];
  add_end(m, 0, &ends);
  add_end(m, m->rings - 1, &ends);
  return sum + ends.volume;
}

/* Weighed by sin^2 along the tube: what bending hands on from a ring to those near it then changes
 * little, and the ends do not count. */
static double lateral_of(const cdem_membrane *m) {
  const double pi = 3.14159265358979323846;
  double push = 0.0, shadow = 0.0;
  for (int64_t i = 0; i < m->nodes; i++) {
    int64_t ring = i / m->around;
    const double *mean = m->store->mean + 6 * ring;
    double normal[3], weight = sin(pi * (double)ring / (m->rings - 1));
    normal_of(m, i, normal);
    for (int c = 0; c < 2; c++) {
      double rho = weight * weight * (m->x[3 * i + c] - mean[c]);
      push += m->contact[3 * i + c] * rho;
      shadow += normal[c] * rho;
    }
  }
  return shadow > 0.0 ? push / shadow : 0.0;
}

void cdem_membrane_shape_now(const cdem_membrane *m, cdem_membrane_shape *shape) {
  const double *low = m->store->mean, *high = low + 6 * (int64_t)(m->rings - 1);
  *shape = (cdem_membrane_shape){.height = high[2] - low[2]};
  add_end(m, 0, shape);
  add_end(m, m->rings - 1, shape);
  shape->volume = cdem_membrane_volume(m);
  for (int32_t f = 0; f < m->faces; f++) {
    const int32_t *node = m->face + 3 * (int64_t)f;
    const double *normal = m->store->normal + 3 * (int64_t)f;
    shape->area += cdem_norm3(normal);
    for (int k = 0; k < 3; k++)
      shape->rate += cdem_dot3(normal, m->v + 3 * (int64_t)node[k]) / 3.0;
  }
  shape->lateral = lateral_of(m);
}
