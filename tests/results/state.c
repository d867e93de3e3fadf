/* States: what goes in comes out, to the bit, and what does not fit is named. */
#include "results/state.h"

#include "support/test.h"

static void arrays_are_borrowed_copied_and_found(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state = {0};
  double velocity[3] = {1.0, -0.0, 1e-320};
  int64_t step = 12;
  check_ok(cdem_state_add(&state, "solver/velocity", CDEM_ARRAY_REAL, 3, velocity, &fault));
  check_ok(cdem_state_add_copy(&state, "solver/step", CDEM_ARRAY_INT64, 1, &step, &fault));
  check_ok(cdem_state_add(&state, "contacts", CDEM_ARRAY_INT32, 0, NULL, &fault));
  step = 13;
  velocity[0] = 2.0;
  assert_ptr_equal(cdem_state_find(&state, "solver/velocity")->data, velocity);
  assert_null(cdem_state_find(&state, "solver"));
  double back[3];
  check_ok(cdem_state_get(&state, "solver/velocity", CDEM_ARRAY_REAL, 3, back, &fault));
  assert_memory_equal(back, velocity, sizeof back);
  int64_t then = 0;
  check_ok(cdem_state_get(&state, "solver/step", CDEM_ARRAY_INT64, 1, &then, &fault));
  assert_int_equal(then, 12);
  double *taken = NULL;
  int64_t count = -1;
  check_ok(cdem_state_take(&state, "solver/velocity", CDEM_ARRAY_REAL, &count, &taken, &fault));
  assert_int_equal(count, 3);
  assert_ptr_not_equal(taken, velocity);
  assert_memory_equal(taken, velocity, sizeof velocity);
  free(taken);
  int32_t *none = NULL;
  check_ok(cdem_state_take(&state, "contacts", CDEM_ARRAY_INT32, &count, &none, &fault));
  assert_int_equal(count, 0);
  assert_non_null(none);
  free(none);
  velocity[2] = NAN; /* borrowed */
  check_fails(cdem_state_get(&state, "solver/velocity", CDEM_ARRAY_REAL, 3, back, &fault),
              CDEM_INPUT, "'solver/velocity' of the checkpoint holds nan at place 2");
  velocity[2] = -INFINITY;
  check_fails(cdem_state_take(&state, "solver/velocity", CDEM_ARRAY_REAL, &count, &taken, &fault),
              CDEM_INPUT, "holds -inf at place 2");
  cdem_state_release(&state);
  assert_int_equal(state.arrays, 0);
  cdem_state_release(&state);
}

static void many_arrays_and_their_sizes(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state = {0};
  for (int i = 0; i < 100; i++) {
    char name[32];
    uint8_t value = (uint8_t)i;
    snprintf(name, sizeof name, "a%d/value", i);
    check_ok(cdem_state_add_copy(&state, name, CDEM_ARRAY_BYTE, 1, &value, &fault));
  }
  assert_int_equal(state.arrays, 100);
  uint8_t value = 0;
  check_ok(cdem_state_get(&state, "a77/value", CDEM_ARRAY_BYTE, 1, &value, &fault));
  assert_int_equal(value, 77);
  assert_int_equal(cdem_array_size(CDEM_ARRAY_REAL), 8);
  assert_int_equal(cdem_array_size(CDEM_ARRAY_INT64), 8);
  assert_int_equal(cdem_array_size(CDEM_ARRAY_INT32), 4);
  assert_int_equal(cdem_array_size(CDEM_ARRAY_BYTE), 1);
  cdem_state_release(&state);
}

static void what_does_not_fit_is_named(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state = {0};
  const int32_t face[4] = {1, 2, 3, 4};
  int32_t back[4] = {9, 9, 9, 9}, *taken = NULL;
  int64_t count = -1;
  check_ok(cdem_state_add(&state, "interfaces/face", CDEM_ARRAY_INT32, 4, face, &fault));
  check_fails(cdem_state_get(&state, "velocity", CDEM_ARRAY_REAL, 4, back, &fault), CDEM_INPUT,
              "no array 'velocity'; it does not belong to this case");
  check_fails(cdem_state_get(&state, "interfaces/face", CDEM_ARRAY_REAL, 4, back, &fault),
              CDEM_INPUT, "'interfaces/face' of the checkpoint is of type int32, not real");
  check_fails(cdem_state_get(&state, "interfaces/face", CDEM_ARRAY_INT32, 3, back, &fault),
              CDEM_INPUT, "has 4 elements, not 3");
  assert_int_equal(back[0], 9);
  check_fails(cdem_state_take(&state, "interfaces/face", CDEM_ARRAY_BYTE, &count, &taken, &fault),
              CDEM_INPUT, "is of type int32, not byte");
  assert_null(taken);
  assert_int_equal(count, -1);
  static const char *const bad[] = {"", "/a", "a/", "a//b", "."};
  for (int i = 0; i < 5; i++)
    check_fails(cdem_state_add(&state, bad[i], CDEM_ARRAY_INT32, 4, face, &fault), CDEM_USAGE,
                "cannot be the name of an array");
  static const char *const taken_names[] = {"interfaces/face", "interfaces", "interfaces/face/x"};
  for (int i = 0; i < 3; i++)
    check_fails(cdem_state_add_copy(&state, taken_names[i], CDEM_ARRAY_INT32, 4, face, &fault),
                CDEM_USAGE, "cannot stand beside 'interfaces/face'");
  check_ok(cdem_state_add(&state, "interfaces/faces", CDEM_ARRAY_INT32, 4, face, &fault));
  check_fails(cdem_state_add(&state, "n", CDEM_ARRAY_INT32, -1, face, &fault), CDEM_USAGE,
              "-1 elements");
  assert_int_equal(state.arrays, 2);
  cdem_state_release(&state);
}

static void memory_runs_out(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  const double value = 1.0;
  for (int allowed = 0;; allowed++) {
    cdem_state state = {0};
    cdem_memory_fail_after(allowed);
    cdem_status status = cdem_state_add_copy(&state, "a", CDEM_ARRAY_REAL, 1, &value, &fault);
    double *taken = NULL;
    int64_t count = 0;
    if (status == CDEM_OK)
      status = cdem_state_take(&state, "a", CDEM_ARRAY_REAL, &count, &taken, &fault);
    cdem_memory_fail_after(-1);
    free(taken);
    cdem_state_release(&state);
    if (status == CDEM_OK) {
      assert_int_equal(allowed, 4);
      return;
    }
    assert_int_equal(status, CDEM_MEMORY);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arrays_are_borrowed_copied_and_found),
      cmocka_unit_test(many_arrays_and_their_sizes),
      cmocka_unit_test(what_does_not_fit_is_named),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
