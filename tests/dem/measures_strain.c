/* Strain of grains: exact for affine motions however they turn, periodic or not. */
#include "measures_support.h"

/* Turn about an axis (Rodrigues). */
static void turn(const double axis[3], double angle, double r[9]) {
  double n = cdem_norm3(axis), c = cos(angle), s = sin(angle);
  const double u[3] = {axis[0] / n, axis[1] / n, axis[2] / n};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[3 * i + j] = (i == j ? c : 0.0) + (1 - c) * u[i] * u[j];
  r[1] -= s * u[2], r[2] += s * u[1], r[3] += s * u[2];
  r[5] -= s * u[0], r[6] -= s * u[1], r[7] += s * u[0];
}

static void move(const double *from, int64_t grains, const double f[9], double *to) {
  for (int64_t i = 0; i < grains; i++)
    for (int c = 0; c < 3; c++)
      to[3 * i + c] = cdem_dot3(f + 3 * c, from + 3 * i) + 0.3 * c;
}

static void affine_motions_are_exact(void **unused) {
  (void)unused;
  static double moved[3 * MOST_GRAINS], gradient[9 * MOST_GRAINS];
  static const double stretch[3] = {1.3, 0.8, 1.1};
  for (int dim = 2; dim <= 3; dim++)
    for (double angle = 0.0; angle < 3.14; angle += 0.39) {
      cdem_fault fault = {0};
      assembly *m = random_assembly(dim, 400, 4);
      const double z[3] = {0, 0, 1}, any[3] = {0.3, -0.5, 0.8};
      double r[9], q[9], f[9] = {0}, u[9];
      turn(dim == 2 ? z : any, angle, r);
      turn(dim == 2 ? z : any + 0, 0.4, q);
      for (int i = 0; i < 3; i++) /* U = Q diag Q^T, so that F = R U */
        for (int j = 0; j < 3; j++) {
          u[3 * i + j] = 0;
          for (int k = 0; k < 3; k++)
            u[3 * i + j] += q[3 * i + k] * (dim == 2 && k == 2 ? 1 : stretch[k]) * q[3 * j + k];
        }
      cdem_product3(r, u, f);
      cdem_strain_reference *reference = NULL;
      check_ok(cdem_strain_reference_make(&m->s, 6, &reference, &fault));
      move(m->xyz, m->s.grains, f, moved);
      for (int64_t i = 0; i < m->s.grains && dim == 2; i++)
        moved[3 * i + 2] = 0;
      m->s.xyz = moved;
      cdem_grain_gradient_kernel(&m->s, reference, gradient);
      double l[3] = {log(1.3), log(0.8), dim == 2 ? 0 : log(1.1)}, mean = (l[0] + l[1] + l[2]) / 3;
      double wanted = 0;
      for (int k = 0; k < 3; k++)
        wanted += 2.0 / 3 * (l[k] - mean) * (l[k] - mean);
      for (int64_t i = 0; i < m->s.grains; i++) {
        double volumetric, effective, rotation[3];
        for (int k = 0; k < 9; k++) /* the least squares problem's condition, under 1e4 here */
          check_near(gradient[9 * i + k], f[k] - (k % 4 == 0), 0, 1e-10);
        cdem_strain_measure(dim, CDEM_STRAIN_HENCKY, gradient + 9 * i, &volumetric, &effective,
                            rotation);
        check_near(volumetric, 3 * mean, 0, 1e-10);
        check_near(effective, sqrt(wanted), 0, 1e-10);
        for (int c = 0; c < 3; c++)
          check_near(rotation[c], dim == 2 ? (c == 2) * angle : angle * any[c] / cdem_norm3(any), 0,
                     1e-9);
      }
      cdem_strain_reference_destroy(&reference);
      assert_null(reference);
      free(m);
    }
}

/* Half a turn, and small strains to all their digits. */
static void measures_of_gradients(void **unused) {
  (void)unused;
  const double half[9] = {0, 0, 0, 0, -2, 0, 0, 0, -2}; /* about x */
  double v, e, w[3];
  cdem_strain_measure(3, CDEM_STRAIN_HENCKY, half, &v, &e, w);
  check_near(v, 0, 0, 1e-14);
  check_near(e, 0, 0, 1e-14);
  check_near(fabs(w[0]), 3.14159265358979323846, 1e-12, 0);
  for (double s = 1e-3; s > 1e-13; s *= 0.01) { /* simple shear: e_eff = s/sqrt(3) to first order */
    const double shear[9] = {0, s, 0, 0, 0, 0, 0, 0, 0};
    cdem_strain_measure(2, CDEM_STRAIN_HENCKY, shear, &v, &e, w);
    check_near(e, s / sqrt(3.0), s * s + 1e-14, 0);
    check_near(v, 0, 0, 1e-15 * s + 1e-30);
    check_near(w[2], -0.5 * s, s * s + 1e-14, 0);
    cdem_strain_measure(2, CDEM_STRAIN_SMALL, shear, &v, &e, NULL);
    check_near(e, s / sqrt(3.0), 1e-14, 0);
    assert_true(v == 0.0);
  }
  /* Turned by theta the small strain sees 2 (cos theta - 1) of volume, Hencky none. */
  const double c = cos(0.3) - 1, s = sin(0.3), turned[9] = {c, -s, 0, s, c, 0, 0, 0, 0};
  cdem_strain_measure(2, CDEM_STRAIN_SMALL, turned, &v, NULL, NULL);
  check_near(v, 2 * c, 1e-15, 0);
  cdem_strain_measure(2, CDEM_STRAIN_HENCKY, turned, &v, &e, w);
  check_near(v, 0, 0, 1e-15);
  check_near(w[2], 0.3, 1e-15, 0);
  const double inside_out[9] = {-3, 0, 0, 0, 0, 0, 0, 0, 0};
  cdem_strain_measure(2, CDEM_STRAIN_HENCKY, inside_out, &v, &e, w);
  assert_true(isnan(v) && isnan(e));
}

static void lonely_grains_have_no_strain(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  double gradient[9 * 4];
  assembly *m = assembly_new(2);
  for (int i = 0; i < 4; i++) /* three in a row, one alone */
    put_grain(m, i < 3 ? 2.0 * i : 50, 0, 0, 1);
  cdem_strain_reference *reference = NULL;
  check_ok(cdem_strain_reference_make(&m->s, 0, &reference, &fault));
  cdem_grain_gradient_kernel(&m->s, reference, gradient);
  for (int i = 0; i < 4; i++)
    assert_true(isnan(gradient[9 * i]));
  cdem_strain_reference_destroy(&reference);
  check_fails(cdem_strain_reference_make(&m->s, 1.5, &reference, &fault), CDEM_USAGE,
              "choose 2 (touching) to 100");
  assert_null(reference);
  cdem_memory_fail_after(3);
  check_fails(cdem_strain_reference_make(&m->s, 0, &reference, &fault), CDEM_MEMORY, "");
  cdem_memory_fail_after(-1);
  assert_null(reference);
  free(m);
}

/* A cell sheared by half its side, and grains wrapped back into it. */
static void cells_deform_with_their_grains(void **unused) {
  (void)unused;
  static double moved[3 * MOST_GRAINS], gradient[9 * MOST_GRAINS];
  cdem_fault fault = {0};
  assembly *m = random_assembly(2, 300, 6);
  cdem_cell cell = {
      .periodic = {true, true, false}, .corner = {-1, -1, 0}, .h = {2, 0, 0, 0, 2, 0, 0, 0, 0}};
  m->s.cell = &cell;
  cdem_strain_reference *reference = NULL;
  check_ok(cdem_strain_reference_make(&m->s, 4, &reference, &fault));
  const double f[9] = {1.1, 0.5, 0, 0, 0.9, 0, 0, 0, 1};
  double h[9];
  cdem_product3(f, cell.h, h);
  memcpy(cell.h, h, sizeof h);
  for (int64_t i = 0; i < m->s.grains; i++) {
    double from[3] = {m->xyz[3 * i] + 1, m->xyz[3 * i + 1] + 1, 0};
    for (int c = 0; c < 3; c++)
      moved[3 * i + c] = cdem_dot3(f + 3 * c, from) - (c < 2) + (c == 0 ? 0.7 : 0.0);
    cdem_cell_wrap(&cell, moved + 3 * i);
  }
  m->s.xyz = moved;
  cdem_grain_gradient_kernel(&m->s, reference, gradient);
  for (int64_t i = 0; i < m->s.grains; i++)
    for (int k = 0; k < 9; k++)
      check_near(gradient[9 * i + k], f[k] - (k % 4 == 0), 0, 1e-10);
  cdem_strain_reference_destroy(&reference);
  free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(affine_motions_are_exact),
      cmocka_unit_test(measures_of_gradients),
      cmocka_unit_test(lonely_grains_have_no_strain),
      cmocka_unit_test(cells_deform_with_their_grains),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
