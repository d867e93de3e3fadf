/* The columns of history.csv: declared and filled by one walk, so that they cannot part. */
#include "run/history.h"

#include "base/suggest.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  cdem_table *table;
  bool declare; /* else fill the last row */
  int column;
  cdem_status status; /* of declaring */
  cdem_fault *fault;
} row_writer;

__attribute__((format(printf, 4, 5))) static void put(row_writer *w, const char *unit, double value,
                                                      const char *format, ...) {
  if (!w->declare) {
    cdem_table_set_real(w->table, w->column++, value);
    return;
  }
  char name[160];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(name, sizeof name, format, arguments);
  va_end(arguments);
  if (w->status == CDEM_OK)
    w->status = cdem_table_add_column(w->table, name, CDEM_COLUMN_REAL, unit, w->fault);
}

static void put_energies(row_writer *w, cdem_run_setup *setup) {
  cdem_energy_book book = {0};
  double by_class[CDEM_CLASSES] = {0};
  /* The scale of the error remembers every report, so declaring must not be one. */
  if (!w->declare) {
    cdem_solver_energies(&setup->solver, &book);
    cdem_body_energy(&setup->body, setup->solver.u, by_class);
  }
  put(w, "J", book.kinetic, "kinetic");
  put(w, "J", book.elastic, "elastic");
  put(w, "J", book.interface, "interface");
  put(w, "J", book.contact, "contact");
  put(w, "J", book.plate, "plate");
  put(w, "J", book.fracture, "fracture");
  put(w, "J", book.friction, "friction");
  put(w, "J", book.damping, "damping");
  put(w, "J", book.quiet, "quiet");
  put(w, "J", book.load, "load");
  put(w, "J", book.gravity, "gravity");
  put(w, "J", book.support, "support");
  put(w, "", book.exchange > 0.0 ? fabs(book.error) / book.exchange : 0.0, "energy_error");
  put(w, "J", by_class[0], "energy_edge");
  put(w, "J", by_class[1], "energy_face");
  put(w, "J", by_class[2], "energy_body");
}

static void put_interfaces(row_writer *w, const cdem_run_setup *setup) {
  cdem_interfaces_totals totals = {0};
  cdem_contact_totals contacts = {0};
  if (!w->declare && setup->has_interfaces)
    cdem_interfaces_sum(&setup->interfaces, &totals);
  if (!w->declare && setup->has_contact)
    cdem_contact_sum(&setup->contact, &contacts);
  if (setup->has_interfaces) {
    put(w, "", (double)totals.softening, "softening");
    put(w, "", (double)totals.tension_failed, "tension_failed");
    put(w, "", (double)totals.shear_failed, "shear_failed");
    put(w, "", (double)totals.cracks, "cracks");
    put(w, "m2", totals.cracked_area, "cracked_area");
  }
  if (setup->has_contact)
    put(w, "", (double)contacts.contacts, "contacts");
}

static void put_conditions(row_writer *w, const cdem_run_setup *setup) {
  const cdem_run_conditions *c = &setup->conditions;
  static const char axis[] = "xyz";
  bool cosserat = setup->model.formulation == CDEM_PLANE_COSSERAT;
  for (int i = 0; i < c->supports; i++) {
    bool turns = cosserat && c->support[i].component == 2;
    put(w, turns ? "N m" : "N", w->declare ? 0.0 : cdem_solver_reaction(&setup->solver, i),
        "reaction.%s.%s", c->support[i].name,
        cdem_run_component[turns ? 3 : c->support[i].component]);
  }
  for (int i = 0; i < c->plates; i++) {
    double force[3] = {0}, moved[3] = {0};
    if (!w->declare)
      cdem_solver_plate(&setup->solver, i, force, moved);
    for (int k = 0; k < setup->model.dimension; k++)
      put(w, "N", force[k], "plate.%s.f%c", c->plate[i].name, axis[k]);
    for (int k = 0; k < setup->model.dimension; k++)
      put(w, "m", moved[k], "plate.%s.moved_%c", c->plate[i].name, axis[k]);
  }
}

static void put_all(row_writer *w, cdem_run_setup *setup, cdem_run_history *history) {
  const cdem_case_values *values = cdem_run_values(setup);
  const cdem_solver *solver = &setup->solver;
  put(w, "s", solver->time, "time");
  put(w, "", (double)solver->steps, "step");
  put(w, "s", solver->step, "time_step");
  put_energies(w, setup);
  put(w, "", w->declare ? 0.0 : cdem_solver_unbalanced(solver), "unbalanced");
  put_interfaces(w, setup);
  put_conditions(w, setup);
  if (!w->declare)
    cdem_run_probes_update(setup, history);
  for (int64_t p = 0; p < values->probes.count; p++)
    put(w, cdem_run_probe_unit(&values->probes.item[p]),
        w->declare ? 0.0 : cdem_run_probe_value(setup, history, p), "probe.%s",
        values->probes.item[p].name);
}

int cdem_run_history_find(const cdem_table *table, const char *name) {
  char probe[160];
  int column = cdem_table_find(table, name);
  snprintf(probe, sizeof probe, "probe.%s", name);
  return column >= 0 ? column : cdem_table_find(table, probe);
}

/* ---- names in the case ---- */

static cdem_status check_column(const cdem_run_setup *setup, const cdem_table *table,
                                const char *key, const char *name, cdem_fault *fault) {
  enum { MOST = 256 };
  const char *candidate[MOST];
  char known[400] = "";
  if (cdem_run_history_find(table, name) >= 0)
    return CDEM_OK;
  int count = table->columns < MOST ? table->columns : MOST;
  for (int c = 0; c < count; c++) {
    candidate[c] = table->column[c].name;
    size_t used = strlen(known);
    if (used + strlen(candidate[c]) + 8 < sizeof known)
      snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "", candidate[c]);
  }
  const char *nearest = cdem_suggest(name, candidate, count);
  return cdem_case_fail(&setup->cases, key, CDEM_INPUT, fault,
                        "history.csv has no column '%s'%s%s%s this run has %s", name,
                        nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                        nearest != NULL ? "'?" : ";", known);
}

static cdem_status check_names(const cdem_run_setup *setup, const cdem_table *table,
                               cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup);
  char key[96];
  for (int64_t p = 0; p < values->probes.count; p++)
    if (cdem_table_find(table, values->probes.item[p].name) >= 0)
      return cdem_case_fail(
          &setup->cases, cdem_run_named_key(key, "probes", values->probes.item[p].name, ""),
          CDEM_INPUT, fault, "'%s' is a column of this history; give the probe another name",
          values->probes.item[p].name);
  if (values->stop_when != NULL)
    CDEM_TRY(check_column(setup, table, "stop_when", values->stop_when, fault));
  for (int64_t i = 0; i < values->curves.count; i++) {
    const cdem_case_curve *curve = &values->curves.item[i];
    if (curve->x != NULL)
      CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "curves", curve->name, "x"),
                            curve->x, fault));
    for (int64_t y = 0; y < curve->y.count; y++)
      CDEM_TRY(check_column(setup, table, cdem_run_named_key(key, "curves", curve->name, "y"),
                            curve->y.item[y], fault));
  }
  for (int64_t i = 0; i < values->results.count; i++)
    CDEM_TRY(check_column(setup, table,
                          cdem_run_named_key(key, "results", values->results.item[i].name, "of"),
                          values->results.item[i].of, fault));
  return CDEM_OK;
}

cdem_status cdem_run_history_init(const cdem_run_setup *setup, cdem_run_history *history,
                                  cdem_fault *fault) {
  CDEM_TRY(cdem_run_probes_init(setup, history, fault));
  row_writer writer = {.table = &history->table, .declare = true, .fault = fault};
  put_all(&writer, (cdem_run_setup *)setup, history); /* declaring changes nothing */
  CDEM_TRY(writer.status);
  return check_names(setup, &history->table, fault);
}

cdem_status cdem_run_history_row(cdem_run_setup *setup, cdem_run_history *history,
                                 cdem_fault *fault) {
  history->table.rows = 0; /* rows live in the file */
  CDEM_TRY(cdem_table_add_row(&history->table, fault));
  row_writer writer = {.table = &history->table, .fault = fault};
  put_all(&writer, setup, history);
  return CDEM_OK;
}

void cdem_run_history_release(cdem_run_history *history, const cdem_run_setup *setup) {
  if (history->probe != NULL)
    for (int64_t p = 0; p < cdem_run_values(setup)->probes.count; p++)
      free(history->probe[p].node);
  free(history->probe);
  free(history->velocity);
  free(history->cell_stress);
  free(history->node_stress);
  cdem_table_release(&history->table);
  *history = (cdem_run_history){0};
}
