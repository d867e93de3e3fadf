/* Probes: means of displacement, velocity and stress, and the sum of the forces on a group. */
#include "run/body.h"

#include <stdlib.h>
#include <string.h>

enum { DISPLACEMENT, VELOCITY, FORCE, STRESS };           /* the choices of `quantity` */
enum { X, Y, Z, ROTATION, XX, YY, ZZ, YZ, XZ, XY, SIZE }; /* of `component` */

const char *cdem_run_probe_unit(const cdem_case_probe *probe) {
  static const char *const unit[] = {"m", "m/s", "N", "Pa"};
  static const char *const turning[] = {"rad", "rad/s", "N m", ""};
  return (probe->component == ROTATION ? turning : unit)[probe->quantity];
}

static cdem_status check_component(const cdem_run_body *setup, const cdem_case_probe *probe,
                                   cdem_fault *fault) {
  char key[96];
  int dof;
  if (probe->quantity != STRESS && probe->component != SIZE)
    return cdem_run_dof(setup, cdem_run_named_key(key, "probes", probe->name, "component"),
                        probe->component, &dof, fault);
  return CDEM_OK;
}

static cdem_status resolve(const cdem_run_body *setup, const cdem_case_probe *probe,
                           cdem_run_probe *found, cdem_fault *fault) {
  const cdem_group *group;
  char key[96];
  CDEM_TRY(check_component(setup, probe, fault));
  CDEM_TRY(cdem_run_find_group(setup, cdem_run_named_key(key, "probes", probe->name, "group"),
                               probe->group, 0, 3, &group, fault));
  if (probe->quantity == STRESS && group->dimension == setup->blocks.dimension) {
    found->cells = group;
    return CDEM_OK;
  }
  return cdem_blocks_group_nodes(&setup->blocks, probe->group, &found->nodes, &found->node, fault);
}

cdem_status cdem_run_probes_init(const cdem_run_body *setup, cdem_run_probes *probes,
                                 cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  bool cells = false, nodes = false;
  CDEM_NEW(probes->probe, values->probes.count, fault);
  for (int64_t p = 0; p < values->probes.count; p++) {
    const cdem_case_probe *probe = &values->probes.item[p];
    if (probe->group == NULL) /* of grains */
      continue;
    CDEM_TRY(resolve(setup, probe, &probes->probe[p], fault));
    cells = cells || probes->probe[p].cells != NULL;
    nodes = nodes || (probe->quantity == STRESS && probes->probe[p].cells == NULL);
  }
  CDEM_NEW(probes->velocity, (int64_t)setup->body.nodes * setup->body.dofs, fault);
  if (cells)
    CDEM_NEW(probes->cell_stress, 6 * (int64_t)setup->model.cells, fault);
  if (nodes)
    CDEM_NEW(probes->node_stress, 6 * (int64_t)setup->body.nodes, fault);
  return CDEM_OK;
}

void cdem_run_probes_update(const cdem_run_body *setup, cdem_run_probes *probes) {
  const cdem_body_fields fields = {.stress = probes->cell_stress};
  if (cdem_run_values(setup->run)->probes.count > 0)
    cdem_solver_velocity(&setup->solver, probes->velocity);
  if (probes->cell_stress != NULL)
    cdem_body_cell_fields(&setup->body, setup->solver.u, &fields);
  if (probes->node_stress != NULL)
    cdem_body_node_stress(&setup->body, setup->solver.u, probes->node_stress);
}

/* Mean over the group, xx yy zz yz xz xy. */
static void mean_stress(const cdem_run_body *setup, const cdem_run_probes *probes,
                        const cdem_run_probe *probe, double mean[6]) {
  double sum = 0.0;
  memset(mean, 0, 6 * sizeof *mean);
  if (probe->cells != NULL)
    for (int32_t i = 0; i < probe->cells->cells; i++) {
      int64_t cell = setup->model_of[probe->cells->cell[i]];
      sum += setup->volume[cell];
      for (int k = 0; k < 6; k++)
        mean[k] += setup->volume[cell] * probes->cell_stress[6 * cell + k];
    }
  else
    for (int32_t i = 0; i < probe->nodes; i++) {
      sum += 1.0;
      for (int k = 0; k < 6; k++)
        mean[k] += probes->node_stress[6 * (int64_t)probe->node[i] + k];
    }
  for (int k = 0; k < 6; k++)
    mean[k] /= sum;
}

static double von_mises(const double s[6]) {
  double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * shear);
}

/* Sum (force) or mean over the nodes, by degree of freedom. */
static void node_vector(const cdem_run_body *setup, const cdem_run_probes *probes,
                        const cdem_run_probe *probe, int quantity, double vector[3]) {
  const cdem_solver *solver = &setup->solver;
  int dofs = solver->dofs;
  memset(vector, 0, 3 * sizeof *vector);
  if (quantity == FORCE) {
    cdem_solver_held(solver, probe->nodes, probe->node, vector);
    return;
  }
  for (int32_t i = 0; i < probe->nodes; i++)
    for (int k = 0; k < dofs; k++) {
      int64_t at = (int64_t)probe->node[i] * dofs + k;
      vector[k] += quantity == DISPLACEMENT ? solver->u[at] : probes->velocity[at];
    }
  for (int k = 0; k < dofs; k++)
    vector[k] /= probe->nodes;
}

double cdem_run_probe_value(const cdem_run_body *setup, const cdem_run_probes *probes,
                            int64_t index) {
  const cdem_case_probe *probe = &cdem_run_values(setup->run)->probes.item[index];
  const cdem_run_probe *place = &probes->probe[index];
  if (probe->quantity == STRESS) {
    double stress[6];
    mean_stress(setup, probes, place, stress);
    return probe->component == SIZE ? von_mises(stress) : stress[probe->component - XX];
  }
  double vector[3];
  node_vector(setup, probes, place, probe->quantity, vector);
  if (probe->component == SIZE)
    return setup->model.dimension == 3 ? cdem_norm3(vector) : hypot(vector[0], vector[1]);
  return vector[probe->component == ROTATION ? 2 : probe->component];
}

void cdem_run_probes_release(const cdem_run_body *setup, cdem_run_probes *probes) {
  if (probes->probe != NULL)
    for (int64_t p = 0; p < cdem_run_values(setup->run)->probes.count; p++)
      free(probes->probe[p].node);
  free(probes->probe);
  free(probes->velocity);
  free(probes->cell_stress);
  free(probes->node_stress);
  *probes = (cdem_run_probes){0};
}
