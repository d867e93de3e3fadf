#include "cdem/solver_store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Contacts open and close between steps. At the limit of a linear spring such a one can keep a
 * motion alive that turns around at every step, since that costs the leapfrog no energy; at half of
 * that step it dies out (check "stack at rest" of cdem verify). Hence four times their squared
 * frequency.
 */
enum { UNILATERAL = 4 };

/* The largest eigenvalue of a sum of stiffnesses is not above the sum of theirs. Local damping
 * works against the spring: in the worst phase a node feels (1 + alpha) F, and alternating motions
 * neither grow nor get stuck below omega dt = 2/sqrt(1 + alpha) (docs/rooms/cdem-solver.md). */
static double stable_step(const cdem_solver_store *s) {
  double omega2 =
      s->omega2_body + s->omega2_interfaces + UNILATERAL * s->omega2_contact + s->omega2_plates;
  return 2.0 / sqrt(omega2 * (1.0 + s->options.local_damping));
}

static double safety(const cdem_solver_store *s) {
  return s->options.safety > 0.0 ? s->options.safety : 0.8;
}

void cdem_solver_body_limit(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  const cdem_model *model = s->options.body->model;
  int32_t cell = -1;
  double omega = cdem_body_frequency(s->options.body, &cell);
  s->omega2_body = omega * omega;
  if (cell >= 0)
    snprintf(s->limiter_body, sizeof s->limiter_body, "element %lld",
             (long long)model->mesh->cell_tag[model->cell[cell]]);
  else
    snprintf(s->limiter_body, sizeof s->limiter_body, "the body");
}

double cdem_solver_limit(const cdem_solver *solver, char limiter[64]) {
  const cdem_solver_store *s = solver->store;
  if (s->options.fictitious_mass) {
    snprintf(limiter, 64, "fictitious masses");
    return 1.0 / safety(s);
  }
  snprintf(limiter, 64, "%s", s->limiter_body);
  double most = s->omega2_body;
  if (s->omega2_interfaces > most) {
    most = s->omega2_interfaces;
    snprintf(limiter, 64, "interfaces");
  }
  if (UNILATERAL * s->omega2_contact > most) {
    most = UNILATERAL * s->omega2_contact;
    snprintf(limiter, 64, "contact");
  }
  if (s->omega2_plates > most)
    snprintf(limiter, 64, "plate '%.50s'", s->options.plate[s->limiter_plate].name);
  return stable_step(s);
}

static void set_step(cdem_solver *solver, double step) {
  cdem_solver_store *s = solver->store;
  if (step == solver->step)
    return;
  s->base_time = solver->time;
  s->base_steps = solver->steps;
  solver->step = step;
}

/* Gershgorin by nodes: with m_i = (row sum of i)(1 + alpha)/(4 safety^2) no eigenfrequency exceeds
 * 2 safety/sqrt(1 + alpha), so that the step 1 is right for every node. Masses never shrink: what
 * breaks off leaves them as they are. The row sums of the contact are at most its squared frequency
 * times the real mass. */
void cdem_solver_masses(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  double factor = (1.0 + o->local_damping) / (4.0 * safety(s) * safety(s));
  size_t dofs = (size_t)solver->dofs;
  memcpy(s->row_sum, s->row_body, (size_t)solver->nodes * sizeof *s->row_sum);
  if (o->interfaces != NULL)
    cdem_interfaces_row_sums(o->interfaces, s->row_sum);
  cdem_solver_plates_row_sums(solver, s->row_sum);
  double contact = o->contact != NULL ? UNILATERAL * cdem_contact_frequency2(o->contact) : 0.0;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t n = 0; n < solver->nodes; n++) {
    size_t first = (size_t)n * dofs;
    double mass = factor * (s->row_sum[n] + contact * o->body->mass[first]);
    for (size_t i = 0; i < dofs; i++) {
      double own = (int)i < s->dimension ? mass : factor * s->row_couple[n];
      s->fictitious[first + i] = fmax(s->fictitious[first + i], own);
    }
  }
}

static void look_at_interfaces(cdem_solver *solver, bool all) {
  cdem_solver_store *s = solver->store;
  cdem_interfaces *interfaces = s->options.interfaces;
  if (interfaces == NULL || (!all && interfaces->version == s->interfaces_version))
    return;
  /* Springs that only break make no step too long: it is enough to look now and then. */
  if (!all && !cdem_interfaces_any_tied(interfaces) && s->cell_stress == NULL &&
      solver->steps % CDEM_SOLVER_LIMIT_EVERY != 0)
    return;
  s->interfaces_version = interfaces->version;
  s->omega2_interfaces = cdem_interfaces_frequency2(interfaces, s->inertia);
}

static void look_at_contact(cdem_solver *solver, bool all) {
  cdem_solver_store *s = solver->store;
  cdem_contact *contact = s->options.contact;
  if (contact == NULL || (!all && contact->version == s->contact_version))
    return;
  s->contact_version = contact->version;
  s->omega2_contact = cdem_contact_frequency2(contact);
}

void cdem_solver_relook(cdem_solver *solver, bool all) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  int64_t versions[2] = {s->interfaces_version, s->contact_version};
  if (o->fictitious_mass) {
    bool changed = (o->interfaces != NULL && o->interfaces->version != versions[0]) ||
                   (o->contact != NULL && o->contact->version != versions[1]);
    if (!changed && !all)
      return;
    s->interfaces_version = o->interfaces != NULL ? o->interfaces->version : 0;
    s->contact_version = o->contact != NULL ? o->contact->version : 0;
    cdem_solver_masses(solver);
    return;
  }
  look_at_interfaces(solver, all);
  look_at_contact(solver, all);
  if (all)
    s->omega2_plates = cdem_solver_plates_frequency2(solver, &s->limiter_plate);
  else if (versions[0] == s->interfaces_version && versions[1] == s->contact_version)
    return;
  double most = safety(s) * stable_step(s);
  if (o->step > 0.0) /* as asked for, as long as that is stable */
    most = o->step <= stable_step(s) ? o->step : fmin(o->step, most);
  if (most < solver->step || most >= (o->step > 0.0 ? 1.0 : 1.25) * solver->step)
    set_step(solver, most);
}

cdem_status cdem_solver_first_step(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  if (s->options.fictitious_mass) {
    s->interfaces_version = s->options.interfaces != NULL ? s->options.interfaces->version : 0;
    s->contact_version = s->options.contact != NULL ? s->options.contact->version : 0;
    set_step(solver, 1.0);
    return CDEM_OK;
  }
  cdem_solver_relook(solver, true);
  if (!(s->options.step > 0.0))
    return CDEM_OK;
  char limiter[64];
  double limit = cdem_solver_limit(solver, limiter);
  CDEM_REQUIRE(s->options.step <= limit, fault, CDEM_INPUT,
               "a step of %.6g s is unstable; the longest is %.6g s, set by %s: take at most that, "
               "or leave the step out",
               s->options.step, limit, limiter);
  return CDEM_OK;
}
