/* The largest stable step.
 *
 * Contacts of stiffness k_1, k_2, ... of a grain against its rigid motion give omega^2 <= 2 S (1/m
 * + a^2/I) with S their sum, a the reach of the grain and I its smallest moment of inertia; the 2
 * stands for the partners, which move too. Against the modes a contact at one node adds 2 k times
 * how that node gives way within a step: at most mobility dt^2/(rho s^3) and, in the implicit
 * scheme, at most compliance/s whatever the step. Stable is dt^2 omega^2 < 4 (explicit central
 * differences), the highest mode of the grains itself included where modes are explicit. The
 * stiffness at one node is taken as four nodes' penalty: two of each of the two surfaces. So omega
 * of one node is half of what is reckoned with, and its dashpot, whose force lags half a step
 * behind, has room up to dt omega/2 = 2 (sqrt(1 + beta^2) - beta): that is beyond the limit
 * without it unless beta is above 3/4.
 */
#include "fdem/confine.h"

/* Largest penalty of a material against any other, along the normal or across. */
static double penalty_of(const cdem_fdem_options *o, int material) {
  double most = 0.0;
  for (int m = 0; m < o->materials; m++) {
    const cdem_fdem_contact_law *law = o->law + (int64_t)material * o->materials + m;
    most = fmax(most, law->penalty * fmax(1.0, law->shear_ratio));
  }
  return most;
}

/* What strong dashpots leave of the step. */
static double left_by_dashpots(const cdem_fdem_options *o, int material) {
  double beta = 0.0;
  for (int m = 0; m < o->materials; m++)
    beta = fmax(beta, o->law[(int64_t)material * o->materials + m].damping_ratio);
  return fmin(1.0, 2.0 / (sqrt(1.0 + beta * beta) + beta));
}

/* Bound of the largest eigenvalue of the inverse inertia: 1 over the smallest moment. */
static double lightest_turn(const double inverse[9]) {
  double most = 0.0;
  for (int i = 0; i < 3; i++)
    most = fmax(most, fabs(inverse[3 * i]) + fabs(inverse[3 * i + 1]) + fabs(inverse[3 * i + 2]));
  return most;
}

static double largest_area(const cdem_skin *surface) {
  double most = 0.0;
  for (int32_t i = 0; i < surface->nodes; i++)
    most = fmax(most, surface->area[i]);
  return most;
}

static double elastic_limit(const cdem_fdem_store *s, int64_t g) {
  const cdem_fdem_options *o = &s->options;
  const cdem_template *t = cdem_fdem_template(s, g);
  double size = s->radius[g], density = o->density[s->material[g]];
  double local = 4.0 * penalty_of(o, s->material[g]) * size * size * largest_area(&t->surface);
  double stiff = fmax(s->stiff[g], local), reach = size * t->surface.reach;
  double rigid = 2.0 * stiff * (1.0 / s->mass[g] + reach * reach * lightest_turn(s->spins + 9 * g));
  double fast = 2.0 * local * t->mobility / (density * size * size * size);
  if (o->integration == CDEM_FDEM_EXPLICIT)
    return 2.0 / sqrt(rigid + fast + t->lambda[t->modes - 1] / (density * size * size));
  double slow = 2.0 * local * t->compliance / size;
  double step = 2.0 / sqrt(rigid + fast);
  return slow < 4.0 ? fmax(step, sqrt((4.0 - slow) / rigid)) : step;
}

static double limit_of(const cdem_fdem_store *s, int64_t g) {
  return left_by_dashpots(&s->options, s->material[g]) * elastic_limit(s, g);
}

double cdem_fdem_limit(const cdem_fdem *fdem) {
  double least = INFINITY;
  for (int64_t g = 0; g < fdem->grains; g++)
    least = fmin(least, limit_of(fdem->store, g));
  return fdem->store->confine != NULL ? fmin(least, cdem_fdem_confine_limit(fdem->store)) : least;
}

static double safety_of(const cdem_fdem *fdem) {
  double safety = fdem->store->options.safety;
  return safety > 0.0 ? safety : 0.5;
}

cdem_status cdem_fdem_first_step(cdem_fdem *fdem, cdem_fault *fault) {
  double limit = cdem_fdem_limit(fdem), step = fdem->store->options.step;
  CDEM_REQUIRE(step <= limit, fault, CDEM_INPUT,
               "the step %g s is unstable: %g s is the largest for these deformable grains and "
               "their contacts; leave it out for an automatic one",
               step, limit);
  fdem->step = step > 0.0 ? step : safety_of(fdem) * limit;
  fdem->store->kick = fdem->step;
  return CDEM_OK;
}

/* An automatic step follows the contacts, down soon and up late. */
void cdem_fdem_follow(cdem_fdem *fdem) {
  cdem_fdem_store *s = fdem->store;
  if (s->options.step > 0.0)
    return;
  double wanted = safety_of(fdem) * cdem_fdem_limit(fdem);
  if (wanted >= fdem->step && wanted < 1.5 * fdem->step)
    return;
  s->base_time = fdem->time;
  s->base_steps = fdem->steps;
  double old = fdem->step;
  s->kick = 0.5 * (old + wanted);
  fdem->step = wanted;
  if (s->confine != NULL)
    cdem_fdem_confine_change_step(fdem, old);
}
