/* Room dem: how dense compaction gets, against what is known of random close packings. */
#include "dem/packing.h"
#include "support/test.h"

static cdem_fault fault;

static const double class_radius[2] = {0.01, 0.014}, class_fraction[2] = {1.0, 1.96};

static cdem_compacted pressed(int dim, int64_t count, double friction, cdem_sizes sizes) {
  double solid = (double)count * cdem_sizes_mean_solid(dim, &sizes);
  double edge = dim == 3 ? cbrt(solid / 0.4) : sqrt(solid / 0.6);
  const cdem_packing_options options = {.dim = dim,
                                        .high = {edge, edge, edge},
                                        .periodic = {true, true, dim == 3},
                                        .sizes = sizes,
                                        .count = count,
                                        .seed = 3};
  const cdem_compaction compaction = {
      .pressure = 1000.0, .friction = friction, .periodic = {true, true, dim == 3}, .threads = 1};
  cdem_grains grains;
  cdem_compacted c;
  check_ok(cdem_packing_make(cdem_packing_find("loose"), &options, &grains, &fault));
  check_ok(cdem_packing_compact(&options, &compaction, &grains, &c, &fault));
  cdem_grains_release(&grains);
  return c;
}

/* Frictionless spheres: 0.64 (O'Hern et al. 2003, Phys. Rev. E 68, 011306: 0.639 for many grains,
 * a few thousandths less for few), with six contacts a carrying grain, as many as hold it. Overlaps
 * of 1e-3 radii add 0.002. */
static void spheres(void **state) {
  (void)state;
  const cdem_sizes equal = {.kind = CDEM_SIZES_EQUAL, .radius = 0.01};
  cdem_compacted smooth = pressed(3, 400, 0.0, equal);
  check_near(smooth.fraction, 0.64, 0.0, 0.007);
  check_near(smooth.coordination, 6.0, 0.0, 0.4);
  /* Random loose packing: friction 0.5 holds spheres at 0.55 to 0.60. */
  cdem_compacted rough = pressed(3, 400, 0.5, equal);
  assert_true(rough.fraction > 0.54 && rough.fraction < 0.605);
}

/* Discs of ratio 1.4, half and half by number: 0.84, four contacts (same source). */
static void discs(void **state) {
  (void)state;
  const cdem_sizes mixed = {.kind = CDEM_SIZES_TABLE,
                            .entries = 2,
                            .class_radius = class_radius,
                            .class_fraction = class_fraction};
  cdem_compacted c = pressed(2, 400, 0.0, mixed);
  check_near(c.fraction, 0.84, 0.0, 0.008);
  check_near(c.coordination, 4.0, 0.0, 0.3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(spheres),
      cmocka_unit_test(discs),
  };
  return cmocka_run_group_tests_name("dem packing_compact_slow", tests, NULL, NULL);
}
