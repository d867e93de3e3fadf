/* Room cases: what a person can ask for, as one table and one typed case.
 *
 * The table (schema.h) knows each key's kind, dimension, default, range, grain/domain tag and help.
 * Reading (io/case_file.c), `cdem help case`, the JSON Schema, docs/reference/case.md and, later,
 * exact scaling follow from it. To add a key: a member here, a line in the table of its section.
 *
 * Numbers are SI. A number that was not given and has no default is NaN. Texts are owned.
 */
#ifndef CDEM_CASES_CASE_H
#define CDEM_CASES_CASE_H

#include "base/base.h"
#include "base/series.h"
#include "dem/law.h"
#include "elements/material.h"

#include <stdbool.h>

/* Lists of the case: `item` [count]; all of one layout, so that the table can serve each. */
#define CDEM_CASE_LIST(type)                                                                       \
  struct {                                                                                         \
    int64_t count;                                                                                 \
    type *item;                                                                                    \
  }
typedef CDEM_CASE_LIST(char *) cdem_case_texts;

/* name: value, for the parameters of a .geo file. */
typedef struct {
  char *name;
  double value;
} cdem_case_parameter;

/* mesh: */
typedef struct {
  char *file;                                     /* as written; relative to the case file */
  CDEM_CASE_LIST(cdem_case_parameter) parameters; /* of a .geo file: DefineConstant */
  double unit;                                    /* m, one unit of the file's coordinates; 1 m */
  /* or a structured grid: */
  int shape;         /* 0: none; else 1 + index into the choices tri3 quad4 tet4 pyr5 wedge6 hex8 */
  double count[3];   /* bricks a direction */
  double size[3];    /* m */
  double origin[3];  /* m */
  double distortion; /* 0 .. 0.25 */
  int64_t seed;
} cdem_case_mesh;

/* the choices of materials.NAME.tension */
typedef enum { CDEM_CASE_TENSION_ELASTIC, CDEM_CASE_TENSION_NONE } cdem_case_tension;

/* materials: NAME: */
typedef struct {
  char *name;
  cdem_material material;
  double density;         /* kg/m^3; NaN: none (static runs without gravity) */
  double micro_inertia;   /* m^2; NaN: cdem_material_micro_inertia */
  int tension;            /* cdem_case_tension */
  cdem_case_texts groups; /* none: wherever no other material is */
} cdem_case_material;

/* blocks: */
typedef struct {
  cdem_case_texts breakable, separate, joints;
} cdem_case_blocks;

/* interfaces: - ; the first entry that fits a face is its law */
typedef struct {
  cdem_case_texts between; /* none or two groups of volumes (may be the same) */
  char *joint;             /* or a group of faces */
  int insertion;           /* penalty tied */
  double stiffness_factor; /* kn = factor (lambda + 2G)/h of the stiffer neighbour; 10 */
  double shear_ratio;      /* ks/kn; NaN: G/(lambda + 2G) of that neighbour */
  double normal_stiffness, shear_stiffness; /* Pa/m, instead of the factor */
  double tension, cohesion;                 /* Pa */
  double friction, dilation;                /* tan phi, tan psi */
  int softening;                            /* brittle linear */
  int unloading;                            /* elastic origin */
  double energy_1, energy_2;                /* J/m^2 */
} cdem_case_interface;

/* contact: */
typedef struct {
  bool active; /* read: true where the section is there */
  double stiffness_factor, shear_ratio, normal_stiffness, shear_stiffness; /* as above */
  double friction, damping;
  double skin;    /* m; NaN: automatic */
  double release; /* fraction of a face after which a broken interface becomes contact; 0.05 */
} cdem_case_contact;

/* components x y z rotation, each a function of time or not given (points == 0 and given false) */
typedef struct {
  bool given[4];
  cdem_series component[4];
} cdem_case_components;

/* supports: - */
typedef struct {
  char *group;
  cdem_case_components displacement; /* m; rotation rad */
  cdem_case_components velocity;     /* m/s */
} cdem_case_support;

/* loads: - */
typedef struct {
  char *group;
  cdem_case_components force;    /* N, total, spread over the group by area (points: evenly) */
  cdem_case_components traction; /* Pa, fixed in direction */
  bool has_pressure;
  cdem_series pressure; /* Pa, follows the surface */
  /* exact tractions of Kirsch's solution (uniaxial tension along x, hole at `center`) */
  double kirsch_tension, kirsch_radius; /* Pa, m; NaN: none */
  double kirsch_center[3];
} cdem_case_load;

/* plates: NAME: */
typedef struct {
  char *name;
  double point[3], normal[3], axis[3], half_size[2];
  cdem_case_components velocity;
  double stiffness_factor, normal_stiffness, shear_ratio, friction;
} cdem_case_plate;

/* initial: - */
typedef struct {
  cdem_case_texts groups; /* none: everywhere */
  double velocity[3];     /* m/s */
  double spin[3];         /* rad/s about `center` */
  double center[3];
} cdem_case_initial;

/* ---- grains ---- */

/* grains: materials: NAME: */
typedef struct {
  char *name;
  double density;        /* kg/m^3 */
  double young, poisson; /* Pa, -; NaN: none */
} cdem_case_grain_material;

/* grains: packing: classes: - ; of sizes: table */
typedef struct {
  double radius, fraction; /* m; of the solid volume (area) */
} cdem_case_size_class;

/* grains: packing: compact: */
typedef struct {
  double fraction, pressure, height; /* -, Pa, m; NaN: another one decides */
  double stiffness;                  /* N/m; NaN: from the pressure */
  double friction, restitution;
} cdem_case_compact;

/* grains: packing: */
typedef struct {
  int kind; /* index into packings.def */
  double low[3], high[3];
  bool centres_inside, cylinder;
  cdem_case_texts periodic; /* x y z; none: those of the cell */
  double radius;            /* m; NaN: none */
  int sizes;                /* cdem_size_kind */
  double least, most, exponent, spread;
  CDEM_CASE_LIST(cdem_case_size_class) classes;
  int64_t count;   /* 0: by fraction */
  double fraction; /* NaN: none */
  int64_t seed;
  cdem_case_compact compact;
} cdem_case_packing;

/* grains: picture_ranges: ends of the colour bars, in the order of the names of pictures; equal:
 * automatic */
typedef struct {
  double radius[2], speed[2], displacement[2], rotation[2], pressure[2], effective_stress[2],
      volumetric_strain[2], effective_strain[2], contacts[2], chains[2], velocities[2];
} cdem_case_picture_ranges;

/* grains: picture_window: low >= high in a direction: all of it */
typedef struct {
  double low[3], high[3];
  cdem_case_texts of; /* pictures; none: all */
} cdem_case_picture_window;

/* grains: fields: a grid of points; without count there is none */
typedef struct {
  double low[3], high[3]; /* m */
  double count[3];        /* points a direction, whole numbers; discs: the third is 0 */
  double width;           /* of the average, m; NaN: two mean diameters */
} cdem_case_fields;

/* grains: deformable: */
typedef struct {
  int shape;          /* index into fdem/shapes.def */
  int64_t refinement; /* of the shape */
  char *file;         /* mesh of a grain, as written; relative to the case file */
  int64_t modes;      /* elastic modes kept; 0: all */
  int integration;    /* implicit explicit */
  double damping_ratio;
  bool aligned; /* all grains stand as their mesh does; else turned at random */
  int64_t seed; /* of these turns */
} cdem_case_deformable;

/* grains: */
enum { CDEM_CASE_PICTURE_TIMES = 8, CDEM_CASE_FIELD_POINTS = 100000000 };
typedef struct {
  int64_t dimension;          /* 2 or 3 */
  int law, rolling, twisting; /* index into laws.def, resistances.def */
  char *file;                 /* as written; relative to the case file */
  cdem_case_packing packing;
  cdem_case_deformable deformable;
  char *material; /* of grains whose file names none; NULL: the first one */
  CDEM_CASE_LIST(cdem_case_grain_material) materials;
  double most_overlap;      /* of grains at the start, in radii of the smaller one */
  double skin;              /* of the neighbour list, in mean radii; NaN: automatic */
  cdem_case_texts pictures; /* of the last state; none: the usual ones */
  cdem_case_picture_window picture_window;
  cdem_case_picture_ranges picture_ranges;
  double picture_times[CDEM_CASE_PICTURE_TIMES]; /* s, earlier states; 0: none */
  cdem_case_fields fields;
} cdem_case_grains;

/* contacts: - ; the first entry that fits a pair of materials is its law */
typedef struct {
  cdem_case_texts between;     /* none or two materials of grains (may be the same) */
  double value[CDEM_LAW_KEYS]; /* the words of law_keys.def; NaN: not given */
} cdem_case_grain_contact;

/* walls: NAME: */
typedef struct {
  char *name;
  int shape; /* cdem_wall_shape */
  char *material;
  double center[3], normal[3], axis[3], half_size[2], radius;
  bool outside;
  char *file, *group; /* of a mesh; NULL: none, all of the file */
  double unit;
  cdem_case_components velocity, spin; /* x y z; 2-D: the spin about z */
  double servo[3];
  bool has_servo_force;
  cdem_series servo_force;
  double servo_speed, servo_gain;
  double start, stop; /* s; stop NaN: never */
} cdem_case_wall;

/* bonds: - ; all pairs of the materials that are closer than the gap at the start */
typedef struct {
  cdem_case_texts between;
  double gap; /* between the surfaces, in mean radii of the pair */
  double normal_stiffness, shear_stiffness, rolling_stiffness, twisting_stiffness;
  double damping_ratio, tension, cohesion, friction, moment;
} cdem_case_bond;

/* cell: rate: and cell: stress: */
typedef struct {
  bool given[9];
  cdem_series component[9]; /* row-major: xx xy xz yx .. zz */
} cdem_case_tensor;

/* cell: */
typedef struct {
  double low[3], size[3]; /* m; size 0: that of the packing */
  double tilt[3];         /* xy, xz, yz: how far the edges y and z lean */
  cdem_case_texts periodic;
  cdem_case_tensor rate, stress; /* 1/s; Pa, compression positive, diagonal only */
  double servo_rate, servo_gain;
} cdem_case_cell;

/* triaxial: membrane: ; NaN: by dimensionless numbers (dem/membrane.h) */
typedef struct {
  double spacing, penalty, contact_damping;
  double young, poisson, thickness, bending, damping;
  double areal_density;
  int edges; /* clamped free */
} cdem_case_membrane;

/* triaxial: */
typedef struct {
  double pressure;
  int boundary;                 /* cdem_triaxial_boundary */
  double consolidation;         /* s; NaN: by dimensionless numbers */
  double rate, inertial_number; /* 1/s, -; NaN: the other one, 1e-3 */
  double strain;
  char *material;      /* NULL: the first */
  char *side_material; /* NULL: `material` */
  cdem_case_membrane membrane;
} cdem_case_triaxial;
enum { CDEM_TRIAXIAL_MEMBRANE, CDEM_TRIAXIAL_CYLINDER }; /* the choices of `boundary` */

/* probes: NAME: region: of grains, coupling: regions: - ; low >= high in a direction: all of it */
typedef struct {
  double low[3], high[3];
} cdem_case_region;

typedef enum { /* coupling: version: which of the models of one problem is run */
               CDEM_VERSION_COUPLED,
               CDEM_VERSION_FROZEN, /* interface grains at rest, no coarse medium: the null test */
               CDEM_VERSION_GRAINS, /* grains everywhere */
               CDEM_VERSION_CONTINUUM /* the coarse medium everywhere */
} cdem_case_version;

/* coupling: grains inside a body */
typedef struct {
  int version;                              /* cdem_case_version */
  CDEM_CASE_LIST(cdem_case_region) regions; /* boxes whose elements are the fine region */
  int form;                                 /* interface virtual-work */
  int64_t cycles;        /* steps of the grains a step of the body; 0: as many as are stable */
  int interface_motion;  /* within a step of the body: velocity acceleration */
  int rotation;          /* micro-rotation of the coarse medium: physical scaled */
  double interface_gap;  /* of interface grains to fine ones, in largest radii */
  double absorb;         /* 1/s, of the absorbing layer; 0: none */
  int64_t absorb_layers; /* elements it is wide */
} cdem_case_coupling;

/* probes: NAME: a column of history.csv */
typedef struct {
  char *name;
  char *group;   /* of a body */
  int quantity;  /* displacement velocity force stress; force is the sum, others means over the
                    group;  of grains: velocity stress count mass solid coordination surface_angle
                    center stress_ratio ...; see the enum */
  int component; /* x y z rotation, xx yy zz yz xz xy, magnitude */
  cdem_case_region region; /* of grains */
  int surface;             /* cdem_surface_kind */
} cdem_case_probe;

enum { /* the choices of `quantity` */
       CDEM_PROBE_DISPLACEMENT,
       CDEM_PROBE_VELOCITY,
       CDEM_PROBE_FORCE,
       CDEM_PROBE_STRESS,
       CDEM_PROBE_COUNT,
       CDEM_PROBE_MASS,
       CDEM_PROBE_SOLID,
       CDEM_PROBE_COORDINATION,
       CDEM_PROBE_SURFACE_ANGLE,
       CDEM_PROBE_CENTER,
       CDEM_PROBE_STRESS_RATIO,
       CDEM_PROBE_BAND_ANGLE,
       CDEM_PROBE_BAND_SLENDERNESS,
       CDEM_PROBE_MEAN_PUSH,
       CDEM_PROBE_BOUNDARY_PUSH,
       CDEM_PROBE_FABRIC,
       CDEM_PROBE_ANISOTROPY,
       CDEM_PROBE_MECHANICAL_COORDINATION,
       CDEM_PROBE_RATTLERS
};

/* curves: NAME: a figure drawn from history.csv */
typedef struct {
  char *name;
  char *title;
  char *x;                 /* column */
  cdem_case_texts y;       /* columns */
  double x_scale, y_scale; /* factors before drawing (-1 turns compression positive) */
  char *x_label, *y_label;
} cdem_case_curve;

/* results: of a run, key numbers in summary.json: NAME: {of: column, take: max} */
typedef struct {
  char *name;
  char *of;
  int take;                    /* CDEM_TAKE_MAX .. */
  char *along;                 /* column in which a place lies; NULL: time */
  double from, to;             /* rows of this time only, s; NaN: of all */
  double factor;               /* multiplies the column before */
  double reference, tolerance; /* expected value and relative tolerance; NaN: none */
  cdem_case_texts against;     /* columns whose sum, taken alike, is the reference */
  double against_factor;       /* multiplies that sum before */
} cdem_case_key_result;

enum { /* the choices of `take` */
       CDEM_TAKE_MAX,
       CDEM_TAKE_MIN,
       CDEM_TAKE_LAST,
       CDEM_TAKE_MEAN,
       CDEM_TAKE_SLOPE,
       CDEM_TAKE_SCATTER,
       CDEM_TAKE_PLACE_OF_MAX,
       CDEM_TAKE_PLACE_OF_MIN
};

typedef enum {
  CDEM_ANALYSIS_DYNAMIC,
  CDEM_ANALYSIS_RELAXATION,
  CDEM_ANALYSIS_STATIC
} cdem_analysis;

typedef struct {
  char *title;
  int analysis;     /* cdem_analysis */
  int plane;        /* strain stress */
  double thickness; /* m */
  bool cosserat;    /* no key: whether the materials are Cosserat */
  double end;       /* s; static: the time at which loads and supports are taken, 0; triaxial: NaN,
                       found by the run */
  double step, safety;                /* s; NaN: automatic */
  double mass_damping, local_damping; /* 1/s; 1. Read: local 0.8 in a relaxation unless given */
  double tolerance;                   /* unbalanced-force ratio of a relaxation */
  int64_t most_steps;                 /* of a relaxation */
  double gravity[3];
  cdem_case_texts quiet;                               /* groups of faces */
  double history_every, frame_every, checkpoint_every; /* s of the run; NaN: end/400, end/20, 5 min
                                                          of wall time */
  char *stop_when;   /* name of a history column: the run ends when ... */
  double stop_below; /* ... its size falls below this fraction of its peak (after the peak) */
  cdem_case_mesh mesh;
  CDEM_CASE_LIST(cdem_case_material) materials;
  cdem_case_blocks blocks;
  CDEM_CASE_LIST(cdem_case_interface) interfaces;
  cdem_case_contact contact;
  CDEM_CASE_LIST(cdem_case_support) supports;
  CDEM_CASE_LIST(cdem_case_load) loads;
  CDEM_CASE_LIST(cdem_case_plate) plates;
  cdem_case_grains grains;
  CDEM_CASE_LIST(cdem_case_grain_contact) contacts;
  CDEM_CASE_LIST(cdem_case_wall) walls;
  CDEM_CASE_LIST(cdem_case_bond) bonds;
  cdem_case_cell cell;
  cdem_case_coupling coupling;
  cdem_case_triaxial triaxial;
  CDEM_CASE_LIST(cdem_case_initial) initial;
  CDEM_CASE_LIST(cdem_case_probe) probes;
  CDEM_CASE_LIST(cdem_case_curve) curves;
  CDEM_CASE_LIST(cdem_case_key_result) results;
} cdem_case_values;

typedef struct cdem_case_places cdem_case_places; /* private: where each value stands in the file */

typedef struct {
  char *path;   /* of the file */
  char *source; /* its text, with overrides applied where there were any */
  cdem_case_values values;
  cdem_case_places *places;
} cdem_case;

/* Safe on a zeroed case and twice. */
void cdem_case_release(cdem_case *cases);

/* Whether the file or an override gave this key ("mesh.size", "loads[0]"). */
bool cdem_case_given(const cdem_case *cases, const char *key);
/* A case is of grains, of a body, or of both. */
bool cdem_case_has_grains(const cdem_case *cases);
/* ... that deform? */
bool cdem_case_has_deformable(const cdem_case *cases);
bool cdem_case_is_coupled(const cdem_case *cases);
bool cdem_case_is_triaxial(const cdem_case *cases);

/* Is direction 0, 1, 2 among the texts x, y, z? */
bool cdem_case_names_direction(const cdem_case_texts *directions, int direction);

/* A failure that has to do with the value at `key` ("supports[1].group", "step"): the message gets
 * file:line:column and the line with a caret. A key that was not given: the nearest section above
 * it. */
__attribute__((format(printf, 5, 6))) cdem_status
cdem_case_fail(const cdem_case *cases, const char *key, cdem_status status, cdem_fault *fault,
               const char *format, ...);
/* The same for a message another room made. */
cdem_status cdem_case_blame(const cdem_case *cases, const char *key, cdem_fault *fault);

#endif
