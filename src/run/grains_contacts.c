/* Materials that grains and walls use, and for each pair that can meet the first entry of
 * `contacts` that fits. */
#include "run/grains.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- materials ---- */

static void take_material(cdem_run_grains *g, int from) {
  if (g->model_of[from] < 0) {
    g->used[g->materials] = from;
    g->model_of[from] = g->materials++;
  }
}

static void name_material(const cdem_run_grains *g, int m, double density) {
  const cdem_case_grain_material *from =
      &cdem_run_grains_values(g)->grains.materials.item[g->used[m]];
  cdem_grain_material *to = &g->material[m];
  snprintf(to->name, sizeof to->name, "%.63s", from->name);
  /* walls have no mass; the solver asks all the same */
  to->density = isnan(from->density) ? density : from->density;
  to->young = from->young;
  to->poisson = from->poisson;
}

cdem_status cdem_run_grains_materials(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  int64_t known = v->grains.materials.count;
  char key[96];
  CDEM_NEW(g->used, known, fault);
  CDEM_NEW(g->model_of, known, fault);
  CDEM_NEW(g->of_grains, known, fault);
  CDEM_NEW(g->material, known, fault);
  for (int64_t m = 0; m < known; m++)
    g->model_of[m] = -1;
  for (int64_t i = 0; i < g->grains.grains; i++) {
    take_material(g, g->case_material[i]);
    g->grains.material[i] = g->model_of[g->case_material[i]];
    g->of_grains[g->grains.material[i]] = true;
  }
  int of_grains = g->materials;
  for (int64_t w = 0; w < v->walls.count; w++)
    take_material(g, cdem_run_grains_material(g, v->walls.item[w].material));
  if (cdem_case_is_triaxial(&g->run->cases))
    cdem_run_grains_triaxial_materials(g, take_material);
  for (int m = 0; m < of_grains; m++) {
    const cdem_case_grain_material *from = &v->grains.materials.item[g->used[m]];
    if (isnan(from->density))
      return cdem_case_fail(&g->run->cases,
                            cdem_run_named_key(key, "grains.materials", from->name, ""), CDEM_INPUT,
                            fault, "material '%s' of the grains needs 'density'", from->name);
  }
  for (int m = 0; m < g->materials; m++)
    name_material(g, m, v->grains.materials.item[g->used[0]].density);
  return CDEM_OK;
}

/* ---- pairs ---- */

static bool fits(const cdem_case_texts *between, const char *a, const char *b) {
  if (between->count == 0)
    return true;
  const char *first = between->item[0], *second = between->item[1];
  return (strcmp(first, a) == 0 && strcmp(second, b) == 0) ||
         (strcmp(first, b) == 0 && strcmp(second, a) == 0);
}

static int find_entry(const cdem_run_grains *g, int a, int b) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  for (int64_t i = 0; i < v->contacts.count; i++)
    if (fits(&v->contacts.item[i].between, g->material[a].name, g->material[b].name))
      return (int)i;
  return -1;
}

/* The word that a message of a law names first, as a key of the entry; the entry itself without. */
static const char *word_of(const char *message, char word[64]) {
  const char *found = NULL;
  word[0] = '\0';
  for (int k = 0; cdem_law_key_get(k) != NULL; k++) {
    const char *name = cdem_law_key_get(k)->name;
    size_t length = strlen(name);
    for (const char *at = strchr(message, '\''); at != NULL; at = strchr(at + 1, '\''))
      if (strncmp(at + 1, name, length) == 0 && at[1 + length] == '\'' &&
          (found == NULL || at < found)) {
        found = at;
        snprintf(word, 64, "%s", name);
      }
  }
  return word;
}

/* Where a failure stands: at the choice of a law or resistance that cannot be, else at the word. */
static const char *key_of(const cdem_run_grains *g, int entry, const char *message, char key[96]) {
  const cdem_case_grains *wanted = &cdem_run_grains_values(g)->grains;
  const cdem_law *law = cdem_law_at(wanted->law);
  char word[64];
  if (!law->dims[g->dim])
    return "grains.law";
  if (law->rolls && (wanted->rolling > 0 || wanted->twisting > 0))
    return wanted->rolling > 0 ? "grains.rolling" : "grains.twisting";
  if (g->dim == 2 && wanted->twisting > 0)
    return "grains.twisting";
  return cdem_run_key(key, "contacts", entry, word_of(message, word));
}

static cdem_status check_pair(cdem_run_grains *g, int a, int b, int entry, cdem_fault *fault) {
  const cdem_case_grains *wanted = &cdem_run_grains_values(g)->grains;
  cdem_contact_model model;
  cdem_fault local = {0};
  char key[96];
  cdem_status status = cdem_contact_model_init(
      g->dim, cdem_law_at(wanted->law), cdem_rolling_at(wanted->rolling),
      g->dim == 3 || wanted->twisting > 0 ? cdem_twisting_at(wanted->twisting) : NULL,
      &g->contact[a * g->materials + b], &g->material[a], &g->material[b], &model, &local);
  if (status == CDEM_OK)
    return CDEM_OK;
  return cdem_run_refused(g->run, key_of(g, entry, local.message, key), status, local.message,
                          fault);
}

/* Pairs that never meet share the numbers of one that does: they must be good, not used. */
static void fill_others(cdem_run_grains *g) {
  int n = g->materials, some = 0;
  while (some + 1 < n * n && g->contact_entry[some] < 0)
    some++;
  for (int p = 0; p < n * n; p++)
    if (g->contact_entry[p] < 0)
      g->contact[p] = g->contact[some];
}

cdem_status cdem_run_grains_contacts(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  int n = g->materials;
  CDEM_NEW(g->contact, (int64_t)n * n, fault);
  CDEM_NEW(g->contact_entry, (int64_t)n * n, fault);
  for (int p = 0; p < n * n; p++)
    g->contact_entry[p] = -1;
  for (int a = 0; a < n; a++)
    for (int b = a; b < n; b++) {
      if (!g->of_grains[a] && !g->of_grains[b])
        continue;
      int entry = find_entry(g, a, b);
      if (entry < 0)
        return cdem_case_fail(&g->run->cases, "contacts", CDEM_INPUT, fault,
                              "no entry fits '%s' and '%s', which can meet; add one with "
                              "`between: [%s, %s]`, or one without `between` that fits all pairs",
                              g->material[a].name, g->material[b].name, g->material[a].name,
                              g->material[b].name);
      for (int i = 0; i < 2; i++) {
        int p = i == 0 ? a * n + b : b * n + a;
        g->contact_entry[p] = entry;
        memcpy(g->contact[p].value, v->contacts.item[entry].value, sizeof g->contact[p].value);
      }
      CDEM_TRY(check_pair(g, a, b, entry, fault));
    }
  fill_others(g);
  return CDEM_OK;
}
