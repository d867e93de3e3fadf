/* A locale with a decimal comma, for tests of programs that do not care for it. */
#ifndef CDEM_TESTS_SUPPORT_COMMA_H
#define CDEM_TESTS_SUPPORT_COMMA_H

#include "support/scratch.h"

#include <locale.h>
#include <stdbool.h>

/* Switches the process to a locale with a decimal comma: an installed one, or one made by localedef
 * in the scratch folder. False when there is none to be had. */
static inline bool use_comma_locale(void) {
  static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"};
  bool found = false;
  for (int i = 0; i < 3 && !found; i++)
    found = setlocale(LC_ALL, names[i]) != NULL;
  char command[160];
  snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s/de_DE.UTF-8' >/dev/null 2>&1",
           scratch);
  if (!found && system(command) >= 0) {
    setenv("LOCPATH", scratch, 1);
    found = setlocale(LC_ALL, "de_DE.UTF-8") != NULL;
  }
  char half[8];
  snprintf(half, sizeof half, "%.1f", 0.5);
  return found && strcmp(half, "0,5") == 0;
}

#endif
