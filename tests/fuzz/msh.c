/* MSH files, versions 2.2 and 4.1, text and binary, through our own parser (4.0 is gmsh's). */
#include "fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_mesh(data, size, cdem_read_msh);
  return 0;
}
