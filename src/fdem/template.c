/* A template from its options, step by step; integrals over its cells. */
#include "fdem/template_store.h"

#include <stdlib.h>
#include <string.h>

/* All modes of so many are found in half a minute. */
enum { MOST_NODES = 1500 };

cdem_status cdem_template_rules_init(const cdem_mesh *mesh, cdem_template_rules *rules,
                                     cdem_fault *fault) {
  memset(rules, 0, sizeof *rules);
  for (int32_t c = 0; c < mesh->cells; c++) {
    cdem_shape shape = (cdem_shape)mesh->cell_shape[c];
    cdem_template_rule *rule = &rules->rule[shape];
    if (rule->made)
      continue;
    const cdem_element *element = cdem_element_for(shape, CDEM_SOLID);
    CDEM_REQUIRE(element != NULL, fault, CDEM_INPUT, "grains cannot be made of cells of kind %s",
                 cdem_shape_get(shape)->name);
    rule->made = true;
    CDEM_TRY(cdem_tabulation_init(element, 0, &rule->stiff, fault));
    CDEM_TRY(cdem_tabulation_init(element, 7, &rule->mass, fault));
  }
  return CDEM_OK;
}

void cdem_template_rules_release(cdem_template_rules *rules) {
  for (int k = 0; k < CDEM_SHAPE_COUNT; k++)
    if (rules->rule[k].made) {
      cdem_tabulation_release(&rules->rule[k].stiff);
      cdem_tabulation_release(&rules->rule[k].mass);
    }
}

static cdem_status check_options(const cdem_template_options *options, cdem_fault *fault) {
  const cdem_grain_shape *shape = options->shape;
  int r = options->options.refinement;
  CDEM_REQUIRE(shape->least == shape->most || (r >= shape->least && r <= shape->most), fault,
               CDEM_INPUT, "refinement %d of the grain shape '%s': it must be %d to %d", r,
               shape->name, shape->least, shape->most);
  CDEM_REQUIRE(!cdem_material_is_cosserat(options->material), fault, CDEM_INPUT,
               "grains of the Cosserat material '%s': deformable grains are classical solids",
               options->material->name);
  CDEM_REQUIRE(options->modes >= 0, fault, CDEM_INPUT,
               "%d modes of a grain: 0 (all) or more are possible", options->modes);
  return CDEM_OK;
}

/* Neighbouring grains overlap by a tenth of a radius at most where anything is to be believed. */
static const double margin = 0.15;

static cdem_status make(const cdem_template_options *options, cdem_template *shape,
                        cdem_fault *fault) {
  cdem_template_rules rules;
  int32_t surface = 0;
  CDEM_TRY(cdem_template_mesh(options, shape, &surface, fault));
  CDEM_REQUIRE(shape->nodes <= MOST_NODES, fault, CDEM_INPUT,
               "a grain of %d nodes: %d are the most; take a coarser mesh or refinement",
               (int)shape->nodes, MOST_NODES);
  cdem_status status = cdem_template_rules_init(&shape->mesh, &rules, fault);
  if (status == CDEM_OK)
    status = cdem_template_masses(&rules, shape, fault);
  if (status == CDEM_OK)
    status = cdem_template_stiffness(&rules, options->material, shape, fault);
  if (status == CDEM_OK)
    status = cdem_skin_build(&shape->mesh, surface, margin, &shape->surface, fault);
  if (status == CDEM_OK)
    status = cdem_template_modes(options->modes, shape, fault);
  cdem_template_rules_release(&rules);
  return status;
}

cdem_status cdem_template_init(const cdem_template_options *options, bool keep_stiffness,
                               cdem_template *shape, cdem_fault *fault) {
  memset(shape, 0, sizeof *shape);
  CDEM_TRY(check_options(options, fault));
  cdem_status status = make(options, shape, fault);
  if (status != CDEM_OK)
    cdem_template_release(shape);
  if (!keep_stiffness) {
    free(shape->stiffness);
    shape->stiffness = NULL;
  }
  return status;
}

void cdem_template_release(cdem_template *shape) {
  cdem_mesh_release(&shape->mesh);
  cdem_skin_release(&shape->surface);
  free(shape->mass);
  free(shape->lambda);
  free(shape->mode);
  free(shape->skin);
  free(shape->stiffness);
  memset(shape, 0, sizeof *shape);
}
