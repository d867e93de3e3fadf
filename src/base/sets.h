/* Which things hang together: disjoint sets of ids (union-find with path halving).
 *
 * The caller owns `parent`, one entry for each id; an id that stands for itself (parent[id] == id)
 * is the root of its set. The root is always the smallest id of its set, so that names do not
 * depend on the order of the joins. Once nothing is joined any more, parent[id] =
 * cdem_sets_root(parent, id) over all ids turns the forest into labels. */
#ifndef CDEM_BASE_SETS_H
#define CDEM_BASE_SETS_H

#include <stdint.h>

/* Ids [from, to): each alone. */
static inline void cdem_sets_init(int32_t *parent, int32_t from, int32_t to) {
  for (int32_t id = from; id < to; id++)
    parent[id] = id;
}

static inline int32_t cdem_sets_root(int32_t *parent, int32_t id) {
  while (parent[id] != id) {
    parent[id] = parent[parent[id]];
    id = parent[id];
  }
  return id;
}

static inline void cdem_sets_join(int32_t *parent, int32_t a, int32_t b) {
  a = cdem_sets_root(parent, a);
  b = cdem_sets_root(parent, b);
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
}

/* Ids [from, to): each says the root of its set. */
static inline void cdem_sets_label(int32_t *parent, int32_t from, int32_t to) {
  for (int32_t id = from; id < to; id++)
    parent[id] = cdem_sets_root(parent, id);
}

#endif
