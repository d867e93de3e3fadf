/* Neighbours: what a build costs, counted. */
#include "dem/neighbours_support.h"

static void cost(int dim, int32_t grains, double ratio, double far, double *tests,
                 double *numbers) {
  cdem_fault fault = {0};
  cdem_dem_store s;
  store_init(&s, dim, grains, 0.1);
  double small = 0.5, large = ratio * small, edge;
  /* Mean of r^2 and r^3 of the distribution r^-3, from which follows a dense box. */
  double square = 2.0 * log(ratio) / (1.0 - 1.0 / (ratio * ratio)), cube = 2.0 * ratio;
  if (dim == 2)
    edge = sqrt(grains * 3.14 * (ratio > 1.0 ? square : 1.0) * small * small / 0.8);
  else
    edge = cbrt(grains * 4.19 * (ratio > 1.0 ? cube : 1.0) * small * small * small / 0.6);
  double box[3] = {edge, edge, edge};
  store_fill(&s, box, small, large, 3);
  for (int k = 0; k < 9 && far > 0.0; k++)
    cdem_place(&s, k)[k % dim] = k % 2 ? far : -far * (1 + k);
  check_ok(cdem_neighbours_build(&s, true, 1, &fault));
  *tests = (double)s.search->tests / (double)grains;
  *numbers = (double)memory_of(&s) / (double)grains;
  store_release(&s);
}

/* Tests of pairs and memory for a grain do not grow with the number of grains, nor much with the
 * ratio of sizes, nor by grains that flew away. */
static void test_cost(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    double few, many, mixed, wide, far, room[5];
    cost(dim, 1000, 1.0, 0.0, &few, &room[0]);
    cost(dim, 100000, 1.0, 0.0, &many, &room[1]);
    cost(dim, 20000, 10.0, 0.0, &mixed, &room[2]);
    cost(dim, 20000, 30.0, 0.0, &wide, &room[3]);
    cost(dim, 20000, 1.0, 1e12, &far, &room[4]);
    check_below(many, 1.5 * few);
    check_below(mixed, 4.0 * many);
    check_below(wide, 6.0 * many);
    check_below(far, 1.05 * many);
    for (int k = 0; k < 5; k++)
      check_below(room[k], 200.0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_cost)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
