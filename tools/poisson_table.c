/* The table of spring sets against Poisson's ratio, and the table of critical ratios. */
#include "io/io.h"
#include "poisson.h"

#include <stdio.h>
#include <string.h>

enum {
  NU,
  PAIR,
  CLASS,
  FORM,
  K1,
  COUPLING = K1 + 3,
  FRAME_H,
  COND,
  CLOSED1,
  DIFFERENCE = CLOSED1 + 3,
  DIRECTION,
  COLUMNS = DIRECTION + 9
};

int poisson_choose_pairs(const cdem_specimen *specimen, bool all, int *pairs) {
  bool taken[CDEM_CLASS_COUNT] = {false};
  int count = 0;
  for (int p = 0; p < cdem_element_pairs(specimen->options.element); p++) {
    cdem_class class_ = cdem_specimen_pair_at(specimen, p).class_;
    if (all || !taken[class_])
      pairs[count++] = p;
    taken[class_] = true;
  }
  return count;
}

void poisson_pair_name(const cdem_specimen_pair *pair, char name[24]) {
  snprintf(name, 24, "%d-%d", pair->node[0] + 1, pair->node[1] + 1);
}

static cdem_status add_columns(cdem_table *table, cdem_fault *fault) {
  static const struct {
    const char *name, *unit;
  } column[COLUMNS] = {
      {"nu", ""},         {"pair", ""},       {"class", ""},      {"form", ""},
      {"k1", "N/m"},      {"k2", "N/m"},      {"k3", "N/m"},      {"coupling", "N/m"},
      {"frame_h", "N/m"}, {"cond", ""},       {"closed1", "N/m"}, {"closed2", "N/m"},
      {"closed3", "N/m"}, {"difference", ""}, {"d1x", ""},        {"d1y", ""},
      {"d1z", ""},        {"d2x", ""},        {"d2y", ""},        {"d2z", ""},
      {"d3x", ""},        {"d3y", ""},        {"d3z", ""}};
  for (int c = 0; c < COLUMNS; c++) {
    bool text = c == PAIR || c == CLASS || c == FORM;
    CDEM_TRY(cdem_table_add_column(
        table, column[c].name, text ? CDEM_COLUMN_TEXT : CDEM_COLUMN_REAL, column[c].unit, fault));
  }
  return CDEM_OK;
}

/* NaN stays absent; plane elements leave the third spring absent and, unless it is a rotation, the
 * third component too. */
static cdem_status add_row(const cdem_specimen_pair *pair, const cdem_poisson_row *row,
                           cdem_table *table, cdem_fault *fault) {
  char name[24];
  poisson_pair_name(pair, name);
  CDEM_TRY(cdem_table_add_row(table, fault));
  cdem_table_set_real(table, NU, row->nu);
  CDEM_TRY(cdem_table_set_text(table, PAIR, name, fault));
  CDEM_TRY(cdem_table_set_text(table, CLASS, cdem_class_name(pair->class_), fault));
  CDEM_TRY(cdem_table_set_text(table, FORM, cdem_form_name(row->form), fault));
  for (int k = 0; k < row->size; k++) {
    cdem_table_set_real(table, K1 + k, row->k[k]);
    cdem_table_set_real(table, CLOSED1 + k, row->closed[k]);
    for (int d = 0; d < row->size; d++)
      cdem_table_set_real(table, DIRECTION + 3 * k + d, row->dir[k][d]);
  }
  cdem_table_set_real(table, COUPLING, row->coupling);
  cdem_table_set_real(table, FRAME_H, row->frame_h);
  cdem_table_set_real(table, COND, row->cond);
  cdem_table_set_real(table, DIFFERENCE, row->difference);
  return CDEM_OK;
}

static cdem_status fill_pair(cdem_specimen_pair *pair, const poisson_range *range,
                             cdem_table *table, cdem_fault *fault) {
  cdem_poisson_family family = cdem_specimen_family(pair);
  cdem_poisson_study study;
  cdem_poisson_row row = {0};
  CDEM_TRY(cdem_poisson_study_init(&family, &study, fault));
  for (int64_t i = 0; i < range->rows; i++) {
    CDEM_TRY(cdem_poisson_follow(&study, range->from + (double)i * range->step, &row, fault));
    CDEM_TRY(add_row(pair, &row, table, fault));
  }
  return CDEM_OK;
}

cdem_status poisson_fill_table(const cdem_specimen *specimen, const poisson_range *range, bool all,
                               const cdem_progress *progress, cdem_table *table,
                               cdem_fault *fault) {
  int pairs[CDEM_MAX_PAIRS], count = poisson_choose_pairs(specimen, all, pairs);
  CDEM_TRY(add_columns(table, fault));
  for (int p = 0; p < count; p++) {
    CDEM_TRY(cdem_progress_report(progress, "tabulating pairs", p, count, fault));
    cdem_specimen_pair pair = cdem_specimen_pair_at(specimen, pairs[p]);
    CDEM_TRY(fill_pair(&pair, range, table, fault));
  }
  return CDEM_OK;
}

static cdem_status add_roots(const cdem_specimen_pair *pair, const cdem_poisson_roots *roots,
                             bool all, cdem_table *table, cdem_fault *fault) {
  for (int i = 0; i < roots->count; i++) {
    char name[24];
    poisson_pair_name(pair, name);
    CDEM_TRY(cdem_table_add_row(table, fault));
    CDEM_TRY(cdem_table_set_text(table, 0, cdem_class_name(pair->class_), fault));
    cdem_table_set_real(table, 1, roots->root[i].nu);
    CDEM_TRY(cdem_table_set_text(table, 2, cdem_form_name(roots->root[i].from), fault));
    CDEM_TRY(cdem_table_set_text(table, 3, cdem_form_name(roots->root[i].to), fault));
    if (all)
      CDEM_TRY(cdem_table_set_text(table, 4, name, fault));
  }
  return CDEM_OK;
}

cdem_status poisson_fill_roots(const cdem_specimen *specimen, bool all,
                               void (*note)(const char *pair, const char *class_),
                               cdem_table *table, cdem_fault *fault) {
  static const char *const column[] = {"class", "nu", "from", "to", "pair"};
  int pairs[CDEM_MAX_PAIRS], count = poisson_choose_pairs(specimen, all, pairs);
  for (int c = 0; c < (all ? 5 : 4); c++)
    CDEM_TRY(cdem_table_add_column(table, column[c], c == 1 ? CDEM_COLUMN_REAL : CDEM_COLUMN_TEXT,
                                   "", fault));
  for (int p = 0; p < count; p++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(specimen, pairs[p]);
    cdem_poisson_family family = cdem_specimen_family(&pair);
    cdem_poisson_study study;
    CDEM_TRY(cdem_poisson_study_init(&family, &study, fault));
    CDEM_TRY(add_roots(&pair, &study.roots, all, table, fault));
    char name[24];
    poisson_pair_name(&pair, name);
    if (study.roots.double_everywhere)
      note(name, cdem_class_name(pair.class_));
  }
  return CDEM_OK;
}
