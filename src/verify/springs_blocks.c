/* Checks of decomposition, of whole elements and of networks. */
#include "network/certificate.h"
#include "verify/specimen.h"
#include "verify/springs.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DOFS = CDEM_SHAPE_MAX_NODES * CDEM_MAX_DOFS };

/* An element with every node moved by up to 8 % of the edge, the same for the same seed. */
static cdem_status init_distorted(int element, uint64_t seed, cdem_specimen *specimen,
                                  cdem_fault *fault) {
  cdem_specimen_options options = {
      .element = cdem_element_get((cdem_element_id)element), .cosserat_ratio = 0.6, .length = 0.4};
  cdem_specimen plain = {0};
  CDEM_TRY(cdem_specimen_init(&options, &plain, fault));
  cdem_random random = {seed};
  int dimension = cdem_element_dimension(options.element);
  for (int a = 0; a < cdem_element_nodes(options.element); a++)
    for (int d = 0; d < dimension; d++)
      plain.xyz[a][d] += cdem_random_uniform(&random, -0.08, 0.08);
  options.xyz = (const double(*)[3])plain.xyz;
  cdem_status status = cdem_specimen_init(&options, specimen, fault);
  cdem_specimen_release(&plain);
  return status;
}

/* ---- decomposition ---- */

/* Robust (reference) or fast path of one block. */
static cdem_status decompose(const double *s, int size, bool fast, cdem_spring_set *set,
                             cdem_fault *fault) {
  if (!fast)
    return cdem_springs_from_block(s, size, false, set, fault);
  double batch[9 * 8];
  for (int e = 0; e < size * size; e++)
    for (int lane = 0; lane < 8; lane++)
      batch[8 * e + lane] = s[e];
  return cdem_springs_from_blocks(batch, 1, size, NULL, set, fault);
}

cdem_status cdem_springs_measure_near_jordan(int parameter, double *value, cdem_fault *fault) {
  const double critical[3] = {0.25 - 5.0 * sqrt(2.0) / 32.0, 0.25 + 5.0 * sqrt(2.0) / 32.0,
                              0.25 - sqrt(2.0) / 4.0};
  cdem_specimen_options options = {.element = cdem_element_find("hex8")};
  cdem_specimen cube = {0};
  CDEM_TRY(cdem_specimen_init(&options, &cube, fault));
  cdem_status status = CDEM_OK;
  *value = 0.0;
  for (int i = 0; i < 3 * 2 * 17 && status == CDEM_OK; i++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(&cube, i % 3 < 2 ? 0 : 1); /* 1-2, 1-3 */
    cdem_poisson_family family = cdem_specimen_family(&pair);
    int side = i / 3 % 2 == 1 ? 1 : -1, power = i / 6;
    double s[9], nu = critical[i % 3] + side * pow(10.0, -power);
    cdem_spring_set set;
    if (!(nu > -1.0 && nu < 0.5))
      continue;
    status = family.block(family.context, nu, s, fault);
    if (status == CDEM_OK)
      status = decompose(s, 3, parameter == 1, &set, fault);
    if (status == CDEM_OK)
      *value = fmax(*value, cdem_springs_residual(s, &set));
  }
  cdem_specimen_release(&cube);
  return status;
}

/* Trace, sum of principal minors and determinant of the matrix of stiffnesses and couplings. */
static void invariants(const cdem_spring_set *set, double out[3]) {
  double l[9] = {0};
  for (int r = 0; r < set->rows; r++) {
    const cdem_spring_row *row = &set->row[r];
    l[4 * (row->spring - 1)] += row->stiffness;
    if (row->couples_to != 0)
      l[3 * (row->spring - 1) + row->couples_to - 1] += row->coupling;
  }
  out[0] = l[0] + l[4] + l[8];
  out[1] = l[4] * l[8] - l[5] * l[7] + l[0] * l[8] - l[2] * l[6] + l[0] * l[4] - l[1] * l[3];
  out[2] = cdem_det3(l);
}

/* Both paths on random 3x3 blocks; compare(slow, fast, |S|) gives the difference of one. */
static cdem_status compare_paths(double (*compare)(const cdem_spring_set *, const cdem_spring_set *,
                                                   double),
                                 double *value, cdem_fault *fault) {
  cdem_random random = {31};
  *value = 0.0;
  for (int trial = 0; trial < 2000; trial++) {
    double s[9];
    cdem_spring_set slow, fast;
    for (int i = 0; i < 9; i++)
      s[i] = cdem_random_uniform(&random, -1.0, 1.0);
    CDEM_TRY(decompose(s, 3, false, &slow, fault));
    CDEM_TRY(decompose(s, 3, true, &fast, fault));
    *value = fmax(*value, compare(&slow, &fast, cdem_frobenius(s, 9)));
  }
  return CDEM_OK;
}

static double compare_invariants(const cdem_spring_set *a, const cdem_spring_set *b, double norm) {
  double of_a[3], of_b[3], worst = 0.0, scale = norm;
  invariants(a, of_a);
  invariants(b, of_b);
  for (int i = 0; i < 3; i++, scale *= norm)
    worst = fmax(worst, fabs(of_a[i] - of_b[i]) / scale);
  return worst;
}

static double compare_values(const cdem_spring_set *a, const cdem_spring_set *b, double norm) {
  double worst = 0.0;
  if (a->form != b->form || !(a->cond < 1e3) || !(b->cond < 1e3))
    return 0.0;
  for (int k = 0; k < 3; k++)
    worst = fmax(worst, fabs(a->row[k].stiffness - b->row[k].stiffness) / norm);
  return worst;
}

cdem_status cdem_springs_measure_fast_invariants(int parameter, double *value, cdem_fault *fault) {
  (void)parameter;
  return compare_paths(compare_invariants, value, fault);
}

cdem_status cdem_springs_measure_fast_values(int parameter, double *value, cdem_fault *fault) {
  (void)parameter;
  return compare_paths(compare_values, value, fault);
}

cdem_status cdem_springs_measure_rebuild(int parameter, double *value, cdem_fault *fault) {
  static const double nu[] = {-0.3, 0.0, 0.25, 0.3, 0.49};
  double s[CDEM_MAX_PAIRS * 9];
  *value = 0.0;
  for (int i = 0; i < 5; i++) {
    cdem_specimen specimen = {0};
    cdem_spring_set set;
    CDEM_TRY(init_distorted(parameter, 100 + (uint64_t)i, &specimen, fault));
    int size = specimen.family.size, pairs = cdem_element_pairs(specimen.options.element);
    cdem_status status = cdem_specimen_blocks(&specimen, nu[i], s, fault);
    for (int p = 0; p < pairs && status == CDEM_OK; p++) {
      const double *block = s + p * size * size;
      status = decompose(block, size, true, &set, fault);
      if (status == CDEM_OK)
        *value = fmax(*value, cdem_springs_residual(block, &set));
    }
    cdem_specimen_release(&specimen);
    CDEM_TRY(status);
  }
  return CDEM_OK;
}

/* ---- whole elements ---- */

/* Rigid transport from node a to node b (docs/theory/springs.md, eq. 21); the identity in classical
 * solids. */
static void transport(const cdem_specimen *specimen, int a, int b, double t[9]) {
  int size = specimen->family.size;
  for (int i = 0; i < size * size; i++)
    t[i] = i % (size + 1) == 0 ? 1.0 : 0.0;
  if (specimen->options.element->formulation == CDEM_PLANE_COSSERAT) {
    t[2] = -(specimen->xyz[b][1] - specimen->xyz[a][1]);
    t[5] = specimen->xyz[b][0] - specimen->xyz[a][0];
  }
}

/* k [n][n] of nodes*size rows += sign * (s or its transpose) * t at block (a, b). */
static void add_block(double *k, int n, int size, int at[2], double sign, bool transposed,
                      const double *s, const double *t) {
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++) {
      double sum = 0.0;
      for (int m = 0; m < size; m++)
        sum += (transposed ? s[size * m + i] : s[size * i + m]) *
               (t != NULL ? t[size * m + j] : (m == j ? 1.0 : 0.0));
      k[(at[0] * size + i) * n + at[1] * size + j] += sign * sum;
    }
}

/* The network of one element, from the rows of its spring sets; pair `without` is left out (-1:
 * none). k [n][n], n = nodes * dofs. */
static cdem_status put_together(const cdem_specimen *specimen, double nu, int without, double *k,
                                cdem_fault *fault) {
  const cdem_element *element = specimen->options.element;
  int size = specimen->family.size, n = cdem_element_nodes(element) * size;
  const cdem_material material = cdem_specimen_material(specimen, nu);
  double s[CDEM_MAX_PAIRS * 9], length = cdem_material_length(&material);
  CDEM_TRY(cdem_specimen_blocks(specimen, nu, s, fault));
  memset(k, 0, (size_t)n * (size_t)n * sizeof *k);
  for (int p = 0; p < cdem_element_pairs(element); p++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(specimen, p);
    cdem_spring_set set;
    double block[9], t[9];
    if (p == without)
      continue;
    CDEM_TRY(cdem_springs_from_block(s + p * size * size, size, pair.class_ == CDEM_CLASS_BODY,
                                     &set, fault));
    cdem_springs_rebuild(&set, block);
    for (int i = 0; i < 9 && element->formulation == CDEM_PLANE_COSSERAT; i++)
      block[i] *= (i / 3 == 2 ? length : 1.0) * (i % 3 == 2 ? length : 1.0);
    int a = pair.node[0], b = pair.node[1];
    add_block(k, n, size, (int[2]){a, b}, -1.0, false, block, NULL);
    add_block(k, n, size, (int[2]){b, a}, -1.0, true, block, NULL);
    transport(specimen, a, b, t);
    add_block(k, n, size, (int[2]){a, a}, 1.0, false, block, t);
    transport(specimen, b, a, t);
    add_block(k, n, size, (int[2]){b, b}, 1.0, true, block, t);
  }
  return CDEM_OK;
}

static cdem_status stiffness_of(const cdem_specimen *specimen, double nu, double *k,
                                cdem_fault *fault) {
  const cdem_material material = cdem_specimen_material(specimen, nu);
  return cdem_element_stiffness(&specimen->tabulation, &material, &specimen->options.section,
                                (const double(*)[3])specimen->xyz, k, fault);
}

static cdem_status assembly_difference(const cdem_specimen *specimen, double *network,
                                       double *element, double *value, cdem_fault *fault) {
  int n = specimen->family.size * cdem_element_nodes(specimen->options.element);
  double largest = 0.0, off = 0.0;
  CDEM_TRY(put_together(specimen, 0.3, -1, network, fault));
  CDEM_TRY(stiffness_of(specimen, 0.3, element, fault));
  for (int i = 0; i < n * n; i++) {
    largest = fmax(largest, fabs(element[i]));
    off = fmax(off, fabs(element[i] - network[i]));
  }
  *value = off / largest;
  return CDEM_OK;
}

cdem_status cdem_springs_measure_assembly(int parameter, double *value, cdem_fault *fault) {
  cdem_specimen specimen = {0};
  double *k;
  CDEM_NEW(k, 2 * DOFS * DOFS, fault);
  cdem_status status = init_distorted(parameter, 7, &specimen, fault);
  if (status == CDEM_OK)
    status = assembly_difference(&specimen, k, k + DOFS * DOFS, value, fault);
  cdem_specimen_release(&specimen);
  free(k);
  return status;
}

/* Largest |sum_j K_ij T_ij| over the sum of |K_ij|. */
static double transport_residual(const cdem_specimen *specimen, const double *k) {
  int size = specimen->family.size, nodes = cdem_element_nodes(specimen->options.element);
  int n = size * nodes;
  double worst = 0.0;
  for (int a = 0; a < nodes; a++) {
    double sum[9] = {0}, total = 0.0;
    for (int b = 0; b < nodes; b++) {
      double t[9];
      transport(specimen, a, b, t);
      for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++)
          for (int m = 0; m < size; m++) {
            double part = k[(size * a + i) * n + size * b + m] * t[size * m + j];
            sum[size * i + j] += part;
            total += fabs(part);
          }
    }
    worst = fmax(worst, cdem_frobenius(sum, size * size) / total);
  }
  return worst;
}

cdem_status cdem_springs_measure_transport(int parameter, double *value, cdem_fault *fault) {
  cdem_specimen specimen = {0};
  double *k;
  CDEM_NEW(k, DOFS * DOFS, fault);
  cdem_status status = init_distorted(parameter, 8, &specimen, fault);
  if (status == CDEM_OK)
    status = stiffness_of(&specimen, 0.3, k, fault);
  if (status == CDEM_OK)
    *value = transport_residual(&specimen, k);
  cdem_specimen_release(&specimen);
  free(k);
  return status;
}

/* Exchanging the nodes transposes the block: S_ij of the reference stiffness against S_ji. */
cdem_status cdem_springs_measure_skew_exchange(int parameter, double *value, cdem_fault *fault) {
  cdem_specimen specimen = {0};
  double *k;
  CDEM_NEW(k, DOFS * DOFS, fault);
  cdem_status status = init_distorted(parameter, 9, &specimen, fault);
  if (status == CDEM_OK)
    status = stiffness_of(&specimen, 0.3, k, fault);
  *value = 0.0;
  for (int p = 0; status == CDEM_OK && p < cdem_element_pairs(specimen.options.element); p++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(&specimen, p);
    int size = specimen.family.size, n = size * cdem_element_nodes(specimen.options.element);
    double s[2][9];
    for (int way = 0; way < 2; way++)
      for (int i = 0; i < size * size; i++)
        s[way][i] =
            -k[(size * pair.node[way] + i / size) * n + size * pair.node[1 - way] + i % size];
    *value = fmax(*value, fabs(cdem_springs_skew(s[0], size) - cdem_springs_skew(s[1], size)));
  }
  cdem_specimen_release(&specimen);
  free(k);
  return status;
}

/* ---- depletion: one cube, E = L = 1, without the first pair of a class ---- */

static cdem_status depleted_cube(int class_, double nu, double k[24 * 24], cdem_specimen *cube,
                                 cdem_fault *fault) {
  cdem_specimen_options options = {.element = cdem_element_find("hex8")};
  int pair = 0;
  CDEM_TRY(cdem_specimen_init(&options, cube, fault));
  while ((int)cdem_specimen_pair_at(cube, pair).class_ != class_)
    pair++;
  return put_together(cube, nu, pair, k, fault);
}

cdem_status cdem_springs_measure_depletion_lowest(int parameter, double *value, cdem_fault *fault) {
  static const double nu[] = {0.25, 0.2, 0.3};
  double k[24 * 24], symmetric[24 * 24], eigenvalue[24];
  cdem_specimen cube = {0};
  cdem_status status = depleted_cube(parameter / 10, nu[parameter % 10], k, &cube, fault);
  cdem_specimen_release(&cube);
  CDEM_TRY(status);
  for (int i = 0; i < 24 * 24; i++)
    symmetric[i] = 0.5 * (k[i] + k[24 * (i % 24) + i / 24]);
  CDEM_REQUIRE(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', 24, symmetric, 24, eigenvalue) == 0, fault,
               CDEM_NUMERIC, "eigenvalues of the depleted cube were not found");
  *value = eigenvalue[0];
  return CDEM_OK;
}

cdem_status cdem_springs_measure_depletion_negative(int parameter, double *value,
                                                    cdem_fault *fault) {
  CDEM_TRY(cdem_springs_measure_depletion_lowest(parameter, value, fault));
  *value = *value < -1e-10 ? 1.0 : 0.0;
  return CDEM_OK;
}

/* Rank of the forces that the three rotations about the centre meet. */
cdem_status cdem_springs_measure_depletion_rotations(int parameter, double *value,
                                                     cdem_fault *fault) {
  double k[24 * 24], force[24 * 3] = {0}, singular[3], work[3];
  cdem_specimen cube = {0};
  cdem_status status = depleted_cube(parameter, 0.25, k, &cube, fault);
  for (int axis = 0; axis < 3 && status == CDEM_OK; axis++)
    for (int j = 0; j < 24; j++) {
      double arm[3], turn[3] = {0}, moved[3];
      for (int d = 0; d < 3; d++)
        arm[d] = cube.xyz[j / 3][d] - 0.5;
      turn[axis] = 1.0;
      cdem_cross3(turn, arm, moved);
      for (int i = 0; i < 24; i++)
        force[3 * i + axis] += k[24 * i + j] * moved[j % 3];
    }
  cdem_specimen_release(&cube);
  CDEM_TRY(status);
  CDEM_REQUIRE(LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'N', 24, 3, force, 3, singular, NULL, 1, NULL,
                              1, work) == 0,
               fault, CDEM_NUMERIC, "singular values of the rotations' forces were not found");
  *value = 0.0;
  for (int i = 0; i < 3; i++)
    *value += singular[i] > 1e-10;
  return CDEM_OK;
}

/* ---- a mesh whose elements all differ ---- */

static cdem_status certify_grid(cdem_mesh *mesh, cdem_model *model, cdem_certifier **certifier,
                                cdem_certificate *certificate, cdem_fault *fault) {
  const cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_HEX8,
                                       .count = {4, 4, 4},
                                       .size = {1.0, 1.0, 1.0},
                                       .distortion = 0.25,
                                       .seed = 4};
  const cdem_material material = cdem_material_isotropic(1.0, 0.3);
  const cdem_model_options options = {
      .mesh = mesh, .materials = 1, .material = &material, .section = {CDEM_PLANE_STRAIN, 1.0}};
  const cdem_convert_options convert = {.frame = CDEM_FRAME_BODY};
  CDEM_TRY(cdem_mesh_grid(&grid, mesh, fault));
  CDEM_TRY(cdem_model_init(&options, model, fault));
  CDEM_TRY(cdem_certifier_create(model, certifier, fault));
  cdem_pair_sink sink = cdem_certifier_sink(*certifier);
  CDEM_TRY(cdem_network_convert(model, &convert, &sink, 1, fault));
  return cdem_certifier_finish(*certifier, 1000, NULL, certificate, fault);
}

cdem_status cdem_springs_measure_grid(int parameter, double *value, cdem_fault *fault) {
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_certifier *certifier = NULL;
  cdem_certificate c = {0};
  cdem_status status = certify_grid(&mesh, &model, &certifier, &c, fault);
  cdem_certifier_destroy(&certifier);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  CDEM_TRY(status);
  const double number[] = {c.rebuild.value, c.translation.value,  c.assembled,
                           c.patch,         (double)c.zero_modes, (double)c.negative_modes};
  *value = number[parameter];
  return CDEM_OK;
}
