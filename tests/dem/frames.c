/* Frames of grains: what the sets hold. */
#include "dem/frames.h"

#include "frames_support.h"

typedef struct {
  int sets, dim;
  int64_t frames[3]; /* points of each set */
} seen;

static const cdem_field *field_of(const cdem_frame *frame, const char *name, const char *unit) {
  for (int f = 0; f < frame->fields; f++)
    if (strcmp(frame->field[f].name, name) == 0) {
      assert_string_equal(frame->field[f].unit, unit);
      return &frame->field[f];
    }
  fail_msg("no field '%s'", name);
  return NULL;
}

static void check_cells(const cdem_frame *frame) {
  assert_int_equal(frame->offset[0], 0);
  for (int64_t c = 0; c < frame->cells; c++) {
    static const int corners[10] = {0, 1, 0, 2, 0, 3, 0, 0, 0, 4};
    assert_int_equal(frame->offset[c + 1] - frame->offset[c], corners[frame->type[c]]);
    for (int64_t n = frame->offset[c]; n < frame->offset[c + 1]; n++)
      assert_true(frame->node[n] >= 0 && frame->node[n] < frame->points);
  }
}

static void check_walls(const cdem_frame *frame, int dim) {
  const int32_t *wall = field_of(frame, "wall", "")->data;
  int count[3] = {0};
  for (int64_t c = 0; c < frame->cells; c++) {
    count[wall[c]]++;
    for (int64_t n = frame->offset[c]; n < frame->offset[c + 1]; n++) {
      const double *x = frame->xyz + 3 * frame->node[n];
      if (wall[c] == 0)
        check_near(x[dim - 1], 0, 0, 1e-15);
      if (wall[c] == 1)
        check_near(x[0], 3, 1e-15, 0);
      if (wall[c] == 2)
        check_near(hypot(x[0], dim == 2 ? x[1] : x[2]), 5, 1e-14, 0);
    }
  }
  assert_true(count[0] == 1 && count[1] == 1 && count[2] == 72);
  /* The floor reaches as far as the plate and the drum. */
  double high = -9;
  for (int64_t n = 0; n < frame->points; n++)
    high = fmax(high, frame->xyz[3 * n]);
  check_near(high, 5, 1e-14, 0);
}

static cdem_status keep(void *context, const cdem_frame *frame, cdem_fault *fault) {
  (void)fault;
  seen *s = context;
  static const char *const sets[3] = {"grains", "contacts", "walls"};
  assert_string_equal(frame->set, sets[s->sets]);
  assert_int_equal(frame->index, 7);
  check_cells(frame);
  s->frames[s->sets++] = frame->points;
  if (s->sets == 3) {
    check_walls(frame, s->dim);
    return CDEM_OK;
  }
  if (s->sets == 1) {
    const double *radius = field_of(frame, "radius", "m")->data;
    const double *pressure = field_of(frame, "pressure", "Pa")->data;
    const int32_t *contacts = field_of(frame, "contacts", "")->data;
    const double *volumetric = field_of(frame, "volumetric_strain", "")->data;
    field_of(frame, "velocity", "m/s");
    field_of(frame, "rotation", "rad");
    field_of(frame, "stress", "Pa");
    assert_int_equal(contacts[0], 2);
    assert_int_equal(contacts[2], 3);
    assert_true(radius[4] == 0.25 && pressure[2] > 0 && isnan(volumetric[0])); /* in a row */
    return CDEM_OK;
  }
  const double *push = field_of(frame, "push", "N")->data;
  const int32_t *wall = field_of(frame, "wall", "")->data;
  assert_int_equal(frame->cells, 9); /* four between, five with the floor */
  for (int64_t c = 0; c < frame->cells; c++) {
    const double *a = frame->xyz + 6 * c;
    double length = sqrt((a[3] - a[0]) * (a[3] - a[0]) + (a[4] - a[1]) * (a[4] - a[1]) +
                         (a[5] - a[2]) * (a[5] - a[2]));
    check_near(length, wall[c] < 0 ? 0.49 : 0.249, 1e-12, 0);
    check_near(push[c], 1e6 * (wall[c] < 0 ? 0.01 : 0.001), 1e-9, 0);
  }
  return CDEM_OK;
}

static void sets_hold_what_they_say(void **unused) {
  (void)unused;
  for (int dim = 2; dim <= 3; dim++) {
    cdem_fault fault = {0};
    scene s;
    scene_init(&s, dim);
    cdem_strain_reference *reference = NULL;
    check_ok(cdem_strain_reference_create(&s.dem, 0, &reference, &fault));
    seen got = {.dim = dim};
    const cdem_frame_sink sink = {&got, keep};
    check_ok(cdem_dem_frames(&s.dem, reference, 7, &sink, &fault));
    assert_true(got.sets == 3 && got.frames[0] == 5 && got.frames[1] == 18);
    cdem_strain_reference_destroy(&reference);
    scene_release(&s);
  }
}

static cdem_status refuse(void *context, const cdem_frame *frame, cdem_fault *fault) {
  (void)frame;
  return --*(int *)context < 0 ? cdem_fail(fault, CDEM_FILE, "disk is full") : CDEM_OK;
}

static void failures_come_back(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  scene s;
  scene_init(&s, 2);
  for (int frames = 0; frames < 3; frames++) {
    int left = frames;
    const cdem_frame_sink sink = {&left, refuse};
    check_fails(cdem_dem_frames(&s.dem, NULL, 0, &sink, &fault), CDEM_FILE, "disk is full");
  }
  int left = 3;
  const cdem_frame_sink sink = {&left, refuse};
  cdem_status status = CDEM_MEMORY;
  int failures = -1;
  for (; status == CDEM_MEMORY; failures++) { /* each allocation once; none leaks */
    left = 3;
    cdem_memory_fail_after(failures + 1);
    status = cdem_dem_frames(&s.dem, NULL, 0, &sink, NULL);
  }
  cdem_memory_fail_after(-1);
  assert_int_equal(status, CDEM_OK);
  assert_true(failures > 20);
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sets_hold_what_they_say),
      cmocka_unit_test(failures_come_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
