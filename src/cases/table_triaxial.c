/* Keys of a triaxial test: a specimen of grains between two plates, in a membrane. */
#include "cases/tables.h"

static const char *const boundaries[] = {"membrane", "cylinder", NULL};
static const char *const edges[] = {"clamped", "free", NULL};

#define MEMBRANE(member) AT(cdem_case_membrane, member)
static const cdem_case_key membrane[] = {
    {MEMBRANE(spacing), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "a third of the smallest diameter",
     .help =
         "Distance of neighbouring nodes; at most half the smallest diameter, else grains leak.",
     .example = "20 mm"},
    {MEMBRANE(penalty), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "1000 pressure/diameter of the smallest grain",
     .help = "Stiffness of its contact with grains, by area.", .example = "15 GPa/m"},
    {MEMBRANE(contact_damping), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 1),
     .otherwise = "0.2", .help = "Damping ratio of that contact.", .example = "0.1"},
    {MEMBRANE(young), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "such that young * thickness is pressure * smallest diameter/10",
     .help = "Young's modulus of the membrane; it keeps nodes from gathering between grains.",
     .example = "1.4 MPa"},
    {MEMBRANE(poisson), .kind = CDEM_KEY_NUMBER, .fallback = 0.3, BETWEEN(0, 0.5),
     .help = "Poisson's ratio of the membrane.", .example = "0.5"},
    {MEMBRANE(thickness), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "a hundredth of the smallest diameter",
     .help = "Thickness of the membrane, for its stretching alone.", .example = "0.3 mm"},
    {MEMBRANE(bending), .kind = CDEM_KEY_NUMBER, .dimension = MOMENT, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "0.1 pressure * diameter^3 of the smallest grain",
     .help = "Bending stiffness, which spans the gaps between grains without confining them.",
     .example = "20 N m"},
    {MEMBRANE(damping), .kind = CDEM_KEY_NUMBER, .fallback = NAN, BETWEEN(0, 1), .otherwise = "0.2",
     .help = "Damping ratio of the highest mode of bending.", .example = "0.1"},
    {MEMBRANE(areal_density), .kind = CDEM_KEY_NUMBER, .dimension = {-2, 0, 1}, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "half of density * smallest diameter of the grains",
     .help = "Mass of the membrane by area: heavy enough that it does not limit the step.",
     .example = "80 kg/m2"},
    {MEMBRANE(edges), .kind = CDEM_KEY_CHOICE, .choice = edges,
     .help =
         "What its ends do across the axis: held where they started, as by the rim of a platen, or "
         "free. Along the axis they follow the plates.",
     .example = "free"},
};
static const cdem_case_section section_membrane =
    SECTION("membrane", cdem_case_membrane, membrane,
            .help = "The flexible membrane around the specimen; every key has a default.");

#define TRIAXIAL(member) AT(cdem_case_triaxial, member)
static const cdem_case_key keys[] = {
    {TRIAXIAL(pressure), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, .fallback = NAN, POSITIVE,
     DOMAIN, .required = true, .help = "Confining pressure.", .example = "0.9 MPa"},
    {TRIAXIAL(boundary), .kind = CDEM_KEY_CHOICE, .choice = boundaries,
     .help = "The side of the specimen: a flexible membrane, or a rigid cylinder whose radius "
             "a servo finds, which is quicker.",
     .example = "cylinder"},
    {TRIAXIAL(consolidation), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "50 mean diameter * sqrt(density/pressure)",
     .help =
         "How long all sides carry the pressure before the shear; it rises over the first half.",
     .example = "50 ms"},
    {TRIAXIAL(rate), .kind = CDEM_KEY_NUMBER, .dimension = RATE, .fallback = NAN, POSITIVE, DOMAIN,
     .otherwise = "by inertial_number",
     .help = "Speed of the upper plate by the height at the start of the shear.",
     .example = "0.2 1/s"},
    {TRIAXIAL(inertial_number), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE,
     .otherwise = "1e-3",
     .help = "The same as a number: rate * mean diameter * sqrt(density/pressure).",
     .example = "5e-4"},
    {TRIAXIAL(strain), .kind = CDEM_KEY_NUMBER, .fallback = 0.15, BETWEEN(0, 3), .above = true,
     .help = "Logarithmic axial strain at the end.", .example = "0.2"},
    {TRIAXIAL(material), .kind = CDEM_KEY_TEXT, .otherwise = "the first of grains.materials",
     .help =
         "Material of the plates, one of grains.materials; `contacts` says how grains touch it.",
     .example = "steel"},
    {TRIAXIAL(side_material), .kind = CDEM_KEY_TEXT, .otherwise = "that of the plates",
     .help = "Material of the cylinder, one of grains.materials. Without friction in its contacts, "
             "else it carries a part of the axial force.",
     .example = "teflon"},
    {TRIAXIAL(membrane), .kind = CDEM_KEY_SECTION, .section = &section_membrane,
     .help = "The flexible membrane.", .example = "{edges: free}"},
};
const cdem_case_section cdem_section_triaxial =
    SECTION("triaxial", cdem_case_triaxial, keys,
            .help = "A triaxial test: the cylinder of the packing is consolidated and sheared.");
