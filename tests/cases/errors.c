/* Case files that are wrong: every error shows its place and says what to do. */
#include "cases/support.h"

#define WITH(more) ROCK more /* begins at line 5 */
#define SUPPORT    WITH("supports:\n  - {group: a, displacement: {x: ")

typedef struct {
  const char *text, *message;
} wrong;

static void check_all(const wrong *list, size_t count) {
  for (size_t i = 0; i < count; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    cdem_status status = read_text(list[i].text, &read, &fault);
    if (status != CDEM_INPUT || strstr(fault.message, list[i].message) == NULL)
      fail_msg("%zu: status %d\n%s\ndoes not hold\n%s", i, status, fault.message, list[i].message);
    assert_true(read.path == NULL && read.places == NULL && read.values.loads.item == NULL);
  }
}
#define CHECK_ALL(list) check_all(list, sizeof(list) / sizeof *(list))

static void keys_and_sections(void **state) {
  (void)state;
  static const wrong list[] = {
      {WITH("thicknes: 1\n"), "c.yaml:5:1: unknown key 'thicknes'; did you mean 'thickness'?\n"
                              "  thicknes: 1\n  ^~~~~~~~"},
      {WITH("contact: {frction: 1}\n"),
       "c.yaml:5:11: unknown key 'frction'; did you mean 'friction'?\n"
       "  contact: {frction: 1}\n            ^~~~~~~"},
      {WITH("title: a\ntitle: b\n"), "c.yaml:6:1: key 'title' was given already in line 5"},
      {WITH("quiet: a\nquiet: [b]\n"), "key 'quiet' was given already"},
      {WITH("supports: [{group: a, displacement: {x: 1, x: 2}}]\n"), "key 'x' was given already"},
      {WITH("loads: [{group: a, pressure: 1, pressure: 2}]\n"), "key 'pressure' was given already"},
      {WITH("loads: [{group: a, pressure: 1}]\nloads: [{group: a, pressure: 1}]\n"),
       "key 'loads' was given already"},
      {WITH("probes: {a: {group: b, component: x}, a: {group: c, component: y}}\n"),
       "key 'a' was given already"},
      {WITH("title: *a\n"), "c.yaml:5:8: aliases are not allowed"},
      {WITH("title: &a b\n"), "c.yaml:5:8: anchors are not allowed"},
      {WITH("title: [a]\n"), "c.yaml:5:8: 'title' must be a text, not a list"},
      {WITH("title:\n"), "'title' must be a text, not nothing"},
      {WITH("supports: {group: a}\n"),
       "c.yaml:5:11: 'supports' must be a list of maps, each begun with '- ', not a map"},
      {WITH("supports:\n  - bottom\n"),
       "c.yaml:6:5: supports[0] must be a map of keys and values, not a text\n"
       "    - bottom\n      ^~~~~~"},
      {WITH("supports:\n  - {displacement: {x: 0}}\n"), "c.yaml:6:5: supports[0] needs 'group'"},
      {WITH("probes: [tip]\n"), "c.yaml:5:9: 'probes' must be a map of names, each with a map of "
                                "keys, not a list"},
      {WITH("probes:\n  tip: {group: a}\n"), "c.yaml:6:3: probes.tip needs 'component'\n"
                                             "    tip: {group: a}\n    ^~~"},
      {WITH("probes:\n  the tip: {group: a, component: x}\n"),
       "c.yaml:6:3: 'the tip' cannot be a name: letters, digits, '_' and '-', at most 63"},
      {WITH("plates: {}\nblocks:\n"), "c.yaml:6:8: blocks must be a map of keys and values, not a "
                                      "text; write {} where all keys keep their defaults"},
      {"end: 1\n", "c.yaml: a case needs a 'mesh' (a body and its 'materials') or 'grains'"},
      {"just words\n", "c.yaml:1:1: a case must be a map of keys and values, not a text"},
      {"", "it is empty"},
      {"end: 1\n---\nend: 2\n", "a second document begins here"},
      {"end: {1\n", "c.yaml:"},
      {"end: 1\nmesh: a\nmaterials: {r: {young: 1, poisson: 0, densty: 3}}\n",
       "c.yaml:3:39: unknown key 'densty'; did you mean 'density'?"},
      {"end: 1\nmesh: a\nmaterials: {r: {poisson: 0, density: 3}}\n",
       "c.yaml:3:13: a material of model isotropic needs 'young'"},
      {"end: 1\nmesh: a\nmaterials: {r: {model: isotropi, young: 1, poisson: 0}}\n",
       "unknown material model 'isotropi'; did you mean 'isotropic'?"},
      {"end: 1\nmesh: a\nmaterials: {r: {material: 3, young: 1, poisson: 0}}\n",
       "c.yaml:3:17: unknown key 'material'"},
  };
  CHECK_ALL(list);
}

static void values(void **state) {
  (void)state;
  static const wrong list[] = {
      {WITH("thickness: 3 kg\n"),
       "c.yaml:5:12: thickness: '3 kg' has the wrong dimension; expected "
       "a unit of m\n  thickness: 3 kg\n             ^~~~"},
      {WITH("thickness: 3 mmm\n"), "unknown unit 'mmm'"},
      {WITH("thickness: .nan\n"), "c.yaml:5:12: thickness: '.nan' is not a number"},
      {WITH("thickness: nan\n"), "'nan' is not a number"},
      {WITH("thickness: .inf\n"), "is not a number"},
      {WITH("thickness: 1e999\n"), "is too large"},
      {WITH("thickness: [1]\n"), "'thickness' must be a number, not a list"},
      {WITH("thickness: 0\n"), "c.yaml:5:12: thickness is 0 m and must be above 0 m\n"},
      {WITH("thickness: -2 mm\n"), "thickness is -0.002 m and must be above 0 m"},
      {WITH("safety: 1.5\n"), "safety is 1.5 and must be above 0 and at most 1"},
      {WITH("local_damping: 1\n"), "local_damping is 1 and must be at least 0 and below 1"},
      {WITH("mass_damping: -1\n"), "mass_damping is -1 s-1 and must be at least 0 s-1"},
      {WITH("most_steps: 1.5\n"), "most_steps is '1.5' and must be a whole number"},
      {WITH("most_steps: 0\n"), "most_steps is 0 and must be at least 1"},
      {WITH("most_steps: 1e20\n"), "must be a whole number"},
      {WITH("plane: strees\n"), "c.yaml:5:8: unknown plane 'strees'; did you mean 'stress'?"},
      {WITH("plane: zzz\n"), "unknown plane 'zzz'; it is one of: strain stress"},
      {WITH("contact: {active: maybe}\n"), "'active' must be yes or no, not 'maybe'"},
      {WITH("gravity: 9.81\n"), "c.yaml:5:10: 'gravity' must be a list of 2 to 3 numbers, such as "
                                "[0, -9.81 m/s2]"},
      {WITH("gravity: [1]\n"), "'gravity' must be a list of 2 to 3 numbers"},
      {WITH("gravity: [1, 2, 3, 4]\n"), "'gravity' must be a list of 2 to 3 numbers"},
      {WITH("gravity: [0, 3 m/s]\n"), "c.yaml:5:14: gravity: '3 m/s' has the wrong dimension"},
      {WITH("gravity: [0, [1]]\n"), "'gravity' must be a number, not a list"},
      {WITH("initial: [{spin: [1]}]\n"), "'spin' must be a list of 3 numbers"},
      {WITH("quiet: {a: b}\n"), "'quiet' must be one text or a list of texts"},
      {WITH("quiet: []\n"), "'quiet' must be one text or a list of texts"},
      {WITH("quiet: [a, [b]]\n"), "c.yaml:5:12: 'quiet' must be a text, not a list"},
      {"end: 1\nmaterials: {r: {young: 1, poisson: 0, density: 1}}\n"
       "mesh: {file: a.geo, parameters: [1]}\n",
       "'parameters' must be a map of names and numbers, such as {h: 0.005"},
      {"end: 1\nmaterials: {r: {young: 1, poisson: 0, density: 1}}\n"
       "mesh: {file: a.geo, parameters: {h: 3 mm}}\n",
       "c.yaml:3:37: h: '3 mm' has the wrong dimension; expected a unit of 1"},
  };
  CHECK_ALL(list);
}

static void functions_of_time(void **state) {
  (void)state;
  static const wrong list[] = {
      {SUPPORT "3 s}}\n", "c.yaml:6:34: x: '3 s' has the wrong dimension; expected a unit of m\n"},
      {SUPPORT "[1]}}\n",
       "'x' must be a number, or a map with one of table, ramp, sine, pulse, not "
       "a list"},
      {SUPPORT "{over: 1}}}\n", "'x' must be a number, or a map with one of table, ramp"},
      {SUPPORT "{ramp: 1, sine: 2}}}\n", "'ramp' and 'sine' cannot both be given"},
      {SUPPORT "{ramp: 1}}}\n", "'ramp' needs 'over' beside it"},
      {SUPPORT "{ramp: 1, over: 0}}}\n", "over is 0 s and must be above 0"},
      {SUPPORT "{ramp: 1, over: 1e-20, start: 1}}}\n", "cannot be told from a jump at 1 s"},
      {SUPPORT "{ramp: 1, ovr: 1 s}}}\n", "unknown key 'ovr'; did you mean 'over'?"},
      {SUPPORT "{ramp: 1, over: 1 m}}}\n", "over: '1 m' has the wrong dimension"},
      {SUPPORT "{ramp: 1, over: 1, from: 1 Pa}}}\n", "from: '1 Pa' has the wrong dimension"},
      {SUPPORT "{sine: 1}}}\n", "'sine' needs 'frequency' beside it"},
      {SUPPORT "{sine: 1, frequency: 1 s}}}\n",
       "frequency: '1 s' has a unit that is no multiple of s-1"},
      {SUPPORT "{sine: 1, frequency: -1 Hz}}}\n", "frequency is -1 s-1 and must be above 0"},
      {SUPPORT "{pulse: 1, duration: -1}}}\n", "duration is -1 s and must be above 0"},
      {SUPPORT "{pulse: 1, duration: 1, frequency: 2}}}\n", "unknown key 'frequency'"},
      {SUPPORT "{table: 3}}}\n", "'table' must be a list of pairs [time, value]"},
      {SUPPORT "{table: []}}}\n", "'table' must be a list of pairs"},
      {SUPPORT "{table: [[0, 1], [1]]}}}\n",
       "c.yaml:6:51: a point of a table must be a pair [time, value]"},
      {SUPPORT "{table: [[0, 1], [0, 2]]}}}\n",
       "the times of a table must ascend: 0 s does not come after 0 s"},
      {SUPPORT "{table: [[0, 1], [1 ms, 2 Pa]]}}}\n", "x: '2 Pa' has the wrong dimension"},
      {SUPPORT "{table: [[0, 1], [1 m, 2]]}}}\n", "time: '1 m' has the wrong dimension"},
      {WITH("supports: [{group: a, displacement: {w: 0}}]\n"), "unknown component 'w'"},
      {WITH("supports: [{group: a, displacement: {rotaton: 0}}]\n"),
       "unknown component 'rotaton'; did you mean 'rotation'?"},
      {WITH("supports: [{group: a, displacement: {}}]\n"),
       "'displacement' must be a map of x, y, z, "
       "rotation, such as {x: 0"},
      {WITH("supports: [{group: a, displacement: 3}]\n"), "'displacement' must be a map of x"},
      {WITH("loads: [{group: a, traction: {rotation: 0}}]\n"), "unknown component 'rotation'"},
      {WITH("loads: [{group: a, pressure: 3 N}]\n"), "pressure: '3 N' has the wrong dimension"},
      {WITH("loads: [{group: a, force: {rotation: 3 N}}]\n"),
       "rotation: '3 N' has the wrong dimension; expected a unit of J"},
  };
  CHECK_ALL(list);
}

/* Five errors in one run, all shown; more are counted. */
static void several_at_once(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  static const char text[] = "end: 3 m\nmesh: a\nsafty: 1\nplane: x\n"
                             "materials: {r: {young: -1, poisson: 0, density: 1 s}}\n";
  assert_int_equal(read_text(text, &read, &fault), CDEM_INPUT);
  static const char *const parts[] = {":1:6: end:", ":3:1: unknown key 'safty'",
                                      ":4:8: unknown plane", ":5:24: young is -1",
                                      ":5:49: density:"};
  for (int i = 0; i < 5; i++)
    if (strstr(fault.message, parts[i]) == NULL)
      fail_msg("'%s' is not in\n%s", parts[i], fault.message);
  memset(&fault, 0, sizeof fault);
  assert_int_equal(read_text("a: 1\nb: 1\nc: 1\nd: 1\ne: 1\nf: 1\ng: 1\nh: 1\n", &read, &fault),
                   CDEM_INPUT);
  assert_non_null(strstr(fault.message, "and 3 more errors"));
}

static void overrides(void **state) {
  (void)state;
  static const struct {
    const char *override, *message;
  } list[] = {
      {"thickness", "override 'thickness': is not of the form section.key=value"},
      {"=3", "is not of the form"},
      {"thickness=", "override 'thickness=': has no value"},
      {"thickness=3 kg", "override 'thickness=3 kg': thickness: '3 kg' has the wrong dimension"},
      {"thicknes=3", "override 'thicknes=3': unknown key 'thicknes'; did you mean 'thickness'?"},
      {"contact.frction=3", "unknown key 'frction'; did you mean 'friction'?"},
      {"end.x=3", "override 'end.x=3': 'x' cannot be a key there: the case has a text"},
      {"materials[0].young=3", "'[0]' needs a list there: the case has a map"},
      {"supports[1].group=a",
       "'[1]' is beyond the list, which has 0 entries; counting begins at 0, "
       "and [0] adds one"},
      {"supports[x].group=a", "'[x].group=a' does not begin with a number in brackets"},
      {"supports[-1]=a", "does not begin with a number in brackets"},
      {"supports[0=a", "does not begin with a number in brackets"},
      {"a..b=1", "a key is missing before '.b=1'"},
      {".a=1", "a key is missing before '.a=1'"},
      {"quiet[0]x=1", "'.' or '[' is missing before 'x=1'"},
      {"thickness=[1", "override 'thickness=[1': did not find expected ',' or ']'"},
      {"title=*a", "override 'title=*a': aliases are not allowed"},
      {"supports=[{group: a}]", "override 'supports=[{group: a}]': a support needs a component"},
      {"interfaces[0].dilation=4", "override 'interfaces[0].dilation=4': interfaces need 'blocks'"},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    cdem_status status = read_with(ROCK, 1, &list[i].override, &read, &fault);
    if (status != CDEM_INPUT || strstr(fault.message, list[i].message) == NULL)
      fail_msg("%zu: status %d\n%s\ndoes not hold\n%s", i, status, fault.message, list[i].message);
  }
}

static void files_that_are_not_there(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  check_fails(cdem_read_case("/nowhere/c.yaml", 0, NULL, &read, &fault), CDEM_FILE,
              "cannot read '/nowhere/c.yaml': No such file or directory");
  check_fails(cdem_read_case("/", 0, NULL, &read, &fault), CDEM_FILE, "cannot read '/'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(keys_and_sections), cmocka_unit_test(values),
      cmocka_unit_test(functions_of_time), cmocka_unit_test(several_at_once),
      cmocka_unit_test(overrides),         cmocka_unit_test(files_that_are_not_there),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
