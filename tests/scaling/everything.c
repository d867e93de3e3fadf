/* A case that gives every key of the tables, made from them: what has a dimension scales, whichever
 * key was added last. */
#include "cases/places.h"
#include "io/case_file.h"
#include "io/case_read.h"
#include "io/case_text.h"
#include "scaling/scaling.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the case, from the tables ---- */

static void put_section(FILE *out, const cdem_case_section *section, int indent);

static void put_moduli(FILE *out, const cdem_material_model_info *info, int indent) {
  for (int k = 0; k < info->keys; k++)
    fprintf(out, "%*s%s: %d\n", indent, "", info->key[k].key, k + 2);
  fprintf(out, "%*smodel: %s\n", indent, "", info->name);
}

/* One entry a model, so that all moduli occur. */
static void put_materials(FILE *out, const cdem_case_section *section, int indent) {
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++) {
    fprintf(out, "%*sm%d:\n", indent, "", m);
    put_section(out, section, indent + 2);
    put_moduli(out, cdem_material_model_get((cdem_material_model)m), indent + 2);
  }
}

static bool has_material(const cdem_case_section *section) {
  for (int k = 0; k < section->keys; k++)
    if (section->key[k].kind == CDEM_KEY_MATERIAL)
      return true;
  return false;
}

static void put_key(FILE *out, const cdem_case_key *key, int indent) {
  if (key->kind == CDEM_KEY_MATERIAL)
    return;
  fprintf(out, "%*s%s:", indent, "", key->key);
  if (key->section == NULL) {
    bool quoted = key->kind == CDEM_KEY_TEXT;
    fprintf(out, quoted ? " \"%s\"\n" : " %s\n", key->example);
    return;
  }
  fputc('\n', out);
  if (key->kind == CDEM_KEY_NAMED && has_material(key->section)) {
    put_materials(out, key->section, indent + 2);
  } else if (key->kind == CDEM_KEY_SECTION) {
    put_section(out, key->section, indent + 2);
  } else {
    if (key->kind == CDEM_KEY_NAMED)
      fprintf(out, "%*sentry:\n", indent + 2, "");
    else
      fprintf(out, "%*s-\n", indent + 2, "");
    put_section(out, key->section, indent + 4);
  }
}

static void put_section(FILE *out, const cdem_case_section *section, int indent) {
  for (int k = 0; k < section->keys; k++)
    put_key(out, &section->key[k], indent);
}

static void read_everything(cdem_case *read) {
  cdem_fault fault = {0};
  char *text = NULL;
  size_t bytes;
  FILE *out = open_memstream(&text, &bytes);
  put_section(out, cdem_case_root(), 0);
  fclose(out);
  if (cdem_case_read_unchecked("everything", text, read, &fault) != CDEM_OK)
    fail_msg("%s\n%s", text, fault.message);
  free(text);
}

/* ---- scaling it ---- */

/* Key results of forces. */
static const char *newtons(void *context, const char *column) {
  (void)context, (void)column;
  return "N";
}
static const cdem_scaling_columns columns = {NULL, newtons};

static void scale(const cdem_case *from, cdem_scaling scaling, cdem_case *to) {
  cdem_fault fault = {0};
  cdem_scaled_list list = {0};
  cdem_case_change *change;
  int64_t changes = 0;
  char *text = NULL;
  check_ok(cdem_scaling_apply(from, &scaling, &columns, &list, &fault));
  change = calloc((size_t)list.count, sizeof *change);
  for (int64_t i = 0; i < list.count; i++)
    if (list.item[i].factor != 1.0)
      change[changes++] = (cdem_case_change){.quantity = list.item[i].quantity,
                                             .section = list.item[i].section,
                                             .key = list.item[i].key,
                                             .value = list.item[i].value};
  check_ok(cdem_case_rewrite(from, NULL, changes, change, &text, &fault));
  if (cdem_case_read_unchecked("scaled", text, to, &fault) != CDEM_OK)
    fail_msg("%s\n%s", text, fault.message);
  free(text);
  free(change);
  cdem_scaled_list_release(&list);
}

typedef struct {
  const cdem_case *one, *other;
  const cdem_ratios *ratios;
  int dimensions;
} walking;

static bool none(cdem_dimension d) {
  return d.length == 0 && d.time == 0 && d.mass == 0;
}

/* The key stands in the case, and all of its numbers were multiplied by its own ratio (those of
 * time in functions of time by that of time). */
static void check_key(void *context, const char *path, const cdem_case_key *key) {
  walking *w = context;
  char plain[CDEM_CASE_PATH], own[CDEM_CASE_PATH];
  bool number = key->kind == CDEM_KEY_NUMBER || key->kind == CDEM_KEY_VECTOR ||
                key->kind == CDEM_KEY_SERIES || key->kind == CDEM_KEY_COMPONENTS;
  int found = 0;
  if (!number || none(key->dimension))
    return;
  w->dimensions++;
  cdem_case_plain_path(path, plain);
  for (int64_t i = 0; i < w->one->places->quantities; i++) {
    const cdem_case_quantity *a = &w->one->places->quantity[i], *b = &w->other->places->quantity[i];
    /* entries are called "entry" and "m0" here, which the table calls NAME */
    char *at, *out = own;
    for (at = a->key; *at != '\0'; at++) {
      if (strncmp(at, ".entry", 6) == 0)
        at += 6;
      else if (at[0] == '.' && at[1] == 'm' && at[2] >= '0' && at[2] <= '9')
        at += 3;
      else if (*at == '[')
        at = strchr(at, ']') + 1;
      if (*at == '\0')
        break;
      *out++ = *at;
    }
    *out = '\0';
    if (strcmp(own, plain) != 0)
      continue;
    bool direct = memcmp(&a->dimension, &key->dimension, sizeof a->dimension) == 0;
    double factor = cdem_ratio(w->ratios, direct ? key->dimension : a->dimension);
    found += direct;
    if (b->value != a->value * factor)
      fail_msg("%s: %.17g became %.17g in place of %.17g", path, a->value, b->value,
               a->value * factor);
  }
  if (found == 0)
    fail_msg("%s has a dimension and no number of it was noted", path);
}

static void every_key_with_a_dimension_is_scaled(void **state) {
  (void)state;
  static const cdem_ratios ratios[] = {{2.0, 2.0, 8.0}, {4.0, 2.0, 32.0}, {3.0, 5.0, 7.0}};
  for (int r = 0; r < 3; r++) {
    cdem_case one = {0}, other = {0};
    read_everything(&one);
    scale(&one, cdem_scaling_exact(ratios[r]), &other);
    assert_int_equal(one.places->quantities, other.places->quantities);
    walking w = {&one, &other, &ratios[r], 0};
    cdem_case_walk(check_key, &w);
    assert_true(w.dimensions > 120);
    for (int64_t i = 0; i < one.places->quantities; i++) { /* the rest stays, key results apart */
      const cdem_case_quantity *a = &one.places->quantity[i], *b = &other.places->quantity[i];
      assert_string_equal(a->key, b->key);
      bool result = strncmp(a->key, "results.", 8) == 0;
      if (none(a->dimension) && !result && a->value != b->value)
        fail_msg("%s is a ratio and became %.17g", a->key, b->value);
    }
    double force = cdem_ratio(&ratios[r], CDEM_FORCE);
    assert_true(other.values.results.item[0].reference == 157.1e3 * force);
    cdem_case_release(&one);
    cdem_case_release(&other);
  }
}

static void there_and_back_are_the_same_bits(void **state) {
  (void)state;
  static const double sizes[] = {2.0, 0.25, 1024.0};
  for (int s = 0; s < 3; s++) {
    cdem_case one = {0}, there = {0}, back = {0};
    read_everything(&one);
    scale(&one, cdem_scaling_exact(cdem_ratios_of_size(sizes[s])), &there);
    scale(&there, cdem_scaling_exact(cdem_ratios_of_size(1.0 / sizes[s])), &back);
    assert_int_equal(one.places->quantities, back.places->quantities);
    for (int64_t i = 0; i < one.places->quantities; i++)
      if (one.places->quantity[i].value != back.places->quantity[i].value)
        fail_msg("%s: %.17g came back as %.17g", one.places->quantity[i].key,
                 one.places->quantity[i].value, back.places->quantity[i].value);
    cdem_case_release(&one);
    cdem_case_release(&there);
    cdem_case_release(&back);
  }
}

/* ---- defaults and refusals ---- */

static void read_case(const char *text, cdem_case *read) {
  cdem_fault fault = {0};
  check_ok(cdem_read_case_text("case.yaml", text, read, &fault));
}

static char *scaled_text(const char *text, cdem_scaling scaling) {
  cdem_fault fault = {0};
  cdem_case read = {0};
  cdem_scaled_list list = {0};
  cdem_case_change change[200];
  int64_t changes = 0;
  char *made = NULL;
  read_case(text, &read);
  check_ok(cdem_scaling_apply(&read, &scaling, NULL, &list, &fault));
  for (int64_t i = 0; i < list.count; i++)
    if (list.item[i].factor != 1.0)
      change[changes++] = (cdem_case_change){.quantity = list.item[i].quantity,
                                             .section = list.item[i].section,
                                             .key = list.item[i].key,
                                             .value = list.item[i].value};
  check_ok(cdem_case_rewrite(&read, "", changes, change, &made, &fault));
  cdem_scaled_list_release(&list);
  cdem_case_release(&read);
  return made;
}

#define ROCK "materials: {rock: {young: 30 GPa, poisson: 0.2, density: 2700 kg/m3}}\n"

/* Defaults with a dimension are written, wherever their section begins; comments stay. */
static void defaults_are_written(void **state) {
  (void)state;
  static const char *const pair[][2] = {
      {"# a plate\nend: 1 ms # soon\nmesh: plate.geo\n" ROCK,
       "# a plate\nthickness: 2\nend: 0.002 # soon\nmesh: {file: plate.geo, unit: 2}\n" ROCK},
      {"end: 1\nmesh:\n  # in mm\n  file: 'a plate.geo'\n  parameters: {h: 2}\n" ROCK,
       "thickness: 2\nend: 2\nmesh:\n  # in mm\n  unit: 2\n  file: 'a plate.geo'\n  parameters: "
       "{h: "
       "2}\n" ROCK},
      {"thickness: 50 mm\nend: 1\nmesh: { file: a.msh, unit: 1 mm }\n" ROCK,
       "thickness: 0.10000000000000001\nend: 2\nmesh: { file: a.msh, unit: 0.002 }\n" ROCK},
      {"end: 1\nmesh: {shape: quad4, count: [2, 2], size: [1 m, \"50 cm\"]}\n" ROCK,
       "thickness: 2\nend: 2\nmesh: {shape: quad4, count: [2, 2], size: [2, 1]}\n" ROCK},
      {"\xef\xbb\xbf"
       "end: 1\nmesh: { # of {mm}\n  file: a.msh}\n" ROCK,
       "thickness: 2\nend: 2\nmesh: { # of {mm}\n  unit: 2, file: a.msh}\n" ROCK},
  };
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
    char *text = scaled_text(pair[i][0], cdem_scaling_exact(cdem_ratios_of_size(2.0)));
    assert_string_equal(text, pair[i][1]);
    free(text);
  }
}

#define SAND                                                                                       \
  "end: 1\ngravity: [0, 0, -10]\ngrains:\n  dimension: 3\n  packing: {kind: loose, high: [1, 1, "  \
  "1], radius: 0.1, count: 80}\n  materials: {sand: {density: 2600}}\ncontacts: "                  \
  "[{normal_stiffness: 1e6, rolling_length: 0.01, friction: 0.5}]\nwalls: {floor: {shape: plane, " \
  "normal: [0, 0, 1], velocity: {z: 4}}}\n"

static void grains_grow_in_their_domain(void **state) {
  (void)state;
  cdem_scaling scaling = cdem_scaling_coarse(2.0, 3);
  char *text = scaled_text(SAND, scaling);
  assert_string_equal(
      text, "end: 2\ngravity: [0, 0, -10]\ngrains:\n  dimension: 3\n  packing: {kind: loose, high: "
            "[1, 1, 1], radius: 0.20000000000000001, count: 10}\n  materials: {sand: {density: "
            "2600}}\ncontacts: [{normal_stiffness: 2000000, rolling_length: 0.02, friction: "
            "0.5}]\nwalls: {floor: {shape: plane, normal: [0, 0, 1], velocity: {z: 2}}}\n");
  free(text);
  scaling.rule = scaling.slow = false;
  text = scaled_text(SAND, scaling);
  assert_string_equal(
      text, "end: 1\ngravity: [0, 0, -10]\ngrains:\n  dimension: 3\n  packing: {kind: loose, high: "
            "[1, 1, 1], radius: 0.20000000000000001, count: 10}\n  materials: {sand: {density: "
            "2600}}\ncontacts: [{normal_stiffness: 1e6, rolling_length: 0.01, friction: "
            "0.5}]\nwalls: {floor: {shape: plane, normal: [0, 0, 1], velocity: {z: 4}}}\n");
  free(text);
}

static void check_refused(const char *text, cdem_scaling scaling, const cdem_scaling_columns *of,
                          const char *message) {
  cdem_fault fault = {0};
  cdem_case read = {0};
  cdem_scaled_list list = {0};
  read_case(text, &read);
  check_fails(cdem_scaling_apply(&read, &scaling, of, &list, &fault), CDEM_INPUT, message);
  assert_null(list.item);
  cdem_case_release(&read);
}

/* Columns of which the name is the unit. */
static const char *unit_is_name(void *context, const char *column) {
  (void)context;
  return column;
}

/* The new value of a number of a result: `section` and `key`, or where it was not given `added`. */
static double scaled_number(const cdem_scaled_list *list, const char *section, const char *key) {
  char path[CDEM_CASE_PATH];
  snprintf(path, sizeof path, "%s.%s", section, key);
  for (int64_t i = 0; i < list->count; i++) {
    const cdem_scaled *item = &list->item[i];
    if (item->added == NULL ? strcmp(item->key, path) == 0
                            : strcmp(item->section, section) == 0 && strcmp(item->added, key) == 0)
      return item->value;
  }
  return NAN;
}

/* What is expected of a result has the dimension of its column, of where it is looked for, or of a
 * quotient of columns; a factor that was one is written when it is no longer. */
static void results_scale_by_what_they_are_of(void **state) {
  (void)state;
  cdem_fault fault = {0};
  cdem_case read = {0};
  cdem_scaled_list list = {0};
  const cdem_scaling_columns units = {NULL, unit_is_name};
  const cdem_scaling scaling = cdem_scaling_exact((cdem_ratios){2.0, 4.0, 64.0});
  read_case("end: 1\nmesh: a.msh\n" ROCK "results:\n"
            "  peak: {of: N, take: max, reference: 3}\n"
            "  slope: {of: N, take: slope, reference: 3}\n"
            "  when: {of: N, take: place_of_max, reference: 3}\n"
            "  where: {of: N, take: place_of_min, along: m, reference: 3}\n"
            "  ratio: {of: N, against: kg}\n"
            "  given: {of: N, against: [m, m], against_factor: 3}\n"
            "  same: {of: N, against: N}\n",
            &read);
  check_ok(cdem_scaling_apply(&read, &scaling, &units, &list, &fault));
  assert_true(scaled_number(&list, "results.peak", "reference") == 3.0 * 64 * 2 / 16);
  assert_true(scaled_number(&list, "results.slope", "reference") == 3.0 * 64 * 2 / 64);
  assert_true(scaled_number(&list, "results.when", "reference") == 3.0 * 4);
  assert_true(scaled_number(&list, "results.where", "reference") == 3.0 * 2);
  assert_true(scaled_number(&list, "results.ratio", "against_factor") == 8.0 / 64);
  assert_true(scaled_number(&list, "results.given", "against_factor") == 3.0 * 8 / 2);
  assert_true(isnan(scaled_number(&list, "results.same", "against_factor")));
  cdem_scaled_list_release(&list);
  cdem_case_release(&read);
}

#define TRIAXIAL                                                                                   \
  "grains:\n  dimension: 3\n  packing: {kind: loose, cylinder: yes, high: [1, 1, 1], radius: "     \
  "0.1, count: 80}\n  materials: {sand: {density: 2600}}\ncontacts: [{normal_stiffness: 1e6}]\n"   \
  "triaxial: {pressure: 1, "

static const char *strange_unit(void *context, const char *column) {
  (void)context;
  return strcmp(column, "odd") == 0 ? "furlong" : strcmp(column, "mass") == 0 ? "kg" : "N";
}

static void what_cannot_scale_is_refused(void **state) {
  (void)state;
  const cdem_scaling twice = cdem_scaling_exact(cdem_ratios_of_size(2.0));
  const cdem_scaling_columns odd = {NULL, strange_unit};
  check_refused("end: 1\nmesh: a.msh\n" ROCK, cdem_scaling_coarse(2.0, 2), NULL,
                "this case has no size of grains");
  check_refused(SAND, cdem_scaling_coarse(8.0, 3), NULL,
                "80 grains cannot be coarse-grained by 8: 0.156 would be left");
  check_refused(SAND, cdem_scaling_coarse(1e-3, 3), NULL,
                "80 grains would become 8e+10 by h = 0.001; at most 2147483646 can be had");
  cdem_scaling quick = cdem_scaling_coarse(2.0, 3);
  quick.slow = false;
  check_refused(TRIAXIAL "rate: 1}\n", quick, NULL, "follow from the size of its grains; give it");
  check_refused(TRIAXIAL "consolidation: 1}\n", quick, NULL, "follow from the size of its grains");
  free(scaled_text(TRIAXIAL "rate: 1, consolidation: 1}\n", quick));
  check_refused("end: 1\ngrains: {dimension: 2, file: g.csv, materials: {s: {density: "
                "1}}}\ncontacts: [{friction: 0}]\n",
                cdem_scaling_coarse(2.0, 2), NULL, "case.yaml:2:30: grains of a file cannot be");
  check_refused("analysis: relaxation\nmesh: a.msh\n" ROCK
                "supports: [{group: g, displacement: {y: {ramp: 1, over: 5}}}]\n",
                twice, NULL, "case.yaml:4:23: a relaxation of a body counts its steps as seconds");
  check_refused("end: 1e300\nmesh: a.msh\n" ROCK, cdem_scaling_exact((cdem_ratios){1.0, 1e9, 1.0}),
                NULL, "case.yaml:1:6:");
  check_refused("end: 1\nmesh: a.msh\n" ROCK "results: {r: {of: odd, reference: 1}}\n", twice, &odd,
                "has the unit 'furlong', whose dimension is not known");
  check_refused("end: 1\nmesh: a.msh\n" ROCK "results: {r: {of: mass, against: [mass, force]}}\n",
                twice, &odd, "have different dimensions");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_key_with_a_dimension_is_scaled),
      cmocka_unit_test(there_and_back_are_the_same_bits),
      cmocka_unit_test(defaults_are_written),
      cmocka_unit_test(grains_grow_in_their_domain),
      cmocka_unit_test(results_scale_by_what_they_are_of),
      cmocka_unit_test(what_cannot_scale_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
