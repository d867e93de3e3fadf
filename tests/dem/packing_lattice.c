/* Room dem: lattices. Counts known in advance, touching to rounding, whole grains in the box, bits
 * that scale, and what the table refuses. */
#include "dem/packing.h"
#include "support/test.h"

static cdem_fault fault;

static cdem_packing_options flat(double width, double height, double radius) {
  return (cdem_packing_options){
      .dim = 2, .high = {width, height}, .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = radius}};
}

static cdem_packing_options solid(double edge, double radius) {
  return (cdem_packing_options){
      .dim = 3, .high = {edge, edge, edge}, .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = radius}};
}

static cdem_grains made(const char *name, const cdem_packing_options *options) {
  cdem_grains grains;
  check_ok(cdem_packing_make(cdem_packing_find(name), options, &grains, &fault));
  check_ok(cdem_grains_check(&grains, &fault));
  return grains;
}

static int64_t count(const char *name, const cdem_packing_options *options) {
  cdem_grains grains = made(name, options);
  int64_t n = grains.grains;
  cdem_grains_release(&grains);
  return n;
}

/* The foundation of Li & Wan 2010, section 3: assemblies A and B. */
static void foundation_counts(void **state) {
  (void)state;
  const double radius[2] = {0.05, 0.03};
  const int64_t expected[2] = {2426, 6765};
  for (int i = 0; i < 2; i++) {
    cdem_packing_options options = flat(7.0, 3.5, radius[i]);
    options.centres_inside = true;
    assert_int_equal(count("square", &options), expected[i]);
    /* Wherever the box stands. */
    for (int c = 0; c < 2; c++) {
      options.low[c] -= 3.5;
      options.high[c] -= 3.5;
    }
    assert_int_equal(count("square", &options), expected[i]);
  }
}

/* The rule itself: the top row is tangent to the top and has no disc in the middle, ids rise from
 * the bottom, rows are symmetric. */
static void square_rule(void **state) {
  (void)state;
  cdem_packing_options options = flat(7.0, 3.5, 0.05);
  options.centres_inside = true;
  cdem_grains grains = made("square", &options);
  const double *xyz = grains.xyz;
  int64_t last = grains.grains - 1, top = 0;
  double nearest = 7.0, sum = 0.0;
  check_near(xyz[3 * last + 1], 3.45, 1e-15, 0.0);
  for (int64_t i = 0; i < grains.grains; i++) {
    assert_true(i == 0 || xyz[3 * i + 1] >= xyz[3 * i - 2]);
    assert_true(xyz[3 * i] >= 0.0 && xyz[3 * i] <= 7.0 && xyz[3 * i + 1] >= 0.0);
    sum += xyz[3 * i] - 3.5;
    if (xyz[3 * i + 1] == xyz[3 * last + 1]) {
      top++;
      nearest = fmin(nearest, fabs(xyz[3 * i] - 3.5));
    }
  }
  assert_int_equal(top, 50);
  check_near(nearest, sqrt(2.0) * 0.05, 1e-12, 0.0);
  check_near(sum, 0.0, 0.0, 1e-10);
  cdem_grains_release(&grains);
}

/* Neighbours inside touch to rounding: as many as the lattice has, none deeper. */
static void check_touching(const char *name, const cdem_packing_options *options, double most,
                           double edge_share) {
  cdem_grains grains = made(name, options);
  cdem_packing_contacts contacts;
  check_ok(cdem_packing_look(&grains, options->low, options->high, options->periodic, 1e-9,
                             &contacts, &fault));
  /* Coordinates of 1 m carry rounding of 1e-16 m; radii are 0.01 m or more. */
  check_below(fabs(contacts.overlap), 1e-13);
  assert_true(contacts.coordination < most);
  check_below(most * (1.0 - edge_share), contacts.coordination);
  double low[3], high[3];
  cdem_grains_box(&grains, low, high);
  for (int c = 0; c < options->dim; c++) {
    assert_true(low[c] >= options->low[c] - 1e-14);
    assert_true(high[c] <= options->high[c] + 1e-14);
  }
  cdem_grains_release(&grains);
}

static void lattices_touch(void **state) {
  (void)state;
  cdem_packing_options disc = flat(1.0, 1.0, 0.01), sphere = solid(1.0, 0.04);
  check_touching("square", &disc, 4.0, 0.05);
  check_touching("hexagonal", &disc, 6.0, 0.05);
  check_touching("cubic", &disc, 4.0, 0.05);
  /* A grain on a face, and there are many, lacks a quarter (hexagonal) or a sixth (cubic). */
  check_touching("hexagonal", &sphere, 12.0, 0.25);
  check_touching("cubic", &sphere, 6.0, 0.2);
}

/* A box that holds a whole number of grains but for rounding holds that number. */
static void whole_numbers(void **state) {
  (void)state;
  cdem_packing_options options = flat(0.7, 0.3, 0.05);
  assert_int_equal(count("cubic", &options), 7 * 3);
  options = solid(0.6, 0.1);
  assert_int_equal(count("cubic", &options), 27);
  /* Centres on the corners of the box count. */
  options.centres_inside = true;
  assert_int_equal(count("cubic", &options), 64);
}

/* pi/sqrt(12), pi/sqrt(18): what is known of the densest lattices, from a large box inside. */
static void known_densities(void **state) {
  (void)state;
  const double pi = 3.14159265358979323846;
  cdem_packing_options disc = flat(1.0, 1.0, 0.002);
  cdem_grains grains = made("hexagonal", &disc);
  check_near(cdem_grains_solid(&grains), pi / sqrt(12.0), 0.01, 0.0);
  cdem_grains_release(&grains);
  cdem_packing_options sphere = solid(1.0, 0.0125);
  grains = made("hexagonal", &sphere);
  check_near(cdem_grains_solid(&grains), pi / sqrt(18.0), 0.05, 0.0);
  cdem_grains_release(&grains);
}

static void bits_scale(void **state) {
  (void)state;
  for (int p = 0; p < 3; p++) {
    const char *name = (const char *[]){"square", "hexagonal", "cubic"}[p];
    cdem_packing_options options = flat(1.3, 0.7, 0.011), twice = flat(2.6, 1.4, 0.022);
    cdem_grains a = made(name, &options), b = made(name, &twice);
    assert_int_equal(a.grains, b.grains);
    for (int64_t i = 0; i < 3 * a.grains; i++)
      assert_true(2.0 * a.xyz[i] == b.xyz[i]);
    cdem_grains_release(&a);
    cdem_grains_release(&b);
  }
}

static void table_is_whole(void **state) {
  (void)state;
  static const char *const name[] = {
#define X(name) #name,
#include "dem/packings.def"
#undef X
  };
  const int count = sizeof name / sizeof *name;
  for (int i = 0; i < count; i++) {
    assert_string_equal(cdem_packing_at(i)->name, name[i]);
    assert_ptr_equal(cdem_packing_find(name[i]), cdem_packing_at(i));
    assert_true(strlen(cdem_packing_at(i)->help) > 10);
  }
  assert_null(cdem_packing_at(count));
  assert_null(cdem_packing_at(-1));
  assert_null(cdem_packing_find("random"));
}

static void refuse(const char *name, const cdem_packing_options *options, const char *text) {
  cdem_grains grains;
  check_fails(cdem_packing_make(cdem_packing_find(name), options, &grains, &fault), CDEM_INPUT,
              text);
  assert_int_equal(grains.grains, 0);
  assert_null(grains.xyz);
}

static void refusals(void **state) {
  (void)state;
  cdem_packing_options options = flat(1.0, 1.0, -0.1);
  refuse("square", &options, "the radius is -0.1 m; a radius is positive");
  options = flat(1.0, -1.0, 0.1);
  refuse("square", &options, "the box reaches from 0 to -1 m in y");
  options = flat(1.0, 0.1, 0.1);
  refuse("cubic", &options, "too short for grains of diameter 0.2 m");
  options = solid(1.0, 0.1);
  refuse("square", &options, "a packing 'square' is of discs (2-D) only");
  options = flat(1.0, 1.0, 0.1);
  options.dim = 4;
  refuse("square", &options, "dimension 2 or 3, not 4");
  options.dim = 2;
  options.sizes = (cdem_sizes){.kind = CDEM_SIZES_UNIFORM, .least = 0.1, .most = 0.2};
  refuse("hexagonal", &options, "lattice of equal grains; sizes 'uniform'");
  options = flat(1.0, 1.0, 0.1);
  options.fraction = 0.5;
  refuse("cubic", &options, "count and fraction are for 'loose'");
  options.fraction = 0.0;
  options.periodic[0] = true;
  refuse("cubic", &options, "no periodic faces");
  options.periodic[0] = false;
  options.cylinder = true;
  refuse("cubic", &options, "only 'loose' fills a cylinder");
  options.cylinder = false;
  options.centres_inside = true;
  refuse("inward", &options, "centres_inside is for lattices");
  /* Refused before memory is filled, also where the number has no integer. */
  static const char *const kinds[4] = {"square", "hexagonal", "cubic", "inward"};
  for (int k = 0; k < 4; k++) {
    options = flat(1e4, 1e4, 0.01);
    refuse(kinds[k], &options, "the box would hold more than 1.59e+11 grains");
    options = flat(1e10, 1e10, 1e-12);
    refuse(kinds[k], &options, "the box would hold more than");
  }
  /* Lower than the radius: the top row is below the bottom. */
  options = flat(1.0, 0.05, 0.1);
  options.centres_inside = true;
  refuse("square", &options, "no grain of radius 0.1 m fits");
}

static bool never(void *context, const char *what, int64_t done, int64_t total) {
  (void)context;
  (void)what;
  (void)done;
  (void)total;
  return false;
}

static void interrupted(void **state) {
  (void)state;
  const cdem_progress stop = {.report = never};
  for (int i = 0; cdem_packing_at(i) != NULL; i++) {
    cdem_grains grains;
    cdem_packing_options options = flat(1.0, 1.0, 0.1);
    options.progress = &stop;
    if (cdem_packing_at(i)->loose)
      options.count = 3;
    assert_int_equal(cdem_packing_make(cdem_packing_at(i), &options, &grains, &fault),
                     CDEM_INTERRUPTED);
    assert_null(grains.xyz);
    memset(&fault, 0, sizeof fault);
  }
}

static void out_of_memory(void **state) {
  (void)state;
  for (int i = 0; cdem_packing_at(i) != NULL; i++) {
    cdem_status status = CDEM_MEMORY;
    for (int n = 0; status != CDEM_OK; n++) {
      cdem_grains grains;
      cdem_packing_options options = flat(1.0, 1.0, 0.05);
      options.count = cdem_packing_at(i)->loose ? 40 : 0;
      cdem_memory_fail_after(n);
      status = cdem_packing_make(cdem_packing_at(i), &options, &grains, &fault);
      cdem_memory_fail_after(-1);
      assert_true(status == CDEM_OK || status == CDEM_MEMORY);
      assert_true(status == CDEM_OK || grains.xyz == NULL);
      cdem_grains_release(&grains);
      memset(&fault, 0, sizeof fault);
      assert_true(n < 1000);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(foundation_counts), cmocka_unit_test(square_rule),
      cmocka_unit_test(lattices_touch),    cmocka_unit_test(whole_numbers),
      cmocka_unit_test(known_densities),   cmocka_unit_test(bits_scale),
      cmocka_unit_test(table_is_whole),    cmocka_unit_test(refusals),
      cmocka_unit_test(interrupted),       cmocka_unit_test(out_of_memory),
  };
  return cmocka_run_group_tests_name("dem packing_lattice", tests, NULL, NULL);
}
