/* Contacts are few against the slots where they may come up: they live in a pool. */
#include "cdem/contact_store.h"

#include <string.h>

int32_t cdem_contact_take(cdem_contact_store *s) {
  int64_t at;
#pragma omp atomic capture
  at = s->pooled++;
  if (at >= s->pool_capacity)
    return -1;
  memset(&s->pool[at], 0, sizeof s->pool[at]);
  s->pool[at].facet = -1;
  return (int32_t)at;
}

cdem_status cdem_contact_make_room(cdem_contact_store *s, int64_t more, cdem_fault *fault) {
  if (s->pooled > s->pool_capacity)
    s->pooled = s->pool_capacity; /* some were turned away */
  CDEM_REQUIRE(s->pooled + more < INT32_MAX, fault, CDEM_MEMORY,
               "contact: more than 2^31 contacts; the model is too large for one run");
  return cdem_grow(&s->pool, &s->pool_capacity, s->pooled + more, sizeof *s->pool, fault);
}
