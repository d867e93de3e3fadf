/* cdem verify [GROUP...]: runs the verification suite, prints each number beside its source. */
#include "base/suggest.h"
#include "command.h"
#include "verify/verify.h"
#include "verify_page.h"

#include <stdlib.h>
#include <string.h>

enum { OPTION_JSON = 256, OPTION_LIST, OPTION_SLOW, OPTION_MARKDOWN, MOST_GROUPS = 64 };

static const struct argp_option option_table[] = {
    {"json", OPTION_JSON, NULL, 0, "print the results as a JSON array", 0},
    {"list", OPTION_LIST, NULL, 0, "list groups and checks, run nothing", 0},
    {"markdown", OPTION_MARKDOWN, NULL, 0,
     "print the page docs/reference/verification.md; with --list without values", 0},
    {"slow", OPTION_SLOW, NULL, 0, "run the long checks too", 0},
    {"quiet", 'q', NULL, 0, "no talk and no progress on stderr", 0},
    {0},
};

typedef struct {
  bool json, list, markdown, slow;
  int groups;
  const char *group[MOST_GROUPS];
} settings;

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  switch (key) {
  case OPTION_JSON:
    s->json = true;
    return 0;
  case OPTION_LIST:
    s->list = true;
    return 0;
  case OPTION_MARKDOWN:
    s->markdown = true;
    return 0;
  case OPTION_SLOW:
    s->slow = true;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (s->groups == MOST_GROUPS)
      command_usage("%d groups at most", MOST_GROUPS);
    s->group[s->groups++] = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static bool is_chosen(const settings *s, const char *name) {
  for (int i = 0; i < s->groups; i++)
    if (strcmp(s->group[i], name) == 0)
      return true;
  return s->groups == 0;
}

static void check_group(const char *name) {
  const char *names[MOST_GROUPS];
  int count = 0;
  if (cdem_verify_group_find(name) != NULL)
    return;
  for (; count < MOST_GROUPS && cdem_verify_group_at(count) != NULL; count++)
    names[count] = cdem_verify_group_at(count)->name;
  const char *nearest = cdem_suggest(name, names, count);
  if (nearest != NULL)
    command_usage("there is no group '%s'; did you mean '%s'?", name, nearest);
  command_usage("there is no group '%s'; `cdem verify --list` shows them", name);
}

static void list_checks(const settings *s) {
  const cdem_verify_group *group;
  for (int g = 0; (group = cdem_verify_group_at(g)) != NULL; g++) {
    if (!is_chosen(s, group->name))
      continue;
    printf("%s: %s (%d checks)\n", group->name, group->summary, group->checks);
    for (int i = 0; i < group->checks; i++)
      printf("  %s%s [%s] %s\n", group->check[i].name, group->check[i].slow ? " (slow)" : "",
             group->check[i].source, cdem_check_kind_find(group->check[i].kind)->text);
  }
}

/* The longest name, so that the columns stand under each other. */
static int widest_name(const cdem_check_list *list) {
  int widest = 0;
  for (int64_t i = 0; i < list->checks; i++) {
    int length = (int)strlen(list->check[i].name);
    widest = length > widest ? length : widest;
  }
  return widest;
}

static void print_table(const cdem_check_list *list) {
  const char *group = "";
  int width = widest_name(list);
  for (int64_t i = 0; i < list->checks; i++) {
    const cdem_check *check = &list->check[i];
    if (strcmp(group, check->group) != 0) {
      group = check->group;
      printf("%s\n      %-*s %22s %15s %9s  %s\n", group, width, "check", "value", "reference",
             "within", "source");
    }
    printf("%s  %-*s %22.15g %15.10g %9.1e  %s\n", cdem_check_passes(check) ? "pass" : "FAIL",
           width, check->name, check->value, check->reference, check->tolerance, check->source);
  }
}

typedef struct {
  int skipped;
} tally;

static void tell_skipped(void *context, const char *group, const char *name, const char *reason) {
  ((tally *)context)->skipped++;
  command_warn("%s, %s: could not run: %s", group, name, reason);
}

static int verify(const settings *s) {
  tally counted = {0};
  cdem_fault fault = {0};
  cdem_check_list list = {0};
  const cdem_verify_options options = {.slow = s->slow,
                                       .progress = command_progress(),
                                       .context = &counted,
                                       .skipped = tell_skipped};
  command_catch_interrupt();
  cdem_status status = cdem_verify_run(s->group, s->groups, &options, &list, &fault);
  command_progress_end();
  int code = 0;
  if (status == CDEM_OK && s->json)
    status = cdem_write_checks_json(stdout, &list, &fault);
  else if (status == CDEM_OK && s->markdown)
    verify_print_page(&list);
  else if (status == CDEM_OK)
    print_table(&list);
  if (status != CDEM_OK) {
    code = command_fail(&fault);
  } else {
    int64_t failed = 0;
    for (int64_t i = 0; i < list.checks; i++)
      failed += !cdem_check_passes(&list.check[i]);
    fflush(stdout);
    command_say("%lld checks: %lld passed, %lld failed, %d could not run", (long long)list.checks,
                (long long)(list.checks - failed), (long long)failed, counted.skipped);
    code = failed > 0 ? cdem_status_exit_code(CDEM_CHECK) : 0;
  }
  cdem_check_list_release(&list);
  return code;
}

int cmd_verify(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "[GROUP...]",
      "Every claim of the program as a number beside its source.\v"
      "Exit code 1 when a check fails. A check that could not run is named on stderr and is not "
      "among the results.",
      NULL,
      NULL,
      NULL};
  settings s = {0};
  command_parse(&argp, argc, argv, &s);
  for (int i = 0; i < s.groups; i++)
    check_group(s.group[i]);
  if (s.markdown && (s.json || s.groups > 0))
    command_usage("--markdown prints the page of all groups; leave %s out",
                  s.json ? "--json" : s.group[0]);
  if (s.list) {
    if (s.markdown)
      verify_print_page(&(cdem_check_list){0});
    else
      list_checks(&s);
    return 0;
  }
  return verify(&s);
}
