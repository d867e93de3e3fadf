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

/* What happens to a quantity when a domain is filled with fewer, larger grains (coarse graining,
 * room scaling)? In exact scaling all follow their dimension. */
typedef enum {
  CDEM_TAG_NONE,  /* ratios, words */
  CDEM_TAG_GRAIN, /* of the grains: scales. An integer counts the grains of the domain: fewer of
                     larger ones */
  CDEM_TAG_LAW,   /* parameter of the grains' law or material: the same, but a length of it is no
                     size of a grain and stays where the parameter rule is not followed */
  CDEM_TAG_DOMAIN /* stays; times and speeds (s, m/s, 1/s) are slowed down to keep the inertial
                     number, see keeps_rate */
} cdem_scale_tag;

typedef struct cdem_case_section cdem_case_section;

typedef struct {
  const char *key;
  cdem_key_kind kind;
  size_t offset;            /* in the section's struct */
  cdem_dimension dimension; /* of numbers, vectors and series (rotations are dimensionless) */
  bool required;
  double fallback;           /* of a number or integer; NaN: none */
  double least, most;        /* range; least == most: none */
  bool above;                /* least itself is not allowed */
  bool below;                /* most itself is not allowed */
  int length;                /* of a vector */
  int fewest;                /* numbers a vector must have; the rest stay 0 */
  size_t given;              /* of a series: offset of its bool */
  const char *const *choice; /* ended by NULL; the first is the default */
  const cdem_case_section *section;
  bool rotates;            /* of components: there may be a `rotation` ... */
  cdem_dimension rotation; /* ... of this dimension */
  cdem_scale_tag tag;
  bool keeps_rate; /* of the domain, a time or a speed that says nothing of how fast the domain is
                      driven: not slowed down */
  bool plane;      /* has no meaning in 3-D */
  const char *beside; /* a fallback with a dimension matters where this key of the section is given;
                         NULL: always */
  const char *otherwise; /* what holds without the key, in words, where the fallback does not say it
                          */
  const char *help;      /* one line */
  const char *example;   /* how it is written: "40 GPa" */
} cdem_case_key;

struct cdem_case_section {
  const char *name; /* "interfaces" */
  size_t size;      /* of the struct */
  int keys;
  const cdem_case_key *key;
  bool named;            /* reached through CDEM_KEY_NAMED: `char *name` is the first member */
  const char *shorthand; /* the key that a plain text in place of the map means; NULL: none */
  const char *help;
};

enum { CDEM_CASE_PATH = 256 }; /* bytes of the longest path of a key, "materials.NAME.young" */

/* The top of every case. */
const cdem_case_section *cdem_case_root(void);

/* The key of a section; NULL when there is none. */
const cdem_case_key *cdem_case_key_find(const cdem_case_section *section, const char *key);

/* Walks all sections depth first: visit(context, path, key) with path "materials.NAME.young",
 * "interfaces[].tension". The keys of material models are visited once each, after `model` and the
 * axes; `key` is good for the time of the call. */
void cdem_case_walk(void (*visit)(void *context, const char *path, const cdem_case_key *key),
                    void *context);

/* Walks the sections of a case that were given, depth first, with the paths of its own entries:
 * "materials.rock", "interfaces[2]"; the root's is "". */
void cdem_case_walk_given(const cdem_case *cases,
                          void (*visit)(void *context, const char *path,
                                        const cdem_case_section *section),
                          void *context);

/* Fills a struct with the defaults of its section. */
cdem_status cdem_case_defaults(const cdem_case_section *section, void *values, cdem_fault *fault);

/* Releases what the struct of a section owns and zeroes it. */
void cdem_case_values_release(const cdem_case_section *section, void *values);

/* Checks that join several keys (a mesh file or a grid, one load a load, a step for ...). Adds to
 * nothing: the first failure, with its place. */
cdem_status cdem_case_check(const cdem_case *cases, cdem_fault *fault);

#endif
