/* Stress at the centre: part of body_kernels_width.h. The gradient of the local displacements is
 * R^T F - I there, which is symmetric: U - I. */

/* R s R^T, s = law [6][7] strain (Voigt, engineering shears; [6]: relative rotation), R = I + E. */
INLINE void turned_stress(const double (*law)[7], const lanes strain[7], const lanes e[9],
                          lanes out[6]) {
  static const int8_t at[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
  static const int8_t row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  lanes s[6], t[9];
  for (int i = 0; i < 6; i++) {
    s[i] = law[i][0] * strain[0];
    for (int j = 1; j < 7; j++)
      s[i] += law[i][j] * strain[j];
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      t[3 * i + j] = s[at[3 * i + j]] + (e[3 * i] * s[at[j]] + e[3 * i + 1] * s[at[3 + j]] +
                                         e[3 * i + 2] * s[at[6 + j]]);
  for (int v = 0; v < 6; v++) {
    int i = row[v], j = column[v];
    out[v] = t[3 * i + j] +
             (t[3 * i] * e[3 * j] + t[3 * i + 1] * e[3 * j + 1] + t[3 * i + 2] * e[3 * j + 2]);
  }
}

INLINE void solid_stress(int nodes, bool shared, const cdem_body_task *task, int part,
                         const double (*law)[7], lanes stress[6]) {
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  lanes w[CDEM_BODY_NODES][3], h[9], e[9] = {0}, inverse[6], b[9];
  relative(nodes, 3, 3, task, part, w);
  gradient3(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
  if (!task->linear)
    polar(h, e, inverse);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      b[3 * i + j] =
          e[3 * j + i] + h[3 * i + j] + (e[i] * h[j] + e[3 + i] * h[3 + j] + e[6 + i] * h[6 + j]);
  lanes strain[7] = {b[0], b[4], b[8], b[5] + b[7], b[2] + b[6], b[1] + b[3], (lanes){0}};
  turned_stress(law, strain, e, stress);
}

INLINE void plane_stress(int nodes, bool cosserat, bool shared, const cdem_body_task *task,
                         int part, const double (*law)[7], lanes stress[6]) {
  const double *record = task->record + (shared ? 0 : part * WIDTH);
  lanes w[CDEM_BODY_NODES][3], h[4], e[2] = {0}, trace, b[4], zero = {0}, omega = {0};
  relative(nodes, cosserat ? 3 : 2, 2, task, part, w);
  gradient2(nodes, shared, task->kind, record, (const lanes(*)[3])w, h);
  if (!task->linear)
    polar2(h, e, &trace);
  if (!task->linear && cosserat)
    branch(nodes, h, w);
  for (int i = 0; i < nodes && cosserat; i++)
    omega += task->kind->shape[i] * w[i][2];
  for (int j = 0; j < 2; j++) { /* E^T + H + E^T H with E^T = (e0 e1; -e1 e0) */
    b[j] = h[j] + (e[0] * h[j] + e[1] * h[2 + j]) + (j == 0 ? e[0] : e[1]);
    b[2 + j] = h[2 + j] + (e[0] * h[2 + j] - e[1] * h[j]) + (j == 0 ? -e[1] : e[0]);
  }
  lanes strain[7] = {b[0], b[3], zero, zero, zero, b[1] + b[2], zero};
  if (cosserat)
    strain[6] = b[2] - b[1] - 2.0 * omega;
  const lanes turn[9] = {e[0], -e[1], zero, e[1], e[0], zero, zero, zero, zero};
  turned_stress(law, strain, turn, stress);
}
