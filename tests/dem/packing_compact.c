/* Room dem: compaction, small ones. The target is met, the box and the grains are at rest, threads
 * do not matter, and what is refused. How dense it gets is measured in packing_compact_slow.c. */
#include "dem/packing.h"
#include "support/test.h"

static cdem_fault fault;

static cdem_packing_options discs(int64_t count, bool periodic) {
  return (cdem_packing_options){.dim = 2,
                                .low = {0.5, -0.25},
                                .high = {1.0, 0.25},
                                .periodic = {periodic, periodic},
                                .sizes = {.kind = CDEM_SIZES_UNIFORM, .least = 0.02, .most = 0.03},
                                .count = count,
                                .seed = 8};
}

static cdem_grains loose(const cdem_packing_options *options) {
  cdem_grains grains;
  check_ok(cdem_packing_make(cdem_packing_find("loose"), options, &grains, &fault));
  return grains;
}

static void pressed(bool periodic, int threads, cdem_grains *grains, cdem_compacted *c) {
  cdem_packing_options options = discs(60, periodic);
  const cdem_compaction compaction = {.pressure = 2000.0,
                                      .friction = 0.3,
                                      .inertial = 1e-2,
                                      .tolerance = 0.02,
                                      .periodic = {periodic, periodic},
                                      .threads = threads};
  *grains = loose(&options);
  check_ok(cdem_grains_complete(grains, &fault));
  grains->velocity[3] = 7.0;
  check_ok(cdem_packing_compact(&options, &compaction, grains, c, &fault));
}

/* Overlaps follow from the stiffness: 1e-3 radii of the mean grain at the mean force; no contact
 * carries more than ten times that. */
static void pressure_is_met(void **state) {
  (void)state;
  for (int periodic = 0; periodic < 2; periodic++) {
    cdem_grains grains;
    cdem_compacted c;
    pressed(periodic, 1, &grains, &c);
    check_near(c.pressure, 2000.0, 0.02, 0.0);
    check_below(c.unbalanced, 0.02);
    check_below(c.most_overlap, 1e-2);
    assert_true(c.coordination > 2.5 && c.coordination < 4.5);
    assert_true(c.low[0] == 0.5 && c.low[1] == -0.25);
    /* The same ratio in all directions. */
    check_near(c.high[0] - c.low[0], c.high[1] - c.low[1], 1e-9, 0.0);
    assert_true(c.high[0] < 1.0);
    check_near(c.fraction, cdem_grains_solid(&grains) / pow(c.high[0] - c.low[0], 2), 1e-9, 0.0);
    assert_true(grains.velocity[3] == 0.0);
    const bool faces[3] = {periodic, periodic, false};
    cdem_packing_contacts contacts;
    check_ok(cdem_packing_look(&grains, c.low, c.high, faces, 1e-6, &contacts, &fault));
    check_below(contacts.overlap, c.most_overlap * (1.0 + 1e-9));
    for (int64_t i = 0; i < grains.grains; i++)
      for (int a = 0; a < 2; a++)
        assert_true(grains.xyz[3 * i + a] >= c.low[a] && grains.xyz[3 * i + a] <= c.high[a]);
    cdem_grains_release(&grains);
  }
}

static void threads_do_not_matter(void **state) {
  (void)state;
  cdem_grains a, b;
  cdem_compacted ca, cb;
  pressed(true, 1, &a, &ca);
  pressed(true, 2, &b, &cb);
  assert_memory_equal(a.xyz, b.xyz, (size_t)(3 * a.grains) * sizeof *a.xyz);
  assert_int_equal(ca.steps, cb.steps);
  cdem_grains_release(&a);
  cdem_grains_release(&b);
}

static void fraction_is_met(void **state) {
  (void)state;
  cdem_packing_options options = discs(60, true);
  const cdem_compaction compaction = {.fraction = 0.78, .inertial = 1e-2, .periodic = {true, true}};
  cdem_grains grains = loose(&options);
  cdem_compacted c;
  check_ok(cdem_packing_compact(&options, &compaction, &grains, &c, &fault));
  check_near(c.fraction, 0.78, 1e-9, 0.0);
  assert_null(grains.velocity);
  cdem_grains_release(&grains);
}

static void refuse(const cdem_compaction *compaction, cdem_status status, const char *text) {
  cdem_packing_options options = discs(60, false);
  cdem_grains grains = loose(&options), before = loose(&options);
  cdem_compacted c;
  check_fails(cdem_packing_compact(&options, compaction, &grains, &c, &fault), status, text);
  assert_memory_equal(grains.xyz, before.xyz, (size_t)(3 * grains.grains) * sizeof *grains.xyz);
  cdem_grains_release(&grains);
  cdem_grains_release(&before);
}

/* 60 spheres in a cylinder of five diameters. */
static const double edge = 0.25;
static cdem_packing_options spheres(double scale) {
  return (cdem_packing_options){.dim = 3,
                                .low = {-0.5 * edge * scale, -0.5 * edge * scale, 0.125 * scale},
                                .high = {0.5 * edge * scale, 0.5 * edge * scale, 0.25 * scale},
                                .cylinder = true,
                                .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = 0.025 * scale},
                                .count = 60,
                                .seed = 8};
}

static void pressed_in_a_cylinder(double scale, double height, int threads, cdem_grains *grains,
                                  cdem_compacted *c) {
  cdem_packing_options options = spheres(scale);
  const cdem_compaction compaction = {.height = height * scale, .threads = threads};
  cdem_packing_make_room(&options, &compaction);
  check_near(60.0 * cdem_grain_solid(3, 0.025 * scale), 0.3 * cdem_packing_room(&options), 1e-12,
             0.0);
  *grains = loose(&options);
  check_ok(cdem_packing_compact(&options, &compaction, grains, c, &fault));
}

static void the_height_of_a_cylinder_is_met(void **state) {
  (void)state;
  cdem_grains grains;
  cdem_compacted c;
  double height = 0.14;
  pressed_in_a_cylinder(1.0, height, 1, &grains, &c);
  assert_true(c.low[2] == 0.125 && c.high[2] == 0.125 + height);
  assert_true(c.low[0] == -0.5 * edge && c.high[1] == 0.5 * edge);
  check_near(c.fraction, 60.0 * pow(0.05, 3) * M_PI / 6.0 / (M_PI / 4.0 * edge * edge * height),
             1e-8, 0.0);
  check_below(c.unbalanced, 1e-2);
  check_below(c.most_overlap, 0.2);
  for (int64_t i = 0; i < grains.grains; i++) {
    const double *x = grains.xyz + 3 * i;
    double reach = 0.025 * (1.0 - c.most_overlap * (1.0 + 1e-9));
    check_below(hypot(x[0], x[1]) + reach, 0.5 * edge);
    assert_true(x[2] - reach >= c.low[2] && x[2] + reach <= c.high[2] * (1.0 + 1e-9));
  }
  cdem_grains_release(&grains);
}

static void cylinders_scale_to_the_bit_whatever_the_threads(void **state) {
  (void)state;
  cdem_grains a, b;
  cdem_compacted ca, cb;
  pressed_in_a_cylinder(1.0, 0.14, 1, &a, &ca);
  pressed_in_a_cylinder(4.0, 0.14, 2, &b, &cb);
  assert_int_equal(ca.steps, cb.steps);
  for (int64_t i = 0; i < 3 * a.grains; i++)
    assert_true(b.xyz[i] == 4.0 * a.xyz[i]);
  assert_true(ca.fraction == cb.fraction && ca.most_overlap == cb.most_overlap);
  cdem_grains_release(&a);
  cdem_grains_release(&b);
}

static void cylinders_jam(void **state) {
  (void)state;
  cdem_packing_options options = spheres(1.0);
  const cdem_compaction compaction = {.height = 0.11};
  cdem_compacted c;
  cdem_packing_make_room(&options, &compaction);
  cdem_grains grains = loose(&options);
  check_fails(cdem_packing_compact(&options, &compaction, &grains, &c, &fault), CDEM_NUMERIC,
              "the grains jam at a solid fraction of 0.");
  cdem_grains_release(&grains);
}

static bool never(void *context, const char *what, int64_t done, int64_t total) {
  (void)context;
  (void)what;
  (void)done;
  (void)total;
  return false;
}

static void refuse_cylinder(const cdem_compaction *compaction, const char *text) {
  cdem_packing_options options = spheres(1.0);
  cdem_packing_make_room(&options, &(cdem_compaction){.height = 0.1});
  cdem_grains grains = loose(&options);
  cdem_compacted c;
  check_fails(cdem_packing_compact(&options, compaction, &grains, &c, &fault), CDEM_INPUT, text);
  cdem_grains_release(&grains);
}

static void refusals(void **state) {
  (void)state;
  refuse(
      &(cdem_compaction){.fraction = 0.8, .pressure = 1.0}, CDEM_INPUT,
      "compaction needs one target: a solid fraction (0.8), a pressure (1 Pa) or the height of a "
      "cylinder (0 m)");
  refuse(&(cdem_compaction){.height = 0.1}, CDEM_INPUT, "to a height is for a cylinder");
  refuse_cylinder(&(cdem_compaction){.pressure = 1.0}, "needs its height or a solid fraction");
  refuse_cylinder(&(cdem_compaction){.height = 0.05},
                  "would fill 1.6000 of the cylinder at a height");
  refuse_cylinder(&(cdem_compaction){.height = 1.0}, "not more than the 1 m wanted");
  refuse_cylinder(&(cdem_compaction){.height = 0.1, .periodic = {false, false, true}},
                  "cannot be periodic along its axis");
  refuse(&(cdem_compaction){0}, CDEM_INPUT, "compaction needs one target");
  refuse(&(cdem_compaction){.fraction = 0.2}, CDEM_INPUT, "before it begins, more than the 0.2000");
  refuse(&(cdem_compaction){.fraction = 1.2}, CDEM_INPUT, "must lie between 0 and 1");
  refuse(&(cdem_compaction){.pressure = 1.0, .friction = -0.5}, CDEM_INPUT,
         "the friction is -0.5; it must not be negative");
  refuse(&(cdem_compaction){.pressure = 1.0, .restitution = 1.5}, CDEM_INPUT,
         "the restitution is 1.5");
  refuse(&(cdem_compaction){.pressure = 1.0, .tolerance = -1e-2}, CDEM_INPUT,
         "the tolerance is -0.01; it must not be negative");
  refuse(&(cdem_compaction){.fraction = 0.95, .inertial = 2e-2}, CDEM_NUMERIC,
         "before 0.9500 is reached; take less, or less friction");
  const cdem_progress stop = {.report = never};
  refuse(&(cdem_compaction){.pressure = 1.0, .progress = &stop}, CDEM_INTERRUPTED, "");
  cdem_packing_options options = discs(60, false);
  cdem_grains grains = loose(&options);
  cdem_compacted c;
  options.dim = 3;
  check_fails(
      cdem_packing_compact(&options, &(cdem_compaction){.pressure = 1.0}, &grains, &c, &fault),
      CDEM_INPUT, "the grains are of dimension 2, their box of 3");
  cdem_grains_release(&grains);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_is_met),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(fraction_is_met),
      cmocka_unit_test(the_height_of_a_cylinder_is_met),
      cmocka_unit_test(cylinders_scale_to_the_bit_whatever_the_threads),
      cmocka_unit_test(cylinders_jam),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("dem packing_compact", tests, NULL, NULL);
}
