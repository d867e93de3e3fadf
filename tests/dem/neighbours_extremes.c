/* Neighbours and lists at the ends of what can be asked: one grain, all in one place, far from the
 * origin, sizes 1:100, memory that runs out. */
#include "dem/neighbours_support.h"
#include "solver_model.h"

/* Rows of the list are what a plain search finds. */
static void check_plain(const cdem_dem_store *s) {
  int64_t at = 0;
  for (int64_t i = 0; i < s->grains; i++)
    for (int64_t j = i + 1; j < s->grains; j++) {
      const double *a = cdem_place(s, i), *b = cdem_place(s, j);
      double square = 0.0, near = a[3] + b[3] + s->skin;
      for (int c = 0; c < 3; c++)
        square += (b[c] - a[c]) * (b[c] - a[c]);
      if (square >= near * near)
        continue;
      assert_true(at < s->pairs && s->pair_other[at] == j);
      at++;
    }
  assert_int_equal(s->pairs, at);
}

static void build(cdem_dem_store *s) {
  cdem_fault fault = {0};
  check_ok(cdem_neighbours_build(s, true, 2, &fault));
  check_plain(s);
}

static void test_one(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    cdem_dem_store s;
    store_init(&s, dim, 1, 0.1);
    cdem_place(&s, 0)[3] = 1.0;
    build(&s);
    assert_int_equal(s.pairs, 0);
    store_release(&s);
  }
}

/* As many pairs as there can be, in the same order whatever the ids. */
static void test_one_place(void **state) {
  (void)state;
  enum { MANY = 300 };
  cdem_dem_store s;
  store_init(&s, 3, MANY, 0.1);
  for (int i = 0; i < MANY; i++) {
    double *place = cdem_place(&s, i);
    place[0] = -3.0;
    place[1] = 7.0;
    place[3] = 0.25 + i * 37 % MANY * 0x1p-12;
  }
  build(&s);
  assert_int_equal(s.pairs, MANY * (MANY - 1) / 2);
  for (int i = 1; i < MANY; i++)
    assert_true(cdem_place(&s, i - 1)[3] < cdem_place(&s, i)[3]);
  store_release(&s);
}

/* Radius 1e-3 at 1e6 m: places have ten bits left for a radius, the search none to lose. */
static void test_far_off(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++)
    for (int one = 0; one < 2; one++) {
      cdem_dem_store s;
      store_init(&s, dim, 400, 2e-4);
      double box[3] = {0.02, 0.03, 0.02};
      store_fill(&s, box, 0.5e-3, 1e-3, 5);
      for (int i = one; i < s.grains; i++) { /* all, or all but one */
        cdem_place(&s, i)[0] += 1e6;
        cdem_place(&s, i)[1] -= 3e6;
      }
      build(&s);
      assert_true(s.pairs > 100);
      store_release(&s);
    }
}

/* Levels over a range of sizes, few large ones and many small ones, and the other way round. */
static void test_wide(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++)
    for (int few = 0; few < 2; few++) {
      cdem_dem_store s;
      store_init(&s, dim, 900, 0.001);
      double box[3] = {3.0, 3.0, 3.0};
      store_fill(&s, box, 0.01, 1.0, 8);
      for (int i = 0; i < s.grains && few == 0; i++)
        cdem_place(&s, i)[3] = i % 100 == 0 ? 0.01 : 0.2;
      build(&s);
      store_release(&s);
    }
}

/* ---- memory that runs out ---- */

typedef struct {
  model m;
  cdem_cell cell;
  cdem_bond bond[8];
  cdem_bond_law law;
} crowd;

static void crowd_init(crowd *w) {
  model_init(&w->m, 3, "linear");
  model_word(&w->m, CDEM_LAW_restitution, 0.8);
  model_word(&w->m, CDEM_LAW_friction, 0.4);
  model_heap(&w->m, 4, 2.0, 30.0, 6);
  double edge = 4 * 1.9 * 0.01;
  w->cell = (cdem_cell){.periodic = {true, true, false}, .h = {edge, 0, 0, 0, edge}};
  model_plane(&w->m, 0.0, 0.0, -0.0105, 0.0, 0.0, 1.0);
  w->law = (cdem_bond_law){.normal_stiffness = 1e5, .shear_stiffness = 1e4, .tension = 5.0};
  for (int b = 0; b < 8; b++)
    w->bond[b] = (cdem_bond){{2 * b, 2 * b + 1}, 0};
  w->m.grains.motion[63] = CDEM_GRAIN_DRIVEN;
  w->m.options.cell = &w->cell;
  w->m.options.bond = w->bond;
  w->m.options.bonds = 8;
  w->m.options.bond_law = &w->law;
  w->m.options.bond_laws = 1;
  w->m.options.skin = 0.05;
}

/* All that a run does; what is looked at after a failure must fit together. */
static cdem_status live(crowd *w, cdem_fault *fault) {
  cdem_dem dem, again = {0};
  cdem_state saved = {0};
  cdem_status status = cdem_dem_init(&w->m.options, &dem, fault);
  if (status != CDEM_OK)
    return status;
  status = cdem_dem_steps(&dem, 60, fault);
  assert_true(status != CDEM_OK || dem.store->builds > 3);
  if (status == CDEM_OK)
    status = cdem_dem_save(&dem, &saved, fault);
  if (status == CDEM_OK)
    status = cdem_dem_init(&w->m.options, &again, fault);
  if (status == CDEM_OK)
    status = cdem_dem_restore(&again, &saved, fault);
  if (status == CDEM_OK)
    status = cdem_dem_steps(&again, 20, fault);
  cdem_memory_fail_after(-1);
  cdem_dem *seen[] = {&dem, &again};
  for (int k = 0; k < 2; k++) {
    int32_t contacts[64];
    cdem_dem_contact *contact;
    int64_t count;
    cdem_fault other = {0};
    if (seen[k]->store == NULL)
      continue;
    cdem_dem_look(seen[k], &(cdem_dem_view){.contacts = contacts});
    if (cdem_dem_contacts(seen[k], &count, &contact, &other) == CDEM_OK)
      free(contact);
    cdem_dem_release(seen[k]);
  }
  cdem_state_release(&saved);
  return status;
}

static void test_memory(void **state) {
  (void)state;
  cdem_status status = CDEM_MEMORY;
  int64_t allocations = 0;
  static crowd w;
  crowd_init(&w);
  for (; status != CDEM_OK; allocations++) {
    cdem_fault fault = {0};
    cdem_memory_fail_after(allocations);
    status = live(&w, &fault);
    cdem_memory_fail_after(-1);
    if (status != CDEM_OK && status != CDEM_MEMORY)
      fail_msg("%s", fault.message);
  }
  assert_true(allocations > 50);
  model_release(&w.m);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_one), cmocka_unit_test(test_one_place),
                                     cmocka_unit_test(test_far_off), cmocka_unit_test(test_wide),
                                     cmocka_unit_test(test_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
