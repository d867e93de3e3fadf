/* Private to io: a YAML file as a tree of nodes that know where they stand, and a list of errors
 * that show it.
 *
 * What has no place in an input file is an error here already: anchors and aliases, tags, a second
 * document, keys that are no plain words, the same key twice. Several errors are collected, so that
 * a person does not repair a file one run at a time:
 *
 *     granite.yaml:2:1: unknown key 'yuong'; did you mean 'young'?
 *       yuong: 40 GPa
 *       ^~~~~
 */
#ifndef CDEM_IO_YAML_TREE_H
#define CDEM_IO_YAML_TREE_H

#include "base/base.h"
#include "base/quantity.h"

#include <stdbool.h>

typedef enum { CDEM_YAML_SCALAR, CDEM_YAML_LIST, CDEM_YAML_MAP } cdem_yaml_kind;

/* Children of a map alternate between key and value. */
typedef struct {
  cdem_yaml_kind kind;
  char *text;              /* of a scalar */
  int line, column, width; /* from 1; characters to underline */
  int32_t child, next;     /* first child, next sibling; -1: none */
  int32_t children;
  bool braces; /* of a map: {key: value} */
  int origin;  /* 0: the file; else 1 + the override it came from */
} cdem_yaml_node;

/* A number that was read from a node. */
typedef struct {
  int32_t node;
  cdem_dimension dimension;
  double value; /* SI */
} cdem_yaml_number;

typedef struct {
  char *path;
  char *source; /* the whole file, ended by a zero */
  int64_t bytes, source_capacity;
  cdem_yaml_node *node; /* [0] is the root */
  int64_t nodes, capacity;
  cdem_yaml_number *number; /* [numbers] in the order of reading, good ones alone */
  int64_t numbers, number_capacity;
  bool lacks_memory; /* a number could not be noted: cdem_yaml_finish fails */
  int errors;
  cdem_fault report; /* the errors so far */
  int origin;        /* of the text being read */
  int overrides;
  const char *const *override; /* [overrides] borrowed, for messages */
} cdem_yaml;

/* CDEM_FILE: cannot be read. CDEM_INPUT: no YAML at all. Errors that leave a tree behind are
 * collected. Zero-initialise; release at any stage. */
cdem_status cdem_yaml_read(const char *path, cdem_yaml *yaml, cdem_fault *fault);
/* The same from a text in place of the file of this path. */
cdem_status cdem_yaml_read_text(const char *path, const char *text, cdem_yaml *yaml,
                                cdem_fault *fault);
void cdem_yaml_release(cdem_yaml *yaml);

/* Reads the value of an override (yaml->override[index] from byte `from` on) into the same tree;
 * its root belongs to nothing yet. Errors name the override instead of a place. */
cdem_status cdem_yaml_read_override(cdem_yaml *yaml, int index, size_t from, int32_t *root,
                                    cdem_fault *fault);

/* Adds an error at a node. */
__attribute__((format(printf, 3, 4))) void
cdem_yaml_error(cdem_yaml *yaml, const cdem_yaml_node *at, const char *format, ...);
/* Adds "unknown WHAT 'text'" with the nearest candidate. */
void cdem_yaml_unknown(cdem_yaml *yaml, const cdem_yaml_node *at, const char *what,
                       const char *const *candidates, int count);
/* Adds an error of an override as a whole. */
__attribute__((format(printf, 3, 4))) void cdem_yaml_override_error(cdem_yaml *yaml, int index,
                                                                    const char *format, ...);
/* CDEM_INPUT with all errors, if there are any; CDEM_MEMORY. */
cdem_status cdem_yaml_finish(const cdem_yaml *yaml, cdem_fault *fault);

static inline const cdem_yaml_node *cdem_yaml_root(const cdem_yaml *yaml) {
  return &yaml->node[0];
}
static inline const cdem_yaml_node *cdem_yaml_child(const cdem_yaml *yaml,
                                                    const cdem_yaml_node *node) {
  return node->child < 0 ? NULL : &yaml->node[node->child];
}
static inline const cdem_yaml_node *cdem_yaml_next(const cdem_yaml *yaml,
                                                   const cdem_yaml_node *node) {
  return node->next < 0 ? NULL : &yaml->node[node->next];
}
/* The value of a key of a map, NULL when it is not there. */
const cdem_yaml_node *cdem_yaml_find(const cdem_yaml *yaml, const cdem_yaml_node *map,
                                     const char *key);
/* ---- changing the tree (yaml_edit.c); node pointers do not outlive these calls ---- */

/* A new node that belongs to nothing, at the place of node `like`, from override `origin` - 1. */
cdem_status cdem_yaml_new(cdem_yaml *yaml, cdem_yaml_kind kind, const char *text, int32_t like,
                          int origin, int32_t *id, cdem_fault *fault);
/* Appends a child. */
void cdem_yaml_append(cdem_yaml *yaml, int32_t parent, int32_t child);
/* Puts a node where the child number `position` (from 0) was. */
void cdem_yaml_replace(cdem_yaml *yaml, int32_t parent, int32_t position, int32_t child);
/* The tree as YAML text (comments are gone), newly allocated: read again it is the same tree. */
cdem_status cdem_yaml_text(const cdem_yaml *yaml, char **text, cdem_fault *fault);

/* "a text", "a list", "a map" for messages. */
const char *cdem_yaml_kind_name(cdem_yaml_kind kind);

/* Each key and value of a map. */
#define CDEM_YAML_EACH(yaml, map, key, value)                                                      \
  for (const cdem_yaml_node *key = cdem_yaml_child((yaml), (map)),                                 \
                            *value = key != NULL ? cdem_yaml_next((yaml), key) : NULL;             \
       key != NULL; key = cdem_yaml_next((yaml), value),                                           \
                            value = key != NULL ? cdem_yaml_next((yaml), key) : NULL)

#endif
