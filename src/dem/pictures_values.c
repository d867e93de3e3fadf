/* Pictures of a solver's state: the field of each grain, the walls, then the map. */
#include "dem/pictures_kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double cdem_effective_stress(int dim, const double stress[6]) {
  double mean = 0.0, sum = 0.0;
  for (int c = 0; c < dim; c++)
    mean += stress[c] / dim;
  for (int c = 0; c < dim; c++)
    sum += (stress[c] - mean) * (stress[c] - mean);
  for (int c = 3; c < (dim == 2 ? 4 : 6); c++)
    sum += 2.0 * stress[c] * stress[c];
  return sqrt(1.5 * sum);
}

static void pressures(const cdem_snapshot *s, const double *stress, double *value) {
  for (int64_t i = 0; i < s->grains; i++) {
    double trace = 0.0;
    for (int c = 0; c < s->dim; c++)
      trace += stress[6 * i + c];
    value[i] = -trace / s->dim;
  }
}

static cdem_status strains(const cdem_snapshot *s, const cdem_picture *p, double *value,
                           cdem_fault *fault) {
  double *gradient;
  bool volumetric = p->field == CDEM_GRAIN_VOLUMETRIC_STRAIN;
  CDEM_NEW(gradient, 9 * s->grains, fault);
  cdem_grain_gradient_kernel(s, p->strain, gradient);
  for (int64_t i = 0; i < s->grains; i++)
    cdem_strain_measure(s->dim, CDEM_STRAIN_HENCKY, gradient + 9 * i, volumetric ? value + i : NULL,
                        volumetric ? NULL : value + i, NULL);
  free(gradient);
  return CDEM_OK;
}

static cdem_status fill_values(const cdem_snapshot *s, const cdem_picture *p, double *value,
                               cdem_fault *fault) {
  switch (p->field) {
  case CDEM_GRAIN_VOLUMETRIC_STRAIN:
  case CDEM_GRAIN_EFFECTIVE_STRAIN:
    return strains(s, p, value, fault);
  case CDEM_GRAIN_PRESSURE:
  case CDEM_GRAIN_EFFECTIVE_STRESS: {
    double *stress;
    CDEM_NEW(stress, 6 * s->grains, fault);
    cdem_grain_stress_kernel(s, stress);
    if (p->field == CDEM_GRAIN_PRESSURE)
      pressures(s, stress, value);
    for (int64_t i = 0; p->field == CDEM_GRAIN_EFFECTIVE_STRESS && i < s->grains; i++)
      value[i] = cdem_effective_stress(s->dim, stress + 6 * i);
    free(stress);
    return CDEM_OK;
  }
  default:
    break;
  }
  for (int64_t i = 0; i < s->grains; i++)
    switch (p->field) {
    case CDEM_GRAIN_SPEED:
      value[i] = cdem_norm3(s->velocity + 3 * i);
      break;
    case CDEM_GRAIN_DISPLACEMENT:
      value[i] = cdem_norm3(s->displacement + 3 * i);
      break;
    case CDEM_GRAIN_ROTATION:
      value[i] = s->dim == 2 ? s->rotation[3 * i + 2] : cdem_norm3(s->rotation + 3 * i);
      break;
    case CDEM_GRAIN_CONTACTS:
      value[i] = s->touching[i];
      break;
    default:
      value[i] = s->radius[i];
    }
  return CDEM_OK;
}

cdem_status cdem_dem_picture(const cdem_dem *dem, const cdem_picture *picture, cdem_map *map,
                             cdem_fault *fault) {
  cdem_snapshot s;
  cdem_wall_surface walls = {0};
  bool coloured = picture->kind == CDEM_PICTURE_GRAINS || picture->kind == CDEM_PICTURE_BAND;
  bool strained = picture->field == CDEM_GRAIN_VOLUMETRIC_STRAIN ||
                  picture->field == CDEM_GRAIN_EFFECTIVE_STRAIN;
  CDEM_REQUIRE(!coloured || !strained || picture->strain != NULL, fault, CDEM_USAGE,
               "a picture of '%s' needs the reference state of the strains; make one with "
               "cdem_strain_reference_create when the run starts",
               cdem_grain_field_name((int)picture->field));
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  double *value = cdem_allocate(s.grains, sizeof *value, fault);
  cdem_status status = value != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK && coloured)
    status = fill_values(&s, picture, value, fault);
  if (status == CDEM_OK)
    status = cdem_wall_surface_make(dem, &walls, fault);
  if (status == CDEM_OK)
    status = cdem_picture_make(&s, &walls, value, picture, map, fault);
  cdem_wall_surface_release(&walls);
  free(value);
  cdem_snapshot_release(&s);
  return status;
}
