/* cdem scale CASE.yaml --h 2 -o scaled.yaml: a case scaled exactly, or coarse-grained. */
#include "command.h"
#include "run/scale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_H = 256,
  OPTION_LENGTH,
  OPTION_TIME,
  OPTION_MASS,
  OPTION_DENSITY,
  OPTION_STRESS,
  OPTION_COARSE,
  OPTION_NO_RULE,
  OPTION_KEEP_RATE,
  OPTION_SET,
  OPTION_JSON
};

static const struct argp_option option_table[] = {
    {"h", OPTION_H, "RATIO", 0,
     "lengths and times by h, masses by h^3: density and stress stay (2 doubles the size)", 0},
    {"output", 'o', "FILE", 0, "the scaled case (- is stdout); without it the table alone", 0},
    {"length", OPTION_LENGTH, "RATIO", 0, "in place of h: ratio of lengths (1)", 0},
    {"time", OPTION_TIME, "RATIO", 0, "ratio of times (that of lengths)", 0},
    {"mass", OPTION_MASS, "RATIO", 0, "ratio of masses (cube of that of lengths)", 0},
    {"density", OPTION_DENSITY, "RATIO", 0, "in place of --mass: ratio of densities", 0},
    {"stress", OPTION_STRESS, "RATIO", 0, "in place of --time: ratio of stresses", 0},
    {"coarse-grain", OPTION_COARSE, NULL, 0,
     "the domain keeps its size: grains alone grow by h, with the parameters that belong to them",
     0},
    {"no-rule", OPTION_NO_RULE, NULL, 0,
     "coarse graining of sizes alone: parameters of contacts stay, and results drift", 0},
    {"keep-rate", OPTION_KEEP_RATE, NULL, 0,
     "coarse graining without slowing the domain down by h (which keeps the inertial number)", 0},
    {"set", OPTION_SET, "KEY=VALUE", 0, "replace a value of the case before it is scaled", 0},
    {"json", OPTION_JSON, NULL, 0, "print a JSON object in place of the table", 0},
    {"quiet", 'q', NULL, 0, "no talk, no table", 0},
    {0},
};

typedef struct {
  const char *path, *output;
  command_overrides set;
  double h, length, time, mass, density, stress; /* NaN: not given */
  bool coarse, no_rule, keep_rate, json;
} settings;

static double ratio(const char *option, const char *text) {
  double value = command_number(option, text);
  if (!(value > 0.0) || !isfinite(value) || value < 1e-9 || value > 1e9)
    command_usage("%s %s: a ratio from 1e-9 to 1e9 is wanted", option, text);
  return value;
}

static bool parse_ratio(settings *s, int key, const char *text) {
  static const char *const names[] = {"--h",    "--length",  "--time",
                                      "--mass", "--density", "--stress"};
  double *const value[] = {&s->h, &s->length, &s->time, &s->mass, &s->density, &s->stress};
  if (key < OPTION_H || key > OPTION_STRESS)
    return false;
  *value[key - OPTION_H] = ratio(names[key - OPTION_H], text);
  return true;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  if (parse_ratio(s, key, text))
    return 0;
  switch (key) {
  case 'o':
    s->output = text;
    return 0;
  case OPTION_COARSE:
    s->coarse = true;
    return 0;
  case OPTION_NO_RULE:
    s->no_rule = true;
    return 0;
  case OPTION_KEEP_RATE:
    s->keep_rate = true;
    return 0;
  case OPTION_SET:
    command_override(&s->set, text);
    return 0;
  case OPTION_JSON:
    s->json = true;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (s->path != NULL)
      command_usage("one case at a time: '%s' and '%s'", s->path, text);
    s->path = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static bool given(double value) {
  return !isnan(value);
}

static void check_settings(const settings *s) {
  bool base =
      given(s->length) || given(s->time) || given(s->mass) || given(s->density) || given(s->stress);
  if (s->path == NULL)
    command_usage("a case is wanted (.yaml)");
  if (given(s->h) && base)
    command_usage("--h says all base ratios; leave --length, --time, --mass, --density and "
                  "--stress out");
  if (!given(s->h) && !base)
    command_usage("a ratio is wanted: --h 2");
  if (s->coarse && !given(s->h))
    command_usage("--coarse-grain takes --h alone: density and stress stay");
  if (!s->coarse && (s->no_rule || s->keep_rate))
    command_usage("%s goes with --coarse-grain", s->no_rule ? "--no-rule" : "--keep-rate");
  if (given(s->mass) && given(s->density))
    command_usage("--mass and --density say the same thing; give one of them");
  if (given(s->time) && given(s->stress))
    command_usage("--time and --stress say the same thing; give one of them");
  if (s->output != NULL && strcmp(s->output, "-") == 0 && s->json)
    command_usage("-o - and --json both want stdout");
}

/* stress = mass/(length time^2). */
static cdem_ratios base_ratios(const settings *s) {
  if (given(s->h))
    return cdem_ratios_of_size(s->h);
  cdem_ratios r = {.length = given(s->length) ? s->length : 1.0};
  double volume = r.length * r.length * r.length;
  r.mass = given(s->mass) ? s->mass : given(s->density) ? s->density * volume : volume;
  r.time = given(s->time)     ? s->time
           : given(s->stress) ? sqrt(r.mass / (r.length * s->stress))
                              : r.length;
  return r;
}

/* ---- what is said ---- */

/* What the source's table 1 calls by a sign, by the last word of a key. */
static const char *symbol_of(const char *key) {
  static const struct {
    const char *word, *symbol;
  } known[] = {{"length", "L"},
               {"time", "T"},
               {"mass", "m"},
               {"force", "F"},
               {"stress", "sigma"},
               {"velocity", "v"},
               {"density", "rho"},
               {"gravity", "g"},
               {"young", "E"},
               {"radius", "r"},
               {"normal_stiffness", "kn"},
               {"shear_stiffness", "ks"},
               {"normal_dashpot", "cn"},
               {"shear_dashpot", "cs"},
               {"rolling_stiffness", "k_omega"},
               {"rolling_dashpot", "c_omega"},
               {"rolling_length", "mu_omega"},
               {"rolling_force_stiffness", "kr"},
               {"rolling_force_dashpot", "cr"},
               {"mass_damping", "c_m"},
               {"characteristic_length", "l_c"},
               {"energy_1", "G_I"},
               {"energy_2", "G_II"}};
  const char *dot = strrchr(key, '.'), *word = dot != NULL ? dot + 1 : key;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (strcmp(known[i].word, word) == 0)
      return known[i].symbol;
  return "";
}

static const char *dimension_text(cdem_dimension d, char text[48]) {
  static const char *const base[] = {"[L]", "[T]", "[M]"};
  const int power[] = {d.length, d.time, d.mass};
  size_t used = 0;
  text[0] = '\0';
  for (int i = 0; i < 3; i++) {
    if (power[i] == 0)
      continue;
    used += (size_t)snprintf(text + used, 48 - used, "%s", base[i]);
    if (power[i] != 1)
      used += (size_t)snprintf(text + used, 48 - used, "%d", power[i]);
  }
  return used > 0 ? text : "[1]";
}

static void print_row(const char *name, cdem_dimension dimension, double factor, const char *note) {
  char text[48];
  printf("  %-38s %-9s %-15s %.10g%s\n", name, symbol_of(name), dimension_text(dimension, text),
         factor, note);
}

static void print_table(const cdem_scaled_table *table) {
  static const struct {
    const char *name;
    cdem_dimension dimension;
  } base[] = {{"length", {1, 0, 0}},    {"time", {0, 1, 0}},          {"mass", {0, 0, 1}},
              {"force", {1, -2, 1}},    {"stress", {-1, -2, 1}},      {"density", {-3, 0, 1}},
              {"velocity", {1, -1, 0}}, {"acceleration", {1, -2, 0}}, {"energy", {2, -2, 1}}};
  const cdem_scaling *s = &table->scaling;
  printf("  %-38s %-9s %-15s %s\n", s->coarse ? "quantity of the grains" : "quantity", "symbol",
         "dimension", "factor");
  for (size_t i = 0; i < sizeof base / sizeof *base; i++)
    print_row(base[i].name, base[i].dimension, cdem_ratio(&s->ratios, base[i].dimension), "");
  printf("\n  %-38s %-9s %-15s %s\n", "key of the case", "symbol", "dimension", "factor");
  for (int64_t i = 0; i < table->rows; i++) {
    const cdem_scaled_row *row = &table->row[i];
    print_row(row->key, row->dimension, row->factor,
              row->added    ? "  (its default)"
              : row->counts ? "  (rounded)"
                            : "");
  }
}

static void put_number(const char *before, double value) {
  fputs(before, stdout);
  cdem_json_number(stdout, value);
}

static void print_json(const cdem_scaled_table *table) {
  static const char *const tags[] = {"none", "grain", "law", "domain"};
  const cdem_scaling *s = &table->scaling;
  printf("{\n  \"kind\": \"%s\",\n", s->coarse ? "coarse" : "exact");
  put_number("  \"length\": ", s->ratios.length);
  put_number(",\n  \"time\": ", s->ratios.time);
  put_number(",\n  \"mass\": ", s->ratios.mass);
  if (s->coarse)
    printf(",\n  \"rule\": %s,\n  \"keep_rate\": %s", s->rule ? "true" : "false",
           s->slow ? "false" : "true");
  printf(",\n  \"bits\": %s,\n  \"keys\": [",
         !s->coarse && cdem_ratios_are_exact(&s->ratios) ? "true" : "false");
  for (int64_t i = 0; i < table->rows; i++) {
    const cdem_scaled_row *row = &table->row[i];
    printf("%s\n    {\"key\": ", i > 0 ? "," : "");
    cdem_json_text(stdout, row->key);
    printf(", \"dimension\": [%d, %d, %d], \"tag\": \"%s\", \"added\": %s", row->dimension.length,
           row->dimension.time, row->dimension.mass, tags[row->tag], row->added ? "true" : "false");
    put_number(", \"factor\": ", row->factor);
    putchar('}');
  }
  printf("\n  ]\n}\n");
}

static void report(const settings *s, const cdem_scaled_table *table) {
  bool plain = s->output == NULL || strcmp(s->output, "-") != 0;
  if (plain && s->json)
    print_json(table);
  else if (plain && !command_quiet)
    print_table(table);
  if (!table->scaling.coarse && !cdem_ratios_are_exact(&table->scaling.ratios))
    command_say("the ratios are no powers of two: the scaled run repeats the original up to "
                "rounding, not to the last bit");
}

/* gmsh can end or crash the program while it reads a mesh; the guard turns that into a message. */
static bool report_progress(void *context, const char *what, int64_t done, int64_t total) {
  const cdem_progress *progress = command_progress();
  command_guard(strcmp(what, "reading the mesh") == 0 ? context : NULL);
  return progress->report(progress->context, what, done, total);
}

int cmd_scale(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "CASE.yaml",
      "Writes the case scaled exactly: every number by its dimension, so that the run is the same "
      "but for its size, to the last bit where ratios are powers of two. With --coarse-grain the "
      "domain stays and is filled with larger grains.\v"
      "Numbers that change are written in SI; the rest of the text stays as it is. A table says "
      "the "
      "factor of each key.\n"
      "Examples:\n"
      "  cdem scale settling.yaml --h 2 -o twice.yaml\n"
      "  cdem scale biaxial.yaml --h 3 --coarse-grain -o coarse.yaml\n"
      "  cdem scale impact.yaml --length 2 --time 4 --density 1 -o slow.yaml",
      NULL,
      NULL,
      NULL};
  settings s = {.h = NAN, .length = NAN, .time = NAN, .mass = NAN, .density = NAN, .stress = NAN};
  cdem_scaled_table table = {0};
  cdem_fault fault = {0};
  command_parse(&argp, argc, argv, &s);
  check_settings(&s);
  cdem_scaling scaling = cdem_scaling_exact(base_ratios(&s));
  if (s.coarse) {
    scaling = cdem_scaling_coarse(s.h, 3); /* of which dimension, the case says */
    scaling.rule = !s.no_rule;
    scaling.slow = !s.keep_rate;
  }
  const cdem_progress progress = {(void *)(uintptr_t)s.path, report_progress};
  const cdem_warnings warnings = command_warnings();
  const cdem_scale_options options = {.path = s.path,
                                      .overrides = s.set.count,
                                      .override = s.set.text,
                                      .output = s.output,
                                      .scaling = scaling,
                                      .progress = &progress,
                                      .warnings = &warnings};
  command_catch_interrupt();
  cdem_status status = cdem_scale_case(&options, &table, &fault);
  command_progress_end();
  command_guard(NULL);
  if (status != CDEM_OK)
    return command_fail(&fault);
  report(&s, &table);
  cdem_scaled_table_release(&table);
  return 0;
}
