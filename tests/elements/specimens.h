/* Elements and materials that the tests of this room run over: every element of the table, as it is
 * and distorted, with every material that fits its formulation. */
#ifndef CDEM_TESTS_ELEMENTS_SPECIMENS_H
#define CDEM_TESTS_ELEMENTS_SPECIMENS_H

#include "elements/elements.h"
#include "support/test.h"

enum { MAX_NODES = CDEM_SHAPE_MAX_NODES, MAX_SIZE = MAX_NODES * CDEM_MAX_DOFS };

static const cdem_section strain_section = {CDEM_PLANE_STRAIN, 0.7};
static const cdem_section stress_section = {CDEM_PLANE_STRESS, 1.3};

/* A rotation by `angle` about the axis (1, 2, 2)/3, or about z for plane elements. */
static inline void rotation(int dimension, double angle, double r[9]) {
  const double solid[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, plane[3] = {0, 0, 1};
  const double *n = dimension == 3 ? solid : plane;
  double c = cos(angle), s = sin(angle);
  const double cross[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[3 * i + j] = (i == j) * c + (1 - c) * n[i] * n[j] + s * cross[3 * i + j];
}

/* Nine materials: four classical ones (the last two in axes of their own), five of Cosserat, of
 * which the last three are made of contacts. */
enum { FIRST_COSSERAT = 4, FIRST_PACKING = 6, SPECIMENS = 9 };

static inline cdem_material specimen(int which) {
  cdem_material m = cdem_material_isotropic(30e9, 0.3);
  if (which == 1 || which == 2) {
    const double p[] = {40e9, 15e9, 10e9, 0.25, 0.3, 0.35, 6e9, 5e9, 4e9};
    m.model = CDEM_ORTHOTROPIC;
    memcpy(m.parameter, p, sizeof p);
    m.rotated = which == 2;
  }
  if (which == 3) {
    /* dominant diagonal: positive definite by Gershgorin */
    const double p[] = {50e9, 9e9,  8e9, 2e9, -1e9, 3e9, 40e9, 7e9,  -2e9, 1e9, 2e9,
                        30e9, -1e9, 2e9, 1e9, 12e9, 1e9, -2e9, 14e9, 1e9,  16e9};
    m.model = CDEM_ANISOTROPIC;
    memcpy(m.parameter, p, sizeof p);
    m.rotated = true;
  }
  if (which == 4) {
    const double p[] = {30e9, 0.2, 4e9, 0.4, 2.0};
    m.model = CDEM_COSSERAT;
    memcpy(m.parameter, p, sizeof p);
  }
  if (which == 5) {
    const double p[] = {20e9, -4e9, 8e9, 3e9, 1e9};
    m.model = CDEM_COSSERAT_CUBIC;
    memcpy(m.parameter, p, sizeof p);
  }
  if (which >= FIRST_PACKING) {
    /* Li & Wan 2010, table 1, with a rolling stiffness that weighs beside kn r^2 */
    const double p[] = {2.5e8, 5e7, 2e5, 0.05, 0.6, 1e6, 0.04};
    m.model = (cdem_material_model)(CDEM_COSSERAT_LATTICE + which - FIRST_PACKING);
    memcpy(m.parameter, p, sizeof p);
  }
  const double axis1[3] = {0.6, 0.8, 0.1}, axis2[3] = {-1, 0.7, 2};
  memcpy(m.axis1, axis1, sizeof axis1);
  memcpy(m.axis2, axis2, sizeof axis2);
  return m;
}

/* The materials first .. last - 1 that fit a formulation. */
static inline int first_specimen(cdem_formulation formulation) {
  return formulation == CDEM_PLANE_COSSERAT ? FIRST_COSSERAT : 0;
}
static inline int last_specimen(cdem_formulation formulation) {
  return formulation == CDEM_PLANE_COSSERAT ? SPECIMENS : FIRST_COSSERAT;
}

/* The reference shape, stretched and sheared, each node moved by up to `amplitude`. */
static inline void distort(const cdem_element *element, double amplitude, uint64_t seed,
                           double (*xyz)[3]) {
  static const double stretch[3][3] = {{1.1, 0.2, -0.1}, {-0.15, 0.9, 0.3}, {0.1, -0.2, 1.2}};
  int dimension = cdem_element_dimension(element);
  cdem_random random = {seed};
  for (int a = 0; a < cdem_element_nodes(element); a++)
    for (int i = 0; i < 3; i++) {
      xyz[a][i] = 0.0;
      for (int j = 0; j < dimension && i < dimension; j++)
        xyz[a][i] += stretch[i][j] * element->reference[a][j];
      if (i < dimension)
        xyz[a][i] += cdem_random_uniform(&random, -amplitude, amplitude);
    }
}

/* 0.08 of an edge length 1 or 2: the quadratic elements stay valid, nothing stays parallel. */
#define DISTORTION 0.08

static inline double largest(const double *values, int count) {
  double most = 0.0;
  for (int i = 0; i < count; i++)
    most = fmax(most, fabs(values[i]));
  return most;
}

/* |a - b| <= bound for all entries. */
static inline void check_same(const double *a, const double *b, int count, double bound,
                              const char *what) {
  for (int i = 0; i < count; i++)
    if (!(fabs(a[i] - b[i]) <= bound))
      fail_msg("%s: entry %d is %.17g, expected %.17g, allowed %.3g", what, i, a[i], b[i], bound);
}

/* Runs a body for every element of the table and both sections (solids: once). */
#define FOR_EACH_ELEMENT(element)                                                                  \
  for (int id_ = 0; id_ < CDEM_ELEMENT_COUNT; id_++)                                               \
    for (const cdem_element *element = cdem_element_get((cdem_element_id)id_); element != NULL;    \
         element = NULL)

static inline int sections(const cdem_element *element) {
  return element->formulation == CDEM_SOLID ? 1 : 2;
}
static inline const cdem_section *section_of(int which) {
  return which == 0 ? &strain_section : &stress_section;
}

#endif
