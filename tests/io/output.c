/* Atomic output: whole files or none, whatever happens. */
#include "io/support.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>

static void put(cdem_output *output, const char *text) {
  assert_true(fputs(text, cdem_output_stream(output)) >= 0);
}

static void check_content(const char *path, const char *expected) {
  char *text = read_whole(path, NULL);
  assert_non_null(text);
  assert_string_equal(text, expected);
  free(text);
}

static void nothing_stands_under_the_name_before_commit(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  const char *path = in_scratch("new.csv");
  check_ok(cdem_output_open(path, &output, &fault));
  put(output, "a\n");
  check_ok(cdem_output_write(output, "b\n", 2, &fault));
  assert_int_equal(access(path, F_OK), -1);
  assert_int_equal(count_files(scratch), 1);
  check_ok(cdem_output_commit(&output, &fault));
  assert_null(output);
  check_content(path, "a\nb\n");
  assert_int_equal(count_files(scratch), 1);
  cdem_output_discard(&output);
  unlink(path);
}

static void a_discarded_file_leaves_the_old_one(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  const char *path = in_scratch("old.csv");
  write_whole(path, "old");
  check_ok(cdem_output_open(path, &output, &fault));
  put(output, "new");
  check_content(path, "old");
  cdem_output_discard(&output);
  assert_null(output);
  check_content(path, "old");
  assert_int_equal(count_files(scratch), 1);
  unlink(path);
}

static mode_t mode_of(const char *path) {
  struct stat info;
  assert_int_equal(stat(path, &info), 0);
  return info.st_mode & 07777;
}

static void permissions_are_those_of_fopen(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  mode_t before = umask(027);
  check_ok(cdem_output_open(in_scratch("mode"), &output, &fault));
  check_ok(cdem_output_commit(&output, &fault));
  umask(before);
  assert_int_equal(mode_of(in_scratch("mode")), 0640);
  chmod(in_scratch("mode"), 0604);
  check_ok(cdem_output_open(in_scratch("mode"), &output, &fault));
  check_ok(cdem_output_commit(&output, &fault));
  assert_int_equal(mode_of(in_scratch("mode")), 0604);
  unlink(in_scratch("mode"));
}

static void links_are_followed(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  struct stat info;
  mkdir(in_scratch("folder"), 0777);
  assert_int_equal(symlink("folder/target", in_scratch("link")), 0);
  for (int i = 0; i < 2; i++) { /* the target is missing at first, then there */
    check_ok(cdem_output_open(in_scratch("link"), &output, &fault));
    put(output, i == 0 ? "first" : "second");
    check_ok(cdem_output_commit(&output, &fault));
    assert_int_equal(lstat(in_scratch("link"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    check_content(in_scratch("folder/target"), i == 0 ? "first" : "second");
  }
  assert_int_equal(symlink("loop", in_scratch("loop")), 0);
  check_fails(cdem_output_open(in_scratch("loop"), &output, &fault), CDEM_FILE, "cannot write");
  unlink(in_scratch("loop"));
  unlink(in_scratch("link"));
  unlink(in_scratch("folder/target"));
  rmdir(in_scratch("folder"));
}

static void a_full_device_is_told_at_the_latest_on_commit(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  check_ok(cdem_output_open("/dev/full", &output, &fault));
  put(output, "waits in the buffer");
  check_fails(cdem_output_commit(&output, &fault), CDEM_FILE,
              "cannot write '/dev/full': No space left on device; free some space or choose "
              "another folder with -o");
  assert_null(output);
  check_ok(cdem_output_open("/dev/full", &output, &fault));
  char *large = calloc(1, 3 << 20);
  check_fails(cdem_output_write(output, large, 3 << 20, &fault), CDEM_FILE, "No space left");
  check_fails(cdem_output_commit(&output, &fault), CDEM_FILE, "No space left");
  free(large);
}

static int write_a_megabyte(const void *path) {
  cdem_fault fault = {0};
  cdem_output *output;
  char block[1024] = {0};
  if (cdem_output_open(path, &output, &fault) != CDEM_OK)
    return 1;
  for (int i = 0; i < 1024; i++)
    fwrite(block, 1, sizeof block, cdem_output_stream(output));
  if (cdem_output_commit(&output, &fault) != CDEM_FILE)
    return 2;
  return strstr(fault.message, "File too large") == NULL ? 3 : 0;
}

static void a_file_that_cannot_grow_leaves_nothing(void **state) {
  (void)state;
  assert_int_equal(with_file_limit(100000, write_a_megabyte, in_scratch("large")), 0);
  assert_int_equal(count_files(scratch), 0);
}

static void places_that_cannot_be_written(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output = (cdem_output *)1;
  check_fails(cdem_output_open(in_scratch("no/such/file"), &output, &fault), CDEM_FILE,
              "No such file or directory; create the folder first");
  assert_null(output);
  check_fails(cdem_output_open(scratch, &output, &fault), CDEM_FILE, "Is a directory");
  mkdir(in_scratch("closed"), 0555);
  write_whole(in_scratch("locked"), "x");
  chmod(in_scratch("locked"), 0444);
  chmod(scratch, 0777);
  bool root = geteuid() == 0; /* for whom every folder is open */
  assert_true(!root || seteuid(65534) == 0);
  check_fails(cdem_output_open(in_scratch("closed/file"), &output, &fault), CDEM_FILE,
              "Permission denied; choose another folder with -o");
  check_fails(cdem_output_open(in_scratch("locked"), &output, &fault), CDEM_FILE,
              "Permission denied");
  assert_true(!root || seteuid(0) == 0);
  rmdir(in_scratch("closed"));
  unlink(in_scratch("locked"));
  assert_int_equal(count_files(scratch), 0);
}

static void *read_pipe(void *path) {
  return read_whole(path, NULL);
}

static void a_pipe_is_written_straight(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *output;
  char path[256];
  pthread_t reader;
  snprintf(path, sizeof path, "%s", in_scratch("pipe"));
  assert_int_equal(mkfifo(path, 0600), 0);
  assert_int_equal(pthread_create(&reader, NULL, read_pipe, path), 0);
  check_ok(cdem_output_open(path, &output, &fault));
  put(output, "through the pipe");
  check_ok(cdem_output_commit(&output, &fault));
  void *text;
  pthread_join(reader, &text);
  assert_string_equal(text, "through the pipe");
  free(text);
  unlink(path);
}

/* What was printed before comes first, and the file the shell opened is not replaced. */
static void standard_output_is_shared(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const char *const names[] = {"-", "/dev/stdout"};
  for (int i = 0; i < 2; i++) {
    fflush(stdout);
    int kept = dup(STDOUT_FILENO);
    int file = open(in_scratch("stdout"), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    cdem_output *output;
    printf("before ");
    cdem_status status = cdem_output_open(names[i], &output, &fault);
    if (status == CDEM_OK) {
      fputs("between ", cdem_output_stream(output));
      status = cdem_output_commit(&output, &fault);
    }
    printf("behind");
    fflush(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    close(file);
    check_ok(status);
    check_content(in_scratch("stdout"), "before between behind");
  }
  unlink(in_scratch("stdout"));
}

static void two_outputs_of_one_name_do_not_meet(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_output *first, *second;
  check_ok(cdem_output_open(in_scratch("twice"), &first, &fault));
  check_ok(cdem_output_open(in_scratch("twice"), &second, &fault));
  put(first, "first");
  put(second, "second");
  check_ok(cdem_output_commit(&first, &fault));
  check_content(in_scratch("twice"), "first");
  check_ok(cdem_output_commit(&second, &fault));
  check_content(in_scratch("twice"), "second");
  unlink(in_scratch("twice"));
  char name[256];
  memset(name, 'n', 250);
  name[250] = '\0';
  check_ok(cdem_output_open(in_scratch(name), &first, &fault));
  check_ok(cdem_output_commit(&first, &fault));
  assert_int_equal(unlink(in_scratch(name)), 0);
}

static void lack_of_memory_leaves_nothing(void **state) {
  (void)state;
  int failures = 0;
  for (;; failures++) {
    cdem_fault fault = {0};
    cdem_output *output;
    cdem_memory_fail_after(failures);
    cdem_status status = cdem_output_open(in_scratch("memory"), &output, &fault);
    cdem_memory_fail_after(-1);
    if (status == CDEM_OK) {
      cdem_output_discard(&output);
      break;
    }
    assert_int_equal(status, CDEM_MEMORY);
    assert_null(output);
    assert_int_equal(count_files(scratch), 0);
  }
  assert_true(failures >= 4);
  assert_int_equal(count_files(scratch), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing_stands_under_the_name_before_commit),
      cmocka_unit_test(a_discarded_file_leaves_the_old_one),
      cmocka_unit_test(permissions_are_those_of_fopen),
      cmocka_unit_test(links_are_followed),
      cmocka_unit_test(a_full_device_is_told_at_the_latest_on_commit),
      cmocka_unit_test(a_file_that_cannot_grow_leaves_nothing),
      cmocka_unit_test(places_that_cannot_be_written),
      cmocka_unit_test(a_pipe_is_written_straight),
      cmocka_unit_test(standard_output_is_shared),
      cmocka_unit_test(two_outputs_of_one_name_do_not_meet),
      cmocka_unit_test(lack_of_memory_leaves_nothing),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
