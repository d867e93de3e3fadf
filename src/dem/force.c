/* Forces of chunks: pairs by batches, then bonds, then walls; and what is summed over chunks. */
#include "base/mat3.h"
#include "dem/confine.h"
#include "dem/walls_store.h"

#include <string.h>
#include <time.h>

enum { CLOCK_TEST, CLOCK_FILL, CLOCK_LAW, CLOCK_SCATTER, CLOCK_REST };

/* Adds the seconds since *last to a phase. */
static void tick(const cdem_dem_core *core, int phase, double *last) {
  struct timespec time;
  if (core->clock == NULL)
    return;
  clock_gettime(CLOCK_MONOTONIC, &time);
  double now = (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
  if (phase >= 0)
    core->clock[phase] += now - *last;
  *last = now;
}

void cdem_dem_law(const cdem_dem *dem, const cdem_contact_model *model, cdem_batch *batch,
                  bool energies) {
  int solid = dem->dim - 2;
  model->law->batch[solid][energies](&model->parameters[0], batch);
  if (model->rolling != NULL && model->rolling->batch[solid][energies] != NULL)
    model->rolling->batch[solid][energies](&model->parameters[1], model->first[1], batch);
  if (model->twisting != NULL && model->twisting->batch[solid][energies] != NULL)
    model->twisting->batch[solid][energies](&model->parameters[2], model->first[2], batch);
}

/* ---- pairs ---- */

static int32_t model_of_pair(const cdem_dem_store *s, int64_t pair) {
  return s->core->model_of[s->material[s->core->pair_owner[pair]] * s->options.materials +
                           s->material[s->pair_other[pair]]];
}

int32_t cdem_dem_hits(cdem_dem *dem, int32_t chunk, cdem_dem_work *work, const cdem_hit **hit,
                      int32_t *model_start) {
  cdem_dem_store *s = dem->store;
  int64_t first = s->pair_start[cdem_chunk_from(dem, chunk)];
  int32_t pairs = (int32_t)(s->pair_start[cdem_chunk_to(dem, chunk)] - first);
  int32_t models = s->core->models, at[CDEM_MODELS_MOST + 1] = {0};
  cdem_pair_kernel kernel = {.store = s, .core = s->core, .first = first};
  int32_t hits = cdem_pairs_test(&kernel, pairs, work->hit);
  *hit = work->hit;
  model_start[0] = 0;
  model_start[models] = hits;
  if (models == 1)
    return hits;
  for (int32_t k = 0; k < hits; k++)
    at[model_of_pair(s, first + (work->hit[k] >> 1)) + 1]++;
  for (int32_t m = 0; m < models; m++)
    at[m + 1] += at[m];
  memcpy(model_start, at, (size_t)(models + 1) * sizeof *at);
  for (int32_t k = 0; k < hits; k++)
    work->ordered[at[model_of_pair(s, first + (work->hit[k] >> 1))]++] = work->hit[k];
  *hit = work->ordered;
  return hits;
}

static void book_batch(const cdem_batch *b, cdem_dem_part *part) {
  for (int k = 0; k < b->count; k++) {
    part->sum[CDEM_DEM_DAMPED] += b->damped[k];
    part->sum[CDEM_DEM_SLID] += b->slid[k];
    part->sum[CDEM_DEM_ROLLED] += b->rolled[k];
    part->sum[CDEM_DEM_CIRCULATED] += b->circulated[k];
  }
}

/* Forces across images (for the work of the cell) and the stress. */
static void book_images(const cdem_pair_kernel *kernel, const cdem_hit *hit, const cdem_dem_work *w,
                        cdem_dem_part *part) {
  for (int k = 0; k < w->batch.count; k++) {
    const double f[3] = {w->force[0][k], w->force[1][k], w->force[2][k]}, *branch = w->place[k];
    double *image = part->image[kernel->store->pair_image[kernel->first + (hit[k] >> 1)]];
    for (int r = 0; r < 3; r++) {
      image[r] += f[r];
      for (int c = 0; c < 3; c++)
        part->virial[3 * r + c] += f[r] * branch[c];
    }
  }
}

static void pair_forces(cdem_dem *dem, int32_t chunk, double step, cdem_dem_work *work) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  const cdem_hit *hit;
  int32_t model_start[CDEM_MODELS_MOST + 1];
  double last = 0.0;
  bool book = s->options.energies && step > 0.0;
  tick(core, -1, &last);
  core->part[chunk].touches = cdem_dem_hits(dem, chunk, work, &hit, model_start);
  tick(core, CLOCK_TEST, &last);
  cdem_pair_kernel kernel = {s, core, s->pair_start[cdem_chunk_from(dem, chunk)], step, false};
  for (int32_t m = 0; m < core->models; m++)
    for (int32_t k = model_start[m]; k < model_start[m + 1]; k += CDEM_BATCH) {
      int count = model_start[m + 1] - k < CDEM_BATCH ? model_start[m + 1] - k : CDEM_BATCH;
      kernel.arms_by_radius = core->model[m].arms_by_radius;
      cdem_pairs_fill(&kernel, count, hit + k, work);
      if (book)
        cdem_pairs_gain(&kernel, count, hit + k, work);
      tick(core, CLOCK_FILL, &last);
      cdem_dem_law(dem, &core->model[m], &work->batch, book);
      tick(core, CLOCK_LAW, &last);
      cdem_pairs_scatter(&kernel, count, hit + k, work);
      if (book)
        book_batch(&work->batch, &core->part[chunk]);
      if (s->pair_image != NULL)
        book_images(&kernel, hit + k, work, &core->part[chunk]);
      tick(core, CLOCK_SCATTER, &last);
    }
}

double cdem_dem_stored_at(cdem_dem *dem, int32_t a, int32_t b, const double n[3], double overlap) {
  const cdem_dem_store *s = dem->store;
  const double *xa = cdem_place(s, a), *xb = cdem_place(s, b);
  double ma = cdem_motion(s, a)[6], mb = cdem_motion(s, b)[6], length = xa[3] + xb[3] - overlap;
  cdem_batch batch = {.count = 1};
  for (int k = 0; k < 8; k++) {
    for (int c = 0; c < 3; c++)
      batch.n[c][k] = n[c];
    batch.overlap[k] = overlap;
    batch.arm[0][k] = xa[3] * (length / (xa[3] + xb[3]));
    batch.arm[1][k] = xb[3] * (length / (xa[3] + xb[3]));
    batch.radius[k] = xa[3] * xb[3] / (xa[3] + xb[3]);
    batch.mass[k] = ma * mb / (ma + mb);
    batch.label[k] = batch.fresh[k] = 1.0;
  }
  const cdem_contact_model *model =
      &s->core->model[s->core->model_of[s->material[a] * s->options.materials + s->material[b]]];
  cdem_dem_law(dem, model, &batch, true);
  return batch.stored_normal[0] + batch.stored_shear[0] + batch.stored_moment[0];
}

/* ---- walls ---- */

static cdem_status grow_walls(cdem_dem_work *work, int64_t needed) {
  int64_t room = work->wall_items;
  if (needed <= room)
    return CDEM_OK;
  int64_t first = room, second = room, third = room;
  CDEM_TRY(cdem_grow(&work->wall_touch, &first, needed, sizeof *work->wall_touch, NULL));
  CDEM_TRY(cdem_grow(&work->wall_grain, &second, needed, sizeof *work->wall_grain, NULL));
  CDEM_TRY(cdem_grow(&work->wall_model, &third, 2 * needed, sizeof *work->wall_model, NULL));
  work->wall_items = first < second ? first : second;
  return CDEM_OK;
}

static int32_t model_of_touch(const cdem_dem_store *s, int32_t grain, const cdem_wall_touch *t) {
  return s->core->model_of[s->material[grain] * s->options.materials + t->material];
}

int32_t cdem_dem_wall_hits(cdem_dem *dem, int32_t chunk, cdem_dem_work *work,
                           int32_t *model_start) {
  cdem_dem_store *s = dem->store;
  const int32_t *row = cdem_walls_rows(s);
  int32_t count = 0, models = s->core->models, at[CDEM_MODELS_MOST + 1] = {0};
  int32_t to = cdem_chunk_to(dem, chunk);
  for (int32_t i = cdem_chunk_from(dem, chunk); i < to; i++) {
    int32_t far = to - i < 16 ? to : i + 16;
    if (row[i] == row[far]) { /* few grains are near a wall */
      i = far - 1;
      continue;
    }
    if (row[i] == row[i + 1])
      continue;
    if (count + CDEM_WALL_TOUCHES > work->wall_items) /* sized at the build */
      break;
    int found = cdem_walls_find(s, i, work->wall_touch + count);
    for (int k = 0; k < found; k++)
      work->wall_grain[count + k] = i;
    count += found;
  }
  int32_t *order = work->wall_model;
  for (int32_t k = 0; k < count; k++)
    at[model_of_touch(s, work->wall_grain[k], &work->wall_touch[k]) + 1]++;
  for (int32_t m = 0; m < models; m++)
    at[m + 1] += at[m];
  memcpy(model_start, at, (size_t)(models + 1) * sizeof *at);
  for (int32_t k = 0; k < count; k++)
    order[at[model_of_touch(s, work->wall_grain[k], &work->wall_touch[k])]++] = k;
  return count;
}

/* law.h: a wall is always B; the arm of A reaches the wall, that of B is 0. */
void cdem_dem_wall_fill(cdem_dem *dem, const cdem_contact_model *model, cdem_dem_work *work,
                        int32_t first, int count, double *history[CDEM_BATCH]) {
  cdem_dem_store *s = dem->store;
  cdem_batch *b = &work->batch;
  int numbers = s->histories;
  bool solid = s->dim == 3;
  b->count = count;
  for (int k = 0; k < count || k % 8 != 0; k++) {
    bool real = k < count;
    int32_t at = real ? work->wall_model[first + k] : 0, i = real ? work->wall_grain[at] : 0;
    static const cdem_wall_touch none = {.n = {1.0, 0.0, 0.0}};
    const cdem_wall_touch *t = real ? &work->wall_touch[at] : &none;
    const double *v = cdem_motion(s, i), *x = cdem_place(s, i);
    const double *gain = s->core->gain != NULL ? s->core->gain + 8 * (int64_t)i : NULL;
    bool fresh = true;
    history[k] = real ? cdem_walls_history(s, t, &fresh) : NULL;
    double arm = model->arms_by_radius ? x[3] : x[3] - t->overlap;
    b->overlap[k] = t->overlap;
    b->arm[0][k] = arm;
    b->arm[1][k] = 0.0;
    b->radius[k] = x[3];
    b->mass[k] = v[6];
    b->label[k] = 1.0;
    b->fresh[k] = fresh ? 1.0 : 0.0;
    for (int c = 0; c < s->dim; c++) {
      b->n[c][k] = t->n[c];
      b->velocity[c][k] = t->velocity[c] - v[c];
      b->velocity_gain[c][k] = gain != NULL ? -gain[c] : 0.0;
    }
    for (int c = 0; c < (solid ? 3 : 1); c++) {
      int from = solid ? c : 2;
      b->turning[c][k] = arm * v[3 + from];
      b->spin[c][k] = t->spin[from] - v[3 + from];
      b->turning_gain[c][k] = gain != NULL ? arm * gain[3 + from] : 0.0;
      b->spin_gain[c][k] = gain != NULL ? -gain[3 + from] : 0.0;
    }
    for (int h = 0; h < numbers; h++)
      b->history[h][k] = history[k] != NULL && !fresh ? history[k][h] : 0.0;
  }
}

static void wall_scatter(cdem_dem *dem, int32_t first, int count, cdem_dem_work *work,
                         double *history[CDEM_BATCH], double *sum) {
  cdem_dem_store *s = dem->store;
  for (int k = 0; k < count; k++) {
    int32_t at = work->wall_model[first + k];
    const cdem_wall_touch *t = &work->wall_touch[at];
    const double *row = work->row_a[k];
    double *f = cdem_force(s, work->wall_grain[at]);
    double *wall = sum + 8 * (int64_t)t->wall, arm[3], turn[3];
    for (int c = 0; c < 3; c++)
      arm[c] = t->point[c] - s->core->wall_center[3 * (int64_t)t->wall + c];
    cdem_cross3(arm, row, turn);
    for (int c = 0; c < 3; c++) {
      wall[c] -= row[c];
      /* row_b holds a_B n x F_t - M with a_B = 0 */
      wall[3 + c] += work->row_b[k][3 + c] - turn[c];
    }
    wall[7] -= cdem_dot3(row, t->n);
    for (int c = 0; c < 6; c++)
      f[c] += row[c];
    for (int h = 0; h < s->histories; h++)
      history[k][h] = work->batch.history[h][k];
  }
}

static void wall_stiffness(const cdem_contact_model *model, const cdem_batch *b, int32_t first,
                           const cdem_dem_work *work, double *sum) {
  for (int k = 0; k < b->count; k++) {
    double normal, shear, dashpot[2];
    model->law->stiffness(&model->parameters[0], b->radius[k], b->mass[k], b->overlap[k], &normal,
                          &shear, dashpot);
    /* A servo that steps by ds in dt also feels the dashpot, c ds/dt. */
    double felt = normal + (b->step > 0.0 ? dashpot[0] / b->step : 0.0);
    sum[8 * (int64_t)work->wall_touch[work->wall_model[first + k]].wall + 6] += felt;
  }
}

static void wall_forces(cdem_dem *dem, int32_t chunk, double step, cdem_dem_work *work) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int32_t model_start[CDEM_MODELS_MOST + 1];
  double *history[CDEM_BATCH], *sum = core->wall_part + 8 * (int64_t)chunk * s->options.walls;
  bool book = s->options.energies && step > 0.0;
  memset(sum, 0, (size_t)s->options.walls * 8 * sizeof *sum);
  cdem_dem_wall_hits(dem, chunk, work, model_start);
  for (int32_t m = 0; m < core->models; m++)
    for (int32_t k = model_start[m]; k < model_start[m + 1]; k += CDEM_BATCH) {
      int count = model_start[m + 1] - k < CDEM_BATCH ? model_start[m + 1] - k : CDEM_BATCH;
      cdem_dem_wall_fill(dem, &core->model[m], work, k, count, history);
      work->batch.step = step;
      cdem_dem_law(dem, &core->model[m], &work->batch, book);
      cdem_pairs_rows(s->dim, work);
      wall_scatter(dem, k, count, work, history, sum);
      if (core->servos)
        wall_stiffness(&core->model[m], &work->batch, k, work, sum);
      if (book)
        book_batch(&work->batch, &core->part[chunk]);
    }
}

/* ---- everything ---- */

void cdem_dem_force_chunk(cdem_dem *dem, int32_t chunk, double step, cdem_dem_work *work) {
  cdem_dem_core *core = dem->store->core;
  double last = 0.0;
  if (dem->store->pair_image != NULL) {
    memset(core->part[chunk].virial, 0, sizeof core->part[chunk].virial);
    memset(core->part[chunk].image, 0, sizeof core->part[chunk].image);
  }
  pair_forces(dem, chunk, step, work);
  tick(core, -1, &last);
  if (core->bonds > 0)
    cdem_bonds_forces(dem, chunk, step);
  if (dem->store->walls != NULL)
    wall_forces(dem, chunk, step, work);
  tick(core, CLOCK_REST, &last);
}

bool cdem_dem_wall_room(cdem_dem_work *work, int64_t grains) {
  return grow_walls(work, CDEM_WALL_TOUCHES * (grains + 1)) == CDEM_OK;
}

/* Work of the walls and the cell by the trapezoid: half with the forces before, half after. */
void cdem_dem_work_half(cdem_dem *dem, double step) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  for (int w = 0; w < s->options.walls; w++) {
    const double *f = core->wall_force + 6 * (int64_t)w;
    const cdem_wall_body *body = &s->walls->body[w];
    double power = cdem_dot3(f, body->velocity) + cdem_dot3(f + 3, body->spin);
    if (body->wall.servo_radius)
      power += core->wall_push[w] * body->radius_speed;
    core->wall_work -= 0.5 * step * power;
  }
  if (s->pair_image != NULL)
    for (int k = 0; k < 27; k++)
      core->cell_work += 0.5 * step * cdem_dot3(core->image_force[k], s->image_velocity[k]);
}

static void sum_walls(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  for (int w = 0; w < s->options.walls; w++) {
    double sum[8] = {0};
    for (int32_t c = 0; c < core->chunks; c++)
      for (int k = 0; k < 8; k++)
        sum[k] += core->wall_part[8 * ((int64_t)c * s->options.walls + w) + k];
    memcpy(core->wall_force + 6 * (int64_t)w, sum, 6 * sizeof *sum);
    core->wall_stiff[w] = sum[6];
    core->wall_push[w] = sum[7];
  }
}

static void sum_images(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  memset(core->image_force, 0, sizeof core->image_force);
  memset(core->stress, 0, sizeof core->stress);
  for (int32_t p = 0; p < core->chunks; p++) {
    for (int k = 0; k < 27; k++)
      for (int c = 0; c < 3; c++)
        core->image_force[k][c] += core->part[p].image[k][c];
    for (int k = 0; k < 9; k++)
      core->stress[k] += core->part[p].virial[k];
  }
  double volume = cdem_cell_volume(s->dim, &s->cell) * (s->dim == 2 ? core->thickness : 1.0);
  for (int k = 0; k < 9; k++)
    core->stress[k] = volume > 0.0 ? core->stress[k] / volume : 0.0;
}

void cdem_dem_force_after(cdem_dem *dem, double step) {
  cdem_dem_store *s = dem->store;
  if (s->walls != NULL && !s->options.reference)
    sum_walls(dem);
  if (s->pair_image != NULL && !s->options.reference)
    sum_images(dem);
  if (s->options.energies && step > 0.0)
    cdem_dem_work_half(dem, step);
  if (s->core->confine != NULL)
    cdem_confine_after(dem, step);
  int32_t broke = 0;
  for (int32_t c = 0; s->core->bonds > 0 && c < s->core->chunks; c++) {
    broke += s->core->part[c].broke;
    s->core->part[c].broke = 0;
  }
  if (broke > 0)
    cdem_bonds_update(dem);
  cdem_dem_bulk_if_stale(dem);
}

void cdem_dem_gather(cdem_dem *dem) {
  cdem_dem_core *core = dem->store->core;
  cdem_move_kernel kernel = {dem->store, core, dem->step, NULL, false};
#pragma omp parallel for schedule(static) num_threads(core->threads)
  for (int32_t c = 0; c < core->chunks; c++)
    cdem_grains_gather(&kernel, cdem_chunk_from(dem, c), cdem_chunk_to(dem, c));
}

void cdem_dem_evaluate(cdem_dem *dem, double step) {
  cdem_dem_core *core = dem->store->core;
  if (dem->store->options.reference)
    cdem_dem_reference(dem, step);
  else
    for (int32_t c = 0; c < core->chunks; c++)
      cdem_dem_force_chunk(dem, c, step, &core->work[0]);
  if (core->confine != NULL)
    cdem_confine_forces(dem);
  cdem_dem_force_after(dem, step);
  cdem_dem_gather(dem);
}
