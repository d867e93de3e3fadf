/* Exact scaling by powers of two repeats a run to the last bit, exponents apart. */
#include "verify/scaling.h"

#include "support/test.h"

static void check_bits(cdem_scaling_case which, cdem_ratios ratios) {
  cdem_fault fault = {0};
  cdem_scaling_difference d;
  check_ok(cdem_scaling_pair(cdem_scaling_text[which], &ratios, true, &d, &fault));
  if (d.off > 0)
    fail_msg("case %d: %lld of %lld numbers are off, first %s", (int)which, (long long)d.off,
             (long long)d.numbers, d.first);
  assert_true(d.numbers > 500);
}

#define BITS(name, which)                                                                          \
  static void name(void **state) {                                                                 \
    (void)state;                                                                                   \
    check_bits(which, cdem_ratios_of_size(2.0));                                                   \
    check_bits(which, cdem_ratios_of_size(4.0));                                                   \
    check_bits(which, cdem_ratios_of_size(0.5));                                                   \
    check_bits(which, (cdem_ratios){2.0, 4.0, 8.0});                                               \
    check_bits(which, (cdem_ratios){4.0, 2.0, 128.0});                                             \
  }
BITS(body, CDEM_SCALING_BODY)
BITS(fracture, CDEM_SCALING_FRACTURE)
BITS(solid, CDEM_SCALING_SOLID)
BITS(spheres, CDEM_SCALING_SPHERES)
BITS(hertz, CDEM_SCALING_HERTZ)
BITS(discs, CDEM_SCALING_DISCS)
BITS(at_rest, CDEM_SCALING_STATIC)
BITS(bonded, CDEM_SCALING_BONDED)
BITS(footing, CDEM_SCALING_FOOTING)
BITS(fdem, CDEM_SCALING_FDEM)
BITS(vibrating, CDEM_SCALING_EXPLICIT)
BITS(triaxial, CDEM_SCALING_TRIAXIAL)
BITS(deformed, CDEM_SCALING_DEFORMED)

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(body),     cmocka_unit_test(fracture),  cmocka_unit_test(solid),
      cmocka_unit_test(spheres),  cmocka_unit_test(hertz),     cmocka_unit_test(discs),
      cmocka_unit_test(at_rest),  cmocka_unit_test(bonded),    cmocka_unit_test(footing),
      cmocka_unit_test(fdem),     cmocka_unit_test(vibrating), cmocka_unit_test(triaxial),
      cmocka_unit_test(deformed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
