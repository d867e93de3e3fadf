/* Sorting lists that may be empty. A list that grows by need (cdem_grow) is NULL until something is
 * in it, and qsort must not be given NULL, even for no rows. */
#ifndef CDEM_BASE_SORT_H
#define CDEM_BASE_SORT_H

#include <stdint.h>
#include <stdlib.h>

/* `count` rows of `size` bytes in the order of `compare`; list: NULL if there are none. */
static inline void cdem_sort(void *list, int64_t count, size_t size,
                             int (*compare)(const void *, const void *)) {
  if (count > 1)
    qsort(list, (size_t)count, size, compare);
}

#endif
