/* Room cdem: the law of one interface point, against its closed forms and its energies. */
#include "cdem/interfaces.h"
#include "support/test.h"

static cdem_fault fault;

static const cdem_interface_law law = {.softening = CDEM_SOFTENING_LINEAR,
                                       .kn = 1e13,
                                       .ks = 4e12,
                                       .tension = 1e6,
                                       .cohesion = 3e6,
                                       .friction = 0.3,
                                       .energy_1 = 10,
                                       .energy_2 = 50};

/* A driven point and its book. work: of the tractions by the trapezoidal rule. */
typedef struct {
  cdem_interface_law law;
  cdem_interface_point point;
  double delta[3], traction[3];
  double work, stored, fracture, friction;
  double peak_n, peak_s;
} specimen;

static specimen specimen_of(const cdem_interface_law *chosen) {
  return (specimen){.law = *chosen};
}

static void drive(specimen *s, double n, double t1, double t2, int steps) {
  const double from[3] = {s->delta[0], s->delta[1], s->delta[2]}, to[3] = {n, t1, t2};
  for (int i = 1; i <= steps; i++) {
    double delta[3], traction[3];
    cdem_interface_work work;
    for (int k = 0; k < 3; k++)
      delta[k] = i == steps ? to[k] : from[k] + (to[k] - from[k]) * i / steps;
    cdem_interface_law_update(&s->law, delta, &s->point, traction, &work);
    for (int k = 0; k < 3; k++)
      s->work -= (traction[k] + s->traction[k]) / 2 * (delta[k] - s->delta[k]);
    memcpy(s->delta, delta, sizeof delta);
    memcpy(s->traction, traction, sizeof traction);
    s->stored = work.stored;
    s->fracture += work.fracture;
    s->friction += work.friction;
    s->peak_n = fmax(s->peak_n, -traction[0]);
    s->peak_s = fmax(s->peak_s, hypot(traction[1], traction[2]));
    double again[3];
    cdem_interface_law_traction(&s->law, delta, &s->point, again);
    for (int k = 0; k < 3; k++) /* to the rounding of k (delta - delta^p) */
      check_near(again[k], traction[k], 1e-12, 1e-15 * s->law.kn * fabs(delta[k]) + 1e-4);
  }
}

static double imbalance(const specimen *s) {
  return s->stored + s->fracture + s->friction - s->work;
}

/* What is dissipated in a pure mode is its energy, whatever the step; the softening branch is the
 * straight line of the law. Final opening 2 G/sigma. */
static void pure_modes_take_their_energy(void **state) {
  (void)state;
  const int steps[] = {3, 7, 50, 999};
  for (int unloading = 0; unloading < 2; unloading++)
    for (int i = 0; i < 4; i++) {
      cdem_interface_law chosen = law;
      chosen.unloading = (cdem_unloading)unloading;
      specimen s = specimen_of(&chosen);
      drive(&s, 2.1e-5, 0, 0, steps[i]);    /* 2 G_I/sigma_t = 2e-5 */
      check_near(s.fracture, 10, 1e-12, 0); /* the rounding of a thousand steps */
      assert_int_equal(s.point.state, CDEM_INTERFACE_TENSION_FAILED);
      assert_true(s.stored == 0 && s.friction == 0 && s.traction[0] == 0);
      s = specimen_of(&chosen);
      drive(&s, 0, 2.4e-5, 2.4e-5, steps[i]); /* |delta_s| beyond 2 G_II/c = 3.33e-5 */
      check_near(s.fracture, 50, 1e-12, 0);
      assert_int_equal(s.point.state, CDEM_INTERFACE_SHEAR_FAILED);
      assert_true(s.stored == 0 && s.friction == 0);
    }
  specimen s = specimen_of(&law);
  drive(&s, 1e-7, 0, 0, 1); /* sigma_t/kn: the peak */
  check_near(s.traction[0], -1e6, 1e-15, 0);
  drive(&s, 1e-5, 0, 0, 4);
  /* kn (delta - D) = sigma_t (1 - D/D_f), D_f = 2e-5. */
  double d = (1e13 * 1e-5 - 1e6) / (1e13 - 5e10);
  check_near(-s.traction[0], 1e6 * (1 - d / 2e-5), 1e-13, 0);
  check_near(s.point.opened, d, 1e-13, 0);
  assert_int_equal(s.point.state, CDEM_INTERFACE_SOFTENING);
}

/* The peak is the strength: reached when a step ends on it, never passed. */
static void peaks_are_the_strengths(void **state) {
  (void)state;
  for (int brittle = 0; brittle < 2; brittle++) {
    cdem_interface_law chosen = law;
    chosen.softening = brittle ? CDEM_SOFTENING_BRITTLE : CDEM_SOFTENING_LINEAR;
    specimen s = specimen_of(&chosen);
    drive(&s, 3e-5, 0, 0, 300);
    check_near(s.peak_n, 1e6, 1e-14, 0);
    assert_true(s.traction[0] == 0);
    s = specimen_of(&chosen);
    drive(&s, -2e-7, 0, 0, 3); /* 2 MPa of pressure: shear strength 3.6 MPa at 9e-7 m */
    drive(&s, -2e-7, 4.5e-5, 0, 50);
    check_near(s.peak_s, 3.6e6, 1e-13, 0);
    check_near(s.traction[1], -0.6e6, 1e-13, 0);
  }
}

/* Sliding under pressure: the ratio is tan phi, friction is force times way, cohesion G_II. */
static void friction_is_kept_apart(void **state) {
  (void)state;
  specimen s = specimen_of(&law);
  drive(&s, -1e-7, 0, 0, 2);
  drive(&s, -1e-7, 5e-5, 0, 400);
  check_near(hypot(s.traction[1], s.traction[2]), 0.3 * s.traction[0], 1e-15, 0);
  check_near(s.fracture, 50, 1e-13, 0);
  check_near(s.friction, 0.3e6 * (5e-5 - 0.3e6 / 4e12), 1e-12, 0); /* less the elastic part left */
  /* The trapezoid is wrong only in the step of the peak: by at most k step^2/8. */
  check_below(fabs(imbalance(&s)), 4e12 * 1.25e-7 * 1.25e-7 / 8 * 1.01);
  double slid = s.friction;
  drive(&s, -1e-7, 5e-5, 5e-5, 2000); /* sideways: the force turns with the sliding */
  check_near(hypot(s.traction[1], s.traction[2]), 0.3 * s.traction[0], 1e-14, 0);
  check_near(s.traction[2], -0.3e6, 1e-4, 0);
  check_near(s.friction - slid, 0.3e6 * 5e-5, 2e-3, 0); /* but for the turning: e/way = 1.5e-3 */
  check_near(s.fracture, 50, 1e-13, 0);
}

/* The book closes to second order in the step through failure, friction and closing again; the
 * brittle one to the first jump (its drop is booked by the trapezoid itself). */
static void book_closes_to_second_order(void **state) {
  (void)state;
  for (int unloading = 0; unloading < 2; unloading++) {
    double error[3];
    for (int i = 0; i < 3; i++) {
      cdem_interface_law chosen = law;
      chosen.unloading = (cdem_unloading)unloading;
      chosen.dilation = 0.1;
      specimen s = specimen_of(&chosen);
      int n = 60 << (2 * i);
      drive(&s, 0.6e-5, 0.4e-5, 0, n);
      drive(&s, 0.1e-5, 0.3e-5, 0.2e-5, n);
      drive(&s, 0.9e-5, 1.1e-5, 0.2e-5, n);
      drive(&s, -0.01e-5, 1.3e-5, 0.2e-5, n);
      drive(&s, -0.02e-5, 4e-5, 0.2e-5, n);
      drive(&s, 1e-5, 4.2e-5, 0.2e-5, n);
      error[i] = fabs(imbalance(&s)) / (s.fracture + s.friction);
      assert_int_equal(s.point.damage, 1);
    }
    check_below(error[2], unloading == 0 ? 5e-6 : 5e-5);
    /* Second order: 256. Kinks fall anywhere within a step, so that it shows over a long way only;
     * the cut of what goes back under a growing pressure is of first order (16). */
    assert_true(error[0] / error[2] > (unloading == 0 ? 100 : 10));
  }
}

/* Elastic unloading comes back along kn and leaves the plastic opening; unloading to the origin
 * leaves none. Both reload to where they were. */
static void unloading_branches(void **state) {
  (void)state;
  specimen s = specimen_of(&law);
  drive(&s, 1e-5, 0, 0, 10);
  double top = -s.traction[0], lost = s.fracture, plastic = s.point.plastic[0];
  drive(&s, plastic, 0, 0, 1);
  check_near(s.traction[0], 0, 0, 1e-3);
  drive(&s, plastic - 1e-8, 0, 0, 1);
  check_near(s.traction[0], 1e5, 1e-9, 0);
  drive(&s, 1e-5, 0, 0, 1);
  check_near(-s.traction[0], top, 1e-12, 0);
  check_near(s.fracture, lost, 1e-13, 0);

  cdem_interface_law origin = law;
  origin.unloading = CDEM_UNLOADING_ORIGIN;
  s = specimen_of(&origin);
  drive(&s, 1e-7, 0, 0, 1); /* the kink on a step's end: the trapezoid is then exact */
  drive(&s, 1e-5, 0, 0, 10);
  check_near(-s.traction[0], top, 1e-12, 0); /* the same envelope */
  lost = s.fracture;
  check_near(lost, s.work - top * 1e-5 / 2, 1e-12, 0);
  drive(&s, 0.25e-5, 0, 0, 3);
  check_near(-s.traction[0], top / 4, 1e-13, 0);
  check_near(s.stored, top / 4 * 0.25e-5 / 2, 1e-13, 0);
  drive(&s, 0, 0, 0, 1);
  assert_true(s.traction[0] == 0 && s.stored == 0);
  drive(&s, -1e-8, 0, 0, 1);
  check_near(s.traction[0], 1e5, 1e-12, 0); /* full stiffness in compression */
  drive(&s, 1e-5, 0, 0, 5);
  check_near(-s.traction[0], top, 1e-12, 0);
  check_near(s.fracture, lost, 1e-13, 0);

  s = specimen_of(&origin);
  drive(&s, 0, 1.5e-5, 0, 10);
  top = -s.traction[1];
  lost = s.fracture;
  drive(&s, 0, -1.5e-5, 0, 7); /* through the origin to the other side */
  check_near(s.traction[1], top, 1e-12, 0);
  check_near(s.fracture, lost, 1e-13, 0);
  drive(&s, 0, -4e-5, 0, 9);
  check_near(s.fracture, 50, 1e-13, 0);
}

/* A failed point carries pressure where its faces meet again, with friction; opening takes both. */
static void closes_and_opens_again(void **state) {
  (void)state;
  for (int brittle = 0; brittle < 2; brittle++) {
    cdem_interface_law chosen = law;
    chosen.softening = brittle ? CDEM_SOFTENING_BRITTLE : CDEM_SOFTENING_LINEAR;
    specimen s = specimen_of(&chosen);
    drive(&s, 1e-4, 0, 0, 100);
    double lost = s.fracture;
    drive(&s, 1e-6, 0, 0, 10);
    assert_true(s.traction[0] == 0); /* still apart */
    drive(&s, -1e-7, 0, 0, 10);
    check_near(s.traction[0], 1e6, 1e-12, 0);
    check_near(s.stored, 1e6 * 1e-7 / 2, 1e-12, 0);
    drive(&s, -1e-7, 1e-6, 0, 20);
    check_near(-s.traction[1], 0.3e6, 1e-12, 0);
    drive(&s, 1e-6, 1e-6, 0, 10);
    assert_true(s.traction[0] == 0 && s.traction[1] == 0 && s.stored == 0);
    check_near(s.fracture, lost, 1e-13, 0);
    check_near(s.friction, 0.3e6 * (1e-6 - 0.3e6 / 4e12), 0.1, 0);
    assert_int_equal(s.point.state, CDEM_INTERFACE_TENSION_FAILED);
  }
}

/* While it is closed, the friction of a failed point is what its tractions did, whatever the size
 * of the steps: sticking, sliding, turning, under a changing pressure, with and without dilation.
 */
static void friction_closes_the_book(void **state) {
  (void)state;
  for (int kind = 0; kind < 8; kind++) {
    cdem_interface_law chosen = law;
    chosen.softening = kind & 1 ? CDEM_SOFTENING_BRITTLE : CDEM_SOFTENING_LINEAR;
    chosen.unloading = kind & 2 ? CDEM_UNLOADING_ORIGIN : CDEM_UNLOADING_ELASTIC;
    chosen.dilation = kind & 4 ? 0.1 : 0;
    specimen s = specimen_of(&chosen);
    drive(&s, 1e-4, 0, 0, 10);
    drive(&s, 0, 0, 0, 2);
    drive(&s, -2e-7, 0, 0, 1);
    double before = imbalance(&s), slid = s.friction;
    const double way[5][3] = {{-3e-7, 2e-6, 0},
                              {-1e-7, 1.9e-6, 1e-6},
                              {-4e-7, -1e-6, 3e-6},
                              {-2e-7, -1.3e-6, 3e-6},
                              {-2e-7, -5e-6, -5e-6}};
    for (int i = 0; i < 5; i++)
      drive(&s, way[i][0], way[i][1], way[i][2], 3);
    assert_true(s.friction > slid + 1);
    check_below(fabs(imbalance(&s) - before), 1e-13 * s.friction);
  }
}

/* Dilation lifts by tan psi times the slip, raises the pressure where opening is held, and is paid
 * out of the friction. The lifted faces meet where sliding has lifted them to. */
static void dilation_lifts(void **state) {
  (void)state;
  cdem_interface_law chosen = law;
  chosen.dilation = 0.2;
  chosen.cohesion = 0;
  chosen.tension = 0;
  specimen s = specimen_of(&chosen);
  s.point.damage = 1;
  drive(&s, -1e-7, 0, 0, 1);
  drive(&s, -1e-7, 1e-6, 0, 100);
  double slip = s.point.plastic[1];
  check_near(s.point.dilated, 0.2 * slip, 1e-14, 0);
  check_near(s.traction[0], 1e13 * (1e-7 + 0.2 * slip), 1e-12, 0);
  check_near(-s.traction[1], 0.3 * s.traction[0], 1e-14, 0);
  /* The trapezoid of the step in which sliding starts: k step^2/8 of the changed slope. */
  check_near(s.friction, 0.1 * (1e6 + s.traction[0]) / 2 * slip, 0, 4e12 * 1e-8 * 1e-8 / 8);
  check_below(fabs(imbalance(&s)), 1e-14);
  drive(&s, 1e-5, 1e-6, 0, 10);
  drive(&s, 0.2 * slip, 1e-6, 0, 10);
  check_near(s.traction[0], 0, 0, 1);
  drive(&s, 0.2 * slip - 1e-8, 1e-6, 0, 1);
  check_near(s.traction[0], 1e5, 1e-9, 0);
  /* In the open it does not lift. */
  chosen = law;
  chosen.dilation = 0.2;
  s = specimen_of(&chosen);
  drive(&s, 1e-8, 4e-5, 0, 100);
  assert_true(s.point.dilated == 0);
}

/* Proportional opening and sliding: the larger damage reduces both strengths, and what is taken
 * lies between nothing less than the smaller energy and the sum of both; the limit of small steps
 * is reached. */
static void mixed_mode(void **state) {
  (void)state;
  for (int i = 1; i < 8; i++) {
    double angle = i * 0.19634954084936207, fracture[2];
    for (int fine = 0; fine < 2; fine++) {
      specimen s = specimen_of(&law);
      drive(&s, 5e-5 * cos(angle), 5e-5 * sin(angle), 0, fine ? 4000 : 1000);
      assert_int_equal(s.point.damage, 1);
      double larger = fmax(s.point.opened / 2e-5, s.point.slipped / (1e-4 / 3));
      check_near(larger, 1, 0.02, 0); /* the other mode ends what is left of its path */
      fracture[fine] = s.fracture;
      assert_true(s.friction == 0);
      check_below(fabs(imbalance(&s)), fine ? 2e-3 : 3e-2);
    }
    assert_true(fracture[1] > 10 && fracture[1] < 60);
    check_near(fracture[0], fracture[1], 5e-3, 0);
  }
  /* Strengths in the middle of it: both on the surface with one factor. */
  specimen s = specimen_of(&law);
  drive(&s, 0.7e-5, 0.7e-5, 0, 500);
  double factor = 1 - s.point.damage;
  check_near(-s.traction[0], 1e6 * factor, 1e-9, 0);
  check_near(-s.traction[1], 3e6 * factor + 0.3 * s.traction[0], 1e-9, 0);
}

/* Brittle: what the spring held when it failed is the fracture energy, and the book closes but for
 * the step of the cap. */
static void brittle_gives_back_what_it_held(void **state) {
  (void)state;
  cdem_interface_law chosen = law;
  chosen.softening = CDEM_SOFTENING_BRITTLE;
  specimen s = specimen_of(&chosen);
  drive(&s, 2e-7, 0, 0, 2000); /* 1e-10 a step, the peak at 1e-7 */
  check_near(s.fracture, 1e6 * 1e-7 / 2, 3e-3, 0);
  check_below(fabs(imbalance(&s)), 1e-3 * s.fracture);
  s = specimen_of(&chosen);
  drive(&s, -1e-7, 0, 0, 10);
  drive(&s, -1e-7, 2e-6, 0, 5000);
  /* From (c + p tan phi)^2/2ks to (p tan phi)^2/2ks less the friction of the slip between. */
  check_near(s.fracture, 3e6 * 3e6 / 2 / 4e12, 5e-3, 0);
  check_below(fabs(imbalance(&s)), 1e-3 * s.fracture);
  assert_int_equal(s.point.state, CDEM_INTERFACE_SHEAR_FAILED);
}

/* A tied point comes in with the traction it replaces; nothing jumps, no energy is created, and the
 * bodies have paid G when it has failed, at an opening of 2 G/sigma. */
static void tied_point_comes_in_loaded(void **state) {
  (void)state;
  cdem_interface_law tied = law;
  tied.insertion = CDEM_INSERTION_TIED;
  tied.kn = tied.ks = 1e11; /* soft: its elastic part shows */
  for (int mode = 0; mode < 3; mode++) {
    for (int unloading = 0; unloading < 2; unloading++) {
      tied.unloading = (cdem_unloading)unloading;
      specimen s = specimen_of(&tied);
      double zero[3] = {0}, traction[3] = {mode == 0   ? -1.1e6
                                           : mode == 2 ? 2e6
                                                       : 0,
                                           mode == 0 ? 0 : -4e6, 0};
      assert_true(cdem_interface_law_reached(&tied, traction));
      cdem_interface_law_insert(&tied, zero, &s.point, traction);
      memcpy(s.traction, traction, sizeof traction);
      check_near(traction[mode > 0], mode == 0 ? -1e6 : mode == 1 ? -3e6 : -3.6e6, 1e-15, 0);
      cdem_interface_work work;
      cdem_interface_point copy = s.point;
      double again[3];
      cdem_interface_law_update(&tied, zero, &copy, again, &work);
      check_near(again[mode > 0], traction[mode > 0], 1e-14, 0);
      check_near(work.stored, 0, 0, 1e-12);
      check_near(work.fracture, 0, 0, 1e-12);
      drive(&s, mode == 0 ? 1e-5 : 0, mode == 0 ? 0 : 1e-5, 0, 100);
      check_near(-s.traction[mode > 0],
                 mode == 0   ? 1e6 * (1 - 1e-5 / 2e-5)
                 : mode == 1 ? 3e6 * (1 - 1e-5 / (1e-4 / 3))
                             : 3e6 * (1 - 1e-5 / (1e-4 / 3)) + 0.6e6,
                 1e-12, 0);
      check_near(imbalance(&s), 0, 0, 1e-11);
      drive(&s, mode == 0 ? 4e-5 : 0, mode == 0 ? 0 : 4e-5, 0, 300);
      assert_int_equal(s.point.damage, 1);
      check_near(s.fracture, mode == 0 ? 10 : 50, 1e-12, 0);
      check_near(s.stored, 0, 0, 1e-11);
      check_near(s.friction, mode == 2 ? 0.6e6 * 4e-5 : 0, 1e-12, 1e-12);
      check_near(imbalance(&s), 0, 0, 1e-2); /* the kink at the end of the slope */
    }
  }
  tied.softening = CDEM_SOFTENING_BRITTLE;
  specimen s = specimen_of(&tied);
  double zero[3] = {0}, traction[3] = {-1e6, 0, 0};
  cdem_interface_law_insert(&tied, zero, &s.point, traction);
  memcpy(s.traction, traction, sizeof traction);
  drive(&s, 1e-7, 0, 0, 1000);
  assert_true(s.traction[0] == 0);
  check_near(s.fracture, 0, 0, 1e6 * 1e-9); /* only the two steps of the drop */
}

/* Nothing has a preferred direction in the plane: turning the way turns the answer. */
static void shear_is_isotropic(void **state) {
  (void)state;
  specimen a = specimen_of(&law), b = specimen_of(&law);
  double c = cos(0.7), d = sin(0.7);
  const double way[4][3] = {
      {1e-6, 1e-6, 0}, {-1e-7, 9e-6, 2e-6}, {2e-6, 2e-6, -5e-6}, {-2e-7, 3e-5, 1e-5}};
  for (int i = 0; i < 4; i++) {
    drive(&a, way[i][0], way[i][1], way[i][2], 30);
    drive(&b, way[i][0], c * way[i][1] - d * way[i][2], d * way[i][1] + c * way[i][2], 30);
    check_near(b.traction[0], a.traction[0], 1e-10, 1e-3);
    check_near(b.traction[1], c * a.traction[1] - d * a.traction[2], 0, 1e-2);
    check_near(b.traction[2], d * a.traction[1] + c * a.traction[2], 0, 1e-2);
    check_near(b.fracture, a.fracture, 1e-10, 0);
  }
}

/* No strength at all: it opens and slides freely, without energy. */
static void joint_without_strength(void **state) {
  (void)state;
  cdem_interface_law joint = {.kn = 1e10, .ks = 1e10, .friction = 0.5};
  specimen s = specimen_of(&joint);
  s.point.damage = 1;
  drive(&s, 1e-6, 1e-6, 0, 10);
  assert_true(s.traction[0] == 0 && s.traction[1] == 0 && s.work == 0 && s.fracture == 0);
  drive(&s, -1e-6, 1e-6, 0, 10);
  drive(&s, -1e-6, 1.5e-6, 0, 1); /* sliding starts on a step's end */
  drive(&s, -1e-6, 5e-6, 0, 10);
  check_near(s.traction[1], -0.5 * s.traction[0], 1e-15, 0);
  check_near(s.fracture, 0, 0, 1e-18);
  check_near(s.friction, 0.5e4 * (4e-6 - 0.5e-6), 1e-12, 0);
}

static void errors_name_key_and_bound(void **state) {
  (void)state;
  check_ok(cdem_interface_law_check(&law, &fault));
  cdem_interface_law bad = law;
  bad.kn = 1e10;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT,
              "kn = 1e+10 Pa/m snaps back: it must be at least strength^2/(2 energy_1) = 5e+10");
  bad.insertion = CDEM_INSERTION_TIED;
  check_ok(cdem_interface_law_check(&bad, &fault));
  bad = law;
  bad.ks = 8e10;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT,
              "ks = 8e+10 Pa/m snaps back: it must be at least strength^2/(2 energy_2) = 9e+10");
  bad.softening = CDEM_SOFTENING_BRITTLE;
  check_ok(cdem_interface_law_check(&bad, &fault));
  bad.ks = 0;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT, "ks = 0 Pa/m; it must be pos");
  bad = law;
  bad.tension = NAN;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT, "tension = nan Pa");
  bad = law;
  bad.dilation = 0.4;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT,
              "dilation = 0.4 (tan psi) exceeds friction = 0.3");
  bad = law;
  bad.energy_2 = 0;
  check_fails(cdem_interface_law_check(&bad, &fault), CDEM_INPUT, "energy_2 = 0 J/m^2");
  bad.cohesion = 0;
  check_ok(cdem_interface_law_check(&bad, &fault));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pure_modes_take_their_energy),
      cmocka_unit_test(peaks_are_the_strengths),
      cmocka_unit_test(friction_is_kept_apart),
      cmocka_unit_test(book_closes_to_second_order),
      cmocka_unit_test(unloading_branches),
      cmocka_unit_test(closes_and_opens_again),
      cmocka_unit_test(friction_closes_the_book),
      cmocka_unit_test(dilation_lifts),
      cmocka_unit_test(mixed_mode),
      cmocka_unit_test(brittle_gives_back_what_it_held),
      cmocka_unit_test(tied_point_comes_in_loaded),
      cmocka_unit_test(shear_is_isotropic),
      cmocka_unit_test(joint_without_strength),
      cmocka_unit_test(errors_name_key_and_bound),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
