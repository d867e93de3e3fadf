/* Disjoint sets against the definition: two ids are in one set where a chain of joins leads from
 * one to the other, and its name is the smallest id, whatever the order of the joins. */
#include "base/sets.h"

#include "base/random.h"
#include "support/test.h"

enum { IDS = 60, JOINS = 45 };

typedef struct {
  int32_t a, b;
} edge;

static void draw(edge *edges, cdem_random *random) {
  for (int k = 0; k < JOINS; k++)
    edges[k] = (edge){(int32_t)(cdem_random_next(random) % IDS),
                      (int32_t)(cdem_random_next(random) % IDS)};
}

/* Labels by spreading the smaller one over every edge until nothing changes. */
static void spread(const edge *edges, int32_t *label) {
  for (int32_t i = 0; i < IDS; i++)
    label[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k < JOINS; k++) {
      int32_t *a = label + edges[k].a, *b = label + edges[k].b;
      changed = changed || *a != *b;
      *a = *b = *a < *b ? *a : *b;
    }
  }
}

static void sets_are_what_chains_connect(void **state) {
  (void)state;
  cdem_random random = {7};
  for (int round = 0; round < 50; round++) {
    edge edges[JOINS];
    int32_t parent[IDS], backwards[IDS], label[IDS];
    draw(edges, &random);
    spread(edges, label);
    cdem_sets_init(parent, 0, IDS);
    cdem_sets_init(backwards, 0, IDS);
    for (int k = 0; k < JOINS; k++) {
      cdem_sets_join(parent, edges[k].a, edges[k].b);
      cdem_sets_join(backwards, edges[JOINS - 1 - k].b, edges[JOINS - 1 - k].a);
    }
    for (int32_t i = 0; i < IDS; i++)
      assert_int_equal(cdem_sets_root(parent, i), label[i]);
    cdem_sets_label(parent, 0, IDS);
    cdem_sets_label(backwards, 0, IDS);
    assert_memory_equal(parent, label, sizeof label);
    assert_memory_equal(backwards, label, sizeof label);
  }
}

/* A part of the ids is its own world: the others keep what they are. */
static void a_range_leaves_the_others(void **state) {
  (void)state;
  int32_t parent[6] = {-1, -1, 0, 0, 0, -1};
  cdem_sets_init(parent, 2, 5);
  cdem_sets_join(parent, 4, 3);
  cdem_sets_label(parent, 2, 5);
  const int32_t wanted[6] = {-1, -1, 2, 3, 3, -1};
  assert_memory_equal(parent, wanted, sizeof wanted);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sets_are_what_chains_connect),
      cmocka_unit_test(a_range_leaves_the_others),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
