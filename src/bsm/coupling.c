#include "bsm/coupling.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_coupling_release(cdem_coupling *coupling) {
  free(coupling->before);
  free(coupling->after);
  free(coupling->reaction);
  free(coupling->motion);
  free(coupling->rate);
  free(coupling->on);
  *coupling = (cdem_coupling){0};
}

/* ---- steps ---- */

/* Part of the bound of central differences. Closer to it, the fastest motions of the body, of which
 * the grains see two or three places a period, find grains to resonate with: narrow bands of steps,
 * from 0.9 on in strips and blocks with m from 2 to 16, in which energy grows (m = 1: none). */
static const double resonance_free = 0.8;

cdem_status cdem_coupling_limit(const cdem_body *body, double limit, const cdem_tie *tie,
                                const cdem_dem *fine, double *most_step, cdem_fault *fault) {
  double *all, *stiffness = NULL;
  CDEM_NEW(all, 2 * fine->grains, fault);
  stiffness = cdem_allocate(2 * tie->grains, sizeof *stiffness, fault);
  cdem_status status =
      stiffness != NULL ? cdem_dem_stiffness(fine, all, all + fine->grains, fault) : CDEM_MEMORY;
  if (status == CDEM_OK) {
    for (int64_t a = 0; a < tie->grains; a++) {
      stiffness[a] = all[tie->grain[a]];
      stiffness[tie->grains + a] = all[fine->grains + tie->grain[a]];
    }
    double own = 2.0 / limit, added;
    status =
        cdem_tie_frequency2(tie, stiffness, stiffness + tie->grains, body->mass, &added, fault);
    if (status == CDEM_OK)
      *most_step = resonance_free * 2.0 / sqrt(own * own + added);
  }
  free(stiffness);
  free(all);
  return status;
}

static cdem_status check_steps(const cdem_coupling_options *o, cdem_fault *fault) {
  double wanted = o->cycles * o->fine->step;
  int largest = (int)fmin(floor(o->most_step / o->fine->step), 1e9);
  CDEM_REQUIRE(o->cycles >= 1, fault, CDEM_INPUT,
               "a step of the body of %d steps of the grains; it has at least one", o->cycles);
  CDEM_REQUIRE(wanted <= o->most_step || largest >= 1, fault, CDEM_INPUT,
               "one step of the grains, %.4g s, is longer than the body is stable with, %.4g s: "
               "let the grains take shorter steps",
               o->fine->step, o->most_step);
  CDEM_REQUIRE(
      wanted <= o->most_step, fault, CDEM_INPUT,
      "%d steps of the grains, %.4g s each, make a step of the body of %.4g s; it is stable "
      "up to %.4g s: take at most %d",
      o->cycles, o->fine->step, wanted, o->most_step, largest);
  CDEM_REQUIRE(fabs(o->coarse->step - wanted) <= 1e-9 * wanted, fault, CDEM_USAGE,
               "the body steps by %.17g s, %d steps of the grains by %.17g s", o->coarse->step,
               o->cycles, wanted);
  return CDEM_OK;
}

/* ---- forces of the grains on the body ---- */

/* What is applied to fine grains beside contacts. Their weight is not among it: the body's solver
 * weighs its nodes, whose masses hold those of the grains. */
static void add_applied(const cdem_dem *fine, const cdem_tie *tie, double *on) {
  for (int64_t a = 0; fine->applied != NULL && a < tie->grains; a++)
    for (int k = 0; k < 6; k++)
      on[6 * a + k] += fine->applied[6 * (int64_t)tie->grain[a] + k];
}

static void take_reactions(cdem_coupling *c) {
  const cdem_coupling_options *o = &c->options;
  size_t count = (size_t)o->coarse->nodes * (size_t)o->coarse->dofs;
  memset(c->reaction, 0, count * sizeof *c->reaction);
  cdem_dem_forces_on(o->fine, o->tie->grains, o->tie->grain, c->on);
  cdem_tie_forces(o->tie, c->on, c->reaction);
  if (o->fine_tie != NULL) {
    cdem_dem_forces_on(o->fine, o->fine_tie->grains, o->fine_tie->grain, c->on);
    add_applied(o->fine, o->fine_tie, c->on);
    cdem_tie_forces(o->fine_tie, c->on, c->reaction);
  }
  memcpy(o->coarse->applied, c->reaction, count * sizeof *c->reaction);
}

cdem_status cdem_coupling_init(const cdem_coupling_options *options, cdem_coupling *coupling,
                               cdem_fault *fault) {
  cdem_coupling c = {.options = *options, .step = options->cycles * options->fine->step};
  int64_t count = (int64_t)options->coarse->nodes * options->coarse->dofs;
  int64_t most = options->tie->grains;
  if (options->fine_tie != NULL && options->fine_tie->grains > most)
    most = options->fine_tie->grains;
  CDEM_TRY(check_steps(options, fault));
  c.before = cdem_allocate(count, sizeof *c.before, fault);
  c.after = cdem_allocate(count, sizeof *c.after, fault);
  c.reaction = cdem_allocate(count, sizeof *c.reaction, fault);
  c.motion = cdem_allocate(6 * most, sizeof *c.motion, fault);
  c.rate = cdem_allocate(6 * most, sizeof *c.rate, fault);
  c.on = cdem_allocate(6 * most, sizeof *c.on, fault);
  if (c.before == NULL || c.after == NULL || c.reaction == NULL || c.motion == NULL ||
      c.rate == NULL || c.on == NULL) {
    cdem_coupling_release(&c);
    return CDEM_MEMORY;
  }
  cdem_status status =
      options->absorb != NULL ? cdem_absorb_apply(options->absorb, fault) : CDEM_OK;
  if (status != CDEM_OK) {
    cdem_coupling_release(&c);
    return status;
  }
  take_reactions(&c);
  *coupling = c;
  return CDEM_OK;
}

/* ---- one step ---- */

/* Velocity of the first fine step (its middle, at dt/2) and the acceleration. */
static void drive(cdem_coupling *c) {
  const cdem_coupling_options *o = &c->options;
  const cdem_tie *tie = o->tie;
  size_t count = (size_t)o->coarse->nodes * (size_t)o->coarse->dofs;
  bool steady = o->way == CDEM_BSM_VELOCITY;
  double half = 0.5 * o->fine->step;
  for (size_t i = 0; i < count; i++) { /* v_n and a_n, or v_{n+1/2} and none */
    c->after[i] = steady ? 0.0 : 2.0 * (o->coarse->v[i] - c->before[i]) / c->step;
    c->before[i] = steady ? o->coarse->v[i] : c->before[i];
  }
  cdem_tie_motion(tie, c->before, c->motion);
  cdem_tie_motion(tie, c->after, c->rate);
  for (int64_t a = 0; a < tie->grains; a++) {
    cdem_dem_motion first, rate;
    for (int k = 0; k < 3; k++) {
      rate.velocity[k] = c->rate[6 * a + k];
      rate.spin[k] = c->rate[6 * a + 3 + k];
      first.velocity[k] = c->motion[6 * a + k] + half * rate.velocity[k];
      first.spin[k] = c->motion[6 * a + 3 + k] + half * rate.spin[k];
    }
    cdem_dem_drive(o->fine, tie->grain[a], &first, &rate);
  }
}

/* Work of the reactions over the step that the body has taken: half with the forces before it, half
 * with those after. */
static void book(cdem_coupling *c) {
  const cdem_solver *coarse = c->options.coarse;
  size_t count = (size_t)coarse->nodes * (size_t)coarse->dofs;
  double sum = 0.0;
  for (size_t i = 0; i < count; i++)
    sum += c->reaction[i] * coarse->v[i];
  c->work += 0.5 * c->step * sum;
}

/* The grains' steps; the layer's forces, which change as fast as the grains move, with each. */
static cdem_status step_grains(const cdem_coupling_options *o, cdem_fault *fault) {
  if (o->absorb == NULL)
    return cdem_dem_steps(o->fine, o->cycles, fault);
  CDEM_TRY(cdem_absorb_apply(o->absorb, fault)); /* others may have cleared what stood there */
  for (int s = 0; s < o->cycles; s++) {
    CDEM_TRY(cdem_dem_steps(o->fine, 1, fault));
    CDEM_TRY(cdem_absorb_apply(o->absorb, fault));
  }
  return CDEM_OK;
}

static double now(const cdem_coupling *c) {
  return c->options.clock != NULL ? c->options.clock() : 0.0;
}

static cdem_status step_coarse(cdem_coupling *c, cdem_fault *fault) {
  const cdem_coupling_options *o = &c->options;
  char limiter[64];
  double begun = now(c);
  cdem_solver_velocity(o->coarse, c->before);
  CDEM_TRY(cdem_solver_step(o->coarse, fault));
  if (!(o->coarse->step >= (1.0 - 1e-9) * c->step)) {
    double limit = cdem_solver_limit(o->coarse, limiter);
    return cdem_fail(fault, CDEM_NUMERIC,
                     "at t = %.6g s the step of the body, %d steps of the grains or %.4g s, has "
                     "become unstable: the limit is now %.4g s, set by %s; take fewer cycles",
                     o->coarse->time, o->cycles, c->step, limit, limiter);
  }
  CDEM_REQUIRE(o->coarse->step <= (1.0 + 1e-9) * c->step, fault, CDEM_USAGE,
               "the step of the body has changed to %.17g s; a coupled body has a fixed step",
               o->coarse->step);
  c->cost.coarse += now(c) - begun;
  return CDEM_OK;
}

cdem_status cdem_coupling_step(cdem_coupling *c, cdem_fault *fault) {
  const cdem_coupling_options *o = &c->options;
  CDEM_TRY(step_coarse(c, fault));
  double begun = now(c);
  book(c);
  drive(c);
  double driven = now(c);
  CDEM_TRY(step_grains(o, fault));
  CDEM_REQUIRE(fabs(o->cycles * o->fine->step - c->step) <= 1e-9 * c->step, fault, CDEM_USAGE,
               "the step of the grains has changed to %.17g s; coupled grains have a fixed step",
               o->fine->step);
  double moved = now(c);
  take_reactions(c);
  book(c);
  c->cost.fine += moved - driven;
  c->cost.transfer += driven - begun + now(c) - moved;
  return CDEM_OK;
}

/* ---- state ---- */

cdem_status cdem_coupling_save(const cdem_coupling *coupling, cdem_state *state,
                               cdem_fault *fault) {
  return cdem_state_add_copy(state, "coupling/work", CDEM_ARRAY_REAL, 1, &coupling->work, fault);
}

cdem_status cdem_coupling_restore(cdem_coupling *coupling, const cdem_state *state,
                                  cdem_fault *fault) {
  CDEM_TRY(cdem_state_get(state, "coupling/work", CDEM_ARRAY_REAL, 1, &coupling->work, fault));
  if (coupling->options.absorb != NULL)
    CDEM_TRY(cdem_absorb_restored(coupling->options.absorb, fault));
  take_reactions(coupling);
  return CDEM_OK;
}
