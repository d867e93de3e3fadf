/* The mesh file that a case names, seen from where the case was read. */
#include "cases/places.h"
#include "io/case_file.h"

#include <stdlib.h>
#include <string.h>

char *cdem_case_mesh_path(const cdem_case *cases, cdem_fault *fault) {
  const char *file = cases->values.mesh.file, *slash = strrchr(cases->path, '/');
  size_t folder = file[0] == '/' || slash == NULL ? 0 : (size_t)(slash - cases->path) + 1;
  char *path = cdem_allocate((int64_t)(folder + strlen(file) + 1), 1, fault);
  if (path != NULL) {
    memcpy(path, cases->path, folder);
    strcpy(path + folder, file);
  }
  return path;
}

/* The path of a file that is there, from the root on, as a YAML text in double quotes. */
static char *quoted(const char *path, const char *before, cdem_fault *fault) {
  char *full = realpath(path, NULL);
  const char *from = full != NULL ? full : path;
  char *text = cdem_allocate((int64_t)(strlen(before) + 2 * strlen(from)) + 3, sizeof *text, fault);
  if (text != NULL) {
    char *at = text + strlen(strcpy(text, before));
    *at++ = '"';
    for (const char *c = from; *c != '\0'; c++) {
      if (*c == '"' || *c == '\\')
        *at++ = '\\';
      *at++ = *c;
    }
    *at++ = '"';
    *at = '\0';
  }
  free(full);
  return text;
}

/* The byte of a place; columns count characters. NULL: the text has no such place. */
static const char *find_place(const char *text, int line, int column) {
  for (; line > 1 && text != NULL; line--) {
    text = strchr(text, '\n');
    text = text != NULL ? text + 1 : NULL;
  }
  for (; column > 1 && text != NULL && *text != '\0' && *text != '\n'; column--)
    do
      text++;
    while ((*text & 0xc0) == 0x80);
  return text;
}

/* The name in the text of the case, without quotes; NULL where it does not stand there on one line
 * and letter by letter. */
static const char *find_name(const cdem_case *cases) {
  const cdem_case_place *place = cdem_case_places_find(cases->places, "mesh.file");
  const char *at = place != NULL && place->override < 0 && cases->places->overrides == 0
                       ? find_place(cases->source, place->line, place->column)
                       : NULL;
  if (at == NULL)
    return NULL;
  at += *at == '"' || *at == '\'';
  return strncmp(at, cases->values.mesh.file, strlen(cases->values.mesh.file)) == 0 ? at : NULL;
}

/* Replaces the name in the text, with its quotes. */
static cdem_status edit(cdem_case *cases, const char *at, const char *name, cdem_fault *fault) {
  size_t before = (size_t)(at - cases->source), length = strlen(cases->values.mesh.file);
  bool quotes = before > 0 && (at[-1] == '"' || at[-1] == '\'') && at[length] == at[-1];
  const char *rest = at + length + quotes;
  before -= quotes;
  size_t room = before + strlen(name) + strlen(rest) + 1;
  char *text = cdem_allocate((int64_t)room, 1, fault);
  if (text == NULL)
    return CDEM_MEMORY;
  memcpy(text, cases->source, before);
  strcpy(text + before, name);
  strcat(text + before, rest);
  free(cases->source);
  cases->source = text;
  return CDEM_OK;
}

/* The case read again with one override more: comments are gone. */
static cdem_status rewrite(cdem_case *cases, int overrides, const char *const *override,
                           const char *path, cdem_fault *fault) {
  cdem_case again = {0};
  char *last = quoted(path, "mesh.file=", fault);
  const char **all = cdem_allocate(overrides + 1, sizeof *all, fault);
  cdem_status status = last != NULL && all != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int i = 0; status == CDEM_OK && i < overrides; i++)
    all[i] = override[i];
  if (status == CDEM_OK) {
    all[overrides] = last;
    status = cdem_read_case(cases->path, overrides + 1, all, &again, fault);
  }
  if (status == CDEM_OK) {
    char *old = cases->source;
    cases->source = again.source;
    again.source = old;
  }
  cdem_case_release(&again);
  free(all);
  free(last);
  return status;
}

cdem_status cdem_case_settle_mesh(cdem_case *cases, int overrides, const char *const *override,
                                  cdem_fault *fault) {
  if (cases->values.mesh.file == NULL || cases->values.mesh.file[0] == '/')
    return CDEM_OK;
  char *path = cdem_case_mesh_path(cases, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  const char *at = find_name(cases);
  cdem_status status;
  if (at == NULL) {
    status = rewrite(cases, overrides, override, path, fault);
  } else {
    char *name = quoted(path, "", fault);
    status = name != NULL ? edit(cases, at, name, fault) : CDEM_MEMORY;
    free(name);
  }
  free(path);
  return status;
}
