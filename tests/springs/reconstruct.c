/* Fifty thousand blocks of all families; the same for millions is reconstruct_many.c. */
#include "springs/reconstruct.h"

static void every_block_is_rebuilt(void **state) {
  (void)state;
  reconstruct_many(50000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_block_is_rebuilt)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
