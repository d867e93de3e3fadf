/* Springs as HDF5: read back by HDF5's own driver, the spring tensor from the file alone. */
#include "base/version.h"
#include "io/support.h"

#include <hdf5.h>

typedef struct {
  hid_t file;
  int64_t pairs, extras;
  int size;
  double *stiffness, *coupling, *dir[3], *dual[3], *cond;
  uint8_t *couples_to, *form, *class_, *kind;
  int64_t *element, *node_i, *node_j;
  int64_t *x_pair;
  uint8_t *x_spring, *x_couples_to;
  double *x_stiffness, *x_coupling, *x_dir[3], *x_dual[3];
} springs_file;

/* A whole dataset, and its number of rows. */
static void *load(hid_t file, const char *name, hid_t type, size_t bytes, int columns,
                  int64_t *rows) {
  hsize_t extent[2] = {0, 1};
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0)
    fail_msg("no dataset %s", name);
  hid_t space = H5Dget_space(set);
  assert_int_equal(H5Sget_simple_extent_ndims(space), columns > 1 ? 2 : 1);
  H5Sget_simple_extent_dims(space, extent, NULL);
  assert_int_equal(extent[1], columns);
  void *data = calloc(extent[0] * (size_t)columns + 1, bytes);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  if (*rows >= 0)
    assert_int_equal(extent[0], *rows);
  *rows = (int64_t)extent[0];
  H5Sclose(space);
  H5Dclose(set);
  return data;
}

static void *reals(springs_file *f, const char *name, int columns, int64_t *rows) {
  return load(f->file, name, H5T_NATIVE_DOUBLE, 8, columns, rows);
}
static void *tags(springs_file *f, const char *name, int64_t *rows) {
  return load(f->file, name, H5T_NATIVE_INT64, 8, 1, rows);
}
static void *codes(springs_file *f, const char *name, int columns, int64_t *rows) {
  return load(f->file, name, H5T_NATIVE_UINT8, 1, columns, rows);
}

static void load_springs(const char *path, const char *third, springs_file *f) {
  char name[64];
  const char *const axis[] = {"x", "y", third};
  memset(f, 0, sizeof *f);
  f->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(f->file >= 0);
  f->size = third != NULL ? 3 : 2;
  f->pairs = f->extras = -1;
  f->element = tags(f, "/springs/element", &f->pairs);
  f->node_i = tags(f, "/springs/node_i", &f->pairs);
  f->node_j = tags(f, "/springs/node_j", &f->pairs);
  f->cond = reals(f, "/springs/cond", 1, &f->pairs);
  f->kind = codes(f, "/springs/kind", 1, &f->pairs);
  f->class_ = codes(f, "/springs/class", 1, &f->pairs);
  f->form = codes(f, "/springs/form", 1, &f->pairs);
  f->stiffness = reals(f, "/springs/stiffness", f->size, &f->pairs);
  f->coupling = reals(f, "/springs/coupling", f->size, &f->pairs);
  f->couples_to = codes(f, "/springs/couples_to", f->size, &f->pairs);
  f->x_pair = tags(f, "/extra/pair", &f->extras);
  f->x_spring = codes(f, "/extra/spring", 1, &f->extras);
  f->x_couples_to = codes(f, "/extra/couples_to", 1, &f->extras);
  f->x_stiffness = reals(f, "/extra/stiffness", 1, &f->extras);
  f->x_coupling = reals(f, "/extra/coupling", 1, &f->extras);
  for (int a = 0; a < f->size; a++) {
    snprintf(name, sizeof name, "/springs/dir_%s", axis[a]);
    f->dir[a] = reals(f, name, f->size, &f->pairs);
    snprintf(name, sizeof name, "/springs/dual_%s", axis[a]);
    f->dual[a] = reals(f, name, f->size, &f->pairs);
    snprintf(name, sizeof name, "/extra/dir_%s", axis[a]);
    f->x_dir[a] = reals(f, name, 1, &f->extras);
    snprintf(name, sizeof name, "/extra/dual_%s", axis[a]);
    f->x_dual[a] = reals(f, name, 1, &f->extras);
  }
}

static void unload_springs(springs_file *f) {
  void *all[] = {f->element, f->node_i,   f->node_j,       f->cond,        f->kind,
                 f->class_,  f->form,     f->stiffness,    f->coupling,    f->couples_to,
                 f->x_pair,  f->x_spring, f->x_couples_to, f->x_stiffness, f->x_coupling};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
    free(all[i]);
  for (int a = 0; a < 3; a++) {
    free(f->dir[a]);
    free(f->dual[a]);
    free(f->x_dir[a]);
    free(f->x_dual[a]);
  }
  H5Fclose(f->file);
}

/* All rows of one pair, slots first; *x walks through the extra rows. */
static int rows_of(const springs_file *f, int64_t pair, int64_t *x, cdem_spring_row *row) {
  int rows = 0;
  for (; rows < f->size; rows++) {
    int64_t at = pair * f->size + rows;
    row[rows] = (cdem_spring_row){.stiffness = f->stiffness[at],
                                  .coupling = f->coupling[at],
                                  .spring = (int8_t)(rows + 1),
                                  .couples_to = (int8_t)f->couples_to[at]};
    for (int a = 0; a < f->size; a++) {
      row[rows].dir[a] = f->dir[a][at];
      row[rows].dual[a] = f->dual[a][at];
    }
  }
  for (; *x < f->extras && f->x_pair[*x] == pair; ++*x, rows++) {
    row[rows] = (cdem_spring_row){.stiffness = f->x_stiffness[*x],
                                  .coupling = f->x_coupling[*x],
                                  .spring = (int8_t)f->x_spring[*x],
                                  .couples_to = (int8_t)f->x_couples_to[*x]};
    for (int a = 0; a < f->size; a++) {
      row[rows].dir[a] = f->x_dir[a][*x];
      row[rows].dual[a] = f->x_dual[a][*x];
    }
  }
  return rows;
}

/* Doubles are stored as they are: tensors agree to the last bit. */
static void round_trip(const char *element, const char *third, int each, int times) {
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, element);
  hand.model.pairs *= times; /* what the writer is told to expect */
  int64_t pairs = hand.model.pairs, x = 0;
  const cdem_springs_format *format = cdem_springs_format_of("a.h5");
  cdem_springs_writer *writer;
  check_ok(format->open(in_scratch("s.h5"), &hand.model, &writer, &fault));
  hand.model.pairs /= times;
  check_ok(hand_feed(&hand, writer, each, times, &fault));
  check_ok(writer->commit(writer, &fault));
  cdem_springs_writer_destroy(&writer);

  springs_file f;
  load_springs(in_scratch("s.h5"), third, &f);
  assert_int_equal(f.pairs, pairs);
  assert_int_equal(f.extras, (hand.rows - hand.model.pairs * f.size) * times);
  for (int64_t p = 0; p < pairs; p++) {
    const cdem_pair *pair = &hand.pair[p % hand.model.pairs];
    cdem_spring_row row[CDEM_SPRING_ROWS + 1];
    double rebuilt[9], expected[9];
    int rows = rows_of(&f, p, &x, row);
    assert_int_equal(rows, pair->set.rows);
    rows_to_block(row, rows, f.size, rebuilt);
    rows_to_block(pair->set.row, rows, f.size, expected);
    assert_memory_equal(rebuilt, expected, sizeof(double) * (size_t)(f.size * f.size));
    assert_int_equal(f.element[p], 4711);
    assert_int_equal(f.node_i[p], hand.mesh.node_tag[pair->node[0]]);
    assert_int_equal(f.node_j[p], hand.mesh.node_tag[pair->node[1]]);
    assert_int_equal(f.form[p], pair->set.form);
    assert_int_equal(f.class_[p], pair->class_);
    assert_int_equal(f.kind[p], 0);
    if (pair->set.form == CDEM_FORM_FRAME)
      assert_true(isnan(f.cond[p]));
    else
      assert_true(f.cond[p] == pair->set.cond);
  }
  assert_int_equal(x, f.extras);
  unload_springs(&f);
  unlink(in_scratch("s.h5"));
  hand_network_release(&hand);
}

static void solids(void **state) {
  (void)state;
  round_trip("hex8", "z", 28, 1);
  round_trip("hex8", "z", 5, 3);
}

static void plane_elements(void **state) {
  (void)state;
  round_trip("quad4", NULL, 4, 2);
}

static void cosserat_elements(void **state) {
  (void)state;
  round_trip("quad4-cosserat", "rz", 6, 1);
}

/* More pairs than a stage holds, so that several HDF5 chunks and the seam between them are there.
 */
static void many_pairs(void **state) {
  (void)state;
  round_trip("hex8", "z", 27, 2500);
}

static char *text_attribute(hid_t file, const char *object, const char *name, int index) {
  hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(attribute >= 0);
  hid_t space = H5Aget_space(attribute), type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  char *text[16] = {NULL};
  assert_true(H5Sget_simple_extent_npoints(space) <= 16);
  assert_true(H5Aread(attribute, type, text) >= 0);
  char *kept = text[index] != NULL ? strdup(text[index]) : NULL;
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, text);
  H5Tclose(type);
  H5Sclose(space);
  H5Aclose(attribute);
  return kept;
}

static void check_text(hid_t file, const char *object, const char *name, int index,
                       const char *expected) {
  char *text = text_attribute(file, object, name, index);
  assert_non_null(text);
  if (strstr(text, expected) == NULL)
    fail_msg("%s of %s is '%s'", name, object, text);
  free(text);
}

static void the_file_explains_itself(void **state) {
  (void)state;
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, "quad4-cosserat");
  hand.mesh.source = strdup("sand.msh");
  check_ok(hand_write(&hand, cdem_springs_format_find("h5"), in_scratch("a.h5"), 6, 1, &fault));
  hid_t file = H5Fopen(in_scratch("a.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
  check_text(file, "/", "format", 0, "cdem springs");
  check_text(file, "/", "program", 0, cdem_version());
  check_text(file, "/", "mesh", 0, "sand.msh");
  check_text(file, "/", "material", 0, "isotropic, young = 40000000000 Pa, poisson = 0.25");
  check_text(file, "/", "formula", 0, "coupling * dual[couples_to]");
  check_text(file, "/", "plane", 0, "strain");
  check_text(file, "/springs/kind", "names", 0, "quad4-cosserat");
  for (int c = 0; c < CDEM_CLASS_COUNT; c++)
    check_text(file, "/springs/class", "names", c, cdem_class_name((cdem_class)c));
  for (int c = 0; c < CDEM_FORM_COUNT; c++)
    check_text(file, "/springs/form", "names", c, cdem_form_name((cdem_form)c));
  double length = 0.0;
  hid_t attribute = H5Aopen(file, "length", H5P_DEFAULT);
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &length);
  H5Aclose(attribute);
  assert_true(length == 0.125);
  int64_t nodes = -1;
  double *xyz = load(file, "/nodes/xyz", H5T_NATIVE_DOUBLE, 8, 3, &nodes);
  int64_t *tag = load(file, "/nodes/tag", H5T_NATIVE_INT64, 8, 1, &nodes);
  assert_int_equal(nodes, 4);
  assert_memory_equal(xyz, hand.mesh.xyz, 12 * sizeof *xyz);
  assert_memory_equal(tag, hand.mesh.node_tag, 4 * sizeof *tag);
  free(xyz);
  free(tag);
  assert_true(H5Lexists(file, "/springs/dir_z", H5P_DEFAULT) <= 0);
  H5Fclose(file);
  hand_network_release(&hand);
}

/* Writing must not leave HDF5's own error reports switched off for the rest of the program, nor
 * say anything by itself. */
static void error_reports_stay_as_they_were(void **state) {
  (void)state;
  cdem_fault fault = {0};
  hand_network hand;
  hand_network_init(&hand, "hex8");
  H5E_auto2_t before, after;
  void *data;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  check_ok(hand_write(&hand, cdem_springs_format_find("h5"), in_scratch("e.h5"), 28, 1, &fault));
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  assert_true(before == after);
  hand_network_release(&hand);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solids),
      cmocka_unit_test(plane_elements),
      cmocka_unit_test(cosserat_elements),
      cmocka_unit_test(many_pairs),
      cmocka_unit_test(the_file_explains_itself),
      cmocka_unit_test(error_reports_stay_as_they_were),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
