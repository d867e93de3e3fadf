/* Checkpoints. HDF5 itself may crash on bytes that were changed, which is why a checkpoint carries
 * a checksum and HDF5 sees none that was; so the bytes here are a recipe for a whole HDF5 file with
 * a right checksum, of arrays and attributes no run of ours writes:
 *
 *     attributes, checksum, then for each array: name, type, space, length and its elements
 *
 * One byte each; elements as they lie in memory, with zeros behind the end of the recipe. The
 * checksum may be wrong or missing. A recipe that begins with two bytes 255 holds a file as it is.
 */
#include "fuzz/fuzz.h"
#include "io/hdf5_tools.h"
#include "io/run_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct {
  const uint8_t *at, *end;
} recipe;

static uint8_t next(recipe *r) {
  return r->at < r->end ? *r->at++ : 0;
}

/* ---- what there is to choose from ---- */

static const char *const names[] = {"mesh/source",
                                    "mesh/xyz",
                                    "mesh/node_tag",
                                    "mesh/cell_shape",
                                    "mesh/cell_tag",
                                    "mesh/cell_node",
                                    "mesh/group",
                                    "mesh/group_name",
                                    "mesh/group_cell",
                                    "run/counts",
                                    "run/reals",
                                    "a",
                                    "a/b",
                                    "a/b/c d",
                                    "solver/u",
                                    "\303\244/\342\x80"};
enum { NAMES = sizeof names / sizeof names[0], TYPES = 12, SPACES = 8, ATTRIBUTES = 8 };

/* A new type; the numbers of a state are the first four. */
static hid_t make_type(unsigned which) {
  const hid_t plain[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT32,  H5T_NATIVE_INT64, H5T_NATIVE_UINT8,
                         H5T_IEEE_F64BE,    H5T_NATIVE_FLOAT,  H5T_STD_U32LE,    H5T_NATIVE_INT8,
                         H5T_STD_B8LE,      H5T_NATIVE_LDOUBLE};
  if (which < sizeof plain / sizeof plain[0])
    return H5Tcopy(plain[which]);
  hid_t type = which == 10 ? H5Tcreate(H5T_COMPOUND, 8) : H5Tcopy(H5T_C_S1);
  if (which == 10)
    H5Tinsert(type, "x", 0, H5T_NATIVE_DOUBLE);
  else
    H5Tset_size(type, 8);
  return type;
}

/* One dimension first; then other ranks, pieces that were packed, and lengths that are announced
 * but not written. */
static hid_t make_space(unsigned which, uint8_t length, hid_t create, bool *written) {
  const hsize_t size[2] = {length, 2}, large[2] = {(hsize_t)1 << length % 61, 1},
                chunk[2] = {64, 1}, piece = length > 1 ? length : 1;
  *written = which < 5 && length > 0;
  switch (which) {
  case 1:
    return H5Screate(H5S_SCALAR);
  case 2:
    return H5Screate_simple(2, size, NULL);
  case 3:
    H5Pset_chunk(create, 1, &piece);
    H5Pset_deflate(create, 1);
    return H5Screate_simple(1, size, NULL);
  case 5:
    H5Pset_chunk(create, 1, chunk);
    return H5Screate_simple(1, large, NULL);
  case 6:
    return H5Screate_simple(1, large, NULL);
  case 7:
    return H5Screate(H5S_NULL);
  default:
    return H5Screate_simple(1, size, NULL);
  }
}

static void put_array(hid_t file, hid_t link, recipe *r) {
  static uint8_t element[255 * 2 * sizeof(long double)];
  const char *name = names[next(r) % NAMES];
  hid_t type = make_type(next(r) % TYPES), create = cdem_hdf5_dataset_properties();
  unsigned which = next(r) % SPACES;
  uint8_t length = next(r);
  bool written;
  hid_t space = make_space(which, length, create, &written);
  hid_t set = H5Dcreate2(file, name, type, space, link, create, H5P_DEFAULT);
  size_t bytes = written ? (size_t)H5Sget_simple_extent_npoints(space) * H5Tget_size(type) : 0;
  if (written && set >= 0) {
    size_t left = (size_t)(r->end - r->at), taken = bytes < left ? bytes : left;
    memset(element, 0, bytes);
    memcpy(element, r->at, taken);
    r->at += taken;
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, element);
  }
  if (set >= 0)
    H5Dclose(set);
  H5Sclose(space);
  H5Pclose(create);
  H5Tclose(type);
}

static void put_attribute(hid_t file, const char *name, const char *text, unsigned which) {
  static const int32_t list[64] = {1, 1};
  static const double real = 1.0;
  static const int64_t wide = 1;
  const int32_t number = which == 4 ? -7 : 1;
  const hsize_t many = 64;
  switch (which) {
  case 1:
    return;
  case 2: {
    hid_t space = H5Screate_simple(1, &many, NULL);
    hid_t made = H5Acreate2(file, name, H5T_NATIVE_INT32, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, H5T_NATIVE_INT32, list);
    H5Aclose(made);
    H5Sclose(space);
    return;
  }
  case 3:
    cdem_hdf5_put_scalar(file, name, H5T_NATIVE_DOUBLE, &real);
    return;
  case 5:
    cdem_hdf5_put_scalar(file, name, H5T_NATIVE_INT64, &wide);
    return;
  case 6:
    cdem_hdf5_put_texts(file, name, (const char *const[]){"cdem state", "x"}, 2);
    return;
  case 7:
    cdem_hdf5_put_text(file, name, "cdem states");
    return;
  default:
    if (text != NULL && which == 0)
      cdem_hdf5_put_text(file, name, text);
    else
      cdem_hdf5_put_scalar(file, name, H5T_NATIVE_INT, &number);
  }
}

/* ---- the file ---- */

static hid_t make_file(recipe *r, unsigned attributes) {
  hid_t access = H5Pcreate(H5P_FILE_ACCESS), link = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_fapl_core(access, 1 << 16, 0);
  H5Pset_create_intermediate_group(link, 1);
  hid_t file = H5Fcreate("fuzz", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  put_attribute(file, "format", "cdem state", attributes % ATTRIBUTES);
  put_attribute(file, "format_version", NULL, attributes / 16 % ATTRIBUTES);
  for (int arrays = 0; r->at < r->end && arrays < 32; arrays++)
    put_array(file, link, r);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  H5Pclose(access);
  H5Pclose(link);
  return file;
}

/* Newly allocated. */
static uint8_t *make_bytes(recipe *r, size_t *size) {
  uint8_t attributes = next(r), checksum = next(r);
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  hid_t file = make_file(r, attributes);
  ssize_t length = H5Fget_file_image(file, NULL, 0);
  fuzz_require(length > 0, "HDF5 makes no file");
  uint8_t *bytes = malloc((size_t)length + 32);
  fuzz_require(bytes != NULL && H5Fget_file_image(file, bytes, (size_t)length) == length,
               "HDF5 gives no file");
  H5Fclose(file);
  cdem_hdf5_silence_end(before);
  *size = (size_t)length;
  if (checksum % 3 < 2) {
    unsigned long sum = crc32(0, bytes, (uInt)length) + (checksum % 3 == 1);
    *size += (size_t)snprintf((char *)bytes + length, 32, "cdem state %08lx\n", sum & 0xffffffff);
  }
  return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  recipe r = {data, data + size};
  cdem_fault fault = {0};
  cdem_state state;
  cdem_mesh mesh;
  uint8_t *made = NULL;
  if (size < 2 || data[0] != 255 || data[1] != 255)
    data = made = make_bytes(&r, &size);
  cdem_status status = cdem_read_state(fuzz_file(data, size), &state, &fault);
  free(made);
  if (!fuzz_is_read(status, &fault))
    return 0;
  if (fuzz_is_read(cdem_mesh_from_state(&state, "mesh", &mesh, &fault), &fault))
    cdem_mesh_release(&mesh);
  cdem_state_release(&state);
  return 0;
}
