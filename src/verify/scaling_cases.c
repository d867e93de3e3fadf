/* Small cases in which as much happens as fits into a second. */
#include "verify/scaling.h"

/* Deformable grains thrown at each other and at the walls of a tube. */
#define TUBE(end, deformable)                                                                      \
  "end: " end "\n"                                                                                 \
  "history_every: 50 us\n"                                                                         \
  "gravity: [0, 0, -9.81 m/s2]\n"                                                                  \
  "mass_damping: 20 1/s\n"                                                                         \
  "grains:\n"                                                                                      \
  "  dimension: 3\n"                                                                               \
  "  law: penalty\n"                                                                               \
  "  deformable: " deformable "\n"                                                                 \
  "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.15], sizes: "  \
  "uniform, least: 18 mm, most: 22 mm, count: 24}\n"                                               \
  "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"                      \
  "contacts: [{penalty_stiffness: 1e11 N/m3, shear_ratio: 0.8, friction: 0.3, damping_ratio: "     \
  "0.2}]\n"                                                                                        \
  "walls:\n"                                                                                       \
  "  floor: {shape: plane, normal: [0, 0, 1], center: [0, 0, 0]}\n"                                \
  "  tube: {shape: cylinder, radius: 100 mm, center: [0, 0, 0], axis: [0, 0, 1]}\n"                \
  "  lid: {shape: plate, normal: [0, 0, -1], center: [0, 0, 0.15], half_size: [0.2, 0.2], "        \
  "velocity: {z: -20 m/s}}\n"                                                                      \
  "initial: [{velocity: [5 m/s, -3 m/s, -10 m/s], spin: [0, 30, 10]}]\n"

/* A short and fast triaxial test of a few large grains. */
#define TRIAXIAL(deformable)                                                                       \
  "history_every: 0.5 ms\n"                                                                        \
  "grains:\n"                                                                                      \
  "  dimension: 3\n"                                                                               \
  "  law: penalty\n"                                                                               \
  "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.3], radius: "  \
  "30 mm, count: 50, compact: {height: 300 mm}}\n"                                                 \
  "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"                      \
  "  most_overlap: 0.4\n" deformable                                                               \
  "contacts: [{penalty_stiffness: 1e10 N/m3, shear_ratio: 1, friction: 0.3, damping_ratio: "       \
  "0.2}]\n"                                                                                        \
  "triaxial: {pressure: 0.9 MPa, strain: 0.01, consolidation: 8 ms, rate: 4 1/s}\n"

const char *const cdem_scaling_text[CDEM_SCALING_CASES] = {
    [CDEM_SCALING_BODY] =
        "end: 0.3 ms\n"
        "thickness: 20 mm\n"
        "mesh: {shape: quad4, count: [5, 6], size: [50 mm, 60 mm], distortion: 0.2}\n"
        "materials:\n"
        "  rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}\n"
        "mass_damping: 300 1/s\n"
        "gravity: [0, -9.81 m/s2]\n"
        "quiet: x0\n"
        "supports: [{group: y0, velocity: {y: {pulse: 0.2 m/s, duration: 0.1 ms, start: 20 us}}}]\n"
        "loads:\n"
        "  - {group: x1, traction: {x: {sine: 1 MPa, frequency: 5 kHz, phase: 0.3, offset: 0.1 "
        "MPa}}}\n"
        "  - {group: y1, pressure: {table: [[0 s, 0 Pa], [0.1 ms, 2 MPa]]}}\n"
        "history_every: 10 us\n"
        "probes: {tip: {group: x1, quantity: velocity, component: x}}\n",
    [CDEM_SCALING_FRACTURE] =
        "end: 0.6 ms\n"
        "mesh: {shape: tri3, count: [5, 6], size: [50 mm, 60 mm], origin: [-25 mm, 0], "
        "distortion: 0.2, seed: 3}\n"
        "materials:\n"
        "  rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}\n"
        "blocks: {breakable: body}\n"
        "interfaces:\n"
        "  - {tension: 1 MPa, cohesion: 3 MPa, friction: 0.3, softening: linear, energy_1: 2 J/m2, "
        "energy_2: 10 J/m2}\n"
        "contact: {friction: 0.3, damping: 0.1}\n"
        "mass_damping: 1000 1/s\n"
        "gravity: [0, -9.81 m/s2]\n"
        "plates:\n"
        "  press: {point: [0, 60.01 mm], normal: [0, -1], half_size: [15 mm], velocity: {y: {ramp: "
        "-0.7 m/s, over: 0.05 ms}}, friction: 0.2}\n"
        "  anvil: {point: [0, -0.01 mm], normal: [0, 1], friction: 0.2}\n"
        "history_every: 10 us\n"
        "probes:\n"
        "  stress: {group: body, quantity: stress, component: yy}\n"
        "  tip: {group: y1, quantity: displacement, component: y}\n"
        "results:\n"
        "  peak: {of: plate.press.fy, take: max, reference: 1000}\n",
    [CDEM_SCALING_SOLID] =
        "end: 0.4 ms\n"
        "mesh: {shape: tet4, count: [2, 2, 2], size: [20 mm, 20 mm, 20 mm]}\n"
        "materials:\n"
        "  rock: {young: 20 GPa, poisson: 0.2, density: 2500 kg/m3}\n"
        "blocks: {breakable: body}\n"
        "interfaces: [{tension: 0.5 MPa, cohesion: 1 MPa, friction: 0.4, energy_1: 1 J/m2, "
        "energy_2: 3 J/m2, softening: linear}]\n"
        "contact: {friction: 0.4}\n"
        "gravity: [0, 0, -9.81 m/s2]\n"
        "initial: [{velocity: [0.3 m/s, 0, -3 m/s]}]\n"
        "plates: {floor: {point: [0, 0, -0.1 mm], normal: [0, 0, 1], friction: 0.3}}\n"
        "history_every: 8 us\n",
    [CDEM_SCALING_SPHERES] =
        "end: 0.15 s\n"
        "safety: 0.05\n"
        "history_every: 3 ms\n"
        "gravity: [0, 0, -9.81 m/s2]\n"
        "grains:\n"
        "  dimension: 3\n"
        "  law: mindlin\n"
        "  packing: {kind: loose, low: [0, 0, 0], high: [40 mm, 40 mm, 80 mm], sizes: uniform, "
        "least: 4 mm, most: 6 mm, count: 70, seed: 3}\n"
        "  materials: {glass: {density: 2500 kg/m3, young: 5 MPa, poisson: 0.25}}\n"
        "contacts: [{friction: 0.5, restitution: 0.5}]\n"
        "walls:\n"
        "  floor: {shape: plane, center: [0, 0, 0], normal: [0, 0, 1]}\n"
        "  tube: {shape: cylinder, center: [20 mm, 20 mm, 0], axis: [0, 0, 1], radius: 29 mm, "
        "spin: {z: 3 1/s}}\n"
        "  lid: {shape: plate, center: [20 mm, 20 mm, 60 mm], normal: [0, 0, -1], half_size: [15 "
        "mm, 10 mm], velocity: {z: {pulse: -0.5 m/s, duration: 60 ms, start: 20 ms}}}\n"
        "probes:\n"
        "  mass: {quantity: mass}\n"
        "  bulk: {quantity: stress, component: zz, region: {low: [10 mm, 10 mm, 5 mm], high: [30 "
        "mm, 30 mm, 25 mm]}}\n"
        "results: {weight: {of: walls.fz, take: last, against: probe.mass, against_factor: "
        "-9.81}}\n",
    [CDEM_SCALING_HERTZ] =
        "end: 20 ms\n"
        "history_every: 0.5 ms\n"
        "mass_damping: 20 1/s\n"
        "grains:\n"
        "  dimension: 3\n"
        "  law: hertz\n"
        "  rolling: constant\n"
        "  twisting: spring\n"
        "  packing: {kind: loose, high: [30 mm, 30 mm, 30 mm], radius: 3 mm, fraction: 0.4, seed: "
        "5, compact: {pressure: 20 kPa, friction: 0.1}}\n"
        "  materials: {glass: {density: 2500 kg/m3, young: 50 MPa, poisson: 0.3}}\n"
        "contacts: [{friction: 0.4, restitution: 0.6, rolling_friction: 0.1, twisting_friction: "
        "0.1, twisting_stiffness: 0.5 N m}]\n"
        "cell:\n"
        "  rate: {zz: {ramp: -2 1/s, over: 2 ms}}\n"
        "  stress: {xx: 20 kPa, yy: 20 kPa}\n"
        "  servo_rate: 10 1/s\n",
    [CDEM_SCALING_DISCS] =
        "end: 30 ms\n"
        "history_every: 0.5 ms\n"
        "grains:\n"
        "  dimension: 2\n"
        "  rolling: spring\n"
        "  packing: {kind: inward, high: [20 mm, 40 mm], sizes: uniform, least: 1 mm, most: 1.5 "
        "mm, compact: {pressure: 10 kPa, stiffness: 1e6 N/m, restitution: 0.8}}\n"
        "  materials: {sand: {density: 2600 kg/m3}}\n"
        "contacts: [{normal_stiffness: 1e6 N/m, friction: 0.5, restitution: 0.8, rolling_friction: "
        "0.1, rolling_stiffness: 0.5 N m}]\n"
        "walls:\n"
        "  bottom: {shape: plane, normal: [0, 1]}\n"
        "  top: {shape: plane, normal: [0, -1], velocity: {y: {ramp: -100 mm/s, over: 5 ms}}}\n"
        "  left: {shape: plane, normal: [1, 0]}\n"
        "  right: {shape: plane, normal: [-1, 0], servo: [1, 0], servo_force: 390 N, servo_speed: "
        "0.2 m/s}\n"
        "probes: {ratio: {quantity: stress_ratio}}\n"
        "results: {power: {of: walls, take: slope, reference: 1}}\n",
    [CDEM_SCALING_STATIC] =
        "analysis: static\n"
        "plane: stress\n"
        "gravity: [0, -9.81 m/s2]\n"
        "mesh: {shape: quad4, count: [6, 3], size: [60 mm, 30 mm], distortion: 0.2}\n"
        "materials:\n"
        "  soil: {model: cosserat, young: 500 MPa, poisson: 0.2, cosserat_modulus: 70 MPa, "
        "characteristic_length: 3 mm, density: 2042 kg/m3}\n"
        "supports: [{group: x0, displacement: {x: 0, y: 0, rotation: 0}}]\n"
        "loads:\n"
        "  - {group: x1, force: {y: -2 kN, rotation: 3 N m}}\n"
        "  - {group: y1, pressure: 0.3 MPa}\n"
        "probes: {tip: {group: x1, quantity: displacement, component: y}, stress: {group: body, "
        "quantity: stress, component: xy}}\n",
    [CDEM_SCALING_BONDED] =
        "analysis: relaxation\n"
        "gravity: [0, 0, -9.81 m/s2]\n"
        "grains:\n"
        "  dimension: 3\n"
        "  rolling: spring\n"
        "  twisting: spring\n"
        "  packing: {kind: cubic, high: [60 mm, 60 mm, 60 mm], radius: 5 mm}\n"
        "  materials: {sand: {density: 2600 kg/m3}}\n"
        "contacts: [{normal_stiffness: 1e5 N/m, friction: 0.4, damping_ratio: 0.2, "
        "rolling_friction: 0.1, twisting_friction: 0.1}]\n"
        "walls: {floor: {shape: plane, center: [0, 0, 0], normal: [0, 0, 1]}}\n"
        "bonds: [{normal_stiffness: 1e5 N/m, shear_stiffness: 3e4 N/m, rolling_stiffness: 1 N m, "
        "twisting_stiffness: 1 N m, tension: 0.01 N, cohesion: 0.02 N, damping_ratio: 0.1}]\n",
    [CDEM_SCALING_FOOTING] =
        "end: 3 ms\n"
        "step: 20 us\n"
        "mass_damping: 500 1/s\n"
        "history_every: 0.2 ms\n"
        "mesh: {shape: quad4, count: [6, 4], size: [3 m, 2 m], origin: [-1.5 m, -2 m]}\n"
        "materials:\n"
        "  soil: {model: cosserat, young: 500 MPa, poisson: 0.2, cosserat_modulus: 70 MPa, "
        "characteristic_length: 50 mm, density: 2042 kg/m3}\n"
        "supports:\n"
        "  - {group: y0, displacement: {x: 0, y: 0, rotation: 0}}\n"
        "  - {group: x0, displacement: {x: 0}}\n"
        "  - {group: x1, displacement: {x: 0}}\n"
        "grains:\n"
        "  dimension: 2\n"
        "  law: li-chu\n"
        "  packing: {kind: square, low: [-1.5 m, -2 m], high: [1.5 m, 0], radius: 50 mm, "
        "centres_inside: yes}\n"
        "  materials: {grain: {density: 2600 kg/m3}}\n"
        "contacts:\n"
        "  - {normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, friction: 0.5, "
        "normal_dashpot: 0.4 N s/m, shear_dashpot: 0.4 N s/m, rolling_stiffness: 700 N m, "
        "rolling_dashpot: 0.01 N m s, rolling_length: 0.5 mm, rolling_force_stiffness: 1e6 N/m, "
        "rolling_force_dashpot: 0.4 N s/m, rolling_force_friction: 0.05}\n"
        "walls: {plate: {shape: plate, center: [0, 0], normal: [0, -1], half_size: [0.4 m], "
        "velocity: {y: -1 m/s}}}\n"
        "coupling: {regions: [{low: [-1 m, -1 m], high: [1 m, 0.1 m]}], rotation: scaled, cycles: "
        "10, absorb: 1000 1/s}\n"
        "results: {load: {of: load.plate.fy, take: last, reference: 1e6}}\n",
    [CDEM_SCALING_FDEM] = TUBE("2 ms", "{shape: cubesphere, refinement: 2}"),
    [CDEM_SCALING_EXPLICIT] =
        TUBE("1 ms", "{shape: cubesphere, integration: explicit, damping_ratio: 0.02}"),
    [CDEM_SCALING_TRIAXIAL] = TRIAXIAL(""),
    [CDEM_SCALING_DEFORMED] = TRIAXIAL("  deformable: {shape: cubesphere, refinement: 2}\n"),
};
