/* Bodies of which every element is a block, in solvers. */
#ifndef CDEM_TESTS_CDEM_JOINTS_SUPPORT_H
#define CDEM_TESTS_CDEM_JOINTS_SUPPORT_H

#include "solver_support.h"

/* A rig whose every element is a block. */
typedef struct {
  rig r;
  cdem_interface_law law;
  int32_t *law_of;
  cdem_interfaces interfaces;
  cdem_contact contact;
} jointed;

static inline cdem_interface_law glue(cdem_insertion insertion, double strength) {
  return (cdem_interface_law){.insertion = insertion,
                              .softening = CDEM_SOFTENING_BRITTLE,
                              .kn = 1e11,
                              .ks = 1e11,
                              .tension = strength,
                              .cohesion = 2.0 * strength,
                              .friction = 0.3};
}

static inline void make_jointed(const rig_options *o, cdem_interface_law law, bool touching,
                                jointed *j) {
  cdem_fault fault = {0};
  const char *all[] = {"body"};
  memset(j, 0, sizeof *j);
  rig_make(o, &j->r);
  cdem_body_release(&j->r.body);
  cdem_model_release(&j->r.model);
  cdem_blocks_release(&j->r.blocks);
  cdem_blocks_options cut = {.mesh = &j->r.mesh, .breakable = 1, .breakable_group = all};
  check_ok(cdem_blocks_init(&cut, &j->r.blocks, &fault));
  cdem_material material = cdem_material_isotropic(o->young, o->poisson);
  cdem_model_options model = {.mesh = &j->r.blocks.mesh,
                              .materials = 1,
                              .material = &material,
                              .default_material = 0,
                              .section = {o->plane, o->thickness}};
  check_ok(cdem_model_init(&model, &j->r.model, &fault));
  cdem_body_options body = {.density = &j->r.density, .linear = o->linear, .threads = o->threads};
  check_ok(cdem_body_init(&j->r.model, &body, &j->r.body, &fault));
  j->law = law;
  j->law_of = calloc((size_t)j->r.blocks.pairs, sizeof *j->law_of);
  cdem_interfaces_options joints = {.blocks = &j->r.blocks,
                                    .dofs = j->r.body.dofs,
                                    .thickness = o->thickness,
                                    .laws = 1,
                                    .law = &j->law,
                                    .law_of = j->law_of,
                                    .release = 0.05,
                                    .threads = o->threads};
  check_ok(cdem_interfaces_init(&joints, &j->interfaces, &fault));
  j->r.options.interfaces = &j->interfaces;
  if (!touching)
    return;
  cdem_contact_options contact = {.blocks = &j->r.blocks,
                                  .dofs = j->r.body.dofs,
                                  .thickness = o->thickness,
                                  .law = {1e11, 1e11, 0.3, 0.0},
                                  .mass = j->r.body.mass,
                                  .threads = o->threads};
  check_ok(cdem_contact_init(&contact, &j->contact, &fault));
  j->r.options.contact = &j->contact;
}

static inline void release_jointed(jointed *j) {
  cdem_solver_release(&j->r.solver);
  cdem_interfaces_release(&j->interfaces);
  cdem_contact_release(&j->contact);
  free(j->law_of);
  rig_release(&j->r);
}

#endif
