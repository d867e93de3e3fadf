/* When is a list outlived in a cell that deforms? Measured without the mean flow, which takes
 * grains far but leaves neighbours together.
 *
 * Since the build the lattice has gone by the gradient F = h h_built^-1, a grain from x_b to
 * x = x_b + u. With a centre c and a drift d that are the same for all, w = u - (F - I)(x_b - c) -
 * d, the vector between two grains (or images: these go with the lattice) is F b + w_j - w_i, b the
 * one at the build. A pair that was left out had |b| >= R + skin, R the sum of radii. So it does
 * not touch while sigma (R + skin) - 2 max|w| >= R, sigma the least stretch of F; the largest R
 * decides:
 *     2 max|w| + (1 - sigma) (2 r_max + skin) < skin.
 * Grains move before the cell does. So w is taken with an F that goes on as in the step before, and
 * its difference from the true one, times the largest |x_b - c|, is added. The drift is the mean
 * displacement, that goes on as before; any number would do. Walls do not go with the flow; with
 * them, the full ways count. */
#include "dem/solver_store.h"

#include <math.h>
#include <string.h>

static bool moves(const cdem_cell *cell) {
  bool any = false;
  for (int k = 0; k < 9; k++)
    any = any || cell->rate[k].kind != CDEM_SERIES_TABLE || cell->rate[k].points > 0;
  return any || cell->servo[0] || cell->servo[1] || cell->servo[2];
}

/* Edges at the build, from their images; unit vectors in free directions. */
static void built_edges(const cdem_dem_store *s, double h[9]) {
  for (int c = 0, one = 1; c < 3; c++, one *= 3)
    for (int r = 0; r < 3; r++)
      h[3 * r + c] = s->cell.periodic[c] ? s->core->built_image[CDEM_IMAGE_SELF + one][r]
                     : r == c            ? 1.0
                                         : 0.0;
}

void cdem_dem_flow_start(cdem_dem *dem) {
  cdem_dem_store *s = dem->store;
  cdem_dem_flow *flow = &s->core->flow;
  cdem_dem_flow before = *flow;
  *flow = (cdem_dem_flow){.on = s->pair_image != NULL && s->walls == NULL && moves(&s->cell)};
  if (!flow->on)
    return;
  memcpy(flow->more, before.more, sizeof flow->more);
  memcpy(flow->on_way, before.on_way, sizeof flow->on_way);
  double h[9];
  built_edges(s, h);
  cdem_inverse3(h, flow->inverse);
  for (int c = 0; c < 3; c++) {
    double edge[3] = {h[c], h[3 + c], h[6 + c]};
    for (int r = 0; r < 3 && s->cell.periodic[c]; r++)
      flow->center[r] += 0.5 * edge[r];
    flow->center[c] += s->cell.periodic[c] ? s->cell.corner[c] : 0.0;
    flow->reach += s->cell.periodic[c] ? 0.5 * cdem_norm3(edge) : 0.0;
  }
  for (int32_t i = 0; i < s->grains; i++)
    flow->largest = fmax(flow->largest, cdem_place(s, i)[3]);
}

void cdem_dem_flow_chunk(const cdem_dem *dem, int32_t chunk, cdem_dem_part *part) {
  const cdem_dem_store *s = dem->store;
  const cdem_dem_flow *flow = &s->core->flow;
  double most = 0.0, sum[3] = {0}, gradient[9], drift[3];
  for (int k = 0; k < 9; k++)
    gradient[k] = flow->gradient[k] + flow->more[k];
  for (int c = 0; c < 3; c++)
    drift[c] = flow->drift[c] + flow->on_way[c];
  for (int32_t i = cdem_chunk_from(dem, chunk); i < cdem_chunk_to(dem, chunk); i++) {
    const double *x = cdem_place(s, i), *u = s->core->since + 8 * (int64_t)i;
    double from[3], w2 = 0.0;
    for (int c = 0; c < 3; c++)
      from[c] = x[c] - u[c] - flow->center[c];
    for (int r = 0; r < 3; r++) {
      double w = u[r] - cdem_dot3(gradient + 3 * r, from);
      sum[r] += w;
      w -= drift[r];
      w2 += w * w;
    }
    most = w2 > most ? w2 : most;
  }
  part->moved2 = most;
  memcpy(part->drift, sum, sizeof sum);
}

/* Least eigenvalue of a symmetric matrix (Smith 1961). */
static double least_eigenvalue(const double e[9]) {
  double mean = (e[0] + e[4] + e[8]) / 3.0, b[9], square = 0.0;
  memcpy(b, e, sizeof b);
  for (int k = 0; k < 9; k += 4)
    b[k] -= mean;
  for (int k = 0; k < 9; k++)
    square += b[k] * b[k];
  double p = sqrt(square / 6.0);
  if (p == 0.0)
    return mean;
  for (int k = 0; k < 9; k++)
    b[k] /= p;
  double half = fmax(-1.0, fmin(1.0, 0.5 * cdem_det3(b)));
  return mean + 2.0 * p * cos((acos(half) + 2.0 * 3.14159265358979323846) / 3.0);
}

/* 1 - sigma, not below 0: F^T F = I + 2 E. */
static double shrinkage(const double g[9]) {
  double e[9];
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      e[3 * r + c] = 0.5 * (g[3 * r + c] + g[3 * c + r] + g[r] * g[c] + g[3 + r] * g[3 + c] +
                            g[6 + r] * g[6 + c]);
  double least = 1.0 + 2.0 * least_eigenvalue(e);
  return least < 1.0 ? 1.0 - sqrt(fmax(least, 0.0)) : 0.0;
}

bool cdem_dem_flow_outlived(cdem_dem *dem, double moved) {
  cdem_dem_store *s = dem->store;
  cdem_dem_flow *flow = &s->core->flow;
  double h[9], change[9], gradient[9], missed[9], sum[3] = {0};
  built_edges(s, h);
  for (int k = 0; k < 9; k++)
    change[k] = s->cell.periodic[k % 3] ? s->cell.h[k] - h[k] : 0.0;
  cdem_product3(change, flow->inverse, gradient);
  for (int k = 0; k < 9; k++) {
    double more = gradient[k] - flow->gradient[k];
    missed[k] = more - flow->more[k];
    flow->more[k] = more;
  }
  double stray = moved + cdem_frobenius(missed, 9) * flow->reach;
  for (int32_t c = 0; c < s->core->chunks; c++)
    for (int r = 0; r < 3; r++)
      sum[r] += s->core->part[c].drift[r];
  for (int r = 0; r < 3; r++) {
    double drift = sum[r] / s->grains;
    flow->on_way[r] = drift - flow->drift[r];
    flow->drift[r] = drift;
  }
  memcpy(flow->gradient, gradient, sizeof gradient);
  /* A part in 1e6 for the rounding of all that. */
  double lost = 2.0 * stray + shrinkage(gradient) * (2.0 * flow->largest + s->skin);
  return lost * (1.0 + 1e-6) >= s->skin;
}
