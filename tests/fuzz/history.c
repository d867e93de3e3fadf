/* history.csv of a run, read back when it is continued, compared and drawn. */
#include "fuzz/fuzz.h"
#include "io/run_files.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  cdem_table table;
  if (fuzz_is_read(cdem_read_history(fuzz_file(data, size), &table, &fault), &fault))
    cdem_table_release(&table);
  return 0;
}
