/* Keys at the top of a case. */
#include "cases/tables.h"

static const char *const analyses[] = {"dynamic", "relaxation", "static", NULL};
static const char *const planes[] = {"strain", "stress", NULL};

#define TOP(member) AT(cdem_case_values, member)

static const cdem_case_key keys[] = {
    {TOP(title), .kind = CDEM_KEY_TEXT, .otherwise = "no title",
     .help = "A line that names the run in summary.json and in what is printed at its end.",
     .example = "Uniaxial compression of a rock specimen"},
    {TOP(analysis), .kind = CDEM_KEY_CHOICE, .choice = analyses,
     .help = "dynamic: explicit in time; relaxation: damped explicit steps until forces balance; "
             "static: one linear solution.",
     .example = "relaxation"},
    {TOP(plane), .kind = CDEM_KEY_CHOICE, .choice = planes,
     .help = "How a 2-D body extends out of its plane: plane strain or plane stress. No meaning in "
             "3-D.",
     .example = "stress"},
    {TOP(thickness), .kind = CDEM_KEY_NUMBER, .dimension = LENGTH, .fallback = 1, POSITIVE, LAW,
     .plane = true, .help = "Thickness of a 2-D body, or of discs. No meaning in 3-D.",
     .example = "50 mm"},
    {TOP(end), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE, DOMAIN,
     .otherwise = "required by a dynamic run but a triaxial test; static: loads are taken at 0 s",
     .help = "Time at which the run ends; in a static run the time at which loads and supports are "
             "taken.",
     .example = "10 ms"},
    {TOP(step), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE, GRAIN,
     .otherwise = "automatic: safety times the largest stable step",
     .help = "Time step. A step that is not stable is an error.", .example = "0.1 us"},
    {TOP(safety), .kind = CDEM_KEY_NUMBER, .fallback = 0.8, .least = 0, .most = 1, .above = true,
     .help = "Fraction of the largest stable step that the automatic step takes; grains, whose "
             "contacts begin and end, take 0.1 where nothing is given.",
     .example = "0.5"},
    {TOP(mass_damping), .kind = CDEM_KEY_NUMBER, .dimension = RATE, NOT_NEGATIVE, GRAIN,
     .help = "Damping force per mass and velocity, 1/s: c = mass_damping times the mass.",
     .example = "200 1/s"},
    {TOP(local_damping), .kind = CDEM_KEY_NUMBER, .fallback = NAN, .least = 0, .most = 1,
     .below = true, .otherwise = "0 in a dynamic run, 0.8 in a relaxation",
     .help = "Local damping: this fraction of the unbalanced force acts against the velocity.",
     .example = "0.7"},
    {TOP(tolerance), .kind = CDEM_KEY_NUMBER, .fallback = 1e-5, .least = 0, .most = 1,
     .above = true,
     .help = "A relaxation ends when the ratio of the largest unbalanced to the mean nodal force "
             "(grains: to the mean contact force) is below it.",
     .example = "1e-6"},
    {TOP(most_steps), .kind = CDEM_KEY_INTEGER, .fallback = 1000000, AT_LEAST(1),
     .help = "A relaxation that takes more steps than this ends with an error.",
     .example = "200000"},
    {TOP(gravity), .kind = CDEM_KEY_VECTOR, .dimension = ACCELERATION, .length = 3, .fewest = 2,
     DOMAIN, .otherwise = "none", .help = "Acceleration by gravity along x, y (and z).",
     .example = "[0, -9.81 m/s2]"},
    {TOP(quiet), .kind = CDEM_KEY_TEXTS, .otherwise = "none",
     .help = "Groups of faces (2-D: edges) that let waves out: viscous dashpots of density times "
             "wave speed.",
     .example = "[left, right, bottom]"},
    {TOP(history_every), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "end/400", .help = "Time of the run between two rows of history.csv.",
     .example = "10 us"},
    {TOP(frame_every), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "end/20",
     .help = "Time of the run between two frames of the .pvd series.", .example = "0.5 ms"},
    {TOP(checkpoint_every), .kind = CDEM_KEY_NUMBER, .dimension = TIME, .fallback = NAN, POSITIVE,
     DOMAIN, .otherwise = "every 5 minutes of wall time",
     .help = "Time of the run between two checkpoints.", .example = "1 ms"},
    {TOP(stop_when), .kind = CDEM_KEY_TEXT, .otherwise = "the run goes on to its end",
     .help = "Column of history.csv whose fall ends the run early; see stop_below.",
     .example = "top_force"},
    {TOP(stop_below), .kind = CDEM_KEY_NUMBER, .fallback = NAN, .least = 0, .most = 1,
     .above = true, .below = true, .otherwise = "must be given beside stop_when",
     .help = "The run ends when the size of the column stop_when has fallen below this fraction of "
             "its peak.",
     .example = "0.3"},
    {TOP(mesh), .kind = CDEM_KEY_SECTION, .section = &cdem_section_mesh,
     .otherwise = "required by a body",
     .help = "The mesh of a body: a file, or a structured grid. A plain text is the file.",
     .example = "plate.geo"},
    {TOP(materials), .kind = CDEM_KEY_NAMED, .section = &cdem_section_materials,
     .otherwise = "required by a body",
     .help = "Materials of a body by name, and the groups that they fill.",
     .example = "{rock: {young: 30 GPa, poisson: 0.3, density: 2700 kg/m3}}"},
    {TOP(blocks), .kind = CDEM_KEY_SECTION, .section = &cdem_section_blocks,
     .otherwise = "each connected part of the mesh is one block",
     .help = "Where the mesh may come apart.", .example = "{breakable: rock}"},
    {TOP(interfaces), .kind = CDEM_KEY_LIST, .section = &cdem_section_interfaces,
     .otherwise = "none: faces between blocks are free from the start",
     .help = "Laws of the faces between blocks; the first entry that fits a face is its law.",
     .example = "[{tension: 1 MPa, cohesion: 3 MPa, friction: 0.3}]"},
    {TOP(contact), .kind = CDEM_KEY_SECTION, .section = &cdem_section_contact, .otherwise = "none",
     .help = "Contact between blocks that meet, and after interfaces have broken.",
     .example = "{friction: 0.3}"},
    {TOP(supports), .kind = CDEM_KEY_LIST, .section = &cdem_section_supports, .otherwise = "none",
     .help = "Prescribed displacements and velocities of groups.",
     .example = "[{group: bottom, displacement: {x: 0, y: 0}}]"},
    {TOP(loads), .kind = CDEM_KEY_LIST, .section = &cdem_section_loads, .otherwise = "none",
     .help = "Forces, tractions and pressures on groups.",
     .example = "[{group: top, traction: {y: {ramp: -1 MPa, over: 1 ms}}}]"},
    {TOP(plates), .kind = CDEM_KEY_NAMED, .section = &cdem_section_plates, .otherwise = "none",
     .help = "Rigid plates that push the surface and report their force.",
     .example = "{press: {point: [0, 0.1], normal: [0, -1], velocity: {y: -20 mm/s}}}"},
    {TOP(grains), .kind = CDEM_KEY_SECTION, .section = &cdem_section_grains,
     .otherwise = "required by a run of grains",
     .help = "Grains in place of a body: discs or spheres, where they are and how they touch.",
     .example =
         "{dimension: 2, packing: {kind: hexagonal, low: [0, 0], high: [1, 1], radius: 0.05}, "
         "materials: {sand: {density: 2600 kg/m3}}}"},
    {TOP(contacts), .kind = CDEM_KEY_LIST, .section = &cdem_section_contacts,
     .otherwise = "required by a run of grains",
     .help = "Numbers of the contact law of grains; the first entry that fits a pair of materials "
             "is its law.",
     .example =
         "[{normal_stiffness: 1e6 N/m, shear_ratio: 0.2857, friction: 0.5, restitution: 0.8}]"},
    {TOP(walls), .kind = CDEM_KEY_NAMED, .section = &cdem_section_walls, .otherwise = "none",
     .help = "Rigid walls that grains touch, by name.",
     .example = "{floor: {shape: plane, center: [0, 0], normal: [0, 1]}}"},
    {TOP(bonds), .kind = CDEM_KEY_LIST, .section = &cdem_section_bonds, .otherwise = "none",
     .help =
         "Grains that are held together from the start; the first entry that fits a pair is its "
         "law.",
     .example = "[{normal_stiffness: 1e6 N/m, shear_stiffness: 3e5 N/m, tension: 10 N}]"},
    {TOP(cell), .kind = CDEM_KEY_SECTION, .section = &cdem_section_cell, .otherwise = "none",
     .help = "The box in which grains are periodic, and how it deforms.",
     .example = "{low: [0, 0], size: [1, 1], periodic: [x, y]}"},
    {TOP(coupling), .kind = CDEM_KEY_SECTION, .section = &cdem_section_coupling,
     .otherwise = "a case is of a body or of grains",
     .help =
         "Grains inside a body: a coarse medium (mesh, materials) around a fine region of grains.",
     .example = "{regions: [{low: [-3.5 m, -3.5 m], high: [3.5 m, 0]}], cycles: 10}"},
    {TOP(triaxial), .kind = CDEM_KEY_SECTION, .section = &cdem_section_triaxial,
     .otherwise = "none",
     .help =
         "A triaxial test of the cylinder of grains: consolidation under a pressure, then shear "
         "by the upper plate.",
     .example = "{pressure: 0.9 MPa, strain: 0.15}"},
    {TOP(initial), .kind = CDEM_KEY_LIST, .section = &cdem_section_initial, .otherwise = "at rest",
     .help = "Velocities at the start.",
     .example = "[{groups: projectile, velocity: [10 m/s, 0]}]"},
    {TOP(probes), .kind = CDEM_KEY_NAMED, .section = &cdem_section_probes, .otherwise = "none",
     .help = "Further columns of history.csv by name.",
     .example = "{tip: {group: tip, quantity: displacement, component: y}}"},
    {TOP(curves), .kind = CDEM_KEY_NAMED, .section = &cdem_section_curves, .otherwise = "none",
     .help = "Figures by name, drawn from columns of history.csv.",
     .example = "{load: {x: top_y, y: top_force}}"},
    {TOP(results), .kind = CDEM_KEY_NAMED, .section = &cdem_section_results, .otherwise = "none",
     .help =
         "Key numbers of the run by name, for summary.json and for comparison with a reference.",
     .example = "{peak: {of: top_force, take: max}}"},
};

static const cdem_case_section root = SECTION(
    "case", cdem_case_values, keys, .help = "A case: what to run, on what, and what to keep.");

const cdem_case_section *cdem_case_root(void) {
  return &root;
}
