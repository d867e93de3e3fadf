/* Making, stepping and releasing. */
#include "fdem/confine.h"

#include <cblas.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

cdem_contact_view cdem_fdem_contact_view(const cdem_fdem_store *s, double step) {
  return (cdem_contact_view){.grains = s->grains,
                             .surface = s->surface,
                             .first = s->first,
                             .scale = s->radius,
                             .material = s->material,
                             .center = s->center,
                             .turn = s->turn,
                             .place = s->place,
                             .now = s->now,
                             .before = s->before,
                             .area = s->area,
                             .mass = s->node_mass,
                             .walls = s->options.walls,
                             .wall = s->wall,
                             .materials = s->options.materials,
                             .law = s->options.law,
                             .step = step};
}

/* Forces for the places there are; the book follows. */
static cdem_status contact_forces(cdem_fdem_store *s, double step, cdem_fault *fault) {
  cdem_contact_view view = cdem_fdem_contact_view(s, step);
  const cdem_contact_forces out = {s->force, s->wall_force, s->wall_stiff, s->stiff};
  cdem_contact_book book = {0};
  CDEM_TRY(cdem_fdem_contacts_forces(s->contacts, &view, &out, &book, fault));
  s->contact.normal = book.normal;
  s->contact.shear = book.shear;
  s->contact.friction += book.friction;
  s->contact.damping += book.damping;
  s->contact.walls += book.walls;
  return CDEM_OK;
}

static cdem_status evaluate(cdem_fdem *fdem, double step, cdem_fault *fault) {
  cdem_status status = contact_forces(fdem->store, step, fault);
  if (status == CDEM_NUMERIC)
    cdem_fault_prefix(fault, "at t = %.6g s", fdem->time);
  if (status == CDEM_OK && fdem->store->confine != NULL)
    status = cdem_fdem_confine_forces(fdem, step, fault);
  return status;
}

/* ---- making ---- */

/* From velocities at t = 0 to those of half a step before, of which the first kick and its damping
 * make them the mean; places a step ago for the dashpots. */
static void set_before(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  double step = fdem->step, damp = 1.0 + 0.5 * step * s->options.mass_damping;
  for (int64_t g = 0; g < s->grains; g++) {
    double *v = s->velocity + 3 * g, *l = s->momentum + 3 * g, spin[3];
    double push[3] = {0.0, 0.0, 0.0};
    const double *center = s->center + 3 * g;
    cdem_fdem_spin_of(s, g, s->turn + 9 * g, l, spin);
    for (int64_t i = s->first[g]; i < s->first[g + 1]; i++) {
      const double *x = s->now + 3 * i, *f = s->force + 3 * i;
      double arm[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]}, turn[3], moment[3];
      cdem_cross3(spin, arm, turn);
      cdem_cross3(arm, f, moment);
      for (int c = 0; c < 3; c++)
        s->before[3 * i + c] = x[c] - step * (v[c] + turn[c]);
      for (int c = 0; c < 3; c++)
        push[c] += 0.5 * step * moment[c];
    }
    for (int c = 0; c < 3; c++) {
      l[c] = damp * l[c] - push[c];
      v[c] = damp * v[c] - 0.5 * step * s->options.gravity[c];
    }
    for (int64_t i = s->first[g]; i < s->first[g + 1]; i++)
      for (int c = 0; c < 3; c++)
        v[c] -= 0.5 * step * s->force[3 * i + c] / s->mass[g];
  }
}

static cdem_status start(cdem_fdem *fdem, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  for (int32_t b = 0; b < s->blocks; b++)
    cdem_fdem_place_block(s, b, s->work);
  memcpy(s->before, s->now, (size_t)(3 * s->nodes) * sizeof *s->now);
  cdem_contact_view view = cdem_fdem_contact_view(s, 0.0);
  CDEM_TRY(cdem_fdem_contacts_create(&view, s->options.skin, s->threads, &s->contacts, fault));
  CDEM_TRY(cdem_fdem_confine_init(fdem, fault));
  CDEM_TRY(evaluate(fdem, 0.0, fault));
  CDEM_TRY(cdem_fdem_first_step(fdem, fault));
  if (s->confine != NULL)
    cdem_fdem_confine_calm(fdem);
  set_before(fdem);
  if (s->confine != NULL)
    cdem_fdem_confine_change_step(fdem, 0.0);
  cdem_fdem_book_start(fdem);
  return CDEM_OK;
}

cdem_status cdem_fdem_init(const cdem_fdem_options *options, cdem_fdem *fdem, cdem_fault *fault) {
  memset(fdem, 0, sizeof *fdem);
  CDEM_TRY(cdem_fdem_check(options, fault));
  CDEM_NEW(fdem->store, 1, fault);
  cdem_fdem_store *s = fdem->store;
  s->options = *options;
  s->grains = fdem->grains = options->grains.grains;
  s->threads = options->threads > 0 ? options->threads : omp_get_max_threads();
  /* Products are made by one thread each: their bits must not depend on how many there are. */
  openblas_set_num_threads(1);
  cdem_status status = cdem_fdem_setup(s, fault);
  s->options.grains = (cdem_fdem_grains){.grains = options->grains.grains};
  if (status == CDEM_OK)
    status = start(fdem, fault);
  if (status != CDEM_OK)
    cdem_fdem_release(fdem);
  return status;
}

static void release_scratch(cdem_fdem_store *s) {
  for (int t = 0; s->work != NULL && t < s->threads; t++) {
    free(s->work[t].skin);
    free(s->work[t].load);
  }
  free(s->work);
  free(s->part);
  free(s->block);
  free(s->member);
}

void cdem_fdem_release(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  if (s == NULL)
    return;
  for (int w = 0; s->wall != NULL && w < s->options.walls; w++)
    cdem_wall_body_release(s->wall + w);
  cdem_fdem_confine_release(s);
  cdem_fdem_contacts_destroy(&s->contacts);
  void *const array[] = {
      s->surface,  s->first,    s->mode,  s->shape,     s->material,   s->radius,    s->mass,
      s->inertia,  s->spins,    s->area,  s->node_mass, s->start,      s->center,    s->quaternion,
      s->turn,     s->q,        s->place, s->now,       s->before,     s->force,     s->stiff,
      s->velocity, s->momentum, s->rate,  s->wall,      s->wall_force, s->wall_stiff};
  for (size_t i = 0; i < sizeof array / sizeof *array; i++)
    free(array[i]);
  release_scratch(s);
  free(s);
  memset(fdem, 0, sizeof *fdem);
}

/* ---- stepping ---- */

static cdem_status report_bad(const cdem_fdem *fdem, cdem_fault *fault) {
  const cdem_fdem_store *s = fdem->store;
  int32_t g = -1;
  for (int32_t b = s->blocks - 1; b >= 0; b--)
    g = s->part[b].bad >= 0 ? s->part[b].bad : g;
  const double *x = s->center + 3 * (int64_t)g, *v = s->velocity + 3 * (int64_t)g;
  double speed = cdem_norm3(v);
  CDEM_REQUIRE(isfinite(speed) && speed * fdem->step >= 0.5 * s->radius[g], fault, CDEM_NUMERIC,
               "the motion is no longer finite at t = %.6g s, at grain %d; a load or a motion may "
               "be too large, or the step too long",
               fdem->time, g);
  return cdem_fail(fault, CDEM_NUMERIC,
                   "grain %d moves by more than half its radius %.4g m in one step at t = %.6g s: "
                   "%.4g m/s at (%.4g, %.4g, %.4g m); take a shorter step or softer loads",
                   g, s->radius[g], fdem->time, speed, x[0], x[1], x[2]);
}

static bool move(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  bool good = true;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t b = 0; b < s->blocks; b++)
    cdem_fdem_move_block(s, b, fdem->step, s->work + omp_get_thread_num());
  for (int32_t b = 0; b < s->blocks; b++) {
    s->sums.damping += s->part[b].sums.damping;
    s->sums.numerical += s->part[b].sums.numerical;
    good = good && s->part[b].bad < 0;
  }
  if (s->confine != NULL)
    cdem_fdem_confine_aim(fdem);
  for (int w = 0; w < s->options.walls; w++)
    cdem_wall_body_advance(s->wall + w, fdem->time, fdem->step, s->wall_force + 3 * w,
                           s->wall_stiff[w]);
  fdem->steps++;
  fdem->time = s->base_time + (double)(fdem->steps - s->base_steps) * fdem->step;
  s->kick = fdem->step;
  if (s->confine != NULL)
    cdem_fdem_confine_move(fdem);
  return good;
}

static cdem_status step_once(cdem_fdem *fdem, cdem_fault *fault) {
  if (!move(fdem))
    return report_bad(fdem, fault);
  return evaluate(fdem, fdem->step, fault);
}

cdem_status cdem_fdem_steps(cdem_fdem *fdem, int64_t steps, cdem_fault *fault) {
  cdem_fdem_store *s = fdem->store;
  CDEM_REQUIRE(!s->failed, fault, CDEM_NUMERIC, "the motion of the grains has failed before");
  for (int64_t n = 0; n < steps; n++) {
    cdem_status status = step_once(fdem, fault);
    s->failed = status != CDEM_OK;
    CDEM_TRY(status);
  }
  return CDEM_OK;
}
