/* Room cdem: from continuum to discontinuum on spring networks.
 *
 * blocks      a mesh cut along the faces where it may break
 * body        the elastic network of all blocks, each element in its own rotating frame
 * interfaces  springs with strength between blocks
 * contact     what meets after breaking, or was never joined
 * solver      time, loads, damping, energy; the static solution
 * frames      the state as data sets for files and pictures
 *
 * The room knows networks and laws, not files: cases become solvers in room run.
 */
#ifndef CDEM_CDEM_CDEM_H
#define CDEM_CDEM_CDEM_H

#include "cdem/blocks.h"
#include "cdem/body.h"
#include "cdem/contact.h"
#include "cdem/frames.h"
#include "cdem/interfaces.h"
#include "cdem/solver.h"

#endif
