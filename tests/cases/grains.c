/* Cases of grains: what is read, what is filled in, and what cannot be. */
#include "cases/support.h"
#include "dem/packing.h"

#define GRAINS                                                                                     \
  "end: 1\n"                                                                                       \
  "grains:\n"                                                                                      \
  "  dimension: 2\n"                                                                               \
  "  packing: {kind: inward, high: [1, 1], radius: 0.02}\n"                                        \
  "  materials: {sand: {density: 2600}, steel: {young: 200 GPa}}\n"
#define CONTACTS "contacts: [{normal_stiffness: 1 MN/m, rolling_length: 2 mm}, {friction: 0.5}]\n"

static void values_arrive(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_ok(
      read_text(GRAINS CONTACTS
                "walls:\n"
                "  lid: {shape: plate, center: [0, 1], normal: [0, -1], half_size: [0.5],\n"
                "        servo: [0, 1], servo_force: {ramp: 1 kN, over: 1 s}, servo_speed: 1,\n"
                "        velocity: {x: 2}, spin: {z: 3}, stop: 2 s}\n"
                "bonds: [{between: [sand, sand], normal_stiffness: 1, tension: 3}]\n"
                "cell: {periodic: x, rate: {xx: 1, yx: 2}, stress: {yy: 5 kPa}, "
                "servo_rate: 1}\n"
                "probes: {n: {quantity: count, region: {low: [0, 0], high: [1, 0.5]}}}\n",
                &read, &fault));
  const cdem_case_values *v = &read.values;
  assert_true(cdem_case_has_grains(&read));
  assert_int_equal(v->grains.dimension, 2);
  assert_string_equal(cdem_law_at(v->grains.law)->name, "linear");
  assert_true(v->contacts.item[0].value[CDEM_LAW_normal_stiffness] == 1e6);
  assert_true(v->contacts.item[0].value[CDEM_LAW_rolling_length] == 2e-3);
  assert_true(isnan(v->contacts.item[0].value[CDEM_LAW_friction]));
  assert_true(v->contacts.item[1].value[CDEM_LAW_friction] == 0.5);
  assert_true(isnan(v->grains.materials.item[1].density));
  assert_true(v->walls.item[0].spin.given[2] && !v->walls.item[0].spin.given[0]);
  assert_true(cdem_series_at(&v->walls.item[0].servo_force, 0.5) == 500.0);
  assert_true(v->walls.item[0].start == 0.0 && v->walls.item[0].stop == 2.0);
  assert_true(v->bonds.item[0].gap == 1e-3 && v->bonds.item[0].shear_stiffness == 0.0);
  assert_true(cdem_case_names_direction(&v->cell.periodic, 0));
  assert_false(cdem_case_names_direction(&v->cell.periodic, 1));
  assert_true(v->cell.rate.given[0] && v->cell.rate.given[3] && !v->cell.rate.given[1]);
  assert_true(v->cell.stress.given[4] && cdem_series_at(&v->cell.stress.component[4], 0) == 5e3);
  assert_true(v->probes.item[0].region.high[1] == 0.5);
  cdem_case_release(&read);
}

/* The names of the choices are those of the tables of room dem. */
static void choices_are_the_tables(void **state) {
  (void)state;
  const cdem_case_section *grains = cdem_case_key_find(cdem_case_root(), "grains")->section;
  const char *const *law = cdem_case_key_find(grains, "law")->choice;
  const char *const *rolling = cdem_case_key_find(grains, "rolling")->choice;
  const char *const *twisting = cdem_case_key_find(grains, "twisting")->choice;
  const cdem_case_section *packing = cdem_case_key_find(grains, "packing")->section;
  const char *const *kind = cdem_case_key_find(packing, "kind")->choice;
  const char *const *sizes = cdem_case_key_find(packing, "sizes")->choice;
  int i;
  for (i = 0; law[i] != NULL; i++)
    assert_string_equal(law[i], cdem_law_at(i)->name);
  assert_null(cdem_law_at(i));
  for (i = 0; rolling[i] != NULL; i++)
    assert_string_equal(rolling[i], cdem_rolling_at(i)->name);
  assert_null(cdem_rolling_at(i));
  for (i = 0; twisting[i] != NULL; i++)
    assert_string_equal(twisting[i], cdem_twisting_at(i)->name);
  assert_null(cdem_twisting_at(i));
  for (i = 0; kind[i] != NULL; i++)
    assert_string_equal(kind[i], cdem_packing_at(i)->name);
  assert_null(cdem_packing_at(i));
  for (i = 0; sizes[i] != NULL; i++)
    assert_string_equal(sizes[i], cdem_size_kind_name(i));
  assert_null(cdem_size_kind_name(i));
}

static void what_cannot_be(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } list[] = {
      {GRAINS, "c.yaml:2:1: grains need 'contacts'"},
      {GRAINS "contacts: []\n", "c.yaml:6:1: grains need 'contacts'"},
      {GRAINS CONTACTS "quiet: a\n", "'quiet' has no meaning in a run of grains; damp waves by"},
      {GRAINS CONTACTS "supports: []\n", "hold grains by 'walls'"},
      {GRAINS CONTACTS "blocks: {}\n", "bonds that break are in 'bonds'"},
      {GRAINS CONTACTS "materials: {}\n", "c.yaml:7:1: 'materials' has no meaning"},
      {GRAINS CONTACTS "gravity: [0, 0, -9]\n", "c.yaml:7:17: discs move in the plane z = 0"},
      {GRAINS CONTACTS "bonds: [{between: [sand], normal_stiffness: 1}]\n",
       "'between' must name two materials, not 1"},
      {GRAINS CONTACTS "bonds: [{normal_stiffness: 1, twisting_stiffness: 1}]\n",
       "discs do not twist"},
      {GRAINS CONTACTS "walls: {w: {shape: plate, center: [0, 0], normal: [0, 1]}}\n",
       "wall 'w' is a plate and needs 'half_size'"},
      {GRAINS CONTACTS
       "walls: {w: {shape: plate, center: [0, 0], normal: [0, 1], half_size: [0]}}\n",
       "an endless wall is a plane"},
      {GRAINS CONTACTS "walls: {w: {shape: cylinder, center: [0, 0]}}\n",
       "wall 'w' is a cylinder and needs 'radius'"},
      {GRAINS CONTACTS "walls: {w: {shape: mesh}}\n", "wall 'w' is a mesh and needs 'file'"},
      {GRAINS CONTACTS "walls: {w: {shape: mesh, file: a, normal: [0, 1]}}\n",
       "'normal' has no meaning for a wall of shape mesh"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], velocity: {z: 1}}}\n",
       "discs lie in the plane z = 0; leave `z` out"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], spin: {x: 1}}}\n",
       "walls of discs turn about z only"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], servo: [0, 0]}}\n",
       "the direction of a servo must not be zero"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], servo: [0, 1]}}\n",
       "a servo needs 'servo_force' beside it"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], servo_speed: 1}}\n",
       "this key has a meaning beside 'servo' only"},
      {GRAINS CONTACTS "walls: {w: {shape: plane, normal: [0, 1], start: 2, stop: 1}}\n",
       "'stop' is 1 s and must be after 'start', 2 s"},
      {GRAINS CONTACTS "cell: {low: [0, 0]}\n", "'low' has a meaning beside 'size' only"},
      {GRAINS CONTACTS "cell: {size: [1]}\n", "'size' must be a list of 2 to 3 numbers"},
      {GRAINS CONTACTS "cell: {rate: {zz: 1}}\n", "components with z have no meaning"},
      {GRAINS CONTACTS "cell: {rate: {xx: 1}, stress: {xx: 1}, servo_rate: 1}\n",
       "follows a rate or a stress, not both"},
      {GRAINS CONTACTS "cell: {servo_rate: 1}\n",
       "'servo_rate' has a meaning beside 'stress' only"},
      {GRAINS CONTACTS "probes: {n: {quantity: force, component: x}}\n",
       "the force on a wall is a column already, wall.NAME.fx"},
      {GRAINS CONTACTS "probes: {n: {quantity: stress}}\n", "probes.n needs 'component'"},
      {GRAINS CONTACTS "probes: {n: {quantity: stress, component: yz}}\n",
       "grains in 2-D have the components"},
      {GRAINS CONTACTS "probes: {n: {quantity: fabric}}\n", "probes.n needs 'component'"},
      {GRAINS CONTACTS "probes: {n: {quantity: fabric, component: x}}\n",
       "a fabric has the components xx"},
      {GRAINS CONTACTS "probes: {n: {quantity: count, component: x}}\n",
       "'component' has no meaning for a quantity that is one number"},
      {GRAINS CONTACTS "probes: {n: {quantity: count, surface: cone}}\n",
       "'surface' has a meaning beside 'quantity: surface_angle' only"},
      {ROCK "walls: {}\n",
       "'walls' has no meaning in a run of a body; a rigid wall is an entry of"},
      {ROCK "cell: {}\n", "a body is not periodic"},
      {ROCK "probes: {n: {group: a, quantity: count}}\n", "this quantity is one of grains"},
      {ROCK "probes: {n: {group: a, component: x, region: {}}}\n",
       "'region' has a meaning for grains only"},
      {"end: 1\nmesh: a\n", "a body needs 'materials'"},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    if (read_text(list[i].text, &read, &fault) != CDEM_INPUT ||
        strstr(fault.message, list[i].message) == NULL)
      fail_msg("%s\n%s\ndoes not hold\n%s", list[i].text, fault.message, list[i].message);
  }
}

/* Packings, by overrides of the case above. */
static void packings_that_cannot_be(void **state) {
  (void)state;
  static const struct {
    const char *override, *message;
  } list[] = {
      {"grains.file=a.csv", "grains come from a file or a packing, not both"},
      {"grains.packing.sizes=normal", "a packing of normal sizes needs 'least'"},
      {"grains.packing.sizes=table", "a packing with a table of sizes needs 'classes'"},
      {"grains.packing.high=[1, -1]", "along y 'high' is -1 m and 'low' 0 m"},
      {"grains.packing.periodic=z", "'z' is no direction; there are x and y"},
      {"grains.packing.compact={}",
       "'compact' needs 'fraction', 'pressure' or, in a cylinder, 'height'"},
      {"grains.packing.compact={height: 0.5, pressure: 1}", "'pressure' and 'height' cannot both"},
      {"grains.packing.compact={fraction: 0.5, pressure: 1}",
       "'fraction' and 'pressure' cannot both be given"},
      {"grains.packing={kind: loose, high: [1, 1], radius: 0.1, count: 3, fraction: 0.1}",
       "'count' and 'fraction' cannot both be given"},
      {"grains.material=steel", "material 'steel' of the grains needs 'density'"},
      {"grains.material=stel", "there is no material 'stel'; did you mean 'steel'?"},
      {"grains.dimension=4", "dimension is 4 and must be at least 2 and at most 3"},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    if (read_with(GRAINS CONTACTS, 1, &list[i].override, &read, &fault) != CDEM_INPUT ||
        strstr(fault.message, list[i].message) == NULL)
      fail_msg("%s\n%s\ndoes not hold\n%s", list[i].override, fault.message, list[i].message);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_arrive),
      cmocka_unit_test(choices_are_the_tables),
      cmocka_unit_test(what_cannot_be),
      cmocka_unit_test(packings_that_cannot_be),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
