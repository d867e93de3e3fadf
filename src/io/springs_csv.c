/* Springs as CSV: one row per term of the spring tensor. Columns are a stable format. */
#include "io/output.h"
#include "io/springs.h"
#include "io/text.h"

#include <math.h>
#include <stdlib.h>

/* Most bytes of a row: 5 integers, 12 real numbers, names, commas. */
enum { ROW = 5 * CDEM_INTEGER_WIDTH + 12 * CDEM_REAL_WIDTH + 128 };

typedef struct {
  cdem_springs_writer writer;
  const cdem_model *model;
  cdem_output *output;
} csv_writer;

/* element,kind,node_i,node_j,class,form, - the same for all rows of a pair. */
static char *put_pair(char *at, const cdem_model *model, const cdem_pair *pair) {
  const int64_t *tag = model->mesh->node_tag;
  at = cdem_put_integer(at, cdem_pair_element_tag(model, pair));
  *at++ = ',';
  at = cdem_put_text(at, cdem_model_element(model, pair->index)->name);
  *at++ = ',';
  at = cdem_put_integer(at, tag[pair->node[0]]);
  *at++ = ',';
  at = cdem_put_integer(at, tag[pair->node[1]]);
  *at++ = ',';
  at = cdem_put_text(at, cdem_class_name((cdem_class)pair->class_));
  *at++ = ',';
  at = cdem_put_text(at, cdem_form_name((cdem_form)pair->set.form));
  *at++ = ',';
  return at;
}

/* ,x,y,z with z empty where the vector has two places. */
static char *put_vector(char *at, const double v[3], bool solid) {
  for (int c = 0; c < 3; c++) {
    *at++ = ',';
    if (c < 2 || solid)
      at = cdem_put_real(at, v[c]);
  }
  return at;
}

static char *put_row(char *at, const cdem_model *model, const cdem_spring_row *row, double cond) {
  bool solid = model->formulation == CDEM_SOLID;
  at = cdem_put_integer(at, row->spring);
  *at++ = ',';
  at = cdem_put_real(at, row->stiffness);
  *at++ = ',';
  if (row->couples_to != 0)
    at = cdem_put_integer(at, row->couples_to);
  *at++ = ',';
  if (row->couples_to != 0)
    at = cdem_put_real(at, row->coupling);
  at = put_vector(at, row->dir, solid);
  at = put_vector(at, row->dual, solid);
  *at++ = ',';
  if (!isnan(cond))
    at = cdem_put_real(at, cond);
  if (cdem_model_is_cosserat(model)) {
    *at++ = ',';
    at = cdem_put_real(at, row->dir[2]);
    *at++ = ',';
    at = cdem_put_real(at, row->dual[2]);
    *at++ = ',';
    at = cdem_put_real(at, model->length);
  }
  *at++ = '\n';
  return at;
}

static cdem_status encode(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                          cdem_fault *fault) {
  (void)context;
  int64_t rows = 0;
  for (int64_t i = 0; i < chunk->pairs; i++)
    rows += chunk->pair[i].set.rows;
  CDEM_TRY(cdem_buffer_reserve(buffer, rows * ROW, fault));
  char *at = buffer->data + buffer->used;
  for (int64_t i = 0; i < chunk->pairs; i++) {
    const cdem_pair *pair = &chunk->pair[i];
    char same[ROW];
    size_t length = (size_t)(put_pair(same, chunk->model, pair) - same);
    for (int r = 0; r < pair->set.rows; r++) {
      memcpy(at, same, length);
      at = put_row(at + length, chunk->model, &pair->set.row[r], pair->set.cond);
    }
  }
  buffer->used = at - buffer->data;
  return CDEM_OK;
}

static cdem_status write_chunk(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                               cdem_fault *fault) {
  (void)chunk;
  csv_writer *csv = context;
  return cdem_output_write(csv->output, buffer->data, (size_t)buffer->used, fault);
}

static cdem_status commit(cdem_springs_writer *writer, cdem_fault *fault) {
  return cdem_output_commit(&((csv_writer *)writer)->output, fault);
}

static void destroy(cdem_springs_writer *writer) {
  cdem_output_discard(&((csv_writer *)writer)->output);
  free(writer);
}

static cdem_status open_csv(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                            cdem_fault *fault) {
  csv_writer *csv;
  *writer = NULL;
  CDEM_NEW(csv, 1, fault);
  csv->model = model;
  csv->writer = (cdem_springs_writer){
      .sink = {csv, encode, write_chunk}, .commit = commit, .destroy = destroy};
  cdem_status status = cdem_output_open(path, &csv->output, fault);
  if (status == CDEM_OK) {
    fputs("element,kind,node_i,node_j,class,form,spring,stiffness,couples_to,coupling,"
          "dir_x,dir_y,dir_z,dual_x,dual_y,dual_z,cond",
          cdem_output_stream(csv->output));
    fputs(cdem_model_is_cosserat(model) ? ",dir_rz,dual_rz,length\n" : "\n",
          cdem_output_stream(csv->output));
    *writer = &csv->writer;
  } else {
    destroy(&csv->writer);
  }
  return status;
}

const cdem_springs_format cdem_springs_csv = {
    "csv", ".csv", "one row per term of the spring tensor, 17 significant digits", open_csv, false};
