/* Steps: grains move, walls and cell follow, forces are evaluated where everything stands then.
 *
 * One team of threads stays together until the list of candidates is outlived or the steps are
 * done. Chunks are dealt out in the same way to moving and to forces, so that a thread finds its
 * grains in its cache. */
#include "dem/confine.h"
#include "dem/walls_store.h"

#include <math.h>
#include <omp.h>
#include <string.h>

typedef enum { GO_ON, DONE, BUILD, CHANGE, FAILED } outcome;

void cdem_dem_set_time(cdem_dem *dem, double time) {
  dem->time = time;
  dem->store->core->base_time = time;
  dem->store->core->base_steps = dem->steps;
}

void cdem_dem_wall_centers(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  for (int w = 0; s->walls != NULL && w < s->options.walls; w++)
    memcpy(s->core->wall_center + 3 * w, s->walls->body[w].center, 3 * sizeof(double));
}

/* The cell and its images at t_{n+1}; image_velocity is what they did on the way. */
static void advance_cell(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  const cdem_cell_answer answer = {dem->step, core->bulk, fmax(dem->step, core->response),
                                   core->viscosity};
  double before[27][3];
  memcpy(before, s->image, sizeof before);
  cdem_cell_rate(&s->cell, dem->time, core->stress, &answer, core->rate);
  cdem_cell_advance(&s->cell, core->rate, dem->step);
  cdem_cell_images(&s->cell, s->image);
  for (int k = 0; k < 27; k++)
    for (int c = 0; c < 3; c++)
      s->image_velocity[k][c] = (s->image[k][c] - before[k][c]) / dem->step;
}

/* How far an image can have come nearer to its grain since the build. */
static double cell_moved(const cdem_dem_store *s) {
  double most = 0.0;
  for (int k = 0; k < 27; k++) {
    double d2 = 0.0;
    for (int c = 0; c < 3; c++) {
      double d = s->image[k][c] - s->core->built_image[k][c];
      d2 += d * d;
    }
    most = fmax(most, d2);
  }
  return sqrt(most);
}

/* Time goes on, walls and cell move; is the list still good? */
static outcome advance(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  double moved2 = 0.0, wall = 0.0;
  bool bad = false;
  if (core->confine != NULL)
    cdem_confine_aim(dem);
  if (s->walls != NULL) {
    const cdem_wall_loads loads = {core->wall_force, core->wall_stiff, core->wall_push};
    cdem_walls_advance(s, dem->time, dem->step, &loads, &wall);
    core->wall_moved = wall;
  }
  if (s->pair_image != NULL)
    advance_cell(dem);
  if (s->options.energies)
    cdem_dem_work_half(dem, dem->step);
  cdem_dem_wall_centers(dem);
  dem->steps++;
  dem->time = core->base_time + (double)(dem->steps - core->base_steps) * dem->step;
  if (core->confine != NULL)
    cdem_confine_move(dem);
  for (int32_t c = 0; c < core->chunks; c++) {
    moved2 = fmax(moved2, core->part[c].moved2);
    bad |= core->part[c].bad >= 0;
  }
  if (bad || (core->confine != NULL && isnan(core->confine->host.moved)))
    return FAILED;
  double moved = sqrt(moved2);
  if (core->flow.on)
    return cdem_dem_flow_outlived(dem, moved) ? BUILD : GO_ON;
  double shift = s->pair_image != NULL ? cell_moved(s) : 0.0;
  bool outlived = 2.0 * moved + shift >= s->skin || moved + core->wall_moved >= 0.5 * s->skin;
  if (core->confine != NULL)
    outlived = outlived || moved + core->confine->host.moved >= s->skin;
  return outlived ? BUILD : GO_ON;
}

static void move_chunk(cdem_dem *dem, int32_t c) {
  cdem_dem_core *core = dem->store->core;
  cdem_move_kernel kernel = {dem->store, core, dem->step, dem->applied, true};
  core->part[c].moved2 = 0.0;
  core->part[c].bad = -1;
  if (core->all || core->part[c].driven)
    cdem_grains_move_all(&kernel, cdem_chunk_from(dem, c), cdem_chunk_to(dem, c), &core->part[c]);
  else
    cdem_grains_move(&kernel, cdem_chunk_from(dem, c), cdem_chunk_to(dem, c), &core->part[c]);
  if (core->flow.on)
    cdem_dem_flow_chunk(dem, c, &core->part[c]);
}

/* Steps until the list is outlived or `left` are done; with `moved`, the first begins with its
 * forces (after a build). */
static outcome team(cdem_dem *dem, bool moved, int64_t *left) {
  cdem_dem_core *core = dem->store->core;
  outcome result = GO_ON;
  bool reference = dem->store->options.reference;
#pragma omp parallel num_threads(core->threads)
  {
    cdem_dem_work *work = &core->work[omp_get_thread_num()];
    bool begin_with_forces = moved;
    while (true) {
      if (!begin_with_forces) {
#pragma omp for schedule(static)
        for (int32_t c = 0; c < core->chunks; c++)
          move_chunk(dem, c);
#pragma omp single
        result = advance(dem);
        if (result != GO_ON)
          break;
      }
      begin_with_forces = false;
#pragma omp for schedule(static)
      for (int32_t c = 0; c < core->chunks; c++)
        if (!reference)
          cdem_dem_force_chunk(dem, c, dem->step, work);
      if (core->confine != NULL)
        cdem_confine_forces(dem);
#pragma omp single
      {
        if (reference)
          cdem_dem_reference(dem, dem->step);
        cdem_dem_force_after(dem, dem->step);
        if (core->relook)
          result = CHANGE;
        if (--*left == 0)
          result = DONE;
      }
      if (result != GO_ON)
        break;
    }
  }
  return result;
}

static cdem_status report_bad(const cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  int32_t at = 0;
  CDEM_REQUIRE(s->core->confine == NULL || !isnan(s->core->confine->host.moved), fault,
               CDEM_NUMERIC,
               "the membrane is no longer finite at t = %.6g s; the pressure may be too large, or "
               "the step too long",
               dem->time);
  for (int32_t c = s->core->chunks - 1; c >= 0; c--)
    at = s->core->part[c].bad >= 0 ? s->core->part[c].bad : at;
  const double *x = cdem_place(s, at), *v = cdem_motion(s, at);
  double speed = cdem_norm3(v);
  if (!isfinite(speed) || !isfinite(cdem_norm3(x)))
    return cdem_fail(fault, CDEM_NUMERIC,
                     "the motion is no longer finite at t = %.6g s, at grain %d (%.4g, %.4g, %.4g "
                     "m); a load or a motion may be too large, or the step too long",
                     dem->time, s->id[at], x[0], x[1], x[2]);
  return cdem_fail(fault, CDEM_NUMERIC,
                   "grain %d moves by more than its radius %.4g m in one step at t = %.6g s: %.4g "
                   "m/s at (%.4g, %.4g, %.4g m); take a shorter step or softer loads",
                   s->id[at], x[3], dem->time, speed, x[0], x[1], x[2]);
}

/* Forces are complete; after a build the limit of the step is looked at. */
static cdem_status complete(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  cdem_dem_gather(dem);
  if (!core->relook)
    return CDEM_OK;
  core->relook = false;
  cdem_dem_bulk(dem);
  CDEM_TRY(cdem_dem_relook(dem, fault));
  if (core->wanted > 0.0)
    cdem_dem_change_step(dem, core->wanted);
  core->wanted = 0.0;
  return CDEM_OK;
}

static cdem_status build(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_wrap_begin(dem);
  CDEM_TRY(cdem_dem_rebuild(dem, true, fault));
  cdem_dem_wrap_end(dem);
  dem->store->core->relook = true;
  return CDEM_OK;
}

cdem_status cdem_dem_steps(cdem_dem *dem, int64_t steps, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t left = steps;
  outcome result = GO_ON;
  if (steps <= 0)
    return CDEM_OK;
  CDEM_REQUIRE(!core->failed, fault, CDEM_NUMERIC, "the motion of the grains has failed before");
  core->all = dem->applied != NULL || s->options.energies || s->options.local_damping > 0.0;
  do {
    core->seen_holds = false;
    result = team(dem, result == BUILD, &left);
    if (result == FAILED) {
      core->failed = true;
      return report_bad(dem, fault);
    }
    cdem_status status = result == BUILD ? build(dem, fault) : complete(dem, fault);
    core->failed = status != CDEM_OK;
    if (status != CDEM_OK && result == BUILD)
      cdem_neighbours_forget(dem->store);
    CDEM_TRY(status);
  } while (result != DONE);
  return CDEM_OK;
}

cdem_status cdem_dem_step(cdem_dem *dem, cdem_fault *fault) {
  return cdem_dem_steps(dem, 1, fault);
}
