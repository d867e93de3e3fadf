/* Frames: the arrays a solver hands out, with their names, orders and values. */
#include "cdem/frames.h"

#include "joints_support.h"

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

/* ---- faces between blocks, and contacts ---- */

static const double parted = 3e-6, slid = 2e-6, pressed = 1e-5; /* m */

/* Two blocks side by side along x, undistorted. */
static rig_options pair_of(int dimension) {
  rig_options o = dimension == 3 ? rig_cube(1) : rig_square(2, 1);
  o.count[0] = 2;
  o.distortion = 0.0;
  return o;
}

/* Moves the block on the right as a whole. */
static void move_right(jointed *j, const double by[3]) {
  const cdem_mesh *mesh = &j->r.blocks.mesh;
  int dofs = j->r.solver.dofs;
  int32_t right = mesh->xyz[3 * cdem_mesh_cell(mesh, 0)[0]] > 0.4 ? 0 : 1;
  for (int64_t i = mesh->cell_start[right]; i < mesh->cell_start[right + 1]; i++)
    for (int k = 0; k < dofs; k++)
      j->r.solver.u[(int64_t)mesh->cell_node[i] * dofs + k] = by[k];
}

static void look_at_faces(const cdem_frame *frame, const cdem_solver *solver) {
  int dimension = solver->options->body->model->dimension;
  if (strcmp(frame->set, "body") == 0)
    return;
  assert_string_equal(frame->set, "interfaces");
  assert_int_equal(frame->cells, 1);
  assert_int_equal(frame->type[0], dimension == 3 ? 9 : 3);
  assert_int_equal(frame->points, dimension == 3 ? 4 : 2);
  assert_int_equal(frame->offset[1], frame->points);
  for (int64_t p = 0; p < frame->points; p++) { /* the face lies between the two sides */
    assert_int_equal(frame->node[p], p);
    check_near(frame->xyz[3 * p], 0.5 + 0.5 * parted, 1e-12, 0.0);
  }
  assert_int_equal(*(const uint8_t *)field(frame, "state", true, 1)->data, CDEM_INTERFACE_INTACT);
  assert_string_equal(field(frame, "state", true, 1)->state[2], "tension-failed");
  assert_int_equal(*(const uint8_t *)field(frame, "open", true, 1)->data, 0);
  assert_int_equal(*(const uint8_t *)field(frame, "released", true, 1)->data, 0);
  check_near(*(const double *)field(frame, "opening", true, 1)->data, parted, 1e-9, 0.0);
  check_near(*(const double *)field(frame, "slip", true, 1)->data, slid, 1e-9, 0.0);
  check_near(*(const double *)field(frame, "normal_traction", true, 1)->data, -1e11 * parted, 1e-9,
             0.0); /* pressure is positive */
  check_near(*(const double *)field(frame, "shear_traction", true, 1)->data, 1e11 * slid, 1e-9,
             0.0);
  check_near(*(const double *)field(frame, "damage", true, 1)->data, 0.0, 0.0, 0.0);
  assert_int_equal(*(const int32_t *)field(frame, "law", true, 1)->data, 0);
}

static void faces_show_opening_and_traction(void **state) {
  (void)state;
  for (int dimension = 2; dimension <= 3; dimension++) {
    cdem_fault fault = {0};
    jointed j;
    rig_options o = pair_of(dimension);
    make_jointed(&o, glue(CDEM_INSERTION_PENALTY, 1e7), false, &j);
    rig_start(&j.r);
    move_right(&j, (double[3]){parted, slid, 0.0});
    cdem_interfaces_forces(&j.interfaces, j.r.solver.u, j.r.solver.force);
    looker l = {.look = look_at_faces, .solver = &j.r.solver};
    cdem_frame_sink sink = {&l, take_frame};
    check_ok(cdem_solver_frames(&j.r.solver, 3, &sink, &fault));
    assert_int_equal(l.frames, 2);
    release_jointed(&j);
  }
}

static void look_at_contacts(const cdem_frame *frame, const cdem_solver *solver) {
  int dimension = solver->options->body->model->dimension;
  if (strcmp(frame->set, "contacts") != 0)
    return;
  const double *force = field(frame, "force", false, 3)->data,
               *normal = field(frame, "normal", false, 3)->data;
  const cdem_field *sliding = field(frame, "sliding", false, 1);
  double sum = 0.0, area = dimension == 3 ? 0.8 * 0.9 : 0.8 * solver->options->thickness;
  assert_true(frame->points > 0);
  assert_int_equal(frame->cells, frame->points);
  for (int64_t p = 0; p < frame->points; p++) {
    assert_int_equal(frame->type[p], 1);
    assert_int_equal(frame->node[p], p);
    assert_int_equal(((const uint8_t *)sliding->data)[p], 0);
    check_near(frame->xyz[3 * p], 0.5, 0.0, 1.01 * pressed);
    check_near(fabs(normal[3 * p]), 1.0, 1e-9, 0.0);
    check_near(force[3 * p + 1], 0.0, 0.0, 1e-3);
    sum += fabs(force[3 * p]);
  }
  check_near(sum, 1e11 * pressed * area, 1e-6, 0.0);
}

/* A face without a law is contact from the start; pressed together it carries kn times overlap. */
static void contacts_carry_what_overlaps(void **state) {
  (void)state;
  for (int dimension = 2; dimension <= 3; dimension++) {
    cdem_fault fault = {0};
    jointed j;
    rig_options o = pair_of(dimension);
    make_jointed(&o, glue(CDEM_INSERTION_PENALTY, 1e7), true, &j);
    cdem_interfaces_release(&j.interfaces);
    j.law_of[0] = -1;
    cdem_interfaces_options joints = {.blocks = &j.r.blocks,
                                      .dofs = j.r.body.dofs,
                                      .thickness = o.thickness,
                                      .laws = 1,
                                      .law = &j.law,
                                      .law_of = j.law_of,
                                      .release = 0.05};
    check_ok(cdem_interfaces_init(&joints, &j.interfaces, &fault));
    rig_start(&j.r);
    /* Contact stores what pressing it has cost, and so is shown the velocity that led there. */
    move_right(&j, (double[3]){-pressed, 0.0, 0.0});
    for (int64_t i = 0; i < (int64_t)j.r.solver.nodes * j.r.solver.dofs; i++)
      j.r.solver.v[i] = j.r.solver.u[i] / j.r.solver.step;
    check_ok(cdem_contact_forces(&j.contact, j.r.solver.u, j.r.solver.v, j.r.solver.step,
                                 j.r.solver.force, &fault));
    looker l = {.look = look_at_contacts, .solver = &j.r.solver};
    cdem_frame_sink sink = {&l, take_frame};
    check_ok(cdem_solver_frames(&j.r.solver, 0, &sink, &fault));
    assert_int_equal(l.frames, 3);
    release_jointed(&j);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(body_frame_holds_the_state),
      cmocka_unit_test(rotation_is_a_vector),
      cmocka_unit_test(faces_show_opening_and_traction),
      cmocka_unit_test(contacts_carry_what_overlaps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
