/* The assembled network as a CalculiX deck of SPRING2 elements.
 *
 * A SPRING2 of stiffness k between degrees of freedom a and b stores k (u_a - u_b)^2 / 2. One with
 * k = -K_ab for every a < b gives each off-diagonal entry, and on the diagonal the sum of k over
 * b != a, which is K_aa exactly when row a of K sums to zero. It does: a row sum is the force of
 * the translation (1, 1, 1), and those of a classical network vanish. What is left above rounding
 * becomes a SPRING1 to the ground.
 *
 * CalculiX reads numbers from 20 columns, so values carry 14 significant digits. Degrees of freedom
 * of one node are coupled too (SPRING2 with the same node twice); CalculiX 2.20 takes that and
 * negative stiffness (tests/io/ccx.sh). */
#include "base/version.h"
#include "io/output.h"
#include "io/springs_matrix.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Entries below this part of the largest are left out: half the rounding of a 14-digit number. */
#define DROP 1e-15

enum { FIELD = 20 };

typedef struct {
  int32_t position[2]; /* [1] = -1: a spring to the ground */
  uint8_t component[2];
  double stiffness;
} inp_spring;

typedef struct {
  inp_spring *spring;
  int64_t springs, capacity;
} inp_list;

/* A number in C notation within FIELD columns; exponents of three digits lose one digit. */
static void put_field(char text[FIELD + 4], double value) {
  double size = fabs(value);
  int digits = size != 0.0 && (size < 1e-99 || size >= 1e100) ? 12 : 13;
  char raw[FIELD + 12];
  snprintf(raw, sizeof raw, "%.*e", digits, value);
  /* The locale's decimal sign may be any bytes but digits: they stand behind the first digit. */
  size_t whole = raw[0] == '-' ? 2 : 1;
  size_t sign = strcspn(raw + whole, "0123456789");
  memcpy(text, raw, whole);
  text[whole] = '.';
  snprintf(text + whole + 1, FIELD + 4 - whole - 1, "%s", raw + whole + sign);
}

/* Equal springs side by side. */
static int by_kind(const void *left, const void *right) {
  const inp_spring *a = left, *b = right;
  int by_component = memcmp(a->component, b->component, sizeof a->component);
  if (by_component != 0)
    return by_component;
  if (a->stiffness != b->stiffness)
    return a->stiffness < b->stiffness ? -1 : 1;
  for (int i = 0; i < 2; i++)
    if (a->position[i] != b->position[i])
      return a->position[i] < b->position[i] ? -1 : 1;
  return 0;
}

static cdem_status add_spring(inp_list *list, inp_spring spring, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&list->spring, &list->capacity, list->springs + 1, sizeof spring, fault));
  list->spring[list->springs++] = spring;
  return CDEM_OK;
}

/* The springs of row a of node position p: to every later degree of freedom, and to the ground. */
static cdem_status add_row(const cdem_sparse *sparse, int32_t p, int a, double largest,
                           inp_list *list, cdem_fault *fault) {
  int dofs = sparse->dofs;
  double sum = 0.0;
  for (int64_t k = sparse->start[p]; k < sparse->start[p + 1]; k++) {
    int32_t q = sparse->column[k];
    const double *block = sparse->value + k * dofs * dofs, *other = cdem_sparse_block(sparse, q, p);
    for (int b = 0; b < dofs; b++) {
      double value = 0.5 * (block[a * dofs + b] + other[b * dofs + a]);
      sum += value;
      if (q < p || (q == p && b <= a) || fabs(value) <= DROP * largest)
        continue;
      const inp_spring spring = {{p, q}, {(uint8_t)a, (uint8_t)b}, -value};
      CDEM_TRY(add_spring(list, spring, fault));
    }
  }
  if (fabs(sum) <= CDEM_MATRIX_ROUNDING * largest)
    return CDEM_OK;
  const inp_spring ground = {{p, -1}, {(uint8_t)a, UINT8_MAX}, sum};
  return add_spring(list, ground, fault);
}

static void put_nodes(const cdem_matrix_writer *matrix, FILE *stream) {
  const cdem_mesh *mesh = matrix->model->mesh;
  fprintf(stream,
          "** spring network of %s, by cdem %s\n"
          "** The springs are the entries of the assembled matrix, -K_ab between degrees of\n"
          "** freedom a < b: they move as the network does, but single springs of the network\n"
          "** cannot be told apart here (use .csv or .h5 for those).\n"
          "** Use: *INCLUDE, INPUT=this file; then *BOUNDARY and *STEP with *CLOAD on its nodes.\n"
          "*NODE, NSET=Nall\n",
          mesh->source != NULL ? mesh->source : "a generated mesh", cdem_version());
  for (int32_t p = 0; p < matrix->sparse.nodes; p++) {
    int32_t node = matrix->sparse.node[p];
    fprintf(stream, "%" PRId64, mesh->node_tag[node]);
    for (int c = 0; c < 3; c++) {
      char text[FIELD + 4];
      put_field(text, mesh->xyz[3 * node + c]);
      fprintf(stream, ",%s", text);
    }
    fputc('\n', stream);
  }
  if (matrix->sparse.dofs == 2)
    fputs("** a plane network has no stiffness across its plane\n*BOUNDARY\nNall,3,3\n", stream);
}

/* "ELEMENT,NODE[,NODE]". */
static void put_element(FILE *stream, int64_t number, int64_t first, int64_t second, bool ground) {
  char line[3 * CDEM_INTEGER_WIDTH + 4], *at = cdem_put_integer(line, number);
  *at++ = ',';
  at = cdem_put_integer(at, first);
  if (!ground) {
    *at++ = ',';
    at = cdem_put_integer(at, second);
  }
  *at++ = '\n';
  fwrite(line, 1, (size_t)(at - line), stream);
}

/* Springs whose components and written stiffness are equal share one set. */
static void put_springs(const cdem_matrix_writer *matrix, const inp_list *list, FILE *stream) {
  const int64_t *tag = matrix->model->mesh->node_tag;
  const int32_t *node = matrix->sparse.node;
  char value[FIELD + 4] = "", next[FIELD + 4];
  int64_t set = 0;
  for (int64_t i = 0; i < list->springs; i++) {
    const inp_spring *s = &list->spring[i];
    bool ground = s->position[1] < 0;
    if (i == 0 || s->stiffness != s[-1].stiffness)
      put_field(next, s->stiffness);
    if (i == 0 || memcmp(s->component, s[-1].component, sizeof s->component) != 0 ||
        strcmp(next, value) != 0) {
      memcpy(value, next, sizeof value);
      fprintf(stream, "*SPRING, ELSET=S%" PRId64 "\n%d", ++set, s->component[0] + 1);
      if (!ground)
        fprintf(stream, ",%d", s->component[1] + 1);
      fprintf(stream, "\n%s\n*ELEMENT, TYPE=SPRING%d, ELSET=S%" PRId64 "\n", value, ground ? 1 : 2,
              set);
    }
    put_element(stream, i + 1, tag[node[s->position[0]]], ground ? 0 : tag[node[s->position[1]]],
                ground);
  }
}

static cdem_status put_inp(cdem_matrix_writer *matrix, cdem_fault *fault) {
  const cdem_sparse *sparse = &matrix->sparse;
  const char *name = cdem_output_name(matrix->output);
  double largest = cdem_sparse_largest(sparse);
  inp_list list = {0};
  CDEM_REQUIRE(cdem_matrix_is_symmetric(sparse), fault, CDEM_INPUT,
               "cannot write '%s': the assembled matrix is not symmetric (skew fraction %.3g), and "
               "SPRING2 elements are; write .mtx instead, or all pairs of the mesh",
               name, cdem_sparse_skew(sparse));
  CDEM_TRY(cdem_matrix_check_tags(matrix, "CalculiX", fault));
  cdem_status status = CDEM_OK;
  for (int32_t p = 0; p < sparse->nodes && status == CDEM_OK; p++)
    for (int a = 0; a < sparse->dofs && status == CDEM_OK; a++)
      status = add_row(sparse, p, a, largest, &list, fault);
  if (status == CDEM_OK) {
    if (list.springs > 0)
      qsort(list.spring, (size_t)list.springs, sizeof *list.spring, by_kind);
    put_nodes(matrix, cdem_output_stream(matrix->output));
    put_springs(matrix, &list, cdem_output_stream(matrix->output));
  }
  free(list.spring);
  return status;
}

static cdem_status open_inp(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                            cdem_fault *fault) {
  *writer = NULL;
  CDEM_TRY(
      cdem_matrix_refuse_cosserat(path, model,
                                  "CalculiX has no spring between a displacement and a rotation of "
                                  "different nodes, which a Cosserat network needs",
                                  fault));
  return cdem_matrix_writer_open(path, model, put_inp, writer, fault);
}

const cdem_springs_format cdem_springs_inp = {
    "inp", ".inp", "CalculiX deck of SPRING2 elements, the assembled network", open_inp, true};
