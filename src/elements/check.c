/* Is an element usable? The sign of the Jacobian determinant at quadrature points and corners.
 *
 * Scale-free: a determinant counts as zero
 *   - below CDEM_FLAT_BOUND |J| |adj J| = CDEM_FLAT_BOUND |det J| cond(J): thinner than a
 *     million-millionth of its length;
 *   - below what the rounding of the coordinates does to it, their size times |adj J|;
 *   - below the rounding of its own products (all nodes near one line make adj J rounding too). */
#include "elements/basis.h"

#include <float.h>

#define ROUNDING (16.0 * DBL_EPSILON)

typedef struct {
  double least, most; /* determinants */
  int positive, negative, zero;
} census;

/* Below these a determinant is zero by its own Jacobian; size: the largest coordinate. */
static double zero_plane(const double j[9], double size) {
  double norm = sqrt(j[0] * j[0] + j[1] * j[1] + j[3] * j[3] + j[4] * j[4]); /* |J| = |adj J| */
  double products = fabs(j[0] * j[4]) + fabs(j[1] * j[3]);
  return fmax(fmax(CDEM_FLAT_BOUND * norm, ROUNDING * size) * norm, ROUNDING * products);
}

static double zero_solid(const double j[9], double size) {
  const double column[3][3] = {{j[0], j[3], j[6]}, {j[1], j[4], j[7]}, {j[2], j[5], j[8]}};
  double adjugate = 0.0, products = 0.0;
  for (int k = 0; k < 3; k++) {
    double area[3];
    cdem_cross3(column[k], column[(k + 1) % 3], area);
    adjugate += cdem_dot3(area, area);
    products += fabs(j[k]) * (fabs(j[3 + (k + 1) % 3] * j[6 + (k + 2) % 3]) +
                              fabs(j[3 + (k + 2) % 3] * j[6 + (k + 1) % 3]));
  }
  double flat = fmax(CDEM_FLAT_BOUND * cdem_frobenius(j, 9), ROUNDING * size) * sqrt(adjugate);
  return fmax(flat, ROUNDING * products);
}

static void count(census *c, double det, double bound) {
  if (det > bound)
    c->positive++;
  else if (det < -bound)
    c->negative++;
  else
    c->zero++;
}

/* Determinants at `points` points of dn [points][nodes][3], and what counts as zero there. */
static void measure(const cdem_tabulation *t, int points, const double *dn, const double (*xyz)[3],
                    double *det, double *zero) {
  int dimension = cdem_element_dimension(t->element);
  double size = 0.0;
  for (int i = 0; i < dimension * t->nodes; i++)
    size = fmax(size, fabs(xyz[i / dimension][i % dimension]));
  for (int q = 0; q < points; q++) {
    double j[9];
    const double(*at)[3] = (const double(*)[3])(dn + (ptrdiff_t)3 * t->nodes * q);
    det[q] = cdem_jacobian(dimension, t->nodes, at, xyz, j);
    zero[q] = dimension == 2 ? zero_plane(j, size) : zero_solid(j, size);
  }
}

static cdem_status judge(const cdem_element *element, const census *inside, const census *corner,
                         cdem_fault *fault) {
  bool plane = cdem_element_dimension(element) == 2;
  CDEM_REQUIRE(inside->positive > 0 || inside->negative > 0, fault, CDEM_INPUT,
               "element is flat: its nodes lie %s (Jacobian determinant %.3g); remove it or move "
               "its nodes apart",
               plane ? "on one line" : "in one plane", inside->most);
  CDEM_REQUIRE(inside->positive > 0 || corner->positive > 0, fault, CDEM_INPUT,
               "element is inverted: its Jacobian determinant is negative everywhere (%.3g to "
               "%.3g); reverse its node order%s",
               inside->least, inside->most,
               plane ? " (in gmsh: turn the curve loop round or use ReverseMesh Surface)" : "");
  CDEM_REQUIRE(inside->negative == 0, fault, CDEM_INPUT,
               "element is folded: its Jacobian determinant is %.3g at a quadrature point and %.3g "
               "at another, it must be positive; untangle its nodes",
               inside->least, inside->most);
  CDEM_REQUIRE(inside->zero == 0, fault, CDEM_INPUT,
               "element is degenerate: its Jacobian determinant is %.3g at a quadrature point, "
               "zero by the side of %.3g at another; move its nodes apart",
               inside->least, inside->most);
  CDEM_REQUIRE(corner->negative == 0, fault, CDEM_INPUT,
               "element is folded: its Jacobian determinant is %.3g at a corner, it must not be "
               "negative; untangle its nodes",
               corner->least);
  return CDEM_OK;
}

static census take(int points, const double *det, const double *zero) {
  census c = {.least = INFINITY, .most = -INFINITY};
  for (int q = 0; q < points; q++) {
    c.least = fmin(c.least, det[q]);
    c.most = fmax(c.most, det[q]);
    count(&c, det[q], zero[q]);
  }
  return c;
}

cdem_status cdem_element_check(const cdem_tabulation *tabulation, const double (*xyz)[3],
                               cdem_fault *fault) {
  double det[CDEM_MAX_POINTS], zero[CDEM_MAX_POINTS], corner_det[8], corner_zero[8];
  int dimension = cdem_element_dimension(tabulation->element);
  for (int a = 0; a < tabulation->nodes; a++)
    for (int i = 0; i < dimension; i++)
      CDEM_REQUIRE(isfinite(xyz[a][i]), fault, CDEM_INPUT,
                   "element has a node at %c = %g; coordinates must be finite", "xyz"[i],
                   xyz[a][i]);
  int corners = cdem_shape_get(tabulation->element->shape)->corners;
  measure(tabulation, tabulation->points, tabulation->dn, xyz, det, zero);
  measure(tabulation, corners, tabulation->corner, xyz, corner_det, corner_zero);
  census inside = take(tabulation->points, det, zero);
  census corner = take(corners, corner_det, corner_zero);
  return judge(tabulation->element, &inside, &corner, fault);
}

double cdem_element_volume(const cdem_tabulation *tabulation, double thickness,
                           const double (*xyz)[3]) {
  int dimension = cdem_element_dimension(tabulation->element);
  double volume = 0.0, j[9];
  for (int q = 0; q < tabulation->points; q++)
    volume += tabulation->weight[q] *
              cdem_jacobian(dimension, tabulation->nodes, cdem_tabulated(tabulation, q), xyz, j);
  return dimension == 2 ? volume * thickness : volume;
}
