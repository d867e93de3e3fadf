/* Random mixtures for mixture_slow.c: what is in them, and the laws that hold for all of them. */
#ifndef CDEM_TESTS_DEM_MIXTURE_SUPPORT_H
#define CDEM_TESTS_DEM_MIXTURE_SUPPORT_H

#include "solver_model.h"

enum { MIXTURE_GRAINS = 640, MIXTURE_BALLS = 4, MIXTURE_BONDS = 4000 };

typedef struct {
  model m;
  cdem_cell cell;
  cdem_bond_law bond_law;
  cdem_bond bond[MIXTURE_BONDS];
  double edge, large, ratio;     /* of the box; largest radius, m; largest by smallest */
  double ball[MIXTURE_BALLS][4]; /* where walls are: no grains at the start */
  int balls;
  double corner[6 * 3];
  int32_t facet[8 * 3];
  cdem_random random;
  bool periodic, momentum; /* momentum: it is conserved */
  double shear;            /* 1/s */
  double mass;             /* of all grains, kg */
  int64_t met, broken;     /* contacts compared so far, bonds that broke */
} mixture;

static inline double mixture_uniform(mixture *x, double low, double high) {
  return cdem_random_uniform(&x->random, low, high);
}

static inline cdem_series mixture_sine(double offset, double amplitude, double frequency) {
  return (cdem_series){
      .kind = CDEM_SERIES_SINE, .offset = offset, .amplitude = amplitude, .frequency = frequency};
}

static inline void mixture_init(mixture *x, int dim, const char *law, double ratio, uint64_t seed) {
  *x = (mixture){.ratio = ratio, .large = 0.01, .random = {seed}};
  model_init(&x->m, dim, law);
  x->m.options.most_overlap = 0.1;
  /* So violent a mixture, which gives a third of its energy to friction within milliseconds, has
   * an energy book that is off by 6e-3, 2e-3 and 5e-4 with safeties of 0.2, 0.1 and 0.05. */
  x->m.options.safety = 0.03;
  x->m.options.thickness = 0.01;
  /* Mean of r^dim of the density r^-(dim + 1), cut at the ends: grains of all sizes fill the same
   * space. */
  double mean = dim * log(ratio) / (pow(ratio, dim) - 1.0) * pow(x->large, dim);
  double space = MIXTURE_GRAINS * mean * (dim == 2 ? 3.14 : 4.19);
  x->edge = pow(space / (dim == 2 ? 0.5 : 0.32), 1.0 / dim);
}

static inline void mixture_release(mixture *x) {
  model_release(&x->m);
}

/* ---- walls ---- */

static inline void mixture_ball(mixture *x, double px, double py, double pz, double radius) {
  const double ball[4] = {px, py, x->m.grains.dim == 3 ? pz : 0.0, radius};
  assert_true(x->balls < MIXTURE_BALLS);
  memcpy(x->ball[x->balls++], ball, sizeof ball);
}

static inline cdem_wall *mixture_wall(mixture *x, const char *name, cdem_wall_shape shape,
                                      double px, double py, double pz) {
  assert_true(x->m.options.walls < MODEL_WALLS);
  cdem_wall *wall = &x->m.wall[x->m.options.walls++];
  *wall = (cdem_wall){.name = name, .shape = shape, .center = {px, py, pz}};
  wall->center[2] = x->m.grains.dim == 3 ? pz : 0.0;
  return wall;
}

/* Planes around the box, but across a periodic x; they press and let go. */
static inline void mixture_box(mixture *x, bool shaken) {
  int first = x->periodic ? 1 : 0, at = x->m.options.walls;
  for (int c = first; c < x->m.grains.dim; c++) {
    double n[3] = {c == 0, c == 1, c == 2}, high = x->edge;
    model_plane(&x->m, 0.0, 0.0, 0.0, n[0], n[1], n[2]);
    model_plane(&x->m, n[0] * high, n[1] * high, n[2] * high, -n[0], -n[1], -n[2]);
    for (int side = 0; side < 2 && shaken; side++, at++)
      x->m.wall[at].velocity[c] = mixture_sine(0.0, side == 0 ? 2.0 : -2.0, 300.0 + 50.0 * c);
  }
}

/* A plate in the middle that turns; pushed by a force where it does not turn. */
static inline void mixture_plate(mixture *x) {
  double m = 0.5 * x->edge, half = 0.12 * x->edge;
  cdem_wall *wall = mixture_wall(x, "plate", CDEM_WALL_PLATE, m, m, m);
  wall->normal[1] = wall->axis[0] = 1.0;
  wall->half[0] = wall->half[1] = half;
  wall->spin[2] = mixture_sine(60.0, 100.0, 200.0);
  wall->servo[1] = 1.0;
  wall->servo_force = mixture_sine(1.0, 2.0, 250.0);
  wall->servo_speed = 1.0;
  mixture_ball(x, m, m, m, 1.5 * half);
}

/* A roller (2-D), or an open tube that grains fly through. */
static inline void mixture_roller(mixture *x) {
  double p = 0.22 * x->edge, radius = 0.09 * x->edge;
  cdem_wall *wall = mixture_wall(x, "roller", CDEM_WALL_CYLINDER, p, p, p);
  wall->radius = radius;
  wall->outside = true;
  wall->axis[2] = 1.0;
  wall->spin[2] = mixture_sine(100.0, 0.0, 1.0);
  wall->velocity[0] = mixture_sine(0.0, 0.5, 400.0);
  if (x->m.grains.dim == 3)
    wall->half[0] = radius;
  mixture_ball(x, p, p, p, x->m.grains.dim == 3 ? 1.5 * radius : radius);
}

/* A double pyramid, or a saw tooth, that goes to and fro and turns. */
static inline void mixture_mesh(mixture *x) {
  double p = 0.75 * x->edge, size = 0.1 * x->edge;
  bool solid = x->m.grains.dim == 3;
  cdem_wall *wall = mixture_wall(x, "mesh", CDEM_WALL_MESH, p, p, p);
  for (int k = 0; k < 6; k++)
    for (int c = 0; c < 3; c++)
      x->corner[3 * k + c] = wall->center[c] + (k / 2 == c ? (k % 2 ? -size : size) : 0.0);
  for (int k = 0; k < 8; k++) {
    int32_t face[3] = {k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)};
    memcpy(x->facet + 3 * k, face, sizeof face);
  }
  for (int k = 0; k < 4 && !solid; k++) {
    x->facet[2 * k] = k & 1;
    x->facet[2 * k + 1] = 2 + (k >> 1);
  }
  wall->corners = solid ? 6 : 4;
  wall->facets = solid ? 8 : 4;
  wall->corner = x->corner;
  wall->facet = x->facet;
  wall->velocity[0] = mixture_sine(0.0, 2.0, 350.0);
  wall->velocity[1] = mixture_sine(0.0, 1.0, 450.0);
  wall->spin[2] = mixture_sine(0.0, 80.0, 300.0);
  if (solid)
    wall->spin[0] = mixture_sine(50.0, 0.0, 1.0);
  mixture_ball(x, p, p, p, size);
}

/* A tube around the box that turns, with planes at its ends. */
static inline void mixture_drum(mixture *x) {
  double m = 0.5 * x->edge;
  cdem_wall *wall = mixture_wall(x, "drum", CDEM_WALL_CYLINDER, m, m, 0.0);
  wall->radius = 0.72 * x->edge;
  wall->axis[2] = 1.0;
  wall->spin[2] = mixture_sine(30.0, 30.0, 100.0);
  wall->velocity[0] = mixture_sine(0.0, 6.0, 300.0);
  model_plane(&x->m, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
  model_plane(&x->m, 0.0, 0.0, x->edge, 0.0, 0.0, -1.0);
}

/* ---- grains ---- */

static inline bool mixture_is_free(const mixture *x, const double at[3], double radius) {
  const cdem_grains *g = &x->m.grains;
  for (int b = 0; b < x->balls; b++) {
    double d2 = 0.0;
    for (int c = 0; c < 3; c++)
      d2 += (at[c] - x->ball[b][c]) * (at[c] - x->ball[b][c]);
    if (d2 < (radius + x->ball[b][3]) * (radius + x->ball[b][3]))
      return false;
  }
  for (int64_t i = 0; i < g->grains; i++) {
    double d2 = 0.0, both = radius + g->radius[i];
    for (int c = 0; c < 3; c++) {
      double d = at[c] - g->xyz[3 * i + c];
      d -= x->cell.periodic[c] ? x->edge * round(d / x->edge) : 0.0;
      d2 += d * d;
    }
    if (d2 < both * both)
      return false;
  }
  return true;
}

/* Placed at random one after the other, the large ones first. */
static inline void mixture_fill(mixture *x) {
  int dim = x->m.grains.dim;
  double power = 1.0 / pow(x->ratio, dim);
  for (int k = 0; k < MIXTURE_GRAINS; k++) {
    /* Numbers above r fall as r^-dim. */
    double part = (k + 0.5) / MIXTURE_GRAINS, at[3] = {0};
    double radius = x->large * pow(power / (power + part * (1.0 - power)), 1.0 / dim);
    int tries = 0;
    do {
      for (int c = 0; c < dim; c++) {
        double margin = x->cell.periodic[c] ? 0.0 : radius;
        at[c] = mixture_uniform(x, margin, x->edge - margin);
      }
      assert_true(++tries < 100000);
    } while (!mixture_is_free(x, at, radius));
    int64_t i = model_add(&x->m, at[0], at[1], at[2], radius);
    double *v = x->m.grains.velocity + 3 * i, *w = x->m.grains.spin + 3 * i;
    for (int c = 0; c < 3; c++) {
      v[c] = c < dim ? mixture_uniform(x, -3.0, 3.0) : 0.0;
      w[c] = dim == 3 || c == 2 ? mixture_uniform(x, -1.0, 1.0) / radius : 0.0;
    }
    v[0] += x->shear * at[1];
    x->mass += 2500.0 * (dim == 2 ? 3.14 * 0.01 : 4.19 * radius) * radius * radius;
    x->m.grains.material[i] = (int32_t)(i % x->m.options.materials);
  }
}

/* A cell in all directions, or along x only. */
static inline void mixture_cell(mixture *x, bool all, double shear) {
  x->periodic = true;
  x->shear = shear;
  for (int c = 0; c < x->m.grains.dim; c++) {
    x->cell.periodic[c] = all || c == 0;
    x->cell.h[4 * c] = all || c == 0 ? x->edge : 0.0;
    if (shear != 0.0)
      x->cell.rate[4 * c] = mixture_sine(-0.15 * shear, 0.3 * shear, 200.0);
  }
  if (shear != 0.0)
    x->cell.rate[1] = mixture_sine(shear, 0.0, 1.0);
  x->m.options.cell = &x->cell;
}

/* Bonds between grains with little room between them; the first grains are driven. */
static inline void mixture_bond(mixture *x) {
  const cdem_grains *g = &x->m.grains;
  x->bond_law = (cdem_bond_law){.normal_stiffness = 1e5,
                                .shear_stiffness = 3e4,
                                .rolling_stiffness = 0.5,
                                .twisting_stiffness = 0.2,
                                .damping_ratio = 0.02,
                                .tension = 6.0,
                                .cohesion = 5.0,
                                .friction = 0.3,
                                .moment = 0.02};
  x->m.options.bond_law = &x->bond_law;
  x->m.options.bond_laws = 1;
  x->m.options.bond = x->bond;
  for (int32_t i = 0; i < g->grains; i++)
    for (int32_t j = i + 1; j < g->grains && x->m.options.bonds < MIXTURE_BONDS; j++) {
      double d[3];
      for (int c = 0; c < 3; c++)
        d[c] = g->xyz[3 * j + c] - g->xyz[3 * i + c];
      d[0] -= x->edge * round(d[0] / x->edge);
      if (cdem_norm3(d) < 1.15 * (g->radius[i] + g->radius[j]))
        x->bond[x->m.options.bonds++] = (cdem_bond){.grain = {i, j}};
    }
  assert_true(x->m.options.bonds > MIXTURE_GRAINS / 4 && x->m.options.bonds < MIXTURE_BONDS);
  for (int i = 0; i < 4; i++)
    x->m.grains.motion[i] = CDEM_GRAIN_DRIVEN;
}

/* Other velocities of the driven grains from now on. */
static inline void mixture_drive(mixture *x, cdem_dem *dem) {
  for (int i = 0; i < 4 && x->m.options.bonds > 0; i++) {
    double v[3], w[3];
    for (int c = 0; c < 3; c++) {
      v[c] = mixture_uniform(x, -2.0, 2.0);
      w[c] = mixture_uniform(x, -50.0, 50.0);
    }
    cdem_dem_motion given = {{v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
    cdem_dem_drive(dem, i, &given, NULL);
  }
}

#endif
