/* The schema: sections of keys as data. One section = one struct of case.h = one table in a file of
 * this room. */
#ifndef CDEM_CASES_SCHEMA_H
#define CDEM_CASES_SCHEMA_H

#include "cases/case.h"

typedef enum {
  CDEM_KEY_NUMBER,     /* double, with a unit */
  CDEM_KEY_INTEGER,    /* int64_t */
  CDEM_KEY_BOOLEAN,    /* bool */
  CDEM_KEY_TEXT,       /* char * */
  CDEM_KEY_CHOICE,     /* int */
  CDEM_KEY_VECTOR,     /* double[length]: a list of numbers with units */
  CDEM_KEY_SERIES,     /* cdem_series; `given` (offset of a bool) is set; see series forms below */
  CDEM_KEY_COMPONENTS, /* cdem_case_components: map of x y z rotation to series */
  CDEM_KEY_TEXTS,      /* cdem_case_texts: one text or a list of texts */
  CDEM_KEY_NUMBERS,    /* list of cdem_case_parameter: map of name to plain number */
  CDEM_KEY_MATERIAL,   /* cdem_material: model, axes and the keys of the model, among this section's
                          own keys */
  CDEM_KEY_SECTION,    /* a struct, map */
  CDEM_KEY_LIST,       /* CDEM_CASE_LIST of structs, list of maps */
  CDEM_KEY_NAMED       /* the same from a map of names; `char *name` is the first member */
} cdem_key_kind;

/* Does the quantity belong to the grains (stays when a domain is coarse-grained) or to the domain? */
typedef enum { CDEM_TAG_NONE, CDEM_TAG_GRAIN, CDEM_TAG_DOMAIN } cdem_scale_tag;

typedef struct cdem_case_section cdem_case_section;

typedef struct {
  const char *key;
  cdem_key_kind kind;
  size_t offset;            /* in the section's struct */
  cdem_dimension dimension; /* of numbers, vectors and series (rotations are dimensionless) */
  bool required;
  double fallback; /* of a number or integer; NaN: none */
  double least, most;            /* range; least == most: none */
  bool above;                    /* least itself is not allowed */
  int length;                    /* of a vector */
  int fewest;                    /* numbers a vector must have; the rest stay 0 */
  size_t given;                  /* of a series: offset of its bool */
  const char *const *choice;     /* ended by NULL; the first is the default */
  const cdem_case_section *section;
  cdem_scale_tag tag;
  const char *help;    /* one line */
  const char *example; /* how it is written: "40 GPa" */
} cdem_case_key;

struct cdem_case_section {
  const char *name; /* "interfaces" */
  size_t size;      /* of the struct */
  int keys;
  const cdem_case_key *key;
  const char *help;
};

/* The top of every case. */
const cdem_case_section *cdem_case_root(void);

/* Walks all sections depth first: visit(context, path, section, key) with path "materials.NAME.young". */
void cdem_case_walk(void (*visit)(void *context, const char *path, const cdem_case_key *key),
                    void *context);

/* Fills a struct with the defaults of its section. */
cdem_status cdem_case_defaults(const cdem_case_section *section, void *values, cdem_fault *fault);

/* Checks that join several keys (a mesh file or a grid, one load a load, a step for ...). Adds to
 * nothing: the first failure, with its place. */
cdem_status cdem_case_check(const cdem_case *cases, cdem_fault *fault);

#endif
