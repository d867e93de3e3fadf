#include "io/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
  BUFFER = 1 << 20, /* bytes between two system calls */
  MAX_LINKS = 40,   /* what the kernel follows */
  MAX_NAME = 200    /* of the target's name in the temporary one; file names end at 255 */
};

struct cdem_output {
  char *name;   /* as the user gave it */
  char *target; /* symbolic links followed; NULL when written straight */
  char *path;   /* where the bytes go */
  int descriptor;
  FILE *stream;
  char *buffer;
  int error; /* errno of the first write that failed */
  bool regular;
  bool dropped; /* what is still buffered must not be written */
};

/* ---- messages ---- */

static const char *remedy(int error) {
  switch (error) {
  case ENOSPC:
  case EDQUOT:
  case EFBIG:
    return "free some space or choose another folder with -o";
  case ENOENT:
  case ENOTDIR:
    return "create the folder first or choose another one with -o";
  case EISDIR:
    return "give the name of a file with -o";
  case EPIPE:
    return "whatever was reading it has gone";
  default:
    return "choose another folder with -o";
  }
}

cdem_status cdem_write_fail(const char *path, int error, cdem_fault *fault) {
  CDEM_REQUIRE(error != ENOMEM, fault, CDEM_MEMORY, "out of memory: cannot write '%s'", path);
  return cdem_fail(fault, CDEM_FILE, "cannot write '%s': %s; %s", path, strerror(error),
                   remedy(error));
}

cdem_status cdem_output_fail(const cdem_output *output, int error, cdem_fault *fault) {
  return cdem_write_fail(output->name, error, fault);
}

/* ---- the stream: a cookie, so that the errno of a late write is not lost in stdio ---- */

static ssize_t cookie_write(void *cookie, const char *data, size_t bytes) {
  cdem_output *output = cookie;
  size_t done = 0;
  while (done < bytes && !output->dropped) {
    ssize_t n = write(output->descriptor, data + done, bytes - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0) {
      if (output->error == 0)
        output->error = errno;
      return 0;
    }
    done += (size_t)n;
  }
  return (ssize_t)bytes;
}

static cdem_status open_stream(cdem_output *output, cdem_fault *fault) {
  output->buffer = cdem_allocate(BUFFER, 1, fault);
  if (output->buffer == NULL)
    return CDEM_MEMORY;
  output->stream = fopencookie(output, "w", (cookie_io_functions_t){.write = cookie_write});
  CDEM_REQUIRE(output->stream != NULL, fault, CDEM_MEMORY, "out of memory: no stream for '%s'",
               output->name);
  setvbuf(output->stream, output->buffer, _IOFBF, BUFFER);
  return CDEM_OK;
}

/* ---- where to write ---- */

/* Follows symbolic links of the last component, so that the link survives the rename and a link to
 * a file that does not exist yet creates that file, as fopen would. */
static cdem_status follow_links(cdem_output *output, cdem_fault *fault) {
  output->target = cdem_copy_text(output->name, fault);
  for (int links = 0; output->target != NULL; links++) {
    char link[4096];
    ssize_t length = readlink(output->target, link, sizeof link - 1);
    if (length < 0)
      return CDEM_OK;
    if (links >= MAX_LINKS)
      return cdem_output_fail(output, ELOOP, fault);
    link[length] = '\0';
    const char *slash = strrchr(output->target, '/');
    int folder = link[0] == '/' || slash == NULL ? 0 : (int)(slash - output->target) + 1;
    char *next = cdem_allocate(folder + length + 1, 1, fault);
    if (next != NULL) {
      memcpy(next, output->target, (size_t)folder);
      memcpy(next + folder, link, (size_t)length);
    }
    free(output->target);
    output->target = next;
  }
  return CDEM_MEMORY;
}

/* Creates FOLDER/.NAME.part-PID; a number is added while the name is taken. */
static cdem_status create_temporary(cdem_output *output, cdem_fault *fault) {
  const char *slash = strrchr(output->target, '/'), *name = slash ? slash + 1 : output->target;
  int folder = (int)(name - output->target), room = folder + MAX_NAME + 64;
  output->path = cdem_allocate(room, 1, fault);
  if (output->path == NULL)
    return CDEM_MEMORY;
  for (int attempt = 0; attempt < 1000; attempt++) {
    int used = snprintf(output->path, (size_t)room, "%.*s.%.*s.part-%ld", folder, output->target,
                        MAX_NAME, name, (long)getpid());
    if (attempt > 0)
      snprintf(output->path + used, (size_t)(room - used), "-%d", attempt);
    output->descriptor = open(output->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (output->descriptor >= 0 || errno != EEXIST)
      break;
  }
  if (output->descriptor >= 0)
    return CDEM_OK;
  int error = errno;
  free(output->path);
  output->path = NULL;
  return cdem_output_fail(output, error, fault);
}

static cdem_status open_straight(cdem_output *output, cdem_fault *fault) {
  output->descriptor = open(output->name, O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (output->descriptor < 0)
    return cdem_output_fail(output, errno, fault);
  output->path = cdem_copy_text(output->name, fault);
  return output->path != NULL ? CDEM_OK : CDEM_MEMORY;
}

static cdem_status open_standard(cdem_output *output, cdem_fault *fault) {
  fflush(stdout);
  output->descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (output->descriptor < 0)
    return cdem_output_fail(output, errno, fault);
  output->path = cdem_copy_text("/dev/stdout", fault);
  return output->path != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* A name that stands for a descriptor this process already has: writing through it must not replace
 * the file the shell opened. */
static bool is_descriptor_name(const char *path) {
  return strcmp(path, "/dev/stderr") == 0 || strncmp(path, "/dev/fd/", 8) == 0 ||
         strncmp(path, "/proc/self/fd/", 14) == 0;
}

static cdem_status open_target(cdem_output *output, cdem_fault *fault) {
  struct stat existing;
  if (strcmp(output->name, "-") == 0 || strcmp(output->name, "/dev/stdout") == 0)
    return open_standard(output, fault);
  bool exists = stat(output->name, &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode))
    return cdem_output_fail(output, EISDIR, fault);
  if (is_descriptor_name(output->name) || (exists && !S_ISREG(existing.st_mode)))
    return open_straight(output, fault);
  if (exists && faccessat(AT_FDCWD, output->name, W_OK, AT_EACCESS) != 0)
    return cdem_output_fail(output, errno, fault);
  CDEM_TRY(follow_links(output, fault));
  CDEM_TRY(create_temporary(output, fault));
  output->regular = true;
  /* An existing file keeps its owner and permissions, as with fopen; not being allowed to give a
   * file away is no failure. */
  if (exists && fchown(output->descriptor, existing.st_uid, existing.st_gid) != 0)
    existing.st_mode &= 0777;
  if (exists)
    fchmod(output->descriptor, existing.st_mode & 07777);
  return CDEM_OK;
}

/* ---- public ---- */

cdem_status cdem_output_open(const char *path, cdem_output **output, cdem_fault *fault) {
  cdem_output *o;
  *output = NULL;
  CDEM_NEW(o, 1, fault);
  o->descriptor = -1;
  o->name = cdem_copy_text(path, fault);
  cdem_status status = o->name != NULL ? open_target(o, fault) : CDEM_MEMORY;
  if (status == CDEM_OK)
    status = open_stream(o, fault);
  if (status != CDEM_OK) {
    cdem_output_discard(&o);
    return status;
  }
  *output = o;
  return CDEM_OK;
}

FILE *cdem_output_stream(cdem_output *output) {
  return output->stream;
}

const char *cdem_output_path(const cdem_output *output) {
  return output->path;
}

const char *cdem_output_name(const cdem_output *output) {
  return output->name;
}

bool cdem_output_is_file(const cdem_output *output) {
  return output->regular;
}

int cdem_output_descriptor(const cdem_output *output) {
  return output->descriptor;
}

cdem_status cdem_output_write(cdem_output *output, const void *data, size_t bytes,
                              cdem_fault *fault) {
  if (bytes == 0 || fwrite(data, 1, bytes, output->stream) == bytes)
    return CDEM_OK;
  return cdem_output_fail(output, output->error != 0 ? output->error : EIO, fault);
}

/* Closes what is open; the first errno of writing or closing stays in output->error. */
static void close_output(cdem_output *output) {
  if (output->stream != NULL) {
    bool bad = fflush(output->stream) != 0 || ferror(output->stream) != 0;
    bad |= fclose(output->stream) != 0;
    if (bad && output->error == 0)
      output->error = EIO;
    output->stream = NULL;
  }
  if (output->descriptor >= 0 && close(output->descriptor) != 0 && output->error == 0)
    output->error = errno;
  output->descriptor = -1;
}

static void free_output(cdem_output **output) {
  free((*output)->name);
  free((*output)->target);
  free((*output)->path);
  free((*output)->buffer);
  free(*output);
  *output = NULL;
}

cdem_status cdem_output_commit(cdem_output **output, cdem_fault *fault) {
  cdem_output *o = *output;
  close_output(o);
  if (o->error == 0 && o->regular && rename(o->path, o->target) != 0)
    o->error = errno;
  cdem_status status = CDEM_OK;
  if (o->error != 0) {
    status = cdem_output_fail(o, o->error, fault);
    if (o->regular)
      unlink(o->path);
  }
  free_output(output);
  return status;
}

void cdem_output_discard(cdem_output **output) {
  if (output == NULL || *output == NULL)
    return;
  (*output)->dropped = true;
  close_output(*output);
  if ((*output)->regular && (*output)->path != NULL)
    unlink((*output)->path);
  free_output(output);
}

cdem_status cdem_output_scratch(const cdem_output *output, FILE **scratch, cdem_fault *fault) {
  *scratch = NULL;
  if (!output->regular) {
    *scratch = tmpfile();
    return *scratch != NULL ? CDEM_OK : cdem_output_fail(output, errno, fault);
  }
  size_t room = strlen(output->path) + 16;
  char *path = cdem_allocate((int64_t)room, 1, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  snprintf(path, room, "%s-XXXXXX", output->path);
  int descriptor = mkostemp(path, O_CLOEXEC);
  if (descriptor >= 0) {
    unlink(path);
    *scratch = fdopen(descriptor, "w+");
  }
  int error = errno;
  free(path);
  if (*scratch != NULL)
    return CDEM_OK;
  if (descriptor >= 0)
    close(descriptor);
  return cdem_output_fail(output, error, fault);
}

cdem_status cdem_write_text(const char *path, const char *text, int64_t length, cdem_fault *fault) {
  cdem_output *file = NULL;
  CDEM_TRY(cdem_output_open(path, &file, fault));
  cdem_status status = cdem_output_write(file, text, (size_t)length, fault);
  if (status == CDEM_OK)
    status = cdem_output_commit(&file, fault);
  cdem_output_discard(&file);
  return status;
}
