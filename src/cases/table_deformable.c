/* Keys of grains that deform. */
#include "cases/tables.h"

static const char *const shapes[] = {
#define X(name) #name,
#include "fdem/shapes.def"
#undef X
    NULL};
static const char *const integrations[] = {"implicit", "explicit", NULL};

#define DEFORMABLE(member) AT(cdem_case_deformable, member)
static const cdem_case_key deformable[] = {
    {DEFORMABLE(shape), .kind = CDEM_KEY_CHOICE, .choice = shapes,
     .help = "Mesh of all grains: icosphere, tetrasphere or cubesphere, spheres of ten-node "
             "tetrahedra, four-node tetrahedra or hexahedra; or mesh, a file.",
     .example = "cubesphere"},
    {DEFORMABLE(refinement), .kind = CDEM_KEY_INTEGER, .fallback = 1, BETWEEN(0, 6),
     .help = "icosphere, tetrasphere: how often the 20 faces of an icosahedron are cut in four; "
             "cubesphere: hexahedra along an edge of its core.",
     .example = "2"},
    {DEFORMABLE(file), .kind = CDEM_KEY_TEXT, .otherwise = "required by mesh",
     .help = "Mesh file of one grain, of any size: it is scaled to the volume of the sphere whose "
             "radius a grain has. Relative to the case file.",
     .example = "pebble.msh"},
    {DEFORMABLE(modes), .kind = CDEM_KEY_INTEGER, NOT_NEGATIVE, .otherwise = "all",
     .help = "Elastic modes of a grain that are kept, the softest first.", .example = "100"},
    {DEFORMABLE(integration), .kind = CDEM_KEY_CHOICE, .choice = integrations,
     .help = "implicit: the step follows the contacts, vibrations it does not resolve die; "
             "explicit: the step resolves every vibration of the mesh.",
     .example = "explicit"},
    {DEFORMABLE(damping_ratio), .kind = CDEM_KEY_NUMBER, NOT_NEGATIVE,
     .help = "Damping of each elastic mode as a fraction of critical damping.", .example = "0.02"},
    {DEFORMABLE(aligned), .kind = CDEM_KEY_BOOLEAN,
     .help = "All grains stand as their mesh does; else each is turned at random.",
     .example = "yes"},
    {DEFORMABLE(seed), .kind = CDEM_KEY_INTEGER, .fallback = 1, NOT_NEGATIVE,
     .help = "Seed of these turns.", .example = "7"},
};
const cdem_case_section cdem_section_deformable =
    SECTION("deformable grains", cdem_case_deformable, deformable,
            .help = "A mesh for every grain. Their law is penalty, the elastic constants are those "
                    "of grains.materials.");
