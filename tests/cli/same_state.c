/* Are two checkpoints the same, array by array, but for the wall time?
 * usage: test_cli_same_state CHECKPOINT CHECKPOINT */
#include "io/run_files.h"

#include <stdio.h>
#include <string.h>

static bool same_array(const cdem_array *a, const cdem_array *b) {
  if (b == NULL || a->type != b->type || a->count != b->count)
    return false;
  int64_t count = strcmp(a->name, "run/reals") == 0 ? 1 : a->count; /* behind it the wall time */
  return count == 0 || memcmp(a->data, b->data, (size_t)count * cdem_array_size(a->type)) == 0;
}

static int compare(const cdem_state *a, const cdem_state *b) {
  int differ = a->arrays != b->arrays;
  if (differ != 0)
    printf("%lld arrays and %lld\n", (long long)a->arrays, (long long)b->arrays);
  for (int64_t i = 0; i < a->arrays; i++)
    if (!same_array(&a->array[i], cdem_state_find(b, a->array[i].name))) {
      printf("array '%s' differs\n", a->array[i].name);
      differ = 1;
    }
  return differ;
}

int main(int argc, char **argv) {
  cdem_fault fault = {0};
  cdem_state state[2] = {{0}};
  if (argc != 3) {
    fprintf(stderr, "usage: test_cli_same_state CHECKPOINT CHECKPOINT\n");
    return 2;
  }
  for (int i = 0; i < 2; i++)
    if (cdem_read_state(argv[1 + i], &state[i], &fault) != CDEM_OK) {
      printf("%s\n", fault.message);
      return 1;
    }
  int differ = compare(&state[0], &state[1]);
  cdem_state_release(&state[0]);
  cdem_state_release(&state[1]);
  return differ;
}
