/* Case files cut off, with bytes changed, and read with too little memory: a status, never more. */
#include "cases/support.h"

#include <ctype.h>

/* Numbers without units: UDUNITS needs not read its database a thousand times. */
static const char plain[] =
    "title: \"quoted, \\\"text\\\"\"\n"
    "end: 0.01\n"
    "gravity: [0, -9.81]\n"
    "quiet: [left, right]\n"
    "mesh: {file: plate.geo, parameters: {h: 0.005}}\n"
    "materials:\n"
    "  rock: {young: 3e10, poisson: 0.3, density: 2700, groups: [a, b]}\n"
    "  clay: {young: 3e7, poisson: 0.4, density: 1900}\n"
    "blocks: {breakable: rock}\n"
    "interfaces:\n"
    "  - {between: [rock, rock], tension: 1e6, softening: linear, energy_1: 10}\n"
    "contact: {friction: 0.5}\n"
    "supports:\n"
    "  - {group: bottom, displacement: {x: 0, y: {ramp: -1e-3, over: 0.01}}}\n"
    "loads:\n"
    "  - {group: edge, pressure: {table: [[0, 1], [1, 2]]}}\n"
    "plates:\n"
    "  press: {point: [0, 0.1], normal: [0, -2], velocity: {y: -0.02}}\n"
    "probes:\n"
    "  tip: {group: tip, component: y}\n"
    "curves:\n"
    "  load: {x: tip, y: [a, b], y_label: load}\n"
    "results:\n"
    "  peak: {of: tip, take: min}\n";

/* Reads what may be anything; what is read can be written anew and read again. */
static bool survives(const char *text, size_t bytes) {
  static const char *const override[] = {"thickness=2"};
  cdem_fault fault = {0};
  cdem_case read = {0};
  write_bytes(text, bytes);
  cdem_status status = cdem_read_case(in_scratch("c.yaml"), 1, override, &read, &fault);
  if (status != CDEM_OK) {
    assert_int_equal(status, CDEM_INPUT);
    assert_true(fault.message[0] != '\0' && read.path == NULL);
    return false;
  }
  assert_true(read.values.thickness == 2.0);
  cdem_case again = {0};
  char *source = strdup(read.source);
  cdem_case_release(&read);
  check_ok(read_text(source, &again, &fault));
  free(source);
  cdem_case_release(&again);
  return true;
}

static void cut_off_anywhere(void **state) {
  (void)state;
  for (size_t bytes = 1; bytes < sizeof plain - 1; bytes++)
    survives(plain, bytes);
  assert_true(survives(plain, sizeof plain - 1));
}

static void with_bytes_changed(void **state) {
  (void)state;
  cdem_random random = {20240611};
  static const char likely[] = "[]{}:,-#'\"&*!|>%@`\n\t 019.eE~=\\\0\x80\xff";
  char text[sizeof plain];
  int good = 0;
  for (int round = 0; round < 800; round++) {
    memcpy(text, plain, sizeof plain);
    bool gentle = round % 3 == 0; /* a digit or a letter for another */
    int changes = gentle ? 1 : 1 + round % 4;
    for (int c = 0; c < changes; c++) {
      size_t at = (size_t)cdem_random_uniform(&random, 0, sizeof plain - 1.001);
      size_t which = (size_t)cdem_random_uniform(&random, 0, sizeof likely - 1.001);
      if (gentle && isalnum((unsigned char)text[at]))
        text[at] = "0123456789abcxyz"[which % 16];
      else
        text[at] =
            round % 3 == 1 ? (char)(int)cdem_random_uniform(&random, 0, 255.9) : likely[which];
    }
    good += survives(text, sizeof plain - 1);
  }
  assert_true(good > 30 && good < 770); /* the test sees both */
}

/* The n-th allocation fails, for every n. */
static void lack_of_memory(void **state) {
  (void)state;
  static const char *const override[] = {"mesh.unit=2", "loads[1]={group: a, force: {x: 1}}",
                                         "initial=[{velocity: [1, 2]}]"};
  write_bytes(plain, sizeof plain - 1);
  bool done = false;
  for (int after = 0; !done; after++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    cdem_memory_fail_after(after);
    cdem_status status = cdem_read_case(in_scratch("c.yaml"), 3, override, &read, &fault);
    cdem_memory_fail_after(-1);
    done = status == CDEM_OK;
    assert_true(done || (status == CDEM_MEMORY && read.path == NULL));
    assert_true(!done || after > 150);
    cdem_case_release(&read);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cut_off_anywhere),
      cmocka_unit_test(with_bytes_changed),
      cmocka_unit_test(lack_of_memory),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
