/* Room io: grains for other programs. What every format must do, looped over the table, and what of
 * a model is not in a file; what the programs make of the files: tests/cli/test-*-grains.sh. */
#include "io/grains_scene.h"
#include "io/support.h"

#include <math.h>

static cdem_fault fault;
static const cdem_grain_material materials[2] = {{.name = "sand", .density = 2600.0},
                                                 {.name = "a \"b\" 'c'\n", .density = 1700.0}};

/* A row of grains a little inside each other, of two materials, the last one driven. */
static cdem_scene sample(int dim) {
  cdem_scene scene = {
      .grains = {.dim = dim}, .materials = 2, .material = materials, .thickness = 0.5};
  for (int i = 0; i < 40; i++)
    check_ok(cdem_grains_add(&scene.grains, (double[3]){0.0199 * i, 0.0, 0.0}, 0.01, &fault));
  check_ok(cdem_grains_complete(&scene.grains, &fault));
  for (int i = 0; i < 40; i++)
    scene.grains.material[i] = i % 2;
  scene.grains.motion[39] = CDEM_GRAIN_DRIVEN;
  return scene;
}

/* A solver of them. */
static cdem_contact_input contact[4];
static cdem_wall wall = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {1.0, 0.0, 0.0}};

static void make_solver(cdem_scene *scene, cdem_dem *dem, const char *law, int walls) {
  const cdem_dem_options options = {.grains = &scene->grains,
                                    .thickness = scene->thickness,
                                    .materials = 2,
                                    .material = materials,
                                    .law = cdem_law_find(law),
                                    .contact = contact,
                                    .walls = walls,
                                    .wall = &wall};
  check_ok(cdem_dem_init(&options, dem, &fault));
  scene->dem = dem;
}

static void ask(double shear_dashpot) {
  wall.center[0] = -0.02;
  for (int p = 0; p < 4; p++) {
    for (int k = 0; k < CDEM_LAW_KEYS; k++)
      contact[p].value[k] = NAN;
    contact[p].value[CDEM_LAW_normal_stiffness] = 1e5;
    contact[p].value[CDEM_LAW_friction] = 0.5;
    contact[p].value[CDEM_LAW_damping_ratio] = 0.2;
    if (!isnan(shear_dashpot))
      contact[p].value[CDEM_LAW_shear_dashpot] = shear_dashpot;
  }
}

static const char *path_of(const cdem_grain_format *format) {
  static char name[64];
  snprintf(name, sizeof name, "grains.%s", format->name);
  return in_scratch(name);
}

static void formats_are_found(void **state) {
  (void)state;
  int count = 0;
  for (const cdem_grain_format *f; (f = cdem_grain_format_at(count)) != NULL; count++)
    assert_ptr_equal(cdem_grain_format_of(path_of(f)), f);
  assert_int_equal(count, 4);
  assert_string_equal(cdem_grain_format_of("A.DATA")->name, "lammps");
  assert_null(cdem_grain_format_at(-1));
  assert_null(cdem_grain_format_of(".data"));
  char lost[256];
  cdem_scene scene = sample(2);
  check_fails(cdem_write_scene(in_scratch("g.txt"), &scene, lost, &fault), CDEM_INPUT,
              "names no file of grains");
  scene.grains.radius[3] = -1.0;
  check_fails(cdem_write_scene(in_scratch("g.data"), &scene, lost, &fault), CDEM_INPUT,
              "grain 3 has radius -1 m");
  cdem_grains_release(&scene.grains);
}

static void nothing_is_half_written(void **state) {
  (void)state;
  char lost[256];
  cdem_scene scene = sample(3);
  cdem_dem dem = {0};
  ask(NAN);
  make_solver(&scene, &dem, "linear", 1);
  int before = count_files(scratch);
  for (int f = 0; cdem_grain_format_at(f) != NULL; f++) {
    const cdem_grain_format *format = cdem_grain_format_at(f);
    char full[64];
    snprintf(full, sizeof full, "full.%s", format->name);
    assert_int_equal(symlink("/dev/full", in_scratch(full)), 0);
    check_fails(cdem_write_scene(in_scratch(full), &scene, lost, &fault), CDEM_FILE,
                "No space left on device");
    unlink(in_scratch(full));
    cdem_status status = CDEM_MEMORY;
    for (int n = 0; status != CDEM_OK; n++) {
      memset(&fault, 0, sizeof fault);
      cdem_memory_fail_after(n);
      status = cdem_write_scene(path_of(format), &scene, lost, &fault);
      cdem_memory_fail_after(-1);
      assert_true(status == CDEM_OK || status == CDEM_MEMORY);
      assert_int_equal(count_files(scratch), before + (status == CDEM_OK));
    }
    unlink(path_of(format));
  }
  cdem_dem_release(&dem);
  cdem_grains_release(&scene.grains);
}

static void lacks(const cdem_scene *scene, const char *name, const char *wanted) {
  char lost[256];
  check_ok(cdem_write_scene(in_scratch(name), scene, lost, &fault));
  assert_string_equal(lost, wanted);
}

static void what_is_lost_is_said(void **state) {
  (void)state;
  cdem_scene scene = sample(3);
  cdem_dem dem = {0};
  lacks(&scene, "a.csv", "");
  lacks(&scene, "a.data", "a law of contact (a table has none; export a case)");
  ask(NAN);
  make_solver(&scene, &dem, "linear", 1);
  lacks(&scene, "a.csv", "");
  lacks(&scene, "a.data", "a wall");
  lacks(&scene, "a.py", "a wall, the dashpots of contacts");
  check_ok(cdem_dem_steps(&dem, 2, &fault));
  lacks(&scene, "a.data", "a wall, what contacts remember of their sliding");
  cdem_dem_release(&dem);
  /* The shear dashpot a constant, the normal one not: no multiple of it for all masses. */
  ask(3.0);
  make_solver(&scene, &dem, "linear", 0);
  lacks(&scene, "a.data", "shear dashpots that are no multiple of the normal ones");
  cdem_dem_release(&dem);
  cdem_grains_release(&scene.grains);
}

/* Names go into comments and into Python: no line may end in one, no quote end the text. */
static void names_stay_names(void **state) {
  (void)state;
  char lost[256];
  cdem_scene scene = sample(2);
  check_ok(cdem_write_scene(in_scratch("n.py"), &scene, lost, &fault));
  char *text = read_whole(in_scratch("n.py"), NULL);
  assert_non_null(strstr(text, "('a \"b\" \\'c\\'?', 1700),"));
  free(text);
  check_ok(cdem_write_scene(in_scratch("n.data"), &scene, lost, &fault));
  text = read_whole(in_scratch("n.data"), NULL);
  assert_non_null(strstr(text, "# Atom types: 1 sand, 2 a \"b\" 'c'?; driven grains"));
  free(text);
  cdem_grains_release(&scene.grains);
}

static void cells_that_cannot_be(void **state) {
  (void)state;
  char lost[256];
  cdem_scene scene = sample(2);
  cdem_cell cell = {.periodic = {true, false, false}, .corner = {-0.01, -0.1, 0.0}};
  cdem_dem dem = {0};
  ask(NAN);
  cell.h[0] = 0.8;
  cell.h[4] = cell.h[8] = 1.0;
  const cdem_dem_options options = {.grains = &scene.grains,
                                    .materials = 2,
                                    .material = materials,
                                    .law = cdem_law_find("linear"),
                                    .contact = contact,
                                    .cell = &cell};
  check_ok(cdem_dem_init(&options, &dem, &fault));
  scene.dem = &dem;
  check_fails(cdem_write_scene(in_scratch("c.py"), &scene, lost, &fault), CDEM_INPUT,
              "a cell of YADE begins at the origin and is periodic in all directions");
  check_ok(cdem_write_scene(in_scratch("c.data"), &scene, lost, &fault));
  char *text = read_whole(in_scratch("c.data"), NULL);
  assert_non_null(strstr(text, "#> boundary      p m p\n"));
  assert_non_null(strstr(text, "\n-0.01 0.79000000000000004 xlo xhi\n"));
  free(text);
  cdem_dem_release(&dem);
  cdem_grains_release(&scene.grains);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formats_are_found),    cmocka_unit_test(nothing_is_half_written),
      cmocka_unit_test(what_is_lost_is_said), cmocka_unit_test(names_stay_names),
      cmocka_unit_test(cells_that_cannot_be),
  };
  return cmocka_run_group_tests_name("io scene", tests, scratch_make, scratch_remove);
}
