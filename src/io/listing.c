/* Looking at a folder: what lies in it, who writes to it, and how to get there from a file. */
#include "io/output.h"
#include "io/run_files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static cdem_status read_fail(const char *path, int error, cdem_fault *fault) {
  return cdem_fail(fault, CDEM_FILE, "cannot read '%s': %s", path, strerror(error));
}

/* ---- what lies in it ---- */

static int by_name(const void *a, const void *b) {
  return strcmp(((const cdem_listed *)a)->name, ((const cdem_listed *)b)->name);
}

/* What has gone since the folder was read is passed over. */
static cdem_status add_listed(const char *folder, const char *name, cdem_listing *listing,
                              cdem_fault *fault) {
  struct stat facts;
  char *path = cdem_join_path(folder, name, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  bool there = stat(path, &facts) == 0;
  free(path);
  if (!there)
    return CDEM_OK;
  CDEM_TRY(cdem_grow(&listing->item, &listing->capacity, listing->count + 1, sizeof *listing->item,
                     fault));
  cdem_listed *item = &listing->item[listing->count];
  *item = (cdem_listed){.name = cdem_copy_text(name, fault),
                        .folder = S_ISDIR(facts.st_mode),
                        .bytes = (int64_t)facts.st_size,
                        .changed = (int64_t)facts.st_mtime};
  if (item->name == NULL)
    return CDEM_MEMORY;
  listing->count++;
  return CDEM_OK;
}

cdem_status cdem_list_folder(const char *path, cdem_listing *listing, cdem_fault *fault) {
  cdem_listing made = {0};
  DIR *list = opendir(path);
  if (list == NULL)
    return read_fail(path, errno, fault);
  cdem_status status = CDEM_OK;
  for (struct dirent *entry; status == CDEM_OK && (entry = readdir(list)) != NULL;)
    if (entry->d_name[0] != '.')
      status = add_listed(path, entry->d_name, &made, fault);
  closedir(list);
  if (status == CDEM_OK) {
    if (made.count > 0)
      qsort(made.item, (size_t)made.count, sizeof *made.item, by_name);
    *listing = made;
  } else {
    cdem_listing_release(&made);
  }
  return status;
}

void cdem_listing_release(cdem_listing *listing) {
  for (int64_t i = 0; i < listing->count; i++)
    free(listing->item[i].name);
  free(listing->item);
  *listing = (cdem_listing){0};
}

const cdem_listed *cdem_listing_find(const cdem_listing *listing, const char *name) {
  for (int64_t i = 0; i < listing->count; i++)
    if (strcmp(listing->item[i].name, name) == 0)
      return &listing->item[i];
  return NULL;
}

/* ---- who writes to it ---- */

/* The number alone may be that of a run that was killed, and the lock alone asks for a moment of
 * it: so it is asked only where the process lives. */
int64_t cdem_folder_holder(const char *folder) {
  char *path = cdem_join_path(folder, ".lock", NULL), text[24] = "";
  int descriptor = path != NULL ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  free(path);
  if (descriptor < 0)
    return 0;
  ssize_t got = pread(descriptor, text, sizeof text - 1, 0);
  long process = got > 0 ? strtol(text, NULL, 10) : 0;
  bool lives = process > 0 && (kill((pid_t)process, 0) == 0 || errno == EPERM);
  bool held = lives && flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return held ? process : 0;
}

/* ---- bytes ---- */

static cdem_status load_bytes(const char *path, FILE *file, int64_t bytes, unsigned char **data,
                              cdem_fault *fault) {
  CDEM_NEW(*data, bytes, fault);
  if (fread(*data, 1, (size_t)bytes, file) == (size_t)bytes)
    return CDEM_OK;
  return ferror(file) ? read_fail(path, errno, fault)
                      : cdem_fail(fault, CDEM_FILE,
                                  "cannot read '%s': it has become shorter; is a "
                                  "run writing it?",
                                  path);
}

cdem_status cdem_read_bytes(const char *path, unsigned char **data, int64_t *bytes,
                            cdem_fault *fault) {
  struct stat facts;
  unsigned char *read = NULL;
  FILE *file = fopen(path, "rbe");
  if (file == NULL)
    return read_fail(path, errno, fault);
  cdem_status status = fstat(fileno(file), &facts) == 0 && S_ISREG(facts.st_mode)
                           ? load_bytes(path, file, (int64_t)facts.st_size, &read, fault)
                           : cdem_fail(fault, CDEM_FILE, "cannot read '%s': it is no file", path);
  fclose(file);
  if (status != CDEM_OK) {
    free(read);
    return status;
  }
  *data = read;
  *bytes = (int64_t)facts.st_size;
  return CDEM_OK;
}

/* ---- the way there ---- */

/* The folder of a file, absolute, links resolved. */
static cdem_status folder_of(const char *file, char **found, cdem_fault *fault) {
  char *folder = cdem_copy_text(file, fault);
  if (folder == NULL)
    return CDEM_MEMORY;
  char *slash = strrchr(folder, '/');
  if (slash != NULL)
    slash[slash == folder] = '\0';
  const char *of = slash != NULL ? folder : ".";
  *found = realpath(of, NULL);
  cdem_status status = CDEM_OK;
  if (*found == NULL)
    status = cdem_write_fail(file, errno, fault);
  free(folder);
  return status;
}

/* Bytes of the folders that both have in common, with the slash. */
static size_t common(const char *a, const char *b) {
  size_t last = 0, i = 0;
  for (; a[i] != '\0' && a[i] == b[i]; i++)
    if (a[i] == '/')
      last = i + 1;
  bool ends = (a[i] == '\0' || a[i] == '/') && (b[i] == '\0' || b[i] == '/');
  return ends ? i + (a[i] == '/' && b[i] == '/') : last;
}

/* "../" for each folder of `from` beyond the first `shared` bytes, then the rest of `to`. */
static char *join_way(const char *from, const char *to, size_t shared, cdem_fault *fault) {
  int64_t up = 0;
  const char *down = to + shared + (to[shared] == '/');
  for (const char *at = from + shared; *at != '\0';) {
    at += strspn(at, "/");
    up += *at != '\0';
    at += strcspn(at, "/");
  }
  char *way = cdem_allocate(3 * up + (int64_t)strlen(down) + 2, 1, fault), *at = way;
  if (way == NULL)
    return NULL;
  for (int64_t i = 0; i < up; i++)
    at = stpcpy(at, "../");
  at = stpcpy(at, down);
  if (at > way && at[-1] != '/')
    stpcpy(at, "/");
  return way;
}

cdem_status cdem_relative_path(const char *file, const char *folder, char **way,
                               cdem_fault *fault) {
  char *to = realpath(folder, NULL), *from = NULL;
  if (to == NULL)
    return read_fail(folder, errno, fault);
  cdem_status status = folder_of(file, &from, fault);
  char *made = status == CDEM_OK ? join_way(from, to, common(from, to), fault) : NULL;
  free(from);
  free(to);
  if (status == CDEM_OK && made == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK)
    *way = made;
  return status;
}
