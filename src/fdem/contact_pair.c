/* How a triangle is touched by a node that is at x, d below the nearest point p of it.
 *
 * Node and triangle take opposite forces f and -f. Put at x and at p they leave a couple (x - p) x
 * f, which is zero for the push, along x - p, but not for friction: angular momentum would not be
 * kept. So both act at x, on material that goes with the triangle as a rigid body goes with three
 * of its points:
 *
 *     u(x) = sum w_i u_i + omega x (x - p) (1)
 *
 * with omega across the normal N from the out-of-plane ways of the corners, and along N their mean
 * rotation about the middle m of the corners (g_i: gradient of weight i in the plane):
 *
 *     omega = sum_i (N . u_i) g_i x N + N sum_i (x_i - m) x u_i . N / sum_i |x_i - m|^2 (2)
 *
 * Virtual work of -f on (1) gives the forces on the corners: with the couple C = -(x - p) x f,
 *
 *     r_i = -w_i f + (g_i . N x C) N + (C . N) N x (x_i - m)/sum |x_j - m|^2 (3)
 *
 * of resultant -f and moment -x x f. As slip is measured with (1) as well, a pair that moves as one
 * rigid body does not slip, and the power of friction is that of the forces on the nodes. (Ways are
 * of a step, with the triangle of its middle; forces with that of its end.) */
#include "fdem/contact_store.h"

void cdem_touched_triangle_set(cdem_touched_triangle *triangle, const double *corner[3],
                               const double weight[3], const double x[3]) {
  double ab[3], ac[3], middle[3];
  for (int c = 0; c < 3; c++) {
    ab[c] = corner[1][c] - corner[0][c];
    ac[c] = corner[2][c] - corner[0][c];
    middle[c] = (corner[0][c] + corner[1][c] + corner[2][c]) / 3.0;
    triangle->arm[c] =
        x[c] - (weight[0] * corner[0][c] + weight[1] * corner[1][c] + weight[2] * corner[2][c]);
  }
  cdem_cross3(ab, ac, triangle->normal);
  double twice = cdem_norm3(triangle->normal);
  triangle->spread = 0.0;
  for (int c = 0; c < 3; c++)
    triangle->normal[c] /= twice;
  for (int k = 0; k < 3; k++) {
    double across[3];
    for (int c = 0; c < 3; c++) {
      across[c] = corner[(k + 2) % 3][c] - corner[(k + 1) % 3][c];
      triangle->from_middle[k][c] = corner[k][c] - middle[c];
    }
    cdem_cross3(triangle->normal, across, triangle->slope[k]);
    for (int c = 0; c < 3; c++)
      triangle->slope[k][c] /= twice;
    triangle->spread += cdem_dot3(triangle->from_middle[k], triangle->from_middle[k]);
  }
}

void cdem_touched_triangle_carry(const cdem_touched_triangle *triangle, const double weight[3],
                                 double way[3][3], double carried[3]) {
  const double *n = triangle->normal;
  double omega[3] = {0.0, 0.0, 0.0}, about = 0.0, by[3];
  for (int k = 0; k < 3; k++) {
    double tilt[3], turn[3], along = cdem_dot3(n, way[k]);
    cdem_cross3(triangle->slope[k], n, tilt);
    cdem_cross3(triangle->from_middle[k], way[k], turn);
    about += cdem_dot3(turn, n) / triangle->spread;
    for (int c = 0; c < 3; c++)
      omega[c] += along * tilt[c];
  }
  for (int c = 0; c < 3; c++)
    omega[c] += about * n[c];
  cdem_cross3(omega, triangle->arm, by);
  for (int c = 0; c < 3; c++)
    carried[c] = weight[0] * way[0][c] + weight[1] * way[1][c] + weight[2] * way[2][c] + by[c];
}

void cdem_touched_triangle_take(const cdem_touched_triangle *triangle, const double weight[3],
                                const double force[3], double reaction[3][3]) {
  const double *n = triangle->normal;
  double couple[3], across[3];
  cdem_cross3(force, triangle->arm, couple);
  cdem_cross3(n, couple, across);
  double about = cdem_dot3(couple, n) / triangle->spread;
  for (int k = 0; k < 3; k++) {
    double turn[3], tilt = cdem_dot3(triangle->slope[k], across);
    cdem_cross3(n, triangle->from_middle[k], turn);
    for (int c = 0; c < 3; c++)
      reaction[k][c] = -weight[k] * force[c] + tilt * n[c] + about * turn[c];
  }
}
