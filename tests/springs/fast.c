/* The batched path: a block's set depends on the block alone, in any lane and any company. */
#include "springs/blocks.h"

enum { COUNT = 41, ROOM = 48 };

static void fill(cdem_random *random, int size, double blocks[ROOM][9]) {
  for (int i = 0; i < ROOM; i++)
    blocks_make(random, (blocks_family)(cdem_random_next(random) % BLOCKS_FAMILIES), size,
                blocks[i]);
}

/* Decomposes blocks[order[i]], n of them, padded by copies of the first. */
static void run(int size, double blocks[ROOM][9], const int *order, int n, cdem_spring_set *set) {
  cdem_fault fault = {0};
  static double s[ROOM * 9];
  for (int i = 0; i < ROOM; i++)
    for (int e = 0; e < size * size; e++)
      s[blocks_place(size, i, e)] = blocks[i < n ? order[i] : order[0]][e];
  check_ok(cdem_springs_from_blocks(s, n, size, NULL, set, &fault));
}

static void sets_do_not_depend_on_neighbours(void **state) {
  (void)state;
  cdem_random random = {99};
  for (int round = 0; round < 40; round++)
    for (int size = 2; size <= 3; size++) {
      double blocks[ROOM][9];
      int order[ROOM], alone;
      cdem_spring_set first[ROOM], other[ROOM], single[ROOM];
      fill(&random, size, blocks);
      for (int i = 0; i < ROOM; i++)
        order[i] = i;
      memset(first, 0xff, sizeof first); /* whatever was there does not shine through */
      run(size, blocks, order, COUNT, first);
      for (int i = COUNT - 1; i > 0; i--) {
        int j = (int)(cdem_random_next(&random) % (uint64_t)(i + 1)), k = order[i];
        order[i] = order[j], order[j] = k;
      }
      run(size, blocks, order, COUNT, other);
      for (int i = 0; i < COUNT; i++) {
        assert_memory_equal(&first[order[i]], &other[i], offsetof(cdem_spring_set, slow) + 1);
        for (int r = 0; r < CDEM_SPRING_ROWS; r++)
          assert_memory_equal(&first[order[i]].row[r], &other[i].row[r],
                              offsetof(cdem_spring_row, couples_to) + 1);
      }
      alone = order[0];
      run(size, blocks, &alone, 1, single);
      assert_memory_equal(single[0].row[0].dir, first[alone].row[0].dir, 24);
      assert_true(single[0].cond == first[alone].cond);
    }
}

/* Sets beyond n are not written. */
static void only_n_sets_are_written(void **state) {
  (void)state;
  cdem_random random = {3};
  double blocks[ROOM][9];
  int order[ROOM];
  cdem_spring_set set[ROOM], untouched;
  fill(&random, 3, blocks);
  for (int i = 0; i < ROOM; i++)
    order[i] = i;
  memset(&untouched, 0x5a, sizeof untouched);
  for (int n = 0; n < 40; n++) {
    memset(set, 0x5a, sizeof set);
    run(3, blocks, order, n, set);
    assert_memory_equal(&set[n], &untouched, sizeof untouched);
    if (n > 0)
      assert_int_equal(set[n - 1].size, 3);
  }
}

/* Unused rows of a set are zero, so that sets can be compared and written as they are. */
static void unused_rows_are_zero(void **state) {
  (void)state;
  cdem_random random = {8};
  const cdem_spring_row zero = {0};
  for (int size = 2; size <= 3; size++) {
    double blocks[ROOM][9];
    int order[ROOM];
    cdem_spring_set set[ROOM];
    fill(&random, size, blocks);
    for (int i = 0; i < ROOM; i++)
      order[i] = i;
    memset(set, 0x5a, sizeof set);
    run(size, blocks, order, ROOM, set);
    for (int i = 0; i < ROOM; i++)
      for (int r = set[i].rows; r < CDEM_SPRING_ROWS; r++)
        assert_memory_equal(&set[i].row[r], &zero, offsetof(cdem_spring_row, couples_to) + 1);
  }
}

/* Denormal and nearly infinite blocks take the robust path and come out right. */
static void the_ends_of_the_range_are_served(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static double s[72 * 2];
  const double factor[8] = {1.0, 1e308, 1e-308, 3e-310, 0.0, 8.9e307, 1e-320, 1e-100};
  for (int size = 2; size <= 3; size++) {
    cdem_spring_set set[8];
    for (int i = 0; i < 8; i++)
      for (int e = 0; e < size * size; e++)
        s[blocks_place(size, i, e)] =
            factor[i] * (e % (size + 1) == 0 ? 1.0 - 0.25 * e / size : 0.0);
    check_ok(cdem_springs_from_blocks(s, 8, size, NULL, set, &fault));
    for (int i = 0; i < 8; i++) {
      assert_int_equal(set[i].form, CDEM_FORM_DIAGONAL);
      check_near(set[i].row[0].stiffness, factor[i], 1e-15, 1e-323);
      for (int c = 0; c < 3; c++)
        check_near(set[i].row[0].dir[c], c == 0, 0.0, 0.0);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sets_do_not_depend_on_neighbours),
      cmocka_unit_test(only_n_sets_are_written),
      cmocka_unit_test(unused_rows_are_zero),
      cmocka_unit_test(the_ends_of_the_range_are_served),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
