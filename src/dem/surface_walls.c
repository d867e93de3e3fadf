#include "dem/surface_walls.h"

#include "dem/wall_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUND = 72 }; /* sides of a circle */

typedef struct {
  int dim;
  double low[3], high[3]; /* of what has an end */
  cdem_wall_surface *to;
  int32_t wall;
  const cdem_wall_body *body;
  cdem_fault *fault;
} drawing;

/* ---- pieces ---- */

static cdem_status put_facet(drawing *d, int corners, const double (*xyz)[3]) {
  cdem_wall_surface *to = d->to;
  int64_t *capacity = to->capacity, points = to->points + corners;
  CDEM_TRY(cdem_grow(&to->xyz, &capacity[0], 3 * points, sizeof *to->xyz, d->fault));
  CDEM_TRY(cdem_grow(&to->velocity, &capacity[1], 3 * points, sizeof *to->velocity, d->fault));
  CDEM_TRY(cdem_grow(&to->offset, &capacity[2], to->facets + 2, sizeof *to->offset, d->fault));
  CDEM_TRY(cdem_grow(&to->node, &capacity[3], points, sizeof *to->node, d->fault));
  CDEM_TRY(cdem_grow(&to->wall, &capacity[4], to->facets + 1, sizeof *to->wall, d->fault));
  for (int k = 0; k < corners; k++) {
    double arm[3], *velocity = to->velocity + 3 * to->points;
    memcpy(to->xyz + 3 * to->points, xyz[k], sizeof xyz[k]);
    for (int c = 0; c < 3; c++)
      arm[c] = xyz[k][c] - d->body->center[c];
    cdem_cross3(d->body->spin, arm, velocity);
    for (int c = 0; c < 3; c++)
      velocity[c] += d->body->velocity[c];
    to->node[to->points] = (int32_t)to->points;
    to->points++;
  }
  to->wall[to->facets++] = d->wall;
  to->offset[to->facets] = to->points;
  return CDEM_OK;
}

/* middle + a x + b y */
static void place(const double middle[3], double a, const double x[3], double b, const double y[3],
                  double out[3]) {
  for (int c = 0; c < 3; c++)
    out[c] = middle[c] + a * x[c] + b * y[c];
}

static cdem_status put_rectangle(drawing *d, const double middle[3], const double x[3],
                                 const double y[3], const double a[2], const double b[2]) {
  double xyz[4][3];
  for (int k = 0; k < 4; k++)
    place(middle, a[k == 1 || k == 2], x, d->dim == 2 ? 0.0 : b[k / 2], y, xyz[k]);
  return put_facet(d, d->dim == 2 ? 2 : 4, (const double(*)[3])xyz);
}

/* Range of the box along a direction, from a point. */
static void range_along(const drawing *d, const double from[3], const double direction[3],
                        double range[2]) {
  range[0] = range[1] = 0.0;
  for (int k = 0; k < (d->dim == 2 ? 4 : 8); k++) {
    double at = 0.0;
    for (int c = 0; c < d->dim; c++)
      at += ((k >> c & 1 ? d->high[c] : d->low[c]) - from[c]) * direction[c];
    range[0] = k == 0 || at < range[0] ? at : range[0];
    range[1] = k == 0 || at > range[1] ? at : range[1];
  }
}

/* ---- shapes ---- */

static void tangents(const drawing *d, const double normal[3], double x[3], double y[3]) {
  if (d->dim == 2) {
    x[0] = -normal[1];
    x[1] = normal[0];
    x[2] = y[0] = y[1] = y[2] = 0.0;
    return;
  }
  int least = 0;
  double length = 0.0;
  for (int c = 1; c < 3; c++)
    least = fabs(normal[c]) < fabs(normal[least]) ? c : least;
  for (int c = 0; c < 3; c++) {
    x[c] = (c == least ? 1.0 : 0.0) - normal[least] * normal[c];
    length += x[c] * x[c];
  }
  for (int c = 0; c < 3; c++)
    x[c] /= sqrt(length);
  cdem_cross3(normal, x, y);
}

static cdem_status put_plane(drawing *d) {
  double x[3], y[3], a[2], b[2] = {0.0, 0.0};
  tangents(d, d->body->normal, x, y);
  range_along(d, d->body->center, x, a);
  if (d->dim == 3)
    range_along(d, d->body->center, y, b);
  return put_rectangle(d, d->body->center, x, y, a, b);
}

static cdem_status put_plate(drawing *d) {
  const double *half = d->body->wall.half;
  const double a[2] = {-half[0], half[0]}, b[2] = {-half[1], half[1]};
  return put_rectangle(d, d->body->center, d->body->axis, d->body->third, a, b);
}

static cdem_status put_cylinder(drawing *d) {
  const cdem_wall_body *body = d->body;
  const double pi = 3.14159265358979323846, half = body->wall.half[0];
  double x[3] = {1.0, 0.0, 0.0}, y[3] = {0.0, 1.0, 0.0}, along[2] = {-half, half};
  if (d->dim == 3) {
    tangents(d, body->axis, x, y);
    if (half == 0.0)
      range_along(d, body->center, body->axis, along);
  }
  for (int k = 0; k < ROUND; k++) {
    double xyz[4][3];
    for (int n = 0; n < 4; n++) {
      double angle = 2.0 * pi * (k + (n == 1 || n == 2)) / ROUND;
      place(body->center, body->wall.radius * cos(angle), x, body->wall.radius * sin(angle), y,
            xyz[n]);
      for (int c = 0; c < 3 && d->dim == 3; c++)
        xyz[n][c] += along[n / 2] * body->axis[c];
    }
    CDEM_TRY(put_facet(d, d->dim == 2 ? 2 : 4, (const double(*)[3])xyz));
  }
  return CDEM_OK;
}

static cdem_status put_mesh(drawing *d) {
  const cdem_wall_facets *facets = d->body->facets;
  for (int32_t f = 0; f < facets->facets; f++) {
    const cdem_wall_facet *facet = &facets->facet[f];
    double xyz[3][3];
    for (int n = 0; n < d->dim; n++) {
      double corner[3];
      for (int c = 0; c < 3; c++)
        corner[c] = facet->a[c] + (n > 0 ? facet->e[n - 1][c] : 0.0);
      cdem_wall_turned(d->body->turn, corner, xyz[n]);
      for (int c = 0; c < 3; c++)
        xyz[n][c] += d->body->center[c];
    }
    CDEM_TRY(put_facet(d, d->dim, (const double(*)[3])xyz));
  }
  return CDEM_OK;
}

/* ---- all ---- */

static bool is_endless(const drawing *d, const cdem_wall *wall) {
  return wall->shape == CDEM_WALL_PLANE ||
         (wall->shape == CDEM_WALL_CYLINDER && d->dim == 3 && wall->half[0] == 0.0);
}

static void find_box(drawing *d, const cdem_dem_store *s) {
  for (int32_t i = 0; i < s->grains; i++)
    for (int c = 0; c < d->dim; c++) {
      const double *x = s->place + 4 * (int64_t)i;
      d->low[c] = i == 0 ? x[c] - x[3] : fmin(d->low[c], x[c] - x[3]);
      d->high[c] = i == 0 ? x[c] + x[3] : fmax(d->high[c], x[c] + x[3]);
    }
}

static cdem_status put_walls(drawing *d, const cdem_walls *walls, bool endless) {
  static cdem_status (*const put[])(drawing *) = {put_plane, put_plate, put_cylinder, put_mesh};
  for (d->wall = 0; d->wall < walls->walls; d->wall++) {
    d->body = &walls->body[d->wall];
    if (d->body->here && is_endless(d, &d->body->wall) == endless)
      CDEM_TRY(put[d->body->wall.shape](d));
  }
  return CDEM_OK;
}

cdem_status cdem_wall_surface_make(const cdem_dem *dem, cdem_wall_surface *surface,
                                   cdem_fault *fault) {
  drawing d = {.dim = dem->dim, .to = surface, .fault = fault};
  const cdem_walls *walls = dem->store->walls;
  *surface = (cdem_wall_surface){0};
  if (walls == NULL)
    return CDEM_OK;
  find_box(&d, dem->store);
  cdem_status status = put_walls(&d, walls, false);
  for (int64_t p = 0; p < surface->points; p++)
    for (int c = 0; c < d.dim; c++) {
      d.low[c] = fmin(d.low[c], surface->xyz[3 * p + c]);
      d.high[c] = fmax(d.high[c], surface->xyz[3 * p + c]);
    }
  if (status == CDEM_OK)
    status = put_walls(&d, walls, true);
  if (status != CDEM_OK)
    cdem_wall_surface_release(surface);
  return status;
}

void cdem_wall_surface_release(cdem_wall_surface *surface) {
  free(surface->xyz);
  free(surface->velocity);
  free(surface->offset);
  free(surface->node);
  free(surface->wall);
  *surface = (cdem_wall_surface){0};
}
