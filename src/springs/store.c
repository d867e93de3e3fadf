/* From a batch, one array a number, to spring sets, one after the other. */
#include "springs/kernels.h"
#include "springs/parts.h"

#include <stddef.h>
#include <string.h>

_Static_assert(offsetof(cdem_spring_row, coupling) == 1 * sizeof(double) &&
                   offsetof(cdem_spring_row, dir) == 2 * sizeof(double) &&
                   offsetof(cdem_spring_row, dual) == 5 * sizeof(double) &&
                   offsetof(cdem_spring_row, spring) == 8 * sizeof(double),
               "a row starts with stiffness, coupling, dir, dual, as in cdem_batch");

/* Four doubles: the widest vector that AVX2 and AVX-512 both exchange in single instructions. */
typedef double vec4 __attribute__((vector_size(32)));
typedef double vec4_at __attribute__((vector_size(32), aligned(8), may_alias));

/* Four fields of four lanes, from lane `first` on, as four neighbours in the row of each lane. */
CDEM_ALWAYS_INLINE void transpose(const cdem_lanes *field, int first, vec4 of_lane[4]) {
  vec4 a = *(const vec4_at *)&field[0][first], b = *(const vec4_at *)&field[1][first];
  vec4 c = *(const vec4_at *)&field[2][first], d = *(const vec4_at *)&field[3][first];
  vec4 ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  vec4 ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  vec4 cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  vec4 cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  of_lane[0] = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  of_lane[1] = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  of_lane[2] = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  of_lane[3] = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/* Everything of a set but the eight numbers a row. */
CDEM_ALWAYS_INLINE void put_labels(const cdem_batch *batch, int lane, int size,
                                   cdem_spring_set *set) {
  bool conjugate = batch->conjugate[lane] > 0.0;
  set->cond = batch->cond[lane];
  set->form = conjugate ? CDEM_FORM_COMPLEX : CDEM_FORM_DIAGONAL;
  set->size = set->rows = (uint8_t)size;
  set->slow = 0;
  int pair = conjugate ? size : 0; /* the last two springs couple to each other */
  for (int r = 0; r < size; r++) {
    set->row[r].spring = (int8_t)(r + 1);
    set->row[r].couples_to = 0;
  }
  set->row[size - 2].couples_to = (int8_t)pair;
  set->row[size - 1].couples_to = (int8_t)(conjugate ? size - 1 : 0);
  set->row[CDEM_SPRING_ROWS - 1] = (cdem_spring_row){0};
  if (size == 2)
    set->row[2] = (cdem_spring_row){0};
}

CDEM_MULTIVERSION void cdem_springs_store(const cdem_batch *batch, int size, int count,
                                          cdem_spring_set *const *set) {
  for (; count > 0; batch++, set += CDEM_SPRINGS_LANES, count -= CDEM_SPRINGS_LANES) {
    int lanes = count < CDEM_SPRINGS_LANES ? count : CDEM_SPRINGS_LANES;
    for (int r = 0; r < size; r++)
      for (int first = 0; first < lanes; first += 4) {
        vec4 low[4], high[4];
        transpose(batch->row[r], first, low);
        transpose(batch->row[r] + 4, first, high);
        for (int k = 0; k < 4 && first + k < lanes; k++) {
          if (set[first + k] == NULL)
            continue;
          vec4_at *to = (vec4_at *)&set[first + k]->row[r];
          to[0] = low[k];
          to[1] = high[k];
        }
      }
    for (int lane = 0; lane < lanes; lane++)
      if (set[lane] != NULL)
        put_labels(batch, lane, size, set[lane]);
  }
}
