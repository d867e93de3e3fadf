/* cdem list [TOPIC]: what there is, from the tables that the program itself works from. */
#include "base/suggest.h"
#include "cases/schema.h"
#include "command.h"
#include "dem/packing.h"
#include "fdem/template.h"
#include "io/grains_scene.h"

#include <math.h>
#include <string.h>

static void list_elements(void) {
  printf("elements (kind: nodes, shape functions; full quadrature)\n");
  for (int i = 0; i < CDEM_ELEMENT_COUNT; i++) {
    const cdem_element *element = cdem_element_get((cdem_element_id)i);
    printf("  %-15s %2d nodes, %d pairs of %dx%d; %s; %s\n", element->name,
           cdem_element_nodes(element), cdem_element_pairs(element), cdem_element_dofs(element),
           cdem_element_dofs(element), element->basis, element->rule);
  }
}

static void list_materials(void) {
  printf("material models (keys of a material file; [unit], default in brackets)\n");
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++) {
    const cdem_material_model_info *model = cdem_material_model_get((cdem_material_model)m);
    printf("  %s: %s\n", model->name, model->help);
    for (int k = 0; k < model->keys; k++) {
      char unit[48];
      printf("    %-22s [%s] %s", model->key[k].key,
             cdem_dimension_unit(model->key[k].dimension, unit), model->key[k].help);
      if (model->key[k].optional)
        printf(" (%g)", model->key[k].fallback);
      printf("\n");
    }
  }
  printf("  orthotropic and anisotropic, optional: axis1, axis2 (three numbers each), the material "
         "axes 1 and 2 in "
         "the mesh\n");
}

static void list_formats(void) {
  printf("output formats of `cdem springs` (endings)\n");
  for (int i = 0; cdem_springs_format_at(i) != NULL; i++) {
    const cdem_springs_format *format = cdem_springs_format_at(i);
    printf("  %-6s %-14s %s\n", format->name, format->endings, format->help);
  }
  printf("files of grains of `cdem export`; csv and vtp also of `cdem pack` (endings)\n");
  for (int i = 0; cdem_grain_format_at(i) != NULL; i++) {
    const cdem_grain_format *format = cdem_grain_format_at(i);
    printf("  %-6s %-14s %s\n", format->name, format->endings, format->help);
  }
}

static void list_key(void *context, const char *path, const cdem_case_key *key) {
  char unit[48] = "";
  (void)context;
  if (key->dimension.length != 0 || key->dimension.time != 0 || key->dimension.mass != 0)
    cdem_dimension_unit(key->dimension, unit);
  printf("  %-36s %s%s%s%s\n", path, unit[0] != '\0' ? "[" : "", unit, unit[0] != '\0' ? "] " : "",
         key->help);
}

static void list_case(void) {
  printf(
      "keys of a case file ([unit]); `cdem help case KEY` tells default, range and an example\n");
  cdem_case_walk(list_key, NULL);
}

/* A word with its unit, what holds without it, and its help. */
static void list_want(const cdem_law_want *want) {
  const cdem_law_key_info *key = cdem_law_key_get((int)want->key);
  char unit[48], otherwise[32] = "";
  if (want->required)
    snprintf(otherwise, sizeof otherwise, "required");
  else if (!isnan(want->fallback))
    snprintf(otherwise, sizeof otherwise, "%g", want->fallback);
  printf("    %-24s [%s] %s%s%s%s\n", key->name, cdem_dimension_unit(key->dimension, unit),
         key->help, otherwise[0] != '\0' ? " (" : "", otherwise, otherwise[0] != '\0' ? ")" : "");
}

static void list_resistances(const char *what, const cdem_resistance *(*at)(int index)) {
  printf("%s (grains.%.*s)\n", what, (int)strcspn(what, " "), what);
  for (int i = 0; at(i) != NULL; i++) {
    printf("  %s: %s\n", at(i)->name, at(i)->help);
    for (int k = 0; k < at(i)->wants; k++)
      list_want(&at(i)->want[k]);
  }
}

static const char *dims_of(const bool dims[4]) {
  return dims[2] && dims[3] ? "2-D, 3-D" : dims[2] ? "2-D" : "3-D";
}

static void list_laws(void) {
  printf("contact laws of grains (grains.law), with the words they take in `contacts` ([unit], "
         "default in brackets)\n");
  for (int i = 0; cdem_law_at(i) != NULL; i++) {
    const cdem_law *law = cdem_law_at(i);
    printf("  %s (%s): %s\n", law->name, dims_of(law->dims), law->help);
    for (int k = 0; k < law->wants; k++)
      list_want(&law->want[k]);
  }
  list_resistances("rolling resistance", cdem_rolling_at);
  list_resistances("twisting resistance", cdem_twisting_at);
}

static void list_packings(void) {
  printf("packings of grains (grains.packing.kind)\n");
  for (int i = 0; cdem_packing_at(i) != NULL; i++) {
    const cdem_packing *packing = cdem_packing_at(i);
    printf("  %-10s (%s) %s\n", packing->name, dims_of(packing->dims), packing->help);
  }
}

static void list_shapes(void) {
  printf("shapes of deformable grains (grains.deformable.shape), with their refinements\n");
  for (int i = 0; cdem_grain_shape_at(i) != NULL; i++) {
    const cdem_grain_shape *shape = cdem_grain_shape_at(i);
    printf("  %-12s ", shape->name);
    if (shape->most > 0)
      printf("(%d to %d) ", shape->least, shape->most);
    printf("%s\n", shape->help);
  }
}

static void list_commands(void) {
  printf("commands\n");
  for (const command *c = commands; c->name != NULL; c++)
    printf("  %-10s %s\n", c->name, c->summary);
}

static const struct {
  const char *name;
  void (*print)(void);
} topics[] = {
    {"elements", list_elements}, {"materials", list_materials}, {"formats", list_formats},
    {"laws", list_laws},         {"packings", list_packings},   {"shapes", list_shapes},
    {"commands", list_commands}, {"case", list_case},
};

enum { TOPICS = sizeof topics / sizeof topics[0] };

static error_t parse(int key, char *text, struct argp_state *state) {
  const char **topic = state->input;
  if (key != ARGP_KEY_ARG)
    return key == ARGP_KEY_END ? 0 : ARGP_ERR_UNKNOWN;
  if (*topic != NULL)
    command_usage("one topic at a time");
  *topic = text;
  return 0;
}

int cmd_list(int argc, char **argv) {
  static const struct argp_option none[] = {{0}};
  static const struct argp argp = {none,
                                   parse,
                                   "[TOPIC]",
                                   "Lists what the program knows: elements, materials, formats, "
                                   "laws, packings, shapes, commands "
                                   "or case; without TOPIC all.",
                                   NULL,
                                   NULL,
                                   NULL};
  const char *topic = NULL, *names[TOPICS];
  command_parse(&argp, argc, argv, &topic);
  for (int i = 0; i < TOPICS; i++)
    names[i] = topics[i].name;
  bool found = false;
  for (int i = 0; i < TOPICS; i++)
    if (topic == NULL || strcmp(topic, topics[i].name) == 0) {
      printf("%s", topic == NULL && i > 0 ? "\n" : "");
      topics[i].print();
      found = true;
    }
  if (!found) {
    const char *nearest = cdem_suggest(topic, names, TOPICS);
    command_usage("there is no topic '%s'%s%s%s", topic, nearest != NULL ? "; did you mean '" : "",
                  nearest != NULL ? nearest : "", nearest != NULL ? "'?" : "");
  }
  return 0;
}
