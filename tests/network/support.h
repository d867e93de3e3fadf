/* Bodies that the network tests share. */
#ifndef CDEM_TESTS_NETWORK_SUPPORT_H
#define CDEM_TESTS_NETWORK_SUPPORT_H

#include "network/network.h"
#include "support/test.h"

/* A small body of all-different elements of one kind. */
static inline void make_grid(const cdem_element *element, int32_t count, double distortion,
                             cdem_mesh *mesh) {
  cdem_fault fault = {0};
  bool solid = cdem_element_dimension(element) == 3;
  cdem_mesh_grid_options options = {.shape = element->shape,
                                    .count = {count, count, solid ? count : 0},
                                    .size = {1.3, 1.0, solid ? 0.9 : 0.0},
                                    .distortion = distortion,
                                    .seed = 7};
  check_ok(cdem_mesh_grid(&options, mesh, &fault));
}

static inline cdem_material make_material(const cdem_element *element) {
  cdem_material material = cdem_material_isotropic(40e9, 0.23);
  if (element->formulation == CDEM_PLANE_COSSERAT) {
    material.model = CDEM_COSSERAT;
    material.parameter[2] = 7e9;
    material.parameter[3] = 0.07;
    material.parameter[4] = 1.0;
  }
  return material;
}

static inline void make_model(const cdem_mesh *mesh, const cdem_material *material,
                              cdem_model *model) {
  cdem_fault fault = {0};
  cdem_model_options options = {.mesh = mesh,
                                .materials = 1,
                                .material = material,
                                .default_material = -1,
                                .section = {CDEM_PLANE_STRAIN, 0.7}};
  check_ok(cdem_model_init(&options, model, &fault));
}

#endif
