/* Private to verify: a few grains and walls made into a solver with few words, for the checks of
 * the group dem.
 *
 * init, fill materials and contact words, add grains, walls and bonds, start, run. One thread
 * unless told otherwise. Zero-initialise; release at any stage.
 */
#ifndef CDEM_VERIFY_DEM_WORLD_H
#define CDEM_VERIFY_DEM_WORLD_H

#include "dem/dem.h"

enum { CDEM_DEM_WORLD_WALLS = 6 };

typedef struct {
  cdem_grains grains;
  cdem_grain_material material[2]; /* 0: grains; 1: walls, and what else is wanted */
  cdem_contact_input contact[4];   /* [2][2] */
  cdem_wall wall[CDEM_DEM_WORLD_WALLS];
  cdem_bond_law bond_law;
  cdem_bond *bond;
  int64_t bond_capacity;
  cdem_dem_options options; /* gravity, step, damping ...: may be set before the start */
  cdem_dem dem;
} cdem_dem_world;

/* Law and density of the grains. The walls' material is the grains', `rigid` times as stiff. */
cdem_status cdem_dem_world_init(cdem_dem_world *world, int dim, const char *law, double density,
                                cdem_fault *fault);
void cdem_dem_world_elastic(cdem_dem_world *world, double young, double poisson, double rigid);
/* A word of the contact law, for all pairs of materials. */
void cdem_dem_world_set(cdem_dem_world *world, cdem_law_key key, double value);
cdem_status cdem_dem_world_add(cdem_dem_world *world, const double place[3], double radius,
                               const double velocity[3], const double spin[3], cdem_fault *fault);
/* A plane through `center` whose grains are where `normal` (unit) points. */
cdem_status cdem_dem_world_plane(cdem_dem_world *world, const double center[3],
                                 const double normal[3], cdem_fault *fault);
cdem_status cdem_dem_world_bond(cdem_dem_world *world, int32_t a, int32_t b, cdem_fault *fault);
cdem_status cdem_dem_world_start(cdem_dem_world *world, cdem_fault *fault);
void cdem_dem_world_release(cdem_dem_world *world);

/* Grain by id, now; of a world of at most CDEM_DEM_WORLD_FEW grains. */
enum { CDEM_DEM_WORLD_FEW = 64 };
typedef struct {
  double place[3], velocity[3], spin[3], rotation[3], force[3];
  int32_t contacts;
} cdem_dem_grain;
cdem_dem_grain cdem_dem_world_grain(const cdem_dem_world *world, int64_t grain);

#endif
