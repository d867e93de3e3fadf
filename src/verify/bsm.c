/* Group bsm: grains inside a continuum. First the coarse medium alone, against Cosserat elasticity;
 * docs/theory/cosserat.md has the derivations. */
#include "verify/bsm.h"

#include "verify/verify.h"

#define THEORY    "docs/theory/cosserat.md, "
#define PATCH     "Providas & Kattis 2002"
#define PROJECTOR "Li & Wan 2010, eqs 3-8"
#define SOLID     "docs/theory/bsm-solid.md, "
#define HOLE      "Kaloni & Ariman 1967, Eringen 1968"

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
    /* Spheres in bricks: identities to rounding. */
    {"projector in space: P P = P", PROJECTOR, 0, 1e-12, MEASURE(solid_identity), .parameter = 0},
    {"projector in space: Q N = 0", PROJECTOR, 0, 1e-12, MEASURE(solid_identity), .parameter = 1},
    {"projector in space: N^T Mp Q = 0", PROJECTOR, 0, 1e-12, MEASURE(solid_identity),
     .parameter = 2},
    {"projector in space: kinetic energy splits", PROJECTOR, 0, 1e-12, MEASURE(solid_identity),
     .parameter = 3},
    {"projector in space: linear fields are reproduced", PROJECTOR, 0, 1e-12,
     MEASURE(solid_identity), .parameter = 4},
    {"cubic lattice: c11 over kn/(2 r)", SOLID "eq. (4)", 1, 1e-3, MEASURE(solid_lattice),
     .parameter = 0},
    {"cubic lattice: c12 over kn/(2 r)", SOLID "eq. (4)", 0, 1e-3, MEASURE(solid_lattice),
     .parameter = 1},
    {"cubic lattice: c44 over ks/(4 r), spins free", SOLID "eq. (6)", 1, 1e-3,
     MEASURE(solid_lattice), .parameter = 2},
    {"patch in space, pulled, h = 12 r", SOLID "eq. (9)", 1.0 / 12.0, 1e-4, MEASURE(solid_patch),
     .parameter = 60},
    {"patch in space, sheared, h = 12 r", SOLID "eq. (10)", 1.0 / 24.0, 1e-4, MEASURE(solid_patch),
     .parameter = 61},
    {"patch in space, turned, h = 12 r", SOLID "eq. (3)", 0, 1e-4, MEASURE(solid_patch),
     .parameter = 62},
    {"patch in space, pulled, h = 24 r", "bound of 5 %", 0, 0.05, MEASURE(solid_patch),
     .parameter = 120},
    {"patch in space, sheared, h = 24 r", "bound of 5 %", 0, 0.05, MEASURE(solid_patch),
     .parameter = 121},
};

const cdem_verify_group cdem_verify_bsm = {
    .name = "bsm",
    .summary = "grains inside a continuum: the Cosserat medium around them",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
