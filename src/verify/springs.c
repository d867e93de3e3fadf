/* Group springs: the stiffness block as a spring set, from single closed forms to whole networks.
 * Tolerances: 1e-12 of the block's norm is what springs.h promises; where the reference is printed
 * with a few digits, half a unit of the last one; elsewhere the reason stands beside it. */
#include "verify/springs.h"

#include "elements/elements.h"
#include "verify/verify.h"

#define WEI    "Wei et al. 2006, "
#define THEORY "docs/theory/springs.md, "
#define ERRATA "docs/theory/errata-wei-2006.md, "

#define MEASURE(of, name) .kind = CDEM_CHECK_##of, .measure = cdem_springs_measure_##name

/* 5 sqrt(2)/32, sqrt(3)/8, sqrt(2)/4 */
#define CHANGE_OF_EDGE 0.22097086912079612
#define TOUCH_OF_EDGE  0.21650635094610965
#define CHANGE_OF_FACE 0.35355339059327376

static const cdem_verification checks[] = {
    /* Closed forms. */
    {"hex8 edge, diagonal form: block against closed form", WEI "eq. (13), table 1", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 0},
    {"hex8 edge, complex form: block against closed form", WEI "eq. (15), corrected", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 1},
    {"hex8 edge, Jordan form: block against closed form", WEI "eq. (14), corrected", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 2},
    {"hex8 face, diagonal form: block against closed form", WEI "eqs. (17), (19), table 2", 0,
     1e-12, MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 3},
    {"hex8 face, complex form: block against closed form", WEI "eq. (20), corrected", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 4},
    {"hex8 body: block against closed form", WEI "eq. (22), table 3", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_closed_form), .parameter = 5},
    {"hex8 edge: k1, k2, k3 in the source's order", WEI "eqs. (13)-(15)", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_stiffnesses), .parameter = 0},
    {"hex8 face: k1, k2, k3 in the source's order", WEI "eqs. (17)-(20)", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_stiffnesses), .parameter = 1},
    {"hex8 body: k1, k2, k3 in the source's order", WEI "eq. (22)", 0, 1e-12,
     MEASURE(CLOSED_FORM, cube_stiffnesses), .parameter = 2},
    /* Critical ratios. */
    {"edge: lower change of form", WEI "text before eq. (13): 1/4 - 5 sqrt(2)/32",
     0.25 - CHANGE_OF_EDGE, 1e-12, MEASURE(CLOSED_FORM, root), .parameter = 0},
    {"edge: lower touch", WEI "text after table 1: 1/4 - sqrt(3)/8", 0.25 - TOUCH_OF_EDGE, 1e-9,
     MEASURE(CLOSED_FORM, root), .parameter = 1},
    {"edge: upper touch", WEI "text after table 1: 1/4 + sqrt(3)/8", 0.25 + TOUCH_OF_EDGE, 1e-9,
     MEASURE(CLOSED_FORM, root), .parameter = 2},
    {"edge: upper change of form", WEI "text before eq. (13): 1/4 + 5 sqrt(2)/32",
     0.25 + CHANGE_OF_EDGE, 1e-12, MEASURE(CLOSED_FORM, root), .parameter = 3},
    {"edge: number of critical ratios", THEORY "section 5", 4, 0, MEASURE(CLOSED_FORM, root_count),
     .parameter = 0},
    {"face: change of form", WEI "text before eq. (17): 1/4 - sqrt(2)/4", 0.25 - CHANGE_OF_FACE,
     1e-12, MEASURE(CLOSED_FORM, root), .parameter = 10},
    {"face: touch", WEI "eq. (19): 1/4", 0.25, 1e-9, MEASURE(CLOSED_FORM, root), .parameter = 11},
    {"face: order of the touch", THEORY "eq. (16)", 4, 0, MEASURE(CLOSED_FORM, root_order),
     .parameter = 11},
    {"face: number of critical ratios", THEORY "section 5", 2, 0, MEASURE(CLOSED_FORM, root_count),
     .parameter = 1},
    {"body: double everywhere, no critical ratio", WEI "eq. (21)", 0, 0,
     MEASURE(CLOSED_FORM, root_count), .parameter = 2},
    /* Plane elements. */
    {"quad4 edge, plane strain, diagonal form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 0},
    {"quad4 edge, plane strain, complex form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 1},
    {"quad4 edge, plane strain, Jordan form at 0", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 2},
    {"quad4 diagonal, plane strain", THEORY "eq. (18)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 3},
    {"quad4 edge, plane stress, diagonal form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 4},
    {"quad4 edge, plane stress, complex form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 5},
    {"quad4 edge, plane stress, Jordan form at 0", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 6},
    {"quad4 diagonal, plane stress", THEORY "eq. (18)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_closed_form), .parameter = 7},
    {"quad4 edge, plane strain: change of form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_root), .parameter = 0},
    {"quad4 edge, plane stress: change of form", THEORY "eq. (17)", 0, 1e-12,
     MEASURE(CLOSED_FORM, square_root), .parameter = 1},
    {"tri3, plane strain", THEORY "eq. (19)", 0, 1e-12, MEASURE(CLOSED_FORM, triangle_closed_form),
     .parameter = 0},
    {"tri3, plane stress", THEORY "eq. (19)", 0, 1e-12, MEASURE(CLOSED_FORM, triangle_closed_form),
     .parameter = 1},
    /* Nets: the printed formulas are 8 sqrt(3)/15 at 1/4 and sqrt(3)/2 at 1/3. */
    {"triangular net, plane strain, 1/4: across over along", WEI "section 4", 0, 1e-12,
     MEASURE(CLOSED_FORM, triangle_across), .parameter = 0},
    {"triangular net, plane stress, 1/3: across over along", WEI "section 4", 0, 1e-12,
     MEASURE(CLOSED_FORM, triangle_across), .parameter = 1},
    {"triangular net, plane strain, 1/4: along, over E t",
     WEI "section 4: sqrt(3)(5 - 4 mu)/(12 (1 + mu)(1 - 2 mu))", 0.92376043070340122, 1e-12,
     MEASURE(CLOSED_FORM, triangle_along), .parameter = 0},
    {"triangular net, plane stress, 1/3: along, over E t",
     WEI "section 4: sqrt(3)(5 + mu)/(12 (1 - mu^2))", 0.86602540378443865, 1e-12,
     MEASURE(CLOSED_FORM, triangle_along), .parameter = 1},
    {"inner edge pair of a block of cubes", "Gusev 2004; " WEI "table 5", 0, 1e-12,
     MEASURE(CLOSED_FORM, interior_sum), .parameter = 0},
    {"inner face pair of a block of cubes", "Gusev 2004; " WEI "table 5", 0, 1e-12,
     MEASURE(CLOSED_FORM, interior_sum), .parameter = 1},
    {"inner body pair of a block of cubes", "Gusev 2004; " WEI "table 5", 0, 1e-12,
     MEASURE(CLOSED_FORM, interior_sum), .parameter = 2},
    {"four springs on the body diagonal, 216", WEI "table 4, corrected", 0, 1e-12,
     MEASURE(CLOSED_FORM, frame_rebuild), .parameter = 0},
    {"four springs as printed, 432: what is missing", ERRATA "no. 17", 0.106, 5e-4,
     MEASURE(CLOSED_FORM, frame_rebuild), .parameter = 1},
    /* Decomposition. */
    {"beside defects, robust path: rebuilt block", THEORY "section 3", 0, 1e-12,
     MEASURE(IDENTITY, near_jordan), .parameter = 0},
    {"beside defects, fast path: rebuilt block", THEORY "section 3", 0, 1e-12,
     MEASURE(IDENTITY, near_jordan), .parameter = 1},
    {"fast path against LAPACK: invariants", THEORY "section 3", 0, 1e-12,
     MEASURE(SECOND_WAY, fast_invariants)},
    /* The eigenvalue's condition is at most cond(P), below 1e3: 1e3 roundings of 1e-15. */
    {"fast path against LAPACK: stiffnesses where cond(P) < 1e3", THEORY "section 3", 0, 1e-12,
     MEASURE(SECOND_WAY, fast_values)},
/* Every element of the table. */
#define X(identifier)                                                                              \
  {#identifier ", distorted: rows rebuild every block",                                            \
   THEORY "eq. (5)",                                                                               \
   0,                                                                                              \
   1e-12,                                                                                          \
   MEASURE(IDENTITY, rebuild),                                                                     \
   .parameter = CDEM_ELEMENT_##identifier},
#include "elements/elements.def"
#undef X
#define X(identifier)                                                                              \
  {#identifier ", distorted: springs put together are the element",                                \
   THEORY "eqs. (3), (21)",                                                                        \
   0,                                                                                              \
   1e-12,                                                                                          \
   MEASURE(IDENTITY, assembly),                                                                    \
   .parameter = CDEM_ELEMENT_##identifier},
#include "elements/elements.def"
#undef X
    {"tri3_cosserat: sum of K_ij T_ij", THEORY "eq. (22)", 0, 1e-13, MEASURE(IDENTITY, transport),
     .parameter = CDEM_ELEMENT_tri3_cosserat},
    {"quad4_cosserat: sum of K_ij T_ij", THEORY "eq. (22)", 0, 1e-13, MEASURE(IDENTITY, transport),
     .parameter = CDEM_ELEMENT_quad4_cosserat},
    {"hex8, distorted: skew fraction of S_ij and S_ji", THEORY "eq. (4)", 0, 1e-13,
     MEASURE(IDENTITY, skew_exchange), .parameter = CDEM_ELEMENT_hex8},
    /* A mesh whose elements all differ. */
    {"distorted 4x4x4 hex8: rows rebuild every block", THEORY "eq. (5)", 0, 1e-12,
     MEASURE(IDENTITY, grid), .parameter = 0},
    {"distorted 4x4x4 hex8: springs balance each element's diagonal", THEORY "eq. (2)", 0, 1e-12,
     MEASURE(IDENTITY, grid), .parameter = 1},
    {"distorted 4x4x4 hex8: network is the finite-element matrix", THEORY "eq. (3)", 0, 1e-12,
     MEASURE(IDENTITY, grid), .parameter = 2},
    {"distorted 4x4x4 hex8: inner forces under uniform strain", "Irons' patch test", 0, 1e-12,
     MEASURE(LAW, grid), .parameter = 3},
    {"distorted 4x4x4 hex8: zero modes", "rigid motions of a body", 6, 0, MEASURE(LAW, grid),
     .parameter = 4},
    {"distorted 4x4x4 hex8: negative modes", "stiffness is semidefinite", 0, 0, MEASURE(LAW, grid),
     .parameter = 5},
    /* Depletion of one cube, E = L = 1, without the first group of a class. */
    {"cube at 1/4 without a face group: lowest eigenvalue over E L", THEORY "table 2", -6.9e-3,
     5e-5, MEASURE(SECOND_WAY, depletion_lowest), .parameter = 10},
    {"cube at 1/4 without a body group: lowest eigenvalue over E L", THEORY "table 2", -1.9e-2,
     5e-4, MEASURE(SECOND_WAY, depletion_lowest), .parameter = 20},
    {"cube at 1/4 without an edge group: negative eigenvalues", THEORY "table 2", 0, 0,
     MEASURE(SECOND_WAY, depletion_negative), .parameter = 0},
    {"cube at 1/4 without an edge group: rotations that meet a force", THEORY "table 2", 2, 0,
     MEASURE(SECOND_WAY, depletion_rotations), .parameter = 0},
    {"cube at 0.2 without an edge group: indefinite", THEORY "table 2", 1, 0,
     MEASURE(SECOND_WAY, depletion_negative), .parameter = 1},
    {"cube at 0.3 without an edge group: indefinite", THEORY "table 2", 1, 0,
     MEASURE(SECOND_WAY, depletion_negative), .parameter = 2},
    /* Numbers the source prints, three digits each (the body's q: five). */
    {"edge, eq. (12): number before D, with the squared factor", ERRATA "no. 8", 3.03e-12, 5e-15,
     MEASURE(PUBLISHED, coefficient), .parameter = 0},
    {"edge, eq. (12): number before p", WEI "eq. (12)", 1.45e-4, 5e-7,
     MEASURE(PUBLISHED, coefficient), .parameter = 1},
    {"edge, eq. (12): number before q", WEI "eq. (12)", 5.36e-6, 5e-9,
     MEASURE(PUBLISHED, coefficient), .parameter = 2},
    {"face, eq. (16): number before D", ERRATA "no. 12", 2.42e-11, 5e-14,
     MEASURE(PUBLISHED, coefficient), .parameter = 10},
    {"face, eq. (16): number before p", WEI "eq. (16)", 2.89e-4, 5e-7,
     MEASURE(PUBLISHED, coefficient), .parameter = 11},
    {"face, eq. (16): number before q", WEI "eq. (16)", 2.68e-6, 5e-9,
     MEASURE(PUBLISHED, coefficient), .parameter = 12},
    {"body, eq. (21): p", WEI "eq. (21)", -1.3e-3, 5e-6, MEASURE(PUBLISHED, coefficient),
     .parameter = 21},
    {"body, eq. (21): q", WEI "eq. (21)", 1.8084e-5, 1e-9, MEASURE(PUBLISHED, coefficient),
     .parameter = 22},
};

const cdem_verify_group cdem_verify_springs = {
    .name = "springs",
    .summary = "stiffness blocks as spring sets: closed forms, critical ratios, networks",
    .checks = sizeof checks / sizeof checks[0],
    .check = checks,
};
