/* What the tests of the face share: cmocka, and statuses as libcdem has them. Nothing of src/ but
 * libcdem.h. */
#ifndef CDEM_TESTS_API_SUPPORT_H
#define CDEM_TESTS_API_SUPPORT_H

/* cmocka.h needs the others before it. */
/* clang-format off */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
/* clang-format on */

#include "support/folder.h"

#include <libcdem.h>

/* The call succeeds; otherwise its message is shown. `fault` must be in scope. */
#define check_ok(call)                                                                             \
  do {                                                                                             \
    if ((call) != LIBCDEM_OK)                                                                      \
      fail_msg("%s failed: %s", #call, fault.message);                                             \
  } while (0)

/* The call fails with this status and its message holds this text; clears `fault`. */
#define check_fails(call, wanted, text)                                                            \
  do {                                                                                             \
    memset(&fault, 0, sizeof fault);                                                               \
    assert_int_equal((call), (wanted));                                                            \
    assert_int_equal(fault.status, (wanted));                                                      \
    if (strstr(fault.message, (text)) == NULL)                                                     \
      fail_msg("message '%s' does not hold '%s'", fault.message, (text));                          \
    memset(&fault, 0, sizeof fault);                                                               \
  } while (0)

#endif
