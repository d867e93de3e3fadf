#include "network/deplete.h"

#include "network/spectrum.h"

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative to the norm of the matrix; the exact network stays at about 1e-15 in all three. */
static const double bound = 1e-10;

typedef struct {
  const cdem_removal *removal;
  int removals;
  int64_t *hits; /* [removals] springs */
  int64_t pairs, springs;
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

/* Marks spring `number` (0: all) of a set in gone [CDEM_SPRING_ROWS + 1]; returns how many it
 * found. */
static int mark_springs(const cdem_spring_set *set, int number, bool *gone) {
  int found = 0, last = 0;
  for (int r = 0; r < set->rows; r++) {
    int spring = set->row[r].spring;
    bool meant = number == 0 || spring == number;
    found += spring > last && meant;
    last = spring > last ? spring : last;
    gone[spring] = gone[spring] || meant;
  }
  return found;
}

/* Takes the marked springs out, with the couplings of others to them; returns how many went. */
static int remove_marked(cdem_spring_set *set, const bool *gone) {
  int kept = 0, removed = 0;
  for (int spring = 1; spring <= CDEM_SPRING_ROWS; spring++)
    removed += gone[spring];
  for (int r = 0; r < set->rows; r++) {
    cdem_spring_row row = set->row[r];
    if (gone[row.spring])
      continue;
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
    bool gone[CDEM_SPRING_ROWS + 1] = {false};
    for (int i = 0; i < sink->removals; i++)
      if (matches_pair(&sink->removal[i], chunk->model, &pair))
        sink->hits[i] += mark_springs(&pair.set, sink->removal[i].spring, gone);
    int removed = remove_marked(&pair.set, gone);
    sink->springs += removed;
    sink->pairs += removed > 0;
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
                                                      : model->length / size;
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
  for (int i = 0; i < modes; i++) {
    rigid_mode(model, sparse, centre, size, i, u);
    cdem_sparse_multiply(sparse, u, f + i * rows);
    for (int64_t r = 0; r < rows; r++)
      f[i * rows + r] /= norm;
  }
  double singular[6] = {0}, superb[6];
  lapack_int info = LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'N', (lapack_int)rows, modes, f,
                                   (lapack_int)rows, singular, NULL, 1, NULL, 1, superb);
  d->rigid_modes = modes;
  d->rigid_lost = 0;
  for (int i = 0; i < modes; i++)
    d->rigid_lost += singular[i] > bound;
  free(u);
  free(f);
  return info == 0 ? CDEM_OK
                   : cdem_fail(fault, CDEM_NUMERIC,
                               "the singular values of the rigid modes did not converge");
}

/* The lowest eigenvalue, N/m: of the matrix as it is, for its value has a meaning. */
static cdem_status find_lowest(const cdem_sparse *sparse, cdem_depletion *d, cdem_fault *fault) {
  cdem_spectrum *spectrum = NULL;
  CDEM_TRY(cdem_spectrum_create(sparse, false, &spectrum, fault));
  d->norm = cdem_spectrum_norm(spectrum);
  cdem_status status =
      d->norm > 0.0 ? cdem_spectrum_lowest(spectrum, 1, &d->lowest, fault) : CDEM_OK;
  cdem_spectrum_destroy(&spectrum);
  return status;
}

static cdem_status measure(const cdem_model *model, const cdem_sparse *sparse,
                           const cdem_progress *progress, cdem_depletion *d, cdem_fault *fault) {
  cdem_spectrum *balanced = NULL;
  CDEM_TRY(cdem_spectrum_create(sparse, true, &balanced, fault));
  cdem_status status =
      cdem_spectrum_count(balanced, progress, &d->negative_modes, &d->zero_modes, fault);
  cdem_spectrum_destroy(&balanced);
  CDEM_TRY(status);
  CDEM_TRY(cdem_progress_report(progress, "finding the lowest eigenvalue", 0, 1, fault));
  CDEM_TRY(find_lowest(sparse, d, fault));
  CDEM_TRY(cdem_progress_report(progress, "finding the lowest eigenvalue", 1, 1, fault));
  d->skew = cdem_sparse_skew(sparse);
  CDEM_TRY(count_lost(model, sparse, d->norm > 0.0 ? d->norm : 1.0, d, fault));
  d->safe = d->negative_modes == 0 && d->skew <= bound && d->rigid_lost == 0;
  return CDEM_OK;
}

/* The network without the removed springs, rotations scaled. */
static cdem_status assemble_rest(const cdem_model *model, const cdem_convert_options *convert,
                                 depletion_sink *sink, cdem_sparse *sparse, cdem_fault *fault) {
  sink->assemble = cdem_sparse_sink(sparse);
  const cdem_pair_sink pairs = {.context = sink, .write = write};
  CDEM_TRY(cdem_network_convert(model, convert, &pairs, 1, fault));
  for (int i = 0; i < sink->removals; i++)
    CDEM_REQUIRE(sink->hits[i] > 0, fault, CDEM_INPUT,
                 "'%s' matches no spring of this network; nothing can be taken out",
                 sink->removal[i].text != NULL ? sink->removal[i].text : "a removal");
  cdem_sparse_scale_rotations(model, model->length, sparse);
  return CDEM_OK;
}

cdem_status cdem_network_deplete(const cdem_model *model, const cdem_convert_options *convert,
                                 const cdem_depletion_options *options, cdem_depletion *depletion,
                                 cdem_fault *fault) {
  cdem_sparse sparse = {0};
  cdem_depletion made = {0};
  depletion_sink sink = {.removal = options->removal, .removals = options->removals};
  CDEM_TRY(cdem_sparse_init(model, &sparse, fault));
  int64_t rows = (int64_t)sparse.nodes * sparse.dofs;
  cdem_status status = CDEM_OK;
  if (rows > options->mode_rows)
    status = cdem_fail(fault, CDEM_INPUT,
                       "depletion finds eigenvalues of a matrix of %" PRId64
                       " rows, more than the %" PRId64
                       " allowed; allow more, or take a part of the mesh by group",
                       rows, options->mode_rows);
  sink.hits = cdem_allocate(options->removals, sizeof *sink.hits, fault);
  if (status == CDEM_OK && sink.hits == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK)
    status = assemble_rest(model, convert, &sink, &sparse, fault);
  made.pairs = sink.pairs;
  made.springs = sink.springs;
  if (status == CDEM_OK)
    status = measure(model, &sparse, convert->progress, &made, fault);
  if (status == CDEM_OK)
    *depletion = made;
  cdem_sparse_release(&sparse);
  free(sink.hits);
  return status;
}
