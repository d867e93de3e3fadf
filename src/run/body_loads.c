/* Loads of a case as nodal vectors: forces spread over a group, tractions, Kirsch's tractions; and
 * pressures and quiet boundaries as lists of facets. */
#include "run/body.h"
#include "run/kirsch.h"

#include <stdlib.h>
#include <string.h>

/* One weight a node of the whole mesh, gathered from facets, cells or single nodes. */
typedef struct {
  double *weight; /* [nodes][width] */
  int width;
} node_field;

/* ---- weights ---- */

/* Facets of a group of faces, with an error at `key`. */
static cdem_status group_facets(const cdem_run_body *setup, const char *key, const char *name,
                                int32_t *count, int32_t **facet, cdem_fault *fault) {
  const cdem_group *group;
  int dimension = setup->blocks.dimension - 1;
  CDEM_TRY(cdem_run_find_group(setup, key, name, dimension, dimension, &group, fault));
  cdem_status status = cdem_blocks_group_facets(&setup->blocks, name, count, facet, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, key, fault) : status;
}

/* Each node's share of the area of a group of faces, m^2. */
static cdem_status area_weights(const cdem_run_body *setup, const char *key, const char *name,
                                double *weight, cdem_fault *fault) {
  int32_t count, *facet;
  CDEM_TRY(group_facets(setup, key, name, &count, &facet, fault));
  for (int32_t i = 0; i < count; i++) {
    const cdem_facet *f = &setup->blocks.facet[facet[i]];
    double area[3], share[4];
    cdem_run_facet(setup, f, area, share);
    for (int k = 0; k < f->corners; k++)
      weight[f->node[k]] += share[k];
  }
  free(facet);
  return CDEM_OK;
}

/* Of a group of volumes: an equal part of each cell's volume. Of points and lines: 1 each. */
static cdem_status other_weights(const cdem_run_body *setup, const cdem_group *group,
                                 double *weight, cdem_fault *fault) {
  const cdem_mesh *mesh = &setup->blocks.mesh;
  if (group->dimension == setup->blocks.dimension) {
    for (int32_t i = 0; i < group->cells; i++) {
      int32_t cell = group->cell[i];
      int nodes = (int)(mesh->cell_start[cell + 1] - mesh->cell_start[cell]);
      for (int k = 0; k < nodes; k++)
        weight[cdem_mesh_cell(mesh, cell)[k]] += setup->volume[setup->model_of[cell]] / nodes;
    }
    return CDEM_OK;
  }
  int32_t count, *node;
  CDEM_TRY(cdem_blocks_group_nodes(&setup->blocks, group->name, &count, &node, fault));
  for (int32_t i = 0; i < count; i++)
    weight[node[i]] = 1.0;
  free(node);
  return CDEM_OK;
}

/* ---- adding ---- */

/* A load from a field that is zero at most nodes: vector = field (width 1: along `dof`). */
static cdem_status add_load(cdem_run_body *setup, const char *name, const cdem_series *series,
                            const node_field *field, int dof, cdem_fault *fault) {
  cdem_run_conditions *c = &setup->conditions;
  int dofs = setup->body.dofs;
  int32_t count = 0, *node;
  double *vector;
  CDEM_TRY(cdem_grow(&c->load, &c->capacity[1], c->loads + 1, sizeof *c->load, fault));
  for (int32_t n = 0; n < setup->body.nodes; n++)
    for (int k = 0, found = 0; k < field->width && !found; k++)
      count += found = field->weight[(int64_t)n * field->width + k] != 0.0;
  CDEM_NEW(node, count, fault);
  vector = cdem_allocate((int64_t)count * dofs, sizeof *vector, fault);
  if (vector == NULL) {
    free(node);
    return CDEM_MEMORY;
  }
  int32_t used = 0;
  for (int32_t n = 0; n < setup->body.nodes; n++) {
    const double *w = field->weight + (int64_t)n * field->width;
    bool any = false;
    for (int k = 0; k < field->width; k++)
      any = any || w[k] != 0.0;
    if (!any)
      continue;
    for (int k = 0; k < field->width; k++)
      vector[(int64_t)used * dofs + (field->width == 1 ? dof : k)] = w[k];
    node[used++] = n;
  }
  c->load[c->loads++] =
      (cdem_load){.name = name, .series = *series, .nodes = count, .node = node, .vector = vector};
  return CDEM_OK;
}

static cdem_status add_components(cdem_run_body *setup, int64_t index, bool traction,
                                  const node_field *field, cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  const cdem_case_components *wanted = traction ? &load->traction : &load->force;
  char key[96];
  cdem_run_key(key, "loads", index, traction ? "traction" : "force");
  for (int k = 0; k < 4; k++)
    if (wanted->given[k]) {
      int dof;
      CDEM_TRY(cdem_run_dof(setup, key, k, &dof, fault));
      CDEM_TRY(add_load(setup, load->group, &wanted->component[k], field, dof, fault));
    }
  return CDEM_OK;
}

static bool any_given(const cdem_case_components *components) {
  return components->given[0] || components->given[1] || components->given[2] ||
         components->given[3];
}

/* A total force: weights that sum to one. */
static cdem_status force_load(cdem_run_body *setup, int64_t index, node_field *field,
                              cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  const cdem_group *group;
  char key[96];
  cdem_run_key(key, "loads", index, "group");
  CDEM_TRY(cdem_run_find_group(setup, key, load->group, 0, 3, &group, fault));
  if (group->dimension == setup->blocks.dimension - 1)
    CDEM_TRY(area_weights(setup, key, load->group, field->weight, fault));
  else
    CDEM_TRY(other_weights(setup, group, field->weight, fault));
  double sum = 0.0;
  for (int32_t n = 0; n < setup->body.nodes; n++)
    sum += field->weight[n];
  if (!(sum > 0.0))
    return cdem_case_fail(&setup->run->cases, key, CDEM_INPUT, fault,
                          "group '%s' has no surface or node to carry the force", load->group);
  for (int32_t n = 0; n < setup->body.nodes; n++)
    field->weight[n] /= sum;
  return add_components(setup, index, false, field, fault);
}

static cdem_status traction_load(cdem_run_body *setup, int64_t index, node_field *field,
                                 cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  char key[96];
  CDEM_TRY(area_weights(setup, cdem_run_key(key, "loads", index, "group"), load->group,
                        field->weight, fault));
  return add_components(setup, index, true, field, fault);
}

/* ---- Kirsch ---- */

enum { GAUSS = 5 };
static const double gauss_place[GAUSS] = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                          0.5384693101056831, 0.9061798459386640};
static const double gauss_weight[GAUSS] = {0.2369268850561891, 0.4786286704993665,
                                           0.5688888888888889, 0.4786286704993665,
                                           0.2369268850561891};

/* Shape functions n [4] and their derivatives of a facet at (s, t) in -1..1: an edge, or a
 * quadrilateral, of which a triangle is the one with corners 2 and 3 in one place. */
static void facet_shape(int corners, double s, double t, double n[4], double dn[4][2]) {
  memset(n, 0, 4 * sizeof n[0]);
  memset(dn, 0, 8 * sizeof dn[0][0]);
  if (corners == 2) {
    n[0] = 0.5 * (1.0 - s);
    n[1] = 0.5 * (1.0 + s);
    dn[0][0] = -0.5;
    dn[1][0] = 0.5;
    return;
  }
  static const double sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < 4; i++) {
    int to = i < corners ? i : corners - 1;
    n[to] += 0.25 * (1.0 + sign[i][0] * s) * (1.0 + sign[i][1] * t);
    dn[to][0] += 0.25 * sign[i][0] * (1.0 + sign[i][1] * t);
    dn[to][1] += 0.25 * sign[i][1] * (1.0 + sign[i][0] * s);
  }
}

/* Adds the integral of N_i sigma . n over a facet. */
static void kirsch_facet(const cdem_run_body *setup, const cdem_case_load *load,
                         const cdem_facet *facet, node_field *field) {
  bool flat = facet->corners == 2;
  for (int a = 0; a < GAUSS; a++)
    for (int b = 0; b < (flat ? 1 : GAUSS); b++) {
      double n[4], dn[4][2], x[3] = {0}, along[2][3] = {{0}}, area[3], s[3];
      facet_shape(facet->corners, gauss_place[a], flat ? 0.0 : gauss_place[b], n, dn);
      for (int i = 0; i < facet->corners; i++)
        for (int k = 0; k < 3; k++) {
          double place = setup->blocks.mesh.xyz[3 * (int64_t)facet->node[i] + k];
          x[k] += n[i] * place;
          along[0][k] += dn[i][0] * place;
          along[1][k] += dn[i][1] * place;
        }
      if (flat) /* interior on the left, hence outward on the right of node 0 -> node 1 */
        memcpy(along[1], (double[3]){0.0, 0.0, setup->section.thickness}, sizeof along[1]);
      cdem_cross3(along[0], along[1], area);
      double w = gauss_weight[a] * (flat ? 1.0 : gauss_weight[b]);
      cdem_run_kirsch(load->kirsch_tension, load->kirsch_radius, x[0] - load->kirsch_center[0],
                      x[1] - load->kirsch_center[1], s);
      for (int i = 0; i < facet->corners; i++) {
        double *f = field->weight + (int64_t)facet->node[i] * field->width;
        f[0] += w * n[i] * (s[0] * area[0] + s[2] * area[1]);
        f[1] += w * n[i] * (s[2] * area[0] + s[1] * area[1]);
      }
    }
}

static cdem_status kirsch_load(cdem_run_body *setup, int64_t index, node_field *field,
                               cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  int32_t count, *facet;
  char key[96];
  CDEM_TRY(group_facets(setup, cdem_run_key(key, "loads", index, "group"), load->group, &count,
                        &facet, fault));
  for (int32_t i = 0; i < count; i++)
    kirsch_facet(setup, load, &setup->blocks.facet[facet[i]], field);
  free(facet);
  return add_load(setup, load->group, &setup->conditions.unit, field, 0, fault);
}

/* ---- pressures and quiet boundaries ---- */

static cdem_status add_pressure(cdem_run_body *setup, int64_t index, cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  cdem_run_conditions *c = &setup->conditions;
  cdem_pressure pressure = {.name = load->group, .series = load->pressure};
  int32_t *facet;
  char key[96];
  CDEM_TRY(cdem_grow(&c->pressure, &c->capacity[2], c->pressures + 1, sizeof *c->pressure, fault));
  CDEM_TRY(group_facets(setup, cdem_run_key(key, "loads", index, "group"), load->group,
                        &pressure.facets, &facet, fault));
  pressure.facet = facet;
  c->pressure[c->pressures++] = pressure;
  return CDEM_OK;
}

static cdem_status impedances(const cdem_run_body *setup, const cdem_quiet *quiet,
                              double *impedance, cdem_fault *fault) {
  for (int32_t i = 0; i < quiet->facets; i++) {
    int32_t cell = setup->blocks.facet[quiet->facet[i]].cell;
    int material = setup->model.material[setup->model_of[cell]];
    CDEM_TRY(cdem_run_density(setup, material, "a quiet boundary", fault));
    const cdem_run_moduli *m = &setup->moduli[material];
    impedance[2 * (int64_t)i] = sqrt(setup->density[material] * m->wave); /* rho c_p */
    impedance[2 * (int64_t)i + 1] = sqrt(setup->density[material] * m->shear);
  }
  return CDEM_OK;
}

static cdem_status add_quiet(cdem_run_body *setup, const char *name, cdem_fault *fault) {
  cdem_run_conditions *c = &setup->conditions;
  int32_t *facet;
  CDEM_TRY(cdem_grow(&c->quiet, &c->capacity[3], c->quiets + 1, sizeof *c->quiet, fault));
  cdem_quiet *quiet = &c->quiet[c->quiets];
  CDEM_TRY(group_facets(setup, "quiet", name, &quiet->facets, &facet, fault));
  quiet->facet = facet;
  c->quiets++;
  double *impedance;
  CDEM_NEW(impedance, 2 * (int64_t)quiet->facets, fault);
  quiet->impedance = impedance;
  return impedances(setup, quiet, impedance, fault);
}

/* ---- all ---- */

static cdem_status one_load(cdem_run_body *setup, int64_t index, node_field *field,
                            cdem_fault *fault) {
  const cdem_case_load *load = &cdem_run_values(setup->run)->loads.item[index];
  int64_t nodes = setup->body.nodes;
  if (load->has_pressure)
    CDEM_TRY(add_pressure(setup, index, fault));
  field->width = 1;
  if (any_given(&load->force)) {
    memset(field->weight, 0, (size_t)nodes * sizeof *field->weight);
    CDEM_TRY(force_load(setup, index, field, fault));
  }
  if (any_given(&load->traction)) {
    memset(field->weight, 0, (size_t)nodes * sizeof *field->weight);
    CDEM_TRY(traction_load(setup, index, field, fault));
  }
  if (isnan(load->kirsch_tension))
    return CDEM_OK;
  field->width = setup->body.dofs;
  memset(field->weight, 0, (size_t)nodes * (size_t)field->width * sizeof *field->weight);
  return kirsch_load(setup, index, field, fault);
}

cdem_status cdem_run_body_loads(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  node_field field;
  CDEM_TRY(cdem_series_constant(1.0, &setup->conditions.unit, fault));
  CDEM_NEW(field.weight, (int64_t)setup->body.nodes * setup->body.dofs, fault);
  cdem_status status = CDEM_OK;
  for (int64_t i = 0; status == CDEM_OK && i < values->loads.count; i++)
    status = one_load(setup, i, &field, fault);
  free(field.weight);
  for (int64_t i = 0; status == CDEM_OK && i < values->quiet.count; i++)
    status = add_quiet(setup, values->quiet.item[i], fault);
  return status;
}
