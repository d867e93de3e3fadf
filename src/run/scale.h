/* A case file scaled: exact scaling and coarse graining of room scaling, from file to file.
 *
 * The scaled case is the original's text with other numbers: comments and order stay; numbers that
 * change are written in SI with 17 digits, and keys whose default has a dimension are added. It is
 * read back, and every number of it must have exactly the value that was meant, before the file
 * gets its name. Files that the case names are found from the new place, too; a table of grains
 * is scaled into a copy beside the case (NAME-grains.csv).
 */
#ifndef CDEM_RUN_SCALE_H
#define CDEM_RUN_SCALE_H

#include "base/base.h"
#include "io/io.h"
#include "scaling/scaling.h"

typedef struct {
  const char *path; /* of the case */
  int overrides;
  const char *const *override;
  const char *output;   /* the scaled case; "-": standard output; NULL: nothing is written */
  cdem_scaling scaling; /* `dim` is found from the case */
  const cdem_progress *progress;
  const cdem_warnings *warnings;
} cdem_scale_options;

/* One line of what was scaled: all numbers of one key, whichever entry of a list they stand in. */
typedef struct {
  char key[CDEM_CASE_PATH]; /* "contacts.normal_stiffness" */
  cdem_dimension dimension;
  cdem_scale_tag tag;
  bool counts, added; /* added: its default, which was not given */
  double factor;
} cdem_scaled_row;

typedef struct {
  cdem_scaling scaling; /* as applied */
  int64_t rows;
  cdem_scaled_row *row; /* [rows] numbers with a dimension and those that change */
} cdem_scaled_table;

/* Builds the model of the case where key results need the units of its columns. After a failure no
 * file is there under the new name. */
cdem_status cdem_scale_case(const cdem_scale_options *options, cdem_scaled_table *table,
                            cdem_fault *fault);
void cdem_scaled_table_release(cdem_scaled_table *table);

#endif
