/* A case scaled from file to file: nothing half-written, nothing forgotten when memory ends. */
#include "base/memory.h"
#include "run/scale.h"
#include "support/scratch.h"

#include <stdlib.h>
#include <unistd.h>

static const char grains_case[] = "end: 1 ms\n"
                                  "grains: {dimension: 2, file: \"it's.csv\", materials: {s: "
                                  "{density: 2600 kg/m3}}}\n"
                                  "contacts: [{normal_stiffness: 1 MN/m, restitution: 0.5}]\n";

static void write_file(const char *name, const char *text) {
  FILE *file = fopen(in_scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

static cdem_status scale(const char *name, const char *output, cdem_fault *fault) {
  cdem_scaled_table table = {0};
  char path[600], to[600];
  snprintf(path, sizeof path, "%s", in_scratch(name));
  snprintf(to, sizeof to, "%s", in_scratch(output));
  const cdem_scale_options options = {
      .path = path, .output = to, .scaling = cdem_scaling_exact(cdem_ratios_of_size(2.0))};
  cdem_status status = cdem_scale_case(&options, &table, fault);
  cdem_scaled_table_release(&table);
  return status;
}

static void check_content(const char *name, const char *wanted) {
  char text[2000];
  FILE *file = fopen(in_scratch(name), "r");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = '\0';
  fclose(file);
  assert_string_equal(text, wanted);
}

static void a_table_of_grains_goes_along(void **state) {
  (void)state;
  cdem_fault fault = {0};
  write_file("it's.csv", "x,y,radius,vx,wz\n0,0,0.5,3,4\n1,0,0.5,0,0\n");
  write_file("case.yaml", grains_case);
  check_ok(scale("case.yaml", "it's2.yaml", &fault));
  check_content("it's2.yaml",
                "# case.yaml, scaled exactly (cdem scale): length 2, time 2, mass 8.\n"
                "thickness: 2\nend: 0.002\n"
                "grains: {dimension: 2, file: 'it''s2-grains.csv', materials: {s: {density: 2600 "
                "kg/m3}}}\ncontacts: [{normal_stiffness: 2000000, restitution: 0.5}]\n");
  check_content("it's2-grains.csv", "x [m],y [m],radius [m],vx [m/s],vy [m/s],wz [rad/s]\n"
                                    "0,0,1,3,0,2\n2,0,1,0,0,0\n");
  write_file("it's.csv", "x,y\n0,0\n"); /* no radius: nothing is left behind */
  check_fails(scale("case.yaml", "bad.yaml", &fault), CDEM_INPUT, "radius");
  assert_int_not_equal(access(in_scratch("bad.yaml"), F_OK), 0);
  assert_int_not_equal(access(in_scratch("bad-grains.csv"), F_OK), 0);
}

static void a_table_of_grains_is_not_overwritten(void **state) {
  (void)state;
  static const char grains[] = "x,y,radius\n0,0,0.5\n1,0,0.5\n";
  cdem_fault fault = {0};
  write_file("b-grains.csv", grains);
  write_file("a.yaml", "end: 1 ms\n"
                       "grains: {dimension: 2, file: b-grains.csv, materials: {s: {density: 1}}}\n"
                       "contacts: [{normal_stiffness: 1, restitution: 0.5}]\n");
  check_fails(scale("a.yaml", "b.yaml", &fault), CDEM_USAGE,
              "the scaled table of grains would overwrite");
  check_content("b-grains.csv", grains);
  assert_int_not_equal(access(in_scratch("b.yaml"), F_OK), 0);
}

static void lack_of_memory(void **state) {
  (void)state;
  int failures = 0;
  write_file("it's.csv", "x,y,radius\n0,0,0.5\n1,0,0.5\n");
  write_file("case.yaml", grains_case);
  for (;; failures++) {
    cdem_fault fault = {0};
    unlink(in_scratch("twice.yaml"));
    cdem_memory_fail_after(failures);
    cdem_status status = scale("case.yaml", "twice.yaml", &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK)
      break;
    if (status != CDEM_MEMORY)
      fail_msg("after %d: %s", failures, fault.message);
    assert_int_not_equal(access(in_scratch("twice.yaml"), F_OK), 0);
  }
  assert_true(failures > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_table_of_grains_goes_along),
      cmocka_unit_test(a_table_of_grains_is_not_overwritten),
      cmocka_unit_test(lack_of_memory),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
