/* Numbers with units: three bytes of exponents (length, time, mass), then the text. */
#include "fuzz/fuzz.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  double value = NAN;
  if (size < 3)
    return 0;
  const cdem_dimension dimension = {data[0] % 9 - 4, data[1] % 9 - 4, data[2] % 5 - 2};
  char *text = fuzz_text(data + 3, size - 3);
  if (fuzz_is_read(cdem_parse_quantity(text, dimension, &value, &fault), &fault))
    fuzz_require(isfinite(value), "'%s' is %g", text, value);
  free(text);
  return 0;
}
