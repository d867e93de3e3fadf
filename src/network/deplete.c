#include "network/deplete.h"

#include "network/spectrum.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

/* Relative to the norm of the matrix; the exact network stays at about 1e-15 in all three. */
static const double bound = 1e-10;

typedef struct {
  const cdem_removal *removal;
  int removals;
  int64_t *hits; /* [removals] springs */
  int64_t pairs;
  cdem_pair_sink assemble;
} depletion_sink;

static bool matches_pair(const cdem_removal *r, const cdem_model *model, const cdem_pair *pair) {
  const cdem_mesh *mesh = model->mesh;
  int64_t first = mesh->node_tag[pair->node[0]], second = mesh->node_tag[pair->node[1]];
  bool nodes = r->node[0] == 0 || (r->node[0] == first && r->node[1] == second) ||
               (r->node[0] == second && r->node[1] == first);
  return nodes && (r->element == 0 || r->element == mesh->cell_tag[model->cell[pair->index]]) &&
         (r->class_ < 0 || r->class_ == pair->class_) && (r->form < 0 || r->form == pair->set.form);
}

/* Takes spring `number` (0: all) out of a set; returns how many springs went. */
static int remove_springs(cdem_spring_set *set, int number) {
  bool gone[CDEM_SPRING_ROWS + 1] = {false};
  int removed = 0, kept = 0;
  for (int r = 0; r < set->rows; r++)
    if (number == 0 || set->row[r].spring == number) {
      removed += !gone[set->row[r].spring];
      gone[set->row[r].spring] = true;
    }
  for (int r = 0; r < set->rows; r++) {
    if (gone[set->row[r].spring])
      continue;
    cdem_spring_row row = set->row[r];
    if (row.couples_to > 0 && gone[row.couples_to]) {
      row.couples_to = 0;
      row.coupling = 0.0;
    }
    set->row[kept++] = row;
  }
  set->rows = (uint8_t)kept;
  return removed;
}

static cdem_status write(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                         cdem_fault *fault) {
  depletion_sink *sink = context;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    cdem_pair pair = chunk->pair[p];
    int before = pair.set.rows;
    for (int i = 0; i < sink->removals; i++)
      if (matches_pair(&sink->removal[i], chunk->model, &pair))
        sink->hits[i] += remove_springs(&pair.set, sink->removal[i].spring);
    sink->pairs += pair.set.rows != before;
    const cdem_chunk one = {.model = chunk->model, .pairs = 1, .pair = &pair};
    CDEM_TRY(sink->assemble.write(sink->assemble.context, &one, buffer, fault));
  }
  return CDEM_OK;
}

/* One rigid mode: translations first, then rotations about the centre; of length about one. */
static void rigid_mode(const cdem_model *model, const cdem_sparse *sparse, const double centre[3],
                       double size, int mode, double *u) {
  int d = sparse->dofs;
  int axis = model->dimension == 3 ? mode - 3 : 2;
  const double theta[3] = {axis == 0, axis == 1, axis == 2};
  for (int32_t n = 0; n < sparse->nodes; n++) {
    const double *x = model->mesh->xyz + 3 * (int64_t)sparse->node[n];
    double r[3], turned[3];
    for (int c = 0; c < 3; c++)
      r[c] = (x[c] - centre[c]) / size;
    cdem_cross3(theta, r, turned);
    for (int a = 0; a < d; a++)
      u[(int64_t)n * d + a] = mode < model->dimension ? a == mode
                              : a < model->dimension  ? turned[a]
                                                      : 1.0 / size;
  }
}

/* Rank of K applied to the rigid modes = modes that now meet a force. */
static cdem_status count_lost(const cdem_model *model, const cdem_sparse *sparse, double norm,
                              cdem_depletion *d, cdem_fault *fault) {
  int64_t rows = (int64_t)sparse->nodes * sparse->dofs;
  int modes = model->dimension == 3 ? 6 : 3;
  double *u = cdem_allocate(rows, sizeof *u, fault),
         *f = cdem_allocate(rows * modes, sizeof *f, fault);
  if (u == NULL || f == NULL) {
    free(u);
    free(f);
    return CDEM_MEMORY;
  }
  double centre[3] = {0}, size = 0.0;
  for (int32_t n = 0; n < sparse->nodes; n++)
    for (int c = 0; c < 3; c++)
      centre[c] += model->mesh->xyz[3 * (int64_t)sparse->node[n] + c] / sparse->nodes;
  for (int32_t n = 0; n < sparse->nodes; n++)
    for (int c = 0; c < 3; c++)
      size = fmax(size, fabs(model->mesh->xyz[3 * (int64_t)sparse->node[n] + c] - centre[c]));
  double gram[36], eigenvalue[6];
  for (int i = 0; i < modes; i++) {
    rigid_mode(model, sparse, centre, size, i, u);
    cdem_sparse_multiply(sparse, u, f + i * rows);
  }
  for (int i = 0; i < modes; i++)
    for (int j = 0; j < modes; j++) {
      gram[i * modes + j] = 0.0;
      for (int64_t r = 0; r < rows; r++)
        gram[i * modes + j] += f[i * rows + r] / norm * (f[j * rows + r] / norm);
    }
  LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', modes, gram, modes, eigenvalue);
  d->rigid_modes = modes;
  d->rigid_lost = 0;
  for (int i = 0; i < modes; i++)
    d->rigid_lost += sqrt(fmax(eigenvalue[i], 0.0)) > bound;
  free(u);
  free(f);
  return CDEM_OK;
}

static cdem_status measure(const cdem_model *model, const cdem_sparse *sparse, cdem_depletion *d,
                           cdem_fault *fault) {
  cdem_spectrum *spectrum = NULL;
  CDEM_TRY(cdem_spectrum_create(sparse, model->length, &spectrum, fault));
  d->norm = cdem_spectrum_norm(spectrum);
  int64_t below = 0, above = 0;
  cdem_status status = CDEM_OK;
  if (d->norm > 0.0) {
    status = cdem_spectrum_below(spectrum, -bound * d->norm, &below, fault);
    if (status == CDEM_OK)
      status = cdem_spectrum_below(spectrum, bound * d->norm, &above, fault);
    if (status == CDEM_OK)
      status = cdem_spectrum_lowest(spectrum, 1, &d->lowest, fault);
  } else {
    above = (int64_t)sparse->nodes * sparse->dofs;
  }
  cdem_spectrum_destroy(&spectrum);
  CDEM_TRY(status);
  d->negative_modes = below;
  d->zero_modes = above - below;
  d->skew = cdem_sparse_skew(sparse);
  CDEM_TRY(count_lost(model, sparse, d->norm > 0.0 ? d->norm : 1.0, d, fault));
  d->safe = d->negative_modes == 0 && d->skew <= bound && d->rigid_lost == 0;
  return CDEM_OK;
}

cdem_status cdem_network_deplete(const cdem_model *model, const cdem_convert_options *options,
                                 const cdem_removal *removal, int removals,
                                 cdem_depletion *depletion, cdem_fault *fault) {
  cdem_sparse sparse = {0};
  cdem_depletion made = {0};
  depletion_sink sink = {.removal = removal, .removals = removals};
  CDEM_NEW(sink.hits, removals, fault);
  cdem_status status = cdem_sparse_init(model, &sparse, fault);
  if (status == CDEM_OK) {
    sink.assemble = cdem_sparse_sink(&sparse);
    const cdem_pair_sink pairs = {.context = &sink, .write = write};
    status = cdem_network_convert(model, options, &pairs, 1, fault);
  }
  for (int i = 0; i < removals && status == CDEM_OK; i++) {
    made.springs += sink.hits[i];
    if (sink.hits[i] == 0)
      status = cdem_fail(fault, CDEM_INPUT, "removal %d matches no spring of this network", i + 1);
  }
  made.pairs = sink.pairs;
  if (status == CDEM_OK)
    status = measure(model, &sparse, &made, fault);
  if (status == CDEM_OK)
    *depletion = made;
  cdem_sparse_release(&sparse);
  free(sink.hits);
  return status;
}
