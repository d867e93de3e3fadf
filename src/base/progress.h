/* Progress: how long work reports itself and hears that it should stop.
 *
 * The library never prints and never looks at signals. Whoever starts long work may hand it a
 * progress: `report` is called now and then, from one thread at a time, with the amount done, and
 * answers true to go on, false to stop cleanly (the work then returns CDEM_INTERRUPTED).
 */
#ifndef CDEM_BASE_PROGRESS_H
#define CDEM_BASE_PROGRESS_H

#include "base/fault.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  void *context;
  /* what: the work in a few words ("converting elements"); done of total units, total 0 when
   * unknown. */
  bool (*report)(void *context, const char *what, int64_t done, int64_t total);
} cdem_progress;

/* Reports to *progress (NULL: nobody listens) and turns a wish to stop into CDEM_INTERRUPTED. */
cdem_status cdem_progress_report(const cdem_progress *progress, const char *what, int64_t done,
                                 int64_t total, cdem_fault *fault);

#endif
