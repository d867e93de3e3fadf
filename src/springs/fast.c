/* The fast path: batches through the closed form, and the few blocks that it does not serve one by
 * one through the robust path. */
#include "springs/kernels.h"
#include "springs/parts.h"

#include <math.h>
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

/* Can the set that the closed form found be that of a frame? The eigenvalues of a block within
 * CDEM_SPRINGS_FRAME_BOUND of a symmetric one lie as near to its own (Bauer and Fike), so two of
 * them nearly agree; anything farther apart need not be looked at. */
static bool may_be_frame(const cdem_spring_set *set) {
  const cdem_spring_row *row = set->row;
  double largest =
      fmax(fabs(row[0].stiffness), fmax(fabs(row[1].stiffness), fabs(row[2].stiffness)));
  double near = 1e-9 * largest;
  return fabs(row[1].coupling) <= near && (fabs(row[0].stiffness - row[1].stiffness) <= near ||
                                           fabs(row[1].stiffness - row[2].stiffness) <= near);
}

/* Frames where they are wanted, and the lanes that the closed form did not serve. */
static cdem_status finish_lane(const double *s, int lane, int size, bool accepted, bool frame,
                               cdem_spring_set *set, cdem_fault *fault) {
  if (accepted && !(frame && may_be_frame(set)))
    return CDEM_OK;
  double block[9];
  for (int e = 0; e < size * size; e++)
    block[e] = s[e * CDEM_SPRINGS_LANES + lane];
  if (!accepted)
    return cdem_springs_from_block(block, size, frame, set, fault);
  cdem_springs_recognise_frame(block, set); /* stays what it is unless it is a frame */
  return CDEM_OK;
}

enum { STRIDE = CDEM_SPRINGS_TOGETHER * CDEM_SPRINGS_LANES };

/* Up to STRIDE blocks, into the sets that are wanted. */
static cdem_status do_together(const double *s, int count, int size, const bool *frame,
                               cdem_spring_set *const *set, int *failed, cdem_fault *fault) {
  cdem_batch batch[CDEM_SPRINGS_TOGETHER];
  decompose(s, size, (count + CDEM_SPRINGS_LANES - 1) / CDEM_SPRINGS_LANES, batch);
  cdem_springs_store(batch, size, count, set);
  for (*failed = 0; *failed < count; ++*failed) {
    int k = *failed, b = k / CDEM_SPRINGS_LANES, lane = k % CDEM_SPRINGS_LANES;
    if (set[k] != NULL)
      CDEM_TRY(finish_lane(s + size * size * CDEM_SPRINGS_LANES * b, lane, size,
                           batch[b].accepted[lane] > 0.0, size == 3 && frame != NULL && frame[k],
                           set[k], fault));
  }
  return CDEM_OK;
}

cdem_status cdem_springs_from_blocks_to(const double *s, int64_t n, int size, const bool *frame,
                                        cdem_spring_set *const *set, cdem_fault *fault) {
  CDEM_REQUIRE(size == 2 || size == 3, fault, CDEM_NUMERIC,
               "stiffness blocks are %d x %d, and only 2 x 2 and 3 x 3 blocks have spring sets",
               size, size);
  for (int64_t first = 0; first < n; first += STRIDE) {
    int count = n - first < STRIDE ? (int)(n - first) : STRIDE, failed;
    if (do_together(s + first * size * size, count, size, frame != NULL ? frame + first : NULL,
                    set + first, &failed, fault) == CDEM_OK)
      continue;
    for (int64_t i = 0; i < n; i++)
      if (set[i] != NULL)
        memset(set[i], 0, sizeof *set[i]);
    cdem_fault_prefix(fault, "block %lld of %lld", (long long)(first + failed), (long long)n);
    return CDEM_NUMERIC;
  }
  return CDEM_OK;
}

cdem_status cdem_springs_from_blocks(const double *s, int64_t n, int size, const bool *frame,
                                     cdem_spring_set *set, cdem_fault *fault) {
  CDEM_REQUIRE(size == 2 || size == 3, fault, CDEM_NUMERIC,
               "stiffness blocks are %d x %d, and only 2 x 2 and 3 x 3 blocks have spring sets",
               size, size);
  for (int64_t first = 0; first < n; first += STRIDE) {
    cdem_spring_set *to[STRIDE];
    int count = n - first < STRIDE ? (int)(n - first) : STRIDE, failed;
    for (int k = 0; k < count; k++)
      to[k] = set + first + k;
    if (do_together(s + first * size * size, count, size, frame != NULL ? frame + first : NULL, to,
                    &failed, fault) == CDEM_OK)
      continue;
    memset(set, 0, sizeof *set * (size_t)n);
    cdem_fault_prefix(fault, "block %lld of %lld", (long long)(first + failed), (long long)n);
    return CDEM_NUMERIC;
  }
  return CDEM_OK;
}
