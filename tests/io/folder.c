/* Folders, locks between processes, and whole texts. */
#include "io/run_files.h"
#include "io/support.h"

static bool is_folder(const char *path) {
  struct stat facts;
  return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
}

static void folders_are_made_with_their_parents(void **state) {
  (void)state;
  cdem_fault fault = {0};
  check_ok(cdem_make_folder(in_scratch("a/b//c/"), &fault));
  assert_true(is_folder(in_scratch("a/b/c")));
  check_ok(cdem_make_folder(in_scratch("a/b/c"), &fault));
  check_ok(cdem_make_folder("/", &fault));
  check_ok(cdem_make_folder(".", &fault));
  write_whole(in_scratch("a/file"), "x");
  check_fails(cdem_make_folder(in_scratch("a/file"), &fault), CDEM_FILE, "Not a directory");
  check_fails(cdem_make_folder(in_scratch("a/file/deeper"), &fault), CDEM_FILE,
              "a/file': Not a directory; choose another one");
}

/* What another process hears when it asks for the folder: 0 got it, 1 in use by our parent, 2
 * other.
 */
static int ask_in_child(const char *folder) {
  fflush(NULL);
  pid_t parent = getpid(), child = fork();
  if (child == 0) {
    cdem_fault fault = {0};
    cdem_folder_lock *lock;
    char expected[256];
    snprintf(expected, sizeof expected, "the folder '%s' is in use by another run (process %ld)",
             folder, (long)parent);
    cdem_status status = cdem_folder_lock_take(folder, &lock, &fault);
    if (status == CDEM_OK)
      _exit(0);
    bool told = status == CDEM_INPUT && lock == NULL && strstr(fault.message, expected) != NULL;
    _exit(told ? 1 : 2);
  }
  int result = 0;
  waitpid(child, &result, 0);
  return WEXITSTATUS(result);
}

static void one_run_a_folder(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_folder_lock *lock, *second;
  const char *folder = in_scratch("locked");
  check_ok(cdem_make_folder(folder, &fault));
  assert_int_equal(ask_in_child(folder), 0); /* gone with that process */
  check_ok(cdem_folder_lock_take(folder, &lock, &fault));
  char mine[32], *text = read_whole(in_scratch("locked/.lock"), NULL);
  snprintf(mine, sizeof mine, "%ld\n", (long)getpid());
  assert_string_equal(text, mine);
  free(text);
  assert_int_equal(ask_in_child(folder), 1);
  check_fails(cdem_folder_lock_take(folder, &second, &fault), CDEM_INPUT, "is in use by another");
  cdem_folder_lock_drop(&lock);
  assert_null(lock);
  cdem_folder_lock_drop(&lock);
  assert_int_equal(ask_in_child(folder), 0);
  /* A number left by a killed run does not matter. */
  write_whole(in_scratch("locked/.lock"), "4294967295\n");
  check_ok(cdem_folder_lock_take(folder, &lock, &fault));
  assert_int_equal(ask_in_child(folder), 1);
  cdem_folder_lock_drop(&lock);
}

static void no_lock_in_no_folder(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_folder_lock *lock;
  check_fails(cdem_folder_lock_take(in_scratch("nowhere"), &lock, &fault), CDEM_FILE,
              "nowhere/.lock': No such file or directory; create the folder first");
  assert_null(lock);
}

static void texts_are_read_whole(void **state) {
  (void)state;
  cdem_fault fault = {0};
  char *text;
  write_whole(in_scratch("text"), "");
  check_ok(cdem_read_text(in_scratch("text"), &text, &fault));
  assert_string_equal(text, "");
  free(text);
  FILE *file = fopen(in_scratch("long"), "wb");
  for (int i = 0; i < 100000; i++)
    fprintf(file, "%d\n", i);
  fclose(file);
  check_ok(cdem_read_text(in_scratch("long"), &text, &fault));
  char *expected = read_whole(in_scratch("long"), NULL);
  assert_string_equal(text, expected);
  free(text);
  free(expected);
  check_fails(cdem_read_text(in_scratch("none"), &text, &fault), CDEM_FILE,
              "none': No such file or directory");
  assert_null(text);
  check_fails(cdem_read_text(scratch, &text, &fault), CDEM_FILE, "Is a directory");
  file = fopen(in_scratch("binary"), "wb");
  fwrite("ab\0c", 1, 4, file);
  fclose(file);
  check_fails(cdem_read_text(in_scratch("binary"), &text, &fault), CDEM_INPUT, "byte 3 is zero");
}

/* Of a process that is gone (numbers end at 2^22), at most one folder down; of one that lives, and
 * what only looks like it, stays. */
static void what_the_killed_left_is_removed(void **state) {
  (void)state;
  static const struct {
    const char *name;
    bool stays;
  } file[] = {
      {"left/.history.csv.part-9999999", false}, {"left/body/.body-000001.vtu.part-9999999", false},
      {"left/.history.csv.part-1", true},        {"left/.history.csv.part-", true},
      {"left/.history.csv.part-9999999x", true}, {"left/history.csv.part-9999999", true},
      {"left/body/deeper/.a.part-9999999", true}};
  cdem_fault fault = {0};
  check_ok(cdem_make_folder(in_scratch("left/body/deeper"), &fault));
  for (size_t i = 0; i < sizeof file / sizeof file[0]; i++) {
    FILE *made = fopen(in_scratch(file[i].name), "w");
    assert_non_null(made);
    fclose(made);
  }
  check_ok(cdem_clear_parts(in_scratch("left"), &fault));
  for (size_t i = 0; i < sizeof file / sizeof file[0]; i++)
    if ((access(in_scratch(file[i].name), F_OK) == 0) != file[i].stays)
      fail_msg("%s %s", file[i].name, file[i].stays ? "is gone" : "is there");
  check_ok(cdem_clear_parts(in_scratch("nowhere"), &fault));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(folders_are_made_with_their_parents),
      cmocka_unit_test(one_run_a_folder),
      cmocka_unit_test(no_lock_in_no_folder),
      cmocka_unit_test(texts_are_read_whole),
      cmocka_unit_test(what_the_killed_left_is_removed),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
