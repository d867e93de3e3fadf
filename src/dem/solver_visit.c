/* All contacts there are, batch by batch, with the forces of the state: for reports. */
#include "dem/solver_store.h"

#include <string.h>

static void visit_pairs(cdem_dem *dem, int32_t chunk, double step, cdem_dem_see *see,
                        void *context) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  cdem_dem_work *work = &core->work[0];
  const cdem_hit *hit;
  int32_t model_start[CDEM_MODELS_MOST + 1];
  cdem_dem_hits(dem, chunk, work, &hit, model_start);
  cdem_pair_kernel kernel = {s, core, s->pair_start[cdem_chunk_from(dem, chunk)], step, false};
  for (int32_t m = 0; m < core->models; m++)
    for (int32_t k = model_start[m]; k < model_start[m + 1]; k += CDEM_BATCH) {
      cdem_dem_visit visit = {.dem = dem, .work = work, .model = &core->model[m], .chunk = chunk};
      visit.count = model_start[m + 1] - k < CDEM_BATCH ? model_start[m + 1] - k : CDEM_BATCH;
      kernel.arms_by_radius = core->model[m].arms_by_radius;
      cdem_pairs_fill(&kernel, visit.count, hit + k, work);
      if (core->gain != NULL)
        cdem_pairs_gain(&kernel, visit.count, hit + k, work);
      cdem_dem_law(dem, &core->model[m], &work->batch, true);
      cdem_pairs_rows(s->dim, work);
      for (int i = 0; i < visit.count; i++)
        visit.pair[i] = kernel.first + (hit[k + i] >> 1);
      see(context, &visit);
    }
}

static void visit_walls(cdem_dem *dem, int32_t chunk, double step, cdem_dem_see *see,
                        void *context) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  cdem_dem_work *work = &core->work[0];
  int32_t model_start[CDEM_MODELS_MOST + 1];
  double *history[CDEM_BATCH];
  cdem_dem_wall_hits(dem, chunk, work, model_start);
  for (int32_t m = 0; m < core->models; m++)
    for (int32_t k = model_start[m]; k < model_start[m + 1]; k += CDEM_BATCH) {
      cdem_dem_visit visit = {
          .dem = dem, .work = work, .model = &core->model[m], .wall = true, .chunk = chunk};
      visit.count = model_start[m + 1] - k < CDEM_BATCH ? model_start[m + 1] - k : CDEM_BATCH;
      cdem_dem_wall_fill(dem, &core->model[m], work, k, visit.count, history);
      work->batch.step = step;
      cdem_dem_law(dem, &core->model[m], &work->batch, true);
      cdem_pairs_rows(s->dim, work);
      for (int i = 0; i < visit.count; i++)
        visit.touch[i] = work->wall_model[k + i];
      see(context, &visit);
    }
}

/* Touches were found at the same places before: finding them again changes nothing. */
void cdem_dem_visit_at(const cdem_dem *dem, double step, cdem_dem_see *see, void *context) {
  cdem_dem copy = *dem;
  for (int32_t c = 0; c < dem->store->core->chunks; c++) {
    visit_pairs(&copy, c, step, see, context);
    if (dem->store->walls != NULL)
      visit_walls(&copy, c, step, see, context);
  }
}

double *cdem_dem_as_seen(const cdem_dem *dem) {
  double *motion = dem->store->motion;
  if (dem->store->core->seen_holds)
    dem->store->motion = dem->store->core->seen;
  return motion;
}

void cdem_dem_visit_all(const cdem_dem *dem, cdem_dem_see *see, void *context) {
  double *motion = cdem_dem_as_seen(dem);
  cdem_dem_visit_at(dem, 0.0, see, context);
  dem->store->motion = motion;
}
