/* Bodies in solvers, as the tests of the solver need them. */
#ifndef CDEM_TESTS_CDEM_SOLVER_SUPPORT_H
#define CDEM_TESTS_CDEM_SOLVER_SUPPORT_H

#include "cdem/solver.h"
#include "support/test.h"

typedef struct {
  cdem_shape shape;
  int32_t count[3];
  double size[3], distortion;
  double young, poisson, density;
  cdem_plane plane;
  double thickness;
  bool linear, no_tension;
  int threads;
} rig_options;

typedef struct {
  double density;
  cdem_mesh mesh;
  cdem_blocks blocks;
  cdem_model model;
  cdem_body body;
  cdem_solver_options options;
  cdem_solver solver;
} rig;

static inline rig_options rig_square(int32_t nx, int32_t ny) {
  return (rig_options){.shape = CDEM_SHAPE_QUAD4,
                       .count = {nx, ny, 0},
                       .size = {1.0, 0.8, 0.0},
                       .distortion = 0.2,
                       .young = 1e9,
                       .poisson = 0.25,
                       .density = 2000.0,
                       .plane = CDEM_PLANE_STRAIN,
                       .thickness = 0.5};
}

static inline rig_options rig_cube(int32_t n) {
  rig_options o = rig_square(n, n);
  o.shape = CDEM_SHAPE_HEX8;
  o.count[2] = n;
  o.size[2] = 0.9;
  return o;
}

/* Body and surface; the solver's options are ready to be added to. */
static inline void rig_make(const rig_options *o, rig *r) {
  cdem_fault fault = {0};
  memset(r, 0, sizeof *r);
  cdem_mesh_grid_options grid = {.shape = o->shape,
                                 .count = {o->count[0], o->count[1], o->count[2]},
                                 .size = {o->size[0], o->size[1], o->size[2]},
                                 .distortion = o->distortion,
                                 .seed = 3};
  check_ok(cdem_mesh_grid(&grid, &r->mesh, &fault));
  cdem_blocks_options cut = {.mesh = &r->mesh};
  check_ok(cdem_blocks_init(&cut, &r->blocks, &fault));
  cdem_material material = cdem_material_isotropic(o->young, o->poisson);
  cdem_model_options model = {.mesh = &r->blocks.mesh,
                              .materials = 1,
                              .material = &material,
                              .default_material = 0,
                              .section = {o->plane, o->thickness}};
  check_ok(cdem_model_init(&model, &r->model, &fault));
  r->density = o->density;
  cdem_body_options body = {.density = &r->density,
                            .no_tension = &o->no_tension,
                            .linear = o->linear,
                            .threads = o->threads};
  check_ok(cdem_body_init(&r->model, &body, &r->body, &fault));
  r->options = (cdem_solver_options){
      .body = &r->body, .blocks = &r->blocks, .thickness = o->thickness, .threads = o->threads};
}

static inline void rig_start(rig *r) {
  cdem_fault fault = {0};
  check_ok(cdem_solver_init(&r->options, &r->solver, &fault));
}

static inline void rig_run(rig *r, int steps) {
  cdem_fault fault = {0};
  for (int k = 0; k < steps; k++)
    check_ok(cdem_solver_step(&r->solver, &fault));
}

static inline void rig_release(rig *r) {
  cdem_solver_release(&r->solver);
  cdem_body_release(&r->body);
  cdem_model_release(&r->model);
  cdem_blocks_release(&r->blocks);
  cdem_mesh_release(&r->mesh);
}

static inline cdem_series constant(double value) {
  cdem_fault fault = {0};
  cdem_series series = {0};
  check_ok(cdem_series_constant(value, &series, &fault));
  return series;
}

static inline cdem_series sine(double amplitude, double frequency) {
  return (cdem_series){.kind = CDEM_SERIES_SINE, .amplitude = amplitude, .frequency = frequency};
}

/* A support of a whole group; its node list is the caller's to free (rig_drop). */
static inline cdem_support hold(const rig *r, const char *group, int component, bool velocity,
                                cdem_series series) {
  cdem_fault fault = {0};
  int32_t *node;
  cdem_support support = {
      .name = group, .component = component, .velocity = velocity, .series = series};
  check_ok(cdem_blocks_group_nodes(&r->blocks, group, &support.nodes, &node, &fault));
  support.node = node;
  return support;
}

static inline void drop(cdem_support *support) {
  free((void *)support->node);
  cdem_series_release(&support->series);
}

/* The energy book closes to `bound` of what has been exchanged. */
static inline cdem_energy_book check_book(cdem_solver *solver, double bound) {
  cdem_energy_book book;
  cdem_solver_energies(solver, &book);
  check_below(fabs(book.error), bound * book.exchange);
  return book;
}

#endif
