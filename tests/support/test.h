/* What every unit test includes: cmocka, and comparisons in double precision (cmocka's own are
 * single). */
#ifndef CDEM_TESTS_SUPPORT_TEST_H
#define CDEM_TESTS_SUPPORT_TEST_H

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
#include <cmocka.h>
/* clang-format on */

#include "base/base.h"

/* |value - reference| <= relative |reference| + absolute; NaN fails. */
#define check_near(value, reference, relative, absolute)                                           \
  do {                                                                                             \
    double value_ = (value), reference_ = (reference);                                             \
    double bound_ = (relative)*fabs(reference_) + (absolute);                                      \
    if (!(fabs(value_ - reference_) <= bound_))                                                    \
      fail_msg("%s = %.17g, expected %.17g, off by %.3g, allowed %.3g", #value, value_,            \
               reference_, fabs(value_ - reference_), bound_);                                     \
  } while (0)

/* value <= bound; NaN fails. */
#define check_below(value, bound)                                                                  \
  do {                                                                                             \
    double value_ = (value), bound_ = (bound);                                                     \
    if (!(value_ <= bound_))                                                                       \
      fail_msg("%s = %.17g exceeds %.3g", #value, value_, bound_);                                 \
  } while (0)

/* The call succeeds; otherwise its message is shown. Declares nothing; `fault` must be in scope. */
#define check_ok(call)                                                                             \
  do {                                                                                             \
    cdem_status status_ = (call);                                                                  \
    if (status_ != CDEM_OK)                                                                        \
      fail_msg("%s failed: %s", #call, fault.message);                                             \
  } while (0)

/* The call fails with this status and its message holds this text; clears `fault`. */
#define check_fails(call, status, text)                                                            \
  do {                                                                                             \
    memset(&fault, 0, sizeof fault);                                                               \
    assert_int_equal((call), (status));                                                            \
    if (strstr(fault.message, (text)) == NULL)                                                     \
      fail_msg("message '%s' does not hold '%s'", fault.message, (text));                          \
    memset(&fault, 0, sizeof fault);                                                               \
  } while (0)

#endif
