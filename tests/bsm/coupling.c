/* Room bsm: a body and grains in one time. Energy and momentum of both, bits, what is refused. */
#include "bsm/coupling_support.h"

static cdem_fault fault;

enum { STEPS = 100 };

/* m = 1 is central differences of one system: the energy stays but for the change of bonds'
 * directions, the momentum to rounding. The force that body and grains exchange does the same work
 * on both. */
static void one_cycle(void **state) {
  (void)state;
  for (int k = 0; k < 8; k++) {
    pair p;
    pair_options o = pair_chosen(k & 1, 1);
    double energy, momentum;
    cdem_energy_book body;
    cdem_dem_energies grains;
    o.cosserat = k & 2;
    o.way = k & 4 ? CDEM_BSM_ACCELERATION : CDEM_BSM_VELOCITY;
    pair_make(&o, &p);
    pair_start(&p);
    pair_watch(&p, STEPS, &energy, &momentum);
    check_below(energy, k & 1 ? 1e-6 : 1e-11);
    check_below(momentum, 1e-11);
    cdem_solver_energies(&p.solver, &body);
    cdem_dem_energies_now(&p.dem, &grains);
    check_below(1e-3, fabs(grains.driven));
    check_near(p.coupling.work, body.load, 1e-12, 0.0);
    check_near(p.coupling.work, -grains.driven, 1e-11, 0.0);
    pair_release(&p);
  }
}

/* Everything moves alike: nothing acts and nothing changes. */
static void uniform_motion(void **state) {
  (void)state;
  for (int k = 0; k < 8; k++) {
    pair p;
    pair_options o = pair_chosen(true, k & 1 ? 4 : 1);
    memset(o.velocity, 0, sizeof o.velocity);
    o.velocity[0][0] = 0.3;
    o.velocity[1][0] = -0.7;
    o.form = k & 2 ? CDEM_BSM_VIRTUAL_WORK : CDEM_BSM_INTERFACE;
    o.cosserat = k & 4;
    pair_make(&o, &p);
    pair_start(&p);
    pair_run(&p, 20);
    int64_t count = p.dem.grains;
    double *v = cdem_allocate(9 * count, sizeof *v, &fault), *w = v + 3 * count, *u = w + 3 * count;
    cdem_dem_view view = {.velocity = v, .spin = w, .displacement = u};
    cdem_dem_look(&p.dem, &view);
    for (int64_t i = 0; i < count; i++)
      for (int c = 0; c < 2; c++) {
        check_near(v[3 * i + c], o.velocity[c][0], 1e-10, 0.0);
        check_near(u[3 * i + c], o.velocity[c][0] * p.dem.time, 1e-10, 0.0);
        check_near(w[3 * i + 2], 0.0, 0.0, 1e-8);
      }
    for (int32_t n = 0; n < p.solver.nodes; n++)
      for (int c = 0; c < 2; c++)
        if (p.body.mass[n * p.solver.dofs + c] > 0.0)
          check_near(p.solver.v[n * p.solver.dofs + c], o.velocity[c][0], 1e-10, 0.0);
    check_near(p.coupling.work, 0.0, 0.0, 1e-10);
    free(v);
    pair_release(&p);
  }
}

/* Free fall: the same for all, whichever form adds the weight of the grains to the nodes. */
static void free_fall(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    pair p;
    pair_options o = pair_chosen(true, 1);
    memset(o.velocity, 0, sizeof o.velocity);
    o.gravity = -10.0;
    o.form = k & 1 ? CDEM_BSM_VIRTUAL_WORK : CDEM_BSM_INTERFACE;
    o.cosserat = k & 2;
    pair_make(&o, &p);
    pair_start(&p);
    pair_run(&p, 50);
    double wanted = o.gravity * (p.solver.time - 0.5 * p.solver.step); /* v is half a step behind */
    for (int32_t n = 0; n < p.solver.nodes; n++)
      if (p.body.mass[n * p.solver.dofs] > 0.0)
        check_near(p.solver.v[n * p.solver.dofs + 1], wanted, 1e-8, 0.0);
    check_near(p.coupling.work, 0.0, 0.0, 1e-8);
    pair_release(&p);
  }
}

/* ---- bits ---- */

static void check_same_bits(const pair *a, const pair *b) {
  int64_t nodes = (int64_t)a->solver.nodes * a->solver.dofs, grains = a->dem.grains;
  double *place = cdem_allocate(18 * grains, sizeof *place, &fault);
  for (int k = 0; k < 2; k++) {
    double *x = place + 9 * grains * k;
    cdem_dem_view view = {.displacement = x, .velocity = x + 3 * grains, .spin = x + 6 * grains};
    cdem_dem_look(k == 0 ? &a->dem : &b->dem, &view);
  }
  assert_memory_equal(place, place + 9 * grains, 9 * (size_t)grains * sizeof *place);
  assert_memory_equal(a->solver.u, b->solver.u, (size_t)nodes * sizeof *place);
  assert_memory_equal(a->solver.v, b->solver.v, (size_t)nodes * sizeof *place);
  assert_memory_equal(&a->coupling.work, &b->coupling.work, sizeof a->coupling.work);
  free(place);
}

static void threads_and_bits(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    pair one, two;
    pair_options o = pair_chosen(true, 4);
    o.form = k == 0 ? CDEM_BSM_INTERFACE : CDEM_BSM_VIRTUAL_WORK;
    pair_make(&o, &one);
    o.threads = 2;
    pair_make(&o, &two);
    pair_start(&one);
    pair_start(&two);
    pair_run(&one, 10);
    pair_run(&two, 10);
    check_same_bits(&one, &two);
    pair_release(&one);
    pair_release(&two);
  }
}

static void save_and_restore(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    pair whole, half;
    pair_options o = pair_chosen(true, 4);
    cdem_state saved = {0};
    o.form = k & 1 ? CDEM_BSM_VIRTUAL_WORK : CDEM_BSM_INTERFACE;
    o.way = k & 2 ? CDEM_BSM_ACCELERATION : CDEM_BSM_VELOCITY;
    pair_make(&o, &whole);
    pair_make(&o, &half);
    pair_start(&whole);
    pair_start(&half);
    pair_run(&whole, 10);
    check_ok(cdem_solver_save(&whole.solver, &saved, &fault));
    check_ok(cdem_dem_save(&whole.dem, &saved, &fault));
    check_ok(cdem_coupling_save(&whole.coupling, &saved, &fault));
    check_ok(cdem_solver_restore(&half.solver, &saved, &fault));
    check_ok(cdem_dem_restore(&half.dem, &saved, &fault));
    check_ok(cdem_coupling_restore(&half.coupling, &saved, &fault));
    cdem_state_release(&saved);
    pair_run(&whole, 10);
    pair_run(&half, 10);
    check_same_bits(&whole, &half);
    check_fails(cdem_coupling_restore(&half.coupling, &saved, &fault), CDEM_INPUT, "coupling/work");
    pair_release(&whole);
    pair_release(&half);
  }
}

/* ---- refusals ---- */

static void refusals(void **state) {
  (void)state;
  pair p;
  pair_options o = pair_strip(3);
  char text[160];
  pair_make(&o, &p);
  double most = p.options.most_step, step = p.dem.step;
  p.options.cycles = 1000;
  snprintf(text, sizeof text, "it is stable up to %.4g s: take at most %d", most,
           (int)floor(most / step));
  check_fails(cdem_coupling_init(&p.options, &p.coupling, &fault), CDEM_INPUT, text);
  p.options.cycles = 0;
  check_fails(cdem_coupling_init(&p.options, &p.coupling, &fault), CDEM_INPUT,
              "a step of the body of 0 steps of the grains; it has at least one");
  p.options.cycles = 2;
  check_fails(cdem_coupling_init(&p.options, &p.coupling, &fault), CDEM_USAGE,
              "the body steps by ");
  p.options.cycles = 3;
  p.options.most_step = 0.5 * step;
  check_fails(cdem_coupling_init(&p.options, &p.coupling, &fault), CDEM_INPUT,
              "let the grains take shorter steps");
  p.options.most_step = most;
  assert_null(p.coupling.before);
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_memory_fail_after(n);
    status = cdem_coupling_init(&p.options, &p.coupling, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || (status == CDEM_MEMORY && p.coupling.on == NULL));
    memset(&fault, 0, sizeof fault);
  }
  pair_run(&p, 1);
  check_ok(cdem_dem_set_step(&p.dem, 0.5 * step, &fault));
  check_fails(cdem_coupling_step(&p.coupling, &fault), CDEM_USAGE,
              "the step of the grains has changed");
  pair_release(&p);
}

/* Stiffer grains or a lighter body: a shorter step; never longer than the body's own. */
static void the_limit(void **state) {
  (void)state;
  double before = INFINITY;
  for (double density = 1.0; density > 1e-4; density *= 0.1) {
    pair p;
    pair_options o = pair_strip(1);
    char limiter[64];
    double most = 0.0;
    o.density = density;
    o.part = 0.2;
    pair_make(&o, &p);
    double own = cdem_solver_limit(&p.solver, limiter);
    check_ok(cdem_coupling_limit(&p.body, own, &p.tie, &p.dem, &most, &fault));
    check_below(most, 0.8 * own);
    check_below(most, before);
    check_near(most, p.options.most_step, 1e-12, 0.0);
    before = most;
    cdem_status status = CDEM_MEMORY;
    int failures = -1;
    for (; status == CDEM_MEMORY; failures++) {
      most = before;
      cdem_memory_fail_after(failures + 1);
      status = cdem_coupling_limit(&p.body, own, &p.tie, &p.dem, &most, NULL);
      assert_true(status == CDEM_OK || most == before);
    }
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK && failures >= 3);
    assert_true(most == before);
    memset(&fault, 0, sizeof fault);
    pair_release(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_cycle),        cmocka_unit_test(uniform_motion),
      cmocka_unit_test(threads_and_bits), cmocka_unit_test(save_and_restore),
      cmocka_unit_test(refusals),         cmocka_unit_test(the_limit),
      cmocka_unit_test(free_fall),
  };
  return cmocka_run_group_tests_name("bsm coupling", tests, NULL, NULL);
}
