/* One element at a time, by plain loops: the reference of the kernels, and the state that fields
 * are computed from. A plane element is treated as a solid that does not strain out of its plane.
 */
#include "base/mat3.h"
#include "cdem/body_store.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = 60 };

/* E = R - I of the polar rotation of I + h by Newton's iteration R <- (R + R^-T)/2 (Higham 1986),
 * written for E so that small rotations keep their digits: E <- (E - R^-T E^T)/2 from E = h. The
 * identity where F is singular or inverted. */
static void rotate(const double h[9], double e[9]) {
  memcpy(e, h, 9 * sizeof *e);
  double last = INFINITY;
  for (int step = 0; step < MOST_STEPS; step++) {
    double r[9], inverse[9], next[9], change = 0.0;
    for (int i = 0; i < 9; i++)
      r[i] = e[i] + (i % 4 == 0 ? 1.0 : 0.0);
    if (!(cdem_inverse3(r, inverse) > 0.0)) {
      memset(e, 0, 9 * sizeof *e);
      return;
    }
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        double sum = 0.0; /* (R^-T E^T)_ij = sum inverse_ki e_jk */
        for (int k = 0; k < 3; k++)
          sum += inverse[3 * k + i] * e[3 * j + k];
        next[3 * i + j] = 0.5 * (e[3 * i + j] - sum);
        change = fmax(change, fabs(next[3 * i + j] - e[3 * i + j]));
      }
    memcpy(e, next, sizeof next);
    if (change == 0.0 || (change >= last && change < 1e-14))
      return;
    last = change;
  }
}

/* Node places and shape function gradients at the centre, from the mesh. */
static void geometry(const cdem_body *body, int32_t cell, cdem_body_element *element) {
  const cdem_body_kind *kind = element->record.kind;
  double xyz[CDEM_SHAPE_MAX_NODES][3], inverse[9];
  cdem_model_coordinates(body->model, cell, xyz);
  cdem_body_jacobian(kind, (const double(*)[3])xyz, kind->derivative, inverse);
  for (int a = 0; a < kind->nodes; a++)
    for (int i = 0; i < 3; i++) {
      element->x[a][i] = i < kind->dimension ? xyz[a][i] : 0.0;
      element->gradient[a][i] = 0.0;
      for (int k = 0; k < kind->dimension && i < kind->dimension; k++)
        element->gradient[a][i] += kind->derivative[a][k] * inverse[3 * k + i];
    }
}

/* Places y, and the opening of a material without tension, which then leaves d. */
static void open_up(const cdem_body *body, int32_t cell, cdem_body_element *element) {
  const cdem_body_kind *kind = element->record.kind;
  double mean[CDEM_BODY_NODES][3], h[9] = {0}, *a = element->opening;
  memset(a, 0, 6 * sizeof *a);
  for (int i = 0; i < kind->nodes; i++)
    for (int c = 0; c < 3; c++)
      element->y[i][c] = c < kind->dimension ? element->x[i][c] + element->d[i][c] : 0.0;
  if (!cdem_body_is_tensionless(body->model, body->store, cell))
    return;
  cdem_body_mean_gradients(body->model, cell, mean);
  for (int i = 0; i < kind->nodes; i++)
    for (int r = 0; r < kind->dimension; r++)
      for (int c = 0; c < kind->dimension; c++)
        h[3 * r + c] += element->d[i][r] * mean[i][c];
  const double strain[6] = {h[0], h[4], h[8], h[5] + h[7], h[2] + h[6], h[1] + h[3]};
  if (!cdem_tension_open(&body->store->tension[body->model->material[cell]], strain, a))
    return;
  const double m[9] = {a[0],     a[5] / 2, a[4] / 2, a[5] / 2, a[1],
                       a[3] / 2, a[4] / 2, a[3] / 2, a[2]};
  for (int i = 0; i < kind->nodes; i++)
    for (int c = 0; c < kind->dimension; c++)
      element->d[i][c] -= cdem_dot3(m + 3 * c, element->x[i]);
}

/* Cosserat rotations less the angle of R, on the branch nearest to their mean. */
static void take_angle(const double rotation[9], int nodes, double (*d)[3]) {
  double mean = 0.0, angle = atan2(rotation[3] - rotation[1], rotation[0] + rotation[4]);
  for (int a = 0; a < nodes; a++)
    mean += d[a][2] / nodes;
  angle += 2.0 * M_PI * rint((mean - angle) / (2.0 * M_PI));
  for (int a = 0; a < nodes; a++)
    d[a][2] -= angle;
}

void cdem_body_element_at(const cdem_body *body, const double *u, int32_t cell,
                          cdem_body_element *element) {
  const cdem_model *model = body->model;
  element->record = cdem_body_record_of(body->store, cell);
  const cdem_body_kind *kind = element->record.kind;
  const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[cell]);
  int dofs = kind->dofs, moving = kind->dimension;
  double w[CDEM_BODY_NODES][3] = {{0}}, h[9] = {0}, f[9], e[9] = {0};
  element->node = node;
  geometry(body, cell, element);
  for (int a = 0; a < kind->nodes; a++)
    for (int c = 0; c < moving; c++) {
      w[a][c] = u[(int64_t)node[a] * dofs + c] - u[(int64_t)node[0] * dofs + c];
      for (int k = 0; k < moving; k++)
        h[3 * c + k] += w[a][c] * element->gradient[a][k];
    }
  for (int i = 0; i < 9; i++)
    f[i] = h[i] + (i % 4 == 0 ? 1.0 : 0.0);
  element->determinant = cdem_det3(f);
  if (!body->linear)
    rotate(h, e);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double left = 0.0, right = 0.0; /* (E^T h)_ij and its transpose */
      for (int k = 0; k < 3; k++) {
        left += e[3 * k + i] * h[3 * k + j];
        right += e[3 * k + j] * h[3 * k + i];
      }
      element->rotation[3 * i + j] = e[3 * i + j] + (i == j);
      element->stretch[3 * i + j] =
          (i == j) + 0.5 * (e[3 * i + j] + e[3 * j + i] + h[3 * i + j] + h[3 * j + i]) +
          0.5 * (left + right);
    }
  for (int a = 0; a < kind->nodes; a++)
    for (int c = 0; c < 3; c++) {
      element->d[a][c] = w[a][c];
      for (int k = 0; k < 3; k++)
        element->d[a][c] += e[3 * k + c] * (element->x[a][k] + w[a][k]);
    }
  if (kind->formulation == CDEM_PLANE_COSSERAT) {
    for (int a = 0; a < kind->nodes; a++)
      element->d[a][2] = u[(int64_t)node[a] * dofs + 2];
    if (!body->linear) {
      double r[9] = {h[0] + h[4] + 2.0, 0, 0, h[3] - h[1], 0}; /* cosine, sine */
      take_angle(r, kind->nodes, element->d);
    }
  }
  open_up(body, cell, element);
}

void cdem_body_spring(const cdem_body_element *element, int p, double s[9]) {
  const cdem_body_record *record = &element->record;
  int entries = record->kind->dofs * record->kind->dofs;
  for (int e = 0; e < entries; e++)
    s[e] = record->data[(ptrdiff_t)(record->kind->spring + entries * p + e) * record->stride];
}

void cdem_body_elongation(const cdem_body_element *element, int i, int j, double g[3]) {
  const cdem_body_kind *kind = element->record.kind;
  for (int c = 0; c < kind->dofs; c++)
    g[c] = element->d[j][c] - element->d[i][c];
  if (kind->formulation == CDEM_PLANE_COSSERAT) {
    g[0] += element->d[i][2] * (element->x[j][1] - element->x[i][1]);
    g[1] -= element->d[i][2] * (element->x[j][0] - element->x[i][0]);
  }
}

/* f [nodes][3]: the network's forces and moments in the local frame. */
static void network_forces(const cdem_body_element *element, double (*f)[3]) {
  const cdem_body_kind *kind = element->record.kind;
  int n = kind->dofs;
  memset(f, 0, CDEM_BODY_NODES * sizeof *f);
  for (int i = 0, p = 0; i < kind->nodes; i++)
    for (int j = i + 1; j < kind->nodes; j++, p++) {
      double s[9], there[3], back[3];
      cdem_body_spring(element, p, s);
      cdem_body_elongation(element, i, j, there);
      cdem_body_elongation(element, j, i, back);
      for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
          f[i][a] += s[n * a + b] * there[b];
          f[j][b] += s[n * a + b] * back[a];
        }
    }
}

/* Adds the terms of dR/dx: f_i -= h x grad N_i, (tr(U) I - U) h = M. */
static void add_rotation_terms(const cdem_body_element *element, double (*f)[3]) {
  const cdem_body_kind *kind = element->record.kind;
  double moment[3] = {0}, k[9], inverse[9], h[3];
  const double *u = element->stretch;
  for (int a = 0; a < kind->nodes; a++) {
    double force[3], part[3];
    for (int c = 0; c < 3; c++)
      force[c] = c < kind->dimension ? f[a][c] : 0.0;
    cdem_cross3(element->y[a], force, part);
    for (int c = 0; c < 3; c++)
      moment[c] += part[c];
    if (kind->formulation == CDEM_PLANE_COSSERAT)
      moment[2] += f[a][2];
  }
  for (int i = 0; i < 9; i++)
    k[i] = (i % 4 == 0 ? u[0] + u[4] + u[8] : 0.0) - u[i];
  cdem_inverse3(k, inverse);
  for (int i = 0; i < 3; i++)
    h[i] = cdem_dot3(inverse + 3 * i, moment);
  for (int a = 0; a < kind->nodes; a++) {
    double part[3];
    cdem_cross3(h, element->gradient[a], part);
    for (int c = 0; c < kind->dimension; c++)
      f[a][c] -= part[c];
  }
}

void cdem_body_forces_reference(const cdem_body *body, const double *u, double *force) {
  memset(force, 0, sizeof *force * (size_t)body->nodes * (size_t)body->dofs);
  for (int32_t cell = 0; cell < body->model->cells; cell++) {
    cdem_body_element element;
    double f[CDEM_BODY_NODES][3];
    cdem_body_element_at(body, u, cell, &element);
    const cdem_body_kind *kind = element.record.kind;
    network_forces(&element, f);
    if (!body->linear)
      add_rotation_terms(&element, f);
    for (int a = 0; a < kind->nodes; a++) {
      double *to = force + (int64_t)element.node[a] * kind->dofs;
      for (int c = 0; c < kind->dofs; c++) {
        if (c >= kind->dimension) {
          to[c] += f[a][c];
          continue;
        }
        for (int k = 0; k < kind->dimension; k++)
          to[c] += element.rotation[3 * c + k] * f[a][k];
      }
    }
  }
}
