/* cdem verify --markdown: what a check is, how many there are of each kind, all of them in tables,
 * and what is held elsewhere. Everything but the values follows from the tables of room verify. */
#include "verify_page.h"

#include "verify/verify.h"

#include <stdio.h>
#include <string.h>

static const char head[] =
    "# Verification\n"
    "\n"
    "Made by `cdem verify --slow --markdown`; the test `cli.verification` compares all but the "
    "values.\n"
    "\n"
    "A check is one number that the program measures, beside its reference, how far it may be off, "
    "and where the reference comes from.\n"
    "`cdem verify` runs all but the slow ones, `cdem verify --slow` these, too; `cdem verify "
    "GROUP...` some groups.\n"
    "It ends with exit code 1 if one fails, and a check that could not run is named, never "
    "passed.\n"
    "A bound is a check with reference 0.\n"
    "\n"
    "## Kinds of references\n"
    "\n";

static const char held[] = "\n"
                           "## Held by tests\n"
                           "\n"
                           "Claims that no check measures, because another program has to run, or "
                           "many outcomes are asked at once.\n"
                           "The name is that of the test: `ctest --test-dir build/release -R "
                           "NAME`.\n"
                           "\n"
                           "| test | claim | against |\n"
                           "|---|---|---|\n";

static const char shown[] =
    "\n"
    "## Shown on pages only\n"
    "\n"
    "Claims that no command repeats within minutes; the pages say which commands made them.\n"
    "\n"
    "| claim | against |\n"
    "|---|---|\n";

/* A cell: bars would end it, and names of variables are no emphasis. */
static void put_cell(const char *text) {
  for (; *text != '\0'; text++) {
    if (strchr("|*_<", *text) != NULL)
      putchar('\\');
    putchar(*text);
  }
}

static void print_kinds(void) {
  int all = 0, all_slow = 0, outside = 0;
  puts("| kind | checks | of them slow | the reference is |\n|---|---|---|---|");
  for (int kind = CDEM_CHECK_UNSTATED + 1; kind < CDEM_CHECK_KINDS; kind++) {
    const cdem_check_kind_words *words = cdem_check_kind_find((cdem_check_kind)kind);
    int count = 0, slow = 0;
    const cdem_verify_group *group;
    for (int g = 0; (group = cdem_verify_group_at(g)) != NULL; g++)
      for (int i = 0; i < group->checks; i++)
        if ((int)group->check[i].kind == kind) {
          count++;
          slow += group->check[i].slow;
        }
    printf("| %s | %d | %d | %s |\n", words->text, count, slow, words->meaning);
    all += count;
    all_slow += slow;
    outside += words->outside ? count : 0;
  }
  printf("| together | %d | %d | |\n", all, all_slow);
  printf("\nOf the first three kinds, whose references come from outside of the program, there are "
         "%d.\n",
         outside);
}

/* NULL: not measured. */
static const cdem_check *find(const cdem_check_list *list, const char *group, const char *name) {
  for (int64_t i = 0; i < list->checks; i++)
    if (strcmp(list->check[i].group, group) == 0 && strcmp(list->check[i].name, name) == 0)
      return &list->check[i];
  return NULL;
}

static void print_group(const cdem_verify_group *group, const cdem_check_list *list) {
  printf("\n## Group %s\n\n%c%s.\n", group->name, group->summary[0] & ~0x20, group->summary + 1);
  puts("\n| check | value | reference | within | kind | source |\n|---|---|---|---|---|---|");
  for (int i = 0; i < group->checks; i++) {
    const cdem_verification *row = &group->check[i];
    const cdem_check *measured = find(list, group->name, row->name);
    printf("| ");
    put_cell(row->name);
    printf("%s | ", row->slow ? " (slow)" : "");
    if (measured != NULL)
      printf("%.6g%s", measured->value, cdem_check_passes(measured) ? "" : " **fails**");
    else
      printf("–");
    printf(" | %.10g | %.2g | %s | ", row->reference, row->tolerance,
           cdem_check_kind_find(row->kind)->text);
    put_cell(row->source);
    puts(" |");
  }
}

/* Tests, or the claims that none holds. */
static void print_elsewhere(bool tests) {
  const cdem_verify_elsewhere *row;
  for (int i = 0; (row = cdem_verify_elsewhere_at(i)) != NULL; i++) {
    if ((row->test != NULL) != tests)
      continue;
    printf("| ");
    if (tests)
      printf("`%s` | ", row->test);
    put_cell(row->claim);
    printf(" | ");
    put_cell(row->against);
    puts(" |");
  }
}

void verify_print_page(const cdem_check_list *list) {
  const cdem_verify_group *group;
  fputs(head, stdout);
  print_kinds();
  for (int g = 0; (group = cdem_verify_group_at(g)) != NULL; g++)
    print_group(group, list);
  fputs(held, stdout);
  print_elsewhere(true);
  fputs(shown, stdout);
  print_elsewhere(false);
}
