/* Runs: whatever fails, the folder is left so that `--resume`, or a new run where there is no
 * checkpoint yet, brings it to the same end. */
#ifndef CDEM_TESTS_ROBUST_DOORS_RUNS_H
#define CDEM_TESTS_ROBUST_DOORS_RUNS_H

#include "robust/doors_work.h"
#include "run/compare.h"
#include "run/run.h"

/* Wants to stop at a call; 0: never. */
static bool report(void *context, const char *what, int64_t done, int64_t total) {
  int *calls_left = context;
  (void)done, (void)total;
  bool stepping = strncmp(what, "running", 7) == 0 || strncmp(what, "relaxing", 8) == 0;
  if (!stepping || *calls_left == 0)
    return true;
  return --*calls_left > 0;
}

static cdem_status run_it(const door *d, const char *folder, bool resume, int stop_at,
                          cdem_fault *fault) {
  const cdem_progress progress = {.context = &stop_at, .report = report};
  const cdem_run_options options = {.path = resume ? NULL : d->text,
                                    .folder = in_scratch(folder),
                                    .resume = resume,
                                    .overrides = resume || d->set[0] == NULL ? 0
                                                 : d->set[1] == NULL         ? 1
                                                                             : 2,
                                    .override = d->set,
                                    .threads = 1,
                                    .frames = true,
                                    .version = "test",
                                    .commit = "test",
                                    .progress = &progress};
  cdem_run_summary summary;
  cdem_status status = cdem_run(&options, &summary, fault);
  cdem_run_summary_release(&summary);
  return status;
}

/* ---- new runs ---- */

static void run_before(const door *d) {
  (void)d;
  remove_folder("run");
}

static cdem_status run_new(const door *d, cdem_fault *fault) {
  return run_it(d, "run", false, 0, fault);
}

/* The last state, too, but for the wall time. */
static uint64_t run_result(const door *d) {
  (void)d;
  cdem_fault fault = {0};
  cdem_state state;
  uint64_t sum = fold_folder(sum_start, in_scratch("run"));
  assert_true(exists("run/summary.json"));
  check_ok(cdem_read_state(in_scratch("run/checkpoint.h5"), &state, &fault));
  for (int64_t i = 0; i < state.arrays; i++) {
    const cdem_array *a = &state.array[i];
    sum = fold_text(sum, a->name);
    int64_t count = strcmp(a->name, "run/reals") == 0 ? 1 : a->count; /* behind it the wall time */
    sum = fold(sum, a->data, (size_t)count * cdem_array_size(a->type));
  }
  cdem_state_release(&state);
  return sum;
}

static void run_failed(const door *d) {
  (void)d;
  assert_false(exists("run/summary.json"));
}

static uint64_t run_again(const door *d) {
  cdem_fault fault = {0};
  bool resume = exists("run/checkpoint.h5");
  check_ok(run_it(d, "run", resume, 0, &fault));
  return run_result(d);
}

static const door_kind run = {run_before, run_new, run_result, run_failed, run_again, true};

/* ---- runs that are continued ---- */

static void copy_folder(const char *from, const char *to) {
  char command[MOST_PATH];
  snprintf(command, sizeof command, "cp -r '%s' '%s'", in_scratch(from), in_scratch(to));
  assert_int_equal(system(command), 0);
}

static void broken_before(const door *d) {
  cdem_fault fault = {0};
  char broken[64];
  snprintf(broken, sizeof broken, "broken: %s", d->name);
  if (!exists(broken))
    check_fails(run_it(d, broken, false, 2, &fault), CDEM_INTERRUPTED, "--resume");
  remove_folder("run");
  copy_folder(broken, "run");
}

static cdem_status run_on(const door *d, cdem_fault *fault) {
  return run_it(d, "run", true, 0, fault);
}

static const door_kind resumed = {broken_before, run_on, run_result, run_failed, run_again, true};

/* ---- runs side by side ---- */

static void two_runs(const door *d) {
  cdem_fault fault = {0};
  remove_folder("out");
  if (exists("one"))
    return;
  check_ok(run_it(d, "one", false, 0, &fault));
  check_ok(run_it(d, "two", false, 0, &fault));
}

static cdem_status compare(const door *d, cdem_fault *fault) {
  (void)d;
  const char *const folder[2] = {in_scratch("one"), in_scratch("two")};
  const char *const column[1] = {"kinetic"};
  const cdem_compare_options options = {2, folder, 1, column, NAN, NAN};
  cdem_comparison comparison = {0};
  char *text = NULL;
  cdem_status status = cdem_compare(&options, &comparison, fault);
  if (status == CDEM_OK)
    status = cdem_comparison_json(&comparison, &text, fault);
  findings = fold_text(sum_start, text);
  free(text);
  cdem_comparison_release(&comparison);
  return status;
}

static cdem_status compare_curves(const door *d, cdem_fault *fault) {
  (void)d;
  const char *const folder[2] = {in_scratch("one"), in_scratch("two")};
  const char *const column[1] = {"kinetic"}, *label[2] = {NULL, NULL};
  const cdem_compare_figure curves = {.runs = 2,
                                      .folder = folder,
                                      .label = label,
                                      .columns = 1,
                                      .column = column,
                                      .y_label = label,
                                      .x_scale = 1.0,
                                      .y_scale = 1.0,
                                      .from = NAN,
                                      .to = NAN};
  return cdem_compare_draw(&curves, in_scratch("out"), "x", fault);
}

static const door_kind comparison = {two_runs, compare, found_result, NULL, NULL, false};
static const door_kind compared_curves = {two_runs,        compare_curves, pictures_result,
                                          pictures_failed, NULL,           true};

#endif
