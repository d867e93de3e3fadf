/* Contact of a case, and the penalty stiffness it shares with plates.
 *
 * One kn for all: factor (lambda + 2G)/h of the stiffest material, h the mean size of a facet that
 * is, or can come, on the surface.
 */
#include "run/body.h"

static void find_scale(cdem_run_body *setup) {
  const cdem_blocks *blocks = &setup->blocks;
  double sum = 0.0;
  for (int32_t f = 0; f < blocks->facets; f++) {
    double area[3], share[4];
    double size = cdem_run_facet(setup, &blocks->facet[f], area, share);
    sum += blocks->dimension == 3 ? sqrt(size) : size / setup->section.thickness;
  }
  setup->contact_size = blocks->facets > 0 ? sum / blocks->facets : 1.0;
  for (int m = 0; m < setup->model.materials; m++)
    if (setup->moduli[m].wave > setup->contact_wave) {
      setup->contact_wave = setup->moduli[m].wave;
      setup->contact_ratio = setup->moduli[m].shear / setup->moduli[m].wave;
    }
}

double cdem_run_contact_stiffness(const cdem_run_body *setup) {
  const cdem_case_contact *contact = &cdem_run_values(setup->run)->contact;
  return contact->normal_stiffness > 0.0
             ? contact->normal_stiffness
             : contact->stiffness_factor * setup->contact_wave / setup->contact_size;
}

cdem_status cdem_run_body_contact(cdem_run_body *setup, cdem_fault *fault) {
  const cdem_case_contact *contact = &cdem_run_values(setup->run)->contact;
  find_scale(setup);
  if (!contact->active)
    return CDEM_OK;
  double kn = cdem_run_contact_stiffness(setup);
  double ratio = isnan(contact->shear_ratio) ? setup->contact_ratio : contact->shear_ratio;
  const cdem_contact_options options = {
      .blocks = &setup->blocks,
      .dofs = setup->body.dofs,
      .thickness = setup->section.thickness,
      .law = {.kn = kn,
              .kt = contact->shear_stiffness > 0.0 ? contact->shear_stiffness : ratio * kn,
              .friction = contact->friction,
              .damping = contact->damping},
      .skin = isnan(contact->skin) ? 0.0 : contact->skin,
      .mass = setup->body.mass,
      .threads = setup->run->threads};
  cdem_status status = cdem_contact_init(&options, &setup->contact, fault);
  setup->has_contact = status == CDEM_OK;
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, "contact", fault) : status;
}
