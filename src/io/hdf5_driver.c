#include "io/hdf5_driver.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* HDF5 hands back pointers to our file; its public part comes first. */
typedef struct {
  H5FD_t base;
  cdem_hdf5_target *target;
  haddr_t allocated; /* end of the space HDF5 has given out */
  haddr_t end;       /* end of the file */
} driver_file;

typedef struct {
  cdem_hdf5_target *target;
} driver_info;

static H5FD_t *driver_open(const char *name, unsigned flags, hid_t access, haddr_t maximum) {
  (void)name, (void)flags, (void)maximum;
  const driver_info *info = H5Pget_driver_info(access);
  driver_file *file = info != NULL ? cdem_allocate(1, sizeof *file, NULL) : NULL;
  if (file == NULL) {
    if (info != NULL)
      info->target->error = ENOMEM;
    return NULL;
  }
  file->target = info->target;
  return &file->base;
}

static herr_t driver_close(H5FD_t *base) {
  free(base);
  return 0;
}

static herr_t driver_query(const H5FD_t *base, unsigned long *flags) {
  (void)base;
  if (flags != NULL)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

static haddr_t driver_get_eoa(const H5FD_t *base, H5FD_mem_t type) {
  (void)type;
  return ((const driver_file *)base)->allocated;
}

static herr_t driver_set_eoa(H5FD_t *base, H5FD_mem_t type, haddr_t address) {
  (void)type;
  ((driver_file *)base)->allocated = address;
  return 0;
}

static haddr_t driver_get_eof(const H5FD_t *base, H5FD_mem_t type) {
  (void)type;
  return ((const driver_file *)base)->end;
}

/* Behind the end, and after a failure, everything reads as zero. */
static herr_t driver_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                          size_t bytes, void *data) {
  (void)type, (void)transfer;
  driver_file *file = (driver_file *)base;
  size_t done = 0;
  while (done < bytes) {
    ssize_t n =
        pread(file->target->descriptor, (char *)data + done, bytes - done, (off_t)(address + done));
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0 && file->target->error == 0)
      file->target->error = errno;
    if (n <= 0)
      break;
    done += (size_t)n;
  }
  memset((char *)data + done, 0, bytes - done);
  return 0;
}

static herr_t driver_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                           size_t bytes, const void *data) {
  (void)type, (void)transfer;
  driver_file *file = (driver_file *)base;
  size_t done = 0;
  while (done < bytes && file->target->error == 0) {
    ssize_t n = pwrite(file->target->descriptor, (const char *)data + done, bytes - done,
                       (off_t)(address + done));
    if (n >= 0)
      done += (size_t)n;
    else if (errno != EINTR)
      file->target->error = errno;
  }
  if (address + bytes > file->end)
    file->end = address + bytes;
  return 0;
}

static herr_t driver_truncate(H5FD_t *base, hid_t transfer, hbool_t closing) {
  (void)transfer, (void)closing;
  driver_file *file = (driver_file *)base;
  if (file->end == file->allocated)
    return 0;
  if (ftruncate(file->target->descriptor, (off_t)file->allocated) != 0 && file->target->error == 0)
    file->target->error = errno;
  file->end = file->allocated;
  return 0;
}

hid_t cdem_hdf5_access(cdem_hdf5_target *target, hid_t *driver) {
  const H5FD_class_t class = {
      .name = "cdem_output",
      .maxaddr = ((haddr_t)1 << (8 * sizeof(off_t) - 1)) - 1,
      .fc_degree = H5F_CLOSE_STRONG,
      .fapl_size = sizeof(driver_info),
      .open = driver_open,
      .close = driver_close,
      .query = driver_query,
      .get_eoa = driver_get_eoa,
      .set_eoa = driver_set_eoa,
      .get_eof = driver_get_eof,
      .read = driver_read,
      .write = driver_write,
      .truncate = driver_truncate,
      .fl_map = H5FD_FLMAP_DICHOTOMY,
  };
  const driver_info info = {target};
  hid_t access = -1;
  *driver = H5FDregister(&class);
  if (*driver >= 0)
    access = H5Pcreate(H5P_FILE_ACCESS);
  if (access >= 0 && H5Pset_driver(access, *driver, &info) < 0) {
    H5Pclose(access);
    access = -1;
  }
  if (access < 0 && *driver >= 0) {
    H5FDunregister(*driver);
    *driver = -1;
  }
  return access;
}
