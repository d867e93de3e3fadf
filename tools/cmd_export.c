/* cdem export INPUT -o FILE: grains for other programs. */
#include "command.h"
#include "run/export.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

enum { OPTION_DENSITY = 256, OPTION_THICKNESS, OPTION_THREADS, OPTION_JSON };

static const struct argp_option option_table[] = {
    {"output", 'o', "FILE", 0,
     "file to write; the ending chooses the kind, see `cdem list formats` (may be repeated)", 0},
    {"density", OPTION_DENSITY, "RHO", 0, "of the grains of a table, kg/m^3 or with a unit", 0},
    {"thickness", OPTION_THICKNESS, "T", 0, "of the discs of a table (default 1 m)", 0},
    {"threads", OPTION_THREADS, "N", 0, "threads for setting a case up", 0},
    {"json", OPTION_JSON, NULL, 0, "print the summary as JSON", 0},
    {"quiet", 'q', NULL, 0, "no talk and no summary", 0},
    {0},
};

typedef struct {
  cdem_export_options options;
  const char *output[CDEM_EXPORTS];
  bool density, thickness, json;
} settings;

static double positive(const char *option, const char *text, cdem_dimension dimension) {
  double value = command_quantity(option, text, dimension);
  if (!(value > 0.0) || isinf(value))
    command_usage("%s %s: a number above 0 is wanted", option, text);
  return value;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  switch (key) {
  case 'o':
    if (s->options.outputs == CDEM_EXPORTS)
      command_usage("-o may be given %d times at most", CDEM_EXPORTS);
    s->output[s->options.outputs++] = text;
    return 0;
  case OPTION_DENSITY:
    s->options.density = positive("--density", text, CDEM_DENSITY);
    s->density = true;
    return 0;
  case OPTION_THICKNESS:
    s->options.thickness = positive("--thickness", text, CDEM_LENGTH);
    s->thickness = true;
    return 0;
  case OPTION_THREADS:
    s->options.threads = (int)command_integer("--threads", text, 1, 1024);
    return 0;
  case OPTION_JSON:
    s->json = true;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (s->options.path != NULL)
      command_usage("one input at a time: '%s' and '%s'", s->options.path, text);
    s->options.path = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static bool is_same_file(const char *left, const char *right) {
  struct stat a, b;
  return strcmp(left, right) == 0 || (stat(left, &a) == 0 && stat(right, &b) == 0 &&
                                      a.st_dev == b.st_dev && a.st_ino == b.st_ino);
}

static bool is_table(const char *path) {
  size_t length = strlen(path);
  return length > 4 && strcmp(path + length - 4, ".csv") == 0;
}

static void check(const settings *s) {
  const cdem_export_options *o = &s->options;
  if (o->path == NULL)
    command_usage("grains are wanted: a table (.csv), a case (.yaml), or the folder of a run");
  if (o->outputs == 0)
    command_usage("an output is wanted: -o FILE");
  if ((s->density || s->thickness) && !is_table(o->path))
    command_usage("--density and --thickness are for tables; a case has its own");
  for (int i = 0; i < o->outputs; i++) {
    if (is_same_file(o->output[i], o->path))
      command_usage("-o %s would overwrite the input; choose another name", o->output[i]);
    for (int j = 0; j < i; j++)
      if (is_same_file(o->output[i], o->output[j]))
        command_usage("-o %s and -o %s are one file", o->output[j], o->output[i]);
  }
}

static void print_text(const settings *s, const cdem_export_summary *summary) {
  printf("%s: %lld %s", s->options.path, (long long)summary->grains,
         summary->dim == 2 ? "discs" : "spheres");
  if (!isnan(summary->time))
    printf(" at t = %.6g s", summary->time);
  printf("\n");
  for (int i = 0; i < s->options.outputs; i++)
    printf("  written to    %s\n", s->output[i]);
}

static void print_json(const settings *s, const cdem_export_summary *summary) {
  printf("{\n  \"input\": ");
  cdem_json_text(stdout, s->options.path);
  printf(",\n  \"dimension\": %d,\n  \"grains\": %lld,\n  \"time\": ", summary->dim,
         (long long)summary->grains);
  cdem_json_number(stdout, summary->time);
  printf(",\n  \"files\": [");
  for (int i = 0; i < s->options.outputs; i++) {
    printf("%s{\"name\": ", i > 0 ? ", " : "");
    cdem_json_text(stdout, s->output[i]);
    printf(", \"lost\": ");
    cdem_json_text(stdout, summary->lost[i]);
    printf("}");
  }
  printf("]\n}\n");
}

int cmd_export(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "INPUT",
      "Grains for other programs: LAMMPS (.data), YADE (.py), tables and ParaView.\v"
      "INPUT is a table of grains (.csv), a case (.yaml: its grains at the start), or the folder "
      "of a run (at its last checkpoint). A case brings its law of contact along where the other "
      "program has it. Examples:\n"
      "  cdem export sand.csv --density 2650 -o sand.data\n"
      "  cdem export data/cases/settling.yaml -o start.py\n"
      "  cdem export settling-run -o end.data -o end.csv",
      NULL,
      NULL,
      NULL};
  settings s = {.options = {.density = NAN, .thickness = 1.0}};
  cdem_export_summary summary;
  cdem_fault fault = {0};
  s.options.output = s.output;
  command_parse(&argp, argc, argv, &s);
  check(&s);
  const cdem_warnings warnings = command_warnings();
  s.options.warnings = &warnings;
  if (cdem_export(&s.options, &summary, &fault) != CDEM_OK)
    return command_fail(&fault);
  for (int i = 0; i < s.options.outputs; i++)
    if (summary.lost[i][0] != '\0')
      command_warn("'%s' lacks %s", s.output[i], summary.lost[i]);
  if (s.json)
    print_json(&s, &summary);
  else if (!command_quiet)
    print_text(&s, &summary);
  return 0;
}
