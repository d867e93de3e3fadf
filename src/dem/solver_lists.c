/* What follows from a new list of candidates: owners, far rows, bonds, room for the threads. */
#include "dem/confine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Owners; and pairs of driven grains are no contacts; which chunks hold driven grains. */
static cdem_status owners(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t room = core->capacity[0];
  CDEM_TRY(cdem_grow(&core->pair_owner, &room, s->pairs + 1, sizeof *core->pair_owner, fault));
  CDEM_TRY(cdem_grow(&core->pair_target, &core->capacity[0], s->pairs + 1,
                     sizeof *core->pair_target, fault));
  for (int32_t i = 0; i < s->grains; i++)
    for (int64_t p = s->pair_start[i]; p < s->pair_start[i + 1]; p++) {
      core->pair_owner[p] = i;
      if (core->driven && s->kind[i] == CDEM_GRAIN_DRIVEN &&
          s->kind[s->pair_other[p]] == CDEM_GRAIN_DRIVEN)
        s->pair_touch[p] = 2;
    }
  for (int32_t c = 0; c < core->chunks; c++) {
    core->part[c].driven = false;
    for (int32_t i = cdem_chunk_from(dem, c); i < cdem_chunk_to(dem, c); i++)
      core->part[c].driven |= s->kind[i] != CDEM_GRAIN_FREE;
  }
  return CDEM_OK;
}

/* Far rows by grain, in the order of owners: first counted, then numbered. Bonds go with pairs. */
static cdem_status targets(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int32_t *start = core->far_start, chunk = core->chunk;
  memset(start, 0, ((size_t)s->grains + 1) * sizeof *start);
  for (int64_t p = 0; p < s->pairs; p++)
    if (core->pair_owner[p] / chunk != s->pair_other[p] / chunk)
      start[s->pair_other[p]]++;
  for (int64_t b = 0; b < core->bonds; b++)
    if (core->bond[b].owner / chunk != core->bond[b].other / chunk)
      start[core->bond[b].other]++;
  int64_t rows = 0;
  for (int32_t i = 0; i <= s->grains; i++) {
    int32_t count = start[i];
    start[i] = (int32_t)rows;
    rows += count;
    CDEM_REQUIRE(rows < INT32_MAX, fault, CDEM_INPUT, "too many pairs of grains: more than %d",
                 INT32_MAX);
  }
  if (rows > core->rows) {
    rows += rows / 4;
    void *block = cdem_allocate(rows + 1, 8 * sizeof(double), fault);
    if (block == NULL)
      return CDEM_MEMORY;
    free(core->far_block);
    core->far_block = block;
    core->far = (double *)(((uintptr_t)block + 63) & ~(uintptr_t)63);
    core->rows = rows;
  }
  for (int64_t p = 0; p < s->pairs; p++) {
    int32_t j = s->pair_other[p];
    core->pair_target[p] = core->pair_owner[p] / chunk == j / chunk ? j : -1 - start[j]++;
  }
  for (int64_t b = 0; b < core->bonds; b++) {
    int32_t j = core->bond[b].other;
    core->bond[b].target = core->bond[b].owner / chunk == j / chunk ? j : -1 - start[j]++;
  }
  for (int32_t i = s->grains; i > 0; i--)
    start[i] = start[i - 1];
  start[0] = 0;
  return CDEM_OK;
}

static cdem_status grow_work(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t most = 0;
  for (int32_t c = 0; c < core->chunks; c++) {
    int64_t pairs = s->pair_start[cdem_chunk_to(dem, c)] - s->pair_start[cdem_chunk_from(dem, c)];
    most = pairs > most ? pairs : most;
  }
  for (int t = 0; t < core->works; t++) {
    cdem_dem_work *work = &core->work[t];
    int64_t room = work->hits;
    if (core->models > 1)
      CDEM_TRY(cdem_grow(&work->ordered, &room, most + 64, sizeof *work->ordered, fault));
    CDEM_TRY(cdem_grow(&work->hit, &work->hits, most + 64, sizeof *work->hit, fault));
    if (s->walls != NULL && !cdem_dem_wall_room(work, core->chunk))
      return cdem_fail(fault, CDEM_MEMORY, "out of memory: touches of walls");
  }
  return CDEM_OK;
}

cdem_status cdem_dem_lists(cdem_dem *dem, cdem_fault *fault) {
  CDEM_TRY(owners(dem, fault));
  if (dem->store->core->bonds > 0)
    CDEM_TRY(cdem_bonds_sort(dem, fault));
  CDEM_TRY(targets(dem, fault));
  return grow_work(dem, fault);
}

/* Displacements since the last build go to the totals; the skin follows how long the list lasted.
 */
static void start_anew(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  for (int64_t k = 0; k < 8 * (int64_t)s->grains; k++) {
    s->travel[k] += core->since[k];
    core->since[k] = 0.0;
  }
  int64_t lasted = dem->steps - core->built_step;
  if (s->options.skin == 0.0 && core->built_step >= 0) {
    double least = CDEM_DEM_LEAST_SKIN * core->mean_radius,
           most = CDEM_DEM_MOST_SKIN * core->mean_radius;
    if (lasted < 40)
      s->skin = fmin(most, 1.4 * s->skin);
    else if (lasted > 400)
      s->skin = fmax(least, 0.8 * s->skin);
  }
  core->built_step = dem->steps;
  core->wall_moved = 0.0;
}

cdem_status cdem_dem_rebuild(cdem_dem *dem, bool sort, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  start_anew(dem);
  CDEM_TRY(cdem_neighbours_build(s, sort, s->core->threads, fault));
  memcpy(s->core->built_image, s->image, sizeof s->image); /* edges may be new */
  cdem_dem_flow_start(dem);
  if (s->core->bonds > 0)
    CDEM_TRY(cdem_bonds_carry(dem, fault));
  if (s->walls != NULL)
    CDEM_TRY(cdem_walls_build(s, fault));
  if (s->core->confine != NULL)
    CDEM_TRY(cdem_confine_build(dem, fault));
  return cdem_dem_lists(dem, fault);
}
