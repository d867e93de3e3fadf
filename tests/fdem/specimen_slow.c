/* Room fdem: grains in a membrane between plates: states, the book, memory that ends. */
#include "base/memory.h"
#include "fdem/solver_support.h"

static cdem_fault fault;

typedef struct {
  scene s;
  cdem_membrane_options membrane;
  cdem_confinement confinement;
  double time[2], pressure[2];
} specimen;

/* Layers of seven grains of radius r, a little apart, between plates and in a membrane. */
static void specimen_make(specimen *p, int layers, int threads) {
  const double r = 0.01, by = 2.12 * r, third = 1.04719755119659775, pressure = 1e5;
  *p = (specimen){.time = {0.0, 1e-2}, .pressure = {0.1 * pressure, pressure}};
  scene_of("cubesphere", 1, 1e11, 0.2, NULL, &p->s);
  for (int k = 0; k < layers; k++)
    for (int i = 0; i < 7; i++) {
      double out = i == 0 ? 0.0 : by, turn = third * i + 0.2 * k;
      scene_add(&p->s, out * cos(turn), out * sin(turn), (k + 0.5) * by, r, (uint64_t)(7 * k + i));
    }
  scene_floor(&p->s, 0.0, 0.0, 1.0);
  cdem_wall *top = scene_floor(&p->s, layers * by, 0.0, -1.0);
  top->name = "top";
  top->servo[2] = 1.0;
  top->servo_speed = 1.0;
  top->servo_gain = 0.8;
  p->membrane = (cdem_membrane_options){.radius = 3.1 * r, .high = top->center[2], .poisson = 0.3};
  cdem_membrane_complete(&p->membrane, pressure, 2.0 * r, 2650.0);
  p->membrane.areal_density *= 100.0; /* heavy: the grains decide on the step */
  p->confinement =
      (cdem_confinement){.membrane = &p->membrane,
                         .low = 0,
                         .high = 1,
                         .presses = true,
                         .pressure = {.points = 2, .time = p->time, .value = p->pressure},
                         .quiet = 5e-3};
  p->s.law = (cdem_fdem_contact_law){
      .penalty = 1e10, .shear_ratio = 0.8, .friction = 0.3, .damping_ratio = 0.2};
  p->s.options.confinement = &p->confinement;
  p->s.options.threads = threads;
}

/* Pressed together, then sheared; the step is looked at every 100 steps. */
enum { SHEAR_AT = 450, CHANGED_AT = 850, LOOK_EVERY = 50, END = 1000 };
static int go(cdem_fdem *fdem, int64_t to) {
  int changes = 0;
  while (fdem->steps < to) {
    check_ok(cdem_fdem_steps(fdem, 1, &fault));
    if (fdem->steps == SHEAR_AT)
      cdem_fdem_shear(fdem, -3.0);
    double step = fdem->step;
    if (fdem->steps % LOOK_EVERY == 0)
      cdem_fdem_follow(fdem);
    changes += fdem->step != step;
  }
  return changes;
}

static void check_same(const cdem_fdem *a, const cdem_fdem *b) {
  cdem_state state[2] = {{0}, {0}};
  check_ok(cdem_fdem_save(a, &state[0], &fault));
  check_ok(cdem_fdem_save(b, &state[1], &fault));
  assert_int_equal(state[0].arrays, state[1].arrays);
  for (int64_t i = 0; i < state[0].arrays; i++) {
    const cdem_array *one = &state[0].array[i], *other = cdem_state_find(&state[1], one->name);
    assert_non_null(other);
    assert_int_equal(one->count, other->count);
    if (one->count > 0 &&
        memcmp(one->data, other->data, (size_t)one->count * cdem_array_size(one->type)) != 0)
      fail_msg("'%s' differs", one->name);
  }
  cdem_specimen now[2];
  assert_true(cdem_fdem_specimen(a, &now[0]) && cdem_fdem_specimen(b, &now[1]));
  assert_true(now[0].touching == now[1].touching && now[0].lateral == now[1].lateral);
  cdem_fdem_energies e[2];
  cdem_fdem_energies_now(a, &e[0]);
  cdem_fdem_energies_now(b, &e[1]);
  assert_memory_equal(&e[0], &e[1], sizeof e[0]);
  for (int k = 0; k < 2; k++)
    cdem_state_release(&state[k]);
}

/* Wherever it is taken up, at a change of the step, before or in the shear, and with any threads.
 */
static void a_restored_specimen_goes_on_to_the_same_bits(void **state) {
  (void)state;
  static const int at[] = {100, 437, SHEAR_AT, 700, CHANGED_AT, CHANGED_AT + 1};
  enum { STATES = sizeof at / sizeof *at };
  specimen p;
  cdem_fdem whole;
  cdem_state saved[STATES] = {{0}};
  specimen_make(&p, 4, 1);
  check_ok(cdem_fdem_init(&p.s.options, &whole, &fault));
  for (int k = 0; k < STATES; k++) {
    int change = go(&whole, at[k]);
    assert_true(change > 0 || at[k] != CHANGED_AT); /* just there */
    check_ok(cdem_fdem_save(&whole, &saved[k], &fault));
    /* what is saved is borrowed */
    cdem_state copy = {0};
    for (int64_t i = 0; i < saved[k].arrays; i++) {
      const cdem_array *from = &saved[k].array[i];
      check_ok(cdem_state_add_copy(&copy, from->name, from->type, from->count, from->data, &fault));
    }
    cdem_state_release(&saved[k]);
    saved[k] = copy;
  }
  go(&whole, END);
  p.s.options.threads = 2;
  for (int k = 0; k < STATES; k++) {
    cdem_fdem other;
    check_ok(cdem_fdem_init(&p.s.options, &other, &fault));
    check_ok(cdem_fdem_restore(&other, &saved[k], &fault));
    go(&other, END);
    check_same(&whole, &other);
    cdem_fdem_release(&other);
    cdem_state_release(&saved[k]);
  }
  cdem_fdem_energies e;
  cdem_fdem_energies_now(&whole, &e);
  check_below(fabs(e.error), 2e-2 * e.exchange);
  cdem_fdem_release(&whole);
  scene_release(&p.s);
}

/* ---- memory ---- */

static cdem_status make_step_save_restore(const specimen *p, cdem_fdem *one, cdem_fdem *two,
                                          cdem_state *saved) {
  CDEM_TRY(cdem_fdem_init(&p->s.options, one, &fault));
  CDEM_TRY(cdem_fdem_steps(one, 2, &fault));
  CDEM_TRY(cdem_fdem_save(one, saved, &fault));
  CDEM_TRY(cdem_fdem_init(&p->s.options, two, &fault));
  CDEM_TRY(cdem_fdem_restore(two, saved, &fault));
  return cdem_fdem_steps(two, 1, &fault);
}

static void a_membrane_that_is_not_finite_ends_the_run(void **state) {
  (void)state;
  specimen p;
  cdem_fdem fdem;
  specimen_make(&p, 1, 1);
  check_ok(cdem_fdem_init(&p.s.options, &fdem, &fault));
  const cdem_membrane *m = cdem_fdem_membrane(&fdem);
  m->v[3 * (m->nodes / 2)] = NAN;
  check_fails(cdem_fdem_steps(&fdem, 3, &fault), CDEM_NUMERIC, "the membrane is no longer finite");
  cdem_fdem_release(&fdem);
  scene_release(&p.s);
}

static void memory_that_ends_is_told(void **state) {
  (void)state;
  specimen p;
  cdem_status status = CDEM_MEMORY;
  int failures = 0;
  specimen_make(&p, 1, 1);
  for (int i = 0; i < 7; i++)
    p.s.xyz[3 * i] *= 0.97; /* some touch */
  for (; status == CDEM_MEMORY; failures++) {
    cdem_fdem one = {0}, two = {0};
    cdem_state saved = {0};
    fault.status = CDEM_OK;
    cdem_memory_fail_after(failures);
    status = make_step_save_restore(&p, &one, &two, &saved);
    cdem_memory_fail_after(-1);
    cdem_state_release(&saved);
    cdem_fdem_release(&one);
    cdem_fdem_release(&two);
  }
  if (status != CDEM_OK)
    fail_msg("%s", fault.message);
  assert_true(failures > 150);
  scene_release(&p.s);
}

static void memory_of_a_shape_that_ends_is_told(void **state) {
  (void)state;
  static const char *const shapes[] = {"cubesphere", "icosphere", "tetrasphere"};
  const cdem_material rock = cdem_material_isotropic(1e9, 0.2);
  for (int k = 0; k < 3; k++) {
    const cdem_template_options options = {.shape = cdem_grain_shape_find(shapes[k]),
                                           .options = {.refinement = k == 0},
                                           .material = &rock};
    cdem_status status = CDEM_MEMORY;
    int failures = 0;
    for (; status == CDEM_MEMORY; failures++) {
      cdem_template shape;
      fault.status = CDEM_OK;
      cdem_memory_fail_after(failures);
      status = cdem_template_init(&options, true, &shape, &fault);
      cdem_memory_fail_after(-1);
      cdem_template_release(&shape);
    }
    if (status != CDEM_OK)
      fail_msg("%s: %s", shapes[k], fault.message);
    assert_true(failures > 40);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_membrane_that_is_not_finite_ends_the_run),
                                     cmocka_unit_test(a_restored_specimen_goes_on_to_the_same_bits),
                                     cmocka_unit_test(memory_that_ends_is_told),
                                     cmocka_unit_test(memory_of_a_shape_that_ends_is_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
