/* Materials without tension: part of body_kernels_width.h. First the frames and mean strains of a
 * batch, then its openings (tension_law.h explains and is the reference), then, when something has
 * opened, its forces less the tension. body_tension.c leads from one to the next. */

/* Mean of grad u, row-major [n][n]; mean: volume, then gradients [nodes][n]. */
INLINE void mean_gradient(int nodes, int n, bool shared, const double *mean, const lanes (*w)[3],
                          lanes *h) {
  for (int e = 0; e < n * n; e++)
    h[e] = (lanes){0};
  for (int i = 1; i < nodes; i++)
    for (int r = 0; r < n; r++)
      for (int c = 0; c < n; c++)
        h[n * r + c] += w[i][r] * ENTRY(mean, 1 + n * i + c);
}

INLINE void solid_frames(const int nodes, const cdem_body_task *task, const double *mean, int part,
                         cdem_body_frames *frames) {
  const bool shared = task->shared;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const double *own = mean + (shared ? 0 : part * WIDTH);
  lanes w[CDEM_BODY_NODES][3], h[9], m[9], e[9] = {0}, inverse[6] = {0};
  relative(nodes, 3, 3, task, part, w);
  gradient3(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
  mean_gradient(nodes, 3, shared, own, (const lanes(*)[3])w, m);
  if (!task->linear)
    polar(h, e, inverse);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      *(lanes_at *)(frames->b[3 * i + j] + part * WIDTH) =
          e[3 * j + i] + m[3 * i + j] + (e[i] * m[j] + e[3 + i] * m[3 + j] + e[6 + i] * m[6 + j]);
  for (int k = 0; k < 9; k++)
    *(lanes_at *)(frames->e[k] + part * WIDTH) = e[k];
  for (int k = 0; k < 6; k++)
    *(lanes_at *)(frames->inverse[k] + part * WIDTH) = inverse[k];
}

INLINE void plane_frames(const int nodes, const int dofs, const cdem_body_task *task,
                         const double *mean, int part, cdem_body_frames *frames) {
  const bool shared = task->shared;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const double *own = mean + (shared ? 0 : part * WIDTH);
  lanes w[CDEM_BODY_NODES][3], h[4], m[4], e[2] = {0}, trace, zero = {0}, about_z = {0};
  relative(nodes, dofs, 2, task, part, w);
  gradient2(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
  mean_gradient(nodes, 2, shared, own, (const lanes(*)[3])w, m);
  if (!task->linear) {
    polar2(h, e, &trace);
    about_z = 1.0 / trace;
  }
  const lanes turn[9] = {e[0], -e[1], zero, e[1], e[0], zero, zero, zero, zero};
  lanes b[9] = {0};
  for (int j = 0; j < 2; j++) { /* as in plane_stress */
    b[j] = m[j] + (e[0] * m[j] + e[1] * m[2 + j]) + (j == 0 ? e[0] : e[1]);
    b[3 + j] = m[2 + j] + (e[0] * m[2 + j] - e[1] * m[j]) + (j == 0 ? -e[1] : e[0]);
  }
  for (int k = 0; k < 9; k++) {
    *(lanes_at *)(frames->b[k] + part * WIDTH) = b[k];
    *(lanes_at *)(frames->e[k] + part * WIDTH) = turn[k];
  }
  for (int k = 0; k < 6; k++) /* only a turn about z meets anything */
    *(lanes_at *)(frames->inverse[k] + part * WIDTH) = k == 2 ? about_z : zero;
}

INLINE bool any_lane(const lane_mask *mask) {
  int64_t any = 0;
  for (int i = 0; i < WIDTH; i++)
    any |= (*mask)[i];
  return any != 0;
}

/* cdem_tension_open_plane side by side, isotropic: k0 = D11 + D12, k1 = D11 - D12. */
INLINE void open_planes(const lanes *k0, const lanes *k1, const lanes strain[6], lanes a[6]) {
  lanes zero = {0}, one = zero + 1.0;
  lanes mean = 0.5 * (strain[0] + strain[1]), half = 0.5 * (strain[0] - strain[1]);
  lanes shear = 0.5 * strain[5], r = half * half + shear * shear;
  root(&r);
  lanes most = *k0 * mean + *k1 * r, part = most / (*k0 + *k1), length = r;
  lane_mask opens = most > zero, all = mean >= r, round = r > zero;
  select_lanes(&round, &length, &one, &length);
  lanes along = part * half / length, across = part * shear / length;
  select_lanes(&all, &mean, &part, &part);
  select_lanes(&all, &half, &along, &along);
  select_lanes(&all, &shear, &across, &across);
  const lanes out[6] = {part + along, part - along, zero, zero, zero, 2.0 * across};
  for (int v = 0; v < 6; v++)
    select_lanes(&opens, &out[v], &zero, &a[v]);
}

/* One of Jacobi's rotations, as in cdem_tension_principal: m in Voigt order with m[off] between the
 * axes p and q, m[rp] and m[rq] between these and the third. */
INLINE void turn_axes(int p, int q, int off, int rp, int rq, lanes m[6], lanes n[3][3]) {
  lanes zero = {0}, one = zero + 1.0, half = 0.5 * (m[q] - m[p]), b = m[off];
  lanes length = half * half + b * b;
  root(&length);
  lane_mask less = half < zero;
  lanes minus = -half, size;
  select_lanes(&less, &minus, &half, &size);
  size += length;
  lane_mask some = size > zero;
  select_lanes(&some, &size, &one, &size);
  lanes t = b / size, back = -t;
  select_lanes(&less, &back, &t, &t);
  lanes secant = 1.0 + t * t;
  root(&secant);
  lanes c = 1.0 / secant, s = t * c, x = m[rp], y = m[rq];
  m[p] -= t * b;
  m[q] += t * b;
  m[off] = zero;
  m[rp] = c * x - s * y;
  m[rq] = s * x + c * y;
  for (int i = 0; i < 3; i++) {
    x = n[p][i], y = n[q][i];
    n[p][i] = c * x - s * y;
    n[q][i] = s * x + c * y;
  }
}

/* The larger of two principal strains first. */
INLINE void order_axes(lanes *v, lanes *w, lanes *n, lanes *o) {
  lane_mask swap = *v < *w;
  lanes keep = *v;
  select_lanes(&swap, w, v, v);
  select_lanes(&swap, &keep, w, w);
  for (int i = 0; i < 3; i++) {
    keep = n[i];
    select_lanes(&swap, &o[i], &n[i], &n[i]);
    select_lanes(&swap, &keep, &o[i], &o[i]);
  }
}

/* cdem_tension_open_principal side by side; v in falling order, replaced by the openings. */
INLINE void open_principal(const lanes *lambda, const lanes *mu, lanes v[3]) {
  lanes zero = {0}, along = *lambda + 2.0 * *mu, sheet = 2.0 * *lambda * *mu / along;
  lanes poisson = 0.5 * *lambda / (*lambda + *mu);
  lanes first = *lambda * (v[0] + v[1] + v[2]) + 2.0 * *mu * v[0];
  lanes second = sheet * (v[1] + v[2]) + 2.0 * *mu * v[1], one = first / along;
  lane_mask opens = first > zero, two = opens & (second > zero), all = two & (v[2] >= zero);
  lanes drawn = poisson * v[2];
  select_lanes(&all, &zero, &drawn, &drawn);
  lanes two0 = v[0] + drawn, two1 = v[1] + drawn;
  select_lanes(&opens, &one, &zero, &one);
  select_lanes(&two, &two0, &one, &v[0]);
  select_lanes(&two, &two1, &zero, &v[1]);
  select_lanes(&all, &v[2], &zero, &v[2]);
}

/* Are symmetric tensors (Voigt, shears once) positive definite? */
INLINE void definite(const lanes m[6], lane_mask *yes) {
  lanes zero = {0}, minor = m[0] * m[1] - m[5] * m[5];
  lanes det =
      m[2] * minor - m[3] * (m[0] * m[3] - m[4] * m[5]) + m[4] * (m[3] * m[5] - m[4] * m[1]);
  *yes = (m[0] > zero) & (minor > zero) & (det > zero);
}

/* cdem_tension_open_solid side by side. Lanes that are not `active` do not ask for principal axes.
 */
INLINE void open_solids(const lanes *lambda, const lanes *mu, const lane_mask *active,
                        const lanes strain[6], lanes a[6]) {
  enum { SWEEPS = 10 };
  lanes zero = {0}, trace = *lambda * (strain[0] + strain[1] + strain[2]), m[6], s[6];
  for (int v = 0; v < 6; v++) {
    m[v] = v < 3 ? strain[v] : 0.5 * strain[v];
    s[v] = -2.0 * *mu * m[v] - (v < 3 ? trace : zero);
  }
  lane_mask pressed, open;
  definite(s, &pressed);
  definite(m, &open);
  for (int v = 0; v < 6; v++)
    select_lanes(&open, &strain[v], &zero, &a[v]);
  lane_mask rest = *active & ~pressed & ~open;
  if (!any_lane(&rest))
    return;
  lanes n[3][3] = {{zero + 1.0, zero, zero}, {zero, zero + 1.0, zero}, {zero, zero, zero + 1.0}};
  lanes off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
  lanes bound = 1e-33 * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + 2.0 * off);
  for (int sweep = 0; sweep < SWEEPS && !reaches(&off, &bound); sweep++) {
    turn_axes(0, 1, 5, 4, 3, m, n);
    turn_axes(0, 2, 4, 5, 3, m, n);
    turn_axes(1, 2, 3, 5, 4, m, n);
    off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
  }
  order_axes(&m[0], &m[1], n[0], n[1]);
  order_axes(&m[1], &m[2], n[1], n[2]);
  order_axes(&m[0], &m[1], n[0], n[1]);
  open_principal(lambda, mu, m);
  for (int v = 0; v < 6; v++) {
    static const int8_t row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    lanes sum = zero;
    for (int k = 0; k < 3; k++)
      sum += m[k] * n[k][row[v]] * n[k][column[v]];
    sum *= v < 3 ? 1.0 : 2.0;
    select_lanes(&rest, &sum, &a[v], &a[v]);
  }
}

/* force_i += pull m_i - turn g_i, g_i = J^-T dN_i. */
INLINE void release_all(const int nodes, const int n, const int dofs, const cdem_body_task *task,
                        const double *mean, int part, const cdem_body_pulls *pulls, double *force) {
  const bool shared = task->shared;
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  const double *own = mean + (shared ? 0 : part * WIDTH);
  lanes pull[9], turned[9];
  for (int r = 0; r < n; r++)
    for (int c = 0; c < n; c++) {
      pull[n * r + c] = *(const lanes_at *)(pulls->pull[3 * r + c] + part * WIDTH);
      turned[n * r + c] = (lanes){0};
      for (int k = 0; k < n; k++)
        turned[n * r + c] +=
            *(const lanes_at *)(pulls->turn[3 * r + k] + part * WIDTH) * ENTRY(record, n * c + k);
    }
  for (int i = 0; i < nodes; i++) {
    const double *dn = task->kind->derivative[i];
    for (int r = 0; r < n; r++) {
      lanes_at *to = (lanes_at *)(force + (ptrdiff_t)CDEM_LANES * (dofs * i + r) + part * WIDTH);
      lanes sum = *to;
      for (int c = 0; c < n; c++)
        sum += pull[n * r + c] * ENTRY(own, 1 + n * i + c) - turned[n * r + c] * dn[c];
      *to = sum;
    }
  }
}
