/* The schema as text: help, JSON Schema, reference page; and what every line of the tables owes.
 * `test_cases_text --schema` and `--reference` print them; the latter makes docs/reference/case.md.
 */
#include "cases/support.h"

#include <ctype.h>

/* What a writer writes, newly allocated. */
typedef cdem_status (*writer)(FILE *stream, cdem_fault *fault);

static char *text_of(writer write) {
  cdem_fault fault = {0};
  char *text = NULL;
  size_t bytes;
  FILE *stream = open_memstream(&text, &bytes);
  check_ok(write(stream, &fault));
  fclose(stream);
  return text;
}

static char *help_on(const char *topic) {
  cdem_fault fault = {0};
  char *text = NULL;
  size_t bytes;
  FILE *stream = open_memstream(&text, &bytes);
  check_ok(cdem_write_case_help(stream, topic, &fault));
  fclose(stream);
  return text;
}

static void check_holds(const char *text, const char *part) {
  if (strstr(text, part) == NULL)
    fail_msg("'%s' is not in\n%s", part, text);
}

/* ---- the tables ---- */

static bool has_dimension(cdem_dimension d) {
  return d.length != 0 || d.time != 0 || d.mass != 0;
}

/* What is not a quantity is not scaled; everything with a dimension is, and says with what. */
static void check_line(void *context, const char *path, const cdem_case_key *key) {
  int *lines = context;
  (*lines)++;
  bool number = key->kind == CDEM_KEY_NUMBER || key->kind == CDEM_KEY_VECTOR ||
                key->kind == CDEM_KEY_SERIES || key->kind == CDEM_KEY_COMPONENTS;
  if (key->help == NULL || key->example == NULL || *key->help == '\0' || *key->example == '\0')
    fail_msg("%s has no help or no example", path);
  bool counts = key->kind == CDEM_KEY_INTEGER && key->tag == CDEM_TAG_GRAIN; /* grains */
  if (((number && has_dimension(key->dimension)) || counts) != (key->tag != CDEM_TAG_NONE))
    fail_msg("%s has a dimension without a tag or a tag without one", path);
  if (key->kind == CDEM_KEY_NUMBER && isnan(key->fallback) && !key->required &&
      key->otherwise == NULL)
    fail_msg("%s does not say what holds without it", path);
  if (key->kind == CDEM_KEY_VECTOR && !(key->fewest >= 1 && key->fewest <= key->length))
    fail_msg("%s: %d to %d numbers", path, key->fewest, key->length);
  if ((key->section != NULL) !=
      (key->kind == CDEM_KEY_SECTION || key->kind == CDEM_KEY_LIST || key->kind == CDEM_KEY_NAMED))
    fail_msg("%s: section and kind do not fit", path);
  if ((key->choice != NULL) != (key->kind == CDEM_KEY_CHOICE))
    fail_msg("%s: choices and kind do not fit", path);
}

static void every_line_is_complete(void **state) {
  (void)state;
  int lines = 0;
  cdem_case_walk(check_line, &lines);
  assert_true(lines > 250);
}

/* Sections that only a run of grains has, each beside what the others need. */
static const char *const grain_sections[][2] = {
    {"grains", "grains: {dimension: 2, packing: {kind: square, high: [1, 1], radius: 0.1}, "
               "materials: {glass: {density: 1}, steel: {density: 1}, rock: {density: 1}}}\n"},
    {"contacts", "contacts: [{friction: 0}]\n"},
    {"walls", ""},
    {"bonds", ""},
    {"cell", ""}};
enum { GRAIN_SECTIONS = sizeof grain_sections / sizeof *grain_sections };

static bool is_of_grains(const char *path) {
  for (int i = 0; i < GRAIN_SECTIONS; i++) {
    size_t length = strlen(grain_sections[i][0]);
    if (strncmp(path, grain_sections[i][0], length) == 0 && strchr(".[", path[length]) != NULL)
      return true;
  }
  return false;
}

static void check_example_of_grains(const cdem_case_key *key) {
  char text[2000] = "end: 1\n";
  for (int i = 0; i < GRAIN_SECTIONS; i++)
    if (strcmp(grain_sections[i][0], key->key) != 0)
      strcat(text, grain_sections[i][1]);
  snprintf(text + strlen(text), sizeof text - strlen(text), "%s: %s\n", key->key, key->example);
  cdem_fault fault = {0};
  cdem_case read = {0};
  if (read_text(text, &read, &fault) != CDEM_OK)
    fail_msg("%s\n%s", text, fault.message);
  cdem_case_release(&read);
}

/* A specimen has no end of its own, and its packing is a cylinder. */
static void check_example_of_a_specimen(const cdem_case_key *key) {
  char text[2000];
  snprintf(text, sizeof text,
           "grains: {dimension: 3, packing: {kind: loose, cylinder: yes, high: [1, 1, 1], radius: "
           "0.1, fraction: 0.3}, materials: {rock: {density: 1}}}\n"
           "contacts: [{friction: 0}]\n"
           "%s: %s\n",
           key->key, key->example);
  cdem_fault fault = {0};
  cdem_case read = {0};
  if (read_text(text, &read, &fault) != CDEM_OK)
    fail_msg("%s\n%s", text, fault.message);
  cdem_case_release(&read);
}

/* The examples are read by the reader itself: those at the top each in a case of its own. */
static void examples_can_be_read(void **state) {
  (void)state;
  const cdem_case_section *root = cdem_case_root();
  static const struct {
    const char *key, *rest; /* what a case needs beside it */
  } beside[] = {{"analysis", ""},
                {"interfaces", "blocks: {breakable: a}\n"},
                {"tolerance", "analysis: relaxation\n"},
                {"most_steps", "analysis: relaxation\n"},
                {"stop_when", "stop_below: 0.5\n"},
                {"stop_below", "stop_when: a\n"},
                {"triaxial",
                 "grains: {dimension: 3, packing: {kind: loose, cylinder: yes, high: "
                 "[1, 1, 1], radius: 0.1, count: 5}, materials: {glass: {density: 1}}}\n"
                 "contacts: [{friction: 0}]\n"},
                {"coupling", "grains: {dimension: 2, packing: {kind: square, high: [1, 1], radius: "
                             "0.1}, materials: {glass: {density: 1}}}\n"
                             "contacts: [{friction: 0}]\n"}};
  for (int k = 0; k < root->keys; k++) {
    const cdem_case_key *key = &root->key[k];
    char text[2000] = "";
    if (is_of_grains(key->key)) {
      check_example_of_grains(key);
      continue;
    }
    if (strcmp(key->key, "triaxial") == 0) {
      check_example_of_a_specimen(key);
      continue;
    }
    static const char *const needed[][2] = {
        {"end", "end: 1\n"},
        {"mesh", "mesh: a\n"},
        {"materials", "materials: {r: {young: 1, poisson: 0, density: 1}}\n"}};
    for (int i = 0; strcmp(key->key, "triaxial") != 0 && i < 3; i++)
      if (strcmp(key->key, needed[i][0]) != 0)
        strcat(text, needed[i][1]);
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++)
      if (strcmp(key->key, beside[i].key) == 0)
        strcat(text, beside[i].rest);
    snprintf(text + strlen(text), sizeof text - strlen(text), "%s: %s\n", key->key, key->example);
    cdem_fault fault = {0};
    cdem_case read = {0};
    if (read_text(text, &read, &fault) != CDEM_OK)
      fail_msg("%s\n%s", text, fault.message);
    cdem_case_release(&read);
  }
}

/* The others by a case file of their section: an error may only be one of joined keys. */
static void check_example(void *context, const char *path, const cdem_case_key *key) {
  (void)context;
  static const char *const joined[] = {"needs",     "not both",    "cannot",
                                       "belongs",   "meaning",     "must be at most",
                                       "has no",    "is a degree", "has the components",
                                       "is used by"};
  char plain[CDEM_CASE_PATH], override[600];
  const char *name = strstr(path, ".NAME."), *list = strstr(path, "[].");
  if (strchr(path, '.') == NULL || strncmp(path, "materials", 9) == 0)
    return;
  if (name != NULL)
    snprintf(plain, sizeof plain, "%.*s.n.%s", (int)(name - path), path, name + 6);
  else if (list != NULL)
    snprintf(plain, sizeof plain, "%.*s[0].%s", (int)(list - path), path, list + 3);
  else
    snprintf(plain, sizeof plain, "%s", path);
  snprintf(override, sizeof override, "%s=%s", plain, key->example);
  char empty[CDEM_CASE_PATH] = "title=a"; /* the list must be there */
  if (list != NULL)
    snprintf(empty, sizeof empty, "%.*s=[]", (int)(list - path), path);
  const char *const overrides[] = {empty, override};
  cdem_fault fault = {0};
  cdem_case read = {0};
  char text[600] = ROCK "blocks: {breakable: a}\n";
  if (is_of_grains(path))
    snprintf(text, sizeof text, "end: 1\n%s%s",
             strncmp(path, "grains", 6) == 0 ? "" : grain_sections[0][1],
             strncmp(path, "contacts", 8) == 0 ? "" : grain_sections[1][1]);
  cdem_status status = read_with(text, 2, overrides, &read, &fault);
  bool known = status == CDEM_OK;
  for (size_t i = 0; i < sizeof joined / sizeof *joined; i++)
    known = known || strstr(fault.message, joined[i]) != NULL;
  if (!known)
    fail_msg("%s\n%s", override, fault.message);
  cdem_case_release(&read);
}

static void examples_of_sections_can_be_read(void **state) {
  (void)state;
  cdem_case_walk(check_example, NULL);
}

/* ---- help ---- */

static void help_on_all_and_one(void **state) {
  (void)state;
  char *text = help_on(NULL), *same = help_on("case");
  assert_string_equal(text, same);
  check_holds(text, "\ninterfaces: list of maps\n");
  check_holds(text, "\n  tension           Pa                 at least 0           0\n");
  check_holds(text, "orthotropic: e1 e2 e3 nu12");
  free(text);
  free(same);
  text = help_on("interfaces.tension");
  assert_string_equal(text, "  interfaces.tension\n      Tensile strength.\n"
                            "      number, Pa; at least 0; default: 0\n"
                            "      Example: tension: 1 MPa\n");
  static const char *const same_key[] = {"interfaces[3].tension", "interfaces[].tension"};
  for (int i = 0; i < 2; i++) {
    same = help_on(same_key[i]);
    assert_string_equal(text, same);
    free(same);
  }
  free(text);
  text = help_on("tension"); /* of two sections */
  check_holds(text, "interfaces.tension");
  check_holds(text, "bonds.tension");
  free(text);
  text = help_on("grains.packing.kind");
  check_holds(text, "grains.packing.kind");
  free(text);
  text = help_on("rolling_length"); /* a word of dem/law_keys.def */
  check_holds(text, "contacts.rolling_length");
  free(text);
  text = help_on("friction"); /* of several sections */
  check_holds(text, "interfaces.friction");
  check_holds(text, "contact.friction");
  check_holds(text, "plates.friction");
  free(text);
  text = help_on("supports");
  check_holds(text, "supports.group");
  check_holds(text, "Functions of time:\n");
  free(text);
  text = help_on("materials.NAME.young");
  check_holds(text, "Young's modulus");
  free(text);
}

static void help_on_nothing(void **state) {
  (void)state;
  cdem_fault fault = {0};
  char *text = NULL;
  size_t bytes;
  FILE *stream = open_memstream(&text, &bytes);
  check_fails(cdem_write_case_help(stream, "interfaces.tensoin", &fault), CDEM_USAGE,
              "a case has no key 'interfaces.tensoin'; did you mean 'interfaces.tension'?");
  check_fails(cdem_write_case_help(stream, "tensoin", &fault), CDEM_USAGE,
              "did you mean 'tension'?");
  check_fails(cdem_write_case_help(stream, "qqqqqq", &fault), CDEM_USAGE,
              "a case has no key 'qqqqqq'; `cdem help case` lists all");
  fclose(stream);
  assert_int_equal(bytes, 0);
  free(text);
}

static void a_full_disk(void **state) {
  (void)state;
  cdem_fault fault = {0};
  FILE *full = fopen("/dev/full", "w");
  if (full == NULL)
    skip();
  setvbuf(full, NULL, _IONBF, 0);
  check_fails(cdem_write_case_help(full, NULL, &fault), CDEM_FILE, "is the disk full?");
  check_fails(cdem_write_case_schema(full, &fault), CDEM_FILE, "is the disk full?");
  check_fails(cdem_write_case_reference(full, &fault), CDEM_FILE, "is the disk full?");
  fclose(full);
}

static void lack_of_memory(void **state) {
  (void)state;
  for (int after = 0; after < 3; after++) {
    char *text = NULL;
    size_t bytes;
    FILE *stream = open_memstream(&text, &bytes);
    cdem_memory_fail_after(after);
    assert_int_equal(cdem_write_case_help(stream, NULL, NULL), CDEM_MEMORY);
    cdem_memory_fail_after(after);
    assert_int_equal(cdem_write_case_reference(stream, NULL), CDEM_MEMORY);
    cdem_memory_fail_after(-1);
    fclose(stream);
    assert_int_equal(bytes, 0);
    free(text);
  }
}

/* ---- JSON ---- */

static const char *skip_space(const char *c) {
  while (isspace((unsigned char)*c))
    c++;
  return c;
}

/* Behind one JSON value (RFC 8259); NULL when it is none. */
static const char *skip_json(const char *c) {
  c = skip_space(c);
  if (*c == '{' || *c == '[') {
    char end = *c == '{' ? '}' : ']';
    c = skip_space(c + 1);
    if (*c == end)
      return c + 1;
    for (;; c++) {
      if (end == '}') {
        c = skip_space(c);
        if (*c != '"' || (c = skip_json(c)) == NULL || *(c = skip_space(c)) != ':')
          return NULL;
        c++;
      }
      if ((c = skip_json(c)) == NULL)
        return NULL;
      c = skip_space(c);
      if (*c == end)
        return c + 1;
      if (*c != ',')
        return NULL;
    }
  }
  if (*c == '"') {
    for (c++; *c != '"'; c++) {
      if (*c == '\\' && strchr("\"\\/bfnrtu", c[1]) == NULL)
        return NULL;
      if (*c == '\0' || (unsigned char)*c < 0x20)
        return NULL;
      c += *c == '\\';
    }
    return c + 1;
  }
  static const char *const words[] = {"true", "false", "null"};
  for (int i = 0; i < 3; i++)
    if (strncmp(c, words[i], strlen(words[i])) == 0)
      return c + strlen(words[i]);
  char *end;
  strtod(c, &end);
  return end != c && (isdigit((unsigned char)*c) || *c == '-') ? end : NULL;
}

static void the_schema_is_json(void **state) {
  (void)state;
  char *text = text_of(cdem_write_case_schema);
  const char *end = skip_json(text);
  assert_non_null(end);
  assert_string_equal(end, "\n");
  check_holds(text, "https://json-schema.org/draft/2020-12/schema");
  check_holds(text, "\"tension\": {\"description\": \"Tensile strength.\", \"$ref\": "
                    "\"#/$defs/quantity\", \"minimum\": 0}");
  free(text);
}

/* ---- the page ---- */

static void check_up_to_date(writer write, const char *name, const char *option) {
  char path[512], *text = text_of(write), *page = NULL;
  size_t room = 0;
  snprintf(path, sizeof path, "%s/../docs/reference/%s", CDEM_DATA, name);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  ssize_t got = getdelim(&page, &room, '\0', file);
  fclose(file);
  assert_true(got > 0);
  if (strcmp(text, page) != 0)
    fail_msg("docs/reference/%s is old: `cdem help case %s` writes the new one", name, option);
  free(text);
  free(page);
}

static void the_pages_are_up_to_date(void **state) {
  (void)state;
  check_up_to_date(cdem_write_case_reference, "case.md", "--markdown");
  check_up_to_date(cdem_write_case_schema, "case.schema.json", "--schema");
}

int main(int arguments, char **argument) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_line_is_complete),
      cmocka_unit_test(examples_can_be_read),
      cmocka_unit_test(examples_of_sections_can_be_read),
      cmocka_unit_test(help_on_all_and_one),
      cmocka_unit_test(help_on_nothing),
      cmocka_unit_test(a_full_disk),
      cmocka_unit_test(lack_of_memory),
      cmocka_unit_test(the_schema_is_json),
      cmocka_unit_test(the_pages_are_up_to_date),
  };
  if (arguments == 2 && strcmp(argument[1], "--schema") == 0)
    return (int)cdem_write_case_schema(stdout, NULL);
  if (arguments == 2 && strcmp(argument[1], "--reference") == 0)
    return (int)cdem_write_case_reference(stdout, NULL);
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
