/* Mesh walls: one contact where facets meet, whatever the triangulation; histories handed on. */
#include "dem/walls_store.h"
#include "walls_support.h"

enum { MOST_CORNERS = 4000, MOST_FACETS = 5000 };

typedef struct {
  int32_t corners, facets;
  double corner[3 * MOST_CORNERS];
  int32_t facet[3 * MOST_FACETS];
} surface;

static int32_t add_corner(surface *m, double x, double y, double z) {
  assert_true(m->corners < MOST_CORNERS);
  double *c = m->corner + 3 * m->corners;
  c[0] = x;
  c[1] = y;
  c[2] = z;
  return m->corners++;
}

static void add_facet(surface *m, int32_t a, int32_t b, int32_t c) {
  assert_true(m->facets < MOST_FACETS);
  int32_t *f = m->facet + 3 * m->facets++;
  f[0] = a;
  f[1] = b;
  f[2] = c;
}

/* A rectangle of n x m cells of two triangles each; inner corners moved at random, diagonals and
 * senses at random. */
static void add_floor(surface *mesh, double x0, double x1, double y0, double y1, int n, int m,
                      double disorder, cdem_random *random) {
  int32_t first = mesh->corners;
  for (int j = 0; j <= m; j++)
    for (int i = 0; i <= n; i++) {
      bool inner_x = i > 0 && i<n, inner_y = j> 0 && j < m;
      double u = i + (inner_x ? cdem_random_uniform(random, -disorder, disorder) : 0.0);
      double v = j + (inner_y ? cdem_random_uniform(random, -disorder, disorder) : 0.0);
      add_corner(mesh, x0 + (x1 - x0) * u / n, y0 + (y1 - y0) * v / m, 0.0);
    }
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) {
      int32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      if (cdem_random_next(random) >> 63) {
        add_facet(mesh, a, b, c);
        add_facet(mesh, b, c, d);
      } else {
        add_facet(mesh, a, d, b);
        add_facet(mesh, a, d, c);
      }
    }
}

static cdem_wall mesh_wall(const surface *m) {
  return (cdem_wall){.name = "mesh",
                     .shape = CDEM_WALL_MESH,
                     .corners = m->corners,
                     .corner = m->corner,
                     .facets = m->facets,
                     .facet = m->facet};
}

/* A segment in 2-D. */
static void add_segment(surface *m, int32_t a, int32_t b) {
  m->facet[2 * m->facets] = a;
  m->facet[2 * m->facets++ + 1] = b;
}

/* ---- contacts ---- */

/* Coarse and fine triangles, corners that do not meet, triangles much smaller than the patch of
 * contact: anywhere on it one contact, as on a plane. */
static void a_flat_floor_is_a_plane(void **state) {
  (void)state;
  cdem_random random = {3};
  const int cells[4][2] = {{1, 1}, {3, 2}, {9, 11}, {30, 33}};
  for (int k = 0; k < 4; k++) {
    surface *m = calloc(1, sizeof *m);
    /* two halves that do not conform */
    add_floor(m, -6.0, 0.0, -4.0, 4.0, cells[k][0], cells[k][1], 0.3, &random);
    add_floor(m, 0.0, 6.0, -4.0, 4.0, cells[k][0] + 1, cells[k][1] + 2, 0.3, &random);
    cdem_wall wall = mesh_wall(m);
    walled w;
    cdem_wall_touch t[CDEM_WALL_TOUCHES];
    walled_make(&w, 3, 1, 1, &wall);
    for (int trial = 0; trial < 500; trial++) {
      double x = cdem_random_uniform(&random, -5.0, 5.0);
      double y = cdem_random_uniform(&random, -3.0, 3.0);
      double h = cdem_random_uniform(&random, 0.9, 1.0), side = trial % 2 ? 1.0 : -1.0;
      x = trial % 5 == 0 ? 0.0 : x; /* on the seam */
      assert_int_equal(walled_touch(&w, x, y, side * h, 1.0, t), 1);
      check_near(t[0].overlap, 1.0 - h, 0.0, 1e-14);
      check_vector(t[0].n, 0.0, 0.0, -side, 1e-14);
      check_vector(t[0].point, x, y, 0.0, 1e-14);
    }
    walled_release(&w);
    free(m);
  }
}

/* Two rectangles that meet at the line x = z = 0, the second one turned up by `angle` from the
 * prolongation of the first: > 0 a valley, < 0 a ridge, seen from above. */
static void fold(surface *m, double angle) {
  double c = cos(angle), s = sin(angle), w = 5.0;
  memset(m, 0, sizeof *m);
  add_corner(m, -w, -w, 0.0);
  add_corner(m, -w, w, 0.0);
  add_corner(m, 0.0, -w, 0.0);
  add_corner(m, 0.0, w, 0.0);
  add_corner(m, w * c, -w, w * s);
  add_corner(m, w * c, w, w * s);
  add_facet(m, 0, 1, 2);
  add_facet(m, 1, 2, 3);
  add_facet(m, 2, 3, 4);
  add_facet(m, 4, 5, 3);
}

static void valleys_are_felt_twice_and_ridges_once(void **state) {
  (void)state;
  static surface m;
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  for (int k = 1; k <= 5; k++) {
    double angle = 0.5 * k, h = 0.98; /* the bottom of the valley is outside */
    fold(&m, angle);
    cdem_wall wall = mesh_wall(&m);
    walled_make(&w, 3, 1, 1, &wall);
    /* on the bisector of the valley, h from both planes */
    assert_int_equal(walled_touch(&w, -h * tan(0.5 * angle), 0.3, h, 1.0, t), 2);
    check_near(t[0].overlap, 0.02, 0.0, 1e-14);
    check_near(t[1].overlap, 0.02, 0.0, 1e-14);
    check_near(cdem_dot3(t[0].n, t[1].n), cos(angle), 0.0, 1e-14);
    walled_release(&w);
    /* over the ridge, in any direction between the two normals */
    fold(&m, -angle);
    walled_make(&w, 3, 1, 1, &wall);
    for (double a = -0.1; a < angle + 0.1; a += 0.07) {
      double x = h * sin(a), z = h * cos(a);
      assert_int_equal(walled_touch(&w, x, 0.3, z, 1.0, t), 1);
      double reach = a < 0.0 ? z : (a > angle ? h * cos(a - angle) : h);
      check_near(t[0].overlap, 1.0 - reach, 0.0, 1e-14);
    }
    walled_release(&w);
  }
}

/* The force of a grain that crosses a flat valley is continuous: no step larger than the stiffness
 * times the way allows. */
static void the_force_over_folds_is_continuous(void **state) {
  (void)state;
  static surface m;
  const double angles[8] = {-1.0, -0.1, -1e-3, 1e-5, 2e-3, 0.05, 0.2, 1.0};
  for (int k = 0; k < 8; k++) {
    fold(&m, angles[k]);
    cdem_wall wall = mesh_wall(&m);
    walled w;
    walled_make(&w, 3, 1, 1, &wall);
    cdem_wall_touch t[CDEM_WALL_TOUCHES];
    double before[3] = {0.0, 0.0, 0.0}, dx = 1e-4;
    walled_place(&w, 0, 0.0, 0.1, 0.97, 1.0);
    w.s.skin = 2.0;
    walled_build(&w);
    for (int i = 0; i <= 8000; i++) {
      double f[3] = {0.0, 0.0, 0.0}, x = -0.4 + dx * i;
      walled_place(&w, 0, x, 0.1, 0.97, 1.0);
      int count = cdem_walls_find(&w.s, 0, t);
      for (int j = 0; j < count; j++)
        for (int c = 0; c < 3; c++)
          f[c] -= t[j].overlap * t[j].n[c];
      /* Two contacts of stiffness 1 change by at most 2 dx; where the deeper of two sides of one
       * patch changes, by the depth times the angle between them. */
      double jump[3] = {f[0] - before[0], f[1] - before[1], f[2] - before[2]};
      double allowed = 4.0 * dx + (angles[k] > 0.0 && angles[k] < 0.3 ? 0.04 * angles[k] : 0.0);
      if (i > 0)
        check_below(cdem_norm3(jump), allowed);
      memcpy(before, f, sizeof f);
    }
    walled_release(&w);
  }
}

static void corners_and_borders_are_felt_once(void **state) {
  (void)state;
  static surface m;
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  /* a fan of 7 around a peak, from above, from the side and from below */
  memset(&m, 0, sizeof m);
  add_corner(&m, 0.0, 0.0, 0.0);
  for (int k = 0; k < 7; k++)
    add_corner(&m, 4.0 * cos(0.9 * k), 4.0 * sin(0.9 * k), -2.0);
  for (int k = 0; k < 7; k++)
    add_facet(&m, 0, 1 + k, 1 + (k + 1) % 7);
  cdem_wall wall = mesh_wall(&m);
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 0.0, 0.0, 0.9, 1.0, t), 1);
  check_vector(t[0].n, 0.0, 0.0, -1.0, 1e-15);
  assert_int_equal(walled_touch(&w, 0.1, 0.05, 0.9, 1.0, t), 1);
  /* inside the peak: all seven sides */
  assert_int_equal(walled_touch(&w, 0.0, 0.0, -1.05, 1.0, t), 7);
  walled_release(&w);
  /* the border of one triangle, and its corner */
  memset(&m, 0, sizeof m);
  add_corner(&m, 0.0, 0.0, 0.0);
  add_corner(&m, 3.0, 0.0, 0.0);
  add_corner(&m, 0.0, 3.0, 0.0);
  add_facet(&m, 0, 1, 2);
  wall = mesh_wall(&m);
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 1.0, -0.3, 0.4, 1.0, t), 1);
  check_vector(t[0].n, 0.0, 0.6, -0.8, 1e-15);
  check_near(t[0].overlap, 0.5, 0.0, 1e-15);
  assert_int_equal(walled_touch(&w, -0.2, -0.3, 0.6, 1.0, t), 1);
  check_vector(t[0].n, 2.0 / 7, 3.0 / 7, -6.0 / 7, 1e-15);
  assert_int_equal(walled_touch(&w, 1.5 + 0.3, 1.5 + 0.4, 0.0, 1.0, t), 1);
  check_near(t[0].overlap, 1.0 - 0.7 / sqrt(2.0), 0.0, 1e-14);
  walled_release(&w);
}

static void polylines_follow_the_same_rules(void **state) {
  (void)state;
  static surface m;
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  /* flat in four pieces, then up 45 degrees (valley), then down again (ridge) */
  const double x[7] = {-9.0, -5.0, -4.9, -1.0, 0.0, 4.0, 8.0};
  const double y[7] = {0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0};
  memset(&m, 0, sizeof m);
  for (int k = 0; k < 7; k++)
    add_corner(&m, x[k], y[k], 0.0);
  for (int32_t k = 0; k < 6; k++)
    add_segment(&m, k, k + 1);
  cdem_wall wall = mesh_wall(&m);
  walled_make(&w, 2, 1, 1, &wall);
  for (double at = -8.0; at < -1.0; at += 0.01) {
    assert_int_equal(walled_touch(&w, at, 0.9, 0.0, 1.0, t), 1);
    check_near(t[0].overlap, 0.1, 0.0, 1e-14);
    check_vector(t[0].n, 0.0, -1.0, 0.0, 1e-14);
  }
  assert_int_equal(walled_touch(&w, -0.95 * tan(M_PI / 8), 0.95, 0.0, 1.0, t), 2);
  assert_int_equal(walled_touch(&w, 4.0, 4.95, 0.0, 1.0, t), 1);
  check_vector(t[0].n, 0.0, -1.0, 0.0, 1e-14);
  check_near(t[0].overlap, 0.05, 0.0, 1e-14);
  walled_release(&w);
}

/* ---- sliding and rolling on ---- */

static void throw_ball(walled *w, ball *b, int steps) {
  const double dt = 1e-3;
  for (int i = 0; i < steps; i++) {
    if (i % 20 == 0) {
      walled_place(w, 0, b->x[0], b->x[1], b->x[2], b->radius);
      walled_build(w);
    }
    ball_step(w, b, dt);
  }
}

/* The history goes from facet to facet: the path of a grain that slides, then rolls, with its
 * tangential spring loaded all the way, is that on a plane to rounding. */
static void the_path_on_a_cut_floor_is_that_on_a_plane(void **state) {
  (void)state;
  cdem_random random = {5};
  const ball start = {.x = {-4.0, -2.0, 0.995},
                      .v = {1.7, 0.9, 0.0},
                      .w = {0.3, -4.0, 2.0},
                      .radius = 1.0,
                      .mass = 1.0,
                      .inertia = 0.4,
                      .kn = 1e3,
                      .kt = 5e2,
                      .mu = 0.4,
                      .gravity = {0.0, 0.0, -5.0}};
  const int cells[3] = {2, 13, 31};
  ball on_plane = start;
  walled w;
  cdem_wall plane = {.name = "floor", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}};
  walled_make(&w, 3, 1, 1, &plane);
  throw_ball(&w, &on_plane, 3000);
  assert_int_equal(on_plane.contacts, 1);
  walled_release(&w);
  for (int k = 0; k < 3; k++) {
    surface *m = calloc(1, sizeof *m);
    add_floor(m, -6.0, 0.0, -4.0, 4.0, cells[k], cells[k], 0.3, &random);
    add_floor(m, 0.0, 6.0, -4.0, 4.0, cells[k] + 1, cells[k] + 2, 0.3, &random);
    cdem_wall wall = mesh_wall(m);
    ball b = start;
    walled_make(&w, 3, 1, 1, &wall);
    throw_ball(&w, &b, 3000);
    for (int c = 0; c < 3; c++) {
      check_near(b.x[c], on_plane.x[c], 1e-12, 1e-12);
      check_near(b.w[c], on_plane.w[c], 1e-12, 1e-12);
    }
    walled_release(&w);
    free(m);
  }
}

/* A contact at another side of a valley is another contact and starts without history. */
static void histories_do_not_jump_across_a_valley(void **state) {
  (void)state;
  static surface m;
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  bool fresh;
  fold(&m, 0.5 * M_PI);
  cdem_wall wall = mesh_wall(&m);
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, -1.2, 0.3, 0.95, 1.0, t), 1);
  cdem_walls_history(&w.s, t, &fresh)[0] = 7.0;
  assert_int_equal(walled_touch(&w, -0.95, 0.3, 0.95, 1.0, t), 2);
  for (int k = 0; k < 2; k++) {
    double *h = cdem_walls_history(&w.s, t + k, &fresh);
    assert_true(fresh == (t[k].n[0] > 0.5));
    assert_true(h[0] == (fresh ? 0.0 : 7.0));
  }
  /* from the floor alone to the side alone, in one step */
  walled_release(&w);
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, -1.05, 0.3, 0.95, 1.0, t), 1);
  cdem_walls_history(&w.s, t, &fresh)[0] = 7.0;
  assert_int_equal(walled_touch(&w, -0.95, 0.3, 1.05, 1.0, t), 1);
  assert_true(cdem_walls_history(&w.s, t, &fresh)[0] == 0.0);
  assert_true(fresh);
  /* on to another facet of the same side */
  int32_t facet = w.s.walls->slots.facet[t[0].slot];
  cdem_walls_history(&w.s, t, &fresh)[0] = 5.0;
  for (double y = 0.3; y < 4.0; y += 0.1)
    assert_int_equal(walled_touch(&w, -0.95, y, 1.05, 1.0, t), 1);
  assert_true(w.s.walls->slots.facet[t[0].slot] != facet);
  assert_true(cdem_walls_history(&w.s, t, &fresh)[0] == 5.0);
  assert_false(fresh);
  walled_release(&w);
}

/* ---- candidates ---- */

/* The grid finds what all pairs find, however sizes are mixed. */
static void the_grid_misses_nothing(void **state) {
  (void)state;
  enum { GRAINS = 300 };
  cdem_random random = {17};
  for (int trial = 0; trial < 6; trial++) {
    surface *m = calloc(1, sizeof *m);
    for (int f = 0; f < 150; f++) {
      double size = trial < 2 ? 0.3 : (f % 50 == 0 ? 10.0 : 0.05);
      double at[3];
      for (int c = 0; c < 3; c++)
        at[c] = cdem_random_uniform(&random, -5.0, 5.0);
      for (int k = 0; k < 3; k++)
        add_corner(m, at[0] + cdem_random_uniform(&random, -size, size),
                   at[1] + cdem_random_uniform(&random, -size, size),
                   at[2] + cdem_random_uniform(&random, -size, size));
      add_facet(m, 3 * f, 3 * f + 1, 3 * f + 2);
    }
    cdem_wall wall = mesh_wall(m), single[1];
    walled w, one;
    cdem_wall_touch t[CDEM_WALL_TOUCHES];
    walled_make(&w, 3, GRAINS, 1, &wall);
    for (int i = 0; i < GRAINS; i++)
      walled_place(&w, i, cdem_random_uniform(&random, -7, 7), cdem_random_uniform(&random, -7, 7),
                   cdem_random_uniform(&random, -7, 7), cdem_random_uniform(&random, 0.05, 1.5));
    walled_build(&w);
    const int32_t *row = cdem_walls_rows(&w.s);
    int expected[GRAINS] = {0}, total = 0;
    for (int32_t f = 0; f < m->facets; f++) {
      single[0] = wall;
      single[0].facets = 1;
      single[0].facet = m->facet + 3 * f;
      walled_make(&one, 3, 1, 1, single);
      one.s.skin = 100.0; /* a grid of one facet, which every grain searches */
      for (int i = 0; i < GRAINS; i++) {
        const double *x = cdem_place(&w.s, i);
        expected[i] += walled_touch(&one, x[0], x[1], x[2], x[3] + 0.5 * w.s.skin, t);
      }
      walled_release(&one);
    }
    for (int i = 0; i < GRAINS; i++) {
      assert_int_equal(row[i + 1] - row[i], expected[i]);
      total += expected[i];
    }
    assert_true(total > 30);
    walled_release(&w);
    free(m);
  }
}

static void more_touches_than_fit_are_the_deepest(void **state) {
  (void)state;
  static surface m;
  memset(&m, 0, sizeof m);
  /* twelve parallel sheets, not joined, each nearer than the one before */
  for (int k = 0; k < 12; k++) {
    double z = 0.9 - 0.05 * k;
    add_corner(&m, -5.0, -5.0, z);
    add_corner(&m, 5.0, -5.0, z);
    add_corner(&m, 0.0, 5.0, z);
    add_facet(&m, 3 * k, 3 * k + 1, 3 * k + 2);
  }
  cdem_wall wall = mesh_wall(&m);
  walled w;
  cdem_wall_touch t[CDEM_WALL_TOUCHES];
  walled_make(&w, 3, 1, 1, &wall);
  assert_int_equal(walled_touch(&w, 0.0, 0.0, 0.0, 1.0, t), CDEM_WALL_TOUCHES);
  for (int k = 0; k < CDEM_WALL_TOUCHES; k++)
    check_near(t[k].overlap, 1.0 - (0.9 - 0.05 * (k + 4)), 0.0, 1e-14);
  walled_release(&w);
}

static void facets_that_cannot_be_are_named(void **state) {
  (void)state;
  cdem_fault fault = {0};
  double corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  int32_t facet[3] = {0, 1, 2};
  cdem_wall wall = {.name = "m",
                    .shape = CDEM_WALL_MESH,
                    .corners = 3,
                    .corner = corner,
                    .facets = 1,
                    .facet = facet};
  check_ok(cdem_wall_check(3, &wall, &fault));
  facet[2] = 3;
  check_fails(cdem_wall_check(3, &wall, &fault), CDEM_INPUT, "facet 0 names a corner");
  facet[2] = 1;
  check_fails(cdem_wall_check(3, &wall, &fault), CDEM_INPUT,
              "facet 0, a triangle at (0, 0, 0) m, has no size");
  facet[2] = 2, corner[7] = NAN;
  check_fails(cdem_wall_check(3, &wall, &fault), CDEM_INPUT, "component 1 of corner 2 is nan");
  wall.facets = 0;
  check_fails(cdem_wall_check(3, &wall, &fault), CDEM_INPUT, "needs at least one triangle");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_flat_floor_is_a_plane),
      cmocka_unit_test(valleys_are_felt_twice_and_ridges_once),
      cmocka_unit_test(the_force_over_folds_is_continuous),
      cmocka_unit_test(corners_and_borders_are_felt_once),
      cmocka_unit_test(polylines_follow_the_same_rules),
      cmocka_unit_test(the_path_on_a_cut_floor_is_that_on_a_plane),
      cmocka_unit_test(histories_do_not_jump_across_a_valley),
      cmocka_unit_test(the_grid_misses_nothing),
      cmocka_unit_test(more_touches_than_fit_are_the_deepest),
      cmocka_unit_test(facets_that_cannot_be_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
