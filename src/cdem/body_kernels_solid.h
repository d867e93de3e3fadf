/* Forces of solids: part of body_kernels_width.h. */

/* h = grad u = sum w_i (x) dN_i/dX, row-major. */
INLINE void gradient3(int nodes, bool shared, const cdem_body_kind *kind, const double *record,
                      const lanes (*w)[3], lanes h[9]) {
  lanes a[9] = {0};
  for (int i = 1; i < nodes; i++)
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < 3; k++)
        a[3 * r + k] += w[i][r] * kind->derivative[i][k];
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      h[3 * r + c] = a[3 * r] * ENTRY(record, c) + a[3 * r + 1] * ENTRY(record, 3 + c) +
                     a[3 * r + 2] * ENTRY(record, 6 + c);
}

/* det (I + h), 1 + tr h + the principal minors + det h. */
INLINE void determinant3(const lanes h[9], lanes *det) {
  lanes c0 = h[4] * h[8] - h[5] * h[7], c1 = h[5] * h[6] - h[3] * h[8];
  lanes c2 = h[3] * h[7] - h[4] * h[6];
  lanes minors = c0 + (h[0] * h[8] - h[2] * h[6]) + (h[0] * h[4] - h[1] * h[3]);
  *det = 1.0 + (h[0] + h[4] + h[8]) + minors + (h[0] * c0 + h[1] * c1 + h[2] * c2);
}

/* w becomes d = w + E^T (X + w). */
INLINE void local3(int nodes, bool shared, const double *place, const lanes e[9], lanes (*w)[3]) {
  for (int i = 1; i < nodes; i++) {
    lanes x = ENTRY(place, 3 * i - 3) + w[i][0], y = ENTRY(place, 3 * i - 2) + w[i][1];
    lanes z = ENTRY(place, 3 * i - 1) + w[i][2];
    for (int c = 0; c < 3; c++)
      w[i][c] += e[c] * x + e[3 + c] * y + e[6 + c] * z;
  }
}

/* f_i = sum S_ij (d_j - d_i): each pair's tensor is read once, the sum of its first node stays in
 * registers. */
INLINE void springs3(int nodes, bool shared, const double *s, const lanes (*d)[3], lanes (*f)[3]) {
  for (int i = 0; i < nodes; i++)
    f[i][0] = f[i][1] = f[i][2] = (lanes){0};
  for (int i = 0; i < nodes; i++) {
    lanes f0 = f[i][0], f1 = f[i][1], f2 = f[i][2];
    lanes d0 = d[i][0], d1 = d[i][1], d2 = d[i][2];
    for (int j = i + 1; j < nodes; j++, s += 9 * (shared ? 1 : CDEM_LANES)) {
      lanes x = d[j][0] - d0, y = d[j][1] - d1, z = d[j][2] - d2;
      lanes g0 = f[j][0], g1 = f[j][1], g2 = f[j][2], a = ENTRY(s, 0), b = ENTRY(s, 1);
      lanes c = ENTRY(s, 2);
      f0 += a * x, f0 += b * y, f0 += c * z;
      g0 -= a * x, g1 -= b * x, g2 -= c * x;
      a = ENTRY(s, 3), b = ENTRY(s, 4), c = ENTRY(s, 5);
      f1 += a * x, f1 += b * y, f1 += c * z;
      g0 -= a * y, g1 -= b * y, g2 -= c * y;
      a = ENTRY(s, 6), b = ENTRY(s, 7), c = ENTRY(s, 8);
      f2 += a * x, f2 += b * y, f2 += c * z;
      g0 -= a * z, g1 -= b * z, g2 -= c * z;
      f[j][0] = g0, f[j][1] = g1, f[j][2] = g2;
    }
    f[i][0] = f0, f[i][1] = f1, f[i][2] = f2;
  }
}

/* What a rotation is used as: E = R - I and the inverse of tr(U) I - U. */
typedef struct {
  lanes e[9], inverse[6];
} frame3;

/* The terms of dR/dx and the turn to global axes. With y_i = X_i + d_i the local places,
 * M = sum y_i x f_i and (tr(U) I - U) h = M, the exact gradient is R (f_i - h x grad N_i). */
INLINE void finish3(int nodes, bool shared, const cdem_body_kind *kind, const double *record,
                    const frame3 *frame, const lanes (*d)[3], lanes (*f)[3]) {
  const double *place = record + kind->place * (shared ? 1 : CDEM_LANES);
  const lanes *e = frame->e, *inverse = frame->inverse;
  lanes mx = {0}, my = {0}, mz = {0};
  for (int i = 1; i < nodes; i++) {
    lanes x = ENTRY(place, 3 * i - 3) + d[i][0], y = ENTRY(place, 3 * i - 2) + d[i][1];
    lanes z = ENTRY(place, 3 * i - 1) + d[i][2];
    mx += y * f[i][2] - z * f[i][1];
    my += z * f[i][0] - x * f[i][2];
    mz += x * f[i][1] - y * f[i][0];
  }
  lanes hx = inverse[0] * mx + inverse[5] * my + inverse[4] * mz;
  lanes hy = inverse[5] * mx + inverse[1] * my + inverse[3] * mz;
  lanes hz = inverse[4] * mx + inverse[3] * my + inverse[2] * mz;
  lanes c[9]; /* columns h x (row k of the inverse Jacobian) */
  for (int k = 0; k < 3; k++) {
    lanes x = ENTRY(record, 3 * k), y = ENTRY(record, 3 * k + 1), z = ENTRY(record, 3 * k + 2);
    c[k] = hy * z - hz * y;
    c[3 + k] = hz * x - hx * z;
    c[6 + k] = hx * y - hy * x;
  }
  for (int i = 0; i < nodes; i++) {
    const double *dn = kind->derivative[i];
    lanes x = f[i][0] - (c[0] * dn[0] + c[1] * dn[1] + c[2] * dn[2]);
    lanes y = f[i][1] - (c[3] * dn[0] + c[4] * dn[1] + c[5] * dn[2]);
    lanes z = f[i][2] - (c[6] * dn[0] + c[7] * dn[1] + c[8] * dn[2]);
    f[i][0] = x + (e[0] * x + e[1] * y + e[2] * z);
    f[i][1] = y + (e[3] * x + e[4] * y + e[5] * z);
    f[i][2] = z + (e[6] * x + e[7] * y + e[8] * z);
  }
}

/* One part of the batch. The number of nodes is known when compiled. */
INLINE void solid_forces(const int nodes, const bool cosserat, const bool shared,
                         const cdem_body_task *task, int part, double *force, double *determinant) {
  (void)cosserat;
  const cdem_body_kind *kind = task->kind;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const int step = shared ? 1 : CDEM_LANES;
  lanes w[CDEM_BODY_NODES][3], f[CDEM_BODY_NODES][3], h[9], det;
  frame3 frame;
  relative(nodes, 3, 3, task, part, w);
  gradient3(nodes, shared, kind, record, (const lanes(*)[3])w, h);
  determinant3(h, &det);
  *(lanes_at *)(determinant + part * WIDTH) = det;
  if (!task->linear) {
    polar(h, frame.e, frame.inverse);
    local3(nodes, shared, record + kind->place * step, frame.e, w);
  }
  springs3(nodes, shared, record + kind->spring * step, (const lanes(*)[3])w, f);
  if (!task->linear)
    finish3(nodes, shared, kind, record, &frame, (const lanes(*)[3])w, f);
  lanes_at *out = (lanes_at *)(force + part * WIDTH);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 3; c++, out += PARTS)
      *out = f[i][c];
}

/* Pair energies -1/2 (d_i . S g - d_j . S^T g), g = d_j - d_i, d from the element's mean. */
INLINE void solid_energy(int nodes, bool shared, const cdem_body_task *task, int part,
                         double *energy) {
  const cdem_body_kind *kind = task->kind;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const int step = shared ? 1 : CDEM_LANES;
  lanes w[CDEM_BODY_NODES][3], h[9], e[9], inverse[6], sum[CDEM_CLASSES] = {0}, mean[3] = {0};
  relative(nodes, 3, 3, task, part, w);
  gradient3(nodes, shared, kind, record, (const lanes(*)[3])w, h);
  if (!task->linear) {
    polar(h, e, inverse);
    local3(nodes, shared, record + kind->place * step, e, w);
  }
  close_up(nodes, 3, shared, record + kind->place * step, task, part, w);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 3; c++)
      mean[c] += w[i][c] * (1.0 / nodes);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 3; c++)
      w[i][c] -= mean[c];
  const double *s = record + kind->spring * step;
  for (int i = 0, p = 0; i < nodes; i++)
    for (int j = i + 1; j < nodes; j++, p++, s += 9 * step) {
      lanes g[3] = {w[j][0] - w[i][0], w[j][1] - w[i][1], w[j][2] - w[i][2]}, both = {0};
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
          both += ENTRY(s, 3 * a + b) * (w[i][a] * g[b] - w[j][b] * g[a]);
      sum[kind->class_[p]] -= 0.5 * both;
    }
  for (int c = 0; c < CDEM_CLASSES; c++)
    *(lanes_at *)(energy + CDEM_LANES * c + part * WIDTH) = sum[c];
}
