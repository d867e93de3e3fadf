/* Blocks of rectangles and bricks by exact integration, for tests that must not lean on the room
 * elements. Shape functions are products of linear ones, so every integral is a product of
 *     integral f f = side/3 (same node) or side/6, integral f' f' = +-1/side, integral f' f =
 * +-1/2. An isotropic pair then is K_ab = lambda M_ab + G M_ba + G delta_ab sum_c M_cc. */
#ifndef CDEM_TESTS_SPRINGS_EXACT_H
#define CDEM_TESTS_SPRINGS_EXACT_H

#include "springs/springs.h"

typedef struct {
  int size; /* 2: rectangle, 3: brick */
  double side[3];
  int near_[3], far[3]; /* -1 or +1: which end of each side the two nodes stand at */
  double young;
  bool plane_stress;
} exact_pair;

static inline exact_pair exact_cube_pair(cdem_class class_) {
  int y = class_ == CDEM_CLASS_EDGE ? -1 : 1, z = class_ == CDEM_CLASS_BODY ? 1 : -1;
  return (exact_pair){
      .size = 3, .side = {1, 1, 1}, .near_ = {-1, -1, -1}, .far = {1, y, z}, .young = 1};
}

static inline void exact_moments(const exact_pair *pair, double m[3][3]) {
  for (int a = 0; a < pair->size; a++)
    for (int b = 0; b < pair->size; b++) {
      m[a][b] = 1.0;
      for (int d = 0; d < pair->size; d++) {
        double side = pair->side[d];
        bool same = pair->near_[d] == pair->far[d];
        if (a == d && b == d)
          m[a][b] *= (same ? 1.0 : -1.0) / side;
        else if (a == d)
          m[a][b] *= 0.5 * pair->near_[d];
        else if (b == d)
          m[a][b] *= 0.5 * pair->far[d];
        else
          m[a][b] *= side / (same ? 3.0 : 6.0);
      }
    }
}

/* S = -K from the two Lame constants. */
static inline void exact_lame_block(const exact_pair *pair, double lambda, double shear,
                                    double *s) {
  double m[3][3], trace = 0.0;
  int n = pair->size;
  exact_moments(pair, m);
  for (int a = 0; a < n; a++)
    trace += m[a][a];
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      s[n * a + b] = -(lambda * m[a][b] + shear * m[b][a] + (a == b ? shear * trace : 0.0));
}

static inline void exact_block(const exact_pair *pair, double nu, double *s) {
  double shear = pair->young / (2.0 * (1.0 + nu));
  double lambda =
      pair->young * nu / (pair->plane_stress ? 1.0 - nu * nu : (1.0 + nu) * (1.0 - 2.0 * nu));
  exact_lame_block(pair, lambda, shear, s);
}

#endif
