/* A state of grains: coloured by what the case asks for, force chains, velocities. */
#include "base/suggest.h"
#include "io/run_files.h"
#include "run/axis.h"
#include "run/grains.h"

#include <stdio.h>
#include <string.h>

static const char *const usual[] = {"displacement", "chains", "velocities"};

static const char *choice_name(int choice) {
  return choice == CDEM_RUN_CHAINS       ? "chains"
         : choice == CDEM_RUN_VELOCITIES ? "velocities"
         : choice == CDEM_RUN_PUSHES     ? "pushes"
         : choice == CDEM_RUN_DIRECTIONS ? "directions"
                                         : cdem_grain_field_name(choice);
}

int cdem_run_picture_find(const char *name) {
  for (int i = 0; i < CDEM_RUN_CHOICES; i++)
    if (strcmp(choice_name(i), name) == 0)
      return i;
  return -1;
}

static bool is_strain(int choice) {
  return choice == CDEM_GRAIN_VOLUMETRIC_STRAIN || choice == CDEM_GRAIN_EFFECTIVE_STRAIN;
}

static bool is_windowed(const cdem_case_picture_window *window, int choice) {
  for (int64_t i = 0; i < window->of.count; i++)
    if (cdem_run_picture_find(window->of.item[i]) == choice)
      return true;
  return window->of.count == 0;
}

_Static_assert(sizeof(cdem_case_picture_ranges) == 2 * CDEM_RUN_MAPS * sizeof(double),
               "one range a map, in their order");

/* Of spheres, chains and velocities are cut through their middle. */
cdem_picture cdem_run_picture(const cdem_run_setup *run, int choice,
                              const cdem_strain_reference *strain, const char *title) {
  const cdem_case_grains *v = &cdem_run_values(run)->grains;
  const double *ends = (const double *)&v->picture_ranges + 2 * choice;
  bool field = choice < CDEM_GRAIN_FIELDS, cut = v->dimension == 3 && !field;
  cdem_picture picture = {.kind = choice == CDEM_RUN_CHAINS       ? CDEM_PICTURE_CHAINS
                                  : choice == CDEM_RUN_VELOCITIES ? CDEM_PICTURE_ARROWS
                                  : is_strain(choice)             ? CDEM_PICTURE_BAND
                                                                  : CDEM_PICTURE_GRAINS,
                          .field = field ? (cdem_grain_field)choice : CDEM_GRAIN_SPEED,
                          .strain = strain,
                          .title = title,
                          .value_min = ends[0],
                          .value_max = ends[1],
                          .slice = cut,
                          .middle = cut};
  if (is_windowed(&v->picture_window, choice)) {
    memcpy(picture.window.low, v->picture_window.low, sizeof picture.window.low);
    memcpy(picture.window.high, v->picture_window.high, sizeof picture.window.high);
  }
  return picture;
}

const char *cdem_run_picture_file(char text[96], int choice, const char *tag) {
  snprintf(text, 96, "%s%s", choice == CDEM_GRAIN_DISPLACEMENT ? "pattern" : choice_name(choice),
           tag);
  return text;
}

static cdem_status refuse(const cdem_run_grains *g, const char *list_key, int64_t index,
                          const char *name, cdem_fault *fault) {
  const char *known[CDEM_RUN_CHOICES];
  char key[64], list[200] = "";
  for (int i = 0; i < CDEM_RUN_CHOICES; i++) {
    known[i] = choice_name(i);
    size_t used = strlen(list);
    snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "", known[i]);
  }
  const char *near = cdem_suggest(name, known, CDEM_RUN_CHOICES);
  snprintf(key, sizeof key, "%s[%d]", list_key, (int)index);
  return cdem_case_fail(&g->run->cases, key, CDEM_INPUT, fault,
                        "there is no picture '%s'%s%s%s choose from %s", name,
                        near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : ";", list);
}

static cdem_status check_names(const cdem_run_grains *g, const char *key,
                               const cdem_case_texts *names, bool *strain, cdem_fault *fault) {
  for (int64_t i = 0; i < names->count; i++) {
    int choice = cdem_run_picture_find(names->item[i]);
    if (choice < 0)
      return refuse(g, key, i, names->item[i], fault);
    *strain = *strain || is_strain(choice);
  }
  return CDEM_OK;
}

cdem_status cdem_run_grains_pictures_init(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  bool strain = false, unused = false;
  CDEM_TRY(check_names(g, "grains.pictures", &v->grains.pictures, &strain, fault));
  CDEM_TRY(
      check_names(g, "grains.picture_window.of", &v->grains.picture_window.of, &unused, fault));
  for (int64_t p = 0; p < v->probes.count; p++)
    strain = strain || v->probes.item[p].quantity == CDEM_PROBE_BAND_ANGLE ||
             v->probes.item[p].quantity == CDEM_PROBE_BAND_SLENDERNESS;
  return strain ? cdem_strain_reference_create(&g->dem, 0.0, &g->strain, fault) : CDEM_OK;
}

static cdem_status draw(const cdem_run_grains *g, int choice, const char *title, const char *folder,
                        const char *tag, cdem_fault *fault) {
  char name[96];
  if (choice >= CDEM_RUN_MAPS)
    return cdem_run_grains_curve(g, choice, title, folder, tag, fault);
  const cdem_picture picture = cdem_run_picture(g->run, choice, g->strain, title);
  cdem_map map = {0};
  cdem_status status = cdem_dem_picture(&g->dem, &picture, &map, fault);
  if (status == CDEM_OK)
    status = cdem_write_map(folder, cdem_run_picture_file(name, choice, tag), &map, fault);
  cdem_map_release(&map);
  return status;
}

cdem_status cdem_run_grains_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                     cdem_fault *fault) {
  const cdem_run_grains *g = run->context;
  const cdem_case_texts *wanted = &cdem_run_grains_values(g)->grains.pictures;
  const double time = g->dem.time;
  const cdem_run_axis axis = cdem_run_axis_for("s", time);
  const int64_t count = wanted->count > 0 ? wanted->count : (int64_t)(sizeof usual / sizeof *usual);
  char title[80];
  snprintf(title, sizeof title, "t = %.4g %s", axis.factor * time, axis.unit);
  for (int64_t i = 0; i < count; i++) {
    int choice = cdem_run_picture_find(wanted->count > 0 ? wanted->item[i] : usual[i]);
    CDEM_TRY(draw(g, choice, title, folder, tag, fault));
  }
  return CDEM_OK;
}
