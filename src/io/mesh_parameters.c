#include "io/mesh_parameters.h"

#include "base/suggest.h"
#include "io/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- what a geometry declares ---- */

enum { MAX_DECLARED = 64, LONGEST_NAME = 63 };

typedef struct {
  char name[MAX_DECLARED][LONGEST_NAME + 1];
  int count;
} declarations;

static bool is_word(char c) {
  return isalnum((unsigned char)c) || c == '_';
}

/* Behind a comment or a text that begins at c; c itself when there is none. */
static const char *skip_dead(const char *c, const char *end) {
  if (end - c >= 2 && c[0] == '/' && c[1] == '/') {
    while (c < end && *c != '\n')
      c++;
  } else if (end - c >= 2 && c[0] == '/' && c[1] == '*') {
    for (c += 2; c < end && !(end - c >= 2 && c[0] == '*' && c[1] == '/');)
      c++;
    c = end - c >= 2 ? c + 2 : end;
  } else if (c < end && *c == '"') {
    for (c++; c < end && *c != '"';)
      c++;
    c = c < end ? c + 1 : end;
  }
  return c;
}

static const char *skip_blank(const char *c, const char *end) {
  for (;;) {
    const char *from = c;
    while (c < end && isspace((unsigned char)*c))
      c++;
    if (c < end && *c == '/')
      c = skip_dead(c, end);
    if (c == from)
      return c;
  }
}

/* To the ',' or ']' that ends an entry, past nested brackets. */
static const char *skip_entry(const char *c, const char *end) {
  for (int depth = 0; c < end;) {
    const char *next = skip_dead(c, end);
    if (next != c) {
      c = next;
      continue;
    }
    if (depth == 0 && (*c == ',' || *c == ']'))
      return c;
    depth += (*c == '[' || *c == '{' || *c == '(') - (*c == ']' || *c == '}' || *c == ')');
    c++;
  }
  return end;
}

/* One "name = value" of a DefineConstant; constants that hold a text are no numbers. */
static void declare(const char *c, const char *end, declarations *found) {
  const char *word = c;
  while (c < end && is_word(*c))
    c++;
  size_t length = (size_t)(c - word);
  c = skip_blank(c, end);
  if (c < end && *c == '=')
    c = skip_blank(c + 1, end);
  if (c < end && *c == '{')
    c = skip_blank(c + 1, end);
  bool text = c < end && (*c == '"' || (end - c > 4 && strncmp(c, "Str", 3) == 0));
  if (length == 0 || length > LONGEST_NAME || text || found->count == MAX_DECLARED)
    return;
  memcpy(found->name[found->count], word, length);
  found->name[found->count++][length] = '\0';
}

static void scan(const cdem_text *text, declarations *found) {
  static const char word[] = "DefineConstant";
  const char *begin = text->data, *end = text->data + text->size;
  for (const char *c = begin; c < end;) {
    const char *next = skip_dead(c, end);
    if (next != c) {
      c = next;
      continue;
    }
    if (end - c < (long)sizeof word || strncmp(c, word, sizeof word - 1) != 0 ||
        (c > begin && is_word(c[-1])) || is_word(c[sizeof word - 1])) {
      c++;
      continue;
    }
    c = skip_blank(c + sizeof word - 1, end);
    if (c == end || *c != '[')
      continue;
    do {
      c = skip_blank(c + 1, end);
      declare(c, end, found);
      c = skip_entry(c, end);
    } while (c < end && *c == ',');
  }
}

static cdem_status fail_unknown(const char *name, const declarations *found, cdem_fault *fault) {
  const char *known[MAX_DECLARED];
  char list[400] = "";
  size_t used = 0;
  for (int i = 0; i < found->count; i++) {
    known[i] = found->name[i];
    if (used + LONGEST_NAME + 8 < sizeof list)
      used +=
          (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "", known[i]);
  }
  CDEM_REQUIRE(found->count > 0, fault, CDEM_INPUT,
               "the geometry has no parameter '%s': no number is declared by DefineConstant[]",
               name);
  const char *near = cdem_suggest(name, known, found->count);
  return cdem_fail(fault, CDEM_INPUT, "the geometry has no parameter '%s'; it has: %s%s%s%s", name,
                   list, near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                   near != NULL ? "'?" : "");
}

cdem_status cdem_mesh_parameters_check(const cdem_mesh_parameters *parameters,
                                       const cdem_text *text, cdem_fault *fault) {
  declarations *found = cdem_allocate(1, sizeof *found, fault);
  if (found == NULL)
    return CDEM_MEMORY;
  scan(text, found);
  cdem_status status = CDEM_OK;
  for (int p = 0; p < parameters->count && status == CDEM_OK; p++) {
    int i = 0;
    while (i < found->count && strcmp(found->name[i], parameters->name[p]) != 0)
      i++;
    if (i == found->count)
      status = fail_unknown(parameters->name[p], found, fault);
    else if (!isfinite(parameters->value[p]))
      status = cdem_fail(fault, CDEM_INPUT, "parameter '%s' is %g and must be finite",
                         parameters->name[p], parameters->value[p]);
  }
  free(found);
  return status;
}

/* ---- the small file ---- */

static cdem_status fail_write(const char *wrapper, cdem_fault *fault) {
  return cdem_fail(
      fault, CDEM_FILE,
      "cannot write '%s', which gives gmsh the parameters: %s; free some space in /tmp", wrapper,
      strerror(errno));
}

cdem_status cdem_mesh_parameters_wrap(const cdem_mesh_parameters *parameters, const char *path,
                                      char wrapper[CDEM_WRAPPER_PATH], cdem_fault *fault) {
  char *whole = realpath(path, NULL);
  CDEM_REQUIRE(whole != NULL, fault, CDEM_FILE, "cannot open it: %s", strerror(errno));
  if (strchr(whole, '"') != NULL) {
    free(whole);
    return cdem_fail(fault, CDEM_INPUT, "gmsh cannot read a file with '\"' in its name");
  }
  snprintf(wrapper, CDEM_WRAPPER_PATH, "/tmp/cdem-mesh-XXXXXX.geo");
  int descriptor = mkstemps(wrapper, 4);
  FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
  if (file == NULL) {
    free(whole);
    cdem_status status = fail_write(wrapper, fault);
    if (descriptor >= 0) {
      close(descriptor);
      unlink(wrapper);
    }
    return status;
  }
  cdem_c_locale locale = cdem_c_locale_enter();
  for (int p = 0; p < parameters->count; p++)
    fprintf(file, "%s = %.17g;\n", parameters->name[p], parameters->value[p]);
  fprintf(file, "Merge \"%s\";\n", whole);
  cdem_c_locale_leave(locale);
  free(whole);
  bool wrong = ferror(file) != 0;
  if (fclose(file) == 0 && !wrong)
    return CDEM_OK;
  cdem_status status = fail_write(wrapper, fault);
  unlink(wrapper);
  return status;
}
