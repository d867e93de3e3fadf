/* Keys of grains: where they are, their materials and how they touch. Words of laws, packings and
 * resistances come from the tables of room dem. */
#include "cases/tables.h"

/* ---- names of variants ---- */

static const char *const laws[] = {
#define X(identifier, name) name,
#include "dem/laws.def"
#undef X
    NULL};

static const char *const rollings[] = {
#define ROLLING(name) #name,
#define TWISTING(name)
#include "dem/resistances.def"
#undef ROLLING
#undef TWISTING
    NULL};
static const char *const twistings[] = {
#define ROLLING(name)
#define TWISTING(name) #name,
#include "dem/resistances.def"
#undef ROLLING
#undef TWISTING
    NULL};
static const char *const kinds[] = {
#define X(name) #name,
#include "dem/packings.def"
#undef X
    NULL};
static const char *const sizes[] = {"equal", "uniform", "power", "normal", "table", NULL};

/* ---- materials ---- */

#define MATERIAL(member) AT(cdem_case_grain_material, member)
static const cdem_case_key materials[] = {
    {MATERIAL(density), .kind = CDEM_KEY_NUMBER, .dimension = DENSITY, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "required by grains; walls do without",
     .help = "Mass per volume of the grains themselves.", .example = "2600 kg/m3"},
    {MATERIAL(young), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "none; the law says whether it needs one",
     .help = "Young's modulus of the grains themselves.", .example = "70 GPa"},
    {MATERIAL(poisson), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 0.5),
     .otherwise = "none; the law says whether it needs one",
     .help = "Poisson's ratio of the grains themselves.", .example = "0.25"},
};
static const cdem_case_section section_materials =
    SECTION("grain materials", cdem_case_grain_material, materials, .named = true,
            .help = "One material of grains or walls.");

/* ---- packing ---- */

#define CLASS(member) AT(cdem_case_size_class, member)
static const cdem_case_key classes[] = {
    {CLASS(radius), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, GRAIN,
     .required = true, .help = "Radius of the grains of this class.", .example = "2 mm"},
    {CLASS(fraction), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 1), .above = true,
     .required = true, .help = "Its part of the volume (2-D: area) of all grains.",
     .example = "0.3"},
};
static const cdem_case_section section_classes =
    SECTION("classes", cdem_case_size_class, classes, .help = "One class of sizes.");

#define COMPACT(member) AT(cdem_case_compact, member)
static const cdem_case_key compact[] = {
    {COMPACT(fraction), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 1), .above = true,
     .below = true, .otherwise = "by pressure", .help = "Solid fraction that is wanted.",
     .example = "0.6"},
    {COMPACT(pressure), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "by fraction", .help = "Pressure that is wanted, at rest.",
     .example = "10 kPa"},
    {COMPACT(height), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "by fraction",
     .help =
         "Height that is wanted of a cylinder; its 'count' grains are put loosely into a higher "
         "one, and a plate comes down.",
     .example = "600 mm"},
    {COMPACT(stiffness), .kind = CDEM_KEY_NUMBER, .dimension = STIFFNESS, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "so high that overlaps stay below a thousandth of a radius",
     .help = "Normal stiffness of the contacts while grains are pressed together.",
     .example = "1e6 N/m"},
    {COMPACT(friction), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Friction while grains are pressed together: the less, the denser.", .example = "0.1"},
    {COMPACT(restitution), .kind = CDEM_KEY_NUMBER, .fallback = 0.3, BETWEEN(0, 1), .above = true,
     .help = "Restitution while grains are pressed together.", .example = "0.5"},
};
static const cdem_case_section section_compact = SECTION(
    "compact", cdem_case_compact, compact,
    .help = "Presses the packing together, by one of 'fraction', 'pressure' and 'height', before "
            "the run.");

#define PACKING(member) AT(cdem_case_packing, member)
static const cdem_case_key packing[] = {
    {PACKING(kind), .kind = CDEM_KEY_CHOICE, .choice = kinds, .required = true,
     .help = "How grains are put in place; `cdem list packings` describes each.",
     .example = "loose"},
    {PACKING(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .help = "Corner of the box with the smallest coordinates.", .example = "[-0.5 m, 0]"},
    {PACKING(high), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .required = true, .help = "Corner of the box with the largest coordinates.",
     .example = "[0.5 m, 1 m]"},
    {PACKING(centres_inside), .kind = CDEM_KEY_BOOLEAN,
     .help = "Lattices: centres are inside the box; else whole grains are.", .example = "yes"},
    {PACKING(cylinder), .kind = CDEM_KEY_BOOLEAN,
     .help = "Loose, 3-D: grains fill the upright cylinder in the box.", .example = "yes"},
    {PACKING(periodic), .kind = CDEM_KEY_TEXTS, .otherwise = "those of the cell",
     .help = "Directions x, y, z in which the packing continues itself.", .example = "[x, y]"},
    {PACKING(radius), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "required by sizes equal and normal",
     .help = "Radius of the grains; the mean of normal sizes.", .example = "5 mm"},
    {PACKING(sizes), .kind = CDEM_KEY_CHOICE, .choice = sizes,
     .help = "How radii are drawn, by number: equal; uniform between least and most; power, r to "
             "the exponent, between them; normal with spread, cut at them; or a table of classes.",
     .example = "uniform"},
    {PACKING(least), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, GRAIN,
     .otherwise = "required by sizes uniform, power and normal", .help = "Smallest radius.",
     .example = "4 mm"},
    {PACKING(most), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, GRAIN,
     .otherwise = "required by sizes uniform, power and normal", .help = "Largest radius.",
     .example = "6 mm"},
    {PACKING(exponent), .kind = CDEM_KEY_NUMBER, .fallback = NAN,
     .otherwise = "required by power sizes", .help = "Exponent of the density of radii by number.",
     .example = "-3"},
    {PACKING(spread), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "required by normal sizes", .help = "Standard deviation of radii.",
     .example = "0.5 mm"},
    {PACKING(classes), .kind = CDEM_KEY_LIST, .section = &section_classes,
     .otherwise = "required by sizes of a table", .help = "Classes of sizes.",
     .example = "[{radius: 2 mm, fraction: 0.4}, {radius: 3 mm, fraction: 0.6}]"},
    {PACKING(count), .kind = CDEM_KEY_INTEGER, NOT_NEGATIVE, GRAIN,
     .otherwise = "by fraction; lattices: as many as there is room for",
     .help = "Loose: how many grains.", .example = "2000"},
    {PACKING(fraction), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 1), .above = true,
     .below = true, .otherwise = "by count",
     .help = "Loose: solid part of the volume (2-D: area) of the box.", .example = "0.3"},
    {PACKING(seed), .kind = CDEM_KEY_INTEGER, .fallback = 1, NOT_NEGATIVE,
     .help = "Seed of the random numbers.", .example = "7"},
    {PACKING(compact), .kind = CDEM_KEY_SECTION, .section = &section_compact, .otherwise = "not",
     .help = "Presses the packing together before the run; its box shrinks about its low corner, a "
             "cylinder along its axis.",
     .example = "{pressure: 1 kPa, friction: 0.1}"},
};
static const cdem_case_section section_packing =
    SECTION("packing", cdem_case_packing, packing, .help = "Grains put in place by a rule.");

/* ---- pictures ---- */

#define WINDOW(member) AT(cdem_case_picture_window, member)
static const cdem_case_key window[] = {
    {WINDOW(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "Corner of the box with the smallest coordinates.",
     .example = "[-3.5 m, -3.5 m]"},
    {WINDOW(high), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "Corner of the box with the largest coordinates.",
     .example = "[3.5 m, 0.1 m]"},
    {WINDOW(of), .kind = CDEM_KEY_TEXTS, .otherwise = "all",
     .help = "Pictures that show the box alone.", .example = "[effective_strain, chains]"},
};
static const cdem_case_section section_window =
    SECTION("picture window", cdem_case_picture_window, window,
            .help = "A box; what has its middle in it is drawn.");

#define ENDS(member, what, sample)                                                                 \
  AT(cdem_case_picture_ranges, member), .kind = CDEM_KEY_VECTOR, .length = 2, .fewest = 2,         \
                                        .otherwise = "automatic", .help = what, .example = sample
static const cdem_case_key ranges[] = {
    {ENDS(radius, "Ends of the colour bar.", "[0, 50 mm]"), .dimension = LENGTH, GRAIN},
    {ENDS(speed, "Ends of the colour bar.", "[0, 1 m/s]"), .dimension = VELOCITY, DOMAIN},
    {ENDS(displacement, "Ends of the colour bar.", "[0, 60 mm]"), .dimension = LENGTH, DOMAIN},
    {ENDS(rotation, "Ends of the colour bar.", "[-0.1, 0.1]")},
    {ENDS(pressure, "Ends of the colour bar.", "[0, 4 MPa]"), .dimension = PRESSURE, DOMAIN},
    {ENDS(effective_stress, "Ends of the colour bar.", "[0, 6 MPa]"), .dimension = PRESSURE,
     DOMAIN},
    {ENDS(volumetric_strain, "Ends of the colour bar.", "[-0.05, 0.05]")},
    {ENDS(effective_strain, "Ends of the colour bar.", "[0, 0.25]")},
    {ENDS(contacts, "Ends of the colour bar.", "[0, 6]")},
    {ENDS(chains, "Ends of the colour bar: pushes themselves, not over their mean.", "[0, 100 kN]"),
     .dimension = FORCE, GRAIN},
    {ENDS(velocities, "Ends of the colour bar; arrows are as long as it says.", "[0, 1 m/s]"),
     .dimension = VELOCITY, DOMAIN},
};
#undef ENDS
static const cdem_case_section section_ranges = SECTION(
    "picture ranges", cdem_case_picture_ranges, ranges,
    .help = "Ends of the colour bars of pictures, so that those of several runs can be compared.");

/* ---- fields ---- */

#define FIELDS(member) AT(cdem_case_fields, member)
static const cdem_case_key fields[] = {
    {FIELDS(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "The point of the grid with the smallest coordinates.",
     .example = "[-3.5 m, -3.5 m]"},
    {FIELDS(high), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "The point of the grid with the largest coordinates.",
     .example = "[3.5 m, 0 m]"},
    {FIELDS(count), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2, AT_LEAST(1),
     .required = true, .help = "Points a direction; one lies in the middle.",
     .example = "[36, 18]"},
    {FIELDS(width), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, GRAIN,
     .otherwise = "two mean diameters",
     .help = "How far from a point grains and contacts still count.", .example = "0.3 m"},
};
static const cdem_case_section section_fields = SECTION(
    "fields", cdem_case_fields, fields,
    .help = "A grid on which density, velocity and stress are averaged, a data set of the frames.");

/* ---- grains ---- */

#define GRAINS(member) AT(cdem_case_grains, member)
static const cdem_case_key grains[] = {
    {GRAINS(dimension), .kind = CDEM_KEY_INTEGER, .fallback = 0, BETWEEN(2, 3), .required = true,
     .help = "2: discs in the plane z = 0; 3: spheres.", .example = "3"},
    {GRAINS(law), .kind = CDEM_KEY_CHOICE, .choice = laws,
     .help = "Contact law; `cdem list laws` describes each and the words it wants in 'contacts'.",
     .example = "hertz"},
    {GRAINS(rolling), .kind = CDEM_KEY_CHOICE, .choice = rollings,
     .help = "Rolling resistance beside the law.", .example = "spring"},
    {GRAINS(twisting), .kind = CDEM_KEY_CHOICE, .choice = twistings,
     .help = "Resistance to twisting about the normal beside the law; 3-D.", .example = "spring"},
    {GRAINS(file), .kind = CDEM_KEY_TEXT, .otherwise = "a packing",
     .help = "Table of grains (.csv), relative to the case file.", .example = "grains.csv"},
    {GRAINS(packing), .kind = CDEM_KEY_SECTION, .section = &section_packing, .otherwise = "a file",
     .help = "Grains put in place by a rule.",
     .example = "{kind: loose, high: [1, 1], radius: 0.02, fraction: 0.4}"},
    {GRAINS(deformable), .kind = CDEM_KEY_SECTION, .section = &cdem_section_deformable,
     .otherwise = "rigid", .help = "Grains that deform: meshes with node contact.",
     .example = "{shape: icosphere}"},
    {GRAINS(material), .kind = CDEM_KEY_TEXT, .otherwise = "the first of 'materials'",
     .help = "Material of the grains, where their file names none.", .example = "glass"},
    {GRAINS(materials), .kind = CDEM_KEY_NAMED, .section = &section_materials, .required = true,
     .help = "Materials of grains and walls by name.",
     .example = "{glass: {density: 2600 kg/m3, young: 70 GPa, poisson: 0.25}}"},
    {GRAINS(most_overlap), .kind = CDEM_KEY_NUMBER, .fallback = 0.1, BETWEEN(0, 2), .above = true,
     .help = "Grains that overlap by more at the start, in radii of the smaller one, are an error.",
     .example = "0.01"},
    {GRAINS(skin), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE, .otherwise = "automatic",
     .help = "Margin of the search for neighbours, in mean radii; changes speed, not results.",
     .example = "0.3"},
    {GRAINS(pictures), .kind = CDEM_KEY_TEXTS, .otherwise = "displacement, chains, velocities",
     .help =
         "Pictures of the last state: grains coloured by radius, speed, displacement, rotation, "
         "pressure, effective_stress, volumetric_strain, effective_strain (since the start) or "
         "contacts; force "
         "chains; velocities as arrows; pushes: the distribution of the normal forces between "
         "grains over their mean; directions: how many contacts point where, and how hard they "
         "push.",
     .example = "[effective_strain, chains]"},
    {GRAINS(picture_window), .kind = CDEM_KEY_SECTION, .section = &section_window,
     .otherwise = "everything", .help = "Pictures that show a part.",
     .example = "{low: [-3.5 m, -3.5 m], high: [3.5 m, 0.1 m], of: [effective_strain]}"},
    {GRAINS(picture_ranges), .kind = CDEM_KEY_SECTION, .section = &section_ranges,
     .otherwise = "automatic", .help = "Ends of the colour bars.",
     .example = "{effective_strain: [0, 0.25]}"},
    {GRAINS(picture_times), .kind = CDEM_KEY_VECTOR, .dimension = TIME,
     .length = CDEM_CASE_PICTURE_TIMES, .fewest = 1, DOMAIN, .otherwise = "none",
     .help = "Times whose states are drawn too, as NAME-15ms.png.", .example = "[15 ms, 33 ms]"},
    {GRAINS(fields), .kind = CDEM_KEY_SECTION, .section = &section_fields, .otherwise = "none",
     .help = "Coarse-grained fields of the frames: what the grains are as a continuum.",
     .example = "{low: [0, 0], high: [1 m, 1 m], count: [21, 21], width: 0.1 m}"},
};
const cdem_case_section cdem_section_grains =
    SECTION("grains", cdem_case_grains, grains, .shorthand = NULL,
            .help = "Discs or spheres: where they are, their materials and their law.");

/* ---- contacts ---- */

/* How a number of this dimension is written. */
#define WRITTEN(length, time, mass)                                                                \
  ((mass) == 0     ? (length) == 0 ? "0.3" : "0.1 mm"                                              \
   : (length) < 0  ? "1.8e11 N/m3"                                                                 \
   : (length) == 2 ? (time) == -2 ? "0.1 N m" : "0.01 N m s"                                       \
   : (time) == -2  ? "1e6 N/m"                                                                     \
                   : "10 N s/m")

static const cdem_case_key contacts[] = {
    {AT(cdem_case_grain_contact, between), .kind = CDEM_KEY_TEXTS, .otherwise = "any two",
     .help = "Two materials between which these numbers hold, of grains or walls.",
     .example = "[glass, steel]"},
#define X(name, length_, time_, mass_, help_)                                                      \
  {.key = #name,                                                                                   \
   .offset = offsetof(cdem_case_grain_contact, value) + (size_t)CDEM_LAW_##name * sizeof(double),  \
   .kind = CDEM_KEY_NUMBER,                                                                        \
   .dimension = {length_, time_, mass_},                                                           \
   .fallback = NAN,                                                                                \
   .tag = (length_) != 0 || (time_) != 0 || (mass_) != 0 ? CDEM_TAG_LAW : CDEM_TAG_NONE,           \
   .otherwise = "as the law says",                                                                 \
   .help = help_,                                                                                  \
   .example = WRITTEN(length_, time_, mass_)},
#include "dem/law_keys.def"
#undef X
};
const cdem_case_section cdem_section_contacts =
    SECTION("contacts", cdem_case_grain_contact, contacts,
            .help = "Numbers of the law between two materials; `cdem list laws` says which words a "
                    "law wants.");
