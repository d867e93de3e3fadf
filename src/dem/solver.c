#include "dem/confine.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---- */

/* A zeroed array on cache lines of its own; what was allocated is kept for freeing. */
static void *lines(cdem_dem_core *core, int64_t count, size_t size, cdem_fault *fault) {
  int64_t bytes = count * (int64_t)size;
  void *block = cdem_allocate(bytes + 64, 1, fault);
  if (block == NULL)
    return NULL;
  core->block[core->blocks++] = block;
  return (void *)(((uintptr_t)block + 63) & ~(uintptr_t)63);
}

#define LINES(pointer, count)                                                                      \
  do {                                                                                             \
    (pointer) = lines(core, (count), sizeof *(pointer), fault);                                    \
    if ((pointer) == NULL)                                                                         \
      return CDEM_MEMORY;                                                                          \
  } while (0)

static void sorts(cdem_dem_store *s, void *address, size_t size) {
  s->sort[s->sorted++] = (cdem_dem_sorted){address, size};
}

/* Runs of grains that one thread works on. Short enough that a few thousand grains keep some
 * threads busy, whatever their number: sums must not know it. */
static int32_t chunk_length(int32_t grains) {
  int32_t length = grains / 16;
  length = length > CDEM_CHUNK ? CDEM_CHUNK : length;
  return length < CDEM_CHUNK_LEAST ? CDEM_CHUNK_LEAST : length;
}

static cdem_status allocate(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t n = s->grains, walls = s->options.walls;
  core->chunk = chunk_length(s->grains);
  core->chunks = (s->grains + core->chunk - 1) / core->chunk;
  LINES(s->place, 4 * n);
  LINES(s->motion, 8 * n);
  LINES(s->force, 8 * n);
  LINES(s->travel, 8 * n);
  LINES(core->since, 8 * n);
  LINES(core->seen, 8 * n);
  if (s->options.energies)
    LINES(core->gain, 8 * n);
  LINES(core->part, core->chunks);
  CDEM_NEW(s->id, n, fault);
  CDEM_NEW(s->slot, n, fault);
  CDEM_NEW(s->material, n, fault);
  CDEM_NEW(s->kind, n, fault);
  CDEM_NEW(core->radius, n, fault);
  CDEM_NEW(core->material, n, fault);
  CDEM_NEW(core->far_start, n + 1, fault);
  CDEM_NEW(core->wall_part, 8 * walls * core->chunks, fault);
  CDEM_NEW(core->wall_force, 6 * walls, fault);
  CDEM_NEW(core->wall_stiff, walls, fault);
  CDEM_NEW(core->wall_push, walls, fault);
  CDEM_NEW(core->wall_center, 3 * walls, fault);
  core->works = core->threads;
  LINES(core->work, core->works);
  if (core->driven) {
    CDEM_NEW(core->drive, 6 * n, fault);
    CDEM_NEW(core->drive_rate, 6 * n, fault);
  }
  if (s->options.cell != NULL)
    CDEM_NEW(s->turns, 4 * n, fault);
  sorts(s, &s->place, 4 * sizeof(double));
  sorts(s, &s->motion, 8 * sizeof(double));
  sorts(s, &s->force, 8 * sizeof(double));
  sorts(s, &s->travel, 8 * sizeof(double));
  sorts(s, &core->since, 8 * sizeof(double));
  if (s->options.energies)
    sorts(s, &core->gain, 8 * sizeof(double));
  if (s->turns != NULL)
    sorts(s, &s->turns, 4 * sizeof *s->turns);
  sorts(s, &s->id, sizeof *s->id);
  sorts(s, &s->material, sizeof *s->material);
  sorts(s, &s->kind, sizeof *s->kind);
  return CDEM_OK;
}

void cdem_dem_release(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  free(dem->applied);
  if (s != NULL) {
    cdem_dem_core *core = s->core;
    cdem_neighbours_release(s);
    if (s->walls != NULL)
      cdem_walls_release(s);
    free(s->id);
    free(s->slot);
    free(s->material);
    free(s->kind);
    free(s->turns);
    if (core != NULL) {
      for (int t = 0; core->work != NULL && t < core->works; t++) {
        free(core->work[t].hit);
        free(core->work[t].ordered);
        free(core->work[t].wall_touch);
        free(core->work[t].wall_grain);
        free(core->work[t].wall_model);
      }
      cdem_bonds_release(core);
      cdem_confine_release(core);
      cdem_grains_release(&core->start);
      for (int b = 0; b < core->blocks; b++)
        free(core->block[b]);
      free(core->model);
      free(core->model_of);
      free(core->radius);
      free(core->material);
      free(core->drive);
      free(core->drive_rate);
      free(core->pair_owner);
      free(core->pair_target);
      free(core->far_block);
      free(core->far_start);
      free(core->wall_part);
      free(core->wall_force);
      free(core->wall_stiff);
      free(core->wall_push);
      free(core->wall_center);
      free(core);
    }
    free(s);
  }
  *dem = (cdem_dem){0};
}

/* ---- grains ---- */

static void place_grain(cdem_dem *dem, int32_t i) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  const cdem_grains *g = &core->start;
  const double pi = 3.14159265358979323846;
  double r = g->radius[i], *x = cdem_place(s, i), *v = cdem_motion(s, i), *f = cdem_force(s, i);
  s->id[i] = s->slot[i] = i;
  s->material[i] = core->material[i] = g->material != NULL ? g->material[i] : 0;
  s->kind[i] = g->motion != NULL ? g->motion[i] : CDEM_GRAIN_FREE;
  double density = s->options.material[s->material[i]].density;
  double solid = s->dim == 2 ? pi * (r * r) * core->thickness : 4.0 / 3.0 * pi * (r * r * r);
  double mass = density * solid, inertia = cdem_inertia_factor(s->dim) * mass * (r * r);
  bool driven = s->kind[i] == CDEM_GRAIN_DRIVEN;
  core->radius[i] = r;
  for (int c = 0; c < 3; c++) {
    bool spins = g->spin != NULL && (s->dim == 3 || c == 2);
    bool moves = g->velocity != NULL && c < s->dim;
    x[c] = g->xyz[3 * (int64_t)i + c];
    v[c] = moves ? g->velocity[3 * (int64_t)i + c] : 0.0;
    v[3 + c] = spins ? g->spin[3 * (int64_t)i + c] : 0.0;
  }
  x[3] = r;
  v[6] = mass;
  f[6] = driven ? 0.0 : 1.0 / mass;
  f[7] = driven ? 0.0 : 1.0 / inertia;
  if (core->drive != NULL)
    memcpy(core->drive + 6 * (int64_t)i, v, 6 * sizeof *v);
}

static void place_grains(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  double sum = 0.0;
  core->uniform = true;
  for (int32_t i = 0; i < s->grains; i++) {
    place_grain(dem, i);
    core->uniform &=
        cdem_place(s, i)[3] == cdem_place(s, 0)[3] && cdem_motion(s, i)[6] == cdem_motion(s, 0)[6];
    sum += cdem_place(s, i)[3];
  }
  core->mean_radius = sum / s->grains;
  s->skin = (s->options.skin > 0.0 ? s->options.skin : 0.2) * core->mean_radius;
}

static cdem_status begin(const cdem_dem_options *options, cdem_dem *dem, cdem_fault *fault) {
  CDEM_NEW(dem->store, 1, fault);
  cdem_dem_store *s = dem->store;
  CDEM_NEW(s->core, 1, fault);
  cdem_dem_core *core = s->core;
  s->options = *options;
  s->dim = dem->dim = options->grains->dim;
  s->grains = (int32_t)options->grains->grains;
  dem->grains = s->grains;
  core->threads = options->threads > 0 ? options->threads : omp_get_max_threads();
  core->thickness = options->thickness > 0.0 ? options->thickness : 1.0;
  core->automatic = options->step == 0.0;
  core->built_step = -1;
  CDEM_TRY(cdem_grains_copy(options->grains, &core->start, fault));
  s->options.grains = &core->start;
  if (options->safety == 0.0)
    s->options.safety = 0.1;
  for (int64_t i = 0; core->start.motion != NULL && i < s->grains; i++)
    core->driven |= core->start.motion[i] != CDEM_GRAIN_FREE;
  for (int w = 0; w < options->walls; w++)
    core->servos |= cdem_dot3(options->wall[w].servo, options->wall[w].servo) > 0.0 ||
                    options->wall[w].servo_radius;
  CDEM_TRY(allocate(dem, fault));
  /* a team is worth it from a few chunks on */
  if (core->threads > core->chunks / 2)
    core->threads = core->chunks / 2 > 1 ? core->chunks / 2 : 1;
  CDEM_TRY(cdem_dem_models(dem, fault));
  place_grains(dem);
  return CDEM_OK;
}

static void begin_cell(cdem_dem_store *s) {
  if (s->options.cell == NULL) {
    for (int k = 0; k < 9; k += 4)
      s->cell.h[k] = 1.0;
    return;
  }
  s->cell = *s->options.cell;
  cdem_cell_images(&s->cell, s->image);
  for (int k = 0; k < 27; k++)
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++)
        s->image_velocity[k][r] += cdem_series_at(&s->cell.rate[3 * r + c], 0.0) * s->image[k][c];
}

static cdem_status init(const cdem_dem_options *options, cdem_dem *dem, cdem_fault *fault) {
  CDEM_TRY(cdem_dem_check(options, fault));
  CDEM_TRY(begin(options, dem, fault));
  cdem_dem_store *s = dem->store;
  begin_cell(s);
  if (options->walls > 0)
    CDEM_TRY(cdem_walls_init(s, fault));
  if (options->bonds > 0)
    CDEM_TRY(cdem_bonds_init(dem, fault));
  if (s->walls != NULL)
    CDEM_TRY(cdem_walls_check(s, fault));
  CDEM_TRY(cdem_confine_init(dem, fault));
  CDEM_TRY(cdem_dem_rebuild(dem, true, fault));
  CDEM_TRY(cdem_dem_check_overlaps(dem, fault));
  cdem_dem_wall_centers(dem);
  cdem_dem_evaluate(dem, 0.0);
  CDEM_TRY(cdem_dem_first_step(dem, fault));
  if (s->core->confine != NULL)
    CDEM_TRY(cdem_confine_calm(dem, fault));
  cdem_dem_bulk(dem);
  cdem_dem_keep_seen(dem);
  for (int32_t i = 0; i < s->grains; i++) {
    double now[6];
    memcpy(now, cdem_motion(s, i), sizeof now);
    cdem_grain_set_before(dem, i, now);
  }
  if (s->core->confine != NULL)
    cdem_confine_change_step(dem, 0.0, dem->step);
  cdem_dem_book_start(dem);
  return CDEM_OK;
}

cdem_status cdem_dem_init(const cdem_dem_options *options, cdem_dem *dem, cdem_fault *fault) {
  *dem = (cdem_dem){0};
  cdem_status status = init(options, dem, fault);
  if (status != CDEM_OK)
    cdem_dem_release(dem);
  return status;
}

cdem_status cdem_dem_want_applied(cdem_dem *dem, cdem_fault *fault) {
  if (dem->applied == NULL)
    CDEM_NEW(dem->applied, 6 * dem->grains, fault);
  return CDEM_OK;
}

void cdem_dem_drive(cdem_dem *dem, int64_t grain, const cdem_dem_motion *motion,
                    const cdem_dem_motion *rate) {
  cdem_dem_core *core = dem->store->core;
  if (core->drive == NULL)
    return;
  double *drive = core->drive + 6 * grain, *grows = core->drive_rate + 6 * grain;
  for (int c = 0; c < 3; c++) {
    bool turns = dem->dim == 3 || c == 2;
    drive[c] = c < dem->dim ? motion->velocity[c] : 0.0;
    drive[3 + c] = turns ? motion->spin[c] : 0.0;
    grows[c] = rate != NULL && c < dem->dim ? rate->velocity[c] : 0.0;
    grows[3 + c] = rate != NULL && turns ? rate->spin[c] : 0.0;
  }
}
