/* Private to io: HDF5 on top of an output of this room.
 *
 * HDF5 cannot close a file whose last writes failed: it keeps the handle, tries again at exit and
 * complains on stderr. This driver keeps the first errno and pretends success from then on, so that
 * closing always works and the caller reports what really happened. The file under construction is
 * thrown away in that case.
 */
#ifndef CDEM_IO_HDF5_DRIVER_H
#define CDEM_IO_HDF5_DRIVER_H

#include "base/base.h"

#include <hdf5.h>

/* What the driver works on. It must outlive the file. */
typedef struct {
  int descriptor; /* open for reading and writing; not closed by HDF5 */
  int error;      /* errno of the first failure, 0: none */
} cdem_hdf5_target;

/* A file access list that creates files in *target; negative on failure. *driver receives the
 * driver's id. Close the file, then the list, then unregister the driver with H5FDunregister. */
hid_t cdem_hdf5_access(cdem_hdf5_target *target, hid_t *driver);

#endif
