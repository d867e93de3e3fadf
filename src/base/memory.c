#include "base/memory.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static atomic_llong allocations_left = -1;

int64_t cdem_memory_fail_after(int64_t count) {
  return atomic_exchange(&allocations_left, count);
}

/* True when a test asked this allocation to fail. */
static bool must_fail(void) {
  if (atomic_load_explicit(&allocations_left, memory_order_relaxed) < 0)
    return false;
  return atomic_fetch_sub(&allocations_left, 1) == 0;
}

static cdem_status out_of_memory(int64_t count, size_t size, cdem_fault *fault) {
  return cdem_fail(fault, CDEM_MEMORY,
                   "out of memory: %" PRId64 " elements of %zu bytes are not to be had", count,
                   size);
}

void *cdem_allocate(int64_t count, size_t size, cdem_fault *fault) {
  void *block = NULL;
  size_t bytes;
  bool possible =
      count >= 0 && !__builtin_mul_overflow((size_t)count, size, &bytes) && bytes <= PTRDIFF_MAX;
  if (possible && !must_fail())
    block = calloc(count > 0 ? (size_t)count : 1, size);
  if (block == NULL)
    out_of_memory(count, size, fault);
  return block;
}

cdem_status cdem_grow(void *array, int64_t *capacity, int64_t needed, size_t size,
                      cdem_fault *fault) {
  if (needed <= *capacity)
    return CDEM_OK;
  int64_t larger = *capacity > INT64_MAX / 2 ? needed : 2 * *capacity;
  if (larger < needed)
    larger = needed;
  if (larger < 16)
    larger = 16;
  void *old, *block = NULL;
  memcpy(&old, array, sizeof old);
  size_t bytes;
  bool possible = !__builtin_mul_overflow((size_t)larger, size, &bytes) && bytes <= PTRDIFF_MAX;
  if (possible && !must_fail())
    block = realloc(old, bytes);
  if (block == NULL)
    return out_of_memory(larger, size, fault);
  size_t used = (size_t)*capacity * size;
  memset((char *)block + used, 0, bytes - used);
  memcpy(array, &block, sizeof block);
  *capacity = larger;
  return CDEM_OK;
}

char *cdem_copy_text(const char *text, cdem_fault *fault) {
  size_t length = strlen(text);
  char *copy = cdem_allocate((int64_t)length + 1, 1, fault);
  if (copy != NULL)
    memcpy(copy, text, length);
  return copy;
}
