/* Walls as the solver sees them: made once, asked for every grain that is near one. */
#include "base/memory.h"
#include "dem/walls_store.h"

#include <stdlib.h>
#include <string.h>

/* One line a shape. */
static const cdem_wall_kind *const kinds[] = {
    [CDEM_WALL_PLANE] = &cdem_wall_plane_kind,
    [CDEM_WALL_PLATE] = &cdem_wall_plate_kind,
    [CDEM_WALL_CYLINDER] = &cdem_wall_cylinder_kind,
    [CDEM_WALL_MESH] = &cdem_wall_mesh_kind,
};

const cdem_wall_kind *cdem_wall_kind_of(cdem_wall_shape shape) {
  return (size_t)shape < sizeof kinds / sizeof *kinds ? kinds[shape] : NULL;
}

/* ---- making ---- */

/* Some unit vector across n. */
static void across(const double n[3], double out[3]) {
  int least = fabs(n[0]) <= fabs(n[1]) ? 0 : 1;
  least = fabs(n[2]) < fabs(n[least]) ? 2 : least;
  double e[3] = {0.0, 0.0, 0.0};
  e[least] = 1.0;
  cdem_cross3(n, e, out);
  cdem_wall_unit(out);
}

/* Unit directions of all shapes: normal and axis at right angles. */
static void set_directions(cdem_wall *wall, int dim) {
  if (wall->shape == CDEM_WALL_CYLINDER || wall->shape == CDEM_WALL_MESH) {
    if (dim == 2 || !cdem_wall_unit(wall->axis)) {
      wall->axis[0] = wall->axis[1] = 0.0;
      wall->axis[2] = 1.0;
    }
    across(wall->axis, wall->normal);
    return;
  }
  cdem_wall_unit(wall->normal);
  if (dim == 2) {
    wall->axis[0] = -wall->normal[1];
    wall->axis[1] = wall->normal[0];
    wall->axis[2] = 0.0;
  } else if (wall->shape == CDEM_WALL_PLATE) {
    cdem_wall_unit(wall->axis);
    double cosine = cdem_dot3(wall->axis, wall->normal);
    for (int c = 0; c < 3; c++)
      wall->axis[c] -= cosine * wall->normal[c];
    cdem_wall_unit(wall->axis);
  } else {
    across(wall->normal, wall->axis);
  }
}

cdem_status cdem_wall_body_init(cdem_wall_body *body, int dim, const cdem_wall *wall,
                                const cdem_grains *grains, cdem_fault *fault) {
  body->kind = cdem_wall_kind_of(wall->shape);
  body->wall = *wall;
  body->dim = dim;
  set_directions(&body->wall, dim);
  cdem_wall_motion_init(body);
  if (body->kind->init != NULL)
    CDEM_TRY(body->kind->init(body, dim, grains, fault));
  body->wall.corner = NULL;
  body->wall.facet = NULL;
  return CDEM_OK;
}

void cdem_wall_body_release(cdem_wall_body *body) {
  if (body->kind != NULL && body->kind->release != NULL)
    body->kind->release(body);
}

static cdem_status fill(cdem_dem_store *s, cdem_fault *fault) {
  const cdem_dem_options *o = &s->options;
  cdem_walls *walls = s->walls;
  CDEM_NEW(walls->body, o->walls, fault);
  CDEM_NEW(walls->row, s->grains + 1, fault);
  CDEM_NEW(walls->fill, s->grains + 1, fault);
  walls->walls = o->walls;
  for (int w = 0; w < o->walls; w++) {
    CDEM_TRY(cdem_wall_body_init(walls->body + w, s->dim, o->wall + w, o->grains, fault));
    walls->meshes = walls->meshes || o->wall[w].shape == CDEM_WALL_MESH;
  }
  return CDEM_OK;
}

cdem_status cdem_walls_init(cdem_dem_store *s, cdem_fault *fault) {
  if (s->options.walls <= 0)
    return CDEM_OK;
  for (int w = 0; w < s->options.walls; w++)
    CDEM_TRY(cdem_wall_check(s->dim, s->options.wall + w, fault));
  CDEM_NEW(s->walls, 1, fault);
  cdem_status status = fill(s, fault);
  if (status != CDEM_OK)
    cdem_walls_release(s);
  return status;
}

static void release_slots(cdem_wall_slots *slots) {
  free(slots->wall);
  free(slots->facet);
  free(slots->id);
  free(slots->touch);
  free(slots->last);
  free(slots->history);
}

void cdem_walls_release(cdem_dem_store *s) {
  cdem_walls *walls = s->walls;
  if (walls == NULL)
    return;
  for (int w = 0; w < walls->walls; w++)
    cdem_wall_body_release(walls->body + w);
  release_slots(&walls->slots);
  release_slots(&walls->old);
  free(walls->list.item);
  free(walls->body);
  free(walls->row);
  free(walls->fill);
  free(walls);
  s->walls = NULL;
}

/* ---- every step ---- */

const int32_t *cdem_walls_rows(const cdem_dem_store *s) {
  return s->walls != NULL ? s->walls->row : NULL;
}

/* One wall of one piece, one grain. */
static inline int find_one(cdem_walls *walls, int32_t slot, const double x[3], double radius,
                           cdem_wall_touch *touch) {
  const cdem_wall_body *body = walls->body + walls->slots.wall[slot];
  cdem_wall_near near;
  if (!body->here || !body->kind->nearest(body, x, radius, &near)) {
    walls->slots.touch[slot] = 0;
    return 0;
  }
  touch->wall = walls->slots.wall[slot];
  touch->slot = slot;
  for (int c = 0; c < 3; c++)
    touch->n[c] = near.n[c];
  cdem_wall_fill(body, x, radius, near.distance, touch);
  return 1;
}

int cdem_walls_find(cdem_dem_store *s, int32_t i, cdem_wall_touch touch[CDEM_WALL_TOUCHES]) {
  cdem_walls *walls = s->walls;
  const double *x = cdem_place(s, i);
  int32_t k = walls->row[i], end = walls->row[i + 1];
  int count = 0;
  while (k < end) {
    int32_t wall = walls->slots.wall[k];
    const cdem_wall_body *body = walls->body + wall;
    int32_t last = k + 1;
    while (last < end && walls->slots.wall[last] == wall)
      last++;
    if (count == CDEM_WALL_TOUCHES || (!body->here && body->facets != NULL)) {
      memset(walls->slots.touch + k, 0, (size_t)(last - k));
    } else if (body->facets == NULL) {
      count += find_one(walls, k, x, x[3], touch + count);
    } else {
      cdem_wall_finding finding = {s, wall, k, last, {x[0], x[1], x[2]}, x[3]};
      count += body->kind->find(&finding, CDEM_WALL_TOUCHES - count, touch + count);
    }
    k = last;
  }
  return count;
}

double *cdem_walls_history(cdem_dem_store *s, const cdem_wall_touch *touch, bool *fresh) {
  cdem_wall_slots *slots = &s->walls->slots;
  double *history = slots->history + (int64_t)s->histories * touch->slot;
  *fresh = slots->touch[touch->slot] == 0;
  if (*fresh) {
    memset(history, 0, (size_t)s->histories * sizeof *history);
    slots->touch[touch->slot] = 1;
  }
  return history;
}

/* Forces are the solver's to fill in. */
void cdem_walls_now(const cdem_dem_store *s, int wall, cdem_dem_wall *now) {
  const cdem_wall_body *body = s->walls->body + wall;
  for (int c = 0; c < 3; c++) {
    now->center[c] = body->center[c];
    now->moved[c] = body->center[c] - body->wall.center[c];
    now->velocity[c] = body->velocity[c];
  }
}
