/* Reading a run: its case, summary, history and pictures, and what lies in its folder. */
#include "report/source.h"

#include "io/case_file.h"
#include "run/axis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_PATH = 3800 }; /* leaves room for the names in a folder */

static const char *path_in(char text[4200], const char *folder, const char *name) {
  snprintf(text, 4200, "%.3900s%s%.250s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/",
           name);
  return text;
}

static bool ends_in(const char *name, const char *ending) {
  size_t length = strlen(name), end = strlen(ending);
  return length > end && strcmp(name + length - end, ending) == 0;
}

/* ---- is it a run? ---- */

static cdem_status check_folder(const char *folder, cdem_fault *fault) {
  struct stat facts;
  CDEM_REQUIRE(strlen(folder) <= MOST_PATH && folder[0] != '\0', fault, CDEM_INPUT,
               "the name of a run's folder has 1 to %d letters", MOST_PATH);
  CDEM_REQUIRE(stat(folder, &facts) == 0, fault, CDEM_INPUT,
               "there is no folder '%s'; name the folder of a run", folder);
  CDEM_REQUIRE(S_ISDIR(facts.st_mode), fault, CDEM_INPUT,
               "'%s' is a file; name the folder of a run, which holds its case.yaml", folder);
  return CDEM_OK;
}

static cdem_status check_files(const char *folder, const cdem_listing *listing, cdem_fault *fault) {
  static const char *const own[] = {"summary.json", "history.csv", "checkpoint.h5"};
  bool any = false;
  for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
    any = any || cdem_listing_find(listing, own[i]) != NULL;
  CDEM_REQUIRE(any, fault, CDEM_INPUT,
               "'%s' is no folder of a run: there is neither summary.json nor history.csv nor "
               "checkpoint.h5; name one that `cdem run` has written",
               folder);
  CDEM_REQUIRE(cdem_listing_find(listing, "case.yaml") != NULL, fault, CDEM_INPUT,
               "the run in '%s' lacks its case.yaml, which says what was run; put it back or run "
               "the case again",
               folder);
  return CDEM_OK;
}

/* ---- names ---- */

static cdem_status set_names(cdem_report_source *source, const char *page, cdem_fault *fault) {
  const char *folder = source->options->folder;
  source->place = cdem_copy_text(folder, fault);
  if (source->place == NULL)
    return CDEM_MEMORY;
  for (size_t length = strlen(folder); length > 1 && source->place[length - 1] == '/';)
    source->place[--length] = '\0';
  const char *slash = strrchr(source->place, '/');
  source->name =
      cdem_copy_text(slash != NULL && slash[1] != '\0' ? slash + 1 : source->place, fault);
  if (source->name == NULL)
    return CDEM_MEMORY;
  return cdem_relative_path(strcmp(page, "-") == 0 ? "./page" : page, folder, &source->way, fault);
}

/* ---- pictures ---- */

bool cdem_report_has_columns(const cdem_report_source *source, const cdem_case_curve *curve) {
  bool there = source->history.rows >= 2 &&
               cdem_run_history_find(&source->history, curve->x != NULL ? curve->x : "time") >= 0;
  for (int64_t y = 0; y < curve->y.count; y++)
    there = there && cdem_run_history_find(&source->history, curve->y.item[y]) >= 0;
  return there;
}

static bool draws(const cdem_report_source *source, const char *name) {
  const cdem_case_values *values = &source->cases.values;
  if (strcmp(name, "energies") == 0)
    return cdem_report_has_balances(source);
  for (int64_t i = 0; i < values->curves.count; i++)
    if (strcmp(values->curves.item[i].name, name) == 0)
      return cdem_report_has_columns(source, &values->curves.item[i]);
  return false;
}

/* The smaller of NAME.png and NAME.svg is taken: lines are short as SVG, thousands of polygons as
 * PNG. */
static const cdem_listed *other_kind(const cdem_listing *figures, const char *name, size_t stem) {
  for (int64_t i = 0; i < figures->count; i++) {
    const char *found = figures->item[i].name;
    if (strncmp(found, name, stem) == 0 && strcmp(found, name) != 0 &&
        (strcmp(found + stem, ".png") == 0 || strcmp(found + stem, ".svg") == 0))
      return &figures->item[i];
  }
  return NULL;
}

static cdem_status add_picture(cdem_report_source *source, const cdem_listed *file, int64_t *inside,
                               cdem_fault *fault) {
  char path[4200], name[300];
  cdem_report_picture *picture = &source->picture[source->pictures++]; /* zeroed */
  snprintf(name, sizeof name, "figures/%.255s", file->name);
  picture->file = cdem_copy_text(name, fault);
  picture->name = cdem_copy_text(file->name, fault);
  if (picture->file == NULL || picture->name == NULL)
    return CDEM_MEMORY;
  picture->name[strlen(file->name) - 4] = '\0';
  picture->type = ends_in(file->name, ".png") ? "image/png" : "image/svg+xml";
  picture->bytes = file->bytes;
  if (file->bytes > CDEM_REPORT_PICTURE_MOST || *inside + file->bytes > CDEM_REPORT_PICTURES_MOST)
    return CDEM_OK;
  snprintf(name, sizeof name, "%s", picture->file);
  CDEM_TRY(cdem_read_bytes(path_in(path, source->options->folder, name), &picture->data,
                           &picture->bytes, fault));
  *inside += picture->bytes;
  return CDEM_OK;
}

static cdem_status read_pictures(cdem_report_source *source, cdem_fault *fault) {
  const cdem_listing *figures = &source->figures;
  char path[4200];
  int64_t inside = 0;
  if (cdem_listing_find(&source->listing, "figures") == NULL)
    return CDEM_OK;
  CDEM_TRY(
      cdem_list_folder(path_in(path, source->options->folder, "figures"), &source->figures, fault));
  CDEM_NEW(source->picture, figures->count, fault);
  for (int64_t i = 0; i < figures->count; i++) {
    const cdem_listed *file = &figures->item[i], *other;
    if (file->folder || (!ends_in(file->name, ".png") && !ends_in(file->name, ".svg")))
      continue;
    size_t stem = strlen(file->name) - 4;
    char name[300];
    snprintf(name, sizeof name, "%.*s", (int)stem, file->name);
    other = other_kind(figures, file->name, stem);
    bool smaller = other == NULL || file->bytes < other->bytes ||
                   (file->bytes == other->bytes && ends_in(file->name, ".png"));
    if (smaller && !draws(source, name))
      CDEM_TRY(add_picture(source, file, &inside, fault));
  }
  return CDEM_OK;
}

/* ---- frames ---- */

/* SET.pvd with what lies in SET/. */
static cdem_status add_set(cdem_report_source *source, const cdem_listed *pvd, cdem_fault *fault) {
  char path[4200], folder[300];
  cdem_listing frames = {0};
  CDEM_TRY(
      cdem_grow(&source->set, &source->set_capacity, source->sets + 1, sizeof *source->set, fault));
  cdem_report_set *set = &source->set[source->sets++];
  *set = (cdem_report_set){.file = cdem_copy_text(pvd->name, fault), .bytes = pvd->bytes};
  if (set->file == NULL)
    return CDEM_MEMORY;
  snprintf(folder, sizeof folder, "%.*s", (int)strlen(pvd->name) - 4, pvd->name);
  const cdem_listed *beside = cdem_listing_find(&source->listing, folder);
  if (beside == NULL || !beside->folder)
    return CDEM_OK;
  CDEM_TRY(cdem_list_folder(path_in(path, source->options->folder, folder), &frames, fault));
  for (int64_t i = 0; i < frames.count; i++) {
    set->frames++;
    set->bytes += frames.item[i].bytes;
  }
  cdem_listing_release(&frames);
  return CDEM_OK;
}

static cdem_status look_at_sets(cdem_report_source *source, cdem_fault *fault) {
  for (int64_t i = 0; i < source->listing.count; i++)
    if (ends_in(source->listing.item[i].name, ".pvd"))
      CDEM_TRY(add_set(source, &source->listing.item[i], fault));
  return CDEM_OK;
}

/* ---- the whole ---- */

static cdem_status read_texts(cdem_report_source *source, cdem_fault *fault) {
  const char *folder = source->options->folder;
  char path[4200];
  CDEM_TRY(cdem_read_case(path_in(path, folder, "case.yaml"), 0, NULL, &source->cases, fault));
  if (cdem_listing_find(&source->listing, "summary.json") != NULL) {
    CDEM_TRY(cdem_read_summary(path_in(path, folder, "summary.json"), &source->summary, fault));
    source->finished = true;
  }
  bool there = cdem_listing_find(&source->listing, "history.csv") != NULL;
  CDEM_REQUIRE(there || !source->finished, fault, CDEM_FILE,
               "the run in '%s' has ended, but its history.csv is gone; run its case again",
               folder);
  if (there)
    CDEM_TRY(cdem_read_history(path_in(path, folder, "history.csv"), &source->history, fault));
  return CDEM_OK;
}

cdem_status cdem_report_source_read(const cdem_report_options *options, const char *page,
                                    cdem_report_source *source, cdem_fault *fault) {
  *source = (cdem_report_source){.options = options};
  CDEM_TRY(check_folder(options->folder, fault));
  CDEM_TRY(cdem_list_folder(options->folder, &source->listing, fault));
  CDEM_TRY(check_files(options->folder, &source->listing, fault));
  CDEM_TRY(set_names(source, page, fault));
  source->process = cdem_folder_holder(options->folder);
  CDEM_TRY(read_texts(source, fault));
  CDEM_TRY(read_pictures(source, fault));
  return look_at_sets(source, fault);
}

void cdem_report_source_release(cdem_report_source *source) {
  for (int i = 0; i < source->pictures; i++) {
    free(source->picture[i].name);
    free(source->picture[i].file);
    free(source->picture[i].data);
  }
  for (int64_t i = 0; i < source->sets; i++)
    free(source->set[i].file);
  free(source->picture);
  free(source->set);
  free(source->way);
  free(source->place);
  free(source->name);
  cdem_case_release(&source->cases);
  cdem_summary_file_release(&source->summary);
  cdem_table_release(&source->history);
  cdem_listing_release(&source->listing);
  cdem_listing_release(&source->figures);
  *source = (cdem_report_source){0};
}

double *cdem_report_column(const cdem_report_source *source, int column, double scale,
                           cdem_report_text *to) {
  double *values = NULL;
  if (to->status == CDEM_OK)
    to->status = cdem_run_column_values(&source->history, column, scale, &values, to->fault);
  return values;
}
