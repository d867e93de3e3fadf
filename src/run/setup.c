/* From a case to a solver: the order of the steps, and what they share. */
#include "run/setup.h"

#include "base/suggest.h"
#include "io/case_file.h"
#include "io/run_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *cdem_run_key(char text[96], const char *section, int64_t index, const char *rest) {
  snprintf(text, 96, "%s[%lld]%s%s", section, (long long)index, rest[0] != '\0' ? "." : "", rest);
  return text;
}

const char *cdem_run_named_key(char text[96], const char *section, const char *name,
                               const char *rest) {
  snprintf(text, 96, "%s.%s%s%s", section, name, rest[0] != '\0' ? "." : "", rest);
  return text;
}

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
static const cdem_mesh *mesh_of(const cdem_run_setup *setup) {
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

static cdem_status no_group(const cdem_run_setup *setup, const char *key, const char *name,
                            const char *known, cdem_fault *fault) {
  const cdem_mesh *mesh = mesh_of(setup);
  const char *candidate[64];
  int count = mesh->groups < 64 ? mesh->groups : 64;
  for (int g = 0; g < count; g++)
    candidate[g] = mesh->group[g].name;
  const char *nearest = cdem_suggest(name, candidate, count);
  return cdem_case_fail(&setup->cases, key, CDEM_INPUT, fault,
                        "the mesh has no group '%s'%s%s%s of this kind it has %s", name,
                        nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                        nearest != NULL ? "'?" : ";", known);
}

cdem_status cdem_run_find_group(const cdem_run_setup *setup, const char *key, const char *name,
                                int least, int most, const cdem_group **group, cdem_fault *fault) {
  const cdem_mesh *mesh = mesh_of(setup);
  const cdem_group *found = cdem_mesh_find_group(mesh, name);
  char known[200];
  cdem_run_group_names(mesh, -1, least, most, known);
  if (found == NULL)
    return no_group(setup, key, name, known, fault);
  if (found->dimension < least || found->dimension > most)
    return cdem_case_fail(&setup->cases, key, CDEM_INPUT, fault,
                          "group '%s' has dimension %d; here a group of %s is wanted: %s", name,
                          found->dimension, kind_of_group(least, most, cdem_mesh_dimension(mesh)),
                          known);
  *group = found;
  return CDEM_OK;
}

cdem_status cdem_run_density(const cdem_run_setup *setup, int material, const char *purpose,
                             cdem_fault *fault) {
  const cdem_case_material *entry = &cdem_run_values(setup)->materials.item[material];
  char key[96];
  if (entry->density > 0.0)
    return CDEM_OK;
  return cdem_case_fail(&setup->cases, cdem_run_named_key(key, "materials", entry->name, "density"),
                        CDEM_INPUT, fault,
                        "material '%s' has no density, which %s needs; give `density: 2700 kg/m3`",
                        entry->name, purpose);
}

double cdem_run_facet(const cdem_run_setup *setup, const cdem_facet *facet, double area[3],
                      double share[4]) {
  cdem_facet_area(facet, setup->blocks.mesh.xyz, setup->section.thickness, area, share);
  return cdem_norm3(area);
}

const char *const cdem_run_component[4] = {"x", "y", "z", "rotation"};

cdem_status cdem_run_dof(const cdem_run_setup *setup, const char *key, int component, int *dof,
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
  return cdem_case_fail(&setup->cases, full, CDEM_INPUT, fault,
                        component == 3 ? "only nodes of a Cosserat material rotate; leave "
                                         "`rotation` out"
                                       : "this is a 2-D run, which has no z component; leave `z` "
                                         "out");
}

/* FNV-1a, 64 bit (Fowler, Noll, Vo): enough to tell inputs apart, no more. */
static uint64_t checksum(uint64_t sum, const void *data, size_t bytes) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < bytes; i++)
    sum = (sum ^ byte[i]) * 0x100000001b3u;
  return sum;
}

static const uint64_t SUM_START = 0xcbf29ce484222325u;

static uint64_t sum_text(const char *text) {
  return checksum(SUM_START, text, strlen(text));
}

static void sum_mesh(cdem_run_setup *setup) {
  const cdem_mesh *mesh = &setup->mesh;
  uint64_t sum = checksum(SUM_START, mesh->xyz, (size_t)mesh->nodes * 3 * sizeof *mesh->xyz);
  sum = checksum(sum, mesh->cell_shape, (size_t)mesh->cells);
  setup->mesh_sum = checksum(sum, mesh->cell_node,
                             (size_t)mesh->cell_start[mesh->cells] * sizeof *mesh->cell_node);
}

static cdem_status read_case(const cdem_run_options *options, cdem_run_setup *setup,
                             cdem_fault *fault) {
  char path[4096];
  cdem_case *cases = &setup->cases;
  if (options->resume) {
    snprintf(path, sizeof path, "%s/case.yaml", options->folder);
    CDEM_TRY(cdem_read_case(path, 0, NULL, cases, fault));
  } else {
    CDEM_TRY(cdem_read_case(options->path, options->overrides, options->override, cases, fault));
  }
  /* The sum of what a person wrote must not depend on the folder in which it was run. */
  setup->case_sum = sum_text(cases->source);
  if (!options->resume)
    CDEM_TRY(cdem_case_settle_mesh(cases, options->overrides, options->override, fault));
  setup->kept_sum = sum_text(cases->source);
  return CDEM_OK;
}

static cdem_status read_mesh(cdem_run_setup *setup, cdem_fault *fault) {
  const cdem_progress *progress = setup->options->progress;
  CDEM_TRY(cdem_progress_report(progress, "reading the mesh", 0, 0, fault));
  CDEM_TRY(cdem_run_setup_mesh(setup, fault));
  return cdem_progress_report(progress, "building", 0, 0, fault);
}

static cdem_status build(const cdem_run_options *options, const cdem_state *checkpoint,
                         cdem_run_setup *setup, cdem_fault *fault) {
  setup->options = options;
  CDEM_TRY(read_case(options, setup, fault));
  const cdem_case_values *values = &setup->cases.values;
  setup->section =
      (cdem_section){.plane = (cdem_plane)values->plane, .thickness = values->thickness};
  if (checkpoint != NULL)
    CDEM_TRY(cdem_mesh_from_state(checkpoint, "mesh", &setup->mesh, fault));
  else
    CDEM_TRY(read_mesh(setup, fault));
  sum_mesh(setup);
  CDEM_TRY(cdem_run_setup_body(setup, fault));
  CDEM_TRY(cdem_run_setup_interfaces(setup, fault));
  CDEM_TRY(cdem_run_setup_contact(setup, fault));
  CDEM_TRY(cdem_run_setup_conditions(setup, fault));
  CDEM_TRY(cdem_run_setup_loads(setup, fault));
  return cdem_run_setup_solver(setup, fault);
}

cdem_status cdem_run_setup_init(const cdem_run_options *options, const cdem_state *checkpoint,
                                cdem_run_setup *setup, cdem_fault *fault) {
  cdem_status status = build(options, checkpoint, setup, fault);
  if (status != CDEM_OK)
    cdem_run_setup_release(setup);
  return status;
}

void cdem_run_setup_release(cdem_run_setup *setup) {
  cdem_solver_release(&setup->solver);
  cdem_contact_release(&setup->contact);
  cdem_interfaces_release(&setup->interfaces);
  cdem_body_release(&setup->body);
  cdem_run_conditions_release(&setup->conditions);
  cdem_model_release(&setup->model);
  cdem_blocks_release(&setup->blocks);
  cdem_mesh_release(&setup->mesh);
  cdem_case_release(&setup->cases);
  free(setup->density);
  free(setup->micro_inertia);
  free(setup->moduli);
  free(setup->model_of);
  free(setup->volume);
  *setup = (cdem_run_setup){0};
}
