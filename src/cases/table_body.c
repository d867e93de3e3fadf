/* Keys of the mesh, the materials, the blocks, their interfaces and contact. */
#include "cases/tables.h"

/* ---- mesh ---- */

static const char *const shapes[] = {"none", "tri3",   "quad4", "tet4",
                                     "pyr5", "wedge6", "hex8",  NULL};

#define MESH(member) AT(cdem_case_mesh, member)
static const cdem_case_key mesh[] = {
    {MESH(file), .kind = CDEM_KEY_TEXT, .otherwise = "a grid, see shape",
     .help = "Mesh file (.msh .geo .step .stp .inp .stl), relative to the case file.",
     .example = "plate.geo"},
    {MESH(parameters), .kind = CDEM_KEY_NUMBERS, .otherwise = "as the file says",
     .help = "Numbers that a .geo file declares by DefineConstant: name to plain number.",
     .example = "{h: 0.005, holes: 2}"},
    {MESH(unit), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = 1, POSITIVE, DOMAIN,
     .beside = "file", .help = "Length of one unit of the file's coordinates.", .example = "1 mm"},
    {MESH(shape), .kind = CDEM_KEY_CHOICE, .choice = shapes,
     .help =
         "A structured grid of a box in place of a file, of these elements. Its groups are body "
         "and the sides x0 x1 y0 y1 (3-D: and z0 z1).",
     .example = "quad4"},
    {MESH(count), .kind = CDEM_KEY_VECTOR, .length = 3, .fewest = 2, AT_LEAST(1), .fallback = 0,
     .otherwise = "required by a grid", .help = "Bricks of the grid along x, y (and z).",
     .example = "[10, 20]"},
    {MESH(size), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, POSITIVE,
     DOMAIN, .otherwise = "required by a grid", .help = "Size of the grid along x, y (and z).",
     .example = "[50 mm, 100 mm]"},
    {MESH(origin), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2, DOMAIN,
     .help = "Corner of the grid with the smallest coordinates.", .example = "[-25 mm, 0]"},
    {MESH(distortion), .kind = CDEM_KEY_NUMBER, BETWEEN(0, 0.25),
     .help = "Random shift of the inner nodes of a grid, as a fraction of a brick.",
     .example = "0.2"},
    {MESH(seed), .kind = CDEM_KEY_INTEGER, .fallback = 1, NOT_NEGATIVE,
     .help = "Seed of the random shift.", .example = "7"},
};
const cdem_case_section cdem_section_mesh =
    SECTION("mesh", cdem_case_mesh, mesh, .shorthand = "file",
            .help = "The mesh: a file, or a structured grid.");

/* ---- materials ---- */

static const char *const tensions[] = {"elastic", "none", NULL};

#define MATERIAL(member) AT(cdem_case_material, member)
static const cdem_case_key materials[] = {
    {MATERIAL(material), .kind = CDEM_KEY_MATERIAL, LAW, .help = "Elastic model and its moduli.",
     .example = "isotropic"},
    {MATERIAL(density), .kind = CDEM_KEY_NUMBER, .dimension = DENSITY, .fallback = NAN, POSITIVE,
     GRAIN, .otherwise = "none: static runs without gravity only", .help = "Mass per volume.",
     .example = "2700 kg/m3"},
    {MATERIAL(micro_inertia), .kind = CDEM_KEY_NUMBER, .dimension = AREA, .fallback = NAN, POSITIVE,
     GRAIN,
     .otherwise = "discs: half the square of their radius; else the square of the characteristic "
                  "length",
     .help = "Cosserat materials: rotational inertia of a material point per mass.",
     .example = "4 mm2"},
    {MATERIAL(tension), .kind = CDEM_KEY_CHOICE, .choice = tensions,
     .help = "elastic: what the moduli give; none: no principal stress is tensile, elements open "
             "and close without loss, as masonry or a coarse medium around loose grains does. "
             "Wants isotropic moduli, or cosserat-cubic ones.",
     .example = "none"},
    {MATERIAL(groups), .kind = CDEM_KEY_TEXTS, .otherwise = "wherever no other material is",
     .help = "Groups of elements that consist of this material.", .example = "[lower, upper]"},
};
const cdem_case_section cdem_section_materials =
    SECTION("materials", cdem_case_material, materials, .named = true,
            .help = "One material: model, moduli, density and where it is.");

/* ---- blocks ---- */

#define BLOCKS(member) AT(cdem_case_blocks, member)
static const cdem_case_key blocks[] = {
    {BLOCKS(breakable), .kind = CDEM_KEY_TEXTS, .otherwise = "none",
     .help = "Groups in which every element is a block of its own, so that cracks may run between "
             "any two.",
     .example = "rock"},
    {BLOCKS(separate), .kind = CDEM_KEY_TEXTS, .otherwise = "none",
     .help = "Groups that are cut off from their surroundings; each connected part is one block.",
     .example = "[slab, wedge]"},
    {BLOCKS(joints), .kind = CDEM_KEY_TEXTS, .otherwise = "none",
     .help = "Groups of faces (2-D: edges) along which the mesh is cut.", .example = "fault"},
};
const cdem_case_section cdem_section_blocks =
    SECTION("blocks", cdem_case_blocks, blocks, .help = "Where the mesh may come apart.");

/* ---- interfaces ---- */

static const char *const insertions[] = {"penalty", "tied", NULL};
static const char *const softenings[] = {"brittle", "linear", NULL};
static const char *const unloadings[] = {"elastic", "origin", NULL};

#define INTERFACE(member) AT(cdem_case_interface, member)
static const cdem_case_key interfaces[] = {
    {INTERFACE(between), .kind = CDEM_KEY_TEXTS, .otherwise = "any two",
     .help =
         "Two groups of elements between which the law holds; the same group twice means inside "
         "it.",
     .example = "[rock, mortar]"},
    {INTERFACE(joint), .kind = CDEM_KEY_TEXT, .otherwise = "any face",
     .help = "Group of faces (one of blocks.joints) on which the law holds.", .example = "fault"},
    {INTERFACE(insertion), .kind = CDEM_KEY_CHOICE, .choice = insertions,
     .help = "penalty: the springs are there from the start and soften the body a little; tied: "
             "faces move as one until the strength is reached.",
     .example = "tied"},
    {INTERFACE(stiffness_factor), .kind = CDEM_KEY_NUMBER, .fallback = 10, POSITIVE,
     .help = "Normal stiffness as a multiple of (lambda + 2G)/h of the stiffer neighbour.",
     .example = "100"},
    {INTERFACE(shear_ratio), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE,
     .otherwise = "G/(lambda + 2G) of the stiffer neighbour",
     .help = "Shear stiffness divided by normal stiffness.", .example = "0.4"},
    {INTERFACE(normal_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "by stiffness_factor", .help = "Normal stiffness per area, kn.",
     .example = "1e4 GPa/m"},
    {INTERFACE(shear_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "by shear_ratio", .help = "Shear stiffness per area, ks.",
     .example = "4e3 GPa/m"},
    {INTERFACE(tension), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, NOT_NEGATIVE, GRAIN,
     .help = "Tensile strength.", .example = "1 MPa"},
    {INTERFACE(cohesion), .kind = CDEM_KEY_NUMBER, .dimension = PRESSURE, NOT_NEGATIVE, GRAIN,
     .help = "Cohesion: shear strength without pressure.", .example = "3 MPa"},
    {INTERFACE(friction), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Tangent of the friction angle, before and after breaking.", .example = "0.3"},
    {INTERFACE(dilation), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Tangent of the dilation angle: opening per sliding; at most the friction.",
     .example = "0.05"},
    {INTERFACE(softening), .kind = CDEM_KEY_CHOICE, .choice = softenings,
     .help = "brittle: all strength is lost at once; linear: it falls linearly while energy_1 and "
             "energy_2 are spent.",
     .example = "linear"},
    {INTERFACE(unloading), .kind = CDEM_KEY_CHOICE, .choice = unloadings,
     .help =
         "How a softened interface unloads: elastic, with a remaining opening; origin, straight "
         "back to none.",
     .example = "origin"},
    {INTERFACE(energy_1), .kind = CDEM_KEY_NUMBER, .dimension = TOUGHNESS, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "required by linear softening with tension",
     .help = "Fracture energy per area in opening, G_I.", .example = "10 J/m2"},
    {INTERFACE(energy_2), .kind = CDEM_KEY_NUMBER, .dimension = TOUGHNESS, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "required by linear softening with cohesion",
     .help = "Fracture energy per area in sliding, G_II.", .example = "50 J/m2"},
};
const cdem_case_section cdem_section_interfaces =
    SECTION("interfaces", cdem_case_interface, interfaces,
            .help = "One law: where it holds, stiffness and strength.");

/* ---- contact ---- */

#define CONTACT(member) AT(cdem_case_contact, member)
static const cdem_case_key contact[] = {
    {CONTACT(active), .kind = CDEM_KEY_BOOLEAN,
     .otherwise = "yes where the section contact is given, no where it is not",
     .help = "Whether blocks feel each other.", .example = "no"},
    {CONTACT(stiffness_factor), .kind = CDEM_KEY_NUMBER, .fallback = 10, POSITIVE,
     .help = "Normal stiffness as a multiple of (lambda + 2G)/h of the stiffer body.",
     .example = "5"},
    {CONTACT(shear_ratio), .kind = CDEM_KEY_NUMBER, .fallback = NAN, POSITIVE,
     .otherwise = "G/(lambda + 2G) of the stiffer body",
     .help = "Shear stiffness divided by normal stiffness.", .example = "0.4"},
    {CONTACT(normal_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "by stiffness_factor", .help = "Normal stiffness per area.",
     .example = "1e3 GPa/m"},
    {CONTACT(shear_stiffness), .kind = CDEM_KEY_NUMBER, .dimension = BEDDING, .fallback = NAN,
     POSITIVE, GRAIN, .otherwise = "by shear_ratio", .help = "Shear stiffness per area.",
     .example = "400 GPa/m"},
    {CONTACT(friction), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE, .help = "Coefficient of friction.",
     .example = "0.5"},
    {CONTACT(damping), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Normal damping as a fraction of critical damping.", .example = "0.1"},
    {CONTACT(skin), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = NAN, POSITIVE, GRAIN,
     .otherwise = "automatic: a fifth of the mean face size",
     .help = "Width of the search margin around faces; changes speed, not results.",
     .example = "1 mm"},
    {CONTACT(release), .kind = CDEM_KEY_NUMBER, .fallback = 0.05, POSITIVE,
     .help = "A broken interface becomes contact when it has moved by this fraction of its face.",
     .example = "0.1"},
};
const cdem_case_section cdem_section_contact =
    SECTION("contact", cdem_case_contact, contact, .shorthand = "active",
            .help = "Penalty contact with Coulomb friction between blocks.");
