/* The fast path: batches through the closed form, and the few blocks that it does not serve one by
 * one through the robust path. */
#include "springs/kernels.h"
#include "springs/parts.h"

#include <string.h>

static bool any_lane(const cdem_lanes truth) {
  double sum = 0.0;
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++)
    sum += truth[lane];
  return sum > 0.0;
}

static void decompose(const double *s, int size, int batches, cdem_batch *batch) {
  if (size == 2) {
    cdem_springs_kernel2(s, batches, batch);
    return;
  }
  cdem_springs_kernel3_single(s, batches, batch);
  cdem_springs_kernel3_directions(batches, batch);
  cdem_springs_kernel3_finish(s, batches, batch);
  for (int b = 0; b < batches; b++)
    if (any_lane(batch[b].wanting)) {
      cdem_springs_kernel3_improve(&batch[b]);
      cdem_springs_kernel3_directions(1, &batch[b]);
      cdem_springs_kernel3_finish(s + 9 * CDEM_SPRINGS_LANES * b, 1, &batch[b]);
    }
}

/* Frames where they are wanted, and the lanes that the closed form did not serve. */
static cdem_status finish_lane(const double *s, int lane, int size, bool accepted, bool frame,
                               cdem_spring_set *set, cdem_fault *fault) {
  double block[9];
  for (int e = 0; e < size * size; e++)
    block[e] = s[e * CDEM_SPRINGS_LANES + lane];
  if (accepted) { /* stays what it is unless it is a frame */
    if (frame)
      cdem_springs_recognise_frame(block, set);
    return CDEM_OK;
  }
  return cdem_springs_from_block(block, size, frame, set, fault);
}

cdem_status cdem_springs_from_blocks(const double *s, int64_t n, int size, const bool *frame,
                                     cdem_spring_set *set, cdem_fault *fault) {
  CDEM_REQUIRE(size == 2 || size == 3, fault, CDEM_NUMERIC,
               "stiffness blocks are %d x %d, and only 2 x 2 and 3 x 3 blocks have spring sets",
               size, size);
  enum { STRIDE = CDEM_SPRINGS_TOGETHER * CDEM_SPRINGS_LANES };
  cdem_batch batch[CDEM_SPRINGS_TOGETHER];
  for (int64_t first = 0; first < n; first += STRIDE) {
    const double *from = s + first * size * size;
    int count = n - first < STRIDE ? (int)(n - first) : STRIDE;
    int batches = (count + CDEM_SPRINGS_LANES - 1) / CDEM_SPRINGS_LANES;
    decompose(from, size, batches, batch);
    cdem_springs_store(batch, size, count, set + first);
    for (int k = 0; k < count; k++) {
      int b = k / CDEM_SPRINGS_LANES, lane = k % CDEM_SPRINGS_LANES;
      bool accepted = batch[b].accepted[lane] > 0.0, want = frame != NULL && frame[first + k];
      if (accepted && !want)
        continue;
      if (finish_lane(from + size * size * CDEM_SPRINGS_LANES * b, lane, size, accepted,
                      want && size == 3, &set[first + k], fault) != CDEM_OK) {
        memset(set, 0, sizeof *set * (size_t)n);
        cdem_fault_prefix(fault, "block %lld of %lld", (long long)(first + k), (long long)n);
        return CDEM_NUMERIC;
      }
    }
  }
  return CDEM_OK;
}
