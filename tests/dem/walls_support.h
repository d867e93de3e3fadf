/* A store with grains and walls and nothing else, and one grain that moves by plain springs. */
#ifndef CDEM_TESTS_DEM_WALLS_SUPPORT_H
#define CDEM_TESTS_DEM_WALLS_SUPPORT_H

#include "base/mat3.h"
#include "base/memory.h"
#include "base/random.h"
#include "dem/store.h"
#include "support/test.h"

typedef struct {
  cdem_dem_store s;
  cdem_grains grains;
} walled;

static inline void walled_place(walled *w, int64_t i, double x, double y, double z, double r) {
  double *p = cdem_place(&w->s, i);
  p[0] = x;
  p[1] = y;
  p[2] = z;
  p[3] = r;
}

/* Grains at the origin with radius 1 until they are placed. */
static inline void walled_make(walled *w, int dim, int32_t grains, int walls,
                               const cdem_wall *wall) {
  cdem_fault fault = {0};
  const double origin[3] = {0.0, 0.0, 0.0};
  memset(w, 0, sizeof *w);
  w->grains.dim = w->s.dim = dim;
  for (int32_t i = 0; i < grains; i++)
    check_ok(cdem_grains_add(&w->grains, origin, 1.0, &fault));
  w->s.grains = grains;
  w->s.options.grains = &w->grains;
  w->s.options.walls = walls;
  w->s.options.wall = wall;
  w->s.skin = 0.3;
  w->s.histories = 3;
  w->s.place = cdem_allocate(4 * grains, sizeof(double), &fault);
  w->s.id = cdem_allocate(grains, sizeof(int32_t), &fault);
  w->s.slot = cdem_allocate(grains, sizeof(int32_t), &fault);
  for (int32_t i = 0; i < grains; i++) {
    w->s.id[i] = w->s.slot[i] = i;
    walled_place(w, i, 0.0, 0.0, 0.0, 1.0);
  }
  check_ok(cdem_walls_init(&w->s, &fault));
}

static inline void walled_build(walled *w) {
  cdem_fault fault = {0};
  check_ok(cdem_walls_build(&w->s, &fault));
}

static inline void walled_release(walled *w) {
  cdem_walls_release(&w->s);
  free(w->s.place);
  free(w->s.id);
  free(w->s.slot);
  cdem_grains_release(&w->grains);
}

/* What one grain at a place touches. */
static inline int walled_touch(walled *w, double x, double y, double z, double r,
                               cdem_wall_touch touch[CDEM_WALL_TOUCHES]) {
  walled_place(w, 0, x, y, z, r);
  walled_build(w);
  return cdem_walls_find(&w->s, 0, touch);
}

static inline void check_vector(const double v[3], double x, double y, double z, double tolerance) {
  check_near(v[0], x, 0.0, tolerance);
  check_near(v[1], y, 0.0, tolerance);
  check_near(v[2], z, 0.0, tolerance);
}

/* ---- a moving grain ---- */

typedef struct {
  double x[3], v[3], w[3]; /* place; velocity and spin of half steps */
  double radius, mass, inertia;
  double kn, kt, mu, gravity[3], damping;
  double force[3], moment[3]; /* of the walls, last step */
  int contacts;
} ball;

/* One contact: springs of stiffness kn and kt, the second cut at mu times the first. */
static inline void ball_contact(walled *w, ball *b, const cdem_wall_touch *touch, double dt) {
  bool fresh;
  double *h = cdem_walls_history(&w->s, touch, &fresh), arm[3], slip[3], spin[3];
  for (int c = 0; c < 3; c++)
    arm[c] = touch->point[c] - b->x[c];
  cdem_cross3(b->w, arm, spin);
  for (int c = 0; c < 3; c++)
    slip[c] = touch->velocity[c] - b->v[c] - spin[c];
  double before = cdem_norm3(h), along = cdem_dot3(h, touch->n), vn = cdem_dot3(slip, touch->n);
  for (int c = 0; c < 3; c++)
    h[c] -= along * touch->n[c];
  double after = cdem_norm3(h), push = b->kn * touch->overlap, shear = 0.0, f[3], m[3];
  for (int c = 0; c < 3; c++)
    h[c] = (after > 0.0 ? h[c] * (before / after) : 0.0) + dt * (slip[c] - vn * touch->n[c]);
  shear = b->kt * cdem_norm3(h);
  for (int c = 0; c < 3 && shear > b->mu * push; c++)
    h[c] *= b->mu * push / shear;
  for (int c = 0; c < 3; c++)
    f[c] = -push * touch->n[c] + b->kt * h[c];
  cdem_cross3(arm, f, m);
  for (int c = 0; c < 3; c++) {
    b->force[c] += f[c];
    b->moment[c] += m[c];
  }
}

static inline void ball_step(walled *w, ball *b, double dt) {
  cdem_wall_touch touch[CDEM_WALL_TOUCHES];
  memset(b->force, 0, sizeof b->force);
  memset(b->moment, 0, sizeof b->moment);
  walled_place(w, 0, b->x[0], b->x[1], b->x[2], b->radius);
  b->contacts = cdem_walls_find(&w->s, 0, touch);
  for (int k = 0; k < b->contacts; k++)
    ball_contact(w, b, touch + k, dt);
  for (int c = 0; c < 3; c++) {
    b->v[c] += dt * (b->force[c] / b->mass + b->gravity[c] - b->damping * b->v[c]);
    b->w[c] += dt * b->moment[c] / b->inertia;
    b->x[c] += dt * b->v[c];
  }
}

#endif
