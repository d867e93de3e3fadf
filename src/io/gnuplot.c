/* Pictures: data and script are files of our own, gnuplot is a child process that draws them.
 *
 * No shell is involved, so that a name may hold spaces and quotes. gnuplot runs in the folder of
 * the picture and draws into temporary files, which are renamed when both are whole. */
#include "io/gnuplot.h"

#include "io/output.h"
#include "io/run_files.h"
#include "io/text.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { KINDS = 2, COMPLAINT = 256 };
static const char *const endings[KINDS] = {"png", "svg"};
/* What stands at the end of a whole picture, but for line breaks. */
static const char *const tails[KINDS] = {"IEND\xae\x42\x60\x82", "</svg>"};

/* FOLDER/NAME.ENDING, to be freed; NULL when out of memory. prefix and suffix may be "". */
static char *join(const char *folder, const char *prefix, const char *name, const char *ending,
                  const char *suffix, cdem_fault *fault) {
  size_t room =
      strlen(folder) + strlen(prefix) + strlen(name) + strlen(ending) + strlen(suffix) + 3;
  char *path = cdem_allocate((int64_t)room, 1, fault);
  if (path != NULL)
    snprintf(path, room, "%s%s%s%s.%s%s", folder, folder[0] != '\0' ? "/" : "", prefix, name,
             ending, suffix);
  return path;
}

static cdem_status put_file(const char *folder, const char *name, const char *ending,
                            const cdem_drawing *drawing, cdem_fault *fault) {
  char *path = join(folder, "", name, ending, "", fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_output *output;
  cdem_status status = cdem_output_open(path, &output, fault);
  free(path);
  CDEM_TRY(status);
  cdem_c_locale locale = cdem_c_locale_enter();
  if (strcmp(ending, "dat") == 0)
    drawing->put_data(cdem_output_stream(output), drawing->picture);
  else
    drawing->put_script(cdem_output_stream(output), name, drawing->picture);
  cdem_c_locale_leave(locale);
  return cdem_output_commit(&output, fault);
}

/* Reads what a child says until it closes; keeps the first line that is not empty. */
static void listen(int descriptor, char complaint[COMPLAINT]) {
  char text[4096];
  size_t used = 0;
  ssize_t got;
  while ((got = read(descriptor, text + used, sizeof text - 1 - used)) > 0 ||
         (got < 0 && errno == EINTR)) {
    used += got > 0 ? (size_t)got : 0;
    if (used == sizeof text - 1)
      used = sizeof text / 2; /* the rest is only drained */
  }
  text[used] = '\0';
  const char *begin = text + strspn(text, " \t\r\n^");
  size_t length = strcspn(begin, "\r\n");
  snprintf(complaint, COMPLAINT, "%.*s", (int)length, begin);
}

/* Runs gnuplot in `folder`; 0, or an errno when it could not be started, or -1 when it failed. */
static int run_gnuplot(const char *folder, char *const arguments[], char complaint[COMPLAINT]) {
  int tube[2];
  complaint[0] = '\0';
  if (pipe2(tube, O_CLOEXEC) != 0)
    return errno;
  posix_spawn_file_actions_t actions;
  pid_t child;
  int error = posix_spawn_file_actions_init(&actions);
  if (error == 0) {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, tube[1], STDERR_FILENO);
    error = posix_spawn_file_actions_addchdir_np(&actions, folder);
    if (error == 0)
      error = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
  }
  close(tube[1]);
  if (error == 0) {
    int result = 0;
    listen(tube[0], complaint);
    while (waitpid(child, &result, 0) < 0 && errno == EINTR)
      ;
    error = WIFEXITED(result) && WEXITSTATUS(result) == 0 ? 0 : -1;
  }
  close(tube[0]);
  return error;
}

/* png='NAME'; with quotes doubled, as gnuplot wants them. */
static size_t put_assignment(char *at, size_t room, const char *variable, const char *name) {
  size_t used = (size_t)snprintf(at, room, "%s='", variable);
  for (; *name != '\0' && used + 4 < room; name++) {
    if (*name == '\'')
      at[used++] = '\'';
    at[used++] = *name;
  }
  return used + (size_t)snprintf(at + used, room - used, "';");
}

/* Draws into the temporary files `drawn` (names within the folder). */
static cdem_status draw(const char *folder, const char *name, char *const drawn[KINDS],
                        cdem_fault *fault) {
  char complaint[COMPLAINT];
  char *script = join("", "", name, "gp", "", fault);
  size_t room = 64 + 2 * (strlen(drawn[0]) + strlen(drawn[1]));
  char *variables = script != NULL ? cdem_allocate((int64_t)room, 1, fault) : NULL;
  if (variables == NULL) {
    free(script);
    return CDEM_MEMORY;
  }
  size_t used = put_assignment(variables, room, "png", drawn[0]);
  put_assignment(variables + used, room - used, "svg", drawn[1]);
  /* gnuplot takes a leading '-' of a file for an option; "./" keeps it a name. */
  char *file = join(".", "", name, "gp", "", fault);
  int error = -1;
  if (file != NULL) {
    char program[] = "gnuplot", defaults[] = "-d", execute[] = "-e";
    char *const arguments[] = {program, defaults, execute, variables, file, NULL};
    error = run_gnuplot(folder[0] != '\0' ? folder : ".", arguments, complaint);
  }
  cdem_status status = file == NULL ? CDEM_MEMORY : CDEM_OK;
  if (status == CDEM_OK && error == ENOENT)
    status = cdem_fail(fault, CDEM_FILE,
                       "cannot draw '%s': gnuplot was not found; install the package gnuplot-nox "
                       "(the data and the script %s are kept)",
                       name, script);
  else if (status == CDEM_OK && error > 0)
    status = cdem_fail(fault, CDEM_FILE, "cannot draw '%s': gnuplot was not started: %s", name,
                       strerror(error));
  else if (status == CDEM_OK && error < 0)
    status = cdem_fail(fault, CDEM_FILE,
                       "cannot draw '%s': gnuplot failed: %s; run gnuplot %s in '%s' to see more",
                       name, complaint[0] != '\0' ? complaint : "no message", script, folder);
  free(script);
  free(variables);
  free(file);
  return status;
}

/* gnuplot takes no notice when a disk is full, and ends well. */
static bool is_whole(const char *path, const char *tail) {
  char end[12];
  FILE *file = fopen(path, "rbe");
  if (file == NULL)
    return false;
  bool whole = fseek(file, -(long)sizeof end, SEEK_END) == 0 &&
               fread(end, 1, sizeof end, file) == sizeof end &&
               memmem(end, sizeof end, tail, strlen(tail)) != NULL;
  fclose(file);
  return whole;
}

/* Renames a drawn file into place. */
static cdem_status publish(const char *drawn, const char *target, const char *tail,
                           cdem_fault *fault) {
  if (!is_whole(drawn, tail))
    return cdem_write_fail(target, ENOSPC, fault);
  if (rename(drawn, target) != 0)
    return cdem_write_fail(target, errno, fault);
  return CDEM_OK;
}

static cdem_status draw_and_publish(const char *folder, const char *name, const char *suffix,
                                    cdem_fault *fault) {
  char *drawn[KINDS] = {NULL}, *path[KINDS] = {NULL}, *target[KINDS] = {NULL};
  cdem_status status = CDEM_OK;
  for (int k = 0; k < KINDS && status == CDEM_OK; k++) {
    drawn[k] = join("", ".", name, endings[k], suffix, fault);
    path[k] = join(folder, ".", name, endings[k], suffix, fault);
    target[k] = join(folder, "", name, endings[k], "", fault);
    if (drawn[k] == NULL || path[k] == NULL || target[k] == NULL)
      status = CDEM_MEMORY;
  }
  if (status == CDEM_OK)
    status = draw(folder, name, drawn, fault);
  for (int k = 0; k < KINDS && status == CDEM_OK; k++)
    status = publish(path[k], target[k], tails[k], fault);
  for (int k = 0; k < KINDS; k++) {
    if (path[k] != NULL)
      unlink(path[k]);
    free(drawn[k]);
    free(path[k]);
    free(target[k]);
  }
  return status;
}

cdem_status cdem_gnuplot_draw(const char *folder, const char *name, const cdem_drawing *drawing,
                              cdem_fault *fault) {
  CDEM_REQUIRE(strpbrk(name, "/\n") == NULL && name[0] != '\0', fault, CDEM_USAGE,
               "'%s' cannot be the name of a figure; leave out folders and line breaks", name);
  char suffix[32];
  snprintf(suffix, sizeof suffix, ".part-%ld", (long)getpid());
  CDEM_TRY(cdem_make_folder(folder, fault));
  CDEM_TRY(put_file(folder, name, "dat", drawing, fault));
  CDEM_TRY(put_file(folder, name, "gp", drawing, fault));
  return draw_and_publish(folder, name, suffix, fault);
}

/* ---- pieces of scripts ---- */

void cdem_gnuplot_text(FILE *stream, const char *text) {
  fputc('\'', stream);
  for (const char *c = text != NULL ? text : ""; *c != '\0'; c++) {
    if (*c == '\'')
      fputc('\'', stream);
    fputc((unsigned char)*c < ' ' ? ' ' : *c, stream);
  }
  fputc('\'', stream);
}

void cdem_gnuplot_number(FILE *stream, double value) {
  char text[CDEM_REAL_WIDTH];
  fwrite(text, 1, (size_t)(cdem_put_real(text, value) - text), stream);
}

void cdem_gnuplot_range(FILE *stream, const char *axis, double low, double high) {
  fprintf(stream, "set %srange [", axis);
  cdem_gnuplot_number(stream, low);
  fputs(":", stream);
  cdem_gnuplot_number(stream, high);
  fputs("]\n", stream);
}

int cdem_gnuplot_power(double low, double high) {
  double size = fmax(fabs(low), fabs(high));
  bool plain = !(size > 0.0) || (size < 1e5 && size >= 1e-2);
  return plain ? 0 : 3 * (int)floor(log10(size) / 3.0);
}

void cdem_gnuplot_power_text(int power, char text[32]) {
  text[0] = '\0';
  if (power != 0)
    snprintf(text, 32, "×10^{%s%d}", power < 0 ? "−" : "", abs(power));
}

void cdem_gnuplot_column(FILE *stream, int column, int power) {
  if (power == 0)
    fprintf(stream, "%d", column);
  else
    fprintf(stream, "($%d*1e%d)", column, -power);
}

int cdem_gnuplot_letters(const char *text) {
  int count = 0;
  for (const char *c = text; *c != '\0'; c++)
    count += ((unsigned char)*c & 0xc0) != 0x80 && strchr("_^{}", *c) == NULL;
  return count;
}

void cdem_gnuplot_begin(FILE *stream, const char *name, double width, double height,
                        const char *more) {
  fputs(CDEM_GNUPLOT_FIRST_LINE "\n", stream);
  const char *const kind[] = {"png", "svg", "data"}, *const ending[] = {".png", ".svg", ".dat"};
  for (int i = 0; i < 3; i++) {
    fprintf(stream, "if (!exists('%s')) %s = ", kind[i], kind[i]);
    cdem_gnuplot_text(stream, name);
    fprintf(stream, ".'%s'\n", ending[i]);
  }
  fprintf(stream,
          "set encoding utf8\nset minussign\n"
          "do for [kind in 'png svg'] {\n"
          "if (kind eq 'png') {\n"
          "  set terminal pngcairo enhanced size %d,%d font '" CDEM_GNUPLOT_FONT
          ",%g' fontscale 2 linewidth 2 dashlength 0.8 background rgb 'white' %s\n"
          "  set output png\n} else {\n"
          "  set terminal svg enhanced size %d,%d font '" CDEM_GNUPLOT_FONT
          ",%g' fontscale 1.3333 linewidth 1 dashlength 0.8 background rgb 'white' %s\n"
          "  set output svg\n}\n",
          (int)(2 * width), (int)(2 * height), CDEM_GNUPLOT_FONT_SIZE, more, (int)width,
          (int)height, CDEM_GNUPLOT_FONT_SIZE, more);
}

void cdem_gnuplot_end(FILE *stream) {
  fputs("set output\nreset\n}\n", stream);
}
