/* A loose heap of discs that falls into a box, for the tests of runs of grains. */
#ifndef CDEM_TESTS_RUN_GRAINS_BOX_H
#define CDEM_TESTS_RUN_GRAINS_BOX_H

#include "run/support.h"

#define BOX                                                                                        \
  "end: 0.1 s\n"                                                                                   \
  "gravity: [0, -10]\n"                                                                            \
  "grains:\n"                                                                                      \
  "  dimension: 2\n"                                                                               \
  "  packing: {kind: loose, low: [0, 0], high: [0.2, 0.2], sizes: uniform, least: 4 mm,\n"         \
  "            most: 6 mm, fraction: 0.4, seed: 5}\n"                                              \
  "  materials: {sand: {density: 2000 kg/m3}, steel: {}}\n"                                        \
  "contacts:\n"                                                                                    \
  "  - {between: [sand, steel], normal_stiffness: 2e6 N/m, shear_ratio: 0.5, friction: 0.1, "      \
  "restitution: 0.5}\n"                                                                            \
  "  - {normal_stiffness: 1e6 N/m, shear_ratio: 0.5, friction: 0.4, restitution: 0.5}\n"           \
  "walls:\n"                                                                                       \
  "  floor: {shape: plane, material: steel, center: [0, 0], normal: [0, 1]}\n"                     \
  "  left: {shape: plane, material: steel, center: [0, 0], normal: [1, 0]}\n"                      \
  "  right: {shape: plane, material: steel, center: [0.2, 0], normal: [-1, 0]}\n"                  \
  "probes:\n"                                                                                      \
  "  mass: {quantity: mass}\n"                                                                     \
  "  falling: {quantity: velocity, component: y}\n"                                                \
  "results:\n"                                                                                     \
  "  floor: {of: wall.floor.fy, take: last}\n"                                                     \
  "  all: {of: walls.fy, take: last}\n"                                                            \
  "  sides: {of: walls.fx, take: last}\n"                                                          \
  "  mass: {of: mass, take: last}\n"                                                               \
  "  error: {of: energy_error, take: max}\n"                                                       \
  "  overlap: {of: overlap, take: max}\n"                                                          \
  "  fastest: {of: falling, take: min}\n"

static inline cdem_run_summary run_ok(const char *name, const char *folder, int overrides,
                                      const char *const *override) {
  cdem_fault fault = {0};
  cdem_run_summary summary;
  check_ok(run_case(name, folder, overrides, override, &summary, &fault));
  return summary;
}

#endif
