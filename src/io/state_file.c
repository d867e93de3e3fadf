/* States as HDF5: one dataset an array, named by its path, behind attributes that say what the file
 * is, and behind the end of HDF5's own bytes one line of text with their checksum. HDF5 itself
 * reads over that line, but may crash on bytes that were changed. The file is written beside the
 * target and takes its place when it is whole and on the disk, so that a run killed at any moment,
 * or a machine that loses its power, leaves the state before. */
#include "io/hdf5_driver.h"
#include "io/hdf5_tools.h"
#include "io/output.h"
#include "io/run_files.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define FORMAT  "cdem state"
#define TRAILER "cdem state %08lx\n" /* zlib's crc32 */

enum {
  VERSION = 1,
  CHUNK = 1 << 18, /* bytes compressed together */
  LEAST = 1 << 12, /* bytes from which on compression is tried */
  SAMPLE = 1 << 15,
  TRAILER_LENGTH = 20,
  COPY = 1 << 20
};

static hid_t native_type(cdem_array_type type) {
  return type == CDEM_ARRAY_REAL    ? H5T_NATIVE_DOUBLE
         : type == CDEM_ARRAY_INT32 ? H5T_NATIVE_INT32
         : type == CDEM_ARRAY_INT64 ? H5T_NATIVE_INT64
                                    : H5T_NATIVE_UINT8;
}

/* ---- the checksum ---- */

/* Of the first `bytes` of a file; 0, or the errno of reading. */
static int sum_file(int descriptor, int64_t bytes, char trailer[TRAILER_LENGTH + 1]) {
  unsigned char *piece = cdem_allocate(COPY, 1, NULL);
  if (piece == NULL)
    return ENOMEM;
  uLong sum = crc32(0, NULL, 0);
  int error = 0;
  for (int64_t done = 0; done < bytes && error == 0;) {
    size_t wanted = bytes - done < COPY ? (size_t)(bytes - done) : COPY;
    ssize_t n = pread(descriptor, piece, wanted, (off_t)done);
    if (n > 0) {
      sum = crc32(sum, piece, (uInt)n);
      done += n;
    } else if (n == 0 || errno != EINTR) {
      error = n == 0 ? EIO : errno;
    }
  }
  free(piece);
  snprintf(trailer, TRAILER_LENGTH + 1, TRAILER, (unsigned long)sum);
  return error;
}

/* 0 or an errno. */
static int append_sum(int descriptor) {
  char trailer[TRAILER_LENGTH + 1];
  off_t bytes = lseek(descriptor, 0, SEEK_END);
  int error = bytes < 0 ? errno : sum_file(descriptor, bytes, trailer);
  if (error != 0)
    return error;
  ssize_t written = pwrite(descriptor, trailer, TRAILER_LENGTH, bytes);
  if (written != TRAILER_LENGTH)
    return written < 0 ? errno : ENOSPC;
  return fsync(descriptor) == 0 ? 0 : errno;
}

/* ---- writing ---- */

typedef struct {
  cdem_output *output;
  cdem_hdf5_target target;
  hid_t driver, access, link, file;
} state_writer;

static cdem_status fail(const state_writer *writer, cdem_fault *fault) {
  if (writer->target.error != 0)
    return cdem_output_fail(writer->output, writer->target.error, fault);
  return cdem_fail(fault, CDEM_FILE, "cannot write '%s': the HDF5 library failed",
                   cdem_output_name(writer->output));
}

/* Numbers that change from place to place hardly shrink and cost time; a piece from the middle,
 * with the bytes of equal weight side by side as the filter lays them, tells. */
static bool shrinks(const cdem_array *array) {
  int64_t size = (int64_t)cdem_array_size(array->type), bytes = array->count * size;
  if (bytes < LEAST)
    return false;
  int64_t count = (bytes < SAMPLE ? bytes : SAMPLE) / size, first = (array->count - count) / 2;
  const unsigned char *data = (const unsigned char *)array->data + first * size;
  unsigned char piece[SAMPLE], packed[SAMPLE];
  for (int64_t i = 0; i < count; i++)
    for (int64_t b = 0; b < size; b++)
      piece[b * count + i] = data[i * size + b];
  uLongf room = (uLongf)(count * size) / 2;
  return compress2(packed, &room, piece, (uLong)(count * size), 1) == Z_OK;
}

static hid_t array_properties(const cdem_array *array) {
  hid_t create = cdem_hdf5_dataset_properties();
  if (create < 0 || !shrinks(array))
    return create;
  hsize_t chunk = CHUNK / cdem_array_size(array->type);
  if (chunk > (hsize_t)array->count)
    chunk = (hsize_t)array->count;
  if (H5Pset_chunk(create, 1, &chunk) >= 0 && H5Pset_shuffle(create) >= 0 &&
      H5Pset_deflate(create, 1) >= 0)
    return create;
  H5Pclose(create);
  return -1;
}

static bool put_array(const state_writer *writer, const cdem_array *array) {
  hsize_t count = (hsize_t)array->count;
  hid_t type = native_type(array->type);
  return cdem_hdf5_put_dataset(writer->file, array->name, type, 1, &count, writer->link,
                               array_properties(array), array->data);
}

static cdem_status put_state(state_writer *writer, const cdem_state *state, cdem_fault *fault) {
  const int version = VERSION;
  CDEM_REQUIRE(cdem_output_is_file(writer->output), fault, CDEM_FILE,
               "cannot write '%s': HDF5 needs a regular file", cdem_output_name(writer->output));
  writer->target.descriptor = cdem_output_descriptor(writer->output);
  writer->access = cdem_hdf5_access(&writer->target, &writer->driver);
  writer->link = H5Pcreate(H5P_LINK_CREATE); /* makes the groups of a path */
  if (writer->access >= 0 && writer->link >= 0 &&
      H5Pset_create_intermediate_group(writer->link, 1) >= 0)
    writer->file =
        H5Fcreate(cdem_output_path(writer->output), H5F_ACC_TRUNC, H5P_DEFAULT, writer->access);
  bool good = writer->file >= 0 && cdem_hdf5_put_text(writer->file, "format", FORMAT) &&
              cdem_hdf5_put_scalar(writer->file, "format_version", H5T_NATIVE_INT, &version) &&
              cdem_hdf5_put_program(writer->file);
  for (int64_t i = 0; i < state->arrays && good; i++)
    good = put_array(writer, &state->array[i]) && writer->target.error == 0;
  return good ? CDEM_OK : fail(writer, fault);
}

static void close_writer(state_writer *writer) {
  if (writer->file >= 0 && H5Fclose(writer->file) < 0 && writer->target.error == 0)
    writer->target.error = EIO;
  if (writer->link >= 0)
    H5Pclose(writer->link);
  if (writer->access >= 0)
    H5Pclose(writer->access);
  if (writer->driver >= 0)
    H5FDunregister(writer->driver);
}

cdem_status cdem_write_state(const char *path, const cdem_state *state, cdem_fault *fault) {
  state_writer writer = {.driver = -1, .access = -1, .link = -1, .file = -1};
  CDEM_TRY(cdem_output_open(path, &writer.output, fault));
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  cdem_status status = put_state(&writer, state, fault);
  close_writer(&writer);
  cdem_hdf5_silence_end(before);
  if (status == CDEM_OK && writer.target.error == 0)
    writer.target.error = append_sum(writer.target.descriptor);
  if (status == CDEM_OK && writer.target.error != 0)
    status = fail(&writer, fault);
  if (status == CDEM_OK)
    return cdem_output_commit(&writer.output, fault);
  cdem_output_discard(&writer.output);
  return status;
}

/* ---- reading ---- */

typedef struct {
  const char *path;
  cdem_state *state;
  cdem_fault *fault;
  cdem_status status;
  hsize_t bytes; /* of the file */
} state_reader;

/* What HDF5 cannot read in a file whose checksum is right. */
static cdem_status damaged(const state_reader *reader, const char *what) {
  return cdem_fail(reader->fault, CDEM_INPUT,
                   "cannot read '%s': the HDF5 library failed at %s; the file was not written by "
                   "cdem",
                   reader->path, what);
}

/* The type of a dataset's numbers; false for others. */
static bool array_type(hid_t type, cdem_array_type *out) {
  H5T_class_t class = H5Tget_class(type);
  size_t size = H5Tget_size(type);
  bool with_sign = class == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_2;
  if (class == H5T_FLOAT && size == sizeof(double))
    *out = CDEM_ARRAY_REAL;
  else if (with_sign && size == sizeof(int32_t))
    *out = CDEM_ARRAY_INT32;
  else if (with_sign && size == sizeof(int64_t))
    *out = CDEM_ARRAY_INT64;
  else if (class == H5T_INTEGER && !with_sign && size == 1)
    *out = CDEM_ARRAY_BYTE;
  else
    return false;
  return true;
}

/* Can the file hold so many? HDF5 makes up what was announced and never written. */
static bool can_hold(const state_reader *reader, hid_t set, cdem_array_type type, hsize_t count) {
  enum { DENSEST = 1032 }; /* deflate packs at most so many bytes into one */
  hsize_t stored = H5Dget_storage_size(set);
  return stored <= reader->bytes && count / DENSEST <= stored / cdem_array_size(type) + 1;
}

static cdem_status read_array(const state_reader *reader, const char *name, hid_t set) {
  hid_t space = H5Dget_space(set), type = H5Dget_type(set);
  cdem_array_type numbers = CDEM_ARRAY_BYTE;
  int rank = space >= 0 ? H5Sget_simple_extent_ndims(space) : -1;
  hsize_t count = 0;
  bool known = type >= 0 && array_type(type, &numbers) && rank == 1 &&
               H5Sget_simple_extent_dims(space, &count, NULL) == 1 && count <= INT64_MAX;
  cdem_status status = CDEM_OK;
  if (space < 0 || type < 0)
    status = damaged(reader, name);
  else if (!known)
    status = cdem_fail(reader->fault, CDEM_INPUT,
                       "cannot read '%s': '%s' is no list of numbers of a known type; it was not "
                       "written by cdem",
                       reader->path, name);
  else if (!can_hold(reader, set, numbers, count))
    status = cdem_fail(reader->fault, CDEM_INPUT,
                       "cannot read '%s': '%s' announces %" PRIu64
                       " elements, which the file is too short for; it was not written by cdem",
                       reader->path, name, (uint64_t)count);
  void *data = status == CDEM_OK
                   ? cdem_allocate((int64_t)count, cdem_array_size(numbers), reader->fault)
                   : NULL;
  if (status == CDEM_OK && data == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK && count > 0 &&
      H5Dread(set, native_type(numbers), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    status = damaged(reader, name);
  if (status == CDEM_OK)
    status =
        cdem_state_add_owned(reader->state, name, numbers, (int64_t)count, data, reader->fault);
  if (status != CDEM_OK)
    free(data);
  if (type >= 0)
    H5Tclose(type);
  if (space >= 0)
    H5Sclose(space);
  return status;
}

/* H5Ovisit calls this for the file itself (".") and every group and dataset. */
static herr_t visit(hid_t file, const char *name, const H5O_info_t *info, void *context) {
  state_reader *reader = context;
  if (info->type != H5O_TYPE_DATASET)
    return 0;
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  reader->status = set >= 0 ? read_array(reader, name, set) : damaged(reader, name);
  if (set >= 0)
    H5Dclose(set);
  return reader->status == CDEM_OK ? 0 : -1;
}

/* The attribute `format`, as cdem_hdf5_put_text writes it. */
static bool is_state(hid_t file) {
  if (H5Aexists(file, "format") <= 0)
    return false;
  hid_t attribute = H5Aopen(file, "format", H5P_DEFAULT);
  hid_t type = attribute >= 0 ? H5Aget_type(attribute) : (hid_t)-1;
  hid_t space = attribute >= 0 ? H5Aget_space(attribute) : (hid_t)-1;
  char *text = NULL;
  bool good = type >= 0 && H5Tis_variable_str(type) > 0 && space >= 0 &&
              H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, type, &text) >= 0 &&
              text != NULL && strcmp(text, FORMAT) == 0;
  if (text != NULL)
    H5free_memory(text);
  if (space >= 0)
    H5Sclose(space);
  if (type >= 0)
    H5Tclose(type);
  if (attribute >= 0)
    H5Aclose(attribute);
  return good;
}

static cdem_status check_format(const state_reader *reader, hid_t file) {
  CDEM_REQUIRE(is_state(file), reader->fault, CDEM_INPUT,
               "cannot read '%s': it is an HDF5 file but no state of cdem; give the checkpoint.h5 "
               "of a run",
               reader->path);
  int version = 0;
  hid_t attribute = H5Aopen(file, "format_version", H5P_DEFAULT);
  hid_t space = attribute >= 0 ? H5Aget_space(attribute) : (hid_t)-1;
  bool good = space >= 0 && H5Sget_simple_extent_npoints(space) == 1 &&
              H5Aread(attribute, H5T_NATIVE_INT, &version) >= 0;
  if (space >= 0)
    H5Sclose(space);
  if (attribute >= 0)
    H5Aclose(attribute);
  if (!good)
    return damaged(reader, "format_version");
  CDEM_REQUIRE(version == VERSION, reader->fault, CDEM_INPUT,
               "cannot read '%s': it is of version %d, and this program reads version %d; use the "
               "program that wrote it",
               reader->path, version, VERSION);
  return CDEM_OK;
}

static cdem_status check_bytes(state_reader *reader, int descriptor) {
  static const char signature[8] = "\211HDF\r\n\032\n";
  char begin[8] = "", trailer[TRAILER_LENGTH + 1] = "", expected[TRAILER_LENGTH + 1];
  struct stat facts;
  CDEM_REQUIRE(fstat(descriptor, &facts) == 0 && !S_ISDIR(facts.st_mode), reader->fault, CDEM_FILE,
               "cannot read '%s': it is a directory", reader->path);
  int64_t bytes = (int64_t)facts.st_size - TRAILER_LENGTH;
  reader->bytes = (hsize_t)facts.st_size;
  CDEM_REQUIRE(pread(descriptor, begin, sizeof begin, 0) == sizeof begin &&
                   memcmp(begin, signature, sizeof begin) == 0,
               reader->fault, CDEM_INPUT,
               "cannot read '%s': it is not an HDF5 file; give the checkpoint.h5 of a run",
               reader->path);
  CDEM_REQUIRE(bytes > 0 &&
                   pread(descriptor, trailer, TRAILER_LENGTH, (off_t)bytes) == TRAILER_LENGTH &&
                   strncmp(trailer, FORMAT, sizeof FORMAT - 1) == 0,
               reader->fault, CDEM_INPUT,
               "cannot read '%s': it was cut short or is no state of cdem; give the checkpoint.h5 "
               "of a run",
               reader->path);
  int error = sum_file(descriptor, bytes, expected);
  CDEM_REQUIRE(error != ENOMEM, reader->fault, CDEM_MEMORY, "out of memory: cannot read '%s'",
               reader->path);
  CDEM_REQUIRE(error == 0, reader->fault, CDEM_FILE, "cannot read '%s': %s", reader->path,
               strerror(error));
  CDEM_REQUIRE(memcmp(trailer, expected, TRAILER_LENGTH) == 0, reader->fault, CDEM_INPUT,
               "cannot read '%s': it is damaged (its checksum is wrong); use another checkpoint or "
               "start the run anew",
               reader->path);
  return CDEM_OK;
}

static cdem_status read_file(state_reader *reader) {
  int descriptor = open(reader->path, O_RDONLY | O_CLOEXEC);
  CDEM_REQUIRE(descriptor >= 0, reader->fault, CDEM_FILE, "cannot read '%s': %s", reader->path,
               strerror(errno));
  cdem_status status = check_bytes(reader, descriptor);
  close(descriptor);
  CDEM_TRY(status);
  hid_t file = H5Fopen(reader->path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    return damaged(reader, "its beginning");
  status = check_format(reader, file);
  if (status == CDEM_OK &&
      H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, reader, H5O_INFO_BASIC) < 0)
    status = reader->status != CDEM_OK ? reader->status : damaged(reader, "the list of arrays");
  H5Fclose(file);
  return status;
}

cdem_status cdem_read_state(const char *path, cdem_state *state, cdem_fault *fault) {
  *state = (cdem_state){0};
  state_reader reader = {path, state, fault, CDEM_OK, 0};
  cdem_hdf5_silence before = cdem_hdf5_silence_begin();
  cdem_status status = read_file(&reader);
  cdem_hdf5_silence_end(before);
  if (status != CDEM_OK)
    cdem_state_release(state);
  return status;
}
