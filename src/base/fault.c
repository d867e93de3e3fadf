#include "base/fault.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static const struct {
  int exit_code;
  const char *text;
} statuses[] = {
#define X(name, exit_code, text) {exit_code, text},
#include "base/status.def"
#undef X
};

const char *cdem_status_text(cdem_status status) {
  assert(status < CDEM_STATUS_COUNT);
  return statuses[status].text;
}

int cdem_status_exit_code(cdem_status status) {
  assert(status < CDEM_STATUS_COUNT);
  return statuses[status].exit_code;
}

cdem_status cdem_fail(cdem_fault *fault, cdem_status status, const char *format, ...) {
  assert(status != CDEM_OK);
  if (fault == NULL || fault->status != CDEM_OK)
    return status;
  fault->status = status;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(fault->message, sizeof fault->message, format, arguments);
  va_end(arguments);
  return status;
}

void cdem_fault_prefix(cdem_fault *fault, const char *format, ...) {
  if (fault == NULL || fault->status == CDEM_OK)
    return;
  char whole[2 * CDEM_FAULT_LENGTH];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(whole, CDEM_FAULT_LENGTH, format, arguments);
  va_end(arguments);
  size_t used = strlen(whole);
  snprintf(whole + used, sizeof whole - used, ": %s", fault->message);
  whole[CDEM_FAULT_LENGTH - 1] = '\0';
  memcpy(fault->message, whole, CDEM_FAULT_LENGTH);
}
