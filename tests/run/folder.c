/* What a run does to its folder, what it keeps when it diverges, errors with their line. */
#include "run/support.h"

static const char bar[] = "end: 0.2 ms\n"
                          "mesh: {shape: quad4, count: [4, 2], size: [1 m, 0.5 m]}\n"
                          "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"
                          "supports: [{group: x0, displacement: {x: 0, y: 0}}]\n"
                          "loads: [{group: x1, traction: {x: 1 MPa}}]\n"
                          "probes: {tip: {group: x1, quantity: displacement, component: x}}\n";

static const char two_triangles[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                                    "$PhysicalNames\n2\n1 1 \"x0\"\n2 2 \"body\"\n"
                                    "$EndPhysicalNames\n"
                                    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
                                    "$Elements\n3\n1 1 2 1 1 4 1\n2 2 2 2 1 1 2 3\n"
                                    "3 2 2 2 1 1 3 4\n$EndElements\n";

static void write_file(const char *name, const char *text) {
  write_case(name, text);
}

static void run_quietly(const char *name, const char *folder, int overrides,
                        const char *const *override) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  check_ok(run_case(name, folder, overrides, override, &summary, &fault));
  cdem_run_summary_release(&summary);
}

/* ---- other people's files ---- */

static void files_of_others_are_not_replaced(void **state) {
  (void)state;
  static const char *const own[] = {"case.yaml", "summary.json", "checkpoint.h5", "history.csv"};
  write_case("bar.yaml", bar);
  for (int i = 0; i < 4; i++) {
    cdem_fault fault = {0};
    cdem_run_summary summary;
    char folder[32], name[64], lock[64];
    snprintf(folder, sizeof folder, "others%d", i);
    snprintf(name, sizeof name, "%s/%s", folder, own[i]);
    snprintf(lock, sizeof lock, "%s/.lock", folder);
    mkdir(in_scratch(folder), 0777);
    write_file(name, "mine\n");
    check_fails(run_case("bar.yaml", folder, 0, NULL, &summary, &fault), CDEM_INPUT,
                "that no run wrote");
    assert_true(holds(name, "mine"));
    assert_int_not_equal(access(in_scratch(lock), F_OK), 0);
  }
}

static void a_new_run_leaves_no_old_pictures(void **state) {
  (void)state;
  write_case("bar.yaml", bar);
  run_quietly("bar.yaml", "pictures", 0, NULL);
  assert_true(is_there("pictures/body.pvd"));
  mkdir(in_scratch("pictures/figures"), 0777);
  write_file("pictures/figures/old.gp",
             "# draws the .png and .svg beside it: gnuplot THIS_FILE, in this folder\n");
  write_file("pictures/figures/old.png", "old");
  write_file("pictures/figures/mine.gp", "# my own\n");
  write_file("pictures/figures/mine.png", "mine");
  cdem_fault fault = {0};
  cdem_run_summary summary;
  const cdem_run_options options = {.path = in_scratch("bar.yaml"),
                                    .folder = in_scratch("pictures"),
                                    .threads = 1,
                                    .version = "test",
                                    .commit = "test"};
  check_ok(cdem_run(&options, &summary, &fault));
  cdem_run_summary_release(&summary);
  assert_false(is_there("pictures/body.pvd"));
  assert_false(is_there("pictures/figures/old.gp"));
  assert_false(is_there("pictures/figures/old.png"));
  assert_true(is_there("pictures/figures/mine.gp"));
  assert_true(is_there("pictures/figures/mine.png"));
}

static void continuing_leaves_other_folders_alone(void **state) {
  (void)state;
  mkdir(in_scratch("plain"), 0777);
  for (int i = 0; i < 2; i++) {
    cdem_fault fault = {0};
    cdem_run_summary summary;
    const cdem_run_options options = {.folder = in_scratch(i == 0 ? "plain" : "absent"),
                                      .resume = true,
                                      .version = "test",
                                      .commit = "test"};
    check_fails(cdem_run(&options, &summary, &fault), CDEM_INPUT,
                i == 0 ? "no run to continue" : "there is no folder");
  }
  assert_int_not_equal(access(in_scratch("plain/.lock"), F_OK), 0);
  assert_int_not_equal(access(in_scratch("absent"), F_OK), 0);
}

/* ---- the case in the folder ---- */

/* `mesh` is how the case names sub/two mesh.msh, seen from sub. */
static void check_kept(const char *mesh, int overrides, const char *const *override,
                       bool comments) {
  char text[700];
  snprintf(text, sizeof text,
           "# a comment\nend: 0.2 ms\nmesh: %s # the mesh\n"
           "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n"
           "supports: [{group: x0, displacement: {x: 0, y: 0}}]\ngravity: [0, -9.81 m/s2]\n",
           mesh);
  write_case("sub/case.yaml", text);
  run_quietly("sub/case.yaml", "kept", overrides, override);
  assert_true(holds("kept/case.yaml", scratch));
  assert_true(holds("kept/case.yaml", "# the mesh") == comments);
  run_quietly("kept/case.yaml", "copy", 0, NULL);
  assert_true(same_files("kept/history.csv", "copy/history.csv"));
  assert_true(same_files("kept/case.yaml", "copy/case.yaml"));
}

static void the_kept_case_runs_from_anywhere(void **state) {
  (void)state;
  const char *end = "end=0.1 ms", *other = "mesh=two mesh.msh";
  mkdir(in_scratch("sub"), 0777);
  write_file("sub/two mesh.msh", two_triangles);
  check_kept("two mesh.msh", 0, NULL, true);
  check_kept("\"two mesh.msh\"", 0, NULL, true);
  check_kept("'two mesh.msh'", 0, NULL, true);
  check_kept("{unit: 1 m, file: two mesh.msh}", 0, NULL, true);
  check_kept("\"two\\x20mesh.msh\"", 0, NULL, false); /* not letter by letter */
  check_kept("two mesh.msh", 1, &end, false);
  check_kept("nothing.msh", 1, &other, false);
}

/* ---- a run that diverges ---- */

static void check_kept_files(const char *folder) {
  char name[128];
  static const char *const there[] = {"history.csv", "body.pvd", "body/body-000001.vtu",
                                      "checkpoint.h5", "case.yaml"};
  for (size_t i = 0; i < sizeof there / sizeof there[0]; i++) {
    snprintf(name, sizeof name, "%s/%s", folder, there[i]);
    if (!is_there(name))
      fail_msg("%s is missing", name);
  }
  snprintf(name, sizeof name, "%s/summary.json", folder);
  assert_false(is_there(name));
}

/* A load a million times too large, either way: time, place and cause; rows and frames of the
 * failure, and a checkpoint that can be read. */
static void a_diverging_run_keeps_what_it_had(void **state) {
  (void)state;
  const char *const load[] = {"loads[0].traction.x=1e6 MPa", "loads[0].traction.x=-1e6 MPa"};
  write_case("bar.yaml", bar);
  for (int i = 0; i < 2; i++) {
    cdem_fault fault = {0};
    cdem_run_summary summary;
    cdem_state kept = {0};
    cdem_table rows = {0};
    cdem_status status = run_case("bar.yaml", "wild", 1, &load[i], &summary, &fault);
    assert_int_equal(status, CDEM_NUMERIC);
    static const char *const said[] = {"element ", "near (",
                                       "at t =", "a load or a prescribed motion"};
    for (size_t k = 0; k < sizeof said / sizeof said[0]; k++)
      if (strstr(fault.message, said[k]) == NULL)
        fail_msg("'%s' is missing in: %s", said[k], fault.message);
    check_kept_files("wild");
    check_ok(cdem_read_history(in_scratch("wild/history.csv"), &rows, &fault));
    assert_true(rows.rows >= 2);
    assert_true(cdem_table_at(&rows, rows.rows - 1, 0)->real > 0.0);
    cdem_table_release(&rows);
    check_ok(cdem_read_state(in_scratch("wild/checkpoint.h5"), &kept, &fault));
    cdem_state_release(&kept);
  }
}

/* ---- errors with their place, found before anything is written ---- */

static void values_out_of_all_range_are_named(void **state) {
  (void)state;
  write_case("bar.yaml", bar);
  check_bad("bar.yaml", "end=1e300", "look at the unit of 'end'");
  check_bad("bar.yaml", "materials.rock.young=1e300", "no stable time step");
  check_bad("bar.yaml", "materials.rock.density=1e-300", "no stable time step");
  check_bad("bar.yaml", "history_every=1e-20", "look at the units of both");
  check_bad("bar.yaml", "frame_every=1e-20", "look at the units of both");
  check_bad("bar.yaml", "checkpoint_every=1e-20", "look at the units of both");
}

static void names_that_clash_are_named(void **state) {
  (void)state;
  write_case("bar.yaml", bar);
  check_bad("bar.yaml", "probes.kinetic={group: x0, component: x}", "is a column of this history");
  check_bad("bar.yaml", "supports[1]={group: x0, displacement: {x: 0}}",
            "prescribes x of group 'x0' already");
  check_bad("bar.yaml", "supports[1]={group: x0, velocity: {y: 0}}",
            "prescribes y of group 'x0' already");
}

static void a_second_order_mesh_is_blamed(void **state) {
  (void)state;
  write_file("six.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                        "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .5 0 0\n5 .5 .5 0\n6 0 .5 0\n"
                        "$EndNodes\n$Elements\n1\n1 9 2 1 1 1 2 3 4 5 6\n$EndElements\n");
  write_case("six.yaml", "end: 1 ms\nmesh: six.msh\n"
                         "materials: {rock: {young: 1 GPa, poisson: 0, density: 1 kg/m3}}\n");
  check_bad("six.yaml", "end=2 ms", "six.yaml:2:7: element 1 is a tri6");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_of_others_are_not_replaced),
      cmocka_unit_test(a_new_run_leaves_no_old_pictures),
      cmocka_unit_test(continuing_leaves_other_folders_alone),
      cmocka_unit_test(the_kept_case_runs_from_anywhere),
      cmocka_unit_test(a_diverging_run_keeps_what_it_had),
      cmocka_unit_test(values_out_of_all_range_are_named),
      cmocka_unit_test(names_that_clash_are_named),
      cmocka_unit_test(a_second_order_mesh_is_blamed),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
