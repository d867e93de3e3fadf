/* The closed form of a batch of 8 blocks side by side: stages that check nothing and allocate
 * nothing, compiled for several processors. Every lane is computed by the same instructions,
 * whatever its neighbours are, so a block gives the same bits in any lane. Lanes for which the
 * closed form does not serve leave with `accepted` 0 (never a wrong set): they take the robust
 * path. */
#ifndef CDEM_SPRINGS_KERNELS_H
#define CDEM_SPRINGS_KERNELS_H

#include "springs/springs.h"

/* Squared residual above which a lane asks for `improve`: (2e-14)^2, a fifth of what is accepted.
 */
#define CDEM_SPRINGS_IMPROVE2 4e-28

enum { CDEM_SPRINGS_LANES = 8, CDEM_SPRINGS_FIELDS = 8 };

/* Before a loop over lanes: no lane writes what another reads. (clang has no such pragma and leaves
 * these loops scalar: right, but slower.) */
#if defined __GNUC__ && !defined __clang__
#define CDEM_SPRINGS_LANE_LOOP _Pragma("GCC ivdep")
#else
#define CDEM_SPRINGS_LANE_LOOP
#endif

/* One number a lane. Truth values are 0.0 and 1.0: masks as wide as the numbers they choose. */
typedef double cdem_lanes[CDEM_SPRINGS_LANES] __attribute__((aligned(64)));

/* A batch on its way through the stages. Numbers of `scale` times the block are in its units. */
typedef struct {
  /* The result. row [spring][field]: stiffness, coupling, dir, dual, as in cdem_spring_row. */
  cdem_lanes row[3][CDEM_SPRINGS_FIELDS];
  cdem_lanes cond;
  cdem_lanes conjugate; /* 1: the pair is complex, 0: diagonal */
  cdem_lanes accepted;  /* 1: equation (1) holds to a tenth of the bound and cond is small */
  cdem_lanes wanting;   /* 1: the residual asks for cdem_springs_kernel3_improve */
  /* In between (3x3). */
  cdem_lanes deviator[9]; /* scaled block less its mean stiffness, traceless */
  cdem_lanes mean, scale, unscale, norm2;
  cdem_lanes symmetric; /* 1: up to rounding; the deviator then is exactly symmetric */
  cdem_lanes left[3];   /* unit left eigenvector of the single value: normal of the pair's plane */
  cdem_lanes axis[3];   /* the global axis that gives the plane its first direction */
  cdem_lanes right[3];  /* right eigenvector of the single value */
  cdem_lanes p[3][3];   /* [spring][component] unit directions, canonical sign and order */
  cdem_lanes k[3];      /* scaled, less the mean */
  cdem_lanes coupling;
} cdem_batch;

/* Batches that go through a stage together: while one waits for its divisions, the processor works
 * on the next. */
enum { CDEM_SPRINGS_TOGETHER = 4 };

/* s: batches as cdem_springs_from_blocks takes them. */
void cdem_springs_kernel2(const double *s, int batches, cdem_batch *batch);

/* The stages of 3x3 batches, in order. */
void cdem_springs_kernel3_single(const double *s, int batches, cdem_batch *batch);
void cdem_springs_kernel3_directions(int batches, cdem_batch *batch);
void cdem_springs_kernel3_finish(const double *s, int batches, cdem_batch *batch);

/* One Newton step on the single eigenvectors of the lanes that want it; `directions` and `finish`
 * are then done again and give the other lanes the same bits. */
void cdem_springs_kernel3_improve(cdem_batch *batch);

/* The sets of the first `count` lanes, but NULL ones; those of lanes that are not accepted are to
 * be replaced. */
void cdem_springs_store(const cdem_batch *batch, int size, int count, cdem_spring_set *const *set);

#endif
