/* Coarse-grained fields: integrals, balances to their order, periodicity, threads. */
#include "measures_support.h"

static cdem_coarse fields_of(const cdem_snapshot *s, const cdem_coarse_grid *grid) {
  cdem_fault fault = {0};
  cdem_coarse fields = {0};
  check_ok(cdem_coarse_make(s, grid, &fields, &fault));
  return fields;
}

/* About one grain density times the ring or shell is a polynomial of degree 7 or 8 in the radius:
 * nine points of Newton and Cotes integrate it exactly. */
static void one_grain_integrates_exactly(void **unused) {
  (void)unused;
  static const double weight[9] = {989, 5888, -928, 10496, -4540, 10496, -928, 5888, 989};
  const double pi = 3.14159265358979323846, w = 0.37;
  for (int dim = 2; dim <= 3; dim++) {
    assembly *m = assembly_new(dim);
    put_grain(m, 0.25, -0.5, 0, 0.1);
    const cdem_coarse_grid grid = {{0.25, -0.5, 0}, {0.25 + w, -0.5, 0}, {9, 1, 1}, w};
    cdem_coarse f = fields_of(&m->s, &grid);
    double mass = 0;
    for (int k = 0; k < 9; k++) {
      double r = f.xyz[3 * k] - 0.25;
      mass += 4.0 / 14175 * w / 8 * weight[k] * f.density[k] *
              (dim == 2 ? 2 * pi * r * m->s.thickness : 4 * pi * r * r);
    }
    check_near(mass, 2, 1e-13, 0);
    assert_true(f.density[8] < 1e-13 * f.density[0]); /* and ends where it should */
    cdem_coarse_release(&f);
    free(m);
  }
}

/* Sums over a grid far finer than the bump, n points a width. By Poisson's formula they are off by
 * the bump's transform at k = 2 pi n and its neighbours: 2^v v! J_v(k)/k^v, v = 3 + dim/2, so at
 * most 4 * 307 k^-4.5 in the plane, n = 83, and 6 * 944 k^-5 in space, n = 17. */
static void fields_integrate_to_what_there_is(void **unused) {
  (void)unused;
  static const double bound[2] = {8e-10, 5e-7};
  for (int dim = 2; dim <= 3; dim++) {
    assembly *m = random_assembly(dim, 12, 31);
    for (int k = 0; k < 12; k++)
      for (int c = 0; c < 3; c++)
        m->xyz[3 * k + c] *= 0.4;
    m->s.contacts = 0;
    memset(m->touching, 0, sizeof m->touching);
    for (int k = 0; k < 8; k++) { /* forces of any direction, branches of any length */
      cdem_dem_contact *c = put_contact(m, k, k + 4, NULL, 2.0 + k);
      c->force[0] += 0.3 * k;
    }
    const double down[3] = {0, -1, 0};
    put_wall_contact(m, 3, 0, down, 7.0);
    int n = dim == 2 ? 401 : 81;
    cdem_coarse_grid grid = {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}, {n, n, dim == 2 ? 1 : n}, 0.5};
    cdem_coarse f = fields_of(&m->s, &grid);
    double cell = pow(2.4 / (n - 1), dim) * m->s.thickness, sum[16] = {0}, wanted[16] = {0};
    for (int64_t p = 0; p < f.points; p++) {
      sum[0] += cell * f.density[p];
      sum[1] += cell * f.solid[p];
      for (int c = 0; c < 3; c++) {
        sum[2 + c] += cell * f.momentum[3 * p + c];
        sum[5 + c] += cell * f.wall_force[3 * p + c];
      }
    }
    for (int64_t i = 0; i < m->s.grains; i++) {
      wanted[0] += m->mass[i];
      wanted[1] += cdem_grain_volume(&m->s, m->radius[i]);
      for (int c = 0; c < 3; c++)
        wanted[2 + c] += m->mass[i] * m->velocity[3 * i + c];
    }
    wanted[6] = 7.0;
    for (int k = 0; k < 8; k++)
      check_near(sum[k], wanted[k], 0, bound[dim - 2] * wanted[0]);
    cdem_coarse_release(&f);
    memset(m->velocity, 0, sizeof m->velocity); /* then stress is that of the contacts */
    f = fields_of(&m->s, &grid);
    double total[9] = {0}, branches[9] = {0};
    for (int64_t p = 0; p < f.points; p++)
      for (int k = 0; k < 9; k++)
        total[k] += cell * f.stress[9 * p + k];
    for (int64_t k = 0; k < m->s.contacts; k++)
      for (int c = 0; c < 9; c++)
        branches[c] += m->contact[k].force[c / 3] * m->contact[k].branch[c % 3];
    for (int k = 0; k < 9; k++)
      check_near(total[k], branches[k], 0, bound[dim - 2] * fabs(branches[4]) * 10);
    cdem_coarse_release(&f);
    assert_null(f.stress);
    free(m);
  }
}

/* ---- balances ---- */

/* The state a time away: grains fly with the accelerations of their forces (constant). The branch
 * of a contact follows, but only the state in the middle is asked for its stress. */
static void fly(const assembly *from, const double (*acceleration)[3], double t, assembly *to) {
  for (int64_t i = 0; i < from->s.grains; i++)
    for (int c = 0; c < 3; c++) {
      double v = from->velocity[3 * i + c], a = acceleration[i][c];
      to->xyz[3 * i + c] = from->xyz[3 * i + c] + v * t + 0.5 * a * t * t;
      to->velocity[3 * i + c] = v + a * t;
    }
}

/* Central differences over h in space and time about a point: what is left of the balance of mass,
 * and of momentum. */
static void residual(const assembly *now, assembly *other, const double (*acceleration)[3],
                     const double gravity[3], const double at[3], double h, double left[4]) {
  cdem_coarse_grid grid = {.count = {3, 3, now->s.dim == 2 ? 1 : 3}, .width = 0.4}, point = grid;
  int dim = now->s.dim;
  for (int c = 0; c < 3; c++) {
    grid.low[c] = at[c] - (c < dim ? h : 0);
    grid.high[c] = at[c] + (c < dim ? h : 0);
    point.low[c] = point.high[c] = at[c];
    point.count[c] = 1;
  }
  cdem_coarse around = fields_of(&now->s, &grid);
  int64_t step[3] = {1, 3, 9}, middle = dim == 2 ? 4 : 13;
  for (int c = 0; c < 4; c++)
    left[c] = 0;
  for (int sign = -1; sign <= 1; sign += 2) {
    fly(now, acceleration, sign * h, other);
    cdem_coarse then = fields_of(&other->s, &point);
    left[0] += sign * then.density[0] / (2 * h);
    for (int c = 0; c < 3; c++)
      left[1 + c] += sign * then.momentum[c] / (2 * h);
    cdem_coarse_release(&then);
    for (int d = 0; d < dim; d++) {
      int64_t p = middle + sign * step[d];
      left[0] += sign * around.momentum[3 * p + d] / (2 * h);
      for (int c = 0; c < 3; c++)
        left[1 + c] += sign / (2 * h) *
                       (around.momentum[3 * p + c] * around.velocity[3 * p + d] -
                        around.stress[9 * p + 3 * c + d]);
    }
  }
  for (int c = 0; c < 3; c++)
    left[1 + c] -= around.density[middle] * gravity[c] + around.wall_force[3 * middle + c];
  cdem_coarse_release(&around);
}

static void mass_and_momentum_are_balanced(void **unused) {
  (void)unused;
  static double acceleration[MOST_GRAINS][3];
  const double gravity[3] = {0.4, -9.81, 0};
  for (int dim = 2; dim <= 3; dim++) {
    assembly *m = random_assembly(dim, 150, 12), *other = random_assembly(dim, 150, 12);
    const double down[3] = {0, -1, 0};
    put_wall_contact(m, 17, 0, down, 20.0);
    other->s.contacts = 0;
    memset(acceleration, 0, sizeof acceleration);
    for (int64_t i = 0; i < m->s.grains; i++)
      for (int c = 0; c < dim; c++)
        acceleration[i][c] = gravity[c];
    for (int64_t k = 0; k < m->s.contacts; k++)
      for (int c = 0; c < 3; c++) {
        const cdem_dem_contact *n = &m->contact[k];
        acceleration[n->a][c] += n->force[c] / m->mass[n->a];
        if (n->b >= 0)
          acceleration[n->b][c] -= n->force[c] / m->mass[n->b];
      }
    double at[3] = {m->xyz[51] + 0.1, m->xyz[52] - 0.15, dim == 3 ? m->xyz[53] + 0.05 : 0.0};
    double left[2][4], size = 0;
    for (int k = 0; k < 2; k++)
      residual(m, other, acceleration, gravity, at, k == 0 ? 4e-3 : 2e-3, left[k]);
    cdem_coarse_grid point = {.count = {1, 1, 1}, .width = 0.4};
    memcpy(point.low, at, sizeof at);
    memcpy(point.high, at, sizeof at);
    cdem_coarse f = fields_of(&m->s, &point);
    assert_true(fabs(f.wall_force[1]) > 0); /* the wall is felt here */
    for (int c = 0; c < 9; c++)
      size = fmax(size, fabs(f.stress[c]) / 0.4);
    cdem_coarse_release(&f);
    double sum[2] = {0, 0};
    for (int c = 0; c < 4; c++) {
      check_below(fabs(left[1][c]), 2e-3 * size);
      sum[0] += fabs(left[0][c]);
      sum[1] += fabs(left[1][c]);
    }
    double order = log2(sum[0] / sum[1]); /* kinks of the third derivative: not quite 2 */
    check_near(order, 2, 0, 0.2);
    free(m);
    free(other);
  }
}

/* ---- the rest ---- */

static void threads_give_the_same_bits(void **unused) {
  (void)unused;
  assembly *m = random_assembly(3, 300, 5);
  const cdem_coarse_grid grid = {{-1, -1, -1}, {1, 1, 1}, {9, 8, 7}, 0.4};
  cdem_coarse one = fields_of(&m->s, &grid);
  for (int threads = 2; threads <= 4; threads += 2) {
    m->s.threads = threads;
    cdem_coarse many = fields_of(&m->s, &grid);
    assert_memory_equal(one.stress, many.stress, 9 * sizeof(double) * (size_t)one.points);
    assert_memory_equal(one.momentum, many.momentum, 3 * sizeof(double) * (size_t)one.points);
    cdem_coarse_release(&many);
  }
  cdem_coarse_release(&one);
  free(m);
}

/* Fields of a cell repeat, with a contact through its side; their mean is that of the cell. */
static void periodic_fields_repeat(void **unused) {
  (void)unused;
  assembly *m = assembly_new(2);
  cdem_cell cell = {.periodic = {true, true, false}, .h = {2, 0.5, 0, 0, 2, 0, 0, 0, 0}};
  m->s.cell = &cell;
  put_grain(m, 0.3, 0.4, 0, 0.3);
  put_grain(m, 1.8, 0.5, 0, 0.3);
  const double back[3] = {-2, 0, 0};
  put_contact(m, 0, 1, back, 5.0);
  enum { SIDE = 161 };
  cdem_coarse_grid grid = {{0.1, 0.2, 0}, {2.1, 2.2, 0}, {SIDE, SIDE, 1}, 0.7};
  cdem_coarse f = fields_of(&m->s, &grid);
  double mass = 0, stress = 0, part = 4.0 / ((SIDE - 1) * (SIDE - 1)) * m->s.thickness;
  for (int y = 0; y < SIDE - 1; y++)
    for (int x = 0; x < SIDE - 1; x++) {
      mass += part * f.density[y * SIDE + x];
      stress += part * f.stress[9 * (y * SIDE + x)];
    }
  for (int y = 0; y < SIDE; y++)
    check_near(f.density[y * SIDE], f.density[y * SIDE + SIDE - 1], 1e-12, 1e-13);
  check_near(mass, 4, 2e-8, 0); /* 56 points a width: see above */
  const cdem_dem_contact *c = &m->contact[0];
  check_near(stress, c->force[0] * c->branch[0], 2e-8, 0);
  cdem_assembly whole, box;
  cdem_measure_kernel(&m->s, NULL, &whole);
  check_near(whole.volume, 4 * 0.5, 1e-15, 0);
  check_near(whole.stress[0] * whole.volume, c->force[0] * c->branch[0], 1e-14, 0);
  /* A box as wide as the period, wherever it stands, holds one of each. */
  const cdem_region region = {{0.7, 0.45, 0}, {2.7, 2.45, 0}};
  cdem_measure_kernel(&m->s, &region, &box);
  assert_int_equal(box.grains, 2);
  check_near(box.stress[0], whole.stress[0], 1e-14, 0);
  check_near(box.solid, whole.solid, 1e-13, 0);
  cdem_coarse_release(&f);
  free(m);
}

static void wrong_grids_are_named(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_coarse f = {0};
  assembly *m = random_assembly(2, 10, 1);
  cdem_coarse_grid grid = {{0, 0, 0}, {1, 1, 0}, {2, 2, 2}, 0.1};
  check_fails(cdem_coarse_make(&m->s, &grid, &f, &fault), CDEM_USAGE, "2 layers");
  grid.count[2] = 0;
  check_fails(cdem_coarse_make(&m->s, &grid, &f, &fault), CDEM_USAGE, "0 points");
  grid.count[2] = 1;
  grid.low[0] = 2;
  check_fails(cdem_coarse_make(&m->s, &grid, &f, &fault), CDEM_USAGE, "from 2 to 1 m");
  grid.low[0] = 0;
  grid.width = -1;
  check_fails(cdem_coarse_make(&m->s, &grid, &f, &fault), CDEM_USAGE, "width of -1 m");
  grid.width = 0; /* two mean diameters */
  for (int n = 0; n < 12; n++) {
    cdem_memory_fail_after(n);
    check_fails(cdem_coarse_make(&m->s, &grid, &f, &fault), CDEM_MEMORY, "");
    assert_null(f.xyz);
    if (n == 9) /* seven arrays and the sources: growing takes two more */
      break;
  }
  cdem_memory_fail_after(-1);
  check_ok(cdem_coarse_make(&m->s, &grid, &f, &fault));
  double mean = 0;
  for (int i = 0; i < 10; i++)
    mean += m->radius[i] / 10;
  check_near(f.width, 4 * mean, 1e-14, 0);
  cdem_coarse_release(&f);
  free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_grain_integrates_exactly),
      cmocka_unit_test(fields_integrate_to_what_there_is),
      cmocka_unit_test(mass_and_momentum_are_balanced),
      cmocka_unit_test(threads_give_the_same_bits),
      cmocka_unit_test(periodic_fields_repeat),
      cmocka_unit_test(wrong_grids_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
