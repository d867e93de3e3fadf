/* Case files in: YAML to a typed case, by the schema of room cases; and the schema as text. */
#ifndef CDEM_IO_CASE_FILE_H
#define CDEM_IO_CASE_FILE_H

#include "cases/case.h"
#include "cases/schema.h"

#include <stdio.h>

/* Reads a case. Overrides "section.key=value" ("interfaces[0].tension=2 MPa",
 * "materials.rock.young=40 GPa") replace or add values after reading the file and before checking;
 * errors in them name the override. CDEM_INPUT: all errors found, each with file:line:column, caret
 * and "did you mean". */
cdem_status cdem_read_case(const char *path, int overrides, const char *const *override,
                           cdem_case *read, cdem_fault *fault);

/* The same from a text that stands for the file of this path: paths in it are relative to its
 * folder, and messages name it. */
cdem_status cdem_read_case_text(const char *path, const char *text, cdem_case *read,
                                cdem_fault *fault);

/* Path of a file that the case names, which is relative to the case; newly allocated, NULL: no
 * memory. */
char *cdem_case_file_path(const cdem_case *cases, const char *file, cdem_fault *fault);
/* Makes the kept text (cases->source) name its files (mesh, grains, walls) from the root on, so
 * that a copy of the case can be run from any folder. The overrides are those the case was read
 * with. */
cdem_status cdem_case_settle_files(cdem_case *cases, int overrides, const char *const *override,
                                   cdem_fault *fault);

/* One change of the text of a case: a number of its places (quantity), the text at a key that is
 * given (key and text), or a key that is not given (section, key and value). */
typedef struct {
  int64_t quantity; /* -1: a key */
  const char *section, *key;
  const char *text; /* NULL: a number */
  double value;     /* SI */
} cdem_case_change;

/* The text of a case that was read without overrides, with these changes and everything else as it
 * stands, comments too; numbers have 17 digits. heading: lines put before it, or NULL. Newly
 * allocated. CDEM_INPUT: a number that does not stand on one line. */
cdem_status cdem_case_rewrite(const cdem_case *cases, const char *heading, int64_t changes,
                              const cdem_case_change *change, char **text, cdem_fault *fault);

/* Help on a section or key ("interfaces", "interfaces.tension"; "case" or NULL: the overview).
 * CDEM_USAGE with the nearest name when there is none. */
cdem_status cdem_write_case_help(FILE *stream, const char *topic, cdem_fault *fault);
/* JSON Schema (draft 2020-12) for editors. */
cdem_status cdem_write_case_schema(FILE *stream, cdem_fault *fault);
/* docs/reference/case.md. */
cdem_status cdem_write_case_reference(FILE *stream, cdem_fault *fault);

#endif
