/* Room verify: every check of the table passes, tables are sound, and a check that cannot be
 * carried out, a wrong name, or a wish to stop is told as it should be. */
#include "verify/verify.h"

#include "io/case_file.h"
#include "springs/springs.h"
#include "support/test.h"
#include "verify/cases.h"
#include "verify/springs.h"

static void print_skipped(void *context, const char *group, const char *name, const char *reason) {
  (*(int *)context)++;
  print_error("%s, %s could not run: %s\n", group, name, reason);
}

static void every_check_passes(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  int skipped = 0, failed = 0;
  const cdem_verify_options options = {.context = &skipped, .skipped = print_skipped};
  check_ok(cdem_verify_run(NULL, 0, &options, &list, &fault));
  for (int64_t i = 0; i < list.checks; i++) {
    const cdem_check *check = &list.check[i];
    if (!cdem_check_passes(check)) {
      print_error("%s, %s: %.17g, expected %.17g within %g (%s)\n", check->group, check->name,
                  check->value, check->reference, check->tolerance, check->source);
      failed++;
    }
  }
  assert_int_equal(failed, 0);
  assert_int_equal(skipped, 0);
  assert_true(list.checks >= 30);
  cdem_check_list_release(&list);
}

/* data/reference/depletion.csv: six digits, half a unit of the last one. */
static void reference_table_holds_the_depletion(void **state) {
  (void)state;
  cdem_fault fault = {0};
  FILE *file = fopen(CDEM_DATA "/reference/depletion.csv", "r");
  assert_non_null(file);
  char line[128], class_[16];
  double nu, lowest, value;
  int rows = 0;
  assert_non_null(fgets(line, sizeof line, file));
  while (fgets(line, sizeof line, file) != NULL) {
    assert_int_equal(sscanf(line, "%15[^,],%lf,%lf", class_, &nu, &lowest), 3);
    int which = nu == 0.25 ? 0 : nu == 0.2 ? 1 : 2;
    check_ok(cdem_springs_measure_depletion_lowest(10 * (int)cdem_class_find(class_) + which,
                                                   &value, &fault));
    check_near(value, lowest, 5e-6, 1e-15);
    rows++;
  }
  fclose(file);
  assert_int_equal(rows, 9);
}

static void tables_are_sound(void **state) {
  (void)state;
  for (int g = 0; cdem_verify_group_at(g) != NULL; g++) {
    const cdem_verify_group *group = cdem_verify_group_at(g);
    assert_ptr_equal(cdem_verify_group_find(group->name), group);
    for (int i = 0; i < group->checks; i++) {
      const cdem_verification *check = &group->check[i];
      assert_non_null(check->measure);
      assert_true(check->source != NULL && check->source[0] != '\0');
      assert_true(check->tolerance >= 0.0);
      if (check->kind == CDEM_CHECK_UNSTATED)
        fail_msg("%s, %s: its kind is missing (results/check_kinds.def)", group->name, check->name);
      for (int j = 0; j < i; j++)
        assert_string_not_equal(check->name, group->check[j].name);
    }
  }
  assert_null(cdem_verify_group_at(-1));
  assert_null(cdem_verify_group_find("no such group"));
}

/* Most of what a program claims of itself proves little: a hundred references come from outside,
 * and are asked without --slow. */
static void a_hundred_references_come_from_outside(void **state) {
  (void)state;
  int outside = 0;
  for (int g = 0; cdem_verify_group_at(g) != NULL; g++)
    for (int i = 0; i < cdem_verify_group_at(g)->checks; i++) {
      const cdem_verification *check = &cdem_verify_group_at(g)->check[i];
      outside += cdem_check_kind_find(check->kind)->outside && !check->slow;
    }
  assert_true(outside >= 100);
}

/* The group `cases` and the case files state each tolerance once for each reader. */
static void cases_keep_the_tolerances_of_their_files(void **state) {
  (void)state;
  const cdem_verify_group *group = cdem_verify_group_find("cases");
  for (int i = 0; i < group->checks; i++) {
    const cdem_verification *check = &group->check[i];
    cdem_fault fault = {0};
    cdem_case read = {0};
    char path[256];
    bool found = false;
    snprintf(path, sizeof path, "%s/cases/%.*s.yaml", CDEM_DATA, (int)strcspn(check->name, ":"),
             check->name);
    check_ok(cdem_read_case(path, 0, NULL, &read, &fault));
    for (int64_t k = 0; k < read.values.results.count; k++) {
      const cdem_case_key_result *key = &read.values.results.item[k];
      if (strcmp(key->name, cdem_cases_key(check->parameter)) != 0)
        continue;
      found = true;
      if (key->tolerance != check->tolerance)
        fail_msg("%s: %g here, %g in the file", check->name, check->tolerance, key->tolerance);
    }
    assert_true(found);
    cdem_case_release(&read);
  }
}

static void unknown_groups_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  const cdem_verify_options options = {0};
  const char *const typo[] = {"springs", "sprngs"}, *const strange[] = {"zzz"};
  check_fails(cdem_verify_run(typo, 2, &options, &list, &fault), CDEM_USAGE,
              "there is no group 'sprngs'; did you mean 'springs'?");
  check_fails(cdem_verify_run(strange, 1, &options, &list, &fault), CDEM_USAGE,
              "there is no group 'zzz'; groups are springs, cdem, dem, bsm, scaling");
  assert_int_equal(list.checks, 0);
}

static cdem_status measure(int parameter, double *value, cdem_fault *fault) {
  CDEM_REQUIRE(parameter != 1, fault, CDEM_NUMERIC, "no value for %d", parameter);
  CDEM_REQUIRE(parameter != 2, fault, CDEM_MEMORY, "out of memory");
  *value = parameter;
  return CDEM_OK;
}

static void remember_reason(void *context, const char *group, const char *name,
                            const char *reason) {
  snprintf(context, 128, "%s/%s: %s", group, name, reason);
}

static bool stop(void *context, const char *what, int64_t done, int64_t total) {
  (void)context, (void)what, (void)total;
  return done < 1;
}

static void checks_that_cannot_run_are_told(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  char reason[128] = "";
  int64_t done = 0;
  const cdem_verification table[] = {
      {"wrong", "here", 0, 0.5, measure, 7, false, CDEM_CHECK_LAW},
      {"broken", "here", 0, 0.5, measure, 1, false, CDEM_CHECK_LAW},
      {"long", "here", 9, 0.5, measure, 9, true, CDEM_CHECK_LAW},
      {"memory", "here", 0, 0.5, measure, 2, true, CDEM_CHECK_LAW},
  };
  cdem_verify_group group = {"test", "for this test", 4, table};
  cdem_verify_options options = {.context = reason, .skipped = remember_reason};
  check_ok(cdem_verify_run_group(&group, &options, &done, 2, &list, &fault));
  assert_int_equal(list.checks, 1); /* measured and wrong; the broken one is absent */
  assert_false(cdem_check_passes(&list.check[0]));
  assert_string_equal(reason, "test/broken: no value for 1");
  options.slow = true;
  check_fails(cdem_verify_run_group(&group, &options, &done, 4, &list, &fault), CDEM_MEMORY,
              "memory: out of memory");
  assert_int_equal(list.checks, 3);
  const cdem_progress progress = {NULL, stop};
  options.progress = &progress;
  done = 0;
  check_fails(cdem_verify_run_group(&group, &options, &done, 4, &list, &fault), CDEM_INTERRUPTED,
              "verifying");
  cdem_check_list_release(&list);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_check_passes),
      cmocka_unit_test(reference_table_holds_the_depletion),
      cmocka_unit_test(tables_are_sound),
      cmocka_unit_test(a_hundred_references_come_from_outside),
      cmocka_unit_test(cases_keep_the_tolerances_of_their_files),
      cmocka_unit_test(unknown_groups_are_named),
      cmocka_unit_test(checks_that_cannot_run_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
