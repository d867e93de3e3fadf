/* What every spring writer must do, looped over the table of formats; a new format is tested the
 * moment its line is there. What stands in each file is tested format by format beside this. */
#include "io/support.h"

#include <sys/mount.h>

enum { FEEDS = 300 }; /* 8400 pairs: more than a megabyte in each format that grows */

static hand_network hand;

static int setup(void **state) {
  hand_network_init(&hand, "hex8");
  hand_make_symmetric(&hand);
  return scratch_make(state);
}

static int teardown(void **state) {
  hand_network_release(&hand);
  return scratch_remove(state);
}

/* Name of a file of this format. */
static const char *path_of(const cdem_springs_format *format) {
  char name[64];
  snprintf(name, sizeof name, "springs.%s", format->name);
  return in_scratch(name);
}

static void formats_are_found_by_name_and_ending(void **state) {
  (void)state;
  int count = 0;
  for (const cdem_springs_format *f; (f = cdem_springs_format_at(count)) != NULL; count++) {
    assert_ptr_equal(cdem_springs_format_find(f->name), f);
    assert_ptr_equal(cdem_springs_format_of(path_of(f)), f);
    assert_true(f->help[0] != '\0');
  }
  assert_int_equal(count, 8);
  assert_null(cdem_springs_format_at(-1));
  assert_null(cdem_springs_format_find("xlsx"));
  assert_null(cdem_springs_format_of("springs.xlsx"));
  assert_null(cdem_springs_format_of(".csv"));
  assert_null(cdem_springs_format_of("csv"));
  assert_string_equal(cdem_springs_format_of("A.B.HDF5")->name, "h5");
}

static void chunks_do_not_change_the_file(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    if (strcmp(format->name, "h5") == 0)
      continue; /* HDF5 keeps times; compared by content in hdf5.c */
    size_t bytes[2] = {0, 0};
    char *text[2];
    for (int i = 0; i < 2; i++) {
      check_ok(hand_write(&hand, format, path_of(format), i == 0 ? 28 : 5, 2, &fault));
      text[i] = read_whole(path_of(format), &bytes[i]);
      unlink(path_of(format));
    }
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(text[0], text[1], bytes[0]);
    free(text[0]);
    free(text[1]);
  }
}

static void files_left_behind_are_none(void **state) {
  (void)state;
  cdem_fault fault = {0};
  int before = count_files(scratch);
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    cdem_springs_writer *writer;
    check_ok(format->open(path_of(format), &hand.model, &writer, &fault));
    check_ok(hand_feed(&hand, writer, 7, 3, &fault));
    assert_int_equal(access(path_of(format), F_OK), -1);
    cdem_springs_writer_destroy(&writer);
    assert_int_equal(count_files(scratch), before);
    cdem_springs_writer_destroy(&writer);
  }
}

static void full_devices_are_told(void **state) {
  (void)state;
  cdem_fault fault = {0};
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    bool seeks = strcmp(format->name, "h5") == 0;
    check_fails(hand_write(&hand, format, "/dev/full", 28, FEEDS, &fault), CDEM_FILE,
                seeks ? "HDF5 needs a regular file" : "No space left on device");
    check_fails(hand_write(&hand, format, in_scratch("no/springs"), 28, 1, &fault), CDEM_FILE,
                "No such file or directory");
  }
}

typedef struct {
  const cdem_springs_format *format;
  const char *path;
} limited;

/* 0: the writer said that the file became too large and left nothing behind. */
static int write_beyond_the_limit(const void *argument) {
  const limited *what = argument;
  cdem_fault fault = {0};
  cdem_status status = hand_write(&hand, what->format, what->path, 28, FEEDS, &fault);
  if (status != CDEM_FILE || access(what->path, F_OK) == 0)
    return 1;
  return strstr(fault.message, "File too large; free some space") != NULL ? 0 : 2;
}

/* Matrices do not grow with the pairs fed: their files stay below any sensible limit. */
static bool grows(const cdem_springs_format *format) {
  return !format->assembled;
}

static void files_that_cannot_grow(void **state) {
  (void)state;
  const rlim_t limits[] = {100, 3000, 20000, 1 << 20};
  int before = count_files(scratch);
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++)
    for (int l = 0; l < 4; l++) {
      const limited what = {cdem_springs_format_at(f), path_of(cdem_springs_format_at(f))};
      if (l > 0 && !grows(what.format))
        continue;
      int result = with_file_limit(limits[l], write_beyond_the_limit, &what);
      if (result != 0)
        fail_msg("%s with a limit of %d bytes: %d", what.format->name, (int)limits[l], result);
      assert_int_equal(count_files(scratch), before);
    }
}

static void a_full_file_system(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const char *folder = in_scratch("small");
  mkdir(folder, 0777);
  if (mount("tmpfs", folder, "tmpfs", 0, "size=256k") != 0) {
    print_message("no right to mount a small file system: skipped\n");
    rmdir(folder);
    skip();
  }
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    if (!grows(format))
      continue;
    cdem_status status = hand_write(&hand, format, in_scratch("small/springs"), 28, FEEDS, &fault);
    if (status != CDEM_FILE || strstr(fault.message, "No space left on device") == NULL)
      print_error("%s: %s\n", format->name, fault.message);
    int left = count_files(in_scratch("small"));
    memset(&fault, 0, sizeof fault);
    if (status != CDEM_FILE || left != 0) {
      umount(in_scratch("small"));
      fail_msg("%s: status %d, %d files left", format->name, status, left);
    }
  }
  assert_int_equal(umount(in_scratch("small")), 0);
  rmdir(in_scratch("small"));
}

static void lack_of_memory_leaves_nothing(void **state) {
  (void)state;
  int before = count_files(scratch);
  for (int f = 0; cdem_springs_format_at(f) != NULL; f++) {
    const cdem_springs_format *format = cdem_springs_format_at(f);
    int failures = 0;
    for (;; failures++) {
      cdem_fault fault = {0};
      cdem_memory_fail_after(failures);
      cdem_status status = hand_write(&hand, format, path_of(format), 28, 1, &fault);
      cdem_memory_fail_after(-1);
      if (status == CDEM_OK)
        break;
      if (strcmp(format->name, "h5") != 0) /* HDF5 hides why its driver could not open */
        assert_int_equal(status, CDEM_MEMORY);
      assert_int_equal(count_files(scratch), before);
    }
    assert_true(failures > 3);
    unlink(path_of(format));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formats_are_found_by_name_and_ending),
      cmocka_unit_test(chunks_do_not_change_the_file),
      cmocka_unit_test(files_left_behind_are_none),
      cmocka_unit_test(full_devices_are_told),
      cmocka_unit_test(files_that_cannot_grow),
      cmocka_unit_test(a_full_file_system),
      cmocka_unit_test(lack_of_memory_leaves_nothing),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
