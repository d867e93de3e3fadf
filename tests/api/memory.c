/* Every allocation of the face fails in turn: LIBCDEM_MEMORY each time, nothing is kept (the
 * sanitizers look), and the call after succeeds. Linked from the rooms, because the library hides
 * the switch. */
#include "base/memory.h"

#include "support.h"

static const int32_t bricks[3] = {1, 1, 1};
static const double low[3] = {0.0, 0.0, 0.0}, high[3] = {1.0, 1.0, 1.0}, rock[2] = {40e9, 0.25};

static bool look(void *context, const libcdem_pair *pair) {
  (void)pair;
  ++*(int *)context;
  return true;
}

static libcdem_status springs(libcdem_fault *fault) {
  int pairs = 0;
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  libcdem_status status = libcdem_mesh_box("tet4", bricks, high, &mesh, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_create(mesh, &model, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_material(model, "isotropic", 2, rock, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_model_visit(model, look, &pairs, NULL, fault);
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
  return status;
}

static libcdem_status packing(libcdem_fault *fault) {
  libcdem_packing *made = NULL;
  libcdem_status status = libcdem_packing_create("cubic", 3, low, high, &made, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_packing_set(made, "radius", 0.1, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_packing_make(made, NULL, fault);
  libcdem_packing_destroy(&made);
  return status;
}

static libcdem_status run(libcdem_fault *fault) {
  libcdem_run *made = NULL;
  libcdem_status status = libcdem_run_create("case.yaml", &made, fault);
  for (int i = 0; i < 9 && status == LIBCDEM_OK; i++)
    status = libcdem_run_set(made, "end=1 s", fault);
  libcdem_run_destroy(&made);
  return status;
}

static void each_allocation_may_fail(void **state) {
  (void)state;
  libcdem_status (*const walk[])(libcdem_fault *) = {springs, packing, run};
  for (size_t w = 0; w < sizeof walk / sizeof *walk; w++) {
    libcdem_status status = LIBCDEM_MEMORY;
    int64_t good = 0;
    for (; status == LIBCDEM_MEMORY; good++) {
      libcdem_fault fault = {0};
      cdem_memory_fail_after(good);
      status = walk[w](&fault);
      cdem_memory_fail_after(-1);
      assert_int_equal(fault.status, status);
    }
    assert_int_equal(status, LIBCDEM_OK);
    assert_true(good > 3); /* some did fail */
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_allocation_may_fail)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
