#include "reference_element.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* Shapes: facets and turns. */

static const reference_shape triangle = {
    2, 3, 3, {{1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 1}}, {{1, 2, 0}, {2, 0, 1}},
};
static const reference_shape quadrilateral = {
    2,
    4,
    4,
    {{1, 0, 0, -1}, {1, 0, 0, 1}, {0, 1, 0, -1}, {0, 1, 0, 1}},
    {{1, 2, 3, 0}, {2, 3, 0, 1}},
};
static const reference_shape tetrahedron = {
    3, 4, 4, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1, 1, 1, 1}}, {{1, 2, 0, 3}, {0, 2, 3, 1}},
};
static const reference_shape pyramid = {
    3,
    5,
    5,
    {{0, 0, 1, 0}, {1, 0, 1, 1}, {-1, 0, 1, 1}, {0, 1, 1, 1}, {0, -1, 1, 1}},
    {{1, 2, 3, 0, 4}, {2, 3, 0, 1, 4}},
};
static const reference_shape wedge = {
    3,
    6,
    5,
    {{1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 1}, {0, 0, 1, -1}, {0, 0, 1, 1}},
    {{1, 2, 0, 4, 5, 3}, {3, 5, 4, 0, 2, 1}},
};
static const reference_shape hexahedron = {
    3,
    8,
    6,
    {{1, 0, 0, -1}, {1, 0, 0, 1}, {0, 1, 0, -1}, {0, 1, 0, 1}, {0, 0, 1, -1}, {0, 0, 1, 1}},
    {{1, 2, 3, 0, 5, 6, 7, 4}, {3, 2, 6, 7, 0, 1, 5, 4}},
};

/* Nodes, linear ones first: an element of lower order takes the head of its table. */

static const double triangle_node[6][3] = {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}};
static const double quadrilateral_node[8][3] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1},
                                                {0, -1},  {1, 0},  {0, 1}, {-1, 0}};
static const double tetrahedron_node[10][3] = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},  {0, 0, 1},
                                               {.5, 0, 0},  {.5, .5, 0}, {0, .5, 0}, {0, 0, .5},
                                               {0, .5, .5}, {.5, 0, .5}};
static const double pyramid_node[5][3] = {
    {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
static const double wedge_node[6][3] = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1},
                                        {0, 0, 1},  {1, 0, 1},  {0, 1, 1}};
static const double hexahedron_node[20][3] = {
    {-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
    {-1, 1, 1},   {0, -1, -1}, {-1, 0, -1}, {-1, -1, 0}, {1, 0, -1},  {1, -1, 0}, {0, 1, -1},
    {1, 1, 0},    {-1, 1, 0},  {0, -1, 1},  {-1, 0, 1},  {1, 0, 1},   {0, 1, 1}};

/* Spaces. Complete polynomials on simplices; products of linear ones; serendipity: every monomial
 * of superlinear degree at most 2 (Arnold & Awanou 2011). The pyramid: Bedrosian 1992, whose four
 * base functions span 1, x, y, z and x y / (1 - z) together with the apex function z. */

static const signed char triangle_power[6][3] = {{0}, {1}, {0, 1}, {2}, {1, 1}, {0, 2}};
static const signed char quadrilateral_power[8][3] = {{0}, {1},    {0, 1}, {1, 1},
                                                      {2}, {0, 2}, {2, 1}, {1, 2}};
static const signed char tetrahedron_power[10][3] = {
    {0}, {1}, {0, 1}, {0, 0, 1}, {2}, {0, 2}, {0, 0, 2}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
static const signed char pyramid_power[5][3] = {{0}, {1}, {0, 1}, {0, 0, 1}, {1, 1, -1}};
static const signed char wedge_power[6][3] = {{0}, {1}, {0, 1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
static const signed char hexahedron_power[20][3] = {
    {0},       {1},       {0, 1},    {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1},
    {1, 1, 1}, {2},       {0, 2},    {0, 0, 2}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0},
    {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};

static const reference_element elements[] = {
    {"tri3", 2, 3, &triangle, triangle_node, triangle_power, RULE_TRIANGLE_1, false},
    {"tri6", 9, 6, &triangle, triangle_node, triangle_power, RULE_TRIANGLE_3, false},
    {"tri3-cosserat", 2, 3, &triangle, triangle_node, triangle_power, RULE_TRIANGLE_3, true},
    {"quad4", 3, 4, &quadrilateral, quadrilateral_node, quadrilateral_power, RULE_GAUSS_2, false},
    {"quad8", 16, 8, &quadrilateral, quadrilateral_node, quadrilateral_power, RULE_GAUSS_3, false},
    {"quad4-cosserat", 3, 4, &quadrilateral, quadrilateral_node, quadrilateral_power, RULE_GAUSS_2,
     true},
    {"tet4", 4, 4, &tetrahedron, tetrahedron_node, tetrahedron_power, RULE_TETRAHEDRON_1, false},
    {"tet10", 11, 10, &tetrahedron, tetrahedron_node, tetrahedron_power, RULE_TETRAHEDRON_4, false},
    {"pyr5", 7, 5, &pyramid, pyramid_node, pyramid_power, RULE_PYRAMID_8, false},
    {"wedge6", 6, 6, &wedge, wedge_node, wedge_power, RULE_WEDGE_6, false},
    {"hex8", 5, 8, &hexahedron, hexahedron_node, hexahedron_power, RULE_GAUSS_2, false},
    {"hex20", 17, 20, &hexahedron, hexahedron_node, hexahedron_power, RULE_GAUSS_3, false},
};

const reference_element *reference_element_find(const char *kind) {
  for (size_t e = 0; e < sizeof elements / sizeof *elements; e++)
    if (strcmp(elements[e].kind, kind) == 0)
      return &elements[e];
  return NULL;
}

int reference_dofs_of_node(const reference_element *element) {
  return element->cosserat ? 3 : element->shape->dimension;
}

/* Two different nodes of a polytope share at most dimension - 1 facets, and the smallest entity
 * that holds both is the common part of the shared ones. Reference nodes are exact numbers. */
const char *reference_class(const reference_element *element, int a, int b) {
  static const char *const name[] = {"", "edge", "face", "body"};
  const reference_shape *shape = element->shape;
  int entity = shape->dimension;
  for (int f = 0; f < shape->facets; f++) {
    const double *n = shape->facet[f], *p = element->node[a], *q = element->node[b];
    if (n[0] * p[0] + n[1] * p[1] + n[2] * p[2] == n[3] &&
        n[0] * q[0] + n[1] * q[1] + n[2] * q[2] == n[3])
      entity--;
  }
  return name[entity];
}

void reference_edge_of(const reference_element *element, int node, int corner[2]) {
  const double(*x)[3] = element->node;
  for (int a = 0; a < element->shape->corners; a++)
    for (int b = a + 1; b < element->shape->corners; b++)
      if (x[a][0] + x[b][0] == 2 * x[node][0] && x[a][1] + x[b][1] == 2 * x[node][1] &&
          x[a][2] + x[b][2] == 2 * x[node][2]) {
        corner[0] = a;
        corner[1] = b;
        return;
      }
  assert(!"a mid-edge node lies between two corners");
}

void reference_solve(int n, int m, double *a, double *b) {
  for (int c = 0; c < n; c++) {
    int pivot = c;
    for (int r = c + 1; r < n; r++)
      if (fabs(a[r * n + c]) > fabs(a[pivot * n + c]))
        pivot = r;
    for (int k = 0; k < n; k++) {
      double t = a[c * n + k];
      a[c * n + k] = a[pivot * n + k];
      a[pivot * n + k] = t;
    }
    for (int k = 0; k < m; k++) {
      double t = b[c * m + k];
      b[c * m + k] = b[pivot * m + k];
      b[pivot * m + k] = t;
    }
    for (int r = 0; r < n; r++) {
      if (r == c)
        continue;
      double factor = a[r * n + c] / a[c * n + c];
      for (int k = c; k < n; k++)
        a[r * n + k] -= factor * a[c * n + k];
      for (int k = 0; k < m; k++)
        b[r * m + k] -= factor * b[c * m + k];
    }
  }
  for (int r = 0; r < n; r++)
    for (int k = 0; k < m; k++)
      b[r * m + k] /= a[r * n + r];
}

/* Shape functions. */

/* base^power and its derivative by base. */
static void power_of(double base, int power, double *value, double *slope) {
  *value = pow(base, power);
  *slope = power == 0 ? 0 : power * pow(base, power - 1);
}

static void monomial(const signed char power[3], const double x[3], double value[4]) {
  bool rational = power[2] < 0;
  if (rational && x[2] == 1) { /* the apex: x y / (1 - z) tends to 0 inside the pyramid */
    memset(value, 0, 4 * sizeof *value);
    return;
  }
  double f[3], g[3];
  power_of(x[0], power[0], &f[0], &g[0]);
  power_of(x[1], power[1], &f[1], &g[1]);
  power_of(rational ? 1 - x[2] : x[2], power[2], &f[2], &g[2]);
  if (rational)
    g[2] = -g[2];
  value[0] = f[0] * f[1] * f[2];
  value[1] = g[0] * f[1] * f[2];
  value[2] = f[0] * g[1] * f[2];
  value[3] = f[0] * f[1] * g[2];
}

/* Row a: N_a = sum over m of coefficient[m][a] monomial_m. */
static void shape_coefficients(const reference_element *element, double *coefficient) {
  int n = element->nodes;
  double vandermonde[REFERENCE_MAX_NODES * REFERENCE_MAX_NODES], value[4];
  for (int b = 0; b < n; b++)
    for (int m = 0; m < n; m++) {
      monomial(element->power[m], element->node[b], value);
      vandermonde[b * n + m] = value[0];
    }
  for (int k = 0; k < n * n; k++)
    coefficient[k] = k % (n + 1) == 0;
  reference_solve(n, n, vandermonde, coefficient);
}

/* Rules: points (x, y, z, weight). */

static int gauss(int n, double x[3], double w[3]) {
  if (n == 2) {
    x[1] = sqrt(1.0 / 3);
    x[0] = -x[1];
    w[0] = w[1] = 1;
  } else {
    x[2] = sqrt(0.6);
    x[1] = 0;
    x[0] = -x[2];
    w[0] = w[2] = 5.0 / 9;
    w[1] = 8.0 / 9;
  }
  return n;
}

static int product_rule(int dimension, int n, double point[][4]) {
  double x[3], w[3];
  gauss(n, x, w);
  int count = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < (dimension == 3 ? n : 1); k++) {
        double *p = point[count++];
        p[0] = x[i];
        p[1] = x[j];
        p[2] = dimension == 3 ? x[k] : 0;
        p[3] = w[i] * w[j] * (dimension == 3 ? w[k] : 1);
      }
  return count;
}

static int simplex_rule(reference_rule rule, double point[][4]) {
  int nodes = rule == RULE_TETRAHEDRON_4 ? 4 : rule == RULE_TRIANGLE_3 ? 3 : 1;
  bool triangular = rule == RULE_TRIANGLE_1 || rule == RULE_TRIANGLE_3;
  double measure = triangular ? 1.0 / 2 : 1.0 / 6;
  /* Barycentric coordinates: one of `far`, the others `near`; both rules are exact to degree 2. */
  double near = triangular ? 1.0 / 6 : (5 - sqrt(5)) / 20;
  if (nodes == 1)
    near = triangular ? 1.0 / 3 : 1.0 / 4;
  double far = 1 - (triangular ? 2 : 3) * near;
  for (int p = 0; p < nodes; p++) {
    for (int c = 0; c < 3; c++)
      point[p][c] = triangular && c == 2 ? 0 : (nodes > 1 && c == p - 1 ? far : near);
    point[p][3] = measure / nodes;
  }
  return nodes;
}

static int wedge_rule(double point[][4]) {
  double flat[3][4], x[3], w[3];
  int n = simplex_rule(RULE_TRIANGLE_3, flat);
  gauss(2, x, w);
  for (int p = 0; p < 2 * n; p++) {
    memcpy(point[p], flat[p % n], sizeof point[p]);
    point[p][2] = x[p / n];
    point[p][3] *= w[p / n];
  }
  return 2 * n;
}

/* x = a t, y = b t, z = 1 - t, dx dy dz = t^2 da db dt. The two t are the roots of the polynomial
 * t^2 - 4/3 t + 2/5, orthogonal to 1 and t under the weight t^2 on 0 < t < 1; their weights give
 * the moments 1/3 and 1/4. */
static int pyramid_rule(double point[][4]) {
  double root = sqrt(2.0 / 45), t[2] = {2.0 / 3 - root, 2.0 / 3 + root}, x[3], w[3];
  double second = (1.0 / 4 - t[0] / 3) / (t[1] - t[0]), weight[2] = {1.0 / 3 - second, second};
  gauss(2, x, w);
  for (int p = 0; p < 8; p++) {
    point[p][0] = x[p & 1] * t[p >> 2];
    point[p][1] = x[p >> 1 & 1] * t[p >> 2];
    point[p][2] = 1 - t[p >> 2];
    point[p][3] = weight[p >> 2];
  }
  return 8;
}

static int rule_points(const reference_element *element, double point[][4]) {
  switch (element->rule) {
  case RULE_GAUSS_2:
    return product_rule(element->shape->dimension, 2, point);
  case RULE_GAUSS_3:
    return product_rule(element->shape->dimension, 3, point);
  case RULE_WEDGE_6:
    return wedge_rule(point);
  case RULE_PYRAMID_8:
    return pyramid_rule(point);
  default:
    return simplex_rule(element->rule, point);
  }
}

/* Moduli. */

static const int voigt_pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
static const int voigt_of[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

void reference_isotropic(double young, double poisson, double moduli[6][6]) {
  double shear = young / (2 * (1 + poisson));
  double constants[9] = {young, young, young, poisson, poisson, poisson, shear, shear, shear};
  reference_orthotropic(constants, moduli);
}

void reference_orthotropic(const double c[9], double moduli[6][6]) {
  double compliance[6][6] = {{1 / c[0], -c[3] / c[0], -c[4] / c[0]},
                             {-c[3] / c[0], 1 / c[1], -c[5] / c[1]},
                             {-c[4] / c[0], -c[5] / c[1], 1 / c[2]}};
  compliance[3][3] = 1 / c[8];
  compliance[4][4] = 1 / c[7];
  compliance[5][5] = 1 / c[6];
  for (int k = 0; k < 36; k++)
    moduli[k / 6][k % 6] = k % 7 == 0;
  reference_solve(6, 6, &compliance[0][0], &moduli[0][0]);
}

/* C_ijkl = a_pi a_qj a_rk a_sl C'_pqrs, row p of a is axis p in x, y, z: one index at a time. */
void reference_turn(double moduli[6][6], const double axis[3][3]) {
  double old[81], new[81];
  for (int k = 0; k < 81; k++)
    old[k] = moduli[voigt_of[k / 27][k / 9 % 3]][voigt_of[k / 3 % 3][k % 3]];
  for (int index = 0, stride = 27; index < 4; index++, stride /= 3) {
    for (int k = 0; k < 81; k++) {
      int i = k / stride % 3, base = k - i * stride;
      new[k] = 0;
      for (int p = 0; p < 3; p++)
        new[k] += axis[p][i] * old[base + p * stride];
    }
    memcpy(old, new, sizeof old);
  }
  for (int a = 0; a < 6; a++)
    for (int b = 0; b < 6; b++)
      moduli[a][b] = old[27 * voigt_pair[a][0] + 9 * voigt_pair[a][1] + 3 * voigt_pair[b][0] +
                         voigt_pair[b][1]];
}

void reference_cosserat_cubic(const double c[5], double moduli[6][6]) {
  memset(moduli, 0, 36 * sizeof(double));
  moduli[0][0] = moduli[1][1] = c[0];
  moduli[0][1] = moduli[1][0] = c[1];
  moduli[2][2] = moduli[3][3] = c[2];
  moduli[2][3] = moduli[3][2] = c[3];
  moduli[4][4] = moduli[5][5] = c[4];
}

/* Plane strain takes the rows xx yy xy. Plane stress: sigma_zz = sigma_yz = sigma_xz = 0, so that
 * D = C_pp - C_po C_oo^-1 C_op with p the plane rows and o the other three. */
static void plane_moduli(const reference_material *material, double d[6][6]) {
  static const int plane[3] = {0, 1, 5}, out[3] = {2, 3, 4};
  double inner[9], response[9];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      d[a][b] = material->moduli[plane[a]][plane[b]];
      inner[3 * a + b] = material->moduli[out[a]][out[b]];
      response[3 * a + b] = material->moduli[out[a]][plane[b]];
    }
  if (!material->plane_stress)
    return;
  reference_solve(3, 3, inner, response);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int k = 0; k < 3; k++)
        d[a][b] -= material->moduli[plane[a]][out[k]] * response[3 * k + b];
}

/* The integral. */

/* Columns a * dofs + c of the strains for N (value) and its gradient at one node. */
static void strain_columns(const reference_element *element, double value, const double g[3],
                           double b[6][3]) {
  memset(b, 0, 18 * sizeof(double));
  if (element->cosserat) {
    b[0][0] = b[2][1] = b[4][2] = g[0];
    b[1][1] = b[3][0] = b[5][2] = g[1];
    b[2][2] = -value;
    b[3][2] = value;
  } else if (element->shape->dimension == 2) {
    b[0][0] = b[2][1] = g[0];
    b[1][1] = b[2][0] = g[1];
  } else {
    for (int row = 0; row < 6; row++) {
      int i = voigt_pair[row][0], j = voigt_pair[row][1];
      b[row][i] = g[j];
      b[row][j] = g[i];
    }
  }
}

/* value[a] and gradient[a] in x, y, z of every shape function; returns det(J). */
static double shape_at(const reference_element *element, const double *coefficient,
                       const double (*x)[3], const double point[3],
                       double value[REFERENCE_MAX_NODES][4]) {
  int n = element->nodes, dimension = element->shape->dimension;
  double jacobian[9] = {0}, term[4];
  memset(value, 0, REFERENCE_MAX_NODES * sizeof *value);
  for (int m = 0; m < n; m++) {
    monomial(element->power[m], point, term);
    for (int a = 0; a < n; a++)
      for (int k = 0; k < 4; k++)
        value[a][k] += coefficient[m * n + a] * term[k];
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int a = 0; a < n; a++)
        jacobian[3 * i + j] += value[a][1 + i] * (j < dimension ? x[a][j] : 0);
  if (dimension == 2)
    jacobian[8] = 1;
  const double *j = jacobian;
  double determinant = j[0] * (j[4] * j[8] - j[5] * j[7]) - j[1] * (j[3] * j[8] - j[5] * j[6]) +
                       j[2] * (j[3] * j[7] - j[4] * j[6]);
  double gradient[3 * REFERENCE_MAX_NODES];
  for (int a = 0; a < n; a++)
    for (int i = 0; i < 3; i++)
      gradient[i * n + a] = value[a][1 + i];
  reference_solve(3, n, jacobian, gradient); /* dN/dxi = J dN/dx */
  for (int a = 0; a < n; a++)
    for (int i = 0; i < 3; i++)
      value[a][1 + i] = gradient[i * n + a];
  return determinant;
}

static void add_point(int dofs, const double b[6][REFERENCE_MAX_DOFS], const double d[6][6],
                      double weight, double *k) {
  double stress[6][REFERENCE_MAX_DOFS] = {{0}};
  for (int r = 0; r < 6; r++)
    for (int s = 0; s < 6; s++)
      for (int q = 0; q < dofs; q++)
        stress[r][q] += d[r][s] * b[s][q];
  for (int p = 0; p < dofs; p++)
    for (int q = 0; q < dofs; q++)
      for (int r = 0; r < 6; r++)
        k[p * dofs + q] += weight * b[r][p] * stress[r][q];
}

double reference_stiffness(const reference_element *element, const double (*x)[3],
                           const reference_material *material, double *k) {
  int n = element->nodes, width = reference_dofs_of_node(element), dofs = n * width;
  bool plane = element->shape->dimension == 2;
  double d[6][6] = {{0}}, coefficient[REFERENCE_MAX_NODES * REFERENCE_MAX_NODES];
  double point[27][4], value[REFERENCE_MAX_NODES][4], smallest = DBL_MAX;
  if (plane && !element->cosserat)
    plane_moduli(material, d);
  else
    memcpy(d, element->cosserat ? material->cosserat : material->moduli, sizeof d);
  shape_coefficients(element, coefficient);
  memset(k, 0, (size_t)dofs * (size_t)dofs * sizeof *k);
  int points = rule_points(element, point);
  for (int p = 0; p < points; p++) {
    double determinant = shape_at(element, coefficient, x, point[p], value);
    double b[6][REFERENCE_MAX_DOFS] = {{0}}, column[6][3];
    for (int a = 0; a < n; a++) {
      strain_columns(element, value[a][0], &value[a][1], column);
      for (int r = 0; r < 6; r++)
        memcpy(&b[r][a * width], column[r], (size_t)width * sizeof(double));
    }
    double weight = point[p][3] * determinant * (plane ? material->thickness : 1);
    add_point(dofs, b, d, weight, k);
    smallest = fmin(smallest, determinant);
  }
  return smallest;
}
