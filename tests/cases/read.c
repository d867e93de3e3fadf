/* Case files that are right: every kind of value, units, defaults, and the same case read again. */
#include "cases/support.h"

static void all_kinds_of_values(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_text(FULL, &read, &fault));
  const cdem_case_values *v = &read.values;
  assert_string_equal(read.path, in_scratch("c.yaml"));
  assert_string_equal(read.source, FULL);
  assert_string_equal(v->title, "Everything");
  assert_int_equal(v->analysis, CDEM_ANALYSIS_DYNAMIC);
  assert_int_equal(v->plane, CDEM_PLANE_STRESS);
  check_near(v->thickness, 0.05, 1e-15, 0);
  check_near(v->end, 0.01, 1e-15, 0);
  assert_true(v->mass_damping == 200.0 && v->local_damping == 0.1 && v->safety == 0.5);
  assert_true(v->gravity[0] == 0.0 && v->gravity[1] == -9.81 && v->gravity[2] == 0.0);
  assert_int_equal(v->quiet.count, 2);
  assert_string_equal(v->quiet.item[1], "right");
  check_near(v->stop_below, 0.3, 1e-15, 0);
  assert_string_equal(v->mesh.file, "plate.geo");
  assert_int_equal(v->mesh.parameters.count, 2);
  assert_string_equal(v->mesh.parameters.item[1].name, "holes");
  assert_true(v->mesh.parameters.item[0].value == 0.005);
  check_near(v->mesh.unit, 1e-3, 1e-15, 0);
  assert_int_equal(v->materials.count, 2);
  check_near(v->materials.item[0].density, 2700, 1e-14, 0);
  assert_string_equal(v->materials.item[1].name, "shale");
  assert_string_equal(v->materials.item[1].material.name, "shale");
  assert_int_equal(v->materials.item[1].material.model, CDEM_ORTHOTROPIC);
  check_near(v->materials.item[1].material.parameter[7], 8e9, 1e-15, 0);
  assert_true(v->materials.item[1].material.rotated);
  assert_int_equal(v->materials.item[1].groups.count, 2);
  assert_string_equal(v->blocks.breakable.item[0], "rock");
  assert_string_equal(v->blocks.joints.item[0], "fault");
  assert_false(v->cosserat);
  cdem_case_release(&read);
  cdem_case_release(&read);
}

static void interfaces_and_contact(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_text(FULL, &read, &fault));
  const cdem_case_values *v = &read.values;
  assert_int_equal(v->interfaces.count, 2);
  const cdem_case_interface *joint = &v->interfaces.item[0], *law = &v->interfaces.item[1];
  assert_string_equal(joint->joint, "fault");
  assert_int_equal(joint->between.count, 0);
  assert_true(joint->tension == 0.0 && joint->friction == 0.4 && joint->stiffness_factor == 10.0);
  assert_true(isnan(joint->energy_1) && isnan(joint->shear_ratio));
  assert_int_equal(law->between.count, 2);
  assert_int_equal(law->insertion, 1);
  assert_int_equal(law->softening, 1);
  assert_int_equal(law->unloading, 1);
  assert_true(law->tension == 1e6 && law->cohesion == 3e6 && law->dilation == 0.05);
  assert_true(law->energy_1 == 10.0 && law->energy_2 == 50.0 && isnan(law->normal_stiffness));
  assert_true(v->contact.active && v->contact.friction == 0.5 && v->contact.release == 0.05);
  check_near(v->contact.normal_stiffness, 1e12, 1e-15, 0);
  cdem_case_release(&read);
}

static void what_acts(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_text(FULL, &read, &fault));
  const cdem_case_values *v = &read.values;
  const cdem_case_support *support = v->supports.item;
  assert_true(support[0].displacement.given[0] && support[0].displacement.given[1]);
  assert_false(support[0].displacement.given[2] || support[0].velocity.given[0]);
  check_near(cdem_series_at(&support[0].displacement.component[1], 5e-3), -0.5e-3, 1e-14, 0);
  check_near(cdem_series_at(&support[0].displacement.component[1], 1.0), -1e-3, 1e-15, 0);
  check_near(cdem_series_at(&support[1].velocity.component[1], 0.25e-3), -5e-3, 1e-14, 0);
  const cdem_case_load *load = v->loads.item;
  assert_int_equal(v->loads.count, 4);
  check_near(cdem_series_at(&load[0].force.component[0], 0.0), 1000, 1e-15, 0); /* sin 90 deg */
  check_near(cdem_series_at(&load[0].force.component[0], 0.01), -1000, 1e-14, 0);
  check_near(cdem_series_at(&load[1].traction.component[1], 7.0), 2e6, 1e-15, 0);
  assert_true(load[2].has_pressure && !load[1].has_pressure);
  check_near(cdem_series_at(&load[2].pressure, 2.5e-3), 3e6 + 1e3, 1e-14, 0);
  check_near(cdem_series_at(&load[2].pressure, 1e-3), 1e3, 1e-15, 0);
  assert_true(load[3].kirsch_tension == 1e6 && isnan(load[2].kirsch_tension));
  check_near(load[3].kirsch_center[1], 2e-3, 1e-15, 0);
  const cdem_case_plate *plate = v->plates.item;
  assert_string_equal(plate->name, "press");
  assert_true(plate->normal[1] == -2.0 && plate->point[1] == 0.1 && plate->half_size[1] == 0.0);
  check_near(plate->half_size[0], 8e-3, 1e-15, 0);
  assert_true(v->initial.item[0].velocity[0] == 1e4 && v->initial.item[0].spin[2] == 5.0);
  assert_string_equal(v->probes.item[1].name, "mean_stress");
  assert_int_equal(v->probes.item[1].quantity, 3);
  assert_int_equal(v->probes.item[1].component, 4);
  assert_string_equal(v->curves.item[0].y.item[0], "top_force");
  assert_string_equal(v->curves.item[0].y_label, "load, kN");
  assert_true(v->curves.item[0].x_scale == 1.0 && v->curves.item[0].y_scale == -1e-3);
  assert_int_equal(v->results.item[0].take, 1);
  check_near(v->results.item[0].tolerance, 0.05, 1e-15, 0);
  cdem_case_release(&read);
}

static void defaults(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_text(ROCK, &read, &fault));
  const cdem_case_values *v = &read.values;
  assert_null(v->title);
  assert_int_equal(v->plane, CDEM_PLANE_STRAIN);
  assert_true(v->thickness == 1.0 && v->safety == 0.8 && v->tolerance == 1e-5);
  assert_true(v->most_steps == 1000000 && v->mass_damping == 0.0 && v->local_damping == 0.0);
  assert_true(isnan(v->step) && isnan(v->checkpoint_every) && isnan(v->stop_below));
  assert_true(v->history_every == v->end / 400 && v->frame_every == v->end / 20);
  assert_string_equal(v->mesh.file, "rock.geo");
  assert_true(v->mesh.shape == 0 && v->mesh.unit == 1.0 && v->mesh.seed == 1);
  assert_false(v->contact.active);
  assert_int_equal(v->loads.count + v->supports.count + v->plates.count + v->interfaces.count, 0);
  assert_true(isnan(v->materials.item[0].micro_inertia));
  cdem_case_release(&read);
  check_ok(read_text("contact: {}\n" ROCK, &read, &fault));
  assert_true(read.values.contact.active && read.values.contact.stiffness_factor == 10.0);
  cdem_case_release(&read);
  check_ok(read_text("contact: no\n" ROCK, &read, &fault));
  assert_false(read.values.contact.active);
  cdem_case_release(&read);
}

static void the_analysis_decides(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_text("analysis: relaxation\nmesh: a.msh\nmaterials: {r: {young: 1, poisson: 0, "
                     "density: 1}}\ntolerance: 1e-7\nmost_steps: 5e3\n",
                     &read, &fault));
  assert_true(read.values.local_damping == 0.8 && isnan(read.values.end));
  assert_true(read.values.tolerance == 1e-7 && read.values.most_steps == 5000);
  cdem_case_release(&read);
  check_ok(read_text("analysis: static\nmesh: {shape: hex8, count: [1, 2, 3], size: [1 cm, 2 cm, 3 "
                     "cm], distortion: 20 %, seed: 9}\nmaterials: {r: {young: 1, poisson: 0}}\n",
                     &read, &fault));
  assert_true(isnan(read.values.materials.item[0].density));
  assert_int_equal(read.values.mesh.shape, 6);
  assert_true(read.values.mesh.count[2] == 3.0 && read.values.mesh.seed == 9);
  check_near(read.values.mesh.size[2], 0.03, 1e-15, 0);
  cdem_case_release(&read);
  check_ok(read_text("end: 1\nmesh: a.msh\nmaterials: {r: {model: cosserat, young: 1, poisson: 0, "
                     "cosserat_modulus: 1, characteristic_length: 1 mm, density: 1, micro_inertia: "
                     "4 mm2}}\nsupports: [{group: a, displacement: {rotation: 3 degree}}]\n"
                     "loads: [{group: b, force: {rotation: 2 N.m}}]\n",
                     &read, &fault));
  assert_true(read.values.cosserat);
  check_near(read.values.materials.item[0].micro_inertia, 4e-6, 1e-15, 0);
  check_near(cdem_series_at(&read.values.supports.item[0].displacement.component[3], 0),
             3 * acos(-1.0) / 180, 1e-14, 0);
  assert_true(cdem_series_at(&read.values.loads.item[0].force.component[3], 0) == 2.0);
  cdem_case_release(&read);
}

/* ---- overrides ---- */

static void overrides_replace_and_add(void **state) {
  (void)state;
  static const char *const override[] = {
      "interfaces[1].tension=2 MPa",
      "materials.rock.young=40 GPa",
      "title=New: with colon",
      "mesh.parameters.h=0.01",
      "loads[4]={group: g, pressure: {ramp: 1 kPa, over: 1 s}}",
      "quiet=[a, b, c]",
      "supports[0].displacement.y.over=20 ms",
      "probes.other.group=x",
      "probes.other.component=z",
      "results={}",
      "interfaces[1].between[0]=slab",
      "title=Newest",
  };
  cdem_fault fault = {0};
  cdem_case read = {0}, again = {0};
  write_bytes(FULL, strlen(FULL));
  check_fails(cdem_read_case(in_scratch("c.yaml"), 3, override, &read, &fault), CDEM_INPUT,
              "override 'title=New: with colon': 'title' must be a text, not a map");
  check_ok(cdem_read_case(in_scratch("c.yaml"), 2, override, &read, &fault));
  cdem_case_release(&read);
  const char *good[11];
  for (int i = 0, n = 0; i < 12; i++)
    if (i != 2)
      good[n++] = override[i];
  check_ok(cdem_read_case(in_scratch("c.yaml"), 11, good, &read, &fault));
  char *source = strdup(read.source);
  check_ok(read_text(source, &again, &fault)); /* what is written stands alone */
  free(source);
  for (int i = 0; i < 2; i++) {
    const cdem_case_values *v = i == 0 ? &read.values : &again.values;
    assert_true(v->interfaces.item[1].tension == 2e6);
    assert_string_equal(v->interfaces.item[1].between.item[0], "slab");
    check_near(v->materials.item[0].material.parameter[0], 40e9, 1e-15, 0);
    assert_string_equal(v->title, "Newest");
    assert_true(v->mesh.parameters.item[0].value == 0.01 && v->mesh.parameters.count == 2);
    assert_int_equal(v->loads.count, 5);
    check_near(cdem_series_at(&v->loads.item[4].pressure, 0.5), 500, 1e-14, 0);
    assert_int_equal(v->quiet.count, 3);
    check_near(cdem_series_at(&v->supports.item[0].displacement.component[1], 5e-3), -0.25e-3,
               1e-14, 0);
    assert_int_equal(v->probes.count, 3);
    assert_string_equal(v->probes.item[2].group, "x");
    assert_int_equal(v->results.count, 0);
    assert_string_equal(v->curves.item[0].y_label, "load, kN");
  }
  cdem_case_release(&read);
  cdem_case_release(&again);
}

/* A file may stand for a section (`mesh: rock.geo`), a section may not be there at all. */
static void overrides_make_sections(void **state) {
  (void)state;
  static const char *const override[] = {"mesh.parameters.h=2", "contact.friction=0.1",
                                         "supports=[{group: b, displacement: {x: 0}}]",
                                         "materials.rock.groups=[a]", "gravity=[0, -1]"};
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(read_with(ROCK, 5, override, &read, &fault));
  assert_string_equal(read.values.mesh.file, "rock.geo");
  assert_string_equal(read.values.mesh.parameters.item[0].name, "h");
  assert_true(read.values.contact.active && read.values.contact.friction == 0.1);
  assert_int_equal(read.values.supports.count, 1);
  assert_true(read.values.gravity[1] == -1.0);
  cdem_case_release(&read);
}

/* ---- places ---- */

static void failures_show_the_place(void **state) {
  (void)state;
  static const char *const override[] = {"end=3 s"};
  cdem_fault fault = {0};
  cdem_case read = {0};
  char expected[512];
  check_ok(read_text(ROCK "supports:\n  - {group: bottom, displacement: {x: 0}}\n", &read, &fault));
  assert_int_equal(
      cdem_case_fail(&read, "supports[0].group", CDEM_INPUT, &fault, "no group '%s'", "bottom"),
      CDEM_INPUT);
  snprintf(expected, sizeof expected,
           "%s:6:13: no group 'bottom'\n    - {group: bottom, displacement: {x: 0}}\n"
           "              ^~~~~~",
           in_scratch("c.yaml"));
  assert_string_equal(fault.message, expected);
  static const struct {
    const char *key, *place;
  } places[] = {{"materials.rock.young", "c.yaml:4:17: "},
                {"materials.rock", "c.yaml:4:3: "},
                {"materials.rock.groups", "c.yaml:4:3: "}, /* not given: its section */
                {"materials.sand.groups", "c.yaml:3:1: "},
                {"supports[0].displacement.x", "c.yaml:6:39: "},
                {"supports[0].displacement.y", "c.yaml:6:21: "},
                {"supports[0]", "c.yaml:6:5: "},
                {"supports[7].group", "c.yaml:5:1: "},
                {"mesh.file", "c.yaml:2:7: "},
                {"end", "c.yaml:1:6: "},
                {"contact.friction", "c.yaml: "},
                {"", "c.yaml: "}};
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    memset(&fault, 0, sizeof fault);
    cdem_fail(&fault, CDEM_NUMERIC, "made elsewhere");
    assert_int_equal(cdem_case_blame(&read, places[i].key, &fault), CDEM_NUMERIC);
    snprintf(expected, sizeof expected, "%s/%smade elsewhere", scratch, places[i].place);
    if (strncmp(fault.message, expected, strlen(expected)) != 0)
      fail_msg("%s: %s", places[i].key, fault.message);
  }
  assert_true(cdem_case_given(&read, "supports[0].group"));
  assert_false(cdem_case_given(&read, "supports[1]") || cdem_case_given(&read, "contact"));
  cdem_case_release(&read);
  check_ok(read_with(ROCK, 1, override, &read, &fault));
  memset(&fault, 0, sizeof fault);
  cdem_case_fail(&read, "end", CDEM_INPUT, &fault, "too long");
  assert_string_equal(fault.message, "override 'end=3 s': too long");
  cdem_case_release(&read);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_kinds_of_values),
      cmocka_unit_test(interfaces_and_contact),
      cmocka_unit_test(what_acts),
      cmocka_unit_test(defaults),
      cmocka_unit_test(the_analysis_decides),
      cmocka_unit_test(overrides_replace_and_add),
      cmocka_unit_test(overrides_make_sections),
      cmocka_unit_test(failures_show_the_place),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
