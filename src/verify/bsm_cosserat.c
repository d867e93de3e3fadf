/* Patch tests of the plane Cosserat networks (the three states of Providas & Kattis 2002, in
 * general form): linear displacements with a rotation that is their spin, that differs from it by a
 * constant, and that varies linearly. The first needs no load. In the second the shear stresses
 * differ, and only a body couple q = -(s_xy - s_yx) keeps the balance; in the third the asymmetry
 * varies, so that its gradient asks for body forces too (docs/theory/cosserat.md, eqs. (5), (6)).
 *
 * Nodes of the boundary are prescribed, inner ones are found by the static solver under
 * work-equivalent nodal loads. Rules integrate all of it exactly: the solution is the field, to
 * rounding, however distorted the mesh. */
#include "verify/bsm.h"
#include "verify/cdem_world.h"

#include <math.h>
#include <stdlib.h>

static const double width = 0.24, height = 0.12;

/* u_i = u[i].(1, x, y), omega = w.(1, x, y). */
typedef struct {
  double u[2][3], w[3];
} field;

static const field fields[] = {
    {{{3e-4, 1e-3, 5e-4}, {-2e-4, 1e-3, 8e-4}}, {2.5e-4, 0.0, 0.0}},
    {{{3e-4, 1e-3, 5e-4}, {-2e-4, 1e-3, 8e-4}}, {8.5e-4, 0.0, 0.0}},
    {{{3e-4, 1e-3, 5e-4}, {-2e-4, 1e-3, 8e-4}}, {8.5e-4, 3e-3, -5e-3}},
};

static const cdem_material materials[] = {
    {.model = CDEM_COSSERAT, .parameter = {30e9, 0.25, 6e9, 0.05, 2.0}},
    {.model = CDEM_COSSERAT_LATTICE, .parameter = {2.5e8, 5e7, 2e5, 0.05}},
};

static double linear(const double c[3], const double *x) {
  return c[0] + c[1] * x[0] + c[2] * x[1];
}

static double exact(const field *f, int component, const double *x) {
  return linear(component < 2 ? f->u[component] : f->w, x);
}

/* xx yy xy yx, curvatures. */
static void strain_at(const field *f, const double *x, double e[6]) {
  double w = linear(f->w, x);
  e[0] = f->u[0][1];
  e[1] = f->u[1][2];
  e[2] = f->u[1][1] - w;
  e[3] = f->u[0][2] + w;
  e[4] = f->w[1];
  e[5] = f->w[2];
}

/* Body forces and couple per volume that balance the stress of the field. */
static void load_at(const field *f, const double d[36], const double *x, double load[3]) {
  double e[6], skew = d[14] - d[15]; /* D1212 - D1221 = 2 Gc */
  strain_at(f, x, e);
  load[0] = -skew * f->w[2];
  load[1] = skew * f->w[1];
  load[2] = -skew * (e[2] - e[3]);
}

/* ---- loads and supports ---- */

static void load_cell(const cdem_model *model, int32_t index, const field *f, const double d[36],
                      double *vector) {
  const cdem_tabulation *t = &model->kinds_of[model->kind[index]].tabulation;
  const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[index]);
  for (int q = 0; q < t->points; q++) {
    double j[2][2] = {{0.0}}, x[2] = {0.0, 0.0}, load[3];
    for (int a = 0; a < t->nodes; a++)
      for (int i = 0; i < 2; i++) {
        double at = model->mesh->xyz[3 * node[a] + i];
        x[i] += t->n[q * t->nodes + a] * at;
        for (int k = 0; k < 2; k++)
          j[i][k] += t->dn[(q * t->nodes + a) * 3 + k] * at;
      }
    double area = t->weight[q] * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
    load_at(f, d, x, load);
    for (int a = 0; a < t->nodes; a++)
      for (int k = 0; k < 3; k++)
        vector[3 * node[a] + k] += area * t->n[q * t->nodes + a] * load[k];
  }
}

static bool on_boundary(const double *x) {
  return x[0] == 0.0 || x[0] == width || x[1] == 0.0 || x[1] == height;
}

/* One support for each component of each node of the boundary: no two values are alike. */
static cdem_status support_boundary(const cdem_world *world, const field *f, const int32_t *ids,
                                    cdem_support *support, int *supports, cdem_fault *fault) {
  const double *xyz = world->blocks.mesh.xyz;
  *supports = 0;
  for (int32_t n = 0; n < world->body.nodes; n++)
    for (int c = 0; c < 3 && on_boundary(xyz + 3 * n); c++) {
      cdem_support *s = &support[(*supports)++];
      *s = (cdem_support){.name = "boundary", .component = c, .nodes = 1, .node = &ids[n]};
      CDEM_TRY(cdem_series_constant(exact(f, c, xyz + 3 * n), &s->series, fault));
    }
  return CDEM_OK;
}

/* ---- errors ---- */

static double node_error(const cdem_world *world, const field *f) {
  double worst[2] = {0.0, 0.0}, scale[2] = {0.0, 0.0};
  for (int32_t i = 0; i < 3 * world->body.nodes; i++) {
    int which = i % 3 == 2;
    double expected = exact(f, i % 3, world->blocks.mesh.xyz + i / 3 * 3);
    worst[which] = fmax(worst[which], fabs(world->solver.u[i] - expected));
    scale[which] = fmax(scale[which], fabs(expected));
  }
  return fmax(worst[0] / scale[0], worst[1] / scale[1]);
}

/* 2x2 Gauss points on the whole rectangle: the energy density is quadratic. */
static double exact_energy(const field *f, const double d[36]) {
  double sum = 0.0;
  for (int q = 0; q < 4; q++) {
    double e[6], g = 0.5 / sqrt(3.0);
    const double x[2] = {width * (0.5 + (q & 1 ? g : -g)), height * (0.5 + (q & 2 ? g : -g))};
    strain_at(f, x, e);
    for (int i = 0; i < 36; i++)
      sum += 0.125 * width * height * e[i / 6] * d[i] * e[i % 6];
  }
  return sum;
}

/* u K u/2 of the network's matrix. Every node has a cell, so rows are nodes. */
static cdem_status energy_error(const cdem_world *world, const field *f, const double d[36],
                                double *error, cdem_fault *fault) {
  cdem_sparse k = {0};
  double *product, sum = 0.0, expected = exact_energy(f, d);
  CDEM_NEW(product, (int64_t)world->body.nodes * 3, fault);
  cdem_status status = cdem_body_stiffness(&world->body, &k, fault);
  if (status == CDEM_OK) {
    cdem_sparse_multiply(&k, world->solver.u, product);
    for (int32_t i = 0; i < 3 * k.nodes; i++)
      sum += 0.5 * world->solver.u[i] * product[i];
  }
  *error = fabs(sum / expected - 1.0);
  cdem_sparse_release(&k);
  free(product);
  return status;
}

/* ---- the test ---- */

typedef struct {
  cdem_world world;
  cdem_load load;
  cdem_support *support;
  double *vector;
  int32_t *id;
} patch;

static void patch_release(patch *p) {
  int supports = p->world.motion.supports; /* the world forgets it */
  cdem_world_release(&p->world);
  for (int i = 0; p->support != NULL && i < supports; i++)
    cdem_series_release(&p->support[i].series);
  cdem_series_release(&p->load.series);
  free(p->support);
  free(p->vector);
  free(p->id);
}

static cdem_status build(patch *p, cdem_shape shape, const cdem_material *material,
                         cdem_fault *fault) {
  cdem_mesh_grid_options grid = {.shape = shape,
                                 .count = {4, 3, 0},
                                 .size = {width, height, 0.0},
                                 .distortion = 0.25,
                                 .seed = 11};
  const cdem_world_options options = {.density = 2000.0, .material = material};
  CDEM_TRY(cdem_mesh_grid(&grid, &p->world.mesh, fault));
  return cdem_world_build(&p->world, &options, fault);
}

static cdem_status solve(patch *p, const field *f, const double d[36], cdem_fault *fault) {
  cdem_world *world = &p->world;
  int32_t nodes = world->body.nodes;
  CDEM_NEW(p->vector, (int64_t)nodes * 3, fault);
  CDEM_NEW(p->id, nodes, fault);
  CDEM_NEW(p->support, (int64_t)nodes * 3, fault);
  for (int32_t n = 0; n < nodes; n++)
    p->id[n] = n;
  for (int32_t i = 0; i < world->model.cells; i++)
    load_cell(&world->model, i, f, d, p->vector);
  CDEM_TRY(support_boundary(world, f, p->id, p->support, &world->motion.supports, fault));
  p->load = (cdem_load){.name = "body", .nodes = nodes, .node = p->id, .vector = p->vector};
  CDEM_TRY(cdem_series_constant(1.0, &p->load.series, fault));
  world->motion.body = &world->body;
  world->motion.blocks = &world->blocks;
  world->motion.thickness = 1.0;
  world->motion.support = p->support;
  world->motion.loads = 1;
  world->motion.load = &p->load;
  world->motion.threads = 1;
  CDEM_TRY(cdem_solver_init(&world->motion, &world->solver, fault));
  return cdem_solver_static(&world->solver, 0.0, fault);
}

static cdem_status measure(patch *p, int parameter, double *value, cdem_fault *fault) {
  const cdem_material *material = &materials[parameter / 100];
  const field *f = &fields[parameter % 10];
  const cdem_section section = {CDEM_PLANE_STRAIN, 1.0};
  double d[36], energy = 0.0;
  int rows;
  CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_PLANE_COSSERAT, &section, d, &rows, fault));
  CDEM_TRY(
      build(p, parameter / 10 % 10 == 0 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_TRI3, material, fault));
  CDEM_TRY(solve(p, f, d, fault));
  CDEM_TRY(energy_error(&p->world, f, d, &energy, fault));
  *value = fmax(node_error(&p->world, f), energy);
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_cosserat_patch(int parameter, double *value, cdem_fault *fault) {
  patch p = {0};
  cdem_status status = measure(&p, parameter, value, fault);
  patch_release(&p);
  return status;
}
