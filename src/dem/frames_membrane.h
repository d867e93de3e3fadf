/* The membrane of a specimen as a frame, set "membrane": triangles where they are now, at their
 * nodes displacement, radial_displacement, velocity, and what grains do to it: contact_force, and
 * contact_pressure, its part along the normal by the area that the node has now. */
#ifndef CDEM_DEM_FRAMES_MEMBRANE_H
#define CDEM_DEM_FRAMES_MEMBRANE_H

#include "dem/membrane.h"
#include "results/frame.h"

cdem_status cdem_membrane_frame(const cdem_membrane *membrane, double time, int64_t index,
                                const cdem_frame_sink *sink, cdem_fault *fault);

#endif
