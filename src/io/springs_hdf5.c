/* Springs as HDF5: compact, one row per pair, for meshes of millions of elements.
 *
 * /springs/NAME has one row per pair. element, node_i, node_j, kind, class, form and cond have one
 * value a row; stiffness, coupling, couples_to, dir_* and dual_* one for each of the first `dofs`
 * springs. What does not fit there - a frame's fourth spring, a second coupling of one spring -
 * stands in /extra/NAME, `pair` being the row it belongs to. kind, class and form are small
 * integers whose names are the attribute `names`. /nodes holds tags and coordinates.
 *
 * Encoding lays a chunk's columns one behind the other in the buffer; writing copies them to one
 * stage a column, and a full stage is one HDF5 chunk, written whole and once. Stages of coupling
 * and couples_to that hold only zeros are not written at all: HDF5 gives zeros back for chunks
 * that are not there. */
#include "io/hdf5_driver.h"
#include "io/hdf5_tools.h"
#include "io/output.h"
#include "io/springs.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { STAGE_ROWS = 32768, EXTRA_ROWS = 8192, LARGEST_NAMES = 32 };
enum { PAIRS, EXTRA, TABLES };
enum { TAG, REAL, CODE };

/* The columns of both tables. Of the three components only the first `dofs` are there. */
enum {
  ELEMENT,
  NODE_I,
  NODE_J,
  COND,
  STIFFNESS,
  COUPLING,
  DIR,
  DUAL = DIR + 3,
  KIND = DUAL + 3,
  CLASS,
  FORM,
  COUPLES_TO,
  X_PAIR,
  X_STIFFNESS,
  X_COUPLING,
  X_DIR,
  X_DUAL = X_DIR + 3,
  X_SPRING = X_DUAL + 3,
  X_COUPLES_TO,
  COLUMNS
};

static const struct {
  const char *name, *cosserat, *unit;
  int table, type, component;
  bool per_spring, sparse;
} columns[COLUMNS] = {
    [ELEMENT] = {"element", NULL, NULL, PAIRS, TAG, 0, false, false},
    [NODE_I] = {"node_i", NULL, NULL, PAIRS, TAG, 0, false, false},
    [NODE_J] = {"node_j", NULL, NULL, PAIRS, TAG, 0, false, false},
    [COND] = {"cond", NULL, NULL, PAIRS, REAL, 0, false, false},
    [STIFFNESS] = {"stiffness", NULL, "N/m", PAIRS, REAL, 0, true, false},
    [COUPLING] = {"coupling", NULL, "N/m", PAIRS, REAL, 0, true, true},
    [DIR] = {"dir_x", NULL, NULL, PAIRS, REAL, 0, true, false},
    [DIR + 1] = {"dir_y", NULL, NULL, PAIRS, REAL, 1, true, false},
    [DIR + 2] = {"dir_z", "dir_rz", NULL, PAIRS, REAL, 2, true, false},
    [DUAL] = {"dual_x", NULL, NULL, PAIRS, REAL, 0, true, false},
    [DUAL + 1] = {"dual_y", NULL, NULL, PAIRS, REAL, 1, true, false},
    [DUAL + 2] = {"dual_z", "dual_rz", NULL, PAIRS, REAL, 2, true, false},
    [KIND] = {"kind", NULL, NULL, PAIRS, CODE, 0, false, false},
    [CLASS] = {"class", NULL, NULL, PAIRS, CODE, 0, false, false},
    [FORM] = {"form", NULL, NULL, PAIRS, CODE, 0, false, false},
    [COUPLES_TO] = {"couples_to", NULL, NULL, PAIRS, CODE, 0, true, true},
    [X_PAIR] = {"pair", NULL, NULL, EXTRA, TAG, 0, false, false},
    [X_STIFFNESS] = {"stiffness", NULL, "N/m", EXTRA, REAL, 0, false, false},
    [X_COUPLING] = {"coupling", NULL, "N/m", EXTRA, REAL, 0, false, true},
    [X_DIR] = {"dir_x", NULL, NULL, EXTRA, REAL, 0, false, false},
    [X_DIR + 1] = {"dir_y", NULL, NULL, EXTRA, REAL, 1, false, false},
    [X_DIR + 2] = {"dir_z", "dir_rz", NULL, EXTRA, REAL, 2, false, false},
    [X_DUAL] = {"dual_x", NULL, NULL, EXTRA, REAL, 0, false, false},
    [X_DUAL + 1] = {"dual_y", NULL, NULL, EXTRA, REAL, 1, false, false},
    [X_DUAL + 2] = {"dual_z", "dual_rz", NULL, EXTRA, REAL, 2, false, false},
    [X_SPRING] = {"spring", NULL, NULL, EXTRA, CODE, 0, false, false},
    [X_COUPLES_TO] = {"couples_to", NULL, NULL, EXTRA, CODE, 0, false, true},
};

typedef struct {
  hsize_t written; /* rows in the file */
  int64_t staged;  /* rows waiting */
  int64_t room;    /* rows of a stage, which is one HDF5 chunk */
} h5_table;

typedef struct {
  cdem_springs_writer writer;
  const cdem_model *model;
  cdem_output *output;
  cdem_hdf5_target target;
  hid_t driver, access, file;
  hid_t dataset[COLUMNS];
  char *stage[COLUMNS];
  h5_table table[TABLES];
} h5_writer;

/* A column is there; its bytes a row. */
static bool has(const cdem_model *model, int c) {
  return columns[c].component < model->dofs;
}

static int64_t row_bytes(const cdem_model *model, int c) {
  return (columns[c].type == CODE ? 1 : 8) * (columns[c].per_spring ? model->dofs : 1);
}

static cdem_status fail(const h5_writer *h5, cdem_fault *fault) {
  if (h5->target.error != 0)
    return cdem_output_fail(h5->output, h5->target.error, fault);
  return cdem_fail(fault, CDEM_FILE,
                   "cannot write '%s': the HDF5 library failed; write .csv instead",
                   cdem_output_name(h5->output));
}

/* ---- encoding ---- */

/* What stands first in a buffer; the columns follow, each beginning at a multiple of 8 bytes. */
typedef struct {
  int64_t rows[TABLES];
} h5_header;

static int64_t padded(int64_t bytes) {
  return (bytes + 7) / 8 * 8;
}

/* Where each column of a chunk stands in the buffer; returns the bytes of the whole. */
static int64_t lay_out(const cdem_model *model, const h5_header *header, int64_t offset[COLUMNS]) {
  int64_t end = sizeof *header;
  for (int c = 0; c < COLUMNS; c++) {
    offset[c] = end;
    if (has(model, c))
      end += padded(header->rows[columns[c].table] * row_bytes(model, c));
  }
  return end;
}

/* Does row r of the set stand in the slot of its spring? The first row of each spring within the
 * first `dofs` does. */
static bool has_slot(const cdem_spring_set *set, int r, int dofs) {
  if (set->row[r].spring > dofs)
    return false;
  for (int before = 0; before < r; before++)
    if (set->row[before].spring == set->row[r].spring)
      return false;
  return true;
}

static void put_real(char *column, int64_t at, double value) {
  memcpy(column + 8 * at, &value, sizeof value);
}

static void put_tag(char *column, int64_t at, int64_t value) {
  memcpy(column + 8 * at, &value, sizeof value);
}

/* Pair i of the chunk; x counts the extra rows so far. */
static void encode_pair(const cdem_model *model, const cdem_pair *pair, int64_t i,
                        char *const column[COLUMNS], int64_t *x) {
  int dofs = model->dofs;
  put_tag(column[ELEMENT], i, cdem_pair_element_tag(model, pair));
  put_tag(column[NODE_I], i, model->mesh->node_tag[pair->node[0]]);
  put_tag(column[NODE_J], i, model->mesh->node_tag[pair->node[1]]);
  put_real(column[COND], i, pair->set.cond);
  column[KIND][i] = (char)model->kind[pair->index];
  column[CLASS][i] = (char)pair->class_;
  column[FORM][i] = (char)pair->set.form;
  for (int r = 0; r < pair->set.rows; r++) {
    const cdem_spring_row *row = &pair->set.row[r];
    bool slot = has_slot(&pair->set, r, dofs);
    int64_t at = slot ? i * dofs + row->spring - 1 : *x;
    put_real(column[slot ? STIFFNESS : X_STIFFNESS], at, row->stiffness);
    put_real(column[slot ? COUPLING : X_COUPLING], at, row->coupling);
    for (int a = 0; a < dofs; a++) {
      put_real(column[(slot ? DIR : X_DIR) + a], at, row->dir[a]);
      put_real(column[(slot ? DUAL : X_DUAL) + a], at, row->dual[a]);
    }
    column[slot ? COUPLES_TO : X_COUPLES_TO][at] = row->couples_to;
    if (!slot) {
      put_tag(column[X_PAIR], at, i);
      column[X_SPRING][at] = row->spring;
      ++*x;
    }
  }
}

static cdem_status encode(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                          cdem_fault *fault) {
  (void)context;
  h5_header header = {{chunk->pairs, 0}};
  for (int64_t i = 0; i < chunk->pairs; i++)
    for (int r = 0; r < chunk->pair[i].set.rows; r++)
      header.rows[EXTRA] += !has_slot(&chunk->pair[i].set, r, chunk->model->dofs);
  int64_t offset[COLUMNS], bytes = lay_out(chunk->model, &header, offset), x = 0;
  CDEM_TRY(cdem_buffer_reserve(buffer, bytes, fault));
  char *data = buffer->data + buffer->used, *column[COLUMNS];
  memset(data, 0, (size_t)bytes);
  memcpy(data, &header, sizeof header);
  for (int c = 0; c < COLUMNS; c++)
    column[c] = data + offset[c];
  for (int64_t i = 0; i < chunk->pairs; i++)
    encode_pair(chunk->model, &chunk->pair[i], i, column, &x);
  buffer->used += bytes;
  return CDEM_OK;
}

/* ---- writing ---- */

static hid_t memory_type(int type) {
  return type == TAG ? H5T_NATIVE_INT64 : type == REAL ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT8;
}

static bool is_zero(const char *data, int64_t bytes) {
  return bytes == 0 || (data[0] == 0 && memcmp(data, data + 1, (size_t)bytes - 1) == 0);
}

/* Appends the staged rows of column c to its dataset. */
static bool append_column(h5_writer *h5, int c) {
  const h5_table *table = &h5->table[columns[c].table];
  int rank = columns[c].per_spring ? 2 : 1;
  hsize_t count[2] = {(hsize_t)table->staged, (hsize_t)h5->model->dofs};
  hsize_t start[2] = {table->written, 0};
  hsize_t extent[2] = {table->written + count[0], count[1]};
  if (H5Dset_extent(h5->dataset[c], extent) < 0)
    return false;
  if (columns[c].sparse && is_zero(h5->stage[c], table->staged * row_bytes(h5->model, c)))
    return true;
  hid_t file = H5Dget_space(h5->dataset[c]), memory = H5Screate_simple(rank, count, NULL);
  bool good = file >= 0 && memory >= 0 &&
              H5Sselect_hyperslab(file, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
              H5Dwrite(h5->dataset[c], memory_type(columns[c].type), memory, file, H5P_DEFAULT,
                       h5->stage[c]) >= 0;
  if (memory >= 0)
    H5Sclose(memory);
  if (file >= 0)
    H5Sclose(file);
  return good;
}

static cdem_status flush_table(h5_writer *h5, int table, cdem_fault *fault) {
  if (h5->table[table].staged == 0)
    return CDEM_OK;
  for (int c = 0; c < COLUMNS; c++)
    if (columns[c].table == table && has(h5->model, c))
      if (!append_column(h5, c) || h5->target.error != 0)
        return fail(h5, fault);
  h5->table[table].written += (hsize_t)h5->table[table].staged;
  h5->table[table].staged = 0;
  return CDEM_OK;
}

/* Moves `rows` rows of one table from the buffer to the stages. */
static cdem_status stage_rows(h5_writer *h5, int table, const char *data,
                              const int64_t offset[COLUMNS], int64_t rows, cdem_fault *fault) {
  h5_table *t = &h5->table[table];
  for (int64_t done = 0; done < rows;) {
    int64_t now = rows - done < t->room - t->staged ? rows - done : t->room - t->staged;
    for (int c = 0; c < COLUMNS; c++) {
      if (columns[c].table != table || !has(h5->model, c))
        continue;
      int64_t bytes = row_bytes(h5->model, c);
      memcpy(h5->stage[c] + t->staged * bytes, data + offset[c] + done * bytes,
             (size_t)(now * bytes));
    }
    t->staged += now;
    done += now;
    if (t->staged == t->room)
      CDEM_TRY(flush_table(h5, table, fault));
  }
  return CDEM_OK;
}

static cdem_status write_chunk(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                               cdem_fault *fault) {
  (void)chunk;
  h5_writer *h5 = context;
  h5_header header;
  int64_t offset[COLUMNS];
  memcpy(&header, buffer->data, sizeof header);
  lay_out(h5->model, &header, offset);
  /* Pairs of extra rows were counted from the start of the chunk. */
  int64_t first = (int64_t)h5->table[PAIRS].written + h5->table[PAIRS].staged;
  char *pair = buffer->data + offset[X_PAIR];
  for (int64_t i = 0; i < header.rows[EXTRA]; i++) {
    int64_t at;
    memcpy(&at, pair + 8 * i, sizeof at);
    put_tag(pair, i, at + first);
  }
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  cdem_status status = stage_rows(h5, PAIRS, buffer->data, offset, header.rows[PAIRS], fault);
  if (status == CDEM_OK)
    status = stage_rows(h5, EXTRA, buffer->data, offset, header.rows[EXTRA], fault);
  cdem_hdf5_silence_end(before);
  return status;
}

/* ---- what is written once: attributes, nodes, empty datasets ---- */

static cdem_status put_materials(h5_writer *h5, cdem_fault *fault) {
  const cdem_model *model = h5->model;
  char **text;
  CDEM_NEW(text, model->materials, fault);
  cdem_status status = CDEM_OK;
  for (int i = 0; i < model->materials && status == CDEM_OK; i++)
    if ((text[i] = cdem_material_text(&model->materials_of[i], fault)) == NULL)
      status = CDEM_MEMORY;
  if (status == CDEM_OK && model->materials > 0 &&
      !cdem_hdf5_put_texts(h5->file, "material", (const char *const *)text, model->materials))
    status = fail(h5, fault);
  for (int i = 0; i < model->materials; i++)
    free(text[i]);
  free(text);
  return status;
}

static cdem_status put_settings(h5_writer *h5, cdem_fault *fault) {
  static const char *const formulations[] = {"solid", "plane", "plane-cosserat"};
  const cdem_model *model = h5->model;
  const int version = 1;
  bool plane = model->formulation != CDEM_SOLID;
  bool good =
      cdem_hdf5_put_text(h5->file, "format", "cdem springs") &&
      cdem_hdf5_put_scalar(h5->file, "format_version", H5T_NATIVE_INT, &version) &&
      cdem_hdf5_put_program(h5->file) &&
      cdem_hdf5_put_text(h5->file, "mesh",
                         model->mesh->source != NULL ? model->mesh->source : "generated") &&
      cdem_hdf5_put_scalar(h5->file, "dimension", H5T_NATIVE_INT, &model->dimension) &&
      cdem_hdf5_put_scalar(h5->file, "dofs", H5T_NATIVE_INT, &model->dofs) &&
      cdem_hdf5_put_text(h5->file, "formulation", formulations[model->formulation]) &&
      cdem_hdf5_put_scalar(h5->file, "length", H5T_NATIVE_DOUBLE, &model->length) &&
      cdem_hdf5_put_text(h5->file, "formula",
                         cdem_model_is_cosserat(model) ? CDEM_SPRINGS_FORMULA_COSSERAT
                                                       : CDEM_SPRINGS_FORMULA) &&
      cdem_hdf5_put_text(
          h5->file, "layout",
          "row p of /springs is a pair; columns of two dimensions hold springs 1 .. dofs; "
          "couples_to counts springs from 1, 0 is none; /extra holds further rows of "
          "pair p; the attribute names of kind, class and form lists what the integers mean");
  if (good && plane)
    good =
        cdem_hdf5_put_text(h5->file, "plane",
                           model->section.plane == CDEM_PLANE_STRESS ? "stress" : "strain") &&
        cdem_hdf5_put_scalar(h5->file, "thickness", H5T_NATIVE_DOUBLE, &model->section.thickness);
  return good ? put_materials(h5, fault) : fail(h5, fault);
}

static bool put_array(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size,
                      const void *data) {
  return cdem_hdf5_put_dataset(group, name, type, rank, size, H5P_DEFAULT,
                               cdem_hdf5_dataset_properties(), data);
}

static cdem_status put_nodes(h5_writer *h5, cdem_fault *fault) {
  const cdem_mesh *mesh = h5->model->mesh;
  const hsize_t size[2] = {(hsize_t)mesh->nodes, 3};
  hid_t group = H5Gcreate2(h5->file, "nodes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  bool good = group >= 0 && cdem_hdf5_put_text(group, "unit", "m") &&
              put_array(group, "tag", H5T_NATIVE_INT64, 1, size, mesh->node_tag) &&
              put_array(group, "xyz", H5T_NATIVE_DOUBLE, 2, size, mesh->xyz);
  if (group >= 0)
    H5Gclose(group);
  return good ? CDEM_OK : fail(h5, fault);
}

/* The attribute `names` of the three coded columns. */
static bool put_names(const h5_writer *h5, int c) {
  const char *name[LARGEST_NAMES] = {NULL};
  int count = 0;
  if (c == KIND)
    for (; count < h5->model->kinds && count < LARGEST_NAMES; count++)
      name[count] = h5->model->kinds_of[count].tabulation.element->name;
  if (c == CLASS)
    for (; count < CDEM_CLASS_COUNT; count++)
      name[count] = cdem_class_name((cdem_class)count);
  if (c == FORM)
    for (; count < CDEM_FORM_COUNT; count++)
      name[count] = cdem_form_name((cdem_form)count);
  return count == 0 || cdem_hdf5_put_texts(h5->dataset[c], "names", name, count);
}

static bool create_dataset(h5_writer *h5, hid_t group, int c) {
  int rank = columns[c].per_spring ? 2 : 1;
  const hsize_t size[2] = {0, (hsize_t)h5->model->dofs};
  const hsize_t most[2] = {H5S_UNLIMITED, size[1]};
  const hsize_t chunk[2] = {(hsize_t)h5->table[columns[c].table].room, size[1]};
  const char *name = cdem_model_is_cosserat(h5->model) && columns[c].cosserat != NULL
                         ? columns[c].cosserat
                         : columns[c].name;
  hid_t space = H5Screate_simple(rank, size, most), create = cdem_hdf5_dataset_properties();
  hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
  /* Stages are chunks already: HDF5's own cache would only hold them once more. */
  bool good = space >= 0 && create >= 0 && access >= 0 && H5Pset_chunk(create, rank, chunk) >= 0 &&
              H5Pset_chunk_cache(access, 1, 0, 1.0) >= 0;
  if (good)
    h5->dataset[c] =
        H5Dcreate2(group, name, memory_type(columns[c].type), space, H5P_DEFAULT, create, access);
  if (access >= 0)
    H5Pclose(access);
  if (create >= 0)
    H5Pclose(create);
  if (space >= 0)
    H5Sclose(space);
  return h5->dataset[c] >= 0 && put_names(h5, c) &&
         (columns[c].unit == NULL || cdem_hdf5_put_text(h5->dataset[c], "unit", columns[c].unit));
}

static cdem_status create_tables(h5_writer *h5, cdem_fault *fault) {
  hid_t group[TABLES] = {-1, -1};
  group[PAIRS] = H5Gcreate2(h5->file, "springs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group[PAIRS] >= 0)
    group[EXTRA] = H5Gcreate2(h5->file, "extra", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  bool good = group[EXTRA] >= 0;
  for (int c = 0; c < COLUMNS && good; c++)
    if (has(h5->model, c))
      good = create_dataset(h5, group[columns[c].table], c);
  for (int t = 0; t < TABLES; t++)
    if (group[t] >= 0)
      H5Gclose(group[t]);
  return good ? CDEM_OK : fail(h5, fault);
}

/* ---- life ---- */

/* Closes everything of HDF5; what went wrong stays in target.error. */
static void close_file(h5_writer *h5) {
  for (int c = 0; c < COLUMNS; c++)
    if (h5->dataset[c] >= 0 && H5Dclose(h5->dataset[c]) < 0 && h5->target.error == 0)
      h5->target.error = EIO;
  if (h5->file >= 0 && H5Fclose(h5->file) < 0 && h5->target.error == 0)
    h5->target.error = EIO;
  if (h5->access >= 0)
    H5Pclose(h5->access);
  if (h5->driver >= 0)
    H5FDunregister(h5->driver);
  for (int c = 0; c < COLUMNS; c++)
    h5->dataset[c] = -1;
  h5->file = h5->access = h5->driver = -1;
}

static cdem_status commit(cdem_springs_writer *writer, cdem_fault *fault) {
  h5_writer *h5 = (h5_writer *)writer;
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  cdem_status status = flush_table(h5, PAIRS, fault);
  if (status == CDEM_OK)
    status = flush_table(h5, EXTRA, fault);
  close_file(h5);
  cdem_hdf5_silence_end(before);
  if (status == CDEM_OK && h5->target.error != 0)
    status = fail(h5, fault);
  if (status == CDEM_OK)
    return cdem_output_commit(&h5->output, fault);
  cdem_output_discard(&h5->output);
  return status;
}

static void destroy(cdem_springs_writer *writer) {
  h5_writer *h5 = (h5_writer *)writer;
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  close_file(h5);
  cdem_hdf5_silence_end(before);
  cdem_output_discard(&h5->output);
  for (int c = 0; c < COLUMNS; c++)
    free(h5->stage[c]);
  free(h5);
}

static cdem_status open_file(h5_writer *h5, const char *path, cdem_fault *fault) {
  CDEM_TRY(cdem_output_open(path, &h5->output, fault));
  CDEM_REQUIRE(cdem_output_is_file(h5->output), fault, CDEM_FILE,
               "cannot write '%s': HDF5 needs a regular file; give a file name with -o or write "
               ".csv instead",
               path);
  int64_t pairs = h5->model->pairs > 0 ? h5->model->pairs : 1;
  h5->table[PAIRS].room = pairs < STAGE_ROWS ? pairs : STAGE_ROWS;
  h5->table[EXTRA].room = pairs < EXTRA_ROWS ? pairs : EXTRA_ROWS;
  for (int c = 0; c < COLUMNS; c++)
    if (has(h5->model, c))
      CDEM_NEW(h5->stage[c], h5->table[columns[c].table].room * row_bytes(h5->model, c), fault);
  h5->target.descriptor = cdem_output_descriptor(h5->output);
  h5->access = cdem_hdf5_access(&h5->target, &h5->driver);
  if (h5->access >= 0)
    h5->file = H5Fcreate(cdem_output_path(h5->output), H5F_ACC_TRUNC, H5P_DEFAULT, h5->access);
  if (h5->file < 0)
    return fail(h5, fault);
  CDEM_TRY(put_settings(h5, fault));
  CDEM_TRY(put_nodes(h5, fault));
  CDEM_TRY(create_tables(h5, fault));
  return h5->target.error == 0 ? CDEM_OK : fail(h5, fault);
}

static cdem_status open_hdf5(const char *path, const cdem_model *model,
                             cdem_springs_writer **writer, cdem_fault *fault) {
  h5_writer *h5;
  *writer = NULL;
  CDEM_NEW(h5, 1, fault);
  h5->model = model;
  h5->driver = h5->access = h5->file = -1;
  for (int c = 0; c < COLUMNS; c++)
    h5->dataset[c] = -1;
  h5->writer = (cdem_springs_writer){
      .sink = {h5, encode, write_chunk}, .commit = commit, .destroy = destroy};
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  cdem_status status = open_file(h5, path, fault);
  cdem_hdf5_silence_end(before);
  if (status == CDEM_OK)
    *writer = &h5->writer;
  else
    destroy(&h5->writer);
  return status;
}

const cdem_springs_format cdem_springs_hdf5 = {
    "h5", ".h5 .hdf5", "compact HDF5, one row per pair, for large meshes", open_hdf5, false};
