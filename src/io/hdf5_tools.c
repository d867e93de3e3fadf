#include "io/hdf5_tools.h"

#include "base/version.h"

#include <stdio.h>

cdem_hdf5_silence cdem_hdf5_silence_begin(void) {
  cdem_hdf5_silence before = {0};
  H5Eget_auto2(H5E_DEFAULT, &before.report, &before.data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return before;
}

void cdem_hdf5_silence_end(cdem_hdf5_silence before) {
  H5Eset_auto2(H5E_DEFAULT, before.report, before.data);
}

bool cdem_hdf5_put_texts(hid_t object, const char *name, const char *const *text, int count) {
  hsize_t size = (hsize_t)count;
  hid_t type = H5Tcopy(H5T_C_S1);
  hid_t space = count > 0 ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR);
  bool good = type >= 0 && space >= 0 && H5Tset_size(type, H5T_VARIABLE) >= 0 &&
              H5Tset_cset(type, H5T_CSET_UTF8) >= 0;
  hid_t attribute =
      good ? H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT) : (hid_t)-1;
  good = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
  if (attribute >= 0)
    H5Aclose(attribute);
  if (space >= 0)
    H5Sclose(space);
  if (type >= 0)
    H5Tclose(type);
  return good;
}

bool cdem_hdf5_put_text(hid_t object, const char *name, const char *text) {
  return cdem_hdf5_put_texts(object, name, &text, 0);
}

bool cdem_hdf5_put_scalar(hid_t object, const char *name, hid_t type, const void *value) {
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t attribute =
      space >= 0 ? H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT) : (hid_t)-1;
  bool good = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
  if (attribute >= 0)
    H5Aclose(attribute);
  if (space >= 0)
    H5Sclose(space);
  return good;
}

bool cdem_hdf5_put_program(hid_t file) {
  char text[64];
  snprintf(text, sizeof text, "cdem %s", cdem_version());
  return cdem_hdf5_put_text(file, "program", text);
}

hid_t cdem_hdf5_dataset_properties(void) {
  hid_t create = H5Pcreate(H5P_DATASET_CREATE);
  if (create >= 0)
    H5Pset_obj_track_times(create, 0);
  return create;
}

bool cdem_hdf5_put_dataset(hid_t place, const char *name, hid_t type, int rank, const hsize_t *size,
                           hid_t link, hid_t create, const void *data) {
  hid_t space = H5Screate_simple(rank, size, NULL);
  hid_t set = space >= 0 && create >= 0
                  ? H5Dcreate2(place, name, type, space, link, create, H5P_DEFAULT)
                  : (hid_t)-1;
  bool empty = false;
  for (int r = 0; r < rank; r++)
    empty = empty || size[r] == 0;
  bool good = set >= 0 && (empty || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  if (set >= 0)
    H5Dclose(set);
  if (create >= 0)
    H5Pclose(create);
  if (space >= 0)
    H5Sclose(space);
  return good;
}
