/* Materials without tension: part of body_kernels_width.h. First the frames and mean strains of a
 * batch, then, when something has opened, its forces less the tension; between the two the law
 * works element by element (body_tension.c). */

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
