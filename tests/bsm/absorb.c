/* Room bsm: the absorbing layer takes what the mesh cannot express, and nothing else. */
#include "base/memory.h"
#include "base/random.h"
#include "bsm/bsm.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ACROSS = 6, UP = 4, PER = 3, GRAINS = ACROSS * UP * PER * PER };

/* A block of ACROSS x UP elements of 1 m, 3 x 3 discs each, the left part fine; discs do not touch.
 */
typedef struct {
  cdem_mesh mesh;
  int32_t cells, *cell, layer_cells, *layer;
  cdem_grains grains;
  cdem_grain_material material;
  cdem_contact_input contact;
  cdem_dem dem;
  int32_t id[GRAINS], home[GRAINS];
  double xi[3 * GRAINS];
  cdem_absorb absorb;
} scene;

static const double rate = 40.0, step = 1e-3;

/* u = (1 + 2x - y, 3 - x/2 + y), spin 2 everywhere; or something of each grain's own. */
static void move(scene *s, bool random) {
  cdem_random r = {5};
  for (int64_t i = 0; i < s->grains.grains; i++) {
    const double *x = s->grains.xyz + 3 * i;
    double *v = s->grains.velocity + 3 * i;
    v[0] = random ? cdem_random_uniform(&r, -1.0, 1.0) : 1.0 + 2.0 * x[0] - x[1];
    v[1] = random ? cdem_random_uniform(&r, -1.0, 1.0) : 3.0 - 0.5 * x[0] + x[1];
    s->grains.spin[3 * i + 2] = random ? cdem_random_uniform(&r, -1.0, 1.0) : 2.0;
  }
}

static void make_grains(scene *s, bool random) {
  cdem_fault fault = {0};
  s->grains.dim = 2;
  for (int j = 0; j < UP * PER; j++)
    for (int i = 0; i < ACROSS * PER; i++) {
      const double x[3] = {(i + 0.5) / PER, (j + 0.5) / PER, 0.0};
      check_ok(cdem_grains_add(&s->grains, x, (i + j) % 2 == 0 ? 0.12 : 0.15, &fault));
    }
  check_ok(cdem_grains_complete(&s->grains, &fault));
  move(s, random);
  s->material = (cdem_grain_material){.name = "g", .density = 2000.0, .young = NAN, .poisson = NAN};
  for (int k = 0; k < CDEM_LAW_KEYS; k++)
    s->contact.value[k] = NAN;
  s->contact.value[CDEM_LAW_normal_stiffness] = 1e5;
  s->contact.value[CDEM_LAW_damping_ratio] = 0.0;
  const cdem_dem_options options = {.grains = &s->grains,
                                    .materials = 1,
                                    .material = &s->material,
                                    .law = cdem_law_find("linear"),
                                    .contact = &s->contact,
                                    .step = step,
                                    .energies = true,
                                    .threads = 1};
  check_ok(cdem_dem_init(&options, &s->dem, &fault));
}

static cdem_status try_layer(scene *s, double wanted, cdem_fault *fault) {
  const cdem_absorb_options options = {.mesh = &s->mesh,
                                       .cells = s->layer_cells,
                                       .layer = s->layer,
                                       .grains = GRAINS,
                                       .grain = s->id,
                                       .cell = s->home,
                                       .xi = s->xi,
                                       .fine = &s->dem,
                                       .rate = wanted};
  return cdem_absorb_init(&options, &s->absorb, fault);
}

static void make(scene *s, int layers, bool random) {
  cdem_fault fault = {0};
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_QUAD4, .count = {ACROSS, UP, 0}, .size = {ACROSS, UP, 0.0}};
  const cdem_bsm_box box = {.low = {0.0, 0.0, 0.0}, .high = {4.0, UP, 0.0}};
  memset(s, 0, sizeof *s);
  check_ok(cdem_mesh_grid(&grid, &s->mesh, &fault));
  check_ok(cdem_bsm_cells(&s->mesh, 1, &box, &s->cells, &s->cell, &fault));
  check_ok(
      cdem_absorb_cells(&s->mesh, s->cells, s->cell, layers, &s->layer_cells, &s->layer, &fault));
  make_grains(s, random);
  for (int32_t i = 0; i < GRAINS; i++)
    s->id[i] = i;
  check_ok(cdem_locate(&s->mesh, s->cells, s->cell, GRAINS, s->grains.xyz, s->home, s->xi, &fault));
}

static void release(scene *s) {
  cdem_absorb_release(&s->absorb);
  cdem_dem_release(&s->dem);
  cdem_grains_release(&s->grains);
  cdem_mesh_release(&s->mesh);
  free(s->cell);
  free(s->layer);
}

/* Columns 0 .. 3 of the grid are fine; a row is ACROSS cells. */
static void the_layer_lies_along_the_outer_cells(void **state) {
  (void)state;
  for (int layers = 1; layers <= 5; layers++) {
    scene s;
    make(&s, layers, false);
    int wide = layers < 4 ? layers : 4;
    assert_int_equal(s.layer_cells, wide * UP);
    for (int32_t k = 0; k < s.layer_cells; k++) {
      int32_t x[2] = {4 - wide + k % wide, k / wide};
      const int32_t *node = cdem_mesh_cell(&s.mesh, s.layer[k]);
      assert_true(fabs(s.mesh.xyz[3 * node[0]] - x[0]) < 1e-12);
      assert_true(fabs(s.mesh.xyz[3 * node[0] + 1] - x[1]) < 1e-12);
      assert_true(k == 0 || s.layer[k] > s.layer[k - 1]);
    }
    release(&s);
  }
}

static double largest(const scene *s) {
  double most = 0.0;
  for (int64_t k = 0; k < 6 * GRAINS; k++)
    most = fmax(most, fabs(s->dem.applied[k]));
  return most;
}

static void a_linear_motion_is_not_felt(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  make(&s, 2, false);
  check_ok(try_layer(&s, rate, &fault));
  assert_int_equal(s.absorb.projector.grains, 2 * UP * PER * PER);
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  /* against c m v with v of some 10 m/s */
  assert_true(largest(&s) < 1e-12 * rate * 2000.0 * 0.07 * 10.0);
  release(&s);
}

/* No work with shape functions, so no resultant and no moment either. */
static void the_forces_do_no_work_with_the_mesh(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  make(&s, 2, true);
  check_ok(try_layer(&s, rate, &fault));
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  const cdem_projector *p = &s.absorb.projector;
  double *nodal = cdem_allocate(6 * (int64_t)p->nodes, sizeof *nodal, &fault), sum[3] = {0};
  cdem_weights_gather(&p->weights, 6, s.absorb.force, nodal);
  assert_true(largest(&s) > 0.1);
  for (int64_t k = 0; k < 6 * (int64_t)p->nodes; k++)
    assert_true(fabs(nodal[k]) < 1e-11 * largest(&s));
  for (int64_t i = 0; i < GRAINS; i++) {
    const double *f = s.dem.applied + 6 * i, *x = s.grains.xyz + 3 * i;
    sum[0] += f[0];
    sum[1] += f[1];
    sum[2] += x[0] * f[1] - x[1] * f[0] + f[5];
  }
  for (int k = 0; k < 3; k++)
    assert_true(fabs(sum[k]) < 1e-10 * largest(&s));
  free(nodal);
  release(&s);
}

/* Power -c v Mp Q v = -2 c E(Q v). */
static void what_is_taken_is_the_energy_of_the_fine_part(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  double power = 0.0;
  make(&s, 2, true);
  check_ok(try_layer(&s, rate, &fault));
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  for (int64_t a = 0; a < s.absorb.projector.grains; a++)
    for (int k = 0; k < 6; k++)
      power += s.absorb.force[6 * a + k] * s.absorb.motion[6 * a + k];
  double fine = cdem_projector_energy(&s.absorb.projector, s.absorb.shape, s.absorb.q);
  assert_true(fabs(power / (-2.0 * rate * fine) - 1.0) < 1e-12);
  release(&s);
}

/* Forces of others stay; those of the layer are put in the place of the last ones, never twice. */
static void what_others_apply_stays(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  double before[6 * GRAINS];
  make(&s, 1, true);
  check_ok(try_layer(&s, rate, &fault));
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  memcpy(before, s.dem.applied, sizeof before);
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  assert_memory_equal(before, s.dem.applied, sizeof before);
  check_ok(cdem_absorb_restored(&s.absorb, &fault));
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  assert_memory_equal(before, s.dem.applied, sizeof before);
  for (int64_t k = 0; k < 6 * GRAINS; k++)
    s.dem.applied[k] = 1.0;
  cdem_absorb_forget(&s.absorb);
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  for (int64_t k = 0; k < 6 * GRAINS; k++)
    assert_true(fabs(s.dem.applied[k] - 1.0 - before[k]) < 1e-12 * (1.0 + fabs(before[k])));
  release(&s);
}

/* Grains that touch nothing: the fine part fades by (1 - c dt) a step, the rest goes on. */
static void the_fine_part_fades_and_the_book_closes(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  cdem_dem_energies e;
  enum { STEPS = 5 };
  make(&s, 4, true);
  check_ok(try_layer(&s, rate, &fault));
  check_ok(cdem_absorb_apply(&s.absorb, &fault));
  double start = cdem_projector_energy(&s.absorb.projector, s.absorb.shape, s.absorb.q);
  for (int n = 0; n < STEPS; n++) {
    check_ok(cdem_dem_steps(&s.dem, 1, &fault));
    check_ok(cdem_absorb_apply(&s.absorb, &fault));
  }
  double end = cdem_projector_energy(&s.absorb.projector, s.absorb.shape, s.absorb.q);
  /* v of the start is that of t = 0 less half a step: the first step has half the time */
  double part = end / start, one = pow(1.0 - rate * step, 2.0 * STEPS);
  assert_true(part < pow(1.0 - rate * step, 2.0 * (STEPS - 1)) && part > 0.99 * one);
  cdem_dem_energies_now(&s.dem, &e);
  assert_true(e.applied < 0.0);
  assert_true(fabs(e.error) < 1e-9 * e.exchange);
  release(&s);
}

static void a_rate_that_is_too_large_is_refused(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  make(&s, 1, true);
  check_fails(try_layer(&s, 2.0 / step, &fault), CDEM_INPUT, "is stable up to");
  assert_null(s.absorb.grain);
  check_fails(try_layer(&s, 0.0, &fault), CDEM_INPUT, "is stable up to");
  release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_layer_lies_along_the_outer_cells),
      cmocka_unit_test(a_linear_motion_is_not_felt),
      cmocka_unit_test(the_forces_do_no_work_with_the_mesh),
      cmocka_unit_test(what_is_taken_is_the_energy_of_the_fine_part),
      cmocka_unit_test(what_others_apply_stays),
      cmocka_unit_test(the_fine_part_fades_and_the_book_closes),
      cmocka_unit_test(a_rate_that_is_too_large_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
