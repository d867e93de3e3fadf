/* Looking at a folder: what lies in it, who holds it, the way to it. */
#include "io/run_files.h"
#include "support/scratch.h"

#include <sys/stat.h>
#include <unistd.h>

static void write_file(const char *name, const char *text) {
  FILE *file = fopen(in_scratch(name), "w");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

static void files_come_in_the_order_of_their_bytes(void **state) {
  (void)state;
  static const char *const expected[] = {"B", "a", "aa", "sub", "\xc3\xa9"};
  cdem_fault fault = {0};
  cdem_listing listing = {0};
  mkdir(in_scratch("list"), 0777);
  mkdir(in_scratch("list/sub"), 0777);
  write_file("list/aa", "12345");
  write_file("list/a", "");
  write_file("list/B", "1");
  write_file("list/\xc3\xa9", "1");
  write_file("list/.hidden", "1");
  assert_int_equal(symlink("nowhere", in_scratch("list/gone")), 0);
  check_ok(cdem_list_folder(in_scratch("list"), &listing, &fault));
  assert_int_equal(listing.count, 5);
  for (int i = 0; i < 5; i++)
    assert_string_equal(listing.item[i].name, expected[i]);
  assert_true(cdem_listing_find(&listing, "sub")->folder);
  assert_int_equal(cdem_listing_find(&listing, "aa")->bytes, 5);
  assert_null(cdem_listing_find(&listing, "gone"));
  cdem_listing_release(&listing);
  cdem_listing_release(&listing);
  check_fails(cdem_list_folder(in_scratch("absent"), &listing, &fault), CDEM_FILE,
              "absent': No such file or directory");
}

static void bytes_are_read_as_they_are(void **state) {
  (void)state;
  cdem_fault fault = {0};
  unsigned char *data = NULL;
  int64_t bytes = 0;
  FILE *file = fopen(in_scratch("bytes"), "w");
  assert_int_equal(fwrite("a\0b\xff", 1, 4, file), 4);
  fclose(file);
  check_ok(cdem_read_bytes(in_scratch("bytes"), &data, &bytes, &fault));
  assert_int_equal(bytes, 4);
  assert_memory_equal(data, "a\0b\xff", 4);
  free(data);
  data = NULL;
  check_fails(cdem_read_bytes(in_scratch("absent"), &data, &bytes, &fault), CDEM_FILE, "absent'");
  check_fails(cdem_read_bytes(scratch, &data, &bytes, &fault), CDEM_FILE, "it is no file");
  assert_null(data);
}

/* Whoever follows the way from the file's folder arrives at the folder. */
static void a_way_leads_there(void **state) {
  (void)state;
  static const char *const place[][3] = {
      {"w/page", "w", ""},           {"page", "w", "w/"},
      {"w/deep/page", "w", "../"},   {"w/deep/page", "wide", "../../wide/"},
      {"wide/page", "w", "../w/"},   {"w/page", "w/deep", "deep/"},
      {"link/page", "w", "../../w/"}};
  cdem_fault fault = {0};
  mkdir(in_scratch("w"), 0777);
  mkdir(in_scratch("w/deep"), 0777);
  mkdir(in_scratch("wide"), 0777);
  mkdir(in_scratch("wide/inner"), 0777);
  assert_int_equal(symlink("wide/inner", in_scratch("link")), 0);
  for (size_t i = 0; i < sizeof place / sizeof place[0]; i++) {
    char *way = NULL, there[700];
    struct stat found, expected;
    check_ok(cdem_relative_path(in_scratch(place[i][0]), in_scratch(place[i][1]), &way, &fault));
    assert_string_equal(way, place[i][2]);
    const char *slash = strrchr(place[i][0], '/');
    snprintf(there, sizeof there, "%s/%.*s/%s", scratch,
             slash != NULL ? (int)(slash - place[i][0]) : 1, slash != NULL ? place[i][0] : ".",
             way);
    assert_int_equal(stat(there, &found), 0);
    assert_int_equal(stat(in_scratch(place[i][1]), &expected), 0);
    assert_true(found.st_ino == expected.st_ino);
    free(way);
  }
  char *way = NULL;
  check_fails(cdem_relative_path(in_scratch("absent/page"), scratch, &way, &fault), CDEM_FILE,
              "create the folder first");
  check_fails(cdem_relative_path(in_scratch("page"), in_scratch("absent"), &way, &fault), CDEM_FILE,
              "absent': No such file");
}

static void the_holder_is_who_has_the_lock(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_folder_lock *lock = NULL;
  mkdir(in_scratch("held"), 0777);
  assert_int_equal(cdem_folder_holder(in_scratch("held")), 0);
  check_ok(cdem_folder_lock_take(in_scratch("held"), &lock, &fault));
  assert_int_equal(cdem_folder_holder(in_scratch("held")), getpid());
  cdem_folder_lock_drop(&lock);
  assert_int_equal(cdem_folder_holder(in_scratch("held")), 0);
  /* the number of a living process that holds nothing */
  char text[24];
  snprintf(text, sizeof text, "%ld\n", (long)getpid());
  write_file("held/.lock", text);
  assert_int_equal(cdem_folder_holder(in_scratch("held")), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_come_in_the_order_of_their_bytes),
      cmocka_unit_test(bytes_are_read_as_they_are),
      cmocka_unit_test(a_way_leads_there),
      cmocka_unit_test(the_holder_is_who_has_the_lock),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
