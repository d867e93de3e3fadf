/* Rotations of CDEM_LANES elements: part of body_kernels_width.h.
 *
 * R is kept as a unit quaternion (w, v) and used as E = R - I, so that a small rotation keeps its
 * digits. Where |grad u| is small, v = 0 is near enough to start from; elsewhere the quaternion is
 * the eigenvector of the largest eigenvalue of Davenport's 4x4 matrix N(F), q.N(F)q = R(q) : F
 * (Horn 1987), which belongs to the polar rotation for any angle and any strain with det F > 0, and
 * to a proper rotation for others. The eigenvalue is tr U = the largest root of x^4 - 2 |F|^2 x^2 -
 * 8 det F x + |F|^4 - 4 |cof F|^2, found by Newton from sqrt(3) |F|, which is never below it; the
 * eigenvector the longest column of adj(N - x I). Either start is then corrected by Newton's method
 * for the skew part of R^T F, (tr(S) I - S) theta = 2 axial(R^T F),  S = sym(R^T F), which is
 * quadratic.
 */

/* Inverse of a symmetric 3x3 (xx yy zz yz xz xy), zero where it is singular. */
INLINE void symmetric(const lanes k[6], lanes inverse[6]) {
  inverse[0] = k[1] * k[2] - k[3] * k[3];
  inverse[1] = k[0] * k[2] - k[4] * k[4];
  inverse[2] = k[0] * k[1] - k[5] * k[5];
  inverse[3] = k[4] * k[5] - k[0] * k[3];
  inverse[4] = k[3] * k[5] - k[1] * k[4];
  inverse[5] = k[3] * k[4] - k[2] * k[5];
  lanes det = k[0] * inverse[0] + k[5] * inverse[5] + k[4] * inverse[4];
  lanes trace = k[0] + k[1] + k[2], zero = {0}, one = zero + 1.0;
  lane_mask good = (det > FLAT_STRETCH * trace * trace * trace) & (trace > zero);
  select_lanes(&good, &det, &one, &det);
  lanes factor = 1.0 / det;
  select_lanes(&good, &factor, &zero, &factor);
  for (int i = 0; i < 6; i++)
    inverse[i] *= factor;
}

/* e = R - I = 2 w [v] + 2 [v][v], row-major. */
INLINE void turn_matrix(const lanes q[4], lanes e[9]) {
  lanes x = q[1], y = q[2], z = q[3], w = q[0];
  e[0] = -2.0 * (y * y + z * z);
  e[4] = -2.0 * (x * x + z * z);
  e[8] = -2.0 * (x * x + y * y);
  lanes a = x * y, b = w * z;
  e[1] = 2.0 * (a - b), e[3] = 2.0 * (a + b);
  a = x * z, b = w * y;
  e[2] = 2.0 * (a + b), e[6] = 2.0 * (a - b);
  a = y * z, b = w * x;
  e[5] = 2.0 * (a - b), e[7] = 2.0 * (a + b);
}

/* R of q against h = F - I: e = R - I, the inverse of tr(S) I - S, and the correction theta. */
INLINE void turned_from(const lanes q[4], const lanes h[9], lanes e[9], lanes inverse[6],
                        lanes theta[3]) {
  turn_matrix(q, e);
  lanes b[9]; /* R^T F - I = E^T + H + E^T H */
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      b[3 * i + j] =
          e[3 * j + i] + h[3 * i + j] + (e[i] * h[j] + e[3 + i] * h[3 + j] + e[6 + i] * h[6 + j]);
  lanes k[6] = {2.0 + b[4] + b[8],    2.0 + b[0] + b[8],    2.0 + b[0] + b[4],
                -0.5 * (b[5] + b[7]), -0.5 * (b[2] + b[6]), -0.5 * (b[1] + b[3])};
  symmetric(k, inverse);
  lanes x = b[7] - b[5], y = b[2] - b[6], z = b[3] - b[1];
  theta[0] = inverse[0] * x + inverse[5] * y + inverse[4] * z;
  theta[1] = inverse[5] * x + inverse[1] * y + inverse[3] * z;
  theta[2] = inverse[4] * x + inverse[3] * y + inverse[2] * z;
}

/* q <- q (1, theta/2), brought back to unit length by Newton's step for 1/sqrt, which needs no
 * root: the length is off by |theta|^2/8 only. */
INLINE void compose(const lanes theta[3], lanes q[4]) {
  lanes x = 0.5 * theta[0], y = 0.5 * theta[1], z = 0.5 * theta[2];
  lanes w = q[0], a = q[1], b = q[2], c = q[3];
  q[0] = w - (a * x + b * y + c * z);
  q[1] = a + (w * x + (b * z - c * y));
  q[2] = b + (w * y + (c * x - a * z));
  q[3] = c + (w * z + (a * y - b * x));
  lanes excess = (q[0] - 1.0) * (q[0] + 1.0) + (q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  lanes factor = 1.0 - excess * (0.5 - 0.375 * excess);
  for (int i = 0; i < 4; i++)
    q[i] *= factor;
}

/* The largest root of the quartic for f of norm^2 three. */
INLINE void largest_root(const lanes f[9], lanes *out) {
  lanes cof[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int r = (i + 1) % 3, s = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
      cof[3 * i + j] = f[3 * r + k] * f[3 * s + l] - f[3 * r + l] * f[3 * s + k];
    }
  lanes size = {0}, det = f[0] * cof[0] + f[1] * cof[1] + f[2] * cof[2];
  for (int i = 0; i < 9; i++)
    size += cof[i] * cof[i];
  lanes c0 = 9.0 - 4.0 * size, c1 = -8.0 * det, x = (lanes){0} + 3.0, zero = {0};
  for (int step = 0; step < MAX_ROOTS; step++) {
    lanes x2 = x * x, value = (x2 - 6.0) * x2 + (c1 * x + c0);
    lanes slope = 4.0 * x * (x2 - 3.0) + c1;
    lane_mask good = (value > zero) & (slope > zero); /* at the root rounding makes any sign */
    lanes down = value / slope, enough = zero + 1e-9;
    select_lanes(&good, &down, &zero, &down);
    x -= down;
    if (reaches(&down, &enough))
      break;
  }
  *out = x;
}

/* The longest column of the adjugate of a symmetric 4x4, of unit length. */
INLINE void best_column(lanes m[4][4], lanes q[4]) {
  static const int8_t pair[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  lanes s[6], c[6];
  for (int p = 0; p < 6; p++) {
    int a = pair[p][0], b = pair[p][1];
    s[p] = m[0][a] * m[1][b] - m[0][b] * m[1][a];
    c[p] = m[2][a] * m[3][b] - m[2][b] * m[3][a];
  }
  lanes adj[4][4];
  adj[0][0] = m[1][1] * c[5] - m[1][2] * c[4] + m[1][3] * c[3];
  adj[0][1] = -m[0][1] * c[5] + m[0][2] * c[4] - m[0][3] * c[3];
  adj[0][2] = m[3][1] * s[5] - m[3][2] * s[4] + m[3][3] * s[3];
  adj[0][3] = -m[2][1] * s[5] + m[2][2] * s[4] - m[2][3] * s[3];
  adj[1][1] = m[0][0] * c[5] - m[0][2] * c[2] + m[0][3] * c[1];
  adj[1][2] = -m[3][0] * s[5] + m[3][2] * s[2] - m[3][3] * s[1];
  adj[1][3] = m[2][0] * s[5] - m[2][2] * s[2] + m[2][3] * s[1];
  adj[2][2] = m[3][0] * s[4] - m[3][1] * s[2] + m[3][3] * s[0];
  adj[2][3] = -m[2][0] * s[4] + m[2][1] * s[2] - m[2][3] * s[0];
  adj[3][3] = m[2][0] * s[3] - m[2][1] * s[1] + m[2][2] * s[0];
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < i; j++)
      adj[i][j] = adj[j][i];
  }
  lanes best = -adj[0][0]; /* all diagonals are negative: three other eigenvalues lie below */
  for (int i = 0; i < 4; i++)
    q[i] = adj[0][i];
  for (int k = 1; k < 4; k++) {
    lanes here = -adj[k][k];
    lane_mask better = here > best;
    select_lanes(&better, &here, &best, &best);
    for (int i = 0; i < 4; i++)
      select_lanes(&better, &adj[k][i], &q[i], &q[i]);
  }
  lanes length = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], zero = {0};
  lane_mask good = length > zero;
  root(&length);
  lanes factor = 1.0 / length, one = zero + 1.0;
  for (int i = 0; i < 4; i++) {
    lanes unit = q[i] * factor;
    select_lanes(&good, &unit, i == 0 ? &one : &zero, &q[i]);
  }
}

/* The quaternion of the rotation nearest to F = I + h. */
INLINE void best_turn(const lanes h[9], lanes q[4]) {
  lanes f[9], size = {0}, x, m[4][4];
  for (int i = 0; i < 9; i++) {
    f[i] = h[i] + (i % 4 == 0 ? 1.0 : 0.0);
    size += f[i] * f[i];
  }
  size *= 1.0 / 3.0;
  root(&size);
  lanes factor = 1.0 / size;
  for (int i = 0; i < 9; i++)
    f[i] *= factor;
  largest_root(f, &x);
  m[0][0] = f[0] + f[4] + f[8] - x;
  m[1][1] = f[0] - f[4] - f[8] - x;
  m[2][2] = f[4] - f[0] - f[8] - x;
  m[3][3] = f[8] - f[0] - f[4] - x;
  m[0][1] = m[1][0] = f[7] - f[5];
  m[0][2] = m[2][0] = f[2] - f[6];
  m[0][3] = m[3][0] = f[3] - f[1];
  m[1][2] = m[2][1] = f[1] + f[3];
  m[1][3] = m[3][1] = f[2] + f[6];
  m[2][3] = m[3][2] = f[5] + f[7];
  best_column(m, q);
}

/* e = R - I of the polar rotation of I + h, and the inverse of tr(U) I - U. */
INLINE void polar(const lanes h[9], lanes e[9], lanes inverse[6]) {
  lanes q[4], theta[3] = {h[7] - h[5], h[2] - h[6], h[3] - h[1]}, size = {0};
  lanes near = (lanes){0} + NEAR_IDENTITY, zero = {0}, one = zero + 1.0;
  for (int i = 0; i < 9; i++)
    size += h[i] * h[i];
  q[0] = one, q[1] = zero, q[2] = zero, q[3] = zero;
  for (int i = 0; i < 3; i++)
    theta[i] *= 0.5; /* the correction at q = 1 for U = I */
  compose(theta, q);
  if (!reaches(&size, &near)) {
    lanes best[4];
    lane_mask far = size > near;
    best_turn(h, best);
    for (int i = 0; i < 4; i++)
      select_lanes(&far, &best[i], &q[i], &q[i]);
  }
  lanes bound = (TURN_FOUND * TURN_FOUND) * size;
  for (int step = 0;; step++) {
    turned_from(q, h, e, inverse, theta);
    lanes off = theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2];
    if (step == MAX_TURNS || reaches(&off, &bound))
      return;
    for (int i = 0; i < 3; i++) /* half a radian at most; at third order else */
      theta[i] /= 1.0 + off;
    compose(theta, q);
  }
}
