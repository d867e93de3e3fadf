/* The frame of coarse-grained fields: its grid, and that it says what the fields say. */
#include "dem/frames.h"
#include "dem/measures.h"
#include "dem/surface.h"
#include "frames_support.h"

enum { LONG = 41, WIDE = 9, HIGH = 21 };

/* What is asked of a frame. */
typedef struct {
  const cdem_coarse_grid *grid;
  const cdem_coarse *fields;
  int dim;
  double skew; /* largest that was met */
} asked;

static const double *field_of(const cdem_frame *frame, const char *name, int components) {
  for (int f = 0; f < frame->fields; f++)
    if (strcmp(frame->field[f].name, name) == 0) {
      assert_int_equal(frame->field[f].components, components);
      assert_false(frame->field[f].on_cells);
      return frame->field[f].data;
    }
  fail_msg("no field '%s'", name);
  return NULL;
}

/* Length, area or volume of a cell whose corners stand as VTK wants them; else it is not that of
 * its box. */
static double size_of(const cdem_frame *frame, int64_t cell) {
  const int32_t *node = frame->node + frame->offset[cell];
  const double *x[8];
  double e[3][3] = {{0}};
  static const int next[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1, 3, 4}};
  int corners = (int)(frame->offset[cell + 1] - frame->offset[cell]), directions = 0;
  for (int c = 0; c < corners; c++)
    x[c] = frame->xyz + 3 * (int64_t)node[c];
  while (1 << directions < corners)
    directions++;
  for (int d = 0; d < directions; d++)
    for (int c = 0; c < 3; c++)
      e[d][c] = x[next[directions][d]][c] - x[0][c];
  if (corners == 8) { /* the top is the floor, moved */
    for (int k = 0; k < 4; k++)
      for (int c = 0; c < 3; c++)
        check_near(x[4 + k][c], x[k][c] + e[2][c], 0, 1e-14);
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  }
  if (corners == 4)
    for (int c = 0; c < 3; c++)
      check_near(x[2][c], x[0][c] + e[0][c] + e[1][c], 0, 1e-14);
  return corners == 1   ? 1.0
         : corners == 2 ? hypot(e[0][0], hypot(e[0][1], e[0][2]))
                        : sqrt(pow(e[0][0] * e[1][1] - e[0][1] * e[1][0], 2) +
                               pow(e[0][1] * e[1][2] - e[0][2] * e[1][1], 2) +
                               pow(e[0][2] * e[1][0] - e[0][0] * e[1][2], 2));
}

static void check_grid(const asked *a, const cdem_frame *frame) {
  static const uint8_t types[4] = {1, 3, 9, 12};
  double all = 0, box = 1;
  int directions = 0;
  for (int c = 0; c < 3; c++)
    if (a->grid->count[c] > 1) {
      directions++;
      box *= a->grid->high[c] - a->grid->low[c];
    }
  for (int64_t cell = 0; cell < frame->cells; cell++) {
    assert_int_equal(frame->type[cell], types[directions]);
    double size = size_of(frame, cell);
    assert_true(size > 0);
    all += size;
  }
  check_near(all, box, 1e-12, 0);
}

static cdem_status look(void *context, const cdem_frame *frame, cdem_fault *fault) {
  (void)fault;
  asked *a = context;
  assert_string_equal(frame->set, "fields");
  assert_int_equal(frame->index, 7);
  assert_int_equal(frame->points, a->fields->points);
  const double *density = field_of(frame, "density", 1), *solid = field_of(frame, "solid", 1),
               *velocity = field_of(frame, "velocity", 3), *wall = field_of(frame, "wall_force", 3),
               *stress = field_of(frame, "stress", 6), *skew = field_of(frame, "stress_skew", 3),
               *pressure = field_of(frame, "pressure", 1);
  static const int place[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  for (int64_t p = 0; p < frame->points; p++) {
    const double *w = skew + 3 * p, *s = a->fields->stress + 9 * p;
    const double cross[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
    const double scale = fabs(s[0]) + fabs(s[4]) + fabs(s[8]);
    double trace = 0;
    for (int k = 0; k < 9; k++)
      check_near(stress[6 * p + place[k]] + cross[k], s[k], 0, 1e-14 * scale);
    for (int c = 0; c < 3; c++) {
      a->skew = fmax(a->skew, fabs(w[c]) / fmax(scale, 1e-300));
      trace += c < a->dim ? s[4 * c] / a->dim : 0;
      check_near(velocity[3 * p + c], a->fields->velocity[3 * p + c], 0, 0);
      check_near(wall[3 * p + c], a->fields->wall_force[3 * p + c], 0, 0);
    }
    check_near(pressure[p], -trace, 0, 1e-14 * scale);
    assert_true(density[p] == a->fields->density[p] && solid[p] == a->fields->solid[p]);
  }
  check_grid(a, frame);
  return CDEM_OK;
}

static void frames_say_what_fields_say(void **unused) {
  (void)unused;
  static const int counts[][3] = {{1, 1, 1},       {LONG, 1, 1}, {1, HIGH, 1},   {LONG, HIGH, 1},
                                  {LONG, 1, HIGH}, {1, 1, HIGH}, {5, WIDE, HIGH}};
  for (int dim = 2; dim <= 3; dim++)
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
      cdem_fault fault = {0};
      scene s;
      cdem_coarse fields;
      if (dim == 2 && counts[k][2] > 1)
        continue;
      scene_init(&s, dim);
      for (int step = 0; step < 20; step++)
        check_ok(cdem_dem_step(&s.dem, &fault));
      cdem_coarse_grid grid = {{-1.5, -0.4, 0}, {1.5, 0.4, 0.9}, {1, 1, 1}, 0.4};
      memcpy(grid.count, counts[k], sizeof grid.count);
      check_ok(cdem_coarse_fields(&s.dem, &grid, &fields, &fault));
      asked a = {.grid = &grid, .fields = &fields, .dim = dim};
      const cdem_frame_sink sink = {&a, look};
      check_ok(cdem_dem_fields_frame(&s.dem, &grid, 7, &sink, &fault));
      assert_true(counts[k][0] == 1 || a.skew > 1e-3); /* the ends slide outwards */
      cdem_coarse_release(&fields);
      scene_release(&s);
    }
}

/* Over a grid that holds all of it the density is the mass, up to the rule of the sum: a bump with
 * two smooth derivatives, eight points from its middle to its end. */
static void density_adds_up_to_the_mass(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  scene s;
  cdem_coarse fields;
  cdem_count all;
  scene_init(&s, 3);
  const cdem_coarse_grid grid = {{-1.8, -0.8, -0.5}, {1.8, 0.8, 1.1}, {73, 33, 33}, 0.4};
  check_ok(cdem_coarse_fields(&s.dem, &grid, &fields, &fault));
  check_ok(cdem_count_region(&s.dem, NULL, &all, &fault));
  double sum = 0;
  for (int64_t p = 0; p < fields.points; p++)
    sum += fields.density[p] * pow(0.05, 3);
  check_near(sum, all.mass, 1e-4, 0);
  cdem_coarse_release(&fields);
  scene_release(&s);
}

static cdem_status refuse(void *context, const cdem_frame *frame, cdem_fault *fault) {
  (void)frame;
  return *(bool *)context ? cdem_fail(fault, CDEM_FILE, "disk is full") : CDEM_OK;
}

static void failures_come_back(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  scene s;
  bool full = true;
  scene_init(&s, 2);
  cdem_coarse_grid grid = {{-1, 0, 0}, {1, 1, 0}, {3, 3, 1}, 0};
  const cdem_frame_sink sink = {&full, refuse};
  check_fails(cdem_dem_fields_frame(&s.dem, &grid, 0, &sink, &fault), CDEM_FILE, "disk is full");
  full = false;
  cdem_status status = CDEM_MEMORY;
  int failures = -1;
  for (; status == CDEM_MEMORY; failures++) { /* each allocation once; none leaks */
    cdem_memory_fail_after(failures + 1);
    status = cdem_dem_fields_frame(&s.dem, &grid, 0, &sink, NULL);
  }
  cdem_memory_fail_after(-1);
  assert_int_equal(status, CDEM_OK);
  assert_true(failures > 10);
  grid.count[2] = 2;
  check_fails(cdem_dem_fields_frame(&s.dem, &grid, 0, &sink, &fault), CDEM_USAGE,
              "2 layers of the fields of a plane model");
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_say_what_fields_say),
      cmocka_unit_test(density_adds_up_to_the_mass),
      cmocka_unit_test(failures_come_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
