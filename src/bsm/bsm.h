/* Room bsm: the bridging scale, grains inside a continuum (Li & Wan 2010; docs/theory/bsm.md).
 *
 * weights      shape functions at places in a mesh
 * projector    what of the motion of grains a mesh can express; the split of energy
 * partition    which grains are calculated, which move with the coarse medium
 * tie          grains that move with a body, and their forces on it
 * traction     loads on the edge of the grains
 * absorb       a layer of fine elements that takes away waves too short for the mesh
 * coupling     body and grains in one time, with sub-cycles
 *
 * The room knows solvers, not cases; room run makes coupled runs of cases.
 */
#ifndef CDEM_BSM_BSM_H
#define CDEM_BSM_BSM_H

#include "bsm/absorb.h"
#include "bsm/coupling.h"
#include "bsm/partition.h"
#include "bsm/projector.h"
#include "bsm/tie.h"
#include "bsm/traction.h"
#include "bsm/weights.h"

#endif
