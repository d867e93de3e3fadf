/* Group bsm: grains inside a continuum. First the coarse medium alone, against Cosserat elasticity;
 * docs/theory/cosserat.md has the derivations. */
#include "verify/bsm.h"

#include "verify/verify.h"

#define THEORY "docs/theory/cosserat.md, "
#define SOURCE "Li & Wan 2010, "
#define BSM    "docs/theory/bsm.md, "
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
    /* The projector. */
    {"foundation, r = 0.05 m: grains in the fine region", SOURCE "section 3", 2426, 0,
     MEASURE(counts), .parameter = 0},
    {"foundation, r = 0.03 m: grains in the fine region", SOURCE "section 3", 6765, 0,
     MEASURE(counts), .parameter = 1},
    {"projector: P P - P", SOURCE "eq. (4)", 0, 1e-12, MEASURE(identity), .parameter = 0},
    {"projector: Q N", SOURCE "eq. (7)", 0, 1e-12, MEASURE(identity), .parameter = 1},
    {"projector: N^T Mp Q", SOURCE "eq. (12)", 0, 1e-12, MEASURE(identity), .parameter = 2},
    {"projector: split of the kinetic energy", SOURCE "eq. (13)", 0, 1e-12, MEASURE(identity),
     .parameter = 3},
    {"projector: linear fields", SOURCE "eq. (3)", 0, 1e-12, MEASURE(identity), .parameter = 4},
    /* Reactions act where interface grains are, half a spacing beyond the edge: about r/(sqrt(2) h)
     * is left over. */
    {"homogeneous strain, form interface, h = 1 m: residual at the edge", BSM "section 4", 0, 0.05,
     MEASURE(patch), .parameter = 0},
    {"homogeneous strain, form interface, h = 0.5 m: residual at the edge", BSM "section 4", 0,
     0.09, MEASURE(patch), .parameter = 1},
    {"homogeneous strain, form virtual work, h = 1 m: residual at the edge", BSM "section 4", 0,
     0.05, MEASURE(patch), .parameter = 10},
    {"homogeneous strain, form virtual work, h = 0.5 m: residual at the edge", BSM "section 4", 0,
     0.09, MEASURE(patch), .parameter = 11},
};

const cdem_verify_group cdem_verify_bsm = {
    .name = "bsm",
    .summary = "grains inside a continuum: the Cosserat medium around them, projector, coupling",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
