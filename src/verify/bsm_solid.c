/* Spheres of the simple cubic lattice in bricks (docs/theory/bsm-solid.md): the projector in space,
 * the moduli of the lattice, and what edge nodes feel when both move by one linear field. */
#include "base/mat3.h"
#include "base/memory.h"
#include "bsm/bsm.h"
#include "dem/measures.h"
#include "verify/bsm.h"
#include "verify/cdem_world.h"
#include "verify/dem_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double radius = 0.05, kn = 2.5e7, ks = 1e7;

/* ---- the projector ---- */

enum { WIDTH = 6 };
static const cdem_projector_shape shape = {3, 3};

typedef struct {
  cdem_mesh mesh;
  cdem_projector projector;
  int64_t grains;
  double *xyz;                    /* [grains][3] */
  double *q, *coarse, *fine, *pp; /* [grains][WIDTH] */
  double *d;                      /* [nodes][WIDTH] */
} space;

static void space_release(space *s) {
  cdem_projector_release(&s->projector);
  cdem_mesh_release(&s->mesh);
  free(s->xyz);
  free(s->q);
  free(s->d);
}

/* Numbers without a rule that the fields under test could share. */
static double noise(int64_t i) {
  double x = 43758.5453 * sin(12.9898 * (double)(i + 1));
  return 2.0 * (x - floor(x)) - 1.0;
}

static cdem_status make_projector(space *s, const int32_t *all, cdem_fault *fault) {
  int32_t *cell;
  double *xi = NULL;
  CDEM_NEW(cell, s->grains, fault);
  xi = cdem_allocate(5 * s->grains, sizeof *xi, fault);
  cdem_status status = xi != NULL ? cdem_locate(&s->mesh, s->mesh.group[0].cells, all, s->grains,
                                                s->xyz, cell, xi, fault)
                                  : CDEM_MEMORY;
  if (status == CDEM_OK) {
    double *mass = xi + 3 * s->grains, *inertia = xi + 4 * s->grains;
    for (int64_t a = 0; a < s->grains; a++) {
      mass[a] = 1.5 + 0.5 * noise(7 * a);
      inertia[a] = 1e-3 * mass[a];
    }
    const cdem_projector_options options = {.mesh = &s->mesh,
                                            .cells = s->mesh.group[0].cells,
                                            .fine_cell = all,
                                            .grains = s->grains,
                                            .cell = cell,
                                            .xi = xi,
                                            .mass = mass,
                                            .inertia = inertia};
    status = cdem_projector_init(&options, &s->projector, fault);
  }
  free(xi);
  free(cell);
  return status;
}

/* 3 x 3 x 2 distorted bricks of 1 m, four spheres along an edge. */
static cdem_status make_space(space *s, cdem_fault *fault) {
  enum { ALONG = 4 };
  const cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_HEX8,
                                       .count = {3, 3, 2},
                                       .size = {3.0, 3.0, 2.0},
                                       .distortion = 0.2,
                                       .seed = 3};
  CDEM_TRY(cdem_mesh_grid(&grid, &s->mesh, fault));
  const cdem_group *body = cdem_mesh_find_group(&s->mesh, "body");
  const int64_t n[3] = {3 * ALONG, 3 * ALONG, 2 * ALONG};
  s->grains = n[0] * n[1] * n[2];
  CDEM_NEW(s->xyz, 3 * s->grains, fault);
  for (int64_t a = 0; a < s->grains; a++) {
    const int64_t at[3] = {a % n[0], a / n[0] % n[1], a / (n[0] * n[1])};
    for (int c = 0; c < 3; c++)
      s->xyz[3 * a + c] = ((double)at[c] + 0.5) / ALONG;
  }
  CDEM_TRY(make_projector(s, body->cell, fault));
  CDEM_NEW(s->q, 4 * WIDTH * s->grains, fault);
  CDEM_NEW(s->d, 2 * (int64_t)WIDTH * s->projector.nodes, fault);
  s->coarse = s->q + WIDTH * s->grains;
  s->fine = s->coarse + WIDTH * s->grains;
  s->pp = s->fine + WIDTH * s->grains;
  return CDEM_OK;
}

/* Largest |a - b| (b NULL: |a|). */
static double apart(int64_t count, const double *a, const double *b) {
  double most = 0.0;
  for (int64_t i = 0; i < count; i++)
    most = fmax(most, fabs(a[i] - (b != NULL ? b[i] : 0.0)));
  return most;
}

/* N^T Mp of a field, into d. */
static void momenta(const space *s, double *field, double *d) {
  for (int64_t i = 0; i < WIDTH * s->grains; i++)
    field[i] *= (i % WIDTH < 3 ? s->projector.mass : s->projector.inertia)[i / WIDTH];
  memset(d, 0, WIDTH * (size_t)s->projector.nodes * sizeof *d);
  cdem_weights_gather(&s->projector.weights, WIDTH, field, d);
}

static double linear_at(const double *x, int k) {
  return noise(k) + noise(k + 10) * x[0] + noise(k + 20) * x[1] + noise(k + 30) * x[2];
}

static cdem_status linear_fields(space *s, double *value, cdem_fault *fault) {
  double *expected = s->d + WIDTH * (int64_t)s->projector.nodes;
  for (int64_t i = 0; i < WIDTH * s->grains; i++)
    s->q[i] = linear_at(s->xyz + 3 * (i / WIDTH), (int)(i % WIDTH));
  for (int64_t i = 0; i < WIDTH * (int64_t)s->projector.nodes; i++)
    expected[i] =
        linear_at(s->mesh.xyz + 3 * (int64_t)s->projector.node[i / WIDTH], (int)(i % WIDTH));
  CDEM_TRY(cdem_projector_project(&s->projector, shape, s->q, s->d, fault));
  int64_t count = WIDTH * (int64_t)s->projector.nodes;
  *value = apart(count, s->d, expected) / apart(count, expected, NULL);
  return CDEM_OK;
}

static cdem_status identity(space *s, int which, double *value, cdem_fault *fault) {
  const cdem_projector *p = &s->projector;
  int64_t all = WIDTH * s->grains, nodal = WIDTH * (int64_t)p->nodes;
  for (int64_t i = 0; i < all; i++)
    s->q[i] = noise(i);
  for (int64_t i = 0; i < nodal; i++)
    s->d[i] = noise(3 * i);
  if (which == 1)
    cdem_weights_interpolate(&p->weights, WIDTH, s->d, s->q);
  CDEM_TRY(cdem_projector_split(p, shape, s->q, s->coarse, s->fine, fault));
  if (which == 0) {
    CDEM_TRY(cdem_projector_split(p, shape, s->coarse, s->pp, NULL, fault));
    *value = apart(all, s->pp, s->coarse) / apart(all, s->coarse, NULL);
  } else if (which == 1) {
    *value = apart(all, s->fine, NULL) / apart(all, s->q, NULL);
  } else if (which == 2) {
    double *whole = s->d + nodal;
    momenta(s, s->fine, s->d);
    momenta(s, s->q, whole);
    *value = apart(nodal, s->d, NULL) / apart(nodal, whole, NULL);
  } else {
    double whole = cdem_projector_energy(p, shape, s->q);
    *value = fabs(cdem_projector_energy(p, shape, s->coarse) +
                  cdem_projector_energy(p, shape, s->fine) - whole) /
             whole;
  }
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_solid_identity(int parameter, double *value, cdem_fault *fault) {
  space s = {0};
  cdem_status status = make_space(&s, fault);
  if (status == CDEM_OK)
    status =
        parameter == 4 ? linear_fields(&s, value, fault) : identity(&s, parameter, value, fault);
  space_release(&s);
  return status;
}

/* ---- moduli of the lattice ---- */

static void bond_all(cdem_dem_world *world) {
  cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(world, CDEM_LAW_shear_stiffness, ks);
  cdem_dem_world_set(world, CDEM_LAW_friction, 0.5);
  cdem_dem_world_set(world, CDEM_LAW_damping_ratio, 0.0);
  world->bond_law = (cdem_bond_law){.normal_stiffness = kn, .shear_stiffness = ks};
}

enum { CELL = 3 }; /* spheres along the periodic cell: fewer would touch one image twice */

static cdem_status start_cell(cdem_dem_world *world, cdem_cell *cell, cdem_fault *fault) {
  CDEM_TRY(cdem_dem_world_init(world, 3, "linear", 2600.0, fault));
  bond_all(world);
  for (int i = 0; i < CELL * CELL * CELL; i++) {
    const int at[3] = {i % CELL, i / CELL % CELL, i / (CELL * CELL)};
    double x[3];
    for (int c = 0; c < 3; c++)
      x[c] = radius * (2 * at[c] + 1);
    CDEM_TRY(cdem_dem_world_add(world, x, radius, NULL, NULL, fault));
  }
  for (int i = 0; i < CELL * CELL * CELL; i++) {
    const int at[3] = {i % CELL, i / CELL % CELL, i / (CELL * CELL)};
    for (int c = 0, stride = 1; c < 3; c++, stride *= CELL)
      CDEM_TRY(
          cdem_dem_world_bond(world, i, i + stride * (at[c] + 1 < CELL ? 1 : 1 - CELL), fault));
  }
  *cell = (cdem_cell){.periodic = {true, true, true}};
  for (int c = 0; c < 3; c++)
    cell->h[4 * c] = 2.0 * radius * CELL;
  world->options.cell = cell;
  world->options.mass_damping = 1000.0; /* of the spins about their equilibrium */
  return CDEM_OK;
}

/* The cell strains slowly; spheres begin at rest and find the spin themselves. */
cdem_status cdem_bsm_measure_solid_lattice(int parameter, double *value, cdem_fault *fault) {
  const double rate = 1e-3;
  const int component[] = {0, 4, 2};
  cdem_dem_world world;
  cdem_cell cell;
  cdem_assembly assembly;
  cdem_status status = start_cell(&world, &cell, fault);
  cdem_series *series = &cell.rate[parameter == 2 ? 2 : 0];
  if (status == CDEM_OK)
    status = cdem_series_constant(rate, series, fault);
  if (status == CDEM_OK)
    status = cdem_dem_world_start(&world, fault);
  if (status == CDEM_OK)
    status = cdem_dem_steps(&world.dem, 20000, fault);
  if (status == CDEM_OK)
    status = cdem_measure(&world.dem, NULL, &assembly, fault);
  if (status == CDEM_OK) {
    const double *s = assembly.stress;
    double strain = rate * world.dem.time;
    *value = parameter == 2 ? 0.5 * (s[2] + s[6]) / (strain * ks / (4.0 * radius))
                            : s[component[parameter]] / (strain * kn / (2.0 * radius));
  }
  cdem_series_release(series);
  cdem_dem_world_release(&world);
  return status;
}

/* ---- patch ----
 *
 * 4^3 elements, the inner 2^3 of them filled with spheres; every edge node has its eight cells.
 * Nodes and spheres move by one linear field (spheres are so heavy that forces do not matter); what
 * outer elements and interface spheres leave at an edge node would be 0 where the two media were
 * one. */

enum { CELLS = 4, FIRST = 1, LAST = 3 }; /* elements of the fine region, in each direction */

typedef struct {
  int spheres; /* along an element */
  double size; /* of an element, m */
  cdem_world world;
  cdem_grains lattice; /* the fine region and one layer around it */
  int32_t *id;         /* [lattice] of a sphere among the grains, -1: away */
  int32_t fine_cells, *fine_cell;
  cdem_partition partition;
  cdem_dem_world dem;
  int32_t *tied, *cell;        /* [interface] */
  double *xi, *on, *u, *force; /* [interface][3], [interface][6], [nodes][3] twice */
  cdem_tie tie;
} patch;

static void patch_release(patch *p) {
  cdem_tie_release(&p->tie);
  cdem_dem_world_release(&p->dem);
  cdem_partition_release(&p->partition);
  cdem_grains_release(&p->lattice);
  cdem_world_release(&p->world);
  free(p->id);
  free(p->fine_cell);
  free(p->tied);
  free(p->cell);
  free(p->xi);
  free(p->on);
  free(p->u);
}

static cdem_status make_parts(patch *p, cdem_fault *fault) {
  const int along = 2 + (LAST - FIRST) * p->spheres;
  const double from = FIRST * p->size - radius, low = FIRST * p->size, high = LAST * p->size;
  const cdem_bsm_box box = {{low, low, low}, {high, high, high}};
  CDEM_TRY(cdem_world_grid(&p->world, CDEM_SHAPE_HEX8, (int32_t[]){CELLS, CELLS, CELLS},
                           (double[]){CELLS * p->size, CELLS * p->size, CELLS * p->size}, fault));
  p->lattice.dim = 3;
  for (int i = 0; i < along * along * along; i++) {
    const int at[3] = {i % along, i / along % along, i / (along * along)};
    double x[3];
    for (int c = 0; c < 3; c++)
      x[c] = from + 2.0 * radius * at[c];
    CDEM_TRY(cdem_grains_add(&p->lattice, x, radius, fault));
  }
  CDEM_TRY(cdem_grains_complete(&p->lattice, fault));
  CDEM_TRY(cdem_bsm_cells(&p->world.mesh, 1, &box, &p->fine_cells, &p->fine_cell, fault));
  CDEM_TRY(cdem_partition_init(&p->world.mesh, p->fine_cells, p->fine_cell, &p->lattice, 0.3,
                               &p->partition, fault));
  return cdem_mesh_add_group(&p->world.mesh, "outer", 3, p->partition.outer_cells,
                             p->partition.outer_cell, fault);
}

static cdem_status make_outer(patch *p, cdem_fault *fault) {
  const double c11 = kn / (2.0 * radius), c44 = ks / (4.0 * radius);
  cdem_material material = {.model = CDEM_ANISOTROPIC};
  for (int i = 0, k = 0; i < 6; i++)
    for (int j = i; j < 6; j++, k++)
      material.parameter[k] = i != j ? 0.0 : i < 3 ? c11 : c44;
  const cdem_world_options options = {.density = 1e3, .material = &material, .only = "outer"};
  CDEM_TRY(cdem_world_build(&p->world, &options, fault));
  CDEM_NEW(p->u, 6 * (int64_t)p->world.body.nodes, fault);
  p->force = p->u + 3 * (int64_t)p->world.body.nodes;
  return CDEM_OK;
}

static void at_place(const double gradient[9], const double *x, double to[3]) {
  for (int c = 0; c < 3; c++)
    to[c] = cdem_dot3(gradient + 3 * c, x);
}

/* Grains of the patch with bonds between those that touch; two driven ones have none. */
static cdem_status make_spheres(patch *p, const double gradient[9], cdem_fault *fault) {
  const int along = 2 + (LAST - FIRST) * p->spheres;
  const double spin[3] = {0.5 * (gradient[7] - gradient[5]), 0.5 * (gradient[2] - gradient[6]),
                          0.5 * (gradient[3] - gradient[1])};
  cdem_grains *g = &p->dem.grains;
  CDEM_NEW(p->id, p->lattice.grains, fault);
  CDEM_TRY(cdem_dem_world_init(&p->dem, 3, "linear", 1e15, fault));
  bond_all(&p->dem);
  for (int32_t i = 0; i < p->lattice.grains; i++) {
    const double *x = p->lattice.xyz + 3 * (int64_t)i;
    double v[3];
    p->id[i] = p->partition.part[i] == CDEM_PART_AWAY ? -1 : (int32_t)g->grains;
    if (p->id[i] < 0)
      continue;
    at_place(gradient, x, v);
    CDEM_TRY(cdem_dem_world_add(&p->dem, x, radius, v, spin, fault));
    if (p->partition.part[i] == CDEM_PART_INTERFACE)
      g->motion[p->id[i]] = CDEM_GRAIN_DRIVEN;
  }
  for (int32_t i = 0; i < p->lattice.grains; i++) {
    const int at[3] = {i % along, i / along % along, i / (along * along)};
    for (int c = 0, stride = 1; c < 3; c++, stride *= along) {
      int32_t a = p->id[i], b = at[c] + 1 < along ? p->id[i + stride] : -1;
      if (a >= 0 && b >= 0 && (g->motion[a] == CDEM_GRAIN_FREE || g->motion[b] == CDEM_GRAIN_FREE))
        CDEM_TRY(cdem_dem_world_bond(&p->dem, a, b, fault));
    }
  }
  p->dem.options.step = 1e-3;
  return cdem_dem_world_start(&p->dem, fault);
}

static cdem_status make_tie(patch *p, cdem_fault *fault) {
  const cdem_partition *parts = &p->partition;
  const cdem_blocks *blocks = &p->world.blocks;
  int64_t count = 0;
  CDEM_NEW(p->tied, parts->interfaces, fault);
  CDEM_NEW(p->cell, parts->interfaces, fault);
  CDEM_NEW(p->xi, 3 * parts->interfaces, fault);
  CDEM_NEW(p->on, 6 * parts->interfaces, fault);
  for (int64_t i = 0; i < parts->grains; i++) {
    if (parts->part[i] != CDEM_PART_INTERFACE)
      continue;
    p->tied[count] = p->id[i];
    while (blocks->old_cell[p->cell[count]] != parts->cell[i])
      p->cell[count]++;
    memcpy(p->xi + 3 * count++, parts->xi + 3 * i, 3 * sizeof *p->xi);
  }
  return cdem_tie_init(&blocks->mesh, 3, count, p->tied, p->cell, p->xi, &p->tie, fault);
}

/* Largest sum of both forces at a node on the edge of the fine region, N. */
static double worst_edge(const patch *p) {
  const double low = FIRST * p->size, high = LAST * p->size, edge = 1e-6 * p->size;
  double worst = 0.0;
  for (int32_t n = 0; n < p->world.body.nodes; n++) {
    const double *x = p->world.blocks.mesh.xyz + 3 * (int64_t)n;
    bool inside = true;
    for (int c = 0; c < 3; c++)
      inside = inside && x[c] > low - edge && x[c] < high + edge;
    if (inside)
      worst = fmax(worst, cdem_norm3(p->force + 3 * (int64_t)n));
  }
  return worst;
}

static cdem_status measure_patch(patch *p, const double gradient[9], double *worst,
                                 cdem_fault *fault) {
  CDEM_TRY(make_parts(p, fault));
  CDEM_TRY(make_outer(p, fault));
  CDEM_TRY(make_spheres(p, gradient, fault));
  CDEM_TRY(make_tie(p, fault));
  CDEM_TRY(cdem_dem_step(&p->dem.dem, fault));
  for (int32_t n = 0; n < p->world.body.nodes; n++) {
    at_place(gradient, p->world.blocks.mesh.xyz + 3 * (int64_t)n, p->u + 3 * (int64_t)n);
    for (int c = 0; c < 3; c++)
      p->u[3 * (int64_t)n + c] *= p->dem.dem.step;
  }
  cdem_body_forces(&p->world.body, p->u, p->force);
  cdem_dem_forces_on(&p->dem.dem, p->tie.grains, p->tie.grain, p->on);
  cdem_tie_forces(&p->tie, p->on, p->force);
  *worst = worst_edge(p);
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_solid_patch(int parameter, double *value, cdem_fault *fault) {
  const double rate = 1e-2, strain = 1e-5; /* of one step: what is of second order is not seen */
  const int field = parameter % 10;
  double gradient[9] = {0}, modulus = field == 1 ? ks / (4.0 * radius) : kn / (2.0 * radius);
  const int spheres = parameter / 10;
  patch p = {.spheres = spheres, .size = 2.0 * radius * spheres};
  gradient[field == 0 ? 8 : 2] = rate;
  gradient[6] = field == 2 ? -rate : 0.0;
  cdem_status status = measure_patch(&p, gradient, value, fault);
  if (status == CDEM_OK)
    *value /= modulus * strain * p.size * p.size;
  patch_release(&p);
  return status;
}
