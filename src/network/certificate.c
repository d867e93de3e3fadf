#include "network/certificate.h"

#include "network/spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What one chunk adds up; travels from encode to write in the buffer. */
typedef struct {
  cdem_certificate part;
  double skew_sum;
} tally;

struct cdem_certifier {
  const cdem_model *model;
  cdem_sparse network;
  cdem_pair_sink assemble;
  tally sum;
};

static void tally_clear(tally *t) {
  const cdem_worst none = {.value = 0.0, .element = -1, .node = {-1, -1}};
  memset(t, 0, sizeof *t);
  t->part.rebuild = t->part.translation = t->part.rotation = t->part.skew = t->part.cond = none;
}

/* Keeps the larger; NaN counts as worst. The first of equals stays, so that order alone decides. */
static void worsen(cdem_worst *worst, double value, int64_t element, int64_t first,
                   int64_t second) {
  if (!(value > worst->value || (isnan(value) && !isnan(worst->value))))
    return;
  *worst = (cdem_worst){.value = value, .element = element, .node = {first, second}};
}

static void merge_worst(cdem_worst *worst, const cdem_worst *other) {
  worsen(worst, other->value, other->element, other->node[0], other->node[1]);
}

/* A Cosserat block in units of N/m, so that no kind of entry drowns the other in a norm. */
static void scale_block(const cdem_model *model, double *s) {
  for (int e = 0; e < 9 && model->formulation == CDEM_PLANE_COSSERAT; e++)
    s[e] /= (e / 3 == 2 ? model->length : 1.0) * (e % 3 == 2 ? model->length : 1.0);
}

/* Sets and blocks in the units in which they were decomposed. */
static double scaled_residual(const cdem_model *model, const cdem_pair *pair) {
  if (model->formulation != CDEM_PLANE_COSSERAT)
    return cdem_springs_residual(pair->block, &pair->set);
  double s[9];
  cdem_spring_set set = pair->set;
  memcpy(s, pair->block, sizeof s);
  scale_block(model, s);
  for (int r = 0; r < set.rows; r++) {
    set.row[r].dir[2] /= model->length;
    set.row[r].dual[2] /= model->length;
  }
  return cdem_springs_residual(s, &set);
}

static void tally_pair(const cdem_model *model, const cdem_pair *pair, tally *t) {
  const cdem_mesh *mesh = model->mesh;
  int64_t element = mesh->cell_tag[model->cell[pair->index]];
  int64_t first = mesh->node_tag[pair->node[0]], second = mesh->node_tag[pair->node[1]];
  t->part.pairs++;
  t->part.census[pair->class_][pair->set.form]++;
  t->part.robust += pair->set.slow;
  for (int r = 0, last = 0; r < pair->set.rows; r++)
    if (pair->set.row[r].spring > last) {
      last = pair->set.row[r].spring;
      t->part.springs++;
      t->part.negative += pair->set.row[r].stiffness < 0.0;
    }
  worsen(&t->part.rebuild, scaled_residual(model, pair), element, first, second);
  double block[9];
  memcpy(block, pair->block, sizeof block);
  scale_block(model, block);
  double skew = cdem_springs_skew(block, pair->set.size);
  t->skew_sum += skew;
  worsen(&t->part.skew, skew, element, first, second);
  if (pair->set.form != CDEM_FORM_FRAME)
    worsen(&t->part.cond, pair->set.cond, element, first, second);
}

/* S_ij of the pairs of one element by local nodes: blocks of j before i are transposed. */
static void add_sums(const cdem_model *model, const cdem_pair *pair, int pairs,
                     const double (*xyz)[3], double *row_sum, double *turning, double *weight) {
  int d = model->dofs, entries = d * d;
  bool cosserat = model->formulation == CDEM_PLANE_COSSERAT;
  for (int p = 0; p < pairs; p++)
    for (int side = 0; side < 2; side++) {
      int i = pair[p].local[side], j = pair[p].local[1 - side];
      double r[3], s[9];
      for (int c = 0; c < 3; c++)
        r[c] = xyz[j][c] - xyz[i][c];
      for (int a = 0; a < d; a++)
        for (int b = 0; b < d; b++)
          s[a * d + b] = pair[p].block[side == 0 ? a * d + b : b * d + a];
      for (int e = 0; e < entries; e++)
        row_sum[i * entries + e] += s[e];
      for (int a = 0; cosserat && a < d; a++)
        row_sum[i * entries + a * d + 2] += -s[a * d] * r[1] + s[a * d + 1] * r[0];
      weight[i] += cdem_frobenius(s, entries) * cdem_norm3(r);
      for (int axis = d == 2 ? 2 : 0; axis < 3; axis++) {
        const double theta[3] = {axis == 0, axis == 1, axis == 2};
        double u[3];
        cdem_cross3(theta, r, u);
        for (int a = 0; a < d; a++)
          for (int b = 0; b < d; b++)
            turning[(i * 3 + axis) * 3 + a] += s[a * d + b] * u[b];
      }
    }
}

/* Translations and rotations of one element, against the reference K_ii. */
static cdem_status tally_element(const cdem_model *model, const cdem_pair *pair, int pairs,
                                 double *k, tally *t, cdem_fault *fault) {
  int32_t index = pair[0].index;
  int nodes = cdem_element_nodes(cdem_model_element(model, index)), d = model->dofs;
  int64_t element = model->mesh->cell_tag[model->cell[index]];
  const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[index]);
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  double row_sum[CDEM_SHAPE_MAX_NODES * 9] = {0}, turning[CDEM_SHAPE_MAX_NODES * 9] = {0};
  double weight[CDEM_SHAPE_MAX_NODES] = {0};
  cdem_model_coordinates(model, index, xyz);
  CDEM_TRY(cdem_element_stiffness(&model->kinds_of[model->kind[index]].tabulation,
                                  &model->materials_of[model->material[index]], &model->section,
                                  xyz, k, fault));
  add_sums(model, pair, pairs, xyz, row_sum, turning, weight);
  for (int i = 0; i < nodes; i++) {
    double difference[9], diagonal[9];
    for (int a = 0; a < d; a++)
      for (int b = 0; b < d; b++) {
        diagonal[a * d + b] = k[(int64_t)(i * d + a) * nodes * d + i * d + b];
        difference[a * d + b] = diagonal[a * d + b] - row_sum[i * d * d + a * d + b];
      }
    scale_block(model, difference);
    scale_block(model, diagonal);
    int64_t tag = model->mesh->node_tag[node[i]];
    worsen(&t->part.translation,
           cdem_frobenius(difference, d * d) / cdem_frobenius(diagonal, d * d), element, tag, -1);
    if (model->formulation != CDEM_PLANE_COSSERAT)
      worsen(&t->part.rotation, cdem_frobenius(turning + i * 9, 9) / weight[i], element, tag, -1);
  }
  t->part.elements++;
  return CDEM_OK;
}

static cdem_status encode(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                          cdem_fault *fault) {
  (void)context;
  CDEM_TRY(cdem_buffer_reserve(buffer, sizeof(tally), fault));
  double *k;
  CDEM_NEW(k, (int64_t)CDEM_SHAPE_MAX_NODES * CDEM_SHAPE_MAX_NODES * 9, fault);
  tally t;
  tally_clear(&t);
  cdem_status status = CDEM_OK;
  for (int64_t p = 0; p < chunk->pairs && status == CDEM_OK;) {
    int pairs = cdem_element_pairs(cdem_model_element(chunk->model, chunk->pair[p].index));
    for (int i = 0; i < pairs; i++)
      tally_pair(chunk->model, &chunk->pair[p + i], &t);
    status = tally_element(chunk->model, &chunk->pair[p], pairs, k, &t, fault);
    p += pairs;
  }
  free(k);
  memcpy(buffer->data, &t, sizeof t);
  buffer->used = sizeof t;
  return status;
}

static cdem_status merge(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                         cdem_fault *fault) {
  cdem_certifier *certifier = context;
  tally t, *sum = &certifier->sum;
  memcpy(&t, buffer->data, sizeof t);
  sum->part.elements += t.part.elements;
  sum->part.pairs += t.part.pairs;
  sum->part.springs += t.part.springs;
  sum->part.negative += t.part.negative;
  sum->part.robust += t.part.robust;
  sum->skew_sum += t.skew_sum;
  for (int c = 0; c < CDEM_CLASS_COUNT; c++)
    for (int f = 0; f < CDEM_FORM_COUNT; f++)
      sum->part.census[c][f] += t.part.census[c][f];
  merge_worst(&sum->part.rebuild, &t.part.rebuild);
  merge_worst(&sum->part.translation, &t.part.translation);
  merge_worst(&sum->part.rotation, &t.part.rotation);
  merge_worst(&sum->part.skew, &t.part.skew);
  merge_worst(&sum->part.cond, &t.part.cond);
  return certifier->assemble.write(certifier->assemble.context, chunk, buffer, fault);
}

cdem_status cdem_certifier_create(const cdem_model *model, cdem_certifier **certifier,
                                  cdem_fault *fault) {
  *certifier = NULL;
  cdem_certifier *made;
  CDEM_NEW(made, 1, fault);
  made->model = model;
  tally_clear(&made->sum);
  if (cdem_sparse_init(model, &made->network, fault) != CDEM_OK) {
    free(made);
    return CDEM_MEMORY;
  }
  made->assemble = cdem_sparse_sink(&made->network);
  *certifier = made;
  return CDEM_OK;
}

void cdem_certifier_destroy(cdem_certifier **certifier) {
  if (*certifier == NULL)
    return;
  cdem_sparse_release(&(*certifier)->network);
  free(*certifier);
  *certifier = NULL;
}

cdem_pair_sink cdem_certifier_sink(cdem_certifier *certifier) {
  return (cdem_pair_sink){.context = certifier, .encode = encode, .write = merge};
}

/* Takes the finite-element matrix away from the network's, in place; largest difference over
 * largest entry, both with rotations scaled. */
static cdem_status compare_assembled(cdem_certifier *certifier, const cdem_progress *progress,
                                     double *assembled, cdem_fault *fault) {
  const cdem_model *model = certifier->model;
  cdem_sparse *network = &certifier->network;
  double largest = cdem_sparse_largest(network);
  cdem_sparse_scale_rotations(model, 1.0 / model->length, network);
  CDEM_TRY(cdem_sparse_add_elements(model, -1.0, network, progress, fault));
  cdem_sparse_scale_rotations(model, model->length, network);
  *assembled = cdem_sparse_largest(network) / largest;
  return CDEM_OK;
}

/* Nodes inside one material: not on the boundary of the cells, and all their cells of one material.
 */
static cdem_status mark_interior(const cdem_model *model, bool *interior, cdem_fault *fault) {
  const cdem_mesh *mesh = model->mesh;
  bool *boundary = cdem_allocate(mesh->nodes, sizeof *boundary, fault);
  int *material = cdem_allocate(mesh->nodes, sizeof *material, fault);
  cdem_status status = boundary != NULL && material != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK)
    status = cdem_mesh_boundary_nodes(mesh, model->cell, model->cells, boundary, fault);
  for (int32_t n = 0; status == CDEM_OK && n < mesh->nodes; n++) {
    material[n] = -1;
    interior[n] = !boundary[n];
  }
  for (int32_t i = 0; status == CDEM_OK && i < model->cells; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, model->cell[i]);
    for (int a = 0; a < cdem_element_nodes(cdem_model_element(model, i)); a++) {
      interior[node[a]] =
          interior[node[a]] && (material[node[a]] < 0 || material[node[a]] == model->material[i]);
      material[node[a]] = model->material[i];
    }
  }
  free(boundary);
  free(material);
  return status;
}

/* u = A (x - centre) with the only nonzero entry A[row][column] = 1; omega is the rotation of that
 * field, times the model's length. */
static void linear_field(const cdem_model *model, const cdem_sparse *sparse, const double centre[3],
                         int row, int column, double *u) {
  for (int32_t n = 0; n < sparse->nodes; n++) {
    const double *x = model->mesh->xyz + 3 * (int64_t)sparse->node[n];
    double *at = u + (int64_t)n * sparse->dofs;
    memset(at, 0, (size_t)sparse->dofs * sizeof *at);
    at[row] = x[column] - centre[column];
    if (model->formulation == CDEM_PLANE_COSSERAT)
      at[2] = row == column ? 0.0 : row == 1 ? model->length / 2.0 : -model->length / 2.0;
  }
}

/* The larger, or NaN when either is. */
static double larger(double a, double b) {
  return isnan(b) || b > a ? b : a;
}

/* Uniform strain must leave interior nodes without force. The measure is the largest sum of |K||u|
 * of a row, for that is what cancels there: thin elements are stiff and round accordingly. */
static double patch_ratio(const cdem_certifier *certifier, const bool *interior,
                          const double centre[3], double *u, double *f) {
  const cdem_model *model = certifier->model;
  const cdem_sparse *network = &certifier->network;
  int d = network->dofs;
  double worst = 0.0;
  for (int row = 0; row < model->dimension; row++)
    for (int column = 0; column < model->dimension; column++) {
      linear_field(model, network, centre, row, column, u);
      cdem_sparse_multiply(network, u, f);
      double inside = 0.0, largest = 0.0;
      for (int32_t n = 0; n < network->nodes; n++)
        for (int a = 0; a < d; a++) {
          double sum = 0.0;
          for (int64_t k = network->start[n]; k < network->start[n + 1]; k++)
            for (int b = 0; b < d; b++)
              sum += fabs(network->value[(k * d + a) * d + b] *
                          u[(int64_t)network->column[k] * d + b]);
          largest = larger(largest, sum);
          if (interior[network->node[n]])
            inside = larger(inside, fabs(f[(int64_t)n * d + a]));
        }
      worst = larger(worst, inside / largest);
    }
  return worst;
}

static cdem_status patch_test(const cdem_certifier *certifier, cdem_certificate *certificate,
                              cdem_fault *fault) {
  const cdem_sparse *network = &certifier->network;
  const cdem_mesh *mesh = certifier->model->mesh;
  int64_t rows = (int64_t)network->nodes * network->dofs;
  bool *interior = cdem_allocate(mesh->nodes, sizeof *interior, fault);
  double *u = cdem_allocate(rows, sizeof *u, fault), *f = cdem_allocate(rows, sizeof *f, fault);
  cdem_status status = interior != NULL && u != NULL && f != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK)
    status = mark_interior(certifier->model, interior, fault);
  if (status == CDEM_OK) {
    double centre[3] = {0};
    for (int32_t n = 0; n < network->nodes; n++) {
      certificate->patch_nodes += interior[network->node[n]];
      for (int c = 0; c < 3; c++)
        centre[c] += mesh->xyz[3 * (int64_t)network->node[n] + c] / network->nodes;
    }
    certificate->patch = patch_ratio(certifier, interior, centre, u, f);
  }
  free(interior);
  free(u);
  free(f);
  return status;
}

static cdem_status count_modes(const cdem_certifier *certifier, const cdem_progress *progress,
                               cdem_certificate *certificate, cdem_fault *fault) {
  cdem_spectrum *spectrum = NULL;
  CDEM_TRY(cdem_spectrum_create(&certifier->network, true, &spectrum, fault));
  int64_t negative = 0, zero = 0;
  cdem_status status = cdem_spectrum_count(spectrum, progress, &negative, &zero, fault);
  cdem_spectrum_destroy(&spectrum);
  CDEM_TRY(status);
  certificate->zero_modes = zero;
  certificate->negative_modes = negative;
  return CDEM_OK;
}

static cdem_status count_parts(const cdem_certifier *certifier, cdem_certificate *certificate,
                               cdem_fault *fault) {
  const cdem_model *model = certifier->model;
  int32_t *part;
  CDEM_NEW(part, model->mesh->nodes, fault);
  cdem_status status = cdem_mesh_components(model->mesh, model->cell, model->cells, part,
                                            &certificate->components, fault);
  free(part);
  certificate->rigid_modes = (int64_t)certificate->components * (model->dimension == 3 ? 6 : 3);
  return status;
}

cdem_status cdem_certifier_finish(cdem_certifier *certifier, int64_t mode_rows,
                                  const cdem_progress *progress, cdem_certificate *certificate,
                                  cdem_fault *fault) {
  cdem_certificate made = certifier->sum.part;
  int64_t rows = (int64_t)certifier->network.nodes * certifier->network.dofs;
  made.nodes = certifier->network.nodes;
  made.skew_mean = made.pairs > 0 ? certifier->sum.skew_sum / (double)made.pairs : 0.0;
  made.zero_modes = made.negative_modes = -1;
  made.rebuild_bound = made.translation_bound = made.rotation_bound = made.assembled_bound = 1e-12;
  made.patch_bound = 1e-12;
  made.has_rotation = certifier->model->formulation != CDEM_PLANE_COSSERAT;
  cdem_sparse_scale_rotations(certifier->model, certifier->model->length, &certifier->network);
  CDEM_TRY(count_parts(certifier, &made, fault));
  CDEM_TRY(patch_test(certifier, &made, fault));
  if (rows <= mode_rows)
    CDEM_TRY(count_modes(certifier, progress, &made, fault));
  CDEM_TRY(compare_assembled(certifier, progress, &made.assembled, fault));
  CDEM_TRY(cdem_progress_report(progress, "certifying", 1, 1, fault));
  *certificate = made;
  return CDEM_OK;
}

bool cdem_certificate_holds(const cdem_certificate *c) {
  bool rotation = !c->has_rotation || c->rotation.value <= c->rotation_bound;
  bool modes = c->zero_modes < 0 || (c->zero_modes == c->rigid_modes && c->negative_modes == 0);
  return c->rebuild.value <= c->rebuild_bound && c->translation.value <= c->translation_bound &&
         rotation && c->assembled <= c->assembled_bound && c->patch <= c->patch_bound && modes;
}
