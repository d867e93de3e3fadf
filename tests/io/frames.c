/* Frames for ParaView: what VTK's own reader finds in our files, and what stays of a broken run. */
#include "io/run_files.h"
#include "io/support.h"

enum { POINTS = 9, CELLS = 8 };

/* One cell of each type over points that a cube and a tip give. */
static const uint8_t type[CELLS] = {1, 3, 5, 9, 10, 12, 13, 14};
static const int64_t offset[CELLS + 1] = {0, 1, 3, 6, 10, 14, 22, 28, 33};
static const int32_t node[33] = {8, 0, 6, 0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2,
                                 3, 4, 5, 6, 7, 0, 1, 2, 4, 5, 6, 4, 5, 6, 7, 8};
static const char *const states[] = {"intact", "failed & <open>"};

typedef struct {
  double xyz[3 * POINTS], displacement[3 * POINTS], stress[6 * CELLS], energy[CELLS];
  int32_t block[CELLS], label[POINTS];
  uint8_t state[CELLS];
  cdem_field field[6];
  cdem_frame frame;
} sample;

static void fill(sample *s, int64_t index, uint64_t seed) {
  cdem_random random = {seed};
  for (int i = 0; i < 3 * POINTS; i++) {
    s->xyz[i] = cdem_random_uniform(&random, -1, 1);
    s->displacement[i] = cdem_random_uniform(&random, -1e-9, 1e-9);
  }
  for (int i = 0; i < 6 * CELLS; i++)
    s->stress[i] = cdem_random_uniform(&random, -1e300, 1e300);
  for (int c = 0; c < CELLS; c++) {
    s->energy[c] = -c / 3.0;
    s->block[c] = INT32_MIN + c;
    s->state[c] = (uint8_t)(c % 2);
  }
  for (int n = 0; n < POINTS; n++)
    s->label[n] = INT32_MAX - n;
  const cdem_field field[6] = {
      {"displacement", "m", false, 3, CDEM_FIELD_REAL, s->displacement, 0, NULL},
      {"stress", "Pa", true, 6, CDEM_FIELD_REAL, s->stress, 0, NULL},
      {"energy \"W\"", "J/m\xc2\xb2", true, 1, CDEM_FIELD_REAL, s->energy, 0, NULL},
      {"block", "", true, 1, CDEM_FIELD_INT32, s->block, 0, NULL},
      {"label", "", false, 1, CDEM_FIELD_INT32, s->label, 0, NULL},
      {"state", "", true, 1, CDEM_FIELD_UINT8, s->state, 2, states}};
  memcpy(s->field, field, sizeof field);
  s->frame = (cdem_frame){
      "body", index,   1e-3 * (double)index / 3, POINTS, s->xyz, CELLS, type, offset, node,
      6,      s->field};
}

static void put(cdem_frame_writer *writer, int64_t index) {
  cdem_fault fault = {0};
  sample s;
  fill(&s, index, (uint64_t)index + 1);
  cdem_frame_sink sink = cdem_frame_writer_sink(writer);
  check_ok(sink.frame(sink.context, &s.frame, &fault));
}

/* ---- the same in words ---- */

static void say_field(FILE *out, const cdem_field *field, int tuples) {
  static const char *const names[] = {"double", "int", "unsigned char"};
  fprintf(out, "%s %s %s %d %d\n", field->on_cells ? "cells" : "point", field->name,
          names[field->type], field->components, tuples);
  for (int i = 0; i < tuples * field->components; i++) {
    double value = field->type == CDEM_FIELD_REAL    ? ((const double *)field->data)[i]
                   : field->type == CDEM_FIELD_INT32 ? ((const int32_t *)field->data)[i]
                                                     : ((const uint8_t *)field->data)[i];
    fprintf(out, "%.17g%c", value, (i + 1) % field->components == 0 ? '\n' : ' ');
  }
}

static void say_frame(FILE *out, int64_t index) {
  sample s;
  fill(&s, index, (uint64_t)index + 1);
  fprintf(out, "frame body/body-%06d.vtu %.17g\n", (int)index, s.frame.time);
  fprintf(out, "field|TimeValue|%s\n",
          index == 0   ? "0.0"
          : index == 1 ? "0.0003333333333333333"
                       : "0.004");
  fprintf(out, "field|state names|%s|%s\npoints %d\n", states[0], states[1], POINTS);
  for (int i = 0; i < 3 * POINTS; i++)
    fprintf(out, "%.17g%c", s.xyz[i], i % 3 == 2 ? '\n' : ' ');
  for (int c = 0; c < CELLS; c++) {
    fprintf(out, "cell %d", type[c]);
    for (int64_t n = offset[c]; n < offset[c + 1]; n++)
      fprintf(out, " %d", node[n]);
    fputc('\n', out);
  }
  for (int on_cells = 0; on_cells < 2; on_cells++)
    for (int f = 0; f < 6; f++)
      if (s.field[f].on_cells == on_cells)
        say_field(out, &s.field[f], on_cells ? CELLS : POINTS);
}

static void vtk_reads_everything(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  char folder[128], command[600];
  snprintf(folder, sizeof folder, "%s/run 1", scratch);
  check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
  put(writer, 0);
  put(writer, 1);
  put(writer, 12);
  cdem_frame_writer_destroy(&writer);
  assert_null(writer);
  assert_int_equal(count_files(folder), 2); /* body and body.pvd, nothing left over */
  assert_int_equal(count_files(in_scratch("run 1/body")), 3);
  snprintf(command, sizeof command,
           "/usr/bin/python3 '%s/frames_read.py' '%s/body.pvd' > '%s' 2>'%s'", CDEM_TESTS_IO,
           folder, in_scratch("out"), in_scratch("err"));
  int result = system(command);
  if (WEXITSTATUS(result) == 77 || WEXITSTATUS(result) == 127) {
    print_message("VTK's Python reader is not installed: skipped\n");
    skip();
  }
  char *complaint = read_whole(in_scratch("err"), NULL);
  assert_string_equal(complaint, "");
  free(complaint);
  assert_int_equal(result, 0);
  FILE *out = fopen(in_scratch("expected"), "w");
  say_frame(out, 0);
  say_frame(out, 1);
  say_frame(out, 12);
  fclose(out);
  char *found = read_whole(in_scratch("out"), NULL);
  char *expected = read_whole(in_scratch("expected"), NULL);
  for (char *f = found, *e = expected; *e != '\0' || *f != '\0';) { /* a line at a time */
    size_t fl = strcspn(f, "\n"), el = strcspn(e, "\n");
    if (fl != el || strncmp(f, e, fl) != 0)
      fail_msg("'%.*s' instead of '%.*s'", (int)fl, f, (int)el, e);
    f += fl + (f[fl] != '\0');
    e += el + (e[el] != '\0');
  }
  free(found);
  free(expected);
}

static void check_list(const char *path, int count, const int *index) {
  char expected[2000], *at = expected, *text = read_whole(path, NULL);
  assert_non_null(text);
  at += sprintf(at, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                    "byte_order=\"LittleEndian\">\n  <Collection>\n");
  for (int i = 0; i < count; i++)
    at += sprintf(at, "    <DataSet timestep=\"%.17g\" part=\"0\" file=\"body/body-%06d.vtu\"/>\n",
                  1e-3 * index[i] / 3, index[i]);
  sprintf(at, "  </Collection>\n</VTKFile>\n");
  assert_string_equal(text, expected);
  free(text);
}

static void lists_grow_with_each_frame(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  char list[128];
  snprintf(list, sizeof list, "%s/run2/body.pvd", scratch);
  check_ok(cdem_frame_writer_create(in_scratch("run2"), 0, &writer, &fault));
  for (int i = 0; i < 4; i++) {
    put(writer, i);
    check_list(list, i + 1, (const int[]){0, 1, 2, 3});
    assert_int_equal(count_files(in_scratch("run2/body")), i + 1);
  }
  cdem_frame_writer_destroy(&writer);
}

static void a_broken_run_goes_on(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  char list[128], folder[128];
  snprintf(list, sizeof list, "%s/run3/body.pvd", scratch);
  snprintf(folder, sizeof folder, "%s/run3", scratch);
  check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
  for (int i = 0; i < 5; i++)
    put(writer, i);
  cdem_frame_writer_destroy(&writer);
  /* Frames from 3 on are forgotten, on the disk too, before the first new one. */
  check_ok(cdem_frame_writer_create(folder, 3, &writer, &fault));
  check_list(list, 3, (const int[]){0, 1, 2});
  assert_int_equal(count_files(in_scratch("run3/body")), 3);
  put(writer, 3);
  put(writer, 7);
  check_list(list, 5, (const int[]){0, 1, 2, 3, 7});
  cdem_frame_writer_destroy(&writer);
  /* Resumed behind its end, nothing is lost; begun anew, all is. */
  check_ok(cdem_frame_writer_create(folder, 8, &writer, &fault));
  check_list(list, 5, (const int[]){0, 1, 2, 3, 7});
  cdem_frame_writer_destroy(&writer);
  check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
  assert_null(read_whole(list, NULL));
  assert_int_equal(count_files(in_scratch("run3/body")), 0);
  cdem_frame_writer_destroy(&writer);
}

static void lists_of_others_are_left_alone(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  static const char *const texts[] = {
      "", "<VTKFile>\n    <DataSet timestep=\"1\" part=\"0\" file=\"../../precious.vtu\"/>\n",
      "    <DataSet timestep=\"1\" part=\"0\" file=\"else/else-000001.vtu\"/>\n",
      "    <DataSet timestep=\"x\" part=\"0\" file=\"mine/mine-000001.vtu\"/>\n",
      "    <DataSet timestep=\"1\" part=\"0\" file=\"mine/mine-1.vtu\"/>\n"};
  char folder[128];
  snprintf(folder, sizeof folder, "%s/run4", scratch);
  check_ok(cdem_make_folder(folder, &fault));
  for (int i = 0; i < 5; i++) {
    write_whole(in_scratch("run4/mine.pvd"), texts[i]);
    check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
    cdem_frame_writer_destroy(&writer);
    char *text = read_whole(in_scratch("run4/mine.pvd"), NULL);
    assert_string_equal(text, texts[i]);
    free(text);
  }
}

static void bad_frames_are_refused(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  check_ok(cdem_frame_writer_create(in_scratch("run5"), 0, &writer, &fault));
  cdem_frame_sink sink = cdem_frame_writer_sink(writer);
  sample s;
  fill(&s, 0, 1);
  s.frame.set = "../body";
  check_fails(sink.frame(sink.context, &s.frame, &fault), CDEM_USAGE,
              "'../body' cannot be the name of a data set");
  fill(&s, -1, 1);
  check_fails(sink.frame(sink.context, &s.frame, &fault), CDEM_USAGE, "frames are counted from 0");
  fill(&s, 0, 1);
  s.frame.points = 8;
  check_fails(sink.frame(sink.context, &s.frame, &fault), CDEM_USAGE,
              "cell 0 of the data set 'body' names point 8, but there are 8 points");
  static const int64_t backwards[CELLS + 1] = {0, 3, 1, 3, 4, 5, 6, 7, 8};
  fill(&s, 0, 1);
  s.frame.offset = backwards;
  check_fails(sink.frame(sink.context, &s.frame, &fault), CDEM_USAGE,
              "cell 1 of the data set 'body' ends before it begins");
  assert_int_equal(count_files(in_scratch("run5")), 0);
  /* A data set may be empty: no contacts yet. */
  s.frame = (cdem_frame){.set = "contacts"};
  check_ok(sink.frame(sink.context, &s.frame, &fault));
  cdem_frame_writer_destroy(&writer);
}

static int fill_disk(const void *folder) {
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  if (cdem_frame_writer_create(folder, 1, &writer, &fault) != CDEM_OK)
    return 1;
  sample s;
  fill(&s, 1, 1);
  cdem_frame_sink sink = cdem_frame_writer_sink(writer);
  cdem_status status = sink.frame(sink.context, &s.frame, &fault);
  cdem_frame_writer_destroy(&writer);
  return status == CDEM_FILE && strstr(fault.message, "body-000001.vtu': File too large") != NULL
             ? 0
             : 2;
}

static void no_half_frame_when_the_disk_is_full(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  char folder[128];
  snprintf(folder, sizeof folder, "%s/run6", scratch);
  check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
  put(writer, 0);
  cdem_frame_writer_destroy(&writer);
  assert_int_equal(with_file_limit(1000, fill_disk, folder), 0);
  assert_int_equal(count_files(in_scratch("run6/body")), 1);
  check_list(in_scratch("run6/body.pvd"), 1, (const int[]){0});
}

static void memory_runs_out(void **unused) {
  (void)unused;
  cdem_fault fault = {0};
  cdem_frame_writer *writer;
  char folder[128];
  snprintf(folder, sizeof folder, "%s/run7", scratch);
  check_ok(cdem_frame_writer_create(folder, 0, &writer, &fault));
  put(writer, 0);
  put(writer, 1);
  cdem_frame_writer_destroy(&writer);
  for (int allowed = 0;; allowed++) {
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(allowed);
    sample s;
    fill(&s, 2, 1);
    cdem_status status = cdem_frame_writer_create(folder, 2, &writer, &fault);
    if (status == CDEM_OK) {
      cdem_frame_sink sink = cdem_frame_writer_sink(writer);
      status = sink.frame(sink.context, &s.frame, &fault);
    }
    cdem_memory_fail_after(-1);
    cdem_frame_writer_destroy(&writer);
    if (status == CDEM_OK) {
      assert_true(allowed > 10);
      break;
    }
    assert_int_equal(status, CDEM_MEMORY);
    assert_true(fault.message[0] != '\0');
  }
  char list[160];
  snprintf(list, sizeof list, "%s/body.pvd", folder);
  check_list(list, 3, (const int[]){0, 1, 2});
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(vtk_reads_everything),
      cmocka_unit_test(lists_grow_with_each_frame),
      cmocka_unit_test(a_broken_run_goes_on),
      cmocka_unit_test(lists_of_others_are_left_alone),
      cmocka_unit_test(bad_frames_are_refused),
      cmocka_unit_test(no_half_frame_when_the_disk_is_full),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
