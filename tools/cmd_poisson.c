/* cdem poisson: spring form, stiffness and direction of one element against Poisson's ratio. */
#include "base/suggest.h"
#include "command.h"
#include "poisson.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 1000000 };

enum {
  OPTION_ELEMENT = 256,
  OPTION_FROM,
  OPTION_TO,
  OPTION_STEP,
  OPTION_PAIRS,
  OPTION_ROOTS,
  OPTION_BOX,
  OPTION_SHAPE,
  OPTION_PLANE,
  OPTION_THICKNESS,
  OPTION_COSSERAT_RATIO,
  OPTION_CHARACTERISTIC_LENGTH,
  OPTION_COUPLE_FACTOR,
  OPTION_FIGURES,
  OPTION_COMPARE,
};

static const struct argp_option option_table[] = {
    {NULL, 0, NULL, 0, "Element:", 1},
    {"element", OPTION_ELEMENT, "NAME", 0,
     "element, see `cdem list elements` (default hex8); its edges are 1 m long", 1},
    {"box", OPTION_BOX, "LX,LY,LZ", 0, "scale it along the axes (one number: all the same)", 1},
    {"shape", OPTION_SHAPE, "FILE", 0,
     "its own shape: a mesh with one element, or a list of coordinates, one node a line (.txt, "
     ".csv, .dat)",
     1},
    {"young", 'E', "YOUNG", 0, "Young's modulus, Pa or with a unit (default 1)", 1},
    {"plane", OPTION_PLANE, "strain|stress", 0, "2-D elements (default strain)", 1},
    {"thickness", OPTION_THICKNESS, "T", 0, "2-D elements (default 1 m)", 1},
    {"cosserat-ratio", OPTION_COSSERAT_RATIO, "R", 0,
     "Cosserat elements: Gc/G, kept while nu changes (default 1)", 1},
    {"characteristic-length", OPTION_CHARACTERISTIC_LENGTH, "L", 0,
     "Cosserat elements (default 1 m)", 1},
    {"couple-factor", OPTION_COUPLE_FACTOR, "F", 0,
     "Cosserat elements: couple modulus = F G L^2 (default 1)", 1},
    {NULL, 0, NULL, 0, "Poisson's ratio:", 2},
    {"from", OPTION_FROM, "A", 0, "first ratio", 2},
    {"to", OPTION_TO, "B", 0, "last ratio, included", 2},
    {"step", OPTION_STEP, "S", 0, "nu = A + i S", 2},
    {"pairs", OPTION_PAIRS, "first|all", 0,
     "first pair of each class (default), or all pairs of nodes", 2},
    {NULL, 0, NULL, 0, "Output:", 3},
    {"output", 'o', "FILE", 0, "write the table to .csv or .json (default: CSV to stdout)", 3},
    {"roots", OPTION_ROOTS, NULL, 0,
     "the critical ratios between -1 and 1/2 (plane stress: 1) instead of the table: where the "
     "form changes, or two "
     "values touch (then from = to)",
     3},
    {"figures", OPTION_FIGURES, "FOLDER", 0,
     "draw stiffness and directions of each class against nu (without --from, --to: where the "
     "source draws them)",
     3},
    {"compare", OPTION_COMPARE, "gusev|net2d", 0,
     "the network inside a body beside Gusev's, or beside the triangular chain net; exit code 1 "
     "when they differ",
     3},
    {"quiet", 'q', NULL, 0, "no talk and no progress on stderr", 4},
    {0},
};

typedef struct {
  cdem_specimen_options options;
  const char *shape, *output, *figures, *compare;
  double from, to, step;
  bool has_from, has_to, has_step, has_box, plane, thickness, cosserat, all, roots;
} settings;

/* ---- option values ---- */

static const cdem_element *element_of(const char *name) {
  const cdem_element *element = cdem_element_find(name);
  if (element != NULL)
    return element;
  const char *names[CDEM_ELEMENT_COUNT];
  for (int i = 0; i < CDEM_ELEMENT_COUNT; i++)
    names[i] = cdem_element_get((cdem_element_id)i)->name;
  const char *nearest = cdem_suggest(name, names, CDEM_ELEMENT_COUNT);
  if (nearest != NULL)
    command_usage("there is no element '%s'; did you mean '%s'?", name, nearest);
  command_usage("there is no element '%s'; `cdem list elements` shows all", name);
}

static double positive(const char *option, const char *text, cdem_dimension dimension) {
  double value = command_quantity(option, text, dimension);
  if (!(value > 0.0) || isinf(value))
    command_usage("%s %s: a number above 0 is wanted", option, text);
  return value;
}

static void box_of(const char *text, double box[3]) {
  const char *at = text;
  int count = 0;
  for (;; at++) {
    char part[64];
    size_t length = strcspn(at, ",");
    if (count == 3 || length == 0 || length >= sizeof part)
      command_usage("--box %s: three lengths parted by commas are wanted, or one", text);
    snprintf(part, sizeof part, "%.*s", (int)length, at);
    box[count++] = positive("--box", part, CDEM_LENGTH);
    at += length;
    if (*at == '\0')
      break;
  }
  for (; count == 1 || count == 2; count++)
    box[count] = count == 1 ? box[0] : 0.0;
  if (box[1] == box[0] && box[2] == 0.0)
    box[2] = box[0];
}

static bool parse_element(settings *s, int key, const char *text) {
  switch (key) {
  case OPTION_ELEMENT:
    s->options.element = element_of(text);
    return true;
  case OPTION_BOX:
    box_of(text, s->options.box);
    s->has_box = true;
    return true;
  case OPTION_SHAPE:
    s->shape = text;
    return true;
  case 'E':
    s->options.young = positive("-E", text, CDEM_PRESSURE);
    return true;
  case OPTION_PLANE:
    if (strcmp(text, "strain") != 0 && strcmp(text, "stress") != 0)
      command_usage("--plane %s: strain or stress is wanted", text);
    s->options.section.plane = strcmp(text, "stress") == 0 ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN;
    s->plane = true;
    return true;
  case OPTION_THICKNESS:
    s->options.section.thickness = positive("--thickness", text, CDEM_LENGTH);
    s->thickness = true;
    return true;
  case OPTION_COSSERAT_RATIO:
    s->options.cosserat_ratio = positive("--cosserat-ratio", text, CDEM_DIMENSIONLESS);
    s->cosserat = true;
    return true;
  case OPTION_CHARACTERISTIC_LENGTH:
    s->options.length = positive("--characteristic-length", text, CDEM_LENGTH);
    s->cosserat = true;
    return true;
  case OPTION_COUPLE_FACTOR:
    s->options.couple_factor = positive("--couple-factor", text, CDEM_DIMENSIONLESS);
    s->cosserat = true;
    return true;
  }
  return false;
}

static bool parse_range(settings *s, int key, const char *text) {
  switch (key) {
  case OPTION_FROM:
    s->from = command_number("--from", text);
    s->has_from = true;
    return true;
  case OPTION_TO:
    s->to = command_number("--to", text);
    s->has_to = true;
    return true;
  case OPTION_STEP:
    s->step = command_number("--step", text);
    s->has_step = true;
    return true;
  case OPTION_PAIRS:
    if (strcmp(text, "first") != 0 && strcmp(text, "all") != 0)
      command_usage("--pairs %s: first or all is wanted", text);
    s->all = strcmp(text, "all") == 0;
    return true;
  }
  return false;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  if (parse_element(s, key, text) || parse_range(s, key, text))
    return 0;
  switch (key) {
  case 'o':
    s->output = text;
    return 0;
  case OPTION_ROOTS:
    s->roots = true;
    return 0;
  case OPTION_FIGURES:
    s->figures = text;
    return 0;
  case OPTION_COMPARE:
    if (strcmp(text, "gusev") != 0 && strcmp(text, "net2d") != 0)
      command_usage("--compare %s: gusev or net2d is wanted", text);
    s->compare = text;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    command_usage("'%s' is no option; `cdem poisson` takes options only", text);
  }
  return ARGP_ERR_UNKNOWN;
}

/* ---- checks between options ---- */

static bool has_ending(const char *path, const char *ending) {
  size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcmp(path + length - tail, ending) == 0;
}

static void check_options(settings *s) {
  const cdem_element *element = s->options.element;
  if (s->has_box && s->shape != NULL)
    command_usage("--box and --shape exclude each other");
  if (s->has_box && s->options.box[2] == 0.0) {
    if (element->formulation == CDEM_SOLID)
      command_usage("--box: %s needs three lengths", element->name);
    s->options.box[2] = 1.0;
  }
  if ((s->plane || s->thickness) && element->formulation == CDEM_SOLID)
    command_usage("--plane and --thickness are for plane elements; %s is a solid", element->name);
  if (s->cosserat && element->formulation != CDEM_PLANE_COSSERAT)
    command_usage("--cosserat-ratio, --characteristic-length and --couple-factor are for "
                  "*-cosserat elements; %s has no rotations",
                  element->name);
  const char *name = s->output != NULL ? strrchr(s->output, '/') : NULL;
  name = name != NULL ? name + 1 : s->output;
  /* Without an ending (a device, a pipe) the table is CSV. */
  if (name != NULL && strchr(name, '.') != NULL && !has_ending(name, ".csv") &&
      !has_ending(name, ".json"))
    command_usage("the ending of '%s' names no table; .csv or .json is wanted", s->output);
  if ((s->roots || s->compare != NULL) && (s->has_from || s->has_to || s->has_step))
    command_say("--from, --to and --step are for tables and figures; they are not used here");
}

/* False when no range is given at all. */
static bool range_of(const settings *s, bool step_needed, double low, double high,
                     poisson_range *range) {
  if (!s->has_from && !s->has_to && !s->has_step)
    return false;
  if (!s->has_from || !s->has_to || (step_needed && !s->has_step))
    command_usage("--from, --to%s go together", step_needed ? " and --step" : "");
  if (s->has_step && !(s->step > 0.0))
    command_usage("--step %g: a number above 0 is wanted", s->step);
  if (!(s->from <= s->to))
    command_usage("the range is empty: --from %g is above --to %g", s->from, s->to);
  *range = (poisson_range){s->from, s->to, s->step, 1};
  const double end[2] = {s->from, s->to};
  for (int i = 0; i < 2; i++)
    if (!(end[i] > low && end[i] < high)) {
      cdem_fault fault = {0};
      cdem_fail(&fault, CDEM_INPUT,
                "%s %g: Poisson's ratio is out of range: it must lie between %g and %g, both "
                "excluded",
                i == 0 ? "--from" : "--to", end[i], low, high);
      exit(command_fail(&fault));
    }
  if (s->has_step) {
    double steps = (s->to - s->from) / s->step;
    if (!(steps < MOST_ROWS))
      command_usage("--step %g makes more than %d rows; take a larger one", s->step, MOST_ROWS);
    /* B is included although (B - A)/S may come out a rounding below a whole number. */
    range->rows = 1 + (int64_t)floor(steps * (1.0 + 1e-12) + 1e-9);
  }
  return true;
}

/* ---- the work ---- */

static cdem_status write_table(const settings *s, const cdem_table *table, cdem_fault *fault) {
  const char *path = s->output != NULL ? s->output : "-";
  if (has_ending(path, ".json"))
    return cdem_write_table_json(path, table, fault);
  return cdem_write_table_csv(path, table, fault);
}

static void note_double(const char *pair, const char *class_) {
  command_say("pair %s (%s): two values are equal at every ratio, so it has no row", pair, class_);
}

static cdem_status make_specimen(const settings *s, cdem_specimen *specimen, cdem_fault *fault) {
  double xyz[CDEM_SHAPE_MAX_NODES][3];
  cdem_specimen_options options = s->options;
  if (s->shape != NULL) {
    const cdem_warnings warnings = command_warnings();
    CDEM_TRY(poisson_read_shape(s->shape, options.element, &warnings, xyz, fault));
    options.xyz = (const double(*)[3])xyz;
  }
  cdem_status status = cdem_specimen_init(&options, specimen, fault);
  if (status != CDEM_OK)
    cdem_fault_prefix(fault, "%s", s->shape != NULL ? s->shape : options.element->name);
  return status;
}

static cdem_status tabulate(const settings *s, const cdem_specimen *specimen,
                            const poisson_range *range, cdem_fault *fault) {
  cdem_table table = {0};
  cdem_status status =
      s->roots ? poisson_fill_roots(specimen, s->all, note_double, &table, fault)
               : poisson_fill_table(specimen, range, s->all, command_progress(), &table, fault);
  command_progress_end();
  if (status == CDEM_OK)
    status = write_table(s, &table, fault);
  cdem_table_release(&table);
  return status;
}

static cdem_status work(const settings *s, cdem_fault *fault) {
  cdem_specimen specimen = {0};
  poisson_range range;
  CDEM_TRY(make_specimen(s, &specimen, fault));
  bool table_wanted = s->figures == NULL || s->output != NULL;
  bool ranged =
      !s->roots && range_of(s, table_wanted, specimen.family.low, specimen.family.high, &range);
  if (!s->roots && table_wanted && !ranged)
    command_usage("a range is wanted: --from A --to B --step S (or --roots, --figures, --compare)");
  const cdem_element *element = s->options.element;
  if (element->formulation != CDEM_SOLID && !(s->plane && s->thickness))
    command_say("plane %s, thickness %g m",
                specimen.options.section.plane == CDEM_PLANE_STRAIN ? "strain" : "stress",
                specimen.options.section.thickness);
  if (element->formulation == CDEM_PLANE_COSSERAT && !s->cosserat)
    command_say("Gc/G = %g, characteristic length %g m, couple factor %g",
                specimen.options.cosserat_ratio, specimen.options.length,
                specimen.options.couple_factor);
  command_catch_interrupt();
  cdem_status status = CDEM_OK;
  if (table_wanted || s->roots)
    status = tabulate(s, &specimen, &range, fault);
  if (status == CDEM_OK && s->figures != NULL)
    status = poisson_draw_figures(&specimen, ranged ? &range : NULL, s->figures, fault);
  cdem_specimen_release(&specimen);
  return status;
}

static void print_comparison(const cdem_table *table) {
  printf("%-13s %-8s %-15s %19s %19s %11s  %s\n", "case", "nu", "direction", "assembled/(E L)",
         "reference/(E L)", "difference", "verdict");
  for (int64_t r = 0; r < table->rows; r++)
    printf("%-13s %-8.6g %-15s %19.12g %19.12g %11.2e  %s\n", cdem_table_at(table, r, 0)->text,
           cdem_table_at(table, r, 1)->real, cdem_table_at(table, r, 2)->text,
           cdem_table_at(table, r, 3)->real, cdem_table_at(table, r, 4)->real,
           cdem_table_at(table, r, 5)->real, cdem_table_at(table, r, 6)->text);
}

static int compare(const settings *s) {
  cdem_table table = {0};
  cdem_fault fault = {0};
  bool agree = false;
  int code;
  cdem_status status = poisson_compare(s->compare, &table, &agree, &fault);
  if (status == CDEM_OK && s->output != NULL)
    status = write_table(s, &table, &fault);
  if (status == CDEM_OK && s->output == NULL)
    print_comparison(&table);
  if (status != CDEM_OK)
    code = command_fail(&fault);
  else
    code = agree ? 0 : cdem_status_exit_code(CDEM_CHECK);
  cdem_table_release(&table);
  return code;
}

int cmd_poisson(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      NULL,
      "Spring form, stiffness and direction of one element against Poisson's ratio, beside the "
      "closed forms where they are known.\v"
      "Examples:\n"
      "  cdem poisson --element hex8 --from -0.2 --to 0.49 --step 0.01 -o t.csv\n"
      "  cdem poisson --element quad4 --plane stress --roots\n"
      "  cdem poisson --figures figures\n"
      "  cdem poisson --compare gusev",
      NULL,
      NULL,
      NULL};
  settings s = {.options = {.element = cdem_element_find("hex8")}};
  command_parse(&argp, argc, argv, &s);
  check_options(&s);
  if (s.compare != NULL)
    return compare(&s);
  cdem_fault fault = {0};
  return work(&s, &fault) == CDEM_OK ? 0 : command_fail(&fault);
}
