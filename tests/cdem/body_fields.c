/* Fields, frequency bound and row sums of the elastic body. */
#include "cdem/body.h"
#include "cdem/body_support.h"

#include <lapacke.h>

#define EACH_ELEMENT(element)                                                                      \
  for (int id_ = 0; id_ < CDEM_ELEMENT_COUNT; id_++)                                               \
    for (const cdem_element *element = cdem_element_get((cdem_element_id)id_);                     \
         element != NULL && first_order(element); element = NULL)

/* A uniform strain (Voigt, engineering shears), then a turn; z stays out of a plane. */
static void strain_all(const specimen *s, const double e[6], double angle, double *u) {
  const double m[9] = {e[0],     e[5] / 2, e[4] / 2, e[5] / 2, e[1],
                       e[3] / 2, e[4] / 2, e[3] / 2, e[2]};
  const double shift[3] = {1.0, 2.0, 3.0};
  int dofs = s->body.dofs, moving = s->model.dimension;
  double *v = new_vector(s->size);
  for (int32_t n = 0; n < s->body.nodes; n++)
    for (int i = 0; i < moving; i++)
      for (int k = 0; k < moving; k++)
        v[(int64_t)n * dofs + i] += m[3 * i + k] * s->mesh.xyz[3 * (int64_t)n + k];
  turn_all(s, v, angle, shift, u);
  free(v);
}

/* R t R^T, shears halved by `shear` before and restored after. */
static void turned_tensor(const double r[9], const double t[6], double shear, double out[6]) {
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  double m[9];
  for (int e = 0; e < 6; e++)
    m[3 * at[e][0] + at[e][1]] = m[3 * at[e][1] + at[e][0]] = t[e] * (e < 3 ? 1.0 : shear);
  for (int e = 0; e < 6; e++) {
    out[e] = 0.0;
    for (int k = 0; k < 9; k++)
      out[e] += r[3 * at[e][0] + k / 3] * m[k] * r[3 * at[e][1] + k % 3] / (e < 3 ? 1.0 : shear);
  }
}

/* Hooke's law: strain [6], zz completed for plane stress, gives stress [6]. */
static void hooke(bool plane_stress, double young, double poisson, double strain[6],
                  double stress[6]) {
  double mu = young / (2 * (1 + poisson)), lambda = 2 * mu * poisson / (1 - 2 * poisson);
  if (plane_stress)
    strain[2] = -poisson / (1 - poisson) * (strain[0] + strain[1]);
  for (int e = 0; e < 6; e++)
    stress[e] =
        e < 3 ? lambda * (strain[0] + strain[1] + strain[2]) + 2 * mu * strain[e] : mu * strain[e];
}

static double class_sum(const double *energy, int64_t cells, double by_class[CDEM_CLASSES]) {
  double sum = 0.0;
  for (int64_t i = 0; i < CDEM_CLASSES * cells; i++) {
    by_class[i % CDEM_CLASSES] += energy[i];
    sum += energy[i];
  }
  return sum;
}

/* A uniform strain, turned by 2 rad: every cell and node knows stress and strain in closed form,
 * and the energy is half their product; classes add up. */
static void uniform_strain_is_known(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int plane = 0; plane < 2; plane++) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .distortion = 0.2, .plane = (cdem_plane)plane},
                  &s);
    bool solid = s.model.dimension == 3;
    if (solid && plane == 1) {
      specimen_release(&s);
      continue;
    }
    int64_t cells = s.model.cells;
    double strain[6] = {1e-3, -2e-3, 3e-3, 4e-3, -1e-3, 2e-3}, stress[6], r[9], want[6];
    for (int e = 2; e < 5 && !solid; e++)
      strain[e] = 0.0;
    double *u = new_vector(s.size), *cell = new_vector(30 * cells);
    double *node = new_vector(6 * (int64_t)s.body.nodes), by_class[3], sums[3] = {0};
    cdem_body_fields fields = {.stress = cell,
                               .strain = cell + 6 * cells,
                               .rotation = cell + 12 * cells,
                               .energy = cell + 21 * cells,
                               .pair_force = cell + 24 * cells};
    strain_all(&s, strain, 2.0, u);
    cdem_body_cell_fields(&s.body, u, &fields);
    cdem_body_node_stress(&s.body, u, node);
    hooke(plane == 1, 40e9, 0.23, strain, stress);
    rotation_about(s.model.dimension, 2.0, r);
    double energy = 0.0, volume = solid ? 1.3 * 0.9 : 1.3 * 0.7;
    for (int e = 0; e < 6; e++)
      energy += 0.5 * volume * stress[e] * strain[e];
    turned_tensor(r, stress, 1.0, want);
    for (int64_t i = 0; i < 6 * cells; i++)
      check_near(cell[i], want[i % 6], 0.0, 1e-12 * 1e9); /* rounding of E times places */
    for (int64_t i = 0; i < 6 * (int64_t)s.body.nodes; i++)
      check_near(node[i], want[i % 6], 0.0, 1e-11 * 1e9);
    turned_tensor(r, strain, 0.5, want);
    for (int64_t i = 0; i < 6 * cells; i++)
      check_near(fields.strain[i], want[i % 6], 0.0, 1e-13);
    for (int64_t i = 0; i < 9 * cells; i++)
      check_near(fields.rotation[i], r[i % 9], 0.0, 1e-13);
    double whole = cdem_body_energy(&s.body, u, by_class);
    check_near(whole, energy, 1e-11, 0.0);
    check_near(by_class[0] + by_class[1] + by_class[2], whole, 1e-15, 0.0);
    check_near(class_sum(fields.energy, cells, sums), energy, 1e-11, 0.0);
    for (int c = 0; c < 3; c++)
      check_near(by_class[c], sums[c], 1e-11, 1e-11 * energy);
    free(u), free(cell), free(node);
    specimen_release(&s);
  }
}

/* Stress at nodes does not depend on the unit of length: the same field on a mesh of microns. */
static void node_stress_at_any_size(void **state) {
  (void)state;
  cdem_fault fault = {0};
  const double scale[2] = {1.0, 1e-6};
  double stress[2][9 * 6];
  for (int k = 0; k < 2; k++) {
    const recipe how = {.count = 2, .distortion = 0.2, .linear = true};
    specimen s = {.density = 2500.0};
    check_ok(cdem_mesh_grid(&(cdem_mesh_grid_options){.shape = CDEM_SHAPE_QUAD4,
                                                      .count = {2, 2, 0},
                                                      .size = {scale[k], scale[k], 0.0},
                                                      .distortion = how.distortion,
                                                      .seed = 5},
                            &s.mesh, &fault));
    s.material = cdem_material_isotropic(40e9, 0.23);
    specimen_build(&how, &s);
    double u[18];
    for (int n = 0; n < 9; n++) { /* a strain that varies within an element */
      const double *x = s.mesh.xyz + 3 * n;
      u[2 * n] = 1e-3 * x[0] * x[1] / scale[k];
      u[2 * n + 1] = 1e-3 * x[1] * x[1] / scale[k];
    }
    cdem_body_node_stress(&s.body, u, stress[k]);
    specimen_release(&s);
  }
  for (int i = 0; i < 9 * 6; i++)
    check_near(stress[1][i], stress[0][i], 0.0, 1e-10 * 40e6);
}

/* Every third cell gets a material of its own, softer by half, and the body is built anew. */
static void mix_materials(const cdem_element *element, const recipe *how, specimen *s) {
  cdem_fault fault = {0};
  int32_t chosen[64], count = 0;
  for (int32_t i = 0; i < s->model.cells && count < 64; i += 3)
    chosen[count++] = s->model.cell[i];
  const char *const soft[] = {"soft"};
  const int second[] = {1};
  cdem_material material[2] = {rock(element), rock(element)};
  double density[2] = {2700.0, 2700.0};
  material[1].parameter[0] *= 0.5;
  cdem_body_release(&s->body);
  cdem_model_release(&s->model);
  check_ok(cdem_mesh_add_group(&s->mesh, "soft", cdem_element_dimension(element), count, chosen,
                               &fault));
  cdem_model_options options = {.mesh = &s->mesh,
                                .materials = 2,
                                .material = material,
                                .assignments = 1,
                                .assigned_group = soft,
                                .assigned_material = second,
                                .section = {how->plane, 0.7}};
  check_ok(cdem_model_init(&options, &s->model, &fault));
  cdem_body_options body = {
      .density = density, .linear = how->linear, .separate = how->separate, .threads = 2};
  check_ok(cdem_body_init(&s->model, &body, &s->body, &fault));
}

/* The quick stress is that of the fields: shared and own batches, small and large motions, two
 * materials side by side in a batch. */
static void quick_stress_is_the_same(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int kind = 0; kind < 8; kind++) {
    recipe how = {.count = 2,
                  .distortion = kind & 1 ? 0.2 : 0.0,
                  .linear = kind & 2,
                  .separate = kind & 1,
                  .plane = kind & 4 ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN};
    specimen s;
    specimen_make(element, &how, &s);
    if (s.model.dimension == 2 || kind < 4) {
      mix_materials(element, &how, &s);
      int64_t size = 6 * (int64_t)s.model.cells;
      double *v = new_vector(s.size), *u = new_vector(s.size), *quick = new_vector(size);
      double *slow = new_vector(size);
      const double shift[3] = {0.3, -0.2, 0.1};
      shake(&s, 0.02, 5, v);
      turn_all(&s, v, how.linear ? 0.0 : 2.5, shift, u);
      cdem_body_fields fields = {.stress = slow};
      cdem_body_cell_fields(&s.body, u, &fields);
      cdem_body_cell_stress(&s.body, u, quick);
      check_below(difference(quick, slow, size), 1e-12 * 40e9); /* rounding of E times places */
      assert_true(largest(slow, size) > 1e6);
      free(v), free(u), free(quick), free(slow);
    }
    specimen_release(&s);
  }
}

/* The force field of a class: two nodes of a bar-like triangle against the springs themselves. For
 * a motion of one node by d the pairs at it carry |S d| each. */
static void pair_forces_are_those_of_springs(void **state) {
  (void)state;
  specimen s;
  specimen_make(cdem_element_find("quad4"), &(recipe){.count = 1, .linear = true}, &s);
  double u[8] = {1e-3}, energy[3], force[3];
  cdem_sparse k = {0};
  cdem_fault fault = {0};
  check_ok(cdem_body_stiffness(&s.body, &k, &fault));
  cdem_body_fields fields = {.energy = energy, .pair_force = force};
  cdem_body_cell_fields(&s.body, u, &fields);
  /* Node 0 of the grid and its neighbours: 1 and 2 along edges, 3 across. */
  double edge = 0.0;
  for (int32_t n = 1; n < 4; n++) {
    const double *block = cdem_sparse_block(&k, 0, n);
    double f = hypot(block[0], block[2]) * 1e-3;
    if (n == 3)
      check_near(force[1], f, 1e-12, 0.0);
    else
      edge += f;
  }
  check_near(force[0], edge, 1e-12, 0.0);
  assert_true(force[2] == 0.0 && energy[2] == 0.0);
  cdem_sparse_release(&k);
  specimen_release(&s);
}

/* Largest eigenfrequency of the whole body by LAPACK. */
static double true_frequency(const specimen *s) {
  cdem_fault fault = {0};
  cdem_sparse k = {0};
  check_ok(cdem_body_stiffness(&s->body, &k, &fault));
  int n = (int)s->size, dofs = s->body.dofs;
  double *a = new_vector((int64_t)n * n), *value = new_vector(n);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double *block = cdem_sparse_block(&k, i / dofs, j / dofs);
      if (block != NULL)
        a[i * n + j] = block[i % dofs * dofs + j % dofs] / sqrt(s->body.mass[i] * s->body.mass[j]);
    }
  assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', n, a, n, value), 0);
  double most = sqrt(value[n - 1]);
  free(a), free(value);
  cdem_sparse_release(&k);
  return most;
}

/* One distorted element: the bound holds and is sharp, 24^(1/256) at most. */
static void one_element(const cdem_element *element, uint64_t seed) {
  cdem_fault fault = {0};
  specimen s = {.density = 2700.0, .material = rock(element)};
  cdem_random random = {seed};
  int nodes = cdem_element_nodes(element);
  int32_t node[CDEM_SHAPE_MAX_NODES];
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  for (int a = 0; a < nodes; a++) {
    node[a] = a;
    for (int c = 0; c < 3; c++)
      xyz[a][c] =
          c < cdem_element_dimension(element)
              ? 0.1 * element->reference[a][c] * (c + 1) + cdem_random_uniform(&random, -0.02, 0.02)
              : 0.0;
  }
  check_ok(cdem_mesh_add_nodes(&s.mesh, nodes, &xyz[0][0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&s.mesh, element->shape, 1, node, NULL, &fault));
  specimen_build(&(recipe){0}, &s);
  int32_t cell;
  double bound = cdem_body_frequency(&s.body, &cell), truth = true_frequency(&s);
  check_below(truth, bound);
  check_below(bound, 1.0125 * truth);
  assert_int_equal(cell, 0);
  specimen_release(&s);
}

static void frequency_is_bounded(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    for (uint64_t seed = 0; seed < 5; seed++)
      one_element(element, seed);
    specimen s;
    specimen_make(element, &(recipe){.count = 2, .distortion = 0.2}, &s);
    double bound = cdem_body_frequency(&s.body, NULL), truth = true_frequency(&s);
    check_below(truth, bound);
    specimen_release(&s);
  }
}

/* The element that limits is the small one; congruent or not is no matter. */
static void frequency_says_where(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double found[2];
  for (int separate = 0; separate < 2; separate++) {
    specimen s = {.density = 2700.0, .material = rock(cdem_element_find("quad4"))};
    const double xyz[8][3] = {{0, 0, 0}, {1, 0, 0}, {1.3, 0, 0}, {2.3, 0, 0},
                              {0, 1, 0}, {1, 1, 0}, {1.3, 1, 0}, {2.3, 1, 0}};
    const int32_t quad[3][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}};
    check_ok(cdem_mesh_add_nodes(&s.mesh, 8, &xyz[0][0], NULL, &fault));
    check_ok(cdem_mesh_add_cells(&s.mesh, CDEM_SHAPE_QUAD4, 3, &quad[0][0], NULL, &fault));
    specimen_build(&(recipe){.separate = separate}, &s);
    int32_t cell = -1;
    found[separate] = cdem_body_frequency(&s.body, &cell);
    assert_int_equal(cell, 1);
    assert_int_equal(s.body.distinct, separate ? 3 : 2);
    specimen_release(&s);
  }
  check_near(found[0], found[1], 1e-12, 0.0);
}

/* With the row sums as masses no eigenvalue exceeds 1 (Gershgorin): relaxation is stable at step 2.
 */
static void row_sums_bound_the_network(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 2, .distortion = 0.2}, &s);
    double *sum = new_vector(s.body.nodes), *couple = new_vector(s.body.nodes);
    cdem_body_row_sums(&s.body, sum, couple);
    for (int64_t i = 0; i < s.size; i++)
      s.body.mass[i] =
          i % s.body.dofs < s.model.dimension ? sum[i / s.body.dofs] : couple[i / s.body.dofs];
    double most = true_frequency(&s);
    check_below(most, 1.0);
    check_below(0.3, most); /* and no wild guess */
    free(sum), free(couple);
    specimen_release(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform_strain_is_known),
      cmocka_unit_test(node_stress_at_any_size),
      cmocka_unit_test(quick_stress_is_the_same),
      cmocka_unit_test(pair_forces_are_those_of_springs),
      cmocka_unit_test(frequency_is_bounded),
      cmocka_unit_test(frequency_says_where),
      cmocka_unit_test(row_sums_bound_the_network),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
