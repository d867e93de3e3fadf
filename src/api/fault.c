/* Failures, listeners and versions, as the outside knows them. */
#include "api/store.h"
#include "base/version.h"

#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <string.h>

static libcdem_status outside(cdem_status status) {
  return (libcdem_status)cdem_status_exit_code(status);
}

libcdem_status cdem_api_end(cdem_status status, const cdem_fault *from, libcdem_fault *to) {
  _Static_assert(sizeof to->message == sizeof from->message, "a message fits");
  if (status != CDEM_OK && to != NULL) {
    const char *text = from->message[0] != '\0' ? from->message : cdem_status_text(status);
    to->status = outside(status);
    snprintf(to->message, sizeof to->message, "%s", text);
  }
  return outside(status);
}

cdem_status cdem_api_want(const void *pointer, const char *what, cdem_fault *fault) {
  CDEM_REQUIRE(pointer != NULL, fault, CDEM_USAGE, "%s is wanted, not NULL", what);
  return CDEM_OK;
}

void cdem_api_listen(const libcdem_listener *listener, cdem_api_ears *ears) {
  *ears = (cdem_api_ears){0};
  if (listener == NULL)
    return;
  ears->own = (cdem_progress){listener->context, listener->progress};
  if (listener->progress != NULL)
    ears->progress = &ears->own;
  ears->warnings = (cdem_warnings){listener->context, listener->warn};
}

void cdem_api_quiet_gsl(void) {
  gsl_set_error_handler_off();
}

const char *libcdem_status_text(libcdem_status status) {
  for (int s = 0; s < CDEM_STATUS_COUNT; s++)
    if (outside((cdem_status)s) == status)
      return cdem_status_text((cdem_status)s);
  return "unknown status";
}

const char *libcdem_version(void) {
  return cdem_version();
}

const char *libcdem_commit(void) {
  return cdem_version_commit();
}

const char *libcdem_build(void) {
  return cdem_version_build();
}
