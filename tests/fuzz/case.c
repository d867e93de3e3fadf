/* Case files, with what `cdem run --set` adds: lines of the file that begin with "#--set " are
 * overrides, too (comments to YAML). */
#include "fuzz/fuzz.h"
#include "io/case_file.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 8 };
static const char mark[] = "#--set ";

/* Cuts them out of a copy of the text. */
static int overrides_of(char *text, const char *override[MOST]) {
  int count = 0;
  for (char *line = text; line != NULL && count < MOST;) {
    char *next = strchr(line, '\n');
    if (next != NULL)
      *next++ = '\0';
    if (strncmp(line, mark, sizeof mark - 1) == 0)
      override[count++] = line + sizeof mark - 1;
    line = next;
  }
  return count;
}

/* The text that a run keeps gives a case again, from any folder. */
static void use_case(cdem_case *read, int overrides, const char *const *override) {
  cdem_fault fault = {0};
  cdem_case again = {0};
  fuzz_require(cdem_case_settle_files(read, overrides, override, &fault) == CDEM_OK,
               "files not settled: %s", fault.message);
  fuzz_require(cdem_read_case_text("kept.yaml", read->source, &again, &fault) == CDEM_OK,
               "the kept text gives no case: %s\n%s", fault.message, read->source);
  cdem_case_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  cdem_case read = {0};
  const char *override[MOST];
  char *text = fuzz_text(data, size);
  int overrides = overrides_of(text, override);
  if (fuzz_is_read(cdem_read_case(fuzz_file(data, size), overrides, override, &read, &fault),
                   &fault))
    use_case(&read, overrides, override);
  cdem_case_release(&read);
  free(text);
  return 0;
}
