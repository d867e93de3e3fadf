/* Triaxial tests from the case to the folder: stages, stresses, scaled bits, broken runs. */
#include "run/resume.h"
#include "run/triaxial_box.h"

#include <math.h>

static cdem_run_summary run_it(const char *name, const char *folder) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  check_ok(run_case(name, folder, 0, NULL, &summary, &fault));
  return summary;
}

/* The last row before the shear: all sides carry the pressure. Then the plate goes down by the rate
 * times H0 a second, until ln(H0/H) is the strain; meanwhile the side keeps the pressure. */
static void check_stages(const char *folder, double strain, double side, double inertial) {
  const double pressure = 0.5e6;
  cdem_table table = read_rows(folder);
  int64_t last = table.rows - 1, before = 0;
  while (before < last && isnan(row_value(&table, before + 1, "axial_strain")))
    before++;
  assert_true(before > 10 && before < last - 10);
  check_near(row_value(&table, before, "confining_pressure"), pressure, 1e-12, 0.0);
  check_near(row_value(&table, before, "axial_stress"), pressure, 0.03, 0.0);
  /* nodes that sit fast between grains hand on a little from the moving plate to the end rings */
  check_near(row_value(&table, before, "bottom_stress"), pressure, 0.05, 0.0);
  check_near(row_value(&table, before, "lateral_stress"), pressure, 0.01, 0.0);
  check_near(row_value(&table, last, "axial_strain"), strain, 2e-3, 0.0);
  check_near(row_value(&table, last, "lateral_stress"), pressure, side, 0.0);
  check_near(row_value(&table, last, "inertial_number"), inertial, 0.06, 0.0);
  double height = row_value(&table, last, "height"), volume = row_value(&table, last, "volume");
  double axial = row_value(&table, last, "axial_stress"), sum = axial + 2.0 * pressure;
  check_near(row_value(&table, last, "stress_ratio"), 3.0 * (axial - pressure) / sum, 1e-12, 0.0);
  check_near(row_value(&table, last, "wall.top.fz"), axial * volume / height, 1e-12, 0.0);
  assert_true(row_value(&table, last, "stress_ratio") > 0.2);
  cdem_table_release(&table);
}

/* Of the rows: the peak and where it is; how far the volume has come back from where it was least.
 */
static void check_keys(const cdem_run_summary *summary, const char *folder) {
  double peak = -INFINITY, at = NAN, contraction = 0.0, dilation = 0.0;
  cdem_table table = read_rows(folder);
  for (int64_t i = 0; i < table.rows; i++) {
    double volumetric = row_value(&table, i, "volumetric_strain");
    double ratio = row_value(&table, i, "stress_ratio");
    if (isnan(ratio))
      continue;
    at = ratio > peak ? row_value(&table, i, "axial_strain") : at;
    peak = fmax(peak, ratio);
    contraction = fmax(contraction, volumetric);
    dilation = fmax(dilation, contraction - volumetric);
  }
  check_near(key_value(summary, "peak_stress_ratio"), peak, 1e-12, 0.0);
  check_near(key_value(summary, "strain_at_peak"), at, 1e-12, 0.0);
  check_near(key_value(summary, "dilation"), dilation, 1e-9, 1e-15);
  check_below(at, 0.0502);
  cdem_table_release(&table);
}

static void a_membrane_keeps_its_pressure(void **state) {
  (void)state;
  write_triaxial("box.yaml", 1.0, "{pressure: 0.5 MPa, inertial_number: 5e-3, strain: 0.05}");
  cdem_run_summary summary = run_it("box.yaml", "flexible");
  check_stages("flexible", 0.05, 0.01, 5e-3);
  check_keys(&summary, "flexible");
  check_below(summary.energy_error, 1e-3);
  assert_true(is_there("flexible/membrane.pvd"));
  cdem_run_summary_release(&summary);
}

/* Its servo lags behind by what the dashpots of its contacts take, in proportion to the rate. */
static void a_rigid_cylinder_keeps_it_too(void **state) {
  (void)state;
  write_triaxial("rigid.yaml", 1.0,
                 "{pressure: 0.5 MPa, inertial_number: 1e-3, strain: 0.03, boundary: cylinder, "
                 "side_material: smooth}");
  cdem_run_summary summary = run_it("rigid.yaml", "rigid");
  check_stages("rigid", 0.03, 0.01, 1e-3);
  cdem_run_summary_release(&summary);
}

/* Exactly scaled by 2: times and lengths double, stresses and strains have the same bits. */
static void a_scaled_specimen_has_scaled_bits(void **state) {
  (void)state;
  static const char *const same[] = {"axial_stress", "lateral_stress", "axial_strain",
                                     "volumetric_strain", "inertial_number"};
  cdem_table table[2];
  for (int k = 0; k < 2; k++) {
    char name[32], folder[32];
    snprintf(name, sizeof name, "scaled%d.yaml", k);
    snprintf(folder, sizeof folder, "scaled%d", k);
    write_triaxial(name, k + 1.0, "{pressure: 0.5 MPa, inertial_number: 2e-2, strain: 0.03}");
    cdem_run_summary summary = run_it(name, folder);
    cdem_run_summary_release(&summary);
    table[k] = read_rows(folder);
  }
  assert_int_equal(table[0].rows, table[1].rows);
  int64_t last = table[0].rows - 1;
  assert_true(row_value(&table[1], last, "time") == 2.0 * row_value(&table[0], last, "time"));
  assert_true(row_value(&table[1], last, "height") == 2.0 * row_value(&table[0], last, "height"));
  assert_true(row_value(&table[1], last, "volume") == 8.0 * row_value(&table[0], last, "volume"));
  for (size_t i = 0; i < sizeof same / sizeof *same; i++)
    assert_true(row_value(&table[1], last, same[i]) == row_value(&table[0], last, same[i]));
  for (int k = 0; k < 2; k++)
    cdem_table_release(&table[k]);
}

/* Dilation counts from rows that the second part has not seen. */
static void check_same_rows(const char *one, const char *other) {
  static const char *const name[] = {"axial_stress", "lateral_stress", "volume", "dilation",
                                     "energy_error"};
  cdem_table a = read_rows(one), b = read_rows(other);
  assert_int_equal(a.rows, b.rows);
  for (int64_t i = 0; i < a.rows; i++)
    for (size_t k = 0; k < sizeof name / sizeof *name; k++) {
      double x = row_value(&a, i, name[k]), y = row_value(&b, i, name[k]);
      if (x != y && !(isnan(x) && isnan(y)))
        fail_msg("row %d: %s %.17g and %.17g", (int)i, name[k], x, y);
    }
  cdem_table_release(&a);
  cdem_table_release(&b);
}

/* Wherever it was broken, before or in the shear, and whatever the threads. */
static void a_broken_test_goes_on_to_the_same_bits(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_triaxial("box.yaml", 1.0,
                 "{pressure: 0.5 MPa, consolidation: 20 ms, inertial_number: 2e-2, strain: 0.03}");
  check_ok(run_until("whole", false, 1 << 30, 1, &fault));
  for (int part = 0; part < 2; part++) {
    char folder[32];
    snprintf(folder, sizeof folder, "broken%d", part);
    cdem_status status = run_until(folder, false, part == 0 ? 60 : 720, 1, &fault);
    assert_int_equal(status, CDEM_INTERRUPTED);
    fault = (cdem_fault){0};
    cdem_table rows = read_rows(folder); /* the second time it shears already */
    assert_true(isnan(row_value(&rows, rows.rows - 1, "axial_strain")) == (part == 0));
    cdem_table_release(&rows);
    check_ok(run_until(folder, true, 1 << 30, 2, &fault));
    check_same_state("whole", folder);
    check_same_rows("whole", folder);
  }
}

/* Of grains that deform: broken where the step has just changed (their step follows their contacts
 * while the pressure rises), and in the shear. */
static void a_broken_test_of_deformable_grains_goes_on_too(void **state) {
  (void)state;
  static const int calls[] = {55, 57, 120, 160};
  cdem_fault fault = {0};
  write_case(
      "box.yaml",
      "safety: 0.5\n"
      "history_every: 0.1 ms\n"
      "grains:\n"
      "  dimension: 3\n"
      "  law: penalty\n"
      "  deformable: {shape: tetrasphere, refinement: 1}\n"
      "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.3], "
      "radius: "
      "25 mm, count: 78, seed: 3, compact: {height: 300 mm}}\n"
      "  materials: {rock: {density: 2650, young: 1 GPa, poisson: 0.2}}\n"
      "  most_overlap: 0.4\n"
      "contacts:\n"
      "  - {penalty_stiffness: 1e10, friction: 0.3, damping_ratio: 0.2}\n"
      "triaxial: {pressure: 0.5 MPa, consolidation: 3 ms, inertial_number: 2e-2, strain: 0.03}\n");
  check_ok(run_until("soft", false, 1 << 30, 1, &fault));
  for (size_t k = 0; k < sizeof calls / sizeof *calls; k++) {
    char folder[32];
    snprintf(folder, sizeof folder, "soft%zu", k);
    assert_int_equal(run_until(folder, false, calls[k], 1, &fault), CDEM_INTERRUPTED);
    fault = (cdem_fault){0};
    cdem_table rows = read_rows(folder);
    bool shears = !isnan(row_value(&rows, rows.rows - 1, "axial_strain"));
    assert_true(shears == (k >= 2));
    cdem_table_release(&rows);
    check_ok(run_until(folder, true, 1 << 30, 2, &fault));
    check_same_rows("soft", folder);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_membrane_keeps_its_pressure),
      cmocka_unit_test(a_rigid_cylinder_keeps_it_too),
      cmocka_unit_test(a_scaled_specimen_has_scaled_bits),
      cmocka_unit_test(a_broken_test_goes_on_to_the_same_bits),
      cmocka_unit_test(a_broken_test_of_deformable_grains_goes_on_too)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
