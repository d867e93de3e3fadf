/* Statistics of lists of contacts made by hand, and of a solver's. */
#include "dem/pushes.h"

#include "dem/measures.h"
#include "solver_model.h"

static cdem_fault fault;

/* Five grains: 0-1 (along x, 3 N), 1-2 (along z, 1 N), 0-2 (along x, 0: does not push), 3 on a wall
 * (10 N), 4 alone. */
static const cdem_push five[4] = {{.a = 0, .b = 1, .normal = {1, 0, 0}, .push = 3.0},
                                  {.a = 1, .b = 2, .normal = {0, 0, 1}, .push = 1.0},
                                  {.a = 0, .b = 2, .normal = {1, 0, 0}, .push = 0.0},
                                  {.a = 3, .b = -1, .normal = {0, 0, -1}, .push = 10.0}};

static void means_and_counts(void **state) {
  (void)state;
  cdem_push_statistics s;
  check_ok(cdem_push_measure(3, 5, 4, five, 0.0, &s, &fault));
  assert_true(s.contacts[CDEM_PUSH_GRAINS] == 2 && s.contacts[CDEM_PUSH_BOUNDARY] == 1);
  assert_true(s.mean[CDEM_PUSH_GRAINS] == 2.0 && s.mean[CDEM_PUSH_BOUNDARY] == 10.0);
  assert_true(s.largest == 3.0 && s.strong == 0.0 && s.weak == 0.0);
  check_near(s.coordination, 5.0 / 5.0, 1e-15, 0.0); /* 1 2 1 1 0 */
  check_near(s.mechanical, 2.0, 1e-15, 0.0);
  check_near(s.rattlers, 0.8, 1e-15, 0.0);
  assert_true(s.fabric[0] == 0.5 && s.fabric[8] == 0.5 && s.fabric[4] == 0.0);
  /* deviator (1/6, -1/3, 1/6): 7.5 sqrt(3/2 * 1/6) */
  check_near(s.anisotropy, 3.75, 1e-15, 0.0);
}

/* The mean of all that push is 14/3 N: a quarter of it leaves the contact of 1 N out. */
static void the_cutoff_is_part_of_the_mean(void **state) {
  (void)state;
  cdem_push_statistics s;
  check_ok(cdem_push_measure(3, 5, 4, five, 0.25, &s, &fault));
  assert_true(s.contacts[CDEM_PUSH_GRAINS] == 1 && s.mean[CDEM_PUSH_GRAINS] == 3.0);
  assert_true(s.contacts[CDEM_PUSH_BOUNDARY] == 1);
  check_fails(cdem_push_measure(3, 3, 4, five, 0.0, &s, &fault), CDEM_INPUT,
              "contact 3 is of grains 3 and -1; there are 3");
}

/* Exponential forces: the density over the mean is exp(-x), shares above 4 and below 0.2 are
 * exp(-4) and 1 - exp(-0.2). */
static void exponential_forces_come_out(void **state) {
  (void)state;
  enum { CONTACTS = 200000, BINS = 20 };
  cdem_random random = {31};
  cdem_push *push;
  cdem_push_statistics s;
  cdem_table table = {0};
  push = malloc(CONTACTS * sizeof *push);
  assert_non_null(push);
  for (int k = 0; k < CONTACTS; k++)
    push[k] = (cdem_push){.a = k % 100,
                          .b = (k + 1) % 100,
                          .normal = {0, 1, 0},
                          .push = -250.0 * log(1.0 - cdem_random_uniform(&random, 0.0, 1.0))};
  check_ok(cdem_push_measure(3, 100, CONTACTS, push, 0.0, &s, &fault));
  check_near(s.mean[0], 250.0, 0.01, 0.0);
  check_near(s.strong, exp(-4.0), 0.05, 0.0);
  check_near(s.weak, 1.0 - exp(-0.2), 0.02, 0.0);
  check_ok(cdem_push_distribution(CONTACTS, push, BINS, 0.1, 4.0, &table, &fault));
  assert_int_equal(table.rows, BINS);
  double ratio = pow(40.0, 1.0 / BINS), counted = 0.0;
  for (int b = 0; b < BINS; b++) {
    double from = 0.1 * pow(ratio, b), to = from * ratio;
    check_near(cdem_table_at(&table, b, 0)->real, sqrt(from * to), 1e-12, 0.0);
    check_near(cdem_table_at(&table, b, 2)->real, (exp(-from) - exp(-to)) / (to - from), 0.05, 0.0);
    counted += cdem_table_at(&table, b, 1)->real;
  }
  check_near(counted / CONTACTS, exp(-0.1) - exp(-4.0), 0.01, 0.0);
  cdem_table_release(&table);
  check_fails(cdem_push_distribution(CONTACTS, push, BINS, 0.0, 4.0, &table, &fault), CDEM_USAGE,
              "both must be positive");
  free(push);
}

static void a_solver_has_the_same_as_its_measures(void **state) {
  (void)state;
  model m;
  cdem_dem dem;
  cdem_push *push;
  cdem_push_statistics s;
  cdem_assembly all;
  int64_t contacts;
  model_init(&m, 3, "penalty");
  model_word(&m, CDEM_LAW_restitution, 0.5);
  model_heap(&m, 5, 1.3, 0.1, 7);
  check_ok(cdem_dem_init(&m.options, &dem, &fault));
  check_ok(cdem_dem_steps(&dem, 50, &fault));
  check_ok(cdem_dem_pushes(&dem, &contacts, &push, &fault));
  check_ok(cdem_push_measure(3, dem.grains, contacts, push, 0.0, &s, &fault));
  check_ok(cdem_measure(&dem, NULL, &all, &fault));
  double between = (double)s.contacts[0], walls = (double)s.contacts[1];
  assert_true(between > 20.0 && s.contacts[0] + s.contacts[1] <= all.contacts);
  check_near((s.mean[0] * between + s.mean[1] * walls) / (double)all.contacts, all.mean_push, 1e-12,
             0.0);
  if (s.contacts[0] + s.contacts[1] == all.contacts) { /* none that only separates */
    check_near(s.anisotropy, all.anisotropy, 1e-9, 0.0);
    check_near(s.coordination, all.coordination, 1e-12, 0.0);
  }
  free(push);
  cdem_dem_release(&dem);
  model_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(means_and_counts),
      cmocka_unit_test(the_cutoff_is_part_of_the_mean),
      cmocka_unit_test(exponential_forces_come_out),
      cmocka_unit_test(a_solver_has_the_same_as_its_measures),
  };
  return cmocka_run_group_tests_name("dem pushes", tests, NULL, NULL);
}
