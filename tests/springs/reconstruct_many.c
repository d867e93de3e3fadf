/* Two million blocks of all families (slow). */
#include "springs/reconstruct.h"

static void every_block_is_rebuilt(void **state) {
  (void)state;
  reconstruct_many(2100000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_block_is_rebuilt)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
