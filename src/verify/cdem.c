/* Group cdem: the solver against closed forms and conservation laws; docs/theory/cdem.md has the
 * derivations. What needs another program (CalculiX) or a whole run (Brazilian disc, notched beam)
 * is a test of the cases, tests/cli. */
#include "verify/cdem.h"

#include "verify/verify.h"

#define THEORY "docs/theory/cdem.md, "

#define MEASURE(of, name) .kind = CDEM_CHECK_##of, .measure = cdem_cdem_measure_##name

static const cdem_verification checks[] = {
    /* Elements in rotating frames. Rounding: positions of 1 m have 1e-16 of strain. */
    {"quad4 turned by 90 degrees: force", THEORY "eq. (2)", 0, 1e-12, MEASURE(LAW, turned),
     .parameter = 0},
    {"tri3 turned by 90 degrees: force", THEORY "eq. (2)", 0, 1e-12, MEASURE(LAW, turned),
     .parameter = 1},
    {"hex8 turned by 90 degrees: force", THEORY "eq. (2)", 0, 1e-12, MEASURE(LAW, turned),
     .parameter = 2},
    {"tet4 turned by 90 degrees: force", THEORY "eq. (2)", 0, 1e-12, MEASURE(LAW, turned),
     .parameter = 3},
    {"spinning plane block: drift of momentum", THEORY "eq. (6)", 0, 1e-12, MEASURE(LAW, spinning),
     .parameter = 0},
    {"spinning plane block: drift of angular momentum", THEORY "eq. (6)", 0, 1e-12,
     MEASURE(LAW, spinning), .parameter = 1},
    {"spinning plane block: energy book", THEORY "eqs. (6), (9)", 0, 1e-3, MEASURE(LAW, spinning),
     .parameter = 2},
    {"spinning plane block: order of the energy book in the step", THEORY "section 3", 2, 0.3,
     MEASURE(LAW, spinning), .parameter = 3},
    {"spinning solid block: drift of momentum", THEORY "eq. (6)", 0, 1e-12, MEASURE(LAW, spinning),
     .parameter = 4},
    {"spinning solid block: drift of angular momentum", THEORY "eq. (6)", 0, 1e-12,
     MEASURE(LAW, spinning), .parameter = 5},
    {"spinning solid block: energy book", THEORY "eqs. (6), (9)", 0, 1e-3, MEASURE(LAW, spinning),
     .parameter = 6},
    {"spinning solid block: order of the energy book in the step", THEORY "section 3", 2, 0.3,
     MEASURE(LAW, spinning), .parameter = 7},
    /* Waves. */
    {"pulse in a bar: order of the error", "d'Alembert", 2, 0.1, MEASURE(LAW, pulse_order),
     .parameter = 0},
    {"pulse between rollers: order of the error", "d'Alembert", 2, 0.1, MEASURE(LAW, pulse_order),
     .parameter = 1},
    {"pulse in a bar: speed over sqrt(E/rho)", "d'Alembert", 1, 1e-3,
     MEASURE(CLOSED_FORM, pulse_speed), .parameter = 0},
    {"pulse between rollers: speed over sqrt((lambda + 2G)/rho)", "d'Alembert", 1, 1e-3,
     MEASURE(CLOSED_FORM, pulse_speed), .parameter = 1},
    {"sudden load on a bar: speed of the front", "d'Alembert", 1, 1e-2, MEASURE(CLOSED_FORM, front),
     .parameter = 0},
    {"sudden load on a bar: plateau", "d'Alembert: p/(rho c)", 1, 1e-2, MEASURE(CLOSED_FORM, front),
     .parameter = 1},

    {"sudden load on a bar: order of the L1 error", THEORY "section 3", 0.5, 0.15,
     MEASURE(LAW, front), .parameter = 2},
    {"pulse into a quiet end: energy that comes back", "Lysmer & Kuhlemeyer 1969", 0, 1e-3,
     MEASURE(CLOSED_FORM, quiet)},
    /* Statics. */
    {"hole in a plate: factor at the crown", "Kirsch 1898", 3, 0.03, MEASURE(CLOSED_FORM, kirsch),
     .parameter = 0},
    /* Corner strains of bilinear elements are of first order; nothing averages at a free edge. */
    {"hole in a plate: order of the factor's error", "Kirsch 1898", 1, 0.3, MEASURE(LAW, kirsch),
     .parameter = 1},
    {"interfaces at factor 10: uniaxial stiffness", THEORY "eq. (14), 9 faces on 10 cells",
     1.0 / (1.0 + 0.09), 1e-9, MEASURE(CLOSED_FORM, softened), .parameter = 0},
    {"specimen, interfaces at factor 100: slope, GPa", "E/(1 - nu^2)", 30.0 / 0.91,
     0.01 * 30.0 / 0.91, MEASURE(CLOSED_FORM, softened), .parameter = 1},
    {"specimen, tied faces: slope, GPa", "E/(1 - nu^2)", 30.0 / 0.91, 1e-8,
     MEASURE(CLOSED_FORM, softened), .parameter = 2},
    /* Breaking. Peaks are sampled once a step: a step's opening is about 1e-3 of the elastic one.
     */
    {"interface pulled: peak over sigma_t A", THEORY "eq. (12)", 1, 1e-3,
     MEASURE(CLOSED_FORM, parting), .parameter = 0},
    {"interface pulled: energy over G_I A", THEORY "eqs. (11)-(13)", 1, 1e-3,
     MEASURE(CLOSED_FORM, parting), .parameter = 1},
    {"interface sheared after the pull: friction", THEORY "eq. (12)", 0.3, 3e-4,
     MEASURE(CLOSED_FORM, parting), .parameter = 2},
    {"interface sheared: peak over (c + sigma tan phi) A", THEORY "eq. (12)", 1, 1e-3,
     MEASURE(CLOSED_FORM, parting), .parameter = 3},
    {"interface sheared: energy over G_II A", THEORY "eqs. (11)-(13)", 1, 1e-3,
     MEASURE(CLOSED_FORM, parting), .parameter = 4},
    {"compressed specimen: peak, Pa", THEORY "eq. (17)", 8.0642e6, 0.02 * 8.0642e6,
     MEASURE(CLOSED_FORM, mohr_coulomb), .parameter = 0, .slow = true},
    {"compressed specimen, tied faces: peak, Pa", THEORY "eq. (17)", 8.0642e6, 0.02 * 8.0642e6,
     MEASURE(CLOSED_FORM, mohr_coulomb), .parameter = 1, .slow = true},
    /* Contact. */
    {"block sliding down a slope: distance to the stop", "Newmark 1965", 1, 1e-3,
     MEASURE(CLOSED_FORM, sliding), .parameter = 0},
    {"block 0.1 % below tan phi: speed over that above it", "Coulomb", 0, 1e-3,
     MEASURE(LAW, sliding), .parameter = 1},
    /* The margin is a thousandth of the friction; 1e-3 of the friction would be all of it. */
    {"block 0.1 % above tan phi: final speed", "Coulomb", 1, 0.02, MEASURE(CLOSED_FORM, sliding),
     .parameter = 2},
    {"two bars: momentum", "Newton", 0, 1e-12, MEASURE(LAW, bars), .parameter = 0},
    {"two bars: energy book", "docs/theory/cdem.md, eq. (9)", 0, 1e-3, MEASURE(LAW, bars),
     .parameter = 1},
    {"bar of half length strikes: its last speed", THEORY "section 6", 0, 0.01,
     MEASURE(CLOSED_FORM, bars), .parameter = 2},
    {"stack at rest: drift in 1e5 steps, over a brick", "rest", 0, 1e-9, MEASURE(LAW, stack),
     .parameter = 0, .slow = true},
    {"stack at rest: force on the floor over its weight", "equilibrium", 1, 1e-6,
     MEASURE(LAW, stack), .parameter = 1, .slow = true},
};

const cdem_verify_group cdem_verify_cdem = {
    .name = "cdem",
    .summary = "blocks, interfaces, contact: closed forms, conservation, orders of convergence",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
