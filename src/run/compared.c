/* Finished runs, read back to be compared. */
#include "run/compared.h"

#include "base/suggest.h"
#include "run/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_there(const char *folder, const char *name) {
  char path[4096];
  return access(cdem_run_path(path, folder, name), F_OK) == 0;
}

cdem_status cdem_compared_check(const char *folder, cdem_fault *fault) {
  struct stat facts;
  CDEM_REQUIRE(stat(folder, &facts) == 0, fault, CDEM_INPUT,
               "there is no folder '%s'; name the folder of a run", folder);
  CDEM_REQUIRE(S_ISDIR(facts.st_mode), fault, CDEM_INPUT,
               "'%s' is a file; name the folder of a run, which holds its summary.json", folder);
  if (is_there(folder, "summary.json"))
    return CDEM_OK;
  if (is_there(folder, "checkpoint.h5"))
    return cdem_fail(fault, CDEM_INPUT,
                     "the run in '%s' has not ended: there is no summary.json; finish it with "
                     "`cdem run --resume %s`",
                     folder, folder);
  return cdem_fail(fault, CDEM_INPUT,
                   "'%s' is no folder of a run: there is no summary.json; name one that `cdem run` "
                   "has written",
                   folder);
}

cdem_status cdem_compared_history(const char *folder, cdem_table *history, cdem_fault *fault) {
  char path[4096];
  cdem_status status =
      cdem_read_history(cdem_run_path(path, folder, "history.csv"), history, fault);
  if (status == CDEM_FILE || status == CDEM_INPUT)
    cdem_fault_prefix(fault, "the history of the run in '%s' is wanted; run its case again",
                      folder);
  return status;
}

cdem_status cdem_compared_column(const cdem_table *history, int runs, const char *name,
                                 cdem_fault *fault) {
  enum { MOST = 256 };
  const char *candidate[MOST];
  for (int r = 0; r < runs; r++)
    if (cdem_run_history_find(&history[r], name) >= 0)
      return CDEM_OK;
  int count = history->columns < MOST ? history->columns : MOST;
  for (int c = 0; c < count; c++)
    candidate[c] = history->column[c].name;
  const char *nearest = cdem_suggest(name, candidate, count);
  if (nearest != NULL)
    return cdem_fail(fault, CDEM_INPUT,
                     "no run has a column '%s' in its history.csv; did you mean '%s'?", name,
                     nearest);
  return cdem_fail(fault, CDEM_INPUT,
                   "no run has a column '%s' in its history.csv; the first line of that file has "
                   "the names",
                   name);
}

/* ---- names ---- */

/* The path without slashes at its end, or the last part of it. */
static char *shown(const char *folder, bool whole, cdem_fault *fault) {
  char *path = cdem_copy_text(folder, fault);
  size_t length = path != NULL ? strlen(path) : 0;
  while (length > 1 && path[length - 1] == '/')
    path[--length] = '\0';
  char *slash = path != NULL ? strrchr(path, '/') : NULL;
  if (!whole && slash != NULL && slash[1] != '\0')
    memmove(path, slash + 1, strlen(slash));
  return path;
}

static bool any_alike(int runs, char *const *name) {
  for (int r = 0; r < runs; r++)
    for (int q = 0; q < r; q++)
      if (strcmp(name[r], name[q]) == 0)
        return true;
  return false;
}

static cdem_status name_all(int runs, const char *const *folder, bool whole, char **name,
                            cdem_fault *fault) {
  for (int r = 0; r < runs; r++) {
    free(name[r]);
    name[r] = shown(folder[r], whole, fault);
    if (name[r] == NULL)
      return CDEM_MEMORY;
  }
  return CDEM_OK;
}

cdem_status cdem_compared_names(int runs, const char *const *folder, char **name,
                                cdem_fault *fault) {
  CDEM_TRY(name_all(runs, folder, false, name, fault));
  return any_alike(runs, name) ? name_all(runs, folder, true, name, fault) : CDEM_OK;
}
