/* cdem compare RUN_A RUN_B ...: finished runs side by side, as a table and as curves. */
#include "command.h"
#include "run/compare.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_COLUMNS = 256,
  OPTION_FROM,
  OPTION_TO,
  OPTION_JSON,
  OPTION_FIGURE,
  OPTION_X,
  OPTION_LABEL,
  OPTION_X_SCALE,
  OPTION_Y_SCALE,
  OPTION_X_LABEL,
  OPTION_Y_LABEL,
  OPTION_TITLE,
  MOST_RUNS = 32,
  MOST_COLUMNS = 64,
  MOST_PATH = 3800, /* leaves room for the names in a folder */
  CELL = 200
};

static const struct argp_option option_table[] = {
    {"columns", OPTION_COLUMNS, "A,B,...", 0,
     "columns of history.csv: means with scatter in the table, and the curves of --figure", 0},
    {"from", OPTION_FROM, "TIME", 0, "rows of --columns before this time do not count", 0},
    {"to", OPTION_TO, "TIME", 0, "rows of --columns after this time do not count", 0},
    {"json", OPTION_JSON, NULL, 0, "print a JSON object in place of the table", 0},
    {"figure", OPTION_FIGURE, "FILE", 0,
     "draw --columns of all runs, a panel each: FILE.png or FILE.svg names both", 0},
    {"x", OPTION_X, "COLUMN", 0, "column along the x axis of the figure (time)", 0},
    {"label", OPTION_LABEL, "TEXT", 0,
     "a run's name in the figure, in the order of the runs; give it once a run", 0},
    {"x-scale", OPTION_X_SCALE, "FACTOR", 0, "multiplies x before drawing", 0},
    {"y-scale", OPTION_Y_SCALE, "FACTOR", 0,
     "multiplies the columns before drawing; -1 turns compression positive", 0},
    {"x-label", OPTION_X_LABEL, "TEXT", 0, "label of the x axis (column and unit)", 0},
    {"y-label", OPTION_Y_LABEL, "TEXT", 0,
     "label of a y axis, in the order of --columns (column and unit)", 0},
    {"title", OPTION_TITLE, "TEXT", 0, "title of the figure (none)", 0},
    {"quiet", 'q', NULL, 0, "no talk on stderr", 0},
    {0},
};

typedef struct {
  int runs, columns, labels, y_labels;
  const char *folder[MOST_RUNS], *column[MOST_COLUMNS], *label[MOST_RUNS], *y_label[MOST_COLUMNS];
  const char *figure, *x, *x_label, *title;
  const char *drawn_only; /* an option that has a meaning beside --figure only */
  double from, to, x_scale, y_scale;
  bool json;
} settings;

/* ---- options ---- */

static void add(const char **list, int *count, int most, const char *what, const char *text) {
  if (*count == most)
    command_usage("%s: %d at most", what, most);
  if (text[0] == '\0')
    command_usage("%s: an empty name", what);
  list[(*count)++] = text;
}

/* Cuts the argument at its commas, in place. */
static void add_columns(settings *s, char *text) {
  for (char *at = text, *comma; at != NULL; at = comma) {
    comma = strchr(at, ',');
    if (comma != NULL)
      *comma++ = '\0';
    add(s->column, &s->columns, MOST_COLUMNS, "--columns", at);
  }
}

static void add_run(settings *s, const char *text) {
  if (strlen(text) > MOST_PATH)
    command_usage("'%.40s...' is no name of a folder: it has more than %d letters", text,
                  MOST_PATH);
  add(s->folder, &s->runs, MOST_RUNS, "runs", text);
}

static bool parse_figure(settings *s, int key, char *text) {
  switch (key) {
  case OPTION_X:
    s->x = text;
    s->drawn_only = "--x";
    return true;
  case OPTION_LABEL:
    add(s->label, &s->labels, MOST_RUNS, "--label", text);
    s->drawn_only = "--label";
    return true;
  case OPTION_X_SCALE:
    s->x_scale = command_number("--x-scale", text);
    s->drawn_only = "--x-scale";
    return true;
  case OPTION_Y_SCALE:
    s->y_scale = command_number("--y-scale", text);
    s->drawn_only = "--y-scale";
    return true;
  case OPTION_X_LABEL:
    s->x_label = text;
    s->drawn_only = "--x-label";
    return true;
  case OPTION_Y_LABEL:
    add(s->y_label, &s->y_labels, MOST_COLUMNS, "--y-label", text);
    s->drawn_only = "--y-label";
    return true;
  case OPTION_TITLE:
    s->title = text;
    s->drawn_only = "--title";
    return true;
  }
  return false;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  if (parse_figure(s, key, text))
    return 0;
  switch (key) {
  case OPTION_COLUMNS:
    add_columns(s, text);
    return 0;
  case OPTION_FROM:
    s->from = command_quantity("--from", text, CDEM_TIME);
    return 0;
  case OPTION_TO:
    s->to = command_quantity("--to", text, CDEM_TIME);
    return 0;
  case OPTION_JSON:
    s->json = true;
    return 0;
  case OPTION_FIGURE:
    s->figure = text;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    add_run(s, text);
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

/* Behind the folders of a path. */
static const char *file_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash != NULL ? slash + 1 : path;
}

static void check_figure(const settings *s) {
  const char *name = file_name(s->figure), *dot = strrchr(name, '.');
  if (dot == NULL || dot == name || (strcmp(dot, ".png") != 0 && strcmp(dot, ".svg") != 0))
    command_usage("--figure %s: a file NAME.png or NAME.svg is wanted", s->figure);
  if (strlen(s->figure) > MOST_PATH)
    command_usage("--figure: the name has more than %d letters", MOST_PATH);
  if (s->columns == 0)
    command_usage("--figure: name what is drawn with --columns");
  if (s->runs > CDEM_COMPARE_MOST_CURVES || s->columns > CDEM_COMPARE_MOST_PANELS)
    command_usage("--figure: %d runs and %d columns at most", CDEM_COMPARE_MOST_CURVES,
                  CDEM_COMPARE_MOST_PANELS);
  if (s->labels > s->runs)
    command_usage("--label: there are %d labels for %d runs", s->labels, s->runs);
  if (s->y_labels > s->columns)
    command_usage("--y-label: there are %d labels for %d columns", s->y_labels, s->columns);
}

static void check_settings(const settings *s) {
  if (s->runs < 2)
    command_usage("two runs or more are wanted: cdem compare RUN_A RUN_B");
  if (s->columns == 0 && !(isnan(s->from) && isnan(s->to)))
    command_usage("--from and --to choose rows of history.csv; name columns with --columns");
  if (s->from >= s->to) /* false with NaN */
    command_usage("--to must be later than --from");
  if (s->figure != NULL)
    check_figure(s);
  else if (s->drawn_only != NULL)
    command_usage("%s is for a figure; name its file with --figure", s->drawn_only);
}

/* ---- the table ---- */

/* Letters on the screen: bytes that do not continue one. */
static int width_of(const char *text) {
  int width = 0;
  for (; *text != '\0'; text++)
    width += ((unsigned char)*text & 0xc0) != 0x80;
  return width;
}

/* Spaces are owed until something follows, so that no line ends with them. */
static void print_cell(const char *text, int width, bool right, int *owed) {
  int space = width - width_of(text);
  *owed += right && space > 0 ? space : 0;
  if (text[0] != '\0') {
    printf("%*s", *owed, "");
    *owed = 0;
  }
  for (; *text != '\0'; text++) /* a name may hold what a terminal would obey */
    putchar(iscntrl((unsigned char)*text) ? ' ' : *text);
  *owed += !right && space > 0 ? space : 0;
}

/* "1.684e6" and " ± 2.1e4", so that signs stand below each other. */
static void split_value(const cdem_compared *compared, char value[CELL], char scatter[CELL]) {
  char text[CDEM_COMPARED_TEXT];
  cdem_compared_text(compared, text);
  const char *sign = strstr(text, " ±");
  int length = sign != NULL ? (int)(sign - text) : (int)strlen(text);
  snprintf(value, CELL, "%.*s", length, text);
  snprintf(scatter, CELL, "%s", text + length);
}

static void difference_text(double difference, char text[CELL]) {
  double percent = 100.0 * difference;
  text[0] = '\0';
  if (!isnan(percent))
    snprintf(text, CELL, fabs(percent) < 1e5 ? "%+.2f %%" : "%+.3g %%", percent);
}

static const char *row_name(const cdem_compared_row *row, char text[CELL]) {
  snprintf(text, CELL, "%s%s", row->kind == CDEM_COMPARED_WINDOW ? "mean of " : "",
           row->kind == CDEM_COMPARED_WALL_TIME ? "wall time" : row->name);
  return text;
}

typedef struct {
  int name, unit;
  int value[MOST_RUNS], scatter[MOST_RUNS],
      run[MOST_RUNS]; /* run: value and scatter, or its name */
  int difference[MOST_RUNS];
} widths;

static int larger(int a, int b) {
  return a > b ? a : b;
}

static widths measure(const cdem_comparison *c) {
  char text[CELL], value[CELL], scatter[CELL];
  widths w = {.name = width_of("result"), .unit = width_of("unit")};
  for (int r = 0; r < c->runs; r++)
    w.difference[r] = width_of("difference");
  for (int64_t i = 0; i < c->rows; i++) {
    const cdem_compared_row *row = &c->row[i];
    w.name = larger(w.name, width_of(row_name(row, text)));
    w.unit = larger(w.unit, width_of(row->unit));
    for (int r = 0; r < c->runs; r++) {
      split_value(&row->run[r], value, scatter);
      w.value[r] = larger(w.value[r], width_of(value));
      w.scatter[r] = larger(w.scatter[r], width_of(scatter));
      difference_text(row->run[r].difference, text);
      w.difference[r] = larger(w.difference[r], width_of(text));
    }
  }
  for (int r = 0; r < c->runs; r++)
    w.run[r] = larger(width_of(c->run[r]), w.value[r] + w.scatter[r]);
  return w;
}

enum { GAP = 2 }; /* between columns */

static void print_header(const cdem_comparison *c, const widths *w) {
  int owed = GAP;
  print_cell("result", w->name + GAP, false, &owed);
  print_cell("unit", w->unit, false, &owed);
  for (int r = 0; r < c->runs; r++) {
    print_cell(c->run[r], w->run[r] + GAP, true, &owed);
    if (r > 0)
      print_cell("difference", w->difference[r] + GAP, true, &owed);
  }
  printf("\n");
}

static void print_row(const cdem_comparison *c, const cdem_compared_row *row, const widths *w) {
  char text[CELL], value[CELL], scatter[CELL];
  int owed = GAP;
  print_cell(row_name(row, text), w->name + GAP, false, &owed);
  print_cell(row->unit, w->unit, false, &owed);
  for (int r = 0; r < c->runs; r++) {
    split_value(&row->run[r], value, scatter);
    print_cell(value, w->run[r] + GAP - w->scatter[r], true, &owed);
    print_cell(scatter, w->scatter[r], false, &owed);
    difference_text(row->run[r].difference, text);
    if (r > 0)
      print_cell(text, w->difference[r] + GAP, true, &owed);
  }
  printf("\n");
}

static void print_table(const cdem_comparison *c) {
  bool scatter = false, window = false;
  const widths w = measure(c);
  print_header(c, &w);
  for (int64_t i = 0; i < c->rows; i++) {
    print_row(c, &c->row[i], &w);
    window = window || c->row[i].kind == CDEM_COMPARED_WINDOW;
    for (int r = 0; r < c->runs; r++)
      scatter = scatter || !isnan(c->row[i].run[r].scatter);
  }
  if (scatter)
    printf("  ± is the standard deviation of the rows of history.csv that a mean is taken from\n");
  if (window && !(isnan(c->from) && isnan(c->to))) {
    printf("  mean of: rows");
    if (!isnan(c->from))
      printf(" from %g s", c->from);
    if (!isnan(c->to))
      printf(" to %g s", c->to);
    printf("\n");
  }
}

/* ---- the whole ---- */

static cdem_status print(const settings *s, const cdem_comparison *comparison, cdem_fault *fault) {
  char *text = NULL;
  if (!s->json) {
    print_table(comparison);
    return CDEM_OK;
  }
  CDEM_TRY(cdem_comparison_json(comparison, &text, fault));
  fputs(text, stdout);
  free(text);
  return CDEM_OK;
}

static cdem_status draw(const settings *s, cdem_fault *fault) {
  const cdem_compare_figure figure = {.runs = s->runs,
                                      .folder = s->folder,
                                      .label = s->label,
                                      .x = s->x,
                                      .columns = s->columns,
                                      .column = s->column,
                                      .y_label = s->y_label,
                                      .x_label = s->x_label,
                                      .title = s->title,
                                      .x_scale = s->x_scale,
                                      .y_scale = s->y_scale,
                                      .from = s->from,
                                      .to = s->to};
  char folder[4096], name[4096];
  const char *file = file_name(s->figure);
  int before = (int)(file - s->figure);
  snprintf(folder, sizeof folder, "%.*s", before, s->figure);
  snprintf(name, sizeof name, "%.*s", (int)strlen(file) - 4, file); /* without .png */
  CDEM_TRY(cdem_compare_draw(&figure, before > 0 ? folder : ".", name, fault));
  command_say("%s%s.png and .svg are drawn, with the .gp and .dat that draw them", folder, name);
  return CDEM_OK;
}

int cmd_compare(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "RUN_A RUN_B [RUN...]",
      "Shows the key results of finished runs side by side, with the differences from RUN_A in "
      "percent of it; the last row is the wall time.\v"
      "RUN is a folder that `cdem run` has written. A mean is shown with its scatter. In a figure, "
      "labels know k_1 and m^2.\n"
      "Examples:\n"
      "  cdem compare coarse-run fine-run\n"
      "  cdem compare a b c --columns top_force,solid --from '58 ms' --to '80 ms'\n"
      "  cdem compare a b --figure load.png --columns force --x tip --y-scale -1 \\\n"
      "      --label coarse --label fine",
      NULL,
      NULL,
      NULL};
  settings s = {.from = NAN, .to = NAN, .x_scale = 1.0, .y_scale = 1.0};
  cdem_comparison comparison = {0};
  cdem_fault fault = {0};
  command_parse(&argp, argc, argv, &s);
  check_settings(&s);
  bool windows = s.figure == NULL || !(isnan(s.from) && isnan(s.to));
  const cdem_compare_options options = {.runs = s.runs,
                                        .folder = s.folder,
                                        .columns = windows ? s.columns : 0,
                                        .column = s.column,
                                        .from = s.from,
                                        .to = s.to};
  cdem_status status = cdem_compare(&options, &comparison, &fault);
  if (status == CDEM_OK && s.figure != NULL)
    status = draw(&s, &fault);
  if (status == CDEM_OK)
    status = print(&s, &comparison, &fault);
  cdem_comparison_release(&comparison);
  return status == CDEM_OK ? 0 : command_fail(&fault);
}
