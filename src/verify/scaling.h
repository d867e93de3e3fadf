/* Private to verify: what the checks of the group "scaling" measure. Each function fills one
 * number; the parameter chooses the case.
 *
 * To add a topic: a file scaling_TOPIC.c with its measure, a line in the list below, its checks in
 * scaling.c. cdem_scaling_pair does the work for whole runs. */
#ifndef CDEM_VERIFY_SCALING_H
#define CDEM_VERIFY_SCALING_H

#include "base/base.h"
#include "scaling/scaling.h"

#define CDEM_SCALING_MEASURES(X)                                                                   \
  X(bits)     /* 10 case (cdem_scaling_case) + 0 h = 2, 1 h = 4, 2 h = 1/2, 3 length 2, time 4,    \
                 density 1: numbers of history and checkpoint that are not the original's times a  \
                 power of two */                                                                   \
  X(rounding) /* case: h = 3, largest difference of the histories by the largest value of the same \
                 unit */                                                                           \
  X(window) /* coarse graining by 2 of a cubic lattice that is pressed together: 0 its stress over \
               the closed form, 1 that of the coarse one over it, 2 without the rule, 3 Hertz      \
               without the rule, 4 steps of the coarse one over its own, 5 the same at the same    \
               rate */                                                                             \
  X(ratios) /* table 1 of the source and what follows from it: worst relative error of the         \
               factors, h = 3 */

#define X(name)                                                                                    \
  cdem_status cdem_scaling_measure_##name(int parameter, double *value, cdem_fault *fault);
CDEM_SCALING_MEASURES(X)
#undef X

/* A case and its scaled copy, both run; how far the results are from each other's scaled ones. */
typedef struct {
  int64_t numbers; /* that were compared */
  int64_t off;     /* that are not the original's times their factor, to the last bit */
  double apart;    /* largest difference in the history by the largest value of its dimension */
  char first[160]; /* the first that is off */
  char worst[80];  /* the column of `apart` */
} cdem_scaling_difference;

/* `text` is a case without files. Columns of the history are compared by the dimension of their
 * units; arrays of the last checkpoint, which have none, by one power of two for all numbers of an
 * array, or for each component of an array of vectors (bits: powers of two alone). */
cdem_status cdem_scaling_pair(const char *text, const cdem_ratios *ratios, bool bits,
                              cdem_scaling_difference *difference, cdem_fault *fault);

/* The last value of a column of the history: of the case, and of its scaled copy. */
cdem_status cdem_scaling_last(const char *text, cdem_scaling scaling, const char *column,
                              double value[2], cdem_fault *fault);

typedef enum {
  CDEM_SCALING_BODY,     /* one elastic body under loads that vary in time, 2-D */
  CDEM_SCALING_FRACTURE, /* blocks that break and touch between plates, 2-D */
  CDEM_SCALING_SOLID,    /* blocks that break under gravity on a plate, 3-D */
  CDEM_SCALING_SPHERES,  /* Mindlin, walls, gravity */
  CDEM_SCALING_HERTZ,    /* Hertz, periodic cell with a servo */
  CDEM_SCALING_DISCS,    /* linear with rolling, compacted, walls with a servo */
  CDEM_SCALING_STATIC,   /* Cosserat, static */
  CDEM_SCALING_BONDED,   /* bonded spheres, relaxed */
  CDEM_SCALING_FOOTING,  /* grains in a Cosserat medium */
  CDEM_SCALING_FDEM,     /* deformable grains in a tube, implicit */
  CDEM_SCALING_EXPLICIT, /* the same with every vibration resolved, damped */
  CDEM_SCALING_TRIAXIAL, /* spheres, law penalty, in a membrane */
  CDEM_SCALING_DEFORMED, /* deformable grains in a membrane */
  CDEM_SCALING_CASES
} cdem_scaling_case;
extern const char *const cdem_scaling_text[CDEM_SCALING_CASES];

#endif
