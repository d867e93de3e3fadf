/* Keys of a coupled case: grains inside a body. */
#include "cases/tables.h"

#define BOX(member) AT(cdem_case_region, member)
static const cdem_case_key box[] = {
    {BOX(low), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "Corner of the box with the smallest coordinates.",
     .example = "[-3.5 m, -3.5 m]"},
    {BOX(high), .kind = CDEM_KEY_VECTOR, .dimension = LENGTH, .length = 3, .fewest = 2,
     .required = true, DOMAIN, .help = "Corner of the box with the largest coordinates.",
     .example = "[3.5 m, 0]"},
};
static const cdem_case_section section_box =
    SECTION("fine regions", cdem_case_region, box,
            .help = "A box; elements whose middle is in it are the fine region.");

static const char *const versions[] = {"coupled", "frozen", "grains", "continuum", NULL};
static const char *const forms[] = {"interface", "virtual-work", NULL};
static const char *const motions[] = {"velocity", "acceleration", NULL};
static const char *const rotations[] = {"physical", "scaled", NULL};

#define COUPLING(member) AT(cdem_case_coupling, member)
static const cdem_case_key keys[] = {
    {COUPLING(version), .kind = CDEM_KEY_CHOICE, .choice = versions,
     .help = "Which model of the problem is run: grains in the coarse medium; the same grains "
             "inside frozen ones (the null test); grains everywhere; the coarse medium everywhere.",
     .example = "grains"},
    {COUPLING(regions), .kind = CDEM_KEY_LIST, .section = &section_box,
     .otherwise = "required by a coupled case",
     .help = "Boxes whose elements are the fine region, in which grains are calculated.",
     .example = "[{low: [-3.5 m, -3.5 m], high: [3.5 m, 0]}]"},
    {COUPLING(form), .kind = CDEM_KEY_CHOICE, .choice = forms,
     .help = "Force of the grains on the coarse medium: of interface grains only, or the virtual "
             "work of all, with the grains' masses in the nodes of the fine region.",
     .example = "virtual-work"},
    {COUPLING(cycles), .kind = CDEM_KEY_INTEGER, BETWEEN(0, 1e6),
     .otherwise = "as many as are stable, 20 at most",
     .help = "Steps of the grains in one step of the coarse medium; 0: automatic. A number that is "
             "given holds for frozen and grains, too, so that they take the same steps.",
     .example = "10"},
    {COUPLING(interface_motion), .kind = CDEM_KEY_CHOICE, .choice = motions,
     .help =
         "How interface grains move within a step of the coarse medium: with its mean velocity, "
         "which keeps energy, or with velocity and acceleration at its start, as published, "
         "which grows where damping is low.",
     .example = "acceleration"},
    {COUPLING(rotation), .kind = CDEM_KEY_CHOICE, .choice = rotations,
     .help = "Inertia of the micro-rotation of a Cosserat medium: that of the material, or "
             "multiplied until rotations no longer limit the step of the coarse medium.",
     .example = "scaled"},
    {COUPLING(interface_gap), .kind = CDEM_KEY_NUMBER, .fallback = 0.3, NOT_NEGATIVE,
     .help = "Grains nearer to a fine grain than this, in largest radii, are interface grains; in "
             "random packings less lets grains escape.",
     .example = "0.3"},
    {COUPLING(absorb), .kind = CDEM_KEY_NUMBER, .dimension = RATE, .fallback = 0.0, NOT_NEGATIVE,
     DOMAIN, .keeps_rate = true,
     .help =
         "Takes motions that the mesh cannot express out of the grains at this rate, in a layer "
         "along the coarse medium, before they are thrown back; 0: no layer. About 5 times "
         "wave speed by element length for one layer of elements, 2 times for two. It resists "
         "slip bands that cross the layer, too: for grains that stay together there.",
     .example = "2000 1/s"},
    {COUPLING(absorb_layers), .kind = CDEM_KEY_INTEGER, .fallback = 1, BETWEEN(1, 1e6),
     .help = "Width of that layer, in elements of the fine region.", .example = "2"},
};
const cdem_case_section cdem_section_coupling =
    SECTION("coupling", cdem_case_coupling, keys, .help = "Grains inside a body.");
