/* The model: what a user can have wrong, each with its message. */
#include "network/network.h"
#include "network/support.h"

static cdem_model_options defaults(const cdem_mesh *mesh, const cdem_material *material,
                                   int materials) {
  return (cdem_model_options){.mesh = mesh,
                              .materials = materials,
                              .material = material,
                              .default_material = -1,
                              .section = {CDEM_PLANE_STRAIN, 1.0}};
}

/* Two unit squares in groups "left" and "right", both in "both", and the edge group "bottom". */
static void two_squares(cdem_mesh *mesh) {
  cdem_fault fault = {0};
  const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const int32_t quad[2][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}}, line[1][2] = {{0, 1}}, id[] = {0, 1, 2};
  const int64_t tag[] = {71, 72}, line_tag[] = {80};
  check_ok(cdem_mesh_add_nodes(mesh, 6, &xyz[0][0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_QUAD4, 2, &quad[0][0], tag, &fault));
  check_ok(cdem_mesh_add_cells(mesh, CDEM_SHAPE_LINE2, 1, &line[0][0], line_tag, &fault));
  check_ok(cdem_mesh_add_group(mesh, "left", 2, 1, id, &fault));
  check_ok(cdem_mesh_add_group(mesh, "right", 2, 1, id + 1, &fault));
  check_ok(cdem_mesh_add_group(mesh, "both", 2, 2, id, &fault));
  check_ok(cdem_mesh_add_group(mesh, "bottom", 1, 1, id + 2, &fault));
}

static void groups_choose_cells(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  two_squares(&mesh);
  cdem_material rock = cdem_material_isotropic(1e9, 0.2);
  cdem_model_options options = defaults(&mesh, &rock, 1);
  const char *right[] = {"right"}, *missing[] = {"rihgt"}, *mixed[] = {"left", "bottom"},
             *bottom[] = {"bottom"};
  check_ok(cdem_model_init(&options, &model, &fault));
  assert_int_equal(model.cells, 2);
  assert_int_equal(model.pairs, 12);
  cdem_model_release(&model);
  options.groups = 1;
  options.group = right;
  check_ok(cdem_model_init(&options, &model, &fault));
  assert_int_equal(model.cells, 1);
  assert_int_equal(mesh.cell_tag[model.cell[0]], 72);
  cdem_model_release(&model);
  options.group = missing;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "no group 'rihgt'; it has: left, right");
  options.group = bottom;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "no plane or solid cells");
  const char *nothing[] = {"nothing"};
  check_ok(cdem_mesh_add_group(&mesh, "nothing", 2, 0, NULL, &fault));
  options.group = nothing;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "group 'nothing' holds no elements");
  options.groups = 2;
  options.group = mixed;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "'left' (dimension 2) and 'bottom' (dimension 1)");
  cdem_mesh empty = {0};
  options = defaults(&empty, &rock, 1);
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "the mesh has no cells");
  cdem_mesh_release(&mesh);
}

static void materials_by_group(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  two_squares(&mesh);
  cdem_material two[2] = {cdem_material_isotropic(1e9, 0.2), cdem_material_isotropic(2e9, 0.3)};
  snprintf(two[0].name, sizeof two[0].name, "soft");
  snprintf(two[1].name, sizeof two[1].name, "hard");
  cdem_model_options options = defaults(&mesh, two, 2);
  const char *both[] = {"left", "right"}, *conflict[] = {"left", "both"}, *one[] = {"left"},
             *line[] = {"bottom"}, *gone[] = {"middle"};
  const int material[] = {0, 1};
  options.assignments = 2;
  options.assigned_group = both;
  options.assigned_material = material;
  check_ok(cdem_model_init(&options, &model, &fault));
  assert_int_equal(model.material[0], 0);
  assert_int_equal(model.material[1], 1);
  cdem_model_release(&model);
  options.assigned_group = conflict;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "element 71 is in group 'left' (material soft) and in group 'both' (material hard)");
  options.assignments = 1;
  options.assigned_group = one;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "no material for element 72 of group 'right'");
  options.default_material = 1;
  check_ok(cdem_model_init(&options, &model, &fault));
  cdem_model_release(&model);
  options.assigned_group = line;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "group 'bottom' a material, but it is of dimension 1");
  options.assigned_group = gone;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "group 'middle', which the mesh does not have");
  /* Without assignments the default is the material of all; what no cell uses is not looked at. */
  options.assignments = 0;
  check_ok(cdem_model_init(&options, &model, &fault));
  assert_int_equal(model.material[0], 1);
  cdem_model_release(&model);
  two[1].parameter[1] = 0.5;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "material 'hard'");
  options.default_material = 0;
  check_ok(cdem_model_init(&options, &model, &fault));
  cdem_model_release(&model);
  two[1] = make_material(cdem_element_find("quad4-cosserat"));
  options.assignments = 2;
  options.assigned_group = both;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "one network holds one kind");
  cdem_mesh_release(&mesh);
}

static void geometry_is_checked(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  two_squares(&mesh);
  cdem_material rock = cdem_material_isotropic(1e9, 0.2);
  cdem_model_options options = defaults(&mesh, &rock, 1);
  options.section.thickness = 0.0;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "thickness = 0 m");
  options.section.thickness = NAN;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "thickness");
  options.section.thickness = 1.0;
  mesh.xyz[3 * 5 + 2] = 0.01;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT,
              "leaves its plane: z runs from 0 to 0.01");
  for (int i = 0; i < 6; i++)
    mesh.xyz[3 * i + 2] = -3.5; /* any constant will do */
  check_ok(cdem_model_init(&options, &model, &fault));
  cdem_model_release(&model);
  int32_t *node = mesh.cell_node + mesh.cell_start[1], keep = node[1];
  node[1] = node[3];
  node[3] = keep;
  check_fails(cdem_model_init(&options, &model, &fault), CDEM_INPUT, "element 72 (quad4)");
  cdem_mesh_release(&mesh);
}

static void a_mesh_far_away_keeps_its_digits(void **state) {
  (void)state;
  cdem_mesh near = {0}, far = {0};
  cdem_model near_model = {0}, far_model = {0};
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 1, 0.0, &near);
  make_grid(element, 1, 0.0, &far);
  for (int64_t i = 0; i < 3 * (int64_t)far.nodes; i++) {
    near.xyz[i] = ldexp(rint(ldexp(near.xyz[i], 20)), -20); /* so that adding 2^20 is exact */
    far.xyz[i] = near.xyz[i] + 0x1p20;
  }
  cdem_material material = make_material(element);
  make_model(&near, &material, &near_model);
  make_model(&far, &material, &far_model);
  double a[CDEM_SHAPE_MAX_NODES][3], b[CDEM_SHAPE_MAX_NODES][3];
  cdem_model_coordinates(&near_model, 0, a);
  cdem_model_coordinates(&far_model, 0, b);
  assert_memory_equal(a, b, 8 * sizeof a[0]);
  cdem_model_release(&near_model);
  cdem_model_release(&far_model);
  cdem_mesh_release(&near);
  cdem_mesh_release(&far);
}

static void every_allocation_may_fail(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  two_squares(&mesh);
  cdem_material rock = cdem_material_isotropic(1e9, 0.2);
  cdem_model_options options = defaults(&mesh, &rock, 1);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_fault fault = {0};
    cdem_memory_fail_after(n);
    status = cdem_model_init(&options, &model, &fault);
    cdem_memory_fail_after(-1);
    if (status != CDEM_OK) {
      assert_int_equal(status, CDEM_MEMORY);
      assert_null(model.cell);
    }
    assert_true(n < 100);
  }
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(groups_choose_cells),
      cmocka_unit_test(materials_by_group),
      cmocka_unit_test(geometry_is_checked),
      cmocka_unit_test(a_mesh_far_away_keeps_its_digits),
      cmocka_unit_test(every_allocation_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
