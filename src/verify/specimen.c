#include "verify/specimen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Reference coordinates to edges of length 1: an affine map of the shape's own. */
static void unit_shape(const cdem_element *element, int node, double xyz[3]) {
  const double *r = element->reference[node];
  const double height = sqrt(3.0) / 2.0;
  switch (element->shape) {
  case CDEM_SHAPE_TRI3:
  case CDEM_SHAPE_TRI6:
    xyz[0] = r[0] + 0.5 * r[1], xyz[1] = height * r[1], xyz[2] = 0.0;
    break;
  case CDEM_SHAPE_TET4:
  case CDEM_SHAPE_TET10:
    xyz[0] = r[0] + 0.5 * r[1] + 0.5 * r[2];
    xyz[1] = height * (r[1] + r[2] / 3.0);
    xyz[2] = sqrt(2.0 / 3.0) * r[2];
    break;
  case CDEM_SHAPE_WEDGE6:
    xyz[0] = r[0] + 0.5 * r[1], xyz[1] = height * r[1], xyz[2] = 0.5 * (r[2] + 1.0);
    break;
  case CDEM_SHAPE_PYR5:
    xyz[0] = 0.5 * (r[0] + 1.0), xyz[1] = 0.5 * (r[1] + 1.0), xyz[2] = M_SQRT1_2 * r[2];
    break;
  default:
    for (int d = 0; d < 3; d++)
      xyz[d] = d < cdem_element_dimension(element) ? 0.5 * (r[d] + 1.0) : 0.0;
  }
}

static void place_nodes(cdem_specimen *specimen) {
  const cdem_specimen_options *o = &specimen->options;
  for (int a = 0; a < cdem_element_nodes(o->element); a++) {
    if (o->xyz != NULL) {
      memcpy(specimen->xyz[a], o->xyz[a], sizeof specimen->xyz[a]);
      continue;
    }
    unit_shape(o->element, a, specimen->xyz[a]);
    for (int d = 0; d < 3; d++)
      specimen->xyz[a][d] *= o->box[d];
  }
}

static void fill_defaults(cdem_specimen_options *o) {
  double *const value[] = {&o->young,         &o->box[0],           &o->box[1],
                           &o->box[2],        &o->cosserat_ratio,   &o->length,
                           &o->couple_factor, &o->section.thickness};
  for (size_t i = 0; i < sizeof value / sizeof value[0]; i++)
    if (*value[i] == 0.0)
      *value[i] = 1.0;
}

static cdem_status fill_moments(cdem_specimen *specimen, cdem_fault *fault) {
  const cdem_element *element = specimen->options.element;
  int nodes = cdem_element_nodes(element), features = cdem_element_features(element);
  double x[CDEM_SHAPE_MAX_NODES * 3 * CDEM_LANES], least[CDEM_LANES];
  for (int a = 0; a < nodes; a++)
    for (int d = 0; d < 3; d++)
      for (int lane = 0; lane < CDEM_LANES; lane++)
        x[(3 * a + d) * CDEM_LANES + lane] = specimen->xyz[a][d];
  CDEM_NEW(specimen->moment,
           (int64_t)cdem_element_pairs(element) * features * features * CDEM_LANES, fault);
  cdem_moments_kernel(&specimen->tabulation, x, specimen->moment, least);
  return CDEM_OK;
}

static cdem_status fill(cdem_specimen *specimen, cdem_fault *fault) {
  const cdem_specimen_options *o = &specimen->options;
  place_nodes(specimen);
  CDEM_TRY(cdem_tabulation_init(o->element, 0, &specimen->tabulation, fault));
  CDEM_TRY(cdem_element_check(&specimen->tabulation, (const double(*)[3])specimen->xyz, fault));
  return fill_moments(specimen, fault);
}

cdem_status cdem_specimen_init(const cdem_specimen_options *options, cdem_specimen *specimen,
                               cdem_fault *fault) {
  cdem_specimen made = {.options = *options};
  fill_defaults(&made.options);
  const cdem_specimen_options *o = &made.options;
  bool plane_stress =
      o->element->formulation != CDEM_SOLID && o->section.plane == CDEM_PLANE_STRESS;
  made.own_shape = o->xyz != NULL;
  made.regular = !made.own_shape && o->box[0] == o->box[1] &&
                 (o->element->formulation != CDEM_SOLID || o->box[1] == o->box[2]);
  made.family = (cdem_poisson_family){.size = cdem_element_dofs(o->element),
                                      .factor = plane_stress ? cdem_poisson_factor_plane_stress
                                                             : cdem_poisson_factor_solid,
                                      .low = -1.0,
                                      .high = plane_stress ? 1.0 : 0.5};
  cdem_status status = fill(&made, fault);
  if (status != CDEM_OK) {
    cdem_specimen_release(&made);
    return status;
  }
  made.options.xyz = NULL;
  *specimen = made;
  return CDEM_OK;
}

void cdem_specimen_release(cdem_specimen *specimen) {
  cdem_tabulation_release(&specimen->tabulation);
  free(specimen->moment);
  *specimen = (cdem_specimen){0};
}

cdem_material cdem_specimen_material(const cdem_specimen *specimen, double nu) {
  const cdem_specimen_options *o = &specimen->options;
  cdem_material material = cdem_material_isotropic(o->young, nu);
  if (o->element->formulation == CDEM_PLANE_COSSERAT) {
    material.model = CDEM_COSSERAT;
    material.parameter[2] = o->cosserat_ratio * o->young / (2.0 * (1.0 + nu));
    material.parameter[3] = o->length;
    material.parameter[4] = o->couple_factor;
  }
  return material;
}

/* omega -> length omega, moment -> moment/length: entries in N/m. */
static void scale_rotations(double length, double *s) {
  for (int i = 0; i < 3; i++) {
    s[3 * i + 2] /= length;
    s[6 + i] /= length;
  }
}

static cdem_status blocks_of(const cdem_specimen *specimen, double nu, int first, int count,
                             double *s, cdem_fault *fault) {
  const cdem_element *element = specimen->options.element;
  const cdem_material material = cdem_specimen_material(specimen, nu);
  int entries = cdem_element_dofs(element) * cdem_element_dofs(element);
  int moments = cdem_element_features(element) * cdem_element_features(element);
  double lanes[9 * CDEM_LANES], length = cdem_material_length(&material);
  cdem_contraction contraction;
  const cdem_contraction *of_lane[CDEM_LANES];
  CDEM_TRY(cdem_contraction_build(&material, element->formulation, &specimen->options.section,
                                  &contraction, fault));
  for (int lane = 0; lane < CDEM_LANES; lane++)
    of_lane[lane] = &contraction;
  for (int p = 0; p < count; p++) {
    cdem_blocks_kernel(1, of_lane, specimen->moment + (int64_t)(first + p) * moments * CDEM_LANES,
                       lanes);
    for (int e = 0; e < entries; e++)
      s[p * entries + e] = lanes[e * CDEM_LANES];
    if (element->formulation == CDEM_PLANE_COSSERAT)
      scale_rotations(length, s + p * entries);
  }
  return CDEM_OK;
}

cdem_status cdem_specimen_blocks(const cdem_specimen *specimen, double nu, double *s,
                                 cdem_fault *fault) {
  return blocks_of(specimen, nu, 0, cdem_element_pairs(specimen->options.element), s, fault);
}

cdem_specimen_pair cdem_specimen_pair_at(const cdem_specimen *specimen, int pair) {
  const cdem_element *element = specimen->options.element;
  cdem_specimen_pair at = {.specimen = specimen, .pair = pair};
  int a = 0, b = pair, nodes = cdem_element_nodes(element);
  for (int row = nodes - 1; b >= row; row--) {
    b -= row;
    a++;
  }
  at.node[0] = a;
  at.node[1] = a + 1 + b;
  at.class_ = (cdem_class)(cdem_shape_pair_class(element->shape, at.node[0], at.node[1]) - 1);
  return at;
}

static cdem_status pair_block(void *context, double nu, double *s, cdem_fault *fault) {
  const cdem_specimen_pair *pair = context;
  return blocks_of(pair->specimen, nu, pair->pair, 1, s, fault);
}

static bool pair_closed(void *context, double nu, cdem_closed *closed) {
  const cdem_specimen_pair *pair = context;
  const cdem_specimen *specimen = pair->specimen;
  const cdem_specimen_options *o = &specimen->options;
  const cdem_closed_sheet sheet = {o->young, nu, o->section.thickness,
                                   o->section.plane == CDEM_PLANE_STRESS};
  if (strcmp(o->element->name, "hex8") == 0 && specimen->regular) {
    cdem_closed_cube(pair->class_, &(cdem_closed_solid){o->young, nu, o->box[0]}, closed);
    return true;
  }
  if (strcmp(o->element->name, "tri3") == 0 && specimen->regular) {
    cdem_closed_triangle_edge(&sheet, closed);
    return true;
  }
  if (strcmp(o->element->name, "quad4") == 0 && !specimen->own_shape) {
    /* Edges 1-2, 3-4 run along x, the others along y. */
    bool along_x = specimen->xyz[pair->node[0]][1] == specimen->xyz[pair->node[1]][1];
    if (pair->class_ == CDEM_CLASS_EDGE)
      cdem_closed_rectangle_edge(&sheet, o->box[along_x ? 0 : 1], o->box[along_x ? 1 : 0], closed);
    else
      cdem_closed_rectangle_diagonal(&sheet, o->box[0], o->box[1], closed);
    return true;
  }
  return false;
}

cdem_poisson_family cdem_specimen_family(cdem_specimen_pair *pair) {
  cdem_poisson_family family = pair->specimen->family;
  family.context = pair;
  family.block = pair_block;
  family.closed = pair_closed;
  family.frame = pair->class_ == CDEM_CLASS_BODY;
  return family;
}
