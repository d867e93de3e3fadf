/* Room dem: size laws and random packings. Nobody overlaps, everybody is inside, each disc of an
 * inward packing touches two things, sizes follow their law, seeds decide everything. */
#include "dem/packing.h"
#include "support/test.h"

static cdem_fault fault;

static const double class_radius[3] = {0.01, 0.02, 0.04};
static const double class_fraction[3] = {0.2, 0.5, 0.3};

static const cdem_sizes law[] = {
    {.kind = CDEM_SIZES_EQUAL, .radius = 0.02},
    {.kind = CDEM_SIZES_UNIFORM, .least = 0.01, .most = 0.03},
    {.kind = CDEM_SIZES_POWER, .least = 0.01, .most = 0.04, .exponent = -2.5},
    {.kind = CDEM_SIZES_POWER, .least = 0.01, .most = 0.02, .exponent = -1.0},
    {.kind = CDEM_SIZES_NORMAL, .radius = 0.02, .spread = 0.01, .least = 0.008, .most = 0.03},
    {.kind = CDEM_SIZES_TABLE,
     .entries = 3,
     .class_radius = class_radius,
     .class_fraction = class_fraction},
};
enum { LAWS = sizeof law / sizeof law[0] };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Kolmogorov-Smirnov: the largest distance between the shares of a sample and of the law. Its 0.1 %
 * bound is 1.95/sqrt(n). */
static double distance_to_law(int dim, const cdem_sizes *sizes, int64_t n, const double *radius) {
  double *sorted = cdem_allocate(n, sizeof *sorted, NULL), worst = 0.0;
  memcpy(sorted, radius, (size_t)n * sizeof *sorted);
  qsort(sorted, (size_t)n, sizeof *sorted, by_value);
  for (int64_t i = 0; i < n; i++) {
    bool last_of_equals = i + 1 == n || sorted[i + 1] > sorted[i];
    if (last_of_equals)
      worst =
          fmax(worst, fabs((double)(i + 1) / (double)n - cdem_sizes_share(dim, sizes, sorted[i])));
  }
  free(sorted);
  return worst;
}

static void quantile_and_share_are_inverse(void **state) {
  (void)state;
  for (int s = 1; s < LAWS - 1; s++)
    for (int i = 0; i <= 20; i++) {
      double share = 0.05 * i * (1.0 - 1e-12);
      double radius = cdem_sizes_quantile(2, &law[s], share);
      assert_true(radius >= law[s].least && radius <= law[s].most);
      check_near(cdem_sizes_share(2, &law[s], radius), share, 1e-9, 1e-9);
    }
  for (int s = 0; s < LAWS; s++) {
    assert_true(cdem_sizes_share(3, &law[s], 0.999 * cdem_sizes_smallest(&law[s])) == 0.0);
    assert_true(cdem_sizes_share(3, &law[s], cdem_sizes_largest(&law[s])) == 1.0);
  }
}

static void draws_follow_the_law(void **state) {
  (void)state;
  enum { DRAWS = 20000 };
  static double radius[DRAWS];
  for (int s = 0; s < LAWS; s++)
    for (int dim = 2; dim <= 3; dim++) {
      cdem_random random = {21};
      for (int i = 0; i < DRAWS; i++)
        radius[i] = cdem_sizes_draw(dim, &law[s], &random);
      check_below(distance_to_law(dim, &law[s], DRAWS, radius), 1.95 / sqrt(DRAWS));
    }
}

/* A table speaks of solid, not of numbers; the mean solid of the power law in closed form. */
static void solid_of_laws(void **state) {
  (void)state;
  enum { DRAWS = 50000 };
  const double pi = 3.14159265358979323846;
  cdem_random random = {5};
  double solid[3] = {0}, all = 0.0;
  for (int i = 0; i < DRAWS; i++) {
    double r = cdem_sizes_draw(3, &law[LAWS - 1], &random);
    int c = r == class_radius[0] ? 0 : r == class_radius[1] ? 1 : 2;
    solid[c] += r * r * r;
    all += r * r * r;
  }
  /* The largest class has about 1 % of the numbers: 500 draws, sigma of its share 3 %. */
  for (int c = 0; c < 3; c++)
    check_near(solid[c] / all, class_fraction[c], 0.15, 0.0);
  const cdem_sizes *p = &law[2];
  double closed = pi * (2.0 * (sqrt(p->most) - sqrt(p->least))) /
                  ((pow(p->least, -1.5) - pow(p->most, -1.5)) / 1.5);
  check_near(cdem_sizes_mean_solid(2, p), closed, 1e-5, 0.0);
  /* One grain in 8001 is twenty times as large and holds half of the solid. */
  const double radius[2] = {1.0, 20.0}, half[2] = {0.5, 0.5};
  const cdem_sizes rare = {
      .kind = CDEM_SIZES_TABLE, .entries = 2, .class_radius = radius, .class_fraction = half};
  check_near(cdem_sizes_mean_solid(3, &rare), 4.0 / 3.0 * pi * 16000.0 / 8001.0, 1e-14, 0.0);
}

static void bad_sizes(void **state) {
  (void)state;
  cdem_sizes s = {.kind = CDEM_SIZES_UNIFORM, .least = 0.0, .most = 1.0};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "the least radius is 0 m");
  s = (cdem_sizes){.kind = CDEM_SIZES_UNIFORM, .least = 2.0, .most = 1.0};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "must not be below the least, 2 m");
  s = (cdem_sizes){.kind = CDEM_SIZES_POWER, .least = 1.0, .most = 2.0, .exponent = NAN};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "the exponent of the size law is nan");
  s = (cdem_sizes){.kind = CDEM_SIZES_NORMAL, .radius = 1.5, .least = 1.0, .most = 2.0};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "the spread of the radii is 0 m");
  s = (cdem_sizes){.kind = CDEM_SIZES_TABLE};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "at least one class");
  s.entries = 1001;
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "1001 classes, more than 1000; gather");
  const double down[2] = {2.0, 1.0}, half[2] = {0.5, 0.5}, none[2] = {0.5, 0.0};
  s = (cdem_sizes){
      .kind = CDEM_SIZES_TABLE, .entries = 2, .class_radius = down, .class_fraction = half};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "classes ascend");
  s.entries = 1;
  s.class_fraction = none + 1;
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "size class 1 has fraction 0");
  s = (cdem_sizes){.kind = (cdem_size_kind)17};
  check_fails(cdem_sizes_check(&s, &fault), CDEM_INPUT, "there is no size law 17");
}

/* The binary specimens of Wang et al. (2024): equal masses of d and 2 d, eight small ones to one.
 */
static void a_count_of_classes_is_dealt_out(void **state) {
  (void)state;
  const double radius[2] = {0.01, 0.02}, half[2] = {0.5, 0.5};
  const cdem_packing_options options = {.dim = 3,
                                        .high = {0.5, 0.5, 0.5},
                                        .sizes = {.kind = CDEM_SIZES_TABLE,
                                                  .entries = 2,
                                                  .class_radius = radius,
                                                  .class_fraction = half},
                                        .count = 1072,
                                        .seed = 4};
  cdem_grains grains;
  int64_t large = 0, first = 0;
  check_ok(cdem_packing_make(cdem_packing_find("loose"), &options, &grains, &fault));
  for (int64_t i = 0; i < grains.grains; i++) {
    large += grains.radius[i] == 0.02;
    first += grains.radius[i] == 0.02 && i < 536;
  }
  assert_int_equal(large, 119);          /* 1072/9 */
  assert_true(first > 35 && first < 85); /* half of them, five times sigma */
  cdem_grains_release(&grains);
}

/* ---- packings ---- */

static cdem_grains made(const char *name, const cdem_packing_options *options) {
  cdem_grains grains;
  check_ok(cdem_packing_make(cdem_packing_find(name), options, &grains, &fault));
  check_ok(cdem_grains_check(&grains, &fault));
  return grains;
}

/* Nobody overlaps by more than rounding (slack), everybody is in the box. */
static void check_apart(const cdem_packing_options *o, const cdem_grains *grains, double slack) {
  cdem_packing_contacts contacts;
  double low[3], high[3];
  check_ok(cdem_packing_look(grains, o->low, o->high, o->periodic, 1e-9, &contacts, &fault));
  check_below(contacts.overlap, slack);
  cdem_grains_box(grains, low, high);
  for (int c = 0; c < o->dim; c++) {
    if (o->periodic[c])
      continue;
    assert_true(low[c] >= o->low[c] - slack);
    assert_true(high[c] <= o->high[c] + slack);
  }
}

static cdem_packing_options flat(const cdem_sizes *sizes) {
  return (cdem_packing_options){
      .dim = 2, .low = {-1.0, 0.5}, .high = {1.0, 1.5}, .sizes = *sizes, .seed = 4};
}

/* What disc i touches: others and sides of the box. */
static int touched(const cdem_packing_options *o, const cdem_grains *grains, int64_t i) {
  const double *x = grains->xyz + 3 * i;
  double r = grains->radius[i], near = 1e-9 * r;
  int sum = 0;
  for (int c = 0; c < 2; c++)
    sum += (fabs(x[c] - r - o->low[c]) < near) + (fabs(o->high[c] - r - x[c]) < near);
  for (int64_t j = 0; j < grains->grains; j++) {
    double dx = grains->xyz[3 * j] - x[0], dy = grains->xyz[3 * j + 1] - x[1];
    sum += j != i && sqrt(dx * dx + dy * dy) - r - grains->radius[j] < near;
  }
  return sum;
}

/* Dense: touching two things gives about 0.82 for modest ranges of sizes, whatever the law; wide
 * ones more, equal discs crystallise along the sides. */
static void inward_laws(void **state) {
  (void)state;
  for (int s = 0; s < LAWS; s++) {
    cdem_packing_options options = flat(&law[s]);
    cdem_grains grains = made("inward", &options);
    check_apart(&options, &grains, 1e-10);
    for (int64_t i = 0; i < grains.grains; i++)
      assert_true(touched(&options, &grains, i) >= 2);
    double n = (double)grains.grains;
    assert_true(cdem_grains_solid(&grains) / 2.0 > 0.795);
    /* Beside the 0.1 % bound of chance: the queue (n/200) that is left over. */
    check_below(distance_to_law(2, &law[s], grains.grains, grains.radius),
                1.95 / sqrt(n) + 1.0 / 200.0);
    cdem_grains_release(&grains);
  }
}

/* Sides first: the first discs stand along the sides, the last far from them. */
static void inward_goes_inwards(void **state) {
  (void)state;
  cdem_packing_options options = flat(&law[1]);
  cdem_grains grains = made("inward", &options);
  double depth[2] = {0.0, 0.0};
  int64_t tenth = grains.grains / 10;
  for (int64_t i = 0; i < grains.grains; i++) {
    const double *x = grains.xyz + 3 * i;
    double side = fmin(1.0 - fabs(x[0]), 0.5 - fabs(x[1] - 1.0));
    if (i < tenth)
      depth[0] = fmax(depth[0], side);
    if (i >= grains.grains - 2 * tenth && i < grains.grains - tenth)
      depth[1] += side / (double)tenth;
  }
  check_below(depth[0], 0.03 * (1.0 + 1e-12));
  assert_true(depth[1] > 0.25);
  cdem_grains_release(&grains);
}

/* The random foundation of Li & Wan 2010: 6835 discs of 0.02 to 0.05 m in 7.0 x 3.5 m. The counts
 * of this size law scatter by 1 % (its mean solid does, over 7000 draws). */
static void foundation_c(void **state) {
  (void)state;
  const cdem_sizes sizes = {
      .kind = CDEM_SIZES_POWER, .least = 0.02, .most = 0.05, .exponent = -2.5};
  cdem_packing_options options = {.dim = 2, .high = {7.0, 3.5}, .sizes = sizes, .seed = 2};
  cdem_grains grains = made("inward", &options);
  check_near(cdem_grains_solid(&grains) / 24.5, 0.82, 0.0, 0.005);
  check_near((double)grains.grains, 6835.0, 0.025, 0.0);
  cdem_grains_release(&grains);
}

static void loose_laws(void **state) {
  (void)state;
  for (int s = 0; s < LAWS; s++)
    for (int dim = 2; dim <= 3; dim++)
      for (int periodic = 0; periodic < 8; periodic += 7) {
        cdem_packing_options options = {.dim = dim,
                                        .low = {-0.3, 0.1, 0.2},
                                        .high = {0.3, 0.6, 0.7},
                                        .periodic = {periodic & 1, periodic & 2, periodic & 4},
                                        .sizes = law[s],
                                        .fraction = dim == 2 ? 0.5 : 0.3,
                                        .seed = 9};
        cdem_grains grains = made("loose", &options);
        check_apart(&options, &grains, 0.0);
        /* To half of the largest grain. */
        double largest = cdem_sizes_largest(&law[s]), grain = pow(largest, dim) * 2.1;
        check_near(cdem_grains_solid(&grains), options.fraction * cdem_packing_room(&options), 0.0,
                   grain);
        double n = (double)grains.grains;
        check_below(distance_to_law(dim, &law[s], grains.grains, grains.radius), 1.95 / sqrt(n));
        cdem_grains_release(&grains);
      }
}

/* Beyond what random addition alone reaches (0.38 and 0.55), grains are pushed apart. */
static void loose_but_close(void **state) {
  (void)state;
  cdem_packing_options options = {
      .dim = 3, .high = {0.4, 0.4, 0.4}, .sizes = law[0], .fraction = 0.45, .seed = 1};
  cdem_grains grains = made("loose", &options);
  check_apart(&options, &grains, 0.0);
  cdem_grains_release(&grains);
  options.dim = 2;
  options.high[0] = options.high[1] = 1.0;
  options.fraction = 0.65;
  grains = made("loose", &options);
  check_apart(&options, &grains, 0.0);
  cdem_grains_release(&grains);
}

/* Places know nothing of the box's middle: halves hold the same number, within 5 sigma of chance
 * (grains that exclude each other scatter less). */
static void loose_is_uniform(void **state) {
  (void)state;
  cdem_packing_options options = {.dim = 3,
                                  .high = {1.0, 1.0, 1.0},
                                  .periodic = {true, true, true},
                                  .sizes = law[0],
                                  .fraction = 0.1,
                                  .seed = 6};
  cdem_grains grains = made("loose", &options);
  for (int c = 0; c < 3; c++) {
    int64_t lower = 0;
    for (int64_t i = 0; i < grains.grains; i++)
      lower += grains.xyz[3 * i + c] < 0.5;
    check_near((double)lower, 0.5 * (double)grains.grains, 0.0, 2.5 * sqrt((double)grains.grains));
  }
  cdem_grains_release(&grains);
}

static void cylinder(void **state) {
  (void)state;
  cdem_packing_options options = {.dim = 3,
                                  .low = {1.0, 2.0, 0.0},
                                  .high = {1.5, 2.6, 1.0},
                                  .cylinder = true,
                                  .periodic = {false, false, true},
                                  .sizes = law[1],
                                  .fraction = 0.3,
                                  .seed = 3};
  cdem_grains grains = made("loose", &options);
  check_apart(&options, &grains, 0.0);
  check_near(cdem_packing_room(&options), 0.25 * 3.14159265358979 * 0.25, 1e-14, 0.0);
  check_near(cdem_grains_solid(&grains) / cdem_packing_room(&options), 0.3, 0.002, 0.0);
  for (int64_t i = 0; i < grains.grains; i++) {
    double x = grains.xyz[3 * i] - 1.25, y = grains.xyz[3 * i + 1] - 2.3;
    check_below(sqrt(x * x + y * y) + grains.radius[i], 0.25 * (1.0 + 1e-12));
  }
  cdem_grains_release(&grains);
}

/* Grains as wide as the tube have their centres on its axis, however deep the box is. */
static void cylinder_of_one_grain(void **state) {
  (void)state;
  cdem_packing_options options = {.dim = 3,
                                  .high = {1.0, 50.0, 30.0},
                                  .cylinder = true,
                                  .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = 0.5},
                                  .count = 10,
                                  .seed = 3};
  cdem_grains grains = made("loose", &options);
  check_apart(&options, &grains, 0.0);
  for (int64_t i = 0; i < grains.grains; i++) {
    assert_true(grains.xyz[3 * i] == 0.5);
    assert_true(grains.xyz[3 * i + 1] == 25.0);
  }
  cdem_grains_release(&grains);
}

static void count_is_kept(void **state) {
  (void)state;
  cdem_packing_options options = {
      .dim = 2, .high = {1.0, 1.0}, .sizes = law[2], .count = 321, .seed = 3};
  cdem_grains grains = made("loose", &options);
  assert_int_equal(grains.grains, 321);
  cdem_grains_release(&grains);
}

/* Same seed same bits, another seed another packing, twice the box twice the places. */
static void seeds_and_scale(void **state) {
  (void)state;
  for (int p = 0; p < 2; p++) {
    const char *name = p == 0 ? "inward" : "loose";
    cdem_packing_options options = flat(&law[1]), twice, other;
    options.fraction = p == 0 ? 0.0 : 0.5;
    twice = other = options;
    other.seed++;
    for (int c = 0; c < 2; c++) {
      twice.low[c] *= 2.0;
      twice.high[c] *= 2.0;
    }
    twice.sizes.least *= 2.0;
    twice.sizes.most *= 2.0;
    cdem_grains a = made(name, &options), b = made(name, &options), c = made(name, &twice);
    cdem_grains d = made(name, &other);
    assert_int_equal(a.grains, b.grains);
    assert_int_equal(a.grains, c.grains);
    assert_memory_equal(a.xyz, b.xyz, (size_t)(3 * a.grains) * sizeof *a.xyz);
    for (int64_t i = 0; i < 3 * a.grains; i++)
      assert_true(2.0 * a.xyz[i] == c.xyz[i]);
    assert_true(a.xyz[3] != d.xyz[3]);
    cdem_grains_release(&a);
    cdem_grains_release(&b);
    cdem_grains_release(&c);
    cdem_grains_release(&d);
  }
}

static void refuse(const cdem_packing_options *options, cdem_status status, const char *text) {
  cdem_grains grains;
  check_fails(cdem_packing_make(cdem_packing_find("loose"), options, &grains, &fault), status,
              text);
  assert_null(grains.xyz);
}

static void refusals(void **state) {
  (void)state;
  cdem_packing_options base = flat(&law[0]), o = base;
  refuse(&o, CDEM_INPUT, "needs a count or a solid fraction");
  o.fraction = 0.3;
  o.count = 10;
  refuse(&o, CDEM_INPUT, "count (10) and fraction (0.3) exclude each other");
  o.count = -1;
  refuse(&o, CDEM_INPUT, "-1 grains are wanted");
  o = base;
  o.fraction = 1.5;
  refuse(&o, CDEM_INPUT, "the solid fraction is 1.5");
  o.fraction = 1e-9;
  refuse(&o, CDEM_INPUT, "less than half a grain of radius 0.02 m");
  o.fraction = 0.3;
  o.cylinder = true;
  refuse(&o, CDEM_INPUT, "a cylinder needs spheres");
  o = base;
  o.fraction = 0.3;
  o.periodic[1] = true;
  o.high[1] = o.low[1] + 0.07;
  refuse(&o, CDEM_INPUT, "a periodic one needs at least two of them");
  o = base;
  o.low[0] = 0.6;
  o.fraction = 0.93;
  refuse(&o, CDEM_NUMERIC, "found a place without overlap, a solid fraction of 0.");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantile_and_share_are_inverse),
      cmocka_unit_test(draws_follow_the_law),
      cmocka_unit_test(solid_of_laws),
      cmocka_unit_test(bad_sizes),
      cmocka_unit_test(a_count_of_classes_is_dealt_out),
      cmocka_unit_test(inward_laws),
      cmocka_unit_test(inward_goes_inwards),
      cmocka_unit_test(foundation_c),
      cmocka_unit_test(loose_laws),
      cmocka_unit_test(loose_but_close),
      cmocka_unit_test(loose_is_uniform),
      cmocka_unit_test(cylinder),
      cmocka_unit_test(cylinder_of_one_grain),
      cmocka_unit_test(count_is_kept),
      cmocka_unit_test(seeds_and_scale),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("dem packing_random", tests, NULL, NULL);
}
