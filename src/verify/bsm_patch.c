/* The projector of the foundation's grains, and a homogeneous strain across the edge of a fine
 * region: what is left over at the nodes of that edge. */
#include "base/mat3.h"
#include "base/memory.h"
#include "base/random.h"
#include "bsm/bsm.h"
#include "cdem/body.h"
#include "dem/packing.h"
#include "verify/bsm.h"
#include "verify/dem_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- a mesh, a lattice, and what is fine of both ---- */

typedef struct {
  cdem_mesh mesh;
  cdem_grains grains;
  int32_t cells, *cell;
  cdem_partition partition;
} scene;

static void scene_release(scene *s) {
  cdem_partition_release(&s->partition);
  cdem_grains_release(&s->grains);
  cdem_mesh_release(&s->mesh);
  free(s->cell);
}

/* `count` quadrilaterals over `size` m with the top at y = 0 and the middle at x = 0, the turned
 * square lattice of radius r in it with its highest row at `top`, and the box `fine`. */
static cdem_status scene_init(scene *s, const int32_t count[2], const double size[2], double radius,
                              double top, const cdem_bsm_box *fine, cdem_fault *fault) {
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_QUAD4, .count = {count[0], count[1], 0}, .size = {size[0], size[1], 0.0}};
  const cdem_packing_options packing = {.dim = 2,
                                        .low = {-0.5 * size[0], -size[1], 0.0},
                                        .high = {0.5 * size[0], top + radius, 0.0},
                                        .centres_inside = true,
                                        .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = radius}};
  CDEM_TRY(cdem_mesh_grid(&grid, &s->mesh, fault));
  for (int32_t n = 0; n < s->mesh.nodes; n++) {
    s->mesh.xyz[3 * (int64_t)n] -= 0.5 * size[0];
    s->mesh.xyz[3 * (int64_t)n + 1] -= size[1];
  }
  s->grains.dim = 2;
  CDEM_TRY(cdem_packing_make(cdem_packing_find("square"), &packing, &s->grains, fault));
  CDEM_TRY(cdem_bsm_cells(&s->mesh, 1, fine, &s->cells, &s->cell, fault));
  return cdem_partition_init(&s->mesh, s->cells, s->cell, &s->grains, 0.3, &s->partition, fault);
}

/* The foundation of Li & Wan (2010), section 3, on elements of 7/6 m. */
static cdem_status foundation(scene *s, double radius, cdem_fault *fault) {
  static const int32_t count[2] = {18, 9};
  static const double size[2] = {21.0, 10.5};
  const cdem_bsm_box fine = {{-3.5, -3.5, 0.0}, {3.5, 0.0, 0.0}};
  return scene_init(s, count, size, radius, -radius, &fine, fault);
}

cdem_status cdem_bsm_measure_counts(int parameter, double *value, cdem_fault *fault) {
  scene s = {0};
  cdem_status status = foundation(&s, parameter == 0 ? 0.05 : 0.03, fault);
  *value = (double)s.partition.fine;
  scene_release(&s);
  return status;
}

/* ---- identities ---- */

typedef struct {
  int64_t grains;
  int32_t *cell;
  double *xi, *mass, *inertia, *q, *pq, *ppq, *qq;
} fields;

static void fields_release(fields *f) {
  free(f->cell);
  free(f->xi);
  free(f->mass);
  free(f->inertia);
  free(f->q);
  free(f->pq);
  free(f->ppq);
  free(f->qq);
}

static cdem_status fields_init(const scene *s, fields *f, cdem_fault *fault) {
  cdem_random random = {.state = 7};
  int64_t n = s->partition.fine, a = 0;
  f->grains = n;
  CDEM_NEW(f->cell, n, fault);
  CDEM_NEW(f->xi, 3 * n, fault);
  CDEM_NEW(f->mass, n, fault);
  CDEM_NEW(f->inertia, n, fault);
  CDEM_NEW(f->q, 3 * n, fault);
  CDEM_NEW(f->pq, 3 * n, fault);
  CDEM_NEW(f->ppq, 3 * n, fault);
  CDEM_NEW(f->qq, 3 * n, fault);
  for (int64_t i = 0; i < s->partition.grains; i++) {
    if (s->partition.part[i] != CDEM_PART_FINE)
      continue;
    /* masses all different: the projector must not live on the regular lattice */
    f->mass[a] = cdem_random_uniform(&random, 5.0, 40.0);
    f->inertia[a] = f->mass[a] * cdem_random_uniform(&random, 0.5e-3, 2e-3);
    f->cell[a] = s->partition.cell[i];
    memcpy(f->xi + 3 * a++, s->partition.xi + 3 * i, 3 * sizeof(double));
  }
  for (int64_t k = 0; k < 3 * n; k++)
    f->q[k] = cdem_random_uniform(&random, -1.0, 1.0);
  return CDEM_OK;
}

static double largest(int64_t count, const double *v) {
  double most = 0.0;
  for (int64_t i = 0; i < count; i++)
    most = fmax(most, fabs(v[i]));
  return most;
}

static const cdem_projector_shape shape = {2, 1};

/* |P P q - P q| */
static cdem_status idempotent(const cdem_projector *p, fields *f, double *value,
                              cdem_fault *fault) {
  CDEM_TRY(cdem_projector_split(p, shape, f->q, f->pq, f->qq, fault));
  CDEM_TRY(cdem_projector_split(p, shape, f->pq, f->ppq, NULL, fault));
  for (int64_t k = 0; k < 3 * f->grains; k++)
    f->ppq[k] -= f->pq[k];
  *value = largest(3 * f->grains, f->ppq);
  return CDEM_OK;
}

/* |Q N d| for random d, by |N d| */
static cdem_status complement(const cdem_projector *p, fields *f, double *value,
                              cdem_fault *fault) {
  cdem_random random = {.state = 11};
  double *d;
  CDEM_NEW(d, 3 * (int64_t)p->nodes, fault);
  for (int64_t k = 0; k < 3 * (int64_t)p->nodes; k++)
    d[k] = cdem_random_uniform(&random, -1.0, 1.0);
  cdem_weights_interpolate(&p->weights, 3, d, f->pq);
  free(d);
  CDEM_TRY(cdem_projector_split(p, shape, f->pq, NULL, f->qq, fault));
  *value = largest(3 * f->grains, f->qq) / largest(3 * f->grains, f->pq);
  return CDEM_OK;
}

/* |N^T Mp Q q| by |N^T Mp q| */
static cdem_status orthogonal(const cdem_projector *p, fields *f, double *value,
                              cdem_fault *fault) {
  double *sum;
  CDEM_NEW(sum, 6 * (int64_t)p->nodes, fault);
  cdem_status status = cdem_projector_split(p, shape, f->q, NULL, f->qq, fault);
  for (int64_t a = 0; a < f->grains; a++)
    for (int k = 0; k < 3; k++) {
      double m = k < 2 ? f->mass[a] : f->inertia[a];
      f->pq[3 * a + k] = m * f->q[3 * a + k];
      f->qq[3 * a + k] *= m;
    }
  cdem_weights_gather(&p->weights, 3, f->pq, sum);
  cdem_weights_gather(&p->weights, 3, f->qq, sum + 3 * (int64_t)p->nodes);
  *value = largest(3 * (int64_t)p->nodes, sum + 3 * (int64_t)p->nodes) /
           largest(3 * (int64_t)p->nodes, sum);
  free(sum);
  return status;
}

/* |T - T(P v) - T(Q v)| by T */
static cdem_status splits(const cdem_projector *p, fields *f, double *value, cdem_fault *fault) {
  CDEM_TRY(cdem_projector_split(p, shape, f->q, f->pq, f->qq, fault));
  double whole = cdem_projector_energy(p, shape, f->q);
  *value = fabs(whole - cdem_projector_energy(p, shape, f->pq) -
                cdem_projector_energy(p, shape, f->qq)) /
           whole;
  return CDEM_OK;
}

/* |Q q| of a field that is linear in the place */
static cdem_status linear(const scene *s, const cdem_projector *p, fields *f, double *value,
                          cdem_fault *fault) {
  int64_t a = 0;
  for (int64_t i = 0; i < s->partition.grains; i++) {
    const double *x = s->grains.xyz + 3 * i;
    if (s->partition.part[i] != CDEM_PART_FINE)
      continue;
    f->q[3 * a] = 0.3 + 0.2 * x[0] - 0.7 * x[1];
    f->q[3 * a + 1] = -0.1 + 0.5 * x[0] + 0.4 * x[1];
    f->q[3 * a++ + 2] = 0.6 - 0.2 * x[0] + 0.1 * x[1];
  }
  CDEM_TRY(cdem_projector_split(p, shape, f->q, NULL, f->qq, fault));
  *value = largest(3 * f->grains, f->qq) / largest(3 * f->grains, f->q);
  return CDEM_OK;
}

cdem_status cdem_bsm_measure_identity(int parameter, double *value, cdem_fault *fault) {
  scene s = {0};
  fields f = {0};
  cdem_projector p = {0};
  cdem_status status = foundation(&s, 0.05, fault);
  if (status == CDEM_OK)
    status = fields_init(&s, &f, fault);
  if (status == CDEM_OK)
    status = cdem_projector_init(&(cdem_projector_options){&s.mesh, s.cells, s.cell, f.grains,
                                                           f.cell, f.xi, f.mass, f.inertia},
                                 &p, fault);
  if (status == CDEM_OK)
    status = parameter == 0   ? idempotent(&p, &f, value, fault)
             : parameter == 1 ? complement(&p, &f, value, fault)
             : parameter == 2 ? orthogonal(&p, &f, value, fault)
             : parameter == 3 ? splits(&p, &f, value, fault)
                              : linear(&s, &p, &f, value, fault);
  cdem_projector_release(&p);
  fields_release(&f);
  scene_release(&s);
  return status;
}

/* ---- homogeneous strain ---- */

static const double kn = 2.5e8, ks = 5e7, k_omega = 700.0;

typedef struct {
  scene s;
  cdem_material material;
  cdem_model model;
  cdem_body body;
  cdem_dem_world world;
  cdem_tie tie, fine_tie;
  double gradient[2][2], spin; /* of the displacements over the strain's size */
} patch;

static void patch_release(patch *p) {
  cdem_tie_release(&p->tie);
  cdem_tie_release(&p->fine_tie);
  cdem_dem_world_release(&p->world);
  cdem_body_release(&p->body);
  cdem_model_release(&p->model);
  scene_release(&p->s);
}

static cdem_status make_body(patch *p, cdem_fault *fault) {
  static const char *const outer[] = {"outer"};
  static const double density = 2042.0;
  p->material = (cdem_material){
      .model = CDEM_COSSERAT_CUBIC,
      .parameter = {0.5 * (kn + ks), 0.5 * (kn - ks), 0.5 * (kn + ks), 0.5 * (kn - ks), k_omega}};
  CDEM_TRY(cdem_mesh_add_group(&p->s.mesh, outer[0], 2, p->s.partition.outer_cells,
                               p->s.partition.outer_cell, fault));
  const cdem_model_options options = {.mesh = &p->s.mesh,
                                      .groups = 1,
                                      .group = outer,
                                      .materials = 1,
                                      .material = &p->material,
                                      .section = {CDEM_PLANE_STRAIN, 1.0}};
  CDEM_TRY(cdem_model_init(&options, &p->model, fault));
  return cdem_body_init(&p->model,
                        &(cdem_body_options){.density = &density, .linear = true, .threads = 1},
                        &p->body, fault);
}

/* Fine and interface grains with the velocity of the strain, bonded where they touch. */
static cdem_status make_grains(patch *p, cdem_fault *fault) {
  const cdem_partition *part = &p->s.partition;
  cdem_dem_world *w = &p->world;
  CDEM_TRY(cdem_dem_world_init(w, 2, "linear", 2600.0, fault));
  cdem_dem_world_set(w, CDEM_LAW_normal_stiffness, kn);
  cdem_dem_world_set(w, CDEM_LAW_shear_stiffness, ks);
  cdem_dem_world_set(w, CDEM_LAW_normal_dashpot, 0.0);
  w->bond_law =
      (cdem_bond_law){.normal_stiffness = kn, .shear_stiffness = ks, .rolling_stiffness = k_omega};
  for (int64_t i = 0; i < part->grains; i++) {
    const double *x = p->s.grains.xyz + 3 * i;
    double v[3] = {0}, spin[3] = {0.0, 0.0, p->spin};
    if (part->part[i] == CDEM_PART_AWAY)
      continue;
    for (int k = 0; k < 2; k++)
      v[k] = p->gradient[k][0] * x[0] + p->gradient[k][1] * x[1];
    CDEM_TRY(cdem_dem_world_add(w, x, p->s.grains.radius[i], v, spin, fault));
    w->grains.motion[w->grains.grains - 1] =
        part->part[i] == CDEM_PART_INTERFACE ? CDEM_GRAIN_DRIVEN : CDEM_GRAIN_FREE;
  }
  for (int32_t a = 0; a < w->grains.grains; a++)
    for (int32_t b = a + 1; b < w->grains.grains; b++) {
      double d[3];
      for (int k = 0; k < 3; k++)
        d[k] = w->grains.xyz[3 * b + k] - w->grains.xyz[3 * a + k];
      if (cdem_norm3(d) < 1.01 * (w->grains.radius[a] + w->grains.radius[b]))
        CDEM_TRY(cdem_dem_world_bond(w, a, b, fault));
    }
  w->options.safety = 0.1;
  CDEM_TRY(cdem_dem_world_start(w, fault));
  return cdem_dem_step(&w->dem, fault); /* at rest forces vanish: the first step is free of them */
}

/* Ties of one part; `of` counts grains that are not away. */
static cdem_status make_tie(patch *p, cdem_bsm_part wanted, cdem_tie *tie, cdem_fault *fault) {
  const cdem_partition *part = &p->s.partition;
  int64_t most = part->grains, count = 0;
  int32_t *grain = cdem_allocate(most, sizeof *grain, fault), id = 0;
  int32_t *cell = cdem_allocate(most, sizeof *cell, fault);
  double *xi = cdem_allocate(3 * most, sizeof *xi, fault);
  cdem_status status = grain != NULL && cell != NULL && xi != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int64_t i = 0; status == CDEM_OK && i < part->grains; i++) {
    if (part->part[i] == wanted) {
      grain[count] = id;
      cell[count] = part->cell[i];
      memcpy(xi + 3 * count++, part->xi + 3 * i, 3 * sizeof *xi);
    }
    id += part->part[i] != CDEM_PART_AWAY;
  }
  if (status == CDEM_OK)
    status = cdem_tie_init(&p->s.mesh, 3, count, grain, cell, xi, tie, fault);
  free(grain);
  free(cell);
  free(xi);
  return status;
}

/* Forces of body and grains at all nodes; both at the same strain, gradient times dt. */
static cdem_status sum_forces(patch *p, bool virtual_work, double *force, cdem_fault *fault) {
  double dt = p->world.dem.step, *u, *on;
  CDEM_NEW(u, 3 * (int64_t)p->s.mesh.nodes, fault);
  on = cdem_allocate(6 * p->world.grains.grains, sizeof *on, fault);
  for (int32_t n = 0; n < p->s.mesh.nodes; n++) {
    const double *x = p->s.mesh.xyz + 3 * (int64_t)n;
    for (int k = 0; k < 2; k++)
      u[3 * n + k] = dt * (p->gradient[k][0] * x[0] + p->gradient[k][1] * x[1]);
    u[3 * n + 2] = dt * p->spin;
  }
  cdem_body_forces(&p->body, u, force);
  if (on != NULL) {
    cdem_dem_forces_on(&p->world.dem, p->tie.grains, p->tie.grain, on);
    cdem_tie_forces(&p->tie, on, force);
    if (virtual_work) {
      cdem_dem_forces_on(&p->world.dem, p->fine_tie.grains, p->fine_tie.grain, on);
      cdem_tie_forces(&p->fine_tie, on, force);
    }
  }
  free(u);
  free(on);
  return on != NULL ? CDEM_OK : CDEM_MEMORY;
}

/* Largest force left at nodes that the tie loads and that do not lie on the edge of the mesh, by
 * the largest traction times an element's edge. */
static double residual(const patch *p, const double *force, double h, double width, double depth) {
  double g[4] = {p->gradient[0][0], p->gradient[1][1], p->gradient[1][0] - p->spin,
                 p->gradient[0][1] + p->spin};
  double a = 0.5 * (kn + ks), b = 0.5 * (kn - ks), dt = p->world.dem.step, most = 0.0;
  const double stress[4] = {a * g[0] + b * g[1], b * g[0] + a * g[1], a * g[2] + b * g[3],
                            b * g[2] + a * g[3]};
  double traction = 0.0;
  for (int k = 0; k < 4; k++)
    traction = fmax(traction, fabs(stress[k]) * dt);
  for (int32_t i = 0; i < p->tie.nodes; i++) {
    int32_t n = p->tie.node[i];
    const double *x = p->s.mesh.xyz + 3 * (int64_t)n;
    bool inside = fabs(x[0]) < 0.5 * width - 0.5 * h && x[1] > -depth + 0.5 * h && x[1] < -0.5 * h;
    for (int k = 0; inside && k < 2; k++)
      most = fmax(most, fabs(force[3 * (int64_t)n + k]));
  }
  return most / (traction * h);
}

/* parameter: 10 form (0 interface, 1 virtual work) + 4 size (0: h = 1 m, 1: h = 0.5 m) + strain (0
 * along x, 1 along y, 2 shear, 3 spin against the grains). */
static cdem_status one_patch(int strain, bool virtual_work, bool small, double *value,
                             cdem_fault *fault) {
  static const double gradients[4][2][2] = {
      {{1, 0}, {0, 0}}, {{0, 0}, {0, 1}}, {{0, 0.5}, {0.5, 0}}, {{0, 0}, {0, 0}}};
  /* Rows are `spacing` apart, one of them at x = 0 and at y = 0; with these elements the edges of
   * the fine region at 2 h and 6 h lie in the middle between two rows. */
  const double radius = 0.05, spacing = sqrt(2.0) * radius;
  const double h = (small ? 7.25 : 14.25) * spacing, size[2] = {8.0 * h, 8.0 * h};
  const cdem_bsm_box fine = {{-2.0 * h, -6.0 * h, 0.0}, {2.0 * h, -2.0 * h, 0.0}};
  patch *p;
  double *force = NULL;
  CDEM_NEW(p, 1, fault);
  memcpy(p->gradient, gradients[strain], sizeof p->gradient);
  p->spin = strain == 3 ? 1.0 : 0.0;
  for (int k = 0; k < 2; k++)
    for (int l = 0; l < 2; l++)
      p->gradient[k][l] *= 1e-3; /* 1/s: a strain of some 1e-8 in the first step */
  p->spin *= 1e-3;
  cdem_status status = scene_init(&p->s, (const int32_t[2]){8, 8}, size, radius, 0.0, &fine, fault);
  if (status == CDEM_OK)
    status = make_body(p, fault);
  if (status == CDEM_OK)
    status = make_grains(p, fault);
  if (status == CDEM_OK)
    status = make_tie(p, CDEM_PART_INTERFACE, &p->tie, fault);
  if (status == CDEM_OK)
    status = make_tie(p, CDEM_PART_FINE, &p->fine_tie, fault);
  if (status == CDEM_OK &&
      (force = cdem_allocate(3 * (int64_t)p->s.mesh.nodes, sizeof *force, fault)) == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK)
    status = sum_forces(p, virtual_work, force, fault);
  if (status == CDEM_OK)
    *value = fmax(*value, residual(p, force, h, size[0], size[1]));
  free(force);
  patch_release(p);
  free(p);
  return status;
}

cdem_status cdem_bsm_measure_patch(int parameter, double *value, cdem_fault *fault) {
  *value = 0.0;
  for (int strain = 0; strain < 4; strain++)
    CDEM_TRY(one_patch(strain, parameter / 10 == 1, parameter % 10 == 1, value, fault));
  return CDEM_OK;
}
