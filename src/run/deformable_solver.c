/* From the case to the solver of grains that deform. */
#include "io/case_file.h"
#include "io/io.h"
#include "run/deformable.h"

#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- templates ---- */

static cdem_status read_shape(const cdem_run_deformable *d, cdem_mesh *mesh, cdem_fault *fault) {
  const char *file = cdem_run_deformable_values(d)->grains.deformable.file;
  if (file == NULL)
    return CDEM_OK;
  char *path = cdem_case_file_path(&d->run->cases, file, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = cdem_read_mesh(path, mesh, d->run->options->warnings, fault);
  free(path);
  return status == CDEM_INPUT || status == CDEM_FILE
             ? cdem_case_blame(&d->run->cases, "grains.deformable.file", fault)
             : status;
}

static cdem_status elastic(const cdem_run_deformable *d, int m, cdem_material *material,
                           cdem_fault *fault) {
  const cdem_grain_material *from = &d->grains->material[m];
  char key[96];
  if (isnan(from->young) || isnan(from->poisson))
    return cdem_case_fail(
        &d->run->cases, cdem_run_named_key(key, "grains.materials", from->name, ""), CDEM_INPUT,
        fault, "material '%s' of deformable grains needs 'young' and 'poisson'", from->name);
  *material = cdem_material_isotropic(from->young, from->poisson);
  snprintf(material->name, sizeof material->name, "%s", from->name);
  return CDEM_OK;
}

static const char *shape_key(const cdem_run_deformable *d, const char *message) {
  static const char key[] = "grains.deformable.refinement";
  bool own = strstr(message, "refinement") != NULL && cdem_case_given(&d->run->cases, key);
  return own ? key : "grains.deformable";
}

/* One template for each material of grains. */
static cdem_status make_shapes(cdem_run_deformable *d, const cdem_mesh *mesh, cdem_fault *fault) {
  const cdem_case_deformable *wanted = &cdem_run_deformable_values(d)->grains.deformable;
  cdem_run_grains *g = d->grains;
  int32_t *of = NULL;
  CDEM_NEW(d->shape, g->materials, fault);
  CDEM_NEW(d->shape_of, g->grains.grains, fault);
  CDEM_NEW(of, g->materials, fault);
  cdem_status status = CDEM_OK;
  for (int m = 0; m < g->materials && status == CDEM_OK; m++) {
    cdem_material material;
    cdem_template_options options = {
        .shape = cdem_grain_shape_at(wanted->shape),
        .options = {.refinement = (int)wanted->refinement, .mesh = mesh},
        .material = &material,
        .modes = (int)(wanted->modes < INT_MAX ? wanted->modes : INT_MAX)};
    if (!g->of_grains[m])
      continue;
    status = elastic(d, m, &material, fault);
    if (status == CDEM_OK) {
      status = cdem_template_init(&options, false, &d->shape[d->shapes], fault);
      if (status == CDEM_INPUT || status == CDEM_NUMERIC)
        status = cdem_case_blame(&d->run->cases, shape_key(d, fault->message), fault);
    }
    of[m] = d->shapes;
    d->shapes += status == CDEM_OK;
  }
  for (int64_t i = 0; i < g->grains.grains && status == CDEM_OK; i++)
    d->shape_of[i] = of[g->grains.material[i]];
  free(of);
  return status;
}

/* ---- laws ---- */

static double or_else(double value, double otherwise) {
  return isnan(value) ? otherwise : value;
}

/* Words of the law that mean nothing node by node. */
static cdem_status check_words(const cdem_run_deformable *d, int entry, const double *value,
                               cdem_fault *fault) {
  const cdem_case *cases = &d->run->cases;
  char key[96];
  if (isnan(value[CDEM_LAW_penalty_stiffness]))
    return cdem_case_fail(cases, cdem_run_key(key, "contacts", entry, ""), CDEM_INPUT, fault,
                          "contacts of deformable grains need 'penalty_stiffness'");
  if (!isnan(value[CDEM_LAW_restitution]))
    return cdem_case_fail(cases, cdem_run_key(key, "contacts", entry, "restitution"), CDEM_INPUT,
                          fault,
                          "nodes of deformable grains are damped one by one: give "
                          "'damping_ratio', not 'restitution'");
  if (!isnan(value[CDEM_LAW_shear_damping_ratio]))
    return cdem_case_fail(
        cases, cdem_run_key(key, "contacts", entry, "shear_damping_ratio"), CDEM_INPUT, fault,
        "nodes of deformable grains have one 'damping_ratio' for both directions; "
        "leave it out");
  if (value[CDEM_LAW_shear_ratio] == 0.0)
    return cdem_case_fail(cases, cdem_run_key(key, "contacts", entry, "shear_ratio"), CDEM_INPUT,
                          fault,
                          "the shear ratio of deformable grains is 0 and must be positive; let "
                          "'friction' be 0 for contacts without shear");
  return CDEM_OK;
}

static cdem_status make_laws(cdem_run_deformable *d, cdem_fault *fault) {
  const cdem_run_grains *g = d->grains;
  int count = g->materials;
  CDEM_NEW(d->law, (int64_t)count * count, fault);
  CDEM_NEW(d->density, count, fault);
  for (int m = 0; m < count; m++)
    d->density[m] = g->material[m].density;
  for (int i = 0; i < count * count; i++) {
    const double *value = g->contact[i].value;
    cdem_fdem_contact_law *law = &d->law[i];
    if (g->contact_entry[i] >= 0)
      CDEM_TRY(check_words(d, g->contact_entry[i], value, fault));
    *law = (cdem_fdem_contact_law){.penalty = value[CDEM_LAW_penalty_stiffness],
                                   .shear_ratio = or_else(value[CDEM_LAW_shear_ratio], 1.0),
                                   .friction = or_else(value[CDEM_LAW_friction], 0.0),
                                   .damping_ratio = or_else(value[CDEM_LAW_damping_ratio], 0.0)};
  }
  return CDEM_OK; /* materials that never meet share the numbers of a pair that does */
}

/* ---- orientations ---- */

/* Even over all rotations (Shoemake 1992). */
static void random_turn(cdem_random *random, double q[4]) {
  const double turn = 6.28318530717958648;
  double u = cdem_random_uniform(random, 0.0, 1.0);
  double a = cdem_random_uniform(random, 0.0, turn), b = cdem_random_uniform(random, 0.0, turn);
  q[0] = sqrt(1.0 - u) * sin(a);
  q[1] = sqrt(1.0 - u) * cos(a);
  q[2] = sqrt(u) * sin(b);
  q[3] = sqrt(u) * cos(b);
}

static cdem_status orient(cdem_run_deformable *d, cdem_fault *fault) {
  const cdem_case_deformable *wanted = &cdem_run_deformable_values(d)->grains.deformable;
  cdem_random random = {.state = (uint64_t)wanted->seed};
  if (wanted->aligned)
    return CDEM_OK;
  CDEM_NEW(d->orientation, 4 * d->grains->grains.grains, fault);
  for (int64_t i = 0; i < d->grains->grains.grains; i++)
    random_turn(&random, d->orientation + 4 * i);
  return CDEM_OK;
}

/* ---- the solver ---- */

static cdem_fdem_options options_of(const cdem_run_deformable *d) {
  const cdem_case_values *v = cdem_run_deformable_values(d);
  const cdem_run_grains *g = d->grains;
  cdem_fdem_options options = {
      .grains = {.grains = g->grains.grains,
                 .xyz = g->grains.xyz,
                 .radius = g->grains.radius,
                 .shape = d->shape_of,
                 .material = g->grains.material,
                 .orientation = d->orientation,
                 .velocity = g->grains.velocity,
                 .spin = g->grains.spin},
      .shapes = d->shapes,
      .shape = d->shape,
      .materials = g->materials,
      .density = d->density,
      .law = d->law,
      .walls = g->walls,
      .wall = g->wall,
      .confinement = g->has_triaxial ? &g->confinement : NULL,
      .mass_damping = v->mass_damping,
      .damping_ratio = v->grains.deformable.damping_ratio,
      .integration =
          v->grains.deformable.integration == 0 ? CDEM_FDEM_IMPLICIT : CDEM_FDEM_EXPLICIT,
      .step = isnan(v->step) ? 0.0 : v->step,
      .safety = cdem_case_given(&d->run->cases, "safety") ? v->safety : 0.0,
      .skin = isnan(v->grains.skin) ? 0.0 : v->grains.skin,
      .threads = d->run->threads};
  memcpy(options.gravity, v->gravity, sizeof options.gravity);
  return options;
}

/* The key that a failure of the solver's making has to do with. */
static const char *key_of(const cdem_run_deformable *d, const char *message, char key[96]) {
  if (cdem_run_wall_key(d->run, message, key) != NULL)
    return key;
  return strstr(message, "step") != NULL ? "step" : "grains.deformable";
}

cdem_status cdem_run_deformable_solver(cdem_run_deformable *d, cdem_fault *fault) {
  cdem_mesh mesh = {0};
  cdem_fault local = {0};
  char key[96];
  cdem_status status = read_shape(d, &mesh, fault);
  if (status == CDEM_OK)
    status = make_shapes(d, &mesh, fault);
  cdem_mesh_release(&mesh);
  CDEM_TRY(status);
  CDEM_TRY(make_laws(d, fault));
  CDEM_TRY(orient(d, fault));
  d->run->threads = d->run->options->threads > 0 ? d->run->options->threads : omp_get_max_threads();
  cdem_fdem_options options = options_of(d);
  status = cdem_fdem_init(&options, &d->fdem, &local);
  if (status != CDEM_OK)
    return cdem_run_refused(d->run, key_of(d, local.message, key), status, local.message, fault);
  snprintf(d->run->limiter, sizeof d->run->limiter, "%s of deformable grains",
           options.integration == CDEM_FDEM_IMPLICIT ? "contacts" : "vibrations");
  return cdem_run_check_step(d->run, cdem_fdem_limit(&d->fdem), fault);
}
