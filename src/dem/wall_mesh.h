/* Private to dem: the facets of a mesh wall, in the body (about the center, in the directions of
 * the start), and a grid over them. */
#ifndef CDEM_DEM_WALL_MESH_H
#define CDEM_DEM_WALL_MESH_H

#include "dem/walls_store.h"

/* A triangle with the corners a, b, c, or a segment a, b. */
typedef struct {
  double a[3];
  double n[3];       /* unit, across */
  double e[3][3];    /* b - a, c - a, c - b; of a segment the first */
  double out[3][3];  /* unit, in the plane, out of the triangle across each edge */
  double offset;     /* out[2].(b - a) */
  double inverse[3]; /* 1/e.e */
} cdem_wall_facet;

struct cdem_wall_facets {
  int dim;
  int32_t facets;
  cdem_wall_facet *facet;
  double low[3], high[3]; /* box of the facets */
  double close;           /* points nearer than this are one point */

  /* Cells hold the facets whose boxes meet them. */
  double cell;
  int32_t cells[3];
  int32_t *first;  /* [cells + 1] */
  int32_t *member; /* facets of each cell, ascending */
};

/* Nearest point of a facet to x, if closer than `within`. */
typedef struct {
  double distance;
  double q[3]; /* the point */
  double n[3]; /* unit, from x to it */
  bool inside; /* not on an edge or corner */
} cdem_facet_near;
bool cdem_facet_nearest(int dim, const cdem_wall_facet *facet, const double x[3], double within,
                        cdem_facet_near *near);

/* wall_mesh_grid.c */
cdem_status cdem_wall_facets_check(int dim, const cdem_wall *wall, cdem_fault *fault);
cdem_status cdem_wall_facets_init(cdem_wall_body *body, int dim, const cdem_grains *grains,
                                  cdem_fault *fault);
void cdem_wall_facets_release(cdem_wall_body *body);
cdem_status cdem_wall_facets_collect(const cdem_dem_store *s, int32_t wall, cdem_wall_list *list,
                                     cdem_fault *fault);

#endif
