/* Ten million particle-steps of random mixtures: three laws, walls of all shapes, cells, bonds and
 * driven grains, shaken so that contacts come and go, saved and restored on the way. To be run
 * under the sanitizers too. What is asserted: the energy book, actions against reactions (forces
 * and moments of grains and walls), momentum in a cell, contacts against those found by looking at
 * all pairs, the same bits after a restore. */
#include "mixture_support.h"

enum { PARTS = 10 };
static double particle_steps; /* of all tests */

typedef struct {
  double xyz[3 * MIXTURE_GRAINS], velocity[3 * MIXTURE_GRAINS], spin[3 * MIXTURE_GRAINS];
  double displacement[3 * MIXTURE_GRAINS], force[3 * MIXTURE_GRAINS], moment[3 * MIXTURE_GRAINS];
} seen;

static void look(const cdem_dem *dem, seen *s) {
  cdem_dem_look(dem, &(cdem_dem_view){.xyz = s->xyz,
                                      .velocity = s->velocity,
                                      .spin = s->spin,
                                      .displacement = s->displacement,
                                      .force = s->force,
                                      .moment = s->moment});
}

/* ---- laws ---- */

static void check_book(cdem_dem *dem) {
  cdem_dem_energies e;
  cdem_dem_energies_now(dem, &e);
  check_below(fabs(e.error), 1e-3 * e.exchange);
}

/* Forces on grains and walls are actions and reactions; without a cell their moments too. The
 * bound is rounding of a sum of some thousand terms. */
static void check_balance(const mixture *x, const cdem_dem *dem) {
  static seen s;
  double force[3] = {0}, moment[3] = {0}, turn[3], scale = 0.0;
  look(dem, &s);
  for (int64_t i = 0; i < dem->grains; i++) {
    cdem_cross3(s.xyz + 3 * i, s.force + 3 * i, turn);
    for (int c = 0; c < 3; c++) {
      force[c] += s.force[3 * i + c];
      moment[c] += s.moment[3 * i + c] + turn[c];
    }
    scale += cdem_norm3(s.force + 3 * i);
  }
  for (int w = 0; w < x->m.options.walls; w++) {
    cdem_dem_wall now;
    cdem_dem_wall_now(dem, w, &now);
    cdem_cross3(now.center, now.force, turn);
    for (int c = 0; c < 3; c++) {
      force[c] += now.force[c];
      moment[c] += now.moment[c] + turn[c];
    }
    scale += cdem_norm3(now.force);
  }
  for (int c = 0; c < 3; c++) {
    check_near(force[c], 0.0, 0.0, 1e-12 * scale);
    if (!x->periodic)
      check_near(moment[c], 0.0, 0.0, 1e-12 * scale * x->edge);
  }
}

/* Overlaps of this part of a radius and less may be told from none by rounding. */
static const double tiny = 1e-9;

/* How many images of a pair touch. */
static int touches(const cdem_cell *cell, const double *a, const double *b, double both,
                   double least) {
  double shift[27][3] = {{0}};
  int count = 0;
  if (cell != NULL)
    cdem_cell_images(cell, shift);
  for (int k = 0; k < 27; k++) {
    double d[3];
    if (cell == NULL && k != CDEM_IMAGE_SELF)
      continue;
    int edges[3];
    cdem_image_edges(k, edges);
    bool free = false; /* images across free directions are the grain itself */
    for (int c = 0; c < 3; c++) {
      d[c] = b[c] - a[c] + shift[k][c];
      free = free || (cell != NULL && !cell->periodic[c] && edges[c] != 0);
    }
    count += !free && both - cdem_norm3(d) > tiny * least;
  }
  return count;
}

static bool is_bonded(const cdem_dem_contact *contact, int64_t contacts, int32_t a, int32_t b) {
  for (int64_t k = 0; k < contacts; k++)
    if (contact[k].bonded && contact[k].a == a && contact[k].b == b)
      return true;
  return false;
}

/* All pairs of grains, one by one, against the contacts of the solver. */
static void check_contacts(mixture *x, const cdem_dem *dem) {
  static seen s;
  cdem_fault fault = {0};
  cdem_dem_contact *contact;
  int64_t contacts, at = 0;
  const double *radius = cdem_dem_radius(dem);
  look(dem, &s);
  check_ok(cdem_dem_contacts(dem, &contacts, &contact, &fault));
  for (int32_t a = 0; a < dem->grains; a++)
    for (int32_t b = a + 1; b < dem->grains; b++) {
      double least = fmin(radius[a], radius[b]);
      int expected = touches(cdem_dem_cell(dem), s.xyz + 3 * a, s.xyz + 3 * b,
                             radius[a] + radius[b], least),
          found = 0;
      while (at < contacts && (contact[at].a < a || (contact[at].a == a && contact[at].b < b)))
        at++;
      for (int64_t k = at; k < contacts && contact[k].a == a && contact[k].b == b; k++)
        found += !contact[k].bonded && contact[k].overlap > tiny * least;
      if (expected == found)
        continue;
      bool driven = x->m.grains.motion[a] && x->m.grains.motion[b];
      if (!driven && !is_bonded(contact, contacts, a, b))
        fail_msg("grains %d and %d touch %d times, the solver says %d", a, b, expected, found);
    }
  x->met += contacts;
  free(contact);
}

static void check_momentum(const mixture *x, const cdem_dem *dem, double before[3]) {
  double linear[3], angular[3];
  cdem_dem_momentum(dem, linear, angular);
  if (dem->steps == 0)
    memcpy(before, linear, sizeof linear);
  for (int c = 0; c < 3 && x->momentum; c++)
    check_near(linear[c], before[c], 0.0, 1e-12 * x->mass * 3.0);
}

static void check_same(const cdem_dem *a, const cdem_dem *b) {
  static seen s[2];
  look(a, &s[0]);
  look(b, &s[1]);
  assert_memory_equal(&s[0], &s[1], sizeof s[0]);
}

/* ---- runs ---- */

/* The solver goes on as another one. */
static void hand_over(mixture *x, cdem_dem *dem, bool compare, int64_t *steps) {
  cdem_fault fault = {0};
  cdem_state saved = {0};
  cdem_dem again;
  check_ok(cdem_dem_init(&x->m.options, &again, &fault));
  check_ok(cdem_dem_save(dem, &saved, &fault));
  check_ok(cdem_dem_restore(&again, &saved, &fault));
  cdem_state_release(&saved);
  if (compare) {
    check_ok(cdem_dem_steps(dem, 50, &fault));
    check_ok(cdem_dem_steps(&again, 50, &fault));
    check_same(dem, &again);
    *steps += 100;
  }
  cdem_dem_release(dem);
  *dem = again;
}

/* Parts of different lengths, each but the first restored from the one before. */
static void shake(mixture *x) {
  cdem_fault fault = {0};
  cdem_dem dem;
  double before[3];
  int64_t steps = 0;
  check_ok(cdem_dem_init(&x->m.options, &dem, &fault));
  check_momentum(x, &dem, before);
  for (int part = 0; part < PARTS; part++) {
    int64_t length = 100 + 57 * part;
    check_ok(cdem_dem_steps(&dem, length, &fault));
    steps += length;
    check_book(&dem);
    check_balance(x, &dem);
    check_momentum(x, &dem, before);
    if (part % 4 == 3)
      check_contacts(x, &dem);
    hand_over(x, &dem, part % 3 == 0, &steps);
    mixture_drive(x, &dem);
  }
  assert_true(x->met > 100); /* or nothing was tested */
  x->broken = cdem_dem_bonds_broken(&dem);
  particle_steps += (double)(steps * dem.grains);
  cdem_dem_release(&dem);
}

/* Discs with Li and Chu's law between walls that shake. */
static void test_discs_li_chu(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 2, "li-chu", 10.0, 1);
  model_word(&x.m, CDEM_LAW_friction, 0.4);
  model_word(&x.m, CDEM_LAW_rolling_force_stiffness, 1e3);
  model_word(&x.m, CDEM_LAW_rolling_force_friction, 0.05);
  model_word(&x.m, CDEM_LAW_rolling_stiffness, 0.05);
  model_word(&x.m, CDEM_LAW_rolling_length, 1e-4);
  mixture_box(&x, true);
  x.m.options.gravity[1] = -9.81;
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* Discs of two materials with rolling springs, a plate that turns, a servo, a roller, a saw. */
static void test_discs_linear(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 2, "linear", 10.0, 2);
  model_word(&x.m, CDEM_LAW_restitution, 0.8);
  model_word(&x.m, CDEM_LAW_friction, 0.5);
  model_word(&x.m, CDEM_LAW_rolling_friction, 0.1);
  x.m.options.rolling = cdem_rolling_find("spring");
  x.m.options.materials = 2;
  x.m.contact[1].value[CDEM_LAW_friction] = x.m.contact[2].value[CDEM_LAW_friction] = 0.2;
  mixture_box(&x, false);
  mixture_plate(&x);
  mixture_roller(&x);
  mixture_mesh(&x);
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* Spheres that roll and twist, over a moving mesh and through an open tube. */
static void test_spheres_linear(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 3, "linear", 10.0, 3);
  model_word(&x.m, CDEM_LAW_restitution, 0.8);
  model_word(&x.m, CDEM_LAW_friction, 0.5);
  model_word(&x.m, CDEM_LAW_rolling_friction, 0.1);
  model_word(&x.m, CDEM_LAW_twisting_friction, 0.1);
  x.m.options.rolling = cdem_rolling_find("spring");
  x.m.options.twisting = cdem_twisting_find("spring");
  x.m.options.mass_damping = 1.0;
  x.m.options.threads = 2;
  mixture_box(&x, true);
  mixture_mesh(&x);
  mixture_roller(&x);
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* Hertz' spheres in a drum that turns, with local damping. */
static void test_spheres_hertz(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 3, "hertz", 5.0, 4);
  model_word(&x.m, CDEM_LAW_restitution, 0.7);
  model_word(&x.m, CDEM_LAW_friction, 0.5);
  model_word(&x.m, CDEM_LAW_rolling_friction, 0.05);
  x.m.options.rolling = cdem_rolling_find("constant");
  x.m.options.local_damping = 0.05;
  x.m.options.gravity[1] = -9.81;
  mixture_drum(&x);
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* A cell that is sheared and pressed until its edges are chosen anew. */
static void test_cell_sheared(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 3, "linear", 4.0, 5);
  model_word(&x.m, CDEM_LAW_restitution, 0.8);
  model_word(&x.m, CDEM_LAW_friction, 0.3);
  mixture_cell(&x, true, 100.0);
  x.m.options.threads = 2;
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* A cell at rest: momentum. */
static void test_cell(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 2, "li-chu", 10.0, 6);
  model_word(&x.m, CDEM_LAW_friction, 0.3);
  mixture_cell(&x, true, 0.0);
  x.momentum = true;
  mixture_fill(&x);
  shake(&x);
  mixture_release(&x);
}

/* Bonded lumps and driven grains, in a cell along x and between plates across it. */
static void test_bonds(void **state) {
  (void)state;
  mixture x;
  mixture_init(&x, 3, "linear", 4.0, 7);
  model_word(&x.m, CDEM_LAW_restitution, 0.8);
  model_word(&x.m, CDEM_LAW_friction, 0.5);
  mixture_cell(&x, false, 0.0);
  mixture_box(&x, true);
  mixture_fill(&x);
  mixture_bond(&x);
  shake(&x);
  assert_true(x.broken > 0);
  mixture_release(&x);
}

static void test_enough(void **state) {
  (void)state;
  assert_true(particle_steps >= 1e7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_discs_li_chu),   cmocka_unit_test(test_discs_linear),
      cmocka_unit_test(test_spheres_linear), cmocka_unit_test(test_spheres_hertz),
      cmocka_unit_test(test_cell_sheared),   cmocka_unit_test(test_cell),
      cmocka_unit_test(test_bonds),          cmocka_unit_test(test_enough)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
