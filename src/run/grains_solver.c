/* The solver of grains and its time step.
 *
 * The step is a fraction of the largest stable one, and a whole number of them ends at `end`.
 * Contacts come and go and stiffen on the way (Hertz): at every row an automatic step that is no
 * longer near its fraction is taken anew, and a given one that has become unstable ends the run.
 */
#include "run/grains.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

static void fill_options(cdem_run_grains *g) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  const cdem_case_grains *wanted = &v->grains;
  bool resists = wanted->rolling > 0, twists = wanted->twisting > 0;
  g->options = (cdem_dem_options){.grains = &g->grains,
                                  .thickness = v->thickness,
                                  .materials = g->materials,
                                  .material = g->material,
                                  .law = cdem_law_at(wanted->law),
                                  .rolling = resists ? cdem_rolling_at(wanted->rolling) : NULL,
                                  .twisting = twists ? cdem_twisting_at(wanted->twisting) : NULL,
                                  .contact = g->contact,
                                  .walls = g->walls,
                                  .wall = g->wall,
                                  .bond_laws = g->bond_law != NULL ? (int)v->bonds.count : 0,
                                  .bond_law = g->bond_law,
                                  .bonds = g->bonds,
                                  .bond = g->bond,
                                  .cell = g->has_cell ? &g->cell : NULL,
                                  .confinement = g->has_triaxial ? &g->confinement : NULL,
                                  .mass_damping = v->mass_damping,
                                  .local_damping = v->local_damping,
                                  .safety = v->safety,
                                  .skin = isnan(wanted->skin) ? 0.0 : wanted->skin,
                                  .most_overlap = wanted->most_overlap,
                                  .energies = true,
                                  .threads = g->run->threads};
  for (int k = 0; k < 3; k++)
    g->options.gravity[k] = v->gravity[k];
}

/* A team is worth its while from some thousand grains on; below, waiting for each other costs more,
 * many times more where other work has the processors. */
int cdem_run_grains_threads(const cdem_run_grains *g) {
  enum { GRAINS_A_THREAD = 2000 };
  int asked = g->run->options->threads, most = omp_get_max_threads();
  int64_t worth = g->grains.grains / GRAINS_A_THREAD;
  return asked > 0 ? asked : worth < 1 ? 1 : worth < most ? (int)worth : most;
}

/* The key that a failure of the solver's making has to do with. */
static const char *key_of(const cdem_run_grains *g, const char *message, char key[96]) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  if (cdem_run_wall_key(g->run, message, key) != NULL)
    return key;
  if (strstr(message, "cell") != NULL && g->has_cell)
    return "cell";
  if (strstr(message, "bond") != NULL && g->bonds > 0)
    return "bonds";
  return v->grains.file != NULL ? "grains.file" : "grains.packing";
}

static cdem_status divide_end(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  double wanted = isnan(v->step) ? g->dem.step : v->step;
  cdem_status status = cdem_dem_set_step(&g->dem, cdem_run_even_step(g->run, wanted), fault);
  return status == CDEM_INPUT ? cdem_case_blame(&g->run->cases, "step", fault) : status;
}

cdem_status cdem_run_grains_solver(cdem_run_grains *g, cdem_fault *fault) {
  cdem_case_values *v = &g->run->cases.values;
  char key[96];
  cdem_fault local = {0};
  if (!cdem_case_given(&g->run->cases, "safety"))
    v->safety = 0.1;
  g->run->threads = cdem_run_grains_threads(g);
  fill_options(g);
  cdem_status status = cdem_dem_init(&g->options, &g->dem, &local);
  if (status != CDEM_OK)
    return cdem_run_refused(g->run, key_of(g, local.message, key), status, local.message, fault);
  double limit;
  CDEM_TRY(cdem_dem_limit(&g->dem, &limit, g->run->limiter, fault));
  CDEM_TRY(cdem_run_check_step(g->run, limit, fault));
  if (v->analysis == CDEM_ANALYSIS_DYNAMIC)
    return divide_end(g, fault);
  return isnan(v->step) ? CDEM_OK : cdem_dem_set_step(&g->dem, v->step, fault);
}

cdem_status cdem_run_grains_look(cdem_run_setup *run, cdem_fault *fault) {
  cdem_run_grains *g = run->context;
  const cdem_case_values *v = cdem_run_values(run);
  char limiter[64];
  double limit, step = g->dem.step;
  CDEM_TRY(cdem_dem_limit(&g->dem, &limit, limiter, fault));
  if (!isnan(v->step))
    return cdem_run_check_stable(run, limit, limiter, fault);
  double wanted = v->safety * limit;
  if (step <= 1.2 * wanted && step >= 0.6 * wanted) /* a new step costs a little accuracy */
    return CDEM_OK;
  memcpy(run->limiter, limiter, sizeof limiter);
  double left = v->end - g->dem.time;
  double even = left > wanted ? left / ceil(left / wanted - 1e-9) : wanted; /* NaN without an end */
  return cdem_dem_set_step(&g->dem, even, fault);
}
