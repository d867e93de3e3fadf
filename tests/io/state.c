/* States in files: every bit survives, and no other file passes for one. */
#include "io/run_files.h"
#include "io/support.h"

#include <hdf5.h>
#include <zlib.h>

enum { LONG = 100000 };

static uint64_t bits_of(double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

/* Numbers that conversion or printing would spoil. */
static void fill_strange(double value[8]) {
  const uint64_t bits[8] = {0x8000000000000000u, 0x7ff8000000000001u, 0xfff80000deadbeefu,
                            0x7ff0000000000001u, 0x0000000000000001u, 0x7ff0000000000000u,
                            0x3fd5555555555555u, 0xffefffffffffffffu};
  memcpy(value, bits, sizeof bits);
}

static void check_same(const cdem_state *a, const cdem_state *b) {
  assert_int_equal(a->arrays, b->arrays);
  for (int64_t i = 0; i < a->arrays; i++) {
    const cdem_array *other = cdem_state_find(b, a->array[i].name);
    assert_non_null(other);
    assert_int_equal(other->type, a->array[i].type);
    assert_int_equal(other->count, a->array[i].count);
    if (other->count > 0)
      assert_memory_equal(other->data, a->array[i].data,
                          (size_t)other->count * cdem_array_size(other->type));
  }
}

static void every_bit_survives(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state = {0}, back;
  double strange[8], *noise = calloc(LONG, sizeof *noise), *zero = calloc(LONG, sizeof *zero);
  int32_t *count = calloc(LONG, sizeof *count);
  cdem_random random = {5};
  fill_strange(strange);
  for (int i = 0; i < LONG; i++) {
    noise[i] = cdem_random_uniform(&random, -1, 1);
    count[i] = -i / 7;
  }
  const int64_t step[2] = {INT64_MIN, INT64_MAX};
  const uint8_t flags[3] = {0, 255, 7};
  check_ok(cdem_state_add(&state, "solver/strange", CDEM_ARRAY_REAL, 8, strange, &fault));
  check_ok(cdem_state_add(&state, "solver/deep/er/noise", CDEM_ARRAY_REAL, LONG, noise, &fault));
  check_ok(cdem_state_add(&state, "zero", CDEM_ARRAY_REAL, LONG, zero, &fault));
  check_ok(cdem_state_add(&state, "count", CDEM_ARRAY_INT32, LONG, count, &fault));
  check_ok(cdem_state_add(&state, "a/step", CDEM_ARRAY_INT64, 2, step, &fault));
  check_ok(cdem_state_add(&state, "a/flags", CDEM_ARRAY_BYTE, 3, flags, &fault));
  check_ok(cdem_state_add(&state, "a/none", CDEM_ARRAY_INT32, 0, NULL, &fault));
  const char *path = in_scratch("state.h5");
  check_ok(cdem_write_state(path, &state, &fault));
  check_ok(cdem_read_state(path, &back, &fault));
  check_same(&state, &back);
  const double *again = cdem_state_find(&back, "solver/strange")->data;
  for (int i = 0; i < 8; i++)
    assert_true(bits_of(again[i]) == bits_of(strange[i]));
  check_fails(cdem_state_get(&back, "solver/strange", CDEM_ARRAY_REAL, 8, strange, &fault),
              CDEM_INPUT, "'solver/strange' of the checkpoint holds nan at place 1");
  /* Zeros and slowly changing counts shrink; noise stays as it is. */
  size_t bytes = 0;
  free(read_whole(path, &bytes));
  assert_in_range(bytes, LONG * 8, LONG * 8 + 60000);
  /* The same state gives the same file, in place of the old one. */
  char *first = read_whole(path, NULL);
  check_ok(cdem_write_state(path, &back, &fault));
  cdem_state_release(&back);
  check_ok(cdem_read_state(path, &back, &fault));
  check_same(&state, &back);
  assert_int_equal(H5Fis_hdf5(path), 1); /* other programs read it too */
  check_ok(cdem_write_state(in_scratch("twin.h5"), &state, &fault));
  size_t twin_bytes = 0;
  char *twin = read_whole(in_scratch("twin.h5"), &twin_bytes);
  assert_int_equal(twin_bytes, bytes);
  assert_memory_equal(twin, first, bytes);
  free(twin);
  free(first);
  cdem_state_release(&back);
  cdem_state_release(&state);
  free(noise);
  free(zero);
  free(count);
}

static void a_mesh_survives(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  static const cdem_shape shapes[] = {CDEM_SHAPE_PYR5, CDEM_SHAPE_WEDGE6, CDEM_SHAPE_QUAD4};
  for (int s = 0; s < 3; s++) {
    cdem_mesh mesh = {0}, back;
    cdem_state state = {0}, read;
    cdem_mesh_grid_options options = {
        shapes[s], {3, 2, s < 2 ? 2 : 0}, {1, 1, s < 2 ? 1 : 0}, 0.1, 3};
    check_ok(cdem_mesh_grid(&options, &mesh, &fault));
    if (s == 1)
      mesh.source = cdem_copy_text("plate.msh", &fault);
    check_ok(cdem_mesh_to_state(&mesh, "start/mesh", &state, &fault));
    check_ok(cdem_write_state(in_scratch("mesh.h5"), &state, &fault));
    check_ok(cdem_read_state(in_scratch("mesh.h5"), &read, &fault));
    check_ok(cdem_mesh_from_state(&read, "start/mesh", &back, &fault));
    cdem_state again = {0};
    check_ok(cdem_mesh_to_state(&back, "start/mesh", &again, &fault));
    check_same(&state, &again);
    assert_int_equal(back.groups, mesh.groups);
    assert_memory_equal(back.cell_start, mesh.cell_start,
                        (size_t)(mesh.cells + 1) * sizeof *mesh.cell_start);
    for (int32_t g = 0; g < mesh.groups; g++)
      assert_string_equal(back.group[g].name, mesh.group[g].name);
    assert_true(s == 1 ? strcmp(back.source, "plate.msh") == 0 : back.source == NULL);
    cdem_state_release(&again);
    cdem_mesh_release(&back);
    cdem_state_release(&read);
    cdem_state_release(&state);
    cdem_mesh_release(&mesh);
  }
}

static void damaged_meshes_are_refused(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0}, back;
  cdem_state state = {0};
  cdem_mesh_grid_options options = {CDEM_SHAPE_TRI3, {2, 2, 0}, {1, 1, 0}, 0, 0};
  check_ok(cdem_mesh_grid(&options, &mesh, &fault));
  check_ok(cdem_mesh_to_state(&mesh, "mesh", &state, &fault));
  check_fails(cdem_mesh_from_state(&state, "body", &back, &fault), CDEM_INPUT,
              "no array 'body/source' of type byte; it holds no mesh");
  assert_int_equal(back.nodes, 0);
  int32_t node = mesh.cell_node[4];
  mesh.cell_node[4] = 9;
  check_fails(cdem_mesh_from_state(&state, "mesh", &back, &fault), CDEM_INPUT,
              "the mesh of the checkpoint is damaged: cell ");
  mesh.cell_node[4] = node;
  mesh.cell_shape[3] = CDEM_SHAPE_QUAD4;
  check_fails(cdem_mesh_from_state(&state, "mesh", &back, &fault), CDEM_INPUT,
              "cells of the mesh of the checkpoint do not fit together");
  mesh.cell_shape[3] = 200;
  check_fails(cdem_mesh_from_state(&state, "mesh", &back, &fault), CDEM_INPUT,
              "cells of the mesh of the checkpoint do not fit together");
  mesh.cell_shape[3] = CDEM_SHAPE_TRI3;
  cdem_array *cell = (cdem_array *)cdem_state_find(&state, "mesh/group_cell");
  cell->count -= 1;
  check_fails(cdem_mesh_from_state(&state, "mesh", &back, &fault), CDEM_INPUT,
              "groups of the mesh of the checkpoint do not fit together");
  cell->count += 1;
  cdem_array *tag = (cdem_array *)cdem_state_find(&state, "mesh/node_tag");
  tag->count -= 1;
  check_fails(cdem_mesh_from_state(&state, "mesh", &back, &fault), CDEM_INPUT,
              "27 coordinates and 8 node tags");
  tag->count += 1;
  check_ok(cdem_mesh_from_state(&state, "mesh", &back, &fault));
  cdem_mesh_release(&back);
  cdem_state_release(&state);
  cdem_mesh_release(&mesh);
}

static void write_small(const char *path) {
  cdem_fault fault = {0};
  cdem_state state = {0};
  double *value = calloc(LONG, sizeof *value);
  value[3] = 1.0;
  check_ok(cdem_state_add(&state, "value", CDEM_ARRAY_REAL, LONG, value, &fault));
  check_ok(cdem_write_state(path, &state, &fault));
  cdem_state_release(&state);
  free(value);
}

static void put_bytes(const char *path, const char *text, size_t bytes) {
  FILE *file = fopen(path, "wb");
  assert_int_equal(fwrite(text, 1, bytes, file), bytes);
  fclose(file);
}

/* Cut anywhere, or with a byte changed anywhere, it is refused with a message; HDF5 says nothing on
 * its own. */
static void damage_is_found(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state;
  const char *path = in_scratch("damaged.h5");
  size_t bytes = 0;
  write_small(path);
  char *whole = read_whole(path, &bytes);
  for (size_t cut = 8; cut < bytes; cut += bytes / 40 + 1) {
    put_bytes(path, whole, cut);
    check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT, "it was cut short");
    assert_int_equal(state.arrays, 0);
  }
  put_bytes(path, whole, 7);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT, "it is not an HDF5 file");
  for (size_t at = 8; at < bytes - 20; at += 31) {
    whole[at] ^= 4;
    put_bytes(path, whole, bytes);
    whole[at] ^= 4;
    check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT, "it is damaged (its checksum");
    assert_int_equal(state.arrays, 0);
  }
  put_bytes(path, whole, bytes);
  check_ok(cdem_read_state(path, &state, &fault));
  cdem_state_release(&state);
  free(whole);
}

/* Gives the bytes of HDF5 in a file the line with their checksum. */
static void put_sum(const char *path) {
  size_t bytes = 0;
  char *whole = read_whole(path, &bytes);
  FILE *file = fopen(path, "ab");
  fprintf(file, "cdem state %08lx\n", crc32(0, (unsigned char *)whole, (uInt)bytes));
  fclose(file);
  free(whole);
}

/* A written state without its checksum, open for changes. */
static hid_t open_bare(const char *path) {
  size_t bytes = 0;
  write_small(path);
  char *whole = read_whole(path, &bytes);
  put_bytes(path, whole, bytes - 20);
  free(whole);
  return H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
}

static void put_foreign(const char *path, const char *name, int rank, hid_t type) {
  const hsize_t size[2] = {2, 3};
  hid_t file = open_bare(path), space = H5Screate_simple(rank, size, NULL);
  H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(file);
  put_sum(path);
}

/* A length without elements, and more numbers of the version than there is room for. */
static void what_is_announced_must_be_there(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state;
  const char *path = in_scratch("announced.h5");
  const hsize_t many = (hsize_t)1 << 40, some = 4096;
  hid_t file = open_bare(path), space = H5Screate_simple(1, &many, NULL);
  H5Dclose(
      H5Dcreate2(file, "long", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(file);
  put_sum(path);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "'long' announces 1099511627776 elements, which the file is too short for");
  file = open_bare(path);
  space = H5Screate_simple(1, &some, NULL);
  H5Adelete(file, "format_version");
  H5Aclose(H5Acreate2(file, "format_version", H5T_NATIVE_INT, space, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(file);
  put_sum(path);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "the HDF5 library failed at format_version");
}

static void foreign_files_are_refused(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state;
  const char *path = in_scratch("foreign.h5");
  check_fails(cdem_read_state(in_scratch("none.h5"), &state, &fault), CDEM_FILE,
              "none.h5': No such file or directory");
  check_fails(cdem_read_state(scratch, &state, &fault), CDEM_FILE, "it is a directory");
  write_whole(path, "time [s],force [N]\n0,0\n");
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT, "it is not an HDF5 file");
  H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "it was cut short or is no state of cdem");
  put_sum(path);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "it is an HDF5 file but no state of cdem");
  put_foreign(path, "matrix", 2, H5T_NATIVE_DOUBLE);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "'matrix' is no list of numbers of a known type");
  put_foreign(path, "short", 1, H5T_NATIVE_INT16);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "'short' is no list of numbers of a known type");
  put_foreign(path, "good", 1, H5T_STD_I32BE); /* of another machine */
  check_ok(cdem_read_state(path, &state, &fault));
  assert_int_equal(cdem_state_find(&state, "good")->type, CDEM_ARRAY_INT32);
  cdem_state_release(&state);
  hid_t file = open_bare(path), attribute = H5Aopen(file, "format_version", H5P_DEFAULT);
  const int version = 2;
  H5Awrite(attribute, H5T_NATIVE_INT, &version);
  H5Aclose(attribute);
  H5Fclose(file);
  put_sum(path);
  check_fails(cdem_read_state(path, &state, &fault), CDEM_INPUT,
              "it is of version 2, and this program reads version 1");
}

static int fill_disk(const void *path) {
  cdem_fault fault = {0};
  cdem_state state = {0};
  static double value[LONG];
  cdem_random random = {1};
  for (int i = 0; i < LONG; i++)
    value[i] = cdem_random_uniform(&random, 0, 1);
  if (cdem_state_add(&state, "value", CDEM_ARRAY_REAL, LONG, value, &fault) != CDEM_OK)
    return 1;
  cdem_status status = cdem_write_state(path, &state, &fault);
  cdem_state_release(&state);
  return status == CDEM_FILE && strstr(fault.message, "File too large; free some space") != NULL
             ? 0
             : 2;
}

static void the_old_state_stays_when_the_disk_is_full(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_state state;
  char folder[128];
  snprintf(folder, sizeof folder, "%s/full", scratch);
  mkdir(folder, 0700);
  const char *path = in_scratch("full/state.h5");
  write_small(path);
  assert_int_equal(with_file_limit(100000, fill_disk, path), 0);
  assert_int_equal(count_files(folder), 1);
  check_ok(cdem_read_state(path, &state, &fault));
  assert_true(((double *)cdem_state_find(&state, "value")->data)[3] == 1.0);
  cdem_state_release(&state);
  check_fails(cdem_write_state("/dev/full", &state, &fault), CDEM_FILE,
              "HDF5 needs a regular file");
  check_fails(cdem_write_state("/no/such/state.h5", &state, &fault), CDEM_FILE,
              "No such file or directory");
}

static void memory_runs_out(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_mesh_grid_options options = {CDEM_SHAPE_TRI3, {2, 2, 0}, {1, 1, 0}, 0, 0};
  check_ok(cdem_mesh_grid(&options, &mesh, &fault));
  mesh.source = cdem_copy_text("plate.msh", &fault);
  char folder[128], path[160];
  snprintf(folder, sizeof folder, "%s/memory", scratch);
  snprintf(path, sizeof path, "%s/state.h5", folder);
  mkdir(folder, 0700);
  for (int allowed = 0;; allowed++) {
    cdem_state state = {0}, read = {0};
    cdem_mesh back = {0};
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(allowed);
    cdem_status status = cdem_mesh_to_state(&mesh, "mesh", &state, &fault);
    if (status == CDEM_OK)
      status = cdem_write_state(path, &state, &fault);
    if (status == CDEM_OK)
      status = cdem_read_state(path, &read, &fault);
    if (status == CDEM_OK)
      status = cdem_mesh_from_state(&read, "mesh", &back, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || fault.message[0] != '\0');
    assert_in_range(count_files(folder), 0, 1);
    cdem_mesh_release(&back);
    cdem_state_release(&read);
    cdem_state_release(&state);
    if (status == CDEM_OK) {
      assert_true(allowed > 30);
      break;
    }
  }
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bit_survives),
      cmocka_unit_test(a_mesh_survives),
      cmocka_unit_test(damaged_meshes_are_refused),
      cmocka_unit_test(damage_is_found),
      cmocka_unit_test(foreign_files_are_refused),
      cmocka_unit_test(what_is_announced_must_be_there),
      cmocka_unit_test(the_old_state_stays_when_the_disk_is_full),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
