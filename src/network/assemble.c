#include "network/assemble.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Node -> cells of the model, as CSR over positions. */
typedef struct {
  int64_t *start; /* [nodes + 1] */
  int32_t *cell;  /* model indices */
} incidence;

static int nodes_of(const cdem_model *model, int32_t index) {
  return cdem_element_nodes(cdem_model_element(model, index));
}

int32_t cdem_sparse_position(const cdem_sparse *sparse, int32_t node) {
  int32_t low = 0, high = sparse->nodes;
  while (low < high) {
    int32_t middle = low + (high - low) / 2;
    if (sparse->node[middle] < node)
      low = middle + 1;
    else
      high = middle;
  }
  return low < sparse->nodes && sparse->node[low] == node ? low : -1;
}

/* Which mesh nodes take part: position [mesh->nodes] or -1, and their number. */
static int32_t number_nodes(const cdem_model *model, int32_t *position) {
  const cdem_mesh *mesh = model->mesh;
  for (int32_t i = 0; i < mesh->nodes; i++)
    position[i] = -1;
  for (int32_t i = 0; i < model->cells; i++)
    for (int a = 0; a < nodes_of(model, i); a++)
      position[cdem_mesh_cell(mesh, model->cell[i])[a]] = 0;
  int32_t used = 0;
  for (int32_t i = 0; i < mesh->nodes; i++)
    if (position[i] == 0)
      position[i] = used++;
  return used;
}

static cdem_status incidence_init(const cdem_model *model, const int32_t *position, int32_t nodes,
                                  incidence *made, cdem_fault *fault) {
  int64_t *fill = NULL;
  CDEM_NEW(made->start, (int64_t)nodes + 1, fault);
  for (int32_t i = 0; i < model->cells; i++)
    for (int a = 0; a < nodes_of(model, i); a++)
      made->start[position[cdem_mesh_cell(model->mesh, model->cell[i])[a]] + 1]++;
  for (int32_t n = 0; n < nodes; n++)
    made->start[n + 1] += made->start[n];
  CDEM_NEW(made->cell, made->start[nodes], fault);
  CDEM_NEW(fill, nodes, fault);
  memcpy(fill, made->start, (size_t)nodes * sizeof *fill);
  for (int32_t i = 0; i < model->cells; i++)
    for (int a = 0; a < nodes_of(model, i); a++)
      made->cell[fill[position[cdem_mesh_cell(model->mesh, model->cell[i])[a]]]++] = i;
  free(fill);
  return CDEM_OK;
}

static int ascending(const void *left, const void *right) {
  int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
  return (a > b) - (a < b);
}

/* The different positions in the cells around position n, ascending, into neighbour; returns their
 * number. */
static int32_t neighbours(const cdem_model *model, const int32_t *position, const incidence *around,
                          int32_t n, int32_t *neighbour) {
  int32_t found = 0, kept = 0;
  for (int64_t k = around->start[n]; k < around->start[n + 1]; k++) {
    int32_t index = around->cell[k];
    const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[index]);
    for (int a = 0; a < nodes_of(model, index); a++)
      neighbour[found++] = position[node[a]];
  }
  qsort(neighbour, (size_t)found, sizeof *neighbour, ascending);
  for (int32_t i = 0; i < found; i++)
    if (i == 0 || neighbour[i] != neighbour[i - 1])
      neighbour[kept++] = neighbour[i];
  return kept;
}

static cdem_status build_pattern(const cdem_model *model, const int32_t *position,
                                 const incidence *around, cdem_sparse *sparse, cdem_fault *fault) {
  int64_t most = 0;
  for (int32_t n = 0; n < sparse->nodes; n++) {
    int64_t cells = around->start[n + 1] - around->start[n];
    most = cells > most ? cells : most;
  }
  int32_t *neighbour;
  CDEM_NEW(neighbour, most * CDEM_SHAPE_MAX_NODES, fault);
  for (int32_t n = 0; n < sparse->nodes; n++)
    sparse->start[n + 1] = sparse->start[n] + neighbours(model, position, around, n, neighbour);
  sparse->column = cdem_allocate(sparse->start[sparse->nodes], sizeof *sparse->column, fault);
  sparse->value = cdem_allocate(sparse->start[sparse->nodes] * sparse->dofs * sparse->dofs,
                                sizeof *sparse->value, fault);
  cdem_status status = sparse->column != NULL && sparse->value != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int32_t n = 0; status == CDEM_OK && n < sparse->nodes; n++)
    memcpy(sparse->column + sparse->start[n], neighbour,
           (size_t)neighbours(model, position, around, n, neighbour) * sizeof *neighbour);
  free(neighbour);
  return status;
}

cdem_status cdem_sparse_init(const cdem_model *model, cdem_sparse *sparse, cdem_fault *fault) {
  cdem_sparse made = {.dofs = model->dofs};
  incidence around = {0};
  cdem_status status = CDEM_MEMORY;
  int32_t *position = cdem_allocate(model->mesh->nodes, sizeof *position, fault);
  if (position != NULL) {
    made.nodes = number_nodes(model, position);
    made.node = cdem_allocate(made.nodes, sizeof *made.node, fault);
    made.start = cdem_allocate((int64_t)made.nodes + 1, sizeof *made.start, fault);
    if (made.node != NULL && made.start != NULL) {
      for (int32_t i = 0; i < model->mesh->nodes; i++)
        if (position[i] >= 0)
          made.node[position[i]] = i;
      status = incidence_init(model, position, made.nodes, &around, fault);
    }
  }
  if (status == CDEM_OK)
    status = build_pattern(model, position, &around, &made, fault);
  free(position);
  free(around.start);
  free(around.cell);
  if (status != CDEM_OK)
    cdem_sparse_release(&made);
  *sparse = made;
  return status;
}

void cdem_sparse_release(cdem_sparse *sparse) {
  free(sparse->node);
  free(sparse->start);
  free(sparse->column);
  free(sparse->value);
  memset(sparse, 0, sizeof *sparse);
}

double *cdem_sparse_block(const cdem_sparse *sparse, int32_t row, int32_t column) {
  int64_t low = sparse->start[row], high = sparse->start[row + 1];
  while (low < high) {
    int64_t middle = low + (high - low) / 2;
    if (sparse->column[middle] < column)
      low = middle + 1;
    else
      high = middle;
  }
  if (low == sparse->start[row + 1] || sparse->column[low] != column)
    return NULL;
  return sparse->value + low * sparse->dofs * sparse->dofs;
}

void cdem_sparse_multiply(const cdem_sparse *sparse, const double *x, double *y) {
  int dofs = sparse->dofs;
#pragma omp parallel for schedule(static)
  for (int32_t n = 0; n < sparse->nodes; n++) {
    double sum[CDEM_MAX_DOFS] = {0};
    for (int64_t k = sparse->start[n]; k < sparse->start[n + 1]; k++) {
      const double *block = sparse->value + k * dofs * dofs,
                   *u = x + (int64_t)sparse->column[k] * dofs;
      for (int a = 0; a < dofs; a++)
        for (int b = 0; b < dofs; b++)
          sum[a] += block[a * dofs + b] * u[b];
    }
    for (int a = 0; a < dofs; a++)
      y[(int64_t)n * dofs + a] = sum[a];
  }
}

double cdem_sparse_largest(const cdem_sparse *sparse) {
  double largest = 0.0;
  int64_t values = sparse->start[sparse->nodes] * sparse->dofs * sparse->dofs;
  for (int64_t i = 0; i < values; i++)
    if (!(fabs(sparse->value[i]) <= largest)) /* NaN comes out */
      largest = fabs(sparse->value[i]);
  return largest;
}

double cdem_sparse_skew(const cdem_sparse *sparse) {
  int dofs = sparse->dofs;
  double skew = 0.0, whole = 0.0;
  for (int32_t n = 0; n < sparse->nodes; n++)
    for (int64_t k = sparse->start[n]; k < sparse->start[n + 1]; k++) {
      const double *block = sparse->value + k * dofs * dofs;
      const double *mirror = cdem_sparse_block(sparse, sparse->column[k], n);
      for (int a = 0; a < dofs; a++)
        for (int b = 0; b < dofs; b++) {
          double difference = block[a * dofs + b] - mirror[b * dofs + a];
          skew += difference * difference;
          whole += block[a * dofs + b] * block[a * dofs + b];
        }
    }
  return whole > 0.0 ? sqrt(skew / whole) / 2.0 : 0.0;
}

/* target += sign * S T, with T the rigid transport over the vector r (identity but for Cosserat:
 * the displacement of the far point is u + omega e_z x r). */
static void add_transported(double *target, const double *s, int dofs, bool cosserat,
                            const double r[2], double sign) {
  for (int a = 0; a < dofs; a++) {
    for (int b = 0; b < dofs; b++)
      target[a * dofs + b] += sign * s[a * dofs + b];
    if (cosserat)
      target[a * dofs + 2] += sign * (-s[a * dofs] * r[1] + s[a * dofs + 1] * r[0]);
  }
}

static void add_pair(cdem_sparse *sparse, const cdem_model *model, const int32_t node[2],
                     const double *s) {
  int dofs = sparse->dofs;
  bool cosserat = model->formulation == CDEM_PLANE_COSSERAT;
  int32_t i = cdem_sparse_position(sparse, node[0]), j = cdem_sparse_position(sparse, node[1]);
  const double *xi = model->mesh->xyz + 3 * (int64_t)node[0],
               *xj = model->mesh->xyz + 3 * (int64_t)node[1];
  const double there[2] = {xj[0] - xi[0], xj[1] - xi[1]}, back[2] = {-there[0], -there[1]};
  const double none[2] = {0};
  double transposed[CDEM_MAX_DOFS * CDEM_MAX_DOFS];
  for (int a = 0; a < dofs; a++)
    for (int b = 0; b < dofs; b++)
      transposed[b * dofs + a] = s[a * dofs + b];
  add_transported(cdem_sparse_block(sparse, i, j), s, dofs, false, none, -1.0);
  add_transported(cdem_sparse_block(sparse, j, i), transposed, dofs, false, none, -1.0);
  add_transported(cdem_sparse_block(sparse, i, i), s, dofs, cosserat, there, 1.0);
  add_transported(cdem_sparse_block(sparse, j, j), transposed, dofs, cosserat, back, 1.0);
}

static cdem_status add_chunk(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                             cdem_fault *fault) {
  (void)buffer, (void)fault;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    double s[CDEM_MAX_DOFS * CDEM_MAX_DOFS];
    cdem_springs_rebuild(&chunk->pair[p].set, s);
    add_pair(context, chunk->model, chunk->pair[p].node, s);
  }
  return CDEM_OK;
}

cdem_pair_sink cdem_sparse_sink(cdem_sparse *sparse) {
  return (cdem_pair_sink){.context = sparse, .write = add_chunk};
}

static void add_element(const cdem_model *model, int32_t index, double factor, const double *k,
                        cdem_sparse *sparse) {
  const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[index]);
  int nodes = nodes_of(model, index), dofs = sparse->dofs;
  int32_t position[CDEM_SHAPE_MAX_NODES];
  for (int a = 0; a < nodes; a++)
    position[a] = cdem_sparse_position(sparse, node[a]);
  for (int a = 0; a < nodes; a++)
    for (int b = 0; b < nodes; b++) {
      double *block = cdem_sparse_block(sparse, position[a], position[b]);
      for (int c = 0; c < dofs; c++)
        for (int d = 0; d < dofs; d++)
          block[c * dofs + d] += factor * k[(int64_t)(a * dofs + c) * nodes * dofs + b * dofs + d];
    }
}

cdem_status cdem_sparse_add_elements(const cdem_model *model, double factor, cdem_sparse *sparse,
                                     const cdem_progress *progress, cdem_fault *fault) {
  double *k;
  CDEM_NEW(k, (int64_t)CDEM_SHAPE_MAX_NODES * CDEM_SHAPE_MAX_NODES * CDEM_MAX_DOFS * CDEM_MAX_DOFS,
           fault);
  cdem_status status = CDEM_OK;
  for (int32_t i = 0; i < model->cells && status == CDEM_OK; i++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    cdem_model_coordinates(model, i, xyz);
    status = cdem_element_stiffness(&model->kinds_of[model->kind[i]].tabulation,
                                    &model->materials_of[model->material[i]], &model->section, xyz,
                                    k, fault);
    if (status == CDEM_OK)
      add_element(model, i, factor, k, sparse);
    if (status == CDEM_OK && i % 1024 == 0)
      status = cdem_progress_report(progress, "assembling the finite-element matrix", i,
                                    model->cells, fault);
  }
  free(k);
  return status;
}

void cdem_sparse_scale_rotations(const cdem_model *model, double length, cdem_sparse *sparse) {
  if (model->formulation != CDEM_PLANE_COSSERAT)
    return;
  int64_t blocks = sparse->start[sparse->nodes];
  for (int64_t k = 0; k < blocks; k++)
    for (int e = 0; e < 9; e++)
      sparse->value[9 * k + e] /= (e / 3 == 2 ? length : 1.0) * (e % 3 == 2 ? length : 1.0);
}
