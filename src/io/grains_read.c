/* Grains in: the table. */
#include "base/suggest.h"
#include "io/csv.h"
#include "io/grains_columns.h"
#include "io/grains_file.h"
#include "io/run_files.h"
#include "io/text.h"
#include "io/units.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = CDEM_GRAIN_COLUMNS };

typedef struct {
  int dim;
  int64_t line;
  int columns, column[MOST_COLUMNS]; /* of the file */
  double unit[MOST_COLUMNS];         /* of the column, SI */
  bool has[CDEM_GRAIN_COLUMNS];
  cdem_units units;
  cdem_grain_table *table;
  int64_t name_room;
} reader;

/* ---- the header ---- */

static int column_of(const char *name) {
  for (int c = 0; c < CDEM_GRAIN_COLUMNS; c++)
    if (strcmp(name, cdem_grain_columns[c].name) == 0)
      return c;
  return -1;
}

static const char *nearest_column(const char *name) {
  const char *names[CDEM_GRAIN_COLUMNS];
  for (int c = 0; c < CDEM_GRAIN_COLUMNS; c++)
    names[c] = cdem_grain_columns[c].name;
  return cdem_suggest(name, names, CDEM_GRAIN_COLUMNS);
}

static cdem_status add_column(reader *r, const char *title, const char *unit, cdem_fault *fault) {
  int c = column_of(title);
  if (c < 0) {
    const char *nearest = nearest_column(title);
    return nearest != NULL
               ? cdem_fail(fault, CDEM_INPUT,
                           "line %" PRId64 ": there is no column '%.40s' in a table of grains; "
                           "did you mean '%s'?",
                           r->line, title, nearest)
               : cdem_fail(fault, CDEM_INPUT,
                           "line %" PRId64 ": there is no column '%.40s' in a table of grains; "
                           "it has x, y, z, radius, material, motion, vx ... wz",
                           r->line, title);
  }
  CDEM_REQUIRE(!r->has[c], fault, CDEM_INPUT, "line %" PRId64 ": the column '%s' is there twice",
               r->line, title);
  /* "rad/s" as it is written: one kind of unit to UDUNITS with 1/s. */
  const cdem_grain_column *column = &cdem_grain_columns[c];
  bool own = unit != NULL && strcmp(unit, column->unit) == 0;
  CDEM_TRY(cdem_csv_unit(&r->units, title, own ? NULL : unit, column->dimension, r->line,
                         &r->unit[r->columns], fault));
  r->has[c] = true;
  r->column[r->columns++] = c;
  return CDEM_OK;
}

static cdem_status check_header(reader *r, cdem_fault *fault) {
  const int needed[3] = {CDEM_GRAIN_x, CDEM_GRAIN_y, CDEM_GRAIN_radius};
  for (int i = 0; i < 3; i++)
    CDEM_REQUIRE(r->has[needed[i]], fault, CDEM_INPUT,
                 "line %" PRId64 ": the column '%s' is missing", r->line,
                 cdem_grain_columns[needed[i]].name);
  if (r->dim == 0)
    r->dim = r->has[CDEM_GRAIN_z] ? 3 : 2;
  CDEM_REQUIRE(r->dim == 2 || r->has[CDEM_GRAIN_z], fault, CDEM_INPUT,
               "line %" PRId64 ": the column 'z' is missing; without it the grains are discs (2-D)",
               r->line);
  for (int c = 0; c < CDEM_GRAIN_COLUMNS; c++)
    CDEM_REQUIRE(!r->has[c] || c == CDEM_GRAIN_z || cdem_grain_column_is_of(c, r->dim), fault,
                 CDEM_INPUT,
                 "line %" PRId64 ": discs have no column '%s'; spheres need a column "
                 "'z'",
                 r->line, cdem_grain_columns[c].name);
  return CDEM_OK;
}

/* ---- rows ---- */

static cdem_status find_material(reader *r, const char *name, int32_t *material,
                                 cdem_fault *fault) {
  cdem_grain_table *t = r->table;
  CDEM_REQUIRE(name[0] != '\0', fault, CDEM_INPUT, "line %" PRId64 ": the material is missing",
               r->line);
  /* Mostly that of the grain before: the search goes backwards. */
  for (int64_t i = t->names - 1; i >= 0; i--)
    if (strcmp(t->name[i], name) == 0) {
      *material = (int32_t)i;
      return CDEM_OK;
    }
  CDEM_TRY(cdem_grow(&t->name, &r->name_room, t->names + 1, sizeof *t->name, fault));
  t->name[t->names] = cdem_copy_text(name, fault);
  if (t->name[t->names] == NULL)
    return CDEM_MEMORY;
  *material = (int32_t)t->names++;
  return CDEM_OK;
}

static cdem_status find_motion(const reader *r, const char *name, uint8_t *motion,
                               cdem_fault *fault) {
  for (uint8_t m = 0; m < 2; m++)
    if (strcmp(name, cdem_grain_motions[m]) == 0) {
      *motion = m;
      return CDEM_OK;
    }
  return cdem_fail(fault, CDEM_INPUT,
                   "line %" PRId64 ": '%.40s' is no motion; free or driven is wanted", r->line,
                   name);
}

typedef struct {
  double number[CDEM_GRAIN_COLUMNS]; /* SI, 0 where there is no column */
  int32_t material;
  uint8_t motion;
} grain_row;

static cdem_status take_row(reader *r, char *text, grain_row *row, cdem_fault *fault) {
  bool last = false;
  char *at = text;
  for (int k = 0; k < r->columns; k++) {
    CDEM_REQUIRE(!last, fault, CDEM_INPUT,
                 "line %" PRId64 ": it has %d fields, but the header has %d", r->line, k,
                 r->columns);
    char *field = cdem_csv_take(&at, &last);
    field += strspn(field, " \t");
    if (r->column[k] == CDEM_GRAIN_material)
      CDEM_TRY(find_material(r, field, &row->material, fault));
    else if (r->column[k] == CDEM_GRAIN_motion)
      CDEM_TRY(find_motion(r, field, &row->motion, fault));
    else
      CDEM_TRY(cdem_csv_number(field, cdem_grain_columns[r->column[k]].name, r->unit[k], r->line,
                               &row->number[r->column[k]], fault));
  }
  CDEM_REQUIRE(last, fault, CDEM_INPUT,
               "line %" PRId64 ": it has more fields than the header, which has %d", r->line,
               r->columns);
  CDEM_REQUIRE(row->number[CDEM_GRAIN_radius] > 0.0, fault, CDEM_INPUT,
               "line %" PRId64 ": the radius is %g m; a radius is positive", r->line,
               row->number[CDEM_GRAIN_radius]);
  CDEM_REQUIRE(r->dim == 3 || row->number[CDEM_GRAIN_z] == 0.0, fault, CDEM_INPUT,
               "line %" PRId64 ": a disc stands at z = %g m; discs are in the plane z = 0", r->line,
               row->number[CDEM_GRAIN_z]);
  return CDEM_OK;
}

static cdem_status add_row(reader *r, const grain_row *row, cdem_fault *fault) {
  cdem_grains *g = &r->table->grains;
  int64_t i = g->grains;
  CDEM_TRY(cdem_grains_add(g, row->number + CDEM_GRAIN_x, row->number[CDEM_GRAIN_radius], fault));
  if (i == 0) {
    /* Whatever has no column stays NULL. */
    CDEM_TRY(cdem_grains_complete(g, fault));
    bool moves = r->has[CDEM_GRAIN_vx] || r->has[CDEM_GRAIN_vy] || r->has[CDEM_GRAIN_vz];
    bool spins = r->has[CDEM_GRAIN_wx] || r->has[CDEM_GRAIN_wy] || r->has[CDEM_GRAIN_wz];
    void **const array[4] = {(void **)&g->velocity, (void **)&g->spin, (void **)&g->material,
                             (void **)&g->motion};
    const bool wanted[4] = {moves, spins, r->has[CDEM_GRAIN_material], r->has[CDEM_GRAIN_motion]};
    for (int a = 0; a < 4; a++)
      if (!wanted[a]) {
        free(*array[a]);
        *array[a] = NULL;
      }
  }
  if (g->velocity != NULL)
    memcpy(g->velocity + 3 * i, row->number + CDEM_GRAIN_vx, 3 * sizeof *g->velocity);
  if (g->spin != NULL)
    memcpy(g->spin + 3 * i, row->number + CDEM_GRAIN_wx, 3 * sizeof *g->spin);
  if (g->material != NULL)
    g->material[i] = row->material;
  if (g->motion != NULL)
    g->motion[i] = row->motion;
  return CDEM_OK;
}

/* ---- lines ---- */

static cdem_status read_lines(reader *r, char *text, cdem_fault *fault) {
  char *at = cdem_csv_begin(text), *line = cdem_csv_line(&at, &r->line);
  CDEM_REQUIRE(line != NULL, fault, CDEM_INPUT, "the header is missing");
  for (bool last = false; !last;) {
    char *unit, *title = cdem_csv_title(&line, &last, &unit);
    CDEM_TRY(add_column(r, title, unit, fault));
  }
  CDEM_TRY(check_header(r, fault));
  r->table->grains.dim = r->dim;
  while ((line = cdem_csv_line(&at, &r->line)) != NULL) {
    grain_row row = {0};
    CDEM_TRY(take_row(r, line, &row, fault));
    CDEM_TRY(add_row(r, &row, fault));
  }
  CDEM_REQUIRE(r->table->grains.grains > 0, fault, CDEM_INPUT, "there are no grains in it");
  return CDEM_OK;
}

cdem_status cdem_read_grains(const char *path, int dim, cdem_grain_table *table,
                             cdem_fault *fault) {
  char *text;
  *table = (cdem_grain_table){0};
  CDEM_TRY(cdem_read_text(path, &text, fault));
  reader r = {.dim = dim, .table = table};
  cdem_status status = read_lines(&r, text, fault);
  cdem_units_release(&r.units);
  free(text);
  if (status == CDEM_OK)
    return CDEM_OK;
  cdem_grain_table_release(table);
  if (status == CDEM_INPUT)
    cdem_fault_prefix(fault, "cannot read '%s'", path);
  return status;
}
