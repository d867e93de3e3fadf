/* Abaqus and CalculiX decks. */
#include "fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_mesh(data, size, cdem_read_inp);
  return 0;
}
