#include "verify/verify.h"

#include "base/suggest.h"

#include <stdio.h>
#include <string.h>

#define X(name) extern const cdem_verify_group cdem_verify_##name;
#include "verify/verify.def"
#undef X

static const cdem_verify_group *const groups_known[] = {
#define X(name) &cdem_verify_##name,
#include "verify/verify.def"
#undef X
};
enum { GROUPS = sizeof groups_known / sizeof groups_known[0] };

const cdem_verify_group *cdem_verify_group_at(int index) {
  return index >= 0 && index < GROUPS ? groups_known[index] : NULL;
}

const cdem_verify_group *cdem_verify_group_find(const char *name) {
  for (int i = 0; i < GROUPS; i++)
    if (strcmp(groups_known[i]->name, name) == 0)
      return groups_known[i];
  return NULL;
}

static cdem_status unknown_group(const char *name, cdem_fault *fault) {
  const char *names[GROUPS];
  char known[256] = "";
  for (int i = 0; i < GROUPS; i++) {
    names[i] = groups_known[i]->name;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i > 0 ? ", " : "", names[i]);
  }
  const char *nearest = cdem_suggest(name, names, GROUPS);
  if (nearest != NULL)
    return cdem_fail(fault, CDEM_USAGE, "there is no group '%s'; did you mean '%s'?", name,
                     nearest);
  return cdem_fail(fault, CDEM_USAGE, "there is no group '%s'; groups are %s", name, known);
}

static bool is_chosen(const cdem_verify_group *group, const char *const *groups, int count) {
  for (int i = 0; i < count; i++)
    if (strcmp(groups[i], group->name) == 0)
      return true;
  return count == 0;
}

/* Memory and a wish to stop end the run; every other failure leaves the check out. */
static cdem_status run_check(const cdem_verify_group *group, const cdem_verification *check,
                             const cdem_verify_options *options, cdem_check_list *list,
                             cdem_fault *fault) {
  cdem_fault own = {0};
  double value = 0.0;
  cdem_status status = check->measure(check->parameter, &value, &own);
  if (status == CDEM_MEMORY || status == CDEM_INTERRUPTED)
    return cdem_fail(fault, status, "%s: %s", check->name, own.message);
  if (status != CDEM_OK) {
    if (options->skipped != NULL)
      options->skipped(options->context, group->name, check->name,
                       own.message[0] != '\0' ? own.message : cdem_status_text(status));
    return CDEM_OK;
  }
  return cdem_check_add(list,
                        (cdem_check){.group = group->name,
                                     .name = check->name,
                                     .source = check->source,
                                     .reference = check->reference,
                                     .value = value,
                                     .tolerance = check->tolerance,
                                     .kind = check->kind},
                        fault);
}

static int64_t count_checks(const cdem_verify_group *group, const cdem_verify_options *options) {
  int64_t count = 0;
  for (int i = 0; i < group->checks; i++)
    count += options->slow || !group->check[i].slow;
  return count;
}

cdem_status cdem_verify_run_group(const cdem_verify_group *group,
                                  const cdem_verify_options *options, int64_t *done, int64_t total,
                                  cdem_check_list *list, cdem_fault *fault) {
  for (int i = 0; i < group->checks; i++) {
    const cdem_verification *check = &group->check[i];
    if (check->slow && !options->slow)
      continue;
    CDEM_TRY(cdem_progress_report(options->progress, "verifying", (*done)++, total, fault));
    CDEM_TRY(run_check(group, check, options, list, fault));
  }
  return CDEM_OK;
}

const cdem_verify_elsewhere *cdem_verify_elsewhere_at(int index) {
  static const cdem_verify_elsewhere elsewhere[] = {
#define X(test, claim, against) {test, claim, against},
#include "verify/elsewhere.def"
#undef X
  };
  const int count = sizeof elsewhere / sizeof elsewhere[0];
  return index >= 0 && index < count ? &elsewhere[index] : NULL;
}

cdem_status cdem_verify_run(const char *const *groups, int count,
                            const cdem_verify_options *options, cdem_check_list *list,
                            cdem_fault *fault) {
  int64_t done = 0, total = 0;
  for (int i = 0; i < count; i++)
    if (cdem_verify_group_find(groups[i]) == NULL)
      return unknown_group(groups[i], fault);
  for (int g = 0; g < GROUPS; g++)
    if (is_chosen(groups_known[g], groups, count))
      total += count_checks(groups_known[g], options);
  for (int g = 0; g < GROUPS; g++)
    if (is_chosen(groups_known[g], groups, count))
      CDEM_TRY(cdem_verify_run_group(groups_known[g], options, &done, total, list, fault));
  return CDEM_OK;
}
