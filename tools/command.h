/* What every subcommand shares: errors in one grammar, options through argp, progress and Ctrl-C,
 * numbers with units. Results go to stdout or files; everything else goes to stderr. */
#ifndef CDEM_TOOLS_COMMAND_H
#define CDEM_TOOLS_COMMAND_H

#include "base/base.h"
#include "io/io.h"

#include <argp.h>

typedef struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv); /* argv[0] is "cdem NAME"; returns the exit code */
} command;

/* All commands, ended by a name of NULL. */
extern const command commands[];

#define X(name, summary) int cmd_##name(int argc, char **argv);
#include "commands.def"
#undef X

/* Parses with argp. An option that does not exist ends the program with exit code 2 and the nearest
 * name;
 * --help goes to stdout with exit code 0. `input` reaches the parser as state->input. */
void command_parse(const struct argp *argp, int argc, char **argv, void *input);

/* Wrong usage: "error: ..." and where the help is, exit code 2. Does not return. */
__attribute__((format(printf, 1, 2), noreturn)) void command_usage(const char *format, ...);

/* Prints "error: message" of a failed call; returns its exit code. */
int command_fail(const cdem_fault *fault);

/* "warning: ..." and plain talk, both to stderr; talk is silent with quiet. */
__attribute__((format(printf, 1, 2))) void command_warn(const char *format, ...);
__attribute__((format(printf, 1, 2))) void command_say(const char *format, ...);
extern bool command_quiet; /* --quiet: no talk, no progress */

/* Warnings of readers, printed by command_warn. */
cdem_warnings command_warnings(void);

/* Progress on stderr (a bar with rate and remaining time on a terminal, nothing otherwise), which
 * stops work at Ctrl-C. command_catch_interrupt makes Ctrl-C a wish to stop; before it, Ctrl-C ends
 * the program at once. */
const cdem_progress *command_progress(void);
void command_catch_interrupt(void);
void command_progress_end(void); /* ends the bar's line */

/* While a library of others reads a file: if it ends or crashes the program, that becomes an error
 * naming the file and exit code 3, not silence. NULL: over. */
void command_guard(const char *path);

/* Option values; wrong ones end the program through command_usage (not a number) or as bad input
 * (exit 3: wrong unit). `option` is the name for the message: "-E". */
double command_quantity(const char *option, const char *text, cdem_dimension dimension);
double command_number(const char *option, const char *text);
long command_integer(const char *option, const char *text, long least, long most);

/* The texts of --set KEY=VALUE, in their order. */
enum { COMMAND_MOST_OVERRIDES = 64 };
typedef struct {
  int count;
  const char *text[COMMAND_MOST_OVERRIDES];
} command_overrides;
void command_override(command_overrides *overrides, const char *text);

/* Flushes stdout; an error there (full disk, closed pipe) turns success into exit code 6. */
int command_finish(int exit_code);
/* For atexit: the same where argp ends the program, after --help. */
void command_finish_others(void);

#endif
