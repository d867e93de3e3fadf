/* One run: folder, lock, setup, loop, and what is said at the end. */
#include "run/run.h"

#include "io/io.h"
#include "io/run_files.h"
#include "run/summary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void warn(const cdem_run_options *options, const char *message) {
  if (options->warnings != NULL && options->warnings->warn != NULL)
    options->warnings->warn(options->warnings->context, message);
}

static cdem_status write_case(const cdem_run_setup *setup, cdem_fault *fault) {
  const char *text = setup->cases.source;
  char path[4096];
  return cdem_write_text(cdem_run_path(path, setup->options->folder, "case.yaml"), text,
                         (int64_t)strlen(text), fault);
}

static bool is_there(const char *folder, const char *name) {
  char path[4096];
  return access(cdem_run_path(path, folder, name), F_OK) == 0;
}

/* Every folder of a run holds a lock file. Without one, files of these names are somebody else's:
 * the very case that is to be run, for instance. */
static cdem_status check_owner(const cdem_run_options *options, cdem_fault *fault) {
  static const char *const own[] = {"case.yaml", "summary.json", "checkpoint.h5", "history.csv"};
  if (is_there(options->folder, ".lock"))
    return CDEM_OK;
  for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
    CDEM_REQUIRE(!is_there(options->folder, own[i]), fault, CDEM_INPUT,
                 "the folder '%s' holds a file '%s' that no run wrote and this one would replace; "
                 "choose another folder with -o",
                 options->folder, own[i]);
  return CDEM_OK;
}

/* Pictures and frames that the new run may not make again. */
static cdem_status clear_pictures(const cdem_run_options *options, cdem_fault *fault) {
  char path[4096];
  cdem_frame_writer *frames = NULL;
  CDEM_TRY(cdem_clear_figures(cdem_run_path(path, options->folder, "figures"), fault));
  CDEM_TRY(cdem_frame_writer_create(options->folder, 0, &frames, fault));
  cdem_frame_writer_destroy(&frames);
  return CDEM_OK;
}

/* Takes the folder for a new run. What an earlier run left is replaced; its summary and checkpoint
 * go first, so that they never stand beside files of another run. */
static cdem_status clear_folder(const cdem_run_options *options, cdem_fault *fault) {
  static const char *const old[] = {"summary.json", "checkpoint.h5", "history.csv"};
  char path[4096], message[4300];
  bool found = false;
  for (size_t i = 0; i < sizeof old / sizeof old[0]; i++) {
    cdem_run_path(path, options->folder, old[i]);
    if (access(path, F_OK) != 0)
      continue;
    found = true;
    CDEM_REQUIRE(unlink(path) == 0, fault, CDEM_FILE,
                 "cannot replace '%s' of an earlier run; choose another folder with -o", path);
  }
  if (found) {
    snprintf(message, sizeof message, "the folder '%s' holds an earlier run, which is replaced",
             options->folder);
    warn(options, message);
    CDEM_TRY(clear_pictures(options, fault));
  }
  return CDEM_OK;
}

static cdem_status has_checkpoint(const cdem_run_options *options, cdem_fault *fault) {
  CDEM_REQUIRE(is_there(options->folder, "checkpoint.h5"), fault, CDEM_INPUT,
               "there is no run to continue in '%s': it has no checkpoint.h5; start one that was "
               "broken before its first checkpoint anew, `cdem run CASE -o %s`",
               options->folder, options->folder);
  return CDEM_OK;
}

/* Asked before the lock is taken, so that a folder of somebody else's stays as it is. */
static cdem_status check_folder(const cdem_run_options *options, cdem_fault *fault) {
  CDEM_REQUIRE(access(options->folder, F_OK) == 0, fault, CDEM_INPUT,
               "there is no folder '%s'; name the folder of the run that is to be continued",
               options->folder);
  return is_there(options->folder, ".lock") ? CDEM_OK : has_checkpoint(options, fault);
}

/* The state of a broken run; CDEM_INPUT when there is nothing to continue. */
static cdem_status read_checkpoint(const cdem_run_options *options, cdem_state *state,
                                   cdem_fault *fault) {
  char path[4096];
  CDEM_TRY(has_checkpoint(options, fault));
  CDEM_REQUIRE(!is_there(options->folder, "summary.json"), fault, CDEM_INPUT,
               "the run in '%s' has ended: summary.json is there; nothing to continue",
               options->folder);
  return cdem_read_state(cdem_run_path(path, options->folder, "checkpoint.h5"), state, fault);
}

/* ---- the end ---- */

/* Shipped cases leave 5e-4 of the energy that was exchanged unexplained, at most. */
enum { FEWEST_STEPS = 100 };
#define OPEN_BOOK 0.01

static void warn_of_open_book(const cdem_run_output *output, const cdem_run_summary *summary) {
  char message[256];
  if (summary->steps < FEWEST_STEPS || !(summary->energy_error > OPEN_BOOK))
    return;
  snprintf(message, sizeof message,
           "the energy book is open: %.2g %% of the energy that was exchanged came from nowhere or "
           "was lost; halve 'step' or 'safety' until it closes, or drive what moves more slowly",
           100.0 * summary->energy_error);
  warn(output->options, message);
}

static cdem_status finish(cdem_run_output *output, cdem_run_summary *summary, cdem_fault *fault) {
  cdem_table history = {0};
  char path[4096];
  CDEM_TRY(cdem_read_history(cdem_run_path(path, output->options->folder, "history.csv"), &history,
                             fault));
  cdem_status status = CDEM_OK;
  if (output->options->figures)
    status = cdem_run_figures(output, &history, fault);
  if (status == CDEM_OK)
    status = cdem_run_summary_fill(output, &history, summary, fault);
  if (status == CDEM_OK)
    warn_of_open_book(output, summary);
  if (status == CDEM_OK)
    status = cdem_run_summary_write(output, &history, summary, fault);
  cdem_table_release(&history);
  return status;
}

static cdem_status step_and_finish(cdem_run_setup *setup, const cdem_state *checkpoint,
                                   cdem_run_summary *summary, cdem_fault *fault) {
  cdem_run_output output = {0};
  CDEM_TRY(cdem_run_output_open(setup, checkpoint, &output, fault));
  cdem_status status = cdem_run_loop(&output, fault);
  if (status == CDEM_OK)
    status = finish(&output, summary, fault);
  cdem_run_output_close(&output);
  return status;
}

/* ---- three ways in ---- */

static cdem_status check_only(const cdem_run_options *options, cdem_run_summary *summary,
                              cdem_fault *fault) {
  cdem_run_setup setup = {0};
  cdem_table history = {0};
  CDEM_TRY(cdem_run_setup_init(options, NULL, &setup, fault));
  cdem_status status = cdem_run_history_init(&setup, &history, fault);
  if (status == CDEM_OK)
    status = cdem_run_summary_sizes(&setup, summary, fault);
  cdem_table_release(&history);
  cdem_run_setup_release(&setup);
  return status;
}

/* Everything in the case is looked at before the folder is touched. */
static cdem_status run_new(const cdem_run_options *options, cdem_run_summary *summary,
                           cdem_fault *fault) {
  cdem_run_setup setup = {0};
  cdem_table history = {0};
  cdem_folder_lock *lock = NULL;
  CDEM_TRY(cdem_run_setup_init(options, NULL, &setup, fault));
  cdem_status status = cdem_run_history_init(&setup, &history, fault);
  cdem_table_release(&history);
  if (status == CDEM_OK)
    status = check_owner(options, fault);
  if (status == CDEM_OK)
    status = cdem_make_folder(options->folder, fault);
  if (status == CDEM_OK)
    status = cdem_folder_lock_take(options->folder, &lock, fault);
  if (status == CDEM_OK)
    status = cdem_clear_parts(options->folder, fault);
  if (status == CDEM_OK)
    status = clear_folder(options, fault);
  if (status == CDEM_OK)
    status = write_case(&setup, fault);
  if (status == CDEM_OK)
    status = step_and_finish(&setup, NULL, summary, fault);
  cdem_folder_lock_drop(&lock);
  cdem_run_setup_release(&setup);
  return status;
}

static cdem_status run_on(const cdem_run_options *options, cdem_run_summary *summary,
                          cdem_fault *fault) {
  cdem_run_setup setup = {0};
  cdem_state checkpoint = {0};
  cdem_folder_lock *lock = NULL;
  CDEM_TRY(check_folder(options, fault));
  CDEM_TRY(cdem_folder_lock_take(options->folder, &lock, fault));
  cdem_status status = read_checkpoint(options, &checkpoint, fault);
  if (status == CDEM_OK)
    status = cdem_run_setup_init(options, &checkpoint, &setup, fault);
  if (status == CDEM_OK)
    status = cdem_clear_parts(options->folder, fault);
  if (status == CDEM_OK)
    status = setup.engine->restore(&setup, &checkpoint, fault);
  if (status == CDEM_OK)
    status = step_and_finish(&setup, &checkpoint, summary, fault);
  cdem_run_setup_release(&setup);
  cdem_state_release(&checkpoint);
  cdem_folder_lock_drop(&lock);
  return status;
}

/* ---- warnings: passed on, and kept for the summary ---- */

typedef struct {
  const cdem_run_options *options;
  cdem_run_summary *summary;
} listener;

/* One that there is no memory for has been passed on at least. */
static void hear(void *context, const char *message) {
  const listener *l = context;
  cdem_run_summary *to = l->summary;
  warn(l->options, message);
  if (cdem_grow(&to->warning, &to->warning_capacity, to->warnings + 1, sizeof *to->warning, NULL) ==
          CDEM_OK &&
      (to->warning[to->warnings] = cdem_copy_text(message, NULL)) != NULL)
    to->warnings++;
}

cdem_status cdem_run(const cdem_run_options *given, cdem_run_summary *summary, cdem_fault *fault) {
  const cdem_warnings warnings = {.context = &(listener){given, summary}, .warn = hear};
  cdem_run_options heard = *given, *options = &heard;
  *summary = (cdem_run_summary){0};
  options->warnings = &warnings;
  CDEM_REQUIRE(options->resume || options->path != NULL, fault, CDEM_USAGE, "a case is wanted");
  CDEM_REQUIRE(options->check || (options->folder != NULL && options->folder[0] != '\0'), fault,
               CDEM_USAGE, "a folder for the results is wanted");
  CDEM_REQUIRE(!options->resume || (options->overrides == 0 && !options->check), fault, CDEM_USAGE,
               "a run that is continued keeps its case: no --set and no --check");
  cdem_status status = options->check    ? check_only(options, summary, fault)
                       : options->resume ? run_on(options, summary, fault)
                                         : run_new(options, summary, fault);
  if (status != CDEM_OK)
    cdem_run_summary_release(summary);
  return status;
}
