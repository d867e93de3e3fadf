/* Deformable grains through the door of a run: neither threads nor interruptions change a bit. */
#include "run/resume.h"

/* Thrown at each other and at the walls of a tube. */
static const char tube[] =
    "end: 0.4 ms\n"
    "history_every: 20 us\n"
    "frame_every: 0.1 ms\n"
    "checkpoint_every: 0.1 ms\n"
    "gravity: [0, 0, -10]\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  deformable: {shape: cubesphere, refinement: 2}\n"
    "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.15], radius: "
    "20 mm, count: 24}\n"
    "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"
    "contacts: [{penalty_stiffness: 1e11 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"
    "walls:\n"
    "  floor: {shape: plane, normal: [0, 0, 1]}\n"
    "  tube: {shape: cylinder, radius: 100 mm, center: [0, 0, 0], axis: [0, 0, 1]}\n"
    "  lid: {shape: plane, normal: [0, 0, -1], center: [0, 0, 0.15], velocity: {z: -50 m/s}}\n";

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
