/* Checks of the rooms together with a scratch folder. */
#ifndef CDEM_TESTS_SUPPORT_SCRATCH_H
#define CDEM_TESTS_SUPPORT_SCRATCH_H

#include "support/folder.h"
#include "support/test.h"

#endif
