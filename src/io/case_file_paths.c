/* The files that a case names, seen from where the case was read. */
#include "cases/places.h"
#include "io/case_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *cdem_case_file_path(const cdem_case *cases, const char *file, cdem_fault *fault) {
  const char *slash = strrchr(cases->path, '/');
  size_t folder = file[0] == '/' || slash == NULL ? 0 : (size_t)(slash - cases->path) + 1;
  char *path = cdem_allocate((int64_t)(folder + strlen(file) + 1), 1, fault);
  if (path != NULL) {
    memcpy(path, cases->path, folder);
    strcpy(path + folder, file);
  }
  return path;
}

/* One file of the case: its key, and what stands there. */
typedef struct {
  char key[CDEM_CASE_PATH];
  const char *file; /* of the case's values */
  char *name;       /* from the root on, quoted; owned */
  int64_t at;       /* byte of the text at which it stands, -1: somewhere else */
} named_file;

/* The path of a file that is there, from the root on, as a YAML text in double quotes. */
static char *quoted(const char *path, cdem_fault *fault) {
  char *full = realpath(path, NULL);
  const char *from = full != NULL ? full : path;
  char *text = cdem_allocate(2 * (int64_t)strlen(from) + 3, sizeof *text, fault);
  if (text != NULL) {
    char *at = text;
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

/* Where the name stands in the text of the case, without quotes; -1 where it does not stand there
 * on one line and letter by letter. */
static int64_t find_name(const cdem_case *cases, const named_file *named) {
  const cdem_case_place *place = cdem_case_places_find(cases->places, named->key);
  const char *at = place != NULL && place->override < 0 && cases->places->overrides == 0
                       ? cdem_case_text_at(cases->source, place->line, place->column)
                       : NULL;
  if (at == NULL)
    return -1;
  at += *at == '"' || *at == '\'';
  return strncmp(at, named->file, strlen(named->file)) == 0 ? at - cases->source : -1;
}

/* Replaces the name in the text, with its quotes. */
static cdem_status edit(cdem_case *cases, const named_file *named, cdem_fault *fault) {
  const char *at = cases->source + named->at;
  size_t before = (size_t)named->at, length = strlen(named->file);
  bool quotes = before > 0 && (at[-1] == '"' || at[-1] == '\'') && at[length] == at[-1];
  const char *rest = at + length + quotes;
  before -= quotes;
  size_t room = before + strlen(named->name) + strlen(rest) + 1;
  char *text = cdem_allocate((int64_t)room, 1, fault);
  if (text == NULL)
    return CDEM_MEMORY;
  memcpy(text, cases->source, before);
  strcpy(text + before, named->name);
  strcat(text + before, rest);
  free(cases->source);
  cases->source = text;
  return CDEM_OK;
}

/* From the last in the text to the first, so that places stay true. */
static int by_place(const void *a, const void *b) {
  int64_t x = ((const named_file *)a)->at, y = ((const named_file *)b)->at;
  return (x < y) - (x > y);
}

/* The case read again with one override more a file: comments are gone. */
static cdem_status rewrite(cdem_case *cases, int overrides, const char *const *override,
                           const named_file *named, int64_t files, cdem_fault *fault) {
  cdem_case again = {0};
  const char **all = cdem_allocate(overrides + files, sizeof *all, fault);
  char **own = cdem_allocate(files, sizeof *own, fault);
  cdem_status status = all != NULL && own != NULL ? CDEM_OK : CDEM_MEMORY;
  for (int i = 0; status == CDEM_OK && i < overrides; i++)
    all[i] = override[i];
  for (int64_t f = 0; status == CDEM_OK && f < files; f++) {
    size_t room = strlen(named[f].key) + strlen(named[f].name) + 2;
    own[f] = cdem_allocate((int64_t)room, 1, fault);
    if (own[f] == NULL)
      status = CDEM_MEMORY;
    else
      snprintf(own[f], room, "%s=%s", named[f].key, named[f].name);
    all[overrides + f] = own[f];
  }
  if (status == CDEM_OK)
    status = cdem_read_case(cases->path, overrides + (int)files, all, &again, fault);
  if (status == CDEM_OK) {
    char *old = cases->source;
    cases->source = again.source;
    again.source = old;
  }
  cdem_case_release(&again);
  for (int64_t f = 0; own != NULL && f < files; f++)
    free(own[f]);
  free(own);
  free(all);
  return status;
}

/* A file that is named from the case's folder on joins the list. */
static cdem_status join(const cdem_case *cases, const char *file, named_file *named, int64_t *files,
                        cdem_fault *fault) {
  if (file == NULL || file[0] == '/')
    return CDEM_OK;
  named_file *new = &named[*files];
  char *path = cdem_case_file_path(cases, file, fault);
  if (path == NULL)
    return CDEM_MEMORY;
  new->file = file;
  new->name = quoted(path, fault);
  new->at = find_name(cases, new);
  free(path);
  *files += new->name != NULL;
  return new->name != NULL ? CDEM_OK : CDEM_MEMORY;
}

static cdem_status collect(const cdem_case *cases, named_file *named, int64_t *files,
                           cdem_fault *fault) {
  const cdem_case_values *values = &cases->values;
  strcpy(named[*files].key, "mesh.file");
  CDEM_TRY(join(cases, values->mesh.file, named, files, fault));
  strcpy(named[*files].key, "grains.file");
  CDEM_TRY(join(cases, values->grains.file, named, files, fault));
  for (int64_t w = 0; w < values->walls.count; w++) {
    snprintf(named[*files].key, CDEM_CASE_PATH, "walls.%s.file", values->walls.item[w].name);
    CDEM_TRY(join(cases, values->walls.item[w].file, named, files, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_case_settle_files(cdem_case *cases, int overrides, const char *const *override,
                                   cdem_fault *fault) {
  int64_t files = 0;
  named_file *named = cdem_allocate(cases->values.walls.count + 3, sizeof *named, fault);
  if (named == NULL)
    return CDEM_MEMORY;
  cdem_status status = collect(cases, named, &files, fault);
  bool there = true;
  for (int64_t f = 0; f < files; f++)
    there = there && named[f].at >= 0;
  qsort(named, (size_t)files, sizeof *named, by_place);
  for (int64_t f = 0; status == CDEM_OK && there && f < files; f++)
    status = edit(cases, &named[f], fault);
  if (status == CDEM_OK && !there)
    status = rewrite(cases, overrides, override, named, files, fault);
  for (int64_t f = 0; f < files; f++)
    free(named[f].name);
  free(named);
  return status;
}
