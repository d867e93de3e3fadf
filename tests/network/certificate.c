/* The certificate passes for every element of the table and fails when the network is not the body.
 */
#include "network/certificate.h"

#include "network/spectrum.h"
#include "network/support.h"

#include <lapacke.h>

static void certify(const cdem_model *model, cdem_pair_sink (*wrap)(cdem_pair_sink *),
                    cdem_certificate *certificate) {
  cdem_fault fault = {0};
  cdem_certifier *certifier = NULL;
  check_ok(cdem_certifier_create(model, &certifier, &fault));
  cdem_pair_sink inner = cdem_certifier_sink(certifier), sink = wrap != NULL ? wrap(&inner) : inner;
  cdem_convert_options options = {.frame = CDEM_FRAME_BODY, .threads = 1};
  check_ok(cdem_network_convert(model, &options, &sink, 1, &fault));
  check_ok(cdem_certifier_finish(certifier, 30000, NULL, certificate, &fault));
  cdem_certifier_destroy(&certifier);
}

static void every_element_is_certified(void **state) {
  (void)state;
  for (int e = 0; e < CDEM_ELEMENT_COUNT; e++) {
    const cdem_element *element = cdem_element_get(e);
    cdem_mesh mesh = {0};
    cdem_model model = {0};
    cdem_certificate c;
    make_grid(element, 3, 0.15, &mesh);
    cdem_material material = make_material(element);
    make_model(&mesh, &material, &model);
    certify(&model, NULL, &c);
    if (!cdem_certificate_holds(&c))
      fail_msg("%s: rebuild %.2e translation %.2e rotation %.2e assembled %.2e patch %.2e zero "
               "modes %lld of %lld, "
               "negative %lld",
               element->name, c.rebuild.value, c.translation.value, c.rotation.value, c.assembled,
               c.patch, (long long)c.zero_modes, (long long)c.rigid_modes,
               (long long)c.negative_modes);
    assert_int_equal(c.pairs, model.pairs);
    assert_int_equal(c.elements, model.cells);
    assert_int_equal(c.components, 1);
    assert_true(c.patch_nodes > 0);
    cdem_model_release(&model);
    cdem_mesh_release(&mesh);
  }
}

/* Feeds the certifier a network whose pair number 100 is a thousandth too stiff. */
static cdem_pair_sink *inner_sink;
static int64_t seen;

static cdem_status tampered_encode(void *context, const cdem_chunk *chunk, cdem_buffer *buffer,
                                   cdem_fault *fault) {
  (void)context;
  for (int64_t p = 0; p < chunk->pairs; p++)
    if (seen++ == 100)
      ((cdem_pair *)chunk->pair)[p].set.row[0].stiffness *= 1.001;
  return inner_sink->encode(inner_sink->context, chunk, buffer, fault);
}

static cdem_pair_sink tamper(cdem_pair_sink *inner) {
  inner_sink = inner;
  seen = 0;
  return (cdem_pair_sink){
      .context = inner->context, .encode = tampered_encode, .write = inner->write};
}

static void a_wrong_spring_is_found(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_certificate c;
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 3, 0.15, &mesh);
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  certify(&model, tamper, &c);
  assert_false(cdem_certificate_holds(&c));
  assert_true(c.rebuild.value > 1e-5);
  assert_true(c.assembled > 1e-6);
  assert_int_equal(c.rebuild.element, mesh.cell_tag[model.cell[100 / 28]]);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

/* Two cubes that share an edge only turn about it: one zero mode more than the six of one part. */
static void a_hinge_is_found(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double xyz[14][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1},
                       {0, 1, 1}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}};
  const int32_t node[2][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {2, 8, 9, 10, 6, 11, 12, 13}};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_certificate c;
  check_ok(cdem_mesh_add_nodes(&mesh, 14, &xyz[0][0], NULL, &fault));
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_HEX8, 2, &node[0][0], NULL, &fault));
  cdem_material material = cdem_material_isotropic(1e9, 0.2);
  make_model(&mesh, &material, &model);
  certify(&model, NULL, &c);
  assert_int_equal(c.rigid_modes, 6);
  assert_int_equal(c.zero_modes, 7);
  assert_false(cdem_certificate_holds(&c));
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

static void sparse_spectrum_is_the_dense_one(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_sparse sparse = {0};
  cdem_spectrum *spectrum = NULL;
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 4, 0.2, &mesh); /* 375 rows: beyond the dense shortcut */
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  check_ok(cdem_sparse_init(&model, &sparse, &fault));
  check_ok(cdem_sparse_add_elements(&model, 1.0, &sparse, NULL, &fault));
  int rows = sparse.nodes * 3;
  double *dense = cdem_allocate((int64_t)rows * rows, sizeof *dense, NULL);
  double *truth = cdem_allocate(rows, sizeof *truth, NULL), lowest[9];
  for (int32_t n = 0; n < sparse.nodes; n++)
    for (int64_t k = sparse.start[n]; k < sparse.start[n + 1]; k++)
      for (int e = 0; e < 9; e++)
        dense[(int64_t)(3 * n + e / 3) * rows + 3 * sparse.column[k] + e % 3] =
            sparse.value[9 * k + e];
  assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', rows, dense, rows, truth), 0);
  check_ok(cdem_spectrum_create(&sparse, false, &spectrum, &fault));
  check_ok(cdem_spectrum_lowest(spectrum, 9, lowest, &fault));
  for (int i = 0; i < 9; i++)
    check_near(lowest[i], truth[i], 1e-9, 1e-13 * truth[rows - 1]); /* backward error of both */
  for (int i = 10; i < rows; i += 41) {
    int64_t below;
    check_ok(cdem_spectrum_below(spectrum, (truth[i - 1] + truth[i]) / 2.0, &below, &fault));
    assert_int_equal(below, i);
  }
  assert_true(cdem_spectrum_norm(spectrum) >= truth[rows - 1]);
  cdem_spectrum_destroy(&spectrum);
  free(dense);
  free(truth);
  cdem_sparse_release(&sparse);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_element_is_certified),
      cmocka_unit_test(a_wrong_spring_is_found),
      cmocka_unit_test(a_hinge_is_found),
      cmocka_unit_test(sparse_spectrum_is_the_dense_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
