/* Room springs: rows of the Poisson table against closed forms and planted pencils. */
#include "springs/poisson.h"

#include "springs/exact.h"
#include "support/test.h"

static cdem_status exact_family_block(void *context, double nu, double *s, cdem_fault *fault) {
  (void)fault;
  exact_block(context, nu, s);
  return CDEM_OK;
}

static bool cube_closed(cdem_class class_, double nu, cdem_closed *closed) {
  cdem_closed_cube(class_, &(cdem_closed_solid){1, nu, 1}, closed);
  return true;
}
static bool edge_closed(void *context, double nu, cdem_closed *closed) {
  (void)context;
  return cube_closed(CDEM_CLASS_EDGE, nu, closed);
}
static bool face_closed(void *context, double nu, cdem_closed *closed) {
  (void)context;
  return cube_closed(CDEM_CLASS_FACE, nu, closed);
}
static bool body_closed(void *context, double nu, cdem_closed *closed) {
  (void)context;
  return cube_closed(CDEM_CLASS_BODY, nu, closed);
}

typedef bool (*closed_call)(void *, double, cdem_closed *);
static const closed_call closed_of[CDEM_CLASS_COUNT] = {edge_closed, face_closed, body_closed};

static cdem_poisson_family exact_family(exact_pair *pair, closed_call closed) {
  return (cdem_poisson_family){.size = pair->size,
                               .context = pair,
                               .block = exact_family_block,
                               .factor = pair->plane_stress ? cdem_poisson_factor_plane_stress
                                                            : cdem_poisson_factor_solid,
                               .closed = closed,
                               .frame = true,
                               .low = -1.0,
                               .high = 0.5};
}

static void init_cube(cdem_class class_, bool known, exact_pair *pair, cdem_poisson_study *study) {
  cdem_fault fault = {0};
  *pair = exact_cube_pair(class_);
  cdem_poisson_family family = exact_family(pair, known ? closed_of[class_] : NULL);
  check_ok(cdem_poisson_study_init(&family, study, &fault));
}

/* The order is the source's in every form, so no value is taken for another. */
static void rows_are_the_closed_form(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int class_ = 0; class_ < CDEM_CLASS_COUNT; class_++) {
    cdem_poisson_study study;
    exact_pair pair;
    init_cube((cdem_class)class_, true, &pair, &study);
    for (int i = 1; i < 150; i++) {
      double nu = -1.0 + i * 0.01;
      cdem_poisson_row row;
      cdem_closed closed;
      check_ok(cdem_poisson_at(&study, nu, &row, &fault));
      cube_closed((cdem_class)class_, nu, &closed);
      assert_int_equal(row.form, closed.form);
      check_below(row.difference, 1e-13);
      if (closed.form == CDEM_FORM_COMPLEX)
        check_near(row.coupling, closed.coupling, 1e-12, 0);
      else
        assert_true(isnan(row.coupling));
      for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
          check_near(row.dir[k][d], closed.dir[k][d], 0, 1e-11);
    }
  }
}

static double alignment(const double a[3], const double b[3]) {
  return fabs(cdem_dot3(a, b));
}

/* At the touches, beside them, and as far away as the continuation reaches. At the kiss of the face
 * pair a plain decomposition of a rounded block has any direction at all. 1e-9 is the error of the
 * six-point continuation; without it the test fails by more than 0.1. */
static void directions_continue_through_touches(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double off[] = {0, 1e-12, -1e-10, 1e-8, -3e-7, 1e-6, 1e-5, -2e-4, 9e-4, 1.1e-3};
  for (int t = 0; t < 3; t++) {
    cdem_class class_ = t == 0 ? CDEM_CLASS_FACE : CDEM_CLASS_EDGE;
    double nu0 = 0.25 + (t == 0 ? 0 : t == 1 ? -1 : 1) * sqrt(3.0) / 8;
    cdem_poisson_study study;
    exact_pair pair;
    init_cube(class_, true, &pair, &study);
    for (size_t i = 0; i < sizeof off / sizeof off[0]; i++) {
      cdem_poisson_row row;
      cdem_closed closed;
      if (t > 0 && fabs(off[i]) > 2e-4)
        continue; /* the change of form is only 4.5e-3 away */
      check_ok(cdem_poisson_at(&study, nu0 + off[i], &row, &fault));
      cube_closed(class_, nu0 + off[i], &closed);
      assert_int_equal(row.form, CDEM_FORM_DIAGONAL);
      check_below(row.difference, 1e-13);
      for (int k = 0; k < 3; k++)
        check_near(alignment(row.dir[k], closed.dir[k]), 1.0, 0, 1e-14 + 1e-9 * 1e-9);
      for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
          check_near(row.dir[k][d], closed.dir[k][d], 0, 1e-8);
    }
  }
}

static void the_body_pair_lies_along_the_canonical_basis(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_poisson_study study;
  cdem_poisson_row row;
  exact_pair pair;
  init_cube(CDEM_CLASS_BODY, true, &pair, &study);
  assert_true(study.roots.double_everywhere);
  check_ok(cdem_poisson_at(&study, 0.3, &row, &fault));
  assert_int_equal(row.form, CDEM_FORM_DIAGONAL);
  check_near(row.frame_h, row.k[1] / 1.5, 1e-14, 0);
  check_near(row.cond, 1.0, 0, 1e-14);
  const double expected[3][3] = {{1 / sqrt(3.0), 1 / sqrt(3.0), 1 / sqrt(3.0)},
                                 {-1 / sqrt(6.0), -1 / sqrt(6.0), 2 / sqrt(6.0)},
                                 {-M_SQRT1_2, M_SQRT1_2, 0}};
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++)
      check_near(row.dir[k][d], expected[k][d], 0, 1e-14);
}

/* A whole table walked with the signs followed: no direction jumps, and none but the first row is
 * bound to the canonical sign (the edge's k1 turns through x at nu = 1/4). */
static void followed_signs_do_not_jump(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int class_ = 0; class_ < 2; class_++) {
    cdem_poisson_study study;
    cdem_poisson_row row = {0}, before;
    exact_pair pair;
    init_cube((cdem_class)class_, class_ == 0, &pair, &study);
    double start = 0.04, largest = 0;
    check_ok(cdem_poisson_follow(&study, start, &row, &fault));
    for (int i = 1; i <= 42; i++) {
      before = row;
      check_ok(cdem_poisson_follow(&study, start + 0.01 * i, &row, &fault));
      for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
          largest = fmax(largest, fabs(row.dir[k][d] - before.dir[k][d]));
    }
    check_below(largest, 0.12); /* steepest at the left end, beside the change of form */
    /* One long stride is many small ones. */
    cdem_poisson_row stride = {0};
    check_ok(cdem_poisson_follow(&study, start, &stride, &fault));
    check_ok(cdem_poisson_follow(&study, 0.46, &stride, &fault));
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 3; d++)
        check_near(stride.dir[k][d], row.dir[k][d], 0, 1e-9);
  }
}

/* Pencils V diag(lines) V^-1, over the factor. */
typedef struct {
  double line[3][2], v[9], inverse[9];
} planted;

static cdem_status planted_block(void *context, double nu, double *s, cdem_fault *fault) {
  (void)fault;
  planted *p = context;
  double l[9] = {0}, half[9];
  for (int i = 0; i < 3; i++)
    l[4 * i] = (p->line[i][0] + nu * p->line[i][1]) / cdem_poisson_factor_solid(nu);
  cdem_product3(p->v, l, half);
  cdem_product3(half, p->inverse, s);
  return CDEM_OK;
}

/* Each of k1, k2, k3 stays on its own line through all crossings, and each direction on its column.
 */
static void branches_keep_their_place_without_closed_forms(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_random random = {21};
  for (int trial = 0; trial < 20; trial++) {
    planted p;
    cdem_poisson_study study;
    cdem_poisson_row row;
    for (int i = 0; i < 3; i++)
      p.line[i][0] = cdem_random_uniform(&random, -1, 1),
      p.line[i][1] = cdem_random_uniform(&random, -3, 3);
    do
      for (int i = 0; i < 9; i++)
        p.v[i] = cdem_random_uniform(&random, -1, 1);
    while (fabs(cdem_inverse3(p.v, p.inverse)) < 0.3);
    cdem_poisson_family family = {.size = 3,
                                  .context = &p,
                                  .block = planted_block,
                                  .factor = cdem_poisson_factor_solid,
                                  .low = -1,
                                  .high = 0.5};
    check_ok(cdem_poisson_study_init(&family, &study, &fault));
    int line_of[3] = {0};
    for (int i = 1; i < 30; i++) {
      double nu = -1 + 0.05 * i, factor = cdem_poisson_factor_solid(nu);
      check_ok(cdem_poisson_at(&study, nu, &row, &fault));
      for (int k = 0; k < 3; k++) {
        if (i == 1)
          for (int line = 1; line < 3; line++)
            if (fabs(row.k[k] * factor - p.line[line][0] - nu * p.line[line][1]) <
                fabs(row.k[k] * factor - p.line[line_of[k]][0] - nu * p.line[line_of[k]][1]))
              line_of[k] = line;
        const double *line = p.line[line_of[k]];
        check_near(row.k[k] * factor, line[0] + nu * line[1], 0, 1e-11);
        double column[3] = {p.v[line_of[k]], p.v[3 + line_of[k]], p.v[6 + line_of[k]]};
        check_near(alignment(row.dir[k], column), cdem_norm3(column), 1e-9, 0);
      }
    }
  }
}

/* Complex below zero, a defect at zero, real above: the square's edge, plane strain. */
static void square_edge_passes_its_defect(void **state) {
  (void)state;
  cdem_fault fault = {0};
  exact_pair pair = {2, {1, 1, 0}, {-1, -1}, {1, -1}, 1, false};
  cdem_poisson_family family = exact_family(&pair, NULL);
  cdem_poisson_study study;
  cdem_poisson_row row = {0};
  check_ok(cdem_poisson_study_init(&family, &study, &fault));
  const double nu[] = {-0.1, 0.0, 5.6e-17, 0.1};
  const cdem_form form[] = {CDEM_FORM_COMPLEX, CDEM_FORM_JORDAN2, CDEM_FORM_JORDAN2,
                            CDEM_FORM_DIAGONAL};
  for (int i = 0; i < 4; i++) {
    check_ok(cdem_poisson_follow(&study, nu[i], &row, &fault));
    assert_int_equal(row.form, form[i]);
    assert_true(isnan(row.k[2]));
    cdem_closed closed;
    cdem_closed_rectangle_edge(&(cdem_closed_sheet){1, nu[i], 1, false}, 1, 1, &closed);
    check_near(row.k[0], closed.k[0], 0, form[i] == CDEM_FORM_JORDAN2 ? 2e-8 : 1e-14);
    if (form[i] == CDEM_FORM_JORDAN2)
      check_near(fabs(row.coupling), fabs(closed.coupling), 1e-7, 0);
    if (form[i] == CDEM_FORM_COMPLEX)
      check_near(row.coupling, closed.coupling, 1e-13, 0);
  }
}

static cdem_status quadratic_block(void *context, double nu, double *s, cdem_fault *fault) {
  (void)context, (void)fault;
  s[0] = nu * nu, s[1] = s[2] = 0, s[3] = 1;
  for (int i = 0; i < 4; i++)
    s[i] /= cdem_poisson_factor_solid(nu);
  return CDEM_OK;
}

static cdem_status failing_block(void *context, double nu, double *s, cdem_fault *fault) {
  (void)context, (void)s;
  return cdem_fail(fault, CDEM_NUMERIC, "no block at %g", nu);
}

static void mistakes_are_told(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_poisson_study study;
  cdem_poisson_row row = {.size = 7};
  exact_pair pair;
  init_cube(CDEM_CLASS_EDGE, true, &pair, &study);
  check_fails(cdem_poisson_at(&study, 0.5, &row, &fault), CDEM_INPUT,
              "Poisson's ratio 0.5 is outside its range: it must lie between -1 and 0.5");
  check_fails(cdem_poisson_at(&study, -1.0, &row, &fault), CDEM_INPUT, "between -1 and 0.5");
  check_fails(cdem_poisson_at(&study, NAN, &row, &fault), CDEM_INPUT, "outside its range");
  assert_int_equal(row.size, 7); /* untouched */
  cdem_poisson_family family = study.family;
  family.size = 4;
  check_fails(cdem_poisson_study_init(&family, &study, &fault), CDEM_USAGE, "must be 2 or 3");
  family.size = 2;
  family.block = quadratic_block;
  check_fails(cdem_poisson_study_init(&family, &study, &fault), CDEM_USAGE, "not linear");
  family.block = failing_block;
  check_fails(cdem_poisson_study_init(&family, &study, &fault), CDEM_NUMERIC, "no block at");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_the_closed_form),
      cmocka_unit_test(directions_continue_through_touches),
      cmocka_unit_test(the_body_pair_lies_along_the_canonical_basis),
      cmocka_unit_test(followed_signs_do_not_jump),
      cmocka_unit_test(branches_keep_their_place_without_closed_forms),
      cmocka_unit_test(square_edge_passes_its_defect),
      cmocka_unit_test(mistakes_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
