/* What the tests of room cases share: case files in a scratch folder. */
#ifndef CDEM_TESTS_CASES_SUPPORT_H
#define CDEM_TESTS_CASES_SUPPORT_H

#include "io/case_file.h"
#include "support/scratch.h"

static inline void write_bytes(const char *text, size_t bytes) {
  FILE *file = fopen(in_scratch("c.yaml"), "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, bytes, file), bytes);
  assert_int_equal(fclose(file), 0);
}

static inline cdem_status read_with(const char *text, int overrides, const char *const *override,
                                    cdem_case *read, cdem_fault *fault) {
  write_bytes(text, strlen(text));
  return cdem_read_case(in_scratch("c.yaml"), overrides, override, read, fault);
}

static inline cdem_status read_text(const char *text, cdem_case *read, cdem_fault *fault) {
  return read_with(text, 0, NULL, read, fault);
}

/* The smallest dynamic case; more keys may follow it. */
#define ROCK                                                                                       \
  "end: 1 ms\n"                                                                                    \
  "mesh: rock.geo\n"                                                                               \
  "materials:\n"                                                                                   \
  "  rock: {young: 30 GPa, poisson: 0.3, density: 2700 kg/m3}\n"

/* Every section and nearly every key. */
#define FULL                                                                                       \
  "title: Everything\n"                                                                            \
  "analysis: dynamic\n"                                                                            \
  "plane: stress\n"                                                                                \
  "thickness: 50 mm\n"                                                                             \
  "end: 10 ms\n"                                                                                   \
  "safety: 0.5\n"                                                                                  \
  "mass_damping: 200 1/s\n"                                                                        \
  "local_damping: 0.1\n"                                                                           \
  "gravity: [0, -9.81 m/s2]\n"                                                                     \
  "quiet: [left, right]\n"                                                                         \
  "history_every: 10 us\n"                                                                         \
  "frame_every: 0.5 ms\n"                                                                          \
  "checkpoint_every: 1 ms\n"                                                                       \
  "stop_when: top_force\n"                                                                         \
  "stop_below: 30 %\n"                                                                             \
  "mesh:\n"                                                                                        \
  "  file: plate.geo\n"                                                                            \
  "  parameters: {h: 0.005, holes: 2}\n"                                                           \
  "  unit: 1 mm\n"                                                                                 \
  "materials:\n"                                                                                   \
  "  rock: {young: 30 GPa, poisson: 0.3, density: 2.7 g/cm3}\n"                                    \
  "  shale:\n"                                                                                     \
  "    model: orthotropic\n"                                                                       \
  "    e1: 20 GPa\n"                                                                               \
  "    e2: 10 GPa\n"                                                                               \
  "    e3: 20 GPa\n"                                                                               \
  "    nu12: 0.2\n"                                                                                \
  "    nu13: 0.2\n"                                                                                \
  "    nu23: 0.1\n"                                                                                \
  "    g12: 5 GPa\n"                                                                               \
  "    g13: 8 GPa\n"                                                                               \
  "    g23: 5 GPa\n"                                                                               \
  "    axis1: [1, 1, 0]\n"                                                                         \
  "    axis2: [-1, 1, 0]\n"                                                                        \
  "    density: 2500\n"                                                                            \
  "    groups: [lower, upper]\n"                                                                   \
  "blocks: {breakable: rock, separate: [slab], joints: [fault]}\n"                                 \
  "interfaces:\n"                                                                                  \
  "  - joint: fault\n"                                                                             \
  "    friction: 0.4\n"                                                                            \
  "  - between: [rock, rock]\n"                                                                    \
  "    insertion: tied\n"                                                                          \
  "    stiffness_factor: 50\n"                                                                     \
  "    shear_ratio: 0.4\n"                                                                         \
  "    tension: 1 MPa\n"                                                                           \
  "    cohesion: 3 MPa\n"                                                                          \
  "    friction: 0.3\n"                                                                            \
  "    dilation: 0.05\n"                                                                           \
  "    softening: linear\n"                                                                        \
  "    unloading: origin\n"                                                                        \
  "    energy_1: 10 J/m2\n"                                                                        \
  "    energy_2: 50 N/m\n"                                                                         \
  "contact: {normal_stiffness: 1e3 GPa/m, friction: 0.5, damping: 0.1, skin: 1 mm}\n"              \
  "supports:\n"                                                                                    \
  "  - {group: bottom, displacement: {x: 0, y: {ramp: -1 mm, over: 10 ms}}}\n"                     \
  "  - {group: top, velocity: {y: {table: [[0 s, 0 m/s], [1 ms, -20 mm/s]]}}}\n"                   \
  "loads:\n"                                                                                       \
  "  - {group: side, force: {x: {sine: 1 kN, frequency: 50 Hz, phase: 90 degree}}}\n"              \
  "  - {group: edge, traction: {y: 2 MPa}}\n"                                                      \
  "  - {group: hole, pressure: {pulse: 3 MPa, duration: 1 ms, start: 2 ms, offset: 1 kPa}}\n"      \
  "  - {group: rim, kirsch_tension: 1 MPa, kirsch_radius: 10 mm, kirsch_center: [1 mm, 2 mm]}\n"   \
  "plates:\n"                                                                                      \
  "  press: {point: [0, 0.1], normal: [0, -2], axis: [1, 0], half_size: [8 mm],\n"                 \
  "          velocity: {y: -20 mm/s}, friction: 0.2}\n"                                            \
  "initial:\n"                                                                                     \
  "  - {groups: ball, velocity: [10 km/s, 0], spin: [0, 0, 5 rad/s], center: [1 m, 2 m, 0]}\n"     \
  "probes:\n"                                                                                      \
  "  tip: {group: tip, component: y}\n"                                                            \
  "  mean_stress: {group: rock, quantity: stress, component: xx}\n"                                \
  "curves:\n"                                                                                      \
  "  load: {title: Load, x: tip, y: [top_force], y_scale: -1e-3, y_label: 'load, kN'}\n"           \
  "results:\n"                                                                                     \
  "  peak: {of: top_force, take: min, factor: -1, reference: 157.1e3, tolerance: 5 %}\n"

#endif
