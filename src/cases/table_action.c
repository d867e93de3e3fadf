/* Keys of what acts on a body and of what is kept of a run. */
#include "cases/tables.h"

/* ---- supports ---- */

#define SUPPORT(member) AT(cdem_case_support, member)
static const cdem_case_key supports[] = {
    {SUPPORT(group), .kind = CDEM_KEY_TEXT, .required = true,
     .help = "Group whose nodes are held or moved.", .example = "bottom"},
    {SUPPORT(displacement), .kind = CDEM_KEY_COMPONENTS, .dimension = LENGTH, .rotates = true,
     .rotation = RATIO, DOMAIN, .otherwise = "free",
     .help = "Prescribed displacement: x, y, z, rotation (rad, Cosserat) to functions of time.",
     .example = "{x: 0, y: {ramp: -1 mm, over: 10 ms}}"},
    {SUPPORT(velocity), .kind = CDEM_KEY_COMPONENTS, .dimension = VELOCITY, .rotates = true,
     .rotation = RATE, DOMAIN, .otherwise = "free",
     .help = "Prescribed velocity: x, y, z, rotation (rad/s, Cosserat) to functions of time.",
     .example = "{y: -20 mm/s}"},
};
const cdem_case_section cdem_section_supports =
    SECTION("supports", cdem_case_support, supports,
            .help = "Prescribed motion of the nodes of one group.");

/* ---- loads ---- */

#define LOAD(member) AT(cdem_case_load, member)
static const cdem_case_key loads[] = {
    {LOAD(group), .kind = CDEM_KEY_TEXT, .required = true,
     .help = "Group on which the load acts: points, or faces (2-D: edges).", .example = "top"},
    {LOAD(force), .kind = CDEM_KEY_COMPONENTS, .dimension = FORCE, .rotates = true,
     .rotation = MOMENT, DOMAIN, .otherwise = "none",
     .help = "Total force on the group, spread by area (points: evenly), fixed in direction; "
             "rotation is a moment (Cosserat).",
     .example = "{y: {ramp: -10 kN, over: 2 ms}}"},
    {LOAD(traction), .kind = CDEM_KEY_COMPONENTS, .dimension = PRESSURE, DOMAIN,
     .otherwise = "none", .help = "Force per area of the undeformed surface, fixed in direction.",
     .example = "{x: 1 MPa}"},
    {LOAD(pressure), .kind = CDEM_KEY_SERIES, .dimension = PRESSURE,
     .given = offsetof(cdem_case_load, has_pressure), DOMAIN, .otherwise = "none",
     .help = "Pressure that follows the surface; positive pushes into the body.",
     .example = "{table: [[0 s, 0 MPa], [1 ms, 2 MPa]]}"},
    {LOAD(kirsch_tension), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, .fallback = NAN, DOMAIN,
     .otherwise = "none",
     .help =
         "Exact tractions of Kirsch's solution: tension along x of an endless plate with a hole.",
     .example = "1 MPa"},
    {LOAD(kirsch_radius), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "required by kirsch_tension",
     .help = "Radius of the hole of Kirsch's solution.", .example = "10 mm"},
    {LOAD(kirsch_center), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     DOMAIN, .help = "Centre of the hole of Kirsch's solution.", .example = "[0, 0]"},
};
const cdem_case_section cdem_section_loads = SECTION(
    "loads", cdem_case_load, loads,
    .help = "One load on one group: exactly one of force, traction, pressure, kirsch_tension.");

/* ---- plates ---- */

#define PLATE(member) AT(cdem_case_plate, member)
static const cdem_case_key plates[] = {
    {PLATE(point), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "A point of the plate's face; the middle of a finite plate.",
     .example = "[0, 100 mm]"},
    {PLATE(normal), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2, .required = true,
     .help = "Direction out of the plate towards the body; any length.", .example = "[0, -1]"},
    {PLATE(axis), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2,
     .otherwise = "automatic: any direction in the face",
     .help = "Direction in the face along which half_size[0] is measured.", .example = "[1, 0]"},
    {PLATE(half_size), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 2, .fewest = 1,
     NOT_NEGATIVE, DOMAIN, .otherwise = "endless",
     .help = "Half of the plate's length along axis, and across it; 0 is endless.",
     .example = "[8 mm]"},
    {PLATE(velocity), .kind = CDEM_KEY_COMPONENTS, .dimension = VELOCITY, DOMAIN,
     .otherwise = "at rest", .help = "Velocity of the plate: x, y, z to functions of time.",
     .example = "{y: -20 mm/s}"},
    {PLATE(stiffness_factor), .kind = CDEM_KEY_NUMBER, .fallback = 10, POSITIVE,
     .help = "Normal stiffness as a multiple of (lambda + 2G)/h of the stiffest element.",
     .example = "5"},
    {PLATE(normal_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "by stiffness_factor", .help = "Normal stiffness per area.",
     .example = "1e3 GPa/m"},
    {PLATE(shear_ratio), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE,
     .otherwise = "G/(lambda + 2G) of the stiffest element",
     .help = "Shear stiffness divided by normal stiffness.", .example = "0.4"},
    {PLATE(friction), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Coefficient of friction between plate and body.", .example = "0.2"},
};
const cdem_case_section cdem_section_plates =
    SECTION("plates", cdem_case_plate, plates, .named = true, .help = "A rigid plate.");

/* ---- initial ---- */

#define INITIAL(member) AT(cdem_case_initial, member)
static const cdem_case_key initial[] = {
    {INITIAL(groups), .kind = CDEM_KEY_TEXTS, .otherwise = "everywhere",
     .help = "Groups of the mesh that start with this velocity.", .example = "projectile"},
    {INITIAL(velocity), .kind = CDEM_KEY_VECTOR, .dimension = VELOCITY, .length = 3, .fewest = 2,
     DOMAIN, .keeps_rate = true, .help = "Velocity along x, y (and z).", .example = "[10 m/s, 0]"},
    {INITIAL(spin), .kind = CDEM_KEY_VECTOR, .dimension = RATE, .length = 3, .fewest = 3, DOMAIN,
     .keeps_rate = true,
     .help = "Angular velocity about the axes x, y, z through center, rad/s; 2-D: [0, 0, spin].",
     .example = "[0, 0, 5 1/s]"},
    {INITIAL(center), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     DOMAIN, .help = "Point about which spin turns.", .example = "[0.5 m, 0.5 m]"},
};
const cdem_case_section cdem_section_initial =
    SECTION("initial", cdem_case_initial, initial, .help = "Velocity of some groups at the start.");

/* ---- probes ---- */

static const char *const quantities[] = {"displacement",
                                         "velocity",
                                         "force",
                                         "stress",
                                         "count",
                                         "mass",
                                         "solid",
                                         "coordination",
                                         "surface_angle",
                                         "center",
                                         "stress_ratio",
                                         "band_angle",
                                         "band_slenderness",
                                         "mean_push",
                                         "boundary_push",
                                         "fabric",
                                         "anisotropy",
                                         "mechanical_coordination",
                                         "rattlers",
                                         NULL};
static const char *const surfaces[] = {"heap", "cone", "slope", NULL};
static const char *const components[] = {"x",  "y",  "z",  "rotation", "xx",        "yy",
                                         "zz", "yz", "xz", "xy",       "magnitude", NULL};

#define PROBE(member) AT(cdem_case_probe, member)
static const cdem_case_key probes[] = {
    {PROBE(group), .kind = CDEM_KEY_TEXT, .otherwise = "required by a body",
     .help = "Group of the mesh that is watched.", .example = "tip"},
    {PROBE(region), .kind = CDEM_KEY_SECTION, .section = &cdem_section_region,
     .otherwise = "all grains", .help = "Box of the grains that are watched.",
     .example = "{low: [0, 0], high: [1 m, 0.5 m]}"},
    {PROBE(quantity), .kind = CDEM_KEY_CHOICE, .choice = quantities,
     .help =
         "What is watched. A body: the mean displacement or velocity of the nodes, the sum of the "
         "forces that hold or push them, the mean stress of the elements. Grains: count, mass, "
         "mean velocity, center (of mass), solid fraction, stress, coordination number and stress "
         "ratio (2-D: (s1 - s3)/(s1 + s3), the sine of the mobilised friction angle; 3-D: q/p) in "
         "the region, or the angle of the free surface; band_angle and band_slenderness (2-D): how "
         "the grains whose effective strain is above half of the region's largest lie. Contacts: "
         "mean_push between grains and boundary_push on walls and plates (a membrane is none), "
         "their fabric (mean of n n) and its anisotropy; mechanical_coordination is that of grains "
         "with two contacts at least, rattlers the share of the others.",
     .example = "force"},
    {PROBE(component), .kind = CDEM_KEY_CHOICE, .choice = components,
     .otherwise = "required by what has components",
     .help = "Its component; xx .. xy of stress and fabric, the others of vectors.",
     .example = "y"},
    {PROBE(surface), .kind = CDEM_KEY_CHOICE, .choice = surfaces,
     .help =
         "How surface_angle looks at the grains: the two flanks of a heap along x, a cone about "
         "the upright axis through the region, one slope over the whole range.",
     .example = "slope"},
};
const cdem_case_section cdem_section_probes =
    SECTION("probes", cdem_case_probe, probes, .named = true, .help = "One column of history.csv.");

/* ---- curves ---- */

#define CURVE(member) AT(cdem_case_curve, member)
static const cdem_case_key curves[] = {
    {CURVE(title), .kind = CDEM_KEY_TEXT, .otherwise = "the name", .help = "Title of the figure.",
     .example = "Load against displacement"},
    {CURVE(x), .kind = CDEM_KEY_TEXT, .otherwise = "time", .help = "Column along the x axis.",
     .example = "top_y"},
    {CURVE(y), .kind = CDEM_KEY_TEXTS, .required = true, .help = "Columns along the y axis.",
     .example = "[top_force, bottom_force]"},
    {CURVE(x_scale), .kind = CDEM_KEY_NUMBER, .fallback = 1,
     .help = "Factor of x before drawing; -1 turns compression positive.", .example = "-1000"},
    {CURVE(y_scale), .kind = CDEM_KEY_NUMBER, .fallback = 1, .help = "Factor of y before drawing.",
     .example = "-0.001"},
    {CURVE(x_label), .kind = CDEM_KEY_TEXT, .otherwise = "the column and its unit",
     .help = "Label of the x axis.", .example = "displacement, mm"},
    {CURVE(y_label), .kind = CDEM_KEY_TEXT, .otherwise = "the column and its unit",
     .help = "Label of the y axis.", .example = "load, kN"},
};
const cdem_case_section cdem_section_curves = SECTION(
    "curves", cdem_case_curve, curves, .named = true, .help = "One figure of the folder figures/.");

/* ---- results ---- */

static const char *const takes[] = {"max",     "min",          "last",         "mean", "slope",
                                    "scatter", "place_of_max", "place_of_min", NULL};

#define RESULT(member) AT(cdem_case_key_result, member)
static const cdem_case_key results[] = {
    {RESULT(of), .kind = CDEM_KEY_TEXT, .required = true, .help = "Column of history.csv.",
     .example = "top_force"},
    {RESULT(take), .kind = CDEM_KEY_CHOICE, .choice = takes,
     .help = "What of the column: its largest, smallest, last or mean value, the slope of its best "
             "line against time, the scatter of its rows (standard deviation), or the place of its "
             "largest or smallest value.",
     .example = "min"},
    {RESULT(along), .kind = CDEM_KEY_TEXT, .otherwise = "time",
     .help = "Of a place: the column of history.csv whose value in that row is reported, in its "
             "own unit.",
     .example = "probe.strain"},
    {RESULT(from), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, NOT_NEGATIVE,
     DOMAIN, .otherwise = "the start", .help = "Rows of history.csv before this time do not count.",
     .example = "0.5 s"},
    {RESULT(to), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE, DOMAIN,
     .otherwise = "the end", .help = "Rows of history.csv after this time do not count.",
     .example = "1 s"},
    {RESULT(factor), .kind = CDEM_KEY_NUMBER, .fallback = 1,
     .help = "Multiplies the column before.", .example = "-1"},
    {RESULT(reference), .kind = CDEM_KEY_NUMBER, .fallback = NAN, .otherwise = "none",
     .help = "Expected value in SI units.", .example = "157.1e3"},
    {RESULT(against), .kind = CDEM_KEY_TEXTS, .otherwise = "reference",
     .help = "In place of a reference: columns of history.csv whose sum, taken alike, is expected; "
             "factor does not multiply it.",
     .example = "[friction, damping]"},
    {RESULT(against_factor), .kind = CDEM_KEY_NUMBER, .fallback = 1,
     .help = "Multiplies that sum before.", .example = "-9.81"},
    {RESULT(tolerance), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE,
     .otherwise = "none: the difference is reported only",
     .help = "Largest relative difference from the reference.", .example = "0.05"},
};
const cdem_case_section cdem_section_results =
    SECTION("results", cdem_case_key_result, results, .named = true, .help = "One key number.");
