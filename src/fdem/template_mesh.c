/* The reference mesh of a template and its masses. */
#include "elements/basis.h"
#include "fdem/template_store.h"

#include <stdlib.h>
#include <string.h>

static const double unit_ball = 4.18879020478639098;

/* ---- surface nodes first ---- */

static cdem_status one_body(const cdem_mesh *mesh, const int32_t *cell, int32_t *scratch,
                            cdem_fault *fault) {
  int32_t components = 0;
  CDEM_TRY(cdem_mesh_components(mesh, cell, mesh->cells, scratch, &components, fault));
  CDEM_REQUIRE(components == 1, fault, CDEM_INPUT,
               "the mesh of a grain consists of %d bodies that share no node; it must be one",
               (int)components);
  return CDEM_OK;
}

/* New number of each node: the surface, then the rest; -1 of nodes without a cell. Returns how many
 * are on the surface. */
static int32_t number(const cdem_mesh *mesh, const int32_t *component, const bool *boundary,
                      int32_t *to, int32_t *nodes) {
  int32_t next = 0, surface = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (int32_t i = 0; i < mesh->nodes; i++)
      if (component[i] >= 0 && boundary[i] == (pass == 0))
        to[i] = next++;
      else if (component[i] < 0)
        to[i] = -1;
    surface = pass == 0 ? next : surface;
  }
  *nodes = next;
  return surface;
}

static cdem_status renumbered(const cdem_mesh *from, const int32_t *to, int32_t nodes, double *xyz,
                              cdem_mesh *mesh, cdem_fault *fault) {
  for (int32_t i = 0; i < from->nodes; i++)
    if (to[i] >= 0)
      memcpy(xyz + 3 * (int64_t)to[i], from->xyz + 3 * (int64_t)i, 3 * sizeof *xyz);
  CDEM_TRY(cdem_mesh_add_nodes(mesh, nodes, xyz, NULL, fault));
  for (int32_t c = 0; c < from->cells; c++) {
    cdem_shape shape = (cdem_shape)from->cell_shape[c];
    int32_t node[CDEM_SHAPE_MAX_NODES];
    for (int a = 0; a < cdem_shape_get(shape)->nodes; a++)
      node[a] = to[cdem_mesh_cell(from, c)[a]];
    CDEM_TRY(cdem_mesh_add_cells(mesh, shape, 1, node, &from->cell_tag[c], fault));
  }
  return CDEM_OK;
}

/* Scratch of the numbering. */
typedef struct {
  int32_t *cell, *component, *to;
  bool *boundary;
  double *xyz;
} sorting;

static cdem_status sort(const cdem_mesh *made, sorting *s, cdem_mesh *mesh, int32_t *surface,
                        cdem_fault *fault) {
  int32_t nodes = 0;
  CDEM_NEW(s->cell, made->cells, fault);
  CDEM_NEW(s->component, made->nodes, fault);
  CDEM_NEW(s->to, made->nodes, fault);
  CDEM_NEW(s->boundary, made->nodes, fault);
  CDEM_NEW(s->xyz, 3 * (int64_t)made->nodes, fault);
  for (int32_t c = 0; c < made->cells; c++)
    s->cell[c] = c;
  CDEM_TRY(one_body(made, s->cell, s->component, fault));
  CDEM_TRY(cdem_mesh_boundary_nodes(made, s->cell, made->cells, s->boundary, fault));
  *surface = number(made, s->component, s->boundary, s->to, &nodes);
  return renumbered(made, s->to, nodes, s->xyz, mesh, fault);
}

/* ---- centre and size ---- */

/* Volume and first moments of the body by the rule of its masses. */
static cdem_status moments(const cdem_template_rules *rules, const cdem_mesh *mesh,
                           double moment[4], cdem_fault *fault) {
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  memset(moment, 0, 4 * sizeof *moment);
  for (int32_t e = 0; e < mesh->cells; e++) {
    const cdem_tabulation *t = &rules->rule[mesh->cell_shape[e]].mass;
    cdem_template_cell(mesh, e, xyz);
    cdem_status status = cdem_element_check(t, (const double(*)[3])xyz, fault);
    if (status != CDEM_OK)
      cdem_fault_prefix(fault, "element %lld of the grain", (long long)mesh->cell_tag[e]);
    CDEM_TRY(status);
    for (int q = 0; q < t->points; q++) {
      double j[9];
      double w = t->weight[q] *
                 cdem_jacobian(3, t->nodes, cdem_tabulated(t, q), (const double(*)[3])xyz, j);
      moment[0] += w;
      for (int a = 0; a < t->nodes; a++)
        for (int c = 0; c < 3; c++)
          moment[1 + c] += w * t->n[t->nodes * q + a] * xyz[a][c];
    }
  }
  return CDEM_OK;
}

static cdem_status normalise(cdem_mesh *mesh, cdem_fault *fault) {
  cdem_template_rules rules;
  double moment[4];
  cdem_status status = cdem_template_rules_init(mesh, &rules, fault);
  if (status == CDEM_OK)
    status = moments(&rules, mesh, moment, fault);
  cdem_template_rules_release(&rules);
  CDEM_TRY(status);
  double size = cbrt(moment[0] / unit_ball);
  for (int32_t i = 0; i < mesh->nodes; i++)
    for (int c = 0; c < 3; c++) {
      double *x = mesh->xyz + 3 * (int64_t)i + c;
      *x = (*x - moment[1 + c] / moment[0]) / size;
    }
  return CDEM_OK;
}

cdem_status cdem_template_mesh(const cdem_template_options *options, cdem_template *shape,
                               int32_t *surface_nodes, cdem_fault *fault) {
  cdem_mesh made = {0};
  sorting s = {0};
  CDEM_TRY(options->shape->make(&options->options, &made, fault));
  cdem_status status = sort(&made, &s, &shape->mesh, surface_nodes, fault);
  free(s.cell);
  free(s.component);
  free(s.to);
  free(s.boundary);
  free(s.xyz);
  cdem_mesh_release(&made);
  CDEM_TRY(status);
  shape->nodes = shape->mesh.nodes;
  return normalise(&shape->mesh, fault);
}

/* ---- masses ---- */

/* Lumped as the diagonal of the consistent matrix, scaled to the mass of the element (Hinton, Rock
 * & Zienkiewicz 1976): positive for every element. */
static void lump(const cdem_tabulation *t, const double (*xyz)[3], const int32_t *node,
                 double *mass, double second[9]) {
  double diagonal[CDEM_SHAPE_MAX_NODES] = {0.0}, volume = 0.0, sum = 0.0, j[9];
  for (int q = 0; q < t->points; q++) {
    const double *n = t->n + t->nodes * q;
    double w = t->weight[q] * cdem_jacobian(3, t->nodes, cdem_tabulated(t, q), xyz, j);
    double x[3] = {0.0, 0.0, 0.0};
    volume += w;
    for (int a = 0; a < t->nodes; a++) {
      diagonal[a] += w * n[a] * n[a];
      for (int c = 0; c < 3; c++)
        x[c] += n[a] * xyz[a][c];
    }
    for (int i = 0; i < 9; i++)
      second[i] += w * x[i / 3] * x[i % 3];
  }
  for (int a = 0; a < t->nodes; a++)
    sum += diagonal[a];
  for (int a = 0; a < t->nodes; a++)
    mass[node[a]] += volume * diagonal[a] / sum;
}

cdem_status cdem_template_masses(const cdem_template_rules *rules, cdem_template *shape,
                                 cdem_fault *fault) {
  const cdem_mesh *mesh = &shape->mesh;
  double second[9] = {0.0}, xyz[CDEM_SHAPE_MAX_NODES][3];
  CDEM_NEW(shape->mass, shape->nodes, fault);
  for (int32_t e = 0; e < mesh->cells; e++) {
    cdem_template_cell(mesh, e, xyz);
    lump(&rules->rule[mesh->cell_shape[e]].mass, (const double(*)[3])xyz, cdem_mesh_cell(mesh, e),
         shape->mass, second);
  }
  double trace = second[0] + second[4] + second[8];
  for (int i = 0; i < 9; i++)
    shape->inertia[i] = (i % 4 == 0 ? trace : 0.0) - second[i];
  return CDEM_OK;
}
