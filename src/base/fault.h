/* Faults: how a failure travels from the place that sees it to the person who must act on it.
 *
 * Every checked call returns a cdem_status and takes, as its last argument, a fault that the caller
 * owns. The first failure writes one message into it - what is wrong, where, the value and the
 * bound, what to do - and nothing below overwrites it. NULL is allowed: the status alone then
 * travels. After a failure the outputs of a call are untouched or empty, never half filled.
 *
 * Three kinds are kept apart: a mistake of this library is an assert, a mistake of the caller and a
 * failure of the outside world are statuses, in release builds too.
 */
#ifndef CDEM_BASE_FAULT_H
#define CDEM_BASE_FAULT_H

#include <stdarg.h>

typedef enum {
#define X(name, exit_code, text) CDEM_##name,
#include "base/status.def"
#undef X
  CDEM_STATUS_COUNT
} cdem_status;

enum { CDEM_FAULT_LENGTH = 1024 };

/* Zero-initialise: `cdem_fault fault = {0};`. */
typedef struct {
  cdem_status status;
  char message[CDEM_FAULT_LENGTH]; /* one line, or several lines of which the first is the error */
} cdem_fault;

/* The text of a status ("bad input"), and the program's exit code for it. */
const char *cdem_status_text(cdem_status status);
int cdem_status_exit_code(cdem_status status);

/* Records the first failure in *fault (which may be NULL) and returns `status`. */
__attribute__((format(printf, 3, 4))) cdem_status cdem_fail(cdem_fault *fault, cdem_status status,
                                                            const char *format, ...);

/* Puts "WHERE: " before a message already recorded. */
__attribute__((format(printf, 2, 3))) void cdem_fault_prefix(cdem_fault *fault, const char *format,
                                                             ...);

/* Return with a message unless the condition holds. */
#define CDEM_REQUIRE(condition, fault, status, ...)                                                \
  do {                                                                                             \
    if (!(condition))                                                                              \
      return cdem_fail((fault), (status), __VA_ARGS__);                                            \
  } while (0)

/* Return the status of a call that failed. */
#define CDEM_TRY(call)                                                                             \
  do {                                                                                             \
    cdem_status cdem_try_status = (call);                                                          \
    if (cdem_try_status != CDEM_OK)                                                                \
      return cdem_try_status;                                                                      \
  } while (0)

#endif
