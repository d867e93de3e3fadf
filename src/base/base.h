/* Room base: what every other room stands on. It knows nothing of mechanics. */
#ifndef CDEM_BASE_BASE_H
#define CDEM_BASE_BASE_H

#include "base/fault.h"
#include "base/mat3.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/quantity.h"
#include "base/random.h"

#endif
