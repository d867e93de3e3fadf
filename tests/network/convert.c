/* Conversion: what comes out is the finite element, for every element of the table, on any number
 * of threads. */
#include "network/assemble.h"
#include "network/support.h"

/* Every pair against the reference B^T D B of its own element. */
typedef struct {
  double worst;
  int64_t pairs;
  double *k;
} comparison;

static cdem_status compare(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                           cdem_fault *fault) {
  (void)buffer;
  comparison *c = context;
  const cdem_model *model = chunk->model;
  int d = model->dofs;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    const cdem_pair *pair = &chunk->pair[p];
    int nodes = cdem_element_nodes(cdem_model_element(model, pair->index));
    double xyz[CDEM_SHAPE_MAX_NODES][3], s[9], largest = 0.0;
    cdem_model_coordinates(model, pair->index, xyz);
    CDEM_TRY(cdem_element_stiffness(&model->kinds_of[model->kind[pair->index]].tabulation,
                                    &model->materials_of[model->material[pair->index]],
                                    &model->section, xyz, c->k, fault));
    for (int i = 0; i < nodes * d * nodes * d; i++)
      largest = fmax(largest, fabs(c->k[i]));
    cdem_springs_rebuild(&pair->set, s);
    for (int a = 0; a < d; a++)
      for (int b = 0; b < d; b++)
        c->worst = fmax(c->worst,
                        fabs(s[a * d + b] +
                             c->k[(pair->local[0] * d + a) * nodes * d + pair->local[1] * d + b]) /
                            largest);
    assert_true(pair->local[0] < pair->local[1]);
  }
  c->pairs += chunk->pairs;
  return CDEM_OK;
}

static void every_element_gives_its_blocks(void **state) {
  (void)state;
  cdem_fault fault = {0};
  comparison c = {.k = cdem_allocate(60 * 60, sizeof(double), NULL)};
  for (int e = 0; e < CDEM_ELEMENT_COUNT; e++) {
    const cdem_element *element = cdem_element_get(e);
    cdem_mesh mesh = {0};
    cdem_model model = {0};
    make_grid(element, 2, 0.2, &mesh);
    cdem_material material = make_material(element);
    make_model(&mesh, &material, &model);
    cdem_pair_sink sink = {.context = &c, .write = compare};
    cdem_convert_options options = {.frame = CDEM_FRAME_BODY};
    c.worst = 0.0;
    c.pairs = 0;
    check_ok(cdem_network_convert(&model, &options, &sink, 1, &fault));
    check_below(c.worst, 1e-13); /* two quadratures of some ten points each: tens of roundings */
    assert_int_equal(c.pairs, model.pairs);
    assert_string_equal(cdem_model_element(&model, 0)->name, element->name);
    cdem_model_release(&model);
    cdem_mesh_release(&mesh);
  }
  free(c.k);
}

/* An order-dependent hash (FNV-1a) of everything in the pairs. */
static cdem_status hash_pairs(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                              cdem_fault *fault) {
  (void)buffer, (void)fault;
  uint64_t *hash = context;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    const cdem_pair *pair = &chunk->pair[p];
    double number[CDEM_SPRING_ROWS * 8 + 2] = {
        pair->index * 1e6 + pair->local[0] * 32 + pair->local[1], pair->set.cond};
    for (int r = 0; r < pair->set.rows && r < CDEM_SPRING_ROWS; r++) {
      double *at = number + 2 + 8 * r;
      at[0] = pair->set.row[r].stiffness;
      at[1] = pair->set.row[r].coupling;
      memcpy(at + 2, pair->set.row[r].dir, 3 * sizeof *at);
      memcpy(at + 5, pair->set.row[r].dual, 3 * sizeof *at);
    }
    unsigned char bytes[sizeof number];
    memcpy(bytes, number, sizeof bytes);
    for (size_t i = 0; i < sizeof bytes; i++)
      *hash = (*hash ^ bytes[i]) * 1099511628211u;
  }
  return CDEM_OK;
}

static uint64_t hash_of(const cdem_model *model, int threads) {
  cdem_fault fault = {0};
  uint64_t hash = 14695981039346656037u;
  cdem_pair_sink sink = {.context = &hash, .write = hash_pairs};
  cdem_convert_options options = {.threads = threads};
  check_ok(cdem_network_convert(model, &options, &sink, 1, &fault));
  return hash;
}

static void threads_do_not_change_a_bit(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 11, 0.2, &mesh);
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  uint64_t one = hash_of(&model, 1);
  assert_true(one == hash_of(&model, 2));
  assert_true(one == hash_of(&model, 4));
  assert_true(one == hash_of(&model, 7));
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

static cdem_status count_classes(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                                 cdem_fault *fault) {
  (void)buffer, (void)fault;
  int64_t(*count)[CDEM_FORM_COUNT] = context;
  for (int64_t p = 0; p < chunk->pairs; p++)
    count[chunk->pair[p].class_][chunk->pair[p].set.form]++;
  return CDEM_OK;
}

static void filters_and_frames(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_mesh_grid_options cubes = {
      .shape = CDEM_SHAPE_HEX8, .count = {3, 3, 3}, .size = {3.0, 3.0, 3.0}};
  check_ok(cdem_mesh_grid(&cubes, &mesh, &fault));
  cdem_material material = cdem_material_isotropic(1.0, 0.3);
  make_model(&mesh, &material, &model);
  int64_t count[CDEM_CLASS_COUNT][CDEM_FORM_COUNT] = {{0}};
  cdem_pair_sink sink = {.context = count, .write = count_classes};
  cdem_convert_options all = {.frame = CDEM_FRAME_BODY};
  check_ok(cdem_network_convert(&model, &all, &sink, 1, &fault));
  assert_int_equal(count[CDEM_CLASS_EDGE][CDEM_FORM_DIAGONAL], 27 * 12);
  assert_int_equal(count[CDEM_CLASS_FACE][CDEM_FORM_DIAGONAL], 27 * 12);
  assert_int_equal(count[CDEM_CLASS_BODY][CDEM_FORM_FRAME], 27 * 4);
  memset(count, 0, sizeof count);
  cdem_convert_options some = {.frame = CDEM_FRAME_NONE,
                               .class_mask = 1u << CDEM_CLASS_BODY | 1u << CDEM_CLASS_EDGE,
                               .form_mask = 1u << CDEM_FORM_DIAGONAL};
  check_ok(cdem_network_convert(&model, &some, &sink, 1, &fault));
  assert_int_equal(count[CDEM_CLASS_EDGE][CDEM_FORM_DIAGONAL], 27 * 12);
  assert_int_equal(count[CDEM_CLASS_FACE][CDEM_FORM_DIAGONAL], 0);
  assert_int_equal(count[CDEM_CLASS_BODY][CDEM_FORM_DIAGONAL], 27 * 4);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

static void the_lapack_path_gives_the_same_network(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_sparse fast = {0}, slow = {0};
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 3, 0.2, &mesh);
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  check_ok(cdem_sparse_init(&model, &fast, &fault));
  check_ok(cdem_sparse_init(&model, &slow, &fault));
  cdem_convert_options options = {0}, reference = {.reference = true};
  cdem_pair_sink sink = cdem_sparse_sink(&fast);
  check_ok(cdem_network_convert(&model, &options, &sink, 1, &fault));
  sink = cdem_sparse_sink(&slow);
  check_ok(cdem_network_convert(&model, &reference, &sink, 1, &fault));
  double largest = cdem_sparse_largest(&slow);
  for (int64_t i = 0; i < fast.start[fast.nodes] * 9; i++)
    check_near(fast.value[i], slow.value[i], 0, 1e-12 * largest);
  cdem_sparse_release(&fast);
  cdem_sparse_release(&slow);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

static bool stop_at_once(void *context, const char *what, int64_t done, int64_t total) {
  (void)context, (void)what, (void)done, (void)total;
  return false;
}

static cdem_status refuse(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                          cdem_fault *fault) {
  (void)buffer;
  int64_t *pairs = context;
  *pairs += chunk->pairs;
  return cdem_fail(fault, CDEM_FILE, "the disk is full");
}

static cdem_status count_nothing(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                                 cdem_fault *fault) {
  (void)context, (void)chunk, (void)buffer, (void)fault;
  return CDEM_OK;
}

static void failures_and_interrupts_stop_the_stream(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  const cdem_element *element = cdem_element_find("hex8");
  make_grid(element, 8, 0.2, &mesh);
  cdem_material material = make_material(element);
  make_model(&mesh, &material, &model);
  int64_t pairs = 0;
  cdem_pair_sink sink = {.context = &pairs, .write = refuse};
  cdem_progress progress = {.report = stop_at_once};
  cdem_convert_options options = {.threads = 3};
  check_fails(cdem_network_convert(&model, &options, &sink, 1, &fault), CDEM_FILE, "disk is full");
  assert_true(pairs > 0 && pairs < model.pairs / 2); /* only the first chunk reached the sink */
  options.progress = &progress;
  check_fails(cdem_network_convert(&model, &options, &sink, 0, &fault), CDEM_INTERRUPTED,
              "converting");
  options.threads = 1; /* with more, one thread without memory leaves the work to the others */
  options.progress = NULL;
  sink.write = count_nothing;
  cdem_memory_fail_after(0);
  check_fails(cdem_network_convert(&model, &options, &sink, 1, &fault), CDEM_MEMORY,
              "out of memory");
  cdem_memory_fail_after(-1);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_element_gives_its_blocks),
      cmocka_unit_test(threads_do_not_change_a_bit),
      cmocka_unit_test(filters_and_frames),
      cmocka_unit_test(the_lapack_path_gives_the_same_network),
      cmocka_unit_test(failures_and_interrupts_stop_the_stream),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
