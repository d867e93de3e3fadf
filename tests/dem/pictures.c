/* Pictures of grains: which marks a map gets, where, how wide and of which value. */
#include "dem/pictures.h"

#include "dem/pictures_kernels.h"
#include "frames_support.h"
#include "measures_support.h"

static cdem_map map_of(const cdem_snapshot *s, const double *value, const cdem_picture *picture) {
  cdem_fault fault = {0};
  cdem_map map = {0};
  check_ok(cdem_picture_make(s, NULL, value, picture, &map, &fault));
  return map;
}

static void discs_are_drawn_as_they_are(void **unused) {
  (void)unused;
  assembly *m = random_assembly(2, 300, 3);
  double value[300];
  for (int i = 0; i < 300; i++)
    value[i] = i < 298 ? i : 1e9; /* fewer than one in a hundred are beyond the bar */
  value[5] = NAN;
  cdem_picture picture = {.kind = CDEM_PICTURE_GRAINS, .field = CDEM_GRAIN_SPEED, .title = "t"};
  cdem_map map = map_of(&m->s, value, &picture);
  assert_int_equal(map.mark_sets, 1);
  assert_int_equal(map.marks[0].marks, 300);
  assert_true(map.marks[0].kind == CDEM_MAP_DISCS && map.marks[0].rims && !map.diverging);
  for (int i = 0; i < 300; i++) {
    assert_true(map.marks[0].xy[4 * i] == m->xyz[3 * i]);
    assert_true(map.marks[0].xy[4 * i + 1] == m->xyz[3 * i + 1]);
    assert_true(map.marks[0].size[i] == m->radius[i]);
    assert_true(i == 5 ? isnan(map.marks[0].value[i]) : map.marks[0].value[i] == value[i]);
  }
  assert_true(map.value_min == 0.0 && map.value_max < 300.0 && map.value_max > 290.0);
  assert_string_equal(map.value_label, "speed |v|, m/s");
  assert_string_equal(map.x_label, "x, m");
  cdem_map_release(&map);
  picture = (cdem_picture){.kind = CDEM_PICTURE_BAND,
                           .field = CDEM_GRAIN_VOLUMETRIC_STRAIN,
                           .value_min = -3,
                           .value_max = 4};
  map = map_of(&m->s, value, &picture);
  assert_true(map.diverging && map.value_min == -3 && map.value_max == 4 && !map.marks[0].rims);
  assert_int_equal(map.mark_sets, 2); /* larger ones below, so that no gaps show */
  assert_true(map.marks[0].size[9] > map.marks[1].size[9] && map.marks[1].size[9] > m->radius[9]);
  cdem_map_release(&map);
  uint8_t hidden[300] = {1};
  picture.left_out = hidden;
  map = map_of(&m->s, value, &picture);
  assert_int_equal(map.marks[0].marks, 299);
  assert_true(map.marks[0].xy[0] == m->xyz[3]);
  cdem_map_release(&map);
  for (int i = 0; i < 300; i++)
    value[i] = 0;
  picture = (cdem_picture){.field = CDEM_GRAIN_EFFECTIVE_STRAIN};
  map = map_of(&m->s, value, &picture); /* nothing to tell apart: no bar */
  assert_null(map.value_label);
  cdem_map_release(&map);
  free(m);
}

/* Strokes lie between centres, ascending in push, as wide as it is up to five means. */
static void chains_are_as_wide_as_their_push(void **unused) {
  (void)unused;
  assembly *m = random_assembly(2, 100, 4);
  m->contact[3].push = 1000;
  m->contact[7].push = -1; /* a bond that pulls */
  double mean = 0;
  for (int64_t k = 0; k < m->s.contacts; k++)
    mean += k == 7 ? 0 : m->contact[k].push / (double)(m->s.contacts - 1);
  const cdem_picture picture = {.kind = CDEM_PICTURE_CHAINS};
  cdem_map map = map_of(&m->s, NULL, &picture);
  assert_int_equal(map.mark_sets, 3);
  assert_int_equal(map.marks[0].marks + map.marks[1].marks, 100);
  int64_t rattlers = 0;
  for (int i = 0; i < 100; i++)
    rattlers += m->touching[i] < 2;
  assert_int_equal(map.marks[1].marks, rattlers);
  const cdem_map_marks *strokes = &map.marks[2];
  assert_int_equal(strokes->marks, m->s.contacts - 1);
  int64_t last = strokes->marks - 1;
  for (int64_t k = 1; k <= last; k++)
    assert_true(strokes->value[k] >= strokes->value[k - 1] &&
                strokes->size[k] >= strokes->size[k - 1]);
  const double *a = m->xyz + 3 * m->contact[3].a, *b = m->xyz + 3 * m->contact[3].b;
  check_near(strokes->value[last], 1000 / mean, 1e-12, 0);
  check_near(strokes->xy[4 * last], a[0], 1e-15, 0);
  check_near(strokes->xy[4 * last + 3], b[1], 1e-12, 1e-14);
  assert_true(map.reversed);
  cdem_map_release(&map);
  /* With a range the pushes themselves, and widths that pictures of two states share. */
  const cdem_picture ranged = {.kind = CDEM_PICTURE_CHAINS, .value_max = 5 * mean};
  map = map_of(&m->s, NULL, &ranged);
  check_near(map.marks[2].value[last], 1000, 1e-12, 0);
  cdem_map twice =
      map_of(&m->s, NULL, &(cdem_picture){.kind = CDEM_PICTURE_CHAINS, .value_max = 10 * mean});
  check_near(twice.marks[2].size[last / 2], 0.5 * map.marks[2].size[last / 2], 1e-12, 0);
  cdem_map_release(&twice);
  assert_true(map.value_min == 0 && map.value_max == 5 * mean);
  cdem_map_release(&map);
  free(m);
}

/* Through the side of a cell: half a stroke from either grain. */
static void chains_cross_cells_in_halves(void **unused) {
  (void)unused;
  assembly *m = assembly_new(2);
  cdem_cell cell = {.periodic = {true, false, false}, .h = {2, 0, 0, 0, 1, 0, 0, 0, 1}};
  m->s.cell = &cell;
  put_grain(m, 0.2, 0.5, 0, 0.3);
  put_grain(m, 1.7, 0.5, 0, 0.3);
  const double back[3] = {-2, 0, 0};
  put_contact(m, 0, 1, back, 5.0);
  const cdem_picture picture = {.kind = CDEM_PICTURE_CHAINS};
  cdem_map map = map_of(&m->s, NULL, &picture);
  const cdem_map_marks *strokes = &map.marks[2];
  assert_int_equal(strokes->marks, 2);
  check_near(strokes->xy[2], -0.05, 1e-12, 0);
  check_near(strokes->xy[4], 1.7, 1e-12, 0);
  check_near(strokes->xy[6], 1.95, 1e-12, 0);
  cdem_map_release(&map);
  free(m);
}

static void arrows_point_where_grains_go(void **unused) {
  (void)unused;
  assembly *m = random_assembly(2, 200, 4);
  const cdem_picture picture = {.kind = CDEM_PICTURE_ARROWS};
  cdem_map map = map_of(&m->s, NULL, &picture);
  const cdem_map_marks *arrows = &map.marks[2];
  assert_int_equal(arrows->marks, 200);
  double scale = 0;
  for (int i = 0; i < 200; i++) {
    const double *xy = arrows->xy + 4 * i, *v = m->velocity + 3 * i;
    double x = xy[2] - xy[0], y = xy[3] - xy[1];
    check_near(x * v[1] - y * v[0], 0, 0, 1e-14);
    scale = i == 0 ? hypot(x, y) / hypot(v[0], v[1]) : scale;
    check_near(hypot(x, y), scale * hypot(v[0], v[1]), 1e-12, 0);
    check_near(arrows->value[i], hypot(v[0], v[1]), 1e-15, 0);
  }
  const double automatic = map.value_max;
  cdem_map_release(&map);
  const cdem_picture ranged = {.kind = CDEM_PICTURE_ARROWS, .value_max = 4 * automatic};
  map = map_of(&m->s, NULL, &ranged); /* a quarter as long */
  const double *xy = map.marks[2].xy, *v = m->velocity;
  check_near(hypot(xy[2] - xy[0], xy[3] - xy[1]), 0.25 * scale * hypot(v[0], v[1]), 1e-12, 0);
  cdem_map_release(&map);
  free(m);
  m = assembly_new(2); /* of many, one in each square */
  for (int i = 0; i < 3600; i++) {
    put_grain(m, i % 60, (double)(i / 60), 0, 0.5);
    m->velocity[3 * i] = 1;
  }
  map = map_of(&m->s, NULL, &picture);
  assert_true(map.marks[2].marks > 1000 && map.marks[2].marks <= 1600);
  cdem_map_release(&map);
  free(m);
}

/* ---- spheres ---- */

static void cuts_are_circles(void **unused) {
  (void)unused;
  assembly *m = assembly_new(3);
  put_grain(m, 1, 0.3, 2, 0.5);
  put_grain(m, 4, -0.6, 2, 0.5); /* not cut by y = 0 */
  put_grain(m, 7, 0, 3, 0.25);
  const double value[3] = {1, 2, 3};
  const cdem_picture picture = {.field = CDEM_GRAIN_RADIUS, .slice = true};
  cdem_map map = map_of(&m->s, value, &picture);
  assert_int_equal(map.marks[0].marks, 2);
  check_near(map.marks[0].size[0], 0.4, 1e-15, 0);
  check_near(map.marks[0].size[1], 0.25, 1e-15, 0);
  check_near(map.marks[0].xy[5], 3, 1e-15, 0);
  assert_string_equal(map.y_label, "z, m");
  cdem_map_release(&map);
  free(m);
}

/* A sphere behind a larger one is not drawn; of the others the furthest come first. */
static void hidden_spheres_are_left_out(void **unused) {
  (void)unused;
  assembly *m = assembly_new(3);
  put_grain(m, 0, 0, 0, 1);
  put_grain(m, 0.1, 3, 0.1, 0.7); /* behind, along y */
  put_grain(m, 0.5, -2, 0, 0.2);  /* in front */
  const double value[3] = {1, 2, 3};
  cdem_picture picture = {.field = CDEM_GRAIN_RADIUS};
  picture.window = (cdem_region){{0, -0.5, 0}, {0, 9, 0}}; /* without the one in front */
  cdem_map map = map_of(&m->s, value, &picture);
  assert_int_equal(map.marks[0].marks, 2);
  cdem_map_release(&map);
  picture.window = (cdem_region){{0, 0, 0}, {0, 0, 0}};
  map = map_of(&m->s, value, &picture);
  assert_int_equal(map.marks[0].marks, 4); /* two spheres, each with a lit side */
  check_near(map.marks[0].value[0], 1, 0, 0);
  check_near(map.marks[0].value[3], 3, 0, 0);
  assert_true(map.marks[0].shade[3] > map.marks[0].shade[2]);
  assert_null(map.x_label);
  cdem_map_release(&map);
  cdem_fault fault = {0};
  const cdem_picture wrong = {.view = {0, 0, 1}, .up = {0, 0, 2}};
  check_fails(cdem_picture_make(&m->s, NULL, value, &wrong, &map, &fault), CDEM_USAGE,
              "choose two directions that are not parallel");
  free(m);
}

/* ---- of a solver ---- */

static void solvers_have_pictures(void **unused) {
  (void)unused;
  for (int dim = 2; dim <= 3; dim++) {
    cdem_fault fault = {0};
    scene s;
    scene_init(&s, dim);
    cdem_strain_reference *reference = NULL;
    check_ok(cdem_strain_reference_create(&s.dem, 0, &reference, &fault));
    for (int field = 0; field < CDEM_GRAIN_FIELDS; field++) {
      assert_int_equal(cdem_grain_field_find(cdem_grain_field_name(field)), field);
      cdem_picture picture = {
          .field = (cdem_grain_field)field, .strain = reference, .slice = true, .middle = true};
      cdem_map map;
      check_ok(cdem_dem_picture(&s.dem, &picture, &map, &fault));
      assert_int_equal(map.marks[0].marks, 5);
      /* Floor, plate and circle; cut, a floor, a plate and the two sides of the tube. */
      assert_int_equal(map.line_sets, 1);
      assert_int_equal(map.lines[0].segments, 74);
      if (field == CDEM_GRAIN_CONTACTS)
        assert_true(map.marks[0].value[1] == 3);
      cdem_map_release(&map);
    }
    cdem_map map = {0};
    cdem_picture picture = {.field = CDEM_GRAIN_EFFECTIVE_STRAIN};
    check_fails(cdem_dem_picture(&s.dem, &picture, &map, &fault), CDEM_USAGE,
                "'effective_strain' needs the reference state");
    picture = (cdem_picture){.kind = CDEM_PICTURE_CHAINS};
    cdem_status status = CDEM_MEMORY;
    int failures = -1;
    for (; status == CDEM_MEMORY; failures++) { /* each allocation once; none leaks */
      cdem_memory_fail_after(failures + 1);
      status = cdem_dem_picture(&s.dem, &picture, &map, NULL);
    }
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK && failures > 10);
    cdem_map_release(&map);
    cdem_strain_reference_destroy(&reference);
    scene_release(&s);
  }
  assert_int_equal(cdem_grain_field_find("colour"), -1);
  assert_null(cdem_grain_field_name(CDEM_GRAIN_FIELDS));
}

/* Small grains far apart: no memory for the empty squares between them. */
static void arrows_of_a_dust(void **unused) {
  (void)unused;
  assembly *m = assembly_new(2);
  for (int i = 0; i < 20; i++)
    put_grain(m, 1e7 * i, 1e7 * (i * 7 % 20), 0, 1.0);
  const cdem_picture picture = {.kind = CDEM_PICTURE_ARROWS};
  cdem_map map = map_of(&m->s, NULL, &picture);
  assert_int_equal(map.marks[map.mark_sets - 1].marks, 20);
  cdem_map_release(&map);
  free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(discs_are_drawn_as_they_are),
      cmocka_unit_test(chains_are_as_wide_as_their_push),
      cmocka_unit_test(chains_cross_cells_in_halves),
      cmocka_unit_test(arrows_point_where_grains_go),
      cmocka_unit_test(cuts_are_circles),
      cmocka_unit_test(hidden_spheres_are_left_out),
      cmocka_unit_test(solvers_have_pictures),
      cmocka_unit_test(arrows_of_a_dust),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
