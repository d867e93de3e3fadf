/* Checks that join several keys: each with its place and remedy, and each good neighbour passes. */
#include "cases/support.h"

#define STATIC                                                                                     \
  "analysis: static\n"                                                                             \
  "mesh: rock.geo\n"                                                                               \
  "materials:\n"                                                                                   \
  "  rock: {young: 30 GPa, poisson: 0.3, density: 2700 kg/m3}\n"
#define RELAX         "analysis: relaxation\n" ROCK
#define BLOCKS        ROCK "blocks: {breakable: rock}\n" /* six lines with the next */
#define LAW           BLOCKS "interfaces: [{"
#define MESH(it)      "end: 1\nmaterials: {r: {young: 1, poisson: 0, density: 1}}\nmesh: {" it "}\n"
#define MATERIALS(it) "end: 1\nmesh: a.msh\nmaterials:\n" it
#define COSSERAT                                                                                   \
  "{model: cosserat, young: 1, poisson: 0, cosserat_modulus: 1, characteristic_length: 1, "        \
  "density: 1"

static void wrong_combinations(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } list[] = {
      /* the analysis */
      {"mesh: a\nmaterials: {r: {young: 1, poisson: 0, density: 1}}\n",
       "c.yaml: a dynamic run needs 'end', the time at which it ends"},
      {"analysis: dynamic\nmesh: a\nmaterials: {r: {young: 1, poisson: 0, density: 1}}\n",
       "c.yaml:1:11: a dynamic run needs 'end'"},
      {ROCK "tolerance: 1e-3\n", "c.yaml:5:12: 'tolerance' has no meaning in a dynamic run"},
      {ROCK "step: 1 us\nsafety: 0.5\n", "c.yaml:6:9: 'step' and 'safety' cannot both be given"},
      {RELAX "quiet: a\n", "c.yaml:6:8: 'quiet' has no meaning in a relaxation run"},
      {STATIC "contact: {friction: 0.1}\n", "c.yaml:5:1: a static run knows no contact"},
      {STATIC "plates: {p: {point: [0, 0], normal: [0, 1]}}\n",
       "c.yaml:5:1: 'plates' has no meaning in a static run"},
      {STATIC "mass_damping: 1\n", "'mass_damping' has no meaning in a static run"},
      {STATIC "most_steps: 5\n", "'most_steps' has no meaning in a static run"},
      {STATIC "initial: [{velocity: [1, 0]}]\n", "'initial' has no meaning in a static run"},
      {STATIC "supports: [{group: a, velocity: {x: 1}}]\n",
       "c.yaml:5:37: 'velocity' has no meaning in a static run; prescribe 'displacement'"},
      {ROCK "stop_when: a\n", "c.yaml:5:12: 'stop_when' needs 'stop_below' beside it"},
      {ROCK "stop_below: 0.5\n", "c.yaml:5:13: 'stop_below' needs 'stop_when' beside it"},
      /* the mesh */
      {MESH("file: a, shape: tri3"), "c.yaml:3:24: a mesh is a file or a grid, not both"},
      {MESH("unit: 1 mm"), "c.yaml:3:1: a mesh needs 'file', or 'shape', 'count' and 'size'"},
      {MESH("file: a, seed: 3"), "c.yaml:3:23: 'mesh.seed' belongs to a grid"},
      {MESH("shape: tri3, count: [1, 1], size: [1, 1], unit: 1 mm"),
       "'mesh.unit' belongs to a mesh file"},
      {MESH("shape: tri3, size: [1, 1]"),
       "c.yaml:3:1: a grid of this shape needs 2 whole numbers of "
       "bricks in 'count', from 1 to 1e6; number 1 is 0"},
      {MESH("shape: tri3, count: [1, 1.5], size: [1, 1]"),
       "c.yaml:3:32: a grid of this shape needs 2 "
       "whole numbers"},
      {MESH("shape: hex8, count: [1, 1], size: [1, 1]"), "needs 3 whole numbers of bricks"},
      {MESH("shape: hex8, count: [1, 1, 1], size: [1, 1]"),
       "c.yaml:3:39: a grid of this shape needs 3 lengths in 'size'; number 3 is 0 m"},
      /* materials */
      {"end: 1\nmesh: a\nmaterials: {}\n", "c.yaml:3:1: a case needs a material"},
      {MATERIALS("  r: {young: 1, poisson: 0}\n"),
       "c.yaml:4:3: material 'r' needs 'density': the run moves masses\n"
       "    r: {young: 1, poisson: 0}\n    ^"},
      {"analysis: static\nmesh: a\ngravity: [0, -1]\nmaterials:\n  r: {young: 1, poisson: 0}\n",
       "c.yaml:5:3: material 'r' needs 'density': there is gravity"},
      {MATERIALS("  r: {young: 1, poisson: 0, density: 1}\n  s: {young: 1, poisson: 0, density: "
                 "1}\n"),
       "c.yaml:5:3: materials 'r' and 's' both have no 'groups'"},
      {MATERIALS("  r: {young: 1, poisson: 0, density: 1, groups: [a, b]}\n"
                 "  s: {young: 1, poisson: 0, density: 1, groups: [c, b]}\n"),
       "c.yaml:5:41: group 'b' has material 'r' already"},
      {MATERIALS("  r: {young: 1, poisson: 0, density: 1, micro_inertia: 1}\n"),
       "'micro_inertia' belongs to Cosserat materials"},
      {MATERIALS("  r: {young: 1, poisson: 0, density: 1}\n  s: " COSSERAT ", groups: a}\n"),
       "c.yaml:5:14: Cosserat and other materials cannot be in one case: 'r' is not, 's' is "
       "Cosserat"},
      {MATERIALS(
           "  r: {model: orthotropic, e1: 1, e2: 1, e3: 1, nu12: 0, nu13: 0, nu23: 0, g12: 1, "
           "g13: 1, g23: 1, density: 1, tension: none}\n"),
       "a material without tension wants isotropic moduli, and 'r' is orthotropic; give it 'young' "
       "and 'poisson', or 'tension: elastic'"},
      {"analysis: static\nmesh: a\nmaterials: {r: {young: 1, poisson: 0, tension: none}}\n",
       "c.yaml:3:48: a static run is linear, and a material without tension is not; take "
       "'analysis: relaxation'"},
      {MATERIALS("  r: {young: 1, poisson: 0, density: 1, tension: some}\n"), "c.yaml:4:50: "},
      /* interfaces and contact */
      {ROCK "interfaces: [{tension: 1}]\n", "c.yaml:5:1: interfaces need 'blocks'"},
      {LAW "between: [a]}]\n", "c.yaml:6:15: 'between' must name two groups, not 1"},
      {LAW "between: [a, b], joint: c}]\n", "'between' and 'joint' cannot both be given"},
      {LAW "friction: 0.1, dilation: 0.2}]\n",
       "c.yaml:6:40: dilation is 0.2 and must be at most the friction, 0.1"},
      {LAW "stiffness_factor: 1, normal_stiffness: 1}]\n",
       "'stiffness_factor' and 'normal_stiffness' cannot both be given; leave one out"},
      {LAW "shear_ratio: 1, shear_stiffness: 1}]\n", "'shear_ratio' and 'shear_stiffness' cannot"},
      {LAW "softening: linear, tension: 1}]\n",
       "c.yaml:6:26: linear softening with 'tension' needs 'energy_1'"},
      {LAW "softening: linear, cohesion: 1}]\n",
       "linear softening with 'cohesion' needs 'energy_2'"},
      {LAW "tension: 1, energy_1: 1}]\n", "'energy_1' is used by linear softening only; add "
                                          "'softening: linear'"},
      {LAW "softening: linear, tension: 2 MPa, energy_1: 10, normal_stiffness: 1e11}]\n",
       "normal_stiffness is 1e+11 Pa/m and must be at least tension^2/(2 energy_1) = 2e+11 Pa/m"},
      {LAW "softening: linear, cohesion: 2 MPa, energy_2: 10, shear_stiffness: 1e11}]\n",
       "shear_stiffness is 1e+11 Pa/m and must be at least cohesion^2/(2 energy_2)"},
      {ROCK "contact: {stiffness_factor: 1, normal_stiffness: 1}\n",
       "'stiffness_factor' and 'normal_stiffness' cannot both be given"},
      /* what acts */
      {ROCK "supports:\n  - {group: a}\n",
       "c.yaml:6:5: a support needs a component of 'displacement'"},
      {ROCK "supports: [{group: a, displacement: {x: 0}, velocity: {x: 1}}]\n",
       "c.yaml:5:59: 'displacement' and 'velocity' cannot both prescribe 'x'"},
      {ROCK "supports: [{group: a, displacement: {rotation: 0}}]\n",
       "c.yaml:5:48: 'rotation' is a degree of freedom of Cosserat materials only"},
      {ROCK "loads:\n  - {group: a}\n",
       "c.yaml:6:5: a load needs exactly one of 'force', 'traction', "
       "'pressure', 'kirsch_tension', not 0"},
      {ROCK "loads: [{group: a, pressure: 1, traction: {x: 1}}]\n",
       "'kirsch_tension', not 2; write "
       "one entry for each"},
      {ROCK "loads: [{group: a, force: {rotation: 1}}]\n", "'rotation' is a degree of freedom"},
      {ROCK "loads: [{group: a, kirsch_tension: 1}]\n", "'kirsch_tension' needs 'kirsch_radius'"},
      {ROCK "loads: [{group: a, kirsch_radius: 1}]\n", "'kirsch_radius' has a meaning beside"},
      {ROCK "loads: [{group: a, pressure: 1, kirsch_center: [0, 0]}]\n",
       "'kirsch_center' has a meaning beside 'kirsch_tension' only"},
      {ROCK "plates: {p: {point: [0, 0], normal: [0, 0]}}\n",
       "the normal of a plate must not be zero"},
      {ROCK "plates: {p: {point: [0, 0], normal: [0, 1], axis: [0, 2]}}\n",
       "the axis of a plate must not be zero or along its normal"},
      {ROCK "plates: {p: {point: [0, 0], normal: [0, 1], axis: [0, 0]}}\n", "must not be zero"},
      {ROCK
       "plates: {p: {point: [0, 0], normal: [0, 1], stiffness_factor: 1, normal_stiffness: 1}}\n",
       "'stiffness_factor' and 'normal_stiffness' cannot both be given"},
      {ROCK "initial: [{groups: a}]\n", "an initial motion needs 'velocity' or 'spin'"},
      {ROCK "initial: [{velocity: [1, 0], center: [0, 0]}]\n",
       "'center' has a meaning beside 'spin'"},
      /* what is kept */
      {ROCK "probes: {time: {group: a, component: x}}\n",
       "c.yaml:5:10: 'time' is a column of every"},
      {ROCK "probes: {p: {group: a, component: xx}}\n",
       "c.yaml:5:35: displacement, velocity and force have the components x y z"},
      {ROCK "probes: {p: {group: a, quantity: stress, component: x}}\n",
       "a stress has the components xx yy zz yz xz xy"},
      {ROCK "probes: {p: {group: a, quantity: stress, component: magnitude}}\n",
       "a stress has the components"},
      {ROCK "probes: {p: {group: a, component: rotation}}\n",
       "'rotation' is a degree of freedom of Cosserat materials only"},
      {ROCK "results: {r: {of: time, tolerance: 1}}\n",
       "c.yaml:5:36: 'tolerance' needs 'reference' beside it"},
      {ROCK "results: {r: {of: time, reference: 1, against: time}}\n",
       "c.yaml:5:48: the expected value is 'reference' or 'against', not both"},
      {ROCK "results: {r: {of: time, against_factor: 2}}\n", "'against_factor' needs 'against'"},
      {ROCK "results: {r: {of: time, take: scatter, along: step}}\n",
       "'along' has a meaning beside 'take: place_of_max' and 'take: place_of_min' only"},
      {ROCK "results: {r: {of: time, from: 2 ms, to: 1 ms}}\n", "'to' must be later than 'from'"},
      {ROCK "results: {r: {of: time, from: 1 ms}}\n", "'from' must be earlier than 'end'"},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    cdem_status status = read_text(list[i].text, &read, &fault);
    if (status != CDEM_INPUT || strstr(fault.message, list[i].message) == NULL)
      fail_msg("%zu: status %d\n%s\ndoes not hold\n%s", i, status, fault.message, list[i].message);
    assert_null(read.path);
  }
}

static void right_combinations(void **state) {
  (void)state;
  static const char *const list[] = {
      ROCK "step: 1 us\n",
      RELAX "tolerance: 1e-3\nplates: {p: {point: [0, 0], normal: [0, 1]}}\n",
      STATIC "contact: no\nend: 2 s\ngravity: [0, -1]\n",
      STATIC "supports: [{group: a, displacement: {x: {ramp: 1, over: 1}}}]\n",
      "analysis: static\nmesh: a\nmaterials: {r: {young: 1, poisson: 0}}\n",
      MESH("shape: tri3, count: [1, 2], size: [1, 1]"),
      MATERIALS("  r: {young: 1, poisson: 0, density: 1, groups: a}\n"
                "  s: {young: 1, poisson: 0, density: 1, groups: b}\n"
                "  t: {young: 1, poisson: 0, density: 1}\n"),
      MATERIALS("  r: " COSSERAT "}\nprobes: {p: {group: a, component: rotation}}\n"),
      LAW "friction: 0.2, dilation: 0.2}]\n",
      LAW "softening: linear, friction: 0.2}]\n", /* no strength, no energy */
      LAW "softening: linear, tension: 2 MPa, energy_1: 10, normal_stiffness: 2e11}]\n",
      LAW "normal_stiffness: 1e9, shear_ratio: 0.3}]\n",
      ROCK "supports: [{group: a, displacement: {x: 0}, velocity: {y: 1}}]\n",
      ROCK "loads: [{group: a, force: {x: 1}}, {group: a, pressure: 1}]\n",
      ROCK "initial: [{spin: [0, 0, 1], center: [1, 1]}]\n",
      ROCK "probes: {p: {group: a, quantity: force, component: magnitude}}\n",
      ROCK "results: {r: {of: time, reference: 0}}\n",
      ROCK "results: {r: {of: time, take: place_of_min, along: step}}\n",
      ROCK "results: {r: {of: time, take: place_of_max}}\n",
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    cdem_fault fault = {0};
    cdem_case read = {0};
    check_ok(read_text(list[i], &read, &fault));
    cdem_case_release(&read);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(wrong_combinations),
      cmocka_unit_test(right_combinations),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
