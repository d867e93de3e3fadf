/* The spring network inside a body beside the nets of other authors. */
#include "poisson.h"
#include "springs/closed.h"
#include "verify/nets.h"

#include <math.h>
#include <string.h>

enum { CASE, NU, DIRECTION, ASSEMBLED, REFERENCE, DIFFERENCE, VERDICT };

/* Rounding of an assembled sum; the references are exact. */
static const double bound = 1e-12;

static cdem_status add_columns(cdem_table *table, cdem_fault *fault) {
  static const char *const name[] = {"case",      "nu",         "direction", "assembled",
                                     "reference", "difference", "verdict"};
  for (int c = 0; c <= VERDICT; c++)
    CDEM_TRY(cdem_table_add_column(table, name[c],
                                   c == CASE || c == DIRECTION || c == VERDICT ? CDEM_COLUMN_TEXT
                                                                               : CDEM_COLUMN_REAL,
                                   c == ASSEMBLED || c == REFERENCE ? "E L" : "", fault));
  return CDEM_OK;
}

typedef struct {
  const char *name, *direction;
  double nu, assembled, reference, scale; /* scale: of the difference */
} comparison;

static cdem_status add_row(const comparison *c, cdem_table *table, bool *agree, cdem_fault *fault) {
  double difference = fabs(c->assembled - c->reference) / c->scale;
  bool good = difference <= bound;
  CDEM_TRY(cdem_table_add_row(table, fault));
  CDEM_TRY(cdem_table_set_text(table, CASE, c->name, fault));
  cdem_table_set_real(table, NU, c->nu);
  CDEM_TRY(cdem_table_set_text(table, DIRECTION, c->direction, fault));
  cdem_table_set_real(table, ASSEMBLED, c->assembled);
  cdem_table_set_real(table, REFERENCE, c->reference);
  cdem_table_set_real(table, DIFFERENCE, difference);
  *agree = *agree && good;
  return cdem_table_set_text(table, VERDICT, good ? "agrees" : "DIFFERS", fault);
}

/* d^T s d. */
static double along(const double *s, int size, const double *d) {
  double sum = 0.0;
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++)
      sum += d[i] * s[size * i + j] * d[j];
  return sum;
}

/* Table 5: the assembled value along each of Gusev's three directions, and everything else of the
 * block as a fourth number that must be zero. */
static cdem_status compare_gusev(cdem_table *table, bool *agree, cdem_fault *fault) {
  static const double nu[] = {0.0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.45};
  static const char *const direction[] = {"normal", "tangential 1", "tangential 2", "coupling"};
  for (int class_ = CDEM_CLASS_COUNT - 1; class_ >= 0; class_--)
    for (size_t i = 0; i < sizeof nu / sizeof nu[0]; i++) {
      double s[9], rebuilt[9], rest = 0.0;
      cdem_closed closed;
      CDEM_TRY(cdem_net_cube_block((cdem_class)class_, nu[i], s, fault));
      cdem_closed_cube_interior((cdem_class)class_, &(cdem_closed_solid){1.0, nu[i], 1.0}, &closed);
      cdem_closed_rebuild(&closed, rebuilt);
      for (int e = 0; e < 9; e++)
        rest = fmax(rest, fabs(s[e] - rebuilt[e]));
      for (int k = 0; k < 4; k++) {
        comparison c = {
            cdem_class_name((cdem_class)class_), direction[k], nu[i], rest, 0.0, fabs(closed.k[0])};
        if (k < 3) {
          c.assembled = along(s, 3, closed.dir[k]);
          c.reference = closed.k[k];
        }
        CDEM_TRY(add_row(&c, table, agree, fault));
      }
    }
  return CDEM_OK;
}

/* A triangular net of central springs k has k = (sqrt(3)/2) E' t with E' = E in plane stress and
 * E/(1 - nu^2) in plane strain, and no other ratio than 1/3 and 1/4. */
static cdem_status compare_net2d(cdem_table *table, bool *agree, cdem_fault *fault) {
  static const double x[] = {1, 0}, y[] = {0, 1};
  for (int plane_stress = 0; plane_stress < 2; plane_stress++) {
    const char *name = plane_stress ? "plane stress" : "plane strain";
    double nu = plane_stress ? 1.0 / 3.0 : 0.25, s[4];
    double k = 0.5 * sqrt(3.0) / (plane_stress ? 1.0 : 1.0 - nu * nu);
    CDEM_TRY(cdem_net_triangle_block(plane_stress, nu, s, fault));
    const comparison c[3] = {{name, "along the bond", nu, along(s, 2, x), k, k},
                             {name, "across the bond", nu, along(s, 2, y), 0.0, k},
                             {name, "coupling", nu, fmax(fabs(s[1]), fabs(s[2])), 0.0, k}};
    for (int i = 0; i < 3; i++)
      CDEM_TRY(add_row(&c[i], table, agree, fault));
  }
  return CDEM_OK;
}

cdem_status poisson_compare(const char *what, cdem_table *table, bool *agree, cdem_fault *fault) {
  *agree = true;
  CDEM_TRY(add_columns(table, fault));
  return strcmp(what, "gusev") == 0 ? compare_gusev(table, agree, fault)
                                    : compare_net2d(table, agree, fault);
}
