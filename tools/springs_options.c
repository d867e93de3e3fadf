#include "springs_options.h"

#include "base/suggest.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
  OPTION_NU = 256,
  OPTION_MATERIAL,
  OPTION_COSSERAT_MODULUS,
  OPTION_CHARACTERISTIC_LENGTH,
  OPTION_COUPLE_FACTOR,
  OPTION_LENGTH,
  OPTION_PLANE,
  OPTION_THICKNESS,
  OPTION_GROUP,
  OPTION_FORMAT,
  OPTION_CARRY,
  OPTION_CLASS,
  OPTION_FORM,
  OPTION_FRAME,
  OPTION_ORDER,
  OPTION_CERTIFY,
  OPTION_MODE_ROWS,
  OPTION_WITHOUT,
  OPTION_JSON,
  OPTION_FIGURES,
  OPTION_THREADS,
};

static const struct argp_option option_table[] = {
    {NULL, 0, NULL, 0, "Material:", 1},
    {"young", 'E', "YOUNG", 0, "Young's modulus, Pa or with a unit (\"40 GPa\")", 1},
    {"nu", OPTION_NU, "POISSON", 0, "Poisson's ratio", 1},
    {"material", OPTION_MATERIAL, "FILE", 0,
     "material file (YAML): any model, a material per group", 1},
    {"cosserat-modulus", OPTION_COSSERAT_MODULUS, "GC", 0,
     "makes -E, --nu a Cosserat material: coupling modulus Gc", 1},
    {"characteristic-length", OPTION_CHARACTERISTIC_LENGTH, "L", 0, "its characteristic length", 1},
    {"couple-factor", OPTION_COUPLE_FACTOR, "F", 0,
     "couple modulus = F G L^2 (default 1, as Li & Wan print it)", 1},
    {"length", OPTION_LENGTH, "L", 0,
     "length that scales rotations (default: the size of the elements)", 1},
    {NULL, 0, NULL, 0, "Body:", 2},
    {"plane", OPTION_PLANE, "strain|stress", 0, "2-D bodies (default strain)", 2},
    {"thickness", OPTION_THICKNESS, "T", 0, "2-D bodies (default 1 m)", 2},
    {"group", OPTION_GROUP, "NAME", 0, "convert this group only (may be repeated)", 2},
    {"order", OPTION_ORDER, "DEGREE", 0,
     "quadrature exact to this degree (default: each element's full rule)", 2},
    {NULL, 0, NULL, 0, "Output:", 3},
    {"output", 'o', "FILE", 0,
     "write the springs; the ending chooses the kind, see `cdem list formats` (may be repeated)",
     3},
    {"format", OPTION_FORMAT, "KIND", 0,
     "kind of output, whatever the ending; `-o -` is standard output, csv unless this says "
     "otherwise",
     3},
    {"carry", OPTION_CARRY, "all|exact|central", 0,
     "lammps, yade: as much of each pair as the program can (default), an error unless that is "
     "everything, or only the springs along the lines",
     3},
    {"class", OPTION_CLASS, "NAME[,NAME]", 0, "write only edge, face, body springs", 3},
    {"form", OPTION_FORM, "NAME[,NAME]", 0,
     "write only diagonal, jordan2, jordan3, complex, frame sets", 3},
    {"frame", OPTION_FRAME, "body|all|none", 0,
     "where transversely isotropic pairs become four springs (default body)", 3},
    {"figures", OPTION_FIGURES, "FOLDER", 0,
     "draw the distributions of stiffness, direction and skewness by class", 3},
    {NULL, 0, NULL, 0, "Proof:", 4},
    {"certify", OPTION_CERTIFY, NULL, 0, "print the certificate; exit code 1 when a bound fails",
     4},
    {"mode-rows", OPTION_MODE_ROWS, "N", 0,
     "count zero modes up to this many matrix rows (default 30000)", 4},
    {"without", OPTION_WITHOUT, "SPEC", 0,
     "is the network safe without some springs? SPEC is key=value,...: element=TAG, "
     "pair=NODE-NODE, class=NAME, form=NAME, "
     "spring=NUMBER (may be repeated); exit code 1 when it is not",
     4},
    {"json", OPTION_JSON, NULL, 0, "print the summary as JSON", 4},
    {NULL, 0, NULL, 0, "Run:", 5},
    {"threads", OPTION_THREADS, "N", 0,
     "number of threads (default: all; the result does not depend on it)", 5},
    {"quiet", 'q', NULL, 0, "no talk and no progress on stderr", 5},
    {0},
};

/* ---- option values ---- */

static void add_text(const char **list, int *count, int most, const char *option,
                     const char *text) {
  if (*count == most)
    command_usage("%s may be given %d times at most", option, most);
  list[(*count)++] = text;
}

static int class_of(const char *name) {
  cdem_class found = cdem_class_find(name);
  if (found == CDEM_CLASS_COUNT)
    command_usage("there is no class '%s'; classes are edge, face and body", name);
  return (int)found;
}

static int form_of(const char *name) {
  cdem_form found = cdem_form_find(name);
  if (found == CDEM_FORM_COUNT)
    command_usage("there is no form '%s'; forms are diagonal, jordan2, jordan3, complex and frame",
                  name);
  return (int)found;
}

static unsigned mask_of(const char *option, const char *text, int (*find)(const char *)) {
  unsigned mask = 0;
  if (*text == '\0')
    command_usage("%s: a name is wanted", option);
  while (*text != '\0') {
    char name[32];
    size_t length = strcspn(text, ",");
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    mask |= 1u << find(name);
    text += length + (text[length] == ',');
  }
  return mask;
}

static cdem_frame_rule frame_of(const char *text) {
  if (strcmp(text, "body") == 0)
    return CDEM_FRAME_BODY;
  if (strcmp(text, "all") == 0)
    return CDEM_FRAME_ALL;
  if (strcmp(text, "none") != 0)
    command_usage("--frame %s: body, all or none is wanted", text);
  return CDEM_FRAME_NONE;
}

static cdem_carry carry_of(const char *text) {
  static const char *const names[] = {"all", "exact", "central"};
  for (int i = 0; i < 3; i++)
    if (strcmp(text, names[i]) == 0)
      return (cdem_carry)i;
  command_usage("--carry %s: all, exact or central is wanted", text);
}

static cdem_plane plane_of(const char *text) {
  if (strcmp(text, "strain") != 0 && strcmp(text, "stress") != 0)
    command_usage("--plane %s: strain or stress is wanted", text);
  return strcmp(text, "stress") == 0 ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN;
}

static int64_t tag_of(const char *text, const char *spec, char **end) {
  int64_t tag = strtoll(text, end, 10);
  if (*end == text || tag <= 0)
    command_usage("--without %s: '%s' is no tag", spec, text);
  return tag;
}

static void set_condition(cdem_removal *removal, const char *key, const char *value,
                          const char *spec) {
  static const char *const keys[] = {"element", "pair", "class", "form", "spring"};
  char *end = (char *)"";
  if (strcmp(key, "element") == 0) {
    removal->element = tag_of(value, spec, &end);
  } else if (strcmp(key, "pair") == 0) {
    removal->node[0] = tag_of(value, spec, &end);
    if (*end != '-')
      command_usage("--without %s: a pair is NODE-NODE, for example pair=7-17", spec);
    removal->node[1] = tag_of(end + 1, spec, &end);
  } else if (strcmp(key, "class") == 0) {
    removal->class_ = class_of(value);
  } else if (strcmp(key, "form") == 0) {
    removal->form = form_of(value);
  } else if (strcmp(key, "spring") == 0) {
    removal->spring = (int)command_integer("--without spring", value, 1, 4);
  } else {
    const char *nearest = cdem_suggest(key, keys, 5);
    command_usage(
        "--without %s: there is no key '%s'%s%s%s; keys are element, pair, class, form and spring",
        spec, key, nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
        nearest != NULL ? "'?" : "");
  }
  if (*end != '\0')
    command_usage("--without %s: '%s' is left over", spec, end);
}

static cdem_removal removal_of(const char *spec) {
  cdem_removal removal = {.text = spec, .class_ = -1, .form = -1};
  for (const char *at = spec;;) {
    char part[64], *value;
    size_t length = strcspn(at, ",");
    snprintf(part, sizeof part, "%.*s", (int)length, at);
    value = strchr(part, '=');
    if (value == NULL)
      command_usage("--without %s: '%s' is not key=value", spec, part);
    *value++ = '\0';
    set_condition(&removal, part, value, spec);
    if (at[length] == '\0')
      return removal;
    at += length + 1;
  }
}

static bool parse_material(springs_settings *s, int key, const char *text) {
  switch (key) {
  case 'E':
    s->material.parameter[0] = command_quantity("-E", text, CDEM_PRESSURE);
    s->young = true;
    return true;
  case OPTION_NU:
    s->material.parameter[1] = command_number("--nu", text);
    s->nu = true;
    return true;
  case OPTION_COSSERAT_MODULUS:
    s->material.parameter[2] = command_quantity("--cosserat-modulus", text, CDEM_PRESSURE);
    s->cosserat_modulus = true;
    return true;
  case OPTION_CHARACTERISTIC_LENGTH:
    s->material.parameter[3] = command_quantity("--characteristic-length", text, CDEM_LENGTH);
    s->characteristic_length = true;
    return true;
  case OPTION_COUPLE_FACTOR:
    s->material.parameter[4] = command_number("--couple-factor", text);
    s->couple_factor = true;
    return true;
  case OPTION_MATERIAL:
    s->material_file = text;
    return true;
  }
  return false;
}

static bool parse_body(springs_settings *s, int key, const char *text) {
  switch (key) {
  case OPTION_LENGTH:
    s->length = command_quantity("--length", text, CDEM_LENGTH);
    if (!(s->length > 0.0))
      command_usage("--length %s: a length above 0 is wanted", text);
    return true;
  case OPTION_PLANE:
    s->section.plane = plane_of(text);
    s->plane = true;
    return true;
  case OPTION_THICKNESS:
    s->section.thickness = command_quantity("--thickness", text, CDEM_LENGTH);
    s->thickness = true;
    return true;
  case OPTION_GROUP:
    add_text(s->group, &s->groups, MOST_GROUPS, "--group", text);
    return true;
  case OPTION_ORDER:
    s->degree = (int)command_integer("--order", text, 1, 15);
    return true;
  }
  return false;
}

static bool parse_proof(springs_settings *s, int key, const char *text) {
  switch (key) {
  case OPTION_CERTIFY:
    s->certify = true;
    return true;
  case OPTION_MODE_ROWS:
    s->mode_rows = command_integer("--mode-rows", text, 0, INT32_MAX);
    return true;
  case OPTION_WITHOUT:
    if (s->removals == MOST_REMOVALS)
      command_usage("--without may be given %d times at most", MOST_REMOVALS);
    s->removal[s->removals++] = removal_of(text);
    return true;
  case OPTION_JSON:
    s->json = true;
    return true;
  case OPTION_THREADS:
    s->convert.threads = (int)command_integer("--threads", text, 1, 4096);
    return true;
  case 'q':
    command_quiet = true;
    return true;
  }
  return false;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  springs_settings *s = state->input;
  if (parse_material(s, key, text) || parse_body(s, key, text) || parse_proof(s, key, text))
    return 0;
  switch (key) {
  case 'o':
    add_text(s->output, &s->outputs, MOST_OUTPUTS, "-o", text);
    return 0;
  case OPTION_FORMAT:
    s->format = text;
    return 0;
  case OPTION_CARRY:
    s->carry = carry_of(text);
    return 0;
  case OPTION_FIGURES:
    s->figures = text;
    return 0;
  case OPTION_CLASS:
    s->convert.class_mask |= mask_of("--class", text, class_of);
    return 0;
  case OPTION_FORM:
    s->convert.form_mask |= mask_of("--form", text, form_of);
    return 0;
  case OPTION_FRAME:
    s->convert.frame = frame_of(text);
    return 0;
  case ARGP_KEY_ARG:
    if (s->mesh != NULL)
      command_usage("one mesh at a time: '%s' and '%s' were given", s->mesh, text);
    s->mesh = text;
    return 0;
  case ARGP_KEY_END:
    if (s->mesh == NULL)
      command_usage("a mesh is wanted (.msh, .geo, .step or .inp)");
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

/* The material of the command line. */
static void check_material_options(springs_settings *s) {
  bool cosserat = s->cosserat_modulus || s->characteristic_length || s->couple_factor;
  if (s->material_file != NULL && (s->young || s->nu || cosserat))
    command_usage("--material and -E, --nu exclude each other: the file holds the whole material");
  if (s->material_file == NULL && !(s->young && s->nu))
    command_usage("a material is wanted: -E YOUNG --nu POISSON, or --material FILE");
  if (cosserat && !(s->cosserat_modulus && s->characteristic_length))
    command_usage("a Cosserat material needs both --cosserat-modulus and --characteristic-length");
  s->material.model = cosserat ? CDEM_COSSERAT : CDEM_ISOTROPIC;
  if (cosserat && !s->couple_factor)
    s->material.parameter[4] = 1.0;
}

const cdem_springs_format *springs_format_of(const springs_settings *s, const char *path) {
  const char *name = s->format != NULL ? s->format : strcmp(path, "-") == 0 ? "csv" : NULL;
  const cdem_springs_format *format =
      name != NULL ? cdem_springs_format_find(name) : cdem_springs_format_of(path);
  if (format != NULL)
    return format;
  char known[256] = "";
  for (int i = 0; cdem_springs_format_at(i) != NULL; i++)
    snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i > 0 ? ", " : "",
             s->format != NULL ? cdem_springs_format_at(i)->name
                               : cdem_springs_format_at(i)->endings);
  if (s->format != NULL)
    command_usage("there is no format '%s'; formats are %s", s->format, known);
  command_usage("the ending of '%s' names no format; endings are %s, or use --format", path, known);
}

/* The same file under two names, or the same stream twice? */
static bool same_file(const char *left, const char *right) {
  struct stat a, b;
  if (strcmp(left, right) == 0)
    return true;
  return stat(left, &a) == 0 && stat(right, &b) == 0 && S_ISREG(a.st_mode) &&
         a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/* No output may fall on an input or on another output. */
static void check_outputs(const springs_settings *s) {
  if (s->format != NULL && s->outputs == 0)
    command_usage("--format needs an output, -o FILE");
  if (s->format != NULL && s->outputs > 1)
    command_usage("--format goes with one output; with several, their endings choose");
  for (int i = 0; i < s->outputs; i++) {
    springs_format_of(s, s->output[i]);
    if (same_file(s->output[i], s->mesh))
      command_usage("-o %s would overwrite the mesh; choose another name", s->output[i]);
    if (s->material_file != NULL && same_file(s->output[i], s->material_file))
      command_usage("-o %s would overwrite the material file; choose another name", s->output[i]);
    for (int j = 0; j < i; j++)
      if (same_file(s->output[i], s->output[j]))
        command_usage("-o %s and -o %s are one file", s->output[j], s->output[i]);
  }
}

void springs_options_parse(int argc, char **argv, springs_settings *settings) {
  static const struct argp argp = {
      option_table,
      parse,
      "MESH",
      "Equivalent spring sets of every node pair of a mesh, with proof that they are the "
      "finite-element body.\v"
      "MESH is .msh, .geo, .step or .inp.\n"
      "Examples:\n"
      "  cdem springs block-with-hole.geo -E 40GPa --nu 0.25 -o springs.csv --certify",
      NULL,
      NULL,
      NULL};
  *settings = (springs_settings){.section = {CDEM_PLANE_STRAIN, 1.0}, .mode_rows = 30000};
  command_parse(&argp, argc, argv, settings);
  check_material_options(settings);
  check_outputs(settings);
}
