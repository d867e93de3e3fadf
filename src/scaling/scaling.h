/* Room scaling: exact scaling and coarse graining, as pure arithmetic on the numbers of a case.
 *
 * Exact scaling. Every quantity q has a dimension [L]^a [T]^b [M]^c, and three base ratios fix what
 * becomes of all (Wang et al. 2024, eqs 6 to 8): q' = lambda_q q, lambda_q = lambda_L^a lambda_T^b
 * lambda_M^c. With density and stress unchanged lambda_L = h, lambda_T = h, lambda_M = h^3 (eq 9);
 * other base ratios are allowed. Nothing here knows a key: dimension and tag come from the tables
 * of room cases, so that a key added there scales by itself.
 *
 * Where all base ratios are powers of two, every factor is one, multiplying by it is exact, and the
 * scaled run repeats the original to the last bit but for exponents: `cdem verify scaling`.
 *
 * Coarse graining. The domain keeps its size and is filled with grains h times as large: a window
 * of the exactly scaled system. What belongs to the grains follows eq 9; lengths, pressures and
 * gravity of the domain stay. So that the inertial number (rate d sqrt(rho/p)) stays, too, the
 * domain is driven slower: durations grow and speeds fall by h. In 2-D the layer of grains is
 * thicker by h with the grains, so that forces on the domain (pressure by length by thickness) grow
 * by h. Derivation: docs/theory/scaling.md.
 */
#ifndef CDEM_SCALING_SCALING_H
#define CDEM_SCALING_SCALING_H

#include "cases/case.h"
#include "cases/schema.h"

/* The base ratios: scaled by original. */
typedef struct {
  double length, time, mass;
} cdem_ratios;

/* Unchanged density and stress, eq 9: h, h, h^3. */
cdem_ratios cdem_ratios_of_size(double h);
/* Eq 8. */
double cdem_ratio(const cdem_ratios *ratios, cdem_dimension dimension);
/* Are all three powers of two? Then so is every factor. */
bool cdem_ratios_are_exact(const cdem_ratios *ratios);

typedef struct {
  cdem_ratios ratios; /* exact: of everything; coarse: of the grains, by eq 9 */
  bool coarse;
  bool rule; /* coarse: parameters of the grains follow eq 9; else their sizes alone do, which the
                source compares */
  bool slow; /* coarse: the domain is driven slower, which keeps the inertial number */
  int dim;   /* coarse: of the grains, 2 or 3 */
} cdem_scaling;

cdem_scaling cdem_scaling_exact(cdem_ratios ratios);
/* With rule and slow; dim: that of the case. */
cdem_scaling cdem_scaling_coarse(double h, int dim);

/* By what a number of this dimension, tag and keeps_rate (schema.h) is multiplied. */
double cdem_scaling_factor(const cdem_scaling *scaling, cdem_dimension dimension,
                           cdem_scale_tag tag, bool keeps_rate);

/* What becomes of one number of the case. */
typedef struct {
  const char *key;   /* of the case; good as long as the case */
  char *section;     /* of an added key; NULL else */
  const char *added; /* its name there; NULL: a number that the case gives */
  int64_t quantity;  /* of the case's places; -1: added */
  cdem_dimension dimension;
  cdem_scale_tag tag;
  bool counts;
  double factor, value; /* value: the scaled one, SI */
} cdem_scaled;

/* The numbers of the case in its order, then keys that were not given and whose default has a
 * dimension. */
typedef struct {
  int64_t count, capacity;
  cdem_scaled *item;
} cdem_scaled_list;
void cdem_scaled_list_release(cdem_scaled_list *list);

/* Columns of the history: the dimension of a key result's reference follows from them. */
typedef struct {
  void *context;
  const char *(*unit)(void *context, const char *column); /* NULL: no such column */
} cdem_scaling_columns;

/* Does the case have key results whose expected value depends on the unit of columns? */
bool cdem_scaling_needs_columns(const cdem_case *cases);

/* All numbers of a case that was read from a file without overrides. CDEM_INPUT, with the place and
 * the reason, where a case cannot be scaled. columns: NULL where they are not needed. */
cdem_status cdem_scaling_apply(const cdem_case *cases, const cdem_scaling *scaling,
                               const cdem_scaling_columns *columns, cdem_scaled_list *list,
                               cdem_fault *fault);

#endif
