/* Contact laws: the force between two grains, or a grain and a wall, as one table.
 *
 * Signs. n is the unit vector from the centre of A to B (to the wall: towards it), t = (-n_y, n_x)
 * in 2-D. overlap = rA + rB - |xB - xA| > 0 in contact. The arms a_A, a_B reach from the centres to
 * the contact point, a_A = rA L/(rA + rB), L the distance of the centres; to a wall a_A = rA -
 * overlap. Velocity of B against A where they touch: vB - vA - (a_A wA + a_B wB) x n. The force on
 * A is -F_N n + F_t, on B the opposite; the moment on A is a_A n x F_t + M, on B a_B n x F_t - M.
 * F_N >= 0: grains push. Bonds (bonds.h) may pull.
 *
 * One law = one file law_NAME.c with one cdem_law + one line in laws.def. Rolling and twisting
 * resistance are chosen beside it (resistance_NAME.c, resistances.def). Parameters come by the
 * words of law_keys.def; a law says which of them it wants. No law has a length, a time or a mass
 * of its own (exact scaling would find it): write Hertz as E sqrt(R d) d.
 */
#ifndef CDEM_DEM_LAW_H
#define CDEM_DEM_LAW_H

#include "base/base.h"
#include "base/quantity.h"

#include <stdbool.h>

/* The words. */
typedef enum {
#define X(name, length, time, mass, help) CDEM_LAW_##name,
#include "dem/law_keys.def"
#undef X
  CDEM_LAW_KEYS
} cdem_law_key;

typedef struct {
  const char *name; /* "normal_stiffness" */
  cdem_dimension dimension;
  const char *help;
} cdem_law_key_info;
/* NULL past the last. */
const cdem_law_key_info *cdem_law_key_get(int key);

/* What a material of grains or walls has of its own. */
typedef struct {
  char name[64];
  double density;        /* kg/m^3 */
  double young, poisson; /* Pa, -; NaN: none (laws that need them say so); young infinite: rigid */
} cdem_grain_material;

/* What was asked for between two materials: NaN where nothing was given. */
typedef struct {
  double value[CDEM_LAW_KEYS];
} cdem_contact_input;

/* What a law makes of it, in its own order. */
enum { CDEM_LAW_PARAMETERS = 24, CDEM_LAW_WANTS = 24, CDEM_LAW_HISTORY = 14 };
typedef struct {
  double p[CDEM_LAW_PARAMETERS];
} cdem_law_parameters;

typedef struct {
  cdem_law_key key;
  bool required;
  double fallback;    /* NaN: the law finds it by itself, or does without; see its help */
  double least, most; /* range; least == most: none */
  bool above;         /* least itself is not allowed */
} cdem_law_want;

typedef struct cdem_batch cdem_batch; /* dem/batch.h */

typedef struct {
  const char *name; /* "hertz" */
  const char *help; /* one line with its source */
  bool dims[4];     /* [2], [3]: does it know discs, spheres? */
  const char *why;  /* why not, when it does not know one of them */
  int wants;
  cdem_law_want want[CDEM_LAW_WANTS];
  /* History: numbers a contact remembers, as [2-D, 3-D] counts, and what becomes of each when A and
   * B change places (+1, -1). Vectors in the tangent plane turn with it (3-D: the first three
   * numbers, the next three, ...). */
  int history[2];
  double parity[2][CDEM_LAW_HISTORY];
  int tangent_vectors; /* how many of them come first */
  bool labels;         /* the force depends on which grain has the lower id (Li-Chu's F_r) */
  bool potential;      /* without damping and sliding the law is exactly conservative */
  bool rolls;          /* has rolling terms of its own: goes with rolling and twisting none only */
  /* From what was asked for to numbers; wants are checked and defaults filled in before. CDEM_INPUT
   * names the word. */
  cdem_status (*prepare)(int dim, const cdem_contact_input *input, const cdem_grain_material *a,
                         const cdem_grain_material *b, cdem_law_parameters *parameters,
                         cdem_fault *fault);
  /* Its shear stiffness, N/m; NULL: not constant. Rolling and twisting take their default from it.
   */
  double (*shear_stiffness)(const cdem_law_parameters *parameters);
  /* Forces of a batch of contacts that share their parameters: [2-D, 3-D][without, with energies].
   */
  void (*batch[2][2])(const cdem_law_parameters *parameters, cdem_batch *batch);
  /* The same, one contact at a time, in plain vector algebra and with energies: [2-D, 3-D]. What
   * the fast loops are tested against. */
  void (*one[2])(const cdem_law_parameters *parameters, cdem_batch *batch, int lane);
  /* Tangent normal and shear stiffness of a contact (N/m) with reduced radius and mass at this
   * overlap, for the time step; and the normal and the shear dashpot (N s/m). */
  void (*stiffness)(const cdem_law_parameters *parameters, double radius, double mass,
                    double overlap, double *normal, double *shear, double dashpot[2]);
  /* The part of the shear force that friction bounds, N; NULL: all of it. */
  double (*sliding)(const cdem_law_parameters *parameters, const cdem_batch *batch, int lane);
} cdem_law;

/* NULL past the last; by name: NULL when there is none. */
const cdem_law *cdem_law_at(int index);
const cdem_law *cdem_law_find(const char *name);

/* Rolling and twisting resistance: moments beside a law. Their history follows the law's. */
typedef struct {
  const char *name; /* "none", "constant", "spring" */
  const char *help;
  int wants;
  cdem_law_want want[8];
  int history[2]; /* 2-D, 3-D; at most 3 */
  double parity[2][3];
  bool tangent_vector;
  /* shear: the law's shear stiffness, N/m; 0 where it has no constant one. */
  cdem_status (*prepare)(int dim, const cdem_contact_input *input, double shear,
                         cdem_law_parameters *parameters, cdem_fault *fault);
  /* Adds to the moments; `first` is where its history begins. NULL: does nothing. */
  void (*batch[2][2])(const cdem_law_parameters *parameters, int first, cdem_batch *batch);
  void (*one[2])(const cdem_law_parameters *parameters, int first, cdem_batch *batch, int lane);
  /* Its stiffness against relative rotation, N m/rad, for the time step. */
  double (*stiffness)(const cdem_law_parameters *parameters, double radius); /* NULL: none */
} cdem_resistance;
const cdem_resistance *cdem_rolling_at(int index);
const cdem_resistance *cdem_rolling_find(const char *name);
const cdem_resistance *cdem_twisting_at(int index); /* 3-D only */
const cdem_resistance *cdem_twisting_find(const char *name);

/* Checks wants, fills defaults and prepares law, rolling and twisting for one pair of materials.
 * CDEM_INPUT: a word that is missing, out of range, or that neither law nor resistances know, with
 * the nearest one. Rolling and twisting may be NULL (none). */
typedef struct {
  const cdem_law *law;
  const cdem_resistance *rolling, *twisting;
  cdem_law_parameters parameters[3];   /* of law, rolling, twisting */
  int first[3];                        /* where the history of each begins */
  int histories;                       /* numbers a contact remembers, all together */
  double parity[CDEM_LAW_HISTORY + 4]; /* of each of them, when A and B change places */
  /* The finder fills arm and turning with the radii, a_A = rA and a_B = rB (wall: rA and 0),
   * instead of the way to the contact point: Li & Chu as printed. The moments use batch->arm. */
  bool arms_by_radius;
} cdem_contact_model;
cdem_status cdem_contact_model_init(int dim, const cdem_law *law, const cdem_resistance *rolling,
                                    const cdem_resistance *twisting,
                                    const cdem_contact_input *input, const cdem_grain_material *a,
                                    const cdem_grain_material *b, cdem_contact_model *model,
                                    cdem_fault *fault);

#endif
