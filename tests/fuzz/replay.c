/* Feeds kept files to a fuzz target, in any build: replay FOLDER_OR_FILE... Fails when one of them
 * is missing or all are empty. */
#include "fuzz/fuzz.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static int64_t replayed;

static int replay(const char *path, const struct stat *facts, int kind, struct FTW *place) {
  (void)place;
  if (kind != FTW_F)
    return kind == FTW_NS || kind == FTW_DNR;
  uint8_t *data = malloc((size_t)facts->st_size + 1);
  FILE *file = fopen(path, "rb");
  bool good = data != NULL && file != NULL &&
              fread(data, 1, (size_t)facts->st_size, file) == (size_t)facts->st_size;
  if (file != NULL)
    fclose(file);
  if (good) {
    fprintf(stderr, "%s\n", path); /* the last one named is to blame */
    LLVMFuzzerTestOneInput(data, (size_t)facts->st_size);
    replayed++;
  }
  free(data);
  return !good;
}

/* What a file announces must not be allocated. The sanitizers take far more addresses than that. */
static void limit_memory(void) {
#ifndef CDEM_SANITIZED
  const struct rlimit limit = {(rlim_t)4 << 30, (rlim_t)4 << 30};
  setrlimit(RLIMIT_AS, &limit);
#endif
}

int main(int count, char **argument) {
  limit_memory();
  for (int i = 1; i < count; i++)
    if (nftw(argument[i], replay, 16, FTW_PHYS) != 0) {
      fprintf(stderr, "cannot replay '%s'\n", argument[i]);
      return 1;
    }
  printf("%lld inputs replayed\n", (long long)replayed);
  return replayed > 0 ? 0 : 1;
}
