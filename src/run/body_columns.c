/* The columns of history.csv of a body. */
#include "run/body.h"

static void put_energies(cdem_run_row *w, cdem_run_body *setup) {
  cdem_energy_book book = {0};
  double by_class[CDEM_CLASSES] = {0};
  /* The scale of the error remembers every report, so declaring must not be one. */
  if (!w->declare) {
    cdem_solver_energies(&setup->solver, &book);
    cdem_body_energy(&setup->body, setup->solver.u, by_class);
  }
  cdem_run_put(w, "J", book.kinetic, "kinetic");
  cdem_run_put(w, "J", book.elastic, "elastic");
  cdem_run_put(w, "J", book.interface, "interface");
  cdem_run_put(w, "J", book.contact, "contact");
  cdem_run_put(w, "J", book.plate, "plate");
  cdem_run_put(w, "J", book.fracture, "fracture");
  cdem_run_put(w, "J", book.friction, "friction");
  cdem_run_put(w, "J", book.damping, "damping");
  cdem_run_put(w, "J", book.quiet, "quiet");
  cdem_run_put(w, "J", book.load, "load");
  cdem_run_put(w, "J", book.gravity, "gravity");
  cdem_run_put(w, "J", book.support, "support");
  cdem_run_put_energy_error(w, book.error, book.exchange);
  cdem_run_put(w, "J", by_class[0], "energy_edge");
  cdem_run_put(w, "J", by_class[1], "energy_face");
  cdem_run_put(w, "J", by_class[2], "energy_body");
}

static void put_interfaces(cdem_run_row *w, const cdem_run_body *setup) {
  cdem_interfaces_totals totals = {0};
  cdem_contact_totals contacts = {0};
  if (!w->declare && setup->has_interfaces)
    cdem_interfaces_sum(&setup->interfaces, &totals);
  if (!w->declare && setup->has_contact)
    cdem_contact_sum(&setup->contact, &contacts);
  if (setup->has_interfaces) {
    cdem_run_put(w, "", (double)totals.softening, "softening");
    cdem_run_put(w, "", (double)totals.tension_failed, "tension_failed");
    cdem_run_put(w, "", (double)totals.shear_failed, "shear_failed");
    cdem_run_put(w, "", (double)totals.cracks, "cracks");
    cdem_run_put(w, "m2", totals.cracked_area, "cracked_area");
  }
  if (setup->has_contact)
    cdem_run_put(w, "", (double)contacts.contacts, "contacts");
}

static void put_conditions(cdem_run_row *w, const cdem_run_body *setup) {
  const cdem_run_conditions *c = &setup->conditions;
  bool cosserat = setup->model.formulation == CDEM_PLANE_COSSERAT;
  for (int i = 0; i < c->supports; i++) {
    bool turns = cosserat && c->support[i].component == 2;
    cdem_run_put(w, turns ? "N m" : "N", w->declare ? 0.0 : cdem_solver_reaction(&setup->solver, i),
                 "reaction.%s.%s", c->support[i].name,
                 cdem_run_component[turns ? 3 : c->support[i].component]);
  }
  for (int i = 0; i < c->plates; i++) {
    double force[3] = {0}, moved[3] = {0};
    if (!w->declare)
      cdem_solver_plate(&setup->solver, i, force, moved);
    cdem_run_put_vector(w, "N", setup->model.dimension, force, "plate.%s.f", c->plate[i].name);
    cdem_run_put_vector(w, "m", setup->model.dimension, moved, "plate.%s.moved_", c->plate[i].name);
  }
}

void cdem_run_body_columns(cdem_run_setup *run, cdem_run_row *w) {
  cdem_run_body *setup = run->context;
  const cdem_case_values *values = cdem_run_values(run);
  put_energies(w, setup);
  cdem_run_put(w, "", w->declare ? 0.0 : cdem_solver_unbalanced(&setup->solver), "unbalanced");
  put_interfaces(w, setup);
  put_conditions(w, setup);
  if (!w->declare)
    cdem_run_probes_update(setup, &setup->probes);
  for (int64_t p = 0; p < values->probes.count; p++)
    if (values->probes.item[p].group != NULL) /* others look at grains */
      cdem_run_put(w, cdem_run_probe_unit(&values->probes.item[p]),
                   w->declare ? 0.0 : cdem_run_probe_value(setup, &setup->probes, p), "probe.%s",
                   values->probes.item[p].name);
}
