#include "io/hdf5_tools.h"

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

hid_t cdem_hdf5_dataset_properties(void) {
  hid_t create = H5Pcreate(H5P_DATASET_CREATE);
  if (create >= 0)
    H5Pset_obj_track_times(create, 0);
  return create;
}
