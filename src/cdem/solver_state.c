#include "cdem/solver_store.h"

#include <stdio.h>
#include <string.h>

/* One list for both ways: what is saved is what is restored. */
typedef struct {
  const char *name;
  cdem_array_type type;
  int64_t count;
  void *data;
} entry;

enum { FIXED_ENTRIES = 8, PLATE_ENTRIES = 8, REALS = 16 + CDEM_SUMS, COUNTS = 5 };

static int list_fixed(const cdem_solver *solver, entry list[FIXED_ENTRIES]) {
  const cdem_solver_store *s = solver->store;
  int64_t count = (int64_t)solver->nodes * solver->dofs;
  int n = 0;
  list[n++] = (entry){"solver/u", CDEM_ARRAY_REAL, count, solver->u};
  list[n++] = (entry){"solver/v", CDEM_ARRAY_REAL, count, solver->v};
  list[n++] = (entry){"solver/force", CDEM_ARRAY_REAL, count, solver->force};
  list[n++] = (entry){"solver/external", CDEM_ARRAY_REAL, count, solver->external};
  list[n++] = (entry){"solver/applied", CDEM_ARRAY_REAL, count, solver->applied};
  if (s->fictitious != NULL)
    list[n++] = (entry){"solver/mass", CDEM_ARRAY_REAL, count, s->fictitious};
  if (s->handed != NULL)
    list[n++] = (entry){"solver/handed", CDEM_ARRAY_BYTE, s->options.blocks->pairs, s->handed};
  return n;
}

static void list_plate(const cdem_plate_store *p, entry list[PLATE_ENTRIES]) {
  list[0] = (entry){"slip", CDEM_ARRAY_REAL, 2 * (int64_t)p->nodes, p->slip};
  list[1] = (entry){"last", CDEM_ARRAY_REAL, 2 * (int64_t)p->nodes, p->last};
  list[2] = (entry){"normal", CDEM_ARRAY_REAL, p->nodes, p->normal};
  list[3] = (entry){"touch", CDEM_ARRAY_BYTE, p->nodes, p->touch};
  list[4] = (entry){"moved", CDEM_ARRAY_REAL, 3, (void *)p->moved};
  list[5] = (entry){"force", CDEM_ARRAY_REAL, 3, (void *)p->force};
  list[7] = (entry){"area", CDEM_ARRAY_REAL, p->nodes, p->area};
  list[6] = (entry){"stored", CDEM_ARRAY_REAL, 1, (void *)&p->stored};
}

static void plate_name(char name[64], int plate, const char *what) {
  snprintf(name, 64, "solver/plate%d/%s", plate, what);
}

/* Numbers of a solver, packed; `in` unpacks. */
static void pack_reals(cdem_solver *solver, double real[REALS], bool in) {
  cdem_solver_store *s = solver->store;
  double *at[] = {&solver->time,    &solver->step,      &s->base_time,         &s->previous,
                  &s->plate_work,   &s->plate_friction, &s->gravity_start,     &s->initial,
                  &s->exchange,     &s->omega2_body,    &s->omega2_interfaces, &s->omega2_contact,
                  &s->omega2_plates};
  int n = 0;
  for (size_t k = 0; k < sizeof at / sizeof at[0]; k++, n++) {
    if (in)
      *at[k] = real[n];
    else
      real[n] = *at[k];
  }
  for (int k = 0; k < CDEM_SUMS; k++, n++) {
    if (in)
      s->total[k] = real[n];
    else
      real[n] = s->total[k];
  }
}

/* Versions count from the start of a process; what matters is whether there is something new. */
static void pack_counts(cdem_solver *solver, int64_t count[COUNTS], bool in) {
  cdem_solver_store *s = solver->store;
  const cdem_interfaces *interfaces = s->options.interfaces;
  const cdem_contact *contact = s->options.contact;
  if (in) {
    solver->steps = count[0];
    s->base_steps = count[1];
    s->stale = count[2] != 0;
    if (interfaces != NULL)
      s->interfaces_version = interfaces->version - (count[3] != 0);
    if (contact != NULL)
      s->contact_version = contact->version - (count[4] != 0);
    return;
  }
  count[0] = solver->steps;
  count[1] = s->base_steps;
  count[2] = s->stale;
  count[3] = interfaces != NULL && interfaces->version != s->interfaces_version;
  count[4] = contact != NULL && contact->version != s->contact_version;
}

cdem_status cdem_solver_save(const cdem_solver *solver, cdem_state *state, cdem_fault *fault) {
  const cdem_solver_store *s = solver->store;
  cdem_solver copy = *solver; /* packing reads only */
  entry list[FIXED_ENTRIES], plate[PLATE_ENTRIES];
  double real[REALS] = {0};
  int64_t count[COUNTS] = {0};
  int entries = list_fixed(solver, list);
  for (int k = 0; k < entries; k++)
    CDEM_TRY(cdem_state_add(state, list[k].name, list[k].type, list[k].count, list[k].data, fault));
  pack_reals(&copy, real, false);
  pack_counts(&copy, count, false);
  CDEM_TRY(cdem_state_add_copy(state, "solver/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(cdem_state_add_copy(state, "solver/counts", CDEM_ARRAY_INT64, COUNTS, count, fault));
  for (int p = 0; p < s->options.plates; p++) {
    list_plate(&s->plate[p], plate);
    for (int k = 0; k < PLATE_ENTRIES; k++) {
      char name[64];
      plate_name(name, p, plate[k].name);
      CDEM_TRY(cdem_state_add(state, name, plate[k].type, plate[k].count, plate[k].data, fault));
    }
  }
  if (s->options.interfaces != NULL)
    CDEM_TRY(cdem_interfaces_save(s->options.interfaces, state, fault));
  if (s->options.contact != NULL)
    CDEM_TRY(cdem_contact_save(s->options.contact, state, fault));
  return CDEM_OK;
}

static cdem_status check_fits(const cdem_solver *solver, const cdem_state *state,
                              cdem_fault *fault) {
  entry list[FIXED_ENTRIES];
  int entries = list_fixed(solver, list);
  for (int k = 0; k < entries; k++) {
    const cdem_array *array = cdem_state_find(state, list[k].name);
    CDEM_REQUIRE(
        array != NULL && array->type == list[k].type && array->count == list[k].count, fault,
        CDEM_INPUT,
        "the checkpoint does not belong to this case: '%s' has %lld entries, the case %lld",
        list[k].name, array == NULL ? 0LL : (long long)array->count, (long long)list[k].count);
  }
  return CDEM_OK;
}

/* The numbers that decide how the run goes on. */
static cdem_status check_clock(const double real[REALS], const int64_t count[COUNTS],
                               cdem_fault *fault) {
  CDEM_REQUIRE(real[0] >= 0.0 && real[1] >= 0.0 && count[0] >= 0 && count[0] < INT64_MAX / 2 &&
                   count[1] >= 0 && count[1] <= count[0],
               fault, CDEM_INPUT,
               "the checkpoint stands at t = %g s after %lld steps of %g s, which cannot be; it "
               "does not belong to this case",
               real[0], (long long)count[0], real[1]);
  return CDEM_OK;
}

cdem_status cdem_solver_restore(cdem_solver *solver, const cdem_state *state, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  entry list[FIXED_ENTRIES], plate[PLATE_ENTRIES];
  double real[REALS];
  int64_t count[COUNTS];
  CDEM_TRY(check_fits(solver, state, fault));
  CDEM_TRY(cdem_state_get(state, "solver/reals", CDEM_ARRAY_REAL, REALS, real, fault));
  CDEM_TRY(cdem_state_get(state, "solver/counts", CDEM_ARRAY_INT64, COUNTS, count, fault));
  CDEM_TRY(check_clock(real, count, fault));
  int entries = list_fixed(solver, list);
  for (int k = 0; k < entries; k++)
    CDEM_TRY(cdem_state_get(state, list[k].name, list[k].type, list[k].count, list[k].data, fault));
  for (int p = 0; p < s->options.plates; p++) {
    list_plate(&s->plate[p], plate);
    for (int k = 0; k < PLATE_ENTRIES; k++) {
      char name[64];
      plate_name(name, p, plate[k].name);
      CDEM_TRY(cdem_state_get(state, name, plate[k].type, plate[k].count, plate[k].data, fault));
    }
  }
  if (s->options.interfaces != NULL)
    CDEM_TRY(cdem_interfaces_restore(s->options.interfaces, state, fault));
  if (s->options.contact != NULL)
    CDEM_TRY(cdem_contact_restore(s->options.contact, state, fault));
  pack_reals(solver, real, true);
  pack_counts(solver, count, true);
  s->ties_version = -1;
  cdem_solver_ties(solver);
  cdem_solver_paths(solver, cdem_solver_next_time(solver));
  return CDEM_OK;
}
