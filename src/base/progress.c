#include "base/progress.h"

#include <stddef.h>

cdem_status cdem_progress_report(const cdem_progress *progress, const char *what, int64_t done,
                                 int64_t total, cdem_fault *fault) {
  if (progress == NULL || progress->report == NULL)
    return CDEM_OK;
  if (progress->report(progress->context, what, done, total))
    return CDEM_OK;
  return cdem_fail(fault, CDEM_INTERRUPTED, "interrupted while %s", what);
}
