/* States: everything that changes while a solver runs, as named arrays: what a checkpoint holds.
 *
 * A solver lists its arrays (borrowed, so that saving copies nothing); io writes them and reads
 * them back as an owned state; the solver copies them out by name. What follows from the case alone
 * (stiffness, topology at the start) is not in a state. Names are paths: "solver/velocity".
 */
#ifndef CDEM_RESULTS_STATE_H
#define CDEM_RESULTS_STATE_H

#include "base/base.h"

#include <stdbool.h>

typedef enum {
  CDEM_ARRAY_REAL, /* double */
  CDEM_ARRAY_INT32,
  CDEM_ARRAY_INT64,
  CDEM_ARRAY_BYTE /* uint8_t */
} cdem_array_type;

typedef struct {
  char *name;
  cdem_array_type type;
  int64_t count;
  void *data;
  bool owned;
} cdem_array;

typedef struct {
  int64_t arrays, capacity;
  cdem_array *array; /* [arrays] */
} cdem_state;

size_t cdem_array_size(cdem_array_type type);
/* "real", "int32", "int64", "byte". */
const char *cdem_array_type_name(cdem_array_type type);
/* Lists an array without copying it; it must live as long as the state. CDEM_USAGE for a name that
 * is taken, is the group of another one, or is no path. */
cdem_status cdem_state_add(cdem_state *state, const char *name, cdem_array_type type, int64_t count,
                           const void *data, cdem_fault *fault);
/* Adds a copy (for scalars, and for readers). */
cdem_status cdem_state_add_copy(cdem_state *state, const char *name, cdem_array_type type,
                                int64_t count, const void *data, cdem_fault *fault);
/* Hands over an array from cdem_allocate; it stays the caller's after a failure. */
cdem_status cdem_state_add_owned(cdem_state *state, const char *name, cdem_array_type type,
                                 int64_t count, void *data, cdem_fault *fault);
/* NULL when there is none. */
const cdem_array *cdem_state_find(const cdem_state *state, const char *name);
/* Copies an array of exactly this type and length out; CDEM_INPUT names what does not fit ("the
 * checkpoint does not belong to this case"), and a number that is not finite. */
cdem_status cdem_state_get(const cdem_state *state, const char *name, cdem_array_type type,
                           int64_t count, void *data, cdem_fault *fault);
/* The same for an array whose length only the state knows: `data` is the address of a pointer,
 * which receives a new array. */
cdem_status cdem_state_take(const cdem_state *state, const char *name, cdem_array_type type,
                            int64_t *count, void *data, cdem_fault *fault);
void cdem_state_release(cdem_state *state);

#endif
