/* Case files: functions of time.
 *
 *     2 MPa                                                     a constant
 *     {table: [[0 s, 0 MPa], [1 ms, 2 MPa]]}
 *     {ramp: 2 MPa, over: 1 ms, from: 0 MPa, start: 0 s}
 *     {sine: 1 mm, frequency: 50 Hz, phase: 0, start: 0 s, offset: 0 mm}
 *     {pulse: 1 MPa, duration: 1 ms, start: 0 s, offset: 0 MPa}
 */
#include "io/case_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cdem_dimension seconds = {0, 1, 0}, hertz = {0, -1, 0};

/* The forms: the first key tells which. A key that ends in `!` must be there. */
enum { FORMS = 4, FORM_KEYS = 5 };
static const char *const forms[FORMS][FORM_KEYS + 1] = {
    {"table", NULL},
    {"ramp", "over!", "from", "start", NULL},
    {"sine", "frequency!", "phase", "start", "offset", NULL},
    {"pulse", "duration!", "start", "offset", NULL},
};

/* A form being read. */
typedef struct {
  cdem_case_reader *r;
  const cdem_yaml_node *map;
  const char *name;         /* of the key, for messages */
  cdem_dimension dimension; /* of its value */
  bool good;
} form_reader;

/* The number at a key of the map; `fallback` when it is not there. */
static double get(form_reader *f, const char *key, cdem_dimension dimension, double fallback) {
  const cdem_yaml_node *at = cdem_yaml_find(&f->r->yaml, f->map, key);
  double value = fallback;
  if (at != NULL && !cdem_yaml_quantity(&f->r->yaml, &f->r->units, at, key, dimension, &value))
    f->good = false;
  return value;
}

/* The same for a duration or a frequency that must be positive. */
static double get_positive(form_reader *f, const char *key, cdem_dimension dimension) {
  double value = get(f, key, dimension, 1.0);
  const cdem_yaml_node *at = cdem_yaml_find(&f->r->yaml, f->map, key);
  char unit[48];
  if (f->good && at != NULL && !(value > 0.0)) {
    cdem_yaml_error(&f->r->yaml, at, "%s is %g %s and must be above 0", key, value,
                    cdem_dimension_unit(dimension, unit));
    f->good = false;
  }
  return value;
}

static void set_table(form_reader *f, int points, const double *time, const double *value,
                      cdem_series *series) {
  cdem_status status = cdem_series_table(points, time, value, series, f->r->fault);
  if (status != CDEM_OK)
    f->r->status = status;
  f->good = f->good && status == CDEM_OK;
}

/* One pair [time, value]. */
static void read_point(form_reader *f, const cdem_yaml_node *at, double *time, double *value) {
  cdem_case_reader *r = f->r;
  const cdem_yaml_node *first = cdem_yaml_child(&r->yaml, at);
  if (at->kind != CDEM_YAML_LIST || at->children != 2) {
    cdem_yaml_error(&r->yaml, at, "a point of a table must be a pair [time, value]");
    f->good = false;
    return;
  }
  f->good = cdem_yaml_quantity(&r->yaml, &r->units, first, "time", seconds, time) && f->good;
  f->good = cdem_yaml_quantity(&r->yaml, &r->units, cdem_yaml_next(&r->yaml, first), f->name,
                               f->dimension, value) &&
            f->good;
}

static void read_table(form_reader *f, cdem_series *series) {
  cdem_case_reader *r = f->r;
  const cdem_yaml_node *at = cdem_yaml_find(&r->yaml, f->map, "table");
  if (at->kind != CDEM_YAML_LIST || at->children == 0) {
    cdem_yaml_error(&r->yaml, at, "'table' must be a list of pairs [time, value]");
    f->good = false;
    return;
  }
  double *time = cdem_allocate(at->children, sizeof *time, r->fault);
  double *value = cdem_allocate(at->children, sizeof *value, r->fault);
  if (time == NULL || value == NULL)
    r->status = CDEM_MEMORY;
  int i = 0;
  for (const cdem_yaml_node *c = cdem_yaml_child(&r->yaml, at); c != NULL && r->status == CDEM_OK;
       c = cdem_yaml_next(&r->yaml, c), i++) {
    read_point(f, c, &time[i], &value[i]);
    if (f->good && i > 0 && !(time[i] > time[i - 1])) {
      cdem_yaml_error(&r->yaml, c,
                      "the times of a table must ascend: %g s does not come after %g s", time[i],
                      time[i - 1]);
      f->good = false;
    }
  }
  if (f->good && r->status == CDEM_OK)
    set_table(f, i, time, value, series);
  free(time);
  free(value);
}

static void read_ramp(form_reader *f, cdem_series *series) {
  double start = get(f, "start", seconds, 0.0);
  const double time[2] = {start, start + get_positive(f, "over", seconds)};
  const double value[2] = {get(f, "from", f->dimension, 0.0), get(f, "ramp", f->dimension, 0.0)};
  if (f->good && !(time[1] > start)) {
    cdem_yaml_error(&f->r->yaml, f->map, "the ramp over %g s cannot be told from a jump at %g s",
                    time[1] - start, start);
    f->good = false;
  }
  if (f->good)
    set_table(f, 2, time, value, series);
}

static void read_wave(form_reader *f, bool sine, cdem_series *series) {
  cdem_series made = {.kind = sine ? CDEM_SERIES_SINE : CDEM_SERIES_PULSE};
  made.amplitude = get(f, sine ? "sine" : "pulse", f->dimension, 0.0);
  made.offset = get(f, "offset", f->dimension, 0.0);
  made.start = get(f, "start", seconds, 0.0);
  if (sine) {
    made.frequency = get_positive(f, "frequency", hertz);
    made.phase = get(f, "phase", CDEM_DIMENSIONLESS, 0.0);
  } else {
    made.duration = get_positive(f, "duration", seconds);
  }
  if (f->good)
    *series = made;
}

/* Which form a map is, -1 after an error. */
static int find_form(form_reader *f) {
  int form = -1;
  for (int i = 0; i < FORMS; i++) {
    const cdem_yaml_node *at = cdem_yaml_find(&f->r->yaml, f->map, forms[i][0]);
    if (at != NULL && form >= 0) {
      cdem_yaml_error(&f->r->yaml, at, "'%s' and '%s' cannot both be given", forms[form][0],
                      forms[i][0]);
      return -1;
    }
    form = at != NULL ? i : form;
  }
  if (form < 0)
    cdem_yaml_error(&f->r->yaml, f->map,
                    "'%s' must be a number, or a map with one of table, ramp, sine, pulse",
                    f->name);
  return form;
}

/* No unknown keys, none missing. */
static void check_keys(form_reader *f, const char *const *key) {
  const char *known[FORM_KEYS];
  char plain[FORM_KEYS][16];
  int count = 0;
  for (; key[count] != NULL; count++) {
    size_t length = strcspn(key[count], "!");
    snprintf(plain[count], sizeof plain[count], "%.*s", (int)length, key[count]);
    known[count] = plain[count];
    if (key[count][length] == '!' && cdem_yaml_find(&f->r->yaml, f->map, plain[count]) == NULL) {
      cdem_yaml_error(&f->r->yaml, f->map, "'%s' needs '%s' beside it", key[0], plain[count]);
      f->good = false;
    }
  }
  CDEM_YAML_EACH(&f->r->yaml, f->map, name, value) {
    int k = 0;
    while (k < count && (name->kind != CDEM_YAML_SCALAR || strcmp(name->text, known[k]) != 0))
      k++;
    if (k == count && name->kind == CDEM_YAML_SCALAR) {
      cdem_yaml_unknown(&f->r->yaml, name, "key", known, count);
      f->good = false;
    }
    (void)value;
  }
}

bool cdem_case_series(cdem_case_reader *r, const cdem_yaml_node *at, const char *name,
                      cdem_dimension dimension, cdem_series *series) {
  form_reader f = {r, at, name, dimension, true};
  if (at->kind == CDEM_YAML_SCALAR) {
    const double time = 0.0;
    double value;
    if (!cdem_yaml_quantity(&r->yaml, &r->units, at, name, dimension, &value))
      return false;
    set_table(&f, 1, &time, &value, series);
    return f.good;
  }
  if (at->kind != CDEM_YAML_MAP) {
    cdem_yaml_error(&r->yaml, at,
                    "'%s' must be a number, or a map with one of table, ramp, sine, pulse, not %s",
                    name, cdem_yaml_kind_name(at->kind));
    return false;
  }
  int form = find_form(&f);
  if (form < 0)
    return false;
  check_keys(&f, forms[form]);
  if (form == 0)
    read_table(&f, series);
  else if (form == 1)
    read_ramp(&f, series);
  else
    read_wave(&f, form == 2, series);
  return f.good;
}

void cdem_case_components_read(cdem_case_reader *r, const cdem_yaml_node *at,
                               const cdem_case_key *key, cdem_case_components *components) {
  static const char *const names[4] = {"x", "y", "z", "rotation"};
  int count = key->rotates ? 4 : 3;
  if (at->kind != CDEM_YAML_MAP || at->children == 0) {
    cdem_yaml_error(&r->yaml, at, "'%s' must be a map of %s, such as %s", key->key,
                    key->rotates ? "x, y, z, rotation" : "x, y, z", key->example);
    return;
  }
  CDEM_YAML_EACH(&r->yaml, at, name, value) {
    int c = 0;
    while (c < count && (name->kind != CDEM_YAML_SCALAR || strcmp(name->text, names[c]) != 0))
      c++;
    if (c == count && name->kind == CDEM_YAML_SCALAR)
      cdem_yaml_unknown(&r->yaml, name, "component", names, count);
    if (c == count || components->given[c])
      continue; /* a component given twice is an error already */
    size_t before = cdem_case_enter(r, "%s", names[c]);
    cdem_case_note(r, value->kind == CDEM_YAML_SCALAR ? value : name);
    if (r->status == CDEM_OK)
      components->given[c] = cdem_case_series(
          r, value, names[c], c == 3 ? key->rotation : key->dimension, &components->component[c]);
    cdem_case_leave(r, before);
  }
}
