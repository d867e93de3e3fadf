/* The law of penalty springs against sums over nodes, lens volumes and the oscillator that its
 * collisions are. */
#include "dem/law_damping.h"
#include "law_support.h"

static const double penalty = 1.8e11;

static cdem_contact_model penalty_model(cdem_law_key damping, double value, double friction) {
  cdem_contact_model model;
  cdem_contact_input input = no_input();
  input.value[CDEM_LAW_penalty_stiffness] = penalty;
  input.value[CDEM_LAW_friction] = friction;
  input.value[damping] = value;
  make_model(3, cdem_law_find("penalty"), NULL, NULL, &input, &model);
  return model;
}

/* Push of a contact at rest; radius b infinite: a wall. */
static double push(double ra, double rb, double overlap) {
  cdem_contact_model model = penalty_model(CDEM_LAW_damping_ratio, 0.2, 0.3);
  static cdem_batch b;
  bool wall = isinf(rb);
  memset(&b, 0, sizeof b);
  b.count = 1;
  b.step = 1e-6;
  b.n[0][0] = b.mass[0] = 1.0;
  b.arm[0][0] = ra;
  b.arm[1][0] = wall ? 0.0 : rb;
  b.radius[0] = wall ? ra : ra * rb / (ra + rb);
  b.overlap[0] = overlap;
  evaluate(3, &model, true, false, &b);
  return b.normal[0];
}

/* Integral of the depth over the part of the surface of A that is inside B: nodes without number,
 * rings about the axis by the midpoint rule. */
static double nodes(double ra, double rb, double overlap) {
  const int rings = 20000;
  bool wall = isinf(rb);
  double sum = 0.0, most = 4.0 * sqrt(overlap / ra), apart = ra + rb - overlap;
  for (int i = 0; i < rings; i++) {
    double angle = most * (i + 0.5) / rings, x = ra * cos(angle), y = ra * sin(angle);
    double depth = wall ? x - (ra - overlap) : rb - hypot(apart - x, y);
    sum += fmax(0.0, depth) * 2.0 * M_PI * y * ra * most / rings;
  }
  return sum;
}

static void the_force_is_that_of_many_nodes(void **state) {
  (void)state;
  static const double other[] = {7.5e-3, 15e-3, 30e-3, INFINITY};
  for (size_t k = 0; k < sizeof other / sizeof *other; k++) {
    double ra = 7.5e-3, rb = other[k], off[3];
    for (int fine = 0; fine < 3; fine++) {
      double d = 0.02 * ra / (1 << fine);
      double sum = nodes(ra, rb, d) + (isinf(rb) ? 0.0 : nodes(rb, ra, d));
      off[fine] = push(ra, rb, d) / (penalty * sum) - 1.0;
      check_below(fabs(off[fine]), 0.5 * d / ra); /* first order in the overlap, and small */
    }
    check_near(off[0] - off[1], 2.0 * (off[1] - off[2]), 0.05, 1e-5);
  }
}

static void the_lens_is_a_little_smaller(void **state) {
  (void)state;
  double r = 7.5e-3, d = 1e-3 * r, apart = 2.0 * r - d;
  /* two caps of height d/2, and one of height d */
  double lens = 2.0 * M_PI * (d / 2.0) * (d / 2.0) * (3.0 * r - d / 2.0) / 3.0;
  double cap = M_PI * d * d * (3.0 * r - d) / 3.0;
  check_near(lens, M_PI * d * d * (apart * apart + 4.0 * apart * r) / (12.0 * apart), 1e-12, 0.0);
  check_near(2.0 * penalty * lens / push(r, r, d), 1.0 - d / (6.0 * r), 1e-9, 0.0);
  check_near(penalty * cap / push(r, INFINITY, d), 1.0 - d / (3.0 * r), 1e-9, 0.0);
}

static double restitution_of(const cdem_contact_model *model, bool wall, double speed) {
  two_body t;
  two_body_init(&t, 3, wall, model, 7.5e-3, 15e-3, 2650.0);
  int axis = wall ? 2 : 0;
  double mass = wall ? t.mass[0] : t.mass[0] * t.mass[1] / (t.mass[0] + t.mass[1]);
  double k = wall ? M_PI * penalty * 7.5e-3 : 2.0 * M_PI * penalty * 5e-3;
  t.step = 1e-3 * cbrt(mass / (k * speed)); /* a collision lasts about (m/kv)^(1/3) */
  t.x[0][axis] = wall ? t.radius[0] : 0.0;
  t.v[0][axis] = wall ? -speed : speed;
  t.x[1][0] = t.radius[0] + t.radius[1];
  two_body_collide(&t, 1000000);
  return wall ? t.v[0][2] / speed : (t.v[1][0] - t.v[0][0]) / speed;
}

static void restitution_does_not_depend_on_velocity(void **state) {
  (void)state;
  const double e = cdem_law_restitution(0.2 * sqrt(4.0 / 3.0));
  cdem_contact_model ratio = penalty_model(CDEM_LAW_damping_ratio, 0.2, 0.0);
  cdem_contact_model asked = penalty_model(CDEM_LAW_restitution, 0.6, 0.0);
  for (int wall = 0; wall < 2; wall++)
    for (double speed = 0.01; speed < 20.0; speed *= 10.0) {
      check_near(restitution_of(&ratio, wall, speed), e, 1e-3, 0.0);
      check_near(restitution_of(&asked, wall, speed), 0.6, 1e-3, 0.0);
    }
}

/* Work into the contact from 0 to d is k d^3/3, and all of it is stored. */
static void the_spring_stores_its_work(void **state) {
  (void)state;
  cdem_contact_model model = penalty_model(CDEM_LAW_restitution, 1.0, 0.0);
  for (int wall = 0; wall < 2; wall++) {
    two_body t;
    two_body_init(&t, 3, wall, &model, 7.5e-3, 7.5e-3, 2650.0);
    double speed = 0.5, most = 0.0, first;
    t.step = 2e-7;
    t.x[0][2] = wall ? t.radius[0] : 0.0;
    t.v[0][wall ? 2 : 0] = wall ? -speed : speed;
    t.x[1][0] = 2.0 * t.radius[0];
    first = 0.5 * t.mass[0] * speed * speed;
    for (int i = 0; i < 20000; i++) {
      two_body_step(&t);
      most = fmax(most, fabs(t.kinetic + t.stored + t.lost - first));
    }
    check_below(most, 1e-5 * first);
    check_near(t.kinetic, first, 1e-5, 0.0);
  }
}

static void discs_and_wrong_words_are_refused(void **state) {
  (void)state;
  cdem_contact_model model;
  cdem_fault fault = {0};
  cdem_contact_input input = no_input();
  const cdem_law *law = cdem_law_find("penalty");
  input.value[CDEM_LAW_damping_ratio] = 0.2;
  check_fails(cdem_contact_model_init(3, law, NULL, NULL, &input, &glass, &glass, &model, &fault),
              CDEM_INPUT, "needs 'penalty_stiffness'");
  input.value[CDEM_LAW_penalty_stiffness] = penalty;
  check_fails(cdem_contact_model_init(2, law, NULL, NULL, &input, &glass, &glass, &model, &fault),
              CDEM_INPUT, "law 'penalty' does not know discs");
  input.value[CDEM_LAW_normal_stiffness] = 1e6;
  check_fails(cdem_contact_model_init(3, law, NULL, NULL, &input, &glass, &glass, &model, &fault),
              CDEM_INPUT, "'normal_stiffness' is not used by law 'penalty'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_force_is_that_of_many_nodes),
      cmocka_unit_test(the_lens_is_a_little_smaller),
      cmocka_unit_test(restitution_does_not_depend_on_velocity),
      cmocka_unit_test(the_spring_stores_its_work),
      cmocka_unit_test(discs_and_wrong_words_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
