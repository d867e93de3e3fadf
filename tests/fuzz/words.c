/* The dictionary of a target for libFuzzer, on stdout: words FILE... takes the text constants of
 * sources, where the readers of formats have their keywords; words --schema takes keys, choices and
 * examples from the table of room cases. */
#include "cases/schema.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 40 };

static void put(const char *word, size_t length) {
  bool plain = length > 1 && length <= LONGEST;
  for (size_t i = 0; i < length && plain; i++)
    plain = isprint((unsigned char)word[i]) && word[i] != '"' && word[i] != '\\';
  if (plain)
    printf("\"%.*s\"\n", (int)length, word);
}

static void visit(void *context, const char *path, const cdem_case_key *key) {
  (void)context;
  (void)path;
  char colon[LONGEST + 4];
  snprintf(colon, sizeof colon, "%s: ", key->key);
  put(colon, strlen(colon));
  for (int i = 0; key->choice != NULL && key->choice[i] != NULL; i++)
    put(key->choice[i], strlen(key->choice[i]));
  if (key->example != NULL)
    put(key->example, strlen(key->example));
}

/* Constants on one line; formats of messages are longer than a word or hold a percent sign. */
static int scan(const char *path) {
  char line[1024];
  FILE *file = fopen(path, "r");
  if (file == NULL)
    return 1;
  while (fgets(line, sizeof line, file) != NULL)
    for (char *from = strchr(line, '"'), *to; from != NULL; from = strchr(to + 1, '"')) {
      to = strchr(from + 1, '"');
      if (to == NULL)
        break;
      if (memchr(from, '%', (size_t)(to - from)) == NULL && strstr(line, "#include") == NULL)
        put(from + 1, (size_t)(to - from - 1));
    }
  fclose(file);
  return 0;
}

int main(int count, char **argument) {
  int failed = 0;
  printf("# words of libFuzzer\n"); /* an empty file is no dictionary */
  for (int i = 1; i < count; i++)
    if (strcmp(argument[i], "--schema") == 0)
      cdem_case_walk(visit, NULL);
    else
      failed |= scan(argument[i]);
  return failed;
}
