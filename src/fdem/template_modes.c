/* Stiffness of a template and its elastic modes, eq (1) of template.h. */
#include "fdem/template_store.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

/* Motions without energy are told from the others by this part of the largest value: rounding is
 * some 1e-13 of it, the softest mode of a compact body some 1e-4. */
static const double rigid_part = 1e-9;

cdem_status cdem_template_stiffness(const cdem_template_rules *rules, const cdem_material *material,
                                    cdem_template *shape, cdem_fault *fault) {
  const cdem_mesh *mesh = &shape->mesh;
  int64_t size = 3 * (int64_t)shape->nodes;
  double xyz[CDEM_SHAPE_MAX_NODES][3], *k = NULL;
  enum { ELEMENT = 3 * CDEM_SHAPE_MAX_NODES };
  CDEM_NEW(shape->stiffness, size * size, fault);
  CDEM_NEW(k, ELEMENT * ELEMENT, fault);
  cdem_status status = CDEM_OK;
  for (int32_t e = 0; e < mesh->cells && status == CDEM_OK; e++) {
    const int32_t *node = cdem_mesh_cell(mesh, e);
    int nodes = cdem_template_cell(mesh, e, xyz), width = 3 * nodes;
    status = cdem_element_stiffness(&rules->rule[mesh->cell_shape[e]].stiff, material, NULL,
                                    (const double(*)[3])xyz, k, fault);
    for (int i = 0; i < width && status == CDEM_OK; i++)
      for (int j = 0; j < width; j++)
        shape->stiffness[size * (3 * (int64_t)node[i / 3] + i % 3) + 3 * node[j / 3] + j % 3] +=
            k[width * i + j];
  }
  free(k);
  return status;
}

/* ---- rigid motions ---- */

/* Six motions of the free body, orthonormal with respect to the masses: rigid [6][3 nodes]. */
static void rigid_motions(const cdem_template *shape, double *rigid) {
  int64_t size = 3 * (int64_t)shape->nodes;
  for (int32_t i = 0; i < shape->nodes; i++)
    for (int r = 0; r < 3; r++) {
      const double *x = shape->mesh.xyz + 3 * (int64_t)i;
      double turn[3], axis[3] = {r == 0, r == 1, r == 2};
      cdem_cross3(axis, x, turn);
      for (int c = 0; c < 3; c++) {
        rigid[r * size + 3 * i + c] = axis[c];
        rigid[(3 + r) * size + 3 * i + c] = turn[c];
      }
    }
}

static double product(const cdem_template *shape, const double *a, const double *b) {
  double sum = 0.0;
  for (int32_t i = 0; i < shape->nodes; i++)
    sum += shape->mass[i] * cdem_dot3(a + 3 * (int64_t)i, b + 3 * (int64_t)i);
  return sum;
}

static void take_away(const cdem_template *shape, const double *rigid, int count, double *v) {
  int64_t size = 3 * (int64_t)shape->nodes;
  for (int r = 0; r < count; r++) {
    double part = product(shape, rigid + r * size, v);
    for (int64_t i = 0; i < size; i++)
      v[i] -= part * rigid[r * size + i];
  }
}

static void to_unit(const cdem_template *shape, double *v) {
  int64_t size = 3 * (int64_t)shape->nodes;
  double norm = sqrt(product(shape, v, v));
  for (int64_t i = 0; i < size; i++)
    v[i] /= norm;
}

static void orthonormal(const cdem_template *shape, double *rigid) {
  int64_t size = 3 * (int64_t)shape->nodes;
  for (int r = 0; r < 6; r++) {
    take_away(shape, rigid, r, rigid + r * size);
    to_unit(shape, rigid + r * size);
  }
}

/* ---- modes ---- */

/* a = M^-1/2 K M^-1/2, whose eigenvectors are M^1/2 phi. */
static void scaled(const cdem_template *shape, double *a) {
  int64_t size = 3 * (int64_t)shape->nodes;
  for (int64_t i = 0; i < size; i++)
    for (int64_t j = 0; j < size; j++)
      a[size * i + j] =
          shape->stiffness[size * i + j] / sqrt(shape->mass[i / 3] * shape->mass[j / 3]);
}

static cdem_status keep(const double *a, const double *value, int wanted, const double *rigid,
                        cdem_template *shape, cdem_fault *fault) {
  int64_t size = 3 * (int64_t)shape->nodes, skin = 3 * (int64_t)shape->surface.nodes;
  int most = (int)size - 6;
  shape->modes = wanted == 0 || wanted > most ? most : wanted;
  CDEM_NEW(shape->lambda, shape->modes, fault);
  CDEM_NEW(shape->mode, shape->modes * size, fault);
  CDEM_NEW(shape->skin, shape->modes * skin, fault);
  for (int k = 0; k < shape->modes; k++) {
    double *mode = shape->mode + k * size;
    shape->lambda[k] = value[6 + k];
    for (int64_t i = 0; i < size; i++)
      mode[i] = a[size * (6 + k) + i] / sqrt(shape->mass[i / 3]);
    take_away(shape, rigid, 6, mode);
    to_unit(shape, mode);
    memcpy(shape->skin + k * skin, mode, (size_t)skin * sizeof *mode);
  }
  return CDEM_OK;
}

/* How far surface nodes give way, fast and slowly: bounds of the step follow from them. */
static void look_at_nodes(cdem_template *shape) {
  int64_t skin = 3 * (int64_t)shape->surface.nodes;
  for (int32_t i = 0; i < shape->surface.nodes; i++) {
    double fast = 0.0, slow = 0.0;
    for (int k = 0; k < shape->modes; k++) {
      const double *phi = shape->skin + k * skin + 3 * (int64_t)i;
      double square = cdem_dot3(phi, phi);
      fast += square;
      slow += square / shape->lambda[k];
    }
    shape->mobility = fmax(shape->mobility, fast);
    shape->compliance = fmax(shape->compliance, slow);
  }
}

static cdem_status find(double *a, double *value, int wanted, double *rigid, cdem_template *shape,
                        cdem_fault *fault) {
  int size = 3 * shape->nodes;
  rigid_motions(shape, rigid);
  orthonormal(shape, rigid);
  scaled(shape, a);
  /* One thread: with several the last bits of the modes depend on how many there are. */
  int threads = openblas_get_num_threads();
  openblas_set_num_threads(1);
  int info = LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', size, a, size, value);
  openblas_set_num_threads(threads);
  CDEM_REQUIRE(info == 0, fault, CDEM_NUMERIC,
               "the modes of a grain were not found (LAPACK dsyevd: %d)", info);
  CDEM_REQUIRE(size > 6 && value[6] > rigid_part * value[size - 1], fault, CDEM_NUMERIC,
               "the mesh of a grain has a motion without energy beside the six rigid ones (value "
               "%.3g of the largest, at least %g is needed): parts of it hang together by a point "
               "or a line",
               size > 6 ? value[6] / value[size - 1] : 0.0, rigid_part);
  CDEM_TRY(keep(a, value, wanted, rigid, shape, fault));
  look_at_nodes(shape);
  return CDEM_OK;
}

cdem_status cdem_template_modes(int wanted, cdem_template *shape, cdem_fault *fault) {
  int64_t size = 3 * (int64_t)shape->nodes;
  double *a = cdem_allocate(size * size, sizeof *a, fault);
  double *value = a != NULL ? cdem_allocate(size, sizeof *value, fault) : NULL;
  double *rigid = value != NULL ? cdem_allocate(6 * size, sizeof *rigid, fault) : NULL;
  cdem_status status = rigid != NULL ? find(a, value, wanted, rigid, shape, fault) : CDEM_MEMORY;
  free(a);
  free(value);
  free(rigid);
  return status;
}
