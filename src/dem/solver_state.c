/* Everything that changes, in the internal order, which is part of the state.
 *
 * The list of pairs is saved as it is. The candidates of walls are built again, with twice the
 * skin: they hold all that may touch until the next build, which comes when it would have come.
 * Which candidates do not touch changes no bit. */
#include "dem/confine.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *name;
  cdem_array_type type;
  int64_t count;
  void *data;
} entry;

enum { ENTRIES = 26, REALS = 16 + CDEM_DEM_SUMS, COUNTS = 6 };

static int list_arrays(const cdem_dem *dem, entry list[ENTRIES]) {
  const cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t n = s->grains, walls = s->options.walls;
  int k = 0;
  list[k++] = (entry){"dem/place", CDEM_ARRAY_REAL, 4 * n, s->place};
  list[k++] = (entry){"dem/motion", CDEM_ARRAY_REAL, 8 * n, s->motion};
  list[k++] = (entry){"dem/force", CDEM_ARRAY_REAL, 8 * n, s->force};
  list[k++] = (entry){"dem/travel", CDEM_ARRAY_REAL, 8 * n, s->travel};
  list[k++] = (entry){"dem/since", CDEM_ARRAY_REAL, 8 * n, core->since};
  list[k++] = (entry){"dem/id", CDEM_ARRAY_INT32, n, s->id};
  if (core->gain != NULL)
    list[k++] = (entry){"dem/gain", CDEM_ARRAY_REAL, 8 * n, core->gain};
  if (core->seen_holds)
    list[k++] = (entry){"dem/seen", CDEM_ARRAY_REAL, 8 * n, core->seen};
  if (s->turns != NULL)
    list[k++] = (entry){"dem/turns", CDEM_ARRAY_INT32, 4 * n, s->turns};
  if (core->drive != NULL)
    list[k++] = (entry){"dem/drive", CDEM_ARRAY_REAL, 6 * n, core->drive};
  if (core->drive_rate != NULL)
    list[k++] = (entry){"dem/drive_rate", CDEM_ARRAY_REAL, 6 * n, core->drive_rate};
  if (dem->applied != NULL)
    list[k++] = (entry){"dem/applied", CDEM_ARRAY_REAL, 6 * n, dem->applied};
  list[k++] = (entry){"dem/wall_force", CDEM_ARRAY_REAL, 6 * walls, core->wall_force};
  list[k++] = (entry){"dem/wall_stiffness", CDEM_ARRAY_REAL, walls, core->wall_stiff};
  list[k++] = (entry){"dem/wall_push", CDEM_ARRAY_REAL, walls, core->wall_push};
  list[k++] = (entry){"dem/cell", CDEM_ARRAY_REAL, 9, (void *)(uintptr_t)s->cell.h};
  list[k++] = (entry){"dem/image", CDEM_ARRAY_REAL, 81, (void *)(uintptr_t)s->image};
  list[k++] =
      (entry){"dem/image_velocity", CDEM_ARRAY_REAL, 81, (void *)(uintptr_t)s->image_velocity};
  list[k++] = (entry){"dem/image_built", CDEM_ARRAY_REAL, 81, core->built_image};
  list[k++] = (entry){"dem/image_force", CDEM_ARRAY_REAL, 81, core->image_force};
  list[k++] = (entry){"dem/stress", CDEM_ARRAY_REAL, 9, core->stress};
  list[k++] = (entry){"dem/cell_rate", CDEM_ARRAY_REAL, 9, core->rate};
  list[k++] = (entry){"dem/flow", CDEM_ARRAY_REAL, 9, core->flow.gradient};
  list[k++] = (entry){"dem/drift", CDEM_ARRAY_REAL, 3, core->flow.drift};
  list[k++] = (entry){"dem/flow_more", CDEM_ARRAY_REAL, 9, core->flow.more};
  list[k++] = (entry){"dem/drift_more", CDEM_ARRAY_REAL, 3, core->flow.on_way};
  return k;
}

enum { AT_TIME, AT_STEP, AT_SKIN = 7 }; /* of these numbers */

static void pack_reals(cdem_dem *dem, double real[REALS], bool in) {
  cdem_dem_core *core = dem->store->core;
  double *at[] = {&dem->time,       &dem->step,        &core->base_time, &core->wall_work,
                  &core->cell_work, &core->initial,    &core->exchange,  &dem->store->skin,
                  &core->bulk,      &core->wall_moved, &core->response};
  int n = 0;
  for (size_t k = 0; k < sizeof at / sizeof at[0]; k++, n++) {
    if (in)
      *at[k] = real[n];
    else
      real[n] = *at[k];
  }
  for (int k = 0; k < CDEM_DEM_SUMS; k++, n++) {
    if (in)
      core->base[k] = real[n];
    else
      real[n] = core->base[k];
  }
  double *more[] = {&core->joints, &core->viscosity};
  for (size_t k = 0; k < sizeof more / sizeof more[0]; k++, n++) {
    if (in)
      *more[k] = real[n];
    else
      real[n] = *more[k];
  }
}

static cdem_status save_sums(const cdem_dem *dem, cdem_state *state, cdem_fault *fault) {
  const cdem_dem_core *core = dem->store->core;
  int64_t count = (int64_t)core->chunks * CDEM_DEM_SUMS;
  double *sums;
  CDEM_NEW(sums, count, fault);
  for (int32_t c = 0; c < core->chunks; c++)
    memcpy(sums + (int64_t)c * CDEM_DEM_SUMS, core->part[c].sum, sizeof core->part[c].sum);
  cdem_status status = cdem_state_add_owned(state, "dem/sums", CDEM_ARRAY_REAL, count, sums, fault);
  if (status != CDEM_OK)
    free(sums);
  return status;
}

static cdem_status restore_sums(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  int64_t count = (int64_t)core->chunks * CDEM_DEM_SUMS;
  double *sums;
  CDEM_NEW(sums, count, fault);
  cdem_status status = cdem_state_get(state, "dem/sums", CDEM_ARRAY_REAL, count, sums, fault);
  for (int32_t c = 0; status == CDEM_OK && c < core->chunks; c++)
    memcpy(core->part[c].sum, sums + (int64_t)c * CDEM_DEM_SUMS, sizeof core->part[c].sum);
  free(sums);
  return status;
}

cdem_status cdem_dem_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  const cdem_dem_core *core = s->core;
  cdem_dem copy = *dem; /* packing reads only */
  entry list[ENTRIES];
  double real[REALS] = {0};
  int64_t count[COUNTS] = {dem->steps,      core->base_steps,     core->built_step,
                           core->automatic, dem->applied != NULL, core->seen_holds};
  int entries = list_arrays(dem, list);
  for (int k = 0; k < entries; k++)
    CDEM_TRY(cdem_state_add(state, list[k].name, list[k].type, list[k].count, list[k].data, fault));
  pack_reals(&copy, real, false);
  CDEM_TRY(cdem_state_add_copy(state, "dem/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(cdem_state_add_copy(state, "dem/counts", CDEM_ARRAY_INT64, COUNTS, count, fault));
  CDEM_TRY(save_sums(dem, state, fault));
  CDEM_TRY(cdem_neighbours_save(s, state, fault));
  if (s->walls != NULL)
    CDEM_TRY(cdem_walls_save(s, state, fault));
  if (core->confine != NULL)
    CDEM_TRY(cdem_confine_save(dem, state, fault));
  return core->bonds > 0 ? cdem_bonds_save(dem, state, fault) : CDEM_OK;
}

/* The numbers that decide how the run goes on. */
static cdem_status check_clock(const double real[REALS], const int64_t count[COUNTS],
                               cdem_fault *fault) {
  CDEM_REQUIRE(real[AT_TIME] >= 0.0 && real[AT_STEP] > 0.0 && count[0] >= 0 &&
                   count[0] < INT64_MAX / 2 && count[1] >= 0 && count[1] <= count[0] &&
                   count[2] >= -1 && count[2] <= count[0],
               fault, CDEM_INPUT,
               "the checkpoint stands at t = %g s after %lld steps of %g s, which cannot be; it "
               "does not belong to this case",
               real[AT_TIME], (long long)count[0], real[AT_STEP]);
  return CDEM_OK;
}

/* The skin that the case gives, or one that an automatic one can come to. */
static cdem_status check_skin(const cdem_dem *dem, double skin, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  double mean = s->core->mean_radius, part = s->options.skin;
  double least = part > 0.0 ? part : CDEM_DEM_LEAST_SKIN,
         most = part > 0.0 ? part : CDEM_DEM_MOST_SKIN;
  CDEM_REQUIRE(skin >= least * mean && skin <= most * mean, fault, CDEM_INPUT,
               "the list of neighbours in the checkpoint has a skin of %g m, which cannot be; it "
               "does not belong to this case",
               skin);
  return CDEM_OK;
}

/* What the constant arrays are in the restored order. */
static cdem_status order_again(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  const cdem_grains *g = &s->core->start;
  for (int32_t i = 0; i < s->grains; i++)
    s->slot[i] = -1;
  for (int32_t i = 0; i < s->grains; i++) {
    int32_t id = s->id[i];
    CDEM_REQUIRE(id >= 0 && id < s->grains && s->slot[id] < 0, fault, CDEM_INPUT,
                 "the checkpoint does not belong to this case: grain %d is not one of its %d", id,
                 s->grains);
    CDEM_REQUIRE(s->place[4 * (int64_t)i + 3] == s->core->radius[id], fault, CDEM_INPUT,
                 "the checkpoint does not belong to this case: grain %d has radius %g m, not %g m",
                 id, s->place[4 * (int64_t)i + 3], s->core->radius[id]);
    s->slot[id] = i;
    s->material[i] = s->core->material[id];
    s->kind[i] = g->motion != NULL ? g->motion[id] : CDEM_GRAIN_FREE;
  }
  return CDEM_OK;
}

static cdem_status restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  double real[REALS];
  int64_t count[COUNTS];
  entry list[ENTRIES];
  CDEM_TRY(cdem_state_get(state, "dem/counts", CDEM_ARRAY_INT64, COUNTS, count, fault));
  CDEM_TRY(cdem_state_get(state, "dem/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(check_clock(real, count, fault));
  CDEM_TRY(check_skin(dem, real[AT_SKIN], fault));
  core->seen_holds = count[5] != 0;
  if (count[4] != 0)
    CDEM_TRY(cdem_dem_want_applied(dem, fault));
  int entries = list_arrays(dem, list);
  for (int k = 0; k < entries; k++)
    CDEM_TRY(cdem_state_get(state, list[k].name, list[k].type, list[k].count, list[k].data, fault));
  pack_reals(dem, real, true);
  dem->steps = count[0];
  core->base_steps = count[1];
  core->built_step = count[2];
  core->automatic = count[3] != 0;
  cdem_dem_flow flow = core->flow;
  cdem_dem_flow_start(dem);
  memcpy(core->flow.gradient, flow.gradient, sizeof flow.gradient);
  memcpy(core->flow.drift, flow.drift, sizeof flow.drift);
  CDEM_TRY(order_again(dem, fault));
  CDEM_TRY(restore_sums(dem, state, fault));
  if (core->bonds > 0)
    CDEM_TRY(cdem_bonds_restore(dem, state, fault));
  /* No build of pairs: it would bring grains back into a periodic cell before their time. */
  CDEM_TRY(cdem_neighbours_restore(s, state, fault));
  if (core->confine != NULL)
    CDEM_TRY(cdem_confine_restore(dem, state, fault));
  if (s->walls != NULL) {
    double skin = s->skin;
    s->skin = 2.0 * skin;
    cdem_status status = cdem_walls_build(s, fault);
    s->skin = skin;
    CDEM_TRY(status);
    CDEM_TRY(cdem_walls_restore(s, state, fault));
  }
  cdem_dem_wall_centers(dem);
  return cdem_dem_lists(dem, fault);
}

cdem_status cdem_dem_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  cdem_status status = restore(dem, state, fault);
  core->failed = status != CDEM_OK; /* half restored: good for nothing but being released */
  if (status != CDEM_OK)
    cdem_neighbours_forget(dem->store);
  core->wanted = 0.0;
  core->relook = false;
  return status;
}
