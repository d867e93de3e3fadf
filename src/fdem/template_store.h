/* Private to fdem: the steps that make a template, one file each. */
#ifndef CDEM_FDEM_TEMPLATE_STORE_H
#define CDEM_FDEM_TEMPLATE_STORE_H

#include "elements/elements.h"
#include "fdem/template.h"

/* What one kind of cell needs for integrals over it. */
typedef struct {
  cdem_tabulation stiff, mass; /* the element's own rule; one for N_i^2 and x x on curved cells */
  bool made;
} cdem_template_rule;
typedef struct {
  cdem_template_rule rule[CDEM_SHAPE_COUNT];
} cdem_template_rules;
cdem_status cdem_template_rules_init(const cdem_mesh *mesh, cdem_template_rules *rules,
                                     cdem_fault *fault);
void cdem_template_rules_release(cdem_template_rules *rules);

/* template_mesh.c: the mesh with the surface nodes first, centre of mass at the origin and the
 * volume of the unit ball; lumped masses and the tensor of inertia of the body. */
cdem_status cdem_template_mesh(const cdem_template_options *options, cdem_template *shape,
                               int32_t *surface_nodes, cdem_fault *fault);
cdem_status cdem_template_masses(const cdem_template_rules *rules, cdem_template *shape,
                                 cdem_fault *fault);
/* template_modes.c: stiffness (shape->stiffness) and from it the elastic modes. */
cdem_status cdem_template_stiffness(const cdem_template_rules *rules, const cdem_material *material,
                                    cdem_template *shape, cdem_fault *fault);
cdem_status cdem_template_modes(int wanted, cdem_template *shape, cdem_fault *fault);

/* Corner coordinates of a cell, [nodes][3]. */
static inline int cdem_template_cell(const cdem_mesh *mesh, int32_t cell, double (*xyz)[3]) {
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  int nodes = cdem_shape_get((cdem_shape)mesh->cell_shape[cell])->nodes;
  for (int a = 0; a < nodes; a++)
    for (int c = 0; c < 3; c++)
      xyz[a][c] = mesh->xyz[3 * (int64_t)node[a] + c];
  return nodes;
}

#endif
