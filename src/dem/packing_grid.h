/* Private to dem: who stands near a place, for packings. Grains come and go one by one.
 *
 * One grid of cells for each class of radii (halved from class to class), so that the work stays
 * O(1) a question whatever the size ratio: small grains are not looked for in cells made for large
 * ones. Grains are held by id in the grains the grid was made for; periodic faces answer with
 * images.
 */
#ifndef CDEM_DEM_PACKING_GRID_H
#define CDEM_DEM_PACKING_GRID_H

#include "dem/grains.h"

enum { CDEM_GRID_LEVELS = 8 };

typedef struct {
  double radius;   /* largest of this class */
  double edge[3];  /* of the cells */
  int64_t cell[3]; /* cells along each axis */
  int32_t *first;  /* [cells] id, -1: empty */
  int64_t grains;
} cdem_packing_level;

typedef struct {
  const cdem_grains *grains; /* borrowed; may grow */
  double low[3], length[3];
  bool periodic[3];
  int levels;
  cdem_packing_level level[CDEM_GRID_LEVELS];
  int32_t *next; /* [capacity] of the same cell, -1: last */
  int64_t capacity;
} cdem_packing_grid;

typedef struct {
  double place[3], radius; /* of the image that is near */
  int32_t grain;
} cdem_packing_near;
typedef struct {
  int64_t count, capacity;
  cdem_packing_near *near;
} cdem_packing_list;

/* For grains with radii from least to most, about `expected` of them. */
cdem_status cdem_packing_grid_init(cdem_packing_grid *grid, const cdem_grains *grains,
                                   const double low[3], const double high[3],
                                   const bool periodic[3], const double sizes[2], int64_t expected,
                                   cdem_fault *fault);
void cdem_packing_grid_release(cdem_packing_grid *grid);
cdem_status cdem_packing_grid_add(cdem_packing_grid *grid, int64_t grain, cdem_fault *fault);
/* Before its place changes. */
void cdem_packing_grid_remove(cdem_packing_grid *grid, int64_t grain);
/* Has a grain of this radius room here, with nobody closer than touching? */
bool cdem_packing_grid_is_free(const cdem_packing_grid *grid, const double place[3], double radius);
/* All grains whose surface is closer to the place than `reach`, in a fixed order; list->near is
 * kept from call to call, free() it at the end. */
cdem_status cdem_packing_grid_near(const cdem_packing_grid *grid, const double place[3],
                                   double reach, cdem_packing_list *list, cdem_fault *fault);

#endif
