/* The table of formats of grains, one line a format, and the one door to them. */
#include "io/grains_file.h"
#include "io/grains_scene.h"
#include "io/text.h"

#include <inttypes.h>
#include <stdlib.h>

static cdem_status write_plain(const char *path, const cdem_scene *scene, const char *lost,
                               cdem_fault *fault) {
  const char **name;
  (void)lost;
  CDEM_NEW(name, scene->materials, fault);
  for (int m = 0; m < scene->materials; m++)
    name[m] = scene->material[m].name;
  cdem_status status = cdem_write_grains(path, &scene->grains, scene->materials, name, fault);
  free(name);
  return status;
}

static const cdem_grain_format csv = {"csv", ".csv",      "table of grains, one row a grain",
                                      false, write_plain, NULL};
static const cdem_grain_format vtp = {
    "vtp", ".vtp", "points for ParaView, with radius and motion", false, write_plain, NULL};
static const cdem_grain_format *const formats[] = {
    &csv,
    &vtp,
    &cdem_grain_format_lammps,
    &cdem_grain_format_yade,
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

const cdem_grain_format *cdem_grain_format_at(int index) {
  return index >= 0 && index < FORMATS ? formats[index] : NULL;
}

const cdem_grain_format *cdem_grain_format_of(const char *path) {
  for (int i = 0; i < FORMATS; i++)
    if (cdem_ends_with_one_of(path, formats[i]->endings))
      return formats[i];
  return NULL;
}

/* ---- what a file lacks ---- */

enum { LOST = 256 };

/* One more thing that is lost, `count` of them; 0: none. */
static void add_lost(char lost[LOST], int64_t count, const char *one, const char *many) {
  size_t used = strlen(lost);
  if (count == 0)
    return;
  if (used > 0)
    used += (size_t)snprintf(lost + used, LOST - used, ", ");
  if (count > 1)
    snprintf(lost + used, LOST - used, "%" PRId64 " %s", count, many);
  else
    snprintf(lost + used, LOST - used, "%s", one);
}

static bool deforms(const cdem_cell *cell) {
  for (int e = 0; cell != NULL && e < 9; e++)
    if (cell->rate[e].points > 0 || cell->servo[e / 3])
      return true;
  return false;
}

static void find_lost(const cdem_scene *scene, const cdem_grain_format *format, char lost[LOST]) {
  lost[0] = '\0';
  if (!format->masses)
    return;
  if (scene->dem == NULL) {
    add_lost(lost, 1, "a law of contact (a table has none; export a case)", NULL);
    return;
  }
  const cdem_dem_options *model = cdem_dem_options_of(scene->dem);
  add_lost(lost, model->walls, "a wall", "walls");
  add_lost(lost, model->bonds, "a bond", "bonds");
  add_lost(lost, model->confinement != NULL, "the plates and sides of the specimen", NULL);
  add_lost(lost, deforms(model->cell), "how the cell deforms", NULL);
  const char *law = format->lacks(scene);
  add_lost(lost, law != NULL, law, NULL);
  bool turns = (model->rolling != NULL && model->rolling->wants > 0) ||
               (model->twisting != NULL && model->twisting->wants > 0);
  add_lost(lost, turns, "rolling and twisting resistance", NULL);
  add_lost(lost, model->mass_damping > 0.0 || model->local_damping > 0.0, "mass or local damping",
           NULL);
  add_lost(lost, scene->dem->steps > 0, "what contacts remember of their sliding", NULL);
}

cdem_status cdem_write_scene(const char *path, const cdem_scene *scene, char lost[LOST],
                             cdem_fault *fault) {
  const cdem_grain_format *format = cdem_grain_format_of(path);
  CDEM_REQUIRE(format != NULL, fault, CDEM_INPUT,
               "the ending of '%s' names no file of grains; see `cdem list formats`", path);
  CDEM_TRY(cdem_grains_check(&scene->grains, fault));
  find_lost(scene, format, lost);
  return format->write(path, scene, lost, fault);
}
