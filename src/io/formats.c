/* The table of spring formats: one line a format. */
#include "io/springs.h"
#include "io/text.h"

#include <stdio.h>
#include <stdlib.h>

static const cdem_springs_format *const formats[] = {
    &cdem_springs_csv, &cdem_springs_hdf5, &cdem_springs_vtp,    &cdem_springs_vtu,
    &cdem_springs_mtx, &cdem_springs_inp,  &cdem_springs_lammps, &cdem_springs_yade,
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

const cdem_springs_format *cdem_springs_format_at(int index) {
  return index >= 0 && index < FORMATS ? formats[index] : NULL;
}

const cdem_springs_format *cdem_springs_format_find(const char *name) {
  for (int i = 0; i < FORMATS; i++)
    if (strcmp(formats[i]->name, name) == 0)
      return formats[i];
  return NULL;
}

const cdem_springs_format *cdem_springs_format_of(const char *path) {
  for (int i = 0; i < FORMATS; i++)
    if (cdem_ends_with_one_of(path, formats[i]->endings))
      return formats[i];
  return NULL;
}

void cdem_springs_writer_destroy(cdem_springs_writer **writer) {
  if (writer == NULL || *writer == NULL)
    return;
  (*writer)->destroy(*writer);
  *writer = NULL;
}

char *cdem_material_text(const cdem_material *material, cdem_fault *fault) {
  const cdem_material_model_info *info = cdem_material_model_get(material->model);
  size_t room = 512 + (size_t)info->keys * 128;
  char *text = cdem_allocate((int64_t)room, 1, fault), *at = text;
  if (text == NULL)
    return NULL;
  if (material->name[0] != '\0')
    at = cdem_put_text(cdem_put_text(at, material->name), ": ");
  at = cdem_put_text(at, info->name);
  for (int k = 0; k < info->keys; k++) {
    char unit[48];
    at = cdem_put_text(cdem_put_text(cdem_put_text(at, ", "), info->key[k].key), " = ");
    at = cdem_put_real(at, material->parameter[k]);
    cdem_dimension_unit(info->key[k].dimension, unit);
    if (strcmp(unit, "1") != 0)
      at = cdem_put_text(cdem_put_text(at, " "), unit);
  }
  for (int axis = 0; material->rotated && axis < 2; axis++) {
    const double *a = axis == 0 ? material->axis1 : material->axis2;
    at = cdem_put_text(at, axis == 0 ? ", axis1 = (" : ", axis2 = (");
    for (int c = 0; c < 3; c++)
      at = cdem_put_text(cdem_put_real(at, a[c]), c < 2 ? " " : ")");
  }
  *at = '\0';
  return text;
}
