/* Group fdem: deformable grains against closed forms and conservation laws; docs/theory/fdem.md has
 * the derivations. */
#include "verify/fdem.h"

#include "verify/verify.h"

#define WANG              "Wang et al. 2024, table 2: all by 15186 grains"
#define LAMB              "Lamb 1882"
#define THEORY            "docs/theory/fdem.md, "
#define HERTZ             "Hertz (Johnson 1985, ch. 4); " THEORY "section 6"
#define LAW               "law penalty, 2 p pi R* d^2; " THEORY "section 6"
#define MEASURE(of, name) .kind = CDEM_CHECK_##of, .measure = cdem_fdem_measure_##name

/* An overlap of one shape. */
#define STIFF(what, which)                                                                         \
  {                                                                                                \
    what " of r: force by that of the facets", LAW, 1, 0.1, MEASURE(CLOSED_FORM, rigid),           \
        .parameter = which                                                                         \
  }

static const cdem_verification checks[] = {
    {"grain of the source: elements", WANG, 80, 0, MEASURE(PUBLISHED, sizes), .parameter = 0},
    {"grain of the source: nodes", WANG, 205, 0, MEASURE(PUBLISHED, sizes), .parameter = 1},
    {"grain of the source: nodes at the surface", "42 corners and 120 edges of 80 faces", 162, 0,
     MEASURE(CLOSED_FORM, sizes), .parameter = 2},
    {"grain of the source: elastic modes", "3 x 205 - 6", 609, 0, MEASURE(CLOSED_FORM, sizes),
     .parameter = 3},
    /* Rounding of modes whose values are four powers of ten apart. */
    {"ball pulled evenly, by modes: error of strain", "sigma/E, -nu sigma/E", 0, 1e-10,
     MEASURE(CLOSED_FORM, strain), .parameter = 2},
    /* Extrapolated from two meshes whose errors e, e' go with h^2: e e' of the value remains; e is
     * 25, 6.6 and 2.9 % of torsion, e' 1.9 and 0.8 % of the other, whose reference has three
     * digits. */
    {"free ball, omega a/c_s of the lowest vibration", LAMB ": torsion of degree 2", 2.501, 0.04,
     MEASURE(CLOSED_FORM, lamb), .parameter = 0},
    {"free ball, omega a/c_s of the lowest vibration, fine", LAMB ": torsion of degree 2", 2.501,
     0.005, MEASURE(CLOSED_FORM, lamb), .parameter = 1, .slow = true},
    {"free ball, omega a/c_s of the lowest spheroidal one", LAMB ": 0.840 pi for nu = 1/4", 2.639,
     0.005, MEASURE(PUBLISHED, lamb), .parameter = 2, .slow = true},
    {"free ball, error of the lowest vibration: half the size by whole", "second order", 0.25, 0.05,
     MEASURE(LAW, lamb), .parameter = 3},
    /* In parts of what 2 (reach - least) r more or less of approach make of Hertz's force: 117, 50,
     * 26 % of it. */
    {"two balls pressed, cubesphere 2: error by that of the facets", HERTZ, 0, 1,
     MEASURE(CLOSED_FORM, hertz), .parameter = 2},
    {"two balls pressed, cubesphere 4: error by that of the facets", HERTZ, 0, 1,
     MEASURE(CLOSED_FORM, hertz), .parameter = 4},
    {"two balls pressed, cubesphere 6: error by that of the facets", HERTZ, 0, 1,
     MEASURE(CLOSED_FORM, hertz), .parameter = 6, .slow = true},
    /* Faces and their error by half and by a quarter; (2/4)^2 and (4/6)^2 of it with some room. */
    {"two balls pressed, error of the force: cubesphere 4 by 2", HERTZ, 0, 0.6, MEASURE(LAW, hertz),
     .parameter = -4},
    {"two balls pressed, error of the force: cubesphere 6 by 4", HERTZ, 0, 0.6, MEASURE(LAW, hertz),
     .parameter = -6, .slow = true},
    /* What is left out: the lens is smaller by d/6r (0.5 to 1.3 %), depths are across the faces
     * (1 to 4 %), a mean of 320 pairs is known to 2 %. */
    STIFF("stiff balls, icosphere 1, 3 %", 0),
    STIFF("stiff balls, icosphere 1, 5 %", 1),
    STIFF("stiff balls, icosphere 1, 8 %", 2),
    STIFF("stiff balls, tetrasphere 2, 3 %", 10),
    STIFF("stiff balls, tetrasphere 2, 5 %", 11),
    STIFF("stiff balls, tetrasphere 2, 8 %", 12),
    STIFF("stiff balls, cubesphere 4, 3 %", 20),
    STIFF("stiff balls, cubesphere 4, 5 %", 21),
    STIFF("stiff balls, cubesphere 4, 8 %", 22),
    /* Half the size: a fourth of what the facets add to d in (d + x)^2, less for the square of it.
     */
    {"stiff balls, 3 % of r, error: tetrasphere 2 by 1", LAW, 0.2, 0.08, MEASURE(LAW, rigid),
     .parameter = 30},
    {"stiff balls, 5 % of r, error: tetrasphere 2 by 1", LAW, 0.2, 0.08, MEASURE(LAW, rigid),
     .parameter = 31},
    {"stiff balls, 8 % of r, error: tetrasphere 2 by 1", LAW, 0.2, 0.08, MEASURE(LAW, rigid),
     .parameter = 32},
    /* Of second order in steps of a tenth of the stable one, which the contact resolves. */
    {"ball that bounces: energy it leaves with by that before", "conservation of energy", 1, 1e-4,
     MEASURE(LAW, bounce), .parameter = 0},
    {"ball that bounces, friction and dashpots: error of the book", "work and energy", 0, 1e-4,
     MEASURE(LAW, bounce), .parameter = 1},
    {"ball that bounces, implicit: error of the book", "work and energy", 0, 1e-4,
     MEASURE(LAW, bounce), .parameter = 2},
    /* 1/16 would be second order throughout; nodes begin to touch anywhere in a step. */
    {"ball that bounces, error of the book: a fourth of the step by whole", "second order", 0, 0.2,
     MEASURE(LAW, bounce), .parameter = 3},
    /* A polyhedron: rolling goes by steps of its faces, of 1 % of the height each. */
    {"ball down a slope: acceleration by g sin/(1 + I/m r^2)", THEORY "section 6", 1, 0.05,
     MEASURE(CLOSED_FORM, roll), .parameter = 0},
    {"ball down a slope: radius times spin by speed", "no slip", 1, 0.05, MEASURE(LAW, roll),
     .parameter = 1},
    {"box that tumbles: momentum lost", "Newton", 0, 1e-12, MEASURE(LAW, spin), .parameter = 0},
    {"box that tumbles: angular momentum lost", "Newton", 0, 1e-11, MEASURE(LAW, spin),
     .parameter = 1},
    {"box that tumbles, error of energy: half the step by whole", "second order", 0.25, 0.01,
     MEASURE(LAW, spin), .parameter = 2},
    {"cloud of balls: momentum lost", "Newton", 0, 1e-13, MEASURE(LAW, cloud), .parameter = 0},
    {"cloud of balls: angular momentum lost", "Newton", 0, 1e-12, MEASURE(LAW, cloud),
     .parameter = 1},
    {"cloud of balls: error of the energy book", "work and energy", 0, 1e-3, MEASURE(LAW, cloud),
     .parameter = 2},
    {"cloud of balls: numbers that differ between one thread and two", "same bits", 0, 0,
     MEASURE(SAME_BITS, cloud), .parameter = 3},
};

const cdem_verify_group cdem_verify_fdem = {
    .name = "fdem",
    .summary = "deformable grains: modes, contact, balances",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
