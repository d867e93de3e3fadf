/* Blocks, model and elastic body of a case. */
#include "run/body.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const *texts(const cdem_case_texts *list) {
  return (const char *const *)list->item;
}

/* Each group of a list must be there, of the wanted dimension. */
static cdem_status check_groups(const cdem_run_body *setup, const char *key,
                                const cdem_case_texts *list, int dimension, cdem_fault *fault) {
  for (int64_t i = 0; i < list->count; i++) {
    const cdem_group *group;
    CDEM_TRY(cdem_run_find_group(setup, key, list->item[i], dimension, dimension, &group, fault));
  }
  return CDEM_OK;
}

/* Nodes that belong to no cell of the body but carry masses that others give them. */
static cdem_status keep_spares(cdem_run_body *setup, cdem_fault *fault) {
  cdem_blocks *b = &setup->blocks;
  int64_t first = b->mesh.nodes, room[2] = {first, first};
  CDEM_TRY(cdem_grow(&b->original, &room[0], first + setup->spare, sizeof *b->original, fault));
  CDEM_TRY(cdem_grow(&b->node_block, &room[1], first + setup->spare, sizeof *b->node_block, fault));
  for (int32_t i = 0; i < setup->spare; i++) {
    int32_t node = setup->spares[i];
    b->original[first + i] = node;
    b->node_block[first + i] = -1;
    CDEM_TRY(cdem_mesh_add_nodes(&b->mesh, 1, setup->mesh.xyz + 3 * (int64_t)node,
                                 &setup->mesh.node_tag[node], fault));
  }
  return CDEM_OK;
}

static cdem_status cut(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_blocks *blocks = &cdem_run_values(setup->run)->blocks;
  int dimension = cdem_mesh_dimension(&setup->mesh);
  if (dimension < 2)
    return cdem_case_fail(&setup->run->cases, "mesh", CDEM_INPUT, fault,
                          "the mesh has no surface or volume elements (highest dimension %d)",
                          dimension);
  CDEM_TRY(check_groups(setup, "blocks.breakable", &blocks->breakable, dimension, fault));
  CDEM_TRY(check_groups(setup, "blocks.separate", &blocks->separate, dimension, fault));
  CDEM_TRY(check_groups(setup, "blocks.joints", &blocks->joints, dimension - 1, fault));
  const cdem_blocks_options options = {.mesh = &setup->mesh,
                                       .groups = setup->only != NULL ? 1 : 0,
                                       .group = &setup->only,
                                       .breakable = (int)blocks->breakable.count,
                                       .breakable_group = texts(&blocks->breakable),
                                       .separate = (int)blocks->separate.count,
                                       .separate_group = texts(&blocks->separate),
                                       .joints = (int)blocks->joints.count,
                                       .joint_group = texts(&blocks->joints)};
  cdem_status status = cdem_blocks_init(&options, &setup->blocks, fault);
  const char *key = cdem_case_given(&setup->run->cases, "blocks") ? "blocks" : "mesh";
  if (status == CDEM_INPUT)
    return cdem_case_blame(&setup->run->cases, key, fault);
  CDEM_TRY(status);
  return keep_spares(setup, fault);
}

/* Index of the material for cells of no named group; -1 when every material has groups. */
static int find_default(const cdem_run_body *setup) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  for (int m = 0; m < (int)values->materials.count; m++)
    if (values->materials.item[m].groups.count == 0)
      return m;
  return -1;
}

/* No cell may be left without a material; the message names the groups it is in. */
static cdem_status check_cover(const cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  const cdem_mesh *mesh = &setup->blocks.mesh;
  bool *covered = cdem_allocate(mesh->cells, sizeof *covered, fault);
  if (covered == NULL)
    return CDEM_MEMORY;
  for (int64_t m = 0; m < values->materials.count; m++)
    for (int64_t g = 0; g < values->materials.item[m].groups.count; g++) {
      const cdem_group *group =
          cdem_mesh_find_group(mesh, values->materials.item[m].groups.item[g]);
      for (int32_t i = 0; i < group->cells; i++)
        covered[group->cell[i]] = true;
    }
  int32_t first = -1, bare = 0;
  for (int32_t c = 0; c < mesh->cells; c++)
    if (setup->blocks.block[c] >= 0 && !covered[c]) {
      first = first < 0 ? c : first;
      bare++;
    }
  free(covered);
  if (bare == 0)
    return CDEM_OK;
  char names[200];
  cdem_run_group_names(mesh, first, setup->blocks.dimension, setup->blocks.dimension, names);
  return cdem_case_fail(&setup->run->cases, "materials", CDEM_INPUT, fault,
                        "%d elements have no material: element %lld is in group %s; name the group "
                        "under `groups` of a material, or leave `groups` out of one material",
                        bare, (long long)mesh->cell_tag[first], names);
}

/* Materials and their groups as the model wants them; the arrays are the caller's. */
typedef struct {
  cdem_material *material;
  const char **group;
  int *of;
  int assignments;
} assignment;

static void assignment_release(assignment *a) {
  free(a->material);
  free(a->group);
  free(a->of);
}

static cdem_status assign(const cdem_run_body *setup, assignment *a, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  int materials = (int)values->materials.count, dimension = setup->blocks.dimension;
  int64_t groups = 0;
  for (int m = 0; m < materials; m++)
    groups += values->materials.item[m].groups.count;
  CDEM_NEW(a->material, materials, fault);
  CDEM_NEW(a->group, groups, fault);
  CDEM_NEW(a->of, groups, fault);
  for (int m = 0; m < materials; m++) {
    const cdem_case_material *material = &values->materials.item[m];
    char key[96];
    cdem_run_named_key(key, "materials", material->name, "groups");
    a->material[m] = material->material;
    snprintf(a->material[m].name, sizeof a->material[m].name, "%s", material->name);
    CDEM_TRY(check_groups(setup, key, &material->groups, dimension, fault));
    for (int64_t g = 0; g < material->groups.count; g++) {
      a->group[a->assignments] = material->groups.item[g];
      a->of[a->assignments++] = m;
    }
  }
  return CDEM_OK;
}

static cdem_status make_model(cdem_run_body *setup, const assignment *a, int default_material,
                              cdem_fault *fault) {
  const cdem_model_options options = {.mesh = &setup->blocks.mesh,
                                      .materials =
                                          (int)cdem_run_values(setup->run)->materials.count,
                                      .material = a->material,
                                      .assignments = a->assignments,
                                      .assigned_group = a->group,
                                      .assigned_material = a->of,
                                      .default_material = default_material,
                                      .section = setup->section};
  if (default_material < 0)
    CDEM_TRY(check_cover(setup, fault));
  cdem_fault local = {0};
  cdem_status status = cdem_model_init(&options, &setup->model, &local);
  if (status == CDEM_OK)
    return CDEM_OK;
  if (fault != NULL)
    *fault = local;
  if (status != CDEM_INPUT)
    return status;
  /* A material that cannot be, or an element that cannot. */
  bool material = strstr(local.message, "material") != NULL;
  return cdem_case_blame(&setup->run->cases, material ? "materials" : "mesh", fault);
}

/* lambda + 2G and G of the formulation. Not isotropic: the stiffest direct and shear moduli, which
 * is what a penalty must keep up with. */
static cdem_status moduli(const cdem_run_body *setup, const cdem_material *material,
                          cdem_run_moduli *found, cdem_fault *fault) {
  const cdem_formulation formulation = setup->model.formulation;
  double d[36];
  int rows;
  if (formulation == CDEM_SOLID) {
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_SOLID, NULL, d, &rows, fault));
    found->wave = fmax(d[0], fmax(d[7], d[14]));
    found->shear = fmax(d[21], fmax(d[28], d[35]));
  } else if (formulation == CDEM_PLANE) {
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_PLANE, &setup->section, d, &rows, fault));
    found->wave = fmax(d[0], d[4]);
    found->shear = d[8];
  } else {
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_PLANE_COSSERAT, &setup->section, d, &rows,
                                  fault));
    found->wave = fmax(d[0], d[7]);
    found->shear = 0.5 * (d[14] + d[15]); /* (G + Gc + G - Gc)/2 */
  }
  return CDEM_OK;
}

static cdem_status material_numbers(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  int materials = (int)values->materials.count;
  bool gravity = cdem_norm3(values->gravity) > 0.0,
       needed = values->analysis == CDEM_ANALYSIS_DYNAMIC || gravity;
  CDEM_NEW(setup->density, materials, fault);
  CDEM_NEW(setup->micro_inertia, materials, fault);
  CDEM_NEW(setup->no_tension, materials, fault);
  CDEM_NEW(setup->moduli, materials, fault);
  for (int m = 0; m < materials; m++) {
    const cdem_case_material *material = &values->materials.item[m];
    if (needed)
      CDEM_TRY(cdem_run_density(setup, m, gravity ? "gravity" : "a dynamic run", fault));
    /* Without inertia or weight the density has no part in the result. */
    setup->density[m] = material->density > 0.0 ? material->density : 1.0;
    setup->micro_inertia[m] = isnan(material->micro_inertia)
                                  ? cdem_material_micro_inertia(&material->material)
                                  : material->micro_inertia;
    setup->no_tension[m] = material->tension == CDEM_CASE_TENSION_NONE;
    CDEM_TRY(moduli(setup, &setup->model.materials_of[m], &setup->moduli[m], fault));
  }
  return CDEM_OK;
}

static cdem_status cell_numbers(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_model *model = &setup->model;
  CDEM_NEW(setup->model_of, setup->blocks.mesh.cells, fault);
  CDEM_NEW(setup->volume, model->cells, fault);
  for (int32_t c = 0; c < setup->blocks.mesh.cells; c++)
    setup->model_of[c] = -1;
  double thickness = model->dimension == 2 ? setup->section.thickness : 1.0;
  for (int32_t i = 0; i < model->cells; i++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    setup->model_of[model->cell[i]] = i;
    cdem_model_coordinates(model, i, xyz);
    setup->volume[i] =
        cdem_element_volume(&model->kinds_of[model->kind[i]].tabulation, thickness, xyz);
  }
  return CDEM_OK;
}

/* Waiting for each other costs small bodies more than a second thread gains; no result depends on
 * their number. */
static int worthwhile_threads(const cdem_run_body *setup) {
  enum { CELLS_A_THREAD = 2000 };
  int most = omp_get_max_threads(), worth = 1 + setup->model.cells / CELLS_A_THREAD;
  return setup->run->options->threads > 0 ? setup->run->options->threads
         : worth < most                   ? worth
                                          : most;
}

cdem_status cdem_run_body_model(cdem_run_body *setup, cdem_fault *fault) {
  assignment a = {0};
  CDEM_TRY(cut(setup, fault));
  cdem_status status = assign(setup, &a, fault);
  if (status == CDEM_OK)
    status = make_model(setup, &a, find_default(setup), fault);
  assignment_release(&a);
  CDEM_TRY(status);
  CDEM_TRY(material_numbers(setup, fault));
  CDEM_TRY(cell_numbers(setup, fault));
  setup->run->threads = worthwhile_threads(setup);
  return cdem_run_body_elastic(setup, fault);
}

cdem_status cdem_run_body_elastic(cdem_run_body *setup, cdem_fault *fault) {
  int materials = setup->model.materials;
  double factor = setup->rotation_factor > 0.0 ? setup->rotation_factor : 1.0, *inertia;
  CDEM_NEW(inertia, materials, fault);
  for (int m = 0; m < materials; m++)
    inertia[m] = factor * setup->micro_inertia[m];
  const cdem_body_options options = {.density = setup->density,
                                     .micro_inertia = inertia,
                                     .no_tension = setup->no_tension,
                                     .linear = cdem_run_values(setup->run)->analysis ==
                                               CDEM_ANALYSIS_STATIC,
                                     .threads = setup->run->threads};
  cdem_body_release(&setup->body);
  cdem_status status = cdem_body_init(&setup->model, &options, &setup->body, fault);
  free(inertia);
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, "mesh", fault) : status;
}
