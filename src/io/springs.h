/* Private to io: the spring writers, one file each, and what they share.
 *
 * A writer is a struct whose first member is cdem_springs_writer. One more format: write its file,
 * declare its cdem_springs_format here and add it to the table in formats.c.
 */
#ifndef CDEM_IO_SPRINGS_H
#define CDEM_IO_SPRINGS_H

#include "io/io.h"

extern const cdem_springs_format cdem_springs_csv, cdem_springs_hdf5, cdem_springs_vtp,
    cdem_springs_vtu, cdem_springs_mtx, cdem_springs_inp, cdem_springs_lammps, cdem_springs_yade;

/* What a spring is, in every file that holds springs without a manual beside it. */
#define CDEM_SPRINGS_FORMULA                                                                       \
  "S_ij = -K_ij = sum over rows of dir (x) (stiffness * dual + coupling * dual[couples_to]); "     \
  "the force on node_i from node_j is S_ij (u_j - u_i)"
#define CDEM_SPRINGS_FORMULA_COSSERAT                                                              \
  "S_ij = -K_ij = sum over rows of dir (x) (stiffness * dual + coupling * dual[couples_to]), "     \
  "components (x, y, rz) with rz = length * p_omega and length * q_omega; the force on node_i "    \
  "from node_j is S_ij (d_j - T_ij d_i), T_ij the rigid transport from node_i to node_j"

/* "granite: isotropic, young = 40000000000 Pa, poisson = 0.25"; NULL when out of memory. Free it.
 */
char *cdem_material_text(const cdem_material *material, cdem_fault *fault);

static inline bool cdem_model_is_cosserat(const cdem_model *model) {
  return model->formulation == CDEM_PLANE_COSSERAT;
}

static inline int64_t cdem_pair_element_tag(const cdem_model *model, const cdem_pair *pair) {
  return model->mesh->cell_tag[model->cell[pair->index]];
}

#endif
