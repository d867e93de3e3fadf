/* A triaxial test of grains that deform: stages, columns and the membrane. */
#include "dem/frames_membrane.h"
#include "run/deformable.h"

cdem_status cdem_run_deformable_advance(cdem_run_deformable *d, int64_t steps, cdem_fault *fault) {
  cdem_run_triaxial *plan = &d->grains->triaxial;
  while (d->grains->has_triaxial && !plan->shears) {
    const cdem_run_now now = {.time = d->fdem.time, .step = d->fdem.step, .steps = d->fdem.steps};
    int64_t before = cdem_run_triaxial_steps(plan, &now);
    if (before > steps)
      break;
    CDEM_TRY(cdem_fdem_steps(&d->fdem, before, fault));
    steps -= before;
    if (before > 0)
      continue;
    cdem_specimen at;
    cdem_fdem_specimen(&d->fdem, &at);
    cdem_fdem_shear(&d->fdem, cdem_run_triaxial_shear(plan, at.height, at.volume));
  }
  return cdem_fdem_steps(&d->fdem, steps, fault);
}

void cdem_run_deformable_triaxial_columns(cdem_run_deformable *d, cdem_run_row *row) {
  cdem_run_specimen specimen = {0};
  cdem_specimen at = {0};
  if (!d->grains->has_triaxial)
    return;
  if (!row->declare) {
    double force[3], center[3], velocity[3];
    cdem_fdem_specimen(&d->fdem, &at);
    cdem_fdem_wall_now(&d->fdem, d->grains->confinement.high, force, center, velocity);
    specimen = (cdem_run_specimen){.pressure = at.pressure,
                                   .height = at.height,
                                   .volume = at.volume,
                                   .axial = at.axial,
                                   .bottom = at.bottom,
                                   .lateral = at.lateral,
                                   .speed = velocity[2]};
  }
  cdem_run_triaxial_columns(&d->grains->triaxial, &specimen, row);
  cdem_run_put(row, "", (double)at.touching, "membrane_touching");
}

cdem_status cdem_run_deformable_membrane(const cdem_run_deformable *d, int64_t index,
                                         const cdem_frame_sink *sink, cdem_fault *fault) {
  const cdem_membrane *membrane = cdem_fdem_membrane(&d->fdem);
  return membrane != NULL ? cdem_membrane_frame(membrane, d->fdem.time, index, sink, fault)
                          : CDEM_OK;
}
