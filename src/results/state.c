#include "results/state.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name;
  size_t size;
} types[] = {[CDEM_ARRAY_REAL] = {"real", sizeof(double)},
             [CDEM_ARRAY_INT32] = {"int32", sizeof(int32_t)},
             [CDEM_ARRAY_INT64] = {"int64", sizeof(int64_t)},
             [CDEM_ARRAY_BYTE] = {"byte", sizeof(uint8_t)}};

size_t cdem_array_size(cdem_array_type type) {
  return types[type].size;
}

const char *cdem_array_type_name(cdem_array_type type) {
  return types[type].name;
}

/* A path of non-empty parts. "a" and "a/b" would be a file and a folder of one name. */
static cdem_status check_name(const cdem_state *state, const char *name, cdem_fault *fault) {
  size_t length = strlen(name);
  CDEM_REQUIRE(length > 0 && name[0] != '/' && name[length - 1] != '/' &&
                   strstr(name, "//") == NULL && strcmp(name, ".") != 0,
               fault, CDEM_USAGE,
               "'%s' cannot be the name of an array of a state; use parts of at least one letter "
               "between single '/'",
               name);
  for (int64_t i = 0; i < state->arrays; i++) {
    const char *other = state->array[i].name;
    size_t l = strlen(other), shorter = l < length ? l : length;
    const char *longer = l < length ? name : other;
    bool same =
        strncmp(other, name, shorter) == 0 && (longer[shorter] == '\0' || longer[shorter] == '/');
    CDEM_REQUIRE(!same, fault, CDEM_USAGE,
                 "the array '%s' of a state cannot stand beside '%s'; rename one of them", name,
                 other);
  }
  return CDEM_OK;
}

cdem_status cdem_state_add(cdem_state *state, const char *name, cdem_array_type type, int64_t count,
                           const void *data, cdem_fault *fault) {
  CDEM_REQUIRE(count >= 0, fault, CDEM_USAGE,
               "the array '%s' of a state has %" PRId64 " elements; 0 is the least", name, count);
  CDEM_TRY(check_name(state, name, fault));
  CDEM_TRY(
      cdem_grow(&state->array, &state->capacity, state->arrays + 1, sizeof *state->array, fault));
  char *copy = cdem_copy_text(name, fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  /* Borrowed data is never written to. */
  state->array[state->arrays++] = (cdem_array){copy, type, count, (void *)data, false};
  return CDEM_OK;
}

cdem_status cdem_state_add_copy(cdem_state *state, const char *name, cdem_array_type type,
                                int64_t count, const void *data, cdem_fault *fault) {
  void *copy = cdem_allocate(count, cdem_array_size(type), fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  if (count > 0)
    memcpy(copy, data, (size_t)count * cdem_array_size(type));
  cdem_status status = cdem_state_add_owned(state, name, type, count, copy, fault);
  if (status != CDEM_OK)
    free(copy);
  return status;
}

cdem_status cdem_state_add_owned(cdem_state *state, const char *name, cdem_array_type type,
                                 int64_t count, void *data, cdem_fault *fault) {
  CDEM_TRY(cdem_state_add(state, name, type, count, data, fault));
  state->array[state->arrays - 1].owned = true;
  return CDEM_OK;
}

const cdem_array *cdem_state_find(const cdem_state *state, const char *name) {
  for (int64_t i = 0; i < state->arrays; i++)
    if (strcmp(state->array[i].name, name) == 0)
      return &state->array[i];
  return NULL;
}

static cdem_status find_typed(const cdem_state *state, const char *name, cdem_array_type type,
                              const cdem_array **array, cdem_fault *fault) {
  *array = cdem_state_find(state, name);
  CDEM_REQUIRE(*array != NULL, fault, CDEM_INPUT,
               "the checkpoint has no array '%s'; it does not belong to this case", name);
  CDEM_REQUIRE((*array)->type == type, fault, CDEM_INPUT,
               "the array '%s' of the checkpoint is of type %s, not %s; it does not belong to this "
               "case",
               name, types[(*array)->type].name, types[type].name);
  return CDEM_OK;
}

/* No solver goes on from a number that is none. */
static cdem_status check_numbers(const cdem_array *array, cdem_fault *fault) {
  const double *value = array->data;
  for (int64_t i = 0; array->type == CDEM_ARRAY_REAL && i < array->count; i++)
    CDEM_REQUIRE(isfinite(value[i]), fault, CDEM_INPUT,
                 "the array '%s' of the checkpoint holds %g at place %" PRId64
                 ", where a finite number is wanted; take an earlier checkpoint or start anew",
                 array->name, value[i], i);
  return CDEM_OK;
}

cdem_status cdem_state_get(const cdem_state *state, const char *name, cdem_array_type type,
                           int64_t count, void *data, cdem_fault *fault) {
  const cdem_array *array;
  CDEM_TRY(find_typed(state, name, type, &array, fault));
  CDEM_REQUIRE(array->count == count, fault, CDEM_INPUT,
               "the array '%s' of the checkpoint has %" PRId64 " elements, not %" PRId64
               "; it does not belong to this case",
               name, array->count, count);
  CDEM_TRY(check_numbers(array, fault));
  if (count > 0)
    memcpy(data, array->data, (size_t)count * cdem_array_size(type));
  return CDEM_OK;
}

cdem_status cdem_state_take(const cdem_state *state, const char *name, cdem_array_type type,
                            int64_t *count, void *data, cdem_fault *fault) {
  const cdem_array *array;
  CDEM_TRY(find_typed(state, name, type, &array, fault));
  CDEM_TRY(check_numbers(array, fault));
  void *copy = cdem_allocate(array->count, cdem_array_size(type), fault);
  if (copy == NULL)
    return CDEM_MEMORY;
  if (array->count > 0)
    memcpy(copy, array->data, (size_t)array->count * cdem_array_size(type));
  *count = array->count;
  memcpy(data, &copy, sizeof copy);
  return CDEM_OK;
}

void cdem_state_release(cdem_state *state) {
  for (int64_t i = 0; i < state->arrays; i++) {
    free(state->array[i].name);
    if (state->array[i].owned)
      free(state->array[i].data);
  }
  free(state->array);
  *state = (cdem_state){0};
}
