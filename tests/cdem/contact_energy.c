/* Contact gives back no more than it was given, whatever way things come and go, and the book of
 * the solver closes. */
#include "cdem/contact_support.h"
#include "joints_support.h"

/* Work done on the bodies by the forces before and after a motion by v dt, by the trapezoid. */
static double half_power(const scene *s, double dt) {
  double sum = 0.0;
  for (int32_t i = 0; i < s->blocks.mesh.nodes * s->dofs; i++)
    sum += 0.5 * dt * s->force[i] * s->v[i];
  return sum;
}

/* A box led over another one, through its edges and corners, slowly and fast, for some rounds. */
static void led_around(int dim, double turn, double speed, const cdem_contact_law *law,
                       uint64_t seed) {
  scene s;
  cdem_random random = {seed};
  scene_box box[2] = {{{3, 2, 2}, {1, 1, 1}, {0, 0, 0}, 0},
                      {{2, 2, 2}, {0.6, 0.7, 0.5}, {0.2, 0.1, 1.02}, turn}};
  if (dim == 2)
    box[1].origin[1] = 1.02 + fmax(0.0, -0.6 * sin(turn));
  scene_make(&s, dim, 2, box);
  scene_start(&s, law);
  double dt = 1e-4, given = 0.0, most = 0.0, shift[3] = {0.0}, at[3], phase[3];
  for (int k = 0; k < 3; k++)
    phase[k] = cdem_random_uniform(&random, 0.0, 6.28);
  scene_forces(&s, 0.0);
  bool ended = false;
  for (int i = 1; i < 2500 && !ended; i++) {
    double a = speed * i, v[3];
    for (int k = 0; k < 3; k++)
      at[k] = k == dim - 1 ? 0.03 * (sin(a + phase[2]) - sin(phase[2])) - 0.02
                           : 0.5 * (sin(0.17 * (k + 1) * a + phase[k]) - sin(phase[k]));
    ended = i > 1500 && scene_totals(&s).contacts == 0;
    for (int k = 0; k < 3; k++) {
      v[k] = (at[k] - shift[k]) / dt;
      shift[k] = at[k];
    }
    scene_move(&s, 1, (double[3]){v[0] * dt, v[1] * dt, v[2] * dt});
    scene_velocity(&s, 1, v);
    given -= half_power(&s, dt);
    memset(s.force, 0, (size_t)s.blocks.mesh.nodes * (size_t)s.dofs * sizeof(double));
    if (cdem_contact_forces(&s.contact, s.u, s.v, dt, s.force, NULL) != CDEM_OK)
      break; /* led too deep: the run stops, and nothing more is asked */
    given -= half_power(&s, dt);
    most = fmax(most, given);
    cdem_contact_totals t = scene_totals(&s);
    double booked = t.stored + t.friction + t.damping;
    assert_true(t.friction >= 0.0 && t.damping >= 0.0);
    /* What is booked was given, but for contacts that gave a last step too much. */
    check_near(booked, given, 0.0, 2e-2 * most);
    assert_true(given >= -2e-2 * most);
  }
  assert_true(most > 0.0);
  scene_release(&s);
}

static void contact_is_passive(void **state) {
  (void)state;
  cdem_contact_law law = {.kn = 1e9}, rough = {.kn = 1e9, .kt = 5e8, .friction = 0.4};
  for (int dim = 2; dim <= 3; dim++)
    for (int way = 0; way < 4; way++)
      led_around(dim, 0.3 * (way % 3 - 1), way < 2 ? 0.004 : 0.03, way % 2 ? &rough : &law,
                 (uint64_t)(17 + way));
}

/* Found deep inside at once (nothing moved it there): no force from nothing; from there on the
 * full stiffness. */
static void deep_contact_begins_without_force(void **state) {
  (void)state;
  scene s;
  cdem_contact_law law = {.kn = 1e9};
  scene_box box[2] = {{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 0}, {{1, 1, 1}, {1, 1, 1}, {0, 0, 1.5}, 0}};
  double f[3], dt = 1e-5, d = 1e-5, v[3] = {0.0, 0.0, -1.0};
  scene_make(&s, 3, 2, box);
  scene_start(&s, &law);
  scene_forces(&s, 0.0);
  scene_move(&s, 1, (double[3]){0.0, 0.0, -0.55});
  scene_forces(&s, dt);
  scene_resultant(&s, 1, f);
  check_below(fabs(f[2]), 1e-9 * law.kn * 0.05);
  scene_velocity(&s, 1, v);
  for (int i = 1; i <= 10; i++) {
    scene_move(&s, 1, (double[3]){0.0, 0.0, -d});
    scene_forces(&s, dt);
    scene_resultant(&s, 1, f);
    check_near(f[2], law.kn * i * d, 1e-6, 0.0);
  }
  check_near(scene_totals(&s).stored, 0.5 * law.kn * 100.0 * d * d, 1e-6, 0.0);
  scene_release(&s);
}

/* Loose squares and cubes thrown together, at the solver's own step. */
static void colliding_blocks_gain_nothing(void **state) {
  (void)state;
  for (int solid = 0; solid < 2; solid++) {
    rig_options o = solid ? rig_cube(2) : rig_square(5, 4);
    o.threads = 1;
    jointed j;
    make_jointed(&o, glue(CDEM_INSERTION_PENALTY, 1e6), true, &j);
    j.r.options.interfaces = NULL;
    for (int32_t f = 0; f < j.r.blocks.facets; f++)
      cdem_contact_activate(&j.contact, f);
    int dofs = j.r.body.dofs;
    double *velocity = calloc((size_t)(dofs * j.r.body.nodes), sizeof *velocity);
    for (int32_t n = 0; n < j.r.body.nodes; n++) {
      const double *x = j.r.blocks.mesh.xyz + 3 * n;
      velocity[dofs * n] = -3.0 * (x[0] - 0.5);
      velocity[dofs * n + 1] = -2.0 * (x[1] - 0.4) + (x[0] > 0.5 ? 1.0 : 0.0);
    }
    j.r.options.velocity = velocity;
    rig_start(&j.r);
    double first = 0.0, p0[3], p[3], scale = 0.0, touched = 0.0;
    cdem_solver_momentum(&j.r.solver, p0, p);
    for (int32_t n = 0; n < j.r.body.nodes; n++)
      scale += j.r.body.mass[dofs * n] * fabs(velocity[dofs * n]);
    for (int k = 0; k < 60; k++) {
      rig_run(&j.r, 10);
      cdem_energy_book book = check_book(&j.r.solver, 1e-3);
      double held = book.kinetic + book.elastic + book.contact;
      first = k == 0 ? held + book.friction + book.damping : first;
      touched = fmax(touched, book.contact);
      assert_true(book.friction >= 0.0 && book.damping >= 0.0);
      assert_true(held <= first * (1.0 + 1e-3));
    }
    assert_true(touched > 0.0);
    cdem_solver_momentum(&j.r.solver, p, (double[3]){0});
    for (int k = 0; k < 3; k++)
      check_near(p[k], p0[k], 0.0, 1e-11 * scale);
    release_jointed(&j);
    free(velocity);
  }
}

/* Force between the halves of a body, pressed and sheared apart. */
static double force_across(const jointed *j, int component) {
  double sum = 0.0;
  for (int32_t n = 0; n < j->r.body.nodes; n++)
    if (j->r.blocks.node_block[n] == 1)
      sum += j->r.solver.force[j->r.body.dofs * n + component];
  return sum;
}

/* Springs fail in shear under pressure, slide, and are released: over the step in which contact
 * takes over the force goes on as smoothly as before it, but for the area, and no energy is lost
 * from the book. */
static void release_is_continuous(void **state) {
  (void)state;
  rig_options o = rig_square(2, 1);
  o.distortion = 0.0;
  o.threads = 1;
  jointed j;
  cdem_interface_law law = glue(CDEM_INSERTION_PENALTY, 1e5);
  law.kn = law.ks = 1e10;
  make_jointed(&o, law, false, &j);
  cdem_fault fault = {0};
  cdem_contact_options contact = {.blocks = &j.r.blocks,
                                  .dofs = 2,
                                  .thickness = o.thickness,
                                  .law = {1e10, 1e10, 0.3, 0.0},
                                  .mass = j.r.body.mass,
                                  .threads = 1};
  check_ok(cdem_contact_init(&contact, &j.contact, &fault));
  j.r.options.contact = &j.contact;
  j.r.options.step = 2e-6;
  int dofs = j.r.body.dofs;
  double *velocity = calloc((size_t)(dofs * j.r.body.nodes), sizeof *velocity);
  for (int32_t n = 0; n < j.r.body.nodes; n++) {
    double sign = j.r.blocks.node_block[n] == 1 ? -1.0 : 1.0;
    velocity[dofs * n] = 0.5 * sign;
    velocity[dofs * n + 1] = 60.0 * sign;
  }
  j.r.options.velocity = velocity;
  rig_start(&j.r);
  double f[3] = {0.0}, bend = 0.0, jump = -1.0, pressed = 0.0, before = 0.0, stored = 0.0;
  int released = -1;
  for (int i = 0; i < 3000 && released < 0; i++) {
    rig_run(&j.r, 1);
    f[0] = f[1];
    f[1] = f[2];
    f[2] = force_across(&j, 0);
    if (j.interfaces.released[0]) {
      cdem_energy_book last;
      cdem_solver_energies(&j.r.solver, &last);
      before = last.error;
      stored = last.interface;
      released = i;
      pressed = f[2];
      rig_run(&j.r, 1);
      jump = fabs(force_across(&j, 0) - 2.0 * f[2] + f[1]);
    } else if (i > 20) {
      bend = fmax(bend, fabs(f[2] - 2.0 * f[1] + f[0]));
    }
  }
  cdem_energy_book book;
  cdem_solver_energies(&j.r.solver, &book);
  assert_true(released > 20 && pressed > 0.0);
  /* The springs stand on the whole face, contact on what still lies over the other: 5 % less. */
  double slipped = 0.05 * pressed;
  check_near(jump, slipped, 0.0, 1e-2 * slipped + 3.0 * bend);
  check_below(fabs(book.error - before), 1e-4 * stored);
  release_jointed(&j);
  free(velocity);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contact_is_passive),
      cmocka_unit_test(deep_contact_begins_without_force),
      cmocka_unit_test(colliding_blocks_gain_nothing),
      cmocka_unit_test(release_is_continuous),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
