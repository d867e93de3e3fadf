/* Keys of what is around grains: walls, bonds, the cell, and the regions of probes. */
#include "cases/tables.h"

/* ---- walls ---- */

static const char *const shapes[] = {"plane", "plate", "cylinder", "mesh", NULL};

#define WALL(member) AT(cdem_case_wall, member)
static const cdem_case_key walls[] = {
    {WALL(shape), .kind = CDEM_KEY_CHOICE, .choice = shapes, .required = true,
     .help =
         "plane: endless, grains on the side of its normal; plate: a rectangle (2-D: a segment) "
         "that acts from both sides; cylinder: grains inside or outside a tube (2-D: a circle); "
         "mesh: triangles (2-D: segments) of a file.",
     .example = "plane"},
    {WALL(material), .kind = CDEM_KEY_TEXT, .otherwise = "the first of grains.materials",
     .help = "Material of the wall, one of grains.materials.", .example = "steel"},
    {WALL(center), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .otherwise = "plane: where it touches the outermost grain; mesh: the middle of its corners",
     .help = "A point of a plane; the middle of a plate, circle or tube; the point about which a "
             "mesh turns.",
     .example = "[0, -0.5 m]"},
    {WALL(normal), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2,
     .otherwise = "required by planes and plates",
     .help = "Direction out of the wall towards the grains; any length.", .example = "[0, 1]"},
    {WALL(axis), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2,
     .otherwise = "automatic: any direction in a plate; z of a cylinder",
     .help = "3-D: direction in a plate along which half_size[0] is measured; axis of a cylinder.",
     .example = "[1, 0, 0]"},
    {WALL(half_size), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 2, .fewest = 1,
     NOT_NEGATIVE, DOMAIN, .otherwise = "required by plates; cylinder: endless",
     .help = "Half of a plate's length along axis and across it; half of a cylinder's length.",
     .example = "[0.2 m]"},
    {WALL(radius), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, DOMAIN,
     .otherwise = "required by cylinders", .help = "Radius of a cylinder.", .example = "0.3 m"},
    {WALL(outside), .kind = CDEM_KEY_BOOLEAN, .help = "Grains are outside the cylinder: a roller.",
     .example = "yes"},
    {WALL(file), .kind = CDEM_KEY_TEXT, .otherwise = "required by meshes",
     .help = "Mesh file of triangles (2-D: segments), relative to the case file.",
     .example = "hopper.stl"},
    {WALL(group), .kind = CDEM_KEY_TEXT, .otherwise = "all of the file",
     .help = "Group of the mesh file that is the wall.", .example = "funnel"},
    {WALL(unit), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = 1, POSITIVE, DOMAIN,
     .beside = "file", .help = "Length of one unit of the file's coordinates.", .example = "1 mm"},
    {WALL(velocity), .kind = CDEM_KEY_COMPONENTS, .dimension = VELOCITY, DOMAIN,
     .otherwise = "at rest", .help = "Velocity of the center: x, y, z to functions of time.",
     .example = "{y: -20 mm/s}"},
    {WALL(spin), .kind = CDEM_KEY_COMPONENTS, .dimension = RATE, DOMAIN, .otherwise = "at rest",
     .help = "Angular velocity about the center, rad/s: x, y, z to functions of time; 2-D: z.",
     .example = "{z: 2 1/s}"},
    {WALL(servo), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2, .otherwise = "none",
     .help = "Direction along which the wall moves so that the grains' force on it becomes "
             "servo_force.",
     .example = "[0, 1]"},
    {WALL(servo_force), .kind = CDEM_KEY_SERIES, .dimension = FORCE,
     .given = offsetof(cdem_case_wall, has_servo_force), DOMAIN, .otherwise = "required by servo",
     .help = "Force of the grains on the wall along servo that is wanted.", .example = "100 N"},
    {WALL(servo_speed), .kind = CDEM_KEY_NUMBER, .dimension = VELOCITY, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "required by servo", .help = "Largest speed along servo.",
     .example = "10 mm/s"},
    {WALL(servo_gain), .kind = CDEM_KEY_NUMBER, .fallback = 0.25, BETWEEN(0, 1), .above = true,
     .below = true, .help = "Part of the missing force that the wall makes good in one step.",
     .example = "0.1"},
    {WALL(start), .kind = CDEM_KEY_NUMBER, .dimension = TIME, NOT_NEGATIVE, DOMAIN,
     .help = "Time from which the wall is there.", .example = "0.5 s"},
    {WALL(stop), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE, DOMAIN,
     .otherwise = "never", .help = "Time at which the wall goes: a gate that opens.",
     .example = "1 s"},
};
const cdem_case_section cdem_section_walls =
    SECTION("walls", cdem_case_wall, walls, .named = true, .help = "A rigid wall.");

/* ---- bonds ---- */

#define BOND(member) AT(cdem_case_bond, member)
static const cdem_case_key bonds[] = {
    {BOND(between), .kind = CDEM_KEY_TEXTS, .otherwise = "any two",
     .help = "Two materials whose grains are bonded.", .example = "[rock, rock]"},
    {BOND(gap), .kind = CDEM_KEY_NUMBER, .fallback = 1e-3, NOT_NEGATIVE,
     .help = "Pairs are bonded whose surfaces are closer than this part of their mean radius.",
     .example = "0.05"},
    {BOND(normal_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = STIFFNESS, .fallback = NAN,
     POSITIVE, GRAIN, .required = true, .help = "Normal stiffness, push and pull.",
     .example = "1e6 N/m"},
    {BOND(shear_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = STIFFNESS, NOT_NEGATIVE, GRAIN,
     .help = "Shear stiffness.", .example = "3e5 N/m"},
    {BOND(rolling_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = TURNING_STIFFNESS, NOT_NEGATIVE,
     GRAIN, .help = "Stiffness against relative rotation about the plane of contact.",
     .example = "10 N m"},
    {BOND(twisting_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = TURNING_STIFFNESS,
     NOT_NEGATIVE, GRAIN, .help = "Stiffness against relative rotation about the normal; 3-D.",
     .example = "10 N m"},
    {BOND(damping_ratio), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Dashpots of normal and shear as a fraction of critical damping.", .example = "0.1"},
    {BOND(tension), .kind = CDEM_KEY_NUMBER, .dimension = FORCE, NOT_NEGATIVE, GRAIN,
     .otherwise = "unbreakable by pull", .help = "Pull at which the bond breaks.",
     .example = "10 N"},
    {BOND(cohesion), .kind = CDEM_KEY_NUMBER, .dimension = FORCE, NOT_NEGATIVE, GRAIN,
     .otherwise = "unbreakable by shear", .help = "Shear force without push at which it breaks.",
     .example = "20 N"},
    {BOND(friction), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Shear strength that is added per push.", .example = "0.5"},
    {BOND(moment), .kind = CDEM_KEY_NUMBER, .dimension = MOMENT, NOT_NEGATIVE, GRAIN,
     .otherwise = "unbreakable by moment", .help = "Moment at which the bond breaks.",
     .example = "0.1 N m"},
};
const cdem_case_section cdem_section_bonds = SECTION(
    "bonds", cdem_case_bond, bonds, .help = "Stiffness and strength of bonds between materials.");

/* ---- cell ---- */

#define RATES(name, index, of, along)                                                              \
  {                                                                                                \
    .key = #name, .offset = offsetof(cdem_case_tensor, component) + (index) * sizeof(cdem_series), \
    .given = offsetof(cdem_case_tensor, given) + (index) * sizeof(bool), .kind = CDEM_KEY_SERIES,  \
    .dimension = RATE, DOMAIN, .otherwise = "0",                                                   \
    .help = "Change of velocity " of " along " along ".", .example = "-0.01 1/s"                   \
  }
static const cdem_case_key rates[] = {
    RATES(xx, 0, "x", "x"), RATES(xy, 1, "x", "y"), RATES(xz, 2, "x", "z"),
    RATES(yx, 3, "y", "x"), RATES(yy, 4, "y", "y"), RATES(yz, 5, "y", "z"),
    RATES(zx, 6, "z", "x"), RATES(zy, 7, "z", "y"), RATES(zz, 8, "z", "z"),
};
static const cdem_case_section section_rate =
    SECTION("rate", cdem_case_tensor, rates, .help = "Velocity gradient of the cell.");

#define STRESSES(name, index)                                                                      \
  {                                                                                                \
    .key = #name, .offset = offsetof(cdem_case_tensor, component) + (index) * sizeof(cdem_series), \
    .given = offsetof(cdem_case_tensor, given) + (index) * sizeof(bool), .kind = CDEM_KEY_SERIES,  \
    .dimension = PRESSURE, DOMAIN, .otherwise = "none: the rate decides",                          \
    .help = "Normal stress " #name " that is wanted, compression positive.", .example = "10 kPa"   \
  }
static const cdem_case_key stresses[] = {STRESSES(xx, 0), STRESSES(yy, 4), STRESSES(zz, 8)};
static const cdem_case_section section_stress =
    SECTION("stress", cdem_case_tensor, stresses, .help = "Stress that servos of the cell keep.");

#define CELL(member) AT(cdem_case_cell, member)
static const cdem_case_key cell[] = {
    {CELL(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .otherwise = "the packing's", .help = "Corner of the cell; it stays where it is.",
     .example = "[0, 0]"},
    {CELL(size), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, POSITIVE,
     DOMAIN, .otherwise = "the packing's", .help = "Size of the cell along x, y (and z).",
     .example = "[1 m, 1 m]"},
    {CELL(tilt), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 1, DOMAIN,
     .help = "How far the edge along y leans to x, the edge along z to x and to y.",
     .example = "[0.1 m]"},
    {CELL(periodic), .kind = CDEM_KEY_TEXTS, .otherwise = "all directions",
     .help = "Directions x, y, z in which the cell is periodic; the others are free.",
     .example = "[x]"},
    {CELL(rate), .kind = CDEM_KEY_SECTION, .section = &section_rate, .otherwise = "the cell stays",
     .help = "Velocity gradient with which the cell deforms: functions of time.",
     .example = "{yy: -0.01 1/s}"},
    {CELL(stress), .kind = CDEM_KEY_SECTION, .section = &section_stress, .otherwise = "none",
     .help = "Normal stresses that the cell keeps by its rate, compression positive.",
     .example = "{xx: 10 kPa}"},
    {CELL(servo_rate), .kind = CDEM_KEY_NUMBER, .dimension = RATE, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "required by stress", .help = "Largest rate by which a stress is sought.",
     .example = "0.1 1/s"},
    {CELL(servo_gain), .kind = CDEM_KEY_NUMBER, .fallback = 0.25, BETWEEN(0, 1), .above = true,
     .below = true, .help = "Part of the missing stress that is made good in one step.",
     .example = "0.1"},
};
const cdem_case_section cdem_section_cell =
    SECTION("cell", cdem_case_cell, cell, .help = "The box in which grains are periodic.");

/* ---- regions of probes ---- */

#define REGION(member) AT(cdem_case_region, member)
static const cdem_case_key region[] = {
    {REGION(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .help = "Corner with the smallest coordinates.", .example = "[0, 0]"},
    {REGION(high), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .help = "Corner with the largest coordinates; not above low in a direction: all of it.",
     .example = "[1 m, 0.5 m]"},
};
const cdem_case_section cdem_section_region =
    SECTION("region", cdem_case_region, region, .help = "A box, by the centres of its grains.");
