/* Room elements: stiffness blocks against closed forms (springs.md section 3; Wei et al. 2006 and
 * Gusev for interior sums). Blocks are S = -K; a spring of stiffness k along d means S d = k d. */
#include "elements/specimens.h"

/* Relative to the scale of the block: a block is a sum of 8 points. */
#define ROUNDING 1e-13

static double blocks[CDEM_MAX_PAIRS * 9];

static void convert(const char *name, const cdem_material *material, const cdem_section *section,
                    const double (*xyz)[3]) {
  cdem_fault fault = {0};
  cdem_tabulation t = {0};
  cdem_contraction law;
  const cdem_element *element = cdem_element_find(name);
  check_ok(cdem_tabulation_init(element, 0, &t, &fault));
  check_ok(cdem_contraction_build(material, element->formulation, section, &law, &fault));
  check_ok(cdem_element_pair_blocks(&t, &law, xyz, blocks, &fault));
  cdem_tabulation_release(&t);
}

/* Block of nodes a and b of an element of `nodes` nodes; S_ba = S_ab^T. Adds into s. */
static void add_block(int nodes, int size, int a, int b, double *s) {
  int low = a < b ? a : b, high = a < b ? b : a, pair = 0;
  for (int i = 0; i < low; i++)
    pair += nodes - 1 - i;
  pair += high - low - 1;
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++)
      s[size * i + j] += blocks[size * size * pair + (a < b ? size * i + j : size * j + i)];
}

static void check_spring(const double *s, int size, double k, double d0, double d1, double d2) {
  const double d[3] = {d0, d1, d2};
  double scale = cdem_frobenius(s, size * size) * fmax(fmax(fabs(d0), fabs(d1)), fabs(d2));
  for (int i = 0; i < size; i++) {
    double force = 0.0;
    for (int j = 0; j < size; j++)
      force += s[size * i + j] * d[j];
    check_near(force, k * d[i], 0, ROUNDING * scale);
  }
}

static const double side = 1.7, young = 2.5;

static void convert_cube(double mu) {
  const cdem_element *hex = cdem_element_find("hex8");
  cdem_material material = cdem_material_isotropic(young, mu);
  double xyz[8][3];
  for (int i = 0; i < 24; i++)
    xyz[i / 3][i % 3] = 0.5 * side * hex->reference[i / 3][i % 3] + 3.0;
  convert("hex8", &material, NULL, (const double(*)[3])xyz);
}

static double cube_factor(double mu) {
  return side * young / ((1 + mu) * (1 - 2 * mu));
}

static void cube_edge(void **state) {
  (void)state;
  for (double mu = 0.05; mu < 0.47; mu += 0.1) {
    double c = cube_factor(mu), root = sqrt(-512 * mu * mu + 256 * mu - 7), s[9] = {0};
    convert_cube(mu);
    add_block(8, 3, 0, 1, s);
    check_spring(s, 3, -c / 144, 0, -1, 1);
    if (fabs(mu - 0.25) > 1e-9) { /* the table's direction is infinite there */
      check_spring(s, 3, c * (1 + 3 * root) / 288, (5 + root) / (4 * (4 * mu - 1)), 1, 1);
      check_spring(s, 3, c * (1 - 3 * root) / 288, (5 - root) / (4 * (4 * mu - 1)), 1, 1);
    }
  }
}

static void cube_face(void **state) {
  (void)state;
  for (double mu = 0.05; mu < 0.47; mu += 0.1) {
    double c = cube_factor(mu), root = sqrt(-32 * mu * mu + 16 * mu + 2), s[9] = {0};
    convert_cube(mu);
    add_block(8, 3, 0, 2, s);
    check_spring(s, 3, c * (1 - 3 * mu) / 36, -1, 1, 0);
    if (fabs(mu - 0.25) > 1e-9) {
      double plus = (2 + root) / (2 * (4 * mu - 1)), minus = (2 - root) / (2 * (4 * mu - 1));
      check_spring(s, 3, c * (10 - 12 * mu + 3 * root) / 144, plus, plus, 1);
      check_spring(s, 3, c * (10 - 12 * mu - 3 * root) / 144, minus, minus, 1);
    }
  }
}

static void cube_body(void **state) {
  (void)state;
  for (double mu = -0.9; mu < 0.5; mu += 0.1) {
    double c = cube_factor(mu), s[9] = {0};
    convert_cube(mu);
    add_block(8, 3, 0, 6, s);
    check_spring(s, 3, c * (7 - 6 * mu) / 72, 1, 1, 1);
    check_spring(s, 3, c * (5 - 12 * mu) / 144, 1, -1, 0);
    check_spring(s, 3, c * (5 - 12 * mu) / 144, 1, 1, -2);
  }
}

/* Gusev: the elements around a pair inside a regular grid. */
static void cube_interior_sums(void **state) {
  (void)state;
  const double mu = 0.3, c = cube_factor(mu);
  double edge[9] = {0}, face[9] = {0};
  convert_cube(mu);
  add_block(8, 3, 0, 1, edge);
  add_block(8, 3, 3, 2, edge);
  add_block(8, 3, 4, 5, edge);
  add_block(8, 3, 7, 6, edge);
  check_spring(edge, 3, 2 * c / 9, 1, 0, 0);
  check_spring(edge, 3, -c / 9, 0, 1, 0);
  check_spring(edge, 3, -c / 9, 0, 0, 1);
  add_block(8, 3, 0, 2, face);
  add_block(8, 3, 4, 6, face);
  check_spring(face, 3, c * (4 - 3 * mu) / 18, 1, 1, 0);
  check_spring(face, 3, c * (1 - 3 * mu) / 18, 1, -1, 0);
  check_spring(face, 3, c * (1 - 3 * mu) / 18, 0, 0, 1);
}

static void convert_square(const cdem_material *material, const cdem_section *section) {
  const double xyz[4][3] = {{1, 1, 0}, {1 + side, 1, 0}, {1 + side, 1 + side, 0}, {1, 1 + side, 0}};
  convert("quad4", material, section, xyz);
}

/* Plane strain; and plane stress by mu -> mu/(1+mu), E -> E(1+2mu)/(1+mu)^2. */
static void square(void **state) {
  (void)state;
  for (int stress = 0; stress < 2; stress++)
    for (double nu = -0.35; nu < 0.5; nu += 0.2) {
      cdem_material material = cdem_material_isotropic(young, nu);
      cdem_section section = {stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN, 0.6};
      double mu = stress ? nu / (1 + nu) : nu;
      double e = stress ? young * (1 + 2 * nu) / ((1 + nu) * (1 + nu)) : young;
      double c = e * section.thickness / ((1 + mu) * (1 - 2 * mu)), s[4] = {0}, diagonal[4] = {0};
      convert_square(&material, &section);
      add_block(4, 2, 0, 1, s);
      /* the two stiffnesses by their sum and product: real or complex */
      check_near(s[0] + s[3], c * (3 - 4 * mu) / 12, 1e-13, 0);
      double product = c * c / 576 * ((3 - 4 * mu) * (3 - 4 * mu) - 72 * mu * (1 - 2 * mu));
      check_near(s[0] * s[3] - s[1] * s[2], product, 0, 1e-13 * c * c);
      add_block(4, 2, 0, 2, diagonal);
      check_spring(diagonal, 2, c * (9 - 8 * mu) / 24, 1, 1, 0);
      check_spring(diagonal, 2, c * (3 - 8 * mu) / 24, -1, 1, 0);
    }
}

static void equilateral_triangles(void **state) {
  (void)state;
  const double xyz[3][3] = {{0, 0, 0}, {side, 0, 0}, {0.5 * side, 0.5 * sqrt(3) * side, 0}};
  for (int stress = 0; stress < 2; stress++)
    for (double mu = -0.4; mu < 0.5; mu += 0.15) {
      cdem_material material = cdem_material_isotropic(young, mu);
      cdem_section section = {stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN, 0.6};
      double f = sqrt(3) * young * section.thickness / 12, s[4] = {0};
      convert("tri3", &material, &section, xyz);
      /* The pair lies in this triangle as nodes 0, 1 and in its half-turned copy as 1, 0. */
      add_block(3, 2, 0, 1, s);
      add_block(3, 2, 1, 0, s);
      double along = stress ? f * (5 + mu) / (1 - mu * mu) : f * (5 - 4 * mu);
      double across = stress ? f * (1 - 3 * mu) / (1 - mu * mu) : f * (1 - 4 * mu);
      if (!stress)
        along /= (1 + mu) * (1 - 2 * mu), across /= (1 + mu) * (1 - 2 * mu);
      check_spring(s, 2, along, 1, 0, 0);
      check_spring(s, 2, across, 0, 1, 0);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cube_edge), cmocka_unit_test(cube_face),
      cmocka_unit_test(cube_body), cmocka_unit_test(cube_interior_sums),
      cmocka_unit_test(square),    cmocka_unit_test(equilateral_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
