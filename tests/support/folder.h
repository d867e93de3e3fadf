/* A scratch folder for the tests of one program: scratch_make and scratch_remove are its group
 * setup and teardown. Nothing of src/, so that tests of the face may use it. */
#ifndef CDEM_TESTS_SUPPORT_FOLDER_H
#define CDEM_TESTS_SUPPORT_FOLDER_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char scratch[64];

static int scratch_make(void **state) {
  (void)state;
  snprintf(scratch, sizeof scratch, "/tmp/cdem-test-XXXXXX");
  return mkdtemp(scratch) == NULL;
}

static int scratch_remove(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", scratch);
  return system(command);
}

/* scratch/NAME; eight at a time. */
static inline const char *in_scratch(const char *name) {
  static char path[8][512];
  static int next;
  next = (next + 1) % 8;
  snprintf(path[next], sizeof path[next], "%s/%s", scratch, name);
  return path[next];
}

#endif
