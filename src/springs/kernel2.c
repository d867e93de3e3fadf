/* Closed form of 2x2 blocks, a batch of 8 at a time: [[m + h, b], [c, m - h]] has the values
 * m +- sqrt(h^2 + b c). The same steps as for the plane of a pair in kernel3.c, in the axes. */
#include "springs/kernels.h"
#include "springs/parts.h"
#include "springs/plane.h"

CDEM_MULTIVERSION void cdem_springs_kernel2(const double *restrict s, int batches,
                                            cdem_batch *restrict batch) {
  for (; batches > 0; batches--, batch++, s += 4 * CDEM_SPRINGS_LANES)
    CDEM_SPRINGS_LANE_LOOP
  for (int lane = 0; lane < CDEM_SPRINGS_LANES; lane++) {
    double m0 = s[lane], m1 = s[8 + lane], m2 = s[16 + lane], m3 = s[24 + lane];
    double row0 = cdem_larger(fabs(m0), fabs(m1)), row1 = cdem_larger(fabs(m2), fabs(m3));
    double scale, unscale;
    cdem_powers_of_two(cdem_larger(row0, row1), &scale, &unscale);
    double m[4] = {m0 * scale, m1 * scale, m2 * scale, m3 * scale};
    double norm2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3], skew = m[1] - m[2];
    int symmetric = 2.0 * skew * skew <= CDEM_SPRINGS_ROUNDING * CDEM_SPRINGS_ROUNDING * norm2;
    cdem_plane_pair pair = cdem_solve_plane(m, symmetric, norm2);
    /* The canonical sign looks at the second component first. */
    double p0 = fabs(pair.a[1]) > CDEM_SPRINGS_TIE ? pair.a[1] : pair.a[0];
    double p1 = fabs(pair.b[1]) > CDEM_SPRINGS_TIE ? pair.b[1] : pair.b[0];
    double sign0 = copysign(1.0, p0), sign1 = pair.conjugate ? sign0 : copysign(1.0, p1);
    double ax = pair.a[0] * sign0 + 0.0, ay = pair.a[1] * sign0 + 0.0;
    double bx = pair.b[0] * sign1 + 0.0, by = pair.b[1] * sign1 + 0.0;
    double det = ax * by - ay * bx, inverse = 1.0 / det, cosine = fabs(ax * bx + ay * by);
    double qax = symmetric ? ax : by * inverse + 0.0, qay = symmetric ? ay : 0.0 - bx * inverse;
    double qbx = symmetric ? bx : 0.0 - ay * inverse, qby = symmetric ? by : ax * inverse + 0.0;
    double k0 = pair.mean + (pair.conjugate ? 0.0 : pair.split);
    double k1 = pair.mean - (pair.conjugate ? 0.0 : pair.split);
    double coupling = pair.conjugate ? pair.split : 0.0;
    double g0x = k0 * qax + coupling * qbx, g0y = k0 * qay + coupling * qby;
    double g1x = k1 * qbx - coupling * qax, g1y = k1 * qby - coupling * qay;
    double e0 = ax * g0x + bx * g1x - m[0], e1 = ax * g0y + bx * g1y - m[1];
    double e2 = ay * g0x + by * g1x - m[2], e3 = ay * g0y + by * g1y - m[3];
    double error = e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3;
    double cond = (1.0 + cosine) / fabs(det);
    const double bound2 = 0.01 * CDEM_SPRINGS_BOUND * CDEM_SPRINGS_BOUND;
    batch->cond[lane] = cond;
    batch->conjugate[lane] = pair.conjugate ? 1.0 : 0.0;
    double exact = error <= bound2 * norm2 ? 1.0 : 0.0, normal = unscale * norm2 > 0.0 ? 1.0 : 0.0;
    batch->accepted[lane] = exact * normal * (cond <= CDEM_SPRINGS_MAX_COND ? 1.0 : 0.0);
    batch->row[0][0][lane] = k0 * unscale + 0.0, batch->row[0][1][lane] = coupling * unscale;
    batch->row[1][0][lane] = k1 * unscale + 0.0, batch->row[1][1][lane] = 0.0 - coupling * unscale;
    batch->row[0][2][lane] = ax, batch->row[0][3][lane] = ay, batch->row[0][4][lane] = 0.0;
    batch->row[0][5][lane] = qax, batch->row[0][6][lane] = qay, batch->row[0][7][lane] = 0.0;
    batch->row[1][2][lane] = bx, batch->row[1][3][lane] = by, batch->row[1][4][lane] = 0.0;
    batch->row[1][5][lane] = qbx, batch->row[1][6][lane] = qby, batch->row[1][7][lane] = 0.0;
  }
}
