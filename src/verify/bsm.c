/* Group bsm: grains inside a continuum. First the coarse medium alone, against Cosserat elasticity;
 * docs/theory/cosserat.md has the derivations. */
#include "verify/bsm.h"

#include "verify/verify.h"

#define THEORY "docs/theory/cosserat.md, "
#define WAVES  "docs/theory/bsm-waves.md, "
#define PATCH  "Providas & Kattis 2002"
#define HOLE   "Kaloni & Ariman 1967, Eringen 1968"

#define MEASURE(name) .measure = cdem_bsm_measure_##name

static const cdem_verification checks[] = {
    /* Patch tests on distorted meshes: rounding. */
    {"patch of quad4-cosserat: turned with its spin", PATCH, 0, 1e-12, MEASURE(cosserat_patch),
     .parameter = 0},
    {"patch of quad4-cosserat: asymmetric shear under couples", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 1},
    {"patch of quad4-cosserat: linear rotation under forces and couples", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 2},
    {"patch of tri3-cosserat: turned with its spin", PATCH, 0, 1e-12, MEASURE(cosserat_patch),
     .parameter = 10},
    {"patch of tri3-cosserat: asymmetric shear under couples", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 11},
    {"patch of tri3-cosserat: linear rotation under forces and couples", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 12},
    {"patch of quad4-cosserat, lattice of discs: linear rotation", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 102},
    {"patch of tri3-cosserat, lattice of discs: linear rotation", PATCH, 0, 1e-12,
     MEASURE(cosserat_patch), .parameter = 112},
    /* Hole in tension, R/l = 1.063, nu = 0.3: the printed digits, then the solver. */
    {"hole in a Cosserat plate, N = 0.25: closed form", HOLE, 2.8493, 5e-5, MEASURE(hole_closed),
     .parameter = 0},
    {"hole in a Cosserat plate, N = 0.5: closed form", HOLE, 2.5548, 5e-5, MEASURE(hole_closed),
     .parameter = 1},
    {"hole in a Cosserat plate, N = 0.75: closed form", HOLE, 2.2866, 5e-5, MEASURE(hole_closed),
     .parameter = 2},
    {"hole in a Cosserat plate, N = 0.9: closed form", HOLE, 2.1579, 5e-5, MEASURE(hole_closed),
     .parameter = 3},
    {"hole in a Cosserat plate, N = 0.001: closed form", "Kirsch 1898", 3, 1e-5,
     MEASURE(hole_closed), .parameter = 4},
    {"hole in a Cosserat plate, N = 0.25: factor over the closed form", THEORY "eq. (23)", 1, 0.01,
     MEASURE(hole), .parameter = 0},
    {"hole in a Cosserat plate, N = 0.5: factor over the closed form", THEORY "eq. (23)", 1, 0.01,
     MEASURE(hole), .parameter = 1},
    {"hole in a Cosserat plate, N = 0.75: factor over the closed form", THEORY "eq. (23)", 1, 0.01,
     MEASURE(hole), .parameter = 2},
    {"hole in a Cosserat plate, N = 0.9: factor over the closed form", THEORY "eq. (23)", 1, 0.01,
     MEASURE(hole), .parameter = 3},
    /* As for the classical plate: corner strains at a free edge, first order. */
    {"hole in a Cosserat plate, N = 0.5: order of the factor's error", THEORY "eq. (23)", 1, 0.3,
     MEASURE(hole), .parameter = 11},
    {"hole in a Cosserat plate, N = 0.5: order of the rotations' error", THEORY "eq. (21)", 2, 0.1,
     MEASURE(hole), .parameter = 31},
    {"hole in a Cosserat plate, N = 0.9: order of the factor's error", THEORY "eq. (23)", 1, 0.3,
     MEASURE(hole), .parameter = 13, .slow = true},
    {"hole in a Cosserat plate, N = 0.25, finer: factor over the closed form", THEORY "eq. (23)", 1,
     0.006, MEASURE(hole), .parameter = 20, .slow = true},
    {"hole in a Cosserat plate, N = 0.9, finer: factor over the closed form", THEORY "eq. (23)", 1,
     0.003, MEASURE(hole), .parameter = 23, .slow = true},
    /* Waves through the interface: the derived reflection, then the solvers' own. What is left of
     * the measured ones comes from the end of the record and is largest next to the cutoff. */
    {"interface, long waves: |R| over k a/4 (1 - a/(2 h))", WAVES "eq. (15)", 1, 1e-4,
     MEASURE(waves_derived), .parameter = 0},
    {"interface, 2 b - b^2/h = a/2: |R| over k a of long waves", WAVES "eq. (14)", 0, 1e-3,
     MEASURE(waves_derived), .parameter = 1},
    {"interface beyond the cutoff: |R| - 1", WAVES "eq. (9)", 0, 1e-12, MEASURE(waves_derived),
     .parameter = 2},
    {"interface beyond the cutoff, m = 10 at the velocity of the step: |R| - 1", WAVES "eq. (11)",
     0, 1e-12, MEASURE(waves_derived), .parameter = 7},
    {"interface: energy that comes back and that goes on", "energy", 0, 1e-12,
     MEASURE(waves_derived), .parameter = 3},
    {"absorbing layer of 1 element, k h > 4: energy that comes back", WAVES "section 7", 0, 0.1,
     MEASURE(waves_derived), .parameter = 4},
    {"absorbing layer of 2 elements, k h > 5: energy that comes back", WAVES "section 7", 0, 0.1,
     MEASURE(waves_derived), .parameter = 5},
    {"absorbing layer of 2 elements, k h < 0.5: energy that is lost", WAVES "section 7", 0, 1e-3,
     MEASURE(waves_derived), .parameter = 6},
    {"waves, h = 5 a: measured |R| less the derived", WAVES "eqs. (5)-(9)", 0, 5e-3, MEASURE(waves),
     .parameter = 0},
    {"waves, h = 5 a, virtual work: measured |R| less the derived", WAVES "eq. (16)", 0, 5e-3,
     MEASURE(waves), .parameter = 1},
    {"waves, h = 5 a, layer of 1 element: measured |R| less the derived", WAVES "eq. (17)", 0, 8e-3,
     MEASURE(waves), .parameter = 2},
    {"waves, h = 5 a, beyond the cutoff: energy that enters the body", "energy", 0, 1e-6,
     MEASURE(waves_energy), .parameter = 0},
    {"waves, h = 5 a: books of body, grains and exchange", "energy", 0, 1e-6, MEASURE(waves_energy),
     .parameter = 1, .slow = true},
    {"waves, h = 10 a: measured |R| less the derived", WAVES "eqs. (5)-(9)", 0, 3e-3,
     MEASURE(waves), .parameter = 3, .slow = true},
    {"waves, h = 23 a: measured |R| less the derived", WAVES "eqs. (5)-(9)", 0, 5e-3,
     MEASURE(waves), .parameter = 4, .slow = true},
    {"waves, h = 5 a, m = 10: measured |R| less the derived", WAVES "eqs. (10), (12), (13)", 0,
     5e-3, MEASURE(waves), .parameter = 5, .slow = true},
    {"waves, h = 10 a, layer of 2 elements: measured |R| less the derived", WAVES "eq. (17)", 0,
     3e-3, MEASURE(waves), .parameter = 6, .slow = true},
    {"waves, h = 5 a, b = a/4: measured |R| less the derived", WAVES "eqs. (5)-(9)", 0, 5e-3,
     MEASURE(waves), .parameter = 7, .slow = true},
    {"waves, h = 10 a, k a = 2: measured |R| less the derived", WAVES "eqs. (5)-(9)", 0, 1e-3,
     MEASURE(waves), .parameter = 8, .slow = true},
};

const cdem_verify_group cdem_verify_bsm = {
    .name = "bsm",
    .summary =
        "grains inside a continuum: the Cosserat medium around them, waves through the interface",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
