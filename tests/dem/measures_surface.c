/* Free surfaces: angles of heaps, cones and slopes that are known. */
#include "measures_support.h"

static const double pi = 3.14159265358979323846;

/* Grains of a jittered lattice below a surface. */
static assembly *heap(int dim, double slope, bool one_sided) {
  assembly *m = assembly_new(dim);
  cdem_random random = {9};
  const double a = dim == 2 ? 0.1 : 0.2;
  int wide = dim == 2 ? 40 : 12;
  for (int k = 0; k < (dim == 2 ? 1 : 2 * wide + 1); k++)
    for (int j = 0; j < 60; j++)
      for (int i = -wide; i <= wide; i++) {
        double x = a * i, y = dim == 3 ? a * (k - wide) : 0.0, z = 0.5 * a + a * j;
        double out = one_sided ? a * wide - x : dim == 3 ? hypot(x, y) : fabs(x);
        if (z + 0.5 * a > slope * (a * wide - out) + (one_sided ? 0.3 : 0.0))
          continue;
        put_grain(m, x + a * cdem_random_uniform(&random, -.2, .2), dim == 3 ? y : z,
                  dim == 3 ? z : 0.0, 0.5 * a);
        m->touching[m->s.grains - 1] = 2;
      }
  put_grain(m, 0.1, dim == 3 ? 0 : 50, dim == 3 ? 50 : 0, 0.5 * a); /* flies, does not count */
  return m;
}

static void angles_of_known_slopes(void **unused) {
  (void)unused;
  static const struct {
    int dim;
    cdem_surface_kind kind;
    double degrees, tolerance;
  } known[] = {{2, CDEM_SURFACE_HEAP, 25, 1.0},
               {2, CDEM_SURFACE_HEAP, 35, 1.0},
               {3, CDEM_SURFACE_CONE, 30, 2.0},
               {2, CDEM_SURFACE_SLOPE, 20, 1.0}};
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
    cdem_fault fault = {0};
    bool slope = known[k].kind == CDEM_SURFACE_SLOPE;
    assembly *m = heap(known[k].dim, tan(known[k].degrees * pi / 180), slope);
    cdem_surface surface = {0};
    cdem_surface_options options = {.kind = known[k].kind};
    if (slope) { /* the one-sided heap rises to the right of the middle */
      options.low = 0.2;
      options.high = 3.8;
    }
    check_ok(cdem_free_surface_make(&m->s, &options, &surface, &fault));
    for (int flank = 0; flank < surface.flanks; flank++) {
      check_near(surface.angle[flank] * 180 / pi, known[k].degrees, 0, known[k].tolerance);
      assert_true(surface.points[flank] >= 6);
      check_below(surface.scatter[flank], 0.1); /* a diameter at most */
      assert_true(surface.error[flank] > 0 && surface.error[flank] < 0.06);
    }
    check_near(surface.repose * 180 / pi, known[k].degrees, 0, known[k].tolerance);
    assert_true(surface.crest < 10);
    cdem_surface_release(&surface);
    assert_null(surface.place);
    free(m);
  }
}

/* Turned together with its directions, a heap is the same. */
static void directions_are_free(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  assembly *m = heap(2, 0.5, false);
  cdem_surface a = {0}, b = {0};
  cdem_surface_options options = {.kind = CDEM_SURFACE_HEAP, .bins = 40};
  check_ok(cdem_free_surface_make(&m->s, &options, &a, &fault));
  for (int64_t i = 0; i < m->s.grains; i++) { /* (x, y) -> (-y, x) */
    double x = m->xyz[3 * i];
    m->xyz[3 * i] = -m->xyz[3 * i + 1];
    m->xyz[3 * i + 1] = x;
  }
  options.up[0] = -2;
  options.along[1] = 3;
  check_ok(cdem_free_surface_make(&m->s, &options, &b, &fault));
  check_near(b.repose, a.repose, 1e-12, 0);
  for (int k = 0; k < 40; k++)
    check_near(b.height[k], a.height[k], 1e-12, 0);
  cdem_surface_release(&a);
  cdem_surface_release(&b);
  options.along[0] = 3;
  check_fails(cdem_free_surface_make(&m->s, &options, &b, &fault), CDEM_USAGE,
              "runs across its upward direction");
  options = (cdem_surface_options){.flank_low = 0.5, .flank_high = 0.2};
  check_fails(cdem_free_surface_make(&m->s, &options, &b, &fault), CDEM_USAGE, "from 0.5 to 0.2");
  options = (cdem_surface_options){.kind = CDEM_SURFACE_CONE};
  check_fails(cdem_free_surface_make(&m->s, &options, &b, &fault), CDEM_USAGE, "no cone");
  options = (cdem_surface_options){.bins = -1};
  check_fails(cdem_free_surface_make(&m->s, &options, &b, &fault), CDEM_USAGE, "-1 bins");
  options = (cdem_surface_options){.kind = CDEM_SURFACE_HEAP};
  for (int n = 0; n < 3; n++) {
    cdem_memory_fail_after(n);
    check_fails(cdem_free_surface_make(&m->s, &options, &b, &fault), CDEM_MEMORY, "");
    assert_null(b.place);
  }
  cdem_memory_fail_after(-1);
  free(m);
}

static void empty_surfaces_have_no_angle(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  assembly *m = assembly_new(3);
  cdem_surface surface = {0};
  cdem_surface_options options = {.kind = CDEM_SURFACE_HEAP};
  check_ok(cdem_free_surface_make(&m->s, &options, &surface, &fault));
  assert_true(isnan(surface.repose) && isnan(surface.crest));
  cdem_surface_release(&surface);
  free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(angles_of_known_slopes),
      cmocka_unit_test(directions_are_free),
      cmocka_unit_test(empty_surfaces_have_no_angle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
