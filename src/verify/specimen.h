/* A specimen: one element of known shape, and its spring tensors as functions of Poisson's ratio.
 * What `cdem poisson` tabulates and half of the verification measures.
 *
 * Reference shapes have edges of length 1 (m) unless scaled: square, equilateral triangle, cube,
 * regular tetrahedron, prism of triangle and height 1, pyramid of square base and height 1/sqrt(2)
 * (all eight edges 1); mid-edge nodes stand in the middle. Node order is the element's own.
 *
 * Blocks of Cosserat elements have omega scaled by the rotation length, so that entries are N/m.
 */
#ifndef CDEM_VERIFY_SPECIMEN_H
#define CDEM_VERIFY_SPECIMEN_H

#include "elements/elements.h"
#include "springs/closed.h"
#include "springs/poisson.h"

/* Zero-initialise; what is left zero is 1 (young, thickness, box, Cosserat parameters). */
typedef struct {
  const cdem_element *element;
  double young;  /* Pa */
  double box[3]; /* factors of the reference shape, m */
  cdem_section section;
  double cosserat_ratio; /* Gc/G: kept while nu changes */
  double length;         /* characteristic length of Cosserat elements, m */
  double couple_factor;
  /* [nodes] the element's own shape instead, m; NULL: reference. Copied, then NULL. */
  const double (*xyz)[3];
} cdem_specimen_options;

typedef struct {
  cdem_specimen_options options;
  cdem_tabulation tabulation;
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  double *moment;             /* [pairs][features*features][CDEM_LANES] */
  cdem_poisson_family family; /* without context, closed and frame */
  bool own_shape;             /* options.xyz was given */
  bool regular; /* reference shape with equal factors: the cube, the equilateral triangle */
} cdem_specimen;

/* CDEM_INPUT when the element is not usable (inverted, flat). Zero-initialise; release at any
 * stage. */
cdem_status cdem_specimen_init(const cdem_specimen_options *options, cdem_specimen *specimen,
                               cdem_fault *fault);
void cdem_specimen_release(cdem_specimen *specimen);

/* The material at nu. */
cdem_material cdem_specimen_material(const cdem_specimen *specimen, double nu);

/* S of all pairs: s [pairs][dofs*dofs]. */
cdem_status cdem_specimen_blocks(const cdem_specimen *specimen, double nu, double *s,
                                 cdem_fault *fault);

/* One pair of a specimen; the context of its family. */
typedef struct {
  const cdem_specimen *specimen;
  int pair, node[2]; /* node: places in the element, from 0 */
  cdem_class class_;
} cdem_specimen_pair;

/* pair: 0 .. cdem_element_pairs - 1. */
cdem_specimen_pair cdem_specimen_pair_at(const cdem_specimen *specimen, int pair);

/* The family of a pair: blocks, the closed form where one is known (hex8 cubes, quad4 rectangles,
 * equilateral tri3), frames for body pairs. `pair` is borrowed. */
cdem_poisson_family cdem_specimen_family(cdem_specimen_pair *pair);

#endif
