#include "commit.h"

#include "base/version.h"

const char *cdem_version_commit(void) {
  return CDEM_COMMIT;
}
