/* Supports, plates and initial velocities of a case. */
#include "run/body.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cdem_status group_nodes(const cdem_run_body *setup, const char *key, const char *name,
                               int32_t *count, int32_t **node, cdem_fault *fault) {
  const cdem_group *group;
  CDEM_TRY(cdem_run_find_group(setup, key, name, 0, 3, &group, fault));
  return cdem_blocks_group_nodes(&setup->blocks, name, count, node, fault);
}

/* ---- supports ---- */

static cdem_status add_support(cdem_run_body *setup, int64_t entry, int component, bool velocity,
                               cdem_fault *fault) {
  const cdem_case_support *wanted = &cdem_run_values(setup->run)->supports.item[entry];
  cdem_run_conditions *c = &setup->conditions;
  char key[96];
  int dof;
  cdem_run_key(key, "supports", entry, velocity ? "velocity" : "displacement");
  CDEM_TRY(cdem_run_dof(setup, key, component, &dof, fault));
  cdem_support support = {
      .name = wanted->group,
      .component = dof,
      .velocity = velocity,
      .series = (velocity ? &wanted->velocity : &wanted->displacement)->component[component]};
  for (int i = 0; i < c->supports; i++)
    if (c->support[i].component == dof && strcmp(c->support[i].name, wanted->group) == 0) {
      char full[128];
      snprintf(full, sizeof full, "%s.%s", key, cdem_run_component[component]);
      return cdem_case_fail(&setup->run->cases, full, CDEM_INPUT, fault,
                            "an entry above prescribes %s of group '%s' already; leave one out",
                            cdem_run_component[component], wanted->group);
    }
  int32_t *node;
  CDEM_TRY(cdem_grow(&c->support, &c->capacity[0], c->supports + 1, sizeof *c->support, fault));
  CDEM_TRY(group_nodes(setup, cdem_run_key(key, "supports", entry, "group"), wanted->group,
                       &support.nodes, &node, fault));
  support.node = node;
  c->support[c->supports++] = support;
  return CDEM_OK;
}

static cdem_status supports(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  for (int64_t i = 0; i < values->supports.count; i++)
    for (int k = 0; k < 4; k++) {
      if (values->supports.item[i].displacement.given[k])
        CDEM_TRY(add_support(setup, i, k, false, fault));
      if (values->supports.item[i].velocity.given[k])
        CDEM_TRY(add_support(setup, i, k, true, fault));
    }
  return CDEM_OK;
}

/* ---- plates ---- */

/* Unit normal; an in-plane axis where none was given: in the plane in 2-D, else across the smallest
 * component of the normal. The case was checked: neither is zero, nor are they parallel. */
static cdem_status plate_axes(const cdem_run_body *setup, const cdem_case_plate *wanted,
                              cdem_plate *plate, cdem_fault *fault) {
  char key[96];
  if (setup->model.dimension == 2 && (wanted->normal[2] != 0.0 || wanted->axis[2] != 0.0))
    return cdem_case_fail(&setup->run->cases,
                          cdem_run_named_key(key, "plates", wanted->name,
                                             wanted->normal[2] != 0.0 ? "normal" : "axis"),
                          CDEM_INPUT, fault,
                          "the body is plane, and so are its plates; leave the z component out");
  double size = cdem_norm3(wanted->normal), along = cdem_norm3(wanted->axis);
  int least = 0;
  double axis[3] = {0};
  for (int k = 0; k < 3; k++) {
    plate->normal[k] = wanted->normal[k] / size;
    least = fabs(plate->normal[k]) < fabs(plate->normal[least]) ? k : least;
    axis[k] = along > 0.0 ? wanted->axis[k] / along : 0.0;
  }
  if (!(along > 0.0)) {
    const double unit[3] = {least == 0, least == 1, least == 2};
    const double z[3] = {0, 0, 1};
    /* In 2-D the first half size is measured in the plane of the body. */
    cdem_cross3(setup->model.dimension == 2 ? z : unit, plate->normal, axis);
  }
  double out = cdem_dot3(axis, plate->normal);
  for (int k = 0; k < 3; k++)
    axis[k] -= out * plate->normal[k];
  double length = cdem_norm3(axis);
  for (int k = 0; k < 3; k++)
    plate->axis[k] = axis[k] / length;
  return CDEM_OK;
}

static cdem_status add_plate(cdem_run_body *setup, int64_t index, cdem_fault *fault) {
  const cdem_case_plate *wanted = &cdem_run_values(setup->run)->plates.item[index];
  cdem_run_conditions *c = &setup->conditions;
  double ratio = isnan(wanted->shear_ratio) ? setup->contact_ratio : wanted->shear_ratio;
  cdem_plate plate = {.name = wanted->name, .friction = wanted->friction};
  CDEM_TRY(cdem_grow(&c->plate, &c->capacity[4], c->plates + 1, sizeof *c->plate, fault));
  CDEM_TRY(plate_axes(setup, wanted, &plate, fault));
  plate.kn = wanted->normal_stiffness > 0.0
                 ? wanted->normal_stiffness
                 : wanted->stiffness_factor * setup->contact_wave / setup->contact_size;
  plate.kt = ratio * plate.kn;
  for (int k = 0; k < 3; k++) {
    plate.point[k] = wanted->point[k];
    if (wanted->velocity.given[k])
      plate.velocity[k] = wanted->velocity.component[k];
  }
  plate.half[0] = wanted->half_size[0];
  plate.half[1] = wanted->half_size[1];
  c->plate[c->plates++] = plate;
  return CDEM_OK;
}

/* ---- initial velocities ---- */

static void set_velocity(const cdem_run_body *setup, const cdem_case_initial *entry, int32_t node) {
  const double *x = setup->blocks.mesh.xyz + 3 * (int64_t)node;
  int dofs = setup->body.dofs, dimension = setup->model.dimension;
  double *v = setup->conditions.velocity + (int64_t)dofs * node;
  double arm[3], turning[3];
  for (int k = 0; k < 3; k++)
    arm[k] = x[k] - entry->center[k];
  cdem_cross3(entry->spin, arm, turning);
  for (int k = 0; k < dimension; k++)
    v[k] = entry->velocity[k] + turning[k];
  if (setup->model.formulation == CDEM_PLANE_COSSERAT)
    v[2] = entry->spin[2];
}

static cdem_status initial(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  char key[96];
  if (values->initial.count == 0)
    return CDEM_OK;
  CDEM_NEW(setup->conditions.velocity, (int64_t)setup->body.nodes * setup->body.dofs, fault);
  for (int64_t i = 0; i < values->initial.count; i++) {
    const cdem_case_initial *entry = &values->initial.item[i];
    if (entry->groups.count == 0)
      for (int32_t n = 0; n < setup->body.nodes; n++)
        set_velocity(setup, entry, n);
    for (int64_t g = 0; g < entry->groups.count; g++) {
      int32_t count, *node;
      CDEM_TRY(group_nodes(setup, cdem_run_key(key, "initial", i, "groups"), entry->groups.item[g],
                           &count, &node, fault));
      for (int32_t n = 0; n < count; n++)
        set_velocity(setup, entry, node[n]);
      free(node);
    }
  }
  return CDEM_OK;
}

cdem_status cdem_run_body_conditions(cdem_run_body *setup, cdem_fault *fault) {
  CDEM_TRY(supports(setup, fault));
  for (int64_t i = 0; i < cdem_run_values(setup->run)->plates.count; i++)
    CDEM_TRY(add_plate(setup, i, fault));
  return initial(setup, fault);
}

void cdem_run_conditions_release(cdem_run_conditions *c) {
  for (int i = 0; i < c->supports; i++)
    free((void *)c->support[i].node);
  for (int i = 0; i < c->loads; i++) {
    free((void *)c->load[i].node);
    free((void *)c->load[i].vector);
  }
  for (int i = 0; i < c->pressures; i++)
    free((void *)c->pressure[i].facet);
  for (int i = 0; i < c->quiets; i++) {
    free((void *)c->quiet[i].facet);
    free((void *)c->quiet[i].impedance);
  }
  free(c->support);
  free(c->load);
  free(c->pressure);
  free(c->quiet);
  free(c->plate);
  free(c->velocity);
  cdem_series_release(&c->unit);
  *c = (cdem_run_conditions){0};
}
