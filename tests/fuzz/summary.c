/* summary.json of a run, read back when runs are compared. */
#include "fuzz/fuzz.h"
#include "io/run_files.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  cdem_summary_file summary = {0};
  if (fuzz_is_read(cdem_read_summary(fuzz_file(data, size), &summary, &fault), &fault))
    for (int64_t i = 0; i < summary.results; i++)
      fuzz_require(summary.result[i].name != NULL, "result %lld has no name", (long long)i);
  cdem_summary_file_release(&summary);
  return 0;
}
