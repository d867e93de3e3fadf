/* Tables of classes of sizes. */
#include "fuzz/fuzz.h"
#include "io/grains_file.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  int classes = 0;
  double *radius = NULL, *fraction = NULL;
  if (fuzz_is_read(cdem_read_sizes(fuzz_file(data, size), &classes, &radius, &fraction, &fault),
                   &fault))
    for (int i = 0; i < classes; i++)
      fuzz_require(isfinite(radius[i]) && isfinite(fraction[i]), "class %d is %g, %g", i, radius[i],
                   fraction[i]);
  free(radius);
  free(fraction);
  return 0;
}
