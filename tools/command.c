#include "command.h"

#include "base/suggest.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

bool command_quiet = false;

static const char *invocation = "cdem"; /* "cdem springs", for the hint where help is */
static volatile sig_atomic_t interrupted = 0;

static void say(const char *kind, const char *format, va_list arguments) {
  command_progress_end();
  fprintf(stderr, "%s", kind);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
}

void command_usage(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  say("error: ", format, arguments);
  va_end(arguments);
  fprintf(stderr, "see `%s --help`\n", invocation);
  exit(cdem_status_exit_code(CDEM_USAGE));
}

void command_override(command_overrides *overrides, const char *text) {
  if (overrides->count == COMMAND_MOST_OVERRIDES)
    command_usage("--set: %d values at most", COMMAND_MOST_OVERRIDES);
  if (strchr(text, '=') == NULL)
    command_usage("--set %s: KEY=VALUE is wanted", text);
  overrides->text[overrides->count++] = text;
}

void command_warn(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  say("warning: ", format, arguments);
  va_end(arguments);
}

void command_say(const char *format, ...) {
  if (command_quiet)
    return;
  va_list arguments;
  va_start(arguments, format);
  say("", format, arguments);
  va_end(arguments);
}

int command_fail(const cdem_fault *fault) {
  command_progress_end();
  fprintf(stderr, "error: %s\n",
          fault->message[0] != '\0' ? fault->message : cdem_status_text(fault->status));
  return cdem_status_exit_code(fault->status);
}

static void warn_of_reader(void *context, const char *message) {
  (void)context;
  command_warn("%s", message);
}

cdem_warnings command_warnings(void) {
  return (cdem_warnings){.warn = warn_of_reader};
}

/* ---- options ---- */

/* The option called by argument `word` ("--nam" or "--name=x") exists, in full or as a prefix. */
static bool option_exists(const struct argp_option *options, const char *word, size_t length) {
  for (const struct argp_option *o = options; o->name != NULL || o->key != 0 || o->doc != NULL; o++)
    if (o->name != NULL && strncmp(o->name, word, length) == 0)
      return true;
  return strncmp("help", word, length) == 0 || strncmp("usage", word, length) == 0;
}

static void check_long_option(const struct argp_option *options, const char *word) {
  size_t length = strcspn(word, "=");
  if (length == 0 || option_exists(options, word, length))
    return;
  const char *names[64];
  int count = 0;
  for (const struct argp_option *o = options;
       (o->name != NULL || o->key != 0 || o->doc != NULL) && count < 64; o++)
    if (o->name != NULL)
      names[count++] = o->name;
  char typed[64];
  snprintf(typed, sizeof typed, "%.*s", (int)length, word);
  const char *nearest = cdem_suggest(typed, names, count);
  if (nearest != NULL)
    command_usage("there is no option '--%s'; did you mean '--%s'?", typed, nearest);
  command_usage("there is no option '--%s'", typed);
}

void command_parse(const struct argp *argp, int argc, char **argv, void *input) {
  invocation = argv[0];
  argp_err_exit_status = cdem_status_exit_code(CDEM_USAGE);
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    if (strncmp(argv[i], "--", 2) == 0)
      check_long_option(argp->options, argv[i] + 2);
  if (argp_parse(argp, argc, argv, 0, NULL, input) != 0)
    command_usage("the command line cannot be understood");
}

double command_quantity(const char *option, const char *text, cdem_dimension dimension) {
  cdem_fault fault = {0};
  double value = 0.0;
  if (cdem_parse_quantity(text, dimension, &value, &fault) != CDEM_OK) {
    cdem_fault_prefix(&fault, "%s %s", option, text);
    exit(command_fail(&fault));
  }
  return value;
}

double command_number(const char *option, const char *text) {
  return command_quantity(option, text, CDEM_DIMENSIONLESS);
}

long command_integer(const char *option, const char *text, long least, long most) {
  char *end;
  errno = 0;
  long value = strtol(text, &end, 10);
  if (errno != 0 || end == text || *end != '\0' || value < least || value > most)
    command_usage("%s %s: a whole number from %ld to %ld is wanted", option, text, least, most);
  return value;
}

/* ---- progress ---- */

static struct {
  bool shown;
  char what[64];
  struct timespec started, last;
} bar;

static double seconds_between(struct timespec from, struct timespec to) {
  return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

static void on_interrupt(int signal_number) {
  (void)signal_number;
  interrupted = 1;
}

void command_catch_interrupt(void) {
  /* The second Ctrl-C ends the program at once. */
  struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

static void draw_bar(const char *what, int64_t done, int64_t total, struct timespec now) {
  double elapsed = seconds_between(bar.started, now),
         rate = elapsed > 0.0 ? (double)done / elapsed : 0.0;
  if (total > 0) {
    int filled = (int)(30.0 * (double)done / (double)total);
    char line[32];
    for (int i = 0; i < 30; i++)
      line[i] = i < filled ? '#' : '.';
    line[30] = '\0';
    fprintf(stderr, "\r%s [%s] %3d %%  %.3g/s  %.0f s left \033[K", what, line,
            (int)(100 * done / total), rate, rate > 0.0 ? (double)(total - done) / rate : 0.0);
  } else {
    fprintf(stderr, "\r%s  %lld  %.3g/s \033[K", what, (long long)done, rate);
  }
  fflush(stderr);
  bar.shown = true;
}

static bool report(void *context, const char *what, int64_t done, int64_t total) {
  (void)context;
  if (!command_quiet && isatty(STDERR_FILENO)) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (strncmp(bar.what, what, sizeof bar.what - 1) != 0) {
      command_progress_end();
      snprintf(bar.what, sizeof bar.what, "%s", what);
      bar.started = bar.last = now;
    }
    if (seconds_between(bar.last, now) > 0.2) {
      draw_bar(what, done, total, now);
      bar.last = now;
    }
  }
  return !interrupted;
}

const cdem_progress *command_progress(void) {
  static const cdem_progress progress = {.report = report};
  return &progress;
}

void command_progress_end(void) {
  if (bar.shown)
    fprintf(stderr, "\r\033[K");
  bar.shown = false;
}

/* ---- guard ---- */

static const char *guarded; /* the file being read */

/* Only what is safe in a signal handler. */
static void say_guarded(const char *what) {
  const char *const part[] = {"error: cannot read '", guarded, "': ", what, "\n"};
  for (int i = 0; i < 5; i++)
    if (write(STDERR_FILENO, part[i], strlen(part[i])) < 0)
      break;
  _exit(cdem_status_exit_code(CDEM_INPUT));
}

static void on_crash(int signal_number) {
  (void)signal_number;
  say_guarded(
      "gmsh crashed on it; repair the geometry, or mesh it with gmsh and give the .msh file");
}

static void on_exit_of_others(void) {
  if (guarded != NULL)
    say_guarded("gmsh ended the program on it; take `Exit` out of the file");
}

void command_guard(const char *path) {
  static bool registered = false;
  if (!registered)
    registered = atexit(on_exit_of_others) == 0;
  guarded = path;
  const int crash[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS};
  struct sigaction action = {.sa_flags = (int)SA_RESETHAND};
  action.sa_handler = path != NULL ? on_crash : SIG_DFL;
  for (int i = 0; i < 4; i++)
    sigaction(crash[i], &action, NULL);
}

static bool finished;

static bool printed(void) {
  if (fflush(stdout) == 0 && ferror(stdout) == 0)
    return true;
  fprintf(stderr, "error: cannot write to standard output: %s\n", strerror(errno));
  return false;
}

int command_finish(int exit_code) {
  command_progress_end();
  finished = true;
  return exit_code != 0 || printed() ? exit_code : cdem_status_exit_code(CDEM_FILE);
}

void command_finish_others(void) {
  if (!finished && !printed())
    _exit(cdem_status_exit_code(CDEM_FILE));
}
