/* The state of a solver as frames: "body" (deformed mesh with displacement, velocity, stress,
 * strain, rotation, energy and force by spring class, block), "interfaces" (faces with state,
 * opening, slip, tractions, damage), "contacts" (points with force). */
#ifndef CDEM_CDEM_FRAMES_H
#define CDEM_CDEM_FRAMES_H

#include "cdem/solver.h"
#include "results/frame.h"

/* VTK's cell type of a first-order shape; 0: none. */
uint8_t cdem_frame_cell_type(cdem_shape shape);

/* Hands the data sets that the solver has to the sink, one after the other. */
cdem_status cdem_solver_frames(const cdem_solver *solver, int64_t index,
                               const cdem_frame_sink *sink, cdem_fault *fault);

#endif
