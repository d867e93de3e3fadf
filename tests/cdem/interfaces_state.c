/* Room cdem: interfaces saved and restored, their errors and memory failures. */
#include "cdem/interfaces_support.h"

/* Saved in the middle of failing and restored into a fresh copy: the same bits ever after. */
static void restored_continues_to_the_bit(void **state) {
  (void)state;
  for (int tie = 0; tie < 2; tie++) {
    cdem_interface_law law = soft;
    law.insertion = tie ? CDEM_INSERTION_TIED : CDEM_INSERTION_PENALTY;
    specimen one, other;
    build(&one, CDEM_SHAPE_HEX8, (int[3]){2, 2, 2}, 0.1, 3, &law, 1);
    build(&other, CDEM_SHAPE_HEX8, (int[3]){2, 2, 2}, 0.1, 3, &law, 1);
    double stress[6 * 64] = {0};
    assert_true(one.blocks.mesh.cells <= 64);
    for (int i = 0; i < 8; i++) {
      cdem_state saved = {0};
      if (i == 4) {
        check_ok(cdem_interfaces_save(&one.interfaces, &saved, &fault));
        check_ok(cdem_interfaces_restore(&other.interfaces, &saved, &fault));
        cdem_state_release(&saved);
      }
      for (int c = 0; c < 8; c++)
        stress[6 * c + i % 3] = 0.3e6 * i;
      for (int both = 0; both < (i < 4 ? 1 : 2); both++) {
        specimen *s = both ? &other : &one;
        displace(s, (double[3]){0}, i < 6 ? 3e-6 * i : 0.06, (uint64_t)(1 + i / 2));
        cdem_interfaces_insert(&s->interfaces, s->u, stress);
        evaluate(s);
      }
    }
    cdem_interfaces_totals a = totals_of(&one), b = totals_of(&other);
    assert_true(a.cracks > 0);
    assert_memory_equal(&a, &b, sizeof a);
    assert_memory_equal(one.force, other.force, (size_t)one.unknowns * sizeof *one.force);
    assert_int_equal(one.interfaces.version, other.interfaces.version);
    assert_int_equal(one.interfaces.ties.version, other.interfaces.ties.version);
    assert_int_equal(one.interfaces.ties.clusters, other.interfaces.ties.clusters);
    assert_memory_equal(one.interfaces.released, other.interfaces.released,
                        (size_t)one.blocks.pairs * sizeof(bool));
    cdem_state empty = {0};
    check_fails(cdem_interfaces_restore(&one.interfaces, &empty, &fault), CDEM_INPUT,
                "no array 'interfaces/points'");
    drop(&one);
    drop(&other);
  }
}

static void errors_say_what_to_do(void **state) {
  (void)state;
  specimen s;
  build(&s, CDEM_SHAPE_QUAD4, two_plane, 0, 2, &soft, 1);
  cdem_interfaces other = {0};
  cdem_interfaces_options options = {.blocks = &s.blocks,
                                     .dofs = 2,
                                     .thickness = 1,
                                     .laws = 1,
                                     .law = &soft,
                                     .law_of = s.law_of,
                                     .release = 0.05};
  options.dofs = 1;
  check_fails(cdem_interfaces_init(&options, &other, &fault), CDEM_USAGE, "1 unknowns a node");
  options.dofs = 2;
  options.thickness = 0;
  check_fails(cdem_interfaces_init(&options, &other, &fault), CDEM_INPUT, "positive thickness");
  options.thickness = 1;
  options.release = 0;
  check_fails(cdem_interfaces_init(&options, &other, &fault), CDEM_INPUT, "release = 0;");
  options.release = 0.05;
  options.laws = 0;
  check_fails(cdem_interfaces_init(&options, &other, &fault), CDEM_USAGE,
              "face pair 0 names law 0 of 0");
  options.laws = 1;
  cdem_interface_law bad = soft;
  bad.kn = 1;
  options.law = &bad;
  check_fails(cdem_interfaces_init(&options, &other, &fault), CDEM_INPUT, "snaps back");
  options.law = &soft;
  /* Without interface: free from the start. */
  s.law_of[0] = -1;
  check_ok(cdem_interfaces_init(&options, &other, &fault));
  double force[4][3];
  assert_true(other.released[0]);
  assert_false(cdem_interfaces_last_force(&other, 0, force));
  cdem_interfaces_release(&other);
  drop(&s);
}

/* Each allocation in turn fails and leaves nothing behind. */
static void memory_failures_leave_nothing(void **state) {
  (void)state;
  specimen s;
  cdem_interface_law tied = soft;
  tied.insertion = CDEM_INSERTION_TIED;
  build(&s, CDEM_SHAPE_HEX8, two, 0, 3, &tied, 1);
  cdem_interfaces other = {0};
  cdem_interfaces_options options = {
      .blocks = &s.blocks, .dofs = 3, .laws = 1, .law = &tied, .law_of = s.law_of, .release = 0.05};
  cdem_status status = CDEM_MEMORY;
  int failures = 0;
  for (; status == CDEM_MEMORY; failures++) {
    cdem_memory_fail_after(failures);
    status = cdem_interfaces_init(&options, &other, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || other.store == NULL);
  }
  assert_true(failures > 15);
  cdem_interface_fields fields;
  for (status = CDEM_MEMORY, failures = 0; status == CDEM_MEMORY; failures++) {
    cdem_memory_fail_after(failures);
    status = cdem_interfaces_fields(&other, s.u, &fields, &fault);
    cdem_memory_fail_after(-1);
  }
  cdem_interface_fields_release(&fields);
  cdem_state saved = {0};
  for (status = CDEM_MEMORY, failures = 0; status == CDEM_MEMORY; failures++) {
    cdem_state_release(&saved);
    cdem_memory_fail_after(failures);
    status = cdem_interfaces_save(&other, &saved, &fault);
    cdem_memory_fail_after(-1);
  }
  for (status = CDEM_MEMORY, failures = 0; status == CDEM_MEMORY; failures++) {
    cdem_memory_fail_after(failures);
    status = cdem_interfaces_restore(&other, &saved, &fault);
    cdem_memory_fail_after(-1);
  }
  assert_int_equal(status, CDEM_OK);
  cdem_state_release(&saved);
  cdem_interfaces_release(&other);
  cdem_interfaces_release(&other);
  drop(&s);
  memset(&fault, 0, sizeof fault);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(restored_continues_to_the_bit),
      cmocka_unit_test(errors_say_what_to_do),
      cmocka_unit_test(memory_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
