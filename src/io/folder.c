/* Folders, locks and whole text files. */
#include "io/gnuplot.h"
#include "io/output.h"
#include "io/run_files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct cdem_folder_lock {
  int descriptor;
};

/* Makes the folder at `path`, whose parents are there. */
static cdem_status make_one(const char *path, cdem_fault *fault) {
  struct stat facts;
  if (mkdir(path, 0777) == 0)
    return CDEM_OK;
  int error = errno;
  /* A file system that may not be written answers EROFS or EACCES for folders that are there. */
  if (stat(path, &facts) == 0 && S_ISDIR(facts.st_mode))
    return CDEM_OK;
  if (error == EEXIST)
    error = ENOTDIR;
  return cdem_fail(fault, CDEM_FILE, "cannot make the folder '%s': %s; choose another one", path,
                   strerror(error));
}

cdem_status cdem_make_folder(const char *folder, cdem_fault *fault) {
  char *path = cdem_copy_text(folder, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = CDEM_OK;
  for (char *at = path; status == CDEM_OK && *at != '\0';) {
    at += strspn(at, "/");
    at += strcspn(at, "/");
    char keep = *at;
    *at = '\0';
    status = make_one(path, fault);
    *at = keep;
  }
  free(path);
  return status;
}

/* ---- pictures ---- */

/* Is this a script of ours? */
static bool draws(const char *path) {
  char line[sizeof CDEM_GNUPLOT_FIRST_LINE] = "";
  FILE *file = fopen(path, "rbe");
  if (file == NULL)
    return false;
  size_t got = fread(line, 1, sizeof line - 1, file);
  fclose(file);
  return got == sizeof line - 1 && strcmp(line, CDEM_GNUPLOT_FIRST_LINE) == 0;
}

/* Removes STEM.png and so on of the script STEM.gp; the script last, so that what a failure leaves
 * is found again. */
static cdem_status clear_figure(const char *folder, const char *script, cdem_fault *fault) {
  static const char *const ending[] = {"png", "svg", "dat", "gp"};
  char *path = cdem_join_path(folder, script, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = CDEM_OK;
  for (size_t i = 0; status == CDEM_OK && i < sizeof ending / sizeof ending[0]; i++) {
    if (i == 0 && !draws(path))
      break;
    char *other = cdem_allocate((int64_t)strlen(path) + 2, 1, fault);
    if (other == NULL) {
      status = CDEM_MEMORY;
      break;
    }
    sprintf(other, "%.*s%s", (int)strlen(path) - 2, path, ending[i]);
    if (unlink(other) != 0 && errno != ENOENT)
      status = cdem_fail(fault, CDEM_FILE,
                         "cannot remove '%s' of an earlier run: %s; choose another folder", other,
                         strerror(errno));
    free(other);
  }
  free(path);
  return status;
}

cdem_status cdem_clear_figures(const char *folder, cdem_fault *fault) {
  DIR *list = opendir(folder);
  cdem_status status = CDEM_OK;
  if (list == NULL)
    return CDEM_OK;
  for (struct dirent *entry; status == CDEM_OK && (entry = readdir(list)) != NULL;) {
    size_t length = strlen(entry->d_name);
    if (length > 3 && strcmp(entry->d_name + length - 3, ".gp") == 0)
      status = clear_figure(folder, entry->d_name, fault);
  }
  closedir(list);
  return status;
}

/* ---- unfinished files ---- */

/* ".NAME.part-123" (output.c) of a process that is gone. */
static bool is_left_over(const char *name) {
  const char *part = name[0] == '.' ? strstr(name, ".part-") : NULL;
  if (part == NULL)
    return false;
  char *end;
  long process = strtol(part + 6, &end, 10);
  return process > 0 && *end == '\0' && kill((pid_t)process, 0) != 0 && errno == ESRCH;
}

static cdem_status clear_parts(const char *folder, bool below, cdem_fault *fault) {
  DIR *list = opendir(folder);
  cdem_status status = CDEM_OK;
  if (list == NULL)
    return CDEM_OK;
  for (struct dirent *entry; status == CDEM_OK && (entry = readdir(list)) != NULL;) {
    bool part = is_left_over(entry->d_name);
    if (!part && (!below || entry->d_name[0] == '.'))
      continue;
    char *path = cdem_join_path(folder, entry->d_name, fault);
    if (path == NULL)
      status = CDEM_MEMORY;
    else if (!part)
      status = clear_parts(path, false, fault);
    else if (unlink(path) != 0 && errno != ENOENT)
      status = cdem_fail(fault, CDEM_FILE,
                         "cannot remove '%s': %s; remove it, or choose another "
                         "folder",
                         path, strerror(errno));
    free(path);
  }
  closedir(list);
  return status;
}

cdem_status cdem_clear_parts(const char *folder, cdem_fault *fault) {
  return clear_parts(folder, true, fault);
}

/* ---- lock ---- */

static cdem_status report_holder(const char *folder, int descriptor, cdem_fault *fault) {
  char holder[24] = "";
  ssize_t got = pread(descriptor, holder, sizeof holder - 1, 0);
  holder[got > 0 ? got : 0] = '\0';
  holder[strspn(holder, "0123456789")] = '\0';
  return cdem_fail(fault, CDEM_INPUT,
                   "the folder '%s' is in use by another run%s%s%s; wait for it or choose another "
                   "folder with -o",
                   folder, holder[0] != '\0' ? " (process " : "", holder,
                   holder[0] != '\0' ? ")" : "");
}

/* The file stays when the lock is dropped: if it were removed, a run that has just opened it would
 * lock a file without a name, and a third run a new one. */
static cdem_status lock_file(const char *folder, const char *path, int descriptor,
                             cdem_fault *fault) {
  char holder[24];
  int result;
  do
    result = flock(descriptor, LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno == EWOULDBLOCK)
    return report_holder(folder, descriptor, fault);
  CDEM_REQUIRE(result == 0, fault, CDEM_FILE,
               "cannot lock '%s': %s; choose a folder on a file system with locks with -o", path,
               strerror(errno));
  int length = snprintf(holder, sizeof holder, "%ld\n", (long)getpid());
  errno = ENOSPC; /* what a number that was cut short comes from */
  if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, holder, (size_t)length, 0) != length)
    return cdem_write_fail(path, errno, fault);
  return CDEM_OK;
}

static cdem_status take(const char *folder, const char *path, cdem_folder_lock **lock,
                        cdem_fault *fault) {
  cdem_folder_lock *l;
  CDEM_NEW(l, 1, fault);
  l->descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  cdem_status status = l->descriptor >= 0 ? lock_file(folder, path, l->descriptor, fault)
                                          : cdem_write_fail(path, errno, fault);
  if (status == CDEM_OK) {
    *lock = l;
    return CDEM_OK;
  }
  if (l->descriptor >= 0)
    close(l->descriptor);
  free(l);
  return status;
}

cdem_status cdem_folder_lock_take(const char *folder, cdem_folder_lock **lock, cdem_fault *fault) {
  *lock = NULL;
  char *path = cdem_join_path(folder, ".lock", fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = take(folder, path, lock, fault);
  free(path);
  return status;
}

void cdem_folder_lock_drop(cdem_folder_lock **lock) {
  if (lock == NULL || *lock == NULL)
    return;
  /* A stale number would mislead whoever looks; that it cannot be erased harms nobody. */
  if (ftruncate((*lock)->descriptor, 0) != 0)
    errno = 0;
  close((*lock)->descriptor);
  free(*lock);
  *lock = NULL;
}

/* ---- paths and texts ---- */

char *cdem_join_path(const char *folder, const char *name, cdem_fault *fault) {
  size_t length = strlen(folder), room = length + strlen(name) + 2;
  char *path = cdem_allocate((int64_t)room, 1, fault);
  if (path != NULL)
    snprintf(path, room, "%s%s%s", folder, length > 0 && folder[length - 1] != '/' ? "/" : "",
             name);
  return path;
}

static cdem_status load(FILE *file, char **text, int64_t *length, cdem_fault *fault) {
  int64_t capacity = 0, used = 0, room = 1 << 16;
  struct stat facts;
  if (fstat(fileno(file), &facts) == 0 && S_ISDIR(facts.st_mode)) {
    errno = EISDIR;
    return CDEM_FILE;
  }
  do {
    CDEM_TRY(cdem_grow(text, &capacity, room, 1, fault));
    errno = 0;
    used += (int64_t)fread(*text + used, 1, (size_t)(capacity - 1 - used), file);
    room = capacity + 1;
  } while (used == capacity - 1 && !feof(file) && !ferror(file));
  (*text)[used] = '\0';
  *length = used;
  return ferror(file) ? CDEM_FILE : CDEM_OK;
}

cdem_status cdem_read_text(const char *path, char **text, cdem_fault *fault) {
  int64_t length = 0;
  char *read = NULL;
  *text = NULL;
  FILE *file = fopen(path, "rbe");
  cdem_status status = file != NULL ? load(file, &read, &length, fault) : CDEM_FILE;
  if (status == CDEM_FILE)
    cdem_fail(fault, CDEM_FILE, "cannot read '%s': %s", path,
              errno != 0 ? strerror(errno) : "it cannot be read to its end");
  if (file != NULL)
    fclose(file);
  if (status == CDEM_OK && (int64_t)strlen(read) != length)
    status = cdem_fail(fault, CDEM_INPUT, "cannot read '%s': byte %zu is zero; give a text file",
                       path, strlen(read) + 1);
  if (status == CDEM_OK)
    *text = read;
  else
    free(read);
  return status;
}

/* ---- scratch ---- */

static const char scratch_prefix[] = "/tmp/cdem-scratch-";

cdem_status cdem_make_scratch(char path[64], cdem_fault *fault) {
  snprintf(path, 64, "%sXXXXXX", scratch_prefix);
  CDEM_REQUIRE(mkdtemp(path) != NULL, fault, CDEM_FILE, "cannot make a folder in /tmp: %s",
               strerror(errno));
  return CDEM_OK;
}

static int remove_one(const char *path, const struct stat *about, int type, struct FTW *where) {
  (void)about;
  (void)type;
  (void)where;
  return remove(path);
}

void cdem_remove_scratch(const char *path) {
  if (strncmp(path, scratch_prefix, sizeof scratch_prefix - 1) == 0)
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}
