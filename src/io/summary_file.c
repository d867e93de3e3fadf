/* summary.json read back. JSON is YAML in flow style, so the reader of cases serves: places, carets
 * and the refusal of double keys come with it. Kept is what runs are compared by, and what a report
 * tells of a run. */
#include "io/run_files.h"
#include "io/text.h"
#include "io/yaml_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cdem_yaml_node *want(cdem_yaml *yaml, const cdem_yaml_node *map, const char *key,
                                  cdem_yaml_kind kind) {
  const cdem_yaml_node *found = cdem_yaml_find(yaml, map, key);
  if (found == NULL)
    cdem_yaml_error(yaml, map, "there is no '%s', which every summary of a run has", key);
  else if (found->kind != kind)
    cdem_yaml_error(yaml, found, "'%s' is %s, not %s", key, cdem_yaml_kind_name(found->kind),
                    cdem_yaml_kind_name(kind));
  return found != NULL && found->kind == kind ? found : NULL;
}

static bool is_null(const cdem_yaml_node *node) {
  return strcmp(node->text, "null") == 0;
}

static double number(cdem_yaml *yaml, const cdem_yaml_node *node) {
  if (node == NULL || node->kind != CDEM_YAML_SCALAR || is_null(node))
    return NAN;
  char *end;
  double value = cdem_get_real(node->text, &end);
  if (end != node->text && *end == '\0' && isfinite(value))
    return value;
  cdem_yaml_error(yaml, node, "'%.40s' is not a number", node->text);
  return NAN;
}

static cdem_status copy(const cdem_yaml_node *node, char **text, cdem_fault *fault) {
  if (node == NULL || node->kind != CDEM_YAML_SCALAR || is_null(node))
    return CDEM_OK;
  *text = cdem_copy_text(node->text, fault);
  return *text != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* How the case takes this result; an older summary may lack it. */
static cdem_status take_setting(cdem_yaml *yaml, const cdem_yaml_node *setting,
                                cdem_summary_result *result, cdem_fault *fault) {
  CDEM_TRY(copy(cdem_yaml_find(yaml, setting, "of"), &result->of, fault));
  CDEM_TRY(copy(cdem_yaml_find(yaml, setting, "take"), &result->take, fault));
  result->from = number(yaml, cdem_yaml_find(yaml, setting, "from"));
  result->to = number(yaml, cdem_yaml_find(yaml, setting, "to"));
  result->factor = number(yaml, cdem_yaml_find(yaml, setting, "factor"));
  return CDEM_OK;
}

static cdem_status take_result(cdem_yaml *yaml, const cdem_yaml_node *name,
                               const cdem_yaml_node *map, const cdem_yaml_node *settings,
                               cdem_summary_result *result, cdem_fault *fault) {
  const cdem_yaml_node *setting =
      settings != NULL ? cdem_yaml_find(yaml, settings, name->text) : NULL;
  result->from = result->to = result->factor = NAN;
  result->name = cdem_copy_text(name->text, fault);
  if (result->name == NULL)
    return CDEM_MEMORY;
  result->value = number(yaml, want(yaml, map, "value", CDEM_YAML_SCALAR));
  result->reference = number(yaml, cdem_yaml_find(yaml, map, "reference"));
  result->difference = number(yaml, cdem_yaml_find(yaml, map, "difference"));
  result->tolerance = number(yaml, cdem_yaml_find(yaml, map, "tolerance"));
  CDEM_TRY(copy(want(yaml, map, "unit", CDEM_YAML_SCALAR), &result->unit, fault));
  return setting != NULL ? take_setting(yaml, setting, result, fault) : CDEM_OK;
}

/* ---- facts and warnings ---- */

static cdem_status add_fact(const char *prefix, const char *name, const cdem_yaml_node *value,
                            cdem_summary_file *summary, cdem_fault *fault) {
  size_t room = strlen(prefix) + strlen(name) + 1;
  CDEM_TRY(cdem_grow(&summary->fact, &summary->fact_capacity, summary->facts + 1,
                     sizeof *summary->fact, fault));
  cdem_summary_fact *fact = &summary->fact[summary->facts++]; /* zeroed */
  fact->name = cdem_allocate((int64_t)room, 1, fault);
  if (fact->name == NULL)
    return CDEM_MEMORY;
  stpcpy(stpcpy(fact->name, prefix), name);
  CDEM_TRY(copy(value, &fact->text, fault));
  char *end = NULL;
  fact->number = fact->text != NULL ? cdem_get_real(fact->text, &end) : NAN;
  if (end == fact->text || (end != NULL && *end != '\0'))
    fact->number = NAN;
  return CDEM_OK;
}

static cdem_status take_facts(const cdem_yaml *yaml, const cdem_yaml_node *map, const char *prefix,
                              cdem_summary_file *summary, cdem_fault *fault) {
  CDEM_YAML_EACH(yaml, map, name, value)
  if (value->kind == CDEM_YAML_SCALAR)
    CDEM_TRY(add_fact(prefix, name->text, value, summary, fault));
  return CDEM_OK;
}

/* Older summaries have no warnings. */
static cdem_status take_warnings(const cdem_yaml *yaml, const cdem_yaml_node *list,
                                 cdem_summary_file *summary, cdem_fault *fault) {
  if (list == NULL || list->kind != CDEM_YAML_LIST)
    return CDEM_OK;
  CDEM_NEW(summary->warning, list->children, fault);
  for (const cdem_yaml_node *item = cdem_yaml_child(yaml, list); item != NULL;
       item = cdem_yaml_next(yaml, item))
    if (item->kind == CDEM_YAML_SCALAR)
      CDEM_TRY(copy(item, &summary->warning[summary->warnings++], fault));
  return CDEM_OK;
}

/* ---- the whole ---- */

static cdem_status take_all(cdem_yaml *yaml, cdem_summary_file *summary, cdem_fault *fault) {
  const cdem_yaml_node *root = cdem_yaml_root(yaml);
  if (root->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(yaml, root, "this is %s; a summary is a map", cdem_yaml_kind_name(root->kind));
    return cdem_yaml_finish(yaml, fault);
  }
  const cdem_yaml_node *wall = want(yaml, root, "wall_time", CDEM_YAML_SCALAR),
                       *results = want(yaml, root, "results", CDEM_YAML_MAP),
                       *settings = cdem_yaml_find(yaml, root, "settings");
  summary->wall_time = number(yaml, wall);
  CDEM_TRY(cdem_yaml_finish(yaml, fault));
  settings = settings != NULL ? cdem_yaml_find(yaml, settings, "results") : NULL;
  CDEM_NEW(summary->result, results->children / 2, fault);
  CDEM_YAML_EACH(yaml, results, name, map)
  CDEM_TRY(take_result(yaml, name, map, settings, &summary->result[summary->results++], fault));
  const cdem_yaml_node *sums = cdem_yaml_find(yaml, root, "checksums");
  CDEM_TRY(take_facts(yaml, root, "", summary, fault));
  if (sums != NULL && sums->kind == CDEM_YAML_MAP)
    CDEM_TRY(take_facts(yaml, sums, "checksums.", summary, fault));
  CDEM_TRY(take_warnings(yaml, cdem_yaml_find(yaml, root, "warnings"), summary, fault));
  return cdem_yaml_finish(yaml, fault);
}

cdem_status cdem_read_summary(const char *path, cdem_summary_file *summary, cdem_fault *fault) {
  cdem_yaml yaml = {0};
  cdem_summary_file made = {0};
  cdem_status status = cdem_yaml_read(path, &yaml, fault);
  if (status == CDEM_OK)
    status = cdem_yaml_finish(&yaml, fault); /* double keys and what no JSON has */
  if (status == CDEM_OK)
    status = take_all(&yaml, &made, fault);
  cdem_yaml_release(&yaml);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault,
                      "the summary of a run is not as cdem wrote it; run the case again, or leave "
                      "this run out");
  if (status == CDEM_OK)
    *summary = made;
  else
    cdem_summary_file_release(&made);
  return status;
}

void cdem_summary_file_release(cdem_summary_file *summary) {
  for (int64_t i = 0; i < summary->results; i++) {
    free(summary->result[i].name);
    free(summary->result[i].unit);
    free(summary->result[i].of);
    free(summary->result[i].take);
  }
  for (int64_t i = 0; i < summary->facts; i++) {
    free(summary->fact[i].name);
    free(summary->fact[i].text);
  }
  for (int64_t i = 0; i < summary->warnings; i++)
    free(summary->warning[i]);
  free(summary->result);
  free(summary->fact);
  free(summary->warning);
  *summary = (cdem_summary_file){0};
}

const char *cdem_summary_fact_find(const cdem_summary_file *summary, const char *name) {
  for (int64_t i = 0; i < summary->facts; i++)
    if (strcmp(summary->fact[i].name, name) == 0)
      return summary->fact[i].text;
  return NULL;
}
