/* Templates: the mesh of a grain shape and its modes, once for all grains of that shape.
 *
 * The reference is dimensionless: centre of mass at the origin, volume that of the unit ball, so
 * that a grain of radius s (that of the ball of its volume) is the reference times s. Nodes: those
 * of the surface first. Masses are lumped (HRZ) and of density 1.
 *
 * A grain moves as a rigid body and deforms in the frame that goes with it, u = s Phi q, where the
 * columns of Phi are the elastic modes of the free body,
 *
 *     K phi = lambda M phi,   phi^T M phi = 1,   phi^T M (rigid motion) = 0 (1)
 *
 * K of the reference with the material's moduli (Pa), M dimensionless, so lambda is a pressure.
 * With density rho and size s the generalised mass is rho s^3, the stiffness s lambda and omega^2 =
 * lambda/(rho s^2): one template serves all sizes. All modes are kept unless `modes` says less, so
 * nothing is lost against the stiffness matrix; the last condition is the mean-axis (Tisserand)
 * frame, in which deforming moves neither momentum.
 *
 * One shape = one file shape_NAME.c + one line in shapes.def.
 */
#ifndef CDEM_FDEM_TEMPLATE_H
#define CDEM_FDEM_TEMPLATE_H

#include "elements/material.h"
#include "fdem/surface.h"

typedef struct {
  int refinement;        /* of shapes made by rule; each shape says what it means */
  const cdem_mesh *mesh; /* of shape `mesh`: any closed solid mesh; borrowed */
} cdem_grain_shape_options;

typedef struct {
  const char *name, *help;
  int least, most; /* refinements; 0, 0: none */
  bool ball;       /* a sphere, as far as the mesh can be one */
  /* Makes the mesh, of any size and anywhere. */
  cdem_status (*make)(const cdem_grain_shape_options *options, cdem_mesh *mesh, cdem_fault *fault);
} cdem_grain_shape;
const cdem_grain_shape *cdem_grain_shape_at(int index); /* NULL past the last */
const cdem_grain_shape *cdem_grain_shape_find(const char *name);

typedef struct {
  const cdem_grain_shape *shape;
  cdem_grain_shape_options options;
  const cdem_material *material; /* a classical solid; Pa */
  int modes;                     /* elastic modes kept, lowest first; 0: all */
} cdem_template_options;

typedef struct {
  cdem_mesh mesh;    /* the reference; surface nodes first */
  cdem_skin surface; /* its skin */
  int32_t nodes;     /* of the mesh */
  int modes;
  double *mass;      /* [nodes] sums to 4 pi/3 */
  double inertia[9]; /* of the reference about its centre, density 1 */
  double *lambda;    /* [modes] ascending, Pa */
  double *mode;      /* [modes][nodes][3]: a mode is contiguous; column-major Phi */
  double *skin;      /* [modes][surface.nodes][3]: the same at the surface */
  double *stiffness; /* [3 nodes][3 nodes] K of the reference, Pa; NULL unless asked to be kept */
} cdem_template;

/* CDEM_INPUT: refinement out of range, a mesh that is not one closed body of solid cells, a
 * material that is none; CDEM_NUMERIC: more than six motions without energy (a mechanism). */
cdem_status cdem_template_init(const cdem_template_options *options, bool keep_stiffness,
                               cdem_template *shape, cdem_fault *fault);
void cdem_template_release(cdem_template *shape);

#endif
