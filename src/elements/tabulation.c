#include "elements/basis.h"

#include <stdlib.h>

void cdem_tabulation_release(cdem_tabulation *tabulation) {
  free(tabulation->weight);
  free(tabulation->n);
  free(tabulation->dn);
  free(tabulation->corner);
  *tabulation = (cdem_tabulation){0};
}

static cdem_status allocate(cdem_tabulation *table, int corners, cdem_fault *fault) {
  CDEM_NEW(table->weight, table->points, fault);
  CDEM_NEW(table->n, table->points * table->nodes, fault);
  CDEM_NEW(table->dn, table->points * table->nodes * 3, fault);
  CDEM_NEW(table->corner, corners * table->nodes * 3, fault);
  return CDEM_OK;
}

/* The highest degree the element has a rule for: of use in a message only. */
static int highest_degree(const cdem_element *element, cdem_quadrature *rule) {
  int degree = 1;
  while (element->quadrature(degree + 1, rule))
    degree++;
  return degree;
}

cdem_status cdem_tabulation_init(const cdem_element *element, int degree,
                                 cdem_tabulation *tabulation, cdem_fault *fault) {
  cdem_quadrature rule;
  if (degree < 0 || !element->quadrature(degree, &rule))
    return cdem_fail(
        fault, CDEM_USAGE,
        "quadrature degree %d is out of range: %s takes 1 to %d, or 0 for its own rule "
        "(%s)",
        degree, element->name, highest_degree(element, &rule), element->rule);
  const cdem_shape_info *shape = cdem_shape_get(element->shape);
  cdem_tabulation table = {.element = element, .points = rule.points, .nodes = shape->nodes};
  cdem_status status = allocate(&table, shape->corners, fault);
  if (status != CDEM_OK) {
    cdem_tabulation_release(&table);
    return status;
  }
  for (int q = 0; q < rule.points; q++) {
    table.weight[q] = rule.weight[q];
    element->shape_functions(rule.xi[q], table.n + (ptrdiff_t)q * table.nodes,
                             (double(*)[3])(table.dn + (ptrdiff_t)q * table.nodes * 3));
  }
  for (int c = 0; c < shape->corners; c++)
    element->shape_functions(element->reference[c], NULL,
                             (double(*)[3])(table.corner + (ptrdiff_t)c * table.nodes * 3));
  *tabulation = table;
  return CDEM_OK;
}
