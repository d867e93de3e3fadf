/* Deformable grains through the door of a run: neither threads nor interruptions change a bit. */
#include "run/deformable_tube.h"
#include "run/resume.h"

static const char tube[] = "end: 0.4 ms\n"
                           "history_every: 20 us\n"
                           "frame_every: 0.1 ms\n"
                           "checkpoint_every: 0.1 ms\n" DEFORMABLE_TUBE;

/* All but the checkpoint, which holds the wall time. */
static const char *const written[] = {"history.csv", "grains.pvd", "grains/grains-000003.vtu",
                                      NULL};

static void threads_and_breaks_change_no_bit(void **state) {
  (void)state;
  check_threads_and_breaks(tube, written);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_and_breaks_change_no_bit),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
