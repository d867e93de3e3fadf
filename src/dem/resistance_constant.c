/* Rolling resistance as a moment of constant size against the rolling (Zhou et al. 1999, Physica A
 * 269, 536; type A of Ai et al. 2011, Powder Technology 206, 269).
 *
 *     M = -(mu_r R + l) F_N w/|w|,  w the relative spin in the tangent plane
 *
 * The sign of w jumps through zero, so the moment is held below what would stop the rolling within
 * the step, I |w|/dt with I = 2/5 m R^2 (discs 1/2), the smallest inertia against rolling that two
 * grains of this reduced mass and radius can have: it cannot turn the rolling around. There is no
 * length and no time in that but the step itself; the price is that nothing ever comes to rest
 * under a moment, it creeps by an amount that falls with the step. For packings that stand still
 * choose "spring".
 */
#include "dem/law_lanes.h"
#include "dem/law_reference.h"

enum { MU, LENGTH };

static const double inertia[2] = {0.5, 0.4};

CDEM_ALWAYS_INLINE void constant_lanes(const cdem_law_parameters *parameters, cdem_batch *b,
                                       int dim, int energies) {
  const double mu = parameters->p[MU], length = parameters->p[LENGTH], step = b->step;
  const double slow = inertia[dim - 2] / step;
  const int count = lane_count(b);
  for (int i = 0; i < count; i++) {
    const lane_vector n = lane_normal(dim, b, i);
    const double radius = b->radius[i];
    lane_vector rate = lane_get(dim, b->spin, i);
    if (dim == 3)
      rate = lane_sum(3, rate, -lane_dot(3, rate, n), n);
    const double square = dim == 2 ? rate.x * rate.x : lane_dot(3, rate, rate);
    const double inverse = lane_inverse_root(square);
    const double cap = (mu * radius + length) * b->normal[i];
    /* moment by spin; at rest the second is the larger, and times no spin */
    const double factor = lane_min(slow * b->mass[i] * radius * radius, cap * inverse);
    const lane_vector moment = lane_scaled(dim, rate, factor);
    lane_put(dim, b->moment, i, lane_sum(dim, lane_get(dim, b->moment, i), 1.0, moment));
    if (energies) {
      const lane_vector gain = lane_get(dim, b->spin_gain, i);
      b->rolled[i] += step * lane_dot(dim, moment, lane_sum(dim, rate, 0.5, gain));
    }
  }
}

CDEM_MULTIVERSION static void constant_2(const cdem_law_parameters *p, int first, cdem_batch *b) {
  (void)first;
  constant_lanes(p, b, 2, 0);
}
CDEM_MULTIVERSION static void constant_2_energies(const cdem_law_parameters *p, int first,
                                                  cdem_batch *b) {
  (void)first;
  constant_lanes(p, b, 2, 1);
}
CDEM_MULTIVERSION static void constant_3(const cdem_law_parameters *p, int first, cdem_batch *b) {
  (void)first;
  constant_lanes(p, b, 3, 0);
}
CDEM_MULTIVERSION static void constant_3_energies(const cdem_law_parameters *p, int first,
                                                  cdem_batch *b) {
  (void)first;
  constant_lanes(p, b, 3, 1);
}

static void constant_one(const cdem_law_parameters *parameters, cdem_batch *b, int lane, int dim) {
  reference_contact c;
  reference_read(b, lane, dim, &c);
  reference_add(b, lane, &c);
  double cap = (parameters->p[MU] * c.radius + parameters->p[LENGTH]) * c.normal;
  reference_slowing(&c, cap, inertia[dim - 2] * c.mass * c.radius * c.radius);
  reference_write_moment(&c, b, lane);
}
static void constant_one_2(const cdem_law_parameters *p, int first, cdem_batch *b, int lane) {
  (void)first;
  constant_one(p, b, lane, 2);
}
static void constant_one_3(const cdem_law_parameters *p, int first, cdem_batch *b, int lane) {
  (void)first;
  constant_one(p, b, lane, 3);
}

static cdem_status constant_prepare(int dim, const cdem_contact_input *input, double shear,
                                    cdem_law_parameters *parameters, cdem_fault *fault) {
  (void)dim, (void)shear;
  double mu = input->value[CDEM_LAW_rolling_friction];
  double length = input->value[CDEM_LAW_rolling_length];
  CDEM_REQUIRE(!isnan(mu) || !isnan(length), fault, CDEM_INPUT,
               "rolling resistance 'constant' needs 'rolling_friction' or 'rolling_length'");
  parameters->p[MU] = isnan(mu) ? 0.0 : mu;
  parameters->p[LENGTH] = isnan(length) ? 0.0 : length;
  return CDEM_OK;
}

const cdem_resistance cdem_rolling_constant = {
    .name = "constant",
    .help = "Moment of constant size against the rolling (Zhou et al. 1999); never quite at rest.",
    .wants = 2,
    .want = {{CDEM_LAW_rolling_friction, false, NAN, 0.0, INFINITY, false},
             {CDEM_LAW_rolling_length, false, NAN, 0.0, INFINITY, false}},
    .prepare = constant_prepare,
    .batch = {{constant_2, constant_2_energies}, {constant_3, constant_3_energies}},
    .one = {constant_one_2, constant_one_3}};
