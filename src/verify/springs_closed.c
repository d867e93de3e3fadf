/* Checks of single blocks against what is known on paper. */
#include "verify/nets.h"
#include "verify/specimen.h"
#include "verify/springs.h"

#include <math.h>
#include <string.h>

static double difference(const double *a, const double *b, int n) {
  double d[9];
  for (int i = 0; i < n; i++)
    d[i] = a[i] - b[i];
  return cdem_frobenius(d, n) / cdem_frobenius(b, n);
}

static cdem_status init_plain(const char *name, bool plane_stress, cdem_specimen *specimen,
                              cdem_fault *fault) {
  cdem_specimen_options options = {.element = cdem_element_find(name)};
  options.section.plane = plane_stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN;
  CDEM_REQUIRE(options.element != NULL, fault, CDEM_INPUT, "there is no element '%s'", name);
  return cdem_specimen_init(&options, specimen, fault);
}

/* The first pair of a class in the element's numbering. */
static cdem_specimen_pair first_pair(const cdem_specimen *specimen, cdem_class class_) {
  int pair = 0;
  while (cdem_specimen_pair_at(specimen, pair).class_ != class_)
    pair++;
  return cdem_specimen_pair_at(specimen, pair);
}

/* Worst |S - closed form| / |S| of one pair over nu = from .. to. */
static cdem_status worst_closed(const cdem_specimen *specimen, cdem_class class_, double from,
                                double to, int steps, double *value, cdem_fault *fault) {
  cdem_specimen_pair pair = first_pair(specimen, class_);
  cdem_poisson_family family = cdem_specimen_family(&pair);
  *value = 0.0;
  for (int i = 0; i <= steps; i++) {
    double nu = steps == 0 ? from : from + (to - from) * i / steps, s[9], rebuilt[9];
    cdem_closed closed;
    CDEM_TRY(family.block(family.context, nu, s, fault));
    family.closed(family.context, nu, &closed);
    cdem_closed_rebuild(&closed, rebuilt);
    *value = fmax(*value, difference(rebuilt, s, family.size * family.size));
  }
  return CDEM_OK;
}

cdem_status cdem_springs_measure_cube_closed_form(int parameter, double *value, cdem_fault *fault) {
  static const struct {
    cdem_class class_;
    double from, to;
  } range[] = {
      {CDEM_CLASS_EDGE, 0.0295, 0.4705}, {CDEM_CLASS_EDGE, -0.95, 0.0285},
      {CDEM_CLASS_EDGE, 0, 0},           {CDEM_CLASS_FACE, -0.1, 0.49},
      {CDEM_CLASS_FACE, -0.95, -0.105},  {CDEM_CLASS_BODY, -0.95, 0.49},
  };
  double from = range[parameter].from, to = range[parameter].to;
  int steps = 60;
  if (parameter == 2) {
    from = to = 0.25 - 5.0 * sqrt(2.0) / 32.0;
    steps = 0;
  }
  cdem_specimen cube = {0};
  CDEM_TRY(init_plain("hex8", false, &cube, fault));
  cdem_status status = worst_closed(&cube, range[parameter].class_, from, to, steps, value, fault);
  cdem_specimen_release(&cube);
  return status;
}

cdem_status cdem_springs_measure_square_closed_form(int parameter, double *value,
                                                    cdem_fault *fault) {
  static const double from[] = {0.01, -0.95, 0.0, -0.95}, to[] = {0.49, -0.01, 0.0, 0.49};
  int form = parameter % 4;
  cdem_specimen square = {0};
  CDEM_TRY(init_plain("quad4", parameter >= 4, &square, fault));
  cdem_status status = worst_closed(&square, form == 3 ? CDEM_CLASS_FACE : CDEM_CLASS_EDGE,
                                    from[form], to[form], form == 2 ? 0 : 60, value, fault);
  cdem_specimen_release(&square);
  return status;
}

cdem_status cdem_springs_measure_triangle_closed_form(int parameter, double *value,
                                                      cdem_fault *fault) {
  cdem_specimen triangle = {0};
  CDEM_TRY(init_plain("tri3", parameter == 1, &triangle, fault));
  cdem_status status = worst_closed(&triangle, CDEM_CLASS_EDGE, 0.0, 0.49, 60, value, fault);
  cdem_specimen_release(&triangle);
  return status;
}

/* ---- the pencil of a pair ---- */

static cdem_status study_of(cdem_specimen *specimen, cdem_specimen_pair *pair, cdem_class class_,
                            cdem_poisson_study *study, cdem_fault *fault) {
  *pair = first_pair(specimen, class_);
  cdem_poisson_family family = cdem_specimen_family(pair);
  return cdem_poisson_study_init(&family, study, fault);
}

static cdem_status roots_of(const char *element, bool plane_stress, cdem_class class_,
                            cdem_poisson_roots *roots, cdem_fault *fault) {
  cdem_specimen specimen = {0};
  cdem_specimen_pair pair;
  cdem_poisson_study study;
  CDEM_TRY(init_plain(element, plane_stress, &specimen, fault));
  cdem_status status = study_of(&specimen, &pair, class_, &study, fault);
  if (status == CDEM_OK)
    *roots = study.roots;
  cdem_specimen_release(&specimen);
  return status;
}

static cdem_status cube_root(int parameter, cdem_poisson_root *root, cdem_fault *fault) {
  cdem_poisson_roots roots;
  CDEM_TRY(roots_of("hex8", false, (cdem_class)(parameter / 10), &roots, fault));
  CDEM_REQUIRE(parameter % 10 < roots.count, fault, CDEM_NUMERIC,
               "only %d critical ratios were found", roots.count);
  *root = roots.root[parameter % 10];
  return CDEM_OK;
}

cdem_status cdem_springs_measure_root(int parameter, double *value, cdem_fault *fault) {
  cdem_poisson_root root = {0};
  CDEM_TRY(cube_root(parameter, &root, fault));
  *value = root.nu;
  return CDEM_OK;
}

cdem_status cdem_springs_measure_root_order(int parameter, double *value, cdem_fault *fault) {
  cdem_poisson_root root = {0};
  CDEM_TRY(cube_root(parameter, &root, fault));
  *value = root.order;
  return CDEM_OK;
}

cdem_status cdem_springs_measure_root_count(int parameter, double *value, cdem_fault *fault) {
  cdem_poisson_roots roots;
  CDEM_TRY(roots_of("hex8", false, (cdem_class)parameter, &roots, fault));
  *value = roots.count;
  return CDEM_OK;
}

cdem_status cdem_springs_measure_square_root(int parameter, double *value, cdem_fault *fault) {
  cdem_poisson_roots roots;
  CDEM_TRY(roots_of("quad4", parameter == 1, CDEM_CLASS_EDGE, &roots, fault));
  CDEM_REQUIRE(roots.count == 1, fault, CDEM_NUMERIC, "%d critical ratios were found, not 1",
               roots.count);
  *value = roots.root[0].nu;
  return CDEM_OK;
}

cdem_status cdem_springs_measure_cube_stiffnesses(int parameter, double *value, cdem_fault *fault) {
  cdem_specimen cube = {0};
  cdem_specimen_pair pair;
  cdem_poisson_study study;
  CDEM_TRY(init_plain("hex8", false, &cube, fault));
  cdem_status status = study_of(&cube, &pair, (cdem_class)parameter, &study, fault);
  *value = 0.0;
  for (int i = 1; i < 150 && status == CDEM_OK; i++) {
    cdem_poisson_row row;
    status = cdem_poisson_at(&study, -1.0 + 0.01 * i, &row, fault);
    if (status == CDEM_OK)
      *value = fmax(*value, row.difference);
  }
  cdem_specimen_release(&cube);
  return status;
}

/* ---- numbers printed in the source ---- */

/* D, p, q of the cubic of a block (source, eqs (3)-(5)). */
static void depressed(const double m[9], double out[3]) {
  double k1 = -(m[0] + m[4] + m[8]), k3 = -cdem_det3(m);
  double k2 = m[4] * m[8] - m[5] * m[7] + m[0] * m[8] - m[2] * m[6] + m[0] * m[4] - m[1] * m[3];
  double p = k2 - k1 * k1 / 3.0, q = 2.0 * k1 * k1 * k1 / 27.0 - k1 * k2 / 3.0 + k3;
  out[0] = q * q / 4.0 + p * p * p / 27.0;
  out[1] = p;
  out[2] = q;
}

cdem_status cdem_springs_measure_coefficient(int parameter, double *value, cdem_fault *fault) {
  const double mu = 0.1, c = 1.0 / ((1.0 + mu) * (1.0 - 2.0 * mu)), square = mu * mu;
  const double edge = 64 * square - 32 * mu + 1, touch = 4 * mu - 1;
  /* What stands behind the number: [class][D, p, q]; the body's D is zero. */
  const double behind[3][3] = {{(512 * square - 256 * mu + 7) * edge * edge,
                                384 * square - 192 * mu + 5, 72 * square - 36 * mu + 1},
                               {(16 * square - 8 * mu - 1) * touch * touch * touch * touch,
                                48 * square - 24 * mu - 5, 144 * square - 72 * mu - 7},
                               {1, 1, -1}};
  int class_ = parameter / 10, which = parameter % 10, power = which == 0 ? 6 : which + 1;
  cdem_specimen cube = {0};
  double s[9], number[3];
  CDEM_TRY(init_plain("hex8", false, &cube, fault));
  cdem_specimen_pair pair = first_pair(&cube, (cdem_class)class_);
  cdem_poisson_family family = cdem_specimen_family(&pair);
  cdem_status status = family.block(family.context, mu, s, fault);
  cdem_specimen_release(&cube);
  CDEM_TRY(status);
  depressed(s, number);
  *value = number[which] / (behind[class_][which] * pow(c, power));
  return CDEM_OK;
}

cdem_status cdem_springs_measure_frame_rebuild(int parameter, double *value, cdem_fault *fault) {
  cdem_specimen cube = {0};
  double s[9], rebuilt[9], largest = 0.0;
  CDEM_TRY(init_plain("hex8", false, &cube, fault));
  cdem_specimen_pair pair = first_pair(&cube, CDEM_CLASS_BODY);
  cdem_poisson_family family = cdem_specimen_family(&pair);
  cdem_spring_set set;
  cdem_status status = family.block(family.context, 0.3, s, fault);
  if (status == CDEM_OK)
    status = cdem_springs_from_block(s, 3, true, &set, fault);
  cdem_specimen_release(&cube);
  CDEM_TRY(status);
  CDEM_REQUIRE(set.form == CDEM_FORM_FRAME, fault, CDEM_NUMERIC,
               "the cube's body pair was not recognised as a frame");
  for (int r = 1; r < 4 && parameter == 1; r++)
    set.row[r].stiffness *= 216.0 / 432.0;
  cdem_springs_rebuild(&set, rebuilt);
  *value = 0.0;
  for (int i = 0; i < 9; i++) {
    largest = fmax(largest, fabs(s[i]));
    *value = fmax(*value, fabs(rebuilt[i] - s[i]));
  }
  *value /= largest;
  return CDEM_OK;
}

/* ---- nets ---- */

static cdem_status bond(int parameter, double s[4], cdem_fault *fault) {
  return cdem_net_triangle_block(parameter == 1, parameter == 1 ? 1.0 / 3.0 : 0.25, s, fault);
}

cdem_status cdem_springs_measure_triangle_across(int parameter, double *value, cdem_fault *fault) {
  double s[4];
  CDEM_TRY(bond(parameter, s, fault));
  *value = fmax(fabs(s[3]), fmax(fabs(s[1]), fabs(s[2]))) / s[0];
  return CDEM_OK;
}

cdem_status cdem_springs_measure_triangle_along(int parameter, double *value, cdem_fault *fault) {
  double s[4];
  CDEM_TRY(bond(parameter, s, fault));
  *value = s[0];
  return CDEM_OK;
}

cdem_status cdem_springs_measure_interior_sum(int parameter, double *value, cdem_fault *fault) {
  static const double nu[] = {-0.5, 0.0, 0.25, 0.3, 0.45};
  *value = 0.0;
  for (size_t i = 0; i < sizeof nu / sizeof nu[0]; i++) {
    double s[9], rebuilt[9];
    cdem_closed closed;
    CDEM_TRY(cdem_net_cube_block((cdem_class)parameter, nu[i], s, fault));
    cdem_closed_cube_interior((cdem_class)parameter, &(cdem_closed_solid){1.0, nu[i], 1.0},
                              &closed);
    cdem_closed_rebuild(&closed, rebuilt);
    *value = fmax(*value, difference(s, rebuilt, 9));
  }
  return CDEM_OK;
}
