/* What the tests of room run share: a scratch folder, cases written as text, runs of them. */
#ifndef CDEM_TESTS_RUN_SUPPORT_H
#define CDEM_TESTS_RUN_SUPPORT_H

#include "io/run_files.h"
#include "run/run.h"
#include "support/scratch.h"

#include <sys/stat.h>
#include <unistd.h>

static inline bool is_there(const char *name) {
  struct stat facts;
  return stat(in_scratch(name), &facts) == 0 && facts.st_size > 0;
}

static inline void write_case(const char *name, const char *text) {
  FILE *file = fopen(in_scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

/* Runs scratch/NAME into scratch/FOLDER without pictures. */
static inline cdem_status run_case(const char *name, const char *folder, int overrides,
                                   const char *const *override, cdem_run_summary *summary,
                                   cdem_fault *fault) {
  const cdem_run_options options = {.path = in_scratch(name),
                                    .folder = in_scratch(folder),
                                    .overrides = overrides,
                                    .override = override,
                                    .frames = true,
                                    .threads = 1, /* idle threads only spin in runs this small */
                                    .version = "test",
                                    .commit = "test"};
  return cdem_run(&options, summary, fault);
}

/* A whole run of box.yaml into scratch/FOLDER, or the rest of a broken one, with frames. */
static inline cdem_status run_box(const char *folder, bool resume, int threads,
                                  const cdem_progress *progress, cdem_fault *fault) {
  const cdem_run_options options = {.path = resume ? NULL : in_scratch("box.yaml"),
                                    .folder = in_scratch(folder),
                                    .resume = resume,
                                    .frames = true,
                                    .threads = threads,
                                    .version = "test",
                                    .commit = "test",
                                    .progress = progress};
  cdem_run_summary summary;
  cdem_status status = cdem_run(&options, &summary, fault);
  cdem_run_summary_release(&summary);
  return status;
}

/* The case fails before anything runs, with this text and the line that is to blame. */
static inline void check_bad(const char *name, const char *override, const char *text) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  check_fails(run_case(name, "never", 1, &override, &summary, &fault), CDEM_INPUT, text);
  assert_false(is_there("never"));
}

static inline double key_value(const cdem_run_summary *summary, const char *name) {
  for (int64_t r = 0; r < summary->keys.rows; r++)
    if (strcmp(cdem_table_at(&summary->keys, r, 0)->text, name) == 0)
      return cdem_table_at(&summary->keys, r, 1)->real;
  fail_msg("there is no key result '%s'", name);
  return NAN;
}

/* Does the file hold the text? */
static inline bool holds(const char *name, const char *text) {
  char *read = NULL;
  cdem_fault fault = {0};
  check_ok(cdem_read_text(in_scratch(name), &read, &fault));
  bool found = strstr(read, text) != NULL;
  free(read);
  return found;
}

static inline bool same_files(const char *a, const char *b) {
  char command[1200];
  snprintf(command, sizeof command, "cmp -s '%s' '%s'", in_scratch(a), in_scratch(b));
  return system(command) == 0;
}

/* The named files of two folders are there and the same; the list ends with NULL. */
static inline void check_same_files(const char *a, const char *b, const char *const *file) {
  for (; *file != NULL; file++) {
    char one[256], other[256];
    snprintf(one, sizeof one, "%s/%s", a, *file);
    snprintf(other, sizeof other, "%s/%s", b, *file);
    if (!is_there(one))
      fail_msg("%s is missing", one);
    if (!same_files(one, other))
      fail_msg("%s is not %s", other, one);
  }
}

#endif
