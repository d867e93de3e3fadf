/* Room elements: Cosserat moduli of discs from their contacts, against sums over contacts that know
 * no formula: directions one by one, and the lattice disc by disc. Every refusal. */
#include "elements/specimens.h"

static double d[36];
static const cdem_section unit_section = {CDEM_PLANE_STRAIN, 1.0};
static const double r = 0.05, kn = 2.5e8, ks = 5e7, kw = 2e5, density = 0.6;

enum { LATTICE, AVERAGE, PRINTED };

static cdem_material packing(int which) {
  return specimen(FIRST_PACKING + which);
}

static void moduli(const cdem_material *material, const cdem_section *section) {
  cdem_fault fault = {0};
  int rows;
  check_ok(cdem_material_moduli(material, CDEM_MODULI_PLANE_COSSERAT, section, d, &rows, &fault));
}

/* Twice the energy of `contacts` contacts per area whose normals point at `angle` + k pi/count, in
 * a homogeneous state: strain (xx yy xy yx), curvature. Strain xy is u_y,x - omega: the difference
 * of two displacements along i is 2 r n_j e_ji. */
static double contact_energy(int count, double angle, double contacts, const double state[6]) {
  double sum = 0.0;
  for (int k = 0; k < count; k++) {
    double t = angle + 3.14159265358979323846 * k / count, n[2] = {cos(t), sin(t)};
    double step[2] = {2 * r * (n[0] * state[0] + n[1] * state[3]),
                      2 * r * (n[0] * state[2] + n[1] * state[1])};
    double normal = step[0] * n[0] + step[1] * n[1], shear = step[1] * n[0] - step[0] * n[1];
    double roll = 2 * r * (n[0] * state[4] + n[1] * state[5]);
    sum += kn * normal * normal + ks * shear * shear + kw * roll * roll;
  }
  return contacts * sum / count;
}

static double modulus_energy(const double state[6]) {
  double sum = 0.0;
  for (int i = 0; i < 36; i++)
    sum += state[i / 6] * d[i] * state[i % 6];
  return sum;
}

static void check_energies(int count, double angle, double contacts) {
  cdem_random random = {3};
  for (int trial = 0; trial < 40; trial++) {
    double state[6];
    for (int i = 0; i < 6; i++)
      state[i] = cdem_random_uniform(&random, -1, 1) * (i < 4 ? 1.0 : 1.0 / r);
    check_near(modulus_energy(state), contact_energy(count, angle, contacts, state), 1e-13, 0);
  }
}

static void lattice_is_the_sum_over_two_directions(void **state) {
  (void)state;
  cdem_material m = packing(LATTICE);
  moduli(&m, &unit_section);
  check_energies(2, 0.25 * 3.14159265358979323846, 1.0 / (2.0 * r * r));
  check_near(d[0], 150e6, 1e-15, 0); /* table 1 of the source: kn 2.5e8, ks 5e7 N/m */
  check_near(d[14], 150e6, 1e-15, 0);
  check_near(d[1], 100e6, 1e-15, 0);
  check_near(d[15], 100e6, 1e-15, 0);
  check_near(d[28], kw, 1e-15, 0);
}

/* Products of four cosines are integrated exactly by five directions or more. */
static void average_is_the_mean_over_directions(void **state) {
  (void)state;
  cdem_material m = packing(AVERAGE);
  moduli(&m, &unit_section);
  check_energies(360, 0.1, density / (r * r));
  check_energies(5, 0.3, density / (r * r));
  /* z = 4, phi = pi/4: the lattice's contacts, and its mean over all turns of it */
  m.parameter[4] = 0.5;
  moduli(&m, &unit_section);
  check_energies(360, 0.0, 1.0 / (2.0 * r * r));
}

/* Eqs 21-24 by their own letters, with table 1; both sections. */
static void printed_is_as_printed(void **state) {
  (void)state;
  cdem_material m = packing(PRINTED);
  const double kr = 1e6, l = 0.04;
  double g = density / 2 * (2 * kn + 3 * ks), lambda = density / 2 * (kn - ks);
  double gc = 2 * density / 3 * ks;
  double lc = sqrt(4 * (2 * l * l * ks + r * r * kr + kw) / (3 * (kn + ks)));
  moduli(&m, &unit_section);
  check_near(d[0], lambda + 2 * g, 1e-14, 0);
  check_near(d[1], lambda, 1e-14, 0);
  check_near(d[14], g + gc, 1e-14, 0);
  check_near(d[15], g - gc, 1e-14, 0);
  check_near(d[28], g * lc * lc, 1e-14, 0);
  check_near(cdem_material_length(&m), lc, 1e-14, 0);
  const cdem_section sheet = {CDEM_PLANE_STRESS, 1.0};
  double young = g * (3 * lambda + 2 * g) / (lambda + g), nu = lambda / (2 * (lambda + g));
  moduli(&m, &sheet);
  check_near(d[0], young / (1 - nu * nu), 1e-14, 0);
  check_near(d[1], nu * young / (1 - nu * nu), 1e-14, 0);
}

/* Twice the energy per area density NV of contacts in space, `turn` the rotation's difference to
 * the spin about z; directions of an integration rule that is exact for products of five. */
static double space_energy(const double e[9], double turn, double roll) {
  double sum = 0.0;
  for (int i = 0; i < 27; i++) {
    double n[3] = {i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    int zeros = (n[0] == 0) + (n[1] == 0) + (n[2] == 0);
    double weight = zeros == 2 ? 1.0 / 15 : zeros == 0 ? 3.0 / 40 : 0.0, step[3];
    double size = sqrt(3.0 - zeros), normal = 0.0, all = 0.0;
    for (int k = 0; k < 3 && weight > 0; k++)
      n[k] /= size;
    for (int k = 0; k < 3; k++) {
      step[k] = 2 * (e[3 * k] * n[0] + e[3 * k + 1] * n[1] + e[3 * k + 2] * n[2]);
      step[k] += 2 * turn * (k == 0 ? -n[1] : k == 1 ? n[0] : 0.0);
      normal += step[k] * n[k];
      all += step[k] * step[k];
    }
    sum += weight *
           (kn * normal * normal + ks * (all - normal * normal) + kw * pow(2 * roll * n[0], 2));
  }
  return sum;
}

/* docs/theory/cosserat.md, section 5: (21) is 15/4 and (22) 15/8 times the average over space, (23)
 * is that average; (24) fits the plane's G and a factor of 2. */
static void printed_mixes_averages(void **state) {
  (void)state;
  const double pull[9] = {1}, shear[9] = {0, 0.5, 0, 0.5}, none[9] = {0};
  double g = space_energy(shear, 0, 0), lambda = space_energy(pull, 0, 0) - 2 * g; /* of NV = 1 */
  double gc = 0.25 * space_energy(none, 1, 0), couple = space_energy(none, 0, 1);
  check_near(g, 2.0 / 15 * (2 * kn + 3 * ks), 1e-14, 0);
  check_near(lambda, 4.0 / 15 * (kn - ks), 1e-13, 0);
  cdem_material m = packing(PRINTED);
  m.parameter[4] = 1.0;
  moduli(&m, &unit_section);
  check_near(d[1], 15.0 / 8 * lambda, 1e-13, 0);
  check_near(0.5 * (d[14] + d[15]), 15.0 / 4 * g, 1e-13, 0);
  check_near(0.5 * (d[14] - d[15]), gc, 1e-13, 0);
  m.parameter[5] = 0.0;
  m.parameter[6] = 1e-9;
  double length = cdem_material_length(&m), plane = 0.5 * (kn + ks);
  check_near(2 * plane * length * length, couple, 1e-9, 0);
}

/* A contact is as thick as the section: stiffness of a body does not know the thickness. */
static void thickness_cancels(void **state) {
  (void)state;
  const cdem_section thick = {CDEM_PLANE_STRAIN, 0.2};
  cdem_fault fault = {0};
  for (int which = LATTICE; which <= PRINTED; which++) {
    cdem_material m = packing(which);
    double unit[36];
    cdem_contraction a, b;
    moduli(&m, &unit_section);
    memcpy(unit, d, sizeof unit);
    moduli(&m, &thick);
    for (int i = 0; i < 36; i++)
      check_near(0.2 * d[i], unit[i], 1e-15, 0);
    check_ok(cdem_contraction_build(&m, CDEM_PLANE_COSSERAT, &unit_section, &a, &fault));
    check_ok(cdem_contraction_build(&m, CDEM_PLANE_COSSERAT, &thick, &b, &fault));
    check_same(&a.c[0][0][0][0], &b.c[0][0][0][0], 81, 1e-15 * d[0], "thickness");
  }
}

static void lengths_and_inertia(void **state) {
  (void)state;
  cdem_material m = packing(LATTICE);
  check_near(cdem_material_length(&m), sqrt(kw / 125e6), 1e-15, 0); /* G = kn/2 */
  m = packing(AVERAGE);
  check_near(cdem_material_length(&m), sqrt(4 * kw / (kn + ks)), 1e-15, 0);
  for (int which = LATTICE; which <= PRINTED; which++) {
    m = packing(which);
    assert_true(cdem_material_is_cosserat(&m));
    check_near(cdem_material_micro_inertia(&m), 0.5 * r * r, 1e-15, 0);
  }
  m = specimen(FIRST_COSSERAT);
  check_near(cdem_material_micro_inertia(&m), 2.0 * 0.4 * 0.4, 1e-15, 0);
  m = specimen(0);
  assert_true(cdem_material_micro_inertia(&m) == 0.0);
}

/* ---- what sliding does to a curvature, disc by disc (docs/theory/cosserat.md, section 4) ----
 *
 * Discs of the lattice that do not move but turn by omega(x). */

static double turn_linear(double x) {
  return 0.3 * x;
}
static double wave_number;
static double turn_wave(double x) {
  return cos(wave_number * x);
}

/* Energy of sliding and of rolling per area over `columns` columns of contacts, 2 a row spacing
 * each; a disc lies at every x = i a, its contacts lead from i to i + 1 (two a disc). */
static void lattice_energy(double (*turn)(double), int columns, double *sliding, double *rolling) {
  const double a = sqrt(2.0) * r;
  *sliding = *rolling = 0.0;
  for (int i = 0; i < columns; i++) {
    double left = turn(i * a), right = turn((i + 1) * a);
    /* two contacts a disc, up and down; a disc owns 4 r^2 */
    *sliding += 2.0 * 0.5 * ks * pow(r * (left + right), 2) / (4 * r * r) / columns;
    *rolling += 2.0 * 0.5 * kw * pow(right - left, 2) / (4 * r * r) / columns;
  }
}

/* A linear rotation: each contact slides by the rotation at its own place, so that all of sliding's
 * energy is that of eps_xy - eps_yx there; nothing is left for a couple modulus. */
static void sliding_has_no_part_in_a_linear_rotation(void **state) {
  (void)state;
  const double a = sqrt(2.0) * r;
  cdem_material m = packing(LATTICE);
  moduli(&m, &unit_section);
  double sliding, rolling, local = 0.0;
  lattice_energy(turn_linear, 50, &sliding, &rolling);
  for (int i = 0; i < 50; i++) {
    double w = turn_linear((i + 0.5) * a), strain[6] = {0, 0, -w, w, 0, 0};
    local += 0.5 * modulus_energy(strain) / 50;
  }
  check_near(sliding, local, 1e-13, 0);
  const double bend[6] = {0, 0, 0, 0, 0.3, 0};
  check_near(rolling, 0.5 * modulus_energy(bend), 1e-12, 0);
}

/* A wave of rotation: the contact sees the mean of two discs, less than the wave between them. The
 * coefficient of q^2 is that of a couple modulus -ks r^2. */
static void sliding_takes_from_a_wave(void **state) {
  (void)state;
  const double a = sqrt(2.0) * r;
  const int columns = 2000;
  wave_number = 2 * 3.14159265358979323846 / (columns * a);
  double sliding, rolling, q2 = wave_number * wave_number;
  lattice_energy(turn_wave, columns, &sliding, &rolling);
  double homogeneous = 0.5 * 2 * ks * 0.5; /* w = 2 Gc' omega^2, mean of cos^2 */
  check_near((sliding - homogeneous) / (0.5 * 0.5 * q2), -ks * r * r, 1e-5, 0);
  check_near(rolling / (0.5 * 0.5 * q2), kw, 1e-5, 0);
}

static void refused(int which, int parameter, double value, const char *text) {
  cdem_fault fault = {0};
  cdem_material m = packing(which);
  int rows = 9;
  m.parameter[parameter] = value;
  d[0] = 7.0;
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_PLANE_COSSERAT, &unit_section, d, &rows, &fault),
              CDEM_INPUT, text);
  assert_true(d[0] == 7.0 && rows == 9);
}

static void impossible_packings_are_refused(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_material m = packing(LATTICE);
  int rows;
  refused(LATTICE, 0, 0.0, "normal_stiffness = 0 N/m is out of range: it must be positive");
  refused(LATTICE, 1, -1.0, "shear_stiffness = -1");
  refused(AVERAGE, 2, 0.0, "rolling_stiffness = 0");
  refused(AVERAGE, 3, 0.0, "radius = 0 m is out of range");
  refused(AVERAGE, 4, -0.5, "contact_density = -0.5 is out of range: it must be positive");
  refused(PRINTED, 5, -1.0, "rolling_force_stiffness = -1 N/m is out of range");
  refused(PRINTED, 6, 0.0, "representative_length = 0 m is out of range");
  m.rotated = true;
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_PLANE_COSSERAT, &unit_section, d, &rows, &fault),
              CDEM_INPUT, "axis1 and axis2 are not for cosserat-lattice: its axes are x and y");
  const cdem_section flat = {CDEM_PLANE_STRAIN, 0.0};
  m.rotated = false;
  check_fails(cdem_material_moduli(&m, CDEM_MODULI_PLANE_COSSERAT, &flat, d, &rows, &fault),
              CDEM_INPUT, "thickness = 0 m is out of range");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattice_is_the_sum_over_two_directions),
      cmocka_unit_test(average_is_the_mean_over_directions),
      cmocka_unit_test(printed_is_as_printed),
      cmocka_unit_test(printed_mixes_averages),
      cmocka_unit_test(thickness_cancels),
      cmocka_unit_test(lengths_and_inertia),
      cmocka_unit_test(sliding_has_no_part_in_a_linear_rotation),
      cmocka_unit_test(sliding_takes_from_a_wave),
      cmocka_unit_test(impossible_packings_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
