/* Quadrature rules on the six reference shapes.
 *
 * Products of Gauss-Legendre points where the shape is a product. A simplex or pyramid is the image
 * of a product under the collapsed coordinates x = (1 - z) a, y = (1 - z) b (pyramid), x = (1 - y)
 * a (triangle), both for the tetrahedron; the powers of (1 - z) that the Jacobian brings are the
 * weight of a Gauss-Jacobi rule (Stroud's conical product). Rules of n points a direction integrate
 * degree 2n - 1, without a table; the symmetric rules of degree 2 on triangle and tetrahedron,
 * which save points, are written out.
 *
 * GSL signals lack of memory through its error handler, which aborts unless the program switched
 * it off; nothing else here can fail inside GSL.
 */
#include "elements/basis.h"

#include <gsl/gsl_integration.h>

enum { MAX_LINE = 20 }; /* GSL tabulates Gauss-Legendre to full precision up to 20 points */

typedef struct {
  int points;
  double x[MAX_LINE], weight[MAX_LINE];
} line_rule;

/* n points for polynomials of `degree`; 0 when there is no such rule. */
static int line_points(int degree) {
  int points = degree / 2 + 1;
  return degree < 1 || points > MAX_LINE ? 0 : points;
}

/* Gauss-Legendre on low .. high. */
static bool legendre(int degree, double low, double high, line_rule *line) {
  line->points = line_points(degree);
  gsl_integration_glfixed_table *table =
      line->points == 0 ? NULL : gsl_integration_glfixed_table_alloc((size_t)line->points);
  if (table == NULL)
    return false;
  for (int i = 0; i < line->points; i++)
    gsl_integration_glfixed_point(low, high, (size_t)i, &line->x[i], &line->weight[i], table);
  gsl_integration_glfixed_table_free(table);
  return true;
}

/* Gauss-Jacobi on 0 .. 1 with the weight (1 - x)^power. */
static bool jacobi(int degree, int power, line_rule *line) {
  line->points = line_points(degree);
  gsl_integration_fixed_workspace *table =
      line->points == 0 ? NULL
                        : gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi,
                                                      (size_t)line->points, 0.0, 1.0, power, 0.0);
  if (table == NULL)
    return false;
  for (int i = 0; i < line->points; i++) {
    line->x[i] = gsl_integration_fixed_nodes(table)[i];
    line->weight[i] = gsl_integration_fixed_weights(table)[i];
  }
  gsl_integration_fixed_free(table);
  return true;
}

static void add(cdem_quadrature *rule, double x, double y, double z, double weight) {
  double *xi = rule->xi[rule->points];
  xi[0] = x, xi[1] = y, xi[2] = z;
  rule->weight[rule->points++] = weight;
}

bool cdem_rule_square(int degree, cdem_quadrature *rule) {
  line_rule line;
  if (!legendre(degree, -1.0, 1.0, &line) || line.points * line.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int j = 0; j < line.points; j++)
    for (int i = 0; i < line.points; i++)
      add(rule, line.x[i], line.x[j], 0.0, line.weight[i] * line.weight[j]);
  return true;
}

bool cdem_rule_cube(int degree, cdem_quadrature *rule) {
  line_rule line;
  if (!legendre(degree, -1.0, 1.0, &line) ||
      line.points * line.points * line.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int k = 0; k < line.points; k++)
    for (int j = 0; j < line.points; j++)
      for (int i = 0; i < line.points; i++)
        add(rule, line.x[i], line.x[j], line.x[k],
            line.weight[i] * line.weight[j] * line.weight[k]);
  return true;
}

bool cdem_rule_triangle(int degree, cdem_quadrature *rule) {
  if (degree == 2) {
    rule->points = 0;
    add(rule, 1.0 / 6.0, 1.0 / 6.0, 0.0, 1.0 / 6.0);
    add(rule, 2.0 / 3.0, 1.0 / 6.0, 0.0, 1.0 / 6.0);
    add(rule, 1.0 / 6.0, 2.0 / 3.0, 0.0, 1.0 / 6.0);
    return true;
  }
  line_rule a, y;
  if (!legendre(degree, 0.0, 1.0, &a) || !jacobi(degree, 1, &y) ||
      a.points * y.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int j = 0; j < y.points; j++)
    for (int i = 0; i < a.points; i++)
      add(rule, a.x[i] * (1.0 - y.x[j]), y.x[j], 0.0, a.weight[i] * y.weight[j]);
  return true;
}

bool cdem_rule_tetrahedron(int degree, cdem_quadrature *rule) {
  if (degree == 2) { /* (5 - sqrt 5)/20 three times and (5 + 3 sqrt 5)/20 */
    const double p = (5.0 - sqrt(5.0)) / 20.0, q = (5.0 + 3.0 * sqrt(5.0)) / 20.0;
    rule->points = 0;
    add(rule, p, p, p, 1.0 / 24.0);
    add(rule, q, p, p, 1.0 / 24.0);
    add(rule, p, q, p, 1.0 / 24.0);
    add(rule, p, p, q, 1.0 / 24.0);
    return true;
  }
  line_rule a, y, z;
  if (!legendre(degree, 0.0, 1.0, &a) || !jacobi(degree, 1, &y) || !jacobi(degree, 2, &z) ||
      a.points * y.points * z.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int k = 0; k < z.points; k++)
    for (int j = 0; j < y.points; j++)
      for (int i = 0; i < a.points; i++) {
        double top = 1.0 - z.x[k];
        add(rule, a.x[i] * (1.0 - y.x[j]) * top, y.x[j] * top, z.x[k],
            a.weight[i] * y.weight[j] * z.weight[k]);
      }
  return true;
}

bool cdem_rule_pyramid(int degree, cdem_quadrature *rule) {
  line_rule a, z;
  if (!legendre(degree, -1.0, 1.0, &a) || !jacobi(degree, 2, &z) ||
      a.points * a.points * z.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int k = 0; k < z.points; k++)
    for (int j = 0; j < a.points; j++)
      for (int i = 0; i < a.points; i++)
        add(rule, a.x[i] * (1.0 - z.x[k]), a.x[j] * (1.0 - z.x[k]), z.x[k],
            a.weight[i] * a.weight[j] * z.weight[k]);
  return true;
}

bool cdem_rule_wedge(int degree, cdem_quadrature *rule) {
  cdem_quadrature base;
  line_rule line;
  if (!cdem_rule_triangle(degree, &base) || !legendre(degree, -1.0, 1.0, &line) ||
      base.points * line.points > CDEM_MAX_POINTS)
    return false;
  rule->points = 0;
  for (int k = 0; k < line.points; k++)
    for (int i = 0; i < base.points; i++)
      add(rule, base.xi[i][0], base.xi[i][1], line.x[k], base.weight[i] * line.weight[k]);
  return true;
}
