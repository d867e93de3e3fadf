/* A body with a bonded lattice of grains inside, coupled; both free in space. */
#ifndef CDEM_TESTS_BSM_COUPLING_SUPPORT_H
#define CDEM_TESTS_BSM_COUPLING_SUPPORT_H

#include "bsm/bsm_support.h"
#include "cdem/solver.h"
#include "dem/packing.h"
#include "dem/solver_model.h"

typedef struct {
  int32_t count[2]; /* elements of 0.25 m, of 4 x 4 grains each */
  cdem_bsm_box fine;
  double velocity[2][3]; /* v_i = velocity[i][0] + velocity[i][1] x + velocity[i][2] y */
  cdem_bsm_form form;
  cdem_bsm_way way;
  int cycles;
  double part;    /* of the longest coupled step; 0: the grains step by a fifth of their limit */
  double density; /* of the body, in that of the grains; 0: 1 */
  double gravity; /* m/s^2 along y, of body and grains */
  bool cosserat;
  int threads;
} pair_options;

typedef struct {
  cdem_mesh mesh;
  cdem_partition partition;
  cdem_model model;
  double density, micro;
  cdem_body body;
  cdem_solver solver;
  double *velocity;
  model grains;
  int32_t fines, interfaces; /* ids in the solver of grains: fine ones first */
  int32_t *id, *home;
  double *xi;
  cdem_bond_law law;
  cdem_bond *bond;
  cdem_dem dem;
  cdem_tie tie, fine_tie;
  cdem_coupling_options options;
  cdem_coupling coupling;
} pair;

static const double pair_radius = 1.0 / 32.0, pair_stiffness = 1e7, pair_density = 2000.0;

/* A strip of 8 elements, the middle two of grains, that is pulled. */
static inline pair_options pair_strip(int cycles) {
  return (pair_options){.count = {8, 1},
                        .fine = {{0.75, 0.0, 0.0}, {1.25, 0.0, 0.0}},
                        .velocity = {{-0.1, 0.1, 0.0}, {0.0, 0.0, 0.0}},
                        .cycles = cycles,
                        .threads = 1};
}

/* A block of 5 x 4 elements, grains in the upper middle, that is pulled, sheared and turned. */
static inline pair_options pair_block(int cycles) {
  pair_options o = pair_strip(cycles);
  o.count[0] = 5;
  o.count[1] = 4;
  o.fine = (cdem_bsm_box){{0.25, 0.5, 0.0}, {1.0, 1.0, 0.0}};
  const double field[2][3] = {{-0.07, 0.1, 0.05}, {0.02, 0.02, -0.06}};
  memcpy(o.velocity, field, sizeof field);
  return o;
}

static inline pair_options pair_chosen(bool block, int cycles) {
  return block ? pair_block(cycles) : pair_strip(cycles);
}

static inline void pair_field(const pair_options *o, const double x[3], double v[2]) {
  for (int c = 0; c < 2; c++)
    v[c] = o->velocity[c][0] + o->velocity[c][1] * x[0] + o->velocity[c][2] * x[1];
}

static inline double pair_spin(const pair_options *o) {
  return 0.5 * (o->velocity[1][1] - o->velocity[0][2]);
}

/* Mesh, partition, and the grains of it that are there. */
static inline void pair_grains(const pair_options *o, pair *p) {
  cdem_fault fault = {0};
  int32_t cells, *cell;
  cdem_grains all;
  const double wide = 0.25 * o->count[0], tall = 0.25 * o->count[1];
  cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_QUAD4, .count = {o->count[0], o->count[1], 0}, .size = {wide, tall, 0.0}};
  cdem_packing_options packing = {.dim = 2,
                                  .high = {wide, tall, 0.0},
                                  .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = pair_radius}};
  check_ok(cdem_mesh_grid(&grid, &p->mesh, &fault));
  check_ok(cdem_packing_make(cdem_packing_find("cubic"), &packing, &all, &fault));
  check_ok(cdem_bsm_cells(&p->mesh, 1, &o->fine, &cells, &cell, &fault));
  check_ok(cdem_partition_init(&p->mesh, cells, cell, &all, 0.3, &p->partition, &fault));
  free(cell);
  int64_t count = p->partition.fine + p->partition.interfaces;
  p->id = cdem_allocate(count, sizeof *p->id, &fault);
  p->home = cdem_allocate(count, sizeof *p->home, &fault);
  p->xi = cdem_allocate(3 * count, sizeof *p->xi, &fault);
  model_init(&p->grains, 2, "linear");
  p->grains.material[0].density = pair_density;
  model_word(&p->grains, CDEM_LAW_restitution, 1.0);
  for (int what = CDEM_PART_FINE; what >= CDEM_PART_INTERFACE; what--)
    for (int64_t i = 0; i < all.grains; i++) {
      double v[2];
      if (p->partition.part[i] != what)
        continue;
      int64_t id = model_add(&p->grains, all.xyz[3 * i], all.xyz[3 * i + 1], 0.0, pair_radius);
      pair_field(o, all.xyz + 3 * i, v);
      model_move(&p->grains, id, v[0], v[1], 0.0);
      p->grains.grains.spin[3 * id + 2] = pair_spin(o);
      p->grains.grains.motion[id] = what == CDEM_PART_FINE ? CDEM_GRAIN_FREE : CDEM_GRAIN_DRIVEN;
      p->id[id] = (int32_t)id;
      p->home[id] = p->partition.cell[i];
      memcpy(p->xi + 3 * id, p->partition.xi + 3 * i, 3 * sizeof *p->xi);
    }
  p->fines = (int32_t)p->partition.fine;
  p->interfaces = (int32_t)p->partition.interfaces;
  cdem_grains_release(&all);
}

static inline void pair_bonds(const pair_options *o, pair *p) {
  cdem_fault fault = {0};
  const cdem_grains *g = &p->grains.grains;
  p->bond = cdem_allocate(3 * g->grains, sizeof *p->bond, &fault);
  p->law = (cdem_bond_law){.normal_stiffness = pair_stiffness,
                           .shear_stiffness = 0.5 * pair_stiffness,
                           .rolling_stiffness = 0.1 * pair_stiffness * pair_radius * pair_radius};
  int64_t bonds = 0;
  for (int32_t i = 0; i < g->grains; i++)
    for (int32_t j = i + 1; j < g->grains && i < p->fines; j++) {
      double d[3];
      for (int c = 0; c < 3; c++)
        d[c] = g->xyz[3 * i + c] - g->xyz[3 * j + c];
      if (cdem_norm3(d) < 2.1 * pair_radius)
        p->bond[bonds++] = (cdem_bond){{i, j}, 0};
    }
  p->grains.options.bond_laws = 1;
  p->grains.options.bond_law = &p->law;
  p->grains.options.bonds = bonds;
  p->grains.options.bond = p->bond;
  p->grains.options.threads = o->threads;
  p->grains.options.gravity[1] = o->gravity;
  check_ok(cdem_dem_init(&p->grains.options, &p->dem, &fault));
}

/* Masses of the grains on the nodes of the fine region, for the form of virtual work. */
static inline void pair_lumps(pair *p) {
  cdem_fault fault = {0};
  cdem_weights w;
  double *mass = cdem_allocate(2 * (int64_t)p->fines, sizeof *mass, &fault);
  double *lump = cdem_allocate(p->mesh.nodes, sizeof *lump, &fault);
  check_ok(cdem_weights_init(&p->mesh, p->fines, p->home, p->xi, &w, &fault));
  for (int32_t a = 0; a < p->fines; a++)
    mass[a] = pair_density * cdem_grain_solid(2, pair_radius);
  cdem_weights_gather(&w, 1, mass, lump);
  for (int32_t n = 0; n < p->mesh.nodes; n++)
    for (int c = 0; c < p->body.dofs; c++)
      p->body.mass[n * p->body.dofs + c] += c < 2 ? lump[n] : lump[n] * p->micro;
  free(mass);
  free(lump);
  cdem_weights_release(&w);
}

static inline void pair_body(const pair_options *o, pair *p) {
  cdem_fault fault = {0};
  static const char *const outer[1] = {"outer"};
  check_ok(cdem_mesh_add_group(&p->mesh, "outer", 2, p->partition.outer_cells,
                               p->partition.outer_cell, &fault));
  cdem_material material = cdem_material_isotropic(pair_stiffness, 0.0);
  if (o->cosserat)
    material = (cdem_material){.model = CDEM_COSSERAT_CUBIC,
                               .parameter = {pair_stiffness, 0.0, 0.5 * pair_stiffness, 0.0,
                                             0.2 * pair_stiffness * pair_radius * pair_radius}};
  cdem_model_options options = {.mesh = &p->mesh,
                                .groups = 1,
                                .group = outer,
                                .materials = 1,
                                .material = &material,
                                .section = {CDEM_PLANE_STRAIN, 1.0}};
  check_ok(cdem_model_init(&options, &p->model, &fault));
  p->density = pair_density * 0.25 * 3.14159265358979 * (o->density > 0.0 ? o->density : 1.0);
  p->micro = 0.5 * pair_radius * pair_radius;
  cdem_body_options body = {
      .density = &p->density, .micro_inertia = &p->micro, .linear = true, .threads = o->threads};
  check_ok(cdem_body_init(&p->model, &body, &p->body, &fault));
  if (o->form == CDEM_BSM_VIRTUAL_WORK)
    pair_lumps(p);
  p->velocity = cdem_allocate((int64_t)p->mesh.nodes * p->body.dofs, sizeof(double), &fault);
  for (int32_t n = 0; n < p->mesh.nodes; n++) {
    pair_field(o, p->mesh.xyz + 3 * (int64_t)n, p->velocity + (int64_t)n * p->body.dofs);
    if (p->body.dofs == 3)
      p->velocity[n * 3 + 2] = pair_spin(o);
  }
}

/* The step, and both solvers with it. */
static inline void pair_steps(const pair_options *o, pair *p) {
  cdem_fault fault = {0};
  char limiter[64];
  cdem_solver_options solver = {
      .body = &p->body, .thickness = 1.0, .velocity = p->velocity, .threads = o->threads};
  solver.gravity[1] = o->gravity;
  check_ok(cdem_solver_init(&solver, &p->solver, &fault));
  double own = cdem_solver_limit(&p->solver, limiter);
  double limit;
  check_ok(cdem_dem_limit(&p->dem, &limit, limiter, &fault));
  double step = 0.2 * limit;
  check_ok(cdem_coupling_limit(&p->body, own, &p->tie, &p->dem, &p->options.most_step, &fault));
  if (o->part > 0.0)
    step = o->part * p->options.most_step / o->cycles;
  cdem_solver_release(&p->solver);
  cdem_dem_release(&p->dem);
  p->grains.options.step = step;
  check_ok(cdem_dem_init(&p->grains.options, &p->dem, &fault));
  solver.step = o->cycles * step;
  check_ok(cdem_solver_init(&solver, &p->solver, &fault));
}

static inline void pair_make(const pair_options *o, pair *p) {
  cdem_fault fault = {0};
  memset(p, 0, sizeof *p);
  pair_grains(o, p);
  pair_bonds(o, p);
  pair_body(o, p);
  check_ok(cdem_tie_init(&p->mesh, p->body.dofs, p->interfaces, p->id + p->fines,
                         p->home + p->fines, p->xi + 3 * p->fines, &p->tie, &fault));
  check_ok(
      cdem_tie_init(&p->mesh, p->body.dofs, p->fines, p->id, p->home, p->xi, &p->fine_tie, &fault));
  pair_steps(o, p);
  p->options.coarse = &p->solver;
  p->options.fine = &p->dem;
  p->options.form = o->form;
  p->options.way = o->way;
  p->options.cycles = o->cycles;
  p->options.tie = &p->tie;
  p->options.fine_tie = o->form == CDEM_BSM_VIRTUAL_WORK ? &p->fine_tie : NULL;
}

static inline void pair_start(pair *p) {
  cdem_fault fault = {0};
  check_ok(cdem_coupling_init(&p->options, &p->coupling, &fault));
}

static inline void pair_run(pair *p, int steps) {
  cdem_fault fault = {0};
  for (int k = 0; k < steps; k++)
    check_ok(cdem_coupling_step(&p->coupling, &fault));
}

static inline void pair_release(pair *p) {
  cdem_coupling_release(&p->coupling);
  cdem_tie_release(&p->tie);
  cdem_tie_release(&p->fine_tie);
  cdem_solver_release(&p->solver);
  cdem_body_release(&p->body);
  cdem_model_release(&p->model);
  cdem_dem_release(&p->dem);
  model_release(&p->grains);
  cdem_partition_release(&p->partition);
  cdem_mesh_release(&p->mesh);
  free(p->velocity);
  free(p->id);
  free(p->home);
  free(p->xi);
  free(p->bond);
}

/* Energy of body and grains, J. */
static inline double pair_energy(pair *p) {
  cdem_energy_book body;
  cdem_dem_energies grains;
  cdem_solver_energies(&p->solver, &body);
  cdem_dem_energies_now(&p->dem, &grains);
  return body.kinetic + body.elastic + grains.translation + grains.rotation + grains.normal +
         grains.shear + grains.moment + grains.bond;
}

/* Momentum of the body and of the fine grains at t_n, kg m/s. */
static inline void pair_momentum(const pair *p, double body[2], double fine[2]) {
  cdem_fault fault = {0};
  int64_t count = (int64_t)p->solver.nodes * p->solver.dofs, grains = p->dem.grains;
  double *v = cdem_allocate(count + 4 * grains, sizeof *v, &fault), *w = v + count,
         *mass = w + 3 * grains;
  cdem_dem_view view = {.velocity = w, .mass = mass};
  memset(body, 0, 2 * sizeof *body);
  memset(fine, 0, 2 * sizeof *fine);
  cdem_solver_velocity(&p->solver, v);
  cdem_dem_look(&p->dem, &view);
  for (int c = 0; c < 2; c++) {
    for (int32_t n = 0; n < p->solver.nodes; n++)
      body[c] += p->body.mass[n * p->solver.dofs + c] * v[n * p->solver.dofs + c];
    for (int32_t a = 0; a < p->fines; a++)
      fine[c] += mass[a] * w[3 * a + c];
  }
  free(v);
}

/* Largest change of the common energy, as a part of it, and of the common momentum over many steps.
 */
static inline void pair_watch(pair *p, int steps, double *energy, double *momentum) {
  double start = pair_energy(p), body[2], fine[2], first[2];
  *energy = *momentum = 0.0;
  pair_momentum(p, body, fine);
  for (int c = 0; c < 2; c++)
    first[c] = body[c] + fine[c];
  for (int k = 0; k < steps; k += 5) {
    pair_run(p, 5);
    *energy = fmax(*energy, fabs(pair_energy(p) / start - 1.0));
    pair_momentum(p, body, fine);
    *momentum = fmax(*momentum, hypot(body[0] + fine[0] - first[0], body[1] + fine[1] - first[1]));
  }
}

#endif
