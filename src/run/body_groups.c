/* What the files of the engine of bodies share: groups of the mesh, densities, facets, degrees of
 * freedom. */
#include "base/suggest.h"
#include "run/body.h"

#include <stdio.h>
#include <string.h>

bool cdem_run_group_holds(const cdem_group *group, int32_t cell) {
  int32_t low = 0, high = group->cells;
  while (low < high) {
    int32_t middle = low + (high - low) / 2;
    if (group->cell[middle] < cell)
      low = middle + 1;
    else
      high = middle;
  }
  return low < group->cells && group->cell[low] == cell;
}

void cdem_run_group_names(const cdem_mesh *mesh, int32_t cell, int least, int most,
                          char text[200]) {
  int used = 0, more = 0;
  text[0] = '\0';
  for (int32_t g = 0; g < mesh->groups; g++) {
    const cdem_group *group = &mesh->group[g];
    if (group->dimension < least || group->dimension > most ||
        (cell >= 0 && !cdem_run_group_holds(group, cell)))
      continue;
    int length = (int)strlen(group->name) + 4;
    if (used + length > 180)
      more++;
    else
      used +=
          snprintf(text + used, (size_t)(200 - used), "%s'%s'", used > 0 ? ", " : "", group->name);
  }
  if (more > 0)
    snprintf(text + used, (size_t)(200 - used), " and %d more", more);
  if (used == 0)
    snprintf(text, 200, "none");
}

/* The cut mesh, and before there is one the mesh as read. */
static const cdem_mesh *mesh_of(const cdem_run_body *setup) {
  return setup->blocks.mesh.cells > 0 ? &setup->blocks.mesh : &setup->mesh;
}

/* What a range of dimensions means in words. */
static const char *kind_of_group(int least, int most, int dimension) {
  if (least == dimension)
    return dimension == 3 ? "volumes" : "surfaces (the cells of a 2-D mesh)";
  if (least == dimension - 1 && most == dimension - 1)
    return dimension == 3 ? "faces" : "lines";
  return "any kind";
}

static cdem_status no_group(const cdem_run_body *setup, const char *key, const char *name,
                            const char *known, cdem_fault *fault) {
  const cdem_mesh *mesh = mesh_of(setup);
  const char *candidate[64];
  int count = mesh->groups < 64 ? mesh->groups : 64;
  for (int g = 0; g < count; g++)
    candidate[g] = mesh->group[g].name;
  const char *nearest = cdem_suggest(name, candidate, count);
  return cdem_case_fail(&setup->run->cases, key, CDEM_INPUT, fault,
                        "the mesh has no group '%s'%s%s%s of this kind it has %s", name,
                        nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                        nearest != NULL ? "'?" : ";", known);
}

cdem_status cdem_run_find_group(const cdem_run_body *setup, const char *key, const char *name,
                                int least, int most, const cdem_group **group, cdem_fault *fault) {
  const cdem_mesh *mesh = mesh_of(setup);
  const cdem_group *found = cdem_mesh_find_group(mesh, name);
  char known[200];
  cdem_run_group_names(mesh, -1, least, most, known);
  if (found == NULL)
    return no_group(setup, key, name, known, fault);
  if (found->dimension < least || found->dimension > most)
    return cdem_case_fail(&setup->run->cases, key, CDEM_INPUT, fault,
                          "group '%s' has dimension %d; here a group of %s is wanted: %s", name,
                          found->dimension, kind_of_group(least, most, cdem_mesh_dimension(mesh)),
                          known);
  *group = found;
  return CDEM_OK;
}

cdem_status cdem_run_density(const cdem_run_body *setup, int material, const char *purpose,
                             cdem_fault *fault) {
  const cdem_case_material *entry = &cdem_run_values(setup->run)->materials.item[material];
  char key[96];
  if (entry->density > 0.0)
    return CDEM_OK;
  return cdem_case_fail(
      &setup->run->cases, cdem_run_named_key(key, "materials", entry->name, "density"), CDEM_INPUT,
      fault, "material '%s' has no density, which %s needs; give `density: 2700 kg/m3`",
      entry->name, purpose);
}

double cdem_run_facet(const cdem_run_body *setup, const cdem_facet *facet, double area[3],
                      double share[4]) {
  cdem_facet_area(facet, setup->blocks.mesh.xyz, setup->section.thickness, area, share);
  return cdem_norm3(area);
}

cdem_status cdem_run_dof(const cdem_run_body *setup, const char *key, int component, int *dof,
                         cdem_fault *fault) {
  int dimension = setup->model.dimension;
  bool cosserat = setup->model.formulation == CDEM_PLANE_COSSERAT;
  char full[128];
  if (component < dimension) {
    *dof = component;
    return CDEM_OK;
  }
  if (component == 3 && cosserat) {
    *dof = 2;
    return CDEM_OK;
  }
  snprintf(full, sizeof full, "%s.%s", key, cdem_run_component[component]);
  return cdem_case_fail(&setup->run->cases, full, CDEM_INPUT, fault,
                        component == 3 ? "only nodes of a Cosserat material rotate; leave "
                                         "`rotation` out"
                                       : "this is a 2-D run, which has no z component; leave `z` "
                                         "out");
}
