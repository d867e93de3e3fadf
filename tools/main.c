/* cdem COMMAND [options] [operands]: finds the command and hands over. */
#include "base/suggest.h"
#include "command.h"
#include "version.h"

#include <gsl/gsl_errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

const command commands[] = {
#define X(name, summary) {#name, summary, cmd_##name},
#include "commands.def"
#undef X
    {NULL, NULL, NULL},
};

static int unknown(const char *name) {
  const char *names[sizeof commands / sizeof commands[0]];
  int count = 0;
  for (; commands[count].name != NULL; count++)
    names[count] = commands[count].name;
  const char *nearest = cdem_suggest(name, names, count);
  if (nearest != NULL)
    command_usage("there is no command '%s'; did you mean '%s'?", name, nearest);
  command_usage("there is no command '%s'", name);
}

static _Noreturn void wanted(void) {
  static const char names[] =
#define X(name, summary) ", " #name
#include "commands.def"
#undef X
      ;
  command_usage("a command is wanted: %s", names + strlen(", "));
}

int main(int argc, char **argv) {
  gsl_set_error_handler_off(); /* GSL's default handler aborts */
  signal(SIGPIPE, SIG_IGN);    /* a closed pipe is an error message, not a silent death */
  signal(SIGXFSZ, SIG_IGN);    /* likewise a file-size limit */
  atexit(command_finish_others);
  if (argc < 2)
    wanted();
  if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
    version_print();
    return command_finish(0);
  }
  const char *name =
      strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ? "help" : argv[1];
  for (const command *c = commands; c->name != NULL; c++)
    if (strcmp(c->name, name) == 0) {
      char called[64];
      snprintf(called, sizeof called, "cdem %s", c->name);
      argv[1] = called;
      return command_finish(c->run(argc - 1, argv + 1));
    }
  return unknown(name);
}
