/* What a solver of grains is asked to accept: checks of the options, contact models. */
#include "dem/solver_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cdem_status check_materials(const cdem_dem_options *o, cdem_fault *fault) {
  const cdem_grains *g = o->grains;
  CDEM_REQUIRE(o->materials > 0 && o->material != NULL && o->contact != NULL, fault, CDEM_INPUT,
               "there are no materials, or nothing is known of their contact");
  CDEM_REQUIRE((int64_t)o->materials * o->materials <= CDEM_MODELS_MOST, fault, CDEM_INPUT,
               "%d materials; at most 16 are possible", o->materials);
  for (int m = 0; m < o->materials; m++)
    CDEM_REQUIRE(isfinite(o->material[m].density) && o->material[m].density > 0.0, fault,
                 CDEM_INPUT, "material '%s' has density %g kg/m^3; a density is positive",
                 o->material[m].name, o->material[m].density);
  for (int64_t i = 0; i < g->grains; i++) {
    int32_t m = g->material != NULL ? g->material[i] : 0;
    CDEM_REQUIRE(m >= 0 && m < o->materials, fault, CDEM_INPUT,
                 "grain %lld has material %d; there are %d", (long long)i, m, o->materials);
  }
  for (int w = 0; w < o->walls; w++)
    CDEM_REQUIRE(o->wall[w].material >= 0 && o->wall[w].material < o->materials, fault, CDEM_INPUT,
                 "wall '%s' has material %d; there are %d",
                 o->wall[w].name != NULL ? o->wall[w].name : "", o->wall[w].material, o->materials);
  return CDEM_OK;
}

static cdem_status check_motion(const cdem_grains *g, cdem_fault *fault) {
  for (int64_t i = 0; i < 3 * g->grains; i++) {
    bool known = (g->velocity == NULL || isfinite(g->velocity[i])) &&
                 (g->spin == NULL || isfinite(g->spin[i]));
    CDEM_REQUIRE(known, fault, CDEM_INPUT, "grain %lld has a velocity or spin that is not finite",
                 (long long)(i / 3));
  }
  return CDEM_OK;
}

static cdem_status check_numbers(const cdem_dem_options *o, cdem_fault *fault) {
  CDEM_REQUIRE(o->step >= 0.0 && isfinite(o->step), fault, CDEM_INPUT,
               "the time step is %g s; it is positive, or 0 for an automatic one", o->step);
  CDEM_REQUIRE(o->safety >= 0.0 && o->safety <= 1.0, fault, CDEM_INPUT,
               "the safety of the time step is %g; it is above 0, at most 1", o->safety);
  CDEM_REQUIRE(o->skin >= 0.0 && isfinite(o->skin), fault, CDEM_INPUT,
               "the skin is %g mean radii; it is positive, or 0 for an automatic one", o->skin);
  CDEM_REQUIRE(o->most_overlap >= 0.0 && isfinite(o->most_overlap), fault, CDEM_INPUT,
               "the largest overlap at the start is %g radii; it is not negative", o->most_overlap);
  CDEM_REQUIRE(o->mass_damping >= 0.0 && isfinite(o->mass_damping), fault, CDEM_INPUT,
               "mass damping is %g 1/s; it is not negative", o->mass_damping);
  CDEM_REQUIRE(o->local_damping >= 0.0 && o->local_damping < 1.0, fault, CDEM_INPUT,
               "local damping is %g; it is at least 0, below 1", o->local_damping);
  CDEM_REQUIRE(o->thickness >= 0.0 && isfinite(o->thickness), fault, CDEM_INPUT,
               "the thickness of discs is %g m; it is positive", o->thickness);
  for (int c = 0; c < 3; c++)
    CDEM_REQUIRE(isfinite(o->gravity[c]), fault, CDEM_INPUT, "gravity is not finite");
  CDEM_REQUIRE(o->grains->dim == 3 || o->gravity[2] == 0.0, fault, CDEM_INPUT,
               "gravity has a component %g m/s^2 along z; discs move in the plane z = 0",
               o->gravity[2]);
  return CDEM_OK;
}

cdem_status cdem_dem_check(const cdem_dem_options *o, cdem_fault *fault) {
  CDEM_REQUIRE(o->grains != NULL, fault, CDEM_INPUT, "there are no grains");
  CDEM_REQUIRE(o->law != NULL, fault, CDEM_INPUT, "there is no contact law");
  CDEM_TRY(cdem_grains_check(o->grains, fault));
  CDEM_REQUIRE(o->grains->grains < INT32_MAX, fault, CDEM_INPUT, "more than %d grains", INT32_MAX);
  CDEM_TRY(check_motion(o->grains, fault));
  CDEM_TRY(check_materials(o, fault));
  CDEM_TRY(check_numbers(o, fault));
  CDEM_REQUIRE(o->law->dims[o->grains->dim], fault, CDEM_INPUT, "the law '%s' does not know %s",
               o->law->name, o->grains->dim == 2 ? "discs" : "spheres");
  for (int w = 0; w < o->walls; w++)
    CDEM_TRY(cdem_wall_check(o->grains->dim, &o->wall[w], fault));
  if (o->cell != NULL)
    CDEM_TRY(cdem_cell_check(o->grains->dim, o->cell, fault));
  return CDEM_OK;
}

/* One model a pair of materials; both orders share it. */
cdem_status cdem_dem_models(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  const cdem_dem_options *o = &s->options;
  int n = o->materials;
  CDEM_NEW(core->model, (int64_t)n * (n + 1) / 2, fault);
  CDEM_NEW(core->model_of, (int64_t)n * n, fault);
  for (int a = 0; a < n; a++)
    for (int b = a; b < n; b++) {
      cdem_status status = cdem_contact_model_init(
          dem->dim, o->law, o->rolling, o->twisting, &o->contact[a * n + b], &o->material[a],
          &o->material[b], &core->model[core->models], fault);
      if (status != CDEM_OK) {
        if (fault != NULL)
          cdem_fault_prefix(fault, "contact of '%s' and '%s'", o->material[a].name,
                            o->material[b].name);
        return status;
      }
      core->model_of[a * n + b] = core->model_of[b * n + a] = core->models++;
    }
  s->histories = core->model[0].histories;
  memcpy(s->parity, core->model[0].parity, sizeof core->model[0].parity);
  return CDEM_OK;
}

/* The pairs of the list that overlap too much, but bonded ones. */
cdem_status cdem_dem_check_overlaps(const cdem_dem *dem, cdem_fault *fault) {
  const cdem_dem_store *s = dem->store;
  double bound = s->options.most_overlap > 0.0 ? s->options.most_overlap : 0.1, worst = bound;
  int64_t many = 0, at = -1;
  for (int64_t p = 0; p < s->pairs; p++) {
    const double *a = cdem_place(s, s->core->pair_owner[p]), *b = cdem_place(s, s->pair_other[p]);
    double d2 = 0.0;
    for (int c = 0; c < 3; c++) {
      double d = b[c] - a[c] + (s->pair_image != NULL ? s->image[s->pair_image[p]][c] : 0.0);
      d2 += d * d;
    }
    double overlap = (a[3] + b[3] - sqrt(d2)) / fmin(a[3], b[3]);
    if (overlap > bound && s->pair_touch[p] != 2) {
      many++;
      if (overlap > worst) {
        worst = overlap;
        at = p;
      }
    }
  }
  if (at < 0)
    return CDEM_OK;
  int32_t a = s->id[s->core->pair_owner[at]], b = s->id[s->pair_other[at]];
  const double *x = cdem_place(s, s->slot[a < b ? a : b]);
  return cdem_fail(fault, CDEM_INPUT,
                   "%lld pairs of grains overlap by more than %g radii at the start; the worst are "
                   "grains %d and %d near (%.4g, %.4g, %.4g m), by %.3g radii: move them apart or "
                   "raise the bound",
                   (long long)many, bound, a < b ? a : b, a < b ? b : a, x[0], x[1], x[2], worst);
}
