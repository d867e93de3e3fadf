/* A triaxial test of grains that deform: stages, columns and the membrane. */
#include "dem/frames_membrane.h"
#include "run/deformable.h"

static cdem_run_now now_of(const void *solver) {
  const cdem_fdem *fdem = solver;
  return (cdem_run_now){.time = fdem->time, .step = fdem->step, .steps = fdem->steps};
}

static cdem_status steps_of(void *solver, int64_t steps, cdem_fault *fault) {
  return cdem_fdem_steps(solver, steps, fault);
}

static void specimen_of(const void *solver, cdem_specimen *specimen) {
  cdem_fdem_specimen(solver, specimen);
}

static void shear_of(void *solver, double velocity) {
  cdem_fdem_shear(solver, velocity);
}

static cdem_run_triaxial_host host_of(cdem_run_deformable *d) {
  return (cdem_run_triaxial_host){&d->fdem, now_of, steps_of, specimen_of, shear_of};
}

cdem_status cdem_run_deformable_advance(cdem_run_deformable *d, int64_t steps, cdem_fault *fault) {
  const cdem_run_triaxial_host host = host_of(d);
  return d->grains->has_triaxial
             ? cdem_run_triaxial_advance(&d->grains->triaxial, &host, steps, fault)
             : cdem_fdem_steps(&d->fdem, steps, fault);
}

void cdem_run_deformable_triaxial_columns(cdem_run_deformable *d, cdem_run_row *row) {
  const cdem_run_triaxial_host host = host_of(d);
  if (d->grains->has_triaxial)
    cdem_run_triaxial_columns(&d->grains->triaxial, &host, row);
}

cdem_status cdem_run_deformable_membrane(const cdem_run_deformable *d, int64_t index,
                                         const cdem_frame_sink *sink, cdem_fault *fault) {
  const cdem_membrane *membrane = cdem_fdem_membrane(&d->fdem);
  return membrane != NULL ? cdem_membrane_frame(membrane, d->fdem.time, index, sink, fault)
                          : CDEM_OK;
}
