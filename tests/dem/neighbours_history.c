/* Neighbours: histories follow their pairs through builds, sorting, wrapping and flips of the cell,
 * to the bit, and through a checkpoint. */
#include "dem/neighbours_support.h"

enum { HISTORIES = 3, MOST = 4096 };
static const double parity[HISTORIES] = {1.0, -1.0, -1.0};

/* What a pair of ids, low < high, remembers; told from its other images by the vector between them,
 * which wrapping does not change. */
typedef struct {
  int32_t low, high;
  double vector[3], value[HISTORIES];
} memory;

typedef struct {
  cdem_dem_store s;
  memory *known;
  int64_t memories, met; /* so far */
  cdem_random random;
} world;

static void world_init(world *w, int dim, int32_t grains, const double box[3], uint64_t seed) {
  *w = (world){.random = {seed}};
  store_init(&w->s, dim, grains, 0.3);
  store_fill(&w->s, box, 0.3, 1.0, seed);
  w->s.histories = HISTORIES;
  memcpy(w->s.parity, parity, sizeof parity);
  STORE_TRY(w->known = calloc(MOST, sizeof *w->known));
}

static void world_release(world *w) {
  store_release(&w->s);
  free(w->known);
}

static void pair_vector(const cdem_dem_store *s, int64_t i, int64_t k, double vector[3]) {
  int code = s->pair_image != NULL ? s->pair_image[k] : CDEM_IMAGE_SELF;
  for (int c = 0; c < 3; c++)
    vector[c] = cdem_place(s, s->pair_other[k])[c] + s->image[code][c] - cdem_place(s, i)[c];
}

static void remember(world *w) {
  cdem_dem_store *s = &w->s;
  w->memories = 0;
  for (int64_t i = 0; i < s->grains; i++)
    for (int64_t k = s->pair_start[i]; k < s->pair_start[i + 1]; k++) {
      int32_t a = s->id[i], b = s->id[s->pair_other[k]];
      double vector[3], *history = s->pair_history + HISTORIES * k;
      pair_vector(s, i, k, vector);
      bool touch = cdem_norm3(vector) < cdem_place(s, i)[3] + cdem_place(s, s->pair_other[k])[3];
      for (int h = 0; h < HISTORIES && touch && s->pair_touch[k] == 0; h++)
        history[h] = cdem_random_uniform(&w->random, -1.0, 1.0);
      w->met += touch && s->pair_touch[k] == 0;
      s->pair_touch[k] = touch;
      if (!touch)
        continue;
      assert_true(w->memories < MOST);
      memory *m = &w->known[w->memories++];
      *m = (memory){.low = a < b ? a : b, .high = a < b ? b : a};
      for (int c = 0; c < 3; c++)
        m->vector[c] = a < b ? vector[c] : -vector[c];
      for (int h = 0; h < HISTORIES; h++)
        m->value[h] = a < b ? history[h] : parity[h] * history[h];
    }
}

/* Each memory is in the list, and nothing else is. */
static void recall(const world *w) {
  const cdem_dem_store *s = &w->s;
  int64_t touches = 0;
  for (int64_t i = 0; i < s->grains; i++)
    for (int64_t k = s->pair_start[i]; k < s->pair_start[i + 1]; k++) {
      if (s->pair_touch[k] == 0)
        continue;
      touches++;
      int32_t a = s->id[i], b = s->id[s->pair_other[k]];
      int64_t found = 0;
      double vector[3];
      pair_vector(s, i, k, vector);
      for (int64_t m = 0; m < w->memories; m++) {
        const memory *known = &w->known[m];
        double off = 0.0, sign = a < b ? 1.0 : -1.0;
        for (int c = 0; c < 3; c++)
          off = fmax(off, fabs(known->vector[c] - sign * vector[c]));
        /* Images are further from each other than 2; nothing moves by more than the skin. */
        if (known->low != (a < b ? a : b) || known->high != (a < b ? b : a) || off > 0.4)
          continue;
        found++;
        for (int h = 0; h < HISTORIES; h++) {
          double value = s->pair_history[HISTORIES * k + h];
          assert_true(known->value[h] == (a < b ? value : parity[h] * value));
        }
      }
      assert_int_equal(found, 1);
    }
  assert_int_equal(touches, w->memories);
}

static void move(world *w, double strain) {
  cdem_dem_store *s = &w->s;
  double most = 0.4 * s->skin / sqrt(3.0), l[9] = {0.0, strain};
  for (int64_t i = 0; i < s->grains; i++)
    for (int c = 0; c < s->dim; c++)
      cdem_place(s, i)[c] += cdem_random_uniform(&w->random, -most, most);
  if (strain != 0.0) {
    cdem_cell_advance(&s->cell, l, 1.0);
    cdem_cell_images(&s->cell, s->image);
  }
}

static void run(world *w, int rounds, double strain) {
  cdem_fault fault = {0};
  for (int k = 0; k < rounds; k++) {
    bool sort = cdem_random_next(&w->random) % 4 == 0;
    check_ok(cdem_neighbours_build(&w->s, sort, 1 + k % 3, &fault));
    recall(w);
    remember(w);
    move(w, strain);
  }
  check_ok(cdem_neighbours_build(&w->s, true, 1, &fault));
  recall(w);
  remember(w);
}

static void test_free_motion(void **state) {
  (void)state;
  world w;
  double box[3] = {4, 4, 4};
  world_init(&w, 3, 60, box, 1);
  run(&w, 1500, 0.0);
  assert_true(w.met > 2000);
  world_release(&w);
}

static void test_periodic_motion(void **state) {
  (void)state;
  static const bool all[3] = {true, true, true}, plane[3] = {true, true, false};
  static const double h[9] = {3.2, 0, 0, 0, 3.5, 0, 0, 0, 4.0};
  double box[3] = {3, 3, 3};
  for (int dim = 2; dim <= 3; dim++) {
    world w;
    world_init(&w, dim, dim == 2 ? 12 : 24, box, 3);
    store_cell(&w.s, dim == 2 ? plane : all, h);
    run(&w, 1500, 0.01); /* a shear of 15: the cell flips more than 15 times */
    assert_true(w.met > 800);
    assert_true(fabs(w.s.cell.h[1]) < 0.55 * 3.2);
    world_release(&w);
  }
}

/* A store in another order takes over order, list and histories. */
static void check_restored(world *w) {
  cdem_fault fault = {0};
  cdem_dem_store *s = &w->s, t;
  cdem_state saved = {0};
  check_ok(cdem_neighbours_save(s, &saved, &fault));
  store_init(&t, s->dim, s->grains, s->skin);
  t.histories = HISTORIES;
  t.cell = s->cell;
  for (int32_t i = 0; i < s->grains; i++) {
    memcpy(cdem_place(&t, s->id[i]), cdem_place(s, i), 32);
    memcpy(cdem_motion(&t, s->id[i]), cdem_motion(s, i), 64);
  }
  check_ok(cdem_neighbours_restore(&t, &saved, &fault));
  assert_int_equal(t.builds, s->builds);
  assert_int_equal(t.pairs, s->pairs);
  size_t pairs = (size_t)s->pairs, grains = (size_t)s->grains;
  assert_memory_equal(t.place, s->place, 32 * grains);
  assert_memory_equal(t.motion, s->motion, 64 * grains);
  assert_memory_equal(t.id, s->id, 4 * grains);
  assert_memory_equal(t.slot, s->slot, 4 * grains);
  assert_memory_equal(t.pair_start, s->pair_start, 8 * (grains + 1));
  assert_memory_equal(t.pair_other, s->pair_other, 4 * pairs);
  assert_memory_equal(t.pair_touch, s->pair_touch, pairs);
  if (cdem_cell_is_periodic(&s->cell))
    assert_memory_equal(t.pair_image, s->pair_image, pairs);
  for (int64_t k = 0; k < s->pairs; k++)
    if (s->pair_touch[k] == 1)
      assert_memory_equal(t.pair_history + HISTORIES * k, s->pair_history + HISTORIES * k,
                          HISTORIES * 8);
  /* The next builds agree too. */
  check_ok(cdem_neighbours_build(s, true, 1, &fault));
  check_ok(cdem_neighbours_build(&t, true, 2, &fault));
  assert_int_equal(t.pairs, s->pairs);
  assert_memory_equal(t.id, s->id, 4 * grains);
  assert_memory_equal(t.pair_other, s->pair_other, 4 * (size_t)s->pairs);
  cdem_state_release(&saved);
  store_release(&t);
}

static void test_checkpoint(void **state) {
  (void)state;
  static const bool all[3] = {true, true, true};
  static const double h[9] = {6, 0, 0, 0, 6, 0, 0, 0, 6};
  double box[3] = {6, 6, 6};
  for (int periodic = 0; periodic < 2; periodic++) {
    world w;
    world_init(&w, 3, 100, box, 5);
    if (periodic)
      store_cell(&w.s, all, h);
    run(&w, 10, 0.0);
    assert_true(w.memories > 50);
    check_restored(&w);
    world_release(&w);
  }
}

static cdem_array *array_of(cdem_state *state, const char *name) {
  for (int64_t k = 0; k < state->arrays; k++)
    if (strcmp(state->array[k].name, name) == 0)
      return &state->array[k];
  fail_msg("no %s", name);
  return NULL;
}

static void test_bad_checkpoint(void **state) {
  (void)state;
  cdem_fault fault = {0};
  world w;
  double box[3] = {4, 4, 4};
  world_init(&w, 3, 40, box, 9);
  run(&w, 3, 0.0);
  cdem_dem_store *s = &w.s;
  cdem_state saved = {0};
  check_ok(cdem_neighbours_save(s, &saved, &fault));
  int64_t pairs = s->pairs;
  /* A copy of each array, wrong in one place. */
  static const struct {
    const char *name, *text;
    int at;
    int64_t value;
  } wrong[] = {{"dem/pairs/order", "name every grain once", 3, -1},
               {"dem/pairs/order", "name every grain once", 3, 40},
               {"dem/pairs/start", "than its rows", 0, 1},
               {"dem/pairs/start", "negative length", 2, 100000},
               {"dem/pairs/other", "cannot be", 0, 0},
               {"dem/pairs/other", "cannot be", 0, 40},
               {"dem/pairs/touch", "", 0, 7}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    cdem_array *array = array_of(&saved, wrong[k].name);
    size_t size = cdem_array_size(array->type);
    void *before = array->data, *copy = malloc(size * (size_t)array->count);
    memcpy(copy, before, size * (size_t)array->count);
    memcpy((char *)copy + size * (size_t)wrong[k].at, &wrong[k].value, size);
    array->data = copy;
    check_fails(cdem_neighbours_restore(s, &saved, &fault), CDEM_INPUT, wrong[k].text);
    array->data = before;
    free(copy);
    assert_int_equal(s->pairs, pairs);
  }
  check_ok(cdem_neighbours_restore(s, &saved, &fault));
  recall(&w);
  cdem_state_release(&saved);
  world_release(&w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_free_motion), cmocka_unit_test(test_periodic_motion),
      cmocka_unit_test(test_checkpoint), cmocka_unit_test(test_bad_checkpoint)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
