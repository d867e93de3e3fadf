/* Doors: whole operations of the library, each behind one call, for tests that make something fail
 * inside them. A door is a kind (what to call, and what must hold afterwards) with its arguments;
 * doors.def lists them, one a line. */
#ifndef CDEM_TESTS_ROBUST_DOOR_H
#define CDEM_TESTS_ROBUST_DOOR_H

#include "support/scratch.h"

#include <dirent.h>
#include <ftw.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <unistd.h>

#define CASES CDEM_ROBUST "/cases/"

typedef struct door_kind door_kind;

typedef struct {
  const char *name;
  const door_kind *kind;
  const char *text;   /* a file, a name */
  const char *set[2]; /* overrides of a case */
} door;

struct door_kind {
  /* Puts everything where it was before the first call. May be NULL. */
  void (*before)(const door *d);
  cdem_status (*open)(const door *d, cdem_fault *fault);
  /* Of a call that went well: a sum of its result, which is then given back. */
  uint64_t (*result)(const door *d);
  /* Of a call that failed: nothing is half done. May be NULL. */
  void (*failed)(const door *d);
  /* Brings what a failed call has left to its end; the sum of the result. NULL: `open` once more
   * from the beginning. */
  uint64_t (*again)(const door *d);
  bool writes; /* a file that lasts */
};

/* ---- sums of results ---- */

enum { MOST_PATH = 4096 };
static const uint64_t sum_start = 0xcbf29ce484222325u;

static inline uint64_t fold(uint64_t sum, const void *data, size_t bytes) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < bytes; i++)
    sum = (sum ^ byte[i]) * 0x100000001b3u;
  return sum;
}

static inline uint64_t fold_text(uint64_t sum, const char *text) {
  return text != NULL ? fold(sum, text, strlen(text) + 1) : fold(sum, "", 1);
}

static inline uint64_t fold_file(uint64_t sum, const char *path) {
  unsigned char piece[4096];
  FILE *file = fopen(path, "rb");
  if (file == NULL)
    fail_msg("%s is missing", path);
  for (size_t got; (got = fread(piece, 1, sizeof piece, file)) > 0;)
    sum = fold(sum, piece, got);
  fclose(file);
  return sum;
}

/* All files of a folder and below, but for those that hold the time of day or of the run. */
static inline uint64_t fold_folder(uint64_t sum, const char *folder) {
  static const char *const other[] = {".", "..", ".lock", "summary.json", "checkpoint.h5"};
  struct dirent **entry;
  int entries = scandir(folder, &entry, NULL, alphasort);
  assert_true(entries >= 0);
  for (int i = 0; i < entries; i++) {
    char path[MOST_PATH];
    struct stat facts;
    bool taken = true;
    for (size_t k = 0; k < sizeof other / sizeof *other; k++)
      taken = taken && strcmp(entry[i]->d_name, other[k]) != 0;
    int length = snprintf(path, sizeof path, "%s/%s", folder, entry[i]->d_name);
    assert_in_range(length, 1, sizeof path - 1);
    assert_int_equal(stat(path, &facts), 0);
    if (taken) {
      sum = fold_text(sum, entry[i]->d_name);
      sum = S_ISDIR(facts.st_mode) ? fold_folder(sum, path) : fold_file(sum, path);
    }
    free(entry[i]);
  }
  free(entry);
  return sum;
}

/* ---- files ---- */

static inline int remove_entry(const char *path, const struct stat *facts, int type,
                               struct FTW *where) {
  (void)facts, (void)type, (void)where;
  return remove(path);
}

static inline void remove_folder(const char *name) {
  nftw(in_scratch(name), remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static inline bool exists(const char *name) {
  return access(in_scratch(name), F_OK) == 0;
}

static inline int count_entries(const char *folder) {
  DIR *list = opendir(folder);
  int count = 0;
  assert_non_null(list);
  for (struct dirent *entry; (entry = readdir(list)) != NULL;)
    count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
  closedir(list);
  return count;
}

#endif
