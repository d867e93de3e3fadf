/* Room elements: laws of the reference stiffness matrix, for every element and fitting material.
 *
 * Entries of K differ in unit under Cosserat (omega in rad), so lengths here are of order one and
 * one bound serves all: 1e-13 of the largest entry covers the sums of up to 27 points x 60 dofs. */
#include "elements/specimens.h"

#include <lapacke.h>

#define ROUNDING 1e-13

typedef struct {
  int size, dofs, nodes;
  double scale; /* the largest entry */
  double k[MAX_SIZE * MAX_SIZE];
} stiffness;

static void compute(const cdem_element *element, const cdem_material *material,
                    const cdem_section *section, double (*xyz)[3], stiffness *out) {
  cdem_fault fault = {0};
  cdem_tabulation tabulation = {0};
  check_ok(cdem_tabulation_init(element, 0, &tabulation, &fault));
  check_ok(cdem_element_stiffness(&tabulation, material, section, (const double(*)[3])xyz, out->k,
                                  &fault));
  cdem_tabulation_release(&tabulation);
  out->dofs = cdem_element_dofs(element);
  out->nodes = cdem_element_nodes(element);
  out->size = out->dofs * out->nodes;
  out->scale = largest(out->k, out->size * out->size);
}

/* Runs `law` on every element, fitting material and section, for a distorted shape. */
typedef void law_check(const cdem_element *element, const cdem_material *material,
                       const cdem_section *section, double (*xyz)[3], const stiffness *k);
static void for_all(law_check *law) {
  static stiffness k;
  FOR_EACH_ELEMENT(element)
  for (int which = first_specimen(element->formulation);
       which < last_specimen(element->formulation); which++)
    for (int s = 0; s < sections(element); s++) {
      double xyz[MAX_NODES][3];
      cdem_material material = specimen(which);
      distort(element, DISTORTION, 21, xyz);
      compute(element, &material, section_of(s), xyz, &k);
      law(element, &material, section_of(s), xyz, &k);
    }
}

static void symmetric(const cdem_element *element, const cdem_material *material,
                      const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  (void)element, (void)material, (void)section, (void)xyz;
  for (int i = 0; i < k->size; i++)
    for (int j = 0; j < i; j++)
      check_near(k->k[k->size * i + j], k->k[k->size * j + i], 0, ROUNDING * k->scale);
}

static void stiffness_is_symmetric(void **state) {
  (void)state;
  for_all(symmetric);
}

/* Rigid motion number m as nodal displacements: translations first, then rotations. */
static int rigid_motions(const cdem_element *element) {
  return cdem_element_dimension(element) == 2 ? 3 : 6;
}
static void rigid_motion(const cdem_element *element, int m, double (*xyz)[3], double *u) {
  int dimension = cdem_element_dimension(element), dofs = cdem_element_dofs(element);
  for (int a = 0; a < cdem_element_nodes(element); a++) {
    double spin[3] = {0}, move[3] = {0};
    if (m < dimension)
      move[m] = 1.0;
    else
      spin[dimension == 2 ? 2 : m - dimension] = 1.0;
    double turned[3];
    cdem_cross3(spin, xyz[a], turned);
    for (int i = 0; i < dofs; i++)
      u[dofs * a + i] = i < dimension ? move[i] + turned[i] : spin[2];
  }
}

static void force_free(const cdem_element *element, const cdem_material *material,
                       const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  (void)material, (void)section;
  for (int m = 0; m < rigid_motions(element); m++) {
    double u[MAX_SIZE];
    rigid_motion(element, m, xyz, u);
    for (int i = 0; i < k->size; i++) {
      double force = 0.0;
      for (int j = 0; j < k->size; j++)
        force += k->k[k->size * i + j] * u[j];
      check_near(force, 0.0, 0, 10 * ROUNDING * k->scale); /* sixty terms of size two */
    }
  }
}

static void rigid_motions_need_no_force(void **state) {
  (void)state;
  for_all(force_free);
}

/* springs.md section 4: sum over j of K_ij T_ij = 0, T_ij the rigid transport from i to j. */
static void transported(const cdem_element *element, const cdem_material *material,
                        const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  (void)material, (void)section;
  if (element->formulation != CDEM_PLANE_COSSERAT)
    return;
  for (int i = 0; i < k->nodes; i++) {
    double sum[9] = {0};
    for (int j = 0; j < k->nodes; j++) {
      const double dx = xyz[j][0] - xyz[i][0], dy = xyz[j][1] - xyz[i][1];
      const double transport[9] = {1, 0, -dy, 0, 1, dx, 0, 0, 1};
      double block[9], product[9];
      for (int e = 0; e < 9; e++)
        block[e] = k->k[k->size * (3 * i + e / 3) + 3 * j + e % 3];
      cdem_product3(block, transport, product);
      for (int e = 0; e < 9; e++)
        sum[e] += product[e];
    }
    check_below(largest(sum, 9), ROUNDING * k->scale);
  }
}

static void cosserat_blocks_sum_to_zero_under_transport(void **state) {
  (void)state;
  for_all(transported);
}

static void modes_counted(const cdem_element *element, const cdem_material *material,
                          const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  (void)material, (void)section, (void)xyz;
  double copy[MAX_SIZE * MAX_SIZE], eigenvalue[MAX_SIZE];
  memcpy(copy, k->k, sizeof(double) * (size_t)(k->size * k->size));
  assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', k->size, copy, k->size, eigenvalue),
                   0);
  int zero = 0;
  for (int i = 0; i < k->size; i++) {
    double relative = eigenvalue[i] / eigenvalue[k->size - 1];
    zero += fabs(relative) < 1e-13;
    assert_true(relative > -1e-13);
    /* nothing in between: the softest true mode of these shapes stands near 1e-4 */
    assert_true(fabs(relative) < 1e-13 || relative > 1e-6);
  }
  assert_int_equal(zero, rigid_motions(element));
}

static void only_rigid_motions_are_free(void **state) {
  (void)state;
  for_all(modes_counted);
}

/* K of the turned element, turned material: R K R^T node by node; omega is not turned. */
static void turned(const cdem_element *element, const cdem_material *material,
                   const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  static stiffness other;
  int dimension = cdem_element_dimension(element), dofs = k->dofs;
  cdem_material m = *material;
  double r[9], moved[MAX_NODES][3] = {{0}}, full[9];
  if (cdem_material_is_cosserat(&m) && !cdem_material_model_get(m.model)->isotropic)
    return; /* its axes are x and y */
  rotation(dimension, 0.7, r);
  if (!m.rotated) {
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
    memcpy(m.axis1, x, sizeof x);
    memcpy(m.axis2, y, sizeof y);
    m.rotated = true;
  }
  double axis1[3] = {0}, axis2[3] = {0};
  for (int i = 0; i < 9; i++) {
    axis1[i / 3] += r[i] * m.axis1[i % 3];
    axis2[i / 3] += r[i] * m.axis2[i % 3];
    for (int a = 0; a < k->nodes; a++)
      moved[a][i / 3] += r[i] * xyz[a][i % 3];
  }
  memcpy(m.axis1, axis1, sizeof axis1);
  memcpy(m.axis2, axis2, sizeof axis2);
  compute(element, &m, section, moved, &other);
  for (int a = 0; a < k->nodes; a++)
    for (int b = 0; b < k->nodes; b++) {
      memset(full, 0, sizeof full);
      for (int e = 0; e < dofs * dofs; e++)
        for (int f = 0; f < dofs * dofs; f++) { /* r acts on omega as r[8] = 1 in a plane */
          double block = k->k[k->size * (dofs * a + f / dofs) + dofs * b + f % dofs];
          full[e] += r[3 * (e / dofs) + f / dofs] * r[3 * (e % dofs) + f % dofs] * block;
        }
      for (int e = 0; e < dofs * dofs; e++)
        check_near(other.k[k->size * (dofs * a + e / dofs) + dofs * b + e % dofs], full[e], 0,
                   ROUNDING * k->scale);
    }
}

static void stiffness_turns_with_the_body(void **state) {
  (void)state;
  for_all(turned);
}

/* Twice the size: K doubles in 3-D, stays in 2-D; omega rows and columns bring a length each when
 * the characteristic length grows too. */
static void scaled(const cdem_element *element, const cdem_material *material,
                   const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  static stiffness other;
  const double factor = 2.5;
  cdem_material m = *material;
  double larger[MAX_NODES][3];
  for (int i = 0; i < 3 * k->nodes; i++)
    larger[i / 3][i % 3] = factor * xyz[i / 3][i % 3];
  if (m.model == CDEM_COSSERAT)
    m.parameter[3] *= factor;
  if (m.model == CDEM_COSSERAT_CUBIC)
    m.parameter[4] *= factor * factor;
  if (m.model >= CDEM_COSSERAT_LATTICE) { /* moments, radius, L; the density is a number */
    m.parameter[2] *= factor * factor;
    m.parameter[3] *= factor;
    m.parameter[6] *= factor;
  }
  compute(element, &m, section, larger, &other);
  for (int i = 0; i < k->size; i++)
    for (int j = 0; j < k->size; j++) {
      double expected = k->k[k->size * i + j];
      if (element->formulation == CDEM_SOLID)
        expected *= factor;
      if (element->formulation == CDEM_PLANE_COSSERAT)
        expected *= (i % 3 == 2 ? factor : 1.0) * (j % 3 == 2 ? factor : 1.0);
      check_near(other.k[k->size * i + j], expected, 0, ROUNDING * other.scale);
    }
}

static void stiffness_scales(void **state) {
  (void)state;
  for_all(scaled);
}

/* Another valid numbering of the same body: corner a becomes corner turn[a], mid nodes follow. */
static void renumbering(const cdem_element *element, int *other) {
  static const int8_t turn[][8] = {{1, 2, 0},       {1, 2, 3, 0},       {1, 2, 0, 3},
                                   {1, 2, 3, 0, 4}, {1, 2, 0, 4, 5, 3}, {3, 2, 6, 7, 0, 1, 5, 4}};
  static const int8_t row[2][9] = {{0, 0, 0, 0, 2, 3, 4, 0, 5}, {0, 0, 0, 0, 1}};
  int corners = cdem_shape_get(element->shape)->corners;
  int dimension = cdem_element_dimension(element);
  const int8_t *corner = turn[row[dimension == 2][corners]];
  const cdem_element *linear = element;
  for (int id = 0; id < CDEM_ELEMENT_COUNT; id++) {
    const cdem_element *e = cdem_element_get((cdem_element_id)id);
    if (cdem_element_dimension(e) == dimension && cdem_element_nodes(e) == corners)
      linear = e;
  }
  for (int a = 0; a < cdem_element_nodes(element); a++) {
    double n[MAX_NODES], at[3] = {0};
    linear->shape_functions(element->reference[a], n, NULL);
    for (int c = 0; c < corners; c++)
      for (int i = 0; i < 3; i++)
        at[i] += n[c] * element->reference[corner[c]][i];
    other[a] = -1;
    for (int b = 0; b < cdem_element_nodes(element); b++) {
      const double *r = element->reference[b];
      if (fabs(r[0] - at[0]) + fabs(r[1] - at[1]) + fabs(r[2] - at[2]) < 1e-12)
        other[a] = b;
    }
    assert_true(other[a] >= 0);
  }
}

static void renumbered(const cdem_element *element, const cdem_material *material,
                       const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  static stiffness again;
  int other[MAX_NODES], d = k->dofs;
  double moved[MAX_NODES][3];
  renumbering(element, other);
  for (int i = 0; i < 3 * k->nodes; i++)
    moved[i / 3][i % 3] = xyz[other[i / 3]][i % 3];
  compute(element, material, section, moved, &again);
  for (int i = 0; i < k->size; i++)
    for (int j = 0; j < k->size; j++) {
      int row = d * other[i / d] + i % d, column = d * other[j / d] + j % d;
      check_near(again.k[k->size * i + j], k->k[k->size * row + column], 0, ROUNDING * k->scale);
    }
}

static void stiffness_follows_renumbering(void **state) {
  (void)state;
  for_all(renumbered);
}

/* Uniform displacement gradient (and constant omega): energy = 1/2 strain D strain volume. */
static void uniform(const cdem_element *element, const cdem_material *material,
                    const cdem_section *section, double (*xyz)[3], const stiffness *k) {
  static const double g[9] = {0.3, -0.2, 0.5, 0.4, -0.6, 0.1, -0.7, 0.2, 0.9};
  const double omega = 0.25;
  cdem_fault fault = {0};
  cdem_tabulation t = {0};
  double d[36], u[MAX_SIZE], energy = 0.0, density = 0.0;
  int rows, dimension = cdem_element_dimension(element);
  const double solid[6] = {g[0], g[4], g[8], g[5] + g[7], g[2] + g[6], g[1] + g[3]};
  const double plane[3] = {g[0], g[4], g[1] + g[3]};
  const double cosserat[6] = {g[0], g[4], g[3] - omega, g[1] + omega, 0, 0};
  const double *strain = element->formulation == CDEM_SOLID   ? solid
                         : element->formulation == CDEM_PLANE ? plane
                                                              : cosserat;
  const cdem_moduli_kind kind[] = {CDEM_MODULI_SOLID, CDEM_MODULI_PLANE,
                                   CDEM_MODULI_PLANE_COSSERAT};
  check_ok(cdem_material_moduli(material, kind[element->formulation], section, d, &rows, &fault));
  for (int i = 0; i < rows * rows; i++)
    density += 0.5 * strain[i / rows] * d[i] * strain[i % rows];
  for (int i = 0; i < k->size; i++) {
    int a = i / k->dofs, c = i % k->dofs;
    u[i] = c < dimension
               ? g[3 * c] * xyz[a][0] + g[3 * c + 1] * xyz[a][1] + g[3 * c + 2] * xyz[a][2]
               : omega;
  }
  for (int i = 0; i < k->size; i++)
    for (int j = 0; j < k->size; j++)
      energy += 0.5 * u[i] * k->k[k->size * i + j] * u[j];
  check_ok(cdem_tabulation_init(element, 0, &t, &fault));
  double volume = cdem_element_volume(&t, section->thickness, (const double(*)[3])xyz);
  cdem_tabulation_release(&t);
  check_near(energy, density * volume, 1e-11, 0); /* sums that cancel by up to a factor of 100 */
}

static void uniform_strain_has_its_energy(void **state) {
  (void)state;
  for_all(uniform);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stiffness_is_symmetric),
      cmocka_unit_test(rigid_motions_need_no_force),
      cmocka_unit_test(cosserat_blocks_sum_to_zero_under_transport),
      cmocka_unit_test(only_rigid_motions_are_free),
      cmocka_unit_test(stiffness_turns_with_the_body),
      cmocka_unit_test(stiffness_scales),
      cmocka_unit_test(stiffness_follows_renumbering),
      cmocka_unit_test(uniform_strain_has_its_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
