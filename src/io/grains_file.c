/* Grains out: the table and VTK points. */
#include "io/grains_file.h"

#include "io/csv.h"
#include "io/grains_columns.h"
#include "io/output.h"
#include "io/text.h"
#include "io/vtk_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define X(name, unit, length, time) {#name, unit, {length, time, 0}},
const cdem_grain_column cdem_grain_columns[CDEM_GRAIN_COLUMNS] = {CDEM_GRAIN_COLUMN_LIST};
#undef X
const char *const cdem_grain_motions[2] = {"free", "driven"};

void cdem_grain_table_release(cdem_grain_table *table) {
  for (int64_t i = 0; i < table->names; i++)
    free(table->name[i]);
  free(table->name);
  cdem_grains_release(&table->grains);
  *table = (cdem_grain_table){0};
}

bool cdem_grain_column_is_of(int column, int dim) {
  return dim == 3 || !(column == CDEM_GRAIN_z || column == CDEM_GRAIN_vz ||
                       column == CDEM_GRAIN_wx || column == CDEM_GRAIN_wy);
}

/* ---- table ---- */

static bool is_written(const cdem_grains *grains, int column) {
  if (!cdem_grain_column_is_of(column, grains->dim))
    return false;
  if (column >= CDEM_GRAIN_vx && column <= CDEM_GRAIN_vz)
    return grains->velocity != NULL;
  if (column >= CDEM_GRAIN_wx && column <= CDEM_GRAIN_wz)
    return grains->spin != NULL;
  if (column == CDEM_GRAIN_material)
    return grains->material != NULL;
  return column != CDEM_GRAIN_motion || grains->motion != NULL;
}

static double number_of(const cdem_grains *grains, int64_t i, int column) {
  if (column == CDEM_GRAIN_radius)
    return grains->radius[i];
  if (column >= CDEM_GRAIN_wx)
    return grains->spin[3 * i + column - CDEM_GRAIN_wx];
  if (column >= CDEM_GRAIN_vx)
    return grains->velocity[3 * i + column - CDEM_GRAIN_vx];
  return grains->xyz[3 * i + column - CDEM_GRAIN_x];
}

static void put_row(FILE *stream, const cdem_grains *grains, int64_t i, const char *const *name) {
  const char *between = "";
  for (int c = 0; c < CDEM_GRAIN_COLUMNS; c++) {
    if (!is_written(grains, c))
      continue;
    fputs(between, stream);
    between = ",";
    char text[CDEM_REAL_WIDTH];
    if (c == CDEM_GRAIN_material)
      cdem_csv_text(stream, name[grains->material[i]]);
    else if (c == CDEM_GRAIN_motion)
      fputs(cdem_grain_motions[grains->motion[i]], stream);
    else
      fwrite(text, 1, (size_t)(cdem_put_real(text, number_of(grains, i, c)) - text), stream);
  }
  fputc('\n', stream);
}

static cdem_status write_table(const char *path, const cdem_grains *grains, const char *const *name,
                               cdem_fault *fault) {
  cdem_output *output;
  CDEM_TRY(cdem_output_open(path, &output, fault));
  FILE *stream = cdem_output_stream(output);
  const char *between = "";
  for (int c = 0; c < CDEM_GRAIN_COLUMNS; c++) {
    const cdem_grain_column *column = &cdem_grain_columns[c];
    if (!is_written(grains, c))
      continue;
    fprintf(stream, column->unit[0] != '\0' ? "%s%s [%s]" : "%s%s", between, column->name,
            column->unit);
    between = ",";
  }
  fputc('\n', stream);
  for (int64_t i = 0; i < grains->grains; i++)
    put_row(stream, grains, i, name);
  return cdem_output_commit(&output, fault);
}

/* ---- VTK ---- */

typedef struct {
  cdem_output *output;
  cdem_vtk_header header;
  const cdem_grains *grains;
  int64_t *number; /* [grains] 0 1 2 ..., then 1 2 3 ... */
} vtp;

/* One array, announced in the header or put behind it. */
static cdem_status array(vtp *v, bool put, const cdem_vtk_array *of, const void *data,
                         cdem_fault *fault) {
  if (data == NULL)
    return CDEM_OK;
  if (put)
    return cdem_vtk_put(v->output, data, of->bytes, fault);
  cdem_vtk_announce(&v->header, of);
  return CDEM_OK;
}

static cdem_status point_arrays(vtp *v, bool put, cdem_fault *fault) {
  const cdem_grains *g = v->grains;
  uint64_t n = (uint64_t)g->grains;
  CDEM_TRY(array(v, put, &(cdem_vtk_array){"Float64", "radius", "m", 1, 8 * n}, g->radius, fault));
  CDEM_TRY(
      array(v, put, &(cdem_vtk_array){"Int32", "material", NULL, 1, 4 * n}, g->material, fault));
  CDEM_TRY(array(v, put, &(cdem_vtk_array){"Float64", "velocity", "m/s", 3, 24 * n}, g->velocity,
                 fault));
  CDEM_TRY(array(v, put, &(cdem_vtk_array){"Float64", "spin", "rad/s", 3, 24 * n}, g->spin, fault));
  return array(v, put, &(cdem_vtk_array){"UInt8", "motion", NULL, 1, n}, g->motion, fault);
}

static void count_from(vtp *v, int64_t first) {
  for (int64_t i = 0; i < v->grains->grains; i++)
    v->number[i] = first + i;
}

static cdem_status put_vtp(vtp *v, int64_t names, const char *const *name, cdem_fault *fault) {
  FILE *stream = v->header.stream;
  uint64_t n = (uint64_t)v->grains->grains;
  cdem_vtk_begin(stream, "PolyData");
  if (v->grains->material != NULL) {
    fputs("    <FieldData>\n", stream);
    cdem_vtk_texts(stream, "material names", name, (int)names);
    fputs("    </FieldData>\n", stream);
  }
  fprintf(stream,
          "    <Piece NumberOfPoints=\"%" PRIu64 "\" NumberOfVerts=\"%" PRIu64 "\">\n"
          "      <Points>\n",
          n, n);
  cdem_vtk_announce(&v->header, &(cdem_vtk_array){"Float64", "Points", NULL, 3, 24 * n});
  fputs("      </Points>\n      <PointData Scalars=\"radius\">\n", stream);
  CDEM_TRY(point_arrays(v, false, fault));
  fputs("      </PointData>\n      <Verts>\n", stream);
  cdem_vtk_announce(&v->header, &(cdem_vtk_array){"Int64", "connectivity", NULL, 1, 8 * n});
  cdem_vtk_announce(&v->header, &(cdem_vtk_array){"Int64", "offsets", NULL, 1, 8 * n});
  fputs("      </Verts>\n    </Piece>\n", stream);
  cdem_vtk_begin_data(stream, "PolyData");
  CDEM_TRY(cdem_vtk_put(v->output, v->grains->xyz, 24 * n, fault));
  CDEM_TRY(point_arrays(v, true, fault));
  count_from(v, 0);
  CDEM_TRY(cdem_vtk_put(v->output, v->number, 8 * n, fault));
  count_from(v, 1);
  CDEM_TRY(cdem_vtk_put(v->output, v->number, 8 * n, fault));
  cdem_vtk_end(stream);
  return cdem_output_commit(&v->output, fault);
}

static cdem_status write_vtp(const char *path, const cdem_grains *grains, int64_t names,
                             const char *const *name, cdem_fault *fault) {
  vtp v = {.grains = grains};
  CDEM_NEW(v.number, grains->grains, fault);
  cdem_status status = cdem_output_open(path, &v.output, fault);
  if (status == CDEM_OK) {
    v.header = (cdem_vtk_header){cdem_output_stream(v.output), 0};
    status = put_vtp(&v, names, name, fault);
  }
  cdem_output_discard(&v.output);
  free(v.number);
  return status;
}

static bool has_ending(const char *path, const char *ending) {
  size_t length = strlen(path), tail = strlen(ending);
  return length >= tail && strcmp(path + length - tail, ending) == 0;
}

cdem_status cdem_write_grains(const char *path, const cdem_grains *grains, int64_t names,
                              const char *const *name, cdem_fault *fault) {
  bool is_vtp = has_ending(path, ".vtp");
  CDEM_REQUIRE(is_vtp || has_ending(path, ".csv") || strcmp(path, "-") == 0, fault, CDEM_INPUT,
               "the ending of '%s' names no file of grains; .csv or .vtp is wanted", path);
  CDEM_TRY(cdem_grains_check(grains, fault));
  for (int64_t i = 0; i < grains->grains && grains->material != NULL; i++)
    CDEM_REQUIRE(grains->material[i] >= 0 && grains->material[i] < names, fault, CDEM_INPUT,
                 "grain %" PRId64 " is of material %d; there are %" PRId64 " names", i,
                 grains->material[i], names);
  return is_vtp ? write_vtp(path, grains, names, name, fault)
                : write_table(path, grains, name, fault);
}
