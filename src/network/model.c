/* From names to arrays: which cells, as which element, of which material; and whether that can be.
 */
#include "network/network.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Marks the cells to convert in chosen [mesh->cells]; *dimension receives theirs. */
static cdem_status choose_cells(const cdem_model_options *options, uint8_t *chosen, int *dimension,
                                cdem_fault *fault) {
  const cdem_mesh *mesh = options->mesh;
  *dimension = -1;
  for (int g = 0; g < options->groups; g++) {
    const cdem_group *group = cdem_mesh_find_group(mesh, options->group[g]);
    if (group == NULL) {
      char known[512] = "";
      for (int32_t i = 0; i < mesh->groups && strlen(known) < 400; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%.60s", i > 0 ? ", " : "",
                 mesh->group[i].name);
      return cdem_fail(fault, CDEM_INPUT, "the mesh has no group '%s'; it has: %s",
                       options->group[g], mesh->groups > 0 ? known : "none");
    }
    CDEM_REQUIRE(*dimension < 0 || *dimension == group->dimension, fault, CDEM_INPUT,
                 "groups '%s' (dimension %d) and '%s' (dimension %d) cannot be converted together; "
                 "choose groups of one dimension",
                 options->group[0], *dimension, group->name, group->dimension);
    *dimension = group->dimension;
    for (int32_t i = 0; i < group->cells; i++)
      chosen[group->cell[i]] = 1;
  }
  if (options->groups == 0) {
    *dimension = cdem_mesh_dimension(mesh);
    for (int32_t i = 0; i < mesh->cells; i++)
      chosen[i] = cdem_shape_get(mesh->cell_shape[i])->dimension == *dimension;
  }
  CDEM_REQUIRE(*dimension >= 2, fault, CDEM_INPUT,
               "%s to convert: springs come from plane or solid elements%s",
               mesh->cells == 0 ? "the mesh has no cells" : "there are no plane or solid cells",
               options->groups > 0 ? "; choose another group" : "");
  CDEM_REQUIRE(memchr(chosen, 1, (size_t)mesh->cells) != NULL, fault, CDEM_INPUT,
               "group '%s' holds no elements; choose another group", options->group[0]);
  return CDEM_OK;
}

static cdem_status no_material(const cdem_mesh *mesh, int32_t cell, cdem_fault *fault) {
  for (int32_t g = 0; g < mesh->groups; g++)
    for (int32_t i = 0; i < mesh->group[g].cells; i++)
      if (mesh->group[g].cell[i] == cell)
        return cdem_fail(fault, CDEM_INPUT,
                         "no material for element %" PRId64
                         " of group '%s'; add '%s: MATERIAL' under 'groups:' or "
                         "a 'default:' to the material file",
                         mesh->cell_tag[cell], mesh->group[g].name, mesh->group[g].name);
  return cdem_fail(fault, CDEM_INPUT,
                   "no material for element %" PRId64
                   ", which is in no group; add a 'default:' to the material file",
                   mesh->cell_tag[cell]);
}

/* material_of [mesh->cells], valid for chosen cells. */
static cdem_status assign_materials(const cdem_model_options *options, const uint8_t *chosen,
                                    int dimension, int *material_of, int *owner,
                                    cdem_fault *fault) {
  const cdem_mesh *mesh = options->mesh;
  for (int32_t i = 0; i < mesh->cells; i++)
    material_of[i] = options->default_material >= 0 ? options->default_material
                     : options->assignments > 0     ? -1
                                                    : 0;
  for (int32_t i = 0; i < mesh->cells; i++)
    owner[i] = -1;
  for (int a = 0; a < options->assignments; a++) {
    const cdem_group *group = cdem_mesh_find_group(mesh, options->assigned_group[a]);
    CDEM_REQUIRE(group != NULL, fault, CDEM_INPUT,
                 "the material file names group '%s', which the mesh does not have",
                 options->assigned_group[a]);
    CDEM_REQUIRE(
        group->dimension == dimension || options->groups > 0, fault, CDEM_INPUT,
        "the material file gives group '%s' a material, but it is of dimension %d and the body of "
        "dimension %d",
        group->name, group->dimension, dimension);
    for (int32_t i = 0; i < group->cells; i++) {
      int32_t cell = group->cell[i];
      int material = options->assigned_material[a];
      CDEM_REQUIRE(
          owner[cell] < 0 || material_of[cell] == material, fault, CDEM_INPUT,
          "element %" PRId64 " is in group '%s' (material %s) and in group '%s' (material %s)",
          mesh->cell_tag[cell], options->assigned_group[owner[cell]],
          options->material[material_of[cell]].name, group->name, options->material[material].name);
      owner[cell] = a;
      material_of[cell] = material;
    }
  }
  for (int32_t i = 0; i < mesh->cells; i++)
    if (chosen[i] && material_of[i] < 0)
      return no_material(mesh, i, fault);
  return CDEM_OK;
}

/* Classical or Cosserat: all materials in use must agree. used [materials]. */
static cdem_status choose_formulation(const cdem_model_options *options, const bool *used,
                                      cdem_model *model, cdem_fault *fault) {
  const cdem_material *cosserat = NULL, *classical = NULL;
  for (int i = 0; i < options->materials; i++)
    if (used[i])
      *(cdem_material_is_cosserat(&options->material[i]) ? &cosserat : &classical) =
          &options->material[i];
  CDEM_REQUIRE(cosserat == NULL || classical == NULL, fault, CDEM_INPUT,
               "material '%s' is a Cosserat material and '%s' is not; one network holds one kind",
               cosserat->name, classical->name);
  CDEM_REQUIRE(cosserat == NULL || model->dimension == 2, fault, CDEM_INPUT,
               "material '%s' is a plane Cosserat material but the mesh is three-dimensional",
               cosserat->name);
  model->formulation = cosserat != NULL        ? CDEM_PLANE_COSSERAT
                       : model->dimension == 2 ? CDEM_PLANE
                                               : CDEM_SOLID;
  model->dofs = model->formulation == CDEM_PLANE ? 2 : 3;
  return CDEM_OK;
}

/* The kind index of a shape, opened when first met. */
static cdem_status kind_of_shape(cdem_model *model, cdem_shape shape, int64_t tag, int degree,
                                 int *kind, cdem_fault *fault) {
  for (*kind = 0; *kind < model->kinds; ++*kind)
    if (model->kinds_of[*kind].tabulation.element->shape == shape)
      return CDEM_OK;
  const cdem_element *element = cdem_element_for(shape, model->formulation);
  CDEM_REQUIRE(element != NULL, fault, CDEM_INPUT,
               "element %" PRId64 ": there is no %s%s element; see `cdem list elements`", tag,
               model->formulation == CDEM_PLANE_COSSERAT ? "Cosserat " : "",
               cdem_shape_get(shape)->name);
  CDEM_TRY(cdem_tabulation_init(element, degree, &model->kinds_of[model->kinds].tabulation, fault));
  uint8_t *class_ = model->kinds_of[model->kinds].class_;
  for (int a = 0; a < cdem_element_nodes(element); a++)
    for (int b = a + 1; b < cdem_element_nodes(element); b++)
      *class_++ = (uint8_t)(cdem_shape_pair_class(shape, a, b) - 1);
  model->kinds++;
  return CDEM_OK;
}

static cdem_status collect_cells(const cdem_model_options *options, const uint8_t *chosen,
                                 const int *material_of, cdem_model *model, cdem_fault *fault) {
  const cdem_mesh *mesh = options->mesh;
  for (int32_t i = 0; i < mesh->cells; i++)
    model->cells += chosen[i];
  CDEM_NEW(model->cell, model->cells, fault);
  CDEM_NEW(model->kind, model->cells, fault);
  CDEM_NEW(model->material, model->cells, fault);
  CDEM_NEW(model->kinds_of, CDEM_SHAPE_COUNT, fault);
  int32_t n = 0;
  for (int32_t i = 0; i < mesh->cells; i++) {
    if (!chosen[i])
      continue;
    int kind;
    CDEM_TRY(kind_of_shape(model, mesh->cell_shape[i], mesh->cell_tag[i], options->degree, &kind,
                           fault));
    model->cell[n] = i;
    model->kind[n] = (uint8_t)kind;
    model->material[n] = (uint16_t)material_of[i];
    model->kinds_of[kind].cells++;
    model->pairs += cdem_element_pairs(model->kinds_of[kind].tabulation.element);
    n++;
  }
  return CDEM_OK;
}

/* Materials that no chosen cell refers to are not looked at: a file may hold a whole library. */
static cdem_status build_laws(const cdem_model_options *options, const bool *used,
                              cdem_model *model, cdem_fault *fault) {
  model->materials = options->materials;
  CDEM_NEW(model->materials_of, options->materials, fault);
  CDEM_NEW(model->contraction, options->materials, fault);
  for (int i = 0; i < options->materials; i++) {
    model->materials_of[i] = options->material[i];
    if (used[i])
      CDEM_TRY(cdem_contraction_build(&options->material[i], model->formulation, &options->section,
                                      &model->contraction[i], fault));
  }
  return CDEM_OK;
}

/* Rotations are scaled by the size of the elements, the square root of their mean area: a length
 * far from it would let either the displacements or the rotations of a block drown in the other's
 * rounding. */
static void choose_length(const cdem_model_options *options, cdem_model *model) {
  model->length = options->length > 0.0 ? options->length : 1.0;
  if (model->formulation != CDEM_PLANE_COSSERAT || options->length > 0.0)
    return;
  double area = 0.0;
  for (int32_t i = 0; i < model->cells; i++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    cdem_model_coordinates(model, i, xyz);
    area += cdem_element_volume(&model->kinds_of[model->kind[i]].tabulation, 1.0,
                                (const double(*)[3])xyz);
  }
  model->length = sqrt(area / model->cells);
}

/* Plane meshes lie in z = const, to a billionth of their size. */
static cdem_status check_plane(const cdem_model *model, cdem_fault *fault) {
  if (model->dimension != 2)
    return CDEM_OK;
  const cdem_mesh *mesh = model->mesh;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int32_t i = 0; i < model->cells; i++) {
    const int32_t *node = cdem_mesh_cell(mesh, model->cell[i]);
    for (int a = 0; a < cdem_shape_get(mesh->cell_shape[model->cell[i]])->nodes; a++)
      for (int c = 0; c < 3; c++) {
        low[c] = fmin(low[c], mesh->xyz[3 * (int64_t)node[a] + c]);
        high[c] = fmax(high[c], mesh->xyz[3 * (int64_t)node[a] + c]);
      }
  }
  double size = hypot(high[0] - low[0], high[1] - low[1]);
  CDEM_REQUIRE(high[2] - low[2] <= 1e-9 * size, fault, CDEM_INPUT,
               "the plane mesh leaves its plane: z runs from %g to %g m; a 2-D mesh lies in z = "
               "const (shells are "
               "not converted)",
               low[2], high[2]);
  return CDEM_OK;
}

/* An element that is listed twice would count twice. */
static cdem_status check_twins(const cdem_model *model, cdem_fault *fault) {
  const cdem_mesh *mesh = model->mesh;
  int32_t first, second;
  CDEM_TRY(cdem_mesh_find_twins(mesh, model->cell, model->cells, &first, &second, fault));
  CDEM_REQUIRE(first < 0, fault, CDEM_INPUT,
               "elements %" PRId64 " and %" PRId64
               " have the same nodes and would count twice; remove one",
               mesh->cell_tag[first], mesh->cell_tag[second]);
  return CDEM_OK;
}

/* The first element, by place in the mesh, that cannot be; checked by all threads. */
static cdem_status check_elements(const cdem_model *model, cdem_fault *fault) {
  int32_t worst = model->cells;
#pragma omp parallel for schedule(static) reduction(min : worst)
  for (int32_t i = 0; i < model->cells; i++) {
    double xyz[CDEM_SHAPE_MAX_NODES][3];
    cdem_model_coordinates(model, i, xyz);
    const cdem_tabulation *tabulation = &model->kinds_of[model->kind[i]].tabulation;
    if (i < worst && cdem_element_check(tabulation, xyz, NULL) != CDEM_OK)
      worst = i;
  }
  if (worst == model->cells)
    return CDEM_OK;
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  cdem_model_coordinates(model, worst, xyz);
  cdem_status status =
      cdem_element_check(&model->kinds_of[model->kind[worst]].tabulation, xyz, fault);
  cdem_fault_prefix(fault, "element %" PRId64 " (%s)", model->mesh->cell_tag[model->cell[worst]],
                    cdem_model_element(model, worst)->name);
  return status;
}

/* What building needs and the model does not keep. */
typedef struct {
  uint8_t *chosen;  /* [mesh cells] */
  int *material_of; /* [mesh cells] */
  int *owner;       /* [mesh cells] assignment that gave the material */
  bool *used;       /* [materials] */
} drafts;

static cdem_status build(const cdem_model_options *options, const drafts *d, cdem_model *model,
                         cdem_fault *fault) {
  CDEM_REQUIRE(options->materials <= UINT16_MAX, fault, CDEM_INPUT,
               "%d materials are too many; a network takes up to %d", options->materials,
               UINT16_MAX);
  CDEM_TRY(choose_cells(options, d->chosen, &model->dimension, fault));
  CDEM_REQUIRE(model->dimension == 3 || options->section.thickness > 0.0, fault, CDEM_INPUT,
               "thickness = %g m is out of range: a plane body needs a thickness above 0",
               options->section.thickness);
  CDEM_TRY(assign_materials(options, d->chosen, model->dimension, d->material_of, d->owner, fault));
  for (int32_t i = 0; i < options->mesh->cells; i++)
    if (d->chosen[i])
      d->used[d->material_of[i]] = true;
  CDEM_TRY(choose_formulation(options, d->used, model, fault));
  CDEM_TRY(collect_cells(options, d->chosen, d->material_of, model, fault));
  CDEM_TRY(build_laws(options, d->used, model, fault));
  CDEM_TRY(check_plane(model, fault));
  CDEM_TRY(check_twins(model, fault));
  CDEM_TRY(check_elements(model, fault));
  choose_length(options, model);
  return CDEM_OK;
}

cdem_status cdem_model_init(const cdem_model_options *options, cdem_model *model,
                            cdem_fault *fault) {
  const cdem_mesh *mesh = options->mesh;
  cdem_model made = {.mesh = mesh, .section = options->section};
  drafts d = {.chosen = cdem_allocate(mesh->cells, sizeof *d.chosen, fault),
              .material_of = cdem_allocate(mesh->cells, sizeof *d.material_of, fault),
              .owner = cdem_allocate(mesh->cells, sizeof *d.owner, fault),
              .used = cdem_allocate(options->materials, sizeof *d.used, fault)};
  cdem_status status = CDEM_MEMORY;
  if (d.chosen != NULL && d.material_of != NULL && d.owner != NULL && d.used != NULL)
    status = build(options, &d, &made, fault);
  free(d.chosen);
  free(d.material_of);
  free(d.owner);
  free(d.used);
  if (status != CDEM_OK)
    cdem_model_release(&made);
  *model = made;
  return status;
}

void cdem_model_release(cdem_model *model) {
  for (int i = 0; i < model->kinds; i++)
    cdem_tabulation_release(&model->kinds_of[i].tabulation);
  free(model->cell);
  free(model->kind);
  free(model->material);
  free(model->kinds_of);
  free(model->materials_of);
  free(model->contraction);
  memset(model, 0, sizeof *model);
}

void cdem_model_coordinates(const cdem_model *model, int32_t index, double (*xyz)[3]) {
  const cdem_mesh *mesh = model->mesh;
  int32_t cell = model->cell[index];
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  const double *origin = mesh->xyz + 3 * (int64_t)node[0];
  int nodes = cdem_shape_get(mesh->cell_shape[cell])->nodes;
  for (int a = 0; a < nodes; a++)
    for (int c = 0; c < 3; c++)
      xyz[a][c] = mesh->xyz[3 * (int64_t)node[a] + c] - origin[c];
}
