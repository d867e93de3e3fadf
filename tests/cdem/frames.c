/* Frames: the arrays a solver hands out, with their names, orders and values. */
#include "cdem/frames.h"

#include "solver_support.h"

typedef struct {
  int frames;
  void (*look)(const cdem_frame *frame, const cdem_solver *solver);
  const cdem_solver *solver;
  cdem_status answer;
} looker;

static cdem_status take_frame(void *context, const cdem_frame *frame, cdem_fault *fault) {
  looker *l = context;
  l->frames++;
  if (l->answer != CDEM_OK)
    return cdem_fail(fault, l->answer, "the sink is full");
  l->look(frame, l->solver);
  return CDEM_OK;
}

static const cdem_field *field(const cdem_frame *frame, const char *name, bool on_cells,
                               int components) {
  for (int k = 0; k < frame->fields; k++)
    if (strcmp(frame->field[k].name, name) == 0) {
      assert_int_equal(frame->field[k].on_cells, on_cells);
      assert_int_equal(frame->field[k].components, components);
      return &frame->field[k];
    }
  fail_msg("no field '%s'", name);
  return NULL;
}

/* A body with known strains in all components: Hooke's stresses by hand, in VTK's order. */
static const double strain[6] = {1e-5, -2e-5, 3e-5, 4e-5, 5e-5, 6e-5}; /* xx yy zz xy yz xz */

static void look_at_body(const cdem_frame *frame, const cdem_solver *solver) {
  const cdem_mesh *mesh = solver->options->body->model->mesh;
  assert_string_equal(frame->set, "body");
  assert_int_equal(frame->index, 7);
  assert_true(frame->time == solver->time);
  assert_int_equal(frame->points, mesh->nodes);
  assert_int_equal(frame->cells, solver->options->body->model->cells);
  const double *u = field(frame, "displacement", false, 3)->data;
  const double *v = field(frame, "velocity", false, 3)->data;
  for (int32_t n = 0; n < mesh->nodes; n++)
    for (int k = 0; k < 3; k++) {
      assert_true(u[3 * n + k] == solver->u[3 * n + k]);
      check_near(frame->xyz[3 * n + k], mesh->xyz[3 * n + k] + u[3 * n + k], 0.0, 1e-15);
      check_near(v[3 * n + k], 0.0, 0.0, 1e-12);
    }
  const cdem_field *stress = field(frame, "stress", true, 6),
                   *eps = field(frame, "strain", true, 6);
  assert_string_equal(stress->unit, "Pa");
  double g = 1e9 / (2.0 * 1.25), lambda = 1e9 * 0.25 / (1.25 * 0.5);
  for (int64_t c = 0; c < frame->cells; c++) {
    assert_int_equal(frame->type[c], 12);
    assert_int_equal(frame->offset[c + 1] - frame->offset[c], 8);
    for (int k = 0; k < 6; k++) {
      double spherical = k < 3 ? lambda * (strain[0] + strain[1] + strain[2]) : 0.0;
      check_near(((const double *)eps->data)[6 * c + k], strain[k], 0.0, 1e-12);
      check_near(((const double *)stress->data)[6 * c + k], 2.0 * g * strain[k] + spherical, 0.0,
                 1e-2);
    }
  }
  double energy = 0.0, by_class[CDEM_CLASSES];
  const double *part = field(frame, "spring_energy", true, 3)->data;
  for (int64_t i = 0; i < 3 * frame->cells; i++)
    energy += part[i];
  check_near(energy, cdem_body_energy(solver->options->body, solver->u, by_class), 1e-9, 0.0);
  const int32_t *block = field(frame, "block", true, 1)->data;
  assert_int_equal(block[0], 0);
  const double *turn = field(frame, "rotation", true, 3)->data;
  check_near(turn[0], 0.0, 0.0, 1e-9);
  field(frame, "spring_force", true, 3);
}

static void body_frame_holds_the_state(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_cube(2);
  o.linear = true;
  rig_make(&o, &r);
  rig_start(&r);
  for (int32_t n = 0; n < r.body.nodes; n++) {
    const double *x = r.blocks.mesh.xyz + 3 * n;
    r.solver.u[3 * n] = strain[0] * x[0] + strain[3] * x[1] + strain[5] * x[2];
    r.solver.u[3 * n + 1] = strain[3] * x[0] + strain[1] * x[1] + strain[4] * x[2];
    r.solver.u[3 * n + 2] = strain[5] * x[0] + strain[4] * x[1] + strain[2] * x[2];
  }
  looker l = {.look = look_at_body, .solver = &r.solver};
  cdem_frame_sink sink = {&l, take_frame};
  check_ok(cdem_solver_frames(&r.solver, 7, &sink, &fault));
  assert_int_equal(l.frames, 1);
  l.answer = CDEM_FILE;
  check_fails(cdem_solver_frames(&r.solver, 7, &sink, &fault), CDEM_FILE, "the sink is full");
  rig_release(&r);
}

/* Turned by 2.5 rad about an axis: every cell says so. */
static void look_at_turn(const cdem_frame *frame, const cdem_solver *solver) {
  (void)solver;
  const double *turn = field(frame, "rotation", true, 3)->data;
  const double *stress = field(frame, "stress", true, 6)->data;
  for (int64_t c = 0; c < frame->cells; c++) {
    check_near(turn[3 * c], 2.5 * 0.6, 1e-12, 0.0);
    check_near(turn[3 * c + 1], 0.0, 0.0, 1e-12);
    check_near(turn[3 * c + 2], 2.5 * 0.8, 1e-12, 0.0);
    for (int k = 0; k < 6; k++)
      check_near(stress[6 * c + k], 0.0, 0.0, 1e-5);
  }
}

static void rotation_is_a_vector(void **state) {
  (void)state;
  cdem_fault fault = {0};
  rig r;
  rig_options o = rig_cube(2);
  rig_make(&o, &r);
  rig_start(&r);
  const double a[3] = {0.6, 0.0, 0.8}, c = cos(2.5), s = sin(2.5);
  for (int32_t n = 0; n < r.body.nodes; n++) { /* Rodrigues */
    const double *x = r.blocks.mesh.xyz + 3 * n;
    double along = a[0] * x[0] + a[2] * x[2];
    const double cross[3] = {-a[2] * x[1], a[2] * x[0] - a[0] * x[2], a[0] * x[1]};
    for (int k = 0; k < 3; k++)
      r.solver.u[3 * n + k] = (c - 1.0) * x[k] + s * cross[k] + (1.0 - c) * along * a[k];
  }
  looker l = {.look = look_at_turn, .solver = &r.solver};
  cdem_frame_sink sink = {&l, take_frame};
  check_ok(cdem_solver_frames(&r.solver, 0, &sink, &fault));
  rig_release(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(body_frame_holds_the_state),
      cmocka_unit_test(rotation_is_a_vector),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
