/* Tables of grains, as discs, as spheres and by their columns. */
#include "fuzz/fuzz.h"
#include "io/grains_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const int dims[] = {0, 2, 3};
  cdem_fault fault = {0};
  const char *path = fuzz_file(data, size);
  for (int d = 0; d < 3; d++) {
    cdem_grain_table table;
    if (!fuzz_is_read(cdem_read_grains(path, dims[d], &table, &fault), &fault))
      continue;
    /* What may still be wrong is said at the case that names the table. */
    fuzz_is_read(cdem_grains_check(&table.grains, &fault), &fault);
    for (int64_t i = 0; table.grains.material != NULL && i < table.grains.grains; i++)
      fuzz_require(table.grains.material[i] >= 0 && table.grains.material[i] < table.names,
                   "grain %lld has material %d of %lld", (long long)i, table.grains.material[i],
                   (long long)table.names);
    cdem_grain_table_release(&table);
  }
  return 0;
}
