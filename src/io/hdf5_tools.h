/* Private to io: what the writers and readers of HDF5 files share. */
#ifndef CDEM_IO_HDF5_TOOLS_H
#define CDEM_IO_HDF5_TOOLS_H

#include <hdf5.h>
#include <stdbool.h>

/* HDF5 prints its own error stack unless told not to. */
typedef struct {
  H5E_auto2_t report;
  void *data;
} cdem_hdf5_silence;

cdem_hdf5_silence cdem_hdf5_silence_begin(void);
void cdem_hdf5_silence_end(cdem_hdf5_silence before);

/* Attributes: one text (count 0) or an array of texts; one text; one number. */
bool cdem_hdf5_put_texts(hid_t object, const char *name, const char *const *text, int count);
bool cdem_hdf5_put_text(hid_t object, const char *name, const char *text);
bool cdem_hdf5_put_scalar(hid_t object, const char *name, hid_t type, const void *value);
/* The attribute "program": which release of cdem writes the file. */
bool cdem_hdf5_put_program(hid_t file);

/* Properties of a new dataset, without the time of day, so that the same input gives the same
 * bytes; negative on failure. */
hid_t cdem_hdf5_dataset_properties(void);

/* A whole dataset of `rank` dimensions size [rank] under `place`; `link` and `create` are property
 * lists (link may be H5P_DEFAULT), `create` is closed. An empty one holds no data. */
bool cdem_hdf5_put_dataset(hid_t place, const char *name, hid_t type, int rank, const hsize_t *size,
                           hid_t link, hid_t create, const void *data);

#endif
