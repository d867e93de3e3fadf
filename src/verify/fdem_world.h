/* Private to verify: a few deformable grains and walls made into a solver with few words, for the
 * checks of the group fdem.
 *
 * init, add grains and walls, start, run; start again after other grains were added. One thread
 * unless told otherwise. Zero-initialise; release at any stage.
 */
#ifndef CDEM_VERIFY_FDEM_WORLD_H
#define CDEM_VERIFY_FDEM_WORLD_H

#include "base/random.h"
#include "fdem/fdem.h"

enum { CDEM_FDEM_WORLD_GRAINS = 64, CDEM_FDEM_WORLD_WALLS = 2 };

typedef struct {
  cdem_material rock;
  cdem_template shape;
  double xyz[3 * CDEM_FDEM_WORLD_GRAINS], radius[CDEM_FDEM_WORLD_GRAINS],
      velocity[3 * CDEM_FDEM_WORLD_GRAINS], spin[3 * CDEM_FDEM_WORLD_GRAINS],
      orientation[4 * CDEM_FDEM_WORLD_GRAINS], density;
  cdem_fdem_contact_law law;
  cdem_wall wall[CDEM_FDEM_WORLD_WALLS];
  cdem_fdem_options options; /* gravity, step, damping ...: may be set before the start */
  cdem_fdem fdem;
} cdem_fdem_world;

/* Rock of 2650 kg/m^3. `mesh` for the shape of that name. */
cdem_status cdem_fdem_world_init(cdem_fdem_world *world, const char *shape, int refinement,
                                 double young, double poisson, const cdem_mesh *mesh,
                                 cdem_fault *fault);
/* A grain at rest, turned as its mesh is; returns its number. No more than there is room for. */
int cdem_fdem_world_add(cdem_fdem_world *world, double x, double y, double z, double radius);
/* Any turn as likely as any other. */
void cdem_fdem_world_turn(cdem_fdem_world *world, int grain, cdem_random *random);
/* A plane through (0, 0, z) whose grains are where (nx, 0, nz), unit, points. */
cdem_wall *cdem_fdem_world_plane(cdem_fdem_world *world, double z, double nx, double nz);
cdem_status cdem_fdem_world_start(cdem_fdem_world *world, cdem_fault *fault);
void cdem_fdem_world_release(cdem_fdem_world *world);

/* Kinetic and stored energy together. */
double cdem_fdem_world_kept(const cdem_fdem_energies *energies);

#endif
