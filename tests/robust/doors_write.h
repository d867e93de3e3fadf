/* Doors through which files go out: after a failure the file that was there before is untouched and
 * nothing else has appeared beside it. */
#ifndef CDEM_TESTS_ROBUST_DOORS_WRITE_H
#define CDEM_TESTS_ROBUST_DOORS_WRITE_H

#include "robust/doors_read.h"
#include "run/scale.h"

static const char old_text[] = "what was there before\n";

/* scratch/out/x.ENDING */
static const char *out_path(const door *d) {
  char name[64];
  snprintf(name, sizeof name, "out/x.%s", d->text);
  return in_scratch(name);
}

static void put_old(const char *path) {
  mkdir(in_scratch("out"), 0777);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(old_text, file);
  assert_int_equal(fclose(file), 0);
}

static void out_before(const door *d) {
  remove_folder("out");
  put_old(out_path(d));
}

/* The HDF5 files are the same but for times of the day, which they do not hold. */
static uint64_t out_result(const door *d) {
  return fold_file(sum_start, out_path(d));
}

static void out_failed(const door *d) {
  if (fold_file(sum_start, out_path(d)) != fold(sum_start, old_text, strlen(old_text)))
    fail_msg("%s was touched", out_path(d));
  assert_int_equal(count_entries(in_scratch("out")), 1);
}

/* ---- springs ---- */

static const cdem_material some_rock = {.name = "rock", .parameter = {4e10, 0.0}};

static cdem_status make_model(const cdem_material *material, cdem_model *model, cdem_mesh *mesh,
                              cdem_fault *fault) {
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_HEX8, .count = {2, 1, 1}, .size = {2.0, 1.0, 1.0}, .distortion = 0.1};
  CDEM_TRY(cdem_mesh_grid(&grid, mesh, fault));
  const cdem_model_options options = {
      .mesh = mesh, .materials = 1, .material = material, .default_material = -1};
  return cdem_model_init(&options, model, fault);
}

static cdem_status feed_writer(const cdem_model *model, cdem_springs_writer *writer,
                               cdem_fault *fault) {
  const cdem_convert_options options = {.threads = 1};
  CDEM_TRY(cdem_network_convert(model, &options, &writer->sink, 1, fault));
  return writer->commit(writer, fault);
}

static cdem_status write_springs(const door *d, cdem_fault *fault) {
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_springs_writer *writer = NULL;
  cdem_status status = make_model(&some_rock, &model, &mesh, fault);
  if (status == CDEM_OK)
    status = cdem_springs_format_of(out_path(d))->open(out_path(d), &model, &writer, fault);
  if (status == CDEM_OK)
    status = feed_writer(&model, writer, fault);
  cdem_springs_writer_destroy(&writer);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  return status;
}

static const door_kind springs_file = {out_before, write_springs, out_result,
                                       out_failed, NULL,          true};

/* ---- grains, tables, states ---- */

static cdem_status write_grains(const door *d, cdem_fault *fault) {
  cdem_grains grains = {.dim = 3};
  const char *const name[1] = {"glass"};
  const double at[2][3] = {{0.0, 0.0, 0.0}, {1.0, 0.1, 0.3}};
  cdem_status status = cdem_grains_add(&grains, at[0], 0.5, fault);
  if (status == CDEM_OK)
    status = cdem_grains_add(&grains, at[1], 0.25, fault);
  if (status == CDEM_OK)
    status = cdem_grains_complete(&grains, fault);
  if (status == CDEM_OK)
    status = cdem_write_grains(out_path(d), &grains, 1, name, fault);
  cdem_grains_release(&grains);
  return status;
}

static const door_kind grains_file = {out_before, write_grains, out_result, out_failed, NULL, true};

static cdem_status fill_table(cdem_table *table, cdem_fault *fault) {
  CDEM_TRY(cdem_table_add_column(table, "x", CDEM_COLUMN_REAL, "m", fault));
  CDEM_TRY(cdem_table_add_column(table, "name", CDEM_COLUMN_TEXT, "", fault));
  for (int i = 0; i < 40; i++) {
    CDEM_TRY(cdem_table_add_row(table, fault));
    cdem_table_set_real(table, 0, 1.0 / (1.0 + i));
    CDEM_TRY(cdem_table_set_text(table, 1, "a, \"b\"", fault));
  }
  return CDEM_OK;
}

static cdem_status write_table(const door *d, cdem_fault *fault) {
  cdem_table table = {0};
  cdem_status status = fill_table(&table, fault);
  if (status == CDEM_OK)
    status = strcmp(d->text, "json") == 0 ? cdem_write_table_json(out_path(d), &table, fault)
                                          : cdem_write_table_csv(out_path(d), &table, fault);
  cdem_table_release(&table);
  return status;
}

static const door_kind table_file = {out_before, write_table, out_result, out_failed, NULL, true};

static cdem_status write_and_read_state(const door *d, cdem_fault *fault) {
  double value[3000];
  cdem_state state = {0}, back = {0};
  cdem_mesh mesh = {0};
  const cdem_mesh_grid_options grid = {
      .shape = CDEM_SHAPE_QUAD4, .count = {2, 1, 0}, .size = {2.0, 1.0, 0.0}};
  for (int i = 0; i < 3000; i++)
    value[i] = i % 7;
  cdem_status status = cdem_mesh_grid(&grid, &mesh, fault);
  if (status == CDEM_OK)
    status = cdem_state_add_copy(&state, "a/b", CDEM_ARRAY_REAL, 3000, value, fault);
  if (status == CDEM_OK)
    status = cdem_mesh_to_state(&mesh, "mesh", &state, fault);
  if (status == CDEM_OK)
    status = cdem_write_state(out_path(d), &state, fault);
  cdem_mesh_release(&mesh);
  cdem_state_release(&state);
  if (status != CDEM_OK)
    return status;
  status = cdem_read_state(out_path(d), &back, fault);
  if (status == CDEM_OK)
    status = cdem_mesh_from_state(&back, "mesh", &mesh, fault);
  cdem_mesh_release(&mesh);
  cdem_state_release(&back);
  return status;
}

/* Read after it was written: either there is what was before, or the whole of the new file. */
static void state_failed(const door *d) {
  cdem_fault fault = {0};
  cdem_state state;
  if (fold_file(sum_start, out_path(d)) != fold(sum_start, old_text, strlen(old_text))) {
    check_ok(cdem_read_state(out_path(d), &state, &fault));
    cdem_state_release(&state);
  }
  assert_int_equal(count_entries(in_scratch("out")), 1);
}

static const door_kind state_file = {
    out_before, write_and_read_state, out_result, state_failed, NULL, true};

/* ---- pictures: gnuplot may have drawn one of two; nothing unfinished stays ---- */

static void pictures_before(const door *d) {
  (void)d;
  remove_folder("out");
}

static uint64_t pictures_result(const door *d) {
  (void)d;
  return fold_folder(sum_start, in_scratch("out"));
}

static int unfinished(const struct dirent *entry) {
  return strstr(entry->d_name, ".part-") != NULL;
}

static void pictures_failed(const door *d) {
  (void)d;
  struct dirent **entry = NULL;
  int entries = exists("out") ? scandir(in_scratch("out"), &entry, unfinished, NULL) : 0;
  if (entries > 0)
    fail_msg("%s stayed", entry[0]->d_name);
  free(entry);
}

static cdem_status draw_figure(const door *d, cdem_fault *fault) {
  const double x[3] = {0.0, 1.0, 2.0}, y[3] = {1.0, 0.5, 2.0};
  const cdem_curve curve[2] = {{.title = "a", .x = x, .y = y, .points = 3},
                               {.title = "b", .x = x, .y = x, .points = 3, .style = 1}};
  const cdem_panel panel = {"t", "x", "y", 2, curve, 0.0, 0.0};
  const cdem_figure figure = {"title", 1, 1, &panel};
  (void)d;
  return cdem_write_figure(in_scratch("out"), "x", &figure, fault);
}

static cdem_status draw_map(const door *d, cdem_fault *fault) {
  cdem_map map = {.title = "title", .value_label = "v"};
  cdem_map_marks *marks = NULL;
  cdem_map_lines *lines = NULL;
  (void)d;
  cdem_status status = cdem_map_add_marks(&map, CDEM_MAP_DISCS, 3, true, true, &marks, fault);
  if (status == CDEM_OK)
    status = cdem_map_add_segments(&map, 1, "wall", "#000000", 1.0, &lines, fault);
  for (int i = 0; status == CDEM_OK && i < 3; i++) {
    marks->xy[4 * i] = marks->value[i] = i;
    marks->size[i] = 0.4;
    lines->xy[i] = i;
  }
  if (status == CDEM_OK)
    status = cdem_write_map(in_scratch("out"), "x", &map, fault);
  cdem_map_release(&map);
  return status;
}

static const door_kind figure = {pictures_before, draw_figure, pictures_result,
                                 pictures_failed, NULL,        true};
static const door_kind map = {pictures_before, draw_map, pictures_result,
                              pictures_failed, NULL,     true};

/* ---- scaled cases ---- */

static cdem_status scale(const door *d, cdem_fault *fault) {
  cdem_scaled_table table = {0};
  bool coarse = d->set[0] != NULL;
  cdem_scale_options options = {.path = d->text, .output = in_scratch("out/x.yaml")};
  options.scaling = cdem_scaling_exact(cdem_ratios_of_size(2.0));
  if (coarse) {
    options.scaling = cdem_scaling_coarse(2.0, 0);
    options.scaling.rule = options.scaling.slow = true;
  }
  cdem_status status = cdem_scale_case(&options, &table, fault);
  if (status != CDEM_OK)
    check_empty(table, cdem_scaled_table);
  cdem_scaled_table_release(&table);
  return status;
}

static void scale_before(const door *d) {
  (void)d;
  remove_folder("out");
  put_old(in_scratch("out/x.yaml"));
  put_old(in_scratch("out/x-grains.csv"));
}

static uint64_t scale_result(const door *d) {
  (void)d;
  return fold_folder(sum_start, in_scratch("out"));
}

/* The case and its table of grains stay together: both old. */
static void scale_failed(const door *d) {
  static const char *const file[] = {"out/x.yaml", "out/x-grains.csv"};
  (void)d;
  for (int i = 0; i < 2; i++)
    if (fold_file(sum_start, in_scratch(file[i])) != fold(sum_start, old_text, strlen(old_text)))
      fail_msg("%s was touched", file[i]);
  assert_int_equal(count_entries(in_scratch("out")), 2);
}

static const door_kind scaled = {scale_before, scale, scale_result, scale_failed, NULL, true};

#endif
