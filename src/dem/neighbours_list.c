/* Neighbours: the list from what was found, and the histories from the list before. */
#include "dem/neighbours.h"

#include <inttypes.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Pairs that grains of finer levels found, by the grain they belong to. */
static cdem_status collect_backs(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t all = 0;
  for (int t = 0; t < n->threads; t++)
    all += n->found[t].backs / 2;
  n->any_back = all > 0;
  if (!n->any_back)
    return CDEM_OK;
  CDEM_TRY(cdem_neighbours_room(&n->back_start, &n->capacity[24], s->grains + 2, sizeof(int64_t),
                                fault));
  CDEM_TRY(cdem_neighbours_room(&n->back_word, &n->capacity[25], all, sizeof(uint64_t), fault));
  int64_t *start = n->back_start;
  memset(start, 0, (size_t)(s->grains + 2) * sizeof *start);
  for (int t = 0; t < n->threads; t++)
    for (int64_t k = 0; k < n->found[t].backs; k += 2)
      start[n->found[t].back[k] + 2]++;
  for (int64_t i = 2; i < s->grains + 2; i++)
    start[i] += start[i - 1];
  for (int t = 0; t < n->threads; t++)
    for (int64_t k = 0; k < n->found[t].backs; k += 2)
      n->back_word[start[n->found[t].back[k] + 1]++] = n->found[t].back[k + 1];
  return CDEM_OK;
}

static void sort_words(uint64_t *word, uint64_t *spare, int64_t count) {
  if (count <= 24) {
    for (int64_t i = 1; i < count; i++) {
      uint64_t moving = word[i];
      int64_t to = i;
      for (; to > 0 && moving < word[to - 1]; to--)
        word[to] = word[to - 1];
      word[to] = moving;
    }
    return;
  }
  int64_t half = count / 2;
  sort_words(word, spare, half);
  sort_words(word + half, spare, count - half);
  memcpy(spare, word, (size_t)half * sizeof *word);
  int64_t left = 0, right = half, to = 0;
  while (left < half)
    word[to++] = right < count && word[right] < spare[left] ? word[right++] : spare[left++];
}

/* One row: own words and those sent back, sorted. */
static void write_row(cdem_dem_store *s, int64_t i, uint64_t *word, uint64_t *spare) {
  struct cdem_neighbours *n = s->search;
  int64_t count = n->found_count[i], first = s->pair_start[i];
  const uint64_t *own = n->found[n->found_by[i]].word + n->found_at[i];
  for (int64_t k = 0; k < count; k++)
    word[k] = own[k];
  if (n->any_back) {
    int64_t more = n->back_start[i + 1] - n->back_start[i];
    memcpy(word + count, n->back_word + n->back_start[i], (size_t)more * sizeof *word);
    count += more;
  }
  sort_words(word, spare, count);
  for (int64_t k = 0; k < count; k++)
    s->pair_other[first + k] = (int32_t)(word[k] >> 8);
  if (s->pair_image != NULL)
    for (int64_t k = 0; k < count; k++)
      s->pair_image[first + k] = (uint8_t)word[k];
  for (int64_t k = 0; k < count; k++)
    s->pair_touch[first + k] = 0;
}

/* The list of now becomes the one before, and the arrays of the one before hold the new one. */
static void swap_lists(cdem_dem_store *s) {
  struct cdem_neighbours *n = s->search;
  int64_t *start = s->pair_start;
  int32_t *other = s->pair_other;
  uint8_t *image = s->pair_image, *touch = s->pair_touch;
  double *history = s->pair_history;
  s->pair_start = n->start;
  s->pair_other = n->other;
  s->pair_image = n->pair_image;
  s->pair_touch = n->touch;
  s->pair_history = n->history;
  n->start = start;
  n->other = other;
  n->pair_image = image;
  n->touch = touch;
  n->history = history;
  for (int k = 0; k < 5; k++) {
    int64_t capacity = s->capacity[k];
    s->capacity[k] = n->list_capacity[k];
    n->list_capacity[k] = capacity;
  }
}

static cdem_status spare_list(cdem_dem_store *s, int64_t pairs, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  int64_t *room = n->list_capacity;
  CDEM_TRY(cdem_neighbours_room(&n->start, &room[0], s->grains + 1, sizeof *n->start, fault));
  CDEM_TRY(cdem_neighbours_room(&n->other, &room[1], pairs, sizeof *n->other, fault));
  if (cdem_cell_is_periodic(&s->cell))
    CDEM_TRY(cdem_neighbours_room(&n->pair_image, &room[2], pairs, 1, fault));
  CDEM_TRY(cdem_neighbours_room(&n->touch, &room[3], pairs, 1, fault));
  if (s->histories > 0)
    CDEM_TRY(cdem_neighbours_room(&n->history, &room[4], pairs * s->histories, sizeof *n->history,
                                  fault));
  return CDEM_OK;
}

/* ---- histories ---- */

/* n edges between two grains become T n + Ta - Tb: T of the flip, Ta and Tb of the grains. */
int cdem_neighbours_image_now(const cdem_dem_store *s, int64_t a, int64_t b, int image) {
  const struct cdem_neighbours *n = s->search;
  int old[3], edges[3];
  if (!n->moved)
    return image;
  cdem_image_edges(image, old);
  for (int r = 0; r < 3; r++) {
    const int *t = n->turns + 3 * r;
    edges[r] = t[0] * old[0] + t[1] * old[1] + t[2] * old[2];
    edges[r] += n->turned[3 * a + r] - n->turned[3 * b + r];
    if (edges[r] < -1 || edges[r] > 1)
      return -1;
  }
  return cdem_image_code(edges);
}

static int64_t find_pair(const cdem_dem_store *s, int64_t owner, int32_t other, int image) {
  int64_t low = s->pair_start[owner], high = s->pair_start[owner + 1];
  const int32_t *others = s->pair_other;
  while (high - low > 8) {
    int64_t middle = low + (high - low) / 2;
    if (others[middle - 1] < other)
      low = middle;
    else
      high = middle;
  }
  for (high = s->pair_start[owner + 1]; low < high && others[low] <= other; low++)
    if (others[low] == other && (s->pair_image == NULL || s->pair_image[low] == image))
      return low;
  return -1;
}

/* Old pair k of old owner a goes to its new place; nobody else writes there. */
static void carry_pair(cdem_dem_store *s, int64_t a, int64_t k, bool sorted) {
  const struct cdem_neighbours *n = s->search;
  int64_t b = n->other[k];
  int image = n->pair_image != NULL ? n->pair_image[k] : CDEM_IMAGE_SELF;
  image = cdem_neighbours_image_now(s, a, b, image);
  int32_t owner = (int32_t)(sorted ? n->place_of[a] : a);
  int32_t other = (int32_t)(sorted ? n->place_of[b] : b);
  bool swapped = other < owner;
  if (image < 0)
    return;
  int64_t to = swapped ? find_pair(s, other, owner, 26 - image) : find_pair(s, owner, other, image);
  if (to < 0)
    return;
  s->pair_touch[to] = 1;
  const double *from = n->history + k * s->histories;
  double *at = s->pair_history + to * s->histories;
  for (int h = 0; h < s->histories; h++)
    at[h] = swapped ? s->parity[h] * from[h] : from[h];
}

static void carry_histories(cdem_dem_store *s, int64_t before, bool sorted, int threads) {
  const struct cdem_neighbours *n = s->search;
  if (before == 0)
    return;
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int64_t a = 0; a < s->grains; a++)
    for (int64_t k = n->start[a]; k < n->start[a + 1]; k++)
      if (n->touch[k] == 1)
        carry_pair(s, a, k, sorted);
}

cdem_status cdem_neighbours_list(cdem_dem_store *s, bool sorted, int threads, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  CDEM_TRY(collect_backs(s, fault));
  int64_t pairs = 0, longest = 0, before = s->pairs;
  for (int64_t i = 0; i < s->grains; i++) {
    int64_t count = n->found_count[i] + (n->any_back ? n->back_start[i + 1] - n->back_start[i] : 0);
    longest = count > longest ? count : longest;
    pairs += count;
  }
  CDEM_TRY(spare_list(s, pairs, fault));
  CDEM_TRY(cdem_neighbours_room(&n->row_word, &n->capacity[26], 2 * longest * threads,
                                sizeof *n->row_word, fault));
  swap_lists(s);
  s->pairs = pairs;
  s->pair_start[0] = 0;
  for (int64_t i = 0; i < s->grains; i++)
    s->pair_start[i + 1] = s->pair_start[i] + n->found_count[i] +
                           (n->any_back ? n->back_start[i + 1] - n->back_start[i] : 0);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int64_t i = 0; i < s->grains; i++) {
    uint64_t *word = n->row_word + 2 * longest * omp_get_thread_num();
    write_row(s, i, word, word + longest);
  }
  carry_histories(s, before, sorted, threads);
  return CDEM_OK;
}
