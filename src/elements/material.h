/* Materials: isotropic, orthotropic, fully anisotropic, Cosserat by moduli or by the contacts of
 * discs. SI units.
 *
 * A material is what a person can measure; moduli for a formulation follow from it. Stress and
 * strain in Voigt order (xx yy zz yz xz xy), shear strains engineering (gamma = 2 epsilon).
 *
 * Plane strain takes the in-plane rows and columns of the 6x6 stiffness; plane stress eliminates
 * the out-of-plane stresses (static condensation). Isotropic bounds: -1 < nu < 1/2 in solids and
 * plane strain, -1 < nu < 1 in plane stress (a two-dimensional body: beyond 1/2 no solid has such a
 * sheet, but a lattice has). Others must be positive definite.
 *
 * Plane Cosserat strain order: eps_xx, eps_yy, eps_xy = u_y,x - omega, eps_yx = u_x,y + omega,
 * kappa_x = omega,x, kappa_y = omega,y. Moduli (Li & Wan 2010, eqs 19-20):
 *     sxx = D11 exx + D12 eyy   sxy = D1212 exy + D1221 eyx   mx = Dm kappa_x
 * isotropic: D11 = lambda + 2G, D12 = lambda, D1212 = G + Gc, D1221 = G - Gc, Dm = f G l^2, with
 * the couple factor f declared: 1 as printed by Li & Wan, 2 de Borst, 4 the hole literature. Plane
 * stress replaces lambda by 2 lambda G/(lambda + 2G). The cubic model gives the plane moduli
 * themselves: its section's plane plays no part, and its axes are x and y.
 *
 * Three Cosserat models are made of the contacts of discs (docs/theory/cosserat.md). The section is
 * one layer of discs: they are as thick as it is, and their stiffness (N/m) is that of the whole
 * thickness, as in room dem. So D = NV k/thickness, and a body of any thickness answers with the
 * same force. NV = N r^2/area, N contacts counted once, = z phi/(2 pi) with coordination number z
 * and solid fraction phi. Lattice and average are plane moduli as the cubic model's are.
 */
#ifndef CDEM_ELEMENTS_MATERIAL_H
#define CDEM_ELEMENTS_MATERIAL_H

#include "base/base.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum { CDEM_PLANE_STRAIN, CDEM_PLANE_STRESS } cdem_plane;

/* How a 2-D body extends out of its plane; ignored by solids. */
typedef struct {
  cdem_plane plane;
  double thickness; /* m, > 0 */
} cdem_section;

typedef enum {
  CDEM_ISOTROPIC,        /* young, poisson */
  CDEM_ORTHOTROPIC,      /* e1 e2 e3 nu12 nu13 nu23 g12 g13 g23 */
  CDEM_ANISOTROPIC,      /* c11 .. c66, upper triangle, Voigt order, Pa */
  CDEM_COSSERAT,         /* young poisson cosserat_modulus characteristic_length couple_factor */
  CDEM_COSSERAT_CUBIC,   /* d11 d12 d1212 d1221 couple_modulus */
  CDEM_COSSERAT_LATTICE, /* normal_stiffness shear_stiffness rolling_stiffness radius */
  CDEM_COSSERAT_AVERAGE, /* the same and contact_density */
  CDEM_COSSERAT_PRINTED, /* the same and rolling_force_stiffness representative_length */
  CDEM_MATERIAL_MODEL_COUNT
} cdem_material_model;

enum { CDEM_MATERIAL_PARAMETERS = 21 };

typedef struct {
  char name[64];
  cdem_material_model model;
  double parameter[CDEM_MATERIAL_PARAMETERS]; /* in the order of the model's keys */
  bool rotated;                               /* the two axes below are given */
  double axis1[3],
      axis2[3]; /* material axes 1 and 2 in global coordinates; made orthonormal when used */
} cdem_material;

/* One key of a model: the table from which files are read and help is printed. */
typedef struct {
  const char *key;
  cdem_dimension dimension;
  bool optional;
  double fallback; /* value of an optional key */
  bool positive;   /* the value must be > 0; other bounds join several keys and stand in help */
  const char *help;
} cdem_material_key;

typedef struct {
  const char *name; /* "isotropic" */
  int keys;
  const cdem_material_key *key; /* [keys] */
  bool isotropic;               /* the same in all directions of the plane or of space: no axes */
  const char *help;
} cdem_material_model_info;

const cdem_material_model_info *cdem_material_model_get(cdem_material_model model);
/* By name; CDEM_MATERIAL_MODEL_COUNT when there is none. */
cdem_material_model cdem_material_model_find(const char *name);

static inline bool cdem_material_is_cosserat(const cdem_material *material) {
  return material->model >= CDEM_COSSERAT && material->model <= CDEM_COSSERAT_PRINTED;
}

/* The isotropic material most commands start from. Not checked here. */
cdem_material cdem_material_isotropic(double young, double poisson);

/* Characteristic length of a Cosserat material: sqrt(couple modulus / shear modulus), m; 0 for
 * others. */
double cdem_material_length(const cdem_material *material);

/* Rotational inertia of a point of a Cosserat material per mass, where nothing else is given, m^2:
 * r^2/2 of the discs it is made of, else the square of its length; 0 for others. */
double cdem_material_micro_inertia(const cdem_material *material);

/* Moduli (Pa; couple rows N): solid [6][6] in Voigt order, plane [3][3] (xx yy xy), plane Cosserat
 * [6][6] in the order above; row-major in d, *rows receives 6 or 3. `solid` true ignores section.
 * CDEM_INPUT names the key, its value and the bound when the material cannot be. */
typedef enum { CDEM_MODULI_SOLID, CDEM_MODULI_PLANE, CDEM_MODULI_PLANE_COSSERAT } cdem_moduli_kind;
cdem_status cdem_material_moduli(const cdem_material *material, cdem_moduli_kind kind,
                                 const cdem_section *section, double d[36], int *rows,
                                 cdem_fault *fault);

#endif
