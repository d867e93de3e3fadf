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

#define LOW(a, b)   __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define HIGH(a, b)  __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define LOW2(a, b)  __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define HIGH2(a, b) __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#define LOW4(a, b)  __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)
#define HIGH4(a, b) __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15)

/* out[lane] = the eight fields of one lane: three rounds of exchange, at distance 1, 2 and 4. */
CDEM_ALWAYS_INLINE void transpose(const cdem_lanes *field, cdem_vec8 out[8]) {
  const cdem_vec8 *f = (const cdem_vec8 *)field;
  cdem_vec8 a0 = LOW(f[0], f[1]), a1 = HIGH(f[0], f[1]), a2 = LOW(f[2], f[3]),
            a3 = HIGH(f[2], f[3]), a4 = LOW(f[4], f[5]), a5 = HIGH(f[4], f[5]),
            a6 = LOW(f[6], f[7]), a7 = HIGH(f[6], f[7]);
  cdem_vec8 b0 = LOW2(a0, a2), b1 = LOW2(a1, a3), b2 = HIGH2(a0, a2), b3 = HIGH2(a1, a3),
            b4 = LOW2(a4, a6), b5 = LOW2(a5, a7), b6 = HIGH2(a4, a6), b7 = HIGH2(a5, a7);
  out[0] = LOW4(b0, b4), out[1] = LOW4(b1, b5), out[2] = LOW4(b2, b6), out[3] = LOW4(b3, b7);
  out[4] = HIGH4(b0, b4), out[5] = HIGH4(b1, b5), out[6] = HIGH4(b2, b6), out[7] = HIGH4(b3, b7);
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
                                          cdem_spring_set *set) {
  for (; count > 0; batch++, set += CDEM_SPRINGS_LANES, count -= CDEM_SPRINGS_LANES) {
    int lanes = count < CDEM_SPRINGS_LANES ? count : CDEM_SPRINGS_LANES;
    for (int r = 0; r < size; r++) {
      cdem_vec8 of_lane[CDEM_SPRINGS_LANES];
      transpose(batch->row[r], of_lane);
      for (int lane = 0; lane < lanes; lane++)
        *(cdem_vec8_at *)&set[lane].row[r] = of_lane[lane];
    }
    for (int lane = 0; lane < lanes; lane++)
      put_labels(batch, lane, size, &set[lane]);
  }
}
