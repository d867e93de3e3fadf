#include "base/mat3.h"
#include "cdem/solver_store.h"

#include <stdlib.h>
#include <string.h>

static const cdem_mesh *mesh_of(const cdem_solver *solver) {
  return solver->store->options.body->model->mesh;
}

/* ---- supports ---- */

double cdem_support_path(const cdem_support *support, double time) {
  return support->velocity ? cdem_series_integral(&support->series, time)
                           : cdem_series_at(&support->series, time);
}

void cdem_solver_paths(cdem_solver *solver, double time) {
  cdem_solver_store *s = solver->store;
  for (int k = 0; k < s->options.supports; k++)
    s->path[k] = cdem_support_path(&s->options.support[k], time);
}

static cdem_status claim(cdem_solver *solver, int index, int32_t node, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_support *support = &s->options.support[index];
  CDEM_REQUIRE(node >= 0 && node < solver->nodes, fault, CDEM_USAGE,
               "support '%s' names node %d of a mesh of %d", support->name, (int)node,
               (int)solver->nodes);
  int16_t *owner = &s->support_of[(size_t)node * (size_t)solver->dofs + (size_t)support->component];
  if (*owner >= 0) {
    const cdem_support *other = &s->options.support[*owner];
    CDEM_REQUIRE(other->velocity == support->velocity &&
                     cdem_series_same(&other->series, &support->series),
                 fault, CDEM_INPUT,
                 "supports '%s' and '%s' prescribe component %d of node %lld differently; take the "
                 "node out of one of them",
                 other->name, support->name, support->component + 1,
                 (long long)mesh_of(solver)->node_tag[node]);
    return CDEM_OK;
  }
  *owner = (int16_t)index;
  s->flag[node] |= (uint8_t)(1U << support->component);
  return CDEM_OK;
}

cdem_status cdem_solver_supports_init(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  for (int k = 0; k < s->options.supports; k++) {
    const cdem_support *support = &s->options.support[k];
    CDEM_REQUIRE(support->component >= 0 && support->component < solver->dofs, fault, CDEM_INPUT,
                 "support '%s' prescribes component %d; nodes of this body have %d", support->name,
                 support->component + 1, solver->dofs);
    for (int32_t i = 0; i < support->nodes; i++)
      CDEM_TRY(claim(solver, k, support->node[i], fault));
  }
  return CDEM_OK;
}

/* ---- surfaces ---- */

void cdem_surface_vectors(const double xyz[4][3], int corners, double thickness,
                          double vector[4][3]) {
  memset(vector, 0, 4 * sizeof vector[0]);
  if (corners == 2) { /* interior on the left: the outward normal is the tangent turned right */
    double half = 0.5 * thickness;
    for (int i = 0; i < 2; i++) {
      vector[i][0] = half * (xyz[1][1] - xyz[0][1]);
      vector[i][1] = -half * (xyz[1][0] - xyz[0][0]);
    }
    return;
  }
  if (corners == 3) {
    double a[3], b[3], n[3];
    for (int k = 0; k < 3; k++) {
      a[k] = xyz[1][k] - xyz[0][k];
      b[k] = xyz[2][k] - xyz[0][k];
    }
    cdem_cross3(a, b, n);
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++)
        vector[i][k] = n[k] / 6.0;
    return;
  }
  /* N_i (x_xi cross x_eta) is quadratic in either direction: 2 x 2 points are exact. */
  static const double sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const double g = 1.0 / sqrt(3.0);
  for (int p = 0; p < 4; p++) {
    double xi = g * sign[p][0], eta = g * sign[p][1], a[3] = {0}, b[3] = {0}, n[3];
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++) {
        a[k] += 0.25 * sign[i][0] * (1.0 + eta * sign[i][1]) * xyz[i][k];
        b[k] += 0.25 * sign[i][1] * (1.0 + xi * sign[i][0]) * xyz[i][k];
      }
    cdem_cross3(a, b, n);
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++)
        vector[i][k] += 0.25 * (1.0 + xi * sign[i][0]) * (1.0 + eta * sign[i][1]) * n[k];
  }
}

void cdem_solver_corners(const cdem_solver *solver, const cdem_facet *facet, const double *u,
                         double xyz[4][3]) {
  const cdem_mesh *mesh = mesh_of(solver);
  const double *base = mesh->xyz + 3 * (size_t)facet->node[0];
  int dim = solver->store->dimension;
  for (int c = 0; c < facet->corners; c++) {
    size_t node = (size_t)facet->node[c];
    for (int k = 0; k < 3; k++) {
      xyz[c][k] = mesh->xyz[3 * node + (size_t)k] - base[k];
      if (u != NULL && k < dim)
        xyz[c][k] += u[node * (size_t)solver->dofs + (size_t)k];
    }
  }
}

void cdem_solver_shares(const cdem_solver *solver, int32_t facet, double share[4],
                        double normal[3]) {
  const cdem_facet *f = &solver->store->options.blocks->facet[facet];
  double xyz[4][3], vector[4][3], area[3] = {0};
  cdem_solver_corners(solver, f, NULL, xyz);
  cdem_surface_vectors((const double(*)[3])xyz, f->corners, solver->store->options.thickness,
                       vector);
  for (int c = 0; c < f->corners; c++)
    for (int k = 0; k < 3; k++)
      area[k] += vector[c][k];
  double size = cdem_norm3(area);
  for (int k = 0; k < 3; k++)
    normal[k] = area[k] / size;
  for (int c = 0; c < 4; c++)
    share[c] = c < f->corners ? cdem_dot3(vector[c], normal) : 0.0;
}

/* ---- loads and pressures ---- */

static cdem_status mark_loaded(cdem_solver *solver, const char *name, int32_t node,
                               cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  CDEM_REQUIRE(node >= 0 && node < solver->nodes, fault, CDEM_USAGE,
               "load '%s' names node %d of a mesh of %d", name, (int)node, (int)solver->nodes);
  if (!(s->flag[node] & CDEM_NODE_LOADED))
    s->loaded++;
  s->flag[node] |= CDEM_NODE_LOADED;
  return CDEM_OK;
}

static cdem_status check_facet(const cdem_solver *solver, const char *name, int32_t facet,
                               cdem_fault *fault) {
  const cdem_blocks *blocks = solver->store->options.blocks;
  CDEM_REQUIRE(blocks != NULL && facet >= 0 && facet < blocks->facets, fault, CDEM_USAGE,
               "'%s' names facet %d of a surface of %d", name, (int)facet,
               blocks == NULL ? 0 : (int)blocks->facets);
  return CDEM_OK;
}

cdem_status cdem_solver_loads_init(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  int32_t largest = 0;
  for (int k = 0; k < o->loads; k++)
    for (int32_t i = 0; i < o->load[k].nodes; i++)
      CDEM_TRY(mark_loaded(solver, o->load[k].name, o->load[k].node[i], fault));
  for (int k = 0; k < o->pressures; k++) {
    const cdem_pressure *p = &o->pressure[k];
    largest = p->facets > largest ? p->facets : largest;
    for (int32_t i = 0; i < p->facets; i++) {
      CDEM_TRY(check_facet(solver, p->name, p->facet[i], fault));
      const cdem_facet *facet = &o->blocks->facet[p->facet[i]];
      for (int c = 0; c < facet->corners; c++)
        CDEM_TRY(mark_loaded(solver, p->name, facet->node[c], fault));
    }
  }
  CDEM_NEW(s->pressed, 12 * (int64_t)largest, fault);
  CDEM_NEW(s->loaded_node, s->loaded, fault);
  int32_t count = 0;
  for (int32_t n = 0; n < solver->nodes; n++) {
    if (s->flag[n] & CDEM_NODE_LOADED)
      s->loaded_node[count++] = n;
    for (int i = 0; i < s->dimension; i++) {
      size_t at = (size_t)n * (size_t)solver->dofs + (size_t)i;
      solver->external[at] = o->body->mass[at] * o->gravity[i];
    }
  }
  return CDEM_OK;
}

static void add_pressure(cdem_solver *solver, const cdem_pressure *p, const double *u,
                         double value) {
  cdem_solver_store *s = solver->store;
  const cdem_blocks *blocks = s->options.blocks;
  double(*vector)[4][3] = (double(*)[4][3])s->pressed;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int32_t i = 0; i < p->facets; i++) {
    const cdem_facet *facet = &blocks->facet[p->facet[i]];
    double xyz[4][3];
    cdem_solver_corners(solver, facet, u, xyz);
    cdem_surface_vectors((const double(*)[3])xyz, facet->corners, s->options.thickness, vector[i]);
  }
  for (int32_t i = 0; i < p->facets; i++) {
    const cdem_facet *facet = &blocks->facet[p->facet[i]];
    for (int c = 0; c < facet->corners; c++)
      for (int k = 0; k < s->dimension; k++)
        solver->external[(size_t)facet->node[c] * (size_t)solver->dofs + (size_t)k] -=
            value * vector[i][c][k];
  }
}

void cdem_solver_external(cdem_solver *solver, const double *u, double time) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  size_t dofs = (size_t)solver->dofs;
  for (int32_t l = 0; l < s->loaded; l++) {
    size_t first = (size_t)s->loaded_node[l] * dofs;
    for (int i = 0; i < solver->dofs; i++)
      solver->external[first + (size_t)i] =
          i < s->dimension ? o->body->mass[first + (size_t)i] * o->gravity[i] : 0.0;
  }
  for (int k = 0; k < o->loads; k++) {
    const cdem_load *load = &o->load[k];
    double factor = cdem_series_at(&load->series, time);
    for (int32_t n = 0; n < load->nodes; n++)
      for (size_t i = 0; i < dofs; i++)
        solver->external[(size_t)load->node[n] * dofs + i] +=
            factor * load->vector[(size_t)n * dofs + i];
  }
  for (int k = 0; k < o->pressures; k++) {
    double value = cdem_series_at(&o->pressure[k].series, time);
    if (value != 0.0)
      add_pressure(solver, &o->pressure[k], u, value);
  }
}

/* ---- quiet boundaries ---- */

static void add_dashpot(cdem_solver_store *s, int32_t node, double area, const double normal[3],
                        const double impedance[2]) {
  double *d = s->dashpot + (size_t)9 * (size_t)s->dashpot_of[node];
  for (int i = 0; i < s->dimension; i++)
    for (int j = 0; j < s->dimension; j++)
      d[3 * i + j] += area * ((impedance[0] - impedance[1]) * normal[i] * normal[j] +
                              (i == j ? impedance[1] : 0.0));
}

cdem_status cdem_solver_quiet_init(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  if (o->quiets == 0 || o->fictitious_mass) /* velocities per counted step mean nothing to it */
    return CDEM_OK;
  CDEM_NEW(s->dashpot_of, solver->nodes, fault);
  for (int k = 0; k < o->quiets; k++)
    for (int32_t i = 0; i < o->quiet[k].facets; i++) {
      CDEM_TRY(check_facet(solver, "quiet boundary", o->quiet[k].facet[i], fault));
      const cdem_facet *facet = &o->blocks->facet[o->quiet[k].facet[i]];
      for (int c = 0; c < facet->corners; c++)
        if (!(s->flag[facet->node[c]] & CDEM_NODE_QUIET)) {
          s->flag[facet->node[c]] |= CDEM_NODE_QUIET;
          s->dashpot_of[facet->node[c]] = s->quiet++;
        }
    }
  CDEM_NEW(s->dashpot, 9 * (int64_t)s->quiet, fault);
  for (int k = 0; k < o->quiets; k++)
    for (int32_t i = 0; i < o->quiet[k].facets; i++) {
      const cdem_facet *facet = &o->blocks->facet[o->quiet[k].facet[i]];
      double share[4], normal[3];
      cdem_solver_shares(solver, o->quiet[k].facet[i], share, normal);
      for (int c = 0; c < facet->corners; c++)
        add_dashpot(s, facet->node[c], share[c], normal, o->quiet[k].impedance + 2 * (size_t)i);
    }
  return CDEM_OK;
}
