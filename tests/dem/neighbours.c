/* Neighbours: the list is that of a plain search, whatever the grains, the cell, the threads. */
#include "dem/neighbours_support.h"

/* Pair i < j is near with this image. */
static bool is_near(const cdem_dem_store *s, int64_t i, int64_t j, int code) {
  const double *a = cdem_place(s, i), *b = cdem_place(s, j);
  double square = 0.0, near = a[3] + b[3] + s->skin;
  for (int c = 0; c < 3; c++) {
    double d = b[c] + s->image[code][c] - a[c];
    square += d * d;
  }
  return square < near * near;
}

static void compare(const cdem_dem_store *s) {
  bool periodic = cdem_cell_is_periodic(&s->cell);
  int64_t at = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    assert_int_equal(s->pair_start[i], at);
    for (int64_t j = i + 1; j < s->grains; j++)
      for (int code = periodic ? 0 : CDEM_IMAGE_SELF; code < (periodic ? 27 : 14); code++) {
        if (code != CDEM_IMAGE_SELF && s->image[code][0] == 0.0 && s->image[code][1] == 0.0 &&
            s->image[code][2] == 0.0)
          continue;
        if (!is_near(s, i, j, code))
          continue;
        bool unique = true; /* free directions repeat the shift of another code */
        for (int d = 0, one = 1; d < 3; d++, one *= 3)
          unique = unique && (s->cell.periodic[d] || code / one % 3 == 1);
        if (!unique)
          continue;
        assert_true(at < s->pairs);
        assert_int_equal(s->pair_other[at], j);
        if (periodic)
          assert_int_equal(s->pair_image[at], code);
        at++;
      }
  }
  assert_int_equal(s->pairs, at);
  assert_int_equal(s->pair_start[s->grains], at);
  for (int32_t i = 0; i < s->grains; i++)
    assert_int_equal(s->slot[s->id[i]], i);
}

static void build_and_compare(cdem_dem_store *s) {
  cdem_fault fault = {0};
  check_ok(cdem_neighbours_build(s, false, 1, &fault));
  compare(s);
  check_ok(cdem_neighbours_build(s, true, 2, &fault));
  compare(s);
}

static void test_open(void **state) {
  (void)state;
  static const struct {
    int dim, grains;
    double box[3], small, large, skin;
  } sets[] = {{3, 500, {10, 10, 10}, 0.5, 0.5, 0.2},  {2, 500, {30, 20, 0}, 0.5, 0.5, 0.2},
              {3, 700, {20, 20, 20}, 0.2, 2.0, 0.1},  {2, 700, {50, 60, 0}, 0.2, 2.0, 0.0},
              {3, 400, {40, 1, 1}, 0.3, 0.4, 0.1},    {3, 400, {1, 1, 40}, 0.3, 0.4, 0.1},
              {3, 400, {20, 0.1, 20}, 0.3, 1.2, 0.1}, {3, 1, {1, 1, 1}, 0.5, 0.5, 0.1},
              {3, 60, {0, 0, 0}, 0.5, 0.5, 0.1},      {2, 300, {10, 10, 0}, 0.01, 1.0, 0.001},
              {3, 500, {9, 9, 9}, 0.001, 1.0, 0.0001}};
  for (size_t k = 0; k < sizeof sets / sizeof *sets; k++) {
    cdem_dem_store s;
    store_init(&s, sets[k].dim, sets[k].grains, sets[k].skin);
    store_fill(&s, sets[k].box, sets[k].small, sets[k].large, k + 1);
    build_and_compare(&s);
    store_release(&s);
  }
}

/* Skewed cells, one to three directions; narrow ones, where two images of a grain are near one. */
static void test_periodic(void **state) {
  (void)state;
  cdem_random random = {7};
  for (int k = 0; k < 60; k++) {
    int dim = 2 + k % 2, subset = 1 + k % (dim == 2 ? 3 : 7);
    bool periodic[3] = {subset & 1, subset & 2, subset & 4};
    double size = k % 3 == 0 ? 2.6 : cdem_random_uniform(&random, 4.0, 12.0), h[9] = {0};
    for (int c = 0; c < 3; c++)
      for (int r = 0; r < 3; r++)
        if (periodic[c] && periodic[r])
          h[3 * r + c] = size * (r == c  ? 1.0
                                 : r < c ? cdem_random_uniform(&random, -1.5, 1.5)
                                         : cdem_random_uniform(&random, -0.05, 0.05));
    double box[3] = {2.0 * size, 2.0 * size, 2.0 * size};
    cdem_dem_store s;
    store_init(&s, dim, 150, 0.1);
    store_fill(&s, box, k % 2 ? 0.1 : 0.5, k % 3 == 0 ? 0.5 : 1.0, (uint64_t)k + 100);
    store_cell(&s, periodic, h);
    build_and_compare(&s);
    store_release(&s);
  }
}

/* ---- what the list and the order do not depend on ---- */

/* The same grains by other ids. */
static void shuffle(const cdem_dem_store *s, cdem_dem_store *t, double scale) {
  cdem_random random = {11};
  store_init(t, s->dim, s->grains, scale * s->skin);
  int32_t *to = t->slot;
  for (int32_t i = s->grains - 1; i > 0; i--) {
    int32_t j = (int32_t)(cdem_random_next(&random) % (uint64_t)(i + 1)), swap = to[i];
    to[i] = to[j];
    to[j] = swap;
  }
  for (int64_t i = 0; i < s->grains; i++) {
    for (int k = 0; k < 4; k++)
      cdem_place(t, to[i])[k] = scale * cdem_place(s, i)[k];
    memcpy(cdem_motion(t, to[i]), cdem_motion(s, i), 64);
  }
  for (int32_t i = 0; i < s->grains; i++)
    to[i] = i;
  if (cdem_cell_is_periodic(&s->cell)) {
    double h[9];
    for (int k = 0; k < 9; k++)
      h[k] = scale * s->cell.h[k];
    store_cell(t, s->cell.periodic, h);
  }
}

static void check_same(const cdem_dem_store *s, const cdem_dem_store *t, double scale) {
  size_t pairs = (size_t)s->pairs;
  assert_int_equal(s->pairs, t->pairs);
  for (int64_t i = 0; i < s->grains; i++) {
    for (int k = 0; k < 4; k++)
      assert_true(scale * cdem_place(s, i)[k] == cdem_place(t, i)[k]);
    assert_memory_equal(cdem_motion(s, i), cdem_motion(t, i), 64);
  }
  assert_memory_equal(s->pair_start, t->pair_start, 8 * (size_t)(s->grains + 1));
  assert_memory_equal(s->pair_other, t->pair_other, 4 * pairs);
  if (s->pair_image != NULL)
    assert_memory_equal(s->pair_image, t->pair_image, pairs);
}

/* Ids, threads and the unit of length do not matter: with ties in all but the velocity, with zeros
 * of both signs, in a cell and without. */
static void test_invariance(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const bool all[3] = {true, true, true};
  static const double h[9] = {13, 2, -1, 0, 12, 3, 0, 0, 11};
  double box[3] = {12, 12, 12};
  for (int k = 0; k < 12; k++) {
    cdem_dem_store s, t;
    store_init(&s, 2 + k % 2, 900, 0.1);
    store_fill(&s, box, 0.1, k % 3 == 0 ? 1.0 : 0.1, (uint64_t)k);
    for (int64_t i = 0; i < 50; i++) {
      memcpy(cdem_place(&s, i + 50), cdem_place(&s, i), 32);
      cdem_place(&s, i + 100)[k % 3] = i % 2 ? 0.0 : -0.0;
    }
    if (k % 4 == 3)
      store_cell(&s, all, h);
    double scale = k % 2 ? 0x1p-13 : 0x1p7;
    shuffle(&s, &t, scale);
    check_ok(cdem_neighbours_build(&s, true, 1, &fault));
    check_ok(cdem_neighbours_build(&t, true, 4, &fault));
    check_same(&s, &t, scale);
    check_ok(cdem_neighbours_build(&s, true, 3, &fault));
    check_same(&s, &t, scale); /* a second sort changes nothing */
    store_release(&s);
    store_release(&t);
  }
}

/* Closer than the skin: not at it. */
static void test_skin(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int axis = 0; axis < 3; axis++)
    for (int k = -1; k <= 1; k++) {
      cdem_dem_store s;
      store_init(&s, 3, 2, 0.5);
      cdem_place(&s, 0)[3] = 1.0;
      cdem_place(&s, 1)[3] = 2.0;
      cdem_place(&s, 1)[axis] = 3.5 + k * 0x1p-50;
      check_ok(cdem_neighbours_build(&s, true, 1, &fault));
      assert_int_equal(s.pairs, k < 0);
      assert_int_equal(s.builds, 1);
      store_release(&s);
    }
}

/* Grains in a row of clumps far from each other, along every axis and the diagonal. */
static void test_clumps(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    cdem_dem_store s;
    double box[3] = {3, 3, 3};
    store_init(&s, 3, 600, 0.1);
    store_fill(&s, box, 0.1, 1.0, 5);
    for (int64_t i = 0; i < s.grains; i++)
      for (int c = 0; c < 3; c++)
        if (k == c || k == 3)
          cdem_place(&s, i)[c] += (double)(i % 7) * 0x1p40;
    build_and_compare(&s);
    check_below((double)memory_of(&s), 200.0 * s.grains);
    store_release(&s);
  }
}

/* ---- errors ---- */

static void test_errors(void **state) {
  (void)state;
  cdem_fault fault = {0};
  static const bool one[3] = {false, true, false};
  static const double h[9] = {0, 0, 0, 0, 2.0, 0, 0, 0, 0};
  cdem_dem_store s;
  double box[3] = {2, 2, 2};
  store_init(&s, 3, 20, 0.1);
  store_fill(&s, box, 0.5, 0.99, 1);
  store_cell(&s, one, h);
  cdem_place(&s, 3)[3] = 1.0;
  check_fails(cdem_neighbours_build(&s, true, 1, &fault), CDEM_INPUT,
              "2 m wide across edge y, but must be 2.1 m at least");
  s.cell.h[4] = 2.2;
  check_ok(cdem_neighbours_build(&s, true, 1, &fault));
  int32_t last = s.slot[7];
  cdem_place(&s, last)[1] = NAN;
  check_fails(cdem_neighbours_build(&s, true, 1, &fault), CDEM_NUMERIC, "grain 7 is at (");
  assert_int_equal(s.pairs, 0);
  store_release(&s);
}

static void test_memory(void **state) {
  (void)state;
  static const bool two[3] = {true, true, false};
  static const double h[9] = {9, 1, 0, 0, 9, 0, 0, 0, 0};
  double box[3] = {8, 8, 30};
  cdem_fault fault = {0};
  int64_t failures = 0;
  for (bool done = false; !done; failures++) {
    cdem_dem_store s;
    store_init(&s, 3, 150, 0.1);
    s.histories = 2;
    store_fill(&s, box, 0.05, 2.0, 2);
    store_cell(&s, two, h);
    cdem_memory_fail_after(failures);
    done = cdem_neighbours_build(&s, true, 1, NULL) == CDEM_OK;
    cdem_memory_fail_after(-1);
    if (!done) {
      assert_int_equal(s.pairs, 0);
      check_ok(cdem_neighbours_build(&s, true, 1, &fault));
    }
    compare(&s);
    store_release(&s);
  }
  assert_true(failures > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_open),       cmocka_unit_test(test_periodic),
      cmocka_unit_test(test_invariance), cmocka_unit_test(test_skin),
      cmocka_unit_test(test_clumps),     cmocka_unit_test(test_errors),
      cmocka_unit_test(test_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
