/* Springs as VTK XML (ParaView): one line cell per row of a spring set, .vtp or .vtu.
 *
 * The header says how many lines there are, which is known only at the end, so each column goes to
 * a nameless scratch file of its own and is copied behind the header at commit. */
#include "io/output.h"
#include "io/springs.h"
#include "io/vtk_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { SCRATCH_BUFFER = 1 << 18, COPY = 1 << 20, LINE = 3 /* VTK's number of that cell type */ };
enum {
  CONNECTIVITY,
  STIFFNESS,
  COUPLING,
  DIRECTION,
  DUAL,
  COND,
  ELEMENT,
  CLASS,
  FORM,
  SPRING,
  COUPLES_TO,
  COLUMNS
};

static const struct {
  const char *name, *type;
  int components, bytes; /* of one component */
} columns[COLUMNS] = {
    [CONNECTIVITY] = {"connectivity", "Int64", 2, 8},
    [STIFFNESS] = {"stiffness", "Float64", 1, 8},
    [COUPLING] = {"coupling", "Float64", 1, 8},
    [DIRECTION] = {"direction", "Float64", 3, 8},
    [DUAL] = {"dual", "Float64", 3, 8},
    [COND] = {"cond", "Float64", 1, 8},
    [ELEMENT] = {"element", "Int64", 1, 8},
    [CLASS] = {"class", "UInt8", 1, 1},
    [FORM] = {"form", "UInt8", 1, 1},
    [SPRING] = {"spring", "UInt8", 1, 1},
    [COUPLES_TO] = {"couples_to", "UInt8", 1, 1},
};

typedef struct {
  cdem_springs_writer writer;
  const cdem_model *model;
  bool poly; /* .vtp */
  cdem_output *output;
  int64_t lines;
  FILE *scratch[COLUMNS];
} vtk_writer;

static int64_t line_bytes(int c) {
  return (int64_t)columns[c].components * columns[c].bytes;
}

/* ---- encoding: the columns of a chunk, one behind the other ---- */

static int64_t count_lines(const cdem_chunk *chunk) {
  int64_t lines = 0;
  for (int64_t i = 0; i < chunk->pairs; i++)
    lines += chunk->pair[i].set.rows;
  return lines;
}

static void encode_row(const cdem_model *model, const cdem_pair *pair, const cdem_spring_row *row,
                       int64_t line, char *const column[COLUMNS]) {
  bool solid = model->formulation == CDEM_SOLID;
  const int64_t node[2] = {pair->node[0], pair->node[1]};
  const int64_t element = cdem_pair_element_tag(model, pair);
  const double direction[3] = {row->dir[0], row->dir[1], solid ? row->dir[2] : 0.0};
  const double dual[3] = {row->dual[0], row->dual[1], solid ? row->dual[2] : 0.0};
  const void *const value[COLUMNS] = {[CONNECTIVITY] = node,
                                      [STIFFNESS] = &row->stiffness,
                                      [COUPLING] = &row->coupling,
                                      [DIRECTION] = direction,
                                      [DUAL] = dual,
                                      [COND] = &pair->set.cond,
                                      [ELEMENT] = &element,
                                      [CLASS] = &pair->class_,
                                      [FORM] = &pair->set.form,
                                      [SPRING] = &row->spring,
                                      [COUPLES_TO] = &row->couples_to};
  for (int c = 0; c < COLUMNS; c++)
    memcpy(column[c] + line * line_bytes(c), value[c], (size_t)line_bytes(c));
}

static cdem_status encode(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                          cdem_fault *fault) {
  (void)context;
  int64_t lines = count_lines(chunk), bytes = 0, line = 0;
  char *column[COLUMNS];
  for (int c = 0; c < COLUMNS; c++)
    bytes += lines * line_bytes(c);
  CDEM_TRY(cdem_buffer_reserve(buffer, bytes, fault));
  column[0] = buffer->data + buffer->used;
  for (int c = 1; c < COLUMNS; c++)
    column[c] = column[c - 1] + lines * line_bytes(c - 1);
  for (int64_t i = 0; i < chunk->pairs; i++)
    for (int r = 0; r < chunk->pair[i].set.rows; r++)
      encode_row(chunk->model, &chunk->pair[i], &chunk->pair[i].set.row[r], line++, column);
  buffer->used += bytes;
  return CDEM_OK;
}

static cdem_status write_chunk(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                               cdem_fault *fault) {
  vtk_writer *vtk = context;
  int64_t lines = count_lines(chunk);
  const char *column = buffer->data;
  for (int c = 0; c < COLUMNS; c++) {
    size_t bytes = (size_t)(lines * line_bytes(c));
    errno = 0;
    if (fwrite(column, 1, bytes, vtk->scratch[c]) != bytes)
      return cdem_output_fail(vtk->output, errno != 0 ? errno : EIO, fault);
    column += bytes;
  }
  vtk->lines += lines;
  return CDEM_OK;
}

/* ---- the header: arrays are announced in the order in which they follow ---- */

static void announce(cdem_vtk_header *header, const char *type, const char *name, int components,
                     uint64_t bytes) {
  cdem_vtk_announce(header, &(cdem_vtk_array){type, name, NULL, components, bytes});
}

static void announce_column(cdem_vtk_header *header, const vtk_writer *vtk, int c) {
  /* VTK wants connectivity as one long list. */
  announce(header, columns[c].type, columns[c].name, c == CONNECTIVITY ? 1 : columns[c].components,
           (uint64_t)(vtk->lines * line_bytes(c)));
}

static void put_fields(FILE *stream, const cdem_model *model) {
  const char *classes[CDEM_CLASS_COUNT], *forms[CDEM_FORM_COUNT];
  const char *formula =
      cdem_model_is_cosserat(model) ? CDEM_SPRINGS_FORMULA_COSSERAT : CDEM_SPRINGS_FORMULA;
  for (int i = 0; i < CDEM_CLASS_COUNT; i++)
    classes[i] = cdem_class_name((cdem_class)i);
  for (int i = 0; i < CDEM_FORM_COUNT; i++)
    forms[i] = cdem_form_name((cdem_form)i);
  fputs("    <FieldData>\n", stream);
  cdem_vtk_texts(stream, "class names", classes, CDEM_CLASS_COUNT);
  cdem_vtk_texts(stream, "form names", forms, CDEM_FORM_COUNT);
  cdem_vtk_texts(stream, "formula", &formula, 1);
  fputs("    </FieldData>\n", stream);
}

static void put_header(const vtk_writer *vtk, FILE *stream) {
  const cdem_mesh *mesh = vtk->model->mesh;
  const char *kind = vtk->poly ? "PolyData" : "UnstructuredGrid";
  const char *cells = vtk->poly ? "Lines" : "Cells";
  cdem_vtk_header header = {stream, 0};
  cdem_vtk_begin(stream, kind);
  put_fields(stream, vtk->model);
  fprintf(stream, "    <Piece NumberOfPoints=\"%d\" NumberOf%s=\"%" PRId64 "\">\n", mesh->nodes,
          cells, vtk->lines);
  fputs("      <Points>\n", stream);
  announce(&header, "Float64", "Points", 3, (uint64_t)mesh->nodes * 24);
  fputs("      </Points>\n      <PointData>\n", stream);
  announce(&header, "Int64", "tag", 1, (uint64_t)mesh->nodes * 8);
  fprintf(stream, "      </PointData>\n      <%s>\n", cells);
  announce_column(&header, vtk, CONNECTIVITY);
  announce(&header, "Int64", "offsets", 1, (uint64_t)vtk->lines * 8);
  if (!vtk->poly)
    announce(&header, "UInt8", "types", 1, (uint64_t)vtk->lines);
  fprintf(stream, "      </%s>\n      <CellData Scalars=\"stiffness\" Vectors=\"direction\">\n",
          cells);
  for (int c = CONNECTIVITY + 1; c < COLUMNS; c++)
    announce_column(&header, vtk, c);
  fputs("      </CellData>\n    </Piece>\n", stream);
  cdem_vtk_begin_data(stream, kind);
}

/* ---- the arrays ---- */

static cdem_status put_column(const vtk_writer *vtk, int c, char *copy, cdem_fault *fault) {
  uint64_t left = (uint64_t)(vtk->lines * line_bytes(c));
  CDEM_TRY(cdem_vtk_put(vtk->output, NULL, left, fault));
  errno = 0;
  if (fflush(vtk->scratch[c]) != 0 || fseeko(vtk->scratch[c], 0, SEEK_SET) != 0)
    return cdem_output_fail(vtk->output, errno != 0 ? errno : EIO, fault);
  while (left > 0) {
    size_t now = left < COPY ? (size_t)left : COPY;
    if (fread(copy, 1, now, vtk->scratch[c]) != now)
      return cdem_output_fail(vtk->output, EIO, fault);
    CDEM_TRY(cdem_output_write(vtk->output, copy, now, fault));
    left -= now;
  }
  return CDEM_OK;
}

/* offsets 2 4 6 ..., and for .vtu the cell types. */
static cdem_status put_offsets(const vtk_writer *vtk, char *copy, cdem_fault *fault) {
  CDEM_TRY(cdem_vtk_put(vtk->output, NULL, (uint64_t)vtk->lines * 8, fault));
  for (int64_t line = 1; line <= vtk->lines; line++) {
    int64_t offset = 2 * line;
    CDEM_TRY(cdem_output_write(vtk->output, &offset, sizeof offset, fault));
  }
  if (vtk->poly)
    return CDEM_OK;
  CDEM_TRY(cdem_vtk_put(vtk->output, NULL, (uint64_t)vtk->lines, fault));
  memset(copy, LINE, COPY);
  for (int64_t left = vtk->lines; left > 0; left -= COPY)
    CDEM_TRY(cdem_output_write(vtk->output, copy, (size_t)(left < COPY ? left : COPY), fault));
  return CDEM_OK;
}

static cdem_status put_arrays(const vtk_writer *vtk, char *copy, cdem_fault *fault) {
  const cdem_mesh *mesh = vtk->model->mesh;
  CDEM_TRY(cdem_vtk_put(vtk->output, mesh->xyz, (uint64_t)mesh->nodes * 24, fault));
  CDEM_TRY(cdem_vtk_put(vtk->output, mesh->node_tag, (uint64_t)mesh->nodes * 8, fault));
  CDEM_TRY(put_column(vtk, CONNECTIVITY, copy, fault));
  CDEM_TRY(put_offsets(vtk, copy, fault));
  for (int c = CONNECTIVITY + 1; c < COLUMNS; c++)
    CDEM_TRY(put_column(vtk, c, copy, fault));
  cdem_vtk_end(cdem_output_stream(vtk->output));
  return CDEM_OK;
}

static cdem_status commit(cdem_springs_writer *writer, cdem_fault *fault) {
  vtk_writer *vtk = (vtk_writer *)writer;
  char *copy;
  CDEM_NEW(copy, COPY, fault);
  put_header(vtk, cdem_output_stream(vtk->output));
  cdem_status status = put_arrays(vtk, copy, fault);
  free(copy);
  return status == CDEM_OK ? cdem_output_commit(&vtk->output, fault) : status;
}

static void destroy(cdem_springs_writer *writer) {
  vtk_writer *vtk = (vtk_writer *)writer;
  for (int c = 0; c < COLUMNS; c++)
    if (vtk->scratch[c] != NULL)
      fclose(vtk->scratch[c]);
  cdem_output_discard(&vtk->output);
  free(vtk);
}

static cdem_status open_vtk(const char *path, const cdem_model *model, bool poly,
                            cdem_springs_writer **writer, cdem_fault *fault) {
  vtk_writer *vtk;
  *writer = NULL;
  CDEM_NEW(vtk, 1, fault);
  vtk->model = model;
  vtk->poly = poly;
  vtk->writer = (cdem_springs_writer){
      .sink = {vtk, encode, write_chunk}, .commit = commit, .destroy = destroy};
  cdem_status status = cdem_output_open(path, &vtk->output, fault);
  for (int c = 0; c < COLUMNS && status == CDEM_OK; c++) {
    status = cdem_output_scratch(vtk->output, &vtk->scratch[c], fault);
    if (status == CDEM_OK)
      setvbuf(vtk->scratch[c], NULL, _IOFBF, SCRATCH_BUFFER);
  }
  if (status == CDEM_OK)
    *writer = &vtk->writer;
  else
    destroy(&vtk->writer);
  return status;
}

static cdem_status open_vtp(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                            cdem_fault *fault) {
  return open_vtk(path, model, true, writer, fault);
}

static cdem_status open_vtu(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                            cdem_fault *fault) {
  return open_vtk(path, model, false, writer, fault);
}

const cdem_springs_format cdem_springs_vtp = {
    "vtp", ".vtp", "lines for ParaView, with stiffness and direction as cell data", open_vtp,
    false};
const cdem_springs_format cdem_springs_vtu = {
    "vtu", ".vtu", "the same lines as an unstructured grid", open_vtu, false};
