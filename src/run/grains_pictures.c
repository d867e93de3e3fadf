/* The last state of grains: coloured by what the case asks for, force chains, velocities. */
#include "base/suggest.h"
#include "dem/pictures.h"
#include "io/run_files.h"
#include "run/axis.h"
#include "run/grains.h"

#include <stdio.h>
#include <string.h>

enum { CHOICES = CDEM_GRAIN_FIELDS + 2, CHAINS = CDEM_GRAIN_FIELDS, VELOCITIES };

static const char *const usual[] = {"displacement", "chains", "velocities"};

static const char *choice_name(int choice) {
  return choice == CHAINS       ? "chains"
         : choice == VELOCITIES ? "velocities"
                                : cdem_grain_field_name(choice);
}

static int find_choice(const char *name) {
  for (int i = 0; i < CHOICES; i++)
    if (strcmp(choice_name(i), name) == 0)
      return i;
  return -1;
}

static bool is_strain(int choice) {
  return choice == CDEM_GRAIN_VOLUMETRIC_STRAIN || choice == CDEM_GRAIN_EFFECTIVE_STRAIN;
}

static cdem_status refuse(const cdem_run_grains *g, int64_t index, const char *name,
                          cdem_fault *fault) {
  const char *known[CHOICES];
  char key[40], list[200] = "";
  for (int i = 0; i < CHOICES; i++) {
    known[i] = choice_name(i);
    size_t used = strlen(list);
    snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "", known[i]);
  }
  const char *near = cdem_suggest(name, known, CHOICES);
  snprintf(key, sizeof key, "grains.pictures[%d]", (int)index);
  return cdem_case_fail(&g->run->cases, key, CDEM_INPUT, fault,
                        "there is no picture '%s'%s%s%s choose from %s", name,
                        near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : ";", list);
}

cdem_status cdem_run_grains_pictures_init(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_texts *wanted = &cdem_run_grains_values(g)->grains.pictures;
  bool strain = false;
  for (int64_t i = 0; i < wanted->count; i++) {
    int choice = find_choice(wanted->item[i]);
    if (choice < 0)
      return refuse(g, i, wanted->item[i], fault);
    strain = strain || is_strain(choice);
  }
  return strain ? cdem_strain_reference_create(&g->dem, 0.0, &g->strain, fault) : CDEM_OK;
}

/* Of spheres, chains and velocities are cut through their middle. */
static cdem_status draw(const cdem_run_grains *g, int choice, const char *title, const char *folder,
                        cdem_fault *fault) {
  bool field = choice < CDEM_GRAIN_FIELDS, cut = g->dim == 3 && !field;
  const cdem_picture picture = {.kind = choice == CHAINS       ? CDEM_PICTURE_CHAINS
                                        : choice == VELOCITIES ? CDEM_PICTURE_ARROWS
                                        : is_strain(choice)    ? CDEM_PICTURE_BAND
                                                               : CDEM_PICTURE_GRAINS,
                                .field = field ? (cdem_grain_field)choice : CDEM_GRAIN_SPEED,
                                .strain = g->strain,
                                .title = title,
                                .slice = cut,
                                .middle = cut};
  const char *name = choice == CDEM_GRAIN_DISPLACEMENT ? "pattern" : choice_name(choice);
  cdem_map map = {0};
  cdem_status status = cdem_dem_picture(&g->dem, &picture, &map, fault);
  if (status == CDEM_OK)
    status = cdem_write_map(folder, name, &map, fault);
  cdem_map_release(&map);
  return status;
}

cdem_status cdem_run_grains_pictures(cdem_run_setup *run, const char *folder, cdem_fault *fault) {
  const cdem_run_grains *g = run->context;
  const cdem_case_texts *wanted = &cdem_run_grains_values(g)->grains.pictures;
  const double time = g->dem.time;
  const cdem_run_axis axis = cdem_run_axis_for("s", time);
  const int64_t count = wanted->count > 0 ? wanted->count : (int64_t)(sizeof usual / sizeof *usual);
  char title[80];
  snprintf(title, sizeof title, "t = %.4g %s", axis.factor * time, axis.unit);
  for (int64_t i = 0; i < count; i++)
    CDEM_TRY(
        draw(g, find_choice(wanted->count > 0 ? wanted->item[i] : usual[i]), title, folder, fault));
  return CDEM_OK;
}
