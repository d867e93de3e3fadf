/* Springs of blocks and of meshes through libcdem: the sum of the springs is the block, whichever
 * way the mesh came, and every misuse is a status with a text. */
#include "support.h"

static const int32_t one_brick[3] = {1, 1, 1};
static const double unit[3] = {1.0, 1.0, 1.0}, rock[2] = {40e9, 0.25};

static double distance(int count, const double *a, const double *b) {
  double sum = 0.0, norm = 0.0;
  for (int i = 0; i < count; i++) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    norm += b[i] * b[i];
  }
  return sqrt(sum / norm);
}

static void a_block_is_the_sum_of_its_springs(void **state) {
  (void)state;
  static const double block[][9] = {
      {2, 0.5, 0, 0.5, 3, 0, 0, 0, 1}, /* symmetric */
      {1, 2, 0, -2, 1, 0.3, 0, 0, 4},  /* a rotation in a plane: complex */
      {1, 1, 0, 0, 1, 1, 0, 0, 1},     /* jordan3 */
      {2, 1, 1, 1, 2, 1, 1, 1, 2},     /* transversely isotropic: a frame where allowed */
  };
  static const libcdem_form form[] = {LIBCDEM_DIAGONAL, LIBCDEM_COMPLEX, LIBCDEM_JORDAN3,
                                      LIBCDEM_FRAME};
  libcdem_fault fault = {0};
  libcdem_springs springs;
  double again[9];
  for (int i = 0; i < 4; i++) {
    check_ok(libcdem_springs_of_block(3, block[i], true, &springs, &fault));
    assert_int_equal(springs.form, form[i]);
    libcdem_springs_rebuild(&springs, again);
    assert_true(distance(9, again, block[i]) <= 1e-12);
  }
  check_ok(libcdem_springs_of_block(3, block[3], false, &springs, &fault));
  assert_int_equal(springs.form, LIBCDEM_DIAGONAL);
  assert_string_equal(libcdem_form_name(springs.form), "diagonal");
  assert_string_equal(libcdem_form_name((libcdem_form)99), "");
}

static void wrong_blocks_are_refused(void **state) {
  (void)state;
  libcdem_fault fault = {0};
  libcdem_springs springs;
  const double block[9] = {NAN, 0, 0, 0, 1, 0, 0, 0, 1};
  check_fails(libcdem_springs_of_block(4, block, true, &springs, &fault), LIBCDEM_USAGE, "size 4");
  check_fails(libcdem_springs_of_block(3, NULL, true, &springs, &fault), LIBCDEM_USAGE, "a block");
  check_fails(libcdem_springs_of_block(3, block, true, &springs, &fault), LIBCDEM_NUMERIC, "");
  assert_int_equal(libcdem_springs_of_block(3, block, true, &springs, NULL), LIBCDEM_NUMERIC);
}

/* ---- meshes ---- */

/* The spring tensors of a mesh of one element, by places in it. */
typedef struct {
  double block[8][8][9];
  int64_t pairs, most;
} tensors;

static bool take(void *context, const libcdem_pair *pair) {
  tensors *t = context;
  int size = pair->springs.size;
  double again[9];
  libcdem_springs_rebuild(&pair->springs, again);
  assert_true(distance(size * size, again, pair->block) <= 1e-12);
  memcpy(t->block[pair->place[0]][pair->place[1]], pair->block, sizeof pair->block);
  return ++t->pairs != t->most;
}

static void tensors_of(const libcdem_mesh *mesh, tensors *t) {
  libcdem_fault fault = {0};
  libcdem_model *model = NULL;
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_ok(libcdem_model_material(model, "isotropic", 2, rock, &fault));
  check_ok(libcdem_model_visit(model, take, t, NULL, &fault));
  libcdem_model_destroy(&model);
  assert_null(model);
}

static void a_mesh_built_by_hand_is_the_generated_one(void **state) {
  (void)state;
  static const double xyz[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  static const int32_t node[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  libcdem_fault fault = {0};
  libcdem_mesh *box = NULL, *own = NULL;
  tensors a = {0}, b = {0};
  check_ok(libcdem_mesh_box("hex8", one_brick, unit, &box, &fault));
  check_ok(libcdem_mesh_create(&own, &fault));
  check_ok(libcdem_mesh_add_nodes(own, 8, xyz[0], &fault));
  check_ok(libcdem_mesh_add_cells(own, "hex8", 1, node, &fault));
  assert_int_equal(libcdem_mesh_nodes(own), 8);
  assert_int_equal(libcdem_mesh_cells(own), 1);
  tensors_of(box, &a);
  tensors_of(own, &b);
  assert_int_equal(a.pairs, 28);
  assert_memory_equal(a.block, b.block, sizeof a.block);
  libcdem_mesh_destroy(&box);
  libcdem_mesh_destroy(&own);
  libcdem_mesh_destroy(&own); /* twice is allowed */
}

static void the_certificate_of_a_mesh_holds(void **state) {
  (void)state;
  static const int32_t bricks[3] = {3, 3, 3};
  const libcdem_certificate *c = NULL;
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  check_ok(libcdem_mesh_box("hex8", bricks, unit, &mesh, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_ok(libcdem_model_material(model, "isotropic", 2, rock, &fault));
  check_ok(libcdem_model_certify(model, NULL, &c, &fault));
  assert_true(c->holds);
  assert_int_equal(c->elements, 27);
  assert_int_equal(c->pairs, 27 * 28);
  assert_int_equal(c->rigid_modes, 6);
  assert_int_equal(c->zero_modes, 6);
  assert_true(c->rebuild <= 1e-12 && c->translation <= 1e-12 && c->rotation <= 1e-12 &&
              c->assembled <= 1e-12 && c->patch <= 1e-12);
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

/* A sheet of twice the thickness has twice the springs, in plane stress softer ones. */
static double stiffest(libcdem_model *model, bool stress, double thickness) {
  libcdem_fault fault = {0};
  tensors t = {0};
  check_ok(libcdem_model_plane(model, stress, thickness, &fault));
  check_ok(libcdem_model_visit(model, take, &t, NULL, &fault));
  return t.block[0][1][0];
}

static void planes_know_their_thickness(void **state) {
  (void)state;
  static const int32_t sheet[3] = {1, 1, 0};
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  check_ok(libcdem_mesh_box("quad4", sheet, unit, &mesh, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_ok(libcdem_model_material(model, "isotropic", 2, rock, &fault));
  double one = stiffest(model, false, 1.0), two = stiffest(model, false, 2.0);
  assert_true(fabs(two - 2.0 * one) <= 1e-14 * fabs(two));
  assert_true(fabs(stiffest(model, true, 1.0)) < fabs(one));
  check_fails(libcdem_model_plane(model, false, 0.0, &fault), LIBCDEM_USAGE, "thickness 0");
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

/* ---- files ---- */

static void files_in_and_out(void **state) {
  (void)state;
  const libcdem_certificate *c = NULL;
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  struct stat file;
  check_ok(libcdem_mesh_read(CDEM_DATA "/meshes/two-layers.geo", NULL, &mesh, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_fails(libcdem_model_write(model, in_scratch("a.csv"), NULL, &fault), LIBCDEM_USAGE,
              "no material yet");
  check_ok(libcdem_model_read_materials(model, CDEM_DATA "/materials/two-layers.yaml", &fault));
  check_ok(libcdem_model_certify(model, NULL, &c, &fault));
  assert_true(c->holds);
  check_fails(libcdem_model_write(model, in_scratch("a.xyz"), NULL, &fault), LIBCDEM_USAGE,
              "names no format");
  check_ok(libcdem_model_write(model, in_scratch("a.csv"), NULL, &fault));
  assert_int_equal(stat(in_scratch("a.csv"), &file), 0);
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

/* Cells 0 and 1 in groups of two materials; a group that the file names must be there. */
static void groups_have_materials(void **state) {
  (void)state;
  static const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0},
                                   {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  static const int32_t node[2][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}}, first = 0, second = 1, none = 7;
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  tensors t = {0};
  check_ok(libcdem_mesh_create(&mesh, &fault));
  check_ok(libcdem_mesh_add_nodes(mesh, 6, xyz[0], &fault));
  check_ok(libcdem_mesh_add_cells(mesh, "quad4", 2, node[0], &fault));
  check_fails(libcdem_mesh_add_group(mesh, "sand", 1, &none, &fault), LIBCDEM_USAGE,
              "names cell 7");
  check_ok(libcdem_mesh_add_group(mesh, "sand", 1, &first, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_ok(libcdem_model_read_materials(model, CDEM_DATA "/materials/two-layers.yaml", &fault));
  check_fails(libcdem_model_visit(model, take, &t, NULL, &fault), LIBCDEM_INPUT, "group 'clay'");
  check_ok(libcdem_mesh_add_group(mesh, "clay", 1, &second, &fault));
  check_ok(libcdem_model_visit(model, take, &t, NULL, &fault));
  assert_int_equal(t.pairs, 12);
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

/* ---- misuse ---- */

static bool stop(void *context, const char *what, int64_t done, int64_t total) {
  (void)what, (void)done, (void)total;
  return ++*(int *)context < 0;
}

static void work_stops_when_asked_to(void **state) {
  (void)state;
  int calls = 0;
  const libcdem_listener listener = {&calls, stop, NULL};
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  tensors t = {.most = 5};
  struct stat file;
  check_ok(libcdem_mesh_box("hex8", one_brick, unit, &mesh, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_ok(libcdem_model_material(model, "isotropic", 2, rock, &fault));
  check_fails(libcdem_model_visit(model, take, &t, NULL, &fault), LIBCDEM_INTERRUPTED, "visitor");
  assert_int_equal(t.pairs, 5);
  check_fails(libcdem_model_write(model, in_scratch("b.csv"), &listener, &fault),
              LIBCDEM_INTERRUPTED, "");
  assert_true(calls > 0);
  assert_int_not_equal(stat(in_scratch("b.csv"), &file), 0); /* nothing half written */
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

static void wrong_meshes_are_refused(void **state) {
  (void)state;
  static const int32_t no_node[3] = {0, 1, 2};
  static const double xyz[3] = {0, 0, 0};
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  check_fails(libcdem_mesh_read("/no/such.msh", NULL, &mesh, &fault), LIBCDEM_FILE, "/no/such.msh");
  check_fails(libcdem_mesh_box("hex9", one_brick, unit, &mesh, &fault), LIBCDEM_USAGE,
              "no shape 'hex9'");
  check_fails(libcdem_mesh_box("hex8", one_brick, unit, NULL, &fault), LIBCDEM_USAGE, "not NULL");
  assert_null(mesh);
  check_ok(libcdem_mesh_create(&mesh, &fault));
  check_ok(libcdem_mesh_add_nodes(mesh, 1, xyz, &fault));
  check_fails(libcdem_mesh_add_cells(mesh, "tri3", 1, no_node, &fault), LIBCDEM_USAGE, "node id 1");
  assert_int_equal(libcdem_mesh_cells(mesh), 0);
  libcdem_mesh_destroy(&mesh);
}

static void wrong_materials_are_refused(void **state) {
  (void)state;
  static const double impossible[2] = {40e9, 0.5};
  libcdem_fault fault = {0};
  libcdem_mesh *mesh = NULL;
  libcdem_model *model = NULL;
  tensors t = {0};
  check_ok(libcdem_mesh_box("hex8", one_brick, unit, &mesh, &fault));
  check_ok(libcdem_model_create(mesh, &model, &fault));
  check_fails(libcdem_model_material(model, "rubber", 2, rock, &fault), LIBCDEM_USAGE, "'rubber'");
  check_fails(libcdem_model_material(model, "isotropic", 1, rock, &fault), LIBCDEM_USAGE,
              "'poisson'");
  check_fails(libcdem_model_material(model, "isotropic", 3, rock, &fault), LIBCDEM_USAGE,
              "3 parameters");
  check_fails(libcdem_model_read_materials(model, "/no/such.yaml", &fault), LIBCDEM_FILE,
              "/no/such.yaml");
  check_fails(libcdem_model_visit(model, NULL, NULL, NULL, &fault), LIBCDEM_USAGE, "no material");
  check_ok(libcdem_model_material(model, "isotropic", 2, impossible, &fault));
  check_fails(libcdem_model_visit(model, take, &t, NULL, &fault), LIBCDEM_INPUT, "0.5");
  check_ok(libcdem_model_material(model, "isotropic", 2, rock, &fault));
  check_fails(libcdem_model_visit(model, NULL, NULL, NULL, &fault), LIBCDEM_USAGE, "a visitor");
  libcdem_model_destroy(&model);
  libcdem_mesh_destroy(&mesh);
}

static void names_and_versions(void **state) {
  (void)state;
  assert_string_equal(libcdem_class_name(LIBCDEM_BODY), "body");
  assert_string_equal(libcdem_class_name((libcdem_class)7), "");
  assert_string_equal(libcdem_status_text(LIBCDEM_INPUT), "bad input");
  assert_string_equal(libcdem_status_text((libcdem_status)77), "unknown status");
  int major, minor, patch;
  assert_int_equal(sscanf(libcdem_version(), "%d.%d.%d", &major, &minor, &patch), 3);
  assert_true(strlen(libcdem_commit()) >= 7);
  assert_non_null(strstr(libcdem_build(), "OpenMP"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_block_is_the_sum_of_its_springs),
      cmocka_unit_test(wrong_blocks_are_refused),
      cmocka_unit_test(a_mesh_built_by_hand_is_the_generated_one),
      cmocka_unit_test(the_certificate_of_a_mesh_holds),
      cmocka_unit_test(planes_know_their_thickness),
      cmocka_unit_test(files_in_and_out),
      cmocka_unit_test(groups_have_materials),
      cmocka_unit_test(work_stops_when_asked_to),
      cmocka_unit_test(wrong_meshes_are_refused),
      cmocka_unit_test(wrong_materials_are_refused),
      cmocka_unit_test(names_and_versions),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
