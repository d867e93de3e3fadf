/* A program that uses the library may have switched to any locale: with a decimal comma every door
 * gives the same bits, in what is read as in what is written, and the locale stays as it was. */
#include "robust/walk.h"
#include "support/comma.h"

static void walk(void **state) {
  const door *d = *state;
  setlocale(LC_ALL, "C");
  uint64_t expected = open_door(d);
  if (!use_comma_locale()) {
    print_message("no locale with a decimal comma can be made: skipped\n");
    skip();
  }
  uint64_t sum = open_door(d);
  char half[8];
  snprintf(half, sizeof half, "%.1f", 0.5);
  assert_string_equal(half, "0,5");
  setlocale(LC_ALL, "C");
  if (sum != expected)
    fail_msg("%s: with a decimal comma the result is another one", d->name);
}

int main(int argc, char **argv) {
  return run_doors(walk, argc > 1 ? argv[1] : NULL);
}
