/* Forces of planes and plane Cosserat continua: part of body_kernels_width.h. The rotation is in
 * closed form: tan(angle) = (F_yx - F_xy)/(F_xx + F_yy), tr U the length of those two. */

/* h = grad u, row-major 2x2. */
INLINE void gradient2(int nodes, bool shared, const cdem_body_kind *kind, const double *record,
                      const lanes (*w)[3], lanes h[4]) {
  lanes a[4] = {0};
  for (int i = 1; i < nodes; i++)
    for (int r = 0; r < 2; r++)
      for (int k = 0; k < 2; k++)
        a[2 * r + k] += w[i][r] * kind->derivative[i][k];
  for (int r = 0; r < 2; r++)
    for (int c = 0; c < 2; c++)
      h[2 * r + c] = a[2 * r] * ENTRY(record, c) + a[2 * r + 1] * ENTRY(record, 2 + c);
}

/* e = (cos - 1, sin) with the digits of a small angle; *trace = tr U. */
INLINE void polar2(const lanes h[4], lanes e[2], lanes *trace) {
  lanes along = 2.0 + h[0] + h[3], across = h[2] - h[1];
  lanes length = along * along + across * across, zero = {0}, one = zero + 1.0;
  lane_mask good = length > 1e-200, forward = along > zero; /* else no direction at all */
  root(&length);
  select_lanes(&good, &length, &one, &length);
  lanes part = 1.0 / length, sum = length + along;
  select_lanes(&forward, &sum, &one, &sum);
  lanes small = -across * across * part / sum, large = (along - length) * part;
  select_lanes(&forward, &small, &large, &e[0]);
  e[1] = across * part;
  select_lanes(&good, &e[0], &zero, &e[0]);
  *trace = length;
}

/* w becomes d = w + E^T (X + w). */
INLINE void local2(int nodes, bool shared, const double *place, const lanes e[2], lanes (*w)[3]) {
  for (int i = 1; i < nodes; i++) {
    lanes x = ENTRY(place, 2 * i - 2) + w[i][0], y = ENTRY(place, 2 * i - 1) + w[i][1];
    w[i][0] += e[0] * x + e[1] * y;
    w[i][1] += e[0] * y - e[1] * x;
  }
}

/* The angle of R leaves the rotations, on the branch nearest to their mean. */
INLINE void branch(int nodes, const lanes h[4], lanes (*w)[3]) {
  lanes angle = {0}, mean = {0};
  for (int i = 0; i < nodes; i++)
    mean += w[i][2];
  mean *= 1.0 / nodes;
  for (int i = 0; i < WIDTH; i++) {
    double a = atan2(h[2][i] - h[1][i], 2.0 + h[0][i] + h[3][i]);
    angle[i] = a + 2.0 * M_PI * rint((mean[i] - a) / (2.0 * M_PI));
  }
  for (int i = 0; i < nodes; i++)
    w[i][2] -= angle;
}

INLINE void springs2(int nodes, bool shared, const double *s, const lanes (*d)[3], lanes (*f)[3]) {
  for (int i = 0; i < nodes; i++)
    f[i][0] = f[i][1] = f[i][2] = (lanes){0};
  for (int i = 0; i < nodes; i++)
    for (int j = i + 1; j < nodes; j++, s += 4 * (shared ? 1 : CDEM_LANES)) {
      lanes x = d[j][0] - d[i][0], y = d[j][1] - d[i][1];
      lanes a = ENTRY(s, 0), b = ENTRY(s, 1), c = ENTRY(s, 2), e = ENTRY(s, 3);
      f[i][0] += a * x + b * y;
      f[i][1] += c * x + e * y;
      f[j][0] -= a * x + c * y;
      f[j][1] -= b * x + e * y;
    }
}

/* g = d_j - T_ij d_i and back = d_i - T_ji d_j over the arm r = X_j - X_i. */
INLINE void elongations(bool cosserat, const lanes *di, const lanes *dj, const lanes r[2],
                        lanes g[3], lanes back[3]) {
  g[0] = dj[0] - di[0], g[1] = dj[1] - di[1];
  back[0] = -g[0], back[1] = -g[1];
  if (!cosserat)
    return;
  back[0] -= dj[2] * r[1], back[1] += dj[2] * r[0];
  g[0] += di[2] * r[1], g[1] -= di[2] * r[0];
  g[2] = dj[2] - di[2];
  back[2] = -g[2];
}

/* The arm from node i to node j of a record. */
#define ARM(r)                                                                                     \
  lanes r[2] = {ENTRY(place, 2 * j - 2), ENTRY(place, 2 * j - 1)};                                 \
  if (i > 0)                                                                                       \
  r[0] -= ENTRY(place, 2 * i - 2), r[1] -= ENTRY(place, 2 * i - 1)

/* f_i = sum S_ij (d_j - T_ij d_i), moments in f[i][2]. */
INLINE void springs_c(int nodes, bool shared, const double *place, const double *s,
                      const lanes (*d)[3], lanes (*f)[3]) {
  for (int i = 0; i < nodes; i++)
    f[i][0] = f[i][1] = f[i][2] = (lanes){0};
  for (int i = 0; i < nodes; i++)
    for (int j = i + 1; j < nodes; j++, s += 9 * (shared ? 1 : CDEM_LANES)) {
      ARM(r);
      lanes g[3], back[3];
      elongations(true, d[i], d[j], r, g, back);
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          lanes k = ENTRY(s, 3 * a + b);
          f[i][a] += k * g[b];
          f[j][b] += k * back[a];
        }
    }
}

/* couple: the sum of the moments of Cosserat nodes, which belong to M and do not turn. */
typedef struct {
  lanes e[2], trace, couple;
} frame2;

/* As finish3: h = M / tr U. */
INLINE void finish2(int nodes, bool shared, const cdem_body_kind *kind, const double *record,
                    const frame2 *frame, const lanes (*d)[3], lanes (*f)[3]) {
  const double *place = record + kind->place * (shared ? 1 : CDEM_LANES);
  const lanes *e = frame->e;
  lanes moment = frame->couple;
  for (int i = 1; i < nodes; i++) {
    lanes x = ENTRY(place, 2 * i - 2) + d[i][0], y = ENTRY(place, 2 * i - 1) + d[i][1];
    moment += x * f[i][1] - y * f[i][0];
  }
  lanes h = moment / frame->trace;
  lanes c[4] = {h * ENTRY(record, 1), h * ENTRY(record, 3), h * ENTRY(record, 0),
                h * ENTRY(record, 2)};
  for (int i = 0; i < nodes; i++) {
    const double *dn = kind->derivative[i];
    lanes x = f[i][0] + (c[0] * dn[0] + c[1] * dn[1]);
    lanes y = f[i][1] - (c[2] * dn[0] + c[3] * dn[1]);
    f[i][0] = x + (e[0] * x - e[1] * y);
    f[i][1] = y + (e[1] * x + e[0] * y);
  }
}

INLINE void plane_forces(const int nodes, const bool cosserat, const bool shared,
                         const cdem_body_task *task, int part, double *force, double *determinant) {
  const cdem_body_kind *kind = task->kind;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const int step = shared ? 1 : CDEM_LANES, dofs = cosserat ? 3 : 2;
  const double *place = record + kind->place * step, *s = record + kind->spring * step;
  lanes w[CDEM_BODY_NODES][3], f[CDEM_BODY_NODES][3], h[4];
  frame2 frame = {.couple = {0}};
  relative(nodes, dofs, 2, task, part, w);
  gradient2(nodes, shared, kind, record, (const lanes(*)[3])w, h);
  *(lanes_at *)(determinant + part * WIDTH) = 1.0 + (h[0] + h[3]) + (h[0] * h[3] - h[1] * h[2]);
  if (!task->linear) {
    polar2(h, frame.e, &frame.trace);
    local2(nodes, shared, place, frame.e, w);
    if (cosserat)
      branch(nodes, h, w);
  }
  if (cosserat)
    springs_c(nodes, shared, place, s, (const lanes(*)[3])w, f);
  else
    springs2(nodes, shared, s, (const lanes(*)[3])w, f);
  for (int i = 0; cosserat && i < nodes; i++)
    frame.couple += f[i][2];
  if (!task->linear)
    finish2(nodes, shared, kind, record, &frame, (const lanes(*)[3])w, f);
  lanes_at *out = (lanes_at *)(force + part * WIDTH);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < dofs; c++, out += PARTS)
      *out = f[i][c];
}

/* Pair energies -1/2 (d_i . S g + d_j . S^T back), d from the element's mean. */
INLINE void plane_energy(int nodes, bool cosserat, bool shared, const cdem_body_task *task,
                         int part, double *energy) {
  const cdem_body_kind *kind = task->kind;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const int step = shared ? 1 : CDEM_LANES, dofs = cosserat ? 3 : 2;
  const double *place = record + kind->place * step, *s = record + kind->spring * step;
  lanes w[CDEM_BODY_NODES][3], h[4], e[2], trace, sum[CDEM_CLASSES] = {0}, mean[2] = {0};
  relative(nodes, dofs, 2, task, part, w);
  gradient2(nodes, shared, kind, record, (const lanes(*)[3])w, h);
  if (!task->linear) {
    polar2(h, e, &trace);
    local2(nodes, shared, place, e, w);
    if (cosserat)
      branch(nodes, h, w);
  }
  close_up(nodes, 2, shared, place, task, part, w);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 2; c++)
      mean[c] += w[i][c] * (1.0 / nodes);
  for (int i = 0; i < nodes; i++)
    for (int c = 0; c < 2; c++)
      w[i][c] -= mean[c];
  for (int i = 0, p = 0; i < nodes; i++)
    for (int j = i + 1; j < nodes; j++, p++, s += dofs * dofs * step) {
      ARM(r);
      lanes g[3], back[3], both = {0};
      elongations(cosserat, w[i], w[j], r, g, back);
      for (int a = 0; a < dofs; a++)
        for (int b = 0; b < dofs; b++)
          both += ENTRY(s, dofs * a + b) * (w[i][a] * g[b] + w[j][b] * back[a]);
      sum[kind->class_[p]] -= 0.5 * both;
    }
  for (int c = 0; c < CDEM_CLASSES; c++)
    *(lanes_at *)(energy + CDEM_LANES * c + part * WIDTH) = sum[c];
}
#undef ARM
