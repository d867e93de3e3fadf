/* Stress, fabric, solid: closed forms on lattices, and sums over regions side by side. */
#include "dem/measures.h"

#include "measures_support.h"

static const double pi = 3.14159265358979323846;

/* ---- lattices ---- */

/* Square lattice of spacing a: one contact in each direction a cell, so that s = -F/(a t). Regions
 * of whole cells give it exactly wherever they begin. */
static void square_lattice(void **unused) {
  (void)unused;
  const double a = 0.19, push[2] = {3.0, 5.0};
  enum { SIDE = 12 };
  assembly *m = assembly_new(2);
  for (int i = 0; i < SIDE * SIDE; i++)
    put_grain(m, a * (i % SIDE), a * (double)(i / SIDE), 0, 0.1);
  for (int i = 0; i < SIDE * SIDE; i++) {
    if (i % SIDE + 1 < SIDE)
      put_contact(m, i, i + 1, NULL, push[0]);
    if (i / SIDE + 1 < SIDE)
      put_contact(m, i, i + SIDE, NULL, push[1]);
  }
  for (int k = 0; k < 4; k++) { /* k = 0: edges along the branches */
    double at = 0.31 * a * k;
    const cdem_region region = {{2 * a + at, 3 * a + at, 0}, {9 * a + at, 8 * a + at, 0}};
    cdem_assembly got;
    cdem_measure_kernel(&m->s, &region, &got);
    check_near(got.volume, 35 * a * a * 0.5, 1e-14, 0);
    check_near(got.stress[0], -push[0] / (a * 0.5), 1e-13, 0);
    check_near(got.stress[4], -push[1] / (a * 0.5), 1e-13, 0);
    check_near(got.stress[1], 0, 0, 1e-13);
    check_near(got.pressure, 0.5 * (push[0] + push[1]) / (a * 0.5), 1e-13, 0);
    check_near(got.deviator, 0.5 * (push[1] - push[0]) / (a * 0.5), 1e-12, 0);
    check_near(got.coordination, 4, 1e-15, 0);
    check_near(got.mechanical, 4, 1e-15, 0);
    check_near(got.solid, pi * 0.01 / (a * a), 1e-12, 0); /* overlaps count twice */
    assert_int_equal(got.grains, 35);
  }
  free(m);
}

/* Hexagonal: area a^2 sqrt(3)/2 a grain and three contacts with sum n n = 3/2 I: s = -sqrt(3) F/(a
 * t) I.
 */
static void hexagonal_lattice(void **unused) {
  (void)unused;
  const double a = 0.2, high = a * sqrt(0.75);
  enum { SIDE = 14 };
  assembly *m = assembly_new(2);
  for (int i = 0; i < SIDE * SIDE; i++)
    put_grain(m, a * (i % SIDE + 0.5 * (i / SIDE % 2)), high * (double)(i / SIDE), 0, 0.5 * a);
  for (int i = 0; i < SIDE * SIDE; i++)
    for (int j = i + 1; j < SIDE * SIDE; j++) {
      double d[3] = {m->xyz[3 * j] - m->xyz[3 * i], m->xyz[3 * j + 1] - m->xyz[3 * i + 1], 0};
      if (cdem_norm3(d) < 1.01 * a)
        put_contact(m, i, j, NULL, 7.0);
    }
  const cdem_region region = {{2.3 * a, 2.1 * high, 0}, {10.3 * a, 10.1 * high, 0}};
  cdem_assembly got;
  cdem_measure_kernel(&m->s, &region, &got);
  for (int k = 0; k < 9; k++)
    check_near(got.stress[k], k == 0 || k == 4 ? -sqrt(3.0) * 7.0 / (a * 0.5) : 0.0, 0, 1e-11);
  check_near(got.solid, pi / sqrt(12.0), 1e-12, 0);
  check_near(got.coordination, 6, 1e-15, 0);
  check_near(got.fabric[0] + got.fabric[4], 1, 1e-14, 0);
  cdem_measure_kernel(&m->s, NULL, &got);
  assert_int_equal(got.contacts, m->s.contacts);
  check_near(got.mean_push, 7, 1e-14, 0);
  free(m);
}

/* ---- additivity ---- */

static void add_measure(const assembly *m, const cdem_region *region, double sum[12]) {
  cdem_assembly got;
  cdem_measure_kernel(&m->s, region, &got);
  for (int k = 0; k < 9; k++)
    sum[k] += got.volume * got.stress[k];
  sum[9] += got.volume * got.solid;
  sum[10] += (double)got.grains;
  sum[11] += (double)got.contacts;
}

/* The box cut by three planes at odd places into eight. */
static void check_parts(const assembly *m, const cdem_region *whole) {
  double one[12] = {0}, parts[12] = {0};
  int dim = m->s.dim;
  add_measure(m, whole, one);
  for (int k = 0; k < 1 << dim; k++) {
    cdem_region part = *whole;
    for (int c = 0; c < dim; c++) {
      double cut = whole->low[c] + (0.31 + 0.17 * c) * (whole->high[c] - whole->low[c]);
      *(k >> c & 1 ? &part.low[c] : &part.high[c]) = cut;
    }
    add_measure(m, &part, parts);
  }
  for (int k = 0; k < 12; k++) /* 1e-9: balls cut by planes are integrated numerically */
    check_near(parts[k], one[k], k == 9 && dim == 3 ? 1e-9 : 1e-12, 1e-12);
}

static void regions_add_up(void **unused) {
  (void)unused;
  for (int dim = 2; dim <= 3; dim++) {
    assembly *m = random_assembly(dim, dim == 2 ? 150 : 300, 3);
    assert_true(m->s.contacts > 200);
    check_parts(m, &(cdem_region){{-2, -2, -2}, {2, 2, 2}});
    check_parts(m, &(cdem_region){{-0.5, -0.7, -0.6}, {0.6, 0.4, 0.8}});
    /* A box around all of it holds the whole sum. */
    double all[12] = {0}, box[12] = {0};
    add_measure(m, NULL, all);
    add_measure(m, &(cdem_region){{-2, -2, -2}, {2, 2, 2}}, box);
    for (int k = 0; k < 12; k++)
      check_near(box[k], all[k], 1e-12, 1e-12);
    free(m);
  }
}

/* Grain volumes times grain stresses sum to f (x) branch, symmetric part. */
static void grains_sum_to_the_whole(void **unused) {
  (void)unused;
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  static double stress[6 * MOST_GRAINS];
  for (int dim = 2; dim <= 3; dim++) {
    assembly *m = random_assembly(dim, 200, 8);
    const double down[3] = {0, -1, 0};
    put_wall_contact(m, 5, 0, down, 3.0);
    cdem_assembly whole;
    cdem_measure_kernel(&m->s, NULL, &whole);
    cdem_grain_stress_kernel(&m->s, stress);
    for (int k = 0; k < 6; k++) {
      double sum = 0;
      for (int64_t i = 0; i < m->s.grains; i++)
        sum += stress[6 * i + k] * cdem_grain_volume(&m->s, m->radius[i]);
      double wanted =
          0.5 * (whole.stress[3 * at[k][0] + at[k][1]] + whole.stress[3 * at[k][1] + at[k][0]]);
      check_near(sum, wanted * whole.volume, 1e-12, 1e-12);
    }
    free(m);
  }
}

/* ---- solids ---- */

static void discs_and_balls_in_boxes(void **unused) {
  (void)unused;
  const double r = 0.7, centre[3] = {0.2, -0.3, 0.4}, far = 9;
  cdem_region half = {{centre[0], -far, -far}, {far, far, far}};
  check_near(cdem_solid_inside(2, centre, r, &half), 0.5 * pi * r * r, 1e-14, 0);
  check_near(cdem_solid_inside(3, centre, r, &half), 2.0 / 3 * pi * r * r * r, 1e-10, 0);
  half.low[1] = centre[1];
  check_near(cdem_solid_inside(2, centre, r, &half), 0.25 * pi * r * r, 1e-14, 0);
  half.low[2] = centre[2];
  check_near(cdem_solid_inside(3, centre, r, &half), pi * r * r * r / 6, 1e-10, 0);
  for (int c = 0; c < 3; c++) /* caps: pi h^2 (3 r - h)/3; segments: r^2 acos(d/r) - d sqrt(..) */
    for (double h = 0.1; h < 1.4; h += 0.1) {
      cdem_region cap = {{-far, -far, -far}, {far, far, far}};
      cap.low[c] = centre[c] + r - h;
      check_near(cdem_solid_inside(3, centre, r, &cap), pi * h * h * (3 * r - h) / 3, 0,
                 1e-9 * r * r * r);
      if (c < 2)
        check_near(cdem_solid_inside(2, centre, r, &cap),
                   r * r * acos((r - h) / r) - (r - h) * sqrt(h * (2 * r - h)), 1e-12, 0);
    }
  /* A box inside is filled; one beside is empty. */
  const cdem_region in = {{0.1, -0.4, 0.3}, {0.3, -0.2, 0.5}}, out = {{2, 2, 2}, {3, 3, 3}};
  check_near(cdem_solid_inside(2, centre, r, &in), 0.04, 1e-13, 0);
  check_near(cdem_solid_inside(3, centre, r, &in), 0.008, 1e-13, 0);
  assert_true(cdem_solid_inside(3, centre, r, &out) == 0.0);
}

static void branches_in_boxes(void **unused) {
  (void)unused;
  const cdem_region box = {{0, 0, 0}, {1, 1, 1}};
  const double from[3] = {-0.5, 0.5, 0.5}, across[3] = {2, 0, 0}, along[3] = {0, 0, 1};
  check_near(cdem_branch_inside(3, from, across, &box), 0.5, 1e-15, 0);
  assert_true(cdem_branch_inside(3, from, along, &box) == 0.0);
  const double corner[3] = {0, 0, 0}, high[3] = {1, 1, 0}, diagonal[3] = {2, 2, 2};
  check_near(cdem_branch_inside(3, corner, along, &box), 1, 1e-15, 0); /* on an edge below */
  assert_true(cdem_branch_inside(3, high, along, &box) == 0.0);        /* ... and above */
  check_near(cdem_branch_inside(3, corner, diagonal, &box), 0.5, 1e-15, 0);
}

/* ---- fabric ---- */

/* Normals of the density (1 + a cos 2(t - t0))/(2 pi), by its inverse at even steps. */
static void anisotropy_of_a_density(void **unused) {
  (void)unused;
  assembly *m = assembly_new(2);
  put_grain(m, 0, 0, 0, 1);
  put_grain(m, 1, 0, 0, 1);
  const double a = 0.4, turned = 0.7;
  enum { NORMALS = 4000 };
  for (int k = 0; k < NORMALS; k++) {
    double wanted = 2 * pi * (k + 0.5) / NORMALS, t = wanted;
    for (int n = 0; n < 60; n++) /* Newton; the slope is at least 0.6 */
      t -= (t + 0.5 * a * sin(2 * t) - wanted) / (1 + a * cos(2 * t));
    cdem_dem_contact *c = put_contact(m, 0, 1, NULL, 1);
    c->normal[0] = cos(t + turned);
    c->normal[1] = sin(t + turned);
  }
  cdem_assembly got;
  cdem_measure_kernel(&m->s, NULL, &got);
  check_near(got.anisotropy, a, 1e-6, 0);
  check_near(0.5 * atan2(2 * got.fabric[1], got.fabric[0] - got.fabric[4]), turned, 1e-6, 0);
  free(m);
  m = assembly_new(3); /* all along one line: a_zz = 5, and 15/2 in all */
  put_grain(m, 0, 0, 0, 1);
  put_grain(m, 0, 0, 2, 1);
  put_contact(m, 0, 1, NULL, 1);
  cdem_measure_kernel(&m->s, NULL, &got);
  check_near(got.anisotropy, 7.5, 1e-14, 0);
  free(m);
}

/* A triangle that carries, one grain with one contact, one alone. */
static void rattlers_are_told_apart(void **unused) {
  (void)unused;
  assembly *m = assembly_new(2);
  const double place[5][2] = {{0, 0}, {2, 0}, {1, 1.7}, {4, 0}, {9, 9}}, down[3] = {0, -1, 0};
  for (int i = 0; i < 5; i++) {
    put_grain(m, place[i][0], place[i][1], 0, 1);
    m->velocity[3 * i] = i;
  }
  put_contact(m, 0, 1, NULL, 1);
  put_contact(m, 0, 2, NULL, 1);
  put_contact(m, 1, 2, NULL, 1)->sliding = true;
  put_contact(m, 1, 3, NULL, 5);
  put_wall_contact(m, 0, 0, down, 2);
  cdem_assembly got;
  cdem_measure_kernel(&m->s, NULL, &got);
  check_near(got.coordination, 9.0 / 5, 1e-15, 0);
  check_near(got.mechanical, 8.0 / 3, 1e-15, 0);
  check_near(got.rattlers, 0.4, 1e-15, 0);
  check_near(got.sliding, 0.2, 1e-15, 0);
  check_near(got.mean_push, 2, 1e-15, 0);
  check_near(got.largest_push, 5, 1e-15, 0);
  /* Velocities 0 .. 4 of masses 2: sum m v'^2 = 20. */
  check_near(got.kinetic_stress[0] * got.volume, -20, 1e-14, 0);
  free(m);
}

/* Powers of two of length, time and mass scale every bit. */
static void scaled_states_have_scaled_bits(void **unused) {
  (void)unused;
  assembly *m = random_assembly(3, 200, 21), *n = random_assembly(3, 200, 21);
  const double length = 0x1p-7, force = 0x1p11, mass = 0x1p5, speed = 0x1p-3;
  for (int64_t i = 0; i < 3 * n->s.grains; i++) {
    n->xyz[i] *= length;
    n->velocity[i] *= speed;
  }
  for (int64_t i = 0; i < n->s.grains; i++) {
    n->radius[i] *= length;
    n->mass[i] *= mass;
  }
  for (int64_t k = 0; k < n->s.contacts; k++)
    for (int c = 0; c < 3; c++) {
      n->contact[k].branch[c] *= length;
      n->contact[k].point[c] *= length;
      n->contact[k].force[c] *= force;
    }
  cdem_region big = {{-0.5, -0.6, -0.7}, {0.4, 0.5, 0.3}}, small = big;
  for (int c = 0; c < 3; c++) {
    small.low[c] *= length;
    small.high[c] *= length;
  }
  cdem_assembly a, b;
  cdem_measure_kernel(&m->s, &big, &a);
  cdem_measure_kernel(&n->s, &small, &b);
  double stress = force / (length * length),
         kinetic = mass * speed * speed / (length * length * length);
  for (int k = 0; k < 9; k++) {
    assert_true(b.stress[k] == a.stress[k] * stress);
    assert_true(b.kinetic_stress[k] == a.kinetic_stress[k] * kinetic);
  }
  assert_true(a.solid == b.solid && a.grains == b.grains && a.contacts == b.contacts);
  free(m);
  free(n);
}

/* A region across the side of a cell counts images where they are, as fast as they are there: a
 * cell sheared at a rate of 3/s with grains that go with it. */
static void images_count_where_they_are(void **unused) {
  (void)unused;
  enum { SIDE = 8 };
  const double rate = 3.0;
  assembly *m = assembly_new(2);
  cdem_cell cell = {.periodic = {true, true, false}, .h = {1, 0.25, 0, 0, 1, 0, 0, 0, 0}};
  for (int i = 0; i < SIDE * SIDE; i++) {
    double y = (i / SIDE + 0.5) / SIDE;
    put_grain(m, (i % SIDE + 0.5) / SIDE, y, 0, 0.05);
    m->velocity[3 * i] = rate * y;
  }
  m->s.cell = &cell;
  for (int k = 0; k < 27; k++)
    m->s.drift[k][0] = rate * (k / 3 % 3 - 1);
  const cdem_region region = {{0, -0.25, 0}, {0, 0.25, 0}}; /* two rows below, two above the side */
  cdem_count count;
  cdem_count_kernel(&m->s, &region, &count);
  assert_int_equal(count.grains, 4 * SIDE);
  check_near(count.low[1], -1.5 / SIDE, 1e-15, 0.0);
  check_near(count.high[1], 1.5 / SIDE, 1e-15, 0.0);
  check_near(count.first[1], 0.0, 0.0, 1e-14);
  check_near(count.momentum[0], 0.0, 0.0, 1e-13);
  /* rows at +-1/16, +-3/16: the mean of y^2 is 5/256 */
  check_near(count.kinetic, 0.5 * 2.0 * 4 * SIDE * rate * rate * 5.0 / 256.0, 1e-14, 0.0);
  cdem_assembly got;
  cdem_measure_kernel(&m->s, &region, &got);
  check_near(got.kinetic_stress[0], -2.0 * count.kinetic / got.volume, 1e-14, 0.0);
  free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(square_lattice),
      cmocka_unit_test(hexagonal_lattice),
      cmocka_unit_test(regions_add_up),
      cmocka_unit_test(grains_sum_to_the_whole),
      cmocka_unit_test(discs_and_balls_in_boxes),
      cmocka_unit_test(branches_in_boxes),
      cmocka_unit_test(anisotropy_of_a_density),
      cmocka_unit_test(rattlers_are_told_apart),
      cmocka_unit_test(scaled_states_have_scaled_bits),
      cmocka_unit_test(images_count_where_they_are),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
