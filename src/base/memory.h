/* Checked allocation: the only place of the library that calls malloc.
 *
 * Sizes are counted in elements and the product is checked for overflow. Tests can make the n-th
 * allocation fail (cdem_memory_fail_after) to walk every error path.
 */
#ifndef CDEM_BASE_MEMORY_H
#define CDEM_BASE_MEMORY_H

#include "base/fault.h"

#include <stddef.h>
#include <stdint.h>

/* A zeroed array of `count` elements of `size` bytes (count 0 gives a valid, freeable block); NULL
 * on failure, with CDEM_MEMORY recorded in *fault. Free with free(). */
void *cdem_allocate(int64_t count, size_t size, cdem_fault *fault);

/* Grows *array (NULL at first) so that it holds `needed` elements; doubles to keep appending O(1).
 * New elements are zeroed. On failure *array and *capacity are untouched. */
cdem_status cdem_grow(void *array, int64_t *capacity, int64_t needed, size_t size,
                      cdem_fault *fault);

/* A copy of a text; NULL on failure. */
char *cdem_copy_text(const char *text, cdem_fault *fault);

/* For tests: the allocation after `count` more successful ones fails; negative switches it off.
 * What was left of the count before: negative when it was off, or the allocation has failed. */
int64_t cdem_memory_fail_after(int64_t count);

/* Declares nothing; assigns a new zeroed array or returns CDEM_MEMORY. */
#define CDEM_NEW(pointer, count, fault)                                                            \
  do {                                                                                             \
    (pointer) = cdem_allocate((count), sizeof *(pointer), (fault));                                \
    if ((pointer) == NULL)                                                                         \
      return CDEM_MEMORY;                                                                          \
  } while (0)

#endif
