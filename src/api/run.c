/* Runs of case files, and cases that are scaled. */
#include "run/run.h"

#include "api/store.h"
#include "base/version.h"
#include "run/scale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct libcdem_run {
  char *path; /* NULL: only to go on */
  int64_t overrides, capacity;
  char **override;
  int choice[3]; /* by libcdem_run_choice */
  cdem_run_summary summary;
  libcdem_result *result; /* [summary.keys.rows] */
};

static cdem_status create(const char *path, libcdem_run **run, cdem_fault *fault) {
  libcdem_run *made = NULL;
  CDEM_TRY(cdem_api_want(run, "a place for the run", fault));
  CDEM_NEW(made, 1, fault);
  made->choice[LIBCDEM_RUN_FRAMES] = made->choice[LIBCDEM_RUN_FIGURES] = 1;
  if (path != NULL && (made->path = cdem_copy_text(path, fault)) == NULL) {
    free(made);
    return CDEM_MEMORY;
  }
  *run = made;
  return CDEM_OK;
}

libcdem_status libcdem_run_create(const char *path, libcdem_run **run, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(create(path, run, &own), &own, fault);
}

static void forget(libcdem_run *run) {
  cdem_run_summary_release(&run->summary);
  free(run->result);
  run->result = NULL;
}

void libcdem_run_destroy(libcdem_run **run) {
  if (run == NULL || *run == NULL)
    return;
  forget(*run);
  for (int64_t i = 0; i < (*run)->overrides; i++)
    free((*run)->override[i]);
  free((*run)->override);
  free((*run)->path);
  free(*run);
  *run = NULL;
}

/* ---- what is run, and how ---- */

static cdem_status set(libcdem_run *run, const char *assignment, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(run, "a run", fault));
  CDEM_TRY(cdem_api_want(assignment, "KEY=VALUE", fault));
  CDEM_REQUIRE(strchr(assignment, '=') != NULL, fault, CDEM_USAGE, "'%.200s': KEY=VALUE is wanted",
               assignment);
  CDEM_TRY(
      cdem_grow(&run->override, &run->capacity, run->overrides + 1, sizeof *run->override, fault));
  char *copy = cdem_copy_text(assignment, fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  run->override[run->overrides++] = copy;
  return CDEM_OK;
}

libcdem_status libcdem_run_set(libcdem_run *run, const char *assignment, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(set(run, assignment, &own), &own, fault);
}

static cdem_status choose(libcdem_run *run, libcdem_run_choice choice, int value,
                          cdem_fault *fault) {
  static const int most[] = {
      [LIBCDEM_RUN_THREADS] = 1024, [LIBCDEM_RUN_FRAMES] = 1, [LIBCDEM_RUN_FIGURES] = 1};
  CDEM_TRY(cdem_api_want(run, "a run", fault));
  CDEM_REQUIRE(choice <= LIBCDEM_RUN_FIGURES, fault, CDEM_USAGE, "there is no choice %d",
               (int)choice);
  CDEM_REQUIRE(value >= 0 && value <= most[choice], fault, CDEM_USAGE,
               "choice %d: %d is not from 0 to %d", (int)choice, value, most[choice]);
  run->choice[choice] = value;
  return CDEM_OK;
}

libcdem_status libcdem_run_choose(libcdem_run *run, libcdem_run_choice choice, int value,
                                  libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(choose(run, choice, value, &own), &own, fault);
}

/* ---- the run ---- */

static double real(const cdem_table *table, int64_t row, int column) {
  const cdem_value *value = cdem_table_at(table, row, column);
  return value->absent ? NAN : value->real;
}

static cdem_status keep_results(libcdem_run *run, cdem_fault *fault) {
  const cdem_table *keys = &run->summary.keys;
  CDEM_NEW(run->result, keys->rows, fault);
  for (int64_t r = 0; r < keys->rows; r++)
    run->result[r] = (libcdem_result){.name = cdem_table_at(keys, r, 0)->text,
                                      .unit = cdem_table_at(keys, r, 2)->text,
                                      .value = real(keys, r, 1),
                                      .reference = real(keys, r, 3),
                                      .difference = real(keys, r, 4)};
  return CDEM_OK;
}

typedef enum { CHECK, START, RESUME } way;

static cdem_status go(libcdem_run *run, way how, const char *folder,
                      const libcdem_listener *listener, cdem_fault *fault) {
  cdem_api_ears ears;
  CDEM_TRY(cdem_api_want(run, "a run", fault));
  if (how != RESUME)
    CDEM_TRY(cdem_api_want(run->path, "the path of a case", fault));
  cdem_api_listen(listener, &ears);
  forget(run);
  const cdem_run_options options = {.path = how == RESUME ? NULL : run->path,
                                    .folder = folder,
                                    .resume = how == RESUME,
                                    .check = how == CHECK,
                                    .overrides = how == RESUME ? 0 : (int)run->overrides,
                                    .override = (const char *const *)run->override,
                                    .threads = run->choice[LIBCDEM_RUN_THREADS],
                                    .figures = run->choice[LIBCDEM_RUN_FIGURES],
                                    .frames = run->choice[LIBCDEM_RUN_FRAMES],
                                    .version = cdem_version(),
                                    .commit = cdem_version_commit(),
                                    .progress = ears.progress,
                                    .warnings = &ears.warnings};
  cdem_api_quiet_gsl();
  cdem_status status = cdem_run(&options, &run->summary, fault);
  if (status == CDEM_OK)
    status = keep_results(run, fault);
  if (status != CDEM_OK)
    forget(run);
  return status;
}

libcdem_status libcdem_run_check(libcdem_run *run, const libcdem_listener *listener,
                                 libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(go(run, CHECK, NULL, listener, &own), &own, fault);
}

libcdem_status libcdem_run_start(libcdem_run *run, const char *folder,
                                 const libcdem_listener *listener, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(go(run, START, folder, listener, &own), &own, fault);
}

libcdem_status libcdem_run_resume(libcdem_run *run, const char *folder,
                                  const libcdem_listener *listener, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(go(run, RESUME, folder, listener, &own), &own, fault);
}

/* ---- what came out ---- */

int64_t libcdem_run_results(const libcdem_run *run) {
  return run != NULL && run->result != NULL ? run->summary.keys.rows : 0;
}

int64_t libcdem_run_failed(const libcdem_run *run) {
  return run != NULL ? run->summary.failed : 0;
}

const libcdem_result *libcdem_run_result(const libcdem_run *run, int64_t index) {
  return index >= 0 && index < libcdem_run_results(run) ? &run->result[index] : NULL;
}

const libcdem_result *libcdem_run_find(const libcdem_run *run, const char *name) {
  for (int64_t r = 0; name != NULL && r < libcdem_run_results(run); r++)
    if (strcmp(run->result[r].name, name) == 0)
      return &run->result[r];
  return NULL;
}
