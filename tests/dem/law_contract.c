/* What every contact law and resistance must keep, over the tables: a new law is tested the moment
 * its line is there. */
#include "law_support.h"

enum { LANES = 61 };

typedef void contract(int dim, const cdem_contact_model *model);

static void each_with(contract *check, bool dampers) {
  for (int l = 0; cdem_law_at(l) != NULL; l++)
    for (int dim = 2; dim <= 3; dim++)
      for (int r = 0; cdem_rolling_at(r) != NULL; r++)
        for (int w = 0; cdem_twisting_at(w) != NULL; w++) {
          const cdem_law *law = cdem_law_at(l);
          const cdem_resistance *rolling = cdem_rolling_at(r), *twisting = cdem_twisting_at(w);
          if (!law->dims[dim] || (dim == 2 && w > 0) || (law->rolls && r + w > 0))
            continue;
          cdem_contact_input input = typical(law, rolling, twisting);
          if (!dampers) {
            if (!isnan(input.value[CDEM_LAW_restitution]))
              input.value[CDEM_LAW_restitution] = 1.0;
            static const cdem_law_key dashpots[] = {CDEM_LAW_normal_dashpot, CDEM_LAW_shear_dashpot,
                                                    CDEM_LAW_rolling_dashpot,
                                                    CDEM_LAW_rolling_force_dashpot};
            for (int k = 0; k < 4; k++)
              if (!isnan(input.value[dashpots[k]]))
                input.value[dashpots[k]] = 0.0;
            if (w > 0)
              input.value[CDEM_LAW_twisting_damping_ratio] = 0.0;
          }
          cdem_contact_model model;
          make_model(dim, law, rolling, twisting, &input, &model);
          check(dim, &model);
        }
}

static void each(contract *check) {
  each_with(check, true);
}

static const char *title(int dim, const cdem_contact_model *m, int lane) {
  static char text[128];
  snprintf(text, sizeof text, "%s, rolling %s, twisting %s, %d-D, lane %d", m->law->name,
           m->rolling->name, m->twisting->name, dim, lane);
  return text;
}

#define check_lane(value, reference, scale)                                                        \
  do {                                                                                             \
    double v_ = (value), r_ = (reference), s_ = (scale);                                           \
    if (!(fabs(v_ - r_) <= 1e-12 * (fabs(r_) + s_)))                                               \
      fail_msg("%s: %s = %.17g, not %.17g", title(dim, m, i), #value, v_, r_);                     \
  } while (0)

/* The forces in a lane, as scale for comparisons. */
static double force_scale(const cdem_batch *b, int i) {
  double scale = b->normal[i];
  for (int k = 0; k < 3; k++)
    scale += fabs(b->shear[k][i]) + fabs(b->history[k][i]);
  return scale;
}

static void same(int dim, const cdem_contact_model *m, const cdem_batch *a, const cdem_batch *b,
                 double vector, const double *parity) {
  int comps = dim == 2 ? 1 : 3;
  double shear = dim == 2 ? 1.0 : vector;
  for (int i = 0; i < b->count; i++) {
    double force = force_scale(b, i), length = a->radius[i];
    double energy = force * (a->overlap[i] + 4.0 * a->step + force * 1e-5);
    check_lane(a->normal[i], b->normal[i], force);
    for (int k = 0; k < comps; k++) {
      check_lane(a->shear[k][i], shear * b->shear[k][i], force);
      check_lane(a->moment[k][i], vector * b->moment[k][i], force * length);
    }
    for (int h = 0; h < m->histories; h++)
      check_lane(a->history[h][i], parity[h] * b->history[h][i],
                 h < m->first[1] && m->law->tangent_vectors > 0 ? force : 1e-3);
    check_lane(a->stored_normal[i], b->stored_normal[i], 0.0);
    check_lane(a->stored_shear[i], b->stored_shear[i], energy);
    check_lane(a->stored_moment[i], b->stored_moment[i], energy);
    check_lane(a->damped[i], b->damped[i], energy);
    check_lane(a->slid[i], b->slid[i], energy);
    check_lane(a->rolled[i], b->rolled[i], energy);
    check_lane(a->circulated[i], b->circulated[i], energy);
  }
}

static const double plus[CDEM_BATCH_HISTORY] = {1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                1, 1, 1, 1, 1, 1, 1, 1, 1};

/* ---- fast loops and plain algebra ---- */

static void fast_is_reference(int dim, const cdem_contact_model *m) {
  cdem_random random = {11};
  static cdem_batch a, b;
  for (int round = 0; round < 20; round++) {
    random_batch(&random, dim, m, LANES, &a);
    a.step = round == 0 ? 0.0 : round % 2 ? 1e-6 : 1e-4;
    b = a;
    evaluate(dim, m, true, false, &a);
    evaluate(dim, m, true, true, &b);
    same(dim, m, &a, &b, 1.0, plus);
  }
}

static void the_fast_loops_agree_with_the_reference(void **state) {
  (void)state;
  each(fast_is_reference);
}

static void energies_change_nothing(int dim, const cdem_contact_model *m) {
  cdem_random random = {12};
  static cdem_batch a, b;
  random_batch(&random, dim, m, LANES, &a);
  b = a;
  evaluate(dim, m, true, false, &a);
  evaluate(dim, m, false, false, &b);
  for (int i = 0; i < LANES; i++) {
    double force = force_scale(&a, i);
    check_lane(b.normal[i], a.normal[i], 0.0);
    for (int k = 0; k < 3; k++) {
      check_lane(b.shear[k][i], a.shear[k][i], force);
      check_lane(b.moment[k][i], a.moment[k][i], force * a.radius[i]);
    }
  }
}

static void forces_are_the_same_without_energies(void **state) {
  (void)state;
  each(energies_change_nothing);
}

/* Lanes beyond count, whatever they hold, change no bit of those below; nor does the count. */
static void lanes_are_apart(int dim, const cdem_contact_model *m) {
  cdem_random random = {13};
  static cdem_batch a, b;
  random_batch(&random, dim, m, LANES, &a);
  b = a;
  unsigned char *bytes = (unsigned char *)&b; /* every array of the batch, whatever its name */
  for (size_t at = offsetof(cdem_batch, n); at + sizeof(cdem_lanes) <= sizeof b;
       at += sizeof(cdem_lanes))
    for (size_t i = 21; i < CDEM_BATCH; i++) {
      double odd = i % 2 ? NAN : 1e300;
      memcpy(bytes + at + i * sizeof odd, &odd, sizeof odd);
    }
  b.count = 21;
  evaluate(dim, m, true, false, &a);
  evaluate(dim, m, true, false, &b);
  for (int i = 0; i < 21; i++) {
    assert_true(a.normal[i] == b.normal[i] && a.shear[0][i] == b.shear[0][i]);
    assert_true(a.moment[0][i] == b.moment[0][i] && a.history[0][i] == b.history[0][i]);
    assert_true(a.damped[i] == b.damped[i] && a.slid[i] == b.slid[i]);
  }
}

static void unused_lanes_are_harmless(void **state) {
  (void)state;
  each(lanes_are_apart);
}

/* ---- exchange, rotation, scaling ---- */

static void exchange(int dim, const cdem_contact_model *m, cdem_batch *b) {
  for (int i = 0; i < b->count; i++) {
    double arm = b->arm[0][i];
    b->arm[0][i] = b->arm[1][i];
    b->arm[1][i] = arm;
    b->label[i] = -b->label[i];
    for (int k = 0; k < dim; k++) {
      b->n[k][i] *= -1.0;
      b->velocity[k][i] *= -1.0;
      b->velocity_gain[k][i] *= -1.0;
    }
    for (int k = 0; k < 3; k++) {
      b->spin[k][i] *= -1.0;
      b->spin_gain[k][i] *= -1.0;
    }
    for (int h = 0; h < m->histories; h++)
      b->history[h][i] *= m->parity[h];
  }
}

static void exchange_changes_nothing(int dim, const cdem_contact_model *m) {
  cdem_random random = {14};
  static cdem_batch a, b;
  random_batch(&random, dim, m, LANES, &a);
  b = a;
  exchange(dim, m, &b);
  evaluate(dim, m, true, false, &a);
  evaluate(dim, m, true, false, &b);
  same(dim, m, &b, &a, -1.0, m->parity);
}

static void a_and_b_may_change_places(void **state) {
  (void)state;
  each(exchange_changes_nothing);
}

/* Li & Chu's rolling force is odd: without the rule of labels the pair's force changes by twice it,
 * up to 2 mu_r F_N; switched off by its stiffness and dashpot. */
static void labels_matter_by_twice_the_rolling_force(void **state) {
  (void)state;
  const cdem_law *law = cdem_law_find("li-chu");
  cdem_random random = {15};
  static cdem_batch a, b;
  for (int off = 0; off < 2; off++) {
    cdem_contact_input input = typical(law, cdem_rolling_at(0), cdem_twisting_at(0));
    if (off)
      input.value[CDEM_LAW_rolling_force_stiffness] = input.value[CDEM_LAW_rolling_force_dashpot] =
          0.0;
    cdem_contact_model model;
    make_model(2, law, NULL, NULL, &input, &model);
    random_batch(&random, 2, &model, LANES, &a);
    b = a;
    for (int i = 0; i < LANES; i++)
      b.label[i] = -b.label[i];
    evaluate(2, &model, true, false, &a);
    evaluate(2, &model, true, false, &b);
    double most = 0.0;
    for (int i = 0; i < LANES; i++) {
      double part = a.normal[i] > 0.0 ? fabs(a.shear[0][i] - b.shear[0][i]) / a.normal[i] : 0.0;
      most = fmax(most, part);
      assert_true(a.label[i] == -b.label[i] && (!off || a.circulated[i] == 0.0));
    }
    check_near(most, off ? 0.0 : 2.0 * 0.2, 1e-12, 0.0);
    assert_false(!off && !law->labels);
  }
}

static void rotation_matrix(cdem_random *random, int dim, double q[9]) {
  double axis[3] = {0.0, 0.0, 1.0}, angle = cdem_random_uniform(random, 0.5, 2.5);
  if (dim == 3)
    random_direction(random, 3, axis);
  double c = cos(angle), s = sin(angle);
  double cross[9] = {0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      q[3 * i + j] = (i == j) * c + s * cross[3 * i + j] + (1.0 - c) * axis[i] * axis[j];
}

static void turn(const double q[9], cdem_lanes *v, int dim, int i) {
  double old[3] = {v[0][i], v[1][i], dim == 3 ? v[2][i] : 0.0};
  for (int k = 0; k < dim; k++)
    v[k][i] = q[3 * k] * old[0] + q[3 * k + 1] * old[1] + q[3 * k + 2] * old[2];
}

static void turn_histories(const double q[9], const cdem_contact_model *m, cdem_batch *b, int i) {
  for (int v = 0; v < m->law->tangent_vectors; v++)
    turn(q, b->history + 3 * v, 3, i);
  if (m->rolling->tangent_vector)
    turn(q, b->history + m->first[1], 3, i);
}

static void turn_in(const double q[9], int dim, const cdem_contact_model *m, cdem_batch *b) {
  for (int i = 0; i < b->count; i++) {
    turn(q, b->n, dim, i);
    turn(q, b->velocity, dim, i);
    turn(q, b->velocity_gain, dim, i);
    if (dim == 2)
      continue;
    turn(q, b->turning, 3, i);
    turn(q, b->turning_gain, 3, i);
    turn(q, b->spin, 3, i);
    turn(q, b->spin_gain, 3, i);
    turn_histories(q, m, b, i);
  }
}

static void rotation_rotates(int dim, const cdem_contact_model *m) {
  cdem_random random = {16};
  static cdem_batch a, b;
  double q[9];
  rotation_matrix(&random, dim, q);
  random_batch(&random, dim, m, LANES, &a);
  b = a;
  turn_in(q, dim, m, &b);
  evaluate(dim, m, true, false, &a);
  evaluate(dim, m, true, false, &b);
  for (int i = 0; dim == 3 && i < LANES; i++) {
    turn(q, a.shear, 3, i);
    turn(q, a.moment, 3, i);
    turn_histories(q, m, &a, i);
  }
  same(dim, m, &b, &a, 1.0, plus);
}

static void the_frame_does_not_matter(void **state) {
  (void)state;
  each(rotation_rotates);
}

/* Lengths 2^p, times 2^q, masses 2^r: every bit of the mantissa stays. */
static double power(const int e[3], int length, int time, int mass) {
  return ldexp(1.0, e[0] * length + e[1] * time + e[2] * mass);
}

static void scale_lanes(cdem_lanes *lanes, int rows, double by) {
  for (int k = 0; k < rows; k++)
    for (int i = 0; i < CDEM_BATCH; i++)
      lanes[k][i] *= by;
}

enum { ENERGIES = 7 };

static double *energies_of(cdem_batch *b, int k) {
  double *const lanes[ENERGIES] = {b->stored_normal, b->stored_shear, b->stored_moment, b->damped,
                                   b->slid,          b->rolled,       b->circulated};
  return lanes[k];
}

static void scale_batch(const cdem_contact_model *m, const int e[3], bool out, cdem_batch *b) {
  double force = power(e, 1, -2, 1), energy = power(e, 2, -2, 1);
  if (!out) {
    b->step *= power(e, 0, 1, 0);
    scale_lanes(&b->overlap, 1, power(e, 1, 0, 0));
    scale_lanes(b->arm, 2, power(e, 1, 0, 0));
    scale_lanes(&b->radius, 1, power(e, 1, 0, 0));
    scale_lanes(&b->mass, 1, power(e, 0, 0, 1));
    scale_lanes(b->velocity, 3, power(e, 1, -1, 0));
    scale_lanes(b->turning, 3, power(e, 1, -1, 0));
    scale_lanes(b->spin, 3, power(e, 0, -1, 0));
    scale_lanes(b->velocity_gain, 3, power(e, 1, -1, 0));
    scale_lanes(b->turning_gain, 3, power(e, 1, -1, 0));
    scale_lanes(b->spin_gain, 3, power(e, 0, -1, 0));
  } else {
    scale_lanes(&b->normal, 1, force);
    scale_lanes(b->shear, 3, force);
    scale_lanes(b->moment, 3, energy);
    for (int k = 0; k < ENERGIES; k++)
      for (int i = 0; i < CDEM_BATCH; i++)
        energies_of(b, k)[i] *= energy;
  }
  bool stretch = m->law->rolls; /* Li-Chu: lengths, lengths, angles */
  for (int h = 0; h < m->first[1]; h++)
    scale_lanes(&b->history[h], 1,
                stretch                           ? power(e, h < 2, 0, 0)
                : h < 3 * m->law->tangent_vectors ? force
                                                  : power(e, 1, 0, 0));
  for (int h = m->first[1]; h < m->histories; h++)
    scale_lanes(&b->history[h], 1, energy);
}

static void scaling_is_exact(int dim, const cdem_contact_model *m) {
  static const int powers[][3] = {{1, 1, 3}, {-3, 2, 1}, {5, -4, 7}, {0, 1, 0}, {0, 0, 1}};
  for (size_t p = 0; p < sizeof powers / sizeof *powers; p++) {
    const int *e = powers[p];
    cdem_contact_input input = typical(m->law, m->rolling, m->twisting);
    for (int key = 0; key < CDEM_LAW_KEYS; key++) {
      cdem_dimension d = cdem_law_key_get(key)->dimension;
      input.value[key] *= power(e, d.length, d.time, d.mass);
    }
    cdem_grain_material big = glass;
    big.young *= power(e, -1, -2, 1);
    cdem_contact_model scaled;
    cdem_fault fault = {0};
    check_ok(cdem_contact_model_init(dim, m->law, m->rolling, m->twisting, &input, &big, &big,
                                     &scaled, &fault));
    cdem_random random = {17};
    static cdem_batch a, b;
    random_batch(&random, dim, m, LANES, &a);
    b = a;
    scale_batch(m, e, false, &b);
    evaluate(dim, m, true, false, &a);
    evaluate(dim, &scaled, true, false, &b);
    scale_batch(m, e, true, &a);
    for (int i = 0; i < LANES; i++) {
      bool equal = a.normal[i] == b.normal[i];
      for (int k = 0; k < (dim == 2 ? 1 : 3); k++)
        equal = equal && a.shear[k][i] == b.shear[k][i] && a.moment[k][i] == b.moment[k][i];
      for (int h = 0; h < m->histories; h++)
        equal = equal && a.history[h][i] == b.history[h][i];
      for (int k = 0; k < ENERGIES; k++)
        equal = equal && energies_of(&a, k)[i] == energies_of(&b, k)[i];
      if (!equal)
        fail_msg("%s: not scaled to the bit", title(dim, m, i));
    }
  }
}

static void a_scaled_contact_has_scaled_bits(void **state) {
  (void)state;
  each(scaling_is_exact);
}

/* ---- bounds ---- */

static void bounds_hold(int dim, const cdem_contact_model *m) {
  cdem_random random = {18};
  static cdem_batch b;
  double sum = m->law->rolls ? 0.4 + 0.2 : 0.4;
  for (int round = 0; round < 20; round++) {
    random_batch(&random, dim, m, LANES, &b);
    memset(b.velocity_gain, 0, sizeof b.velocity_gain);
    memset(b.turning_gain, 0, sizeof b.turning_gain);
    memset(b.spin_gain, 0, sizeof b.spin_gain);
    evaluate(dim, m, true, false, &b);
    for (int i = 0; i < LANES; i++) {
      double n[3] = {b.n[0][i], b.n[1][i], b.n[2][i]}, f[3], moment[3];
      for (int k = 0; k < 3; k++) {
        f[k] = b.shear[k][i];
        moment[k] = b.moment[k][i];
      }
      assert_true(b.normal[i] >= 0.0); /* no pull */
      check_below(cdem_norm3(f), sum * b.normal[i] * (1.0 + 1e-14));
      if (dim == 3)
        check_below(fabs(cdem_dot3(f, n)), 1e-12 * cdem_norm3(f) + 1e-300);
      double cap = ((0.1 + 0.2) * b.radius[i] + 2e-4) * b.normal[i];
      check_below(cdem_norm3(moment), cap * (1.0 + 1e-14));
      if (m->law->rolls) /* its dashpots may: see law_li_chu.c */
        continue;
      double small = 1e-12 * force_scale(&b, i) * 1e-4;
      assert_true(b.damped[i] >= -small);
      /* the random past may be longer than its cap, or point the other way: only springs within */
      assert_true(b.circulated[i] == 0.0);
    }
  }
}

static void forces_keep_to_their_bounds(void **state) {
  (void)state;
  each(bounds_hold);
}

/* A contact that just closes, without speed, has no force; nor does one that opens fast. */
static void nothing_without_overlap(int dim, const cdem_contact_model *m) {
  cdem_random random = {19};
  static cdem_batch b;
  random_batch(&random, dim, m, LANES, &b);
  memset(b.history, 0, sizeof b.history);
  for (int i = 0; i < LANES; i++) {
    double along = 0.0;
    b.overlap[i] = 0.0;
    for (int k = 0; k < dim; k++)
      along += b.velocity[k][i] * b.n[k][i];
    for (int k = 0; k < dim; k++) /* apart, or along the plane */
      b.velocity[k][i] -= (along - (i % 2 ? 0.0 : fabs(along))) * b.n[k][i];
    if (i % 2 == 0)
      b.overlap[i] = 1e-9;
    for (int k = 0; k < dim && i % 2; k++)
      b.velocity[k][i] = 0.0;
  }
  evaluate(dim, m, true, false, &b);
  for (int i = 0; i < LANES; i++) {
    check_below(b.normal[i], i % 2 ? 0.0 : 1e-2);
    for (int k = 0; k < (dim == 2 ? 1 : 3); k++) {
      check_below(fabs(b.shear[k][i]), 0.6 * b.normal[i] * (1.0 + 1e-14));
      check_below(fabs(b.moment[k][i]), b.normal[i]);
    }
  }
}

static void there_is_no_force_without_overlap(void **state) {
  (void)state;
  each(nothing_without_overlap);
}

/* ---- stiffness against differences of the batch ---- */

static void stiffness_is_the_slope(int dim, const cdem_contact_model *m) {
  cdem_random random = {20};
  static cdem_batch b, less, more;
  random_batch(&random, dim, m, LANES, &b);
  memset(b.velocity, 0, (size_t)((char *)b.label - (char *)b.velocity));
  memset(b.history, 0, sizeof b.history);
  for (int i = 0; i < LANES; i++)
    b.overlap[i] = cdem_random_uniform(&random, 1e-5, 1e-4);
  evaluate(dim, m, false, false, &b); /* the contact has been there */
  less = more = b;
  for (int i = 0; i < LANES; i++) {
    double small = 1e-4 * b.overlap[i], t[3], axis[3] = {0.3, 0.5, -0.7};
    double n[3] = {b.n[0][i], b.n[1][i], b.n[2][i]};
    less.overlap[i] -= small;
    more.overlap[i] += small;
    cdem_cross3(n, axis, t);
    for (int k = 0; k < dim; k++)
      more.velocity[k][i] = dim == 2 ? (k == 0 ? -n[1] : n[0]) : t[k] / cdem_norm3(t);
    for (int k = 0; k < dim; k++)
      more.velocity[k][i] *= 1e-9 / b.step;
  }
  evaluate(dim, m, false, false, &less);
  evaluate(dim, m, false, false, &more);
  for (int i = 0; i < LANES; i++) {
    double normal, shear, dashpot[2], force = 0.0;
    m->law->stiffness(&m->parameters[0], b.radius[i], b.mass[i], b.overlap[i], &normal, &shear,
                      dashpot);
    check_near((more.normal[i] - less.normal[i]) / (2e-4 * b.overlap[i]), normal, 1e-6, 0.0);
    for (int k = 0; k < (dim == 2 ? 1 : 3); k++)
      force += more.shear[k][i] * more.shear[k][i];
    if (!m->law->rolls) /* the two springs of Li & Chu do not pull in the same motion */
      check_near(sqrt(force), shear * 1e-9, 1e-4, 0.0);
    assert_true(dashpot[0] >= 0.0 && dashpot[1] >= 0.0 && shear > 0.0);
  }
}

static void stiffness_is_that_of_the_force(void **state) {
  (void)state;
  each_with(stiffness_is_the_slope, false);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_fast_loops_agree_with_the_reference),
      cmocka_unit_test(forces_are_the_same_without_energies),
      cmocka_unit_test(unused_lanes_are_harmless),
      cmocka_unit_test(a_and_b_may_change_places),
      cmocka_unit_test(labels_matter_by_twice_the_rolling_force),
      cmocka_unit_test(the_frame_does_not_matter),
      cmocka_unit_test(a_scaled_contact_has_scaled_bits),
      cmocka_unit_test(forces_keep_to_their_bounds),
      cmocka_unit_test(there_is_no_force_without_overlap),
      cmocka_unit_test(stiffness_is_that_of_the_force),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
