/* Deformable balls thrown at each other and at the walls of a tube; how long and what is written is
 * for each test to say in front. */
#ifndef CDEM_TESTS_RUN_DEFORMABLE_TUBE_H
#define CDEM_TESTS_RUN_DEFORMABLE_TUBE_H

#define DEFORMABLE_TUBE                                                                            \
  "gravity: [0, 0, -10]\n"                                                                         \
  "grains:\n"                                                                                      \
  "  dimension: 3\n"                                                                               \
  "  law: penalty\n"                                                                               \
  "  deformable: {shape: cubesphere, refinement: 2}\n"                                             \
  "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.15], radius: " \
  "20 mm, count: 24}\n"                                                                            \
  "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"                      \
  "contacts: [{penalty_stiffness: 1e11 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"                \
  "walls:\n"                                                                                       \
  "  floor: {shape: plane, normal: [0, 0, 1]}\n"                                                   \
  "  tube: {shape: cylinder, radius: 100 mm, center: [0, 0, 0], axis: [0, 0, 1]}\n"                \
  "  lid: {shape: plane, normal: [0, 0, -1], center: [0, 0, 0.15], velocity: {z: -50 m/s}}\n"

#endif
