/* Grains, contacts and walls as frames, all VTK's.
 *
 *     grains    vertices at the centres: radius, displacement, rotation, velocity, spin, force,
 * stress, pressure, contacts, material, id; with a strain reference also volumetric_strain,
 *               effective_strain
 *     contacts  lines between centres (to the contact point of a wall; across a periodic cell to
 * the image): force on the first, push, normal, overlap, sliding, bonded, wall (its index, -1:
 * between grains) walls     lines or facets where they are now (endless ones end where all else
 * does): wall, velocity at points
 *     membrane  its triangles (frames_membrane.h)
 *     fields    points of a grid and the cells between them: density, solid, velocity, stress,
 *               stress_skew (axial vector w of its skew part W, W x = w cross x), pressure,
 *               wall_force; see coarse-grained fields in measures.h
 */
#ifndef CDEM_DEM_FRAMES_H
#define CDEM_DEM_FRAMES_H

#include "dem/dem.h"
#include "dem/measures.h"
#include "results/frame.h"

/* strain: NULL, or the reference for the fields volumetric_strain and effective_strain. */
cdem_status cdem_dem_frames(const cdem_dem *dem, const cdem_strain_reference *strain, int64_t index,
                            const cdem_frame_sink *sink, cdem_fault *fault);
/* The data set "fields". CDEM_USAGE: no such grid; CDEM_MEMORY. */
cdem_status cdem_dem_fields_frame(const cdem_dem *dem, const cdem_coarse_grid *grid, int64_t index,
                                  const cdem_frame_sink *sink, cdem_fault *fault);

#endif
